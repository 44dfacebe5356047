// SPDX-License-Identifier: MIT
// SPDX-FileCopyrightText: 2026 the osgGeoFX authors
#pragma once

#include <osg/CoordinateSystemNode>
#include <osg/Geometry>
#include <osg/MatrixTransform>
#include <osg/Texture2D>
#include <osgGeoFX/effect/GlslFunctions.h>

#include <functional>

namespace geofx::test
{

/** Tiles of a terrain as osggeofx_build writes them: a mesh in a local frame with skirts, for tests of what is placed
    on them. */
struct StrokeTiles
{
    using Function = std::function<double(double x, double y)>;

    osg::ref_ptr<osg::EllipsoidModel>
        ellipsoid; ///< null: projected, x and y in metres, else longitude and latitude in radians
    Function height = [](double, double)
    {
        return 100.0;
    };
    /// What covers the ground; none: no texture.
    std::function<osgGeoFX::glsl::geofx_Cover(double x, double y)> cover;
    int cells = 16; ///< along an edge
    double skirt = 50.0;
    bool normals = true;

    osg::Vec3d world(double x, double y, double z) const;
    /// A tile with its transform and, below it, its geometry.
    osg::ref_ptr<osg::MatrixTransform> tile(double west, double south, double east, double north) const;
    static osg::Geometry& geometryOf(osg::MatrixTransform& tile) { return *tile.getChild(0)->asGeometry(); }
};

} // namespace geofx::test
