// SPDX-License-Identifier: MIT
// SPDX-FileCopyrightText: 2026 the osgGeoFX authors
#pragma once

#include <osgGeoFX/Export.h>
#include <osgGeoFX/scene/Property.h>

#include <osg/Object>
#include <osg/ref_ptr>

#include <map>
#include <string>
#include <utility>
#include <vector>

namespace osgGeoFX
{

class Deformation;

/** What an EffectScene hosts: something that changes how everything below the scene is drawn.

    An effect is a set of parameters. What follows from them for one camera and frame is computed while culling and
    kept with that camera, so one effect may be hosted by several scenes and drawn by several cameras at once.

    Setters refuse what makes no sense: they return false, say why in one warning of OSG, and leave the last good
    state. setProperty() is the same with the sentence at hand. As everything in a scene graph, effects are changed by
    the thread of the frame loop between frames (in the update or event traversal). */
class OSGGEOFX_EXPORT Effect : public osg::Object
{
public:
    /// Whether it is in force. Switching changes defines and uploads nothing; the first time that a combination of effects is
    /// in force, its variant of the shaders is compiled.
    bool setEnabled(bool enabled) { return assign("enabled", enabled ? 1.0 : 0.0); }
    bool getEnabled() const { return _enabled; }

    /// All properties of the effect's class, "enabled" first.
    virtual const Properties& properties() const = 0;
    const Property* property(const std::string& name) const;
    /// The same as the typed setter and getter. False, with a sentence in `error`, where the value is refused.
    bool setProperty(const std::string& name, double value, std::string& error);
    double getProperty(const std::string& name) const;
    /// Several at once, by name: they need to fit each other in the end only, not on the way. Where some are refused,
    /// these keep their former values and the others are taken; then it is false, with a sentence for each in `error`.
    bool setProperties(const std::map<std::string, double>& values, std::string& error);
    /// From the texts that a person types: "bendAngleDegrees", "30"; of a part, "birdsEyeView.focusLine".
    bool setPropertyText(const std::string& name, const std::string& value, std::string& error);
    /// Several at once, in any order; of a name that comes twice the last counts. False at the first mistake, with a
    /// sentence in `error`.
    using Texts = std::vector<std::pair<std::string, std::string>>;
    bool setPropertyTexts(const Texts& texts, std::string& error);

    /// Effects that this one is made of, by their kinds' names in text; most have none.
    struct Part
    {
        const char* name;
        Effect* effect;
    };
    virtual std::vector<Part> parts() { return {}; }

    /// The effect as a deformation, null where it is none.
    virtual const Deformation* asDeformation() const { return nullptr; }

    /// Grows with each change.
    unsigned int revision() const { return _revision; }

protected:
    Effect() = default;
    Effect(const Effect& other, const osg::CopyOp& copy) : osg::Object(other, copy), _enabled(other._enabled)
    {
    }
    ~Effect() override;

    /// For typed setters: setProperty() with a warning in the place of `error`.
    bool assign(const char* name, double value);
    /// A sentence where the properties do not fit each other; then the last change is taken back.
    virtual std::string inconsistency() const { return {}; }
    void touch() { ++_revision; }

    static Property enabledProperty();

private:
    bool _enabled = true;
    unsigned int _revision = 0;
};

} // namespace osgGeoFX
