// SPDX-License-Identifier: MIT
// SPDX-FileCopyrightText: 2026 the osgGeoFX authors
//
// <closeUps> of the scene file: the parser alone, then with files and terrain through the plugin osgdb_geofx.
#include <plugins/SceneFixture.h>

#include <tools/TestRasters.h>

#include <GeographicLib/LocalCartesian.hpp>
#include <GeographicLib/UTMUPS.hpp>
#include <osg/CoordinateSystemNode>
#include <osg/Geode>
#include <osg/Group>
#include <osg/Math>
#include <osg/Shape>
#include <osg/ShapeDrawable>
#include <osgDB/ReadFile>
#include <osgDB/WriteFile>

namespace
{

using geofx::test::TempDir;
using osg::DegreesToRadians;
using osgGeoFX::Anchor;
using osgGeoFX::CloseUp;
using osgGeoFX::CloseUps;
using osgGeoFX::parseScene;
using osgGeoFX::RegionOfInterest;
using osgGeoFX::SceneCloseUp;
using osgGeoFX::SceneCloseUps;
using osgGeoFX::SceneResult;
using osgGeoFX::SceneSurface;
using osgGeoFX::SurfaceData;

using Mistake = geofx::test::SceneMistake;

/// A scene whose close-ups begin on line 3.
std::string sceneWith(const std::string& inside, const std::string& attributes = {})
{
    return "<geofx version='1'><terrain><database file='terrain.osgb'/></terrain>\n<effects><closeUps " +
           attributes + ">\n" + inside + "</closeUps></effects></geofx>";
}

SceneCloseUps parsed(const std::string& inside, const std::string& attributes = {})
{
    const SceneResult result = parseScene(sceneWith(inside, attributes), "x.geofx", "/scenes");
    for (const std::string& error : result.errors)
        ADD_FAILURE() << error;
    if (!result.scene || result.scene->closeUps.size() != 1) return {};
    EXPECT_EQ(result.scene->effects.at(0), result.scene->closeUps[0].effect);
    return result.scene->closeUps[0];
}

TEST(SceneCloseUps, AreReadWithAllThatTheyName)
{
    const SceneCloseUps closeUps = parsed(
        "<colorTable name='ready' ready='magma' low='0' high='1.5'/>\n"
        "<colorTable name='text' file='ramp.txt'/>\n"
        "<surfaceData west='-158.3' south='21.2' east='-157.6' north='21.8' maxSide='512' radius='900'>\n"
        "<dem file='dem.tif'/>\n"
        "<vectors name='roads' file='/data/roads.gpkg' width='12.5' color='#ff000080'/>\n"
        "<surface name='cover' file='cover.tif' kind='class'/>\n"
        "<derived name='sky' kind='occlusion'/></surfaceData>\n"
        "<closeUp offsetHeight='4000' scaleHeight='0' orientation='billboard' surface='slope' table='ready' "
        "turn='+90' activity='noAnchor'>\n"
        "<region longitude='-157.8' latitude='21.26' width='3000' depth='2000.5' "
        "shape='star'/>\n"
        "<anchor kind='stretched' opacity='.5' lineWidth='0'/></closeUp>\n"
        "<closeUp surface='roads'><anchor table=' 1 0.5 +0\n.25'/>\n"
        "<region centerX='12' image='mask.png'/></closeUp>\n"
        "<closeUp><region><corner x='-1' y='-1'/><corner x='1' y='-0.5'/><corner x='0' y='1'/></region>"
        "</closeUp>",
        "pipeline='multiPass' supersampling='2'");
    ASSERT_TRUE(closeUps.effect);
    EXPECT_EQ(closeUps.effect->getPipeline(), CloseUps::MULTI_PASS);
    EXPECT_EQ(closeUps.effect->getSupersampling(), 2);
    ASSERT_EQ(closeUps.tables.size(), 1u);
    EXPECT_EQ(closeUps.tables[0].file.path, "/scenes/ramp.txt");

    ASSERT_TRUE(closeUps.surfaceData);
    ASSERT_TRUE(closeUps.surfaceData->box);
    EXPECT_EQ(closeUps.surfaceData->box->west, -158.3);
    EXPECT_EQ(closeUps.surfaceData->box->north, 21.8);
    EXPECT_EQ(closeUps.surfaceData->maxSide, 512);
    EXPECT_EQ(closeUps.surfaceData->radius, 900.0);
    const std::vector<SceneSurface>& surfaces = closeUps.surfaceData->surfaces;
    ASSERT_EQ(surfaces.size(), 4u);
    EXPECT_EQ(surfaces[0].source, SceneSurface::DEM);
    EXPECT_EQ(surfaces[0].file.path, "/scenes/dem.tif");
    EXPECT_EQ(surfaces[0].place.line, 6);
    EXPECT_EQ(surfaces[1].source, SceneSurface::VECTORS);
    EXPECT_EQ(surfaces[1].name, "roads");
    EXPECT_EQ(surfaces[1].file.path, "/data/roads.gpkg");
    EXPECT_EQ(surfaces[1].width, 12.5);
    EXPECT_EQ(surfaces[1].color, osg::Vec4(osg::Vec4d(1.0, 0.0, 0.0, 128.0 / 255.0)));
    EXPECT_EQ(surfaces[2].source, SceneSurface::RASTER);
    EXPECT_EQ(surfaces[2].kind, SurfaceData::CLASS);
    EXPECT_EQ(surfaces[3].source, SceneSurface::DERIVED);
    EXPECT_EQ(surfaces[3].kind, SurfaceData::OCCLUSION);

    ASSERT_EQ(closeUps.closeUps.size(), 3u);
    ASSERT_EQ(closeUps.effect->getNumCloseUps(), 3u);
    for (unsigned int i = 0; i < 3; ++i)
        EXPECT_EQ(closeUps.effect->getCloseUp(i), closeUps.closeUps[i].closeUp) << "the order stays";
    CloseUp& first = *closeUps.closeUps[0].closeUp;
    EXPECT_EQ(first.getOffset(), osg::Vec3d(0.0, 0.0, 4000.0));
    EXPECT_EQ(first.getScaleHeight(), 0.0);
    EXPECT_EQ(first.getOrientation(), CloseUp::BILLBOARD);
    EXPECT_DOUBLE_EQ(first.getTurn(), osg::PI_2);
    EXPECT_EQ(first.getActivity(), CloseUp::NO_ANCHOR);
    EXPECT_EQ(first.getSurface(), "slope") << "a picture of the DEM";
    ASSERT_TRUE(first.getTable());
    EXPECT_EQ(first.getTable()->range(), std::pair(0.0, 1.5));
    EXPECT_DOUBLE_EQ(first.getRegion()->getLongitude(), DegreesToRadians(-157.8));
    EXPECT_EQ(first.getRegion()->getDepth(), 2000.5);
    EXPECT_EQ(first.getRegion()->getShape(), RegionOfInterest::STAR);
    EXPECT_EQ(first.getAnchor()->getKind(), Anchor::STRETCHED);
    EXPECT_EQ(first.getAnchor()->getOpacity(), 0.5);
    EXPECT_EQ(first.getAnchor()->getStyle(), Anchor::FALLING);
    EXPECT_EQ(closeUps.closeUps[0].center, SceneCloseUp::DEGREES);
    EXPECT_EQ(closeUps.closeUps[0].place.element, "region");

    const SceneCloseUp& second = closeUps.closeUps[1];
    EXPECT_EQ(second.closeUp->getAnchor()->getStyle(), Anchor::TABLE);
    EXPECT_EQ(second.closeUp->getAnchor()->getTable(), (std::vector<float>{1.0f, 0.5f, 0.0f, 0.25f}));
    EXPECT_EQ(second.center, SceneCloseUp::METRES);
    EXPECT_EQ(second.closeUp->getRegion()->getCenter(), osg::Vec2d(12.0, 0.0));
    EXPECT_EQ(second.closeUp->getRegion()->getShape(), RegionOfInterest::IMAGE);
    ASSERT_TRUE(second.image);
    EXPECT_EQ(second.image->path, "/scenes/mask.png");
    EXPECT_FALSE(second.closeUp->getTable());

    const RegionOfInterest& third = *closeUps.closeUps[2].closeUp->getRegion();
    EXPECT_EQ(third.getShape(), RegionOfInterest::POLYGON);
    EXPECT_EQ(third.getOutline(), (std::vector<osg::Vec2d>{{-1.0, -1.0}, {1.0, -0.5}, {0.0, 1.0}}));
    EXPECT_EQ(closeUps.closeUps[2].center, SceneCloseUp::NOTHING);

    EXPECT_FALSE(parsed("").surfaceData);
    EXPECT_FALSE(parsed("<surfaceData><dem file='a'/></surfaceData>").surfaceData->box);
    // Shapes and styles that fit what stands beside them may be said.
    parsed("<closeUp><region shape='image' image='a.png'/><anchor style='table' table='0 1'/></closeUp>");
}

class CloseUpMistake : public testing::TestWithParam<Mistake>
{
};

TEST_P(CloseUpMistake, IsNamedWithFileLineElementAndMend)
{
    expectMistake(sceneWith(GetParam().inside), GetParam());
}

constexpr const char* edges = "<surfaceData west='1' south='2' east='3' north='4'>";

INSTANTIATE_TEST_SUITE_P(
    All, CloseUpMistake,
    testing::Values(
        Mistake{"UnknownElement", "<closeup/>", "3: <closeup>: this element is not known in <closeUps>",
                "<closeUp>"},
        Mistake{"UnknownAttribute", "<closeUp hight='1'/>",
                "3: <closeUp>: the attribute \"hight\" is not known", "offsetHeight"},
        Mistake{"Order", "<closeUp/>\n<colorTable name='a' ready='magma'/>",
                "4: <colorTable>: this element is out of place", "expected: <closeUp>."},
        Mistake{"TwoRegions", "<closeUp><region/>\n<region/></closeUp>",
                "4: <region>: this element is one too many", "at most one each of <region>, <anchor>."},
        Mistake{"RegionInEffect", "<region/>", "3: <region>: this element is", "<closeUp>"},
        Mistake{"Scale", "<closeUp scaleX='0'/>", "3: <closeUp>: scaleX=\"0\" ", "from 0.001 to 1000."},
        Mistake{"Orientation", "<closeUp orientation='up'/>", "3: <closeUp>: orientation=\"up\" ",
                "\"billboard\""},
        Mistake{"NoSuchTable", "<closeUp table='a'/>",
                "3: <closeUp>: table=\"a\" names no <colorTable> of this",
                "expected: nothing, there is none."},
        Mistake{"NoSuchSurface", "<closeUp surface='a'/>",
                "3: <closeUp>: surface=\"a\" names no picture of this effect's <surfaceData>; ",
                "expected: nothing, there is none."},
        Mistake{"AnotherSurface",
                "<surfaceData><dem file='a'/><vectors name='roads' file='b'/></surfaceData>\n"
                "<closeUp surface='road'/>",
                "4: <closeUp>: surface=\"road\" names no picture",
                "expected: height, normal, slope, aspect, occlusion, roads."},
        Mistake{"NothingCovered", "<surfaceData><surface name='a' file='b'/></surfaceData>",
                "3: <surfaceData>: nothing says what it covers; ", "or a <dem>."},
        Mistake{"EdgeMissing", "<surfaceData west='1' south='2' east='3'><dem file='a'/></surfaceData>",
                "3: <surfaceData>: nothing says what it covers; ", "all of west, south, east and north"},
        Mistake{"SouthAndNorth", "<surfaceData west='1' south='4' east='3' north='4'/>",
                "3: <surfaceData>: south must be less than north.", ""},
        Mistake{"TwoDems", std::string(edges) + "<dem file='a'/>\n<dem file='b'/></surfaceData>",
                "4: <dem>: this element is", "<derived>"},
        Mistake{"DemLater",
                std::string(edges) + "<surface name='a' file='a'/>\n<dem file='b'/></surfaceData>",
                "4: <dem>: this element is", "<surface>"},
        Mistake{"NameOfTheDem",
                std::string(edges) + "<dem file='a'/>\n<surface name='slope' file='b'/></surfaceData>",
                "4: <surface>: the name \"slope\" stands twice; ", "another name."},
        Mistake{"NoHeights", std::string(edges) + "\n<derived name='a' kind='slope'/></surfaceData>",
                "4: <derived>: there are no heights before it; ", "a <dem> or a <surface"},
        Mistake{"DerivedKind", std::string(edges) + "\n<derived name='a' kind='height'/></surfaceData>",
                "4: <derived>: kind=\"height\" ", "\"occlusion\"."},
        Mistake{"SurfaceKind",
                std::string(edges) + "\n<surface name='a' file='a' kind='normal'/></surfaceData>",
                "4: <surface>: kind=\"normal\" ", "\"height\""},
        Mistake{"NoName", std::string(edges) + "\n<vectors file='a'/></surfaceData>",
                "4: <vectors>: an attribute is missing", "name (what close-ups call it by"},
        Mistake{"Width", std::string(edges) + "\n<vectors name='a' file='a' width='0'/></surfaceData>",
                "4: <vectors>: width=\"0\" ", "metres, from 0.01 to 100000."},
        Mistake{"TableOfOne", "<closeUp><anchor table='1'/></closeUp>", "3: <anchor>: table=\"1\" ",
                "2 to 256 numbers from 0 to 1."},
        Mistake{"TableRange", "<closeUp><anchor table='1 2'/></closeUp>", "3: <anchor>: table=\"1 2\" ",
                "from 0 to 1."},
        Mistake{"TableAndStyle", "<closeUp><anchor style='rings' table='1 0'/></closeUp>",
                "3: <anchor>: a table is of no use with this style; ", "style=\"table\"."},
        Mistake{"CornersAndShape",
                "<closeUp><region shape='star'><corner x='0' y='0'/><corner x='1' y='0'/><corner x='0' "
                "y='1'/></region></closeUp>",
                "3: <region>: corners are of no use with this shape; ", "shape=\"polygon\"."},
        Mistake{"TwoCorners",
                "<closeUp><region><corner x='0' y='0'/><corner x='1' y='0'/></region></closeUp>",
                "3: <region>: its corners span no area; ", "three or more"},
        Mistake{"CornerRange", "<closeUp><region>\n<corner x='0' y='1.5'/></region></closeUp>",
                "4: <corner>: y=\"1.5\" ", "from -1 to 1."},
        Mistake{"CornerWithoutY", "<closeUp><region>\n<corner x='0'/></region></closeUp>",
                "4: <corner>: an attribute is missing; expected: y (to the front", ""},
        Mistake{"ImageAndShape", "<closeUp><region shape='ellipse' image='a.png'/></closeUp>",
                "3: <region>: an image is of no use with this shape; ", "shape=\"image\"."},
        Mistake{"LongitudeAlone", "<closeUp><region longitude='1'/></closeUp>",
                "3: <region>: longitude and latitude belong together", "remove one of the pairs."},
        Mistake{"PointAndCenter", "<closeUp><region longitude='1' latitude='2' centerY='0'/></closeUp>",
                "3: <region>: longitude and latitude belong together", "remove one of the pairs."}),
    [](const auto& mistake) { return std::string(mistake.param.name); });

TEST(SceneCloseUps, UnitsMustDiffer)
{
    const SceneResult result = parseScene(sceneWith("", "maskUnit='12' tableUnit='12'"), "x.geofx", "/");
    ASSERT_EQ(result.errors.size(), 1u);
    EXPECT_EQ(result.errors[0], "x.geofx:2: <closeUps>: CloseUps: maskUnit and tableUnit must differ.");
}

TEST(SceneCloseUps, NameFilesThatAreNotThere)
{
    const TempDir folder;
    folder.write("a.tif", "");
    const SceneResult result = parseScene(
        sceneWith(
            "<colorTable name='t' file='t.txt'/>\n<surfaceData><dem file='d.tif'/>\n"
            "<surface name='a' file='a.tif'/><vectors name='v' file='v.gpkg'/>"
            "<derived name='e' kind='slope'/></surfaceData>\n<closeUp><region image='m.png'/></closeUp>"),
        "x.geofx", folder.path().string());
    ASSERT_TRUE(result.scene) << testing::PrintToString(result.errors);
    const std::vector<std::string> errors = osgGeoFX::missingFiles(*result.scene);
    ASSERT_EQ(errors.size(), 5u) << testing::PrintToString(errors); // with the terrain
    EXPECT_EQ(errors[1].rfind("x.geofx:3: <colorTable>: the file ", 0), 0u) << errors[1];
    EXPECT_EQ(errors[2].rfind("x.geofx:4: <dem>: the file ", 0), 0u) << errors[2];
    EXPECT_EQ(errors[3].rfind("x.geofx:5: <vectors>: the file ", 0), 0u) << errors[3];
    EXPECT_EQ(errors[4],
              "x.geofx:6: <region>: the file \"" + (folder / "m.png").string() +
                  "\" does not exist; correct the attribute \"image\" (a relative path starts in the "
                  "folder of the scene file).");
}

/// Scenes with files, on a globe unless the test asks for another terrain.
class SceneCloseUpsPlugin : public geofx::test::SceneFiles
{
protected:
    void SetUp() override { setTerrain(0); }

    /// A database that says how far it reaches, in its own coordinates.
    void writeTerrain(int epsg, double west, double south, double east, double north)
    {
        const osg::ref_ptr<osg::CoordinateSystemNode> root = terrainOf(epsg);
        geofx::test::describeTerrain(*root, epsg == 0, west, south, east, north);
        saveTerrain(*root);
    }

    /// Some other file, 10 km about 0°, 0° on a globe.
    void writeBall()
    {
        const osg::ref_ptr<osg::CoordinateSystemNode> root = terrainOf(0);
        const osg::ref_ptr<osg::Geode> geode = new osg::Geode;
        geode->addDrawable(
            new osg::ShapeDrawable(new osg::Sphere(osg::Vec3(6378137.0f, 0.0f, 0.0f), 10000.0f)));
        root->addChild(geode);
        saveTerrain(*root);
    }

    CloseUps* read(const std::string& inside) { return effectOf<CloseUps>(sceneWith(inside)); }

    /// The message about a scene whose mistake is on a line, in an element.
    void expectMistake(const std::string& inside, int line, const std::string& element,
                       const std::string& holds)
    {
        std::string message;
        // What was refused may have something to say, too.
        _watch.messagesOf([&] { message = messageOf(_folder.write("wrong.geofx", sceneWith(inside))); });
        const std::string begins =
            (_folder / "wrong.geofx").string() + ":" + std::to_string(line) + ": <" + element + ">: ";
        EXPECT_EQ(message.rfind(begins, 0), 0u) << message;
        EXPECT_NE(message.find(holds), std::string::npos) << message;
        EXPECT_EQ(message.back(), '.') << message;
        EXPECT_EQ(message.find('\n'), std::string::npos) << message;
    }

    /// Heights that grow to the east, 40 × 20 cells of 0.01 degrees from 158° W, 21.5° N.
    void writeDem()
    {
        geofx::test::TestRaster(40, 20)
            .placed(-158.0, 21.5, 0.01, 0.01)
            .crs("EPSG:4326")
            .fill([](int column, int, int) { return 100.0 * column; })
            .write(_folder / "dem.tif");
    }
};

TEST_F(SceneCloseUpsPlugin, ReadMasksAndTables)
{
    const osg::ref_ptr<osg::Image> image = new osg::Image;
    image->allocateImage(4, 2, 1, GL_RGBA, GL_UNSIGNED_BYTE);
    for (unsigned int i = 0; i < image->getTotalSizeInBytes(); ++i)
        image->data()[i] = i < 16 ? 255 : 0;
    ASSERT_TRUE(osgDB::writeImageFile(*image, (_folder / "mask.png").string()));
    _folder.write("ramp.txt", "0 blue\n10 255 0 0\n");
    CloseUps* closeUps = read("<colorTable name='t' file='ramp.txt'/><closeUp table='t'>"
                              "<region longitude='-157.8' latitude='21.3' image='mask.png'/></closeUp>");
    ASSERT_TRUE(closeUps);
    ASSERT_EQ(closeUps->getNumCloseUps(), 1u);
    CloseUp& closeUp = *closeUps->getCloseUp(0);
    EXPECT_EQ(closeUp.getTable()->range(), std::pair(0.0, 10.0));
    const RegionOfInterest& region = *closeUp.getRegion();
    EXPECT_FALSE(region.isEmpty());
    EXPECT_NEAR(region.maskAt({0.0, -0.5}).x(), 1.0, 0.01) << "the lower row is white";
    EXPECT_NEAR(region.maskAt({0.0, 0.5}).x(), 0.0, 0.01);
    EXPECT_DOUBLE_EQ(region.getLongitude(), DegreesToRadians(-157.8));
    EXPECT_FALSE(closeUps->getSurfaceData());
}

TEST_F(SceneCloseUpsPlugin, APlaceOnAProjectedTerrainIsConverted)
{
    setTerrain(32604);
    CloseUps* closeUps = read("<closeUp><region longitude='-157.9' latitude='21.3'/></closeUp>"
                              "<closeUp><region centerX='600000' centerY='2300000'/></closeUp>");
    ASSERT_TRUE(closeUps);
    int zone = 0;
    bool north = false;
    double easting = 0.0, northing = 0.0;
    GeographicLib::UTMUPS::Forward(21.3, -157.9, zone, north, easting, northing);
    EXPECT_NEAR(closeUps->getCloseUp(0)->getRegion()->getCenter().x(), easting, 1e-3);
    EXPECT_NEAR(closeUps->getCloseUp(0)->getRegion()->getCenter().y(), northing, 1e-3);
    EXPECT_EQ(closeUps->getCloseUp(1)->getRegion()->getCenter(), osg::Vec2d(600000.0, 2300000.0));
}

TEST_F(SceneCloseUpsPlugin, SurfaceDataLieWhereTheirEdgesAre)
{
    writeDem();
    CloseUps* closeUps =
        read("<surfaceData west='-157.9' south='21.35' east='-157.7' north='21.45' maxSide='64'>"
             "<surface name='h' file='dem.tif' kind='height'/><derived name='s' kind='slope'/></surfaceData>"
             "<closeUp surface='s'><region longitude='-157.8' latitude='21.4'/></closeUp>");
    ASSERT_TRUE(closeUps);
    const SurfaceData* data = closeUps->getSurfaceData();
    ASSERT_TRUE(data);
    EXPECT_NEAR(data->getLongitude(), DegreesToRadians(-157.8), 1e-12);
    EXPECT_NEAR(data->getLatitude(), DegreesToRadians(21.4), 1e-12);
    // The corners that reach farthest.
    const GeographicLib::LocalCartesian frame(21.4, -157.8, 0.0);
    double x = 0.0, y = 0.0, z = 0.0;
    frame.Forward(21.35, -157.9, 0.0, x, y, z);
    EXPECT_NEAR(data->getLow().x(), x, 1e-3) << "the southern edge is the longer one";
    frame.Forward(21.35, -157.8, 0.0, x, y, z);
    EXPECT_NEAR(data->getLow().y(), y, 1e-3) << "and its middle the lowest";
    frame.Forward(21.45, -157.7, 0.0, x, y, z);
    EXPECT_NEAR(data->getHigh().y(), y, 1e-3);
    ASSERT_EQ(data->getNumLayers(), 2);
    EXPECT_EQ(data->getLayerKind(0), SurfaceData::HEIGHT);
    EXPECT_EQ(data->getLayerKind(1), SurfaceData::SLOPE);
    EXPECT_LE(std::max(data->getWidth(), data->getHeight()), 64);
    // 2000 m half a texel east of the middle, and 100 m in 0.01 degrees.
    const osg::Image& heights = *data->getLayerImage(0);
    const auto* middle =
        reinterpret_cast<const float*>(heights.data(data->getWidth() / 2, data->getHeight() / 2));
    EXPECT_NEAR(static_cast<double>(middle[0]), 2000.0, 5.0);
    const auto* slope = reinterpret_cast<const float*>(
        data->getLayerImage(1)->data(data->getWidth() / 2, data->getHeight() / 2));
    EXPECT_NEAR(static_cast<double>(slope[0]), std::atan(100.0 / 1037.0), 0.01);
}

TEST_F(SceneCloseUpsPlugin, SurfaceDataOfADemCoverIt)
{
    writeDem();
    _folder.write("roads.geojson",
                  R"({"type": "LineString", "coordinates": [[-158, 21.4], [-157.6, 21.4]]})");
    const std::string somewhere = "<closeUp><region longitude='-157.8' latitude='21.4'/></closeUp>";
    CloseUps* closeUps = read("<surfaceData maxSide='16' radius='0'><dem file='dem.tif'/>"
                              "<vectors name='roads' file='roads.geojson' width='9000' color='#ff0000'/>"
                              "<surface name='v' file='dem.tif' kind='value'/></surfaceData>" +
                              somewhere);
    ASSERT_TRUE(closeUps);
    const SurfaceData* data = closeUps->getSurfaceData();
    ASSERT_TRUE(data);
    EXPECT_NEAR(data->getLongitude(), DegreesToRadians(-157.8), 1e-9);
    EXPECT_NEAR(data->getLatitude(), DegreesToRadians(21.4), 1e-9);
    std::string names;
    for (int layer = 0; layer < data->getNumLayers(); ++layer)
        names += data->getLayerName(layer) + " ";
    EXPECT_EQ(names, "height normal slope aspect occlusion roads v ");
    EXPECT_EQ(std::max(data->getWidth(), data->getHeight()), 16);
    const auto* road = reinterpret_cast<const float*>(
        data->getLayerImage(5)->data(data->getWidth() / 2, data->getHeight() / 2));
    EXPECT_EQ(road[0], 1.0f);
    EXPECT_EQ(road[1], 0.0f);
    EXPECT_GT(road[3], 0.5f);

    setTerrain(32604);
    closeUps = read("<surfaceData west='620000' south='2365000' east='624000' north='2367000'>"
                    "<dem file='dem.tif'/></surfaceData>" +
                    somewhere);
    ASSERT_TRUE(closeUps);
    data = closeUps->getSurfaceData();
    ASSERT_TRUE(data);
    EXPECT_EQ(data->getOrigin(), osg::Vec2d(622000.0, 2366000.0));
    EXPECT_EQ(data->getLow(), osg::Vec2d(-2000.0, -1000.0));
    EXPECT_EQ(data->getHigh(), osg::Vec2d(2000.0, 1000.0));
    EXPECT_EQ(data->getWidth(), 2 * data->getHeight());
}

TEST_F(SceneCloseUpsPlugin, MistakesAreNamedWithPlaceAndMend)
{
    writeDem();
    _folder.write("broken.png", "no picture");
    _folder.write("broken.tif", "no raster");
    _folder.write("broken.txt", "1 2 3\n");
    expectMistake("<closeUp>\n<region image='broken.png'/></closeUp>", 4, "region", "convert it to PNG");
    expectMistake("<colorTable name='a' file='broken.txt'/>", 3, "colorTable", "broken.txt:1");
    expectMistake("<surfaceData>\n<dem file='broken.tif'/></surfaceData>", 4, "dem",
                  "is not a raster that GDAL can read");
    const std::string edgesHere = "<surfaceData west='-157.9' south='21.35' east='-157.7' north='21.45'>\n";
    expectMistake(edgesHere + "<vectors name='a' file='broken.tif'/></surfaceData>", 4, "vectors",
                  "broken.tif");
    const std::string far = "<surfaceData west='10' south='2' east='11' north='4'>\n";
    expectMistake(far + "<surface name='a' file='dem.tif'/></surfaceData>", 4, "surface", "dem.tif");
    expectMistake(far + "<dem file='dem.tif'/></surfaceData>", 4, "dem", "dem.tif");
    expectMistake("<surfaceData west='500000' south='2' east='600000' north='4'/>", 3, "surfaceData",
                  "latitudes from -90 to 90");
    expectMistake("<surfaceData west='-90' south='2' east='90' north='4'/>", 3, "surfaceData",
                  "120 degrees at most");
    expectMistake("<closeUp>\n<region centerX='1'/></closeUp>", 4, "region", "the terrain is a globe");
    const std::string remedy = "longitude and latitude";
    expectMistake("<closeUp>\n<region width='9'/></closeUp>", 4, "region", remedy);
    expectMistake("\n<closeUp/>", 4, "closeUp", remedy);
    expectMistake("<closeUp>\n<anchor/></closeUp>", 3, "closeUp", remedy);
    setTerrain(32604);
    expectMistake("<surfaceData west='3' south='2' east='1' north='4'/>", 3, "surfaceData",
                  "west must be less than east.");
    expectMistake("<closeUp>\n<region longitude='-69' latitude='0'/></closeUp>", 4, "region",
                  "terrain's projection");
    const osg::ref_ptr<osg::Group> plain = new osg::Group;
    ASSERT_TRUE(osgDB::writeNodeFile(*plain, (_folder / "terrain.osgb").string()));
    expectMistake("<closeUp>\n<region longitude='1' latitude='2'/></closeUp>", 4, "region",
                  "no coordinate system");
    expectMistake("<surfaceData>\n<dem file='dem.tif'/></surfaceData>", 4, "dem",
                  "the terrain has no coordinate system");
}

TEST_F(SceneCloseUpsPlugin, RegionsOffTheTerrainAreSaid)
{
    const auto warningsOf = [&](const std::string& region)
    {
        std::string all;
        for (const std::string& message :
             _watch.messagesOf([&] { EXPECT_TRUE(read("<closeUp>\n" + region + "</closeUp>")) << region; }))
            all += message;
        return all;
    };
    const auto expectOff = [&](const std::string& region, const std::string& holds)
    {
        const std::string warning = warningsOf(region);
        EXPECT_NE(warning.find("x.geofx:4: <region>: the region lies off the terrain"), std::string::npos)
            << region << warning;
        EXPECT_NE(warning.find(holds), std::string::npos) << warning;
    };
    // A database says how far it reaches: here from 179° to 181°.
    writeTerrain(0, 179.0, -1.0, 181.0, 1.0);
    EXPECT_EQ(warningsOf("<region longitude='-179.5' latitude='0'/>"), "");
    EXPECT_EQ(warningsOf("<region longitude='179.5' latitude='0.9'/>"), "");
    EXPECT_EQ(warningsOf("<region longitude='-178.999' latitude='0' width='500'/>"), "")
        << "a part of it lies on the terrain";
    expectOff("<region longitude='-178.9' latitude='0' width='500'/>",
              "from longitude 179 to 181 and from latitude -1 to 1.");
    expectOff("<region longitude='0' latitude='0'/>", "from longitude 179");
    expectOff("<region longitude='180' latitude='1.1'/>", "latitude -1 to 1");
    // Swapped, as people write them.
    writeTerrain(0, -158.4, 21.1, -157.5, 21.85);
    expectOff("<region longitude='21.3' latitude='-57.8'/>", "from longitude -158.4 to -157.5");
    writeTerrain(32604, 560000.0, 2330000.0, 650000.0, 2420000.0);
    EXPECT_EQ(warningsOf("<region centerX='600000' centerY='2400000'/>"), "");
    EXPECT_EQ(warningsOf("<region longitude='-157.9' latitude='21.3'/>"), "");
    expectOff("<region width='500'/>", "from x = 560000 to 650000 and from y = 2330000 to 2420000.");
    expectOff("<region centerX='600000' centerY='2300000'/>", "from x = 560000");
    // Without a database's word, by its bounding sphere: 10 km about 0°, 0°.
    writeBall();
    EXPECT_EQ(warningsOf("<region longitude='0.05' latitude='-0.05'/>"), "");
    expectOff("<region longitude='0.2' latitude='0'/>", "correct its place.");
}

TEST_F(SceneCloseUpsPlugin, NoneAtAllIsSaid)
{
    std::string all;
    for (const std::string& message : _watch.messagesOf([&] { EXPECT_TRUE(read("")); }))
        all += message;
    EXPECT_NE(all.find("x.geofx:2: <closeUps>: closeUps draws nothing, because it has no close-up; "),
              std::string::npos)
        << all;
}

} // namespace
