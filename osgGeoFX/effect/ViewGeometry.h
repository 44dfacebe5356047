// SPDX-License-Identifier: MIT
// SPDX-FileCopyrightText: 2026 the osgGeoFX authors
#pragma once

#include <osgGeoFX/Export.h>

#include <osg/CoordinateSystemNode>
#include <osg/Math>
#include <osg/Matrixd>
#include <osg/Vec3d>
#include <osg/observer_ptr>

namespace osgGeoFX
{

/// What a deformation has to know of the ground, in the frame of the EffectScene's children.
struct OSGGEOFX_EXPORT Ground
{
    osg::ref_ptr<const osg::EllipsoidModel> ellipsoid; ///< null: heights are z of a projected terrain
    double minHeight = 0.0;                            ///< metres; of the terrain where known, else both 0
    double maxHeight = 0.0;
    /// Of the kit's databases: by how much finer tiles can stick out of a coarser one's box, for each metre that the
    /// coarser one's LOD range is longer than its radius; 0 for other databases.
    double tileError = 0.0;
    /// Of the kit's databases: the longest edge of a tile's mesh, as a share of its radius; 0 for other databases.
    double tileEdge = 0.0;
    bool heightsKnown = false; ///< whether the database tells its heights
    /// Radians; of the database's middle where it is known, else 45° north. For what depends on the climate.
    double latitude = 0.25 * osg::PI;
    osg::observer_ptr<const osg::Node> terrain; ///< the root of the kit's database; null for other databases
};

/** One camera over a terrain, in double and in eye space (x right, y up, −z forward, metres).

    Nothing in eye space is as large as the world. A modelview matrix that scales is not supported. */
struct OSGGEOFX_EXPORT ViewGeometry
{
    ViewGeometry(const osg::Matrixd& modelView, const osg::Matrixd& projection, const Ground& ground);

    Ground ground;
    osg::Matrixd projection;
    osg::Matrixd inverseProjection;
    osg::Vec3d up;          ///< unit normal of the ground below the eye
    osg::Vec3d polarAxis;   ///< unit vector along the ellipsoid's axis; `up` on a projected terrain
    double eyeHeight = 0.0; ///< of the eye above the ellipsoid or above z = 0

    /// The ray of the picture's point x, y (−1…1): from the near plane, not normalised. On any projection.
    void ray(double x, double y, osg::Vec3d& origin, osg::Vec3d& direction) const;
};

} // namespace osgGeoFX
