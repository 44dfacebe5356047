// SPDX-License-Identifier: MIT
// SPDX-FileCopyrightText: 2026 the osgGeoFX authors
#include <osgGeoFX/mapping/PathRibbon.h>

#include <osg/BlendFunc>
#include <osg/BoundingBox>
#include <osg/Depth>
#include <osg/Geometry>
#include <osg/LineWidth>
#include <osg/Math>
#include <osg/ValueObject>

#include <algorithm>
#include <cmath>
#include <utility>
#include <vector>

namespace osgGeoFX
{

namespace
{

/// Sides of a tube.
constexpr int sides = 10;
constexpr double mostPixels = 10.0;
/// Of a way, after it got more of them.
constexpr std::size_t mostPlaces = 200000;

/// A place of the way in the world, metres.
struct Point
{
    osg::Vec3d place;
    osg::Vec3d foot; ///< below it
    osg::Vec3d up;
    osg::Vec3d across; ///< level, to the right
};

class Maker
{
public:
    Maker(const PathRibbon& look, const RoutePath& path, const Georeference& reference)
        : _look(look), _path(path), _reference(reference)
    {
    }

    bool place(std::string& error)
    {
        if (_path.places.size() < 2)
        {
            error = "The way \"" + _path.name + "\" has less than two places; give it more.";
            return false;
        }
        if (!(_look.leastPixels >= 0.0 && _look.leastPixels <= mostPixels))
        {
            error = "The way \"" + _path.name + "\" shall be " + std::to_string(_look.leastPixels) +
                    " pixels wide at least; give 0 to 10.";
            return false;
        }
        _places = _path.places;
        if (_path.altitude == RoutePath::ABOVE_GROUND)
            for (osg::Vec3d& each : _places)
                each.z() += groundAt(each, 0.0);
        osg::BoundingBoxd box;
        osg::Vec3d world;
        for (const osg::Vec3d& each : _places)
        {
            if (!worldOf(each, world, error)) return false;
            box.expandBy(world);
        }
        const double extent = 2.0 * box.radius();
        const double seen = _look.groundExtent > 0.0 ? std::min(extent, _look.groundExtent) : extent;
        _width = _look.width > 0.0 ? _look.width : std::max(4.0, seen / 200.0);
        const double wanted = _look.step > 0.0 ? _look.step : std::max(extent / 100.0, 1.0);
        const double step = std::max(wanted, extent / static_cast<double>(mostPlaces));
        osg::Vec3d before;
        for (const osg::Vec3d& each : denser(step))
        {
            Point point;
            osg::Vec3d above;
            if (!worldOf(each, point.place, error) ||
                !worldOf({each.x(), each.y(), groundAt(each, _look.foot)}, point.foot, error) ||
                !worldOf({each.x(), each.y(), each.z() + 1.0}, above, error))
                return false;
            point.up = above - point.place;
            point.up.normalize();
            // Of places at the same spot the first one counts.
            if (!_points.empty() && (point.place - before).length() < 1e-3) continue;
            before = point.place;
            _points.push_back(point);
        }
        if (_points.size() < 2)
        {
            error = "The way \"" + _path.name + "\" has all its places at one spot; give it others.";
            return false;
        }
        for (std::size_t i = 0; i < _points.size(); ++i)
        {
            const std::size_t from = i > 0 ? i - 1 : 0, to = std::min(i + 1, _points.size() - 1);
            Point& point = _points[i];
            point.across = (_points[to].place - _points[from].place) ^ point.up;
            if (point.across.normalize() < 1e-6)
                point.across = i > 0 ? _points[i - 1].across : osg::Vec3d(1.0, 0.0, 0.0);
        }
        _origin = box.center();
        return true;
    }

    osg::ref_ptr<osg::MatrixTransform> make()
    {
        switch (_look.shape)
        {
        case PathRibbon::RIBBON:
            for (const Point& point : _points)
                addRow({{point.place - point.across * (_width / 2.0), point.up},
                        {point.place + point.across * (_width / 2.0), point.up}});
            break;
        case PathRibbon::CURTAIN:
            for (const Point& point : _points)
                addRow({{point.foot, point.across}, {point.place, point.across}});
            break;
        case PathRibbon::TUBE:
            for (const Point& point : _points)
                addRow(ringOf(point));
            break;
        }
        const osg::ref_ptr<osg::Geometry> geometry = new osg::Geometry;
        geometry->setUseDisplayList(false);
        geometry->setUseVertexBufferObjects(true);
        geometry->setVertexArray(_vertices);
        geometry->setNormalArray(_normals, osg::Array::BIND_PER_VERTEX);
        const osg::ref_ptr<osg::Vec4Array> color = new osg::Vec4Array;
        color->push_back(_path.color.value_or(_look.color));
        if (_look.shape == PathRibbon::CURTAIN) color->back().a() /= 3.0f;
        geometry->setColorArray(color, osg::Array::BIND_OVERALL);
        geometry->addPrimitiveSet(_triangles);
        geometry->setName(_path.name);
        osg::StateSet& state = *geometry->getOrCreateStateSet();
        state.setMode(GL_CULL_FACE, osg::StateAttribute::OFF);
        state.setMode(GL_LIGHTING, osg::StateAttribute::OFF);
        if (color->back().a() < 1.0f)
        {
            state.setAttributeAndModes(new osg::BlendFunc);
            state.setRenderingHint(osg::StateSet::TRANSPARENT_BIN);
            state.setAttributeAndModes(new osg::Depth(osg::Depth::LESS, 0.0, 1.0, false));
        }
        osg::ref_ptr<osg::MatrixTransform> node = new osg::MatrixTransform(osg::Matrixd::translate(_origin));
        node->setName(_path.name);
        node->addChild(geometry);
        if (_look.leastPixels > 0.0 && _look.shape != PathRibbon::CURTAIN) node->addChild(line(*geometry));
        return node;
    }

private:
    using Row = std::vector<std::pair<osg::Vec3d, osg::Vec3d>>; ///< positions and normals

    bool worldOf(const osg::Vec3d& place, osg::Vec3d& world, std::string& error) const
    {
        if (_reference.toWorld(osg::DegreesToRadians(place.x()), osg::DegreesToRadians(place.y()), place.z(),
                               world))
            return true;
        error = "The way \"" + _path.name + "\" leaves the terrain's projection; cut it.";
        return false;
    }

    double groundAt(const osg::Vec3d& place, double otherwise) const
    {
        if (!_look.ground) return otherwise;
        const double height = _look.ground(place.x(), place.y());
        return std::isfinite(height) ? height : otherwise;
    }

    /// A line along the middle, which is seen where the shape is narrower.
    osg::ref_ptr<osg::Geometry> line(const osg::Geometry& shape) const
    {
        const osg::ref_ptr<osg::Geometry> geometry = new osg::Geometry;
        const osg::ref_ptr<osg::Vec3Array> vertices = new osg::Vec3Array;
        for (const Point& point : _points)
            vertices->push_back(osg::Vec3(point.place - _origin));
        geometry->setUseDisplayList(false);
        geometry->setUseVertexBufferObjects(true);
        geometry->setVertexArray(vertices);
        geometry->setColorArray(const_cast<osg::Array*>(shape.getColorArray()), osg::Array::BIND_OVERALL);
        geometry->addPrimitiveSet(new osg::DrawArrays(GL_LINE_STRIP, 0, static_cast<int>(vertices->size())));
        geometry->setName(_path.name);
        geometry->setUserValue("geofx.thinLine", true);
        const osg::ref_ptr<osg::StateSet> state = new osg::StateSet(*shape.getStateSet());
        state->setAttributeAndModes(new osg::LineWidth(static_cast<float>(_look.leastPixels)));
        geometry->setStateSet(state);
        return geometry;
    }

    /// The places with more between them: on geodesics, at heights that grow evenly.
    std::vector<osg::Vec3d> denser(double step) const
    {
        std::vector<osg::Vec3d> result = {_places.front()};
        for (std::size_t i = 1; i < _places.size(); ++i)
        {
            RoutePath leg;
            leg.places = {_places[i - 1], _places[i]};
            const std::vector<osg::Vec2d> way = leg.alongGeodesics(step);
            for (std::size_t k = 1; k < way.size(); ++k)
            {
                const double share = static_cast<double>(k) / static_cast<double>(way.size() - 1);
                result.emplace_back(way[k].x(), way[k].y(),
                                    leg.places[0].z() + share * (leg.places[1].z() - leg.places[0].z()));
            }
        }
        return result;
    }

    Row ringOf(const Point& point) const
    {
        Row row;
        for (int i = 0; i <= sides; ++i)
        {
            const double angle = 2.0 * osg::PI * i / sides;
            const osg::Vec3d outward = point.across * std::cos(angle) + point.up * std::sin(angle);
            row.emplace_back(point.place + outward * (_width / 2.0), outward);
        }
        return row;
    }

    void addRow(const Row& row)
    {
        const auto first = static_cast<unsigned int>(_vertices->size());
        const auto count = static_cast<unsigned int>(row.size());
        for (const auto& [position, normal] : row)
        {
            _vertices->push_back(osg::Vec3(position - _origin));
            _normals->push_back(osg::Vec3(normal));
        }
        if (first == 0) return;
        for (unsigned int i = 0; i + 1 < count; ++i)
        {
            const unsigned int a = first - count + i, b = first + i;
            for (const unsigned int index : {a, a + 1, b + 1, a, b + 1, b})
                _triangles->push_back(index);
        }
    }

    const PathRibbon& _look;
    const RoutePath& _path;
    const Georeference& _reference;
    std::vector<osg::Vec3d> _places; ///< of the path, with heights above zero
    std::vector<Point> _points;
    osg::Vec3d _origin;
    double _width = 0.0;
    osg::ref_ptr<osg::Vec3Array> _vertices = new osg::Vec3Array;
    osg::ref_ptr<osg::Vec3Array> _normals = new osg::Vec3Array;
    osg::ref_ptr<osg::DrawElementsUInt> _triangles = new osg::DrawElementsUInt(GL_TRIANGLES);
};

} // namespace

osg::ref_ptr<osg::MatrixTransform> PathRibbon::make(const RoutePath& path, const Georeference& reference,
                                                    std::string& error) const
{
    Maker maker(*this, path, reference);
    return maker.place(error) ? maker.make() : nullptr;
}

std::vector<osg::ref_ptr<osg::Node>> PathRibbon::nodesOf(const RoutePath& path, const RoutePath::Look& look,
                                                         const Georeference& reference, std::string& error,
                                                         const Ground& ground)
{
    PathRibbon ribbon;
    ribbon.ground = ground;
    ribbon.color = look.style.color;
    ribbon.width = look.width;
    ribbon.groundExtent = look.groundExtent;
    std::vector<osg::ref_ptr<osg::Node>> nodes;
    for (const Shape each : {TUBE, CURTAIN})
    {
        if (each == CURTAIN && !path.extruded) continue;
        ribbon.shape = each;
        const osg::ref_ptr<osg::Node> node = ribbon.make(path, reference, error);
        if (!node) return {};
        nodes.push_back(node);
    }
    return nodes;
}

} // namespace osgGeoFX
