// SPDX-License-Identifier: MIT
// SPDX-FileCopyrightText: 2026 the osgGeoFX authors
#pragma once

#include <osgGeoFX/mapping/MappingPool.h>

#include <osg/Group>

namespace osgGeoFX
{

/** Lets two geometries share one place: within a mask the one is seen and outside of it the other, pixel by pixel
    (Trapp and Döllner 2009, Section 5 and Figure 3.D), for instance a city and its generalisation.

    Both nodes are below the mappings' EffectScene. Each gets the define GEOFX_MAPPING_CHANNELS in its state, 1 the inner one
    and 2 the outer one, so that mappings for both (the default) are drawn on both; the rest of the scene gets 252, with all
    other channels, in the state of `rest`, its root. Mappings that discard lie on top: two with the mask, and four that take
    the inner geometry away around it. The destructor takes all of it back, but for defines that were changed since. */
class OSGGEOFX_EXPORT GeometrySwap : public osg::Referenced
{
public:
    /// The mask's grey, half and more is inside, over a rectangle of the mappings' frame: centre and half size, metres.
    GeometrySwap(osg::Node& inside, osg::Node& outside, osg::Node& rest, ProjectiveMappings& mappings,
                 DataLayer* mask, const osg::Vec2d& centre, double halfWidth, double halfHeight);

    /// Null is refused.
    bool setMask(DataLayer* mask);
    /// As the constructor's; refused where it spans no area.
    bool setPlace(const osg::Vec2d& centre, double halfWidth, double halfHeight);
    /// False shows both geometries everywhere.
    void setEnabled(bool enabled);

    const MappingPool& mappings() const { return _masked; }

protected:
    ~GeometrySwap() override;

private:
    osg::ref_ptr<osg::Node> _nodes[3];
    MappingPool _masked; ///< the first takes away from the inner geometry, the second from the outer one
    MappingPool _around;
};

/// The same in one call.
OSGGEOFX_EXPORT osg::ref_ptr<GeometrySwap> swapGeometries(osg::Node& inside, osg::Node& outside,
                                                          osg::Node& rest, ProjectiveMappings& mappings,
                                                          DataLayer* mask, const osg::Vec2d& centre,
                                                          double halfWidth, double halfHeight);

} // namespace osgGeoFX
