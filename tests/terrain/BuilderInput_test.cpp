// SPDX-License-Identifier: MIT
// SPDX-FileCopyrightText: 2026 the osgGeoFX authors
//
// What osggeofx_build cannot use: exit code 2, one line that names the file and the remedy, nothing that looks
// whole.
#include <tools/RunProgram.h>
#include <tools/TempDir.h>
#include <tools/TestRasters.h>

#include <gtest/gtest.h>

#include <fstream>
#include <limits>

using namespace geofx::test;
namespace fs = std::filesystem;

namespace
{

class BuilderInput : public ::testing::Test
{
protected:
    /// A DEM of one degree that could be used.
    std::string goodDem(const std::string& name = "good.tif", double west = 10.0)
    {
        return writeRelief(_folder / name, 50, 50, west, 50.0, 0.02);
    }

    std::string output() const { return _folder / "db"; }

    ProgramResult run(const std::vector<std::string>& arguments) const
    {
        std::vector<std::string> command{builtProgram("osggeofx_build"), "--quiet"};
        command.insert(command.end(), arguments.begin(), arguments.end());
        return runProgram(command);
    }

    /// Runs it and expects a refusal whose line has all of `parts`.
    void expectRefusal(std::vector<std::string> arguments, const std::vector<std::string>& parts) const
    {
        SCOPED_TRACE(::testing::PrintToString(arguments));
        arguments.insert(arguments.end(), {"-o", output()});
        expectRefusalLine(run(arguments), parts);
        EXPECT_FALSE(fs::exists(output() + "/terrain.osgb"));
    }

    static void expectRefusalLine(const ProgramResult& result, const std::vector<std::string>& parts)
    {
        EXPECT_EQ(result.exitCode, 2);
        const std::string& line = result.standardError;
        EXPECT_EQ(line.rfind("osggeofx_build: ", 0), 0u) << line;
        EXPECT_TRUE(line.size() > 2 && line.substr(line.size() - 2) == ".\n") << line;
        EXPECT_EQ(line.find('\n'), line.size() - 1) << line;
        for (const auto& part : parts)
            EXPECT_NE(line.find(part), std::string::npos) << "no \"" << part << "\" in: " << line;
        EXPECT_EQ(result.standardOutput, "");
    }

    void expectDemRefusal(const std::string& file, const std::vector<std::string>& parts) const
    {
        std::vector<std::string> all{file};
        all.insert(all.end(), parts.begin(), parts.end());
        expectRefusal({"--dem", file}, all);
    }

    std::string cut(const std::string& file, const std::string& name, double share) const
    {
        fs::copy_file(file, _folder / name);
        fs::resize_file(_folder / name,
                        static_cast<std::uintmax_t>(static_cast<double>(fs::file_size(file)) * share));
        return _folder / name;
    }

    const TempDir _folder;
};

TEST_F(BuilderInput, MissingAndEmptyFiles)
{
    expectDemRefusal(_folder / "nothing.tif", {"there is no such file", "check the path"});
    expectDemRefusal(_folder.write("empty.tif", ""), {"the file is empty", "export it again"});
    expectRefusal({"--dem", goodDem(), "--imagery", _folder / "nothing.jpg"},
                  {"nothing.jpg: there is no such file"});
    const std::string table = _folder.write("t.csv", "value,class,name,red,green,blue\n1,a,A,1,2,3\n");
    expectRefusal({"--dem", goodDem(), "--landcover", _folder / "nothing.tif", "--landcover-table", table},
                  {"nothing.tif: there is no such file"});
}

TEST_F(BuilderInput, TruncatedRasters)
{
    for (const auto& compression : {"COMPRESS=NONE", "COMPRESS=DEFLATE", "TILED=YES"})
    {
        SCOPED_TRACE(compression);
        const std::string file = TestRaster(300, 300)
                                     .placed(10.0, 50.0, 0.002, 0.002)
                                     .crs("EPSG:4326")
                                     .fill([](int column, int row, int) { return relief(column, row); })
                                     .write(_folder / "whole.tif", {compression});
        const std::string name = compression;
        expectDemRefusal(cut(file, name + "half.tif", 0.5), {"cannot be read", "cut short"});
        expectDemRefusal(cut(file, name + "nearly.tif", 0.97), {"cannot be read", "cut short"});
        expectDemRefusal(cut(file, name + "start.tif", 0.0002),
                         {"not a raster that GDAL can read", "gdalinfo"});
    }
}

TEST_F(BuilderInput, ThingsThatAreNoRasters)
{
    expectDemRefusal(_folder.write("notes.txt", "These are notes.\n"), {"not a raster", "gdalinfo"});
    expectDemRefusal(_folder.write("points.geojson", R"({"type":"FeatureCollection","features":[]})"),
                     {"vector data and no raster", "gdal_rasterize"});
    fs::create_directory(_folder / "folder");
    expectDemRefusal(_folder / "folder", {"not a raster"});
    expectDemRefusal(_folder.write("noise.tif", std::string("II*\0\xff\xff\xff\xff", 8)), {"not a raster"});
    expectDemRefusal(_folder.write("wrong.vrt", "<VRTDataset rasterXSize=\"10\""), {"not a raster"});
}

TEST_F(BuilderInput, RastersWithoutPlace)
{
    const auto value = [](int column, int row, int)
    {
        return relief(column, row);
    };
    expectDemRefusal(TestRaster(20, 20).crs("EPSG:4326").fill(value).write(_folder / "a.tif"),
                     {"no georeference", "gdal_translate -a_ullr"});
    expectDemRefusal(TestRaster(20, 20).placed(10.0, 50.0, 0.1, 0.1).fill(value).write(_folder / "b.tif"),
                     {"no coordinate reference system", "gdal_translate -a_srs"});
    expectDemRefusal(TestRaster(20, 20)
                         .placed(10.0, 50.0, 0.1, 0.1)
                         .crs("LOCAL_CS[\"mine\",UNIT[\"m\",1]]")
                         .fill(value)
                         .write(_folder / "c.tif"),
                     {"no coordinate reference system"});
    expectDemRefusal(TestRaster(20, 20)
                         .geoTransform({10.0, 0.1, 0.1, 50.0, 0.1, 0.1})
                         .crs("EPSG:4326")
                         .fill(value)
                         .write(_folder / "d.tif"),
                     {"gdal_translate"});
}

TEST_F(BuilderInput, ValuesThatCannotBeUsed)
{
    const auto placed = [](TestRaster raster, double value, const fs::path& file)
    {
        return raster.placed(10.0, 50.0, 0.05, 0.05)
            .crs("EPSG:4326")
            .fill([=](int, int, int) { return value; })
            .write(file);
    };
    expectDemRefusal(placed(TestRaster(20, 20, 1, GDT_CFloat32), 1.0, _folder / "complex.tif"),
                     {"complex numbers", "-ot Float32"});
    const double nan = std::numeric_limits<double>::quiet_NaN();
    expectDemRefusal(placed(TestRaster(20, 20), nan, _folder / "nan.tif"), {"no data at all", "gdalinfo"});
    expectDemRefusal(placed(TestRaster(20, 20), -32768.0, _folder / "undeclared.tif"),
                     {"no data at all", "gdalinfo"});
    expectDemRefusal(placed(TestRaster(1, 1), 100.0, _folder / "pixel.tif"), {"at least 2 × 2"});
    const std::string image = placed(TestRaster(20, 20, 1, GDT_Float32), 0.5, _folder / "image.tif");
    expectRefusal({"--dem", goodDem(), "--imagery", image}, {image, "not colors", "-ot Byte"});
    const std::string classes = placed(TestRaster(20, 20, 1, GDT_Int32), 1.0, _folder / "classes.tif");
    const std::string table = _folder.write("t.csv", "value,class,name,red,green,blue\n1,a,A,1,2,3\n");
    expectRefusal({"--dem", goodDem(), "--landcover", classes, "--landcover-table", table},
                  {classes, "one byte"});
}

TEST_F(BuilderInput, RastersThatDoNotMeet)
{
    const std::string dem = goodDem(), far = goodDem("far.tif", 30.0);
    const std::string image = TestRaster(20, 20, 3, GDT_Byte)
                                  .placed(30.0, 50.0, 0.05, 0.05)
                                  .crs("EPSG:4326")
                                  .write(_folder / "image.tif");
    expectRefusal({"--dem", dem, "--imagery", image}, {image, "outside the elevation", "leave the file out"});
    const std::string table = _folder.write("t.csv", "value,class,name,red,green,blue\n1,a,A,1,2,3\n");
    const std::string classes = TestRaster(20, 20, 1, GDT_Byte)
                                    .placed(10.0, 20.0, 0.05, 0.05)
                                    .crs("EPSG:4326")
                                    .write(_folder / "classes.tif");
    expectRefusal({"--dem", dem, "--landcover", classes, "--landcover-table", table}, {classes, "outside"});
    expectRefusal({"--dem", dem, "--tree-cover", far}, {far, "outside the elevation", "leave the file out"});
    // A full turn away is the same place.
    const std::string turned = TestRaster(20, 20, 3, GDT_Byte)
                                   .placed(370.0, 50.0, 0.05, 0.05)
                                   .crs("EPSG:4326")
                                   .write(_folder / "turned.tif");
    EXPECT_EQ(run({"--dem", dem, "--imagery", turned, "-o", output()}).exitCode, 0);
}

TEST_F(BuilderInput, TreeCover)
{
    const std::string dem = goodDem();
    expectRefusal({"--dem", dem, "--tree-cover", _folder / "none.tif"},
                  {"none.tif", "there is no such file"});
    TestRaster picture(20, 20, 1, GDT_Byte);
    picture.placed(10.0, 50.0, 0.05, 0.05).crs("EPSG:4326");
    GDALColorTable colors;
    const GDALColorEntry green{0, 120, 0, 255};
    colors.SetColorEntry(1, &green);
    picture.dataset().GetRasterBand(1)->SetColorTable(&colors);
    const std::string file = picture.write(_folder / "palette.tif");
    expectRefusal({"--dem", dem, "--tree-cover", file}, {file, "palette", "percent"});
}

TEST_F(BuilderInput, LandCoverTables)
{
    const std::string dem = goodDem();
    const std::string classes = TestRaster(20, 20, 1, GDT_Byte)
                                    .placed(10.0, 50.0, 0.05, 0.05)
                                    .crs("EPSG:4326")
                                    .write(_folder / "classes.tif");
    const std::string bad =
        _folder.write("bad.csv", "value,class,name,red,green,blue\n1,a,A,1,2,3\n2,b,B,1,2,300\n");
    expectRefusal({"--dem", dem, "--landcover", classes, "--landcover-table", bad},
                  {bad + ":3: ", "\"blue\"", "\"300\"", "from 0 to 255"});
    expectRefusal({"--dem", dem, "--landcover", classes}, {classes, "--landcover-table CSV"});
    expectRefusal({"--dem", dem, "--landcover-table", bad}, {bad, "--landcover FILE"});
    expectRefusal({"--dem", dem, "--landcover", classes, "--landcover-table", _folder / "none.csv"},
                  {"none.csv", "land-cover table"});
    expectRefusal({"--dem", dem, "--landcover", classes, "--landcover-table", "worldcovr"},
                  {"worldcovr: ", "worldcover, corine, nlcd, flightgear"});
    EXPECT_EQ(run({"--dem", dem, "--land-cover", classes, "--land-cover-table", "worldcover", "-o", output()})
                  .exitCode,
              0);
}

TEST_F(BuilderInput, OptionsOutOfRange)
{
    const std::string dem = goodDem();
    expectRefusal({"--dem", dem, "--srs", "EPSG:4326"}, {"EPSG:4326", "not a projected CRS", "--geocentric"});
    expectRefusal({"--dem", dem, "--srs", "EPSG:999999"}, {"EPSG:999999", "projinfo"});
    expectRefusal({"--dem", dem, "--srs", "UTM"}, {"--srs UTM", "EPSG:32604"});
    expectRefusal({"--dem", dem, "--tile-size", "3"}, {"tile size"});
    expectRefusal({"--dem", dem, "--texture-size", "-2"}, {"texture size"});
    expectRefusal({"--dem", dem, "--memory", "5"}, {"128 MiB", "--memory"});
    expectRefusal({"--dem", dem, "--pixel-error", "0"}, {"pixel error"});
    expectRefusal({"--dem", dem, "--pixel-error", "nan"}, {"pixel error"});
    expectRefusal({"--dem", dem, "--texel-error", "-1"}, {"texel error"});
    expectRefusal({"--dem", dem, "--tree-line", "-1"}, {"tree line"});
    expectRefusal({"--dem", dem, "--lake-area", "-1"}, {"area of a lake"});
    // What the command line's own grammar refuses has the same exit code.
    EXPECT_EQ(run({"--dem", dem}).exitCode, 2);
    EXPECT_EQ(run({"-o", output()}).exitCode, 2);
    EXPECT_EQ(run({"--dem", dem, "-o", output(), "--wings"}).exitCode, 2);
    EXPECT_EQ(run({"--dem", dem, "-o", output(), "--srs", "EPSG:32604", "--geocentric"}).exitCode, 2);
    EXPECT_EQ(run({"--dem", dem, "-o", output(), "--vertical", "sea"}).exitCode, 2);
    EXPECT_FALSE(fs::exists(output()));
    EXPECT_EQ(run({"--help"}).exitCode, 0);
}

TEST_F(BuilderInput, FoldersThatCannotBeWritten)
{
    const std::string dem = goodDem(), file = _folder.write("file", "text");
    for (const std::string& folder :
         {file + "/db", file, std::string("/proc/osggeofx/db"), std::string("/dev/null")})
    {
        SCOPED_TRACE(folder);
        expectRefusalLine(run({"--dem", dem, "-o", folder}), {folder, "-o"});
    }
    EXPECT_EQ(fs::file_size(file), 4u);
}

TEST_F(BuilderInput, FoldersOfOthersAreLeftAlone)
{
    const std::string dem = goodDem();
    const std::string notes = _folder.write("db/notes.txt", "mine");
    expectRefusal({"--dem", dem}, {output(), "holds other files", "-o"});
    expectRefusal({"--dem", dem, "--resume"}, {output(), "holds other files"});
    EXPECT_EQ(fs::file_size(notes), 4u);
    EXPECT_EQ(std::distance(fs::directory_iterator(output()), fs::directory_iterator()), 1);
}

TEST_F(BuilderInput, BadInputLeavesAnOldDatabaseAlone)
{
    ASSERT_EQ(run({"--dem", goodDem(), "-o", output()}).exitCode, 0);
    const auto size = fs::file_size(output() + "/terrain.osgb");
    EXPECT_EQ(run({"--dem", _folder / "nothing.tif", "-o", output()}).exitCode, 2);
    EXPECT_EQ(fs::file_size(output() + "/terrain.osgb"), size);
}

TEST_F(BuilderInput, AFailedBuildLeavesNothingThatLooksWhole)
{
    // The old database is whole; the new one stops in the middle.
    ASSERT_EQ(run({"--dem", goodDem(), "-o", output()}).exitCode, 0);
    const std::string file = writeRelief(_folder / "large.tif", 300, 300, 10.0, 50.0, 0.002);
    const std::string half = cut(file, "half.tif", 0.5);
    // An update leaves the old one as it is, and --anew has removed it before.
    expectRefusalLine(run({"--dem", half, "-o", output()}), {"cut short"});
    EXPECT_TRUE(fs::exists(output() + "/terrain.osgb"));
    expectRefusal({"--dem", half, "--anew"}, {"cut short"});
}

} // namespace
