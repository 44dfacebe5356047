// SPDX-License-Identifier: MIT
// SPDX-FileCopyrightText: 2026 the osgGeoFX authors
#include <tools/TestRasters.h>

#include <gdal_utils.h>
#include <ogr_spatialref.h>

#include <cmath>
#include <cstdio>
#include <limits>
#include <stdexcept>

namespace geofx::test
{

namespace
{

CPLStringList listOf(const std::vector<std::string>& words)
{
    CPLStringList list;
    for (const auto& word : words)
        list.AddString(word.c_str());
    return list;
}

std::string number(double value)
{
    char text[32];
    std::snprintf(text, sizeof(text), "%.17g", value);
    return text;
}

DatasetPtr opened(const std::string& file)
{
    GDALAllRegister();
    DatasetPtr dataset(GDALDataset::Open(file.c_str(), GDAL_OF_RASTER | GDAL_OF_VERBOSE_ERROR));
    if (!dataset) throw std::runtime_error("GDAL cannot open " + file);
    return dataset;
}

} // namespace

TestRaster::TestRaster(int columns, int rows, int bands, GDALDataType type)
{
    GDALAllRegister();
    _dataset.reset(
        GetGDALDriverManager()->GetDriverByName("MEM")->Create("", columns, rows, bands, type, nullptr));
}

TestRaster& TestRaster::placed(double west, double north, double pixelWidth, double pixelHeight)
{
    return geoTransform({west, pixelWidth, 0.0, north, 0.0, -pixelHeight});
}

TestRaster& TestRaster::geoTransform(std::array<double, 6> transform)
{
    _dataset->SetGeoTransform(transform.data());
    return *this;
}

TestRaster& TestRaster::placedByPoints(double x, double y, double step)
{
    std::vector<GDAL_GCP> points(4);
    GDALInitGCPs(4, points.data());
    for (int i = 0; i < 4; ++i)
    {
        GDAL_GCP& point = points[static_cast<std::size_t>(i)];
        point.dfGCPPixel = i % 2 ? _dataset->GetRasterXSize() : 0;
        point.dfGCPLine = i / 2 ? _dataset->GetRasterYSize() : 0;
        point.dfGCPX = x + step * (point.dfGCPPixel - point.dfGCPLine);
        point.dfGCPY = y - step * (point.dfGCPPixel + point.dfGCPLine);
    }
    OGRSpatialReference srs;
    srs.importFromEPSG(4326);
    srs.SetAxisMappingStrategy(OAMS_TRADITIONAL_GIS_ORDER);
    const CPLErr result = _dataset->SetGCPs(4, points.data(), &srs);
    GDALDeinitGCPs(4, points.data());
    if (result != CE_None) throw std::runtime_error("GDAL cannot take control points");
    return *this;
}

TestRaster& TestRaster::crs(const std::string& definition)
{
    OGRSpatialReference srs;
    srs.SetAxisMappingStrategy(OAMS_TRADITIONAL_GIS_ORDER);
    if (srs.SetFromUserInput(definition.c_str()) != OGRERR_NONE)
        throw std::runtime_error("not a CRS: " + definition);
    _dataset->SetSpatialRef(&srs);
    return *this;
}

TestRaster& TestRaster::fill(const Value& value)
{
    std::vector<double> line(static_cast<std::size_t>(_dataset->GetRasterXSize()));
    for (int band = 0; band < _dataset->GetRasterCount(); ++band)
        for (int row = 0; row < _dataset->GetRasterYSize(); ++row)
        {
            for (std::size_t column = 0; column < line.size(); ++column)
                line[column] = value(static_cast<int>(column), row, band);
            if (_dataset->GetRasterBand(band + 1)->RasterIO(GF_Write, 0, row, static_cast<int>(line.size()),
                                                            1, line.data(), static_cast<int>(line.size()), 1,
                                                            GDT_Float64, 0, 0, nullptr) != CE_None)
                throw std::runtime_error("GDAL cannot fill a raster in memory");
        }
    return *this;
}

std::string TestRaster::write(const std::filesystem::path& file,
                              const std::vector<std::string>& options) const
{
    const DatasetPtr written(GetGDALDriverManager()->GetDriverByName("GTiff")->CreateCopy(
        file.c_str(), _dataset.get(), FALSE, listOf(options).List(), nullptr, nullptr));
    if (!written) throw std::runtime_error("GDAL cannot write " + file.string());
    return file.string();
}

double relief(double x, double y)
{
    double height = 500.0;
    double size = 260.0, wave = 0.021;
    for (int octave = 0; octave < 6; ++octave)
    {
        height += size * std::sin(x * wave + 1.7 * octave) * std::cos(y * wave * 1.3 - 0.6 * octave);
        size *= 0.5;
        wave *= 2.3;
    }
    return height;
}

std::string writeRelief(const std::filesystem::path& file, int columns, int rows, double west, double north,
                        double pixel, const std::string& crs)
{
    return TestRaster(columns, rows)
        .placed(west, north, pixel, pixel)
        .crs(crs)
        .fill([](int column, int row, int) { return relief(column, row); })
        .write(file);
}

std::string writeHollow(const std::filesystem::path& file, int columns, int rows)
{
    GDALAllRegister();
    const CPLStringList options = listOf({"SPARSE_OK=TRUE", "BLOCKYSIZE=512"});
    const DatasetPtr dataset(GetGDALDriverManager()->GetDriverByName("GTiff")->Create(
        file.c_str(), columns, rows, 1, GDT_Byte, CPLStringList(options).List()));
    if (!dataset) throw std::runtime_error("GDAL cannot write " + file.string());
    return file.string();
}

std::string writeCrop(const std::string& from, const std::filesystem::path& file, int column, int row,
                      int columns, int rows)
{
    const DatasetPtr source = opened(from);
    const CPLStringList arguments = listOf({"-srcwin", std::to_string(column), std::to_string(row),
                                            std::to_string(columns), std::to_string(rows)});
    GDALTranslateOptions* options = GDALTranslateOptionsNew(CPLStringList(arguments).List(), nullptr);
    const DatasetPtr crop(GDALDataset::FromHandle(
        GDALTranslate(file.c_str(), GDALDataset::ToHandle(source.get()), options, nullptr)));
    GDALTranslateOptionsFree(options);
    if (!crop) throw std::runtime_error("GDAL cannot write " + file.string());
    return file.string();
}

std::vector<float> warpedHeights(const std::vector<std::string>& files, const std::string& crs, double x0,
                                 double y0, double dx, double dy, int columns, int rows)
{
    // The warp utility's pixels are centered on the points.
    CPLStringList arguments =
        listOf({"-of", "MEM",           "-ot", "Float32",  "-t_srs",     crs,
                "-r",  "bilinear",      "-et", "0",        "-dstnodata", "nan",
                "-wo", "XSCALE=1",      "-wo", "YSCALE=1", "-wo",        "SAMPLE_GRID=YES",
                "-wo", "SOURCE_EXTRA=4"});
    for (const auto& word :
         {std::string("-te"), number(x0 - dx / 2), number(y0 - dy / 2), number(x0 + (columns - 0.5) * dx),
          number(y0 + (rows - 0.5) * dy), std::string("-ts"), std::to_string(columns), std::to_string(rows)})
        arguments.AddString(word.c_str());

    std::vector<DatasetPtr> sources;
    std::vector<GDALDatasetH> handles;
    for (const auto& file : files)
    {
        sources.push_back(opened(file));
        handles.push_back(GDALDataset::ToHandle(sources.back().get()));
    }
    GDALWarpAppOptions* options = GDALWarpAppOptionsNew(arguments.List(), nullptr);
    const DatasetPtr warped(GDALDataset::FromHandle(
        GDALWarp("", nullptr, static_cast<int>(handles.size()), handles.data(), options, nullptr)));
    GDALWarpAppOptionsFree(options);
    if (!warped) throw std::runtime_error("GDAL cannot warp " + files.front());

    std::vector<float> heights(static_cast<std::size_t>(columns) * static_cast<std::size_t>(rows));
    // A negative line spacing turns the picture: its first row is the northernmost.
    if (warped->GetRasterBand(1)->RasterIO(
            GF_Read, 0, 0, columns, rows, heights.data() + static_cast<std::ptrdiff_t>(rows - 1) * columns,
            columns, rows, GDT_Float32, sizeof(float), -static_cast<GSpacing>(sizeof(float)) * columns,
            nullptr) != CE_None)
        throw std::runtime_error("GDAL cannot read what it has warped from " + files.front());
    return heights;
}

} // namespace geofx::test
