// SPDX-License-Identifier: MIT
// SPDX-FileCopyrightText: 2026 the osgGeoFX authors
#pragma once

#include <osgGeoFX/Export.h>
#include <osgGeoFX/labels/MapName.h>
#include <osgGeoFX/panorama/TerrainRelief.h>

#include <osg/CoordinateSystemNode>
#include <osg/Node>

#include <string>
#include <vector>

namespace osgGeoFX
{

/** Puts names on the ground of a terrain.

    Names come as vector data has them: places in the units of TerrainRelief's extent, with a height in metres above the sea or
    not a number. They go as NameSet takes them: world coordinates on the ground.
    @ingroup labels */
struct OSGGEOFXMAPS_EXPORT NamePlacement
{
    /// How far a name of one place is moved to the summit that it means, metres; 0: not at all. Vector data and elevation rarely agree to
    /// a cell.
    double reach = 250.0;
    /// The styles of names that are summits, and are moved.
    std::vector<std::string> summits = {"", "summit", "peak", "volcano", "mountain", "hill"};
    /// Places whose ground is read as finely as the database has it, those of the most important names first; others get that of the relief, whose
    /// cells may be coarse.
    std::size_t finest = 5000;

    struct Result
    {
        std::size_t outside = 0; ///< names that were left out, for they lie beside the terrain
        std::size_t moved = 0;   ///< names that were moved to a summit
    };

    /** Places the names on a terrain, in their order. `relief`: the terrain's. `ellipsoid`: as for TerrainRelief::read().

        A summit without an importance gets that of its topographic prominence, metres, or else a small one that grows with its
        height. Names of other styles keep theirs. Reads tiles from files; no other thread may change the terrain meanwhile. */
    Result place(std::vector<MapName>& names, const osg::Node& terrain, const osg::EllipsoidModel* ellipsoid,
                 const TerrainRelief& relief) const;
};

} // namespace osgGeoFX
