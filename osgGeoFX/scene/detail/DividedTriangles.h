// SPDX-License-Identifier: MIT
// SPDX-FileCopyrightText: 2026 the osgGeoFX authors
#pragma once

#include <osgGeoFX/effect/DeformationChain.h>

namespace osgGeoFX
{

/// What the CPU knows of triangles that the GPU divides (effect/Tessellation.h). Positions are in the view's eye space.
struct DividedTriangles
{
    /// Whether a deformation of the chain has triangles divided at all.
    static bool wanted(const DeformationChain& chain);
    /// Whether some edge in a box may be divided; conservative.
    static bool within(const DeformationChain& chain, const EyeBox& box);
    /// Whether a bend of the chain curves something in a box, divided or not; conservative.
    static bool curves(const DeformationChain& chain, const EyeBox& box);
    /// Into how many parts an edge must be divided so that what it misses of the curve is below a tenth of a pixel of a usual picture; 15 at
    /// most, as on the GPU.
    static int parts(const DeformationChain& chain, osg::Vec3d from, osg::Vec3d to);
};

} // namespace osgGeoFX
