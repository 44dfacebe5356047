// SPDX-License-Identifier: MIT
// SPDX-FileCopyrightText: 2026 the osgGeoFX authors
#include <osgGeoFX/effect/Property.h>

#include <osg/Math>

#include <algorithm>
#include <charconv>
#include <cmath>

namespace osgGeoFX
{

namespace
{

std::string shortest(double value)
{
    char buffer[40];
    const auto end = std::to_chars(std::begin(buffer), std::end(buffer), value).ptr;
    return {buffer, end};
}

/// Degrees that come back as they were typed: 45, not 45.00000000000001.
double roundedDegrees(double radians)
{
    const double degrees = osg::RadiansToDegrees(radians);
    const double rounded = std::round(degrees * 1e10) / 1e10;
    return osg::DegreesToRadians(rounded) == radians ? rounded : degrees;
}

std::string joined(const std::vector<std::string>& words)
{
    std::string text;
    for (std::size_t i = 0; i < words.size(); ++i)
    {
        text += (i == 0 ? "" : i + 1 == words.size() ? " or " : ", ") + words[i];
    }
    return text;
}

} // namespace

Property Property::number(std::string name, double value, double minimum, double maximum, std::string unit)
{
    Property property;
    property.name = std::move(name);
    property.defaultValue = value;
    property.minimum = minimum;
    property.maximum = maximum;
    property.unit = std::move(unit);
    return property;
}

Property Property::integer(std::string name, int value, int minimum, int maximum)
{
    Property property = number(std::move(name), value, minimum, maximum);
    property.kind = Kind::Integer;
    return property;
}

Property Property::angle(std::string name, double value, double minimum, double maximum)
{
    Property property = number(std::move(name), value, minimum, maximum, "rad");
    property.kind = Kind::Angle;
    return property;
}

Property Property::flag(std::string name, bool value)
{
    Property property = number(std::move(name), value ? 1.0 : 0.0, 0.0, 1.0);
    property.kind = Kind::Flag;
    return property;
}

Property Property::choice(std::string name, int value, std::vector<std::string> choices)
{
    Property property = number(std::move(name), value, 0.0, static_cast<double>(choices.size()) - 1.0);
    property.kind = Kind::Choice;
    property.choices = std::move(choices);
    return property;
}

Property Property::turnedBy(double step) &&
{
    keyStep = step;
    return std::move(*this);
}

Property Property::turnedByFactor(double factor) &&
{
    keyStep = factor;
    keyScales = true;
    return std::move(*this);
}

double Property::turned(double value, double presses) const
{
    if (keyStep == 0.0) return value;
    const double turned = keyScales ? value * std::pow(keyStep, presses) : value + keyStep * presses;
    return std::clamp(turned, minimum, maximum);
}

std::string Property::textName() const
{
    return kind == Kind::Angle ? name + "Degrees" : name;
}

std::string Property::text(double value) const
{
    switch (kind)
    {
    case Kind::Angle:
        return shortest(roundedDegrees(value));
    case Kind::Flag:
        return value != 0.0 ? "true" : "false";
    case Kind::Choice:
        return choices.at(static_cast<std::size_t>(value));
    case Kind::Integer:
    case Kind::Number:
        break;
    }
    return shortest(value);
}

bool Property::parse(const std::string& text, double& value, std::string& error) const
{
    if (kind == Kind::Choice || kind == Kind::Flag)
    {
        const std::vector<std::string> flags = {"false", "true"};
        const std::vector<std::string>& words = kind == Kind::Flag ? flags : choices;
        for (std::size_t i = 0; i < words.size(); ++i)
        {
            if (words[i] != text) continue;
            value = static_cast<double>(i);
            return true;
        }
        error = textName() + " must be " + joined(words) + ", not \"" + text + "\".";
        return false;
    }
    double number = 0.0;
    const char* end = text.data() + text.size();
    const auto result = std::from_chars(text.data(), end, number);
    if (result.ec != std::errc() || result.ptr != end)
    {
        error = textName() + " must be a number, not \"" + text + "\".";
        return false;
    }
    if (kind == Kind::Angle) number = osg::DegreesToRadians(number);
    error = refusal(number);
    if (!error.empty()) return false;
    value = number;
    return true;
}

std::string Property::refusal(double value) const
{
    if (value >= minimum && value <= maximum)
    {
        const bool whole = kind == Kind::Flag || kind == Kind::Choice || kind == Kind::Integer;
        if (!whole || value == std::floor(value)) return {};
    }
    const std::string shown = std::isfinite(value) && kind == Kind::Angle ? text(value) : shortest(value);
    const std::string what = kind == Kind::Angle ? " degrees" : unit.empty() ? "" : " " + unit;
    const auto bound = [&](double limit)
    {
        return kind == Kind::Angle ? text(limit) : shortest(limit);
    };
    return textName() + " must " + (kind == Kind::Integer ? "be a whole number" : "lie") + " between " +
           bound(minimum) + " and " + bound(maximum) + what + ", not " + shown + ".";
}

} // namespace osgGeoFX
