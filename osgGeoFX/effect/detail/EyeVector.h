// SPDX-License-Identifier: MIT
// SPDX-FileCopyrightText: 2026 the osgGeoFX authors
#pragma once

#include <osgGeoFX/effect/GlslFunctions.h>

#include <osg/Vec3d>

namespace osgGeoFX
{

/// A vector of OSG as one of GLM, which shaders/lib uses in C++.
inline glm::dvec3 toGlm(const osg::Vec3d& vector)
{
    return {vector.x(), vector.y(), vector.z()};
}

inline osg::Vec3d toOsg(const glm::dvec3& vector)
{
    return {vector.x, vector.y, vector.z};
}

} // namespace osgGeoFX
