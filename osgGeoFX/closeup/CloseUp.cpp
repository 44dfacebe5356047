// SPDX-License-Identifier: MIT
// SPDX-FileCopyrightText: 2026 the osgGeoFX authors
#include <osgGeoFX/closeup/CloseUp.h>

#include <osg/Math>
#include <osg/Notify>

#include <cmath>

namespace osgGeoFX
{

namespace
{

constexpr double sunAzimuthOfMaps = 315.0;
constexpr double sunElevationOfMaps = 45.0;

bool refuseNull(const char* setter)
{
    OSG_WARN << "osgGeoFX: CloseUp::" << setter << " got nothing; the former one stays." << std::endl;
    return false;
}

} // namespace

CloseUp::CloseUp()
    : _region(new RegionOfInterest), _anchor(new Anchor),
      _sunAzimuth(osg::DegreesToRadians(sunAzimuthOfMaps)),
      _sunElevation(osg::DegreesToRadians(sunElevationOfMaps))
{
    _region->addListener(*this);
    _anchor->addListener(*this);
}

CloseUp::CloseUp(const CloseUp& other, const osg::CopyOp& copy)
    : PropertyHolder(other, copy), _region(other._region), _anchor(other._anchor), _table(other._table),
      _surface(other._surface)
{
    for (const Property& property : CloseUp::properties())
        property.put(*this, property.get(other));
    if (copy.getCopyFlags() & osg::CopyOp::DEEP_COPY_OBJECTS)
    {
        _region = osg::clone(_region.get(), copy);
        _anchor = osg::clone(_anchor.get(), copy);
        if (_table) _table = osg::clone(_table.get(), copy);
    }
    _region->addListener(*this);
    _anchor->addListener(*this);
}

CloseUp::~CloseUp()
{
    _region->removeListener(*this);
    _anchor->removeListener(*this);
}

bool CloseUp::setRegion(RegionOfInterest* region)
{
    if (!region) return refuseNull("setRegion");
    _region->removeListener(*this);
    _region = region;
    _region->addListener(*this);
    touch();
    return true;
}

bool CloseUp::setAnchor(Anchor* anchor)
{
    if (!anchor) return refuseNull("setAnchor");
    _anchor->removeListener(*this);
    _anchor = anchor;
    _anchor->addListener(*this);
    touch();
    return true;
}

void CloseUp::setSurface(const std::string& layer)
{
    _surface = layer;
    touch();
}

bool CloseUp::setTable(ColorTable* table)
{
    _table = table;
    touch();
    return true;
}

void CloseUp::propertyChanged(PropertyHolder&)
{
    touch();
}

std::vector<PropertyHolder::Part> CloseUp::parts()
{
    return {{"region", _region.get()}, {"anchor", _anchor.get()}};
}

osg::Matrixd CloseUp::shape(double time) const
{
    // OSG's matrices act on rows: the first factor acts first.
    return osg::Matrixd::scale(_scaleX, _scaleY, _scaleHeight) *
           osg::Matrixd::rotate(std::remainder(_turn + _turnRate * time, 2.0 * osg::PI), osg::Z_AXIS) *
           osg::Matrixd::rotate(_tilt, osg::X_AXIS) *
           osg::Matrixd::translate(_offsetX, _offsetY, _offsetHeight);
}

const Properties& CloseUp::properties() const
{
    using Self = CloseUp;
    static const double turn = 2.0 * osg::PI;
    static const Properties all = withDefaultsOf(
        new Self,
        {
            Property::flag("enabled", "whether the close-up is drawn").of<&Self::_enabled>(),
            Property::number(
                "offsetX", "how far it lies from the region's center to the right, along the region's x axis",
                -1e7, 1e7, "m")
                .of<&Self::_offsetX>(),
            Property::number(
                "offsetY", "how far it lies from the region's center to the front, along the region's y axis",
                -1e7, 1e7, "m")
                .of<&Self::_offsetY>(),
            Property::number("offsetHeight", "how far it lies above the region's center", -1e7, 1e7, "m")
                .of<&Self::_offsetHeight>(),
            Property::number("scaleX", "its scale along the region's x axis", 0.001, 1000.0)
                .of<&Self::_scaleX>(),
            Property::number("scaleY", "its scale along the region's y axis", 0.001, 1000.0)
                .of<&Self::_scaleY>(),
            Property::number("scaleHeight", "the scale of its heights; 0 is a flat map", 0.0, 1000.0)
                .of<&Self::_scaleHeight>(),
            Property::choice("orientation", "what it stands in",
                             {{"scene", ""},
                              {"fixed", "it goes with the camera"},
                              {"billboard", "the same without perspective"}})
                .of<&Self::_orientation>(),
            Property::angle("tilt", "its turn about its x axis; the far side rises", -turn, turn)
                .of<&Self::_tilt>(),
            Property::angle("turn", "its turn about the vertical, counter-clockwise", -turn, turn)
                .of<&Self::_turn>(),
            Property::choice("edge", "how its edge is cut",
                             {{"fragments", "along the mask's border"},
                              {"primitives", "the triangles that lie in the mask wholly"}})
                .of<&Self::_edge>(),
            Property::number("roundness", "how far added vertices leave the flat triangles for round ground",
                             0.0, 1.0)
                .of<&Self::_roundness>(),
            Property::color("color", "the color of the anchor and the lines").of<&Self::_color>(),
            Property::number("surfaceOpacity", "how much of the surface shows over the scene's colors", 0.0,
                             1.0)
                .of<&Self::_surfaceOpacity>(),
            Property::choice("lighting", "how it is lit",
                             {{"asScene", "the scene's colors with their light"},
                              {"unlit", ""},
                              {"sun", "by the surface data's normals and a sun of its own"}})
                .of<&Self::_lighting>(),
            Property::angle("sunAzimuth", "where its sun stands, clockwise from the region's y axis", -turn,
                            turn)
                .of<&Self::_sunAzimuth>(),
            Property::angle("sunElevation", "the angle of its sun above the horizon", 0.0, osg::PI_2)
                .of<&Self::_sunElevation>(),
            Property::number("saturation", "the factor of the saturation; 0 is grey", 0.0, 4.0)
                .of<&Self::_saturation>(),
            Property::number("contrast", "the factor of the contrast about a middle grey", 0.0, 4.0)
                .of<&Self::_contrast>(),
            Property::number("brightness", "what is added to colors", -1.0, 1.0).of<&Self::_brightness>(),
            Property::number("opacity", "the opacity of the close-up", 0.0, 1.0).of<&Self::_opacity>(),
            Property::integer("mappingChannels",
                              "the bits of the projective mappings that it shows, by their channels", 0, 255)
                .of<&Self::_mappingChannels>(),
            Property::choice("activity", "how much of it is drawn",
                             {{"active", "all"},
                              {"regionOnly", "the line around the region"},
                              {"noAnchor", ""},
                              {"desaturated", ""}})
                .of<&Self::_activity>(),
            Property::angle("turnRate", "how fast it turns about the vertical, counter-clockwise", -10.0,
                            10.0, "rad/s")
                .of<&Self::_turnRate>(),
        });
    return all;
}

} // namespace osgGeoFX
