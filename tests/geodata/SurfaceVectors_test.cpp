// SPDX-License-Identifier: MIT
// SPDX-FileCopyrightText: 2026 the osgGeoFX authors
//
// Surface data from vector data: roads and the like. Where things must lie, GeographicLib says.
#include <geodata/SurfaceRasterFixture.h>

#include <algorithm>
#include <cmath>
#include <string>

namespace
{

using namespace geofx::test;

class SurfaceVectors : public SurfaceRasterFixture
{
protected:
    /// Roads as GeoJSON, which is in longitude and latitude.
    std::string writeLines(const std::string& name, const std::string& geometry) const
    {
        return _folder
            .write(
                name,
                R"({"type":"FeatureCollection","features":[{"type":"Feature","properties":{},"geometry":)" +
                    geometry + "}]}")
            .string();
    }
};

/// What lines cover, square metres.
double areaOf(const SurfaceData& data, const osg::Image& image)
{
    double sum = 0.0;
    for (int y = 0; y < image.t(); ++y)
        for (int x = 0; x < image.s(); ++x)
            sum += static_cast<double>(texelAt(image, x, y)[3]);
    return sum * data.getSpacing().x() * data.getSpacing().y();
}

TEST_F(SurfaceVectors, AreAsLongAndAsWideAsTheyAre)
{
    _frame = globeAt(-158.0, 21.4);
    const auto drawn = [&](const std::string& geometry, double width)
    {
        osg::ref_ptr<SurfaceData> data = new SurfaceData;
        data->setLocalOrigin(_frame.origin);
        data->setRectangle(osg::Vec2d(-3000.0, -2000.0), osg::Vec2d(3000.0, 2000.0));
        std::string error;
        EXPECT_TRUE(SurfaceRaster::addVectors(*data, "roads", writeLines("a.geojson", geometry), width,
                                              osg::Vec4f(0.9f, 0.5f, 0.1f, 1.0f), _frame, error, 300))
            << error;
        return data;
    };
    // 0.04 degrees north and 0.02 degrees east, from one end of the picture to the other and beyond.
    const osg::Vec2d from = placeOf(_frame, -158.01, 21.38), to = placeOf(_frame, -157.99, 21.42);
    const std::string line = R"({"type":"LineString","coordinates":[[-158.01,21.38],[-157.99,21.42]]})";
    const osg::Vec2d way = to - from;
    const double inside = 4000.0 * way.length() / way.y();
    for (const double width : {5.0, 20.0, 60.0, 200.0})
    {
        const osg::ref_ptr<SurfaceData> data = drawn(line, width);
        const osg::Image& image = *data->getLayerImage(0);
        EXPECT_EQ(image.s(), 300);
        EXPECT_EQ(data->getLayerKind(0), SurfaceData::COLOR);
        EXPECT_NEAR(areaOf(*data, image) / (inside * width), 1.0, width < 20.0 ? 0.05 : 0.01) << width;
        for (double share = 0.1; share < 0.95; share += 0.01)
        {
            const osg::Vec2d place = from + way * share;
            if (std::abs(place.y()) > 1950.0) continue;
            const auto [x, y] = texelOf(*data, place);
            const Texel on = texelAt(image, x, y);
            EXPECT_EQ(on[0], 0.9f);
            if (width > 40.0)
            {
                EXPECT_EQ(on[3], 1.0f);
            }
            const osg::Vec2d aside = osg::Vec2d(way.y(), -way.x()) / way.length() * (width / 2.0 + 35.0);
            const auto [i, j] = texelOf(*data, place + aside);
            EXPECT_EQ(texelAt(image, i, j)[3], 0.0f);
            EXPECT_EQ(texelAt(image, i, j)[0], 0.9f) << "no dark edges when alpha is interpolated";
        }
    }
    // A disc, and the border of an area with a hole.
    const osg::ref_ptr<SurfaceData> disc =
        drawn(R"({"type":"MultiPoint","coordinates":[[-158.0,21.4]]})", 400.0);
    EXPECT_NEAR(areaOf(*disc, *disc->getLayerImage(0)) / (osg::PI * 200.0 * 200.0), 1.0, 0.02);
    const osg::ref_ptr<SurfaceData> area = drawn(
        R"({"type":"Polygon","coordinates":[[[-158.01,21.39],[-157.99,21.39],[-157.99,21.41],[-158.01,21.41],)"
        R"([-158.01,21.39]],[[-158.002,21.398],[-157.998,21.398],[-157.998,21.402],[-158.002,21.402],)"
        R"([-158.002,21.398]]]})",
        40.0);
    const double around =
        2.0 * (placeOf(_frame, -157.99, 21.4).x() + placeOf(_frame, -158.0, 21.41).y()) * 2.0 * 1.2;
    EXPECT_NEAR(areaOf(*area, *area->getLayerImage(0)) / (around * 40.0), 1.0, 0.03);
    EXPECT_EQ(texelAt(*area->getLayerImage(0), 150, 100)[3], 0.0f);
}

TEST_F(SurfaceVectors, ThatBendInTheFrameFollowThem)
{
    // Along a parallel in the north, one segment of 4 degrees: it bends 1.7 km off the straight way.
    _frame = globeAt(10.0, 60.0);
    const osg::ref_ptr<SurfaceData> data = new SurfaceData;
    data->setLocalOrigin(_frame.origin);
    data->setRectangle(osg::Vec2d(-120000.0, -5000.0), osg::Vec2d(120000.0, 5000.0));
    // The one on the other side of the globe is left out.
    const std::string file =
        writeLines("a.geojson", R"({"type":"MultiLineString","coordinates":[[[8,60],[12,60]],)"
                                R"([[-170,-60],[-160,-50],[-165,-40]]]})");
    std::string error;
    ASSERT_TRUE(SurfaceRaster::addVectors(*data, "a", file, 500.0, osg::Vec4f(1.0f, 1.0f, 1.0f, 0.5f), _frame,
                                          error, 2048))
        << error;
    for (double longitude = 8.01; longitude < 12.0; longitude += 0.01)
    {
        const auto [x, y] = texelOf(*data, placeOf(_frame, longitude, 60.0));
        EXPECT_NEAR(static_cast<double>(texelAt(*data->getLayerImage(0), x, y)[3]), 0.5, 1e-6) << longitude;
    }
}

TEST_F(SurfaceVectors, OfNoUseAreToldWithFileAndMend)
{
    const auto sentence = [&](const std::string& file, double width, const osg::Vec4f& color)
    {
        return sentenceOf(
            file, [&](std::string& error)
            { return SurfaceRaster::addVectors(*_data, "x", file, width, color, _frame, error); });
    };
    const osg::Vec4f white(1.0f, 1.0f, 1.0f, 1.0f);
    const std::string far =
        writeLines("far.geojson", R"({"type":"LineString","coordinates":[[10.0,50.0],[10.1,50.1]]})");
    holds(sentence(far, 10.0, white), "nothing in the rectangle");
    holds(sentence((_folder / "none.geojson").string(), 10.0, white), "there is no such file");
    holds(sentence(_folder.write("text.geojson", "{").string(), 10.0, white), "check it with ogrinfo");
    holds(sentence(raster(4, 4).write(_folder / "r.tif"), 10.0, white),
          "make areas of it with gdal_polygonize");
    holds(
        sentence(_folder.write("no.csv", "id,WKT\n1,\"LINESTRING(600000 200000,600001 200001)\"\n").string(),
                 10.0, white),
        "ogr2ogr -a_srs");
    for (const double width : {0.0, -1.0, 2e6, none})
        holds(sentence(far, width, white), "give metres");
    holds(sentence(far, 1.0, osg::Vec4f(1.0f, 1.5f, 1.0f, 1.0f)), "give numbers of 0 to 1");
}

} // namespace
