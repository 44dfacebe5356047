// SPDX-License-Identifier: MIT
// SPDX-FileCopyrightText: 2026 the osgGeoFX authors
//
// Wrappers of the mappings and of what they are made of.
#include "PropertySerializers.h"

#include <osgGeoFX/mapping/ProjectiveMappings.h>

#include <osg/Notify>
#include <osgDB/InputStream>
#include <osgDB/OutputStream>

#include <algorithm>
#include <iterator>

namespace osgGeoFX
{

namespace
{

/// Adds what a class has beside its properties.
using AddMore = void (*)(osgDB::ObjectWrapper&);

template<typename Class, AddMore More>
class Wrapper : public osgDB::RegisterCustomWrapperProxy
{
public:
    Wrapper(const std::string& name, const std::string& associates)
        : osgDB::RegisterCustomWrapperProxy([]() -> osg::Object* { return new Class; }, serializerDomain,
                                            name, associates, &add)
    {
    }

private:
    static void add(const char*, osgDB::ObjectWrapper* wrapper)
    {
        const osg::ref_ptr<Class> sample = new Class;
        addProperties(*wrapper, *sample);
        More(*wrapper);
    }
};

/// An object that another one has or has not.
template<typename Owner, typename Part, Part* (Owner::*Get)(), bool (Owner::*Set)(Part*)>
void addPart(osgDB::ObjectWrapper& wrapper, const char* name)
{
    const auto has = [](const Owner& owner)
    {
        return (const_cast<Owner&>(owner).*Get)() != nullptr;
    };
    const auto read = [](osgDB::InputStream& stream, Owner& owner)
    {
        stream >> stream.BEGIN_BRACKET;
        const osg::ref_ptr<Part> part = stream.readObjectOfType<Part>();
        stream >> stream.END_BRACKET;
        return !part || (owner.*Set)(part);
    };
    const auto write = [](osgDB::OutputStream& stream, const Owner& owner)
    {
        stream << stream.BEGIN_BRACKET << std::endl;
        stream.writeObject((const_cast<Owner&>(owner).*Get)());
        stream << stream.END_BRACKET << std::endl;
        return true;
    };
    wrapper.addSerializer(new osgDB::UserSerializer<Owner>(name, has, read, write),
                          osgDB::BaseSerializer::RW_USER);
}

void addNothing(osgDB::ObjectWrapper&) {}

void addImage(osgDB::ObjectWrapper& wrapper)
{
    const auto has = [](const DataLayer& layer)
    {
        return layer.getImage() != nullptr;
    };
    const auto read = [](osgDB::InputStream& stream, DataLayer& layer)
    {
        stream >> stream.BEGIN_BRACKET;
        const osg::ref_ptr<osg::Image> image = stream.readImage();
        stream >> stream.END_BRACKET;
        layer.setImage(image);
        return true;
    };
    const auto write = [](osgDB::OutputStream& stream, const DataLayer& layer)
    {
        stream << stream.BEGIN_BRACKET << std::endl;
        stream.writeImage(layer.getImage());
        stream << stream.END_BRACKET << std::endl;
        return true;
    };
    wrapper.addSerializer(new osgDB::UserSerializer<DataLayer>("Image", has, read, write),
                          osgDB::BaseSerializer::RW_USER);
}

void addMappingParts(osgDB::ObjectWrapper& wrapper)
{
    using Self = ProjectiveMapping;
    addPart<Self, DataLayer, &Self::getLayer, &Self::setLayer>(wrapper, "Layer");
    addPart<Self, DataLayer, &Self::getMask, &Self::setMask>(wrapper, "Mask");
    addPart<Self, ColorTable, &Self::getTable, &Self::setTable>(wrapper, "Table");
    addPart<Self, ColorTransfer, &Self::getTransfer, &Self::setTransfer>(wrapper, "Transfer");
}

void addMappings(osgDB::ObjectWrapper& wrapper)
{
    const auto has = [](const ProjectiveMappings& mappings)
    {
        return mappings.getNumMappings() > 0;
    };
    const auto read = [](osgDB::InputStream& stream, ProjectiveMappings& mappings)
    {
        unsigned int count = 0;
        stream >> count >> stream.BEGIN_BRACKET;
        for (unsigned int i = 0; i < count && !stream.getException(); ++i)
        {
            const osg::ref_ptr<ProjectiveMapping> mapping = stream.readObjectOfType<ProjectiveMapping>();
            if (mapping) mappings.addMapping(mapping);
        }
        stream >> stream.END_BRACKET;
        return true;
    };
    const auto write = [](osgDB::OutputStream& stream, const ProjectiveMappings& mappings)
    {
        stream << mappings.getNumMappings() << stream.BEGIN_BRACKET << std::endl;
        for (unsigned int i = 0; i < mappings.getNumMappings(); ++i)
            stream.writeObject(mappings.getMapping(i));
        stream << stream.END_BRACKET << std::endl;
        return true;
    };
    wrapper.addSerializer(new osgDB::UserSerializer<ProjectiveMappings>("Mappings", has, read, write),
                          osgDB::BaseSerializer::RW_USER);
}

constexpr const char* tableModes[] = {"LINEAR", "NEAREST", "EXACT", "STEPS"};

void writeColor(osgDB::OutputStream& stream, const osg::Vec4& color)
{
    for (int i = 0; i < 4; ++i)
        stream << exactText(static_cast<double>(color[i]));
}

double readNumber(osgDB::InputStream& stream)
{
    std::string text;
    stream >> text;
    double value = 0.0;
    if (!stream.getException() && !parseExact(text, value))
        OSG_WARN << "osgGeoFX: A file is wrong: ColorTable needs a number, not \"" << text
                 << "\". It is taken as 0." << std::endl;
    return value;
}

osg::Vec4 readColor(osgDB::InputStream& stream)
{
    osg::Vec4 color;
    for (int i = 0; i < 4; ++i)
        color[i] = static_cast<float>(readNumber(stream));
    return color;
}

bool readTable(osgDB::InputStream& stream, ColorTable& table)
{
    std::string mode;
    unsigned int count = 0;
    stream >> mode;
    const auto* end = std::end(tableModes);
    const auto* found = std::find(std::begin(tableModes), end, mode);
    if (found != end)
        table.setMode(static_cast<ColorTable::Mode>(found - std::begin(tableModes)));
    else
        OSG_WARN << "osgGeoFX: A file is wrong: ColorTable: the mode must be LINEAR, NEAREST, EXACT or "
                    "STEPS, not \""
                 << mode << "\". The default stays." << std::endl;
    table.setNoDataColor(readColor(stream));
    stream >> count >> stream.BEGIN_BRACKET;
    ColorTable::Stops stops;
    for (unsigned int i = 0; i < count && !stream.getException(); ++i)
    {
        const double value = readNumber(stream);
        stops.push_back({value, readColor(stream)});
    }
    stream >> stream.END_BRACKET;
    // A refusal has its own warning, and the rest of the file is fine.
    table.setStops(stops);
    return true;
}

bool writeTable(osgDB::OutputStream& stream, const ColorTable& table)
{
    stream << std::string(tableModes[table.getMode()]);
    writeColor(stream, table.getNoDataColor());
    stream << static_cast<unsigned int>(table.getStops().size()) << stream.BEGIN_BRACKET << std::endl;
    for (const ColorTable::Stop& stop : table.getStops())
    {
        stream << exactText(stop.value);
        writeColor(stream, stop.color);
        stream << std::endl;
    }
    stream << stream.END_BRACKET << std::endl;
    return true;
}

/// A table has no properties: it is a list.
class TableWrapper : public osgDB::RegisterCustomWrapperProxy
{
public:
    TableWrapper()
        : osgDB::RegisterCustomWrapperProxy([]() -> osg::Object* { return new ColorTable; }, serializerDomain,
                                            "osgGeoFX::ColorTable", "osg::Object osgGeoFX::ColorTable", &add)
    {
    }

private:
    static void add(const char*, osgDB::ObjectWrapper* wrapper)
    {
        wrapper->addSerializer(new osgDB::UserSerializer<ColorTable>(
                                   "Stops", [](const ColorTable&) { return true; }, &readTable, &writeTable),
                               osgDB::BaseSerializer::RW_USER);
    }
};

const TableWrapper tableWrapper;
const Wrapper<DataLayer, addImage> layerWrapper("osgGeoFX::DataLayer", "osg::Object osgGeoFX::DataLayer");
const Wrapper<ColorTransfer, addNothing> transferWrapper("osgGeoFX::ColorTransfer",
                                                         "osg::Object osgGeoFX::ColorTransfer");
const Wrapper<ProjectiveMapping, addMappingParts> mappingWrapper("osgGeoFX::ProjectiveMapping",
                                                                 "osg::Object osgGeoFX::ProjectiveMapping");
const Wrapper<ProjectiveMappings, addMappings>
    mappingsWrapper("osgGeoFX::ProjectiveMappings",
                    "osg::Object osgGeoFX::Effect osgGeoFX::ProjectiveMappings");

} // namespace

} // namespace osgGeoFX
