// SPDX-License-Identifier: MIT
// SPDX-FileCopyrightText: 2026 the osgGeoFX authors
#pragma once

#include <osgGeoFX/batch/detail/ContentHash.h>
#include <osgGeoFX/terrain/detail/RowFile.h>
#include <osgGeoFX/terrain/detail/VoidFinder.h>

#include <osgGeoFX/geodata/detail/RasterSource.h>

#include <cstdint>
#include <memory>
#include <optional>
#include <string>
#include <vector>

namespace osgGeoFX
{

class BuildPlan;

/** The posts of an elevation with voids, on the level of its coarsest files: heights above the sea, the kind of each post, and the heights
    of filled voids (NaN if GDAL found no data near enough). They are three work files, which the stages of voids write. Sampling is thread-safe. */
class VoidRaster
{
public:
    /// Reads what the stages of voids have written. Throws BuildError.
    explicit VoidRaster(const BuildPlan& plan);

    /// Gives heights to points without one (NaN) that lie in filled voids, metres above the sea, bilinear between
    /// posts. `filled` is null, or has a byte for each point, which becomes 1 there.
    void fill(const Lattice& lattice, std::vector<float>& heights, std::vector<unsigned char>* filled) const;

    /// Of the filled posts that fill() reads for a lattice. Empty if there are none.
    std::optional<Digest> digest(const Lattice& lattice) const;

    /// The posts of the lattice of voids.
    int columns() const { return _columns; }
    int rows() const { return _rows; }

    std::uint64_t filledPosts() const { return _filledPosts; }
    std::uint64_t openPosts() const
    {
        return _openPosts;
    } ///< within a raster's rectangle, and without a height
    std::uint64_t dataPosts() const { return _dataPosts; }

    /// The share of filled posts over the extent, a byte for each cell. 255 is all, and any filled post gives at
    /// least 1. The south-western cell comes first. There are at most 1,024 cells a side.
    const std::vector<unsigned char>& mask() const { return _mask; }
    int maskColumns() const { return _maskColumns; }

    static std::string file(const BuildPlan& plan, const char* name);
    /// A file that is there if any post lacks a height. The sampling of heights makes it.
    static std::string neededFile(const BuildPlan& plan) { return file(plan, "needed"); }
    static bool isNeeded(const BuildPlan& plan);

private:
    class Rows;

    const BuildPlan& _plan;
    const int _columns, _rows;
    RowFile _heights, _posts, _filled;
    std::uint64_t _filledPosts = 0, _openPosts = 0, _dataPosts = 0;
    int _maskColumns = 0;
    std::vector<unsigned char> _mask;
};

} // namespace osgGeoFX
