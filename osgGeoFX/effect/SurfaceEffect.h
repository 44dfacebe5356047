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

/// What a SurfaceEffect needs to know of one camera while it culls.
/// @ingroup effect
struct SurfaceView
{
    const ViewGeometry& geometry;
    const osg::Matrixd& modelView; ///< from the frame of the EffectScene's children to eye space
    double viewportX;              ///< the viewport, pixels
    double viewportY;
    double viewportWidth;
    double viewportHeight;
    double time;                   ///< simulation time, seconds
    const std::vector<int>& units; ///< the effect's texture units (TextureUser)
};

/** An effect that colors the geometry, fragment by fragment. It goes by the geometry's undeformed place.

    To write a new surface effect, derive a class from this one:
    - Name a vertex shader file with `void SLOT_locate(vec3 eyePosition)`. This function writes the effect's own
      varyings for an undeformed position in eye space.
    - List these varyings in varyings().
    - Name a fragment shader file with `vec4 SLOT_color(vec4 color)`.
    - Fill the state of a camera in fill().

    The effects of a scene color in their order, but for those that come first (comesFirst()). The styles of bends take part
    in this order.
    apps/examples/Contours.h is an example.

    @ingroup effect */
class OSGGEOFX_EXPORT SurfaceEffect : public Effect
{
public:
    using Effect::asSurfaceEffect;
    SurfaceEffect* asSurfaceEffect() override { return this; }

    /// The shader files. `SLOT_` in them stands for the prefix of names.
    virtual std::string vertexFile() const = 0;
    virtual std::string fragmentFile() const = 0;
    /// The varyings that the vertex shader file declares with `out`; none by default. Some passes draw with a geometry or
    /// a tessellation stage, which copies what is named here. Such a pass cannot draw with a varying that is missing.
    virtual std::vector<Varying> varyings() const { return {}; }
    /// Whether the vertex file has `void SLOT_face(vec3 eyeNormal)`. This function gets the undeformed normal of length
    /// 1. False by default.
    virtual bool looksAtNormals() const { return false; }
    /// Whether SLOT_color() ignores the color that comes in, so that neither lights nor textures need to be computed.
    /// Below a state set with `setDefine("GEOFX_PAINTED", OFF)` they are computed, and SLOT_color() should return the
    /// color that comes in. False by default.
    virtual bool repaints() const { return false; }
    /// Whether an effect that repaints mixes its color with the one that comes in for now, so that lights, textures and fog
    /// are computed all the same. False by default.
    virtual bool fades() const { return false; }

    /// Whether the effect belongs to the ground's own look, so that it colors before all styles and all other surface effects,
    /// wherever it stands in the scene's list. False by default.
    virtual bool comesFirst() const { return false; }
    /// Whether the fragment file has `float SLOT_sunlight()`. It returns the share of light 0 that reaches the fragment, diffuse and
    /// specular, 0…1; of several effects the product counts. False by default.
    virtual bool shadesLight() const { return false; }

    /** Puts everything that the shaders need into a camera's state: uniforms with the prefix, and textures on the
        view's units. False if there is nothing to draw. Several cameras' threads may call it at once. Each call gets
        the camera's own state, which stays the same one until the scene's effects or their units change. */
    virtual bool fill(osg::StateSet& state, const std::string& prefix, const SurfaceView& view) = 0;

protected:
    SurfaceEffect() = default;
    SurfaceEffect(const SurfaceEffect& other, const osg::CopyOp& copy) : Effect(other, copy) {}
    ~SurfaceEffect() override;
};

} // namespace osgGeoFX
