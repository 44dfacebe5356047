// SPDX-License-Identifier: MIT
// SPDX-FileCopyrightText: 2026 the osgGeoFX authors
#pragma once

#include <osgGeoFX/Export.h>

#include <osg/Object>

#include <string>
#include <vector>

namespace osgGeoFX
{

/** A property of one of the kit's classes: what serializers, scene files, programs and tests need to know of it.

    Values travel as doubles: metres and radians, a flag as 0 or 1, a choice as its place in `choices`. */
struct OSGGEOFX_EXPORT Property
{
    enum class Kind
    {
        Number,
        Integer,
        Angle, ///< radians; people type degrees
        Flag,
        Choice
    };

    std::string name; ///< as in the setter, with a small first letter
    Kind kind = Kind::Number;
    double defaultValue = 0.0;
    double minimum = 0.0; ///< the smallest value that is taken
    double maximum = 0.0;
    std::string unit;                 ///< "m", "rad" or nothing
    std::vector<std::string> choices; ///< of a choice, as a person types them
    /// What one press of a key adds or, where keyScales is set, multiplies by; 0: keys leave the property alone.
    double keyStep = 0.0;
    bool keyScales = false;
    double (*get)(const osg::Object&) = nullptr;
    void (*put)(osg::Object&, double) = nullptr; ///< without any check

    static Property number(std::string name, double value, double minimum, double maximum,
                           std::string unit = {});
    static Property integer(std::string name, int value, int minimum, int maximum);
    static Property angle(std::string name, double value, double minimum, double maximum);
    static Property flag(std::string name, bool value);
    static Property choice(std::string name, int value, std::vector<std::string> choices);

    /// Binds a member: `Property::number(...).of<&Class::_member>()`.
    template<auto Member>
    Property of() &&;
    /// Makes it what keys turn (EffectKeys) of its effect: `Property::number(...).of<...>().turnedBy(0.02)`.
    Property turnedBy(double step) &&;
    /// The same for what grows by a factor.
    Property turnedByFactor(double factor) &&;
    /// What a value becomes by some presses of a key, less than 0 for the other way; it stays in the range.
    double turned(double value, double presses) const;

    /// The name for a person's text: degrees are said in it ("bendAngleDegrees").
    std::string textName() const;
    /// A value as a person types it: degrees, true or false, the name of a choice.
    std::string text(double value) const;
    /// The reverse. False, with a sentence in `error`, where the text is no such value or out of range.
    bool parse(const std::string& text, double& value, std::string& error) const;
    /// A sentence where the value is out of range or not a number; nothing where it is fine.
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
