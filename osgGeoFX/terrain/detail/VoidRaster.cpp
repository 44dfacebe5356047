// SPDX-License-Identifier: MIT
// SPDX-FileCopyrightText: 2026 the osgGeoFX authors
#include <osgGeoFX/terrain/detail/VoidRaster.h>

#include <osgGeoFX/terrain/detail/AtomicFile.h>
#include <osgGeoFX/terrain/detail/BuildPlan.h>

#include <osgGeoFX/geodata/BuildError.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <filesystem>
#include <limits>

namespace osgGeoFX
{

namespace
{

// A point so near to a post, in posts, lies on it. The difference is rounding.
constexpr double ON_POST = 1e-5;

/// A place between two posts of a row or column.
struct Place
{
    int post = -1; ///< the lower one; −1 outside the extent
    double fraction = 0.0;
};

Place placeOf(double value, double start, double extent, int last, bool wholeCircle)
{
    double posts = (value - start) / extent * last;
    if (wholeCircle) posts -= last * std::floor(posts / last);
    const double whole = std::round(posts);
    if (std::abs(posts - whole) < ON_POST) posts = whole;
    if (!(posts >= 0.0 && posts <= last)) return {};
    const int post = static_cast<int>(posts);
    return {post, posts - post};
}

} // namespace

/// The posts of two neighbouring rows, between two columns.
class VoidRaster::Rows
{
public:
    explicit Rows(const VoidRaster& raster) : _raster(raster) {}

    void load(int row, int firstColumn, int lastColumn)
    {
        if (row == _row && firstColumn >= _first && lastColumn <= _last) return;
        _row = row;
        _first = firstColumn;
        _last = lastColumn;
        const auto count = static_cast<std::size_t>(_last - _first + 1);
        for (std::size_t side = 0; side < 2; ++side)
        {
            heights[side].resize(count);
            filled[side].resize(count);
            posts[side].resize(count);
            const int from = std::min(row + static_cast<int>(side), _raster._rows - 1);
            const auto first = static_cast<std::size_t>(_first);
            _raster._posts.read(from, first, count, posts[side].data());
            _raster._heights.read(from, first * sizeof(float), count * sizeof(float), heights[side].data());
            _raster._filled.read(from, first * sizeof(float), count * sizeof(float), filled[side].data());
        }
    }

    /// The height of a post; NaN for none. Sets `any` if the post was filled.
    float height(std::size_t side, int column, bool& any) const
    {
        const auto c = static_cast<std::size_t>(column - _first);
        any = any || (posts[side][c] == Post::FILLED && !std::isnan(filled[side][c]));
        return posts[side][c] == Post::FILLED ? filled[side][c]
               : posts[side][c] == Post::DATA ? heights[side][c]
                                              : std::numeric_limits<float>::quiet_NaN();
    }

private:
    const VoidRaster& _raster;
    int _row = -1, _first = 0, _last = -1;
    std::array<std::vector<float>, 2> heights, filled;
    std::array<std::vector<Post>, 2> posts;
};

std::string VoidRaster::file(const BuildPlan& plan, const char* name)
{
    return plan.workFolder() + "/voids/" + name;
}

bool VoidRaster::isNeeded(const BuildPlan& plan)
{
    return std::filesystem::exists(neededFile(plan));
}

VoidRaster::VoidRaster(const BuildPlan& plan)
    : _plan(plan), _columns(plan.scheme.lastColumn / plan.scheme.step(plan.voidLevel) + 1),
      _rows(plan.scheme.lastRow / plan.scheme.step(plan.voidLevel) + 1),
      _heights(file(plan, "heights"), static_cast<std::size_t>(_columns) * sizeof(float),
               RowFile::Mode::READ),
      _posts(file(plan, "posts"), static_cast<std::size_t>(_columns), RowFile::Mode::READ),
      _filled(file(plan, "filled"), static_cast<std::size_t>(_columns) * sizeof(float), RowFile::Mode::READ)
{
    ByteReader reader(file(plan, "done"));
    _filledPosts = reader.get<std::uint64_t>();
    _openPosts = reader.get<std::uint64_t>();
    _dataPosts = reader.get<std::uint64_t>();
    _maskColumns = reader.get<int>();
    _mask = reader.getVector<unsigned char>();
    if (!reader.good())
        throw BuildError(file(plan, "done") + ": this work file is damaged; build again without --resume.");
}

void VoidRaster::fill(const Lattice& lattice, std::vector<float>& heights,
                      std::vector<unsigned char>* filled) const
{
    const TilingScheme& scheme = _plan.scheme;
    const bool wholeCircle = scheme.wholeCircle();
    const auto columns = static_cast<std::size_t>(lattice.columns);
    std::vector<Place> across;
    Rows rows(*this);
    for (int row = 0; row < lattice.rows; ++row)
    {
        float* line = heights.data() + static_cast<std::size_t>(row) * columns;
        if (std::none_of(line, line + columns, [](float height) { return std::isnan(height); })) continue;
        const Place south = placeOf(lattice.y0 + row * lattice.dy, scheme.south, scheme.north - scheme.south,
                                    _rows - 1, false);
        if (south.post < 0) continue;
        if (across.empty())
            for (int column = 0; column < lattice.columns; ++column)
                across.push_back(placeOf(lattice.x0 + column * lattice.dx, scheme.west,
                                         scheme.east - scheme.west, _columns - 1, wholeCircle));
        int first = _columns - 1, last = -1;
        for (std::size_t c = 0; c < columns; ++c)
            if (std::isnan(line[c]) && across[c].post >= 0)
            {
                first = std::min(first, across[c].post);
                last = std::max(last, std::min(across[c].post + 1, _columns - 1));
            }
        if (last < 0) continue;
        rows.load(south.post, first, last);
        for (std::size_t c = 0; c < columns; ++c)
        {
            const Place& west = across[c];
            if (!std::isnan(line[c]) || west.post < 0) continue;
            double sum = 0.0, weights = 0.0;
            bool any = false;
            for (const int corner : {0, 1, 2, 3})
            {
                const bool east = corner % 2 == 1, north = corner > 1;
                const double weight = (east ? west.fraction : 1.0 - west.fraction) *
                                      (north ? south.fraction : 1.0 - south.fraction);
                if (!(weight > 0.0)) continue;
                const float height = rows.height(north ? 1 : 0, west.post + (east ? 1 : 0), any);
                if (std::isnan(height)) continue;
                sum += weight * static_cast<double>(height);
                weights += weight;
            }
            const bool onPost = west.fraction == 0.0 && south.fraction == 0.0;
            if (!(weights > 0.0) || !(any || onPost)) continue;
            line[c] = static_cast<float>(sum / weights);
            if (filled) (*filled)[static_cast<std::size_t>(row) * columns + c] = 1;
        }
    }
}

std::optional<Digest> VoidRaster::digest(const Lattice& lattice) const
{
    const TilingScheme& scheme = _plan.scheme;
    const auto range = [](double first, double last, double start, double extent, int posts)
    {
        const auto post = [&](double value)
        {
            return (value - start) / extent * (posts - 1);
        };
        return std::pair(std::clamp(static_cast<int>(std::floor(post(first))) - 1, 0, posts - 1),
                         std::clamp(static_cast<int>(std::ceil(post(last))) + 1, 0, posts - 1));
    };
    auto [west, east] = range(lattice.x0, lattice.x0 + lattice.dx * (lattice.columns - 1), scheme.west,
                              scheme.east - scheme.west, _columns);
    const auto [south, north] = range(lattice.y0, lattice.y0 + lattice.dy * (lattice.rows - 1), scheme.south,
                                      scheme.north - scheme.south, _rows);
    // Beside the seam a lattice goes on at the other end.
    if (scheme.wholeCircle() && (west == 0 || east == _columns - 1))
    {
        west = 0;
        east = _columns - 1;
    }
    const auto first = static_cast<std::size_t>(west), count = static_cast<std::size_t>(east - west + 1);
    std::vector<Post> posts(count);
    std::vector<float> heights(count), filled(count);
    ContentHash hash;
    bool any = false;
    for (int row = south; row <= north; ++row)
    {
        _posts.read(row, first, count, posts.data());
        if (std::none_of(posts.begin(), posts.end(), [](Post each) { return each == Post::FILLED; }))
            continue;
        any = true;
        _heights.read(row, first * sizeof(float), count * sizeof(float), heights.data());
        _filled.read(row, first * sizeof(float), count * sizeof(float), filled.data());
        hash.add(row - south).add(posts).add(heights).add(filled);
    }
    if (!any) return {};
    return hash.digest();
}

} // namespace osgGeoFX
