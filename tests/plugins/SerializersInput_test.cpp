// SPDX-License-Identifier: MIT
// SPDX-FileCopyrightText: 2026 the osgGeoFX authors
//
// Files of the plugin osgdb_serializers_osggeofx that another hand has written, that are damaged, or that are written
// with OSG's options.
#include <osgGeoFX/deformation/PerspectiveBend.h>
#include <plugins/SerializerFixture.h>
#include <tools/RandomSamples.h>

namespace
{

using geofx::test::allProperties;
using geofx::test::contentOf;
using geofx::test::expectFullScene;
using geofx::test::expectSame;
using geofx::test::formats;
using geofx::test::fullScene;
using geofx::test::nameInFiles;
using geofx::test::PropertyRow;
using osgGeoFX::createPropertyHolder;
using osgGeoFX::effectKinds;
using osgGeoFX::EffectScene;
using osgGeoFX::PerspectiveBend;
using osgGeoFX::Property;
using osgGeoFX::PropertyHolder;
using osgGeoFX::RigidReference;
using SerializersInput = geofx::test::Serializers;

TEST_F(SerializersInput, PropertiesMayStandInAnyOrderAndFitInTheEndOnly)
{
    osg::ref_ptr<PropertyHolder> effect =
        fromLines("osgGeoFX::BirdsEyeView",
                  "  HorizonLine 0.95\n  FocusLine 0.9\n  Enabled FALSE\n  Curve bezier\n  MapUnit 2\n");
    ASSERT_TRUE(effect);
    EXPECT_EQ(effect->getProperty("focusLine"), 0.9);
    EXPECT_EQ(effect->getProperty("horizonLine"), 0.95);
    EXPECT_EQ(effect->getProperty("enabled"), 0.0);
    EXPECT_EQ(effect->getProperty("curve"), PerspectiveBend::BEZIER);
    EXPECT_EQ(effect->getProperty("mapUnit"), 2.0);
    effect = fromLines("osgGeoFX::BirdsEyeView", "  FocusLine 0.1\n  HorizonLine 0.2\n");
    ASSERT_TRUE(effect);
    EXPECT_EQ(effect->getProperty("focusLine"), 0.1);
    EXPECT_EQ(effect->getProperty("horizonLine"), 0.2);
}

TEST_F(SerializersInput, WrongValuesLeaveTheDefaultWithAWarning)
{
    for (const PropertyRow& row : allProperties())
    {
        const Property& property = row.property();
        const osg::ref_ptr<PropertyHolder> plain = createPropertyHolder(row.kind);
        for (const char* text : {"1e39", "-1e39", "nan", "inf", "spline", "1x"})
        {
            SCOPED_TRACE(row.kind + "." + row.name + " " + text);
            osg::ref_ptr<PropertyHolder> read;
            const std::vector<std::string> said = _watch.messagesOf(
                [&] {
                    read = fromLines(plain->getCompoundClassName(),
                                     "  " + nameInFiles(row.name) + " " + text + "\n");
                });
            ASSERT_TRUE(read);
            expectSame(*read, *plain);
            ASSERT_EQ(said.size(), 1u);
            EXPECT_NE(said[0].find("osgGeoFX: "), std::string::npos) << said[0];
            EXPECT_NE(said[0].find(property.name.substr(1)), std::string::npos) << said[0];
        }
    }
    // What else the file says is taken.
    osg::ref_ptr<PropertyHolder> read;
    const auto said = _watch.messagesOf(
        [&]
        {
            read = fromLines("osgGeoFX::BirdsEyeView",
                             "  FocusLine 0.95\n  HorizonLine 0.9\n  ContextTilt 7\n  MapUnit 1\n");
        });
    ASSERT_TRUE(read);
    EXPECT_EQ(said.size(), 1u);
    EXPECT_EQ(read->getProperty("focusLine"), 0.4);
    EXPECT_EQ(read->getProperty("horizonLine"), 0.9);
    EXPECT_EQ(read->getProperty("contextTilt"), 0.0);
    EXPECT_EQ(read->getProperty("mapUnit"), 1.0);
}

TEST_F(SerializersInput, AWrongGroundLeavesTheDefaultWithAWarning)
{
    const osg::ref_ptr<EffectScene> scene = new EffectScene;
    ASSERT_TRUE(scene->setGround({EffectScene::GEOCENTRIC, 1.0, 2.0, 3}));
    const std::string file = (_folder / "ground.osgt").string();
    ASSERT_TRUE(osgDB::writeNodeFile(*scene, file));
    const std::string good = contentOf(file), line = "Ground HEIGHTS 1 2 3";
    ASSERT_NE(good.find(line), std::string::npos) << good;
    for (const char* wrong : {"Ground HEIGHTS 2 1 3", "Ground DEPTHS 1 2 3", "Ground HEIGHTS 1 2x 3",
                              "Ground HEIGHTS 1 2 -3", "Ground HEIGHTS 1 nan 3"})
    {
        SCOPED_TRACE(wrong);
        std::string text = good;
        text.replace(text.find(line), line.size(), wrong);
        osg::ref_ptr<osg::Node> node;
        const auto said = _watch.messagesOf(
            [&] { node = osgDB::readRefNodeFile(_folder.write("wrong.osgt", text).string()); });
        auto* read = dynamic_cast<EffectScene*>(node.get());
        ASSERT_TRUE(read);
        EXPECT_FALSE(read->getGround().minHeight);
        EXPECT_EQ(read->getGround().tileCells, 0);
        EXPECT_EQ(read->getTerrainFrame(), EffectScene::GEOCENTRIC) << "what else the file says is taken";
        ASSERT_EQ(said.size(), 1u);
        EXPECT_NE(said[0].find("osgGeoFX: A file is wrong: EffectScene: "), std::string::npos) << said[0];
    }
}

TEST_F(SerializersInput, OsgsOptionsForItsFormatsWork)
{
    const osg::ref_ptr<EffectScene> scene = fullScene();
    const auto* building = static_cast<RigidReference*>(scene->getChild(0));
    const osg::Vec3d place(-5459123.456789012, 2264123.4567890123, 1.0 / 3.0);
    const_cast<RigidReference*>(building)->setReference(place);
    const std::vector<std::pair<std::string, std::string>> settings = {{"SchemaData", "true"},
                                                                       {"Compressor", "zlib"},
                                                                       {"RobustBinaryFormat", "false"},
                                                                       {"CustomDomains", "osgGeoFX:1"}};
    for (const auto& [name, value] : settings)
    {
        for (const std::string& format : formats)
        {
            // OSG writes domains into XML files, but cannot read them there.
            if (name == "CustomDomains" && format == ".osgx") continue;
            SCOPED_TRACE(testing::Message() << name << " " << format);
            // The precision is that of OSG's own numbers; ours have all their digits.
            const osg::ref_ptr<osgDB::Options> options = new osgDB::Options("precision 3");
            options->setPluginStringData(name, value);
            const std::string file = (_folder / ("options" + format)).string();
            ASSERT_TRUE(osgDB::writeNodeFile(*scene, file, options));
            const osg::ref_ptr<osg::Node> node = osgDB::readRefNodeFile(file);
            auto* read = dynamic_cast<EffectScene*>(node.get());
            ASSERT_TRUE(read);
            expectFullScene(*read);
            EXPECT_EQ(static_cast<RigidReference*>(read->getChild(0))->getReference(), place);
        }
    }
}

TEST_F(SerializersInput, DamagedFilesAreNoReasonToHangOrCrash)
{
    const std::string file = (_folder / "scene.osgb").string();
    ASSERT_TRUE(osgDB::writeNodeFile(*fullScene(), file));
    const std::string whole = contentOf(file);
    const std::size_t step = geofx::test::fullTest() ? 1 : 7;
    // Cut off behind what OSG itself reads first, where it may hang; what has been read so far keeps its promises.
    for (std::size_t size = whole.find("osgGeoFX::EffectScene") + 30; size < whole.size(); size += step)
    {
        osg::ref_ptr<osg::Node> node;
        _watch.messagesOf(
            [&]
            { node = osgDB::readRefNodeFile(_folder.write("cut.osgb", whole.substr(0, size)).string()); });
        auto* scene = dynamic_cast<EffectScene*>(node.get());
        for (unsigned int i = 0; scene && i < scene->getNumEffects(); ++i)
        {
            for (const Property& property : scene->getEffect(i)->properties())
                EXPECT_EQ(property.refusal(property.get(*scene->getEffect(i))), "") << size;
        }
    }
}

TEST_F(SerializersInput, AnEffectOfALaterVersionIsLeftOut)
{
    const std::string file = (_folder / "scene.osgt").string();
    ASSERT_TRUE(osgDB::writeNodeFile(*fullScene(), file));
    std::string text = contentOf(file);
    const std::string name = "osgGeoFX::PedestrianView {";
    text.replace(text.find(name), name.size(), "osgGeoFX::TimeMachine {");
    osg::ref_ptr<osg::Node> node;
    const auto said =
        _watch.messagesOf([&] { node = osgDB::readRefNodeFile(_folder.write("later.osgt", text).string()); });
    EXPECT_GE(said.size(), 1u);
    auto* scene = dynamic_cast<EffectScene*>(node.get());
    ASSERT_TRUE(scene);
    EXPECT_EQ(scene->getNumEffects() + 1, effectKinds().size());
    EXPECT_EQ(scene->getNumChildren(), 1u);
}

} // namespace
