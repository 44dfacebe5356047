// SPDX-License-Identifier: MIT
// SPDX-FileCopyrightText: 2026 the osgGeoFX authors
//
// Surface data from rasters. Where things must lie, GeographicLib says for globes.
#include <geodata/SurfaceRasterFixture.h>
#include <tools/RandomSamples.h>

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <set>
#include <string>
#include <utility>

namespace
{

using namespace geofx::test;
using osg::DegreesToRadians;

const std::string elevation = GEOFX_SOURCE_DIR "/data/oahu/elevation.tif";
const std::string landCover = GEOFX_SOURCE_DIR "/data/oahu/landcover.tif";

/// Mixed between texels.
double mixedAt(const SurfaceData& data, int layer, const osg::Vec2d& place)
{
    const osg::Vec2d half = data.getSpacing() / 2.0;
    const auto [x, y] = texelOf(data, place - half);
    const osg::Vec2d from = place - half - data.getLow();
    const double u = from.x() / data.getSpacing().x() - x, v = from.y() / data.getSpacing().y() - y;
    const osg::Image& image = *data.getLayerImage(layer);
    return (1.0 - v) * ((1.0 - u) * valueAt(image, x, y) + u * valueAt(image, x + 1, y)) +
           v * ((1.0 - u) * valueAt(image, x, y + 1) + u * valueAt(image, x + 1, y + 1));
}

class SurfaceRasterLayers : public SurfaceRasterFixture
{
protected:
    const osg::Image& added(SurfaceData::Kind kind, const std::string& file, int maxSide = 1024)
    {
        const std::string name = "layer " + std::to_string(_data->getNumLayers());
        std::string error;
        EXPECT_TRUE(SurfaceRaster::addLayer(*_data, name, kind, file, _frame, error, maxSide)) << error;
        EXPECT_EQ(error, "");
        const int layer = _data->findLayer(name);
        EXPECT_EQ(_data->getLayerKind(layer), kind);
        return *_data->getLayerImage(layer);
    }

    osg::ref_ptr<SurfaceData> dem(const std::string& file, const SurfaceRaster::Options& options = {})
    {
        std::string error;
        osg::ref_ptr<SurfaceData> data = SurfaceRaster::fromDem(file, _frame, options, error);
        EXPECT_TRUE(data) << error;
        return data;
    }

    using SurfaceRasterFixture::sentenceOf;
    std::string sentenceOf(const std::string& file, SurfaceData::Kind kind)
    {
        return sentenceOf(file, [&](std::string& error)
                          { return SurfaceRaster::addLayer(*_data, "x", kind, file, _frame, error); });
    }
};

TEST_F(SurfaceRasterLayers, AreTheFileInItsOwnCoordinateSystem)
{
    const std::string file = raster(60, 40)
                                 .fill([](int column, int row, int) { return column + 100.0 * row; })
                                 .write(_folder / "r.tif");
    const osg::Image& image = added(SurfaceData::HEIGHT, file);
    ASSERT_EQ(image.s(), 60);
    ASSERT_EQ(image.t(), 40);
    for (int y = 0; y < 40; ++y)
        for (int x = 0; x < 60; ++x)
            EXPECT_EQ(texelAt(image, x, y), (Texel{static_cast<float>(x + 100 * (39 - y)), 0.0f, 0.0f, 1.0f}))
                << x << " " << y;
    EXPECT_EQ(image.getFileName(), file);
    // The next one has as many texels as the first one, whatever its own resolution; it lies half beside the rectangle.
    const std::string coarse = TestRaster(6, 6)
                                   .placed(600300.0, 2300100.0, 100.0, 100.0)
                                   .crs("EPSG:32604")
                                   .fill([](int, int, int) { return 7.0; })
                                   .write(_folder / "s.tif");
    const osg::Image& next = added(SurfaceData::VALUE, coarse);
    ASSERT_EQ(next.s(), 60);
    ASSERT_EQ(next.t(), 40);
    EXPECT_EQ(texelAt(next, 29, 20), Texel());
    EXPECT_EQ(texelAt(next, 30, 20), (Texel{7.0f, 0.0f, 0.0f, 1.0f}));
}

TEST_F(SurfaceRasterLayers, HaveTheRastersResolutionOrTheMostTexels)
{
    TestRaster source = raster(60, 40);
    source.fill([](int, int, int) { return 1.0; });
    const std::string file = source.write(_folder / "r.tif");
    const osg::Image& few = added(SurfaceData::VALUE, file, 30);
    EXPECT_EQ(few.s(), 30);
    EXPECT_EQ(few.t(), 20);
    _data->removeLayer("layer 0");
    _data->setRectangle(osg::Vec2d(100.0, -400.0), osg::Vec2d(200.0, 0.0));
    const osg::Image& part = added(SurfaceData::VALUE, file);
    EXPECT_EQ(part.s(), 10);
    EXPECT_EQ(part.t(), 40);
}

TEST_F(SurfaceRasterLayers, LieWhereOtherLibrariesSayOnAGlobe)
{
    // The last one is far from the origin, where the globe bends away.
    for (const MappingFrame& frame : {globeAt(-157.95, 21.47), globeAt(-155.0, 19.0)})
    {
        const auto field = [](double column, double row)
        {
            return 10.0 * column - 7.0 * row + 500.0;
        };
        const std::string file =
            TestRaster(300, 200)
                .placed(-158.0, 21.5, 0.0003, 0.0003)
                .crs("EPSG:4326")
                .fill([&](int column, int row, int) { return field(column + 0.5, row + 0.5); })
                .write(_folder / "r.tif");
        const osg::ref_ptr<SurfaceData> data = new SurfaceData;
        data->setLocalOrigin(frame.origin);
        const osg::Vec2d middle = placeOf(frame, -157.955, 21.47);
        data->setRectangle(middle - osg::Vec2d(6000.0, 4500.0), middle + osg::Vec2d(6000.0, 4500.0));
        std::string error;
        // Of the frame only that it is a globe counts.
        ASSERT_TRUE(SurfaceRaster::addLayer(*data, "a", SurfaceData::HEIGHT, file, globeAt(1.0, 2.0), error))
            << error;
        EXPECT_NEAR(data->getSpacing().x(), 32.0, 4.0) << "0.0003 degrees";
        for (int i = 0; i < 500; ++i)
        {
            Random random(static_cast<std::uint64_t>(i));
            const double column = random.uniform(3.0, 297.0), row = random.uniform(3.0, 197.0);
            const osg::Vec2d place = placeOf(frame, -158.0 + 0.0003 * column, 21.5 - 0.0003 * row);
            // Along the steepest way, a tenth of a pixel.
            EXPECT_NEAR(mixedAt(*data, 0, place), field(column, row), 0.1 * std::hypot(10.0, 7.0)) << i;
        }
        // The raster's corners lie on the texels that they should: there is data inside of them and none outside.
        for (const double column : {0.0, 300.0})
            for (const double row : {0.0, 200.0})
                for (const double pixels : {-1.5, 1.5})
                {
                    const double east = column > 0.0 ? -pixels : pixels, south = row > 0.0 ? -pixels : pixels;
                    const auto [x, y] = texelOf(*data, placeOf(frame, -158.0 + 0.0003 * (column + east),
                                                               21.5 - 0.0003 * (row + south)));
                    EXPECT_EQ(hasTexel(*data->getLayerImage(0), x, y), pixels > 0.0)
                        << column << " " << row << " " << pixels;
                }
    }
}

TEST_F(SurfaceRasterLayers, WithoutDataAreNothingAndDoNotBleed)
{
    TestRaster source = raster(60, 40, 1, GDT_Int16);
    const auto isHole = [](int column, int row)
    {
        return column >= 20 && column < 30 && row >= 10 && row < 20;
    };
    source.fill([&](int column, int row, int) { return isHole(column, row) ? -9999.0 : 100.0; });
    source.dataset().GetRasterBand(1)->SetNoDataValue(-9999.0);
    source.dataset().GetRasterBand(1)->SetScale(0.5);
    source.dataset().GetRasterBand(1)->SetOffset(3.0);
    const std::string file = source.write(_folder / "r.tif");
    // As it is, and half a pixel aside, so that it is interpolated.
    for (const double shift : {0.0, 5.0})
    {
        _data->setRectangle(osg::Vec2d(shift, -400.0 + shift), osg::Vec2d(600.0 + shift, shift));
        const osg::Image& image = added(SurfaceData::HEIGHT, file);
        for (int y = 1; y < 39; ++y)
            for (int x = 1; x < 59; ++x)
            {
                if (hasTexel(image, x, y))
                    EXPECT_NEAR(valueAt(image, x, y), 53.0, 1e-4) << x << " " << y;
                else
                    EXPECT_EQ(texelAt(image, x, y), Texel());
            }
        EXPECT_EQ(texelAt(image, 25, 25), Texel());
        ASSERT_TRUE(_data->addDerived("slope", SurfaceData::SLOPE));
        const osg::Image& slope = *_data->getLayerImage(_data->findLayer("slope"));
        for (int y = 1; y < 39; ++y)
            for (int x = 1; x < 59; ++x)
                EXPECT_EQ(texelAt(slope, x, y),
                          (Texel{0.0f, 0.0f, 0.0f, hasTexel(image, x, y) ? 1.0f : 0.0f}));
        _data->removeLayer("slope");
        _data->removeLayer("layer 0");
    }
}

TEST_F(SurfaceRasterLayers, AreColorsOrClasses)
{
    TestRaster palette = raster(60, 40, 1, GDT_Byte);
    GDALColorTable colors;
    const GDALColorEntry red = {255, 51, 0, 255};
    const GDALColorEntry blue = {0, 102, 255, 255};
    colors.SetColorEntry(5, &red);
    colors.SetColorEntry(9, &blue);
    palette.dataset().GetRasterBand(1)->SetColorTable(&colors);
    palette.fill([](int column, int, int) { return column < 30 ? 5.0 : 9.0; });
    const std::string file = palette.write(_folder / "p.tif");
    const osg::Image& picture = added(SurfaceData::COLOR, file);
    EXPECT_EQ(texelAt(picture, 10, 10), (Texel{1.0f, 0.2f, 0.0f, 1.0f}));
    EXPECT_EQ(texelAt(picture, 40, 10), (Texel{0.0f, 0.4f, 1.0f, 1.0f}));

    // The south is the lowest row of pictures too. They have their alpha.
    TestRaster bands = raster(60, 40, 4, GDT_Byte);
    bands.dataset().GetRasterBand(4)->SetColorInterpretation(GCI_AlphaBand);
    bands.fill([](int, int row, int band)
               { return band == 3                ? 51.0
                        : band == 1 && row == 39 ? 255.0
                                                 : 0.0; });
    const osg::Image& ramp = added(SurfaceData::COLOR, bands.write(_folder / "rgba.tif"));
    EXPECT_EQ(texelAt(ramp, 10, 0), (Texel{0.0f, 1.0f, 0.0f, 0.2f}));
    EXPECT_EQ(texelAt(ramp, 10, 39), (Texel{0.0f, 0.0f, 0.0f, 0.2f}));

    // Half a pixel aside there is still nothing between 5 and 9.
    _data->setRectangle(osg::Vec2d(5.0, -400.0), osg::Vec2d(600.0, 0.0));
    const osg::Image& classes = added(SurfaceData::CLASS, file);
    std::set<double> found;
    for (int x = 0; x < classes.s(); ++x)
        found.insert(valueAt(classes, x, 20));
    EXPECT_EQ(found, (std::set<double>{5.0, 9.0}));
    const osg::Image& unmixed = added(SurfaceData::COLOR, file);
    for (int x = 0; x < unmixed.s(); ++x)
        EXPECT_EQ(texelAt(unmixed, x, 20)[0] > 0.0f, texelAt(unmixed, x, 20)[2] == 0.0f) << x;
}

TEST_F(SurfaceRasterLayers, FromHeightsAreAllThatFollowsFromThem)
{
    // Down to the east.
    const std::string file =
        raster(60, 40).fill([](int column, int, int) { return -5.0 * column; }).write(_folder / "r.tif");
    const osg::ref_ptr<SurfaceData> data = dem(file);
    ASSERT_TRUE(data);
    EXPECT_EQ(data->getOrigin(), _frame.origin.place());
    EXPECT_EQ(data->getLow(), osg::Vec2d(0.0, -400.0));
    EXPECT_EQ(data->getHigh(), osg::Vec2d(600.0, 0.0));
    ASSERT_EQ(data->getNumLayers(), 5);
    const std::pair<const char*, SurfaceData::Kind> expected[] = {{"height", SurfaceData::HEIGHT},
                                                                  {"normal", SurfaceData::NORMAL},
                                                                  {"slope", SurfaceData::SLOPE},
                                                                  {"aspect", SurfaceData::ASPECT},
                                                                  {"occlusion", SurfaceData::OCCLUSION}};
    for (int i = 0; i < 5; ++i)
    {
        EXPECT_EQ(data->getLayerName(i), expected[i].first);
        EXPECT_EQ(data->getLayerKind(i), expected[i].second);
        EXPECT_EQ(data->getLayerImage(i)->s(), 60);
        EXPECT_EQ(data->getLayerImage(i)->t(), 40);
    }
    for (const int x : {0, 30, 59})
    {
        EXPECT_EQ(valueAt(*data->getLayerImage(0), x, 7), -5.0 * x);
        EXPECT_NEAR(valueAt(*data->getLayerImage(2), x, 7), std::atan(0.5), 1e-5);
        EXPECT_NEAR(valueAt(*data->getLayerImage(3), x, 7), osg::PI_2, 1e-5);
        const osg::Vec3d normal(std::sqrt(0.2), 0.0, std::sqrt(0.8));
        const Texel texel = texelAt(*data->getLayerImage(1), x, 7);
        EXPECT_LT((osg::Vec3d(osg::Vec3f(texel[0], texel[1], texel[2])) - normal).length(), 1e-5);
    }
    EXPECT_LT(valueAt(*data->getLayerImage(4), 30, 7), 0.97);
    const osg::ref_ptr<SurfaceData> small = dem(file, {{}, {}, 12, 100.0});
    EXPECT_EQ(small->getWidth(), 12);
    EXPECT_EQ(small->getHeight(), 8);
}

TEST_F(SurfaceRasterLayers, OfNeighbouringRectanglesFitTogether)
{
    const std::string file =
        raster(300, 200)
            .fill([](int column, int row, int) { return geofx::test::relief(column / 4.0, row / 4.0); })
            .write(_folder / "r.tif");
    SurfaceRaster::Options options;
    options.radius = 200.0;
    const auto of = [&](double left, double right)
    {
        options.low.set(left, -1500.0);
        options.high.set(right, -500.0);
        return dem(file, options);
    };
    const osg::ref_ptr<SurfaceData> both = of(500.0, 2500.0), west = of(500.0, 1500.0),
                                    east = of(1500.0, 2500.0);
    ASSERT_EQ(both->getWidth(), 200);
    ASSERT_EQ(west->getWidth(), 100);
    for (int layer = 0; layer < 5; ++layer)
    {
        // Of the sky's share, the lines along which it is looked for start elsewhere.
        const double tolerance = layer == 4 ? 0.005 : 1e-5;
        double sum = 0.0;
        for (int y = 0; y < 100; ++y)
            for (int x = 0; x < 200; ++x)
            {
                const osg::Image& part = *(x < 100 ? west : east)->getLayerImage(layer);
                const Texel a = texelAt(*both->getLayerImage(layer), x, y);
                const Texel b = texelAt(part, x % 100, y);
                for (std::size_t channel = 0; channel < 4; ++channel)
                {
                    const auto difference = static_cast<double>(a[channel]) - static_cast<double>(b[channel]);
                    ASSERT_NEAR(difference, 0.0, tolerance) << layer << " " << x << " " << y;
                    sum += difference;
                }
            }
        EXPECT_NEAR(sum / 20000.0, 0.0, 1e-4) << layer;
    }
}

TEST_F(SurfaceRasterLayers, OfOahuAreItsMountainsAndTheSea)
{
    _frame = globeAt(-157.80, 21.27);
    SurfaceRaster::Options options;
    options.low.set(-6000.0, -6000.0);
    options.high.set(6000.0, 6000.0);
    const osg::ref_ptr<SurfaceData> data = dem(elevation, options);
    ASSERT_TRUE(data);
    EXPECT_NEAR(data->getSpacing().x(), 30.0, 2.0);
    std::string error;
    ASSERT_TRUE(SurfaceRaster::addLayer(*data, "cover", SurfaceData::COLOR, landCover, _frame, error))
        << error;
    ASSERT_TRUE(SurfaceRaster::addLayer(*data, "class", SurfaceData::CLASS, landCover, _frame, error))
        << error;
    const auto at = [&](const char* layer, double longitude, double latitude)
    {
        const auto [x, y] = texelOf(*data, placeOf(_frame, longitude, latitude));
        return texelAt(*data->getLayerImage(data->findLayer(layer)), x, y);
    };
    // Off Waikiki; and the highest point of Diamond Head's rim, within its 200 m.
    EXPECT_EQ(at("height", -157.84, 21.26), (Texel{0.0f, 0.0f, 0.0f, 1.0f}));
    EXPECT_EQ(at("aspect", -157.84, 21.26), Texel());
    EXPECT_GT(at("occlusion", -157.84, 21.26)[0], 0.99f);
    double rim = 0.0, steepest = 0.0, darkest = 1.0;
    for (double longitude = -157.815; longitude < -157.800; longitude += 0.0003)
        for (double latitude = 21.253; latitude < 21.270; latitude += 0.0003)
        {
            rim = std::max(rim, static_cast<double>(at("height", longitude, latitude)[0]));
            steepest = std::max(steepest, static_cast<double>(at("slope", longitude, latitude)[0]));
            darkest = std::min(darkest, static_cast<double>(at("occlusion", longitude, latitude)[0]));
        }
    EXPECT_NEAR(rim, 195.0, 10.0);
    EXPECT_GT(steepest, DegreesToRadians(25.0));
    EXPECT_LT(darkest, 0.9);
    EXPECT_EQ(at("cover", -157.84, 21.26)[3], 1.0f);
    EXPECT_EQ(at("class", -157.84, 21.26)[0], at("class", -157.82, 21.25)[0]) << "the sea";
}

TEST_F(SurfaceRasterLayers, OfNoUseAreToldWithFileAndMend)
{
    const std::string good = raster(60, 40).write(_folder / "good.tif");
    const std::string missing = (_folder / "none.tif").string();
    holds(sentenceOf(missing, SurfaceData::HEIGHT), "there is no such file");
    holds(sentenceOf(TestRaster(4, 4).crs("EPSG:4326").write(_folder / "a.tif"), SurfaceData::HEIGHT),
          "gdal_translate -a_ullr");
    holds(sentenceOf(raster(4, 4, 1, GDT_Float32).write(_folder / "d.tif"), SurfaceData::COLOR),
          "are not colors");
    holds(sentenceOf(good, SurfaceData::NORMAL), "derive them");
    holds(sentenceOf(good, SurfaceData::ASPECT), "derive them");
    const auto addedTo = [&](const std::string& name, int side, const MappingFrame& frame)
    {
        return sentenceOf(
            good, [&](std::string& error)
            { return SurfaceRaster::addLayer(*_data, name, SurfaceData::HEIGHT, good, frame, error, side); });
    };
    holds(addedTo("", 1024, _frame), "give it one");
    for (const int side : {0, -3, 16385})
        holds(addedTo("x", side, _frame), "give 1 to 16384");
    MappingFrame nowhere = _frame;
    nowhere.wkt = "";
    holds(addedTo("x", 1024, nowhere), "the terrain has no coordinate system");
    added(SurfaceData::HEIGHT, good);
    holds(addedTo("layer 0", 1024, _frame), "remove that one");
    const std::string beside =
        TestRaster(4, 4).placed(700000.0, 2300000.0, 10.0, 10.0).crs("EPSG:32604").write(_folder / "e.tif");
    holds(sentenceOf(beside, SurfaceData::HEIGHT), "nothing in the rectangle");
    // A file that is cut short.
    const std::string whole = raster(400, 400)
                                  .fill([](int column, int row, int) { return std::sin(column * row); })
                                  .write(_folder / "f.tif");
    std::filesystem::resize_file(whole, std::filesystem::file_size(whole) / 20);
    holds(sentenceOf(whole, SurfaceData::HEIGHT), "copy or export it again");

    const auto demOf = [&](const std::string& file, const SurfaceRaster::Options& options)
    {
        return sentenceOf(file, [&](std::string& error)
                          { return SurfaceRaster::fromDem(file, _frame, options, error).valid(); });
    };
    holds(demOf(missing, {}), "there is no such file");
    holds(demOf(good, {{}, {}, 0, 100.0}), "give 1 to 16384");
    holds(demOf(good, {{}, {}, 100, -1.0}), "give 0 metres or more");
    holds(demOf(good, {{}, {}, 100, none}), "give 0 metres or more");
    holds(demOf(good, {osg::Vec2d(10.0, 10.0), osg::Vec2d(0.0, 20.0)}), "the lower corner first");
    holds(demOf(good, {osg::Vec2d(10.0, 10.0), osg::Vec2d(none, 20.0)}), "the lower corner first");
    holds(demOf(good, {osg::Vec2d(9000.0, 10.0), osg::Vec2d(9900.0, 20.0)}), "nothing in the rectangle");
}

} // namespace
