// SPDX-License-Identifier: MIT
// SPDX-FileCopyrightText: 2026 the osgGeoFX authors
#include <osgGeoFX/closeup/detail/ContourFence.h>

#include <algorithm>
#include <cmath>
#include <limits>

namespace osgGeoFX
{

namespace
{

constexpr double partLength = 0.02; ///< of the border, in halves of the smaller side
constexpr double longestPart = 0.1; ///< even on level ground, which a deformation may bend
constexpr double tolerance = 0.1;   ///< of a texel of the mask
constexpr double unknown = -std::numeric_limits<double>::infinity();

using Contour = std::vector<osg::Vec2d>;

/// The border's points and the heights of the ground below them. A grid over the region finds the points of a
/// triangle.
class Heights
{
public:
    Heights(const std::vector<Contour>& contours, const osg::Vec2d& half) : _half(half)
    {
        for (const auto& contour : contours)
        {
            for (const osg::Vec2d& place : contour)
            {
                _places.emplace_back(place.x() * half.x(), place.y() * half.y());
                _cells[cellOf(place.x()) + cellOf(place.y()) * side].push_back(_places.size() - 1);
            }
        }
        _heights.assign(_places.size(), unknown);
    }

    /// Adds all triangles of a geometry. The highest one counts at each point. Upright triangles, such as skirts, do
    /// not count.
    void add(const osg::Geometry& geometry, const osg::Matrixd& toRegion)
    {
        // The places of instances are not known here.
        if (DrawableTriangles::instanced(geometry)) return;
        const DrawableTriangles mesh(geometry);
        _vertices.resize(mesh.positions().size());
        std::transform(mesh.positions().begin(), mesh.positions().end(), _vertices.begin(),
                       [&](const osg::Vec3d& vertex) { return vertex * toRegion; });
        const std::vector<unsigned int>& corners = mesh.corners();
        for (std::size_t i = 0; i < corners.size(); i += 3)
            addTriangle(corners[i], corners[i + 1], corners[i + 2]);
    }

    bool anyKnown() const
    {
        return std::any_of(_heights.begin(), _heights.end(), [](double height) { return height > unknown; });
    }
    double height(std::size_t point) const { return _heights[point]; }

private:
    static constexpr std::size_t side = 48;

    static std::size_t cellOf(double place)
    {
        const double cell = (place + 1.0) / 2.0 * static_cast<double>(side);
        return static_cast<std::size_t>(std::clamp(cell, 0.0, static_cast<double>(side - 1)));
    }

    void addTriangle(unsigned int i, unsigned int j, unsigned int k)
    {
        const osg::Vec3d& a = _vertices[i];
        const osg::Vec3d& b = _vertices[j];
        const osg::Vec3d& c = _vertices[k];
        const double area = (b.x() - a.x()) * (c.y() - a.y()) - (c.x() - a.x()) * (b.y() - a.y());
        const double lowX = std::min({a.x(), b.x(), c.x()}) / _half.x();
        const double highX = std::max({a.x(), b.x(), c.x()}) / _half.x();
        const double lowY = std::min({a.y(), b.y(), c.y()}) / _half.y();
        const double highY = std::max({a.y(), b.y(), c.y()}) / _half.y();
        if (area == 0.0 || !(lowX <= 1.0 && highX >= -1.0 && lowY <= 1.0 && highY >= -1.0)) return;
        // Rounding makes skirts lean a little.
        if (std::abs(area) < 1e-3 * (c - a).length() * (b - a).length()) return;
        for (std::size_t y = cellOf(lowY); y <= cellOf(highY); ++y)
        {
            for (std::size_t x = cellOf(lowX); x <= cellOf(highX); ++x)
            {
                for (const std::size_t point : _cells[x + y * side])
                    meet(point, a, b, c, area);
            }
        }
    }

    void meet(std::size_t point, const osg::Vec3d& a, const osg::Vec3d& b, const osg::Vec3d& c, double area)
    {
        const osg::Vec2d& p = _places[point];
        const double u = ((p.x() - a.x()) * (c.y() - a.y()) - (c.x() - a.x()) * (p.y() - a.y())) / area;
        const double v = ((b.x() - a.x()) * (p.y() - a.y()) - (p.x() - a.x()) * (b.y() - a.y())) / area;
        constexpr double slack = -1e-6;
        if (u < slack || v < slack || u + v > 1.0 - slack) return;
        _heights[point] = std::max(_heights[point], a.z() + u * (b.z() - a.z()) + v * (c.z() - a.z()));
    }

    osg::Vec2d _half;
    std::vector<osg::Vec2d> _places;
    std::vector<double> _heights;
    std::vector<std::size_t> _cells[side * side];
    std::vector<osg::Vec3d> _vertices;
};

/// Chooses the points of a closed line on the ground that a simpler line keeps. The simpler line is nowhere farther
/// from it than `deviation`, and its parts are no longer than `longest`. Points without a height stay. The mask's own
/// line has points at each texel.
std::vector<std::size_t> needed(const std::vector<osg::Vec3d>& line, double deviation, double longest)
{
    const auto fits = [&](std::size_t from, std::size_t to)
    {
        const osg::Vec3d& start = line[from];
        osg::Vec3d way = line[to % line.size()] - start;
        const double length = way.normalize();
        if (!(length > 0.0 && length <= longest)) return false;
        for (std::size_t between = from + 1; between < to; ++between)
        {
            const osg::Vec3d at = line[between] - start;
            const double along = at * way;
            if (!(along >= 0.0 && along <= length && (at - way * along).length() <= deviation)) return false;
        }
        return true;
    };
    std::vector<std::size_t> kept;
    for (std::size_t from = 0; from < line.size();)
    {
        kept.push_back(from);
        std::size_t to = from + 1;
        while (to < line.size() && fits(from, to + 1))
            ++to;
        from = to;
    }
    return kept;
}

/// Whether two matrices are equal up to the rounding of a camera's matrices.
bool same(const osg::Matrixd& one, const osg::Matrixd& other)
{
    for (int i = 0; i < 16; ++i)
    {
        const double a = one.ptr()[i];
        if (std::abs(a - other.ptr()[i]) > (i < 12 ? 1e-7 : 1e-2)) return false;
    }
    return true;
}

osg::ref_ptr<osg::Geometry> geometryOf(osg::Vec3Array* vertices, osg::Array* shares,
                                       osg::PrimitiveSet* primitives)
{
    osg::ref_ptr<osg::Geometry> geometry = new osg::Geometry;
    geometry->setUseDisplayList(false);
    geometry->setUseVertexBufferObjects(true);
    geometry->setCullingActive(false);
    geometry->setVertexArray(vertices);
    geometry->setTexCoordArray(0, shares, osg::Array::BIND_PER_VERTEX);
    geometry->addPrimitiveSet(primitives);
    // OSG gives the buffers to the next geometry of the same size, which comes with the next tile.
    geometry->getOrCreateVertexBufferObject()->setUsage(GL_DYNAMIC_DRAW);
    return geometry;
}

} // namespace

bool ContourFence::isKnown(const RegionOfInterest& region, const std::vector<Ground>& ground) const
{
    return _wall && _region.get() == &region && _revision == region.revision() &&
           ground.size() == _known.size() &&
           std::equal(ground.begin(), ground.end(), _known.begin(),
                      [](const Ground& now, const Known& known)
                      {
                          const osg::Geometry* geometry = now.drawable->asGeometry();
                          return known.drawable.get() == now.drawable.get() &&
                                 same(now.toRegion, known.toRegion) &&
                                 (!geometry || known.stamp.matches(*geometry));
                      });
}

bool ContourFence::update(const RegionOfInterest& region, const std::vector<Ground>& ground)
{
    if (!isKnown(region, ground))
    {
        _region = &region;
        _revision = region.revision();
        _known.clear();
        for (const Ground& each : ground)
        {
            const osg::Geometry* geometry = each.drawable->asGeometry();
            _known.push_back({osg::observer_ptr<const osg::Drawable>(each.drawable), each.toRegion,
                              geometry ? GeometryStamp(*geometry) : GeometryStamp()});
        }
        build(region, ground);
    }
    return _grounded;
}

void ContourFence::build(const RegionOfInterest& region, const std::vector<Ground>& ground)
{
    const osg::Vec2d half(region.getWidth() / 2.0, region.getDepth() / 2.0);
    const double unit = std::min(half.x(), half.y());
    const std::vector<Contour> contours = region.contours(partLength);
    Heights heights(contours, half);
    for (const Ground& each : ground)
    {
        if (const osg::Geometry* geometry = each.drawable->asGeometry())
            heights.add(*geometry, each.toRegion);
    }
    _grounded = heights.anyKnown();

    osg::ref_ptr<osg::Vec3Array> wall = new osg::Vec3Array;
    osg::ref_ptr<osg::Vec2Array> wallShares = new osg::Vec2Array;
    osg::ref_ptr<osg::DrawElementsUInt> wallIndices = new osg::DrawElementsUInt(GL_TRIANGLES);
    osg::ref_ptr<osg::Vec3Array> line = new osg::Vec3Array;
    // A band: each point twice, with its neighbours. OpenGL's own lines are at most ten pixels wide with many drivers.
    osg::ref_ptr<osg::Vec3Array> lineShares = new osg::Vec3Array, before = new osg::Vec3Array,
                                 after = new osg::Vec3Array;
    osg::ref_ptr<osg::DrawElementsUInt> lineIndices = new osg::DrawElementsUInt(GL_TRIANGLES);
    std::size_t first = 0;
    for (const Contour& contour : contours)
    {
        std::vector<osg::Vec3d> points;
        for (std::size_t i = 0; i < contour.size(); ++i)
            points.emplace_back(contour[i].x() * half.x(), contour[i].y() * half.y(),
                                heights.height(first + i));
        const std::vector<std::size_t> kept =
            needed(points, tolerance * 2.0 * unit / region.getMaskSide(), longestPart * unit);
        const auto start = static_cast<unsigned int>(line->size());
        for (std::size_t i = 0; i < kept.size(); ++i)
        {
            osg::Vec3d point = points[kept[i]];
            const bool known = point.z() > unknown;
            if (!known) point.z() = 0.0;
            // The line ends where no ground is known.
            const auto neighbour = [&](std::size_t other)
            {
                const osg::Vec3d& place = points[kept[other % kept.size()]];
                return osg::Vec3(place.z() > unknown ? place : point);
            };
            const auto at = static_cast<unsigned int>(line->size());
            for (const float share : {0.0f, 1.0f})
            {
                wall->push_back(osg::Vec3(point));
                wallShares->push_back(osg::Vec2(share, 0.0f));
                line->push_back(osg::Vec3(point));
                lineShares->push_back(osg::Vec3(0.0f, 1.0f, 2.0f * share - 1.0f));
                before->push_back(neighbour(i + kept.size() - 1));
                after->push_back(neighbour(i + 1));
            }
            // There is no wall without ground, for example beyond the terrain's border.
            const std::size_t following = (i + 1) % kept.size();
            if (!known || !(points[kept[following]].z() > unknown)) continue;
            const unsigned int next = start + 2 * static_cast<unsigned int>(following);
            for (const unsigned int index : {at, next, at + 1, at + 1, next, next + 1})
            {
                wallIndices->push_back(index);
                lineIndices->push_back(index);
            }
        }
        first += contour.size();
    }
    _wall = geometryOf(wall, wallShares, wallIndices);
    _line = geometryOf(line, lineShares, lineIndices);
    _line->setTexCoordArray(1, before, osg::Array::BIND_PER_VERTEX);
    _line->setTexCoordArray(2, after, osg::Array::BIND_PER_VERTEX);
}

void ContourFence::resizeGLObjectBuffers(unsigned int size)
{
    osg::resizeGLObjectBuffers(_wall, size);
    osg::resizeGLObjectBuffers(_line, size);
}

void ContourFence::releaseGLObjects(osg::State* state) const
{
    osg::releaseGLObjects(_wall, state);
    osg::releaseGLObjects(_line, state);
}

} // namespace osgGeoFX
