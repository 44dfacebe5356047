// SPDX-License-Identifier: MIT
// SPDX-FileCopyrightText: 2026 the osgGeoFX authors
#pragma once

#include <osgGeoFX/batch/detail/ContentHash.h>
#include <osgGeoFX/terrain/detail/CellMask.h>
#include <osgGeoFX/terrain/detail/RowFile.h>

#include <atomic>
#include <cstdint>
#include <memory>
#include <string>
#include <vector>

namespace osgGeoFX
{

class BuildPlan;
class RasterStack;

/// What water and heights alone tell of a place, coded as in shaders/lib/cover.glsl.
struct GroundCell
{
    std::uint16_t shore = 0; ///< the alpha of a cover texel in 1/65280: 256 for each step of a byte
    std::uint8_t trees = 0, bare = 0;
};

/// A raster of shores over a rectangle of the grid.
struct GroundPatch
{
    int firstColumn = 0, firstRow = 0, lastColumn = 1, lastRow = 1; ///< finest posts on its corners
    int columns = 2, rows = 2; ///< points; the outermost lie on the border
};

/** Shores and likely trees of the whole terrain. Distances go on across tiles, and a place has one value on whichever
    tile it lies. It is a raster in a work file, as dense as the land cover, or else as the elevation, but with at
    most 16,385 points a side. If elevation files differ in density, it is as dense as the coarsest, and each denser
    layer has a raster of its own around it, which fades into those before it towards its border. Sampling is
    thread-safe. */
class GroundRaster
{
public:
    /// The most points along a side. It limits the time to some minutes and the work files to two gigabytes.
    static constexpr int LARGEST_SIDE = 16385;
    static std::string file(const BuildPlan& plan, std::size_t patch);

    /// Reads the rasters that the stages of the ground have written. Throws BuildError.
    explicit GroundRaster(const BuildPlan& plan);

    /// Texels from a finest post on. `texels` of them go to `posts` finest posts.
    struct Texels
    {
        int firstColumn = 0, firstRow = 0, posts = 1, texels = 1;
    };
    /// Bilinear samples at texels.
    std::vector<GroundCell> sample(const Texels& first, int columns, int rows) const;

    /// Of all that sample() reads in a rectangle of finest posts.
    Digest digest(int firstColumn, int firstRow, int lastColumn, int lastRow) const;

private:
    const BuildPlan& _plan;
    std::vector<std::unique_ptr<RowFile>> _files; ///< by patch
};

/// The height up to which trees grow at a latitude in degrees, metres above the sea: 3,800 up to 25°, then evenly
/// down to 0 at 70°.
double likelyTreeLine(double latitude);

} // namespace osgGeoFX
