// SPDX-License-Identifier: MIT
// SPDX-FileCopyrightText: 2026 the osgGeoFX authors
#pragma once

#include <osg/Matrixd>

#include <filesystem>

namespace geofx::test
{

/** A small paged quadtree as osggeofx_build writes one, for tests of paging that need no rasters.

    A flat square of 4 × 4 km around the origin of a local frame, each level in a color of its own: level 0 red
    (one tile), 1 green (2 × 2), 2 blue (4 × 4), unlit. Level 1 comes nearer than 100 km, level 2 nearer than
    20 km. The files below the folder: terrain.osgb, tiles/0_0_0.osgb (the four tiles of level 1) and
    tiles/1_X_Y.osgb (four tiles of level 2 each), X eastwards and Y northwards. */
struct PagedScene
{
    enum class Kind
    {
        Flat,      ///< no coordinate system; x east, y north
        Geocentric ///< around longitude −157.8°, latitude 21.4°, height 100 m
    };

    /// Returns the path of terrain.osgb.
    static std::filesystem::path write(const std::filesystem::path& folder, Kind kind);

    /// From the local frame to the world.
    static osg::Matrixd placement(Kind kind);
};

} // namespace geofx::test
