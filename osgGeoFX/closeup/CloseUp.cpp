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
    static const Properties all = {
        Property::flag("enabled", true).of<&Self::_enabled>(),
        Property::number("offsetX", 0.0, -1e7, 1e7, "m").of<&Self::_offsetX>(),
        Property::number("offsetY", 0.0, -1e7, 1e7, "m").of<&Self::_offsetY>(),
        Property::number("offsetHeight", 2000.0, -1e7, 1e7, "m").of<&Self::_offsetHeight>(),
        Property::number("scaleX", 1.5, 0.001, 1000.0).of<&Self::_scaleX>(),
        Property::number("scaleY", 1.5, 0.001, 1000.0).of<&Self::_scaleY>(),
        Property::number("scaleHeight", 1.5, 0.0, 1000.0).of<&Self::_scaleHeight>(),
        Property::choice("orientation", SCENE, {"scene", "fixed", "billboard"}).of<&Self::_orientation>(),
        Property::angle("tilt", 0.0, -turn, turn).of<&Self::_tilt>(),
        Property::angle("turn", 0.0, -turn, turn).of<&Self::_turn>(),
        Property::choice("edge", FRAGMENTS, {"fragments", "primitives"}).of<&Self::_edge>(),
        Property::number("roundness", 0.0, 0.0, 1.0).of<&Self::_roundness>(),
        Property::number("red", 1.0, 0.0, 1.0).of<&Self::_red>(),
        Property::number("green", 0.55, 0.0, 1.0).of<&Self::_green>(),
        Property::number("blue", 0.1, 0.0, 1.0).of<&Self::_blue>(),
        Property::number("surfaceOpacity", 1.0, 0.0, 1.0).of<&Self::_surfaceOpacity>(),
        Property::choice("lighting", AS_SCENE, {"asScene", "unlit", "sun"}).of<&Self::_lighting>(),
        Property::angle("sunAzimuth", osg::DegreesToRadians(sunAzimuthOfMaps), -turn, turn)
            .of<&Self::_sunAzimuth>(),
        Property::angle("sunElevation", osg::DegreesToRadians(sunElevationOfMaps), 0.0, osg::PI_2)
            .of<&Self::_sunElevation>(),
        Property::number("saturation", 1.0, 0.0, 4.0).of<&Self::_saturation>(),
        Property::number("contrast", 1.0, 0.0, 4.0).of<&Self::_contrast>(),
        Property::number("brightness", 0.0, -1.0, 1.0).of<&Self::_brightness>(),
        Property::number("opacity", 1.0, 0.0, 1.0).of<&Self::_opacity>(),
        Property::integer("mappingChannels", 255, 0, 255).of<&Self::_mappingChannels>(),
        Property::choice("activity", ACTIVE, {"active", "regionOnly", "noAnchor", "desaturated"})
            .of<&Self::_activity>(),
        Property::number("turnRate", 0.0, -10.0, 10.0, "rad/s").of<&Self::_turnRate>(),
    };
    return all;
}

} // namespace osgGeoFX
