// SPDX-License-Identifier: MIT
// SPDX-FileCopyrightText: 2026 the osgGeoFX authors
#include <osgGeoFX/terrain/detail/AtomicFile.h>
#include <osgGeoFX/terrain/detail/BuildPlan.h>
#include <osgGeoFX/terrain/detail/BuildStage.h>
#include <osgGeoFX/terrain/detail/VoidRaster.h>

#include <osgGeoFX/geodata/BuildError.h>

#include <cpl_string.h>
#include <gdal_alg.h>

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <limits>

namespace osgGeoFX
{

namespace
{

// Cells along the mask's longer side.
constexpr int MASK_SIDE = 1024;
// The height of posts that GDAL left unfilled: no height of the Earth, and exact in a float.
constexpr float UNFILLED = -1048576.0f;
// The memory of a post in a window: heights, mask, and GDAL's own.
constexpr double BYTES_PER_POST = 24.0;

/// What the stages of voids share.
class VoidPass
{
public:
    explicit VoidPass(BuildPlan& plan);

    void sample(RasterStack& rasters, const Unit& unit);
    void find();
    void fill(const Unit& unit);
    void count();
    /// The memory of filling a unit, MiB.
    double windowMiB() const;

private:
    /// The part of the grid that GDAL gets for a unit: the unit and a margin.
    struct Window
    {
        int west = 0, south = 0, width = 0, height = 0; ///< posts
        std::vector<float> heights;
        std::vector<Post> posts;
    };
    RowFile open(const char* name, std::size_t bytesPerPost, RowFile::Mode mode) const;
    bool hasVoids(const RowFile& posts, const Unit& unit) const;
    Window windowOf(const RowFile& posts, const Unit& unit) const;
    /// Gives all posts without a height one. It is UNFILLED if there is no data near enough.
    void interpolate(Window& window) const;
    /// In posts of the lattice of voids.
    int firstColumn(const Unit& unit) const { return _scheme.firstColumn(unit.root) / _step; }
    int firstRow(const Unit& unit) const { return _scheme.firstRow(unit.root) / _step; }
    /// The posts of a unit that no other unit has. Those on its northern and eastern border belong to the next unit,
    /// if there is one.
    int ownColumns(const Unit& unit) const;
    int ownRows(const Unit& unit) const;

    BuildPlan& _plan;
    const TilingScheme& _scheme;
    const int _step; ///< finest posts from post to post
    const int _columns, _rows;
    /// How far GDAL looks for data: across the largest void, and to the middle of a void that the data's edge cuts.
    const int _search;
    const int _margin; ///< makes a window's middle come out as it would in the whole grid
};

DatasetPtr wrap(void* values, int columns, int rows, GDALDataType type)
{
    DatasetPtr dataset(
        GetGDALDriverManager()->GetDriverByName("MEM")->Create("", columns, rows, 0, type, nullptr));
    char pointer[64] = {};
    CPLPrintPointer(pointer, values, sizeof(pointer) - 1);
    CPLStringList options;
    options.SetNameValue("DATAPOINTER", pointer);
    dataset->AddBand(type, options.List());
    return dataset;
}

VoidPass::VoidPass(BuildPlan& plan)
    : _plan(plan), _scheme(plan.scheme), _step(_scheme.step(plan.voidLevel)),
      _columns(_scheme.lastColumn / _step + 1), _rows(_scheme.lastRow / _step + 1),
      _search(plan.options.voidReach * 9 / 4 + 2), _margin(_search + plan.options.voidSmoothing)
{
}

RowFile VoidPass::open(const char* name, std::size_t bytesPerPost, RowFile::Mode mode) const
{
    RowFile file(VoidRaster::file(_plan, name), static_cast<std::size_t>(_columns) * bytesPerPost, mode);
    // Rows that no unit writes are 0.
    if (mode == RowFile::Mode::SHARE) file.extend(_rows);
    return file;
}

double VoidPass::windowMiB() const
{
    const double side = _plan.voidUnits.front().span() * _scheme.intervals + 2.0 * _margin;
    return side * side * BYTES_PER_POST / (1024.0 * 1024.0);
}

int VoidPass::ownColumns(const Unit& unit) const
{
    const int side = unit.span() * _scheme.intervals, left = _columns - 1 - firstColumn(unit);
    return left <= side ? left + 1 : side;
}

int VoidPass::ownRows(const Unit& unit) const
{
    const int side = unit.span() * _scheme.intervals, left = _rows - 1 - firstRow(unit);
    return left <= side ? left + 1 : side;
}

void VoidPass::sample(RasterStack& rasters, const Unit& unit)
{
    // The same points as the height pass samples. The last bits of GDAL's heights depend on them.
    const Lattice lattice = _plan.postsWithApron(unit);
    const std::vector<float> heights = rasters.measuredHeights(lattice);
    const std::vector<unsigned char> covered = rasters.covered(lattice, heights);
    const int columns = ownColumns(unit), rows = ownRows(unit);
    std::vector<Post> posts(static_cast<std::size_t>(columns));
    RowFile postFile = open("sampled", 1, RowFile::Mode::SHARE),
            heightFile = open("heights", sizeof(float), RowFile::Mode::SHARE);
    for (int j = 0; j < rows; ++j)
    {
        const std::size_t start =
            (static_cast<std::size_t>(j) + 1) * static_cast<std::size_t>(lattice.columns) + 1;
        for (std::size_t i = 0; i < posts.size(); ++i)
            posts[i] = !std::isnan(heights[start + i]) ? Post::DATA
                       : covered[start + i]            ? Post::VOID
                                                       : Post::OUTSIDE;
        const int row = firstRow(unit) + j;
        const auto column = static_cast<std::size_t>(firstColumn(unit));
        postFile.write(row, column, posts.size(), posts.data());
        heightFile.write(row, column * sizeof(float), posts.size() * sizeof(float), heights.data() + start);
    }
}

void VoidPass::find()
{
    VoidFinder finder(_columns, _rows, _plan.options.voidReach, _scheme.wholeCircle());
    std::vector<Post> posts(static_cast<std::size_t>(_columns));
    std::vector<float> heights(posts.size());
    const RowFile sampled = open("sampled", 1, RowFile::Mode::READ),
                  heightFile = open("heights", sizeof(float), RowFile::Mode::READ);
    for (int row = 0; row < _rows; ++row)
    {
        sampled.read(row, posts.data());
        heightFile.read(row, heights.data());
        finder.add(posts, heights);
    }
    RowFile marked(VoidRaster::file(_plan, "posts"), posts.size(), RowFile::Mode::TEMPORARY);
    for (int row = _rows - 1; row >= 0; --row)
    {
        sampled.read(row, posts.data());
        finder.mark(posts);
        marked.write(row, posts.data());
    }
    marked.finish(VoidRaster::file(_plan, "posts"));
}

bool VoidPass::hasVoids(const RowFile& posts, const Unit& unit) const
{
    std::vector<Post> line(static_cast<std::size_t>(ownColumns(unit)));
    for (int j = 0; j < ownRows(unit); ++j)
    {
        posts.read(firstRow(unit) + j, static_cast<std::size_t>(firstColumn(unit)), line.size(), line.data());
        if (std::find(line.begin(), line.end(), Post::FILLED) != line.end()) return true;
    }
    return false;
}

VoidPass::Window VoidPass::windowOf(const RowFile& posts, const Unit& unit) const
{
    const RowFile heightFile = open("heights", sizeof(float), RowFile::Mode::READ);
    // On a whole circle a window goes on beyond the seam. The last column is the first one again.
    const bool circle = _scheme.wholeCircle();
    const int column = firstColumn(unit), row = firstRow(unit);
    const int last = column + ownColumns(unit) + _margin;
    Window window;
    window.west = circle ? column - _margin : std::max(column - _margin, 0);
    window.south = std::max(row - _margin, 0);
    window.width = (circle ? last : std::min(last, _columns)) - window.west;
    window.height = std::min(row + ownRows(unit) + _margin, _rows) - window.south;
    const auto count = static_cast<std::size_t>(window.width) * static_cast<std::size_t>(window.height);
    window.heights.resize(count);
    window.posts.resize(count);
    for (int j = 0; j < window.height; ++j)
    {
        const std::size_t start = static_cast<std::size_t>(j) * static_cast<std::size_t>(window.width);
        for (int i = 0; i < window.width;)
        {
            const int lap = _columns - 1;
            const int from = circle ? ((window.west + i) % lap + lap) % lap : window.west + i;
            const int run = std::min(window.width - i, (circle ? lap : _columns) - from);
            const auto first = static_cast<std::size_t>(from), size = static_cast<std::size_t>(run);
            const std::size_t target = start + static_cast<std::size_t>(i);
            posts.read(window.south + j, first, size, window.posts.data() + target);
            heightFile.read(window.south + j, first * sizeof(float), size * sizeof(float),
                            window.heights.data() + target);
            i += run;
        }
    }
    return window;
}

void VoidPass::interpolate(Window& window) const
{
    std::vector<unsigned char> valid(window.posts.size());
    for (std::size_t i = 0; i < valid.size(); ++i)
    {
        valid[i] = window.posts[i] == Post::DATA ? 255 : 0;
        if (!valid[i]) window.heights[i] = UNFILLED;
    }
    const GdalErrorScope errors;
    const DatasetPtr values = wrap(window.heights.data(), window.width, window.height, GDT_Float32);
    const DatasetPtr mask = wrap(valid.data(), window.width, window.height, GDT_Byte);
    CPLStringList options;
    options.SetNameValue("TEMP_FILE_DRIVER", "MEM");
    if (GDALFillNodata(values->GetRasterBand(1), mask->GetRasterBand(1), _search, 0,
                       _plan.options.voidSmoothing, options.List(), nullptr, nullptr) != CE_None)
        throw BuildError(_plan.options.dems.front() + ": its voids cannot be filled (" + errors.message() +
                         "); build with --voids keep.");
}

void VoidPass::fill(const Unit& unit)
{
    const RowFile posts = open("posts", 1, RowFile::Mode::READ);
    RowFile filled = open("filled", sizeof(float), RowFile::Mode::SHARE);
    if (!hasVoids(posts, unit)) return;
    Window window = windowOf(posts, unit);
    interpolate(window);
    const int column = firstColumn(unit), row = firstRow(unit), columns = ownColumns(unit);
    for (int j = 0; j < ownRows(unit); ++j)
    {
        const std::size_t start =
            static_cast<std::size_t>(row + j - window.south) * static_cast<std::size_t>(window.width) +
            static_cast<std::size_t>(column - window.west);
        const auto isFilled = [&](int k)
        {
            return window.posts[start + static_cast<std::size_t>(k)] == Post::FILLED;
        };
        for (int i = 0; i < columns;)
        {
            int end = i;
            for (; end < columns && isFilled(end); ++end)
            {
                // GDAL found no data near enough, so the post stays a void.
                float& height = window.heights[start + static_cast<std::size_t>(end)];
                if (height == UNFILLED) height = std::numeric_limits<float>::quiet_NaN();
            }
            if (end > i)
                filled.write(row + j, static_cast<std::size_t>(column + i) * sizeof(float),
                             static_cast<std::size_t>(end - i) * sizeof(float),
                             window.heights.data() + start + static_cast<std::size_t>(i));
            for (i = end; i < columns && !isFilled(i); ++i)
                ;
        }
    }
}

/// Counts posts, and writes the file that VoidRaster reads first.
void VoidPass::count()
{
    const double scale = std::min(1.0, static_cast<double>(MASK_SIDE) / std::max(_columns, _rows));
    const int maskColumns = std::max(1, static_cast<int>(std::ceil(_columns * scale)));
    const int maskRows = std::max(1, static_cast<int>(std::ceil(_rows * scale)));
    std::vector<std::uint32_t> filled(static_cast<std::size_t>(maskColumns) *
                                      static_cast<std::size_t>(maskRows)),
        all(filled);
    std::uint64_t filledPosts = 0, openPosts = 0, dataPosts = 0;
    std::vector<Post> posts(static_cast<std::size_t>(_columns));
    std::vector<float> heights(posts.size());
    const RowFile postFile = open("posts", 1, RowFile::Mode::READ),
                  filledFile = open("filled", sizeof(float), RowFile::Mode::READ);
    const auto cellOf = [](int post, int count, int cells)
    {
        return static_cast<std::size_t>(static_cast<std::int64_t>(post) * cells / count);
    };
    for (int row = 0; row < _rows; ++row)
    {
        postFile.read(row, posts.data());
        if (std::find(posts.begin(), posts.end(), Post::FILLED) != posts.end())
        {
            filledFile.read(row, heights.data());
            for (std::size_t i = 0; i < posts.size(); ++i)
                if (posts[i] == Post::FILLED && std::isnan(heights[i])) posts[i] = Post::VOID;
        }
        const std::size_t start = cellOf(row, _rows, maskRows) * static_cast<std::size_t>(maskColumns);
        for (int column = 0; column < _columns; ++column)
        {
            const Post post = posts[static_cast<std::size_t>(column)];
            const std::size_t cell = start + cellOf(column, _columns, maskColumns);
            ++all[cell];
            filled[cell] += post == Post::FILLED ? 1 : 0;
            filledPosts += post == Post::FILLED ? 1 : 0;
            openPosts += post == Post::VOID ? 1 : 0;
            dataPosts += post == Post::DATA ? 1 : 0;
        }
    }
    std::vector<unsigned char> mask(filled.size());
    for (std::size_t cell = 0; cell < mask.size(); ++cell)
        if (filled[cell] > 0)
            mask[cell] = static_cast<unsigned char>(std::clamp<std::uint64_t>(
                (std::uint64_t{255} * filled[cell] + all[cell] / 2) / all[cell], 1, 255));
    ByteWriter writer;
    writer.put(filledPosts);
    writer.put(openPosts);
    writer.put(dataPosts);
    writer.put(maskColumns);
    writer.put(mask);
    writeFileAtomically(VoidRaster::file(_plan, "done"), writer.bytes().data(), writer.bytes().size());
}

bool exists(const BuildPlan& plan, const char* name)
{
    return std::filesystem::exists(VoidRaster::file(plan, name));
}

/// One of four stages. A stage that has made its file is done, and so are those before.
class VoidStage : public BuildStage
{
public:
    VoidStage(BuildPlan& plan, const char* name, const char* result)
        : BuildStage(name, "voids"), _plan(plan), _pass(plan), _result(result)
    {
    }
    std::size_t units() const override { return 1; }
    bool isNeeded() const override { return VoidRaster::isNeeded(_plan); }
    bool takeOver(std::size_t) override { return exists(_plan, _result); }

protected:
    BuildPlan& _plan;
    VoidPass _pass;

private:
    const char* _result;
};

/// Samples the posts of the lattice of voids.
class VoidPosts : public VoidStage
{
public:
    explicit VoidPosts(BuildPlan& plan)
        : VoidStage(plan, "void-posts", "posts"), _rasters(static_cast<std::size_t>(plan.threads))
    {
    }
    std::size_t units() const override { return _plan.voidUnits.size(); }
    void run(int worker, std::size_t unit) override
    {
        auto& stack = _rasters[static_cast<std::size_t>(worker)];
        if (!stack) stack = std::make_unique<RasterStack>(_plan);
        _pass.sample(*stack, _plan.voidUnits[unit]);
    }

private:
    std::vector<std::unique_ptr<RasterStack>> _rasters;
};

/// Finds out which voids are small enough to be filled.
class VoidAreas : public VoidStage
{
public:
    explicit VoidAreas(BuildPlan& plan) : VoidStage(plan, "void-areas", "posts") {}
    void run(int, std::size_t) override { _pass.find(); }
};

class VoidHeights : public VoidStage
{
public:
    explicit VoidHeights(BuildPlan& plan) : VoidStage(plan, "void-heights", "done") {}
    std::size_t units() const override { return _plan.voidUnits.size(); }
    int threads(int wanted) const override
    {
        return std::clamp(static_cast<int>(0.75 * _plan.options.memoryMiB / _pass.windowMiB()), 1, wanted);
    }
    void run(int, std::size_t unit) override { _pass.fill(_plan.voidUnits[unit]); }
};

class VoidCounts : public VoidStage
{
public:
    explicit VoidCounts(BuildPlan& plan) : VoidStage(plan, "void-counts", "done") {}
    void run(int, std::size_t) override { _pass.count(); }
};

} // namespace

void addVoidStages(BuildPlan& plan, BuildStages& stages)
{
    stages.push_back(std::make_unique<VoidPosts>(plan));
    stages.push_back(std::make_unique<VoidAreas>(plan));
    stages.push_back(std::make_unique<VoidHeights>(plan));
    stages.push_back(std::make_unique<VoidCounts>(plan));
}

} // namespace osgGeoFX
