// SPDX-License-Identifier: MIT
// SPDX-FileCopyrightText: 2026 the osgGeoFX authors
#pragma once

#include <osgGeoFX/effect/SurfaceEffect.h>
#include <osgGeoFX/effect/TextureUnits.h>

#include <osg/Texture2D>

#include <cstdint>
#include <memory>

namespace osgGeoFX
{

/** The shadows of a sun: what stands between it and the ground, a building or a mountain takes its light away.

    @code
    scene->addChild(sun);                          // light 0, such as a SunLight
    scene->addEffect(new osgGeoFX::SunShadows);
    @endcode

    **What it does.** The direct light of OpenGL's light 0, diffuse and specular, does not reach what lies in shadow; ambient
    light and other lights do. The light must have a direction (w = 0); a view's headlight does not count. Where there is no such light, one
    warning says why. Where it stands below a place's horizon, all of the
    place is in shadow. A light without a diffuse color throws none.

    **Undeformed.** Shadows are those of the undeformed world, and a place is in shadow on bent or lifted ground if it is on the plain
    one. The maps follow the eye and where it looks to along the ground, so bends find shadows for the ground that they bring into
    the picture.

    **How sharp, how far.** Each of the cascades is four times as wide as the one before, and has as many texels. The first one
    reaches about as far as the eye is above the ground below it, at least 64 m; five of them reach from 16 km, for an eye near the ground, on. Farther
    ground has no shadows. Edges are about two texels soft. The texels stay where they are while the camera moves or
    turns, and turn smoothly with the sun, so nothing shimmers.

    **Who throws, who receives.** Geometry that has no shader of its own: terrain, RigidParts, what stands below a RigidReference; at the levels
    of detail that the picture shows, and also beside it, as far as it is loaded. The maps ask for no tiles, and keep none in memory. A texture with holes throws the shadow of
    its whole polygon. Programs of applications throw none; they receive shadows if their fragment shader multiplies the light by
    `float geofx_sunlight();` (EffectScene::addFunctions). What a panorama map paints has no light, and so no shadows; names have none; lines on the ground (MapLines) get paler ones. The
    back of a face that is lit on two sides, by its vertices' normals, stays as it is. osgEarth's engine and core
    profiles have lights of their own, and get no shadows.

    **Cost.** In each frame the scene is culled once more. A cascade is drawn anew when what stands in it has changed, or the sun, or
    when the camera has moved by eight of its texels: so the wide ones, which have the most to draw, mostly stay. What a draw callback draws, or a class of
    drawables of one's own, counts as changed in each frame. Without a GPU a frame over a town takes three to four times as long where all maps are drawn
    (apps/bench/README.md).
    @ingroup light */
class OSGGEOFX_EXPORT SunShadows : public SurfaceEffect, public TextureUser
{
public:
    SunShadows();
    SunShadows(const SunShadows& other, const osg::CopyOp& copy = osg::CopyOp::SHALLOW_COPY);
    META_Object(osgGeoFX, SunShadows);

    /// How much of the sun's light shadows take away, from 0, none, to 1, the default.
    bool setStrength(double strength) { return assign("strength", strength); }
    double getStrength() const { return _strength; }
    bool isActive() const override { return getEnabled() && _strength > 0.0; }
    /// How many maps there are, 1…6. Default: 5.
    bool setCascades(int count) { return assign("cascades", count); }
    int getCascades() const { return _cascades; }
    /// The texels along the side of one map, 64…4096. Default: 2048. Each has four bytes for each camera, however many frames are on
    /// their way: 80 MiB with five maps. Where five of them in a row are wider than the context's largest texture, 96 MiB.
    bool setMapSize(int texels) { return assign("mapSize", texels); }
    int getMapSize() const { return _mapSize; }
    /// Half the width of the first map, metres, 0…100 000. The default, 0, goes by the eye's height above the ground below it.
    bool setNearest(double metres) { return assign("nearest", metres); }
    double getNearest() const { return _nearest; }

    /// The maps of all cameras, since the effect was made.
    struct Statistics
    {
        std::uint64_t drawn = 0; ///< maps that were drawn
        std::uint64_t kept = 0;  ///< maps that were used as they were drawn for an earlier frame
    };
    /// May be called from any thread.
    Statistics statistics() const;

    /// The texture unit of the maps, 4…31; the default, −1, lets the scene choose one.
    bool setMapUnit(int unit) { return assign("mapUnit", unit); }
    int getMapUnit() const { return _mapUnit; }

    using SurfaceEffect::asPassEffect;
    PassEffect* asPassEffect() override;

    const Properties& properties() const override;
    std::string vertexFile() const override { return "stages/shadows.vert.glsl"; }
    std::string fragmentFile() const override { return "stages/shadows.frag.glsl"; }
    std::vector<Varying> varyings() const override { return {{"vec3", "place"}}; }
    bool shadesLight() const override { return true; }
    bool fill(osg::StateSet& state, const std::string& prefix, const SurfaceView& view) override;
    std::vector<TextureUnitWish> textureUnits() const override;

    void resizeGLObjectBuffers(unsigned int size) override;
    void releaseGLObjects(osg::State* state) const override;

protected:
    ~SunShadows() override;

private:
    class Pass;

    double _strength = 1.0;
    int _cascades = 5;
    int _mapSize = 2048;
    double _nearest = 0.0;
    int _mapUnit = -1;
    osg::ref_ptr<osg::Texture2D> _noMaps; ///< in their place while none is drawn
    osg::ref_ptr<Pass> _pass;
};

} // namespace osgGeoFX
