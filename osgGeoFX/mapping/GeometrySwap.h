// SPDX-License-Identifier: MIT
// SPDX-FileCopyrightText: 2026 the osgGeoFX authors
#pragma once

#include <osgGeoFX/mapping/MappingPool.h>

#include <osg/Group>

namespace osgGeoFX
{

/** Lets two geometries share one place: one is visible inside a mask, the other outside, pixel by pixel (Trapp and
    Döllner 2009, Section 5 and Figure 3.D). An example is a city and its generalisation.

    Both nodes must be below the mappings' EffectScene. The define GEOFX_MAPPING_CHANNELS is set in the state of each
    node: 1 for the inner node, 2 for the outer node, and 252, all other channels, for `rest`, the root of the
    remaining scene. Mappings of all channels, which is their default, are therefore drawn on all three. Discarding
    mappings of order 1000 lie on top: two use the mask, and four remove the inner geometry up to 1000 km around it.
    The destructor removes the mappings and the defines, except defines that the program has changed since.
    @ingroup mapping */
class OSGGEOFX_EXPORT GeometrySwap : public osg::Referenced
{
public:
    /// A grey of 0.5 or more in the mask counts as inside. The mask covers a rectangle of the mappings' frame with the
    /// given center and half size, metres.
    GeometrySwap(osg::Node& inside, osg::Node& outside, osg::Node& rest, ProjectiveMappings& mappings,
                 DataLayer* mask, const osg::Vec2d& center, double halfWidth, double halfHeight);

    /// Returns false and keeps the former mask, with a warning, if `mask` is null.
    bool setMask(DataLayer* mask);
    /// Moves the mask, as in the constructor. Returns false if the rectangle has no area.
    bool setPlace(const osg::Vec2d& center, double halfWidth, double halfHeight);
    /// While disabled, both geometries are visible everywhere. Default: enabled.
    void setEnabled(bool enabled);

    /// The two mappings that use the mask: the first discards the inner geometry, the second the outer one.
    const MappingPool& mappings() const { return _masked; }

protected:
    ~GeometrySwap() override;

private:
    osg::ref_ptr<osg::Node> _nodes[3];
    MappingPool _masked; ///< the first takes away from the inner geometry, the second from the outer one
    MappingPool _around;
};

/// Makes a GeometrySwap in one call.
OSGGEOFX_EXPORT osg::ref_ptr<GeometrySwap> swapGeometries(osg::Node& inside, osg::Node& outside,
                                                          osg::Node& rest, ProjectiveMappings& mappings,
                                                          DataLayer* mask, const osg::Vec2d& center,
                                                          double halfWidth, double halfHeight);

} // namespace osgGeoFX
