// SPDX-License-Identifier: MIT
// SPDX-FileCopyrightText: 2026 the osgGeoFX authors
#include <osgGeoFX/effect/LocalOrigin.h>

#include <osg/Math>

#include <cmath>

namespace osgGeoFX
{

namespace
{

constexpr double farthest = 5e7;

}

LocalOrigin LocalOrigin::onGlobe(double longitude, double latitude)
{
    return {0.0, 0.0, std::remainder(longitude, 2.0 * osg::PI), latitude};
}

osg::Matrixd LocalOrigin::toWorld(const osg::EllipsoidModel* ellipsoid, double height) const
{
    osg::Matrixd result = osg::Matrixd::translate(x, y, height);
    if (ellipsoid)
        ellipsoid->computeLocalToWorldTransformFromLatLongHeight(latitude, longitude, height, result);
    return result;
}

Property LocalOrigin::originX()
{
    return Property::number("originX", "the frame's origin on a projected terrain, to the east", -farthest,
                            farthest, "m");
}

Property LocalOrigin::originY()
{
    return Property::number("originY", "the frame's origin on a projected terrain, to the north", -farthest,
                            farthest, "m");
}

Property LocalOrigin::originLongitude()
{
    return Property::angle("longitude", "the longitude of the frame's origin on a globe, to the east",
                           -osg::PI, osg::PI);
}

Property LocalOrigin::originLatitude()
{
    return Property::angle("latitude", "the latitude of the frame's origin on a globe, to the north",
                           -osg::PI_2, osg::PI_2);
}

} // namespace osgGeoFX
