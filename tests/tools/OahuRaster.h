// SPDX-License-Identifier: MIT
// SPDX-FileCopyrightText: 2026 the osgGeoFX authors
#pragma once

#include <gdal_priv.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <memory>
#include <stdexcept>
#include <string>
#include <vector>

namespace geofx::test
{

/// A raster of data/oahu, all of it, in memory.
template<typename T>
class OahuRaster
{
public:
    /// Throws std::runtime_error if it cannot be read.
    OahuRaster(const std::string& name, GDALDataType type)
    {
        GDALAllRegister();
        const std::string file = std::string(GEOFX_SOURCE_DIR) + "/data/oahu/" + name;
        const std::unique_ptr<GDALDataset> data(GDALDataset::Open(file.c_str()));
        if (!data || data->GetGeoTransform(_transform.data()) != CE_None)
            throw std::runtime_error(file + " cannot be read.");
        _columns = data->GetRasterXSize();
        _rows = data->GetRasterYSize();
        _values.resize(static_cast<std::size_t>(_columns) * static_cast<std::size_t>(_rows));
        if (data->GetRasterBand(1)->RasterIO(GF_Read, 0, 0, _columns, _rows, _values.data(), _columns, _rows,
                                             type, 0, 0) != CE_None)
            throw std::runtime_error(file + " cannot be read.");
    }

    int columns() const { return _columns; }
    int rows() const { return _rows; }
    const std::array<double, 6>& transform() const { return _transform; }
    /// The value of a pixel; beyond the edge that of the pixel at the edge.
    T pixel(int column, int row) const
    {
        return _values[static_cast<std::size_t>(std::clamp(row, 0, _rows - 1)) *
                           static_cast<std::size_t>(_columns) +
                       static_cast<std::size_t>(std::clamp(column, 0, _columns - 1))];
    }
    /// The value at a place, degrees; 0 outside.
    T at(double longitude, double latitude) const
    {
        const auto column = static_cast<int>(std::floor((longitude - _transform[0]) / _transform[1]));
        const auto row = static_cast<int>(std::floor((latitude - _transform[3]) / _transform[5]));
        if (column < 0 || row < 0 || column >= _columns || row >= _rows) return T(0);
        return pixel(column, row);
    }

private:
    std::array<double, 6> _transform{};
    int _columns = 0, _rows = 0;
    std::vector<T> _values;
};

} // namespace geofx::test
