// SPDX-License-Identifier: MIT
// SPDX-FileCopyrightText: 2026 the osgGeoFX authors
#pragma once

#include <osgGeoFX/paging/Georeference.h>
#include <osgGeoFX/panorama/TerrainRelief.h>

#include <osg/Matrixd>
#include <osg/Vec2d>

namespace geofx::bench
{

/// A flight across Oahu, 500 m above the ground at 200 m/s, in wide curves. The camera looks where it flies, a little down.
class FlightPath
{
public:
    static constexpr double SPEED = 200.0, HEIGHT = 500.0; ///< metres a second, metres

    FlightPath(const osgGeoFX::TerrainRelief& relief, const osgGeoFX::Georeference& reference)
        : _relief(relief), _reference(reference)
    {
    }

    /// World to eye.
    osg::Matrixd view(double seconds) const;

private:
    struct Pose
    {
        osg::Vec2d place; ///< longitude and latitude, degrees
        double heading;   ///< radians
    };
    Pose at(double seconds) const;
    double ground(const osg::Vec2d& place) const;

    const osgGeoFX::TerrainRelief& _relief;
    const osgGeoFX::Georeference& _reference;
};

} // namespace geofx::bench
