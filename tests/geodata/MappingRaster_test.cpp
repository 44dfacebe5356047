// SPDX-License-Identifier: MIT
// SPDX-FileCopyrightText: 2026 the osgGeoFX authors
//
// Rasters with a georeference in the frames of mappings. Where things must lie, GeographicLib says for globes and a
// transformation of the test's own for projected terrains.
#include <osgGeoFX/geodata/MappingRaster.h>
#include <tools/GeofxPlugins.h>
#include <tools/RandomSamples.h>
#include <tools/TempDir.h>
#include <tools/TestRasters.h>

#include <GeographicLib/LocalCartesian.hpp>
#include <gdal_priv.h>
#include <osg/Math>

#include <algorithm>
#include <cmath>
#include <memory>
#include <set>

namespace
{

using geofx::test::Random;
using geofx::test::TempDir;
using geofx::test::TestRaster;
using osg::DegreesToRadians;
using osgGeoFX::DataLayer;
using osgGeoFX::MappingFrame;
using osgGeoFX::MappingRaster;

using Transform = std::array<double, 6>;

struct CrsTransformation
{
    CrsTransformation(const std::string& from, const std::string& to)
    {
        OGRSpatialReference a, b;
        EXPECT_EQ(a.SetFromUserInput(from.c_str()), OGRERR_NONE);
        EXPECT_EQ(b.SetFromUserInput(to.c_str()), OGRERR_NONE);
        a.SetAxisMappingStrategy(OAMS_TRADITIONAL_GIS_ORDER);
        b.SetAxisMappingStrategy(OAMS_TRADITIONAL_GIS_ORDER);
        _transformation.reset(OGRCreateCoordinateTransformation(&a, &b));
        EXPECT_TRUE(_transformation);
    }
    osg::Vec2d operator()(osg::Vec2d place) const
    {
        EXPECT_TRUE(_transformation->Transform(1, &place.x(), &place.y()));
        return place;
    }

private:
    std::unique_ptr<OGRCoordinateTransformation> _transformation;
};

MappingFrame globeAt(double longitude, double latitude)
{
    MappingFrame frame;
    frame.origin = osgGeoFX::LocalOrigin::onGlobe(DegreesToRadians(longitude), DegreesToRadians(latitude));
    return frame;
}

MappingFrame projected(int epsg, const osg::Vec2d& origin)
{
    MappingFrame frame;
    frame.globe = false;
    frame.wkt = geofx::test::wktOf(epsg);
    frame.origin = osgGeoFX::LocalOrigin::onPlane(origin);
    return frame;
}

/// A raster of one band, and how it lies.
struct Sample
{
    const char* name;
    const char* crs;
    Transform transform;
    int columns;
    int rows;
    MappingFrame frame;
    std::string terrain; ///< the CRS of a projected one
};

std::ostream& operator<<(std::ostream& stream, const Sample& sample)
{
    return stream << sample.name;
}

osg::Vec2d applied(const Transform& t, double x, double y)
{
    return {t[0] + t[1] * x + t[2] * y, t[3] + t[4] * x + t[5] * y};
}

/// The value of a layer at a place of the frame, mixed between texels; nothing beyond their centers.
double valueAt(const MappingRaster& raster, const osg::Vec2d& place)
{
    const osg::Image& image = *raster.layer->getImage();
    const osg::Vec2d size = raster.high - raster.low;
    const double x = (place.x() - raster.low.x()) / size.x() * image.s() - 0.5;
    const double y = (place.y() - raster.low.y()) / size.y() * image.t() - 0.5;
    const int column = static_cast<int>(std::floor(x));
    const int row = static_cast<int>(std::floor(y));
    if (column < 0 || row < 0 || column + 1 >= image.s() || row + 1 >= image.t())
        return std::numeric_limits<double>::quiet_NaN();
    const auto texel = [&](int i, int j)
    {
        return static_cast<double>(*reinterpret_cast<const float*>(
            image.data(static_cast<unsigned int>(i), static_cast<unsigned int>(j))));
    };
    const double u = x - column;
    const double v = y - row;
    return (1.0 - v) * ((1.0 - u) * texel(column, row) + u * texel(column + 1, row)) +
           v * ((1.0 - u) * texel(column, row + 1) + u * texel(column + 1, row + 1));
}

/// RGBA of the texel at a place.
std::array<int, 4> colorAt(const MappingRaster& raster, const osg::Vec2d& place)
{
    const osg::Image& image = *raster.layer->getImage();
    const osg::Vec2d size = raster.high - raster.low;
    const auto index = [](double share, int count)
    {
        return static_cast<unsigned int>(
            std::clamp(static_cast<int>(std::floor(share * count)), 0, count - 1));
    };
    const unsigned char* texel = image.data(index((place.x() - raster.low.x()) / size.x(), image.s()),
                                            index((place.y() - raster.low.y()) / size.y(), image.t()));
    return {texel[0], texel[1], texel[2], texel[3]};
}

MappingRaster readGood(const std::string& file, const MappingFrame& frame,
                       const MappingRaster::Options& options = {})
{
    std::string error;
    const std::optional<MappingRaster> raster = MappingRaster::read(file, frame, options, error);
    EXPECT_TRUE(raster) << error;
    EXPECT_EQ(error, "");
    return raster.value_or(MappingRaster());
}

class MappingRasterPlace : public testing::TestWithParam<Sample>
{
protected:
    void SetUp() override
    {
        GDALAllRegister();
        _toGeodetic = std::make_unique<CrsTransformation>(GetParam().crs, "EPSG:4326");
        if (!GetParam().frame.globe)
            _toTerrain = std::make_unique<CrsTransformation>(GetParam().crs, GetParam().terrain);
    }

    /// The place in the frame of a raster's pixel, by way of other libraries.
    osg::Vec2d placeOf(double column, double row) const
    {
        const Sample& sample = GetParam();
        const osg::Vec2d there = applied(sample.transform, column, row);
        if (!sample.frame.globe) return (*_toTerrain)(there)-sample.frame.origin.place();
        const osg::Vec2d geodetic = (*_toGeodetic)(there);
        const GeographicLib::LocalCartesian frame(osg::RadiansToDegrees(sample.frame.origin.latitude),
                                                  osg::RadiansToDegrees(sample.frame.origin.longitude), 0.0);
        double x = 0.0, y = 0.0, z = 0.0;
        frame.Forward(geodetic.y(), geodetic.x(), 0.0, x, y, z);
        return {x, y};
    }

    const TempDir _folder;

private:
    std::unique_ptr<CrsTransformation> _toGeodetic, _toTerrain;
};

// A 30 m grid of Oahu in several coordinate systems, seen from near and far, and rasters at awkward places.
INSTANTIATE_TEST_SUITE_P(All, MappingRasterPlace,
                         testing::Values(Sample{"GeographicOnGlobe",
                                                "EPSG:4326",
                                                {-158.0, 0.0003, 0.0, 21.5, 0.0, -0.0003},
                                                300,
                                                200,
                                                globeAt(-157.95, 21.47),
                                                ""},
                                         Sample{"GeographicFarFromTheOrigin",
                                                "EPSG:4326",
                                                {-158.0, 0.001, 0.0, 21.5, 0.0, -0.001},
                                                300,
                                                200,
                                                globeAt(-155.0, 19.0),
                                                ""},
                                         Sample{"UtmOnGlobe",
                                                "EPSG:32604",
                                                {600000.0, 30.0, 0.0, 2370000.0, 0.0, -30.0},
                                                300,
                                                200,
                                                globeAt(-158.0, 21.4),
                                                ""},
                                         Sample{"RotatedOnGlobe",
                                                "EPSG:32604",
                                                {600000.0, 26.0, 15.0, 2370000.0, 15.0, -26.0},
                                                300,
                                                200,
                                                globeAt(-157.9, 21.4),
                                                ""},
                                         Sample{"SouthUpOnGlobe",
                                                "EPSG:32604",
                                                {600000.0, 30.0, 0.0, 2360000.0, 0.0, 30.0},
                                                200,
                                                300,
                                                globeAt(-157.9, 21.4),
                                                ""},
                                         Sample{"WebMercatorOnGlobe",
                                                "EPSG:3857",
                                                {-17580000.0, 40.0, 0.0, 2440000.0, 0.0, -40.0},
                                                300,
                                                200,
                                                globeAt(-157.9, 21.4),
                                                ""},
                                         Sample{"OldDatumOnGlobe",
                                                "EPSG:31467",
                                                {3500000.0, 25.0, 0.0, 5800000.0, 0.0, -25.0},
                                                200,
                                                200,
                                                globeAt(9.0, 52.3),
                                                ""},
                                         Sample{"AcrossTheAntimeridian",
                                                "EPSG:4326",
                                                {179.9, 0.001, 0.0, -16.5, 0.0, -0.001},
                                                300,
                                                200,
                                                globeAt(-179.95, -16.6),
                                                ""},
                                         Sample{"AroundThePole",
                                                "EPSG:3995",
                                                {-50000.0, 500.0, 0.0, 50000.0, 0.0, -500.0},
                                                200,
                                                200,
                                                globeAt(30.0, 89.9),
                                                ""},
                                         Sample{"GeographicOnUtm",
                                                "EPSG:4326",
                                                {-158.0, 0.0003, 0.0, 21.5, 0.0, -0.0003},
                                                300,
                                                200,
                                                projected(32604, osg::Vec2d(605000.0, 2370000.0)),
                                                "EPSG:32604"},
                                         Sample{"UtmOnUtm",
                                                "EPSG:32604",
                                                {600000.0, 30.0, 0.0, 2370000.0, 0.0, -30.0},
                                                300,
                                                200,
                                                projected(32604, osg::Vec2d(600000.0, 2300000.0)),
                                                "EPSG:32604"},
                                         Sample{"RotatedOnUtm",
                                                "EPSG:32605",
                                                {200000.0, 26.0, 15.0, 2370000.0, 15.0, -26.0},
                                                300,
                                                200,
                                                projected(32604, osg::Vec2d(600000.0, 2300000.0)),
                                                "EPSG:32604"}),
                         [](const auto& sample) { return std::string(sample.param.name); });

TEST_P(MappingRasterPlace, ValuesLieWhereOtherLibrariesSay)
{
    const Sample& sample = GetParam();
    // Linear, so that neither warping nor mixing changes a value that is in its place.
    const auto field = [](double column, double row)
    {
        return 10.0 * column - 7.0 * row + 500.0;
    };
    const std::string file =
        TestRaster(sample.columns, sample.rows)
            .geoTransform(sample.transform)
            .crs(sample.crs)
            .fill([&](int column, int row, int) { return field(column + 0.5, row + 0.5); })
            .write(_folder / "r.tif");
    const MappingRaster raster = readGood(file, sample.frame);
    ASSERT_TRUE(raster.layer);
    EXPECT_EQ(raster.layer->getKind(), DataLayer::VALUE);

    // The rectangle is that of the raster's edges, to half a texel.
    osg::Vec2d low(1e30, 1e30), high(-1e30, -1e30);
    for (int i = 0; i <= 400; ++i)
    {
        const double column = sample.columns * i / 400.0;
        const double row = sample.rows * i / 400.0;
        for (const osg::Vec2d& place : {placeOf(column, 0.0), placeOf(column, sample.rows), placeOf(0.0, row),
                                        placeOf(sample.columns, row)})
        {
            low.set(std::min(low.x(), place.x()), std::min(low.y(), place.y()));
            high.set(std::max(high.x(), place.x()), std::max(high.y(), place.y()));
        }
    }
    const osg::Vec2d size = raster.high - raster.low;
    const osg::Vec2d texel(size.x() / raster.layer->getImage()->s(),
                           size.y() / raster.layer->getImage()->t());
    EXPECT_NEAR(raster.low.x(), low.x(), texel.x() / 20.0);
    EXPECT_NEAR(raster.low.y(), low.y(), texel.y() / 20.0);
    EXPECT_NEAR(raster.high.x(), high.x(), texel.x() / 20.0);
    EXPECT_NEAR(raster.high.y(), high.y(), texel.y() / 20.0);
    // Its resolution stays.
    const double pixels = std::sqrt(static_cast<double>(sample.columns) * sample.rows);
    EXPECT_GT(std::hypot(raster.layer->getImage()->s(), raster.layer->getImage()->t()), pixels);

    double worst = 0.0;
    double sum = 0.0;
    constexpr int samples = 2000;
    for (int i = 0; i < samples; ++i)
    {
        Random random(static_cast<std::uint64_t>(i));
        const double column = random.uniform(5.0, sample.columns - 5.0);
        const double row = random.uniform(5.0, sample.rows - 5.0);
        const double value = valueAt(raster, placeOf(column, row));
        ASSERT_FALSE(std::isnan(value)) << "sample " << i;
        const double error = value - field(column, row);
        worst = std::max(worst, std::abs(error));
        sum += error;
    }
    // Along the steepest way, a tenth of a pixel: GDAL's kernel for turned rasters does not give a slope back exactly. On
    // the average it does, so that nothing is displaced.
    const double slope = std::hypot(10.0, 7.0);
    EXPECT_LT(worst, 0.1 * slope);
    EXPECT_NEAR(sum / samples, 0.0, 0.01 * slope);
    EXPECT_NEAR(raster.lowest, field(0.5, sample.rows - 0.5), 20.0);
    EXPECT_NEAR(raster.highest, field(sample.columns - 0.5, 0.5), 20.0);

    // The mapping has the rectangle.
    const osg::ref_ptr<osgGeoFX::ProjectiveMapping> mapping = new osgGeoFX::ProjectiveMapping;
    EXPECT_TRUE(raster.apply(*mapping));
    EXPECT_EQ(mapping->getLayer(), raster.layer);
    const auto outline = mapping->outline();
    ASSERT_TRUE(outline);
    EXPECT_LT((outline->corners[0] - raster.low).length(), 1e-6);
    EXPECT_LT((outline->corners[2] - raster.high).length(), 1e-6);

    // And the middle is the raster's.
    MappingFrame frame = sample.frame;
    std::string error;
    ASSERT_TRUE(MappingRaster::moveToMiddle(file, frame, error)) << error;
    const osg::Vec2d middle = placeOf(sample.columns / 2.0, sample.rows / 2.0);
    if (frame.globe)
    {
        double x = 0.0, y = 0.0, z = 0.0;
        GeographicLib::LocalCartesian(osg::RadiansToDegrees(sample.frame.origin.latitude),
                                      osg::RadiansToDegrees(sample.frame.origin.longitude), 0.0)
            .Forward(osg::RadiansToDegrees(frame.origin.latitude),
                     osg::RadiansToDegrees(frame.origin.longitude), 0.0, x, y, z);
        EXPECT_LT((osg::Vec2d(x, y) - middle).length(), 1e-3);
    }
    else
    {
        EXPECT_LT((frame.origin.place() - sample.frame.origin.place() - middle).length(), 1e-3);
    }
}

/// What does not depend on the place: a raster of 1 km about an origin on a UTM terrain.
class MappingRasterValues : public testing::Test
{
protected:
    void SetUp() override { GDALAllRegister(); }

    static TestRaster raster(int columns, int rows, int bands = 1, GDALDataType type = GDT_Float32)
    {
        TestRaster result(columns, rows, bands, type);
        result.placed(600000.0, 2300000.0, 10.0, 10.0).crs("EPSG:32604");
        return result;
    }

    MappingRaster readBack(TestRaster& source, const MappingRaster::Options& options = {})
    {
        return readGood(source.write(_folder / "r.tif"), _frame, options);
    }

    /// The center of a pixel of raster() in the frame.
    static osg::Vec2d pixel(int column, int row) { return {10.0 * column + 5.0, -10.0 * row - 5.0}; }

    double value(const MappingRaster& read, int column, int row) const
    {
        const unsigned char* texel =
            read.layer->getImage()->data(static_cast<unsigned int>(column),
                                         static_cast<unsigned int>(read.layer->getImage()->t() - 1 - row));
        return static_cast<double>(*reinterpret_cast<const float*>(texel));
    }

    std::string messageOf(const std::string& file, const MappingFrame& frame)
    {
        std::string error;
        EXPECT_FALSE(MappingRaster::read(file, frame, {}, error));
        EXPECT_EQ(error.rfind(file + ": ", 0), 0u) << error;
        EXPECT_EQ(error.back(), '.') << error;
        return error;
    }

    const TempDir _folder;
    const MappingFrame _frame = projected(32604, osg::Vec2d(600000.0, 2300000.0));
};

TEST_F(MappingRasterValues, AreTheFilesInTheirOwnCoordinateSystem)
{
    for (const GDALDataType type :
         {GDT_Byte, GDT_UInt16, GDT_Int16, GDT_UInt32, GDT_Int32, GDT_Float32, GDT_Float64})
    {
        SCOPED_TRACE(GDALGetDataTypeName(type));
        TestRaster source = raster(9, 5, 1, type);
        source.fill([](int column, int row, int) { return 20.0 * column + row; });
        const MappingRaster read = readBack(source);
        ASSERT_EQ(read.layer->getImage()->s(), 9);
        ASSERT_EQ(read.layer->getImage()->t(), 5);
        EXPECT_EQ(read.low, osg::Vec2d(0.0, -50.0));
        EXPECT_EQ(read.high, osg::Vec2d(90.0, 0.0));
        for (int row = 0; row < 5; ++row)
            for (int column = 0; column < 9; ++column)
                EXPECT_NEAR(value(read, column, row), 20.0 * column + row, 1e-3) << column << " " << row;
        EXPECT_NEAR(read.lowest, 0.0, 1e-3);
        EXPECT_NEAR(read.highest, 164.0, 1e-3);
    }
}

TEST_F(MappingRasterValues, WithoutDataAreNaN)
{
    const auto hole = [](int column, int row)
    {
        return column >= 3 && column < 6 && row >= 1 && row < 3;
    };
    for (const std::string way : {"value", "alpha", "mask"})
    {
        SCOPED_TRACE(way);
        TestRaster source = raster(9, 5, way == "alpha" ? 2 : 1, GDT_UInt16);
        source.fill(
            [&](int column, int row, int band)
            {
                if (band == 1) return hole(column, row) ? 0.0 : 65535.0;
                return hole(column, row) ? 9999.0 : 5.0;
            });
        GDALRasterBand* last = source.dataset().GetRasterBand(source.dataset().GetRasterCount());
        if (way == "value") last->SetNoDataValue(9999.0);
        if (way == "alpha") last->SetColorInterpretation(GCI_AlphaBand);
        if (way == "mask")
        {
            ASSERT_EQ(source.dataset().CreateMaskBand(GMF_PER_DATASET), CE_None);
            std::vector<unsigned char> bytes;
            for (int i = 0; i < 45; ++i)
                bytes.push_back(hole(i % 9, i / 9) ? 0 : 255);
            ASSERT_EQ(last->GetMaskBand()->RasterIO(GF_Write, 0, 0, 9, 5, bytes.data(), 9, 5, GDT_Byte, 0, 0,
                                                    nullptr),
                      CE_None);
        }
        const MappingRaster read = readBack(source);
        for (int row = 0; row < 5; ++row)
        {
            for (int column = 0; column < 9; ++column)
            {
                if (hole(column, row))
                    EXPECT_TRUE(std::isnan(value(read, column, row))) << column << " " << row;
                else
                    EXPECT_NEAR(value(read, column, row), 5.0, 1e-6) << column << " " << row;
            }
        }
        EXPECT_NEAR(read.lowest, 5.0, 1e-6);
        EXPECT_NEAR(read.highest, 5.0, 1e-6);
    }
}

// A satellite above the equator sees half of the Earth; GDAL finds no place in its picture for a window of the other half.
TEST_F(MappingRasterValues, BeyondTheHorizonOfASatelliteAreNaN)
{
    TestRaster source(60, 60);
    source.placed(-5.5e6, 5.5e6, 1.1e7 / 60.0, 1.1e7 / 60.0)
        .crs("+proj=geos +h=35785831 +lon_0=0 +sweep=y +ellps=WGS84 +units=m")
        .fill([](int, int, int) { return 200.0; });
    const std::string file = source.write(_folder / "disk.tif");
    MappingRaster::Options options;
    options.window = MappingRaster::Window{{-1e5, -1e5}, {1e5, 1e5}, 1e4};
    std::string error;
    const auto seen = MappingRaster::read(file, globeAt(10.0, 20.0), options, error);
    ASSERT_TRUE(seen) << error;
    const auto hidden = MappingRaster::read(file, globeAt(170.0, 20.0), options, error);
    ASSERT_TRUE(hidden) << error;
    for (int row = 0; row < 20; ++row)
        for (int column = 0; column < 20; ++column)
        {
            EXPECT_NEAR(value(*seen, column, row), 200.0, 1e-6) << column << " " << row;
            EXPECT_TRUE(std::isnan(value(*hidden, column, row))) << column << " " << row;
        }
}

// Rounded degrees add up to a little more than a circle, and some files repeat the first column.
TEST_F(MappingRasterValues, GoAroundTheGlobeAlsoWhereTheyAreMoreThanACircle)
{
    for (const int columns : {54, 55})
    {
        SCOPED_TRACE(columns);
        TestRaster source(columns, 27);
        source.placed(20.0, 90.0, 6.66667, 6.66667)
            .crs("EPSG:4326")
            .fill([](int column, int, int) { return 100.0 + column % 54; });
        const std::string file = source.write(_folder / "around.tif");
        MappingRaster::Options options;
        options.window = MappingRaster::Window{{-1e4, -1e4}, {1e4, 1e4}, 1e3};
        for (const int column : {0, 20, 26, 40, 53})
        {
            std::string error;
            const double longitude = 20.0 + (column + 0.5) * 6.66667;
            const auto read =
                MappingRaster::read(file, globeAt(std::remainder(longitude, 360.0), 10.0), options, error);
            ASSERT_TRUE(read) << error;
            EXPECT_NEAR(value(*read, 10, 10), 100.0 + column, 0.1) << column;
        }
    }
}

TEST_F(MappingRasterValues, AroundATurnedRasterAreNaN)
{
    TestRaster source(20, 20);
    source.geoTransform({600000.0, 10.0, 10.0, 2300000.0, 10.0, -10.0})
        .crs("EPSG:32604")
        .fill([](int, int, int) { return 5.0; });
    const MappingRaster read = readBack(source);
    const int last = read.layer->getImage()->s() - 1;
    EXPECT_TRUE(std::isnan(value(read, 0, 0)));
    EXPECT_TRUE(std::isnan(value(read, last, last)));
    EXPECT_NEAR(value(read, last / 2, last / 2), 5.0, 1e-6);
}

TEST_F(MappingRasterValues, AreScaledAsTheFileSays)
{
    TestRaster source = raster(4, 4, 1, GDT_Int16);
    source.fill([](int column, int row, int) { return column == 0 && row == 0 ? -1.0 : 100.0; });
    source.dataset().GetRasterBand(1)->SetScale(0.5);
    source.dataset().GetRasterBand(1)->SetOffset(-3.0);
    source.dataset().GetRasterBand(1)->SetNoDataValue(-1.0);
    const MappingRaster read = readBack(source);
    EXPECT_NEAR(value(read, 2, 2), 47.0, 1e-6);
    EXPECT_TRUE(std::isnan(value(read, 0, 0))) << "no data is told of the numbers in the file";
}

TEST_F(MappingRasterValues, OfClassesAreNeverMixed)
{
    const std::set<double> classes = {3.0, 90.0, 700.0};
    TestRaster source(60, 60, 1, GDT_UInt16);
    source.geoTransform({600000.0, 8.0, 5.0, 2300000.0, 5.0, -8.0})
        .crs("EPSG:32604")
        .fill([&](int column, int row, int)
              { return *std::next(classes.begin(), (column / 3 + row / 3) % 3); });
    for (const int side : {2048, 20})
    {
        const MappingRaster read = readBack(source, {DataLayer::CLASS, side});
        EXPECT_EQ(read.layer->getKind(), DataLayer::CLASS);
        std::set<double> found;
        for (int row = 0; row < read.layer->getImage()->t(); ++row)
        {
            for (int column = 0; column < read.layer->getImage()->s(); ++column)
            {
                const double each = value(read, column, row);
                if (!std::isnan(each)) found.insert(each);
            }
        }
        EXPECT_EQ(found, classes);
    }
}

TEST_F(MappingRasterValues, ComeFromOverviewsWhereTexelsAreFew)
{
    TestRaster source = raster(512, 256);
    source.fill([](int, int, int) { return 1.0; });
    const std::string file = source.write(_folder / "big.tif");
    {
        const geofx::test::DatasetPtr dataset(
            GDALDataset::Open(file.c_str(), GDAL_OF_RASTER | GDAL_OF_UPDATE));
        int factors[] = {4};
        ASSERT_EQ(dataset->BuildOverviews("NEAREST", 1, factors, 0, nullptr, nullptr, nullptr), CE_None);
        // An overview that tells of itself.
        ASSERT_EQ(dataset->GetRasterBand(1)->GetOverview(0)->Fill(7.0), CE_None);
    }
    const MappingRaster small = readGood(file, _frame, {std::nullopt, 100});
    EXPECT_EQ(small.layer->getImage()->s(), 100);
    EXPECT_EQ(small.layer->getImage()->t(), 50);
    EXPECT_EQ(small.low, osg::Vec2d(0.0, -2560.0));
    EXPECT_EQ(small.high, osg::Vec2d(5120.0, 0.0));
    EXPECT_NEAR(value(small, 50, 25), 7.0, 1e-6);
    const MappingRaster whole = readGood(file, _frame);
    EXPECT_EQ(whole.layer->getImage()->s(), 512);
    EXPECT_NEAR(value(whole, 50, 25), 1.0, 1e-6);
    EXPECT_EQ(readGood(file, _frame, {std::nullopt, 1}).layer->getImage()->s(), 1);
}

TEST_F(MappingRasterValues, OfSeveralBandsAreColors)
{
    for (const GDALDataType type : {GDT_Byte, GDT_UInt16})
    {
        const double most = type == GDT_Byte ? 255.0 : 65535.0;
        for (const int bands : {3, 4})
        {
            TestRaster source = raster(8, 4, bands, type);
            source.fill(
                [&](int column, int row, int band) {
                    return band == 3 ? (column < 4 ? most : 0.0)
                                     : most / 255.0 * (20 * column + 3 * row + 50 * band);
                });
            if (bands == 4) source.dataset().GetRasterBand(4)->SetColorInterpretation(GCI_AlphaBand);
            const MappingRaster read = readBack(source);
            EXPECT_EQ(read.layer->getKind(), DataLayer::COLOR);
            EXPECT_EQ(colorAt(read, pixel(2, 1)), (std::array<int, 4>{43, 93, 143, 255}));
            if (bands == 4)
                EXPECT_EQ(colorAt(read, pixel(6, 1))[3], 0);
            else
                EXPECT_EQ(colorAt(read, pixel(6, 1)), (std::array<int, 4>{123, 173, 223, 255}));
        }
    }
    // Black that means no data is transparent.
    TestRaster source = raster(8, 4, 3, GDT_Byte);
    source.fill([](int column, int, int) { return column < 4 ? 0.0 : 200.0; });
    for (int band = 1; band <= 3; ++band)
        source.dataset().GetRasterBand(band)->SetNoDataValue(0.0);
    const MappingRaster read = readBack(source);
    EXPECT_EQ(colorAt(read, pixel(1, 1))[3], 0);
    EXPECT_EQ(colorAt(read, pixel(6, 1)), (std::array<int, 4>{200, 200, 200, 255}));
}

TEST_F(MappingRasterValues, OfAPaletteAreColors)
{
    TestRaster source = raster(8, 4, 1, GDT_Byte);
    GDALColorTable palette;
    const GDALColorEntry red = {250, 10, 20, 255};
    const GDALColorEntry glass = {1, 2, 3, 100};
    palette.SetColorEntry(5, &red);
    palette.SetColorEntry(9, &glass);
    source.dataset().GetRasterBand(1)->SetColorTable(&palette);
    source.fill([](int column, int, int) { return column < 4 ? 5.0 : 9.0; });
    const MappingRaster read = readBack(source);
    EXPECT_EQ(read.layer->getKind(), DataLayer::COLOR);
    EXPECT_EQ(colorAt(read, pixel(1, 1)), (std::array<int, 4>{250, 10, 20, 255}));
    EXPECT_EQ(colorAt(read, pixel(2, 3)), colorAt(read, pixel(3, 0))) << "palettes are not mixed";
    const MappingRaster classes = readBack(source, {DataLayer::CLASS, 2048});
    EXPECT_EQ(value(classes, 1, 1), 5.0);
    EXPECT_EQ(value(classes, 6, 1), 9.0);
    // One band of bytes may be a grey picture, when asked for.
    TestRaster grey = raster(8, 4, 1, GDT_Byte);
    grey.fill([](int column, int, int) { return 30.0 * column; });
    EXPECT_EQ(colorAt(readBack(grey, {DataLayer::COLOR, 2048}), pixel(3, 1)),
              (std::array<int, 4>{90, 90, 90, 255}));
}

/// While it lives, GDAL writes masks into the GeoTIFF itself, as most orthophotos have them.
struct InternalMasks
{
    InternalMasks() { CPLSetConfigOption("GDAL_TIFF_INTERNAL_MASK", "YES"); }
    ~InternalMasks() { CPLSetConfigOption("GDAL_TIFF_INTERNAL_MASK", nullptr); }
};

TEST_F(MappingRasterValues, OfAMaskedOrthophotoWithOverviewsAreColors)
{
    for (const bool overviews : {false, true})
    {
        TestRaster source = raster(512, 256, 3, GDT_Byte);
        source.fill([](int, int, int) { return 120.0; });
        const std::string file = source.write(_folder / (overviews ? "overviews.tif" : "plain.tif"));
        {
            const InternalMasks internal;
            const geofx::test::DatasetPtr dataset(
                GDALDataset::Open(file.c_str(), GDAL_OF_RASTER | GDAL_OF_UPDATE));
            ASSERT_EQ(dataset->CreateMaskBand(GMF_PER_DATASET), CE_None);
            std::vector<unsigned char> mask(512 * 256, 255);
            for (std::size_t i = 0; i < mask.size(); ++i)
                if (i % 512 < 256) mask[i] = 0;
            ASSERT_EQ(dataset->GetRasterBand(1)->GetMaskBand()->RasterIO(
                          GF_Write, 0, 0, 512, 256, mask.data(), 512, 256, GDT_Byte, 0, 0, nullptr),
                      CE_None);
            int factors[] = {2, 4, 8};
            if (overviews)
            {
                ASSERT_EQ(dataset->BuildOverviews("AVERAGE", 3, factors, 0, nullptr, nullptr, nullptr),
                          CE_None);
            }
        }
        // Each life of the reader ends with all that is below it.
        for (const int side : {2048, 100, 40})
        {
            const MappingRaster read = readGood(file, _frame, {std::nullopt, side});
            ASSERT_EQ(read.layer->getKind(), DataLayer::COLOR);
            const osg::Image& image = *read.layer->getImage();
            for (int i = 0; i < 5; ++i)
            {
                const int row = (2 * i + 1) * image.t() / 10;
                EXPECT_EQ(image.data(image.s() / 5, row)[3], 0) << side;
                const unsigned char* const shown = image.data(4 * image.s() / 5, row);
                EXPECT_EQ(shown[0], 120) << side;
                EXPECT_EQ(shown[3], 255) << side;
            }
        }
    }
}

TEST_F(MappingRasterValues, ByControlPointsAndOfTheWholeEarth)
{
    TestRaster turned(50, 50);
    turned.placedByPoints(-158.0, 21.5, 0.001)
        .fill([](int column, int row, int) { return 10.0 * column + row; });
    const MappingRaster read = readGood(turned.write(_folder / "gcp.tif"), globeAt(-158.0, 21.45));
    const GeographicLib::LocalCartesian frame(21.45, -158.0, 0.0);
    double x = 0.0, y = 0.0, z = 0.0;
    frame.Forward(21.5 - 0.001 * (30.5 + 20.5), -158.0 + 0.001 * (30.5 - 20.5), 0.0, x, y, z);
    EXPECT_NEAR(valueAt(read, osg::Vec2d(x, y)), 320.0, 1.0);

    // Of the whole Earth, half is to be seen from above an origin.
    TestRaster earth(360, 180);
    earth.placed(-180.0, 90.0, 1.0, 1.0)
        .crs("EPSG:4326")
        .fill([](int column, int row, int) { return column + 1000.0 * row; });
    const MappingRaster half = readGood(earth.write(_folder / "earth.tif"), globeAt(20.0, 10.0));
    EXPECT_NEAR(half.high.x(), 6378137.0, 150000.0);
    EXPECT_NEAR(half.low.y(), -6378137.0, 150000.0);
    GeographicLib::LocalCartesian(10.0, 20.0, 0.0).Forward(40.0, 50.0, 0.0, x, y, z);
    EXPECT_NEAR(valueAt(half, osg::Vec2d(x, y)), 229.5 + 1000.0 * 49.5, 100.0);
}

// As GMT writes them: degrees along both axes, and no datum.
TEST_F(MappingRasterValues, ByAxesInDegreesAreThoseOfWgs84)
{
    TestRaster named(6, 4), bare(6, 4);
    for (TestRaster* each : {&named, &bare})
        each->placed(10.0, 50.0, 0.01, 0.01)
            .fill([](int column, int row, int) { return column + 10.0 * row; });
    named.crs("EPSG:4326");
    const MappingFrame frame = globeAt(10.03, 49.98);
    EXPECT_NE(messageOf(bare.write(_folder / "none.tif"), frame), "");
    bare.dataset().SetMetadataItem("lon#units", "degrees_east");
    EXPECT_NE(messageOf(bare.write(_folder / "half.tif"), frame), "");
    bare.dataset().SetMetadataItem("lat#units", "degrees_north");
    const MappingRaster expected = readGood(named.write(_folder / "named.tif"), frame, {}),
                        actual = readGood(bare.write(_folder / "bare.tif"), frame, {});
    EXPECT_EQ(actual.low, expected.low);
    EXPECT_EQ(actual.high, expected.high);
    EXPECT_EQ(actual.lowest, expected.lowest);
    EXPECT_EQ(actual.highest, expected.highest);
}

TEST_F(MappingRasterValues, OfNoUseAreToldWithFileAndMend)
{
    const auto holds = [](const std::string& message, const std::string& words)
    {
        EXPECT_NE(message.find(words), std::string::npos) << message;
    };
    holds(messageOf((_folder / "none.tif").string(), _frame), "there is no such file");
    holds(messageOf(_folder.write("text.tif", "hello").string(), _frame), "check it with gdalinfo");
    holds(messageOf(TestRaster(4, 4).crs("EPSG:4326").write(_folder / "a.tif"), _frame),
          "gdal_translate -a_ullr");
    holds(messageOf(TestRaster(4, 4).placed(1.0, 2.0, 1.0, 1.0).write(_folder / "b.tif"), _frame),
          "gdal_translate -a_srs EPSG:N");
    holds(messageOf(raster(4, 4, 1, GDT_CFloat32).write(_folder / "c.tif"), _frame), "complex numbers");
    const std::string good = raster(4, 4).write(_folder / "e.tif");
    MappingFrame nowhere = _frame;
    nowhere.wkt = "";
    holds(messageOf(good, nowhere), "the terrain has no coordinate system");
    holds(messageOf(good, globeAt(20.0, -20.0)), "give the effect an origin near it");
    // A file that is cut short.
    TestRaster source = raster(400, 400);
    source.fill([](int column, int row, int) { return std::sin(column * row); });
    const std::string whole = source.write(_folder / "f.tif");
    std::filesystem::resize_file(whole, std::filesystem::file_size(whole) / 2);
    holds(messageOf(whole, _frame), "copy or export it again");
}

} // namespace
