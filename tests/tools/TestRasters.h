// SPDX-License-Identifier: MIT
// SPDX-FileCopyrightText: 2026 the osgGeoFX authors
#pragma once

#include <gdal_priv.h>

#include <array>
#include <filesystem>
#include <functional>
#include <memory>
#include <string>
#include <vector>

namespace geofx::test
{

struct DatasetCloser
{
    void operator()(GDALDataset* dataset) const { GDALClose(dataset); }
};
using DatasetPtr = std::unique_ptr<GDALDataset, DatasetCloser>;

/** A raster made in memory, to be written as GeoTIFF. It starts without georeference and CRS. What has no
    method here (no-data, unit, scale, palette, control points) is set on dataset(). */
class TestRaster
{
public:
    /// Value of a band (from 0) at a pixel (column and row from the north-west, from 0).
    using Value = std::function<double(int column, int row, int band)>;

    TestRaster(int columns, int rows, int bands = 1, GDALDataType type = GDT_Float32);

    /// North up: the outer corner of the north-western pixel, and the pixels' sizes, both positive.
    TestRaster& placed(double west, double north, double pixelWidth, double pixelHeight);
    TestRaster& geoTransform(std::array<double, 6> transform);
    /// By ground control points in EPSG:4326, turned by 45°: the corner of pixel (c, r) lies at x + step · (c − r),
    /// y − step · (c + r) degrees.
    TestRaster& placedByPoints(double x, double y, double step);
    /// Anything that OGRSpatialReference takes, in GIS order: x is longitude or easting.
    TestRaster& crs(const std::string& definition);
    TestRaster& fill(const Value& value);

    GDALDataset& dataset() { return *_dataset; }

    /// Writes it and returns the path. Creation options as GDAL's driver takes them: "NAME=VALUE".
    std::string write(const std::filesystem::path& file, const std::vector<std::string>& options = {}) const;

private:
    DatasetPtr _dataset;
};

/// Mountains and valleys from one formula: metres, between about 0 and 1000, for pixels or any other unit.
double relief(double x, double y);

/// Writes relief() of columns and rows as Float32, north up, and returns the path.
std::string writeRelief(const std::filesystem::path& file, int columns, int rows, double west, double north,
                        double pixel, const std::string& crs = "EPSG:4326");

/// Writes a GeoTIFF of bytes, all 0, with so many pixels that are not stored: a large raster in a small file. Returns the path.
std::string writeHollow(const std::filesystem::path& file, int columns, int rows);

/// Part of a raster file as a GeoTIFF of its own; returns the path.
std::string writeCrop(const std::string& from, const std::filesystem::path& file, int column, int row,
                      int columns, int rows);

/** GDAL's own bilinear samples, made by GDAL's warp utility, which knows nothing of osgGeoFX: at the points
    (x0 + i·dx, y0 + j·dy), row 0 the southernmost, in a CRS; NaN where the files have no data. Later files
    win. */
std::vector<float> warpedHeights(const std::vector<std::string>& files, const std::string& crs, double x0,
                                 double y0, double dx, double dy, int columns, int rows);

} // namespace geofx::test
