// SPDX-License-Identifier: MIT
// SPDX-FileCopyrightText: 2026 the osgGeoFX authors
#pragma once

#include <osgGeoFX/paging/Georeference.h>
#include <osgGeoFX/scene/DeformedIntersector.h>
#include <osgGeoFX/scene/EffectScene.h>

#include <osg/Camera>
#include <osg/Vec2d>

#include <optional>

namespace osgGeoFX
{

/** One camera's picture of an EffectScene, both ways: from the ground to pixels and from pixels to the ground.

    World coordinates are those of the scene's children. Pixels count from the lower left corner of the viewport; the middle
    of the first one is (0.5, 0.5). It keeps the camera and the effects as they were when it was made, and looks at the
    tiles that are loaded when it is asked. To be used where the scene graph may be read: in event and update traversals.

    With it a program keeps cameras above exaggerated ground, picks and flies to what a click shows, and places labels. */
class OSGGEOFX_EXPORT DeformedView
{
public:
    /// `camera` is a viewer's, with a viewport.
    DeformedView(EffectScene& scene, const osg::Camera& camera);
    /// `view` from the scene's own frame to eye space.
    DeformedView(EffectScene& scene, const osg::Matrixd& view, const osg::Matrixd& projection, double width,
                 double height, double lodScale = 1.0);

    /// The pixel at which a place of the ground appears, if nothing hides it. False where it is behind the eye.
    bool project(const osg::Vec3d& world, osg::Vec2d& pixel) const;
    /// The same by longitude and latitude, radians, and height, metres; false also outside the projection.
    bool project(double longitude, double latitude, double height, const Georeference& reference,
                 osg::Vec2d& pixel) const;

    /// What a pixel shows; nothing for the sky.
    std::optional<DeformedLineIntersector::Intersection> pick(double x, double y,
                                                              osg::Node::NodeMask mask = ~0u) const;
    /// The place of the ground that a pixel shows: radians, and metres above the database's zero height.
    bool unproject(double x, double y, const Georeference& reference, double& longitude, double& latitude,
                   double& height) const;

    /// Where a place of the world is drawn, as a place of the world; and back.
    osg::Vec3d deform(const osg::Vec3d& world) const;
    osg::Vec3d undeform(const osg::Vec3d& world) const;

    const DeformationChain& chain() const { return *_chain; }
    const osg::Matrixd& modelView() const { return _modelView; }

private:
    osg::ref_ptr<EffectScene> _scene;
    osg::ref_ptr<const DeformationChain> _chain;
    osg::Matrixd _modelView;
    osg::Matrixd _toWorld;
    osg::Matrixd _projection;
    double _width;
    double _height;
    double _lodScale;
};

} // namespace osgGeoFX
