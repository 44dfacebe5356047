// SPDX-License-Identifier: MIT
// SPDX-FileCopyrightText: 2026 the osgGeoFX authors
#pragma once

#include <osgGeoFX/Export.h>
#include <osgGeoFX/lines/LineStyle.h>
#include <osgGeoFX/lines/MapLine.h>
#include <osgGeoFX/panorama/TerrainRelief.h>

#include <osg/CoordinateSystemNode>
#include <osg/Node>

#include <cstddef>
#include <map>
#include <string>
#include <vector>

namespace osgGeoFX
{

/** Puts lines on the ground of a terrain.

    Lines come as vector data has them: places in the units of TerrainRelief's extent. They go as MapLines takes them: world coordinates
    on the ground, with more places where the ground between two of them is not flat.
    @ingroup lines */
struct OSGGEOFXMAPS_EXPORT LinePlacement
{
    /// The longest way between two places on the ground, metres; 0: as long as a cell of the relief, at least 10.
    double step = 0.0;
    /// How far the drawn line may be from the ground, metres, where it leaves out places that lie between others; ≥ 0.
    double tolerance = 0.5;
    /// Places whose ground is read as finely as the database has it; others get that of the relief, whose cells may be coarse.
    std::size_t finest = 200000;
    /// How high the wire of a line through the air is above its places, metres.
    double wire = 8.0;

    struct Result
    {
        std::size_t outside = 0; ///< lines that were left out, for they lie beside the terrain
        std::size_t places = 0;  ///< of all lines
    };

    /** Places the lines on a terrain, in their order. A line that leaves the terrain is cut into the parts that lie on it. `relief`: the
        terrain's. `ellipsoid`: as for TerrainRelief::read(). Lines that are not shown are left out. Reads tiles from files; no other
        thread may change the terrain meanwhile. */
    Result place(std::vector<MapLine>& lines, const std::map<std::string, LineStyle>& styles,
                 const osg::Node& terrain, const osg::EllipsoidModel* ellipsoid,
                 const TerrainRelief& relief) const;
};

} // namespace osgGeoFX
