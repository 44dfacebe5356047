// SPDX-License-Identifier: MIT
// SPDX-FileCopyrightText: 2026 the osgGeoFX authors
#pragma once

#include <osgGeoFX/Export.h>

#include <osg/CoordinateSystemNode>
#include <osg/Node>
#include <osg/Vec2d>
#include <osg/Vec3d>

#include <cstddef>
#include <optional>
#include <string>
#include <vector>

namespace osgGeoFX
{

/** The heights of a whole terrain as a small raster, for programs that must know a terrain before they show it.

    Places of the extent are longitude and latitude in degrees on a globe, and metres of the world on a plane. East may
    exceed 180. Rows count from the south. It is a plain value.
    @ingroup panorama */
struct OSGGEOFX_EXPORT TerrainRelief
{
    bool geocentric = false;
    double west = 0.0;
    double south = 0.0;
    double east = 0.0;
    double north = 0.0;
    int columns = 0;
    int rows = 0;
    std::vector<float> heights; ///< metres; not a number where there is no ground
    std::vector<char>
        water; ///< 1 where the ground is water, by the tiles' cover, else by a height of 0 or less

    /// Reads the terrain below a node. Databases of osggeofx_build are read from their files, as coarse as the raster
    /// allows. Of other terrains it takes the triangles that are loaded. `cells`: of the longer side, 16…4096.
    /// `ellipsoid`: the globe's; null on a plane. Empty, with a sentence in `error`, if there is no ground. No other
    /// thread may change the scene meanwhile.
    static std::optional<TerrainRelief> read(const osg::Node& terrain, const osg::EllipsoidModel* ellipsoid,
                                             int cells, std::string& error);

    std::size_t index(int column, int row) const
    {
        return static_cast<std::size_t>(row) * static_cast<std::size_t>(columns) +
               static_cast<std::size_t>(column);
    }
    /// The size of a metre at a latitude of the extent, in the extent's units to the east and to the north.
    osg::Vec2d metre(double latitude) const;
    /// The extent's size through its middle, metres.
    osg::Vec2d size() const;
    /// The middle of a cell, in the extent's units.
    osg::Vec2d place(int column, int row) const
    {
        return {west + (column + 0.5) * (east - west) / columns,
                south + (row + 0.5) * (north - south) / rows};
    }
    /// Of the cell at a place of the extent, metres; not a number beside the extent. A longitude may be a full turn off.
    double heightAt(double x, double y) const;
    /// The same terrain with fewer cells. Each takes the highest of its cells' heights, and is water if most of them are.
    TerrainRelief coarser(int factor) const;
};

} // namespace osgGeoFX
