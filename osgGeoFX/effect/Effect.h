// SPDX-License-Identifier: MIT
// SPDX-FileCopyrightText: 2026 the osgGeoFX authors
#pragma once

#include <osgGeoFX/effect/PropertyHolder.h>

#include <osg/ref_ptr>

namespace osgGeoFX
{

class Deformation;
class PassEffect;
class SurfaceEffect;

/** What an EffectScene hosts: something that changes how everything below the scene is drawn.

    An effect is a set of parameters. What follows from them for one camera and frame is computed while culling and
    kept with that camera, so one effect may be hosted by several scenes and drawn by several cameras at once. */
class OSGGEOFX_EXPORT Effect : public PropertyHolder
{
public:
    /// Whether it is in force. Switching changes defines and uploads nothing; the first time that a combination of
    /// effects is in force, its variant of the shaders is compiled. The first of its class's properties.
    bool setEnabled(bool enabled) { return assign("enabled", enabled ? 1.0 : 0.0); }
    bool getEnabled() const { return _enabled; }

    /// The effect as a deformation, null where it is none.
    virtual const Deformation* asDeformation() const { return nullptr; }
    /// The effect as one that colours surfaces, null where it is none.
    virtual SurfaceEffect* asSurfaceEffect() { return nullptr; }
    const SurfaceEffect* asSurfaceEffect() const { return const_cast<Effect*>(this)->asSurfaceEffect(); }
    /// The effect as one that draws the scene again, null where it is none.
    virtual PassEffect* asPassEffect() { return nullptr; }
    const PassEffect* asPassEffect() const { return const_cast<Effect*>(this)->asPassEffect(); }

protected:
    Effect() = default;
    Effect(const Effect& other, const osg::CopyOp& copy)
        : PropertyHolder(other, copy), _enabled(other._enabled)
    {
    }
    ~Effect() override;

    static Property enabledProperty();

private:
    bool _enabled = true;
};

} // namespace osgGeoFX
