// SPDX-License-Identifier: MIT
// SPDX-FileCopyrightText: 2026 the osgGeoFX authors
#pragma once

#include <osgGeoFX/scene/EffectScene.h>

#include <osg/Vec2d>
#include <osgGA/GUIEventHandler>
#include <osgViewer/View>

#include <functional>
#include <optional>

namespace osgGeoFX
{

/** Lets the wheel and the middle button take hold of the ground that the picture shows below the pointer, where effects
    deform it. OSG's manipulators know the undeformed ground only, and would zoom and pan at a wrong pace in a bend.

    The wheel goes a share of the way to the place, and the middle button drags it; the place stays below the pointer. The camera
    looks on in the same direction. Where nothing is deformed, over the sky, with Ctrl, Alt or Shift, and with
    manipulators that are not free (AboveGround::isFree()), events are left to others. A place that cannot be brought below the pointer, such as
    one that is dragged into the sky, stays where it is. The handler stands before the manipulator, as all of a viewer's. One handler serves one view.
    @ingroup viewer */
class OSGGEOFX_EXPORT GroundGrip : public osgGA::GUIEventHandler
{
public:
    /// `share`: how much of the way to the ground a turn of the wheel goes, more than 0 and less than 1; a turn back goes as much farther.
    explicit GroundGrip(EffectScene& scene, double share = 0.15) : _scene(&scene), _share(share) {}

    bool handle(const osgGA::GUIEventAdapter& event, osgGA::GUIActionAdapter& action) override;
    void getUsage(osg::ApplicationUsage& usage) const override;

    /// The view matrix of a camera that has moved over the ground, as high as before, so that a pixel shows a place of it; empty if no
    /// such place is found nearby. `view` is where it starts.
    static std::optional<osg::Matrixd> bring(EffectScene& scene, const osg::Camera& camera,
                                             const osg::Matrixd& view, const osg::Vec3d& world,
                                             const osg::Vec2d& pixel);
    /// As bring(), for cameras that move by other rules: how far one goes to the right and ahead, metres. `viewAt` gives its view matrix
    /// after such a way; `step`, metres, is a way after which the picture differs a little.
    static std::optional<osg::Vec2d> wayOf(EffectScene& scene, const osg::Camera& camera,
                                           const std::function<osg::Matrixd(const osg::Vec2d& way)>& viewAt,
                                           double step, const osg::Vec3d& world, const osg::Vec2d& pixel);

private:
    bool scroll(osgViewer::View& view, const osg::Vec2d& pixel, double share);
    void move(osgViewer::View& view, const osg::Matrixd& matrix, const osg::Vec3d& world) const;

    osg::ref_ptr<EffectScene> _scene;
    double _share;
    std::optional<osg::Vec3d> _held; ///< while the button is down
};

} // namespace osgGeoFX
