// SPDX-License-Identifier: MIT
// SPDX-FileCopyrightText: 2026 the osgGeoFX authors
#pragma once

#include <osgGeoFX/effect/Effect.h>
#include <osgGeoFX/effect/ViewGeometry.h>

#include <osg/StateSet>

#include <string>
#include <vector>

namespace osgGeoFX
{

/// One camera's look at the scene while it culls.
struct SurfaceView
{
    const ViewGeometry& geometry;
    const osg::Matrixd& modelView; ///< from the frame of the EffectScene's children to eye space
    double viewportX;              ///< pixels
    double viewportY;
    double viewportWidth;
    double viewportHeight;
    double time;                   ///< of the simulation, seconds
    const std::vector<int>& units; ///< texture units that the effect has here (TextureUser)
};

/** An effect that colours what is drawn, fragment by fragment, in the geometry's undeformed place.

    To write a new one: derive from this, name the shader file with `void SLOT_locate(vec3 eyePosition)`, which writes the
    effect's own varyings for an undeformed position in eye space, and the one with `vec4 SLOT_colour(vec4 colour)`, and
    fill the state of a camera. The effects of a scene colour in their order, bends' styles among them. */
class OSGGEOFX_EXPORT SurfaceEffect : public Effect
{
public:
    using Effect::asSurfaceEffect;
    SurfaceEffect* asSurfaceEffect() override { return this; }

    /// The shader files in which `SLOT_` stands for the prefix of names.
    virtual std::string vertexFile() const = 0;
    virtual std::string fragmentFile() const = 0;
    /// Whether the vertex file has `void SLOT_face(vec3 eyeNormal)`, which gets the undeformed normal of length 1.
    virtual bool looksAtNormals() const { return false; }
    /// Whether the colour that comes in does not matter, so that neither lights nor textures need to be worked out. Below a
    /// state set with `setDefine("GEOFX_PAINTED", OFF)` it does, and SLOT_colour() should hand it on.
    virtual bool repaints() const { return false; }

    /** Puts what the shaders need into a camera's state: uniforms with the prefix, and textures on the view's units. False
        where there is nothing to draw. Several cameras' threads may call it at once; the state is the caller's own, and the
        same one until the scene's effects or their units change. */
    virtual bool fill(osg::StateSet& state, const std::string& prefix, const SurfaceView& view) = 0;

protected:
    SurfaceEffect() = default;
    SurfaceEffect(const SurfaceEffect& other, const osg::CopyOp& copy) : Effect(other, copy) {}
    ~SurfaceEffect() override;
};

} // namespace osgGeoFX
