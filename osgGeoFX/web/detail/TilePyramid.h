// SPDX-License-Identifier: MIT
// SPDX-FileCopyrightText: 2026 the osgGeoFX authors
#pragma once

#include <cstddef>
#include <memory>
#include <string>
#include <vector>

namespace osgGeoFX
{

/** The tiles of a picture at all zooms. Each has 256 pixels in a row and in a column, and the first ones of the tiles to its right and below it:
    so tiles that are drawn larger or smaller, with edges between the screen's pixels, leave no line between them. At the picture's right and lower border they are
    smaller.

    At the highest level a pixel is a pixel of the picture. Each level below has half as many, rounded up, and the lowest one is a single
    tile. A pixel of a level is the mean light of the pixels that it covers. The picture is read row by row, and memory has a strip of tiles
    of each level. */
class TilePyramid
{
public:
    static constexpr int side = 256;
    /// The number of the highest level; the lowest one has 0.
    static int levelsOf(int width, int height);

    /// `folder`: where tiles go, as LEVEL/COLUMN/ROW.jpg. `quality`: of JPEG, 1…100.
    TilePyramid(std::string folder, int width, int height, int quality);
    ~TilePyramid();

    /// The next row, from the uppermost one: red, green and blue of each pixel, sRGB. Throws std::runtime_error with a sentence if tiles
    /// cannot be written.
    void add(const unsigned char* row);

private:
    struct Level;
    void add(std::size_t level, const unsigned char* bytes, const std::vector<float>& light);
    void writeStrip(const Level& level) const;

    std::string _folder;
    int _quality;
    std::vector<Level> _levels; ///< from the highest one
    std::vector<float> _light;
};

} // namespace osgGeoFX
