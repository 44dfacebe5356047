// SPDX-License-Identifier: MIT
// SPDX-FileCopyrightText: 2026 the osgGeoFX authors
#pragma once

#include <osgGeoFX/effect/DeformationChain.h>

#include <osg/Drawable>
#include <osg/Matrixd>
#include <osg/Vec4d>

#include <cfloat>
#include <vector>

namespace osgGeoFX
{

/** Between which depths the deformed triangles of a drawable lie, as far as they are within a frustum: what
    osg::CullSettings::COMPUTE_NEAR_FAR_USING_PRIMITIVES looks for. */
struct MeshDepths
{
    /// `modelView`: to eye space. `planes`: of the frustum, positive on the inner side. `depths`: what a depth is, metres: the product
    /// with (x, y, z, 1).
    MeshDepths(const osg::Drawable& drawable, const osg::Matrixd& modelView, const DeformationChain& chain,
               const std::vector<osg::Vec4d>& planes, const osg::Vec4d& depths);

    /// False where the triangles do not tell all: with points and lines, for vertices that a shader places, and for things that keep
    /// their shape.
    bool known = false;
    double nearest = DBL_MAX;
    double farthest = -DBL_MAX; ///< below `nearest` where nothing is within the frustum
};

} // namespace osgGeoFX
