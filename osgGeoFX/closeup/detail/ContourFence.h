// SPDX-License-Identifier: MIT
// SPDX-FileCopyrightText: 2026 the osgGeoFX authors
#pragma once

#include <osgGeoFX/closeup/RegionOfInterest.h>
#include <osgGeoFX/effect/detail/DrawableTriangles.h>

#include <osg/Geometry>
#include <osg/observer_ptr>

#include <vector>

namespace osgGeoFX
{

/** The wall between a region's border on the ground and the border of its close-up, and the line on the ground. It is
    geometry in the region's frame. Its first texture coordinate says how far a vertex goes up. The line is a band, which
    the vertex stage makes as wide as it is wanted (stages/closeup.fence.vert).

    Heights are those of the triangles that the camera sees there. Points of the border are left out as long as the
    line stays within a tenth of a texel of the mask. An object belongs to one camera and one close-up. */
class ContourFence
{
public:
    /// A drawable over the region, with the matrix from its own frame to the region's, metres.
    struct Ground
    {
        osg::ref_ptr<const osg::Drawable> drawable;
        osg::Matrixd toRegion;
    };

    /// Makes new geometry if the region or the ground has changed. False if there is no ground below the border.
    bool update(const RegionOfInterest& region, const std::vector<Ground>& ground);
    /// The geometry of the last update, in the region's frame. Each change makes a new one.
    osg::Geometry* wall() { return _wall.get(); }
    osg::Geometry* line() { return _line.get(); }
    void resizeGLObjectBuffers(unsigned int size);
    void releaseGLObjects(osg::State* state) const;

private:
    struct Known
    {
        osg::observer_ptr<const osg::Drawable> drawable;
        osg::Matrixd toRegion;
        GeometryStamp stamp;
    };
    bool isKnown(const RegionOfInterest& region, const std::vector<Ground>& ground) const;
    void build(const RegionOfInterest& region, const std::vector<Ground>& ground);

    osg::observer_ptr<const RegionOfInterest> _region;
    unsigned int _revision = 0;
    std::vector<Known> _known;
    bool _grounded = false;
    osg::ref_ptr<osg::Geometry> _wall, _line;
};

} // namespace osgGeoFX
