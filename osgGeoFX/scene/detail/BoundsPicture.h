// SPDX-License-Identifier: MIT
// SPDX-FileCopyrightText: 2026 the osgGeoFX authors
#pragma once

#include <osgGeoFX/effect/DeformationChain.h>

#include <osg/Geometry>

namespace osgGeoFX
{

/// Lines around what the deformation makes of boxes, in eye space: red where it bends them, yellow elsewhere. For one thread at a time.
class BoundsPicture
{
public:
    /// Forgets all boxes, but not what is still to be drawn of them.
    void begin();
    void add(const EyeBox& box, const DeformationChain& chain);
    /// Of all boxes since begin().
    osg::Geometry& geometry();

private:
    osg::ref_ptr<osg::Geometry> _geometry;
    osg::ref_ptr<osg::Vec3Array> _lines;
    osg::ref_ptr<osg::Vec4Array> _colors;
};

} // namespace osgGeoFX
