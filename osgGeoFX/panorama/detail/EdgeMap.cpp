// SPDX-License-Identifier: MIT
// SPDX-FileCopyrightText: 2026 the osgGeoFX authors
#include <osgGeoFX/panorama/detail/EdgeMap.h>

#include <osgGeoFX/effect/GlslFunctions.h>
#include <osgGeoFX/panorama/detail/CoverSampler.h>
#include <osgGeoFX/panorama/detail/EdgeBorder.h>
#include <osgGeoFX/panorama/detail/EdgeDistances.h>

#include <osg/CoordinateSystemNode>
#include <osg/Geometry>
#include <osg/LOD>
#include <osg/MatrixTransform>
#include <osg/NodeVisitor>
#include <osg/TriangleIndexFunctor>

#include <algorithm>
#include <cmath>
#include <vector>

namespace osgGeoFX
{

namespace
{

constexpr int within = EdgeExtent::within, around = EdgeExtent::around, whole = EdgeExtent::whole;
/// Water that lies higher than this share of the relief, and higher than so many metres, is no sea. Sea level may be
/// above the ellipsoid.
constexpr double seaShare = 0.02, seaHeight = 10.0;
/// Behind land the sea may begin after so many cells.
constexpr double landCells = 3.0;

using Cell = EdgeExtent::Cell;

/// Finds the coarsest tile's ground and its place.
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
        // The first child is the coarse tile. Finer tiles need not be searched.
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

/// A texture coordinate along the extent, by the two outermost vertices.
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

/// The place of a position of the world in the extent, 0 to 1, and its height.
osg::Vec3d placeIn(const TerrainInfo& info, osg::Vec3d place)
{
    if (info.geocentric)
    {
        double latitude = 0.0, longitude = 0.0, height = 0.0;
        osg::EllipsoidModel().convertXYZToLatLongHeight(place.x(), place.y(), place.z(), latitude, longitude,
                                                        height);
        const double middle = 0.5 * (info.west + info.east);
        const double degrees = osg::RadiansToDegrees(longitude);
        place.set(middle + std::remainder(degrees - middle, 360.0), osg::RadiansToDegrees(latitude), height);
    }
    return {(place.x() - info.west) / (info.east - info.west),
            (place.y() - info.south) / (info.north - info.south), place.z()};
}

/// The size of the extent to the east and to the north, metres.
osg::Vec2d sizeOf(const TerrainInfo& info)
{
    const osg::Vec2d size(info.east - info.west, info.north - info.south);
    if (!info.geocentric) return size;
    const double degree = osg::DegreesToRadians(1.0) * osg::EllipsoidModel().getRadiusEquator();
    const double middle = osg::DegreesToRadians(0.5 * (info.south + info.north));
    return {size.x() * degree * std::max(std::cos(middle), 0.01), size.y() * degree};
}

/// Fills the extent from the coarsest tile. False if this tile cannot be read.
bool readTile(const osg::Node& root, const TerrainInfo& info, unsigned int coverUnit, EdgeExtent& extent)
{
    FindTile finder;
    const_cast<osg::Node&>(root).accept(finder);
    if (!finder.geometry) return false;
    const osg::Geometry& tile = *finder.geometry;
    const auto* vertices = dynamic_cast<const osg::Vec3Array*>(tile.getVertexArray());
    const auto* texels = dynamic_cast<const osg::Vec2Array*>(tile.getTexCoordArray(0));
    const CoverSampler sampler(tile, coverUnit);
    if (!vertices || !texels || texels->size() < vertices->size() || !sampler.valid()) return false;

    std::vector<osg::Vec3d> places;
    Line across, along;
    for (std::size_t i = 0; i < vertices->size(); ++i)
    {
        places.push_back(placeIn(info, osg::Vec3d((*vertices)[i]) * finder.toWorld));
        across.add(places.back().x(), static_cast<double>((*texels)[i].x()));
        along.add(places.back().y(), static_cast<double>((*texels)[i].y()));
    }
    osg::TriangleIndexFunctor<Triangles> triangles;
    tile.accept(triangles);
    for (std::size_t i = 0; i + 2 < triangles.indices.size(); i += 3)
    {
        if (std::max({triangles.indices[i], triangles.indices[i + 1], triangles.indices[i + 2]}) >=
            places.size())
            continue;
        extent.rasterise({places[triangles.indices[i]], places[triangles.indices[i + 1]],
                          places[triangles.indices[i + 2]]});
    }
    extent.tellCells(
        [&](double x, double y)
        {
            const glsl::Rgba texel = sampler.at(across.at(x), along.at(y));
            return glsl::geofx_coverKnown(texel) && glsl::geofx_coverOf(texel).shore > 0.0;
        });
    return true;
}

/// The cells that are not known: those beyond land, and holes. `land` is for places without ground, where land does
/// not count as known.
struct Known
{
    std::vector<char> gone = std::vector<char>(std::size_t{whole} * whole), land = gone;
    bool ends = false; ///< whether anything is unknown

    Known(const EdgeExtent& extent, const EdgeBorder& border, bool seaGoesOn)
    {
        for (int row = 0; row < whole; ++row)
        {
            for (int column = 0; column < whole; ++column)
            {
                const int x = column - around, y = row - around;
                const bool inside = x >= 0 && y >= 0 && x < within && y < within;
                const Cell cell = inside ? extent.cells[EdgeExtent::index(x, y)] : Cell::HOLE;
                const bool open = !inside && seaGoesOn && border.sea(x, y);
                const std::size_t at =
                    static_cast<std::size_t>(row) * whole + static_cast<std::size_t>(column);
                gone[at] = (inside ? cell != Cell::HOLE : open) ? 0 : 1;
                land[at] = inside && (cell == Cell::LAND || cell == Cell::GAP) ? 1 : 0;
                ends = ends || gone[at];
            }
        }
    }
};

osg::ref_ptr<osg::Texture2D> textureOf(osg::Image* image)
{
    osg::ref_ptr<osg::Texture2D> texture = new osg::Texture2D(image);
    texture->setInternalFormat(GL_RGB32F);
    texture->setFilter(osg::Texture::MIN_FILTER, osg::Texture::LINEAR);
    texture->setFilter(osg::Texture::MAG_FILTER, osg::Texture::LINEAR);
    texture->setWrap(osg::Texture::WRAP_S, osg::Texture::CLAMP_TO_EDGE);
    texture->setWrap(osg::Texture::WRAP_T, osg::Texture::CLAMP_TO_EDGE);
    texture->setResizeNonPowerOfTwoHint(false);
    return texture;
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
    // The whole globe has no edge.
    if (info.geocentric && info.east - info.west > 359.0) return map;
    EdgeExtent extent;
    if (!readTile(root, info, coverUnit, extent)) return nullptr;
    extent.keepSea(std::max(seaHeight, seaShare * (info.maxHeight - info.minHeight)));
    extent.tellGaps();
    const EdgeBorder border(extent);
    const Known known(extent, border, seaGoesOn);
    map->_ends = known.ends;
    map->_island = seaGoesOn && border.share() > 0.5;
    if (!map->_ends) return map;

    const osg::Vec2d size = sizeOf(info), step = size / within;
    map->_size = std::min(size.x(), size.y());
    const std::vector<float> ground = signedDistances(known.gone, whole, step.x(), step.y());
    const std::vector<float> shores = signedDistances(known.land, whole, step.x(), step.y());
    std::vector<float> inCells(ground);
    for (float& distance : inCells)
        distance /= static_cast<float>(0.5 * (step.x() + step.y()));
    const std::vector<float> heights = EdgeBorder::heights(extent, inCells);
    // Land differs from what lies behind it at once, however wide the land runs out.
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
    map->_texture = textureOf(map->_image);
    return map;
}

} // namespace osgGeoFX
