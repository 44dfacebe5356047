// SPDX-License-Identifier: MIT
// SPDX-FileCopyrightText: 2026 the osgGeoFX authors
#include <osgGeoFX/mapping/ProjectiveMapping.h>

#include <glm/glm.hpp>
#include <osg/Math>
#include <osg/Notify>

#include <algorithm>
#include <cmath>

namespace osgGeoFX
{

namespace
{

constexpr double farAway = 5e7; ///< metres; no map is larger

osg::Vec2d place(const glm::dvec3& homogeneous)
{
    return {homogeneous.x / homogeneous.z, homogeneous.y / homogeneous.z};
}

/// What takes the unit square's corners (lower left, lower right, upper right, upper left) to four points.
glm::dmat3 squareToQuad(const osg::Vec2d (&c)[4])
{
    // Heckbert's construction: the projective map of a square onto a quadrilateral.
    const osg::Vec2d sum = c[0] - c[1] + c[2] - c[3];
    const osg::Vec2d d1 = c[1] - c[2];
    const osg::Vec2d d2 = c[3] - c[2];
    const double det = d1.x() * d2.y() - d2.x() * d1.y();
    const double g = (sum.x() * d2.y() - d2.x() * sum.y()) / det;
    const double h = (d1.x() * sum.y() - sum.x() * d1.y()) / det;
    return {glm::dvec3(c[1].x() - c[0].x() + g * c[1].x(), c[1].y() - c[0].y() + g * c[1].y(), g),
            glm::dvec3(c[3].x() - c[0].x() + h * c[3].x(), c[3].y() - c[0].y() + h * c[3].y(), h),
            glm::dvec3(c[0].x(), c[0].y(), 1.0)};
}

std::map<std::string, double> transformValues(const glm::dmat3& m)
{
    return {{"m00", m[0][0]}, {"m01", m[1][0]}, {"m02", m[2][0]}, {"m10", m[0][1]}, {"m11", m[1][1]},
            {"m12", m[2][1]}, {"m20", m[0][2]}, {"m21", m[1][2]}, {"m22", m[2][2]}};
}

} // namespace

ProjectiveMapping::ProjectiveMapping()
    : _slopeFull(osg::PI_2), _slopeNone(osg::PI_2), _transfer(new ColorTransfer)
{
    _transfer->addListener(*this);
}

ProjectiveMapping::ProjectiveMapping(const ProjectiveMapping& other, const osg::CopyOp& copy)
    : PropertyHolder(other, copy), _layer(other._layer), _mask(other._mask), _table(other._table),
      _transfer(other._transfer)
{
    for (const Property& property : ProjectiveMapping::properties())
        property.put(*this, property.get(other));
    if (copy.getCopyFlags() & osg::CopyOp::DEEP_COPY_OBJECTS)
    {
        if (_layer) _layer = osg::clone(_layer.get(), copy);
        if (_mask) _mask = osg::clone(_mask.get(), copy);
        if (_table) _table = osg::clone(_table.get(), copy);
        _transfer = osg::clone(_transfer.get(), copy);
    }
    _transfer->addListener(*this);
}

ProjectiveMapping::~ProjectiveMapping()
{
    _transfer->removeListener(*this);
}

const Properties& ProjectiveMapping::properties() const
{
    using Self = ProjectiveMapping;
    static const Properties all = withDefaultsOf(
        new Self,
        {
            Property::flag("enabled", "whether the mapping is shown").of<&Self::_enabled>(),
            Property::integer(
                "order",
                "which mapping lies on top: the one of the higher number, of equal ones the later one", -1000,
                1000)
                .of<&Self::_order>(),
            Property::number("opacity", "the opacity of the mapping", 0.0, 1.0).of<&Self::_opacity>(),
            Property::number("importance",
                             "which mappings stay where there is no room for all; the highest stay longest",
                             0.0, 1.0)
                .of<&Self::_importance>(),
            Property::integer("channels", "the bits of the geometries that the mapping is for; 255 is all", 0,
                              255)
                .of<&Self::_channels>(),
            Property::number("centerX", "the center, east of the frame's origin", -farAway, farAway, "m")
                .of<&Self::_centerX>(),
            Property::number("centerY", "the center, north of the frame's origin", -farAway, farAway, "m")
                .of<&Self::_centerY>(),
            Property::number("uX", "how far the middle of the right edge lies east of the center", -farAway,
                             farAway, "m")
                .of<&Self::_uX>(),
            Property::number("uY", "how far the middle of the right edge lies north of the center", -farAway,
                             farAway, "m")
                .of<&Self::_uY>(),
            Property::number("vX", "how far the middle of the upper edge lies east of the center", -farAway,
                             farAway, "m")
                .of<&Self::_vX>(),
            Property::number("vY", "how far the middle of the upper edge lies north of the center", -farAway,
                             farAway, "m")
                .of<&Self::_vY>(),
            Property::number("m00", "row 0, column 0 of the transform in raster coordinates", -1e6, 1e6)
                .of<&Self::_m00>(),
            Property::number("m01", "row 0, column 1 of the transform in raster coordinates", -1e6, 1e6)
                .of<&Self::_m01>(),
            Property::number("m02", "row 0, column 2 of the transform in raster coordinates", -1e6, 1e6)
                .of<&Self::_m02>(),
            Property::number("m10", "row 1, column 0 of the transform in raster coordinates", -1e6, 1e6)
                .of<&Self::_m10>(),
            Property::number("m11", "row 1, column 1 of the transform in raster coordinates", -1e6, 1e6)
                .of<&Self::_m11>(),
            Property::number("m12", "row 1, column 2 of the transform in raster coordinates", -1e6, 1e6)
                .of<&Self::_m12>(),
            Property::number("m20", "row 2, column 0 of the transform in raster coordinates", -1e6, 1e6)
                .of<&Self::_m20>(),
            Property::number("m21", "row 2, column 1 of the transform in raster coordinates", -1e6, 1e6)
                .of<&Self::_m21>(),
            Property::number("m22", "row 2, column 2 of the transform in raster coordinates", -1e6, 1e6)
                .of<&Self::_m22>(),
            Property::number("lowest", "the height from which on the mapping is shown", -1e6, 1e6, "m")
                .of<&Self::_lowest>(),
            Property::number("highest", "the height up to which the mapping is shown", -1e6, 1e6, "m")
                .of<&Self::_highest>(),
            Property::number("nearest", "the distance from the camera from which on the mapping is shown",
                             0.0, 5e7, "m")
                .of<&Self::_nearest>(),
            Property::number("farthest", "the distance from the camera up to which the mapping is shown", 0.0,
                             5e7, "m")
                .of<&Self::_farthest>(),
            Property::number("softness", "the share of those distances in which it fades", 0.0, 1.0)
                .of<&Self::_softness>(),
            Property::number(
                "pixelsNone",
                "the size on the screen up to which the mapping is not shown; not more than pixelsFull", 0.0,
                1e6, "px")
                .of<&Self::_pixelsNone>(),
            Property::number("pixelsFull",
                             "the size on the screen from which on the mapping is shown in full", 0.0, 1e6,
                             "px")
                .of<&Self::_pixelsFull>(),
            Property::angle("slopeFull", "the slope of the ground up to which the mapping is shown in full",
                            0.0, osg::PI_2)
                .of<&Self::_slopeFull>(),
            Property::angle(
                "slopeNone",
                "the slope of the ground above which the mapping is not shown; not less than slopeFull", 0.0,
                osg::PI_2)
                .of<&Self::_slopeNone>(),
            Property::flag("softEdges",
                           "whether edges are smooth; tiles that meet without a seam have hard ones")
                .of<&Self::_softEdges>(),
            Property::number("sizeInPixels", "the size of a symbol on the screen; 0 leaves it to the metres",
                             0.0, 1e5, "px")
                .of<&Self::_sizeInPixels>(),
            Property::flag("turned", "whether a symbol's upper edge points away from the camera")
                .of<&Self::_turned>(),
            Property::choice("projector", "along which rays the raster is thrown",
                             {{"plane", "straight down"}, {"pinhole", "those of a camera at the center"}})
                .of<&Self::_projector>(),
            Property::number("height", "the height of the center or the camera", -12000.0, 1e7, "m")
                .of<&Self::_height>(),
            Property::angle("heading", "where the camera looks, clockwise from the frame's north",
                            -2.0 * osg::PI, 2.0 * osg::PI)
                .of<&Self::_heading>(),
            Property::angle("pitch", "the angle by which the camera looks up", -osg::PI_2, osg::PI_2)
                .of<&Self::_pitch>(),
            Property::angle("roll", "the turn of the camera to the right", -osg::PI, osg::PI)
                .of<&Self::_roll>(),
            Property::angle("fieldOfView", "the camera's angle of view from left to right",
                            osg::DegreesToRadians(0.1), osg::DegreesToRadians(170.0))
                .of<&Self::_fieldOfView>(),
            Property::number("aspectRatio", "width over height of the camera's image", 0.01, 100.0)
                .of<&Self::_aspectRatio>(),
            Property::number("k1", "coefficient 1 of the lens's radial distortion (Brown)", -10.0, 10.0)
                .of<&Self::_k1>(),
            Property::number("k2", "coefficient 2 of the lens's radial distortion (Brown)", -10.0, 10.0)
                .of<&Self::_k2>(),
            Property::number("k3", "coefficient 3 of the lens's radial distortion (Brown)", -10.0, 10.0)
                .of<&Self::_k3>(),
            Property::number("p1", "coefficient 1 of the lens's tangential distortion (Brown)", -1.0, 1.0)
                .of<&Self::_p1>(),
            Property::number("p2", "coefficient 2 of the lens's tangential distortion (Brown)", -1.0, 1.0)
                .of<&Self::_p2>(),
            Property::number("range", "how far the camera's image reaches", 0.1, 1e6, "m")
                .of<&Self::_range>(),
        });
    return all;
}

std::string ProjectiveMapping::inconsistency() const
{
    // Two vectors span an area where the sine between them is not lost in rounding.
    const double area = _uX * _vY - _uY * _vX;
    if (!(std::abs(area) > 1e-9 * getU().length() * getV().length()))
        return "U and V must span an area, and (" + std::to_string(_uX) + ", " + std::to_string(_uY) +
               ") and (" + std::to_string(_vX) + ", " + std::to_string(_vY) + ") do not.";
    if (!outline()) return "the transform must have an inverse, and keep the raster's corners from infinity.";
    if (_lowest > _highest) return "lowest must not exceed highest.";
    if (_nearest > _farthest) return "nearest must not exceed farthest.";
    if (_pixelsNone > _pixelsFull) return "pixelsNone must not exceed pixelsFull.";
    if (_slopeFull > _slopeNone) return "slopeFull must not exceed slopeNone.";
    return {};
}

void ProjectiveMapping::propertyChanged(PropertyHolder&)
{
    touch();
}

bool ProjectiveMapping::setAxes(const osg::Vec2d& u, const osg::Vec2d& v)
{
    return assign({{"uX", u.x()}, {"uY", u.y()}, {"vX", v.x()}, {"vY", v.y()}});
}

bool ProjectiveMapping::setRectangle(const osg::Vec2d& center, double halfWidth, double halfHeight,
                                     double heading)
{
    const double sine = std::sin(heading);
    const double cosine = std::cos(heading);
    return assign({{"centerX", center.x()},
                   {"centerY", center.y()},
                   {"uX", halfWidth * cosine},
                   {"uY", -halfWidth * sine},
                   {"vX", halfHeight * sine},
                   {"vY", halfHeight * cosine}});
}

bool ProjectiveMapping::setTransform(const glm::dmat3& m)
{
    return assign(transformValues(m));
}

glm::dmat3 ProjectiveMapping::getTransform() const
{
    return {_m00, _m10, _m20, _m01, _m11, _m21, _m02, _m12, _m22};
}

bool ProjectiveMapping::setQuad(const osg::Vec2d (&corners)[4])
{
    // The parallelogram through three of the corners, and the rest as a transform.
    const osg::Vec2d u = (corners[1] - corners[0]) / 2.0;
    const osg::Vec2d v = (corners[3] - corners[0]) / 2.0;
    const osg::Vec2d center = corners[0] + u + v;
    const double area = u.x() * v.y() - u.y() * v.x();
    osg::Vec2d within[4];
    for (int i = 0; i < 4; ++i)
    {
        const osg::Vec2d d = corners[i] - corners[0];
        within[i].set((d.x() * v.y() - d.y() * v.x()) / (2.0 * area),
                      (u.x() * d.y() - u.y() * d.x()) / (2.0 * area));
    }
    glm::dmat3 m = glm::inverse(squareToQuad(within));
    m /= m[2][2];
    std::map<std::string, double> values = transformValues(m);
    values.insert({{"centerX", center.x()},
                   {"centerY", center.y()},
                   {"uX", u.x()},
                   {"uY", u.y()},
                   {"vX", v.x()},
                   {"vY", v.y()}});
    return assign(values);
}

bool ProjectiveMapping::setCamera(const Camera& camera)
{
    return assign({{"projector", PINHOLE},
                   {"centerX", camera.eye.x()},
                   {"centerY", camera.eye.y()},
                   {"height", camera.eye.z()},
                   {"heading", camera.heading},
                   {"pitch", camera.pitch},
                   {"roll", camera.roll},
                   {"fieldOfView", camera.fieldOfView},
                   {"aspectRatio", camera.aspectRatio},
                   {"k1", camera.k1},
                   {"k2", camera.k2},
                   {"k3", camera.k3},
                   {"p1", camera.p1},
                   {"p2", camera.p2},
                   {"range", camera.range}});
}

ProjectiveMapping::Camera ProjectiveMapping::getCamera() const
{
    return {{_centerX, _centerY, _height},
            _heading,
            _pitch,
            _roll,
            _fieldOfView,
            _aspectRatio,
            _k1,
            _k2,
            _k3,
            _p1,
            _p2,
            _range};
}

bool ProjectiveMapping::setLayer(DataLayer* layer)
{
    _layer = layer;
    touch();
    return true;
}

bool ProjectiveMapping::setMask(DataLayer* mask)
{
    _mask = mask;
    touch();
    return true;
}

bool ProjectiveMapping::setTable(ColorTable* table)
{
    _table = table;
    touch();
    return true;
}

bool ProjectiveMapping::setTransfer(ColorTransfer* transfer)
{
    if (!transfer)
    {
        OSG_WARN << "osgGeoFX: A ProjectiveMapping needs a color transfer; the former one stays."
                 << std::endl;
        return false;
    }
    _transfer->removeListener(*this);
    _transfer = transfer;
    _transfer->addListener(*this);
    touch();
    return true;
}

glm::dmat3 ProjectiveMapping::placeToRaster() const
{
    const double area = _uX * _vY - _uY * _vX;
    // d = a U + b V, and raster coordinates 1/2 + (a, b)/2.
    const glm::dvec2 a(_vY / (2.0 * area), -_vX / (2.0 * area));
    const glm::dvec2 b(-_uY / (2.0 * area), _uX / (2.0 * area));
    const glm::dvec2 center(_centerX, _centerY);
    const glm::dmat3 square(a.x, b.x, 0.0, a.y, b.y, 0.0, 0.5 - glm::dot(a, center),
                            0.5 - glm::dot(b, center), 1.0);
    return getTransform() * square;
}

std::optional<PlaneFootprint> ProjectiveMapping::outline() const
{
    const glm::dmat3 there = placeToRaster();
    const glm::dmat3 back = glm::inverse(there);
    PlaneFootprint result;
    const glm::dvec3 corners[4] = {{0.0, 0.0, 1.0}, {1.0, 0.0, 1.0}, {1.0, 1.0, 1.0}, {0.0, 1.0, 1.0}};
    double sign = 0.0;
    for (std::size_t i = 0; i < 4; ++i)
    {
        const glm::dvec3 corner = back * corners[i];
        if (i == 0) sign = corner.z;
        // The line at infinity must not run through the raster.
        if (!(corner.z * sign > 0.0)) return std::nullopt;
        result.corners[i] = place(corner);
    }
    if (!result.valid()) return std::nullopt;
    return result;
}

PlaneFootprint ProjectiveMapping::footprint() const
{
    const osg::Vec2d center = getCenter();
    double radius = 0.0;
    if (_projector == PINHOLE)
        radius = _range;
    else if (_turned || _sizeInPixels > 0.0)
        radius = std::hypot(getU().length(), getV().length());
    if (radius > 0.0)
    {
        const osg::Vec2d half(radius, radius);
        return PlaneFootprint::box(center - half, center + half);
    }
    return outline().value_or(PlaneFootprint());
}

} // namespace osgGeoFX
