// SPDX-License-Identifier: MIT
// SPDX-FileCopyrightText: 2026 the osgGeoFX authors
#include <osgGeoFX/panorama/detail/EdgeMap.h>

#include <osgGeoFX/effect/GlslFunctions.h>
#include <osgGeoFX/panorama/detail/CoverSampler.h>
#include <osgGeoFX/panorama/detail/EdgeDistances.h>

#include <osg/CoordinateSystemNode>
#include <osg/Geometry>
#include <osg/LOD>
#include <osg/MatrixTransform>
#include <osg/NodeVisitor>
#include <osg/TriangleIndexFunctor>

#include <algorithm>
#include <cmath>
#include <iterator>
#include <vector>

namespace osgGeoFX
{

namespace
{

/// Cells along each side of the extent, around it, and in all.
constexpr int within = 256, around = 64, whole = within + 2 * around;
/// Water that lies higher than this share of the relief, or than as many metres, is no sea: heights may stand above the ellipsoid.
constexpr double seaShare = 0.02, seaHeight = 10.0;

/// Holes within the data that are smaller than this share of it are gaps.
constexpr double largestGap = 0.02;
/// Behind land the sea may show from so many cells on.
constexpr double landCells = 3.0;
/// The land along the border: cells that are so far from it, not the last ones, which are not drawn in a picture of all of it; in blocks
/// of so many, which count a quarter at so many.
constexpr double besideFirst = 4.0, besideLast = 14.0;
constexpr int blockCells = 8;
constexpr double farCells = 16.0;
/// Most of its mountains are lower than so many standard deviations above the mean.
constexpr double summits = 1.2;

enum class Cell : unsigned char
{
    HOLE,
    GAP,
    WET_HOLE,
    LAND,
    WATER
};

/// The coarsest tile's ground, and where it lies.
class FindTile : public osg::NodeVisitor
{
public:
    FindTile() : osg::NodeVisitor(TRAVERSE_ALL_CHILDREN) { setNodeMaskOverride(~0u); }

    void apply(osg::Transform& transform) override
    {
        if (geometry) return;
        const std::optional<TileInfo> info = TileInfo::read(transform);
        if (!info || info->level != 0)
        {
            traverse(transform);
            return;
        }
        transform.computeLocalToWorldMatrix(toWorld, this);
        geometry = TileInfo::ground(transform);
    }
    void apply(osg::LOD& node) override
    {
        // Finer tiles come later; they need not be looked at.
        if (!geometry && node.getNumChildren() > 0) node.getChild(0)->accept(*this);
    }

    osg::ref_ptr<osg::Geometry> geometry;
    osg::Matrixd toWorld;
};

struct Triangles
{
    std::vector<unsigned int> indices;
    void operator()(unsigned int a, unsigned int b, unsigned int c)
    {
        for (const unsigned int index : {a, b, c})
            indices.push_back(index);
    }
};

/// How a texture's coordinate runs along the extent, from its two outermost vertices.
struct Line
{
    double low = HUGE_VAL, high = -HUGE_VAL, atLow = 0.0, atHigh = 1.0;
    void add(double place, double coordinate)
    {
        if (place < low) low = place, atLow = coordinate;
        if (place > high) high = place, atHigh = coordinate;
    }
    double at(double place) const
    {
        return high > low ? atLow + (atHigh - atLow) * (place - low) / (high - low) : atLow;
    }
};

/// What is known of the cells of the extent.
struct Extent
{
    std::vector<Cell> cells = std::vector<Cell>(std::size_t{within} * within, Cell::HOLE);
    std::vector<float> heights = std::vector<float>(std::size_t{within} * within, NAN);

    static std::size_t index(int column, int row)
    {
        return static_cast<std::size_t>(row) * within + static_cast<std::size_t>(column);
    }

    void rasterise(const osg::Vec3d (&corners)[3])
    {
        const auto cellsFrom = [](double a, double b, double c, int& first, int& last)
        {
            first = std::max(0, static_cast<int>(std::ceil(std::min({a, b, c}) * within - 0.5)));
            last = std::min(within - 1, static_cast<int>(std::floor(std::max({a, b, c}) * within - 0.5)));
        };
        int left = 0, right = 0, bottom = 0, top = 0;
        cellsFrom(corners[0].x(), corners[1].x(), corners[2].x(), left, right);
        cellsFrom(corners[0].y(), corners[1].y(), corners[2].y(), bottom, top);
        const osg::Vec3d a = corners[1] - corners[0], b = corners[2] - corners[0];
        const double area = a.x() * b.y() - a.y() * b.x();
        if (std::abs(area) < 1e-15) return; // a wall of the skirt
        for (int row = bottom; row <= top; ++row)
        {
            for (int column = left; column <= right; ++column)
            {
                const osg::Vec3d p =
                    osg::Vec3d((column + 0.5) / within, (row + 0.5) / within, 0.0) - corners[0];
                const double u = (p.x() * b.y() - p.y() * b.x()) / area;
                const double v = (a.x() * p.y() - a.y() * p.x()) / area;
                if (u < -1e-9 || v < -1e-9 || u + v > 1.0 + 1e-9) continue;
                heights[index(column, row)] = static_cast<float>(corners[0].z() + u * a.z() + v * b.z());
            }
        }
    }

    /// Calls back with the cells of each area that hangs together of those of a kind.
    template<class Kind, class Action>
    void forAreas(const Kind& kind, const Action& action) const
    {
        std::vector<char> seen(cells.size(), 0);
        std::vector<std::size_t> area;
        for (std::size_t first = 0; first < cells.size(); ++first)
        {
            if (seen[first] || !kind(cells[first])) continue;
            area.assign(1, first);
            seen[first] = 1;
            for (std::size_t next = 0; next < area.size(); ++next)
            {
                const std::size_t cell = area[next], column = cell % within, row = cell / within;
                const auto add = [&](bool there, std::size_t neighbour)
                {
                    if (!there || seen[neighbour] || !kind(cells[neighbour])) return;
                    seen[neighbour] = 1;
                    area.push_back(neighbour);
                };
                add(column > 0, cell - 1);
                add(column + 1 < within, cell + 1);
                add(row > 0, cell - within);
                add(row + 1 < within, cell + within);
            }
            action(area);
        }
    }

    /// Water that is sea stays; that of lakes and rivers becomes land, or a hole.
    void keepSea(double highest)
    {
        std::vector<std::size_t> others;
        forAreas([](Cell cell) { return cell == Cell::WATER || cell == Cell::WET_HOLE; },
                 [&](const std::vector<std::size_t>& area)
                 {
                     std::size_t low = 0, known = 0;
                     for (const std::size_t cell : area)
                     {
                         if (std::isnan(heights[cell])) continue;
                         ++known;
                         low += static_cast<double>(heights[cell]) <= highest ? 1 : 0;
                     }
                     if (2 * low < known) others.insert(others.end(), area.begin(), area.end());
                 });
        for (const std::size_t cell : others)
            cells[cell] = cells[cell] == Cell::WATER ? Cell::LAND : Cell::HOLE;
    }

    /// The land does not run out towards a gap in its middle: what lies behind is seen through it.
    void tellGaps()
    {
        std::vector<std::size_t> gaps;
        forAreas([](Cell cell) { return cell == Cell::HOLE; },
                 [&](const std::vector<std::size_t>& area)
                 {
                     const bool small = static_cast<double>(area.size()) < largestGap * within * within;
                     const auto onBorder = [](std::size_t cell)
                     {
                         const std::size_t column = cell % within, row = cell / within;
                         return column == 0 || row == 0 || column + 1 == within || row + 1 == within;
                     };
                     if (small && std::none_of(area.begin(), area.end(), onBorder))
                         gaps.insert(gaps.end(), area.begin(), area.end());
                 });
        for (const std::size_t cell : gaps)
            cells[cell] = Cell::GAP;
    }
};

/// What lies beyond the border, by what it is along it.
class Border
{
public:
    explicit Border(const Extent& extent)
    {
        _sums.push_back(0);
        for (int turn = 0; turn < 3; ++turn)
        {
            for (int i = 0; i < length; ++i)
            {
                const int side = i / within, along = i % within;
                const int columns[] = {along, within - 1, within - 1 - along, 0};
                const int rows[] = {0, along, within - 1, within - 1 - along};
                const Cell cell = extent.cells[Extent::index(columns[side], rows[side])];
                const bool water = cell == Cell::WATER || cell == Cell::WET_HOLE;
                _sums.push_back(_sums.back() + (water ? 1 : 0));
            }
        }
    }

    /// Of a cell outside of the extent, in cells of it: the farther off, the more of the border says what is there, so that a bay
    /// closes.
    bool sea(int column, int row) const
    {
        const int nearX = std::clamp(column, 0, within - 1), nearY = std::clamp(row, 0, within - 1);
        const double away = std::hypot(static_cast<double>(column - nearX), static_cast<double>(row - nearY));
        const int reach = std::min(static_cast<int>(2.0 * away), length / 2 - 1);
        const int place = row < 0            ? nearX
                          : column >= within ? within + nearY
                          : row >= within    ? 3 * within - 1 - nearX
                                             : 4 * within - 1 - nearY;
        const int first = length + place - reach, last = length + place + reach + 1;
        return 2 * (_sums[static_cast<std::size_t>(last)] - _sums[static_cast<std::size_t>(first)]) >
               last - first;
    }
    /// The share of it that is sea.
    double share() const { return static_cast<double>(_sums[length]) / length; }

private:
    static constexpr int length = 4 * within;
    std::vector<int> _sums; ///< of the border's cells that are sea, three times around
};

/// How high the land along the border lies, smoothed along it and in the same way away from it, so that it tells of none of its
/// mountains; 0 where there is none. `distances`: to where what is known ends, in cells.
std::vector<float> borderHeights(const Extent& extent, const std::vector<float>& distances)
{
    constexpr int blocks = whole / blockCells;
    struct Block
    {
        double x = 0.0, y = 0.0, height = 0.0, square = 0.0, count = 0.0;
    };
    std::vector<Block> all(std::size_t{blocks} * blocks), seeds;
    for (int row = 0; row < within; ++row)
    {
        for (int column = 0; column < within; ++column)
        {
            const std::size_t cell = Extent::index(column, row);
            const int x = column + around, y = row + around;
            const auto away = static_cast<double>(
                distances[static_cast<std::size_t>(y) * whole + static_cast<std::size_t>(x)]);
            if (extent.cells[cell] != Cell::LAND || away < besideFirst || away > besideLast) continue;
            Block& block = all[static_cast<std::size_t>(y / blockCells) * blocks +
                               static_cast<std::size_t>(x / blockCells)];
            block.x += x;
            block.y += y;
            const auto height = static_cast<double>(extent.heights[cell]);
            block.height += height;
            block.square += height * height;
            block.count += 1.0;
        }
    }
    std::copy_if(all.begin(), all.end(), std::back_inserter(seeds),
                 [](const Block& block) { return block.count > 0.0; });
    // Between the blocks' corners it changes little.
    constexpr int corners = blocks + 1;
    std::vector<double> coarse(std::size_t{corners} * corners, 0.0);
    for (int row = 0; row < corners; ++row)
    {
        for (int column = 0; column < corners; ++column)
        {
            double sum = 0.0, squares = 0.0, weights = 0.0;
            for (const Block& seed : seeds)
            {
                const double x = seed.x / seed.count - column * blockCells;
                const double y = seed.y / seed.count - row * blockCells;
                const double far = x * x + y * y + farCells * farCells;
                const double weight = 1.0 / (far * far);
                sum += weight * seed.height;
                squares += weight * seed.square;
                weights += weight * seed.count;
            }
            if (!(weights > 0.0)) continue;
            const double mean = sum / weights;
            const double spread = std::sqrt(std::max(squares / weights - mean * mean, 0.0));
            coarse[static_cast<std::size_t>(row) * corners + static_cast<std::size_t>(column)] =
                mean + summits * spread;
        }
    }
    std::vector<float> heights(std::size_t{whole} * whole);
    for (int row = 0; row < whole; ++row)
    {
        for (int column = 0; column < whole; ++column)
        {
            const double x = (column + 0.5) / blockCells, y = (row + 0.5) / blockCells;
            const auto left = static_cast<std::size_t>(x), low = static_cast<std::size_t>(y);
            const double u = x - static_cast<double>(left), v = y - static_cast<double>(low);
            const double* at = &coarse[low * corners + left];
            heights[static_cast<std::size_t>(row) * whole + static_cast<std::size_t>(column)] =
                static_cast<float>((1.0 - v) * ((1.0 - u) * at[0] + u * at[1]) +
                                   v * ((1.0 - u) * at[corners] + u * at[corners + 1]));
        }
    }
    return heights;
}

} // namespace

EdgeMap::~EdgeMap() = default;

double EdgeMap::inner()
{
    return static_cast<double>(within) / whole;
}

double EdgeMap::widest()
{
    return 0.2;
}

osg::ref_ptr<const EdgeMap> EdgeMap::make(const osg::Node& root, const TerrainInfo& info,
                                          unsigned int coverUnit, bool seaGoesOn)
{
    if (!(info.east > info.west && info.north > info.south)) return nullptr;
    osg::ref_ptr<EdgeMap> map = new EdgeMap;
    map->_info = info;
    // Nothing is missing of the whole globe.
    if (info.geocentric && info.east - info.west > 359.0) return map;
    FindTile finder;
    const_cast<osg::Node&>(root).accept(finder);
    if (!finder.geometry) return nullptr;
    const osg::Geometry& tile = *finder.geometry;
    const auto* vertices = dynamic_cast<const osg::Vec3Array*>(tile.getVertexArray());
    const auto* texels = dynamic_cast<const osg::Vec2Array*>(tile.getTexCoordArray(0));
    const CoverSampler sampler(tile, coverUnit);
    if (!vertices || !texels || texels->size() < vertices->size() || !sampler.valid()) return nullptr;

    // The tile's vertices in the extent, 0 to 1.
    const osg::EllipsoidModel globe;
    std::vector<osg::Vec3d> places;
    Line across, along;
    for (std::size_t i = 0; i < vertices->size(); ++i)
    {
        osg::Vec3d place = osg::Vec3d((*vertices)[i]) * finder.toWorld;
        if (info.geocentric)
        {
            double latitude = 0.0, longitude = 0.0, height = 0.0;
            globe.convertXYZToLatLongHeight(place.x(), place.y(), place.z(), latitude, longitude, height);
            const double middle = 0.5 * (info.west + info.east);
            const double degrees = osg::RadiansToDegrees(longitude);
            place.set(middle + std::remainder(degrees - middle, 360.0), osg::RadiansToDegrees(latitude),
                      height);
        }
        place.x() = (place.x() - info.west) / (info.east - info.west);
        place.y() = (place.y() - info.south) / (info.north - info.south);
        places.push_back(place);
        across.add(place.x(), static_cast<double>((*texels)[i].x()));
        along.add(place.y(), static_cast<double>((*texels)[i].y()));
    }
    osg::TriangleIndexFunctor<Triangles> triangles;
    tile.accept(triangles);
    Extent extent;
    for (std::size_t i = 0; i + 2 < triangles.indices.size(); i += 3)
    {
        if (std::max({triangles.indices[i], triangles.indices[i + 1], triangles.indices[i + 2]}) >=
            places.size())
            continue;
        extent.rasterise({places[triangles.indices[i]], places[triangles.indices[i + 1]],
                          places[triangles.indices[i + 2]]});
    }
    for (int row = 0; row < within; ++row)
    {
        for (int column = 0; column < within; ++column)
        {
            const glsl::Rgba texel =
                sampler.at(across.at((column + 0.5) / within), along.at((row + 0.5) / within));
            const bool wet = glsl::geofx_coverKnown(texel) && glsl::geofx_coverOf(texel).shore > 0.0;
            const std::size_t cell = Extent::index(column, row);
            const bool data = !std::isnan(extent.heights[cell]);
            extent.cells[cell] =
                data ? (wet ? Cell::WATER : Cell::LAND) : (wet ? Cell::WET_HOLE : Cell::HOLE);
        }
    }
    extent.keepSea(std::max(seaHeight, seaShare * (info.maxHeight - info.minHeight)));
    extent.tellGaps();

    // What is not known: beyond land, and holes. Where there is no ground, land does not count, either.
    std::vector<char> gone(std::size_t{whole} * whole), land(gone.size());
    const Border border(extent);
    for (int row = 0; row < whole; ++row)
    {
        for (int column = 0; column < whole; ++column)
        {
            const int x = column - around, y = row - around;
            const bool inside = x >= 0 && y >= 0 && x < within && y < within;
            const Cell cell = inside ? extent.cells[Extent::index(x, y)] : Cell::HOLE;
            const bool open = !inside && seaGoesOn && border.sea(x, y);
            const std::size_t at = static_cast<std::size_t>(row) * whole + static_cast<std::size_t>(column);
            gone[at] = (inside ? cell != Cell::HOLE : open) ? 0 : 1;
            land[at] = inside && (cell == Cell::LAND || cell == Cell::GAP) ? 1 : 0;
            map->_ends = map->_ends || gone[at];
        }
    }
    map->_island = seaGoesOn && border.share() > 0.5;
    if (!map->_ends) return map;
    double sizeX = info.east - info.west, sizeY = info.north - info.south;
    if (info.geocentric)
    {
        const double middle = osg::DegreesToRadians(0.5 * (info.south + info.north));
        sizeX *= osg::DegreesToRadians(1.0) * globe.getRadiusEquator() * std::max(std::cos(middle), 0.01);
        sizeY *= osg::DegreesToRadians(1.0) * globe.getRadiusEquator();
    }
    map->_size = std::min(sizeX, sizeY);
    const double stepX = sizeX / within, stepY = sizeY / within;
    const std::vector<float> ground = signedDistances(gone, whole, stepX, stepY);
    const std::vector<float> shores = signedDistances(land, whole, stepX, stepY);
    std::vector<float> inCells(ground);
    for (float& distance : inCells)
        distance /= static_cast<float>(0.5 * (stepX + stepY));
    const std::vector<float> heights = borderHeights(extent, inCells);
    // Land is told from what lies behind it at once, however wide the land runs out.
    const auto steep = static_cast<float>(widest() * within / landCells);
    map->_image = new osg::Image;
    map->_image->allocateImage(whole, whole, 1, GL_RGB, GL_FLOAT);
    map->_image->setInternalTextureFormat(GL_RGB32F);
    auto* values = reinterpret_cast<float*>(map->_image->data());
    for (std::size_t i = 0; i < ground.size(); ++i)
    {
        values[3 * i] = ground[i];
        values[3 * i + 1] = std::min(ground[i], steep * shores[i]);
        values[3 * i + 2] = heights[i];
    }
    map->_texture = new osg::Texture2D(map->_image);
    map->_texture->setInternalFormat(GL_RGB32F);
    map->_texture->setFilter(osg::Texture::MIN_FILTER, osg::Texture::LINEAR);
    map->_texture->setFilter(osg::Texture::MAG_FILTER, osg::Texture::LINEAR);
    map->_texture->setWrap(osg::Texture::WRAP_S, osg::Texture::CLAMP_TO_EDGE);
    map->_texture->setWrap(osg::Texture::WRAP_T, osg::Texture::CLAMP_TO_EDGE);
    map->_texture->setResizeNonPowerOfTwoHint(false);
    return map;
}

} // namespace osgGeoFX
