// SPDX-License-Identifier: MIT
// SPDX-FileCopyrightText: 2026 the osgGeoFX authors
#pragma once

#include <osgGeoFX/Export.h>
#include <osgGeoFX/effect/Property.h>

#include <osg/CoordinateSystemNode>
#include <osg/Matrixd>
#include <osg/Vec2d>

namespace osgGeoFX
{

/** The origin of a local frame on the ground: x points east, y north and z up, in metres.

    It has a place for each kind of terrain, and the terrain decides which one counts. On a projected terrain the frame
    is moved to (x, y), and its axes are the terrain's. On a globe the frame stands on the ellipsoid at the longitude and
    the latitude; its plane z = 0 touches the ellipsoid there.

    @ingroup effect */
struct OSGGEOFX_EXPORT LocalOrigin
{
    double x = 0.0, y = 0.0;                ///< on a projected terrain, metres, ±5e7
    double longitude = 0.0, latitude = 0.0; ///< on a globe, radians, ±π and ±π/2

    /// The origin of a frame on a projected terrain, metres.
    static LocalOrigin onPlane(const osg::Vec2d& place) { return {place.x(), place.y(), 0.0, 0.0}; }
    /// The origin of a frame on a globe, radians. A longitude beyond ±π is turned by full circles.
    static LocalOrigin onGlobe(double longitude, double latitude);

    osg::Vec2d place() const { return {x, y}; }
    /// The matrix from the frame to world coordinates. `ellipsoid` is null on a projected terrain. The frame stands
    /// `height` metres above the ellipsoid or above z = 0.
    osg::Matrixd toWorld(const osg::EllipsoidModel* ellipsoid, double height = 0.0) const;

    /// The properties of a class that has such a member: `LocalOrigin::originX().of<&Class::_origin, &LocalOrigin::x>()`.
    static Property originX();
    static Property originY();
    static Property originLongitude();
    static Property originLatitude();
};

} // namespace osgGeoFX
