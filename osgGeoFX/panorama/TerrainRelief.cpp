// SPDX-License-Identifier: MIT
// SPDX-FileCopyrightText: 2026 the osgGeoFX authors
#include <osgGeoFX/panorama/TerrainRelief.h>

#include <osgGeoFX/effect/GlslFunctions.h>
#include <osgGeoFX/paging/TerrainInfo.h>
#include <osgGeoFX/paging/TileGuard.h>
#include <osgGeoFX/panorama/detail/CoverSampler.h>

#include <osg/Geometry>
#include <osg/NodeVisitor>
#include <osg/PagedLOD>
#include <osg/Transform>
#include <osg/TriangleIndexFunctor>
#include <osgDB/FileNameUtils>
#include <osgDB/ReadFile>

#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>

namespace osgGeoFX
{

namespace
{

struct Triangles
{
    std::vector<unsigned int> indices;
    void operator()(unsigned int a, unsigned int b, unsigned int c)
    {
        for (const unsigned int index : {a, b, c})
            indices.push_back(index);
    }
};

/// A geometry's ground: places of the extent with heights, and where the cover tells of them.
struct Patch
{
    std::vector<osg::Vec3d> places;
    std::vector<unsigned int> indices;
    osg::ref_ptr<const osg::Vec2Array> texels;
    std::optional<CoverSampler> cover;
};

/// Gathers the ground of a terrain. Of a database of the kit it reads tiles down to a level.
class Gatherer : public osg::NodeVisitor
{
public:
    Gatherer(const osg::EllipsoidModel* ellipsoid, const TerrainInfo* info, int cells,
             osg::ref_ptr<osgDB::Options> reading)
        : osg::NodeVisitor(TRAVERSE_ACTIVE_CHILDREN), _ellipsoid(ellipsoid), _info(info), _cells(cells),
          _reading(std::move(reading))
    {
        setNodeMaskOverride(~0u);
        if (info && info->geocentric) _middle = 0.5 * (info->west + info->east);
    }

    void apply(osg::LOD& node) override
    {
        const osg::Transform* coarse = TileInfo::coarseOf(node);
        if (!coarse)
        {
            // The finest child that is there.
            for (unsigned int i = node.getNumChildren(); i-- > 0;)
            {
                if (node.getChild(i)->getBound().valid())
                {
                    node.getChild(i)->accept(*this);
                    return;
                }
            }
            return;
        }
        const std::optional<TileInfo> tile = TileInfo::read(*coarse);
        const auto* paged = dynamic_cast<const osg::PagedLOD*>(&node);
        if (tile && paged && paged->getNumFileNames() > 1 && (tile->cells << tile->level) < _cells)
        {
            const std::string& file = paged->getFileName(1);
            const osg::ref_ptr<osg::Node> finer = osgDB::readRefNodeFile(
                paged->getDatabasePath().empty() ? file : osgDB::concatPaths(paged->getDatabasePath(), file),
                _reading.get());
            if (finer)
            {
                finer->accept(*this);
                return;
            }
        }
        node.getChild(0)->accept(*this);
    }

    void apply(osg::Transform& transform) override
    {
        // Skies and the like follow the eye; panels lie on the screen.
        if (transform.getReferenceFrame() != osg::Transform::RELATIVE_RF) return;
        if (!TileInfo::isTile(transform))
        {
            traverse(transform);
            return;
        }
        _ground = TileInfo::ground(transform);
        if (_ground)
        {
            osg::NodePath path = getNodePath();
            add(*_ground, osg::computeLocalToWorld(path), TileInfo::firstMesh(transform));
        }
    }

    void apply(osg::Geometry& geometry) override
    {
        if (_info) return; // Whatever stands on the ground.
        osg::NodePath path = getNodePath();
        add(geometry, osg::computeLocalToWorld(path), &geometry);
    }

    std::vector<Patch> patches;

private:
    void add(const osg::Geometry& geometry, const osg::Matrixd& toWorld, const osg::Geometry* covered)
    {
        const auto* vertices = dynamic_cast<const osg::Vec3Array*>(geometry.getVertexArray());
        if (!vertices) return;
        Patch patch;
        patch.places.reserve(vertices->size());
        for (const osg::Vec3& vertex : *vertices)
            patch.places.push_back(placeOf(osg::Vec3d(vertex) * toWorld));
        osg::TriangleIndexFunctor<Triangles> triangles;
        geometry.accept(triangles);
        for (const unsigned int index : triangles.indices)
            if (index >= patch.places.size()) return;
        patch.indices = std::move(triangles.indices);
        const auto* texels = dynamic_cast<const osg::Vec2Array*>(geometry.getTexCoordArray(0));
        if (covered && texels && texels->size() >= patch.places.size())
        {
            const CoverSampler cover(*covered);
            if (cover.valid())
            {
                patch.cover = cover;
                patch.texels = texels;
            }
        }
        patches.push_back(std::move(patch));
    }

    osg::Vec3d placeOf(const osg::Vec3d& world)
    {
        if (!_ellipsoid) return world;
        double latitude = 0.0, longitude = 0.0, height = 0.0;
        _ellipsoid->convertXYZToLatLongHeight(world.x(), world.y(), world.z(), latitude, longitude, height);
        const double degrees = osg::RadiansToDegrees(longitude);
        if (!_middle) _middle = degrees;
        return {*_middle + std::remainder(degrees - *_middle, 360.0), osg::RadiansToDegrees(latitude),
                height};
    }

    osg::ref_ptr<const osg::EllipsoidModel> _ellipsoid;
    const TerrainInfo* _info;
    int _cells;
    osg::ref_ptr<osgDB::Options> _reading; ///< of tiles
    std::optional<double> _middle;
    osg::ref_ptr<osg::Geometry> _ground;
};

void rasterise(const Patch& patch, TerrainRelief& relief)
{
    const double wide = relief.columns / (relief.east - relief.west);
    const double high = relief.rows / (relief.north - relief.south);
    const auto cellsFrom = [](double a, double b, double c, int count, int& first, int& last)
    {
        first = static_cast<int>(std::ceil(std::clamp(std::min({a, b, c}) - 0.5, 0.0, count - 1.0)));
        last = static_cast<int>(std::floor(std::clamp(std::max({a, b, c}) - 0.5, -1.0, count - 1.0)));
    };
    for (std::size_t i = 0; i + 2 < patch.indices.size(); i += 3)
    {
        osg::Vec3d corner[3];
        for (std::size_t k = 0; k < 3; ++k)
        {
            const osg::Vec3d& place = patch.places[patch.indices[i + k]];
            corner[k].set((place.x() - relief.west) * wide, (place.y() - relief.south) * high, place.z());
        }
        int left = 0, right = 0, bottom = 0, top = 0;
        cellsFrom(corner[0].x(), corner[1].x(), corner[2].x(), relief.columns, left, right);
        cellsFrom(corner[0].y(), corner[1].y(), corner[2].y(), relief.rows, bottom, top);
        const osg::Vec3d a = corner[1] - corner[0], b = corner[2] - corner[0];
        const double area = a.x() * b.y() - a.y() * b.x();
        if (!(std::abs(area) > 1e-12)) continue; // A wall.
        for (int row = bottom; row <= top; ++row)
        {
            for (int column = left; column <= right; ++column)
            {
                const osg::Vec3d p = osg::Vec3d(column + 0.5, row + 0.5, 0.0) - corner[0];
                const double u = (p.x() * b.y() - p.y() * b.x()) / area;
                const double v = (a.x() * p.y() - a.y() * p.x()) / area;
                if (u < -1e-9 || v < -1e-9 || u + v > 1.0 + 1e-9) continue;
                const auto height = static_cast<float>(corner[0].z() + u * a.z() + v * b.z());
                float& known = relief.heights[relief.index(column, row)];
                if (known >= height) continue; // Of what lies above each other, the highest is seen.
                known = height;
                bool wet = height <= 0.0f;
                if (patch.cover)
                {
                    const auto texel = [&](std::size_t k)
                    {
                        return (*patch.texels)[patch.indices[i + k]];
                    };
                    const osg::Vec2 at = texel(0) + (texel(1) - texel(0)) * static_cast<float>(u) +
                                         (texel(2) - texel(0)) * static_cast<float>(v);
                    const glsl::Rgba cover =
                        patch.cover->at(static_cast<double>(at.x()), static_cast<double>(at.y()));
                    if (glsl::geofx_coverKnown(cover)) wet = glsl::geofx_coverOf(cover).shore > 0.0;
                }
                relief.water[relief.index(column, row)] = wet ? 1 : 0;
            }
        }
    }
}

} // namespace

std::optional<TerrainRelief> TerrainRelief::read(const osg::Node& terrain,
                                                 const osg::EllipsoidModel* ellipsoid, int cells,
                                                 std::string& error)
{
    error.clear();
    const std::optional<TerrainInfo> info = TerrainInfo::read(&terrain, error);
    if (!info && !error.empty()) return std::nullopt;
    const osg::ref_ptr<const osg::EllipsoidModel> ours = new osg::EllipsoidModel;
    if (info) ellipsoid = info->geocentric ? ours.get() : nullptr;
    cells = std::clamp(cells, 16, 4096);

    Gatherer gatherer(ellipsoid, info ? &*info : nullptr, cells, TileGuard::readingOptions(terrain));
    const_cast<osg::Node&>(info ? *info->root : terrain).accept(gatherer);
    TerrainRelief relief;
    relief.geocentric = ellipsoid != nullptr;
    if (info)
    {
        relief.west = info->west;
        relief.south = info->south;
        relief.east = info->east;
        relief.north = info->north;
    }
    else
    {
        relief.west = relief.south = HUGE_VAL;
        relief.east = relief.north = -HUGE_VAL;
        for (const Patch& patch : gatherer.patches)
        {
            for (const osg::Vec3d& place : patch.places)
            {
                relief.west = std::min(relief.west, place.x());
                relief.east = std::max(relief.east, place.x());
                relief.south = std::min(relief.south, place.y());
                relief.north = std::max(relief.north, place.y());
            }
        }
    }
    if (!(relief.east > relief.west && relief.north > relief.south))
    {
        error = "The scene has no ground that could be shown; load a terrain first.";
        return std::nullopt;
    }
    const osg::Vec2d size = relief.size();
    const double cell = std::max(size.x(), size.y()) / cells;
    relief.columns = std::clamp(static_cast<int>(std::lround(size.x() / cell)), 4, cells);
    relief.rows = std::clamp(static_cast<int>(std::lround(size.y() / cell)), 4, cells);
    const std::size_t count =
        static_cast<std::size_t>(relief.columns) * static_cast<std::size_t>(relief.rows);
    relief.heights.assign(count, std::numeric_limits<float>::quiet_NaN());
    relief.water.assign(count, 0);
    for (const Patch& patch : gatherer.patches)
        rasterise(patch, relief);
    if (std::all_of(relief.heights.begin(), relief.heights.end(),
                    [](float height) { return std::isnan(height); }))
    {
        error = "The scene has no ground that could be shown; load a terrain first.";
        return std::nullopt;
    }
    return relief;
}

osg::Vec2d TerrainRelief::metre(double latitude) const
{
    if (!geocentric) return {1.0, 1.0};
    const double degree = osg::RadiansToDegrees(1.0 / osg::WGS_84_RADIUS_EQUATOR);
    return {degree / std::max(std::cos(osg::DegreesToRadians(latitude)), 0.01), degree};
}

osg::Vec2d TerrainRelief::size() const
{
    const osg::Vec2d unit = metre(0.5 * (south + north));
    return {(east - west) / unit.x(), (north - south) / unit.y()};
}

double TerrainRelief::heightAt(double x, double y) const
{
    if (geocentric && x < west) x += 360.0;
    if (geocentric && x > east) x -= 360.0;
    const double column = std::floor((x - west) / (east - west) * columns);
    const double row = std::floor((y - south) / (north - south) * rows);
    if (!(column >= 0.0 && column < columns && row >= 0.0 && row < rows))
        return std::numeric_limits<double>::quiet_NaN();
    return static_cast<double>(heights[index(static_cast<int>(column), static_cast<int>(row))]);
}

TerrainRelief TerrainRelief::coarser(int factor) const
{
    TerrainRelief result = *this;
    result.columns = std::max((columns + factor - 1) / factor, 1);
    result.rows = std::max((rows + factor - 1) / factor, 1);
    // Whole blocks, so the extent may grow by a part of one.
    result.east = west + (east - west) * (result.columns * factor) / columns;
    result.north = south + (north - south) * (result.rows * factor) / rows;
    const std::size_t count =
        static_cast<std::size_t>(result.columns) * static_cast<std::size_t>(result.rows);
    result.heights.assign(count, std::numeric_limits<float>::quiet_NaN());
    result.water.assign(count, 0);
    for (int row = 0; row < result.rows; ++row)
    {
        for (int column = 0; column < result.columns; ++column)
        {
            float& highest = result.heights[result.index(column, row)];
            int wet = 0, known = 0;
            for (int y = row * factor; y < std::min((row + 1) * factor, rows); ++y)
            {
                for (int x = column * factor; x < std::min((column + 1) * factor, columns); ++x)
                {
                    const float height = heights[index(x, y)];
                    if (std::isnan(height)) continue;
                    ++known;
                    wet += water[index(x, y)];
                    if (!(highest >= height)) highest = height;
                }
            }
            result.water[result.index(column, row)] = 2 * wet > known ? 1 : 0;
        }
    }
    return result;
}

} // namespace osgGeoFX
