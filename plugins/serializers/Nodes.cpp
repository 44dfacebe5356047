// SPDX-License-Identifier: MIT
// SPDX-FileCopyrightText: 2026 the osgGeoFX authors
//
// Wrappers of the nodes.
#include "PropertySerializers.h"

#include <osgGeoFX/effect/TextureUnits.h>
#include <osgGeoFX/light/SunLight.h>
#include <osgGeoFX/scene/CameraEffects.h>
#include <osgGeoFX/scene/EffectCullCallback.h>
#include <osgGeoFX/scene/EffectScene.h>
#include <osgGeoFX/scene/RigidReference.h>

#include <osg/Notify>
#include <osgDB/InputStream>
#include <osgDB/OutputStream>

#include <algorithm>
#include <cmath>
#include <iterator>

namespace osgGeoFX
{

namespace
{

bool hasEffects(const EffectScene& scene)
{
    return scene.getNumEffects() > 0;
}

bool readEffects(osgDB::InputStream& stream, EffectScene& scene)
{
    unsigned int count = 0;
    stream >> count >> stream.BEGIN_BRACKET;
    for (unsigned int i = 0; i < count && !stream.getException(); ++i)
    {
        // Null where this version of the kit does not know the class; OSG has said so.
        const osg::ref_ptr<Effect> effect = stream.readObjectOfType<Effect>();
        if (effect) scene.addEffect(effect);
    }
    stream >> stream.END_BRACKET;
    return true;
}

bool writeEffects(osgDB::OutputStream& stream, const EffectScene& scene)
{
    stream << scene.getNumEffects() << stream.BEGIN_BRACKET << std::endl;
    for (unsigned int i = 0; i < scene.getNumEffects(); ++i)
        stream.writeObject(scene.getEffect(i));
    stream << stream.END_BRACKET << std::endl;
    return true;
}

constexpr const char* terrainFrames[] = {"AUTOMATIC", "GEOCENTRIC", "PROJECTED"};

bool hasTerrainFrame(const EffectScene& scene)
{
    return scene.getTerrainFrame() != EffectScene::AUTOMATIC;
}

bool readTerrainFrame(osgDB::InputStream& stream, EffectScene& scene)
{
    std::string text;
    stream >> text;
    const auto* end = std::end(terrainFrames);
    const auto* found = std::find(std::begin(terrainFrames), end, text);
    if (found != end)
        scene.setTerrainFrame(static_cast<EffectScene::TerrainFrame>(found - std::begin(terrainFrames)));
    else
        OSG_WARN << "osgGeoFX: A file is wrong: EffectScene: TerrainFrame must be AUTOMATIC, GEOCENTRIC or "
                    "PROJECTED, "
                    "not \""
                 << text << "\". The default stays." << std::endl;
    return true;
}

bool writeTerrainFrame(osgDB::OutputStream& stream, const EffectScene& scene)
{
    stream << std::string(terrainFrames[scene.getTerrainFrame()]) << std::endl;
    return true;
}

bool hasGround(const EffectScene& scene)
{
    return scene.getGround().minHeight || scene.getGround().tileCells != 0;
}

/// Whether heights are stated, both heights, and the number of cells.
bool readGround(osgDB::InputStream& stream, EffectScene& scene)
{
    std::string stated, texts[2];
    EffectScene::GroundDescription ground = scene.getGround();
    stream >> stated >> texts[0] >> texts[1] >> ground.tileCells;
    double heights[2] = {};
    bool good = stated == "HEIGHTS" || stated == "UNKNOWN";
    for (int i = 0; i < 2; ++i)
        good = parseExact(texts[i], heights[i]) && good;
    if (stated == "HEIGHTS")
    {
        ground.minHeight = heights[0];
        ground.maxHeight = heights[1];
    }
    const std::string fault =
        good ? ground.fault() : "Ground must be HEIGHTS or UNKNOWN, two heights and a number of cells.";
    if (fault.empty())
        scene.setGround(ground);
    else
        OSG_WARN << "osgGeoFX: A file is wrong: EffectScene: " << fault << " The default stays." << std::endl;
    return true;
}

bool writeGround(osgDB::OutputStream& stream, const EffectScene& scene)
{
    const EffectScene::GroundDescription& ground = scene.getGround();
    stream << std::string(ground.minHeight ? "HEIGHTS" : "UNKNOWN")
           << exactText(ground.minHeight.value_or(0.0)) << exactText(ground.maxHeight.value_or(0.0))
           << ground.tileCells << std::endl;
    return true;
}

bool hasEngineCulling(const EffectScene& scene)
{
    return scene.getEngineCulling() != EffectScene::AS_IT_IS;
}

bool readEngineCulling(osgDB::InputStream& stream, EffectScene& scene)
{
    std::string name;
    stream >> name;
    if (name == "OPEN" || name == "PROXY")
        scene.setEngineCulling(name == "OPEN" ? EffectScene::OPEN : EffectScene::PROXY);
    else
        OSG_WARN << "osgGeoFX: A file is wrong: EffectScene: EngineCulling must be OPEN or PROXY, not \""
                 << name << "\". The default stays." << std::endl;
    return true;
}

bool writeEngineCulling(osgDB::OutputStream& stream, const EffectScene& scene)
{
    stream << std::string(scene.getEngineCulling() == EffectScene::OPEN ? "OPEN" : "PROXY") << std::endl;
    return true;
}

/// A whole number of a scene, which refuses what it cannot be.
template<int (EffectScene::*Get)() const, bool (EffectScene::*Set)(int), int DefaultValue>
struct SceneNumber
{
    static bool has(const EffectScene& scene) { return (scene.*Get)() != DefaultValue; }
    static bool read(osgDB::InputStream& stream, EffectScene& scene)
    {
        int value = 0;
        stream >> value;
        (scene.*Set)(value);
        return true;
    }
    static bool write(osgDB::OutputStream& stream, const EffectScene& scene)
    {
        stream << (scene.*Get)() << std::endl;
        return true;
    }
};
using FirstTextureUnit =
    SceneNumber<&EffectScene::getFirstTextureUnit, &EffectScene::setFirstTextureUnit, TextureUnits::first>;
using FirstBlockBinding = SceneNumber<&EffectScene::getFirstBlockBinding, &EffectScene::setFirstBlockBinding,
                                      TextureUnits::firstBlock>;

constexpr const char* depthKinds[] = {"OF_PROJECTION", "LOGARITHMIC", "LOGARITHMIC_BY_FRAGMENT"};

bool hasDepthConvention(const EffectScene& scene)
{
    return scene.getDepthConvention() != DepthConvention();
}

bool readDepthConvention(osgDB::InputStream& stream, EffectScene& scene)
{
    std::string kind, farDistance;
    stream >> kind >> farDistance;
    DepthConvention convention;
    const auto* end = std::end(depthKinds);
    const auto* found = std::find(std::begin(depthKinds), end, kind);
    const bool good = found != end && parseExact(farDistance, convention.farDistance);
    if (found != end) convention.kind = static_cast<DepthConvention::Kind>(found - std::begin(depthKinds));
    const std::string fault =
        good ? convention.fault()
             : "DepthConvention must be OF_PROJECTION, LOGARITHMIC or LOGARITHMIC_BY_FRAGMENT, and a number.";
    if (fault.empty())
        scene.setDepthConvention(convention);
    else
        OSG_WARN << "osgGeoFX: A file is wrong: EffectScene: " << fault << " The default stays." << std::endl;
    return true;
}

bool writeDepthConvention(osgDB::OutputStream& stream, const EffectScene& scene)
{
    const DepthConvention& convention = scene.getDepthConvention();
    stream << std::string(depthKinds[convention.kind]) << exactText(convention.farDistance) << std::endl;
    return true;
}

bool hasReference(const RigidReference& node)
{
    return node.getReference() != osg::Vec3d();
}

bool readReference(osgDB::InputStream& stream, RigidReference& node)
{
    osg::Vec3d point;
    bool good = true;
    for (int i = 0; i < 3; ++i)
    {
        std::string text;
        stream >> text;
        good = parseExact(text, point[i]) && std::isfinite(point[i]) && good;
    }
    if (good)
        node.setReference(point);
    else
        OSG_WARN << "osgGeoFX: A file is wrong: RigidReference: Reference must be three finite numbers. The "
                    "default "
                    "stays."
                 << std::endl;
    return true;
}

bool writeReference(osgDB::OutputStream& stream, const RigidReference& node)
{
    for (int i = 0; i < 3; ++i)
        stream << exactText(node.getReference()[i]);
    stream << std::endl;
    return true;
}

bool hasPlace(const SunLight& sun)
{
    return sun.getLongitude() != 0.0 || sun.getLatitude() != 0.0 || !sun.getFrame().isIdentity();
}

/// Longitude and latitude, and the frame there.
bool readPlace(osgDB::InputStream& stream, SunLight& sun)
{
    double numbers[18] = {};
    bool good = true;
    for (double& number : numbers)
    {
        std::string text;
        stream >> text;
        good = parseExact(text, number) && std::isfinite(number) && good;
    }
    if (good)
        sun.setPlace(numbers[0], numbers[1], osg::Matrixd(numbers + 2));
    else
        OSG_WARN << "osgGeoFX: A file is wrong: SunLight: Place must be 18 finite numbers. The default stays."
                 << std::endl;
    return true;
}

bool writePlace(osgDB::OutputStream& stream, const SunLight& sun)
{
    stream << exactText(sun.getLongitude()) << exactText(sun.getLatitude());
    for (int i = 0; i < 16; ++i)
        stream << exactText(sun.getFrame().ptr()[i]);
    stream << std::endl;
    return true;
}

bool hasTime(const SunLight& sun)
{
    return sun.getTime() != SunLight::firstTime();
}

bool readTime(osgDB::InputStream& stream, SunLight& sun)
{
    std::string text;
    ClockTime time;
    stream >> text >> time.zone;
    if (parseExact(text, time.time) && std::isfinite(time.time))
        sun.setTime(time);
    else
        OSG_WARN << "osgGeoFX: A file is wrong: SunLight: Time must be two finite numbers. The default stays."
                 << std::endl;
    return true;
}

bool writeTime(osgDB::OutputStream& stream, const SunLight& sun)
{
    stream << exactText(sun.getTime().time) << sun.getTime().zone << std::endl;
    return true;
}

void addSunProperties(const char*, osgDB::ObjectWrapper* wrapper)
{
    using Sun = osgDB::UserSerializer<SunLight>;
    wrapper->addSerializer(new Sun("Place", hasPlace, readPlace, writePlace), osgDB::BaseSerializer::RW_USER);
    wrapper->addSerializer(new Sun("Time", hasTime, readTime, writeTime), osgDB::BaseSerializer::RW_USER);
    using Color = osgDB::PropByRefSerializer<SunLight, osg::Vec4>;
    const osg::ref_ptr<SunLight> sample = new SunLight;
    wrapper->addSerializer(new Color("Color", sample->getColor(), &SunLight::getColor, &SunLight::setColor),
                           osgDB::BaseSerializer::RW_VEC4F);
    wrapper->addSerializer(
        new Color("Ambient", sample->getAmbient(), &SunLight::getAmbient, &SunLight::setAmbient),
        osgDB::BaseSerializer::RW_VEC4F);
}

template<typename Class>
void addFlag(osgDB::ObjectWrapper& wrapper, const char* name, bool (Class::*getter)() const,
             void (Class::*setter)(bool))
{
    const osg::ref_ptr<Class> sample = new Class;
    wrapper.addSerializer(
        new osgDB::PropByValSerializer<Class, bool>(name, (sample.get()->*getter)(), getter, setter),
        osgDB::BaseSerializer::RW_BOOL);
}

void addSceneProperties(const char*, osgDB::ObjectWrapper* wrapper)
{
    using Effects = osgDB::UserSerializer<EffectScene>;
    wrapper->addSerializer(new Effects("Effects", hasEffects, readEffects, writeEffects),
                           osgDB::BaseSerializer::RW_USER);
    addFlag(*wrapper, "Compensation", &EffectScene::getCompensation, &EffectScene::setCompensation);
    addFlag(*wrapper, "DebugBounds", &EffectScene::getDebugBounds, &EffectScene::setDebugBounds);
    addFlag(*wrapper, "NestedCameras", &EffectScene::getNestedCameras, &EffectScene::setNestedCameras);
    wrapper->addSerializer(new Effects("TerrainFrame", hasTerrainFrame, readTerrainFrame, writeTerrainFrame),
                           osgDB::BaseSerializer::RW_USER);
    wrapper->addSerializer(new Effects("Ground", hasGround, readGround, writeGround),
                           osgDB::BaseSerializer::RW_USER);
    addFlag(*wrapper, "AdaptsPrograms", &EffectScene::getAdaptsPrograms, &EffectScene::setAdaptsPrograms);
    wrapper->addSerializer(
        new Effects("EngineCulling", hasEngineCulling, readEngineCulling, writeEngineCulling),
        osgDB::BaseSerializer::RW_USER);
    wrapper->addSerializer(new Effects("FirstTextureUnit", FirstTextureUnit::has, FirstTextureUnit::read,
                                       FirstTextureUnit::write),
                           osgDB::BaseSerializer::RW_USER);
    wrapper->addSerializer(new Effects("FirstBlockBinding", FirstBlockBinding::has, FirstBlockBinding::read,
                                       FirstBlockBinding::write),
                           osgDB::BaseSerializer::RW_USER);
    wrapper->addSerializer(
        new Effects("DepthConvention", hasDepthConvention, readDepthConvention, writeDepthConvention),
        osgDB::BaseSerializer::RW_USER);
}

void addReferenceProperties(const char*, osgDB::ObjectWrapper* wrapper)
{
    wrapper->addSerializer(
        new osgDB::UserSerializer<RigidReference>("Reference", hasReference, readReference, writeReference),
        osgDB::BaseSerializer::RW_USER);
    addFlag(*wrapper, "UseBoundCenter", &RigidReference::getUseBoundCenter,
            &RigidReference::setUseBoundCenter);
    addFlag(*wrapper, "Turn", &RigidReference::getTurn, &RigidReference::setTurn);
}

const osgDB::RegisterCustomWrapperProxy sceneWrapper([]() -> osg::Object* { return new EffectScene; },
                                                     serializerDomain, "osgGeoFX::EffectScene",
                                                     "osg::Object osg::Node osg::Group osgGeoFX::EffectScene",
                                                     &addSceneProperties);
const osgDB::RegisterCustomWrapperProxy referenceWrapper([]() -> osg::Object* { return new RigidReference; },
                                                         serializerDomain, "osgGeoFX::RigidReference",
                                                         "osg::Object osg::Node osg::Group "
                                                         "osgGeoFX::RigidReference",
                                                         &addReferenceProperties);
const osgDB::RegisterCustomWrapperProxy
sunWrapper([]() -> osg::Object* { return new SunLight; }, serializerDomain, "osgGeoFX::SunLight",
           "osg::Object osg::Node osg::Group osg::LightSource osgGeoFX::SunLight", &addSunProperties);
/// OSG's own serializers cast objects in a way that a virtual base class forbids.
class CallbackSerializer : public osgDB::BaseSerializer
{
public:
    CallbackSerializer() : osgDB::BaseSerializer(READ_WRITE_PROPERTY), _name("Scene") {}
    const std::string& getName() const override { return _name; }
    bool read(osgDB::InputStream& stream, osg::Object& object) override
    {
        auto& callback = dynamic_cast<EffectCullCallback&>(object);
        if (!stream.isBinary() && !stream.matchString(_name)) return true;
        stream >> stream.BEGIN_BRACKET;
        const osg::ref_ptr<EffectScene> scene = stream.readObjectOfType<EffectScene>();
        callback.setScene(scene);
        stream >> stream.END_BRACKET;
        return true;
    }
    bool write(osgDB::OutputStream& stream, const osg::Object& object) override
    {
        if (!stream.isBinary()) stream << stream.PROPERTY(_name.c_str());
        stream << stream.BEGIN_BRACKET << std::endl;
        stream.writeObject(dynamic_cast<const EffectCullCallback&>(object).getScene());
        stream << stream.END_BRACKET << std::endl;
        return true;
    }

private:
    const std::string _name;
};

void addCallbackProperties(const char*, osgDB::ObjectWrapper* wrapper)
{
    wrapper->addSerializer(new CallbackSerializer, osgDB::BaseSerializer::RW_OBJECT);
}

const osgDB::RegisterCustomWrapperProxy callbackWrapper([]() -> osg::Object*
                                                        { return new EffectCullCallback; },
                                                        serializerDomain, "osgGeoFX::EffectCullCallback",
                                                        "osg::Object osg::Callback osg::NodeCallback "
                                                        "osgGeoFX::EffectCullCallback",
                                                        &addCallbackProperties);

/// A camera that is written has one among its user data. OSG would warn of a class without a wrapper.
void addNothing(const char*, osgDB::ObjectWrapper*) {}

const osgDB::RegisterCustomWrapperProxy cameraWrapper([]() -> osg::Object* { return new CameraEffects; },
                                                      serializerDomain, "osgGeoFX::CameraEffects",
                                                      "osg::Object osgGeoFX::CameraEffects", &addNothing);

} // namespace

} // namespace osgGeoFX
