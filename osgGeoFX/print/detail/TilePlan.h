// SPDX-License-Identifier: MIT
// SPDX-FileCopyrightText: 2026 the osgGeoFX authors
#pragma once

#include <algorithm>

namespace osgGeoFX
{

/// The numbers of a tile.
struct PictureTile
{
    int column = 0, row = 0;   ///< rows from the uppermost one
    int left = 0, top = 0;     ///< pixels of the picture
    int width = 0, height = 0; ///< of what lies in the picture
};

/// The picture in tiles of about the same size.
struct TilePlan
{
    int width, height, columns, rows, tileWidth, tileHeight;

    TilePlan(int wide, int high, int longest) : width(wide), height(high)
    {
        const int most = std::clamp(longest, 64, 16384);
        columns = countOf(width, most);
        rows = countOf(height, most);
        tileWidth = (width + columns - 1) / columns;
        tileHeight = (height + rows - 1) / rows;
    }
    /// Whole tiles where a side has a divisor: then the matrices of tiles are exact, and the edges of strokes fall into the same pixels
    /// as in a picture that is drawn at once.
    static int countOf(int side, int most)
    {
        const int least = (side + most - 1) / most;
        for (int count = least; count <= 2 * least; ++count)
            if (side % count == 0) return count;
        return least;
    }
    PictureTile at(int column, int row) const
    {
        const int left = column * tileWidth, top = row * tileHeight;
        return {
            column, row, left, top, std::min(tileWidth, width - left), std::min(tileHeight, height - top)};
    }
};

} // namespace osgGeoFX
