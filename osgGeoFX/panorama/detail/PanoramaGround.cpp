// SPDX-License-Identifier: MIT
// SPDX-FileCopyrightText: 2026 the osgGeoFX authors
#include <osgGeoFX/panorama/detail/PanoramaGround.h>

#include <osgGeoFX/effect/detail/EyeVector.h>
#include <osgGeoFX/panorama/detail/PanoramaEdge.h>
#include <osgGeoFX/panorama/detail/PanoramaSnapshot.h>
#include <osgGeoFX/panorama/detail/PanoramaTextures.h>

#include <osg/Math>

#include <algorithm>
#include <cmath>

namespace osgGeoFX
{

namespace
{

/// How many times the brush's picture repeats across half of the picture's width.
constexpr double brushRepeats = 1.6;
/// How far edges stray for a way of 1 (geofx_handWay), in sizes of strokes. Ways are about 0.4.
constexpr double handReach = 1.0;

void set(osg::StateSet& state, const std::string& name, const osg::Vec4d& value)
{
    state.getOrCreateUniform(name, osg::Uniform::FLOAT_VEC4)->set(osg::Vec4f(value));
}

void setTexture(osg::StateSet& state, const std::string& name, int unit, osg::Texture2D* texture)
{
    const auto place = static_cast<unsigned int>(unit);
    if (state.getTextureAttribute(place, osg::StateAttribute::TEXTURE) != texture)
        state.setTextureAttribute(place, texture);
    state.getOrCreateUniform(name, osg::Uniform::SAMPLER_2D)->set(unit);
}

/** The axes of the brush's picture in eye space, and the eye's place on them. They are fixed on the ground: the frame
    of a place some degrees away. So the axes change only where nobody can compare. */
struct BrushAxes
{
    osg::Vec3d x, y;
    osg::Vec2d eye; ///< metres

    explicit BrushAxes(const SurfaceView& view)
    {
        osg::Vec3d east(1.0, 0.0, 0.0), north(0.0, 1.0, 0.0);
        osg::Matrixd toWorld;
        toWorld.invert(view.modelView);
        const osg::Vec3d place = toWorld.getTrans();
        if (view.geometry.ground.ellipsoid && place.length2() > 0.0)
        {
            const double step = osg::PI / 18.0;
            const double longitude = std::round(std::atan2(place.y(), place.x()) / step) * step;
            const double latitude =
                std::round(std::asin(std::clamp(place.z() / place.length(), -1.0, 1.0)) / step) * step;
            east.set(-std::sin(longitude), std::cos(longitude), 0.0);
            north.set(-std::sin(latitude) * std::cos(longitude), -std::sin(latitude) * std::sin(longitude),
                      std::cos(latitude));
        }
        eye.set(place * east, place * north);
        x = osg::Matrixd::transform3x3(east, view.modelView);
        y = osg::Matrixd::transform3x3(north, view.modelView);
    }
};

} // namespace

PanoramaMap::Ground::~Ground() = default;

const Properties& PanoramaMap::Ground::properties() const
{
    static const Properties none;
    return none;
}

bool PanoramaMap::Ground::fill(osg::StateSet& state, const std::string& prefix, const SurfaceView& view)
{
    const std::optional<glsl::geofx_Panorama> panorama = panoramaOf(_map, view.geometry);
    if (!panorama || !_map.getPaint()) return false;
    const auto put = [&](const char* name, const osg::Vec4d& value)
    {
        set(state, prefix + name, value);
    };
    if (!_map.getProjection())
    {
        // The projection itself is off, and the painting still needs its values.
        const osg::ref_ptr<const PanoramaSnapshot> frame = new PanoramaSnapshot(*panorama, 1.0);
        for (const auto& [name, value] : frame->uniforms())
            set(state, prefix + name, value);
    }
    const osg::Vec3d right = toOsg(panorama->right), forward = toOsg(panorama->forward);
    const double azimuth = _map.getLightAzimuth(), elevation = _map.getLightElevation();
    const osg::Vec3d light = (right * std::sin(azimuth) + forward * std::cos(azimuth)) * std::cos(elevation) +
                             view.geometry.up * std::sin(elevation);
    put("light", {light, _map.getRelief()});

    const double latitude = view.geometry.ground.ellipsoid
                                ? std::asin(std::clamp(view.geometry.up * view.geometry.polarAxis, -1.0, 1.0))
                                : view.geometry.ground.latitude;
    const double snowLine = _map.getSnowLine() >= 0.0 ? _map.getSnowLine() : glsl::geofx_snowLine(latitude);
    const double treeLine = _map.getTreeLine() >= 0.0 ? _map.getTreeLine() : treeLineAt(latitude);
    put("snow", {snowLine, glsl::geofx_winterDrop(latitude), _map.getSnowWidth(), _map.getSeason()});
    put("slopes", {_map.getCliffSlope(), _map.getHillSlope(), treeLine, _map.getBottomShade()});

    // The brush has the same size on the screen at any zoom. Two sizes of it, one twice the other, blend into each
    // other.
    const double radius = 1.0 / panorama->across;
    const double octave = std::log2(radius / brushRepeats);
    const double period = std::exp2(std::floor(octave));
    const BrushAxes axes(view);
    const auto row = [&](const osg::Vec3d& axis, double eye)
    {
        return osg::Vec4d(axis / period, std::fmod(eye, 2.0 * period) / period);
    };
    put("brushX", row(axes.x, axes.eye.x()));
    put("brushY", row(axes.y, axes.eye.y()));
    put("hand", {_map.getBrush(), octave - std::floor(octave), _map.getAtmosphere(),
                 _map.getSceneLight() ? 1.0 : 0.0});
    put("water", {_map.getDeepShore(), _map.getReflection(), _map.getRipples(), _map.getWater() ? 1.0 : 0.0});
    osg::Vec2d low, high;
    view.geometry.picturePart(low, high);
    const osg::Vec2d share = (high - low) * 0.5; // of the picture
    const osg::Vec2d pixel(share.x() / std::max(view.viewportWidth, 1.0),
                           share.y() / std::max(view.viewportHeight, 1.0));
    put("window", {view.viewportX - (0.5 + 0.5 * low.x()) / pixel.x(),
                   view.viewportY - (0.5 + 0.5 * low.y()) / pixel.y(), pixel.x(), pixel.y()});
    // At edges the hand wanders as far as a tree is high, whatever the zoom.
    const double wander = handReach * _map.getStrokeSize() * pixel.x() * 2.0 * radius;
    put("clock", {std::fmod(view.time, 3600.0), shareOf(_map.getStrength()), wander / period, wander});

    setTexture(state, prefix + "palette", view.units[PaletteUnit], _textures.palette(_map));
    setTexture(state, prefix + "brush", view.units[BrushUnit], _textures.brush());
    setTexture(state, prefix + "cover", view.units[CoverUnit], _textures.noCover());
    const PanoramaEdge edge(_map, _textures, view.geometry, view.modelView, *panorama);
    put("edgeEye", edge.eye);
    put("edgeWays", edge.ways);
    put("edgeKind", edge.kind);
    put("edgePlace", edge.sky);
    setTexture(state, prefix + "edgeMap", view.units[EdgeMapUnit], edge.map);
    setTexture(state, prefix + "edgeSky", view.units[EdgeSkyUnit], edge.skyTexture);
    // The scenery puts the reflection there if there is one.
    state.getOrCreateUniform(prefix + "mirror", osg::Uniform::SAMPLER_2D)->set(view.units[MirrorUnit]);
    return true;
}

} // namespace osgGeoFX
