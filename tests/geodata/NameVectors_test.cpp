// SPDX-License-Identifier: MIT
// SPDX-FileCopyrightText: 2026 the osgGeoFX authors
//
// Names from vector data: of any geometry, in any coordinate reference system, with fields that lack and lie.
#include <osgGeoFX/geodata/NameVectors.h>
#include <tools/TempDir.h>

#include <gdal_priv.h>
#include <gtest/gtest.h>
#include <ogrsf_frmts.h>

#include <cmath>
#include <fstream>
#include <string>

using namespace osgGeoFX;
using geofx::test::TempDir;

namespace
{

class NameVectorsTest : public ::testing::Test
{
protected:
    std::string write(const std::string& name, const std::string& content) const
    {
        const std::string file = (_folder.path() / name).string();
        std::ofstream(file) << content;
        return file;
    }
    static std::string feature(const std::string& properties, const std::string& geometry)
    {
        return R"({"type":"Feature","properties":{)" + properties + R"(},"geometry":)" + geometry + "}";
    }
    std::string collection(const std::string& features) const
    {
        return write("names.geojson", R"({"type":"FeatureCollection","features":[)" + features + "]}");
    }
    static std::vector<MapName> readAll(const std::string& file, const NameVectors::Options& options = {},
                                        const MappingFrame& frame = {})
    {
        std::vector<MapName> names;
        std::string error;
        EXPECT_TRUE(NameVectors::read(file, options, frame, names, error)) << error;
        return names;
    }
    static std::string faultOf(const std::string& file, const NameVectors::Options& options = {})
    {
        std::vector<MapName> names(1);
        std::string error;
        EXPECT_FALSE(NameVectors::read(file, options, {}, names, error));
        EXPECT_EQ(names.size(), 1u) << "unchanged";
        EXPECT_EQ(error.back(), '.');
        return error;
    }

    TempDir _folder;
};

const std::string point = R"({"type":"Point","coordinates":[7.66,45.98]})";

} // namespace

TEST_F(NameVectorsTest, PointsWithTheirFields)
{
    const std::vector<MapName> names = readAll(collection(
        feature(R"("name":"Matterhorn","ele":4478,"natural":"peak","importance":9.5)", point) + "," +
        feature(R"("name":"Kaʻala","ele":"4,025 ft")", R"({"type":"Point","coordinates":[-158.14,21.5]})") +
        "," +
        feature(R"("name":"Two","ele":"about high")",
                R"({"type":"MultiPoint","coordinates":[[1,2,300],[3,4,310]]})") +
        "," + feature(R"("name":"Flat")", point)));
    ASSERT_EQ(names.size(), 5u);
    EXPECT_EQ(names[0].text, "Matterhorn");
    EXPECT_EQ(names[0].kind, MapName::POINT);
    EXPECT_EQ(names[0].style, "peak");
    EXPECT_EQ(names[0].importance, 9.5);
    ASSERT_EQ(names[0].places.size(), 1u);
    EXPECT_NEAR(names[0].places[0].x(), 7.66, 1e-9);
    EXPECT_NEAR(names[0].places[0].y(), 45.98, 1e-9);
    EXPECT_EQ(names[0].places[0].z(), 4478.0);
    EXPECT_EQ(names[1].text, "Kaʻala");
    EXPECT_NEAR(names[1].places[0].z(), 1226.82, 1e-9);
    EXPECT_TRUE(std::isnan(names[1].importance));
    EXPECT_EQ(names[2].places[0].z(), 300.0) << "of the geometry";
    EXPECT_EQ(names[3].places[0].z(), 310.0);
    EXPECT_TRUE(std::isnan(names[4].places[0].z()));
}

// GDAL's layout of OpenStreetMap: most tags are in one column.
TEST_F(NameVectorsTest, TagsOfOpenStreetMapCount)
{
    const std::string file = write("points.csv", R"csv(WKT,osm_id,name,place,other_tags
POINT (7.66 45.98),1,Matterhorn,,"""natural""=>""peak"",""ele""=>""4478"",""alt_name""=>""Mont \""Cervin\""
"""
POINT (7.75 46.02),2,Zermatt,village,"""ele""=>""1,608 m"""
POINT (7.7 46),3,,,"""natural""=>""peak"",""name:de""=>""Horn"""
)csv");
    const std::vector<MapName> names = readAll(file);
    ASSERT_EQ(names.size(), 2u);
    EXPECT_EQ(names[0].style, "peak");
    EXPECT_EQ(names[0].places[0].z(), 4478.0);
    EXPECT_EQ(names[1].style, "village");
    EXPECT_EQ(names[1].places[0].z(), 1608.0);
    NameVectors::Options options;
    options.name = "alt_name";
    const std::vector<MapName> others = readAll(file, options);
    ASSERT_EQ(others.size(), 1u);
    EXPECT_EQ(others[0].text, "Mont \"Cervin\" ") << "a line break is a space";
    options.name = "name:de";
    EXPECT_EQ(readAll(file, options)[0].text, "Horn");
}

TEST_F(NameVectorsTest, TheFirstValueTellsTheKindAndNotTheFirstColumn)
{
    const std::vector<MapName> names =
        readAll(collection(feature(R"("name":"Zermatt","natural":"","place":"village")", point) + "," +
                           feature(R"("name":"Matterhorn","natural":"peak","place":null)", point)));
    ASSERT_EQ(names.size(), 2u);
    EXPECT_EQ(names[0].style, "village");
    EXPECT_EQ(names[1].style, "peak");
}

TEST_F(NameVectorsTest, CsvHasItsPlacesInColumns)
{
    for (const char* const columns : {"longitude,latitude", "Lon,Lat", "X,Y"})
    {
        SCOPED_TRACE(columns);
        const std::vector<MapName> names = readAll(
            write("places.csv", "name," + std::string(columns) + ",ele\nA,7.5,46.5,1200\nB,7.6,46.4,\n"));
        ASSERT_EQ(names.size(), 2u);
        EXPECT_EQ(names[0].places[0], osg::Vec3d(7.5, 46.5, 1200.0));
    }
    const std::vector<MapName> names = readAll(write("semicolons.csv", "WKT;name\nPOINT(7.5 46.5);A\n"));
    ASSERT_EQ(names.size(), 1u);
    EXPECT_EQ(names[0].places[0].y(), 46.5);
    EXPECT_NE(faultOf(write("none.csv", "name,where\nA,here\n")).find("no columns of places"),
              std::string::npos);
    EXPECT_NE(
        faultOf(write("metres.csv", "name,x,y\nA,600000,200000\n")).find("no coordinate reference system"),
        std::string::npos);
}

TEST_F(NameVectorsTest, TextOfOldFilesBecomesUtf8)
{
    const std::string file = write(
        "old.csv", "name,lon,lat\nZ\xfcrich\x80,8.5,47.4\n\"a\x01\nb\tc\",8.6,47.4\nK\xc3\xb6ln,8.7,47.4\n");
    const std::vector<MapName> names = readAll(file);
    ASSERT_EQ(names.size(), 3u);
    EXPECT_EQ(names[0].text, "Zürich€");
    EXPECT_EQ(names[1].text, "a b c");
    EXPECT_EQ(names[2].text, "Köln");
}

// QGIS keeps styles in a GeoPackage as a table without places.
TEST_F(NameVectorsTest, TablesWithoutPlacesAreNoLayers)
{
    GDALAllRegister();
    const std::string file = (_folder.path() / "project.gpkg").string();
    GDALDataset* const dataset =
        GetGDALDriverManager()->GetDriverByName("GPKG")->Create(file.c_str(), 0, 0, 0, GDT_Unknown, nullptr);
    OGRSpatialReference degrees;
    degrees.importFromEPSG(4326);
    for (const bool table : {true, false})
    {
        OGRLayer* const layer =
            dataset->CreateLayer(table ? "layer_styles" : "peaks", table ? nullptr : &degrees,
                                 table ? wkbNone : wkbPoint, nullptr);
        OGRFieldDefn name("name", OFTString);
        layer->CreateField(&name);
        OGRFeature each(layer->GetLayerDefn());
        each.SetField("name", "A");
        if (!table) each.SetGeometryDirectly(new OGRPoint(7.5, 46.5));
        EXPECT_EQ(layer->CreateFeature(&each), OGRERR_NONE);
    }
    GDALClose(dataset);
    EXPECT_EQ(readAll(file).size(), 1u);
    NameVectors::Options options;
    options.layer = "layer_styles";
    EXPECT_NE(faultOf(file, options).find("is a table without places"), std::string::npos);
}

// An area's name runs along its middle: here a lake that is bent like a banana.
TEST_F(NameVectorsTest, LinesAndAreasAreCurves)
{
    std::string outer, inner;
    for (int i = 0; i <= 40; ++i)
    {
        const double angle = 3.14159265 * i / 40.0;
        const auto place = [&](double radius)
        {
            return "[" + std::to_string(radius * std::cos(angle)) + "," +
                   std::to_string(radius * std::sin(angle)) + "]";
        };
        outer += place(1.0) + ",";
        inner = place(0.8) + "," + inner;
    }
    const std::vector<MapName> names = readAll(collection(
        feature(R"("name":"River","natural":"water")",
                R"({"type":"MultiLineString","coordinates":[[[0,0],[0.1,0]],[[0,1],[0.5,1],[0.5,1.2]]]})") +
        "," +
        feature(R"("name":"Bent Lake")",
                R"({"type":"Polygon","coordinates":[[)" + outer + inner + "[1,0]]]}")));
    ASSERT_EQ(names.size(), 2u);
    EXPECT_EQ(names[0].kind, MapName::LINE);
    EXPECT_NEAR(names[0].places.front().y(), 1.0, 1e-9) << "the longer part";
    EXPECT_NEAR(names[0].places.back().y(), 1.2, 1e-9);
    ASSERT_GT(names[1].places.size(), 10u);
    // Where the lake's arc is crossed once, the curve is its middle line.
    int within = 0;
    for (const osg::Vec3d& place : names[1].places)
    {
        const double radius = std::hypot(place.x(), place.y());
        within += radius > 0.78 && radius < 1.02 ? 1 : 0;
    }
    EXPECT_EQ(within, static_cast<int>(names[1].places.size()));
}

TEST_F(NameVectorsTest, AnyCoordinateReferenceSystemAndAProjectedTerrain)
{
    // Swiss coordinates of the Matterhorn: easting, northing.
    const std::string file = (_folder.path() / "swiss.gpkg").string();
    GDALAllRegister();
    {
        GDALDataset* const dataset = GetGDALDriverManager()->GetDriverByName("GPKG")->Create(
            file.c_str(), 0, 0, 0, GDT_Unknown, nullptr);
        ASSERT_TRUE(dataset);
        OGRSpatialReference swiss;
        swiss.importFromEPSG(2056);
        OGRLayer* const layer = dataset->CreateLayer("peaks", &swiss, wkbPoint, nullptr);
        OGRFieldDefn field("title", OFTString);
        layer->CreateField(&field);
        OGRFeature* const feature = OGRFeature::CreateFeature(layer->GetLayerDefn());
        feature->SetField("title", "Matterhorn");
        const OGRPoint place(2617050.0, 1091650.0);
        feature->SetGeometry(&place);
        ASSERT_EQ(layer->CreateFeature(feature), OGRERR_NONE);
        OGRFeature::DestroyFeature(feature);
        GDALClose(dataset);
    }
    const std::vector<MapName> globe = readAll(file);
    ASSERT_EQ(globe.size(), 1u);
    EXPECT_NEAR(globe[0].places[0].x(), 7.6586, 0.001);
    EXPECT_NEAR(globe[0].places[0].y(), 45.9764, 0.001);
    MappingFrame frame;
    frame.globe = false;
    OGRSpatialReference utm;
    utm.importFromEPSG(32632);
    char* text = nullptr;
    utm.exportToWkt(&text);
    frame.wkt = text;
    CPLFree(text);
    NameVectors::Options options;
    options.layer = "peaks";
    options.name = "title";
    const std::vector<MapName> plane = readAll(file, options, frame);
    ASSERT_EQ(plane.size(), 1u);
    EXPECT_NEAR(plane[0].places[0].x(), 396075.0, 150.0);
    EXPECT_NEAR(plane[0].places[0].y(), 5092450.0, 300.0);
}

TEST_F(NameVectorsTest, WhatHasNoNameOrNoPlaceIsLeftOut)
{
    const std::vector<MapName> names = readAll(
        collection(feature(R"("name":null)", point) + "," + feature(R"("name":"  ")", point) + "," +
                   feature(R"("name":"Nowhere")", "null") + "," +
                   feature(R"("name":"Empty")", R"({"type":"Point","coordinates":[]})") + "," +
                   feature(R"("name":"Beyond the pole")", R"({"type":"Point","coordinates":[0,95]})") + "," +
                   feature(R"("name":"Here")", point)));
    ASSERT_EQ(names.size(), 1u);
    EXPECT_EQ(names[0].text, "Here");
}

TEST_F(NameVectorsTest, FaultsAreSentencesWithTheRemedy)
{
    EXPECT_NE(faultOf((_folder.path() / "none.gpkg").string()).find("none.gpkg"), std::string::npos);
    EXPECT_NE(faultOf(write("text.csv", "a,b\n1,2\n")).find("text.csv"), std::string::npos);
    const std::string file = collection(feature(R"("title2":"x")", point));
    EXPECT_NE(faultOf(file).find("of title2, by --label-field"), std::string::npos);
    EXPECT_NE(faultOf(collection(feature(R"("name":null)", point))).find("ogrinfo"), std::string::npos);
    collection(feature(R"("title2":"x")", point));
    NameVectors::Options options;
    options.name = "nom";
    EXPECT_NE(faultOf(file, options).find("no field \"nom\""), std::string::npos);
    options = {};
    options.layer = "lakes";
    EXPECT_NE(faultOf(file, options).find("no layer \"lakes\""), std::string::npos);
}

// In KML a third number counts in one mode alone; the usual one has 0 there, which is no height.
TEST_F(NameVectorsTest, PointsOfKmlOnTheGroundHaveNoHeight)
{
    const std::pair<const char*, double> points[] = {
        {"<coordinates>7.66,45.98,0</coordinates>", std::nan("")},
        {"<altitudeMode>clampToGround</altitudeMode><coordinates>7.66,45.98,0</coordinates>", std::nan("")},
        {"<altitudeMode>relativeToGround</altitudeMode><coordinates>7.66,45.98,30</coordinates>",
         std::nan("")},
        {"<altitudeMode>absolute</altitudeMode><coordinates>7.66,45.98,0</coordinates>", 0.0},
        {"<altitudeMode>absolute</altitudeMode><coordinates>7.66,45.98,2014</coordinates>", 2014.0},
        {"<coordinates>7.66,45.98,4478</coordinates>", 4478.0},
        {"<coordinates>7.66,45.98</coordinates>", std::nan("")}};
    for (const auto& [text, height] : points)
    {
        const std::vector<MapName> names = readAll(
            write("names.kml",
                  "<kml xmlns=\"http://www.opengis.net/kml/2.2\"><Document><Placemark><name>A</name><Point>" +
                      std::string(text) + "</Point></Placemark></Document></kml>"));
        ASSERT_EQ(names.size(), 1u) << text;
        EXPECT_EQ(std::isnan(names[0].places[0].z()), std::isnan(height)) << text;
        if (!std::isnan(height))
        {
            EXPECT_EQ(names[0].places[0].z(), height) << text;
        }
    }
}
