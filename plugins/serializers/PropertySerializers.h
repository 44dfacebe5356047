// SPDX-License-Identifier: MIT
// SPDX-FileCopyrightText: 2026 the osgGeoFX authors
#pragma once

#include <osgGeoFX/effect/PropertyHolder.h>

#include <osgDB/ObjectWrapper>
#include <osgDB/Serializer>

#include <string>

namespace osgGeoFX
{

/// The domain of the wrappers' versions. Its version in a file is 0 unless the writer names it in OSG's option
/// CustomDomains, so nothing may be left out for its sake; it is there for changes that cannot be told otherwise.
constexpr const char* serializerDomain = "osgGeoFX";

/// The shortest text that gives the same number again, in every locale. (OSG's own has six digits, and its reading is
/// off in the last ones.)
std::string exactText(double value);
/// The reverse; false where it is no number.
bool parseExact(const std::string& text, double& value);
/// The next number of a file; 0, with a warning that names the class, where it is none.
double readNumber(osgDB::InputStream& stream, const char* className);

/** Writes and reads all properties of an object.

    In text, a line for each one that is not at its default: its name as OSG has it, "FocusLine", and its value in
    radians and metres; they may stand in any order. In binary files, their number and the same names and values as
    texts, so that a file with properties of a later version can be read.

    What has been read is set in one go, since properties may depend on each other. What the object refuses stays at its
    default, with a warning. */
class PropertiesSerializer : public osgDB::BaseSerializer
{
public:
    PropertiesSerializer() : osgDB::BaseSerializer(READ_WRITE_PROPERTY) {}

    const std::string& getName() const override { return _name; }
    bool read(osgDB::InputStream& stream, osg::Object& object) override;
    bool write(osgDB::OutputStream& stream, const osg::Object& object) override;

private:
    const std::string _name = "Properties";
};

/// One property for osgDB::ClassInterface, and so for scripts and inspectors, which read from and write to a stream of
/// their own. Files go by PropertiesSerializer.
class PropertyAccess : public osgDB::BaseSerializer
{
public:
    explicit PropertyAccess(const Property& property);

    const std::string& getName() const override { return _name; }
    osgDB::BaseSerializer::Type type() const;
    osgDB::IntLookup* getIntLookup() override { return _choices.size() > 0 ? &_choices : nullptr; }
    bool read(osgDB::InputStream& stream, osg::Object& object) override;
    bool write(osgDB::OutputStream& stream, const osg::Object& object) override;

private:
    std::string _property;
    std::string _name;
    Property::Kind _kind;
    osgDB::IntLookup _choices;
};

/// Adds what the table of properties asks for.
void addProperties(osgDB::ObjectWrapper& wrapper, const PropertyHolder& holder);

} // namespace osgGeoFX
