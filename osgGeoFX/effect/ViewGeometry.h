// SPDX-License-Identifier: MIT
// SPDX-FileCopyrightText: 2026 the osgGeoFX authors
#pragma once

#include <osgGeoFX/Export.h>

#include <osg/CoordinateSystemNode>
#include <osg/Math>
#include <osg/Matrixd>
#include <osg/Vec2d>
#include <osg/Vec3d>
#include <osg/observer_ptr>

namespace osgGeoFX
{

/// What a deformation needs to know of the ground, in the frame of the EffectScene's children.
/// @ingroup effect
struct OSGGEOFX_EXPORT Ground
{
    osg::ref_ptr<const osg::EllipsoidModel> ellipsoid; ///< null on a projected terrain, whose heights are z
    double minHeight = 0.0; ///< heights of the terrain, metres; both are 0 if unknown
    double maxHeight = 0.0;
    /// How far finer tiles can stick out of a coarser tile's box, for each metre by which the coarser tile's LOD range
    /// exceeds its radius. 0 if unknown. Of other databases whose `tileEdge` is stated, a usual value.
    double tileError = 0.0;
    /// The longest edge of a tile's mesh, as a share of the tile's radius. 0 if neither the database nor the application
    /// says so.
    double tileEdge = 0.0;
    bool heightsKnown = false; ///< whether the database or the application tells the heights
    /// The latitude of the middle of a geocentric database of the kit, radians; otherwise 45° north. Effects that
    /// depend on the climate use it.
    double latitude = 0.25 * osg::PI;
    bool coarseTiles =
        false; ///< whether an engine leaves tiles coarse where they are out of sight (ShaderHost)
    osg::observer_ptr<const osg::Node> terrain; ///< the root of the kit's database; null for other databases
};

/// The cameras that a mesh is made for before it is drawn: all those with one lens above a ground. They may look anywhere
/// and be rolled by up to 60°.
/// @ingroup effect
struct OSGGEOFX_EXPORT CameraRange
{
    Ground ground;
    osg::Matrixd projection;  ///< of all of them
    double distance = 1000.0; ///< no eye is nearer to the ground, metres; > 0
};

/** One view of a terrain, in double precision and in its eye space (x right, y up, −z forward, metres).

    Coordinates in eye space are small compared with those of a geocentric world. A modelview matrix that scales is
    not supported.

    Effects belong to a view. Most often one camera draws it. Other cameras may draw the same view from elsewhere or in
    part: a channel of a wall of screens, the left eye of a stereo pair, a tile of a print, a shadow map (CameraRole).
    All members but `image` are then those of the view, so that every image shows the same deformed world.

    @ingroup effect */
struct OSGGEOFX_EXPORT ViewGeometry
{
    /// `modelView`: from the frame of the EffectScene's children to eye space.
    ViewGeometry(const osg::Matrixd& modelView, const osg::Matrixd& projection, const Ground& ground);

    /// The camera that draws an image of the view.
    struct Image
    {
        bool ofView = true;      ///< whether it is the view's own camera; then both matrices are the identity
        osg::Matrixd toEye;      ///< from the view's eye space to the camera's
        osg::Matrixd toView;     ///< from the camera's eye space to the view's
        osg::Matrixd projection; ///< the camera's
        /// The matrix from the view's eye space to the camera's clip coordinates.
        osg::Matrixd toClip() const { return ofView ? projection : toEye * projection; }
    };

    Ground ground;
    osg::Matrixd modelView; ///< from the frame of the EffectScene's children to eye space
    osg::Matrixd projection;
    osg::Matrixd inverseProjection;
    osg::Vec3d up;          ///< the unit normal of the ground below the eye
    osg::Vec3d polarAxis;   ///< a unit vector along the ellipsoid's axis; equals `up` on a projected terrain
    double eyeHeight = 0.0; ///< height of the eye above the ellipsoid or above z = 0, metres
    Image image;            ///< by default that of the view's own camera

    /// Sets `image` to that of another camera. `cameraModelView`: from the frame of the EffectScene's children to the
    /// camera's eye space.
    void setImage(const osg::Matrixd& cameraModelView, const osg::Matrixd& cameraProjection);

    /// The part of the view's picture that the image shows: its lower left and upper right corners in the picture, x and y
    /// from −1 to 1. It is the whole picture if the view's own camera draws. From elsewhere it is the part that has the
    /// same corners at infinity; if there is none, the whole picture.
    void picturePart(osg::Vec2d& low, osg::Vec2d& high) const;

    /// The ray through a point of the viewport, x and y from −1 to 1. It begins on the near plane; the direction is not
    /// normalised. It works with any projection.
    void ray(double x, double y, osg::Vec3d& origin, osg::Vec3d& direction) const;
    /// The same for a projection and its inverse.
    static void ray(const osg::Matrixd& projection, const osg::Matrixd& inverse, double x, double y,
                    osg::Vec3d& origin, osg::Vec3d& direction);
};

} // namespace osgGeoFX
