// SPDX-License-Identifier: MIT
// SPDX-FileCopyrightText: 2026 the osgGeoFX authors
#pragma once

#include <osgGeoFX/Export.h>

#include <osg/Object>

#include <string>
#include <vector>

namespace osgGeoFX
{

/** Describes a property of one of the kit's classes, for serializers, scene files, programs and tests.

    Values are doubles: metres, radians, 0 or 1 for a flag, the index in `choices` for a choice.

    @ingroup effect */
struct OSGGEOFX_EXPORT Property
{
    enum class Kind
    {
        Number,
        Integer,
        Angle, ///< radians; degrees in its text form
        Flag,
        Choice
    };

    std::string name; ///< that of the setter, with a small first letter: "enabled" for setEnabled()
    Kind kind = Kind::Number;
    double defaultValue = 0.0;
    double minimum = 0.0;             ///< the smallest value allowed
    double maximum = 0.0;             ///< the largest value allowed
    std::string unit;                 ///< "m", "rad" or nothing
    std::vector<std::string> choices; ///< the text forms of a choice's values
    /// What one press of a key adds or, if keyScales is true, multiplies by. 0: keys do not change the property.
    double keyStep = 0.0;
    bool keyScales = false;
    double (*get)(const osg::Object&) = nullptr;
    void (*put)(osg::Object&, double) = nullptr; ///< sets the value without any check

    static Property number(std::string name, double value, double minimum, double maximum,
                           std::string unit = {});
    static Property integer(std::string name, int value, int minimum, int maximum);
    static Property angle(std::string name, double value, double minimum, double maximum);
    static Property flag(std::string name, bool value);
    static Property choice(std::string name, int value, std::vector<std::string> choices);

    /// Binds a member variable: `Property::number(...).of<&Class::_member>()`.
    template<auto Member>
    Property of() &&;
    /// Lets keys (EffectKeys) change the property by a step: `Property::number(...).of<...>().turnedBy(0.02)`.
    Property turnedBy(double step) &&;
    /// The same with a factor in place of a step.
    Property turnedByFactor(double factor) &&;
    /// The value after a number of key presses, clamped to the range. A negative number is for the opposite direction.
    double turned(double value, double presses) const;

    /// The name in text form. That of an angle tells the unit: "bendAngleDegrees".
    std::string textName() const;
    /// The text form of a value: an angle in degrees, a flag as true or false, a choice by its name.
    std::string text(double value) const;
    /// Reads the text form of a value. False, with a sentence in `error`, if the text is no such value or out of range.
    bool parse(const std::string& text, double& value, std::string& error) const;
    /// A sentence if the value is out of range, not a number, or not whole where it must be; empty if it is allowed.
    std::string refusal(double value) const;
};

using Properties = std::vector<Property>;

namespace detail
{
template<typename Class, typename Value>
Class ownerOf(Value Class::*);
template<typename Class, typename Value>
Value valueOf(Value Class::*);
} // namespace detail

template<auto Member>
Property Property::of() &&
{
    using Class = decltype(detail::ownerOf(Member));
    using Value = decltype(detail::valueOf(Member));
    get = [](const osg::Object& object)
    {
        return static_cast<double>(static_cast<const Class&>(object).*Member);
    };
    put = [](osg::Object& object, double value)
    {
        static_cast<Class&>(object).*Member = static_cast<Value>(value);
    };
    return std::move(*this);
}

} // namespace osgGeoFX
