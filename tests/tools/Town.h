// SPDX-License-Identifier: MIT
// SPDX-FileCopyrightText: 2026 the osgGeoFX authors
#pragma once

#include <osg/Geometry>
#include <osg/Group>
#include <osg/Vec2d>

#include <functional>

namespace geofx::test
{

/** A small made-up town: streets on a grid, a river through it, and houses with flat and gabled roofs, higher towards the
    middle. The same town for the same seed. x, y and z are metres about the given center; z is up. */
struct TownPlan
{
    osg::Vec2d center;
    int blocksAcross = 8; ///< along x
    int blocksAlong = 8;
    double block = 90.0; ///< side, without the street
    double street = 18.0;
    double river = 60.0; ///< width; 0: none
    std::uint64_t seed = 1;
    /// The ground below a place; flat at 0 where it is empty.
    std::function<double(double x, double y)> height;
};

/// Where the blocks are that are not in the river.
std::vector<osg::Vec2d> townBlocks(const TownPlan& plan);

/// All houses, 4 to 9 of them in a block, in one geometry with normals and colors.
osg::ref_ptr<osg::Geometry> makeTown(const TownPlan& plan);
/// The same town generalised: a flat prism for each block, as high as its houses are on average.
osg::ref_ptr<osg::Geometry> makeGeneralisedTown(const TownPlan& plan);
/// The ground: blocks, streets and the river as flat colors, `margin` metres around, on the heights of the plan.
osg::ref_ptr<osg::Geometry> makeTownGround(const TownPlan& plan, double margin);

} // namespace geofx::test
