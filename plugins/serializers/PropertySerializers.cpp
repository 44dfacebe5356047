// SPDX-License-Identifier: MIT
// SPDX-FileCopyrightText: 2026 the osgGeoFX authors
#include "PropertySerializers.h"

#include <osg/Notify>
#include <osgDB/InputStream>
#include <osgDB/OutputStream>

#include <algorithm>
#include <cctype>
#include <charconv>
#include <iterator>
#include <map>

namespace osgGeoFX
{

namespace
{

/// More properties than any class has: a binary file that says so is damaged.
constexpr unsigned int mostProperties = 1000;

std::string osgName(const std::string& name)
{
    std::string result = name;
    if (!result.empty()) result[0] = static_cast<char>(std::toupper(static_cast<unsigned char>(result[0])));
    return result;
}

/// As OSG writes such values; in its files angles are radians.
std::string fileText(const Property& property, double value)
{
    if (property.kind == Property::Kind::Flag) return value != 0.0 ? "TRUE" : "FALSE";
    return property.kind == Property::Kind::Choice ? property.text(value) : exactText(value);
}

bool parseFileText(const Property& property, const std::string& text, double& value, std::string& error)
{
    if (property.kind == Property::Kind::Choice) return property.parse(text, value, error);
    if (property.kind == Property::Kind::Flag)
    {
        value = text == "TRUE" ? 1.0 : 0.0;
        if (text == "TRUE" || text == "FALSE") return true;
        error = osgName(property.name) + " must be TRUE or FALSE, not \"" + text + "\".";
        return false;
    }
    if (parseExact(text, value)) return true;
    error = osgName(property.name) + " must be a number, not \"" + text + "\".";
    return false;
}

/// Collects what a file says of an object.
class Reading
{
public:
    explicit Reading(PropertyHolder& holder) : _holder(holder) {}

    void take(const Property& property, const std::string& text)
    {
        double value = 0.0;
        std::string error;
        if (parseFileText(property, text, value, error))
            _values[property.name] = value;
        else
            warn(std::string(_holder.className()) + ": " + error);
    }
    void warn(const std::string& sentence) const
    {
        OSG_WARN << "osgGeoFX: A file is wrong: " << sentence << " The default stays." << std::endl;
    }
    void finish()
    {
        std::string error;
        if (!_holder.setProperties(_values, error)) warn(error);
    }

private:
    PropertyHolder& _holder;
    std::map<std::string, double> _values;
};

void readBinary(osgDB::InputStream& stream, const Properties& properties, Reading& reading)
{
    unsigned int count = 0;
    stream >> count;
    if (count > mostProperties) stream.throwException("osgGeoFX: An object has too many properties.");
    for (unsigned int i = 0; i < count && !stream.getException(); ++i)
    {
        std::string name;
        std::string text;
        stream >> name >> text;
        if (stream.getException()) return;
        const auto found = std::find_if(properties.begin(), properties.end(),
                                        [&](const Property& each) { return osgName(each.name) == name; });
        if (found != properties.end())
            reading.take(*found, text);
        else
            reading.warn("there is no property " + name + ".");
    }
}

void readText(osgDB::InputStream& stream, const Properties& properties, Reading& reading)
{
    for (bool more = true; more;)
    {
        const auto found =
            std::find_if(properties.begin(), properties.end(),
                         [&](const Property& each) { return stream.matchString(osgName(each.name)); });
        more = found != properties.end();
        std::string text;
        if (more) stream >> text;
        more = more && !stream.getException();
        if (more) reading.take(*found, text);
    }
}

} // namespace

std::string exactText(double value)
{
    char buffer[40];
    const auto end = std::to_chars(std::begin(buffer), std::end(buffer), value).ptr;
    return {buffer, end};
}

bool parseExact(const std::string& text, double& value)
{
    const char* end = text.data() + text.size();
    const auto result = std::from_chars(text.data(), end, value);
    return result.ec == std::errc() && result.ptr == end;
}

double readNumber(osgDB::InputStream& stream, const char* className)
{
    std::string text;
    stream >> text;
    double value = 0.0;
    if (!stream.getException() && !parseExact(text, value))
        OSG_WARN << "osgGeoFX: A file is wrong: " << className << " needs a number, not \"" << text
                 << "\". It is taken as 0." << std::endl;
    return value;
}

bool PropertiesSerializer::read(osgDB::InputStream& stream, osg::Object& object)
{
    auto& holder = static_cast<PropertyHolder&>(object);
    Reading reading(holder);
    (stream.isBinary() ? readBinary : readText)(stream, holder.properties(), reading);
    reading.finish();
    return true;
}

bool PropertiesSerializer::write(osgDB::OutputStream& stream, const osg::Object& object)
{
    const auto& holder = static_cast<const PropertyHolder&>(object);
    std::map<std::string, std::string> texts;
    for (const Property& property : holder.properties())
    {
        const double value = property.get(holder);
        if (value != property.defaultValue) texts[osgName(property.name)] = fileText(property, value);
    }
    if (stream.isBinary()) stream << static_cast<unsigned int>(texts.size());
    for (const auto& [name, text] : texts)
    {
        if (stream.isBinary())
            stream << name << text;
        else
            stream << stream.PROPERTY(name.c_str()) << text << std::endl;
    }
    return true;
}

PropertyAccess::PropertyAccess(const Property& property)
    : osgDB::BaseSerializer(GET_SET_PROPERTY), _property(property.name), _name(osgName(property.name)),
      _kind(property.kind)
{
    for (std::size_t i = 0; i < property.choices.size(); ++i)
        _choices.add(property.choices[i].name.c_str(), static_cast<int>(i));
}

osgDB::BaseSerializer::Type PropertyAccess::type() const
{
    switch (_kind)
    {
    case Property::Kind::Integer:
    case Property::Kind::Color:
        return RW_INT;
    case Property::Kind::Flag:
        return RW_BOOL;
    case Property::Kind::Choice:
        return RW_ENUM;
    case Property::Kind::Number:
    case Property::Kind::Angle:
        break;
    }
    return RW_DOUBLE;
}

bool PropertyAccess::write(osgDB::OutputStream& stream, const osg::Object& object)
{
    const double value = static_cast<const PropertyHolder&>(object).getProperty(_property);
    if (type() == RW_DOUBLE)
        stream << value;
    else if (type() == RW_BOOL)
        stream << (value != 0.0);
    else
        stream << static_cast<int>(value);
    return true;
}

bool PropertyAccess::read(osgDB::InputStream& stream, osg::Object& object)
{
    double value = 0.0;
    bool flag = false;
    int whole = 0;
    if (type() == RW_DOUBLE)
        stream >> value;
    else if (type() == RW_BOOL)
        stream >> flag;
    else
        stream >> whole;
    if (type() != RW_DOUBLE) value = type() == RW_BOOL ? static_cast<double>(flag) : whole;
    std::string error;
    if (static_cast<PropertyHolder&>(object).setProperty(_property, value, error)) return true;
    OSG_WARN << "osgGeoFX: " << error << " The former value stays." << std::endl;
    return false;
}

void addProperties(osgDB::ObjectWrapper& wrapper, const PropertyHolder& holder)
{
    wrapper.addSerializer(new PropertiesSerializer, osgDB::BaseSerializer::RW_USER);
    for (const Property& property : holder.properties())
    {
        osg::ref_ptr<PropertyAccess> access = new PropertyAccess(property);
        wrapper.addSerializer(access, access->type());
    }
}

} // namespace osgGeoFX
