// SPDX-License-Identifier: MIT
// SPDX-FileCopyrightText: 2026 the osgGeoFX authors
#pragma once

#include <osgGeoFX/Export.h>

#include <osg/Object>
#include <osg/Vec3d>
#include <osg/ref_ptr>

#include <string>
#include <type_traits>
#include <utility>
#include <vector>

namespace osgGeoFX
{

/** Describes a property of one of the kit's classes. Everything else that knows of properties is made from this table:
    serializers, the schema of scene files, the page of all properties, help texts, panels and tests.

    Values are doubles: metres, radians, 0 or 1 for a flag, the index in `choices` for a choice, 0xrrggbb for a color.
    Text forms are for people, in scene files, options and panels: an angle is in degrees there, and a color is
    "#rrggbb".

    @ingroup effect */
struct OSGGEOFX_EXPORT Property
{
    enum class Kind
    {
        Number,
        Integer,
        Angle, ///< radians; degrees in its text form
        Flag,
        Choice,
        Color ///< 0xrrggbb, eight bits for each of red, green and blue
    };
    /// One of the values of a choice.
    struct Choice
    {
        std::string name;        ///< its text form
        std::string description; ///< what it means; empty where the name says all
    };

    std::string name;        ///< that of the setter, with a small first letter: "enabled" for setEnabled()
    std::string description; ///< what it is, as a phrase without range and unit: "the depth; 0 is none"
    Kind kind = Kind::Number;
    double defaultValue = 0.0;
    double minimum = 0.0; ///< the smallest value allowed
    double maximum = 0.0; ///< the largest value allowed
    std::string unit;     ///< "m", "rad", "rad/s", "px", "texel", "MiB" or nothing
    std::vector<Choice> choices;
    /// What one press of a key adds or, if keyScales is true, multiplies by. 0: keys do not change the property.
    double keyStep = 0.0;
    bool keyScales = false;
    double (*get)(const osg::Object&) = nullptr;
    void (*put)(osg::Object&, double) = nullptr; ///< sets the value without any check

    static Property number(std::string name, std::string description, double minimum, double maximum,
                           std::string unit = {});
    static Property integer(std::string name, std::string description, int minimum, int maximum,
                            std::string unit = {});
    /// `unit`: "rad", or "rad/s" for a rate of turn.
    static Property angle(std::string name, std::string description, double minimum, double maximum,
                          std::string unit = "rad");
    static Property flag(std::string name, std::string description);
    static Property choice(std::string name, std::string description, std::vector<Choice> choices);
    static Property color(std::string name, std::string description);

    /// Binds a member variable: `Property::number(...).of<&Class::_member>()`. More parameters lead on to a member of that
    /// member: `of<&Class::_origin, &LocalOrigin::x>()`.
    template<auto Member, auto... Parts>
    Property of() &&;
    /// Lets keys (EffectKeys) change the property by a step: `Property::number(...).of<...>().turnedBy(0.02)`.
    Property turnedBy(double step) &&;
    /// The same with a factor in place of a step.
    Property turnedByFactor(double factor) &&;
    /// The value after a number of key presses, clamped to the range. A negative number is for the opposite direction.
    double turned(double value, double presses) const;

    /// The text form of a value: an angle in degrees, a flag as true or false, a choice by its name, a color as
    /// "#rrggbb".
    std::string text(double value) const;
    /// Reads the text form of a value. False, with a sentence in `error`, if the text is no such value or out of range.
    bool parse(const std::string& text, double& value, std::string& error) const;
    /// A sentence if the value is out of range, not a number, or not whole where it must be; empty if it is allowed.
    std::string refusal(double value) const;

    /// The unit of the text form, written out: "metres", "degrees"; empty where there is none.
    std::string textUnit() const;
    /// Which text forms there are: "metres, from 0 to 100", "true or false", "\"a\" (which is so) or \"b\"".
    std::string range() const;
    /// The description with the range, which stands before a remark that follows a semicolon: "the depth, metres, from 0
    /// to 9; 0 is none".
    std::string documentation() const;
};

/// Red, green and blue, 0…1, of a color 0xrrggbb, and the reverse, rounded to eight bits. A component beyond 0…1 gives
/// −1, which every property refuses.
/// @ingroup effect
OSGGEOFX_EXPORT osg::Vec3d unpackedColor(int color);
OSGGEOFX_EXPORT int packedColor(const osg::Vec3d& color);

using Properties = std::vector<Property>;

/// The table of a class: takes each property's default from an object with default values. `new Class` will do.
/// @ingroup effect
OSGGEOFX_EXPORT Properties withDefaultsOf(const osg::ref_ptr<const osg::Object>& object,
                                          Properties properties);

namespace detail
{
template<typename Class, typename Value>
Class ownerOf(Value Class::*);

/// The member that a path of members leads to.
template<auto Member, auto... Parts, typename Object>
auto& memberOf(Object& object)
{
    if constexpr (sizeof...(Parts) == 0)
        return object.*Member;
    else
        return memberOf<Parts...>(object.*Member);
}
} // namespace detail

template<auto Member, auto... Parts>
Property Property::of() &&
{
    using Class = decltype(detail::ownerOf(Member));
    using Value = std::decay_t<decltype(detail::memberOf<Member, Parts...>(std::declval<Class&>()))>;
    get = [](const osg::Object& object)
    {
        return static_cast<double>(detail::memberOf<Member, Parts...>(static_cast<const Class&>(object)));
    };
    put = [](osg::Object& object, double value)
    {
        detail::memberOf<Member, Parts...>(static_cast<Class&>(object)) = static_cast<Value>(value);
    };
    return std::move(*this);
}

} // namespace osgGeoFX
