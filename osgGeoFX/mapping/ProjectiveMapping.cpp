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
    const auto metres = [](const char* name, double value)
    {
        return Property::number(name, value, -farAway, farAway, "m");
    };
    const auto factor = [](const char* name, double value)
    {
        return Property::number(name, value, -1e6, 1e6);
    };
    static const Properties all = {
        Property::flag("enabled", true).of<&Self::_enabled>(),
        Property::integer("order", 0, -1000, 1000).of<&Self::_order>(),
        Property::number("opacity", 1.0, 0.0, 1.0).of<&Self::_opacity>(),
        Property::number("importance", 0.5, 0.0, 1.0).of<&Self::_importance>(),
        Property::integer("channels", 255, 0, 255).of<&Self::_channels>(),
        metres("centreX", 0.0).of<&Self::_centreX>(),
        metres("centreY", 0.0).of<&Self::_centreY>(),
        metres("uX", 100.0).of<&Self::_uX>(),
        metres("uY", 0.0).of<&Self::_uY>(),
        metres("vX", 0.0).of<&Self::_vX>(),
        metres("vY", 100.0).of<&Self::_vY>(),
        factor("m00", 1.0).of<&Self::_m00>(),
        factor("m01", 0.0).of<&Self::_m01>(),
        factor("m02", 0.0).of<&Self::_m02>(),
        factor("m10", 0.0).of<&Self::_m10>(),
        factor("m11", 1.0).of<&Self::_m11>(),
        factor("m12", 0.0).of<&Self::_m12>(),
        factor("m20", 0.0).of<&Self::_m20>(),
        factor("m21", 0.0).of<&Self::_m21>(),
        factor("m22", 1.0).of<&Self::_m22>(),
        Property::number("lowest", -1e6, -1e6, 1e6, "m").of<&Self::_lowest>(),
        Property::number("highest", 1e6, -1e6, 1e6, "m").of<&Self::_highest>(),
        Property::number("nearest", 0.0, 0.0, 5e7, "m").of<&Self::_nearest>(),
        Property::number("farthest", 5e7, 0.0, 5e7, "m").of<&Self::_farthest>(),
        Property::number("softness", 0.2, 0.0, 1.0).of<&Self::_softness>(),
        Property::number("pixelsNone", 0.0, 0.0, 1e6).of<&Self::_pixelsNone>(),
        Property::number("pixelsFull", 0.0, 0.0, 1e6).of<&Self::_pixelsFull>(),
        Property::angle("slopeFull", osg::PI_2, 0.0, osg::PI_2).of<&Self::_slopeFull>(),
        Property::angle("slopeNone", osg::PI_2, 0.0, osg::PI_2).of<&Self::_slopeNone>(),
        Property::flag("softEdges", true).of<&Self::_softEdges>(),
        Property::number("sizeInPixels", 0.0, 0.0, 1e5).of<&Self::_sizeInPixels>(),
        Property::flag("turned", false).of<&Self::_turned>(),
        Property::choice("projector", PLANE, {"plane", "pinhole"}).of<&Self::_projector>(),
        Property::number("height", 0.0, -12000.0, 1e7, "m").of<&Self::_height>(),
        Property::angle("heading", 0.0, -2.0 * osg::PI, 2.0 * osg::PI).of<&Self::_heading>(),
        Property::angle("pitch", 0.0, -osg::PI_2, osg::PI_2).of<&Self::_pitch>(),
        Property::angle("roll", 0.0, -osg::PI, osg::PI).of<&Self::_roll>(),
        Property::angle("fieldOfView", 1.0, 0.001, 3.0).of<&Self::_fieldOfView>(),
        Property::number("aspectRatio", 4.0 / 3.0, 0.01, 100.0).of<&Self::_aspectRatio>(),
        Property::number("k1", 0.0, -10.0, 10.0).of<&Self::_k1>(),
        Property::number("k2", 0.0, -10.0, 10.0).of<&Self::_k2>(),
        Property::number("k3", 0.0, -10.0, 10.0).of<&Self::_k3>(),
        Property::number("p1", 0.0, -1.0, 1.0).of<&Self::_p1>(),
        Property::number("p2", 0.0, -1.0, 1.0).of<&Self::_p2>(),
        Property::number("range", 5000.0, 0.1, 1e6, "m").of<&Self::_range>(),
    };
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

bool ProjectiveMapping::setRectangle(const osg::Vec2d& centre, double halfWidth, double halfHeight,
                                     double heading)
{
    const double sine = std::sin(heading);
    const double cosine = std::cos(heading);
    return assign({{"centreX", centre.x()},
                   {"centreY", centre.y()},
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
    const osg::Vec2d centre = corners[0] + u + v;
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
    values.insert({{"centreX", centre.x()},
                   {"centreY", centre.y()},
                   {"uX", u.x()},
                   {"uY", u.y()},
                   {"vX", v.x()},
                   {"vY", v.y()}});
    return assign(values);
}

bool ProjectiveMapping::setCamera(const Camera& camera)
{
    return assign({{"projector", PINHOLE},
                   {"centreX", camera.eye.x()},
                   {"centreY", camera.eye.y()},
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
    return {{_centreX, _centreY, _height},
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
    const glm::dvec2 centre(_centreX, _centreY);
    const glm::dmat3 square(a.x, b.x, 0.0, a.y, b.y, 0.0, 0.5 - glm::dot(a, centre),
                            0.5 - glm::dot(b, centre), 1.0);
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
    const osg::Vec2d centre = getCentre();
    double radius = 0.0;
    if (_projector == PINHOLE)
        radius = _range;
    else if (_turned || _sizeInPixels > 0.0)
        radius = std::hypot(getU().length(), getV().length());
    if (radius > 0.0)
    {
        const osg::Vec2d half(radius, radius);
        return PlaneFootprint::box(centre - half, centre + half);
    }
    return outline().value_or(PlaneFootprint());
}

} // namespace osgGeoFX
