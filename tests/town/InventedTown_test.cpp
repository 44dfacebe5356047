// SPDX-License-Identifier: MIT
// SPDX-FileCopyrightText: 2026 the osgGeoFX authors
//
// The made-up town of data/oahu: houses stand on no road, streets run between them, and the files in data/oahu are those of its generator.
#include <tools/InventedTown.h>
#include <tools/OahuRaster.h>
#include <tools/TempDir.h>

#include <gdal_priv.h>
#include <gtest/gtest.h>
#include <ogrsf_frmts.h>
#include <osg/Vec2d>

#include <algorithm>
#include <cmath>
#include <fstream>
#include <iterator>
#include <memory>
#include <string>
#include <vector>

using namespace geofx::test;

namespace
{

const std::string OAHU = GEOFX_SOURCE_DIR "/data/oahu/";

/// Metres about a place in Honolulu.
osg::Vec2d metres(double longitude, double latitude)
{
    return {(longitude + 157.85) * 103700.0, (latitude - 21.3) * 110730.0};
}

struct Line
{
    osg::Vec2d from, to;
};

std::vector<Line> linesOf(const std::string& file, const std::string& style)
{
    GDALAllRegister();
    std::vector<Line> lines;
    const std::unique_ptr<GDALDataset> data(GDALDataset::Open(file.c_str(), GDAL_OF_VECTOR));
    if (!data) return lines;
    for (const auto& feature : data->GetLayer(0))
    {
        if (feature->GetFieldAsString("style") != style) continue;
        for (const OGRLineString* line : *feature->GetGeometryRef()->toMultiLineString())
            for (int i = 0; i + 1 < line->getNumPoints(); ++i)
                lines.push_back(
                    {metres(line->getX(i), line->getY(i)), metres(line->getX(i + 1), line->getY(i + 1))});
    }
    return lines;
}

struct House
{
    std::vector<osg::Vec2d> outline;
    osg::Vec2d degrees; ///< of a corner
    std::string use;
};

std::vector<House> housesOf(const std::string& file)
{
    std::vector<House> houses;
    const std::unique_ptr<GDALDataset> data(GDALDataset::Open(file.c_str(), GDAL_OF_VECTOR));
    if (!data) return houses;
    for (const auto& feature : data->GetLayer(0))
    {
        House house;
        const OGRLinearRing& ring = *feature->GetGeometryRef()->toPolygon()->getExteriorRing();
        for (int i = 0; i + 1 < ring.getNumPoints(); ++i)
            house.outline.push_back(metres(ring.getX(i), ring.getY(i)));
        house.degrees.set(ring.getX(0), ring.getY(0));
        house.use = feature->GetFieldAsString("use");
        houses.push_back(house);
    }
    return houses;
}

/// Metres between a line and a place.
double apart(const Line& line, const osg::Vec2d& place)
{
    const osg::Vec2d side = line.to - line.from;
    const double share =
        side.length2() > 0.0 ? std::clamp(((place - line.from) * side) / side.length2(), 0.0, 1.0) : 0.0;
    return (place - line.from - side * share).length();
}

/// The least distance of an outline's corners and its sides' middles to all lines.
double nearest(const std::vector<Line>& lines, const std::vector<osg::Vec2d>& outline)
{
    double result = HUGE_VAL;
    for (const Line& line : lines)
    {
        const osg::Vec2d middle = (line.from + line.to) * 0.5;
        if ((outline.front() - middle).length() > 0.5 * (line.to - line.from).length() + 200.0) continue;
        for (std::size_t i = 0; i < outline.size(); ++i)
        {
            result = std::min(result, apart(line, outline[i]));
            result = std::min(result, apart(line, (outline[i] + outline[(i + 1) % outline.size()]) * 0.5));
        }
    }
    return result;
}

std::string bytesOf(const std::string& file)
{
    std::ifstream stream(file, std::ios::binary);
    return {std::istreambuf_iterator<char>(stream), {}};
}

} // namespace

TEST(InventedTown, HousesStandAlongStreetsAndOnNoRoad)
{
    const TempDir folder;
    const std::string town = (folder / "town.gpkg").string(), file = (folder / "streets.geojson").string();
    const int count = 3000;
    ASSERT_EQ(inventTown(town, count), count);
    EXPECT_GT(inventStreets(file, count), 100);
    const std::vector<Line> streets = linesOf(file, "residential"),
                            freeways = linesOf(OAHU + "streets.geojson", "motorway"),
                            roads = linesOf(OAHU + "streets.geojson", "secondary");
    ASSERT_GT(freeways.size(), 500u);
    ASSERT_GT(roads.size(), 2000u);
    int all = 0, beside = 0;
    for (const House& house : housesOf(town))
    {
        EXPECT_GT(nearest(freeways, house.outline), 15.0);
        EXPECT_GT(nearest(roads, house.outline), 6.0);
        // Files round to a metre.
        EXPECT_GT(nearest(streets, house.outline), 4.0);
        if (house.use != "house") continue;
        ++all;
        beside += nearest(streets, house.outline) < 25.0 ? 1 : 0;
    }
    EXPECT_GT(all, 200);
    EXPECT_GT(beside, all * 85 / 100);
}

TEST(InventedTown, TheFilesInDataAreItsOwn)
{
    const TempDir folder;
    const std::string file = (folder / "streets.geojson").string();
    inventStreets(file, 40000);
    EXPECT_EQ(bytesOf(file), bytesOf(OAHU + "town-streets.geojson"))
        << "make it anew: geofx_invent streets data/oahu/town-streets.geojson 40000";
    // The land cover: as landcover.tif has it, but for lines, and for gardens where houses stand.
    const OahuRaster<unsigned char> ground("ground.tif", GDT_Byte), cover("landcover.tif", GDT_Byte);
    constexpr unsigned char town = 15, urban = 16, suburb = 25;
    int gardens = 0, other = 0;
    for (int row = 0; row < cover.rows(); ++row)
        for (int column = 0; column < cover.columns(); ++column)
        {
            const unsigned char here = ground.pixel(column, row), there = cover.pixel(column, row);
            const bool line = there == 3 || there == 4 || (there >= 19 && there <= 21);
            if (here == suburb)
            {
                ++gardens;
                other += line || there == town || there == urban ? 0 : 1;
            }
            else
                other += line || here == there ? 0 : 1;
        }
    EXPECT_GT(gardens, 10000);
    EXPECT_EQ(other, 0);
    const std::string buildings = (folder / "town.gpkg").string();
    inventTown(buildings, 40000);
    int houses = 0, among = 0;
    for (const House& house : housesOf(buildings))
    {
        if (house.use != "house") continue;
        ++houses;
        among += ground.at(house.degrees.x(), house.degrees.y()) == suburb ? 1 : 0;
    }
    EXPECT_GT(houses, 10000);
    EXPECT_GT(among, houses * 9 / 10);
}

// Copying it once more changes nothing.
TEST(InventedTown, GardensStayWhereTheyAre)
{
    const TempDir folder;
    const std::string file = (folder / "ground.tif").string();
    EXPECT_GT(inventGardens(OAHU + "ground.tif", file), 10000);
    const OahuRaster<unsigned char> ground("ground.tif", GDT_Byte);
    const std::unique_ptr<GDALDataset> data(GDALDataset::Open(file.c_str()));
    ASSERT_TRUE(data);
    std::vector<unsigned char> row(static_cast<std::size_t>(ground.columns()));
    int less = 0;
    for (int r = 0; r < ground.rows(); ++r)
    {
        ASSERT_EQ(data->GetRasterBand(1)->RasterIO(GF_Read, 0, r, ground.columns(), 1, row.data(),
                                                   ground.columns(), 1, GDT_Byte, 0, 0),
                  CE_None);
        for (int c = 0; c < ground.columns(); ++c)
            less += ground.pixel(c, r) == 25 && row[static_cast<std::size_t>(c)] != 25 ? 1 : 0;
    }
    EXPECT_EQ(less, 0);
}
