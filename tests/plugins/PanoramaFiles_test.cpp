// SPDX-License-Identifier: MIT
// SPDX-FileCopyrightText: 2026 the osgGeoFX authors
//
// The pictures and vector data of panorama maps, through files and copies, and as scene files name them.
#include <osgGeoFX/panorama/PanoramaMap.h>
#include <osgGeoFX/panorama/PanoramaPalette.h>
#include <osgGeoFX/panorama/StrokeLines.h>
#include <plugins/SerializerFixture.h>
#include <plugins/SerializerSamples.h>

#include <osg/CoordinateSystemNode>
#include <osg/Geode>
#include <osg/Shape>
#include <osg/ShapeDrawable>

#include <algorithm>

namespace
{

using geofx::test::byteImage;
using geofx::test::expectSameImage;
using geofx::test::formats;
using osgGeoFX::EffectScene;
using osgGeoFX::PanoramaMap;
using osgGeoFX::StrokeLines;

class PanoramaFiles : public geofx::test::Serializers
{
protected:
    void SetUp() override
    {
        const osg::ref_ptr<osg::CoordinateSystemNode> root = new osg::CoordinateSystemNode;
        root->setEllipsoidModel(new osg::EllipsoidModel);
        const osg::ref_ptr<osg::Geode> geode = new osg::Geode;
        geode->addDrawable(new osg::ShapeDrawable(new osg::Box(osg::Vec3d(6378137.0, 0.0, 0.0), 2000.0f)));
        root->addChild(geode);
        ASSERT_TRUE(osgDB::writeNodeFile(*root, (_folder / "terrain.osgb").string()));
    }

    /// A scene with one panorama map, on line 3.
    std::filesystem::path scene(const std::string& attributes, const std::string& within = "")
    {
        return _folder.write("a.geofx",
                             "<geofx version='1'>\n<terrain><database file='terrain.osgb'/></terrain>\n"
                             "<effects><panoramaMap " +
                                 attributes + ">" + within + "</panoramaMap></effects></geofx>");
    }

    void writePicture(const std::string& name, const osg::Image& image)
    {
        std::filesystem::create_directories((_folder / name).parent_path());
        ASSERT_TRUE(osgDB::writeImageFile(image, (_folder / name).string())) << name;
    }

    /// The sentence of a scene that cannot be read.
    std::string sentence(const std::string& attributes)
    {
        std::string text = messageOf(scene(attributes));
        EXPECT_NE(text.find("a.geofx:3: <panoramaMap>: "), std::string::npos) << text;
        return text;
    }
};

TEST_F(PanoramaFiles, PicturesGoThroughAllFormats)
{
    for (const bool palette : {false, true})
    {
        for (const bool sky : {false, true})
        {
            const osg::ref_ptr<PanoramaMap> map = new PanoramaMap;
            if (palette) map->setPalette(osgGeoFX::makePalette(0.25));
            if (sky) map->setSkyImage(byteImage());
            for (const std::string& format : formats)
            {
                SCOPED_TRACE(format);
                const osg::ref_ptr<PanoramaMap> read = throughFile(*map, format);
                ASSERT_TRUE(read);
                expectSameImage(read->getPalette(), map->getPalette());
                expectSameImage(read->getSkyImage(), map->getSkyImage());
            }
        }
    }
}

TEST_F(PanoramaFiles, CopiesShareThePicturesUnlessTheyAreDeep)
{
    const osg::ref_ptr<PanoramaMap> map = new PanoramaMap;
    map->setPalette(osgGeoFX::makePalette());
    map->setSkyImage(byteImage());
    const osg::ref_ptr<PanoramaMap> shallow = new PanoramaMap(*map);
    EXPECT_EQ(shallow->getPalette(), map->getPalette());
    EXPECT_EQ(shallow->getSkyImage(), map->getSkyImage());
    const osg::ref_ptr<PanoramaMap> deep = new PanoramaMap(*map, osg::CopyOp::DEEP_COPY_ALL);
    EXPECT_NE(deep->getPalette(), map->getPalette());
    EXPECT_NE(deep->getSkyImage(), map->getSkyImage());
    expectSameImage(deep->getPalette(), map->getPalette());
    expectSameImage(deep->getSkyImage(), map->getSkyImage());
}

TEST_F(PanoramaFiles, ASceneNamesItsPictures)
{
    // Twice as large as a palette is in the end.
    osg::ref_ptr<osg::Image> wide = new osg::Image(*osgGeoFX::makePalette(0.0), osg::CopyOp::DEEP_COPY_ALL);
    wide->scaleImage(512, 16, 1);
    writePicture("colors/winter.png", *wide);
    writePicture("sky.png", *byteImage());
    const osg::ref_ptr<osg::Node> node =
        osgDB::readRefNodeFile(scene("palette='colors/winter.png' season='0' skyImage='sky.png'").string());
    auto* effects = dynamic_cast<EffectScene*>(node.get());
    ASSERT_TRUE(effects);
    auto* map = dynamic_cast<PanoramaMap*>(effects->getEffect(0));
    ASSERT_TRUE(map);
    EXPECT_EQ(map->getSeason(), 0.0);
    std::string error;
    expectSameImage(map->getPalette(), osgGeoFX::paletteFromImage(*wide, error));
    expectSameImage(map->getSkyImage(), byteImage());

    const osg::ref_ptr<osg::Node> plain = osgDB::readRefNodeFile(scene("").string());
    auto* bare = dynamic_cast<PanoramaMap*>(dynamic_cast<EffectScene&>(*plain).getEffect(0));
    ASSERT_TRUE(bare);
    EXPECT_FALSE(bare->getPalette());
    EXPECT_FALSE(bare->getSkyImage());
}

std::string features(const std::string& geometries)
{
    return "{\"type\":\"FeatureCollection\",\"features\":[{\"type\":\"Feature\",\"properties\":{},"
           "\"geometry\":{\"type\":\"GeometryCollection\",\"geometries\":[" +
           geometries + "]}}]}";
}

const char* const someLines =
    "{\"type\":\"LineString\",\"coordinates\":[[0.0,0.0],[0.002,0.0]]},"
    "{\"type\":\"LineString\",\"coordinates\":[[0.004,0.001],[0.002,0.0]]},"
    "{\"type\":\"MultiLineString\",\"coordinates\":[[[0.005,0.001],[0.006,0.001]]]}";
const char* const aTown =
    "{\"type\":\"Polygon\",\"coordinates\":[[[0,0],[0.003,0],[0.003,0.003],[0,0.003],[0,0]],"
    "[[0.001,0.001],[0.002,0.001],[0.002,0.002],[0.001,0.001]]]}";

TEST_F(PanoramaFiles, ASceneNamesItsLines)
{
    _folder.write("roads.geojson", features(std::string(someLines) + "," + aTown));
    const osg::ref_ptr<osg::Node> node =
        osgDB::readRefNodeFile(scene("", "<lines file='roads.geojson' kind='road'/><lines "
                                         "file='roads.geojson' kind='river' layer='roads'/>"
                                         "<lines file='roads.geojson' kind='town'/>")
                                   .string());
    auto* effects = dynamic_cast<EffectScene*>(node.get());
    ASSERT_TRUE(effects);
    const auto* map = dynamic_cast<PanoramaMap*>(effects->getEffect(0));
    ASSERT_TRUE(map && map->getLines());
    EXPECT_EQ(map->getLines()->getUnits(), StrokeLines::DEGREES);
    const std::vector<StrokeLines::Line>& lines = map->getLines()->getLines();
    // Two of the lines continue each other.
    ASSERT_EQ(lines.size(), 5u);
    EXPECT_EQ(lines[0].kind, StrokeLines::ROAD);
    EXPECT_EQ(lines[2].kind, StrokeLines::RIVER);
    EXPECT_EQ(lines[4].kind, StrokeLines::TOWN);
    ASSERT_EQ(lines[0].points.size(), 3u);
    EXPECT_EQ(lines[0].points.front(), osg::Vec2d(0.0, 0.0));
    EXPECT_EQ(lines[0].points[1], osg::Vec2d(0.002, 0.0));
    EXPECT_EQ(lines[0].points.back(), osg::Vec2d(0.004, 0.001));
    const StrokeLines::Towns towns(*map->getLines(), {0.0, 0.0}, {0.01, 0.01});
    EXPECT_TRUE(towns.contain({0.0025, 0.0015}));
    EXPECT_FALSE(towns.contain({0.0018, 0.0012}));
    EXPECT_FALSE(towns.contain({0.004, 0.0015}));
}

TEST_F(PanoramaFiles, LinesGoThroughAllFormats)
{
    const osg::ref_ptr<StrokeLines> lines = new StrokeLines;
    ASSERT_TRUE(lines->set(StrokeLines::METRES, {{StrokeLines::RIVER, {{0.1, 1.0 / 3.0}, {1e6, -7.0}}},
                                                 {StrokeLines::TOWN, {{0.0, 0.0}, {1.0, 0.0}, {1.0, 1.0}}}}));
    const osg::ref_ptr<PanoramaMap> map = new PanoramaMap;
    map->setLines(lines);
    EXPECT_EQ(osg::ref_ptr<PanoramaMap>(new PanoramaMap(*map))->getLines(), lines);
    for (const std::string& format : formats)
    {
        SCOPED_TRACE(format);
        const osg::ref_ptr<PanoramaMap> read = throughFile(*map, format);
        ASSERT_TRUE(read && read->getLines());
        EXPECT_EQ(read->getLines()->getUnits(), StrokeLines::METRES);
        ASSERT_EQ(read->getLines()->getLines().size(), 2u);
        for (std::size_t i = 0; i < 2; ++i)
        {
            EXPECT_EQ(read->getLines()->getLines()[i].kind, lines->getLines()[i].kind);
            EXPECT_EQ(read->getLines()->getLines()[i].points, lines->getLines()[i].points);
        }
        const osg::ref_ptr<PanoramaMap> bare =
            throughFile(*osg::ref_ptr<PanoramaMap>(new PanoramaMap), format);
        EXPECT_FALSE(bare->getLines());
    }
}

TEST_F(PanoramaFiles, LinesThatCannotBeUsedAreSaidWithTheirMend)
{
    _folder.write("roads.geojson", features(someLines));
    _folder.write("town.geojson", features(aTown));
    _folder.write("no.geojson", "no vectors");
    const auto said = [&](const std::string& attributes, const std::string& part)
    {
        const std::string text = messageOf(scene("", "<lines " + attributes + "/>"));
        EXPECT_NE(text.find("a.geofx:3: <lines>: "), std::string::npos) << text;
        EXPECT_NE(text.find(part), std::string::npos) << text;
    };
    said("file='none.gpkg' kind='road'", "none.gpkg\" does not exist; correct the attribute \"file\"");
    said("file='no.geojson' kind='road'", "check it with ogrinfo, or convert it with ogr2ogr");
    said("file='roads.geojson' kind='town'",
         "roads.geojson: it has no areas, which towns are; name another layer");
    said("file='town.geojson' kind='river'", "town.geojson: it has no lines; name another layer or kind");
    said("file='roads.geojson' kind='road' layer='rails'",
         "it has no layer \"rails\"; ogrinfo lists those it has");
    said("file='roads.geojson' kind='rail'", "kind");
    said("file='roads.geojson'", "kind");
}

TEST_F(PanoramaFiles, APictureThatCannotBeUsedIsSaidWithItsMend)
{
    osg::ref_ptr<osg::Image> low = new osg::Image;
    low->allocateImage(256, 7, 1, GL_RGBA, GL_UNSIGNED_BYTE);
    std::fill(low->data(), low->data() + low->getTotalSizeInBytes(), static_cast<unsigned char>(9));
    writePicture("low.png", *low);
    _folder.write("no.png", "not a picture");

    for (const char* attribute : {"palette", "skyImage"})
    {
        SCOPED_TRACE(attribute);
        const std::string missing = sentence(std::string(attribute) + "='none.png'");
        EXPECT_NE(missing.find("none.png\" does not exist; correct the attribute \"" +
                               std::string(attribute) + "\""),
                  std::string::npos)
            << missing;
        const std::string unread = sentence(std::string(attribute) + "='no.png'");
        EXPECT_NE(unread.find("no.png\" cannot be read"), std::string::npos) << unread;
        EXPECT_NE(unread.find("convert it to PNG"), std::string::npos) << unread;
        EXPECT_NE(messageOf(scene(std::string(attribute) + "=''")).find("a.geofx:3: <panoramaMap>: "),
                  std::string::npos);
    }
    const std::string small = sentence("palette='low.png'");
    EXPECT_NE(small.find("low.png\" cannot be used"), std::string::npos) << small;
    EXPECT_NE(small.find("give it at least 8 rows"), std::string::npos) << small;
}

} // namespace
