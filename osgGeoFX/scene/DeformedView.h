// SPDX-License-Identifier: MIT
// SPDX-FileCopyrightText: 2026 the osgGeoFX authors
#pragma once

#include <osgGeoFX/paging/Georeference.h>
#include <osgGeoFX/scene/DeformedIntersector.h>
#include <osgGeoFX/scene/EffectScene.h>

#include <osg/BoundingSphere>
#include <osg/Camera>
#include <osg/Vec2d>

#include <optional>

namespace osgGeoFX
{

/** The view that one camera has of an EffectScene: it converts places on the ground to pixels, and pixels to places.

    A program uses it to keep cameras above exaggerated ground, to pick, to fly to the place of a click, and to place
    labels.

    World coordinates are those of the scene's children. Pixels count from the lower left corner of the viewport; the
    center of the first one is (0.5, 0.5). An object keeps the camera and the effects as they were when it was made.
    Each query uses the tiles that are loaded at that time. Use it where the scene graph may be read: in event and
    update traversals.

    @ingroup scene */
class OSGGEOFX_EXPORT DeformedView
{
public:
    /// `camera`: a viewer's camera with a viewport.
    DeformedView(EffectScene& scene, const osg::Camera& camera);
    /// `view`: a camera's view matrix, from the viewer's world (above all transforms over the scene) to eye space.
    /// `width`, `height`: the viewport, pixels. If the scene has several parents, the first path to it counts.
    DeformedView(EffectScene& scene, const osg::Matrixd& view, const osg::Matrixd& projection, double width,
                 double height, double lodScale = 1.0);

    /// The pixel that shows a place, if nothing hides it. False if the place is behind the eye.
    bool project(const osg::Vec3d& world, osg::Vec2d& pixel) const;
    /// The same for a longitude and latitude, radians, and a height, metres. False also outside the projection.
    bool project(double longitude, double latitude, double height, const Georeference& reference,
                 osg::Vec2d& pixel) const;

    /// Whether the picture may show something of a sphere of the undeformed world. It is true also for some spheres that are
    /// out of sight, and whatever hides them.
    bool maySee(const osg::BoundingSphered& ball) const;

    /// The point that a pixel shows; empty for the sky. `mask`: only nodes with one of these bits are visited.
    std::optional<DeformedLineIntersector::Intersection> pick(double x, double y,
                                                              osg::Node::NodeMask mask = ~0u) const;
    /// As pick(), of the ground as bends curve it (DeformedLineIntersector::setCurved()). Where tiles are still too coarse to show the
    /// curve, the picture has another point there, but this place lies on the ground. For what goes on about a place, as a drag does.
    std::optional<DeformedLineIntersector::Intersection> pickCurved(double x, double y,
                                                                    osg::Node::NodeMask mask = ~0u) const;
    /// The place that a pixel shows: radians, and metres above the database's zero height. False for the sky and
    /// outside the projection.
    bool unproject(double x, double y, const Georeference& reference, double& longitude, double& latitude,
                   double& height) const;

    /// The place where a world position is drawn, in world coordinates.
    osg::Vec3d deform(const osg::Vec3d& world) const;
    /// The inverse of deform().
    osg::Vec3d undeform(const osg::Vec3d& world) const;

    /// The camera's deformation. If the picture needs several cameras, that of one camera for all of it.
    const DeformationChain& chain() const { return *_chain; }
    /// What is known of the ground.
    const Ground& ground() const { return _ground; }
    /// The matrix from the frame of the scene's children to eye space.
    const osg::Matrixd& modelView() const { return _modelView; }

private:
    std::optional<DeformedLineIntersector::Intersection> meet(double x, double y, osg::Node::NodeMask mask,
                                                              bool curved) const;

    osg::ref_ptr<EffectScene> _scene;
    Ground _ground;
    /// The deformation of the camera that would draw a place of the picture, x from −1 to 1.
    const DeformationChain& chainAt(double x) const;
    /// The same of the one that would draw a position in eye space.
    const DeformationChain& chainOf(const osg::Vec3d& position) const;

    osg::ref_ptr<const DeformationChain> _chain;
    /// Of columns from left to right, if one camera does not draw the whole picture; else empty.
    std::vector<osg::ref_ptr<const DeformationChain>> _columns;
    osg::Matrixd _modelView;
    osg::Matrixd _toWorld;
    osg::Matrixd _projection;
    double _width;
    double _height;
    double _lodScale;
};

} // namespace osgGeoFX
