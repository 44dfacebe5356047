// SPDX-License-Identifier: MIT
// SPDX-FileCopyrightText: 2026 the osgGeoFX authors
#include <osgGeoFX/panorama/PanoramaMap.h>

#include <osgGeoFX/panorama/StrokeLines.h>
#include <osgGeoFX/panorama/detail/PanoramaFrame.h>
#include <osgGeoFX/panorama/detail/PanoramaGround.h>
#include <osgGeoFX/panorama/detail/PanoramaScenery.h>
#include <osgGeoFX/panorama/detail/PanoramaTextures.h>

#include <algorithm>
#include <cmath>

namespace osgGeoFX
{

namespace
{

/// What stands for the projection's (0, 0) where the camera is orthographic: that of a field of view of 50° across.
constexpr double orthographicScale = 2.1;

} // namespace

PanoramaMap::PanoramaMap()
    : _textures(std::make_unique<PanoramaTextures>()), _ground(new Ground(*this, *_textures)),
      _scenery(new Scenery(*this, *_textures))
{
}

PanoramaMap::PanoramaMap(const PanoramaMap& other, const osg::CopyOp& copy)
    : Deformation(other, copy), _palette(copy(other._palette.get())), _skyImage(copy(other._skyImage.get())),
      _lines(other._lines), _textures(std::make_unique<PanoramaTextures>()),
      _ground(new Ground(*this, *_textures)), _scenery(new Scenery(*this, *_textures))
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
        Property::flag("paint", true).of<&Self::_paint>(),
        Property::number("season", 0.5, 0.0, 1.0).of<&Self::_season>(),
        Property::number("snowLine", -1.0, -1.0, 12000.0, "m").of<&Self::_snowLine>(),
        Property::number("snowWidth", 500.0, 1.0, 5000.0, "m").of<&Self::_snowWidth>(),
        Property::number("treeLine", -1.0, -1.0, 12000.0, "m").of<&Self::_treeLine>(),
        Property::number("cliffSlope", 0.85, 0.05, 10.0).of<&Self::_cliffSlope>(),
        Property::number("hillSlope", 0.18, 0.005, 10.0).of<&Self::_hillSlope>(),
        Property::number("relief", 2.2, 0.1, 20.0).of<&Self::_relief>(),
        Property::number("brush", 0.35, 0.0, 2.0).of<&Self::_brush>(),
        Property::number("bottomShade", 0.3, 0.0, 2.0).of<&Self::_bottomShade>(),
        Property::angle("lightAzimuth", -osg::PI / 3.0, -osg::PI, osg::PI).of<&Self::_lightAzimuth>(),
        Property::angle("lightElevation", 32.0 * osg::PI / 180.0, 0.0, osg::PI_2)
            .of<&Self::_lightElevation>(),
        Property::flag("sceneLight", false).of<&Self::_sceneLight>(),
        Property::number("atmosphere", 0.8, 0.0, 1.0).of<&Self::_atmosphere>(),
        Property::flag("water", true).of<&Self::_water>(),
        Property::number("deepShore", 2200.0, 1.0, 1e6, "m").of<&Self::_deepShore>(),
        Property::number("reflection", 0.5, 0.0, 1.0).of<&Self::_reflection>(),
        Property::number("ripples", 1.0, 0.0, 10.0).of<&Self::_ripples>(),
        Property::flag("sky", true).of<&Self::_sky>(),
        Property::integer("clouds", 1, 0, 9999).of<&Self::_clouds>(),
        Property::choice("edge", AUTOMATIC, {"automatic", "sea", "haze"}).of<&Self::_edge>(),
        Property::number("edgeWidth", 0.3, 0.0, 5.0).of<&Self::_edgeWidth>(),
        Property::flag("strokes", true).of<&Self::_strokes>(),
        Property::number("strokeSize", 5.0, 1.0, 200.0).of<&Self::_strokeSize>(),
        Property::number("strokeSpacing", 4.2, 1.0, 200.0).of<&Self::_strokeSpacing>(),
        Property::number("strokeStep", 25.0, 1.0, 10000.0, "m").of<&Self::_strokeStep>(),
        Property::integer("coverUnit", 7, 4, 31).of<&Self::_coverUnit>(),
        Property::integer("firstUnit", -1, -1, 29).of<&Self::_firstUnit>(),
        Property::integer("edgeUnit", -1, -1, 30).of<&Self::_edgeUnit>(),
    };
    return all;
}

std::string PanoramaMap::inconsistency() const
{
    if (_curveDistance >= _horizonDistance) return "curveDistance must be less than horizonDistance.";
    if (_firstUnit >= 0 && _firstUnit < TextureUnits::first)
        return "firstUnit must be from 4 to 29, for the geometry has those below, or -1 for the scene's "
               "choice.";
    if (_firstUnit >= 0 && _coverUnit >= _firstUnit && _coverUnit < _firstUnit + 3)
        return "coverUnit must not be one of the three units from firstUnit on.";
    if (_edgeUnit >= 0 && _edgeUnit < TextureUnits::first)
        return "edgeUnit must be from 4 to 30, for the geometry has those below, or -1 for the scene's "
               "choice.";
    if (_edgeUnit >= 0 && _edgeUnit <= _coverUnit && _coverUnit < _edgeUnit + 2)
        return "coverUnit must not be one of the two units from edgeUnit on.";
    if (_edgeUnit >= 0 && _firstUnit >= 0 && _edgeUnit < _firstUnit + 3 && _firstUnit < _edgeUnit + 2)
        return "The two units from edgeUnit on must not be among the three from firstUnit on.";
    return {};
}

osg::ref_ptr<const DeformationFrame> PanoramaMap::frame(const ViewGeometry& view) const
{
    if (!_projection) return nullptr;
    const std::optional<glsl::geofx_Panorama> panorama = panoramaOf(*this, view);
    if (!panorama) return nullptr;
    const bool perspective = view.projection(3, 3) == 0.0;
    const double scale = perspective ? std::abs(view.projection(0, 0)) : orthographicScale;
    return new PanoramaFrame(*panorama, scale / panorama->across / _detail);
}

SurfaceEffect* PanoramaMap::asSurfaceEffect()
{
    return _ground;
}

PassEffect* PanoramaMap::asPassEffect()
{
    return _scenery;
}

void PanoramaMap::setPalette(osg::Image* image)
{
    _palette = image;
    touch();
}

void PanoramaMap::setSkyImage(osg::Image* image)
{
    _skyImage = image;
    touch();
}

void PanoramaMap::setLines(StrokeLines* lines)
{
    _lines = lines;
    touch();
}

std::vector<TextureUnitWish> PanoramaMap::textureUnits() const
{
    const auto after = [&](int place)
    {
        return TextureUnitWish{"firstUnit", _firstUnit < 0 ? -1 : _firstUnit + place, 4 + place};
    };
    const auto edge = [&](int place)
    {
        return TextureUnitWish{"edgeUnit", _edgeUnit < 0 ? -1 : _edgeUnit + place, 14 + place};
    };
    return {after(0), after(1), after(2),
            edge(0),  edge(1),  {"coverUnit", _coverUnit, _coverUnit, true, true}};
}

void PanoramaMap::resizeGLObjectBuffers(unsigned int size)
{
    _textures->resizeGLObjectBuffers(size);
    _scenery->resizeGLObjectBuffers(size);
}

void PanoramaMap::releaseGLObjects(osg::State* state) const
{
    _textures->releaseGLObjects(state);
    _scenery->releaseGLObjects(state);
}

} // namespace osgGeoFX
