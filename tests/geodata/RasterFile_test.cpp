// SPDX-License-Identifier: MIT
// SPDX-FileCopyrightText: 2026 the osgGeoFX authors
//
// Variables of files, steps of time, grids without a reference system and curved grids: each reader takes them alike, and one line says what was
// chosen.
#include <osgGeoFX/geodata/BuildError.h>
#include <osgGeoFX/geodata/MappingRaster.h>
#include <osgGeoFX/geodata/OverlayReader.h>
#include <osgGeoFX/geodata/SequenceRaster.h>
#include <osgGeoFX/geodata/detail/RasterFile.h>
#include <osgGeoFX/geodata/detail/RasterSource.h>
#include <tools/NotifyWatch.h>
#include <tools/TempDir.h>
#include <tools/TestRasters.h>

#include <gtest/gtest.h>
#include <osg/Math>

#include <cmath>
#include <memory>
#include <vector>

using namespace osgGeoFX;
using namespace geofx::test;

namespace
{

constexpr int columns = 40, rows = 30;
constexpr double west = 7.0, south = 45.0, cell = 0.01;

/// Metres of a variable at a place, at a level and a time.
double heightAt(double longitude, double latitude, int level, int time)
{
    return 1000.0 * (longitude - west) + 2000.0 * (latitude - south) + 10.0 * level + 100.0 * time;
}

/// The place of a cell of a grid that is turned and bent.
osg::Vec2d curvedAt(double column, double row)
{
    const double x = column * cell, y = row * cell;
    return {west + 0.9 * x - 0.2 * y + 0.1 * x * y, south + 0.25 * x + 0.9 * y + 0.1 * x * x};
}

using Axis = std::shared_ptr<GDALDimension>;

/// Writes NetCDF with the variables "ground" and "t", by time, level and place, and "curved", whose places are in two variables.
class Writer
{
public:
    explicit Writer(const std::filesystem::path& file)
        : _dataset(
              (GDALAllRegister(), GetGDALDriverManager()->GetDriverByName("netCDF")->CreateMultiDimensional(
                                      file.c_str(), nullptr, nullptr))),
          _root(_dataset->GetRootGroup())
    {
    }
    Axis axis(const char* name, const char* type, std::vector<double> values, const char* unit)
    {
        const Axis result = _root->CreateDimension(name, type, "", values.size(), nullptr);
        const auto array = write(name, {result}, values, unit);
        CPLPushErrorHandler(CPLQuietErrorHandler);
        result->SetIndexingVariable(array);
        CPLPopErrorHandler();
        return result;
    }
    Axis plain(const char* name, int count)
    {
        return _root->CreateDimension(name, "", "", static_cast<GUInt64>(count), nullptr);
    }
    std::shared_ptr<GDALMDArray> write(const char* name, const std::vector<Axis>& axes,
                                       const std::vector<double>& values, const char* unit)
    {
        const auto numbers = GDALExtendedDataType::Create(GDT_Float64);
        const auto array = _root->CreateMDArray(name, axes, numbers, nullptr);
        if (unit) array->SetUnit(unit);
        const std::vector<GUInt64> from(axes.size(), 0);
        std::vector<size_t> count;
        for (const Axis& each : axes)
            count.push_back(static_cast<size_t>(each->GetSize()));
        EXPECT_TRUE(array->Write(from.data(), count.data(), nullptr, nullptr, numbers, values.data()));
        return array;
    }

private:
    osgGeoFX::DatasetPtr _dataset;
    std::shared_ptr<GDALGroup> _root;
};

std::string writeAll(const std::filesystem::path& file)
{
    Writer writer(file);
    std::vector<double> longitudes, latitudes, ground, t, lon2, lat2, curved;
    for (int x = 0; x < columns; ++x)
        longitudes.push_back(west + cell * x);
    for (int y = 0; y < rows; ++y)
        latitudes.push_back(south + cell * y);
    for (const double latitude : latitudes)
        for (const double longitude : longitudes)
            ground.push_back(heightAt(longitude, latitude, 0, 0));
    for (int time = 0; time < 3; ++time)
        for (int level = 0; level < 2; ++level)
            for (const double latitude : latitudes)
                for (const double longitude : longitudes)
                    t.push_back(heightAt(longitude, latitude, level, time));
    for (int time = 0; time < 3; ++time)
        for (int y = 0; y < rows; ++y)
            for (int x = 0; x < columns; ++x)
            {
                const osg::Vec2d place = curvedAt(x, y);
                if (time == 0) lon2.push_back(place.x());
                if (time == 0) lat2.push_back(place.y());
                curved.push_back(heightAt(place.x(), place.y(), 0, time));
            }
    const Axis time =
        writer.axis("time", GDAL_DIM_TYPE_TEMPORAL, {0.0, 6.0, 12.0}, "hours since 2026-01-12 06:00:00");
    const Axis level = writer.axis("level", "", {500.0, 850.0}, "hPa");
    const Axis y = writer.axis("lat", GDAL_DIM_TYPE_HORIZONTAL_Y, latitudes, "degrees_north");
    const Axis x = writer.axis("lon", GDAL_DIM_TYPE_HORIZONTAL_X, longitudes, "degrees_east");
    writer.write("ground", {y, x}, ground, "m");
    writer.write("t", {time, level, y, x}, t, "m");
    const Axis j = writer.plain("j", rows), i = writer.plain("i", columns);
    writer.write("lon2", {j, i}, lon2, "degrees_east");
    writer.write("lat2", {j, i}, lat2, "degrees_north");
    writer.write("curved", {time, j, i}, curved, "m")
        ->CreateAttribute("coordinates", {}, GDALExtendedDataType::CreateString(), nullptr)
        ->Write("lon2 lat2");
    return file.string();
}

const osg::Vec2d someWhere(west + 0.21, south + 0.17);

/// What --mapping and close-ups show.
double mapped(const std::string& name, std::string& error)
{
    MappingFrame frame;
    frame.origin =
        LocalOrigin::onGlobe(osg::DegreesToRadians(someWhere.x()), osg::DegreesToRadians(someWhere.y()));
    MappingRaster::Options options;
    options.window = MappingRaster::Window{{-50.0, -50.0}, {50.0, 50.0}, 100.0};
    const auto raster = MappingRaster::read(name, frame, options, error);
    return raster ? static_cast<double>(*reinterpret_cast<const float*>(raster->layer->getImage()->data()))
                  : std::nan("");
}

/// What --dem takes.
double built(const std::string& name)
{
    RasterSource source(name, RasterKind::Elevation);
    float height = std::nanf("");
    source.sampleHeights(GridCrs::geocentric(), {someWhere.x(), someWhere.y(), cell, cell, 1, 1}, &height);
    return static_cast<double>(height);
}

class RasterFiles : public ::testing::Test
{
protected:
    static void SetUpTestSuite() { _file = writeAll(folder() / "f.nc"); }
    static TempDir& folder()
    {
        static TempDir folder;
        return folder;
    }
    static std::string _file;
};
std::string RasterFiles::_file;

} // namespace

TEST_F(RasterFiles, VariablesAreTakenByEachReader)
{
    const double ground = heightAt(someWhere.x(), someWhere.y(), 0, 0);
    std::string error;
    EXPECT_NEAR(mapped(_file + ":ground", error), ground, 0.1) << error;
    EXPECT_NEAR(built(_file + ":ground"), ground, 0.1);
    EXPECT_NEAR(mapped(_file + ":t[level=850,time=12]", error), ground + 210.0, 0.1) << error;
    EXPECT_NEAR(built(_file + ":t[level=850]"), ground + 10.0, 0.1);
    OverlayReader reader;
    OverlayReader::Options options;
    options.layer = "ground";
    options.paged = true;
    ASSERT_TRUE(reader.read(_file, options, error)) << error;
    ASSERT_EQ(reader.overlays.size(), 1u);
    EXPECT_EQ(reader.overlays[0].name, "f.nc:ground");
    EXPECT_NEAR(reader.overlays[0].highest - reader.overlays[0].lowest, 0.39 * 1000.0 + 0.29 * 2000.0, 20.0);
    // GDAL's own name of the same.
    EXPECT_NEAR(built("NETCDF:\"" + _file + "\":ground"), ground, 0.1);
}

TEST_F(RasterFiles, WhatIsNotThereIsListed)
{
    std::string error;
    mapped(_file + ":snow", error);
    EXPECT_NE(error.find("it has no variable \"snow\" with rows and columns; it has "), std::string::npos)
        << error;
    EXPECT_NE(error.find("ground"), std::string::npos) << error;
    mapped(_file, error);
    EXPECT_NE(error.find("; name one as " + _file + ":"), std::string::npos) << error;
    const std::string plain =
        TestRaster(4, 4).placed(west, south, 0.1, 0.1).crs("EPSG:4326").write(folder() / "plain.tif");
    mapped(plain + ":snow", error);
    EXPECT_NE(error.find("it has no variables, so \"snow\" is none of it"), std::string::npos) << error;
    EXPECT_THROW(built(_file + ":snow"), BuildError);
}

TEST_F(RasterFiles, OneLineTellsWhatIsTaken)
{
    std::string error;
    const std::string own = writeAll(folder() / "told.nc");
    const std::vector<std::string> said = NotifyWatch().messagesOf(
        [&]
        {
            mapped(own + ":t[level=500]", error);
            built(own + ":t[level=500]");
        });
    ASSERT_EQ(said.size(), 2u);
    EXPECT_NE(said[0].find("the first value of time, 0, is shown of 3"), std::string::npos) << said[0];
    EXPECT_NE(said[0].find("show all of them with --sequence"), std::string::npos) << said[0];
    EXPECT_NE(said[1].find("WGS 84"), std::string::npos) << said[1];
}

// A file of one variable, which needs no name.
TEST_F(RasterFiles, TheFirstOfManyTimesIsTold)
{
    const std::filesystem::path file = folder() / "one.nc";
    {
        Writer writer(file);
        std::vector<double> longitudes, latitudes, values;
        for (int x = 0; x < columns; ++x)
            longitudes.push_back(west + cell * x);
        for (int y = 0; y < rows; ++y)
            latitudes.push_back(south + cell * y);
        for (int time = 0; time < 4; ++time)
            for (const double latitude : latitudes)
                for (const double longitude : longitudes)
                    values.push_back(heightAt(longitude, latitude, 0, time));
        const Axis time = writer.axis("time", GDAL_DIM_TYPE_TEMPORAL, {0.0, 6.0, 12.0, 18.0},
                                      "hours since 2026-01-12 06:00:00");
        const Axis y = writer.axis("lat", GDAL_DIM_TYPE_HORIZONTAL_Y, latitudes, "degrees_north");
        const Axis x = writer.axis("lon", GDAL_DIM_TYPE_HORIZONTAL_X, longitudes, "degrees_east");
        writer.write("rain", {time, y, x}, values, "m");
    }
    std::string error;
    double value = 0.0;
    const std::vector<std::string> said =
        NotifyWatch().messagesOf([&] { value = mapped(file.string(), error); });
    EXPECT_NEAR(value, heightAt(someWhere.x(), someWhere.y(), 0, 0), 0.1) << error;
    ASSERT_EQ(said.size(), 2u);
    EXPECT_NE(
        said[0].find("of its 4 times the first, 2026-01-12 06:00 UTC, is taken; --sequence shows them all."),
        std::string::npos)
        << said[0];
    EXPECT_NEAR(built(file.string()), heightAt(someWhere.x(), someWhere.y(), 0, 0), 0.1);
}

TEST_F(RasterFiles, CurvedGridsGoByTheirPlaces)
{
    const osg::Vec2d place = curvedAt(21.3, 14.6);
    const auto at = [&](int time)
    {
        return heightAt(place.x(), place.y(), 0, time);
    };
    MappingFrame frame;
    frame.origin = LocalOrigin::onGlobe(osg::DegreesToRadians(place.x()), osg::DegreesToRadians(place.y()));
    MappingRaster::Options options;
    options.window = MappingRaster::Window{{-50.0, -50.0}, {50.0, 50.0}, 100.0};
    std::string error;
    const auto raster = MappingRaster::read(_file + ":curved", frame, options, error);
    ASSERT_TRUE(raster) << error;
    const double cellOfHeights = 0.01 * 3000.0;
    EXPECT_NEAR(static_cast<double>(*reinterpret_cast<const float*>(raster->layer->getImage()->data())),
                at(0), 0.3 * cellOfHeights);
    RasterSource source(_file + ":curved[time=12]", RasterKind::Elevation);
    float height = std::nanf("");
    source.sampleHeights(GridCrs::geocentric(), {place.x(), place.y(), cell, cell, 1, 1}, &height);
    EXPECT_NEAR(static_cast<double>(height), at(2), 0.6 * cellOfHeights);
    const auto steps = SequenceRaster::open(_file, frame, true, {"curved", 200}, error);
    ASSERT_TRUE(steps) << error;
    EXPECT_EQ(steps->steps->times().size(), 3u);
    EXPECT_NEAR(steps->highest - steps->lowest,
                heightAt(curvedAt(39, 29).x(), curvedAt(39, 29).y(), 0, 2) -
                    heightAt(curvedAt(0, 0).x(), curvedAt(0, 0).y(), 0, 0),
                3.0 * cellOfHeights);
}

// Where the two variables are called lat and lon, GDAL takes them for the numbers along the axes.
TEST_F(RasterFiles, CurvedGridsMayCallTheirPlacesLatAndLon)
{
    const std::filesystem::path file = folder() / "curved.nc";
    {
        Writer writer(file);
        std::vector<double> longitudes, latitudes, values;
        for (int time = 0; time < 2; ++time)
            for (int row = 0; row < rows; ++row)
                for (int column = 0; column < columns; ++column)
                {
                    const osg::Vec2d place = curvedAt(column, row);
                    if (time == 0) longitudes.push_back(place.x());
                    if (time == 0) latitudes.push_back(place.y());
                    values.push_back(heightAt(place.x(), place.y(), 0, time));
                }
        const Axis time =
            writer.axis("time", GDAL_DIM_TYPE_TEMPORAL, {0.0, 6.0}, "hours since 2026-01-12 06:00:00");
        const Axis y = writer.plain("y", rows), x = writer.plain("x", columns);
        writer.write("lat", {y, x}, latitudes, "degrees_north");
        writer.write("lon", {y, x}, longitudes, "degrees_east");
        writer.write("rain", {time, y, x}, values, "m")
            ->CreateAttribute("coordinates", {}, GDALExtendedDataType::CreateString(), nullptr)
            ->Write("time lat lon");
    }
    const osg::Vec2d place = curvedAt(20.0, 15.0);
    MappingFrame frame;
    frame.origin = LocalOrigin::onGlobe(osg::DegreesToRadians(place.x()), osg::DegreesToRadians(place.y()));
    std::string error;
    const auto steps = SequenceRaster::open(file.string(), frame, true, {"rain", 200}, error);
    ASSERT_TRUE(steps) << error;
    EXPECT_LT(std::abs(steps->low.x()) + std::abs(steps->high.y()), 1e5) << "it lies where it is";
    EXPECT_NEAR(steps->highest - steps->lowest,
                heightAt(curvedAt(39, 29).x(), curvedAt(39, 29).y(), 0, 1) -
                    heightAt(curvedAt(0, 0).x(), curvedAt(0, 0).y(), 0, 0),
                90.0);
}

TEST_F(RasterFiles, ColumnsMayComeBeforeRows)
{
    const std::filesystem::path file = folder() / "turned.nc";
    {
        Writer writer(file);
        std::vector<double> longitudes, latitudes, values;
        for (int column = 0; column < columns; ++column)
            longitudes.push_back(west + cell * column);
        for (int row = 0; row < rows; ++row)
            latitudes.push_back(south + cell * row);
        for (const double longitude : longitudes)
            for (const double latitude : latitudes)
                values.push_back(heightAt(longitude, latitude, 0, 0));
        const Axis x = writer.axis("lon", GDAL_DIM_TYPE_HORIZONTAL_X, longitudes, "degrees_east");
        const Axis y = writer.axis("lat", GDAL_DIM_TYPE_HORIZONTAL_Y, latitudes, "degrees_north");
        writer.write("rain", {x, y}, values, "m")
            ->CreateAttribute("coordinates", {}, GDALExtendedDataType::CreateString(), nullptr)
            ->Write("lat lon");
    }
    std::string error;
    EXPECT_NEAR(mapped(file.string(), error), heightAt(someWhere.x(), someWhere.y(), 0, 0), 1.0) << error;
    EXPECT_NEAR(built(file.string()), heightAt(someWhere.x(), someWhere.y(), 0, 0), 1.0);
}

TEST_F(RasterFiles, TablesOfAGeoPackage)
{
    const std::filesystem::path file = folder() / "two.gpkg";
    for (const int shade : {50, 200})
    {
        TestRaster raster(64, 64, 3, GDT_Byte);
        raster.placed(west, south + 0.64, 0.01, 0.01)
            .crs("EPSG:4326")
            .fill([&](int, int, int) { return shade; });
        raster.write(folder() / "shade.tif");
        const osgGeoFX::DatasetPtr from(GDALDataset::Open((folder() / "shade.tif").c_str(), GDAL_OF_RASTER));
        const std::string table = "RASTER_TABLE=shade" + std::to_string(shade);
        const char* const options[] = {table.c_str(),
                                       shade == 50 ? "APPEND_SUBDATASET=NO" : "APPEND_SUBDATASET=YES",
                                       "TILE_FORMAT=PNG", nullptr};
        const osgGeoFX::DatasetPtr to(GetGDALDriverManager()->GetDriverByName("GPKG")->CreateCopy(
            file.c_str(), from.get(), FALSE, const_cast<char**>(options), nullptr, nullptr));
        ASSERT_TRUE(to);
    }
    OverlayReader reader;
    std::string error;
    OverlayReader::Options options;
    for (const int shade : {50, 200})
    {
        reader = OverlayReader();
        options.layer = "shade" + std::to_string(shade);
        ASSERT_TRUE(reader.read(file.string(), options, error)) << error;
        const osg::Image& image = *reader.overlays.at(0).layer->getImage();
        EXPECT_NEAR(
            image.data(static_cast<unsigned int>(image.s() / 2), static_cast<unsigned int>(image.t() / 2))[0],
            shade, 1);
    }
    options.layer = "none";
    EXPECT_FALSE(reader.read(file.string(), options, error));
    EXPECT_NE(error.find("it has shade50, shade200"), std::string::npos) << error;
}
