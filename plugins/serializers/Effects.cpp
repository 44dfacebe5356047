// SPDX-License-Identifier: MIT
// SPDX-FileCopyrightText: 2026 the osgGeoFX authors
//
// Wrappers of the effects. A new effect needs one line at the end.
#include "PropertySerializers.h"

#include <osgGeoFX/deformation/BlendedView.h>
#include <osgGeoFX/deformation/VerticalExaggeration.h>

#include <osgDB/InputStream>
#include <osgDB/OutputStream>

#include <type_traits>

namespace osgGeoFX
{

namespace
{

/// Of a class that has no objects of its own; the wrappers of derived classes write and read everything.
class BaseWrapper : public osgDB::RegisterCustomWrapperProxy
{
public:
    BaseWrapper(const std::string& name, const std::string& associates)
        : osgDB::RegisterCustomWrapperProxy([]() -> osg::Object* { return nullptr; }, serializerDomain, name,
                                            associates, nullptr)
    {
    }
};

void addParts(osgDB::ObjectWrapper&, const Effect&) {}
void addParts(osgDB::ObjectWrapper& wrapper, const BlendedView&);

template<typename Class>
class EffectWrapper : public osgDB::RegisterCustomWrapperProxy
{
public:
    EffectWrapper(const std::string& name, const std::string& associates)
        : osgDB::RegisterCustomWrapperProxy([]() -> osg::Object* { return new Class; }, serializerDomain,
                                            name, associates, &add)
    {
    }

private:
    static void add(const char*, osgDB::ObjectWrapper* wrapper)
    {
        const osg::ref_ptr<Class> sample = new Class;
        addProperties(*wrapper, *sample);
        addParts(*wrapper, *sample);
    }
};

/// A part of a blended view. It is always written: it may be shared with another view.
template<typename Part>
class PartSerializer : public osgDB::UserSerializer<BlendedView>
{
public:
    explicit PartSerializer(const char* name)
        : osgDB::UserSerializer<BlendedView>(
              name, [](const BlendedView&) { return true; }, &readPart, &writePart)
    {
    }

private:
    static const Part* partOf(const BlendedView& view)
    {
        if constexpr (std::is_same_v<Part, BirdsEyeView>)
            return view.getBirdsEyeView();
        else
            return view.getPedestrianView();
    }

    static bool readPart(osgDB::InputStream& stream, BlendedView& view)
    {
        stream >> stream.BEGIN_BRACKET;
        const osg::ref_ptr<Part> part = stream.readObjectOfType<Part>();
        stream >> stream.END_BRACKET;
        if constexpr (std::is_same_v<Part, BirdsEyeView>)
            return view.setBirdsEyeView(part);
        else
            return view.setPedestrianView(part);
    }

    static bool writePart(osgDB::OutputStream& stream, const BlendedView& view)
    {
        stream << stream.BEGIN_BRACKET << std::endl;
        stream.writeObject(partOf(view));
        stream << stream.END_BRACKET << std::endl;
        return true;
    }
};

void addParts(osgDB::ObjectWrapper& wrapper, const BlendedView&)
{
    wrapper.addSerializer(new PartSerializer<BirdsEyeView>("BirdsEyeView"), osgDB::BaseSerializer::RW_USER);
    wrapper.addSerializer(new PartSerializer<PedestrianView>("PedestrianView"),
                          osgDB::BaseSerializer::RW_USER);
}

const std::string effect = "osg::Object osgGeoFX::Effect";
const std::string deformation = effect + " osgGeoFX::Deformation";
const std::string bend = deformation + " osgGeoFX::PerspectiveBend";

const BaseWrapper effectWrapper("osgGeoFX::Effect", effect);
const BaseWrapper deformationWrapper("osgGeoFX::Deformation", deformation);
const BaseWrapper bendWrapper("osgGeoFX::PerspectiveBend", bend);
const EffectWrapper<BirdsEyeView> birdsEyeView("osgGeoFX::BirdsEyeView", bend + " osgGeoFX::BirdsEyeView");
const EffectWrapper<PedestrianView> pedestrianView("osgGeoFX::PedestrianView",
                                                   bend + " osgGeoFX::PedestrianView");
const EffectWrapper<BlendedView> blendedView("osgGeoFX::BlendedView", bend + " osgGeoFX::BlendedView");
const EffectWrapper<VerticalExaggeration>
    verticalExaggeration("osgGeoFX::VerticalExaggeration", deformation + " osgGeoFX::VerticalExaggeration");

} // namespace

} // namespace osgGeoFX
