// SPDX-License-Identifier: MIT
// SPDX-FileCopyrightText: 2026 the osgGeoFX authors
#include <osgGeoFX/viewer/GroundGrip.h>

#include <osgGeoFX/scene/DeformedView.h>
#include <osgGeoFX/viewer/AboveGround.h>

#include <osgGA/OrbitManipulator>

#include <algorithm>
#include <cmath>

namespace osgGeoFX
{

namespace
{

using Event = osgGA::GUIEventAdapter;

constexpr int steps = 12;
/// Pixels from the pointer that nobody sees.
constexpr double exact = 0.1;

/// Cameras that stand at another place and look as this one does, with the same height above a globe or a plane.
class Mover
{
public:
    Mover(EffectScene& scene, const osg::Camera& camera, const osg::Matrixd& view)
        : _toWorld(osg::Matrixd::inverse(view)), _start(scene, view, camera.getProjectionMatrix(), 1.0, 1.0)
    {
        _pose.invert(_start.modelView());
        const ViewGeometry geometry(_start.modelView(), camera.getProjectionMatrix(), _start.ground());
        _up = osg::Matrixd::transform3x3(geometry.up, _pose);
        _height = geometry.eyeHeight;
        const osg::Vec3d across = osg::Matrixd::transform3x3(osg::Vec3d(1.0, 0.0, 0.0), _pose);
        _forward = _up ^ across;
        _forward.normalize();
        _right = _forward ^ _up;
    }
    double height() const { return std::max(std::abs(_height), 1.0); }

    /// The view matrix of one that has gone ahead and to the right, metres.
    osg::Matrixd at(const osg::Vec2d& way) const
    {
        osg::Vec3d eye = _pose.getTrans() + _right * way.x() + _forward * way.y();
        osg::Matrixd pose = _pose * osg::Matrixd::translate(-_pose.getTrans());
        if (const osg::EllipsoidModel* const globe = _start.ground().ellipsoid)
        {
            double latitude = 0.0, longitude = 0.0, height = 0.0;
            globe->convertXYZToLatLongHeight(eye.x(), eye.y(), eye.z(), latitude, longitude, height);
            globe->convertLatLongHeightToXYZ(latitude, longitude, _height, eye.x(), eye.y(), eye.z());
            osg::Quat turn;
            turn.makeRotate(_up, globe->computeLocalUpVector(eye.x(), eye.y(), eye.z()));
            pose.postMultRotate(turn);
        }
        pose.postMultTranslate(eye);
        // From the children's frame to the viewer's world, as before.
        const osg::Matrixd above = _start.modelView() * _toWorld;
        return osg::Matrixd::inverse(pose * above);
    }

private:
    osg::Matrixd _toWorld;
    DeformedView _start;
    osg::Matrixd _pose; ///< of the camera, in the frame of the scene's children
    osg::Vec3d _up, _forward, _right;
    double _height = 0.0;
};

} // namespace

void GroundGrip::getUsage(osg::ApplicationUsage& usage) const
{
    usage.addKeyboardMouseBinding("wheel, middle button", "Zoom to deformed ground, drag it");
}

std::optional<osg::Matrixd> GroundGrip::bring(EffectScene& scene, const osg::Camera& camera,
                                              const osg::Matrixd& view, const osg::Vec3d& world,
                                              const osg::Vec2d& pixel)
{
    const Mover mover(scene, camera, view);
    const auto way = wayOf(
        scene, camera, [&mover](const osg::Vec2d& gone) { return mover.at(gone); }, 1e-4 * mover.height(),
        world, pixel);
    if (!way) return std::nullopt;
    return mover.at(*way);
}

std::optional<osg::Vec2d> GroundGrip::wayOf(EffectScene& scene, const osg::Camera& camera,
                                            const std::function<osg::Matrixd(const osg::Vec2d& way)>& viewAt,
                                            double step, const osg::Vec3d& world, const osg::Vec2d& pixel)
{
    const osg::Viewport* const port = camera.getViewport();
    if (!port) return std::nullopt;
    const auto project = [&](const osg::Vec2d& gone, osg::Vec2d& seen)
    {
        return DeformedView(scene, viewAt(gone), camera.getProjectionMatrix(), port->width(), port->height())
            .project(world, seen);
    };
    osg::Vec2d way, shown;
    if (!project(way, shown)) return std::nullopt;
    double away = (shown - pixel).length();
    for (int i = 0; i < steps && away > exact; ++i)
    {
        osg::Vec2d right, ahead;
        if (!project(way + osg::Vec2d(step, 0.0), right) || !project(way + osg::Vec2d(0.0, step), ahead))
            return std::nullopt;
        const osg::Vec2d a = (right - shown) / step, b = (ahead - shown) / step, miss = pixel - shown;
        const double area = a.x() * b.y() - a.y() * b.x();
        if (std::abs(area) < 1e-15) return std::nullopt;
        osg::Vec2d change((miss.x() * b.y() - miss.y() * b.x()) / area,
                          (a.x() * miss.y() - a.y() * miss.x()) / area);
        // Newton's method may leap too far where a bend begins.
        bool nearer = false;
        for (int half = 0; half < 6 && !nearer; ++half, change *= 0.5)
        {
            osg::Vec2d next;
            if (!project(way + change, next) || !((next - pixel).length() < away)) continue;
            way += change;
            shown = next;
            away = (shown - pixel).length();
            nearer = true;
            break;
        }
        if (!nearer) break;
    }
    if (away > 1.0) return std::nullopt;
    return way;
}

void GroundGrip::move(osgViewer::View& view, const osg::Matrixd& matrix, const osg::Vec3d& world) const
{
    osgGA::CameraManipulator* const manipulator = view.getCameraManipulator();
    if (!manipulator)
    {
        view.getCamera()->setViewMatrix(matrix);
        return;
    }
    // What orbits goes on about a point as far away as the ground.
    const DeformedView picture(*_scene, matrix, view.getCamera()->getProjectionMatrix(), 1.0, 1.0);
    if (auto* const orbit = dynamic_cast<osgGA::OrbitManipulator*>(AboveGround::movingOne(manipulator)))
        orbit->setDistance((world * picture.modelView()).length());
    manipulator->setByInverseMatrix(matrix);
    view.getCamera()->setViewMatrix(manipulator->getInverseMatrix());
}

bool GroundGrip::scroll(osgViewer::View& view, const osg::Vec2d& pixel, double share)
{
    const osg::Camera& camera = *view.getCamera();
    const DeformedView picture(*_scene, camera);
    if (picture.chain().empty()) return false;
    const auto hit = picture.pick(pixel.x(), pixel.y());
    if (!hit) return false;
    osg::Matrixd matrix = camera.getViewMatrix();
    matrix.postMultTranslate((hit->world * picture.modelView()) * -share);
    // Where the place does not come below the pointer, the way itself is still right.
    move(view, bring(*_scene, camera, matrix, hit->world, pixel).value_or(matrix), hit->world);
    return true;
}

bool GroundGrip::handle(const Event& event, osgGA::GUIActionAdapter& action)
{
    auto* const view = dynamic_cast<osgViewer::View*>(&action);
    const osg::Viewport* const port = view ? view->getCamera()->getViewport() : nullptr;
    if (!port) return false;
    const osg::Vec2d pixel(static_cast<double>(event.getX()) - port->x(),
                           static_cast<double>(event.getY()) - port->y());
    constexpr int modifiers = Event::MODKEY_CTRL | Event::MODKEY_ALT | Event::MODKEY_SHIFT;
    const bool free = !(event.getModKeyMask() & modifiers) &&
                      (!view->getCameraManipulator() || AboveGround::isFree(view->getCameraManipulator()));
    bool used = false;
    switch (event.getEventType())
    {
    case Event::SCROLL:
        if (free && event.getScrollingMotion() == Event::SCROLL_UP)
            used = scroll(*view, pixel, _share);
        else if (free && event.getScrollingMotion() == Event::SCROLL_DOWN)
            used = scroll(*view, pixel, -_share / (1.0 - _share));
        break;
    case Event::PUSH:
    {
        _held.reset();
        if (!free || event.getButton() != Event::MIDDLE_MOUSE_BUTTON) break;
        const DeformedView picture(*_scene, *view->getCamera());
        if (picture.chain().empty()) break;
        if (const auto hit = picture.pick(pixel.x(), pixel.y())) _held = hit->world;
        used = _held.has_value();
        break;
    }
    case Event::DRAG:
        if (!_held) break;
        if (const auto matrix =
                bring(*_scene, *view->getCamera(), view->getCamera()->getViewMatrix(), *_held, pixel))
            move(*view, *matrix, *_held);
        used = true;
        break;
    case Event::RELEASE:
        used = _held.has_value();
        _held.reset();
        break;
    default:
        break;
    }
    if (used) action.requestRedraw();
    return used;
}

} // namespace osgGeoFX
