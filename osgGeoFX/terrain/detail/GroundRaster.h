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

/// What is known of a place from water and heights alone, as shaders/lib/cover.glsl codes it.
struct GroundCell
{
    std::uint16_t shore = 0; ///< the alpha of a cover texel in 1/65280: 256 for each step of a byte
    std::uint8_t trees = 0, bare = 0;
};

/** Shores and likely trees over the whole terrain, so that distances run on across tiles and a place has one value
    whichever tile it lies on. A raster in a work file, as dense as the land cover, or else the elevation, but at most
    16,385 points a side. Sampling is thread-safe. */
class GroundRaster
{
public:
    /// The size of the raster that a plan asks for.
    struct Size
    {
        int columns = 2, rows = 2; ///< points, the outermost on the extent's corners
    };
    static Size sizeFor(const BuildPlan& plan);
    /// Steps of progress that making it takes.
    static int steps(const BuildPlan& plan);

    /// Reads what make() has written. Throws BuildError.
    explicit GroundRaster(const BuildPlan& plan);

    /// Bilinear samples at texels of the finest level, counted from the extent's south-western corner.
    std::vector<GroundCell> sample(std::int64_t firstColumn, std::int64_t firstRow, int columns,
                                   int rows) const;

private:
    const BuildPlan& _plan;
    const Size _size;
    RowFile _file;
};

/// Metres above the sea up to which trees grow at a latitude in degrees: 3,800 from the equator to 25°, from there
/// evenly down to 0 at 70°.
double likelyTreeLine(double latitude);

/// Samples classes and heights, finds water, measures the distances from its shores; sets the plan's `ground`.
/// An interrupted build's is taken over.
void runGroundPass(BuildPlan& plan);

} // namespace osgGeoFX
