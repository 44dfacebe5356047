// SPDX-License-Identifier: MIT
// SPDX-FileCopyrightText: 2026 the osgGeoFX authors
//
// <projectiveMappings> of the scene file: the parser alone, then with files and terrain through the plugin osgdb_geofx.
#include <plugins/SceneFixture.h>

#include <osgGeoFX/mapping/LayerSequence.h>
#include <osgGeoFX/mapping/PagedRaster.h>
#include <osgGeoFX/mapping/RouteMapping.h>
#include <osgGeoFX/raster/LayerPixels.h>
#include <tools/HeightMesh.h>
#include <tools/KmlFiles.h>
#include <tools/TestRasters.h>

#include <GeographicLib/Geocentric.hpp>
#include <GeographicLib/LocalCartesian.hpp>
#include <GeographicLib/UTMUPS.hpp>
#include <osg/CoordinateSystemNode>
#include <osg/Geometry>
#include <osg/Group>
#include <osg/Math>
#include <osg/MatrixTransform>
#include <osgDB/ReadFile>
#include <osgDB/WriteFile>

#include <cmath>
#include <filesystem>

namespace
{

using geofx::test::TempDir;
using osg::DegreesToRadians;
using osgGeoFX::ColorTable;
using osgGeoFX::ColorTransfer;
using osgGeoFX::DataLayer;
using osgGeoFX::parseScene;
using osgGeoFX::ProjectiveMapping;
using osgGeoFX::ProjectiveMappings;
using osgGeoFX::RouteMapping;
using osgGeoFX::SceneMapping;
using osgGeoFX::SceneMappings;
using osgGeoFX::SceneResult;

using Mistake = geofx::test::SceneMistake;

/// A scene whose mappings begin on line 3.
std::string sceneWith(const std::string& inside, const std::string& attributes = {})
{
    return "<geofx version='1'><terrain><database "
           "file='terrain.osgb'/></terrain>\n<effects><projectiveMappings " +
           attributes + ">\n" + inside + "</projectiveMappings></effects></geofx>";
}

SceneMappings parsed(const std::string& inside, const std::string& attributes = {})
{
    const SceneResult result = parseScene(sceneWith(inside, attributes), "x.geofx", "/scenes");
    for (const std::string& error : result.errors)
        ADD_FAILURE() << error;
    if (!result.scene || result.scene->mappings.size() != 1) return {};
    EXPECT_EQ(result.scene->effects.at(0), result.scene->mappings[0].effect);
    return result.scene->mappings[0];
}

TEST(SceneMappings, AreReadWithAllThatTheyName)
{
    const SceneMappings mappings = parsed(
        "<layer name='noise' file='noise.png' kind='value' smooth='false' sRgb='false' noData='-1' "
        "importance='.25'/>\n"
        "<layer name='mask' file='/data/mask.tif'/>\n"
        "<colorTable name='ready' ready='magma' low='40' high='80' mode='steps' noDataColor='#ff000080'/>\n"
        "<colorTable name='text' file='ramp.txt' low='-5' high='5'/>\n"
        "<colorTable name='own' mode='exact'><stop value='2' color='#00ff00'/><stop value='-1e3' "
        "color='#0000ff33'/>"
        "</colorTable>\n"
        "<transfer name='show' source='table' equation='multiply'/>\n"
        "<mapping layer='noise' mask='mask' table='ready' transfer='show' order='3' opacity='0.5' "
        "centerX='7'/>\n"
        "<raster file='r.tif' kind='class' maxSide='512' table='own' order='-2'/>\n"
        "<mapping layer='noise' west='-158' south='21' east='-157' north='22'/>\n"
        "<mapping layer='mask' longitude='-157.5' latitude='21.5' uX='10'/>\n",
        "latitude='21.5'");
    EXPECT_TRUE(mappings.hasOrigin);
    ASSERT_EQ(mappings.layers.size(), 2u);
    DataLayer& noise = *mappings.layers[0].layer;
    EXPECT_EQ(noise.getName(), "noise");
    EXPECT_EQ(noise.getKind(), DataLayer::VALUE);
    EXPECT_FALSE(noise.getSmooth());
    EXPECT_FALSE(noise.getSRgb());
    EXPECT_TRUE(noise.getHasNoData());
    EXPECT_EQ(noise.getNoData(), -1.0);
    EXPECT_EQ(noise.getImportance(), 0.25);
    EXPECT_EQ(mappings.layers[0].file.path, "/scenes/noise.png");
    EXPECT_EQ(mappings.layers[0].file.place.line, 3);
    EXPECT_EQ(mappings.layers[1].file.path, "/data/mask.tif");
    EXPECT_FALSE(mappings.layers[1].layer->getHasNoData());
    ASSERT_EQ(mappings.tables.size(), 1u);
    EXPECT_EQ(mappings.tables[0].file.path, "/scenes/ramp.txt");
    EXPECT_EQ(mappings.tables[0].range, std::pair(-5.0, 5.0));

    ASSERT_EQ(mappings.mappings.size(), 4u);
    ASSERT_EQ(mappings.effect->getNumMappings(), 4u);
    for (unsigned int i = 0; i < 4; ++i)
        EXPECT_EQ(mappings.effect->getMapping(i), mappings.mappings[i].mapping) << "the order stays";
    ProjectiveMapping& first = *mappings.mappings[0].mapping;
    EXPECT_EQ(first.getLayer(), &noise);
    EXPECT_EQ(first.getMask(), mappings.layers[1].layer);
    ASSERT_TRUE(first.getTable());
    EXPECT_EQ(first.getTable()->getMode(), ColorTable::STEPS);
    EXPECT_EQ(first.getTable()->range(), std::pair(40.0, 80.0));
    EXPECT_EQ(first.getTable()->getNoDataColor(), osg::Vec4(osg::Vec4d(1.0, 0.0, 0.0, 128.0 / 255.0)));
    EXPECT_EQ(first.getTransfer()->getEquation(), ColorTransfer::MULTIPLY);
    EXPECT_EQ(first.getTransfer()->getSource(), ColorTransfer::TABLE);
    EXPECT_TRUE(mappings.mappings[0].hasTransfer);
    EXPECT_EQ(first.getOrder(), 3);
    EXPECT_EQ(first.getOpacity(), 0.5);
    EXPECT_EQ(first.getCenter(), osg::Vec2d(7.0, 0.0));
    EXPECT_FALSE(mappings.mappings[0].box || mappings.mappings[0].point || mappings.mappings[0].raster);

    const SceneMapping& raster = mappings.mappings[1];
    ASSERT_TRUE(raster.raster);
    EXPECT_EQ(raster.raster->file.path, "/scenes/r.tif");
    EXPECT_EQ(raster.raster->kind, DataLayer::CLASS);
    EXPECT_EQ(raster.raster->maxSide, 512);
    EXPECT_FALSE(raster.hasTransfer);
    EXPECT_EQ(raster.mapping->getOrder(), -2);
    const ColorTable* own = raster.mapping->getTable();
    ASSERT_TRUE(own);
    EXPECT_EQ(own->getMode(), ColorTable::EXACT);
    ASSERT_EQ(own->getStops().size(), 2u);
    EXPECT_EQ(own->getStops()[0].value, -1000.0);
    EXPECT_EQ(own->getStops()[0].color, osg::Vec4(osg::Vec4d(0.0, 0.0, 1.0, 0.2)));
    EXPECT_EQ(own->getStops()[1].color, osg::Vec4(0.0f, 1.0f, 0.0f, 1.0f));

    ASSERT_TRUE(mappings.mappings[2].box);
    EXPECT_EQ(mappings.mappings[2].box->west, -158.0);
    EXPECT_EQ(mappings.mappings[2].box->north, 22.0);
    EXPECT_EQ(mappings.mappings[2].mapping->getLayer(), &noise) << "layers are shared";
    ASSERT_TRUE(mappings.mappings[3].point);
    EXPECT_EQ(mappings.mappings[3].point->longitude, -157.5);
    EXPECT_EQ(mappings.mappings[3].mapping->getU(), osg::Vec2d(10.0, 0.0));
    EXPECT_FALSE(parsed("").hasOrigin);
    for (const char* name : {"originX", "originY", "longitude"})
        EXPECT_TRUE(parsed("", std::string(name) + "='0'").hasOrigin) << "zero is an origin, too";
}

TEST(SceneMappings, NamesBelongToOneEffect)
{
    const std::string effect =
        "<projectiveMappings><layer name='a' file='a.png'/><mapping layer='a'/></projectiveMappings>";
    const std::string start =
        "<geofx version='1'><terrain><database file='terrain.osgb'/></terrain><effects>";
    const SceneResult result = parseScene(start + effect + effect + "</effects></geofx>", "x.geofx", "/");
    ASSERT_TRUE(result.scene) << testing::PrintToString(result.errors);
    ASSERT_EQ(result.scene->mappings.size(), 2u);
    EXPECT_NE(result.scene->mappings[0].mappings[0].mapping->getLayer(),
              result.scene->mappings[1].mappings[0].mapping->getLayer());
}

TEST(SceneMappings, SetsOfOneSceneHaveUnitsOfTheirOwn)
{
    const SceneResult result =
        parseScene("<geofx version='1'><terrain><database file='terrain.osgb'/></terrain><effects>"
                   "<projectiveMappings/><projectiveMappings dataUnit='9' layerUnit='-1'/>"
                   "<closeUps/><panoramaMap/></effects></geofx>",
                   "x.geofx", "/");
    ASSERT_TRUE(result.scene) << testing::PrintToString(result.errors);
    const osgGeoFX::TextureUnits given = osgGeoFX::TextureUnits::of(result.scene->effects);
    EXPECT_EQ(given.ofEffects, (std::vector<osgGeoFX::TextureUnits::Units>{
                                   {8, 4, 10}, {9, 5, 6}, {11, 12, 13}, {14, 15, 16, 17, 18, 7}}));
    EXPECT_TRUE(given.sentences.empty());
}

class MappingMistake : public testing::TestWithParam<Mistake>
{
};

TEST_P(MappingMistake, IsNamedWithFileLineElementAndMend)
{
    expectMistake(sceneWith(GetParam().inside), GetParam());
}

INSTANTIATE_TEST_SUITE_P(
    All, MappingMistake,
    testing::Values(
        Mistake{"NoName", "<layer file='a'/>", "3: <layer>: ", "expected: name (what mappings call it by"},
        Mistake{"NoFile", "<layer name='a'/>", "3: <layer>: ", "expected: file (a path; "},
        Mistake{"NameTwice", "<layer name='a' file='a'/>\n<layer name='a' file='b'/>",
                "4: <layer>: ", "the name \"a\" stands twice; give one of them another name."},
        Mistake{"TransferTwice", "<transfer name='a'/>\n<transfer name='a'/>",
                "4: <transfer>: ", "stands twice"},
        Mistake{"NoSuchLayer", "<layer name='a' file='a'/><layer name='b' file='b'/>\n<mapping layer='c'/>",
                "4: <mapping>: layer=\"c\" names no <layer> of this effect; ", "expected: a, b."},
        Mistake{"NoSuchTable", "<mapping table='c'/>",
                "3: <mapping>: table=\"c\" names no <colorTable> of this effect; ",
                "expected: nothing, there is none."},
        Mistake{"NoSuchTransfer", "<raster file='a' transfer='c'/>", "3: <raster>: transfer=\"c\" ",
                "<transfer>"},
        Mistake{"NoSuchMask", "<raster file='a' mask='c'/>", "3: <raster>: mask=\"c\" ", "<layer>"},
        Mistake{"Order", "<mapping/>\n<layer name='a' file='a'/>", "4: <layer>: this element is out of place",
                "<raster>, <sequence>, <overlays>, <route>, in this order."},
        Mistake{"UnknownElement", "<decal/>", "3: <decal>: this element is not known in <projectiveMappings>",
                "<mapping>"},
        Mistake{"UnknownAttribute", "<mapping centreX='2'/>",
                "3: <mapping>: the attribute \"centreX\" is not known here", "centerX"},
        Mistake{"RasterHasAPlace", "<raster file='a' centerX='2'/>",
                "3: <raster>: the attribute \"centerX\" is not known here", "maxSide"},
        Mistake{"RasterSide", "<raster file='a' maxSide='0'/>", "3: <raster>: maxSide=\"0\" ",
                "from 1 to 16384."},
        Mistake{"NoColors", "<colorTable name='a'/>", "3: <colorTable>: nothing says what the colors are; ",
                "expected: one of ready, file and <stop> elements."},
        Mistake{"TwoColors",
                "<colorTable name='a' ready='magma'><stop value='1' color='#000000'/></colorTable>",
                "3: <colorTable>: too much says", "expected: one of ready"},
        Mistake{"Ready", "<colorTable name='a' ready='jet'/>", "3: <colorTable>: ready=\"jet\" ",
                "\"viridis\""},
        Mistake{"LowHigh", "<colorTable name='a' ready='magma' low='2'/>",
                "3: <colorTable>: low must be less than high.", ""},
        Mistake{"LowOfStops", "<colorTable name='a' low='0'><stop value='1' color='#000000'/></colorTable>",
                "3: <colorTable>: low and high are of no use with <stop> elements; ", "remove them."},
        Mistake{"StopColor", "<colorTable name='a'>\n<stop value='1' color='#00000'/></colorTable>",
                "4: <stop>: color=\"#00000\" ", "two hexadecimal digits each"},
        Mistake{"StopValue", "<colorTable name='a'>\n<stop value='INF' color='#000000'/></colorTable>",
                "4: <stop>: value=\"INF\" ", "from -1e30 to 1e30."},
        Mistake{"ValuesDoNotFit", "<transfer name='a' lowValue='2'/>",
                "3: <transfer>: ColorTransfer: lowValue must be less than highValue.", ""},
        Mistake{"NoArea", "<mapping uX='0'/>", "3: <mapping>: ProjectiveMapping: U and V must span an area",
                ""},
        Mistake{"EdgesMissing", "<mapping west='1' south='2' east='3'/>",
                "3: <mapping>: west, south, east and north belong", "remove centerX"},
        Mistake{"EdgesAndCenter", "<mapping west='1' south='2' east='3' north='4' centerY='0'/>",
                "3: <mapping>: west, south, east and north belong", "or the edges."},
        Mistake{"EdgesAndAxes", "<mapping west='1' south='2' east='3' north='4' m22='1'/>",
                "3: <mapping>: west, south, east and north belong", "or the edges."},
        Mistake{"EdgesAndPoint", "<mapping west='1' south='2' east='3' north='4' latitude='3'/>",
                "3: <mapping>: west, south, east and north belong", "or the edges."},
        Mistake{"SouthAndNorth", "<mapping west='1' south='4' east='3' north='4'/>",
                "3: <mapping>: south must be less than north.", ""},
        Mistake{"WestAndEast", "<mapping west='1' south='2' east='1' north='4'/>",
                "3: <mapping>: west and east must differ.", ""},
        Mistake{"LongitudeAlone", "<mapping longitude='1'/>",
                "3: <mapping>: longitude and latitude belong together", "remove one of the pairs."},
        Mistake{"PointAndCenter", "<mapping longitude='1' latitude='2' centerX='0'/>",
                "3: <mapping>: longitude and latitude belong together", "remove one of the pairs."},
        Mistake{"Latitude", "<mapping longitude='1' latitude='91'/>", "3: <mapping>: latitude=\"91\" ",
                "from -90 to 90."}),
    [](const auto& mistake) { return std::string(mistake.param.name); });

TEST(SceneMappings, NameFilesThatAreNotThere)
{
    const TempDir folder;
    folder.write("a.png", "");
    const SceneResult result =
        parseScene(sceneWith("<layer name='a' file='a.png'/>\n<layer name='b' file='b.png'/>\n"
                             "<colorTable name='c' file='c.txt'/>\n<raster file='d.tif'/>"),
                   "x.geofx", folder.path().string());
    ASSERT_TRUE(result.scene) << testing::PrintToString(result.errors);
    std::vector<std::string> errors = osgGeoFX::missingFiles(*result.scene);
    ASSERT_EQ(errors.size(), 4u) << testing::PrintToString(errors); // with the terrain
    EXPECT_EQ(errors[1],
              "x.geofx:4: <layer>: the file \"" + (folder / "b.png").string() +
                  "\" does not exist; correct the attribute \"file\" (a relative path starts in the "
                  "folder of the scene file).");
    EXPECT_EQ(errors[2].rfind("x.geofx:5: <colorTable>: the file ", 0), 0u) << errors[2];
    EXPECT_EQ(errors[3].rfind("x.geofx:6: <raster>: the file ", 0), 0u) << errors[3];
}

/// Scenes with files, on a globe unless the test asks for another terrain.
class SceneMappingsPlugin : public geofx::test::SceneFiles
{
protected:
    void SetUp() override
    {
        const osg::ref_ptr<osg::Image> image = new osg::Image;
        image->allocateImage(4, 2, 1, GL_RGBA, GL_UNSIGNED_BYTE);
        for (unsigned int i = 0; i < image->getTotalSizeInBytes(); ++i)
            image->data()[i] = static_cast<unsigned char>(31 * i);
        ASSERT_TRUE(osgDB::writeImageFile(*image, (_folder / "a.png").string()));
        setTerrain(0);
    }

    ProjectiveMappings* read(const std::string& inside, const std::string& attributes = {})
    {
        return effectOf<ProjectiveMappings>(sceneWith(inside, attributes));
    }

    std::string messageWith(const std::string& inside, const std::string& attributes = {})
    {
        return messageOf(_folder.write("wrong.geofx", sceneWith(inside, attributes)));
    }

    /// Fails unless a mapping's corner, counted from the lower left, is where GeographicLib sees a place from an origin.
    static void expectCorner(const ProjectiveMapping& mapping, std::size_t corner, double longitude,
                             double latitude, const GeographicLib::LocalCartesian& frame)
    {
        double x = 0.0, y = 0.0, z = 0.0;
        frame.Forward(latitude, longitude, 0.0, x, y, z);
        const auto outline = mapping.outline();
        ASSERT_TRUE(outline);
        EXPECT_NEAR(outline->corners[corner].x(), x, 1e-3);
        EXPECT_NEAR(outline->corners[corner].y(), y, 1e-3);
    }
};

TEST_F(SceneMappingsPlugin, ReadPicturesAndTables)
{
    _folder.write("ramp.txt", "0% blue\n100% 255 0 0\nnv 1 2 3\n");
    ProjectiveMappings* mappings =
        read("<layer name='a' file='a.png'/>"
             "<colorTable name='t' file='ramp.txt' low='10' high='30' mode='nearest'/>"
             "<colorTable name='r' ready='greys' high='9'/><transfer name='s' source='scene' saturation='0'/>"
             "<mapping layer='a' table='t'/><mapping layer='a' table='r' transfer='s'/><mapping layer='a'/>");
    ASSERT_TRUE(mappings);
    ASSERT_EQ(mappings->getNumMappings(), 3u);
    ProjectiveMapping& first = *mappings->getMapping(0);
    ASSERT_TRUE(first.getLayer()->getImage());
    EXPECT_EQ(first.getLayer()->getImage()->s(), 4);
    EXPECT_FLOAT_EQ(first.getLayer()->getImage()->getColor(1, 1).r(),
                    static_cast<float>(31 * 20 % 256) / 255.0f);
    EXPECT_EQ(first.getTable()->range(), std::pair(10.0, 30.0));
    EXPECT_EQ(first.getTable()->getMode(), ColorTable::NEAREST);
    EXPECT_EQ(first.getTable()->at(10.0), osg::Vec4(0, 0, 1, 1));
    EXPECT_NEAR(static_cast<double>(first.getTable()->getNoDataColor().b()), 3.0 / 255.0, 1e-6);
    // A table without a transfer is shown over its whole range.
    EXPECT_EQ(first.getTransfer()->getSource(), ColorTransfer::TABLE);
    EXPECT_EQ(first.getTransfer()->getLowValue(), 10.0);
    EXPECT_EQ(first.getTransfer()->getHighValue(), 30.0);
    EXPECT_EQ(mappings->getMapping(1)->getTransfer()->getSource(), ColorTransfer::SCENE);
    EXPECT_EQ(mappings->getMapping(1)->getTransfer()->getHighValue(), 1.0);
    EXPECT_EQ(mappings->getMapping(2)->getTransfer()->getSource(), ColorTransfer::LAYER);
    EXPECT_EQ(mappings->getMapping(2)->getLayer(), first.getLayer());
    // A mapping in metres leaves the origin alone.
    EXPECT_EQ(mappings->getLongitude(), 0.0);
    EXPECT_EQ(mappings->getLatitude(), 0.0);
}

TEST_F(SceneMappingsPlugin, EdgesOnAGlobeAreWhereTheyAre)
{
    const ProjectiveMappings* mappings =
        read("<layer name='a' file='a.png'/>"
             "<mapping layer='a' west='-158' south='21' east='-157.5' north='21.25'/>"
             "<mapping layer='a' west='-157' south='20.5' east='-156.5' north='20.75'/>"
             "<mapping layer='a' longitude='-158.25' latitude='22' uX='50' vY='20'/>");
    ASSERT_TRUE(mappings);
    EXPECT_DOUBLE_EQ(mappings->getLongitude(), DegreesToRadians(-157.75));
    EXPECT_DOUBLE_EQ(mappings->getLatitude(), DegreesToRadians(21.125));
    const GeographicLib::LocalCartesian frame(21.125, -157.75, 0.0);
    expectCorner(*mappings->getMapping(0), 0, -158.0, 21.0, frame);
    expectCorner(*mappings->getMapping(0), 1, -157.5, 21.0, frame);
    expectCorner(*mappings->getMapping(0), 2, -157.5, 21.25, frame);
    expectCorner(*mappings->getMapping(0), 3, -158.0, 21.25, frame);
    expectCorner(*mappings->getMapping(1), 2, -156.5, 20.75, frame);
    double x = 0.0, y = 0.0, z = 0.0;
    frame.Forward(22.0, -158.25, 0.0, x, y, z);
    EXPECT_NEAR(mappings->getMapping(2)->getCenter().x(), x, 1e-3);
    EXPECT_NEAR(mappings->getMapping(2)->getCenter().y(), y, 1e-3);
    EXPECT_EQ(mappings->getMapping(2)->getU(), osg::Vec2d(50.0, 0.0));

    // An origin of one's own stays, and the antimeridian is no border.
    mappings = read("<mapping west='179.5' south='-17' east='-179' north='-16'/>",
                    "longitude='179' latitude='-17.5'");
    ASSERT_TRUE(mappings);
    EXPECT_DOUBLE_EQ(mappings->getLongitude(), DegreesToRadians(179.0));
    const GeographicLib::LocalCartesian fiji(-17.5, 179.0, 0.0);
    expectCorner(*mappings->getMapping(0), 0, 179.5, -17.0, fiji);
    expectCorner(*mappings->getMapping(0), 2, -179.0, -16.0, fiji);
    mappings = read("<mapping west='179.5' south='-17' east='-179' north='-16'/>");
    ASSERT_TRUE(mappings);
    EXPECT_NEAR(mappings->getLongitude(), DegreesToRadians(-179.75), 1e-12);
    mappings = read("<mapping longitude='10' latitude='-60'/>");
    ASSERT_TRUE(mappings);
    EXPECT_DOUBLE_EQ(mappings->getLongitude(), DegreesToRadians(10.0));
    EXPECT_NEAR(mappings->getMapping(0)->getCenter().length(), 0.0, 1e-6);
    // The first mapping decides, though it be one in metres.
    mappings = read("<mapping centerX='5'/><mapping longitude='1' latitude='1'/>");
    ASSERT_TRUE(mappings);
    EXPECT_EQ(mappings->getLongitude(), 0.0);
}

TEST_F(SceneMappingsPlugin, EdgesOnAProjectedTerrainAreItsCoordinates)
{
    setTerrain(32604);
    const ProjectiveMappings* mappings =
        read("<mapping west='600000' south='2300000' east='601000' north='2300500'/>"
             "<mapping longitude='-157.9' latitude='21.3'/>");
    ASSERT_TRUE(mappings);
    EXPECT_EQ(mappings->getOrigin(), osg::Vec2d(600500.0, 2300250.0));
    const auto outline = mappings->getMapping(0)->outline();
    ASSERT_TRUE(outline);
    EXPECT_EQ(outline->corners[0], osg::Vec2d(-500.0, -250.0));
    EXPECT_EQ(outline->corners[2], osg::Vec2d(500.0, 250.0));
    int zone = 0;
    bool north = false;
    double easting = 0.0, northing = 0.0;
    GeographicLib::UTMUPS::Forward(21.3, -157.9, zone, north, easting, northing);
    EXPECT_NEAR(mappings->getMapping(1)->getCenter().x(), easting - 600500.0, 1e-3);
    EXPECT_NEAR(mappings->getMapping(1)->getCenter().y(), northing - 2300250.0, 1e-3);
}

TEST_F(SceneMappingsPlugin, RastersLieWhereTheirGeoreferenceSays)
{
    geofx::test::TestRaster(40, 20)
        .placed(-158.0, 21.5, 0.01, 0.01)
        .crs("EPSG:4326")
        .fill([](int column, int row, int) { return 100.0 * column + row; })
        .write(_folder / "r.tif");
    ProjectiveMappings* mappings = read("<colorTable name='t' ready='viridis' low='7' high='8'/>"
                                        "<raster file='r.tif' opacity='0.25'/>"
                                        "<raster file='r.tif' table='t' maxSide='16' kind='class'/>");
    ASSERT_TRUE(mappings);
    EXPECT_NEAR(mappings->getLongitude(), DegreesToRadians(-157.8), 1e-12);
    EXPECT_NEAR(mappings->getLatitude(), DegreesToRadians(21.4), 1e-12);
    ASSERT_EQ(mappings->getNumMappings(), 2u);
    ProjectiveMapping& mapping = *mappings->getMapping(0);
    EXPECT_EQ(mapping.getOpacity(), 0.25);
    ASSERT_TRUE(mapping.getLayer() && mapping.getLayer()->getImage());
    EXPECT_EQ(mapping.getLayer()->getKind(), DataLayer::VALUE);
    // Values without a transfer are greys from the lowest to the highest.
    EXPECT_NEAR(mapping.getTransfer()->getLowValue(), 0.0, 60.0);
    EXPECT_NEAR(mapping.getTransfer()->getHighValue(), 3919.0, 60.0);
    EXPECT_EQ(mapping.getTransfer()->getSource(), ColorTransfer::LAYER);
    // Half of the raster's size, seen from its middle.
    double x = 0.0, y = 0.0, z = 0.0;
    GeographicLib::LocalCartesian(21.4, -157.8, 0.0).Forward(21.4, -157.6, 0.0, x, y, z);
    EXPECT_NEAR(mapping.getU().x(), x, 30.0); // the southern edge is a little longer
    EXPECT_NEAR(mapping.getCenter().length(), 0.0, 100.0);
    ProjectiveMapping& other = *mappings->getMapping(1);
    EXPECT_EQ(other.getLayer()->getKind(), DataLayer::CLASS);
    EXPECT_EQ(other.getLayer()->getImage()->s(), 16);
    EXPECT_EQ(other.getTransfer()->getSource(), ColorTransfer::TABLE);
    EXPECT_EQ(other.getTransfer()->getLowValue(), 7.0);

    setTerrain(32604);
    mappings = read("<raster file='r.tif'/>");
    ASSERT_TRUE(mappings);
    int zone = 0;
    bool north = false;
    double easting = 0.0, northing = 0.0;
    GeographicLib::UTMUPS::Forward(21.4, -157.8, zone, north, easting, northing);
    EXPECT_NEAR(mappings->getOrigin().x(), easting, 1e-3);
    EXPECT_NEAR(mappings->getOrigin().y(), northing, 1e-3);
    EXPECT_NEAR(mappings->getMapping(0)->getCenter().length(), 0.0, 100.0);
}

TEST_F(SceneMappingsPlugin, PicturesMayBeStretched)
{
    geofx::test::TestRaster picture(40, 20, 3, GDT_UInt16);
    picture.placed(-158.0, 21.5, 0.01, 0.01)
        .crs("EPSG:4326")
        .fill([](int, int, int band) { return 1000.0 * band; });
    picture.write(_folder / "p.tif");
    const auto colorOf = [](const ProjectiveMapping& mapping)
    {
        const osg::Image& image = *mapping.getLayer()->getImage();
        const unsigned char* const texel =
            image.data(static_cast<unsigned int>(image.s() / 2), static_cast<unsigned int>(image.t() / 2));
        return std::array<int, 3>{texel[0], texel[1], texel[2]};
    };
    ProjectiveMappings* mappings =
        read("<raster file='p.tif' stretch='0,2000'/><raster file='p.tif' stretch='5000,0'/>"
             "<overlays file='p.tif' stretch='0,4000'/>");
    ASSERT_TRUE(mappings);
    ASSERT_EQ(mappings->getNumMappings(), 3u);
    EXPECT_EQ(colorOf(*mappings->getMapping(0)), (std::array<int, 3>{0, 128, 255}));
    EXPECT_EQ(colorOf(*mappings->getMapping(1)), (std::array<int, 3>{255, 204, 153}));
    EXPECT_EQ(colorOf(*mappings->getMapping(2)), (std::array<int, 3>{0, 64, 128}));
    for (const std::string stretch : {"1", "1,1", "a,b"})
    {
        const std::string message = messageOf(
            _folder.write("x.geofx", sceneWith("<raster file='p.tif' stretch='" + stretch + "'/>")));
        EXPECT_NE(message.find("with a comma between them"), std::string::npos) << message;
    }
}

TEST_F(SceneMappingsPlugin, WhatGdalReadsIsALayer)
{
    // Tiled floats with no-data and a scale, without any georeference: OSG's own reader of TIFF gives up on tiles.
    geofx::test::TestRaster values(70, 40);
    values.fill([](int column, int row, int)
                { return column == 3 && row == 2 ? -99.0 : 100.0 * column + row; });
    values.dataset().GetRasterBand(1)->SetNoDataValue(-99.0);
    values.dataset().GetRasterBand(1)->SetScale(0.5);
    values.dataset().GetRasterBand(1)->SetOffset(-7.0);
    values.write(_folder / "v.tif", {"TILED=YES", "BLOCKXSIZE=16", "BLOCKYSIZE=16"});
    geofx::test::TestRaster(3, 2, 1, GDT_Int16)
        .fill([](int column, int row, int) { return -10.0 * column - row; })
        .write(_folder / "below.tif");
    geofx::test::TestRaster colors(20, 10, 3, GDT_Byte);
    colors.fill([](int column, int row, int band) { return 10.0 * column + row + 60.0 * band; })
        .write(_folder / "c.tif", {"TILED=YES", "BLOCKXSIZE=16", "BLOCKYSIZE=16", "PHOTOMETRIC=RGB"});

    const ProjectiveMappings* mappings =
        read("<layer name='v' file='v.tif' kind='value'/><layer name='b' file='below.tif' kind='class'/>"
             "<layer name='c' file='c.tif'/><mapping layer='v'/><mapping layer='b'/><mapping layer='c'/>");
    ASSERT_TRUE(mappings);
    ASSERT_EQ(mappings->getNumMappings(), 3u);
    const auto imageOf = [&](unsigned int number)
    {
        return mappings->getMapping(number)->getLayer()->getImage();
    };
    const osg::Image* image = imageOf(0);
    ASSERT_TRUE(image);
    ASSERT_EQ(image->s(), 70);
    ASSERT_EQ(image->t(), 40);
    ASSERT_EQ(image->getDataType(), static_cast<GLenum>(GL_FLOAT));
    const auto value = [&](unsigned int column, unsigned int rowFromNorth)
    {
        return static_cast<double>(
            *reinterpret_cast<const float*>(imageOf(0)->data(column, 39 - rowFromNorth)));
    };
    EXPECT_EQ(value(0, 0), -7.0);
    EXPECT_EQ(value(69, 39), 0.5 * 6939.0 - 7.0);
    EXPECT_TRUE(std::isnan(value(3, 2))) << "no data";
    EXPECT_EQ(value(4, 2), 0.5 * 402.0 - 7.0);
    image = imageOf(1);
    ASSERT_TRUE(image);
    std::string error;
    osgGeoFX::LayerPixels::Options options;
    options.kind = osgGeoFX::LayerPixels::Kind::Class;
    const auto pixels = osgGeoFX::LayerPixels::make(*image, options, error);
    ASSERT_TRUE(pixels) << error;
    EXPECT_EQ(osgGeoFX::LayerPixels::value(pixels->levels[0][2]), -21.0f) << "negative numbers stay so";
    image = imageOf(2);
    ASSERT_TRUE(image);
    ASSERT_EQ(image->s(), 20);
    const osg::Vec4 color = image->getColor(3, 8); // row 1 from the north
    EXPECT_NEAR(static_cast<double>(color.r()), 31.0 / 255.0, 1e-6);
    EXPECT_NEAR(static_cast<double>(color.g()), 91.0 / 255.0, 1e-6);
    EXPECT_NEAR(static_cast<double>(color.b()), 151.0 / 255.0, 1e-6);
    EXPECT_EQ(color.a(), 1.0f);
}

TEST_F(SceneMappingsPlugin, TheElevationOfOahuIsALayer)
{
    std::filesystem::copy_file(GEOFX_SOURCE_DIR "/data/oahu/elevation.tif", _folder / "elevation.tif");
    std::string warnings;
    ProjectiveMappings* mappings = nullptr;
    for (const std::string& message : _watch.messagesOf(
             [&]
             {
                 mappings = read("<layer name='h' file='elevation.tif' kind='value'/><mapping layer='h'/>",
                                 "pageSide='1024'");
             }))
        warnings += message;
    ASSERT_TRUE(mappings);
    const osg::Image* image = mappings->getMapping(0)->getLayer()->getImage();
    ASSERT_TRUE(image);
    // More than a page holds is read coarser, by area, and said.
    EXPECT_EQ(image->s(), 1024);
    EXPECT_EQ(image->t(), 853);
    EXPECT_NE(warnings.find("elevation.tif\" has 3240 × 2700 texels"), std::string::npos) << warnings;
    // Kaʻala, 1,220 m, is the highest place.
    double highest = 0.0;
    const auto* values = reinterpret_cast<const float*>(image->data());
    for (int i = 0; i < image->s() * image->t(); ++i)
        highest = std::max(highest, static_cast<double>(values[i]));
    EXPECT_GT(highest, 1100.0);
    EXPECT_LT(highest, 1230.0);
}

TEST_F(SceneMappingsPlugin, HugePicturesAreReducedOrRefused)
{
    // 68 million pixels in a few kilobytes, without tiles: OSG's reader would take them all.
    geofx::test::writeHollow(_folder / "huge.tif", 8320, 8192);
    ProjectiveMappings* mappings = nullptr;
    _watch.messagesOf(
        [&]
        {
            mappings = read("<layer name='v' file='huge.tif' kind='value'/><layer name='c' file='huge.tif'/>"
                            "<mapping layer='v'/><mapping layer='c'/>");
        });
    ASSERT_TRUE(mappings);
    for (unsigned int i = 0; i < 2; ++i)
    {
        const osg::Image* image = mappings->getMapping(i)->getLayer()->getImage();
        ASSERT_TRUE(image);
        EXPECT_EQ(image->s(), 2048);
        EXPECT_EQ(image->t(), 2016);
    }
}

TEST_F(SceneMappingsPlugin, AVariableOfAFileIsNamedBesideIt)
{
    setTerrain(0);
    GDALAllRegister();
    for (const auto& [name, value] : {std::pair("two", 10.0), std::pair("high", 20.0)})
    {
        geofx::test::TestRaster raster(8, 8);
        raster.placed(-158.0, 21.31, 0.001, 0.001).crs("EPSG:4326");
        raster.fill([height = value](int, int, int) { return height; });
        const std::string table = std::string("RASTER_TABLE=") + name;
        const std::array<const char*, 4> options = {table.c_str(), "APPEND_SUBDATASET=YES",
                                                    "TILE_FORMAT=TIFF", nullptr};
        const geofx::test::DatasetPtr copy(GetGDALDriverManager()->GetDriverByName("GPKG")->CreateCopy(
            (_folder / "two.gpkg").c_str(), &raster.dataset(), FALSE,
            const_cast<char**>(std::string(name) == "two" ? options.data() + 3 : options.data()), nullptr,
            nullptr));
        ASSERT_TRUE(copy);
    }
    auto* const effect = effectOf<ProjectiveMappings>(
        sceneWith("<raster file='two.gpkg' variable='two' kind='value'/><raster file='two.gpkg' "
                  "variable='high' kind='value'/>"));
    ASSERT_TRUE(effect);
    ASSERT_EQ(effect->getNumMappings(), 2u);
    for (unsigned int i = 0; i < 2; ++i)
    {
        const osg::Image& image = *effect->getMapping(i)->getLayer()->getImage();
        EXPECT_EQ(*reinterpret_cast<const float*>(image.data(4, 4)), i == 0 ? 10.0f : 20.0f);
    }
    std::string message;
    _watch.messagesOf([&] { message = messageWith("<raster file='two.gpkg' variable='deep'/>"); });
    EXPECT_NE(message.find("<raster>: "), std::string::npos) << message;
    EXPECT_NE(message.find("deep"), std::string::npos) << message;
}

TEST_F(SceneMappingsPlugin, MistakesAreNamedWithPlaceAndMend)
{
    _folder.write("broken.png", "no picture");
    _folder.write("broken.txt", "1 2 3\n");
    _folder.write("broken.tif", "no raster");
    const auto expect = [&](const std::string& message, const std::string& element, const std::string& holds)
    {
        const std::string begins = (_folder / "wrong.geofx").string() + ":3: <" + element + ">: ";
        EXPECT_EQ(message.rfind(begins, 0), 0u) << message;
        EXPECT_NE(message.find(holds), std::string::npos) << message;
        EXPECT_EQ(message.back(), '.') << message;
        EXPECT_EQ(message.find('\n'), std::string::npos) << message;
    };
    std::string message;
    // The picture's own plugin may have to say something, too.
    _watch.messagesOf([&] { message = messageWith("<layer name='a' file='broken.png'/>"); });
    expect(message, "layer", "convert it to PNG");
    expect(messageWith("<colorTable name='a' file='broken.txt'/>"), "colorTable", "broken.txt:1");
    expect(messageWith("<raster file='broken.tif'/>"), "raster", "is not a raster that GDAL can read");
    expect(messageWith("<mapping west='1' south='2' east='3' north='4'/>", "longitude='150'"), "mapping",
           "on the other side of the globe");
    expect(messageWith("<mapping longitude='100' latitude='0'/>", "longitude='0'"), "mapping",
           "on the other side of the globe");
    expect(messageWith("<mapping west='500000' south='2' east='600000' north='4'/>"), "mapping",
           "latitudes from -90 to 90");
    _watch.messagesOf([&]
                      { message = messageWith("<mapping west='0' south='-90' east='30' north='-89'/>"); });
    expect(message, "mapping", "off the poles");
    setTerrain(32604);
    expect(messageWith("<mapping west='3' south='2' east='1' north='4'/>"), "mapping",
           "west must be less than east.");
    expect(messageWith("<mapping longitude='-69' latitude='0'/>"), "mapping", "terrain's projection");
    const osg::ref_ptr<osg::Group> plain = new osg::Group;
    ASSERT_TRUE(osgDB::writeNodeFile(*plain, (_folder / "terrain.osgb").string()));
    expect(messageWith("<mapping longitude='1' latitude='2'/>"), "mapping", "no coordinate system");
    geofx::test::TestRaster(4, 4).placed(1.0, 2.0, 0.1, 0.1).crs("EPSG:4326").write(_folder / "r.tif");
    expect(messageWith("<raster file='r.tif'/>"), "raster", "the terrain has no coordinate system");
}

// Rasters in time are a mapping of the effect, whose layer follows a clock in the update traversal.
TEST_F(SceneMappingsPlugin, SequencesFollowTheScenesClock)
{
    setTerrain(0);
    std::filesystem::create_directory(_folder / "rain");
    for (int step = 0; step < 3; ++step)
    {
        geofx::test::TestRaster raster(8, 8);
        raster.placed(-158.0, 21.31, 0.001, 0.001).crs("EPSG:4326");
        raster.fill([step](int, int, int) { return 10.0 * step; });
        raster.write(_folder / "rain" / ("rain_20260112_0" + std::to_string(step) + "00.tif"));
    }
    auto* const effect = effectOf<ProjectiveMappings>(
        sceneWith("<colorTable name='c' ready='viridis' low='0' high='20'/>"
                  "<sequence file='rain' table='c' opacity='.5' order='3' speed='1800'/>"
                  "<sequence name='greys' file='rain' blending='false'/>"));
    ASSERT_TRUE(effect);
    ASSERT_EQ(effect->getNumMappings(), 2u);
    EXPECT_EQ(effect->getMapping(1)->getName(), "greys");
    const ProjectiveMapping& mapping = *effect->getMapping(0);
    EXPECT_EQ(mapping.getOpacity(), 0.5);
    EXPECT_EQ(mapping.getOrder(), 3);
    EXPECT_EQ(mapping.getTransfer()->getSource(), ColorTransfer::TABLE);
    EXPECT_EQ(mapping.getTransfer()->getHighValue(), 20.0);
    EXPECT_NEAR(effect->getLatitude(), osg::DegreesToRadians(21.306), 1e-6)
        << "the origin is in their middle";
    const auto value = [&](unsigned int index)
    {
        const osg::Image& image = *effect->getMapping(index)->getLayer()->getImage();
        return *reinterpret_cast<const float*>(
            image.data(static_cast<unsigned int>(image.s() / 2), static_cast<unsigned int>(image.t() / 2)));
    };
    EXPECT_EQ(value(0), 0.0f) << "there is a picture at once";
    auto* const scene = dynamic_cast<osgGeoFX::EffectScene*>(_scene.get());
    ASSERT_TRUE(scene);
    osgGeoFX::LayerPlayer* const player = osgGeoFX::LayerPlayer::of(*scene);
    ASSERT_TRUE(player);
    ASSERT_EQ(player->getNumSequences(), 2u);
    EXPECT_EQ(player->getClock()->text(player->getClock()->getEnd()), "2026-01-12 02:00 UTC");
    for (unsigned int i = 0; i < 2; ++i)
        player->getSequence(i)->setWaiting(true);
    // Four halves of an hour.
    player->update(0.0);
    player->update(3.0);
    EXPECT_FLOAT_EQ(value(0), 15.0f);
    EXPECT_FLOAT_EQ(value(1), 10.0f);

    const auto expectFault = [&](const std::string& inside, const std::string& word)
    {
        const std::string message = messageOf(_folder.write("x.geofx", sceneWith(inside)));
        EXPECT_NE(message.find(word), std::string::npos) << message;
    };
    expectFault("<sequence file='none'/>", "none");
    expectFault("<sequence file='rain' variable='snow'/>", "no variables");
    std::filesystem::create_directory(_folder / "empty");
    expectFault("<sequence file='empty'/>", "no rasters");
    expectFault("<sequence file='../rain'/>", "leads out of the scene's folder");
    _folder.write(
        "rain/rain_20260112_0500.vrt",
        "<VRTDataset rasterXSize='8' rasterYSize='8'><VRTRasterBand dataType='Float32' "
        "band='1'><SimpleSource>"
        "<SourceFilename relativeToVRT='1'>../../outside.tif</SourceFilename></SimpleSource></VRTRasterBand>"
        "</VRTDataset>");
    expectFault("<sequence file='rain'/>", "lies outside the scene's folder");
}

// A map of the world is cut out around the terrain, in the effect's frame if that is near.
TEST_F(SceneMappingsPlugin, AMapOfTheWorldIsCutOutAroundTheTerrain)
{
    const osg::ref_ptr<osg::CoordinateSystemNode> terrain = terrainOf(0);
    osg::Vec3d middle;
    terrain->getEllipsoidModel()->convertLatLongHeightToXYZ(
        osg::DegreesToRadians(21.3), osg::DegreesToRadians(-158.0), 0.0, middle.x(), middle.y(), middle.z());
    const osg::ref_ptr<osg::Geometry> ground = new osg::Geometry;
    const osg::ref_ptr<osg::Vec3Array> corners = new osg::Vec3Array;
    for (const osg::Vec3d& corner :
         {osg::Vec3d(3e4, 0.0, 0.0), osg::Vec3d(0.0, 3e4, 0.0), osg::Vec3d(0.0, 0.0, 3e4)})
        corners->push_back(osg::Vec3(middle + corner));
    ground->setVertexArray(corners);
    ground->addPrimitiveSet(new osg::DrawArrays(GL_TRIANGLES, 0, 3));
    terrain->addChild(ground);
    saveTerrain(*terrain);
    geofx::test::TestRaster(720, 360, 3, GDT_Byte)
        .placed(-180.0, 90.0, 0.5, 0.5)
        .crs("EPSG:4326")
        .fill([](int column, int row, int band)
              { return band == 0   ? column / 3.0
                       : band == 1 ? row / 2.0
                                   : 0.0; })
        .write(_folder / "world.tif");
    for (const std::string origin : {"", "longitude='-157' latitude='22'"})
    {
        auto* const effect = effectOf<ProjectiveMappings>(sceneWith("<overlays file='world.tif'/>", origin));
        ASSERT_TRUE(effect) << origin;
        ASSERT_EQ(effect->getNumMappings(), 1u) << origin;
        const ProjectiveMapping& mapping = *effect->getMapping(0);
        EXPECT_LT(mapping.getU().length(), 1e6) << origin;
        const osg::Image& image = *mapping.getLayer()->getImage();
        const unsigned char* const texel =
            image.data(static_cast<unsigned int>(image.s() / 2), static_cast<unsigned int>(image.t() / 2));
        const double longitude = osg::RadiansToDegrees(effect->getLongitude()),
                     latitude = osg::RadiansToDegrees(effect->getLatitude());
        EXPECT_NEAR(texel[0], (longitude + 180.0) / 1.5, 1.0) << origin;
        EXPECT_NEAR(texel[1], (90.0 - latitude) / 1.0, 1.0) << origin;
        EXPECT_EQ(texel[3], 255) << origin;
    }
}

// Ground overlays and ways of files, and a way of way points, are mappings of the effect, where GeographicLib has their places.
TEST_F(SceneMappingsPlugin, OverlaysAndRoutesLieWhereTheirFilesSay)
{
    setTerrain(0);
    _folder.write("over.kml",
                  geofx::test::kml(geofx::test::groundOverlay(
                      "", geofx::test::latLonBox(-158.0, 21.3, -157.99, 21.31), "<color>80ff0000</color>")));
    _folder.write("way.gpx",
                  "<gpx version='1.1' creator='t' xmlns='http://www.topografix.com/GPX/1/1'><trk><trkseg>"
                  "<trkpt lat='21.3' lon='-158'/><trkpt lat='21.31' lon='-158'/></trkseg></trk></gpx>");
    _folder.write("two.sld",
                  "<ColorMap type='values'><ColorMapEntry color='#ff0000' quantity='1'/></ColorMap>");
    auto* const effect = effectOf<ProjectiveMappings>(sceneWith(
        "<colorTable name='c' file='two.sld'/><overlays file='over.kml' opacity='.5' order='3'/>"
        "<route file='way.gpx' width='10'/>"
        "<route name='plan' color='#ff8000' width='20' order='7'><wayPoint longitude='-158' latitude='21.3'/>"
        "<wayPoint longitude='-157.99' latitude='21.3'/></route>",
        "longitude='-158' latitude='21.3'"));
    ASSERT_TRUE(effect);
    const ProjectiveMapping& overlay = *effect->getMapping(0);
    EXPECT_NEAR(overlay.getOpacity(), 0.5 * 128.0 / 255.0, 1e-6);
    EXPECT_EQ(overlay.getOrder(), 3);
    const GeographicLib::LocalCartesian frame(21.3, -158.0, 0.0);
    double x = 0.0, y = 0.0, z = 0.0;
    frame.Forward(21.31, -157.99, 0.0, x, y, z);
    EXPECT_NEAR(overlay.outline()->corners[2].x(), x, 0.1);
    EXPECT_NEAR(overlay.outline()->corners[2].y(), y, 0.1);
    EXPECT_EQ(effect->getNumMappings(), 1u) << "routes have mappings of their own";
    ASSERT_EQ(effect->getNumRoutes(), 2u);
    RouteMapping& plan = *effect->getRoute(1);
    EXPECT_EQ(plan.getName(), "plan");
    EXPECT_EQ(plan.getNumMappings(), 8u) << "line and outline, two caps each, and two marks";
    EXPECT_EQ(plan.getGeographicWayPoints(), (std::vector<osg::Vec2d>{{-158.0, 21.3}, {-157.99, 21.3}}));
    // The line of the way points: from the origin to the east, 20 m wide.
    const ProjectiveMapping& strip = plan.mappings(RouteMapping::LINE).at(0);
    frame.Forward(21.3, -157.99, 0.0, x, y, z);
    EXPECT_NEAR(strip.getCenter().x(), x / 2.0, 0.1);
    EXPECT_NEAR(strip.getV().length(), x / 2.0, 0.1);
    EXPECT_NEAR(strip.getU().length(), 10.0, 1e-6);
    EXPECT_EQ(strip.getOrder(), 9);
    EXPECT_TRUE(effect->mappingsAt({0.0, 500.0}).size() > 1) << "the way to the north";
    EXPECT_EQ(_scene->asGroup()->getNumChildren(), 1u) << "these ways have no heights";
    for (const bool inAir : {true, false})
    {
        _folder.write(
            "flight.kml",
            geofx::test::kml(
                "<Placemark><name>flight</name><LineString><extrude>1</extrude><altitudeMode>absolute"
                "</altitudeMode><coordinates>-158,21.3,900 -157.99,21.3,1000</coordinates>"
                "</LineString></Placemark>"));
        ASSERT_TRUE(effectOf<ProjectiveMappings>(
            sceneWith(std::string("<route file='flight.kml' inAir='") + (inAir ? "true'/>" : "false'/>"))));
        const osg::Group& group = *_scene->asGroup();
        ASSERT_EQ(group.getNumChildren(), inAir ? 3u : 1u) << "the terrain, a tube and a curtain";
        if (!inAir) continue;
        const auto* const tube = dynamic_cast<const osg::MatrixTransform*>(group.getChild(1));
        ASSERT_TRUE(tube);
        EXPECT_EQ(tube->getName(), "flight");
        osg::Vec3d foot;
        GeographicLib::Geocentric::WGS84().Forward(21.3, -157.995, 950.0, foot.x(), foot.y(), foot.z());
        EXPECT_LT((osg::Vec3d(tube->getBound().center()) - foot).length(), 10.0);
    }
}

TEST_F(SceneMappingsPlugin, ARouteTakesThePropertiesOfItsClass)
{
    setTerrain(0);
    auto* const effect = effectOf<ProjectiveMappings>(sceneWith(
        "<route color='#ff800080' width='48' order='-900' dash='300' gap='90' casingColor='#102030' "
        "pointRadius='60' "
        "highlightedLeg='1' enabled='false' context='true' softness='77'>"
        "<wayPoint longitude='-158' latitude='21.3'/><wayPoint longitude='-157.99' latitude='21.3'/>"
        "<wayPoint longitude='-157.98' latitude='21.31'/></route>",
        "longitude='-158' latitude='21.3'"));
    ASSERT_TRUE(effect);
    ASSERT_EQ(effect->getNumRoutes(), 1u);
    RouteMapping& route = *effect->getRoute(0);
    const RouteMapping::Style style = route.getStyle();
    EXPECT_EQ(style.halfWidth, 24.0);
    EXPECT_EQ(style.casing, 10.0) << "twice the usual one, as the line is";
    EXPECT_EQ(style.pointRadius, 60.0) << "as it says";
    EXPECT_EQ(style.dash, 300.0);
    EXPECT_EQ(style.gap, 90.0);
    EXPECT_EQ(style.softness, 77.0);
    EXPECT_TRUE(style.context);
    EXPECT_EQ(osgGeoFX::packedColor({style.color.x(), style.color.y(), style.color.z()}), 0xff8000);
    EXPECT_NEAR(style.color.w(), 128.0 / 255.0, 1e-6);
    EXPECT_EQ(osgGeoFX::packedColor({style.casingColor.x(), style.casingColor.y(), style.casingColor.z()}),
              0x102030);
    EXPECT_EQ(route.highlighted(), 1u);
    EXPECT_EQ(route.getOrder(), -900);
    EXPECT_FALSE(route.getEnabled());
    EXPECT_EQ(route.getNumMappings(), 0u) << "it is switched off";
    route.setEnabled(true);
    EXPECT_GT(route.getNumMappings(), 8u);
    const auto expectFault = [&](const char* attributes, const char* part)
    {
        const std::string said = messageOf(
            _folder.write("x.geofx", sceneWith(std::string("<route ") + attributes +
                                               "><wayPoint longitude='-158' latitude='21.3'/><wayPoint "
                                               "longitude='20' latitude='-21'/></route>")));
        EXPECT_NE(said.find(part), std::string::npos) << said;
    };
    expectFault("", "other side of the globe");
    expectFault("dash='-1'", "dash");
    expectFault("order='901'", "order");
}

// A plane 500 m above the ellipsoid, over which a way keeps its height, whatever its own is called.
TEST_F(SceneMappingsPlugin, WaysAboveTheGroundAreAboveTheScenesGround)
{
    const osg::ref_ptr<osg::CoordinateSystemNode> terrain = terrainOf(0);
    const auto at = [](double longitude, double latitude, double height)
    {
        osg::Vec3d place;
        GeographicLib::Geocentric::WGS84().Forward(latitude, longitude, height, place.x(), place.y(),
                                                   place.z());
        return place;
    };
    const osg::Vec3d middle = at(-158.0, 21.3, 0.0);
    const auto ground =
        geofx::test::makeMesh(20, [&](double east, double north)
                              { return at(-158.02 + 0.04 * east, 21.28 + 0.04 * north, 500.0) - middle; });
    const osg::ref_ptr<osg::MatrixTransform> place =
        new osg::MatrixTransform(osg::Matrixd::translate(middle));
    place->addChild(ground);
    terrain->addChild(place);
    saveTerrain(*terrain);
    _folder.write("flight.kml",
                  geofx::test::kml("<Placemark><name>flight</name><LineString><altitudeMode>relativeToGround"
                                   "</altitudeMode><coordinates>-158,21.3,100 -157.99,21.3,100</coordinates>"
                                   "</LineString></Placemark>"));
    auto* const effect = effectOf<ProjectiveMappings>(sceneWith("<route file='flight.kml'/>"));
    ASSERT_TRUE(effect);
    EXPECT_EQ(effect->getNumRoutes(), 1u) << "it lies on the ground, too";
    const osg::Group& group = *_scene->asGroup();
    ASSERT_EQ(group.getNumChildren(), 2u) << "the terrain and a tube";
    const auto* const tube = dynamic_cast<const osg::MatrixTransform*>(group.getChild(1));
    ASSERT_TRUE(tube);
    EXPECT_LT((osg::Vec3d(tube->getBound().center()) - at(-157.995, 21.3, 600.0)).length(), 3.0);
    ASSERT_EQ(dynamic_cast<osgGeoFX::EffectScene&>(*_scene).getNumEffects(), 1u) << "and it lies there once";
    // Without ground there is no height above it.
    setTerrain(0);
    EXPECT_NE(
        messageOf(_folder.write("x.geofx", sceneWith("<route file='flight.kml'/>"))).find("there is none"),
        std::string::npos);
}

// Vector data with their look, in an effect of the scene.
TEST_F(SceneMappingsPlugin, VectorDataAreOverlays)
{
    setTerrain(0);
    _folder.write(
        "areas.geojson",
        R"({"type":"FeatureCollection","features":[{"type":"Feature","properties":{},"geometry":{"type":"Polygon",
"coordinates":[[[-158,21.3],[-157.99,21.3],[-157.99,21.31],[-158,21.3]]]}},{"type":"Feature","properties":{},"geometry":{"type":"Point",
"coordinates":[-158,21.3]}}]})");
    _folder.write(
        "look.sld",
        "<FeatureTypeStyle><Rule><PolygonSymbolizer><Fill/></PolygonSymbolizer></Rule></FeatureTypeStyle>");
    auto* effect =
        effectOf<ProjectiveMappings>(sceneWith("<overlays file='areas.geojson' opacity='.5' order='3'/>"));
    ASSERT_TRUE(effect);
    ASSERT_EQ(effect->getNumMappings(), 2u);
    ASSERT_EQ(effect->getNumRasters(), 1u);
    EXPECT_EQ(effect->getMapping(0), effect->getRaster(0)->getMapping()) << "symbols lie on top";
    EXPECT_EQ(effect->getMapping(0)->getOpacity(), 0.5);
    EXPECT_EQ(effect->getMapping(1)->getOrder(), 3);
    EXPECT_GT(effect->getMapping(1)->getSizeInPixels(), 0.0);
    effect = effectOf<ProjectiveMappings>(
        sceneWith("<overlays file='areas.geojson' style='look.sld' layer='areas'/>"));
    ASSERT_TRUE(effect);
    EXPECT_EQ(effect->getNumMappings(), 1u) << "the style has no points";
    const auto expectFault = [&](const std::string& inside, const std::string& word)
    {
        const std::string message = messageOf(_folder.write("x.geofx", sceneWith(inside)));
        EXPECT_NE(message.find(word), std::string::npos) << message;
    };
    expectFault("<overlays file='areas.geojson' style='none.sld'/>", "none.sld");
    expectFault("<overlays file='areas.geojson' style='../look.sld'/>", "leads out of the scene's folder");
    expectFault("<overlays file='areas.geojson' layer='roads'/>", "no layer \"roads\"");
}

TEST_F(SceneMappingsPlugin, OverlaysAndRoutesAreRefusedInASentence)
{
    setTerrain(0);
    const auto expectFault = [&](const std::string& inside, const std::string& word)
    {
        const std::string message = messageOf(_folder.write("x.geofx", sceneWith(inside)));
        EXPECT_NE(message.find(word), std::string::npos) << message;
    };
    _folder.write("far.kml",
                  geofx::test::kml(geofx::test::groundOverlay("", geofx::test::latLonBox(0, 0, 1, 1)) +
                                   geofx::test::groundOverlay("", geofx::test::latLonBox(170, 0, 171, 1))));
    _folder.write("out.kml", geofx::test::kml(
                                 geofx::test::groundOverlay("../x.png", geofx::test::latLonBox(0, 0, 1, 1))));
    expectFault("<overlays file='far.kml'/>", "x.geofx:3: <overlays>: its rasters lie too far");
    expectFault("<overlays file='out.kml'/>", "leads out of the folder");
    expectFault("<overlays file='none.kml'/>", "none.kml");
    expectFault("<overlays file='../far.kml'/>", "leads out of the scene's folder");
    expectFault("<route file='../way.gpx'/>", "leads out of the scene's folder");
    expectFault("<route/>", "either a file or <wayPoint> elements");
    expectFault("<route file='far.kml'/>", "it has no way");
}

} // namespace
