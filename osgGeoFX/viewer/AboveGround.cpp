// SPDX-License-Identifier: MIT
// SPDX-FileCopyrightText: 2026 the osgGeoFX authors
#include <osgGeoFX/viewer/AboveGround.h>

#include <osgGeoFX/panorama/PanoramaManipulator.h>
#include <osgGeoFX/scene/DeformedView.h>
#include <osgGeoFX/scene/detail/GroundVisitor.h>

#include <osg/Timer>
#include <osgGA/AnimationPathManipulator>
#include <osgGA/KeySwitchMatrixManipulator>

#include <algorithm>

namespace osgGeoFX
{

namespace
{

/// From where the ground is looked for, metres above the eye. More than any mountain, exaggerated and folded up.
constexpr double reach = 1e5;
/// Seconds after which tiles may have come.
constexpr double patience = 0.25;
/// A camera that rises sees another bend.
constexpr int tries = 6;

/// A number that is another one after any change of the scene's effects.
std::uint64_t stampOf(EffectScene& scene)
{
    std::uint64_t stamp = scene.getNumEffects();
    const auto add = [&](std::uint64_t number)
    {
        stamp = stamp * 1099511628211u + number;
    };
    for (unsigned int i = 0; i < scene.getNumEffects(); ++i)
    {
        Effect& effect = *scene.getEffect(i);
        add(reinterpret_cast<std::uintptr_t>(&effect));
        add(effect.revision());
        for (const PropertyHolder::Part& part : effect.parts())
            add(part.object->revision());
    }
    return stamp;
}

} // namespace

AboveGround::AboveGround(EffectScene& scene, osgGA::CameraManipulator& manipulator)
    : _scene(&scene), _inner(&manipulator)
{
}

AboveGround::~AboveGround() = default;

osgGA::CameraManipulator* AboveGround::movingOne(osgGA::CameraManipulator* manipulator)
{
    while (manipulator)
    {
        if (auto* const above = dynamic_cast<AboveGround*>(manipulator))
            manipulator = above->_inner.get();
        else if (auto* const chosen = dynamic_cast<osgGA::KeySwitchMatrixManipulator*>(manipulator))
            manipulator = chosen->getCurrentMatrixManipulator();
        else
            break;
    }
    return manipulator;
}

bool AboveGround::isFree(osgGA::CameraManipulator* manipulator)
{
    osgGA::CameraManipulator* const moving = movingOne(manipulator);
    return moving && !dynamic_cast<osgGA::AnimationPathManipulator*>(moving) &&
           !dynamic_cast<PanoramaManipulator*>(moving);
}

void AboveGround::setCoordinateFrameCallback(CoordinateFrameCallback* callback)
{
    osgGA::CameraManipulator::setCoordinateFrameCallback(callback);
    _inner->setCoordinateFrameCallback(callback);
}

void AboveGround::setHomePosition(const osg::Vec3d& eye, const osg::Vec3d& center, const osg::Vec3d& up,
                                  bool automatic)
{
    osgGA::CameraManipulator::setHomePosition(eye, center, up, automatic);
    _inner->setHomePosition(eye, center, up, automatic);
}

void AboveGround::setAutoComputeHomePosition(bool automatic)
{
    osgGA::CameraManipulator::setAutoComputeHomePosition(automatic);
    _inner->setAutoComputeHomePosition(automatic);
}

double AboveGround::rise(EffectScene& scene, const osg::Matrixd& view, const osg::Camera& camera,
                         double margin)
{
    const DeformedView picture(scene, view, camera.getProjectionMatrix(), 1.0, 1.0,
                               static_cast<double>(camera.getLODScale()));
    const ViewGeometry geometry(picture.modelView(), camera.getProjectionMatrix(), picture.ground());
    const osg::Vec3d& up = geometry.up;
    const osg::ref_ptr<DeformedLineIntersector> ray = new DeformedLineIntersector(up * reach, -up);
    ray->setCurved(true);
    const osg::ref_ptr<GroundVisitor> visitor = new GroundVisitor(ray, picture.chain(), picture.modelView(),
                                                                  static_cast<double>(camera.getLODScale()));
    scene.getTerrain()->traverse(*visitor);
    // From below: what is above the eye, the nearest first, then what is below.
    const auto& hits = ray->intersections();
    double below = -2.0 * reach;
    double above = 2.0 * reach;
    bool covered = false;
    for (const DeformedLineIntersector::Intersection& hit : hits)
    {
        const double height = hit.deformed * up;
        if (height <= 0.0)
        {
            below = std::max(below, height);
            continue;
        }
        if (height >= above) continue;
        above = height;
        // On the map the ground looks up; a bend may turn it over.
        const osg::Vec3d place = hit.world * picture.modelView();
        osg::Vec3d normal = osg::Matrixd::transform3x3(hit.normal, picture.modelView());
        if (normal * up < 0.0) normal = -normal;
        covered = picture.chain().deformNormal(place, normal) * up > 0.0;
    }
    if (covered) return above + margin;
    return std::max(0.0, below + margin);
}

bool AboveGround::Watch::mustLook(EffectScene& scene, const osg::Camera& camera)
{
    const std::uint64_t effects = stampOf(scene);
    const double time = osg::Timer::instance()->time_s();
    const bool same = _time >= 0.0 && _effects == effects && _view == camera.getViewMatrix() &&
                      _projection == camera.getProjectionMatrix();
    if (same && time - _time < patience) return false;
    _effects = effects;
    _projection = camera.getProjectionMatrix();
    _time = time;
    return true;
}

std::optional<osg::Matrixd> AboveGround::Watch::risen(EffectScene& scene, const osg::Camera& camera,
                                                      double margin)
{
    if (!mustLook(scene, camera)) return std::nullopt;
    osg::Matrixd view = camera.getViewMatrix();
    bool moved = false;
    for (int i = 0; i < tries; ++i)
    {
        const double metres = rise(scene, view, camera, margin);
        if (!(metres > 1e-3)) break;
        const DeformedView picture(scene, view, camera.getProjectionMatrix(), 1.0, 1.0);
        const ViewGeometry geometry(picture.modelView(), camera.getProjectionMatrix(), picture.ground());
        view.postMultTranslate(geometry.up * -metres);
        moved = true;
    }
    _view = view;
    if (!moved) return std::nullopt;
    return view;
}

void AboveGround::updateCamera(osg::Camera& camera)
{
    _inner->updateCamera(camera);
    if (!_enabled || !isFree(_inner)) return;
    const auto view = _watch.risen(*_scene, camera, _margin);
    if (!view) return;
    _inner->setByInverseMatrix(*view);
    // Some manipulators take only a part of it.
    camera.setViewMatrix(*view);
}

} // namespace osgGeoFX
