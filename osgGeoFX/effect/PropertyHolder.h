// SPDX-License-Identifier: MIT
// SPDX-FileCopyrightText: 2026 the osgGeoFX authors
#pragma once

#include <osgGeoFX/Export.h>
#include <osgGeoFX/effect/Property.h>

#include <osg/Object>

#include <map>
#include <string>
#include <utility>
#include <vector>

namespace osgGeoFX
{

class PropertyHolder;

/// Who wants to know of an object's changes.
class PropertyListener
{
public:
    virtual void propertyChanged(PropertyHolder& holder) = 0;

protected:
    ~PropertyListener() = default;
};

/** An object whose parameters stand in a table of properties, from which serializers, scene files, options and tests
    follow.

    Setters refuse what makes no sense: they return false, say why in one warning of OSG, and leave the last good
    state. setProperty() is the same with the sentence at hand. As everything in a scene graph, such objects are changed
    by the thread of the frame loop between frames (in the update or event traversal). */
class OSGGEOFX_EXPORT PropertyHolder : public osg::Object
{
public:
    /// All properties of the object's class.
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

    /// Objects that this one is made of, by their names in text; most have none.
    struct Part
    {
        const char* name;
        PropertyHolder* object;
    };
    virtual std::vector<Part> parts() { return {}; }

    /// Grows with each change.
    unsigned int revision() const { return _revision; }
    /// Who is told of each change, by the thread that makes it; until removed. Copies of the object do not tell them.
    void addListener(PropertyListener& listener) { _listeners.push_back(&listener); }
    void removeListener(PropertyListener& listener);

protected:
    PropertyHolder() = default;
    PropertyHolder(const PropertyHolder& other, const osg::CopyOp& copy) : osg::Object(other, copy) {}
    ~PropertyHolder() override;

    /// For typed setters: setProperty() with a warning in the place of `error`.
    bool assign(const char* name, double value);
    /// The same for several, all of them or none; they need to fit each other in the end only.
    bool assign(const std::map<std::string, double>& values);
    /// A sentence where the properties do not fit each other; then the last change is taken back.
    virtual std::string inconsistency() const { return {}; }
    void touch();

private:
    unsigned int _revision = 0;
    std::vector<PropertyListener*> _listeners;
};

} // namespace osgGeoFX
