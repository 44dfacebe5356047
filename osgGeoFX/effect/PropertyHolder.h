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

/// Is told of the changes of a PropertyHolder.
/// @ingroup effect
class PropertyListener
{
public:
    /// Called after each change, by the thread that makes it.
    virtual void propertyChanged(PropertyHolder& holder) = 0;

protected:
    ~PropertyListener() = default;
};

/** An object whose parameters stand in a table of properties. Serializers, scene files, options and tests use this
    table.

    A setter refuses an invalid value: it returns false, tells the reason in one warning of OSG, and keeps the last
    valid state. setProperty() does the same and returns the reason as a sentence. The thread of the frame loop
    changes such objects between frames (in the update or event traversal), as everything in a scene graph.

    @ingroup effect */
class OSGGEOFX_EXPORT PropertyHolder : public osg::Object
{
public:
    /// All properties of the object's class.
    virtual const Properties& properties() const = 0;
    /// The property of a name; null if there is none.
    const Property* property(const std::string& name) const;
    /// Sets a property as the typed setter does. False, with a sentence in `error`, if the value is refused.
    bool setProperty(const std::string& name, double value, std::string& error);
    /// The value of a property; 0 if there is none of this name.
    double getProperty(const std::string& name) const;
    /// Sets several properties by name. Only the final values need to fit each other, not the steps between. If some
    /// are refused, they keep their former values and the others are set. The result is then false, with a sentence for
    /// each in `error`.
    bool setProperties(const std::map<std::string, double>& values, std::string& error);
    /// Sets a property from text: "bendAngle", "30" (degrees). The name of a property of a part is
    /// "birdsEyeView.focusLine".
    bool setPropertyText(const std::string& name, const std::string& value, std::string& error);
    /// Sets several properties from text, in any order. If a name occurs twice, the last value counts. False at the
    /// first mistake, with a sentence in `error`.
    using Texts = std::vector<std::pair<std::string, std::string>>;
    bool setPropertyTexts(const Texts& texts, std::string& error);

    /// An object that this one consists of, with its name in text.
    struct Part
    {
        const char* name;
        PropertyHolder* object;
    };
    /// The parts of this object; none by default.
    virtual std::vector<Part> parts() { return {}; }

    /// Grows with each change.
    unsigned int revision() const { return _revision; }
    /// Tells a listener of each change until it is removed, on the thread that makes the change. Copies of the object
    /// do not tell it.
    void addListener(PropertyListener& listener) { _listeners.push_back(&listener); }
    void removeListener(PropertyListener& listener);

protected:
    PropertyHolder() = default;
    PropertyHolder(const PropertyHolder& other, const osg::CopyOp& copy) : osg::Object(other, copy) {}
    ~PropertyHolder() override;

    /// For typed setters: setProperty() with a warning instead of `error`.
    bool assign(const char* name, double value);
    /// The same for several properties: sets all of them or none. Only the final values need to fit each other.
    bool assign(const std::map<std::string, double>& values);
    /// A sentence if the properties do not fit each other; the last change is then undone. Empty if they fit.
    virtual std::string inconsistency() const { return {}; }
    /// Notes a change: revision() grows, and the listeners are told.
    void touch();

private:
    unsigned int _revision = 0;
    std::vector<PropertyListener*> _listeners;
};

} // namespace osgGeoFX
