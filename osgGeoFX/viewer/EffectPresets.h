// SPDX-License-Identifier: MIT
// SPDX-FileCopyrightText: 2026 the osgGeoFX authors
#pragma once

#include <osgGeoFX/Export.h>
#include <osgGeoFX/effect/Effect.h>
#include <osgGeoFX/scene/EffectScene.h>

#include <map>
#include <optional>
#include <string>
#include <vector>

namespace osgGeoFX
{

/** A named set of values of a scene's effects. A value.

    A setting names a property by the kind of its effect, as scene files have it, and gives its value as text: "birdsEyeView.focusLine"
    and "0.3". "birdsEyeView[2].focusLine" is that of the scene's second effect of the kind; "blendedView.pedestrianView.bendAngle" that of
    a part of an effect. What a preset does not name stays as it is.
    @ingroup viewer */
struct OSGGEOFX_EXPORT EffectPreset
{
    std::string name;
    PropertyHolder::Texts settings;

    /// All properties of a scene's effects as they are now.
    static EffectPreset of(EffectScene& scene, const std::string& name);

    /// The presets that a scene has, in their order; its files keep them (the user value `geofx.presets`). Empty, with a sentence in
    /// `error`, if it has some that cannot be read.
    static std::vector<EffectPreset> read(const EffectScene& scene, std::string& error);
    /// Gives presets to a scene, in the place of those that it has.
    static void write(EffectScene& scene, const std::vector<EffectPreset>& presets);

    /// A sentence that tells what is wrong with a setting for these effects, and the remedy; empty if nothing is.
    static std::string fault(const std::vector<osg::ref_ptr<Effect>>& effects, const std::string& property,
                             const std::string& value);
};

/** Leads the effects of a scene from what they are to a preset, step by step.

    @code
    std::string error;
    auto blend = osgGeoFX::PresetBlend::begin(*scene, preset, error);
    for (each frame) blend->set(secondsSinceThen / 1.5);
    @endcode

    Numbers, angles and colors change smoothly, begin and end slowly, and have their final values at a share of 1; directions (angles of a full
    circle, with negative ones) go the shorter way round. Flags, choices and whole numbers cannot be blended: they change halfway. So do numbers of which −1 has a meaning
    of its own, where they are −1 at one end. Each object is told its values of a step together, so listeners hear of one change.

    It needs no viewer. Use it on the thread that changes effects, between frames.
    @ingroup viewer */
class OSGGEOFX_EXPORT PresetBlend
{
public:
    /// Empty, with a sentence in `error`, if the scene has no such property or the value is refused; nothing has changed then.
    static std::optional<PresetBlend> begin(EffectScene& scene, const EffectPreset& preset,
                                            std::string& error);

    /// Puts what lies a share of the way to the preset, 0…1. False, with a sentence in `error`, if effects refuse values that do not fit
    /// others; these stay as they were.
    bool set(double share, std::string& error) const;

private:
    struct Change
    {
        const Property* property;
        double from, to;

        double at(double share) const;
    };
    std::map<osg::ref_ptr<PropertyHolder>, std::vector<Change>> _changes;
};

} // namespace osgGeoFX
