// SPDX-License-Identifier: MIT
// SPDX-FileCopyrightText: 2026 the osgGeoFX authors
#pragma once

#include <osg/Image>

#include <cstddef>
#include <limits>
#include <vector>

namespace simulation
{

/// Numbers on a regular grid; row 0 is the southernmost.
struct Field
{
    int columns = 0, rows = 0;
    std::vector<float> cells;

    Field() = default;
    Field(int columnCount, int rowCount, float value = 0.0f)
        : columns(columnCount), rows(rowCount),
          cells(static_cast<std::size_t>(columnCount) * static_cast<std::size_t>(rowCount), value)
    {
    }
    /// Of an image of floats with one channel.
    explicit Field(const osg::Image& image) : Field(image.s(), image.t())
    {
        for (int row = 0; row < rows; ++row)
        {
            const auto* from = reinterpret_cast<const float*>(image.data(0, static_cast<unsigned int>(row)));
            std::copy(from, from + columns, &at(0, row));
        }
    }
    bool has(int column, int row) const { return column >= 0 && row >= 0 && column < columns && row < rows; }
    float& at(int column, int row)
    {
        return cells[static_cast<std::size_t>(row) * static_cast<std::size_t>(columns) +
                     static_cast<std::size_t>(column)];
    }
    float at(int column, int row) const { return const_cast<Field&>(*this).at(column, row); }
};

constexpr float never = std::numeric_limits<float>::infinity();

} // namespace simulation
