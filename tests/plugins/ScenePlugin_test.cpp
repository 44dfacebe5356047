// SPDX-License-Identifier: MIT
// SPDX-FileCopyrightText: 2026 the osgGeoFX authors
//
// The plugin osgdb_geofx, through osgDB.
#include <osgGeoFX/scene/EffectScene.h>
#include <osgGeoFX/viewer/Scene.h>
#include <tools/GeofxPlugins.h>
#include <tools/RunProgram.h>
#include <tools/TempDir.h>

#include <GeographicLib/LocalCartesian.hpp>
#include <GeographicLib/UTMUPS.hpp>
#include <osg/CoordinateSystemNode>
#include <osg/Fog>
#include <osg/Geode>
#include <osg/LightSource>
#include <osg/Math>
#include <osg/Shape>
#include <osg/ShapeDrawable>
#include <osg/ValueObject>
#include <osgDB/ReadFile>
#include <osgDB/WriteFile>

namespace
{

namespace fs = std::filesystem;
using geofx::test::TempDir;
using geofx::test::wktOf;
using osg::DegreesToRadians;
using ScenePlugin = geofx::test::GeofxPlugins;

/// A terrain without pages: a box of 2 km around a point of the world, below a node with a coordinate system.
fs::path writeTerrain(const TempDir& folder, const osg::ref_ptr<osg::CoordinateSystemNode>& root,
                      const osg::Vec3d& center)
{
    osg::ref_ptr<osg::Geode> geode = new osg::Geode;
    geode->addDrawable(new osg::ShapeDrawable(new osg::Box(center, 2000.0f)));
    root->addChild(geode);
    fs::path file = folder / "terrain.osgb";
    EXPECT_TRUE(osgDB::writeNodeFile(*root, file.string()));
    return file;
}

osg::ref_ptr<osg::CoordinateSystemNode> geocentricRoot()
{
    osg::ref_ptr<osg::CoordinateSystemNode> root = new osg::CoordinateSystemNode;
    root->setEllipsoidModel(new osg::EllipsoidModel);
    return root;
}

std::string sceneWith(const std::string& more)
{
    return "<geofx version='1'>\n<terrain><database file='terrain.osgb'/></terrain>\n" + more + "</geofx>";
}

const osg::Light* sunOf(const osg::Node* scene)
{
    const osg::Group* group = scene ? scene->asGroup() : nullptr;
    for (unsigned int i = 0; group && i < group->getNumChildren(); ++i)
        if (const auto* source = dynamic_cast<const osg::LightSource*>(group->getChild(i)))
            return source->getLight();
    return nullptr;
}

osg::Vec3d directionOf(const osg::Light* sun)
{
    const osg::Vec4d position = sun->getPosition();
    EXPECT_EQ(position.w(), 0.0);
    return osg::Vec3d(position.x(), position.y(), position.z());
}

TEST_F(ScenePlugin, SceneTellsProgramsWhatItSays)
{
    const TempDir folder;
    writeTerrain(folder, geocentricRoot(), osg::Vec3d(6378137.0, 0.0, 0.0));
    const auto file = folder.write(
        "a.geofx", sceneWith("<homeView longitude='-157.905' latitude='21.25' height='1400' heading='25' "
                             "pitch='-12' verticalFieldOfView='35'/><background color='#ff0033'/>"
                             "<sun azimuth='0' elevation='0' color='#00ff00' ambient='#0000ff'/>"));
    const osg::ref_ptr<osg::Node> scene = osgDB::readRefNodeFile(file.string());
    ASSERT_TRUE(scene);
    EXPECT_EQ(scene->getName(), "osgGeoFX scene");
    std::string text;
    double fov = 0.0;
    bool hasLight = false;
    EXPECT_TRUE(scene->getUserValue("geofx.homeView", text));
    EXPECT_EQ(text, "-157.905,21.25,1400,25,-12,0");
    EXPECT_TRUE(scene->getUserValue("geofx.background", text));
    EXPECT_EQ(text, "1,0,0.2");
    EXPECT_TRUE(scene->getUserValue("geofx.homeFov", fov));
    EXPECT_EQ(fov, 35.0);
    EXPECT_TRUE(scene->getUserValue("geofx.hasLight", hasLight) && hasLight);
    const osg::Light* sun = sunOf(scene);
    ASSERT_TRUE(sun);
    EXPECT_EQ(sun->getLightNum(), 0);
    EXPECT_EQ(sun->getDiffuse(), osg::Vec4(0, 1, 0, 1));
    EXPECT_EQ(sun->getSpecular(), osg::Vec4(0, 1, 0, 1)) << "glints have the sun's color";
    EXPECT_EQ(sun->getAmbient(), osg::Vec4(0, 0, 1, 1));

    const auto bare = folder.write("b.geofx", sceneWith(""));
    const osg::ref_ptr<osg::Node> other = osgDB::readRefNodeFile(bare.string());
    ASSERT_TRUE(other);
    EXPECT_FALSE(sunOf(other));
    EXPECT_FALSE(other->getStateSet());
    EXPECT_FALSE(other->getUserValue("geofx.homeView", text) || other->getUserValue("geofx.homeFov", fov) ||
                 other->getUserValue("geofx.background", text) ||
                 other->getUserValue("geofx.hasLight", hasLight));
}

TEST_F(ScenePlugin, HazeIsFogOfTheBackgroundsColor)
{
    const TempDir folder;
    writeTerrain(folder, geocentricRoot(), osg::Vec3d(6378137.0, 0.0, 0.0));
    for (const char* const effects : {"", "<effects><birdsEyeView/></effects>"})
    {
        SCOPED_TRACE(effects);
        const auto file = folder.write(
            "a.geofx",
            sceneWith(std::string("<background color='#ff0033' visibility='39120.23'/>") + effects));
        const osg::ref_ptr<osg::Node> scene = osgDB::readRefNodeFile(file.string());
        ASSERT_TRUE(scene && scene->getStateSet());
        EXPECT_EQ(scene->getStateSet()->getMode(GL_FOG), osg::StateAttribute::ON);
        const auto* const haze =
            static_cast<const osg::Fog*>(scene->getStateSet()->getAttribute(osg::StateAttribute::FOG));
        ASSERT_TRUE(haze);
        EXPECT_EQ(haze->getMode(), osg::Fog::EXP);
        EXPECT_EQ(haze->getColor(), osg::Vec4(1.0f, 0.0f, 0.2f, 1.0f));
        double visibility = 0.0;
        EXPECT_TRUE(scene->getUserValue("geofx.visibility", visibility));
        EXPECT_EQ(visibility, 39120.23) << "--sky has the same haze";
        // A fiftieth of the contrast is left.
        EXPECT_NEAR(std::exp(-haze->getDensity() * 39120.23f), 0.02f, 1e-4f);
    }
}

TEST_F(ScenePlugin, ASkyStandsBesideAGlobeAndOnlyOnce)
{
    const TempDir folder;
    writeTerrain(folder, geocentricRoot(), osg::Vec3d(6378137.0, 0.0, 0.0));
    const std::string sky = "<background color='#ff0033' sky='true'/>";
    for (const char* const effects : {"", "<effects><birdsEyeView/></effects>"})
    {
        SCOPED_TRACE(effects);
        const auto file = folder.write("a.geofx", sceneWith(sky + effects));
        std::string error;
        std::optional<osgGeoFX::Scene> scene = osgGeoFX::Scene::load(file.string(), error);
        ASSERT_TRUE(scene) << error;
        const auto skiesOf = [](osg::Node& node)
        {
            struct Count : public osg::NodeVisitor
            {
                Count() : NodeVisitor(TRAVERSE_ALL_CHILDREN) {}
                void apply(osg::Node& child) override
                {
                    skies += child.getName() == "sky of the Earth" ? 1 : 0;
                    traverse(child);
                }
                int skies = 0;
            } count;
            node.accept(count);
            return count.skies;
        };
        EXPECT_EQ(skiesOf(*scene->node), 1);
        EXPECT_EQ(skiesOf(*scene->effects), 0) << "bends do not bend it";
        EXPECT_TRUE(scene->settings.hasSky);
        EXPECT_TRUE(scene->addSky(error)) << error;
        EXPECT_EQ(skiesOf(*scene->node), 1) << "it has its own";
        EXPECT_EQ(scene->settings.background, osg::Vec4(1.0f, 0.0f, 0.2f, 1.0f));
    }
    const TempDir plane;
    osg::ref_ptr<osg::CoordinateSystemNode> root = new osg::CoordinateSystemNode("WKT", wktOf(32604));
    writeTerrain(plane, root, osg::Vec3d(610000.0, 2360000.0, 0.0));
    const auto file = plane.write("a.geofx", sceneWith(sky));
    std::string error;
    EXPECT_FALSE(osgGeoFX::Scene::load(file.string(), error));
    EXPECT_NE(error.find("a.geofx:3: <background>: the terrain is no round Earth"), std::string::npos)
        << error;
}

TEST_F(ScenePlugin, EffectsStandAboveTerrainAndSun)
{
    const TempDir folder;
    writeTerrain(folder, geocentricRoot(), osg::Vec3d(6378137.0, 0.0, 0.0));
    const auto file = folder.write(
        "a.geofx",
        sceneWith("<effects><verticalExaggeration factor='2'/><birdsEyeView focusLine='0.3'/></effects>"
                  "<sun azimuth='0' elevation='0'/><background color='#ff0033'/>"));
    const osg::ref_ptr<osg::Node> node = osgDB::readRefNodeFile(file.string());
    auto* effects = dynamic_cast<osgGeoFX::EffectScene*>(node.get());
    ASSERT_TRUE(effects);
    EXPECT_EQ(effects->getName(), "osgGeoFX scene");
    EXPECT_TRUE(sunOf(effects));
    EXPECT_TRUE(dynamic_cast<const osg::CoordinateSystemNode*>(effects->getChild(0)));
    ASSERT_EQ(effects->getNumEffects(), 2u);
    EXPECT_EQ(effects->getEffect(0)->getProperty("factor"), 2.0);
    EXPECT_EQ(effects->getEffect(1)->getProperty("focusLine"), 0.3);
    EXPECT_TRUE(effects->ground().ellipsoid);

    // Programs find them, and the scene's wishes.
    std::string error;
    const std::optional<osgGeoFX::Scene> scene = osgGeoFX::Scene::adopt(node, error);
    ASSERT_TRUE(scene) << error;
    EXPECT_EQ(scene->effects, effects);
    EXPECT_EQ(scene->node, node);
    EXPECT_TRUE(scene->settings.hasLight);
    EXPECT_EQ(scene->settings.background, osg::Vec4(1.0f, 0.0f, 0.2f, 1.0f));

    // Two readings have effects of their own.
    const osg::ref_ptr<osg::Node> again = osgDB::readRefNodeFile(file.string());
    auto* others = dynamic_cast<osgGeoFX::EffectScene*>(again.get());
    ASSERT_TRUE(others);
    EXPECT_NE(others->getEffect(0), effects->getEffect(0));
}

TEST_F(ScenePlugin, WhatTheSceneStatesOfTheGroundReachesTheEffects)
{
    const TempDir folder;
    // As other engines have it: geocentric, and nothing that says so.
    writeTerrain(folder, new osg::CoordinateSystemNode, osg::Vec3d(6378137.0, 0.0, 0.0));
    const auto file = folder.write("a.geofx", "<geofx version='1'><terrain><database file='terrain.osgb' "
                                              "frame='geocentric' minHeight='-4' maxHeight='1500' "
                                              "tileCells='8'/></terrain>"
                                              "<effects><birdsEyeView/></effects></geofx>");
    const osg::ref_ptr<osg::Node> node = osgDB::readRefNodeFile(file.string());
    const auto* effects = dynamic_cast<const osgGeoFX::EffectScene*>(node.get());
    ASSERT_TRUE(effects);
    const osgGeoFX::Ground ground = effects->ground();
    EXPECT_TRUE(ground.ellipsoid);
    EXPECT_TRUE(ground.heightsKnown);
    EXPECT_EQ(ground.minHeight, -4.0);
    EXPECT_EQ(ground.maxHeight, 1500.0);
    EXPECT_EQ(ground.tileEdge, 0.25);
}

TEST_F(ScenePlugin, ASceneWithoutEffectsIsAPlainGroup)
{
    const TempDir folder;
    writeTerrain(folder, geocentricRoot(), osg::Vec3d(6378137.0, 0.0, 0.0));
    for (const char* text : {"", "<effects/>"})
    {
        const osg::ref_ptr<osg::Node> node =
            osgDB::readRefNodeFile(folder.write("a.geofx", sceneWith(text)).string());
        ASSERT_TRUE(node);
        EXPECT_FALSE(dynamic_cast<osgGeoFX::EffectScene*>(node.get()));
        std::string error;
        const std::optional<osgGeoFX::Scene> scene = osgGeoFX::Scene::adopt(node, error);
        ASSERT_TRUE(scene) << error;
        ASSERT_EQ(scene->effects->getNumChildren(), 1u);
        EXPECT_EQ(scene->effects->getChild(0), node);
        EXPECT_EQ(scene->node, scene->effects);
    }
}

TEST_F(ScenePlugin, ASceneWithEffectsIsSavedForOtherPrograms)
{
    const TempDir folder;
    writeTerrain(folder, geocentricRoot(), osg::Vec3d(6378137.0, 0.0, 0.0));
    const auto file =
        folder.write("a.geofx", sceneWith("<effects><pedestrianView zoneWidth='750'/></effects>"));
    const osg::ref_ptr<osg::Node> node = osgDB::readRefNodeFile(file.string());
    ASSERT_TRUE(node);
    for (const char* name : {"a.osgt", "a.osgb", "a.osgx"})
    {
        const std::string saved = (folder / name).string();
        ASSERT_TRUE(osgDB::writeNodeFile(*node, saved)) << name;
        const osg::ref_ptr<osg::Node> read = osgDB::readRefNodeFile(saved);
        auto* scene = dynamic_cast<osgGeoFX::EffectScene*>(read.get());
        ASSERT_TRUE(scene) << name;
        ASSERT_EQ(scene->getNumEffects(), 1u) << name;
        EXPECT_EQ(scene->getEffect(0)->getProperty("zoneWidth"), 750.0) << name;
        EXPECT_EQ(scene->getNumChildren(), 1u) << name;
    }
}

TEST_F(ScenePlugin, EffectsThatDoNotFitAreSaidBeforeTheTerrainIsRead)
{
    const TempDir folder;
    folder.write("terrain.osgb", "not a database");
    const auto file =
        folder.write("a.geofx", sceneWith("<effects>\n<birdsEyeView focusLine='0.9'/></effects>"));
    EXPECT_NE(messageOf(file).find(
                  "a.geofx:4: <birdsEyeView>: BirdsEyeView: focusLine must lie below horizonLine."),
              std::string::npos)
        << messageOf(file);
}

TEST_F(ScenePlugin, SunStandsWhereTheSceneSays)
{
    const TempDir folder;
    const double longitude = -157.8, latitude = 21.4, azimuth = 245.0, elevation = 35.0;
    const GeographicLib::LocalCartesian local(latitude, longitude, 0.0);
    const double a = DegreesToRadians(azimuth), e = DegreesToRadians(elevation);
    osg::Vec3d origin, tip, expected(std::sin(a) * std::cos(e), std::cos(a) * std::cos(e), std::sin(e));
    double lat = 0.0, lon = 0.0, h = 0.0;
    const GeographicLib::Geocentric earth(GeographicLib::Constants::WGS84_a(),
                                          GeographicLib::Constants::WGS84_f());
    earth.Forward(latitude, longitude, 0.0, origin.x(), origin.y(), origin.z());
    local.Reverse(expected.x() * 1000.0, expected.y() * 1000.0, expected.z() * 1000.0, lat, lon, h);
    earth.Forward(lat, lon, h, tip.x(), tip.y(), tip.z());
    const osg::Vec3d world = (tip - origin) / 1000.0;
    const std::string sun = "<sun azimuth='245' elevation='35'/>";

    // At the terrain's center, and at the home view's place, which is where the terrain is not.
    writeTerrain(folder, geocentricRoot(), origin);
    osg::ref_ptr<osg::Node> scene = osgDB::readRefNodeFile(folder.write("a.geofx", sceneWith(sun)).string());
    ASSERT_TRUE(sunOf(scene));
    EXPECT_LT((directionOf(sunOf(scene)) - world).length(), 1e-5);
    writeTerrain(folder, geocentricRoot(), osg::Vec3d(6378137.0, 0.0, 0.0));
    scene = osgDB::readRefNodeFile(folder.write("b.geofx", sceneWith(sun)).string());
    ASSERT_TRUE(sunOf(scene));
    EXPECT_GT((directionOf(sunOf(scene)) - world).length(), 0.5);
    const std::string view =
        "<homeView longitude='-157.8' latitude='21.4' height='0' heading='0' pitch='0'/>";
    scene = osgDB::readRefNodeFile(folder.write("c.geofx", sceneWith(sun + view)).string());
    ASSERT_TRUE(sunOf(scene));
    EXPECT_LT((directionOf(sunOf(scene)) - world).length(), 1e-5);

    // On a projected terrain the azimuth is turned by the grid's convergence.
    int zone = 0;
    bool isNorth = false;
    double x = 0.0, y = 0.0, convergence = 0.0, scale = 0.0;
    GeographicLib::UTMUPS::Forward(latitude, longitude, zone, isNorth, x, y, convergence, scale, 4);
    writeTerrain(folder, new osg::CoordinateSystemNode("WKT", wktOf(32604)), osg::Vec3d(x, y, 0.0));
    scene = osgDB::readRefNodeFile((folder / "a.geofx").string());
    ASSERT_TRUE(sunOf(scene));
    const double grid = a - DegreesToRadians(convergence);
    EXPECT_GT(std::abs(convergence), 0.4);
    EXPECT_LT((directionOf(sunOf(scene)) -
               osg::Vec3d(std::sin(grid) * std::cos(e), std::cos(grid) * std::cos(e), std::sin(e)))
                  .length(),
              1e-5);
}

TEST_F(ScenePlugin, SceneErrorsReachThePerson)
{
    const TempDir folder;
    folder.write("a.geofx", sceneWith("<panorama/>"));
    geofx::test::ProgramOptions options;
    options.folder = folder.path().string();
    options.environment = {"OSG_LIBRARY_PATH=" GEOFX_BUILD_DIR "/lib"};
    const auto result =
        geofx::test::runProgram({geofx::test::builtProgram("read_scene"), "a.geofx"}, options);
    EXPECT_NE(result.exitCode, 0);
    EXPECT_NE(
        result.standardError.find("a.geofx:3: <panorama>: this element is not known in <geofx>; expected: "),
        std::string::npos)
        << result.standardError;
}

TEST_F(ScenePlugin, SceneSaysWhyItCannotBeRead)
{
    const TempDir folder;
    EXPECT_NE(messageOf(folder.write("a.geofx", sceneWith(""))).find("a.geofx:2: <database>: the file \""),
              std::string::npos);
    folder.write("terrain.none", "not a database");
    const auto scene = folder.write(
        "c.geofx", "<geofx version='1'>\n<terrain><database file='terrain.none'/></terrain></geofx>");
    EXPECT_NE(messageOf(scene).find("c.geofx:2: <database>: the terrain \""), std::string::npos);

    // A sun needs to know where north is.
    writeTerrain(folder, new osg::CoordinateSystemNode("WKT", "nonsense"), osg::Vec3d());
    EXPECT_TRUE(osgDB::readRefNodeFile((folder / "a.geofx").string()));
    EXPECT_NE(messageOf(folder.write("b.geofx", sceneWith("<sun azimuth='0' elevation='1'/>")))
                  .find("b.geofx:3: <sun>: The scene's coordinate system cannot be used: "),
              std::string::npos);

    EXPECT_EQ(osgDB::Registry::instance()->readNode((folder / "none.geofx").string(), nullptr).status(),
              osgDB::ReaderWriter::ReadResult::FILE_NOT_FOUND);
}

} // namespace
