// SPDX-License-Identifier: MIT
// SPDX-FileCopyrightText: 2026 the osgGeoFX authors
#pragma once

#include <osg/Geometry>
#include <osg/Matrixd>

#include <cstddef>

namespace osgGeoFX
{

/// What became of a geometry.
struct RefinedGeometry
{
    std::size_t triangles = 0; ///< 0 where it is as it was
    double inside = 1.0; ///< by how much longer than wished edges inside may be, for the sake of the limit
};

/// Splits a geometry's triangles until no edge is longer than `longest`, metres. `matrix`: from the geometry's frame to metres. The
/// geometry gets new arrays; others that share the former ones keep them. See MeshRefiner.
RefinedGeometry refineGeometry(osg::Geometry& geometry, const osg::Matrixd& matrix, double longest,
                               std::size_t most);

} // namespace osgGeoFX
