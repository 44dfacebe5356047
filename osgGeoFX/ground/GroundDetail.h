// SPDX-License-Identifier: MIT
// SPDX-FileCopyrightText: 2026 the osgGeoFX authors
#pragma once

#include <osgGeoFX/effect/SurfaceEffect.h>
#include <osgGeoFX/effect/TextureUnits.h>

#include <memory>

namespace osgGeoFX
{

class DetailNoise;

/** Detail of the ground where its colors are too coarse for the camera: grass, crowns of trees, rock, sand, gardens and
    streets of towns, waves. It is what a ground of 30 m for each texel needs to be looked at from 300 m.

    **What it does.** From where a texel of the ground's colors takes two pixels, waves of noise come in, all of them from five
    pixels on. They change the ground's color and its light by what lies there. Borders between classes become sharp lines, also the
    shore. On land no color changes in the mean; water is lighter at shores. Far ground stays as it is. No wave is shown that is shorter than 2.5 pixels, so nothing
    shimmers. Waves lie on the undeformed ground, so they do not swim in bends, and are the same in each picture, from
    anywhere, on planes and globes. Nothing moves, so culling and picking do not change.

    **What it knows.** Tiles of the kit's databases say what lies on the ground (shaders/lib/cover.glsl). Such a scene has detail on
    these tiles and on nothing else. Of other terrains, slope, height and color decide; then all that is drawn counts as ground, unless a
    state set above it has `setDefine("GEOFX_DETAIL", OFF)`. Things with references of their own (RigidParts) have none. Borders
    are sharp where unit 0 has the ground's colors as a texture that modulates.

    **Order.** It belongs to the ground's own look. So it comes before all mappings and styles, wherever it stands in the list.
    What a panorama map paints has no detail.

    **Light.** Waves are lit by OpenGL's light 0. Ground without light, that of core profiles and that of programs with
    lights of their own have a light from the northwest.
    @ingroup ground */
class OSGGEOFX_EXPORT GroundDetail : public SurfaceEffect, public TextureUser
{
public:
    GroundDetail();
    GroundDetail(const GroundDetail& other, const osg::CopyOp& copy = osg::CopyOp::SHALLOW_COPY);
    META_Object(osgGeoFX, GroundDetail);

    /// How much of the detail is drawn, from 0, none, to 1, the default.
    bool setStrength(double strength) { return assign("strength", strength); }
    double getStrength() const { return _strength; }
    bool isActive() const override { return getEnabled() && _strength > 0.0; }
    /// How much light and shade waves make, 0…3. Default: 1.
    bool setRelief(double relief) { return assign("relief", relief); }
    double getRelief() const { return _relief; }
    /// How sharp borders of classes are: 0 leaves the texture's blur, 1, the default, makes lines.
    bool setEdges(double edges) { return assign("edges", edges); }
    double getEdges() const { return _edges; }
    /// The longest waves, metres, 1…5000; longer than the shortest ones. Waves of more than 8 to 16 texels of the ground's
    /// colors are left out. Default: 320.
    bool setLargest(double metres) { return assign("largest", metres); }
    double getLargest() const { return _largest; }
    /// The shortest waves, metres, 0.05…1000. There are twelve octaves at most, each 2.3 times as long as the next. Default:
    /// 0.6.
    bool setSmallest(double metres) { return assign("smallest", metres); }
    double getSmallest() const { return _smallest; }
    /// Up to which height, metres, woods are likely where nothing tells what grows, −1…12 000. The default, −1, takes it
    /// from the latitude.
    bool setTreeLine(double metres) { return assign("treeLine", metres); }
    double getTreeLine() const { return _treeLine; }

    /// The texture unit where tiles say what lies on the ground, 4…31. Default: 7.
    bool setCoverUnit(int unit) { return assign("coverUnit", unit); }
    int getCoverUnit() const { return _coverUnit; }
    /// The texture unit of the noise, 4…31; the default, −1, lets the scene choose one.
    bool setNoiseUnit(int unit) { return assign("noiseUnit", unit); }
    int getNoiseUnit() const { return _noiseUnit; }

    const Properties& properties() const override;
    std::string vertexFile() const override { return "stages/detail.vert.glsl"; }
    std::string fragmentFile() const override { return "stages/detail.frag.glsl"; }
    std::vector<Varying> varyings() const override { return {{"vec3", "position"}, {"vec3", "ground"}}; }
    bool looksAtNormals() const override { return true; }
    bool comesFirst() const override { return true; }
    bool fill(osg::StateSet& state, const std::string& prefix, const SurfaceView& view) override;
    std::vector<TextureUnitWish> textureUnits() const override;

    void resizeGLObjectBuffers(unsigned int size) override;
    void releaseGLObjects(osg::State* state) const override;

protected:
    ~GroundDetail() override;
    std::string inconsistency() const override;

private:
    double _strength = 1.0;
    double _relief = 1.0;
    double _edges = 1.0;
    double _largest = 320.0;
    double _smallest = 0.6;
    double _treeLine = -1.0;
    int _coverUnit = TextureUnits::ofCover;
    int _noiseUnit = -1;
    std::unique_ptr<DetailNoise> _noise;
};

} // namespace osgGeoFX
