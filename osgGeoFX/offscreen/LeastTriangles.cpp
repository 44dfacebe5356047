// SPDX-License-Identifier: MIT
// SPDX-FileCopyrightText: 2026 the osgGeoFX authors
#include <osgGeoFX/offscreen/LeastTriangles.h>

#include <osgGeoFX/paging/TerrainInfo.h>
#include <osgGeoFX/paging/TileGuard.h>
#include <osgGeoFX/paging/TilePosts.h>

#include <osg/NodeVisitor>
#include <osg/PagedLOD>
#include <osg/Transform>
#include <osgDB/FileNameUtils>
#include <osgDB/ReadFile>

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <optional>

namespace osgGeoFX
{

namespace
{

/// A finest tile as its file has it.
struct FineTile
{
    TileInfo info;
    osg::Matrixd toWorld;
    TilePosts posts;
};

/// Collects the finest tiles of a file, and the names of the files below it.
class TileCollector : public osg::NodeVisitor
{
public:
    TileCollector() : osg::NodeVisitor(TRAVERSE_ALL_CHILDREN) { setNodeMaskOverride(~0u); }

    void apply(osg::PagedLOD& lod) override
    {
        const osg::Transform* coarse = TileInfo::coarseOf(lod);
        if (!coarse)
        {
            traverse(lod);
            return;
        }
        const std::string& file = lod.getFileName(1);
        files.push_back(lod.getDatabasePath().empty() ? file
                                                      : osgDB::concatPaths(lod.getDatabasePath(), file));
    }

    void apply(osg::Transform& transform) override
    {
        const std::optional<TileInfo> info = TileInfo::read(transform);
        if (!info)
        {
            traverse(transform);
            return;
        }
        const std::optional<TilePosts> posts = TilePosts::read(transform);
        if (!posts) return;
        osg::Matrixd toWorld;
        transform.computeLocalToWorldMatrix(toWorld, nullptr);
        tiles.push_back({*info, toWorld, *posts});
    }

    std::vector<FineTile> tiles;
    std::vector<std::string> files;
};

} // namespace

std::unique_ptr<LeastTriangles> LeastTriangles::read(const osg::Node& root, std::string& error)
{
    error.clear();
    const std::optional<TerrainInfo> terrain = TerrainInfo::read(&root, error);
    if (!terrain)
    {
        if (error.empty())
            error =
                "The scene has no terrain database of osggeofx_build, so the least number of triangles is "
                "not known; leave --least-triangles out.";
        return nullptr;
    }
    std::unique_ptr<LeastTriangles> result(new LeastTriangles);
    result->_geocentric = terrain->geocentric;
    TileCollector collector;
    const_cast<osg::Node&>(root).accept(collector);
    const osg::ref_ptr<osgDB::Options> reading = TileGuard::readingOptions(root);
    int cells = 0, level = 0;
    const float nowhere = std::numeric_limits<float>::quiet_NaN();
    for (;;)
    {
        for (const FineTile& tile : collector.tiles)
        {
            if (cells == 0)
            {
                cells = tile.info.cells;
                level = tile.info.level;
                result->_origin = tile.toWorld.getTrans();
                result->_side = (cells << level) + 1;
                result->_positions.assign(static_cast<std::size_t>(result->_side) *
                                              static_cast<std::size_t>(result->_side),
                                          osg::Vec3f(nowhere, nowhere, nowhere));
            }
            if (tile.info.cells != cells || tile.info.level != level)
            {
                error = "The terrain database has finest tiles of several sizes, so the least number of "
                        "triangles "
                        "is not known; build it again with this version.";
                return nullptr;
            }
            for (int row = 0; row <= cells; ++row)
                for (int column = 0; column <= cells; ++column)
                {
                    const osg::Vec3d& local = tile.posts.at(column, row);
                    if (std::isnan(local.x())) continue;
                    const osg::Vec3d world = local * tile.toWorld;
                    result
                        ->_positions[result->place(tile.info.x * cells + column, tile.info.y * cells + row)] =
                        world - result->_origin;
                }
        }
        if (collector.files.empty()) break;
        const std::string file = collector.files.back();
        collector.files.pop_back();
        collector.tiles.clear();
        const osg::ref_ptr<osg::Node> node = osgDB::readRefNodeFile(file, reading.get());
        if (!node)
        {
            error = file +
                    ": the tile cannot be read, so the least number of triangles is not known; build the "
                    "database again.";
            return nullptr;
        }
        node->accept(collector);
    }
    if (cells == 0)
    {
        error = "The terrain database has no ground at all; build it again.";
        return nullptr;
    }
    result->findEnd();
    result->gatherErrors();
    return result;
}

osg::Vec3d LeastTriangles::up(const osg::Vec3d& position) const
{
    if (!_geocentric) return {0.0, 0.0, 1.0};
    osg::Vec3d result = position + _origin;
    result.normalize();
    return result;
}

void LeastTriangles::findEnd()
{
    for (int row = 0; row < _side; ++row)
        for (int column = 0; column < _side; ++column)
            if (!std::isnan(_positions[place(column, row)].x()))
            {
                _lastColumn = std::max(_lastColumn, column);
                _lastRow = std::max(_lastRow, row);
            }
}

/// How far the middle of an edge lies above or below the straight line between its ends, metres.
float LeastTriangles::ownError(int column, int row, int alongColumns, int alongRows) const
{
    // The quadtree may reach beyond the terrain. No triangle of the least network has to.
    if (column + std::abs(alongColumns) > _lastColumn || row + std::abs(alongRows) > _lastRow) return 0.0f;
    const osg::Vec3d middle = _positions[place(column, row)];
    const osg::Vec3d a = _positions[place(column - alongColumns, row - alongRows)];
    const osg::Vec3d b = _positions[place(column + alongColumns, row + alongRows)];
    const int holes = std::isnan(middle.x()) + std::isnan(a.x()) + std::isnan(b.x());
    if (holes == 3) return 0.0f;
    // Borders of holes are followed sample by sample.
    if (holes > 0) return std::numeric_limits<float>::max();
    const osg::Vec3d sky = up(middle);
    const osg::Vec3d edge = b - a;
    // Meridians converge, so the middle is not quite half-way.
    const osg::Vec3d level = edge - sky * (edge * sky);
    const double share = level.length2() > 0.0 ? ((middle - a) * level) / level.length2() : 0.5;
    return static_cast<float>(std::abs((middle - a - edge * share) * sky));
}

void LeastTriangles::gatherErrors()
{
    const int last = _side - 1;
    _errors.assign(_positions.size(), 0.0f);
    const auto include = [&](float& target, int column, int row)
    {
        if (column >= 0 && row >= 0 && column <= last && row <= last)
            target = std::max(target, _errors[place(column, row)]);
    };
    for (int half = 1; half < last; half *= 2)
    {
        const int step = 2 * half, quarter = half / 2;
        for (int row = 0; row <= last; row += half)
            for (int column = (row / half) % 2 != 0 ? 0 : half; column <= last; column += step)
            {
                const bool alongX = (column / half) % 2 != 0;
                float error = ownError(column, row, alongX ? half : 0, alongX ? 0 : half);
                if (quarter > 0)
                    for (const int up : {-quarter, quarter})
                        for (const int across : {-quarter, quarter})
                            include(error, column + across, row + up);
                _errors[place(column, row)] = error;
            }
        for (int row = half; row <= last; row += step)
            for (int column = half; column <= last; column += step)
            {
                // The diagonals of neighbouring cells alternate.
                const bool main = ((column / step) + (row / step)) % 2 == 0;
                float error = ownError(column, row, main ? half : -half, half);
                include(error, column - half, row);
                include(error, column + half, row);
                include(error, column, row - half);
                include(error, column, row + half);
                _errors[place(column, row)] = error;
            }
    }
}

std::uint64_t LeastTriangles::count(const osg::Matrixd& view, const osg::Matrixd& projection,
                                    double pixelsPerRadian, double pixelError,
                                    const DeformationChain& chain) const
{
    const osg::Matrixd toEye = osg::Matrixd::translate(_origin) * view;
    std::uint64_t vertices = 0;
    for (int row = 0; row <= _lastRow; ++row)
        for (int column = 0; column <= _lastColumn; ++column)
        {
            const std::size_t here = place(column, row);
            const float error = _errors[here];
            if (!(error > 0.0f) || std::isnan(_positions[here].x())) continue;
            const osg::Vec3d eye = osg::Vec3d(_positions[here]) * toEye;
            const osg::Vec3d bent = chain.empty() ? eye : chain.deform(eye);
            const double distance =
                chain.empty() ? eye.length() : chain.lodDistance({eye, 0.0}, osg::Vec3d());
            if (static_cast<double>(error) * pixelsPerRadian <= pixelError * distance) continue;
            const osg::Vec4d clip = osg::Vec4d(bent, 1.0) * projection;
            if (clip.w() > 0.0 && std::abs(clip.x()) <= clip.w() && std::abs(clip.y()) <= clip.w())
                ++vertices;
        }
    return 2 * vertices;
}

} // namespace osgGeoFX
