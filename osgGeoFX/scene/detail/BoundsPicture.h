// SPDX-License-Identifier: MIT
// SPDX-FileCopyrightText: 2026 the osgGeoFX authors
#pragma once

#include <osgGeoFX/effect/DeformationChain.h>

#include <osg/Geometry>

namespace osgGeoFX
{

/// Draws boxes as the deformation leaves them, in eye space. Lines are red where the deformation is curved, yellow
/// elsewhere. For one thread at a time.
class BoundsPicture
{
public:
    /// Forgets all boxes. Lines that are still to be drawn stay valid.
    void begin();
    void add(const EyeBox& box, const DeformationChain& chain);
    /// The lines of all boxes since begin().
    osg::Geometry& geometry();

private:
    osg::ref_ptr<osg::Geometry> _geometry;
    osg::ref_ptr<osg::Vec3Array> _lines;
    osg::ref_ptr<osg::Vec4Array> _colors;
};

} // namespace osgGeoFX
