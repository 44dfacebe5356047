// SPDX-License-Identifier: MIT
// SPDX-FileCopyrightText: 2026 the osgGeoFX authors
#include <osgGeoFX/effect/Property.h>

#include <osg/Math>

#include <algorithm>
#include <charconv>
#include <cmath>
#include <cstdio>
#include <map>

namespace osgGeoFX
{

namespace
{

/// The shortest text that gives the number again, without an exponent where that is readable.
std::string shortest(double value)
{
    char buffer[40];
    const double size = std::abs(value);
    const bool plain = value == 0.0 || (size >= 1e-5 && size < 1e15);
    const auto end =
        plain ? std::to_chars(std::begin(buffer), std::end(buffer), value, std::chars_format::fixed).ptr
              : std::to_chars(std::begin(buffer), std::end(buffer), value).ptr;
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

std::vector<std::string> flagWords()
{
    return {"false", "true"};
}

std::vector<std::string> names(const std::vector<Property::Choice>& choices)
{
    std::vector<std::string> result;
    for (const Property::Choice& choice : choices)
        result.push_back(choice.name);
    return result;
}

bool isWhole(Property::Kind kind)
{
    return kind != Property::Kind::Number && kind != Property::Kind::Angle;
}

std::string limitText(const Property& property, double limit)
{
    return property.kind == Property::Kind::Angle ? property.text(limit) : shortest(limit);
}

std::string colorText(int color)
{
    char buffer[8];
    std::snprintf(buffer, sizeof buffer, "#%06x", static_cast<unsigned int>(color) & 0xffffffu);
    return buffer;
}

bool parseNumber(const std::string& text, double& value)
{
    const char* end = text.data() + text.size();
    const auto result = std::from_chars(text.data(), end, value);
    return result.ec == std::errc() && result.ptr == end;
}

bool parseColor(const std::string& text, double& value)
{
    if (text.size() != 7 || text[0] != '#') return false;
    unsigned int number = 0;
    const char* end = text.data() + text.size();
    const auto result = std::from_chars(text.data() + 1, end, number, 16);
    value = number;
    return result.ec == std::errc() && result.ptr == end;
}

} // namespace

Property Property::number(std::string name, std::string description, double minimum, double maximum,
                          std::string unit)
{
    Property property;
    property.name = std::move(name);
    property.description = std::move(description);
    property.minimum = minimum;
    property.maximum = maximum;
    property.unit = std::move(unit);
    return property;
}

Property Property::integer(std::string name, std::string description, int minimum, int maximum,
                           std::string unit)
{
    Property property = number(std::move(name), std::move(description), minimum, maximum, std::move(unit));
    property.kind = Kind::Integer;
    return property;
}

Property Property::angle(std::string name, std::string description, double minimum, double maximum,
                         std::string unit)
{
    Property property = number(std::move(name), std::move(description), minimum, maximum, std::move(unit));
    property.kind = Kind::Angle;
    return property;
}

Property Property::flag(std::string name, std::string description)
{
    Property property = number(std::move(name), std::move(description), 0.0, 1.0);
    property.kind = Kind::Flag;
    return property;
}

Property Property::choice(std::string name, std::string description, std::vector<Choice> choices)
{
    Property property =
        number(std::move(name), std::move(description), 0.0, static_cast<double>(choices.size()) - 1.0);
    property.kind = Kind::Choice;
    property.choices = std::move(choices);
    return property;
}

Property Property::color(std::string name, std::string description)
{
    Property property = number(std::move(name), std::move(description), 0.0, 0xffffff);
    property.kind = Kind::Color;
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

std::string Property::text(double value) const
{
    switch (kind)
    {
    case Kind::Angle:
        return shortest(roundedDegrees(value));
    case Kind::Flag:
        return value != 0.0 ? "true" : "false";
    case Kind::Choice:
        return choices.at(static_cast<std::size_t>(value)).name;
    case Kind::Color:
        return colorText(static_cast<int>(value));
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
        const std::vector<std::string> words = kind == Kind::Flag ? flagWords() : names(choices);
        for (std::size_t i = 0; i < words.size(); ++i)
        {
            if (words[i] != text) continue;
            value = static_cast<double>(i);
            return true;
        }
        error = name + " must be " + joined(words) + ", not \"" + text + "\".";
        return false;
    }
    double number = 0.0;
    const bool isColor = kind == Kind::Color;
    if (!(isColor ? parseColor(text, number) : parseNumber(text, number)))
    {
        error = name + " must be " + (isColor ? range() : "a number") + ", not \"" + text + "\".";
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
    if (value >= minimum && value <= maximum && (!isWhole(kind) || value == std::floor(value))) return {};
    if (kind == Kind::Color)
        return name + " must be " + range() + "; red, green and blue lie between 0 and 1.";
    const std::string shown = std::isfinite(value) && kind == Kind::Angle ? text(value) : shortest(value);
    const std::string what = textUnit().empty() ? "" : " " + textUnit();
    return name + " must " + (kind == Kind::Integer ? "be a whole number" : "lie") + " between " +
           limitText(*this, minimum) + " and " + limitText(*this, maximum) + what + ", not " + shown + ".";
}

std::string Property::textUnit() const
{
    static const std::map<std::string, std::string> words = {
        {"m", "metres"},  {"rad", "degrees"},  {"rad/s", "degrees a second"},
        {"px", "pixels"}, {"texel", "texels"},
    };
    const auto found = words.find(unit);
    return found == words.end() ? unit : found->second;
}

std::string Property::range() const
{
    if (kind == Kind::Flag) return "true or false";
    if (kind == Kind::Color) return "\"#\" and two hexadecimal digits each for red, green and blue";
    if (kind == Kind::Choice)
    {
        std::vector<std::string> words;
        for (const Choice& choice : choices)
            words.push_back("\"" + choice.name + "\"" +
                            (choice.description.empty() ? "" : " (" + choice.description + ")"));
        return joined(words);
    }
    return (unit.empty() ? "" : textUnit() + ", ") + (kind == Kind::Integer ? "a whole number " : "") +
           "from " + limitText(*this, minimum) + " to " + limitText(*this, maximum);
}

std::string Property::documentation() const
{
    const std::size_t end = std::min(description.find(';'), description.size());
    return description.substr(0, end) + (kind == Kind::Choice ? ": " : ", ") + range() +
           description.substr(end);
}

Properties withDefaultsOf(const osg::ref_ptr<const osg::Object>& object, Properties properties)
{
    for (Property& property : properties)
        property.defaultValue = property.get(*object);
    return properties;
}

osg::Vec3d unpackedColor(int color)
{
    return osg::Vec3d(color >> 16 & 255, color >> 8 & 255, color & 255) / 255.0;
}

int packedColor(const osg::Vec3d& color)
{
    int packed = 0;
    for (int i = 0; i < 3; ++i)
    {
        if (!(color[i] >= 0.0 && color[i] <= 1.0)) return -1;
        packed = packed << 8 | static_cast<int>(std::lround(255.0 * color[i]));
    }
    return packed;
}

} // namespace osgGeoFX
