// SPDX-License-Identifier: MIT
// SPDX-FileCopyrightText: 2026 the osgGeoFX authors
#pragma once

#include "PropertySerializers.h"

#include <osg/Image>
#include <osgDB/InputStream>
#include <osgDB/OutputStream>

#include <string>
#include <type_traits>

namespace osgGeoFX
{

/// Adds what a class has beside its properties.
using AddMore = void (*)(osgDB::ObjectWrapper&);

inline void addNothing(osgDB::ObjectWrapper&) {}

/// Of a class with properties.
template<typename Class, AddMore More = addNothing>
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

/// Something that only functions of our own can write and read.
template<typename Owner>
void addOwn(osgDB::ObjectWrapper& wrapper, const char* name, bool (*has)(const Owner&),
            bool (*read)(osgDB::InputStream&, Owner&), bool (*write)(osgDB::OutputStream&, const Owner&))
{
    wrapper.addSerializer(new osgDB::UserSerializer<Owner>(name, has, read, write),
                          osgDB::BaseSerializer::RW_USER);
}

/// An object that another one has or has not. It may be shared with others.
template<typename Owner, typename Part, Part* (Owner::*Get)(), auto Set>
void addPart(osgDB::ObjectWrapper& wrapper, const char* name)
{
    addOwn<Owner>(
        wrapper, name, [](const Owner& owner) { return (const_cast<Owner&>(owner).*Get)() != nullptr; },
        [](osgDB::InputStream& stream, Owner& owner)
        {
            stream >> stream.BEGIN_BRACKET;
            const osg::ref_ptr<Part> part = stream.readObjectOfType<Part>();
            stream >> stream.END_BRACKET;
            if constexpr (std::is_void_v<decltype((owner.*Set)(part))>)
            {
                if (part) (owner.*Set)(part);
                return true;
            }
            else
            {
                return !part || (owner.*Set)(part);
            }
        },
        [](osgDB::OutputStream& stream, const Owner& owner)
        {
            stream << stream.BEGIN_BRACKET << std::endl;
            stream.writeObject((const_cast<Owner&>(owner).*Get)());
            stream << stream.END_BRACKET << std::endl;
            return true;
        });
}

/// The objects of a list, in their order. They may be shared with others.
template<typename Owner, typename Part, unsigned int (Owner::*Count)() const,
         const Part* (Owner::*At)(unsigned int) const, bool (Owner::*Add)(Part*)>
void addParts(osgDB::ObjectWrapper& wrapper, const char* name)
{
    addOwn<Owner>(
        wrapper, name, [](const Owner& owner) { return (owner.*Count)() > 0; },
        [](osgDB::InputStream& stream, Owner& owner)
        {
            unsigned int count = 0;
            stream >> count >> stream.BEGIN_BRACKET;
            for (unsigned int i = 0; i < count && !stream.getException(); ++i)
            {
                // Null where this version of the kit does not know the class; OSG has said so.
                const osg::ref_ptr<Part> part = stream.readObjectOfType<Part>();
                if (part) (owner.*Add)(part);
            }
            stream >> stream.END_BRACKET;
            return true;
        },
        [](osgDB::OutputStream& stream, const Owner& owner)
        {
            stream << (owner.*Count)() << stream.BEGIN_BRACKET << std::endl;
            for (unsigned int i = 0; i < (owner.*Count)(); ++i)
                stream.writeObject((owner.*At)(i));
            stream << stream.END_BRACKET << std::endl;
            return true;
        });
}

/// Null where a file has ended before: OSG would take whatever is in memory for the image's size.
inline osg::ref_ptr<osg::Image> readImage(osgDB::InputStream& stream)
{
    return stream.getException() ? nullptr : stream.readImage();
}

/// An image that an object has or has not.
template<typename Owner, const osg::Image* (Owner::*Get)() const, auto Set>
void addImage(osgDB::ObjectWrapper& wrapper, const char* name)
{
    addOwn<Owner>(
        wrapper, name, [](const Owner& owner) { return (owner.*Get)() != nullptr; },
        [](osgDB::InputStream& stream, Owner& owner)
        {
            stream >> stream.BEGIN_BRACKET;
            const osg::ref_ptr<osg::Image> image = readImage(stream);
            stream >> stream.END_BRACKET;
            (owner.*Set)(image);
            return true;
        },
        [](osgDB::OutputStream& stream, const Owner& owner)
        {
            stream << stream.BEGIN_BRACKET << std::endl;
            stream.writeImage((owner.*Get)());
            stream << stream.END_BRACKET << std::endl;
            return true;
        });
}

} // namespace osgGeoFX
