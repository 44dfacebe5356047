// SPDX-License-Identifier: MIT
// SPDX-FileCopyrightText: 2026 the osgGeoFX authors
#pragma once

#include <cstddef>
#include <cstdint>
#include <vector>

namespace osgGeoFX
{

/// One bit for each cell of a raster. Several threads may write different rows at once.
class CellMask
{
public:
    CellMask(int columnCount, int rowCount)
        : columns(columnCount), rows(rowCount), _words((static_cast<std::size_t>(columnCount) + 63) / 64),
          _bits(_words * static_cast<std::size_t>(rowCount))
    {
    }

    const int columns, rows;

    bool at(int column, int row) const { return (word(column, row) >> (column % 64)) & 1u; }
    void set(int column, int row)
    {
        _bits[static_cast<std::size_t>(row) * _words + static_cast<std::size_t>(column) / 64] |=
            std::uint64_t{1} << (column % 64);
    }

private:
    std::uint64_t word(int column, int row) const
    {
        return _bits[static_cast<std::size_t>(row) * _words + static_cast<std::size_t>(column) / 64];
    }

    std::size_t _words;
    std::vector<std::uint64_t> _bits;
};

} // namespace osgGeoFX
