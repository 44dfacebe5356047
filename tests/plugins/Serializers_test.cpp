// SPDX-License-Identifier: MIT
// SPDX-FileCopyrightText: 2026 the osgGeoFX authors
//
// Every class of the kit through osgDB's ASCII, binary and XML files, by the plugin osgdb_serializers_osggeofx.
#include <osgGeoFX/deformation/BlendedView.h>
#include <osgGeoFX/light/SunLight.h>
#include <osgGeoFX/scene/CameraEffects.h>
#include <osgGeoFX/scene/EffectCullCallback.h>
#include <plugins/SerializerFixture.h>
#include <tools/RandomSamples.h>
#include <tools/RunProgram.h>

#include <osgDB/ClassInterface>

#include <algorithm>
#include <functional>
#include <map>
#include <optional>

namespace
{

using geofx::test::allProperties;
using geofx::test::alteredHolder;
using geofx::test::contentOf;
using geofx::test::expectFullScene;
using geofx::test::expectSame;
using geofx::test::formats;
using geofx::test::fullScene;
using geofx::test::nameInFiles;
using geofx::test::otherValues;
using geofx::test::PropertyRow;
using geofx::test::Random;
using geofx::test::Serializers;
using osgGeoFX::BirdsEyeView;
using osgGeoFX::BlendedView;
using osgGeoFX::CameraEffects;
using osgGeoFX::createEffect;
using osgGeoFX::createPropertyHolder;
using osgGeoFX::DepthConvention;
using osgGeoFX::Effect;
using osgGeoFX::EffectCullCallback;
using osgGeoFX::EffectScene;
using osgGeoFX::Property;
using osgGeoFX::PropertyHolder;
using osgGeoFX::propertyHolderKinds;
using osgGeoFX::RigidReference;
using osgGeoFX::SunLight;

TEST_F(Serializers, ThereIsAWrapperForEachClass)
{
    auto* wrappers = osgDB::Registry::instance()->getObjectWrapperManager();
    std::vector<osg::ref_ptr<osg::Object>> objects = {
        new EffectScene, new RigidReference, new EffectCullCallback, new CameraEffects, new SunLight};
    for (const std::string& kind : propertyHolderKinds())
        objects.emplace_back(createPropertyHolder(kind));
    for (const auto& object : objects)
    {
        const std::string name = object->getCompoundClassName();
        osgDB::ObjectWrapper* wrapper = wrappers->findWrapper(name);
        ASSERT_TRUE(wrapper) << name;
        EXPECT_EQ(wrapper->getDomain(), "osgGeoFX");
        const osg::ref_ptr<osg::Object> created = wrapper->createInstance();
        EXPECT_EQ(created->getCompoundClassName(), name);
        bool self = false;
        for (const osgDB::ObjectWrapperAssociate& associate : wrapper->getAssociates())
        {
            EXPECT_TRUE(wrappers->findWrapper(associate._name)) << associate._name;
            self = self || associate._name == name;
        }
        EXPECT_TRUE(self) << name;
    }
    for (const std::string name : {"osgGeoFX::Effect", "osgGeoFX::Deformation", "osgGeoFX::PerspectiveBend"})
    {
        ASSERT_TRUE(wrappers->findWrapper(name)) << name;
        EXPECT_FALSE(wrappers->findWrapper(name)->createInstance()) << name;
    }
}

TEST_F(Serializers, KeepEveryPropertyOfEveryClass)
{
    for (const PropertyRow& row : allProperties())
    {
        std::vector<double> values = otherValues(row);
        if (!geofx::test::fullTest()) values.resize(std::min<std::size_t>(values.size(), 2));
        for (const double value : values)
        {
            const osg::ref_ptr<PropertyHolder> holder = row.create();
            std::string error;
            ASSERT_TRUE(holder->setProperty(row.name, value, error)) << error;
            for (const std::string& format : formats)
            {
                SCOPED_TRACE(row.kind + "." + row.name + " " + format);
                const osg::ref_ptr<PropertyHolder> read = throughFile<PropertyHolder>(*holder, format);
                ASSERT_TRUE(read);
                expectSame(*read, *holder);
            }
        }
    }
}

TEST_F(Serializers, KeepWholeObjects)
{
    for (const std::string& kind : propertyHolderKinds())
    {
        for (const std::string& format : formats)
        {
            SCOPED_TRACE(testing::Message() << kind << " " << format);
            const osg::ref_ptr<PropertyHolder> altered = alteredHolder(kind);
            altered->setName("an object");
            const osg::ref_ptr<PropertyHolder> read = throughFile<PropertyHolder>(*altered, format);
            ASSERT_TRUE(read);
            EXPECT_EQ(read->getName(), "an object");
            expectSame(*read, *altered);
            // And a file of defaults stays one, without a word about them.
            const osg::ref_ptr<PropertyHolder> plain = createPropertyHolder(kind);
            const osg::ref_ptr<PropertyHolder> other = throughFile<PropertyHolder>(*plain, format);
            ASSERT_TRUE(other);
            expectSame(*other, *plain);
            const std::string text = contentOf(_folder / ("object" + format));
            for (const Property& property : plain->properties())
                EXPECT_EQ(text.find(nameInFiles(property.name)), std::string::npos) << property.name;
        }
    }
}

TEST_F(Serializers, KeepRandomNumbersToTheLastDigit)
{
    const int samples = geofx::test::fullTest() ? 1000 : 50;
    for (int i = 0; i < samples; ++i)
    {
        Random random(static_cast<std::uint64_t>(i));
        const osg::ref_ptr<Effect> effect = createEffect("pedestrianView");
        std::map<std::string, double> values;
        for (const char* name :
             {"bendAngle", "focusDistance", "zoneWidth", "planeHeight", "contextSaturation"})
        {
            const Property& property = *effect->property(name);
            values[name] = random.uniform(property.minimum, property.maximum) * random.logarithmic(1e-9, 1.0);
            values[name] = std::max(values[name], property.minimum);
        }
        std::string error;
        ASSERT_TRUE(effect->setProperties(values, error)) << error;
        for (const std::string& format : formats)
        {
            SCOPED_TRACE("sample " + std::to_string(i) + " " + format);
            const osg::ref_ptr<Effect> read = throughFile<Effect>(*effect, format);
            ASSERT_TRUE(read);
            expectSame(*read, *effect);
        }
    }
}

TEST_F(Serializers, PartsThatAreSharedStayShared)
{
    const osg::ref_ptr<EffectScene> scene = new EffectScene;
    const osg::ref_ptr<BlendedView> one = new BlendedView;
    const osg::ref_ptr<BlendedView> other = new BlendedView;
    other->setBirdsEyeView(one->getBirdsEyeView());
    scene->addEffect(one);
    scene->addEffect(one->getBirdsEyeView());
    scene->addEffect(other);
    for (const std::string& format : formats)
    {
        SCOPED_TRACE(format);
        const osg::ref_ptr<EffectScene> read = throughFile(*scene, format);
        ASSERT_TRUE(read);
        ASSERT_EQ(read->getNumEffects(), 3u);
        const auto* first = dynamic_cast<const BlendedView*>(read->getEffect(0));
        const auto* last = dynamic_cast<const BlendedView*>(read->getEffect(2));
        ASSERT_TRUE(first && last);
        EXPECT_EQ(first->getBirdsEyeView(), read->getEffect(1));
        EXPECT_EQ(first->getBirdsEyeView(), last->getBirdsEyeView());
        EXPECT_NE(first->getPedestrianView(), last->getPedestrianView());
    }
}

/// A setting of a node: how it is altered, and what it is.
template<typename Class>
struct Setting
{
    std::function<void(Class&)> alter;
    std::function<double(const Class&)> get;
    double defaultValue;
    double altered;
};

const std::vector<Setting<EffectScene>>& sceneSettings()
{
    static const std::vector<Setting<EffectScene>> all = {
        {[](auto& s) { s.setCompensation(false); }, [](auto& s) { return s.getCompensation(); }, 1.0, 0.0},
        {[](auto& s) { s.setDebugBounds(true); }, [](auto& s) { return s.getDebugBounds(); }, 0.0, 1.0},
        {[](auto& s) { s.setNestedCameras(true); }, [](auto& s) { return s.getNestedCameras(); }, 0.0, 1.0},
        {[](auto& s) { s.setAdaptsPrograms(true); }, [](auto& s) { return s.getAdaptsPrograms(); }, 0.0, 1.0},
        {[](auto& s) { s.setTerrainFrame(EffectScene::GEOCENTRIC); },
         [](auto& s) { return s.getTerrainFrame(); }, EffectScene::AUTOMATIC, EffectScene::GEOCENTRIC},
        {[](auto& s) { s.setTerrainFrame(EffectScene::PROJECTED); },
         [](auto& s) { return s.getTerrainFrame(); }, EffectScene::AUTOMATIC, EffectScene::PROJECTED},
        {[](auto& s) {
             s.setGround({EffectScene::AUTOMATIC, -7.25, 1.0 / 3.0, 0});
         },
         [](auto& s) { return s.getGround().minHeight.value_or(-1e30); }, -1e30, -7.25},
        {[](auto& s) {
             s.setGround({EffectScene::AUTOMATIC, -7.25, 1.0 / 3.0, 0});
         },
         [](auto& s) { return s.getGround().maxHeight.value_or(-1e30); }, -1e30, 1.0 / 3.0},
        {[](auto& s) {
             s.setGround({EffectScene::AUTOMATIC, std::nullopt, std::nullopt, 32});
         },
         [](auto& s) { return s.getGround().tileCells; }, 0.0, 32.0},
        {[](auto& s) { s.setEngineCulling(EffectScene::OPEN); }, [](auto& s) { return s.getEngineCulling(); },
         EffectScene::AS_IT_IS, EffectScene::OPEN},
        {[](auto& s) { s.setEngineCulling(EffectScene::PROXY); },
         [](auto& s) { return s.getEngineCulling(); }, EffectScene::AS_IT_IS, EffectScene::PROXY},
        {[](auto& s) { s.setFirstTextureUnit(9); }, [](auto& s) { return s.getFirstTextureUnit(); }, 4.0,
         9.0},
        {[](auto& s) { s.setFirstBlockBinding(20); }, [](auto& s) { return s.getFirstBlockBinding(); }, 7.0,
         20.0},
        {[](auto& s) {
             s.setDepthConvention({DepthConvention::LOGARITHMIC_BY_FRAGMENT, 0.0});
         },
         [](auto& s) { return s.getDepthConvention().kind; }, DepthConvention::OF_PROJECTION,
         DepthConvention::LOGARITHMIC_BY_FRAGMENT},
        {[](auto& s) {
             s.setDepthConvention({DepthConvention::LOGARITHMIC, 1e7 / 3.0});
         },
         [](auto& s) { return s.getDepthConvention().farDistance; }, 0.0, 1e7 / 3.0},
        {[](auto& s) { s.addEffect(new BirdsEyeView); }, [](auto& s) { return s.getNumEffects(); }, 0.0, 1.0},
    };
    return all;
}

const std::vector<Setting<RigidReference>>& referenceSettings()
{
    const double x = -5459123.456789012;
    static const std::vector<Setting<RigidReference>> all = {
        {[=](auto& n) {
             n.setReference({x, 0.0, 0.0});
         },
         [](auto& n) { return n.getReference().x(); }, 0.0, x},
        {[=](auto& n) {
             n.setReference({1.0, x, 0.0});
         },
         [](auto& n) { return n.getReference().y(); }, 0.0, x},
        {[=](auto& n) {
             n.setReference({0.0, 1.0, x});
         },
         [](auto& n) { return n.getReference().z(); }, 0.0, x},
        {[](auto& n) { n.setUseBoundCenter(true); }, [](auto& n) { return n.getUseBoundCenter(); }, 0.0, 1.0},
        {[](auto& n) { n.setTurn(false); }, [](auto& n) { return n.getTurn(); }, 1.0, 0.0},
    };
    return all;
}

const std::vector<Setting<SunLight>>& sunSettings()
{
    const double angle = 1.0 / 3.0, place = -5459123.456789012;
    static const std::vector<Setting<SunLight>> all = {
        {[=](auto& s) { s.setPlace(angle, 0.0, osg::Matrixd()); }, [](auto& s) { return s.getLongitude(); },
         0.0, angle},
        {[=](auto& s) { s.setPlace(angle, -angle, osg::Matrixd()); }, [](auto& s) { return s.getLatitude(); },
         0.0, -angle},
        {[=](auto& s) { s.setPlace(0.0, 0.0, osg::Matrixd::translate(0.0, place, 0.0)); },
         [](auto& s) { return s.getFrame()(3, 1); }, 0.0, place},
        {[=](auto& s) {
             s.setTime({1e9 / 3.0, 0});
         },
         [](auto& s) { return s.getTime().time; }, SunLight::firstTime().time, 1e9 / 3.0},
        {[](auto& s) {
             s.setTime({1e9 / 3.0, -36000});
         },
         [](auto& s) { return s.getTime().zone; }, 0.0, -36000.0},
        {[](auto& s) {
             s.setColor({0.5f, 0.25f, 0.125f, 1.0f});
         },
         [](auto& s) { return s.getColor().y(); }, static_cast<double>(244.0f / 255.0f), 0.25},
        {[](auto& s) {
             s.setAmbient({0.5f, 0.25f, 0.125f, 1.0f});
         },
         [](auto& s) { return s.getAmbient().y(); }, static_cast<double>(85.0f / 255.0f), 0.25},
    };
    return all;
}

template<typename Class>
void expectSettings(const std::vector<Setting<Class>>& settings,
                    const std::function<osg::ref_ptr<Class>(const Class&)>& copy)
{
    for (const Setting<Class>& setting : settings)
    {
        const osg::ref_ptr<Class> node = new Class;
        for (const bool altered : {false, true})
        {
            if (altered) setting.alter(*node);
            EXPECT_EQ(setting.get(*node), altered ? setting.altered : setting.defaultValue);
            const osg::ref_ptr<Class> copied = copy(*node);
            ASSERT_TRUE(copied);
            for (const Setting<Class>& each : settings)
                EXPECT_EQ(each.get(*copied), each.get(*node));
        }
    }
}

TEST_F(Serializers, NodesKeepEverySetting)
{
    std::vector<std::string> ways = formats;
    ways.insert(ways.end(), {"shallow", "deep"});
    for (const std::string& way : ways)
    {
        SCOPED_TRACE(way);
        const osg::CopyOp flags(way == "deep" ? osg::CopyOp::DEEP_COPY_ALL : osg::CopyOp::SHALLOW_COPY);
        const auto copy = [&](const auto& node)
        {
            return way[0] == '.' ? throughFile(node, way) : osg::ref_ptr(osg::clone(&node, flags));
        };
        expectSettings<EffectScene>(sceneSettings(), copy);
        expectSettings<RigidReference>(referenceSettings(), copy);
        expectSettings<SunLight>(sunSettings(), copy);
    }
}

TEST_F(Serializers, ACallbackComesBackWithItsScene)
{
    for (const std::string& format : formats)
    {
        SCOPED_TRACE(format);
        const osg::ref_ptr<osg::Group> terrain = new osg::Group;
        terrain->setCullingActive(false);
        const osg::ref_ptr<EffectScene> effects = fullScene();
        effects->removeChildren(0, effects->getNumChildren());
        terrain->addCullCallback(new EffectCullCallback(effects));
        const osg::ref_ptr<osg::Group> read = throughFile(*terrain, format);
        ASSERT_TRUE(read);
        EXPECT_FALSE(read->isCullingActive());
        auto* callback = dynamic_cast<EffectCullCallback*>(read->getCullCallback());
        ASSERT_TRUE(callback);
        ASSERT_EQ(callback->getScene()->getNumEffects(), effects->getNumEffects());
        for (unsigned int i = 0; i < effects->getNumEffects(); ++i)
            EXPECT_EQ(callback->getScene()->getEffect(i)->getCompoundClassName(),
                      effects->getEffect(i)->getCompoundClassName());
    }
}

TEST_F(Serializers, ASceneWithEverythingComesBack)
{
    for (const std::string& format : formats)
    {
        SCOPED_TRACE(format);
        const osg::ref_ptr<EffectScene> read = throughFile(*fullScene(), format);
        ASSERT_TRUE(read);
        expectFullScene(*read);
        const osg::ref_ptr<EffectScene> again = throughFile(*read, format);
        ASSERT_TRUE(again);
        expectFullScene(*again);
    }
    const osg::ref_ptr<EffectScene> scene = fullScene();
    const osg::ref_ptr<EffectScene> deep = osg::clone(scene.get(), osg::CopyOp::DEEP_COPY_ALL);
    expectFullScene(*deep);
    EXPECT_NE(deep->getEffect(0), scene->getEffect(0));
    const osg::ref_ptr<EffectScene> shallow = osg::clone(scene.get(), osg::CopyOp::SHALLOW_COPY);
    EXPECT_EQ(shallow->getEffect(0), scene->getEffect(0));
}

TEST_F(Serializers, AProgramThatKnowsNothingOfTheKitReadsAScene)
{
    for (const std::string& format : formats)
    {
        const std::string file = (_folder / ("scene" + format)).string();
        ASSERT_TRUE(osgDB::writeNodeFile(*fullScene(), file));
        geofx::test::ProgramOptions options;
        options.environment = {"OSG_LIBRARY_PATH=" GEOFX_BUILD_DIR "/lib"};
        const auto result = geofx::test::runProgram({geofx::test::builtProgram("read_scene"), file}, options);
        EXPECT_EQ(result.exitCode, 0) << format;
        EXPECT_EQ(result.standardError, "") << format;
    }
}

TEST_F(Serializers, ScriptsReachEveryProperty)
{
    osgDB::ClassInterface access;
    for (const PropertyRow& row : allProperties())
    {
        SCOPED_TRACE(row.kind + "." + row.name);
        const Property& property = row.property();
        const std::string name = nameInFiles(row.name);
        const osg::ref_ptr<PropertyHolder> holder = row.create();
        const double wanted = otherValues(row).at(0);
        std::optional<double> found;
        bool set = false;
        if (property.kind == Property::Kind::Flag)
        {
            set = access.setProperty(holder.get(), name, wanted != 0.0);
            bool value = false;
            if (access.getProperty(holder.get(), name, value)) found = value;
        }
        else if (geofx::test::isWhole(property))
        {
            set = access.setProperty(holder.get(), name, static_cast<int>(wanted));
            int value = 0;
            if (access.getProperty(holder.get(), name, value)) found = value;
        }
        else
        {
            set = access.setProperty(holder.get(), name, wanted);
            double value = 0.0;
            if (access.getProperty(holder.get(), name, value)) found = value;
        }
        EXPECT_TRUE(set);
        EXPECT_EQ(holder->getProperty(row.name), wanted);
        EXPECT_EQ(found, wanted);
        EXPECT_FALSE(holder->getUserDataContainer()) << "the value went into user data";
    }
}

} // namespace
