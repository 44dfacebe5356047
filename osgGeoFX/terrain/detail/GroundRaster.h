// SPDX-License-Identifier: MIT
// SPDX-FileCopyrightText: 2026 the osgGeoFX authors
#pragma once

#include <osgGeoFX/terrain/detail/CellMask.h>
#include <osgGeoFX/terrain/detail/RowFile.h>

#include <atomic>
#include <cstdint>
#include <memory>
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

/** Shores and likely trees of the whole terrain. Distances go on across tiles, and a place has one value on whichever
    tile it lies. It is a raster in a work file, as dense as the land cover, or else as the elevation, but with at
    most 16,385 points a side. Sampling is thread-safe. */
class GroundRaster
{
public:
    /// The size of the raster for a plan.
    struct Size
    {
        int columns = 2, rows = 2; ///< points; the outermost lie on the extent's corners
    };
    static Size sizeFor(const BuildPlan& plan);
    /// The steps of progress of making it.
    static int steps(const BuildPlan& plan);

    /// Reads the raster that runGroundPass() has written. Throws BuildError.
    explicit GroundRaster(const BuildPlan& plan);

    /// Bilinear samples at texels of the finest level, counted from the extent's south-western corner.
    std::vector<GroundCell> sample(std::int64_t firstColumn, std::int64_t firstRow, int columns,
                                   int rows) const;

private:
    const BuildPlan& _plan;
    const Size _size;
    RowFile _file;
};

/// The height up to which trees grow at a latitude in degrees, metres above the sea: 3,800 up to 25°, then evenly
/// down to 0 at 70°.
double likelyTreeLine(double latitude);

/// Samples classes and heights, finds water, and measures the distances from its shores. Sets the plan's `ground`.
/// Takes over the raster of an interrupted build.
void runGroundPass(BuildPlan& plan);

} // namespace osgGeoFX
