// SPDX-License-Identifier: MIT
// SPDX-FileCopyrightText: 2026 the osgGeoFX authors
#include <osgGeoFX/panorama/PanoramaMap.h>

#include <osgGeoFX/panorama/PanoramaFrame.h>
#include <osgGeoFX/panorama/PanoramaGround.h>

#include <algorithm>
#include <cmath>

namespace osgGeoFX
{

namespace
{

/// What stands for the projection's (0, 0) where the camera is orthographic: that of a field of view of 50° across.
constexpr double orthographicScale = 2.1;

} // namespace

PanoramaMap::PanoramaMap() : _ground(new Ground(*this)) {}

PanoramaMap::PanoramaMap(const PanoramaMap& other, const osg::CopyOp& copy)
    : Deformation(other, copy), _ground(new Ground(*this))
{
    for (const Property& property : PanoramaMap::properties())
        property.put(*this, property.get(other));
}

PanoramaMap::~PanoramaMap() = default;

const Properties& PanoramaMap::properties() const
{
    using Self = PanoramaMap;
    static const Properties all = {
        enabledProperty(),
        Property::flag("projection", true).of<&Self::_projection>(),
        Property::number("viewRadius", 0.0, 0.0, 2e6, "m").of<&Self::_viewRadius>(),
        Property::number("horizonLine", 0.8, 0.1, 1.0).of<&Self::_horizonLine>(),
        Property::number("curveDistance", 0.4, 0.0, 20.0).of<&Self::_curveDistance>(),
        Property::number("horizonDistance", 3.6, 0.1, 50.0).of<&Self::_horizonDistance>(),
        Property::number("horizonBend", 0.05, 0.0, 0.5).of<&Self::_horizonBend>(),
        Property::number("exaggeration", 2.0, 0.0, 20.0).of<&Self::_exaggeration>().turnedByFactor(1.15),
        Property::number("baseHeight", 0.0, -12000.0, 12000.0, "m").of<&Self::_baseHeight>(),
        Property::flag("baseFromTerrain", true).of<&Self::_baseFromTerrain>(),
        Property::number("detail", 1.0, 0.05, 16.0).of<&Self::_detail>(),
    };
    return all;
}

std::string PanoramaMap::inconsistency() const
{
    if (_curveDistance >= _horizonDistance) return "curveDistance must be less than horizonDistance.";
    return {};
}

osg::ref_ptr<const DeformationFrame> PanoramaMap::frame(const ViewGeometry& view) const
{
    if (!_projection) return nullptr;
    const std::optional<glsl::geofx_Panorama> panorama = panoramaOf(*this, view);
    if (!panorama) return nullptr;
    const bool perspective = view.projection(3, 3) == 0.0;
    const double scale = perspective ? std::abs(view.projection(0, 0)) : orthographicScale;
    return new PanoramaFrame(*panorama,
                             scale / panorama->across / (std::max(1.0, _exaggeration) * _detail));
}

SurfaceEffect* PanoramaMap::asSurfaceEffect()
{
    return _ground;
}

} // namespace osgGeoFX
