// SPDX-License-Identifier: MIT
// SPDX-FileCopyrightText: 2026 the osgGeoFX authors
//
// Lines from vector data: of any geometry, with the style that each feature names.
#include <osgGeoFX/geodata/LineVectors.h>
#include <tools/TempDir.h>

#include <gtest/gtest.h>

#include <fstream>
#include <string>

using namespace osgGeoFX;
using geofx::test::TempDir;

namespace
{

class LineVectorsTest : public ::testing::Test
{
protected:
    std::string collection(const std::string& features, const std::string& more = {}) const
    {
        const std::string file = (_folder.path() / "lines.geojson").string();
        std::ofstream(file) << R"({"type":"FeatureCollection",)" << more << R"("features":[)" << features
                            << "]}";
        return file;
    }
    static std::string feature(const std::string& properties, const std::string& type,
                               const std::string& coordinates)
    {
        return R"({"type":"Feature","properties":{)" + properties + R"(},"geometry":{"type":")" + type +
               R"(","coordinates":)" + coordinates + "}}";
    }
    static std::vector<MapLine> readAll(const std::string& file, const LineVectors::Options& options = {},
                                        const MappingFrame& frame = {})
    {
        std::vector<MapLine> lines;
        std::string error;
        EXPECT_TRUE(LineVectors::read(file, options, frame, lines, error)) << error;
        return lines;
    }
    static std::string faultOf(const std::string& file, const LineVectors::Options& options = {})
    {
        std::vector<MapLine> lines(1);
        std::string error;
        EXPECT_FALSE(LineVectors::read(file, options, {}, lines, error));
        EXPECT_EQ(lines.size(), 1u) << "unchanged";
        EXPECT_EQ(error.back(), '.');
        return error;
    }

    TempDir _folder;
};

const std::string way = "[[7.6,45.9],[7.7,45.95],[7.7,45.95],[7.8,46.0]]";

} // namespace

TEST_F(LineVectorsTest, EachFeatureNamesItsStyleInItsOwnField)
{
    const std::vector<MapLine> lines = readAll(
        collection(feature(R"("highway":"track","waterway":null,"name":"Höhenweg")", "LineString", way) +
                   "," + feature(R"("highway":null,"waterway":"river","name":null)", "LineString", way) +
                   "," + feature(R"("highway":null,"waterway":"","name":"")", "LineString", way)));
    ASSERT_EQ(lines.size(), 3u);
    EXPECT_EQ(lines[0].style, "track");
    EXPECT_EQ(lines[0].name, "Höhenweg");
    ASSERT_EQ(lines[0].places.size(), 3u) << "the place that is there twice counts once";
    EXPECT_EQ(lines[0].places[1], osg::Vec3d(7.7, 45.95, 0.0));
    EXPECT_EQ(lines[1].style, "river");
    EXPECT_EQ(lines[1].name, "");
    EXPECT_EQ(lines[2].style, "");
    const std::vector<MapLine> named =
        readAll(collection(feature(R"("name":"a","grade":"steep")", "LineString", way)), {"", "grade"});
    EXPECT_EQ(named[0].style, "steep");
}

TEST_F(LineVectorsTest, TagsOfOpenStreetMapCount)
{
    const std::string file = (_folder.path() / "lines.csv").string();
    std::ofstream(file) << R"csv(WKT,highway,waterway,other_tags
"LINESTRING (7.6 45.9,7.7 45.95)",,,"""piste:type""=>""downhill"",""piste:difficulty""=>""easy"""
"LINESTRING (7.6 45.9,7.7 45.95)",,stream,
"LINESTRING (7.6 45.9,7.7 45.95)",,,"""railway""=>""rail"""
)csv";
    const std::vector<MapLine> lines = readAll(file);
    ASSERT_EQ(lines.size(), 3u);
    EXPECT_EQ(lines[0].style, "downhill");
    EXPECT_EQ(lines[1].style, "stream");
    EXPECT_EQ(lines[2].style, "rail");
    LineVectors::Options options;
    options.style = "piste:difficulty";
    EXPECT_EQ(readAll(file, options)[0].style, "easy");
}

TEST_F(LineVectorsTest, AllGeometriesThatHaveLines)
{
    const std::vector<MapLine> lines = readAll(
        collection(feature("", "MultiLineString", "[" + way + ",[[1,2],[3,4]]]") + "," +
                   feature("", "Polygon", "[[[0,0],[4,0],[4,4],[0,0]],[[2,1],[3,1],[3,2],[2,1]]]") + "," +
                   feature("", "Point", "[1,2]") + R"(,{"type":"Feature","properties":{},"geometry":null})"));
    ASSERT_EQ(lines.size(), 4u) << "two lines, a border and its hole";
    EXPECT_EQ(lines[2].places.size(), 4u);
    EXPECT_EQ(lines[2].places.front(), lines[2].places.back());
}

TEST_F(LineVectorsTest, InTheFrameOfTheTerrain)
{
    MappingFrame frame;
    frame.globe = false;
    // Swiss kilometres: the file's degrees become metres.
    frame.wkt =
        R"(PROJCS["CH1903 / LV03",GEOGCS["CH1903",DATUM["CH1903",SPHEROID["Bessel 1841",6377397.155,299.1528128],TOWGS84[674.374,15.056,405.346,0,0,0,0]],PRIMEM["Greenwich",0],UNIT["degree",0.0174532925199433]],PROJECTION["Hotine_Oblique_Mercator_Azimuth_Center"],PARAMETER["latitude_of_center",46.95240555555556],PARAMETER["longitude_of_center",7.439583333333333],PARAMETER["azimuth",90],PARAMETER["rectified_grid_angle",90],PARAMETER["scale_factor",1],PARAMETER["false_easting",600],PARAMETER["false_northing",200],UNIT["kilometre",1000]])";
    const std::vector<MapLine> lines =
        readAll(collection(feature("", "LineString", "[[7.658,45.976],[7.66,45.98]]")), {}, frame);
    ASSERT_EQ(lines.size(), 1u);
    // The Matterhorn's national coordinates, 617 km east and 92 km north.
    EXPECT_NEAR(lines[0].places[0].x(), 617000.0, 300.0);
    EXPECT_NEAR(lines[0].places[0].y(), 91500.0, 500.0);
}

TEST_F(LineVectorsTest, FaultsAreSentencesAndChangeNothing)
{
    EXPECT_NE(faultOf("nowhere.gpkg").find("nowhere.gpkg"), std::string::npos);
    EXPECT_NE(faultOf(collection(feature("", "Point", "[1,2]"))).find("has no lines"), std::string::npos);
    EXPECT_NE(faultOf(collection(feature("", "LineString", way)), {"", "grade"}).find("\"grade\""),
              std::string::npos);
    EXPECT_NE(faultOf(collection(feature("", "LineString", way)), {"roads", ""}).find("roads"),
              std::string::npos);
}
