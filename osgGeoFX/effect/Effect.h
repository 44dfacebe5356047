// SPDX-License-Identifier: MIT
// SPDX-FileCopyrightText: 2026 the osgGeoFX authors
#pragma once

#include <osgGeoFX/effect/PropertyHolder.h>

#include <osg/ref_ptr>

#include <string>
#include <vector>

namespace osgGeoFX
{

class Deformation;
class PassEffect;
class SurfaceEffect;

/// A variable that an effect's vertex shader file hands to its fragment shader file.
/// @ingroup effect
struct Varying
{
    std::string type;  ///< its type in GLSL: "float", "vec3", "int"
    std::string name;  ///< its name without `SLOT_`
    bool flat = false; ///< whether the files declare it `flat`
};

/** An effect of an EffectScene: it changes how everything below the scene is drawn.

    An effect is a set of parameters. Culling computes what follows from them for each camera and frame, and keeps it
    with that camera. So several scenes may host one effect, and several cameras may draw it at once.

    @ingroup effect */
class OSGGEOFX_EXPORT Effect : public PropertyHolder
{
public:
    /// Switches the effect on or off; on by default. Switching changes defines and uploads nothing. A combination of
    /// effects compiles its variant of the shaders when it is first drawn. A class with this switch lists
    /// enabledProperty() as the first of its properties; without it, this setter refuses.
    bool setEnabled(bool enabled) { return assign("enabled", enabled ? 1.0 : 0.0); }
    bool getEnabled() const { return _enabled; }

    /// Whether the effect changes anything that is drawn: it is switched on, and no strength of it is 0. A scene leaves
    /// out the others.
    virtual bool isActive() const { return _enabled; }

    /// The effect as a deformation; null if it is none.
    virtual const Deformation* asDeformation() const { return nullptr; }
    /// The effect as one that colors surfaces; null if it is none.
    virtual SurfaceEffect* asSurfaceEffect() { return nullptr; }
    const SurfaceEffect* asSurfaceEffect() const { return const_cast<Effect*>(this)->asSurfaceEffect(); }
    /// The effect as one that draws the scene again; null if it is none.
    virtual PassEffect* asPassEffect() { return nullptr; }
    const PassEffect* asPassEffect() const { return const_cast<Effect*>(this)->asPassEffect(); }

protected:
    Effect() = default;
    Effect(const Effect& other, const osg::CopyOp& copy)
        : PropertyHolder(other, copy), _enabled(other._enabled)
    {
    }
    ~Effect() override;

    /// The property "enabled", for the table of a class.
    static Property enabledProperty();

private:
    bool _enabled = true;
};

} // namespace osgGeoFX
