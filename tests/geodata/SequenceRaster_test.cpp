// SPDX-License-Identifier: MIT
// SPDX-FileCopyrightText: 2026 the osgGeoFX authors
//
// Rasters in time: where their values lie, when, and what is refused. GDAL writes the data sets; where things must lie, PROJ says.
#include <osgGeoFX/geodata/SequenceRaster.h>
#include <osgGeoFX/mapping/LayerClock.h>
#include <tools/NotifyWatch.h>
#include <tools/TempDir.h>
#include <tools/TestRasters.h>

#include <gdal_priv.h>
#include <ogr_spatialref.h>
#include <osg/Math>

#include <gtest/gtest.h>

#include <cmath>
#include <filesystem>
#include <fstream>
#include <memory>
#include <optional>

using namespace osgGeoFX;
using namespace geofx::test;

namespace
{

constexpr double west = -160.0, south = 19.0;
constexpr int columns = 60, rows = 40; ///< of a tenth of a degree
constexpr double start = 1768197600.0; ///< 2026-01-12 06:00 UTC

/// A value that a bilinear filter keeps.
double valueAt(double longitude, double latitude, int step)
{
    return 100.0 * step + (longitude + 160.0) + 2.0 * (latitude - 19.0);
}

bool contains(const std::string& text, const std::string& part)
{
    return text.find(part) != std::string::npos;
}

struct Look
{
    const char* driver = "netCDF";
    const char* unit = "hours since 2026-01-12 06:00:00";
    const char* calendar = nullptr;
    bool degrees = true; ///< whether longitudes and latitudes say so
    bool southUp = false;
    double east = 0.0;       ///< added to longitudes
    int levels = 0;          ///< of another dimension
    bool kilometres = false; ///< axes of UTM in km, 2 km a cell
    bool bounds = false;     ///< attributes bound the valid values
    double scale = 1.0;      ///< with bounds: of the numbers in the file
};

std::string write(const std::filesystem::path& file, const Look& look = {})
{
    GDALAllRegister();
    const DatasetPtr dataset(GetGDALDriverManager()
                                 ->GetDriverByName(look.driver)
                                 ->CreateMultiDimensional(file.c_str(), nullptr, nullptr));
    EXPECT_TRUE(dataset);
    const std::shared_ptr<GDALGroup> root = dataset->GetRootGroup();
    const auto numbers = GDALExtendedDataType::Create(GDT_Float64);
    const auto dimension =
        [&](const char* name, const char* type, const std::vector<double>& values, const char* unit)
    {
        const std::shared_ptr<GDALDimension> result =
            root->CreateDimension(name, type, "", values.size(), nullptr);
        const std::shared_ptr<GDALMDArray> array = root->CreateMDArray(name, {result}, numbers, nullptr);
        if (unit) array->SetUnit(unit);
        const GUInt64 from = 0;
        const size_t count = values.size();
        EXPECT_TRUE(array->Write(&from, &count, nullptr, nullptr, numbers, values.data()));
        if (unit && look.calendar && std::string(name) == "time")
            array->CreateAttribute("calendar", {}, GDALExtendedDataType::CreateString(), nullptr)
                ->Write(look.calendar);
        // NetCDF goes by the name alone, and says so.
        CPLPushErrorHandler(CPLQuietErrorHandler);
        result->SetIndexingVariable(array);
        CPLPopErrorHandler();
        return result;
    };
    std::vector<double> longitudes, latitudes;
    for (int i = 0; i < columns; ++i)
        longitudes.push_back(west + look.east + 0.1 * (i + 0.5));
    for (int i = 0; i < rows; ++i)
        latitudes.push_back(look.southUp ? south + 0.1 * (i + 0.5) : south + 0.1 * (rows - i - 0.5));
    if (look.kilometres)
    {
        for (int i = 0; i < columns; ++i)
            longitudes[static_cast<std::size_t>(i)] = 500.0 + 2.0 * i;
        for (int i = 0; i < rows; ++i)
            latitudes[static_cast<std::size_t>(i)] = 2400.0 - 2.0 * i;
    }
    std::vector<std::shared_ptr<GDALDimension>> dimensions = {
        dimension("time", GDAL_DIM_TYPE_TEMPORAL, {0.0, 3.0, 6.0, 12.0}, look.unit)};
    if (look.levels > 0)
        dimensions.push_back(
            root->CreateDimension("level", "", "", static_cast<GUInt64>(look.levels), nullptr));
    dimensions.push_back(dimension("lat", GDAL_DIM_TYPE_HORIZONTAL_Y, latitudes,
                                   look.kilometres ? "km"
                                   : look.degrees  ? "degrees_north"
                                                   : "m"));
    dimensions.push_back(dimension("lon", GDAL_DIM_TYPE_HORIZONTAL_X, longitudes,
                                   look.kilometres ? "km"
                                   : look.degrees  ? "degrees_east"
                                                   : "m"));
    const auto floats = GDALExtendedDataType::Create(GDT_Float32);
    const std::shared_ptr<GDALMDArray> rain = root->CreateMDArray("rain", dimensions, floats, nullptr);
    rain->SetUnit("mm");
    if (look.kilometres)
    {
        OGRSpatialReference utm;
        utm.importFromEPSG(32604);
        rain->SetSpatialRef(&utm);
    }
    if (look.bounds)
    {
        const GUInt64 two = 2;
        const double range[] = {100.0, 250.0};
        const auto pair = rain->CreateAttribute("valid_range", {two}, numbers, nullptr);
        pair->Write(range, 2);
        if (look.scale != 1.0) rain->SetScale(look.scale);
    }
    std::vector<float> values;
    for (int step = 0; step < 4; ++step)
        for (int level = 0; level < std::max(1, look.levels); ++level)
            for (const double latitude : latitudes)
                for (const double longitude : longitudes)
                    values.push_back(
                        static_cast<float>(valueAt(longitude - look.east, latitude, step) + 1000.0 * level));
    const std::vector<GUInt64> from(dimensions.size(), 0);
    std::vector<size_t> count;
    for (const auto& each : dimensions)
        count.push_back(static_cast<size_t>(each->GetSize()));
    EXPECT_TRUE(rain->Write(from.data(), count.data(), nullptr, nullptr, floats, values.data()));
    return file.string();
}

/// The value of a step at a place in degrees.
double valueOf(const SequenceRaster& raster, std::size_t step, const MappingFrame& frame, double longitude,
               double latitude)
{
    std::string error;
    const osg::ref_ptr<osg::Image> image = raster.steps->read(step, error);
    EXPECT_TRUE(image) << error;
    if (!image) return 0.0;
    OGRSpatialReference from, to;
    from.importFromEPSG(4326);
    from.SetAxisMappingStrategy(OAMS_TRADITIONAL_GIS_ORDER);
    to.SetFromUserInput(CPLSPrintf("+proj=ortho +ellps=WGS84 +lat_0=%.17g +lon_0=%.17g",
                                   osg::RadiansToDegrees(frame.origin.latitude),
                                   osg::RadiansToDegrees(frame.origin.longitude)));
    const std::unique_ptr<OGRCoordinateTransformation> transformation(
        OGRCreateCoordinateTransformation(&from, &to));
    double x = longitude, y = latitude;
    EXPECT_TRUE(transformation->Transform(1, &x, &y));
    const double column = (x - raster.low.x()) / (raster.high.x() - raster.low.x()) * image->s() - 0.5;
    const double row = (y - raster.low.y()) / (raster.high.y() - raster.low.y()) * image->t() - 0.5;
    const auto i = static_cast<unsigned int>(column), j = static_cast<unsigned int>(row);
    const auto texel = [&](unsigned int c, unsigned int r)
    {
        return static_cast<double>(*reinterpret_cast<const float*>(image->data(c, r)));
    };
    const double u = column - i, v = row - j;
    return (1.0 - v) * ((1.0 - u) * texel(i, j) + u * texel(i + 1, j)) +
           v * ((1.0 - u) * texel(i, j + 1) + u * texel(i + 1, j + 1));
}

std::optional<SequenceRaster> opened(const std::string& file, MappingFrame& frame, std::string& error,
                                     const std::string& variable = {})
{
    SequenceRaster::Options options;
    options.variable = variable;
    options.maxSide = 200;
    return SequenceRaster::open(file, frame, true, options, error);
}

void expectRight(const SequenceRaster& raster, const MappingFrame& frame, double east = 0.0)
{
    for (std::size_t step = 0; step < raster.steps->times().size(); ++step)
        for (const auto& [longitude, latitude] :
             {std::pair(-157.0, 21.0), std::pair(-159.5, 19.6), std::pair(-154.6, 22.4)})
            EXPECT_NEAR(valueOf(raster, step, frame, longitude + east, latitude),
                        valueAt(longitude, latitude, static_cast<int>(step)), 0.02)
                << "step " << step << " at " << longitude << ", " << latitude;
}

std::string faultOf(const std::string& file, const std::string& variable = {})
{
    MappingFrame frame;
    std::string error;
    EXPECT_FALSE(opened(file, frame, error, variable));
    EXPECT_TRUE(contains(error, file)) << error;
    return error;
}

} // namespace

class SequenceRasters : public ::testing::Test
{
protected:
    TempDir _folder;
    std::filesystem::path path(const char* name) const { return _folder.path() / name; }
};

TEST_F(SequenceRasters, TheTimeDimensionOfNetCdfAndZarr)
{
    for (const char* driver : {"netCDF", "Zarr"})
    {
        SCOPED_TRACE(driver);
        Look look;
        look.driver = driver;
        for (const bool southUp : {false, true})
        {
            look.southUp = southUp;
            const std::string file = write(
                path((std::string(southUp ? "up" : "down") + (driver[0] == 'n' ? ".nc" : ".zarr")).c_str()),
                look);
            MappingFrame frame;
            std::string error;
            const std::optional<SequenceRaster> raster = opened(file, frame, error);
            ASSERT_TRUE(raster) << error;
            EXPECT_EQ(raster->variable, "rain");
            EXPECT_EQ(raster->unit, "mm");
            EXPECT_TRUE(raster->steps->dated());
            EXPECT_EQ(raster->steps->times(),
                      (std::vector<double>{start, start + 10800.0, start + 21600.0, start + 43200.0}));
            EXPECT_EQ(raster->steps->kind(), DataLayer::VALUE);
            EXPECT_NEAR(raster->lowest, valueAt(west, south, 0), 0.3);
            EXPECT_NEAR(raster->highest, valueAt(west + 6.0, south + 4.0, 3), 0.3);
            expectRight(*raster, frame);
        }
    }
}

TEST_F(SequenceRasters, LongitudesBeyond180AndTheFirstLevel)
{
    Look look;
    look.east = 360.0;
    look.levels = 3;
    MappingFrame frame;
    std::string error;
    const std::optional<SequenceRaster> raster = opened(write(path("east.nc"), look), frame, error);
    ASSERT_TRUE(raster) << error;
    expectRight(*raster, frame);
}

TEST_F(SequenceRasters, OtherCalendarsAndUnitsCount)
{
    Look look;
    look.calendar = "360_day";
    look.unit = "days since 2000-01-01";
    MappingFrame frame;
    std::string error;
    std::optional<SequenceRaster> raster = opened(write(path("climate.nc"), look), frame, error);
    ASSERT_TRUE(raster) << error;
    EXPECT_FALSE(raster->steps->dated());
    EXPECT_EQ(raster->steps->times(), (std::vector<double>{0.0, 259200.0, 518400.0, 1036800.0}));
    look.calendar = nullptr;
    // Zones count, and times as Zarr's are; those beyond all clocks do not.
    look.unit = "hours since 1970-01-02 06:00 +10:00";
    raster = opened(write(path("zone.nc"), look), frame, error);
    ASSERT_TRUE(raster) << error;
    EXPECT_TRUE(raster->steps->dated());
    EXPECT_EQ(raster->steps->times().front(), 86400.0 - 4 * 3600.0);
    look.unit = "nanoseconds since 1970-01-01";
    raster = opened(write(path("nano.nc"), look), frame, error);
    ASSERT_TRUE(raster) << error;
    EXPECT_TRUE(raster->steps->dated());
    EXPECT_NEAR(raster->steps->times().back(), 12e-9, 1e-15);
    look.unit = "fortnights";
    raster = opened(write(path("odd.nc"), look), frame, error);
    ASSERT_TRUE(raster) << error;
    EXPECT_FALSE(raster->steps->dated());
    EXPECT_EQ(raster->steps->times(), (std::vector<double>{0.0, 3.0, 6.0, 12.0}));
}

TEST_F(SequenceRasters, BandsAndFoldersOfRasters)
{
    TestRaster bands(columns, rows, 3);
    bands.placed(west, south + 4.0, 0.1, 0.1).crs("EPSG:4326");
    bands.fill([](int column, int row, int band)
               { return valueAt(west + 0.1 * (column + 0.5), south + 4.0 - 0.1 * (row + 0.5), band); });
    const std::string plain = bands.write(path("bands.tif"));
    MappingFrame frame;
    std::string error;
    std::optional<SequenceRaster> raster = opened(plain, frame, error);
    ASSERT_TRUE(raster) << error;
    EXPECT_FALSE(raster->steps->dated());
    EXPECT_EQ(raster->steps->times(), (std::vector<double>{0.0, 1.0, 2.0}));
    expectRight(*raster, frame);
    for (int band = 0; band < 3; ++band)
        bands.dataset().GetRasterBand(band + 1)->SetDescription(CPLSPrintf("2026-01-12T%02d:00", 6 + band));
    raster = opened(bands.write(path("dated.tif")), frame, error);
    ASSERT_TRUE(raster) << error;
    EXPECT_EQ(raster->steps->times(), (std::vector<double>{start, start + 3600.0, start + 7200.0}));

    std::filesystem::create_directory(path("steps"));
    for (int step = 0; step < 3; ++step)
    {
        TestRaster one(columns, rows);
        one.placed(west, south + 4.0, 0.1, 0.1).crs("EPSG:4326");
        one.fill([&](int column, int row, int)
                 { return valueAt(west + 0.1 * (column + 0.5), south + 4.0 - 0.1 * (row + 0.5), step); });
        one.write(path("steps") / CPLSPrintf("rain_20260112_%02d00.tif", 6 + 6 * step));
    }
    std::ofstream(path("steps") / "readme.txt") << "no raster";
    raster = opened(path("steps").string(), frame, error);
    ASSERT_TRUE(raster) << error;
    EXPECT_TRUE(raster->steps->dated());
    EXPECT_EQ(raster->steps->times(), (std::vector<double>{start, start + 21600.0, start + 43200.0}));
    expectRight(*raster, frame);
}

TEST_F(SequenceRasters, TheTimeOfGrib)
{
    GDALAllRegister();
    TestRaster bands(columns, rows, 3, GDT_Float64);
    bands.placed(west, south + 4.0, 0.1, 0.1).crs("EPSG:4326");
    bands.fill([](int column, int row, int band)
               { return valueAt(west + 0.1 * (column + 0.5), south + 4.0 - 0.1 * (row + 0.5), band); });
    CPLStringList options;
    options.AddString("DATA_ENCODING=IEEE_FLOATING_POINT");
    for (int band = 0; band < 3; ++band)
        options.AddString(CPLSPrintf("BAND_%d_IDS=REF_TIME=2026-01-12T%02d:00:00Z", band + 1, 6 + band));
    const std::string file = path("rain.grib2").string();
    DatasetPtr(GetGDALDriverManager()->GetDriverByName("GRIB")->CreateCopy(
        file.c_str(), &bands.dataset(), FALSE, options.List(), nullptr, nullptr));
    MappingFrame frame;
    std::string error;
    const std::optional<SequenceRaster> raster = opened(file, frame, error);
    ASSERT_TRUE(raster) << error;
    EXPECT_TRUE(raster->steps->dated());
    EXPECT_EQ(raster->steps->times(), (std::vector<double>{start, start + 3600.0, start + 7200.0}));
    expectRight(*raster, frame);
    // A message that ends in its middle.
    std::filesystem::resize_file(file, std::filesystem::file_size(file) / 8);
    EXPECT_TRUE(contains(faultOf(file), "gdalinfo") || contains(faultOf(file), "copy or export"));
}

namespace
{

/// A small raster of one value.
TestRaster flat(double value)
{
    TestRaster one(4, 4);
    one.placed(west, south, 0.1, 0.1).crs("EPSG:4326");
    one.fill([=](int, int, int) { return value; });
    return one;
}

double meanOf(const SequenceRaster& raster, std::size_t step)
{
    std::string error;
    const osg::ref_ptr<osg::Image> image = raster.steps->read(step, error);
    EXPECT_TRUE(image) << error;
    return image ? static_cast<double>(
                       *reinterpret_cast<const float*>(image->data(image->s() / 2, image->t() / 2)))
                 : -1.0;
}

} // namespace

TEST_F(SequenceRasters, FilesBesideRastersAreNoSteps)
{
    std::filesystem::create_directory(path("steps"));
    flat(1.0).write(path("steps") / "a.tif");
    flat(2.0).write(path("steps") / "b.tif");
    for (const char* const each : {"a.pgw", "a.jgw", "a.tif.aux.xml", "a.qml", "b.tifw", "b.sld", "c.hdr"})
        std::ofstream(path("steps") / each) << "1\n";
    flat(3.0).write(path("steps") / "c.flt");
    MappingFrame frame;
    std::string error;
    const std::optional<SequenceRaster> raster = opened(path("steps").string(), frame, error);
    ASSERT_TRUE(raster) << error;
    EXPECT_EQ(raster->steps->times().size(), 3u);
}

TEST_F(SequenceRasters, NumbersInNamesCountByTheirValueAndDatesByTheirTime)
{
    std::filesystem::create_directory(path("numbers"));
    for (const int step : {1, 2, 10})
        flat(step).write(path("numbers") / CPLSPrintf("step_%d.tif", step));
    MappingFrame frame;
    std::string error;
    std::optional<SequenceRaster> raster = opened(path("numbers").string(), frame, error);
    ASSERT_TRUE(raster) << error;
    EXPECT_EQ(meanOf(*raster, 1), 2.0);
    EXPECT_EQ(meanOf(*raster, 2), 10.0);
    // The names stand in another order than the dates.
    std::filesystem::create_directory(path("dates"));
    flat(1.0).write(path("dates") / "b_202601.tif");
    flat(2.0).write(path("dates") / "a_202602.tif");
    raster = opened(path("dates").string(), frame, error);
    ASSERT_TRUE(raster) << error;
    EXPECT_TRUE(raster->steps->dated());
    EXPECT_EQ(raster->steps->times()[1] - raster->steps->times()[0], 31 * 86400.0);
    EXPECT_EQ(meanOf(*raster, 0), 1.0);
    // Two steps of one date, and a step without a date, leave a word.
    NotifyWatch watch;
    flat(3.0).write(path("dates") / "c_202601.tif");
    auto messages = watch.messagesOf([&] { raster = opened(path("dates").string(), frame, error); });
    ASSERT_TRUE(raster) << error;
    EXPECT_FALSE(raster->steps->dated());
    ASSERT_EQ(messages.size(), 1u);
    EXPECT_TRUE(contains(messages[0], "do not rise")) << messages[0];
    flat(3.0).write(path("numbers") / "step_20260112.tif");
    messages = watch.messagesOf([&] { raster = opened(path("numbers").string(), frame, error); });
    ASSERT_EQ(messages.size(), 1u);
    EXPECT_TRUE(contains(messages[0], "1 of its 4 steps have a date")) << messages[0];
}

TEST_F(SequenceRasters, MonthsGoByTheCalendar)
{
    Look look;
    look.unit = "months since 2025-12-15";
    MappingFrame frame;
    std::string error;
    std::optional<SequenceRaster> raster = opened(write(path("months.nc"), look), frame, error);
    ASSERT_TRUE(raster) << error;
    const double first = *LayerClock::parseDate("2025-12-15");
    EXPECT_TRUE(raster->steps->dated());
    EXPECT_EQ(raster->steps->times(), (std::vector<double>{first, *LayerClock::parseDate("2026-03-15"),
                                                           *LayerClock::parseDate("2026-06-15"),
                                                           *LayerClock::parseDate("2026-12-15")}));
    // A year 0 stands for any year.
    look.unit = "hour since 0000-01-01 00:00:00";
    NotifyWatch silent;
    raster = opened(write(path("climatology.nc"), look), frame, error);
    ASSERT_TRUE(raster) << error;
    EXPECT_FALSE(raster->steps->dated());
    EXPECT_EQ(raster->steps->times(), (std::vector<double>{0.0, 10800.0, 21600.0, 43200.0}));
    look.unit = "fortnights since 2025-12-15";
    NotifyWatch watch;
    const auto messages =
        watch.messagesOf([&] { raster = opened(write(path("odd.nc"), look), frame, error); });
    ASSERT_TRUE(raster) << error;
    ASSERT_EQ(messages.size(), 1u);
    EXPECT_TRUE(contains(messages[0], "\"fortnights since 2025-12-15\", is not known")) << messages[0];
}

TEST_F(SequenceRasters, LevelsAreChosenByTheirValueOrNamed)
{
    Look look;
    look.levels = 3;
    const std::string file = write(path("levels.nc"), look);
    MappingFrame frame;
    std::string error;
    NotifyWatch watch;
    std::optional<SequenceRaster> raster;
    const auto messages = watch.messagesOf([&] { raster = opened(file, frame, error); });
    ASSERT_TRUE(raster) << error;
    ASSERT_EQ(messages.size(), 1u);
    EXPECT_TRUE(contains(messages[0], "the first value of level, 0, is shown of 3; name another one as " +
                                          file + ":rain[level=0]."))
        << messages[0];
    raster = opened(file, frame, error, "rain[level=2]");
    ASSERT_TRUE(raster) << error;
    EXPECT_NEAR(valueOf(*raster, 1, frame, -157.0, 21.0), valueAt(-157.0, 21.0, 1) + 2000.0, 0.02);
    EXPECT_TRUE(
        contains(faultOf(file, "rain[level=7]"), "its dimension level has no value 7; it has 0, 1, 2."));
    EXPECT_TRUE(contains(faultOf(file, "rain[member=1]"), "name a value of level."));
    EXPECT_TRUE(contains(faultOf(file, "snow[level=1]"), "no variable \"snow\""));
}

TEST_F(SequenceRasters, AxesInKilometres)
{
    const std::string file = write(path("km.nc"),
                                   []
                                   {
                                       Look look;
                                       look.kilometres = true;
                                       return look;
                                   }());
    MappingFrame frame;
    frame.globe = false;
    frame.wkt = "EPSG:32604";
    std::string error;
    const std::optional<SequenceRaster> raster = opened(file, frame, error);
    ASSERT_TRUE(raster) << error;
    EXPECT_NEAR(raster->high.x() - raster->low.x(), columns * 2000.0, 1.0);
    EXPECT_NEAR(raster->high.y() - raster->low.y(), rows * 2000.0, 1.0);
}

TEST_F(SequenceRasters, ValuesThatAttributesCallInvalidAreNone)
{
    Look look;
    look.bounds = true; // only values from 100 to 250 are valid
    MappingFrame frame;
    std::string error;
    const std::optional<SequenceRaster> raster = opened(write(path("bounds.nc"), look), frame, error);
    ASSERT_TRUE(raster) << error;
    EXPECT_GE(raster->lowest, 100.0);
    EXPECT_LE(raster->highest, 250.0);
    EXPECT_NEAR(valueOf(*raster, 1, frame, -157.0, 21.0), valueAt(-157.0, 21.0, 1), 0.02);
    // They bound what the file holds, before its scale.
    look.scale = 2.0;
    const std::optional<SequenceRaster> scaled = opened(write(path("scaled.nc"), look), frame, error);
    ASSERT_TRUE(scaled) << error;
    EXPECT_NEAR(valueOf(*scaled, 1, frame, -157.0, 21.0), 2.0 * valueAt(-157.0, 21.0, 1), 0.04);
    EXPECT_LE(scaled->highest, 500.0);
    const osg::ref_ptr<osg::Image> none = raster->steps->read(3, error);
    ASSERT_TRUE(none) << error;
    EXPECT_TRUE(std::isnan(*reinterpret_cast<const float*>(none->data(none->s() / 2, none->t() / 2))));
}

// ERA5, GFS and CMIP: cells that are centred on the poles, from 0 or from −180 degrees on.
TEST_F(SequenceRasters, DataOfTheWorldAreSixParts)
{
    const auto valueAt = [](double longitude, double latitude, int step)
    {
        return 1000.0 * step + latitude +
               20.0 * std::cos(osg::DegreesToRadians(longitude)) * std::cos(osg::DegreesToRadians(latitude));
    };
    for (const double first : {0.0, -180.0})
    {
        SCOPED_TRACE(first);
        const std::filesystem::path folder = path(first == 0.0 ? "east" : "west");
        std::filesystem::create_directory(folder);
        for (int step = 0; step < 2; ++step)
        {
            TestRaster world(144, 73);
            world.placed(first - 1.25, 91.25, 2.5, 2.5)
                .crs("EPSG:4326")
                .fill([&](int column, int row, int)
                      { return valueAt(first + 2.5 * column, 90.0 - 2.5 * row, step); });
            world.write(folder / (step == 0 ? "a.tif" : "b.tif"));
        }
        MappingFrame frame;
        std::string error;
        const std::optional<SequenceRaster> raster = opened(folder.string(), frame, error);
        ASSERT_TRUE(raster) << error;
        ASSERT_EQ(raster->others.size(), 5u);
        EXPECT_NEAR(raster->lowest, -90.0 - 20.0, 22.0);
        EXPECT_NEAR(raster->highest, 1000.0 + 90.0 + 20.0, 22.0);
        std::vector<SequenceRaster::Part> parts = raster->others;
        parts.push_back({frame.origin, raster->steps, raster->low, raster->high});
        std::vector<osg::ref_ptr<osg::Image>> images;
        for (const SequenceRaster::Part& part : parts)
            images.push_back(part.steps->read(1, error));
        for (double latitude = -88.0; latitude < 90.0; latitude += 11.0)
        {
            for (double longitude = -175.0; longitude < 180.0; longitude += 35.0)
            {
                int shown = 0;
                for (std::size_t i = 0; i < parts.size(); ++i)
                {
                    ASSERT_TRUE(images[i]) << error;
                    const LocalOrigin& origin = parts[i].origin;
                    const double x = osg::DegreesToRadians(longitude) - origin.longitude,
                                 y = osg::DegreesToRadians(latitude);
                    // On a sphere that is near enough for cells of 278 km.
                    const osg::Vec2d place(std::cos(y) * std::sin(x),
                                           std::sin(y) * std::cos(origin.latitude) -
                                               std::cos(y) * std::sin(origin.latitude) * std::cos(x));
                    const double facing = std::sin(y) * std::sin(origin.latitude) +
                                          std::cos(y) * std::cos(origin.latitude) * std::cos(x);
                    if (facing < 0.5) continue;
                    const osg::Vec2d metres = place * 6371000.0;
                    const int column =
                                  static_cast<int>((metres.x() - parts[i].low.x()) /
                                                   (parts[i].high.x() - parts[i].low.x()) * images[i]->s()),
                              row = static_cast<int>((metres.y() - parts[i].low.y()) /
                                                     (parts[i].high.y() - parts[i].low.y()) * images[i]->t());
                    if (column < 0 || row < 0 || column >= images[i]->s() || row >= images[i]->t()) continue;
                    const auto value = static_cast<double>(*reinterpret_cast<const float*>(
                        images[i]->data(static_cast<unsigned int>(column), static_cast<unsigned int>(row))));
                    if (std::isnan(value)) continue;
                    ++shown;
                    EXPECT_NEAR(value, valueAt(longitude, latitude, 1), 2.5) << longitude << ", " << latitude;
                }
                EXPECT_GE(shown, 1) << longitude << ", " << latitude;
                EXPECT_LE(shown, 2) << longitude << ", " << latitude;
            }
        }
        // As a file of OSG's opens it again: by the frame of a part.
        MappingFrame again;
        again.origin = raster->others[0].origin;
        const std::optional<SequenceRaster> part =
            SequenceRaster::open(folder.string(), again, false, {"", 200}, error);
        ASSERT_TRUE(part) << error;
        EXPECT_TRUE(part->others.empty());
        EXPECT_EQ(part->low, raster->others[0].low);
    }
}

TEST_F(SequenceRasters, WhatIsWrongIsSaid)
{
    const std::string good = write(path("good.nc"));
    EXPECT_TRUE(contains(faultOf(good, "snow"), "\"snow\""));
    EXPECT_TRUE(contains(faultOf(good, "snow"), "it has rain"));
    Look look;
    look.degrees = false;
    EXPECT_TRUE(contains(faultOf(write(path("nowhere.nc"), look)), "no coordinate reference system"));
    std::filesystem::copy_file(good, path("cut.nc"));
    std::filesystem::resize_file(path("cut.nc"), 700);
    faultOf(path("cut.nc").string());
    EXPECT_TRUE(contains(faultOf(path("none.nc").string()), "there is no such file"));
    std::ofstream(path("words.nc")) << "these are words";
    faultOf(path("words.nc").string());
    std::filesystem::create_directory(path("empty"));
    EXPECT_TRUE(contains(faultOf(path("empty").string()), "no rasters"));
    TestRaster one(4, 4);
    one.placed(west, south, 0.1, 0.1).crs("EPSG:4326");
    EXPECT_TRUE(contains(faultOf(one.write(path("one.tif"))), "--mapping"));
    EXPECT_TRUE(contains(faultOf(path("one.tif").string(), "rain"), "no variables"));
    // On a globe, half of a map of the world would lie on the other side of a frame that is given.
    MappingFrame globe;
    globe.origin = LocalOrigin::onGlobe(0.1, 0.2);
    std::string reach;
    std::filesystem::create_directory(path("world"));
    TestRaster(36, 18).placed(-180.0, 90.0, 10.0, 10.0).crs("EPSG:4326").write(path("world") / "a.tif");
    TestRaster(36, 18).placed(-180.0, 90.0, 10.0, 10.0).crs("EPSG:4326").write(path("world") / "b.tif");
    EXPECT_FALSE(SequenceRaster::open(path("world").string(), globe, false, {}, reach));
    EXPECT_TRUE(contains(reach, "-projwin")) << reach;
    // A step that goes bad later is said when it is read, and the others stay.
    std::filesystem::create_directory(path("steps"));
    for (const char* name : {"a.tif", "b.tif", "c.tif"})
        one.write(path("steps") / name);
    MappingFrame frame;
    std::string error;
    const std::optional<SequenceRaster> raster = opened(path("steps").string(), frame, error);
    ASSERT_TRUE(raster) << error;
    std::filesystem::resize_file(path("steps") / "b.tif", 100);
    EXPECT_FALSE(raster->steps->read(1, error));
    EXPECT_TRUE(contains(error, "b.tif")) << error;
    EXPECT_TRUE(raster->steps->read(2, error));
}

// A virtual dataset stands on each of these when the reader finds the fault, and must go before the file does.
TEST_F(SequenceRasters, StepsWithoutAPlaceAreRefused)
{
    TestRaster bands(columns, rows, 3);
    bands.fill([](int column, int row, int band) { return column + row + band; });
    const std::string nowhere = bands.write(path("nowhere.tif"));
    EXPECT_TRUE(contains(faultOf(nowhere), "no georeference")) << nowhere;
    bands.placed(west, south + 4.0, 0.1, 0.1);
    EXPECT_TRUE(contains(faultOf(bands.write(path("unnamed.tif"))), "no coordinate reference system"));
}

TEST_F(SequenceRasters, FilesAndVariables)
{
    const std::string file = write(path("a:b.nc"));
    EXPECT_EQ(SequenceRaster::parse(file), std::pair(file, std::string()));
    EXPECT_EQ(SequenceRaster::parse(file + ":rain"), std::pair(file, std::string("rain")));
    EXPECT_EQ(SequenceRaster::parse("none.nc"), std::pair(std::string("none.nc"), std::string()));
    const std::string address = "/vsicurl/https://host/rain.nc";
    EXPECT_EQ(SequenceRaster::parse(address), std::pair(address, std::string()));
    EXPECT_EQ(SequenceRaster::parse(address + ":rain"), std::pair(address, std::string("rain")));
}
