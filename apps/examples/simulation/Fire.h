// SPDX-License-Identifier: MIT
// SPDX-FileCopyrightText: 2026 the osgGeoFX authors
#pragma once

#include "Field.h"

#include <osg/Vec2d>

namespace simulation
{

/** A fire that spreads by slope, wind and what grows on the ground.

    The time at which it comes to each cell is found once, as the shortest way from where it began, by Dijkstra's algorithm over
    sixteen directions: the minimum travel time of Finney (2002). Uphill it is exp(3.533 tan^1.2) times as fast as on level ground
    (Van Wagner 1977), up to 30 degrees, and slower downhill by the same; with the wind it is faster by a factor that falls with the cosine of the
    angle. It is a picture of how fires spread, not a forecast. */
class Fire
{
public:
    struct Ground
    {
        Field heights;     ///< metres
        Field speeds;      ///< of the fire on level ground in still air, m/s; 0 where nothing burns
        double cell = 0.0; ///< side of a cell, metres
        /// Where the wind blows to: east and north. Its length is how much faster the fire is with it: 1 is twice as fast.
        osg::Vec2d wind;
    };
    Fire(const Ground& ground, int column, int row);

    /// When the fire comes, seconds after it began; `never` where it does not.
    const Field& times() const { return _times; }
    /// Writes for how long each cell has been burning or burnt at a time, seconds. Where the fire comes within an hour, it is negative:
    /// so filters find its front between cells. NaN elsewhere. `image` has floats in one channel, and the grid's size.
    void draw(double time, osg::Image& image) const;
    std::size_t burnt(double time) const;

private:
    Field _times;
};

/// How fast a fire spreads over a class of data/oahu/landcover.csv on level ground in still air, m/s; 0 where nothing burns.
double fireSpeed(int landCover);

} // namespace simulation
