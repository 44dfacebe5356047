// SPDX-License-Identifier: MIT
// SPDX-FileCopyrightText: 2026 the osgGeoFX authors
#pragma once

#include <osgGeoFX/scene/DeformedView.h>
#include <osgGeoFX/scene/EffectScene.h>
#include <osgGeoFX/viewer/AboveGround.h>
#include <osgGeoFX/viewer/GroundGrip.h>

#include <osg/observer_ptr>
#include <osgGA/GUIEventAdapter>

#include <algorithm>
#include <optional>

// Of osgEarth, which the kit does without.
namespace osgEarth
{
class TileKey;
class TerrainCallbackContext;
} // namespace osgEarth

namespace osgGeoFX
{

/** osgEarth's EarthManipulator, or a class derived from it, for ground that effects deform.

    @code
    #include <osgEarth/EarthManipulator>
    viewer.setCameraManipulator(new osgGeoFX::EarthNavigation<osgEarth::Util::EarthManipulator>);
    @endcode

    It is that manipulator: settings, bindings, viewpoints, tethering and callbacks are its own. The EffectScene is found above the
    MapNode. Where no effect deforms the picture, all is as without this class. Elsewhere
    - a mouse drag by ACTION_EARTH_DRAG holds the ground that the picture shows below the pointer. ACTION_PAN does so too, if nothing
      scales the pointer's way (a sensitivity or an action's option). Over the sky, by keys, by touch and when thrown, both pan at the
      pace of the ground in the picture's middle.
    - zooming goes to the place below the pointer, with `setZoomToMouse(false)` to the one in the middle, and the place stays where it
      is in the picture. ACTION_GOTO flies to the place that is seen.
    - the camera is kept above the deformed ground as AboveGround does, by the setting of terrain avoidance and its least distance,
      metres. A camera that is tethered, or flies to a viewpoint, rises for the picture alone: the manipulator does not follow it.

    A place that cannot be brought below the pointer, such as one that is dragged into the sky, stays where it is. One object serves
    one view, with the camera of the whole window.

    `Manipulator`: EarthManipulator of osgEarth 3.x, whose header is included first. Threads: as for EarthManipulator.
    @ingroup viewer */
template<class Manipulator>
class EarthNavigation : public Manipulator
{
public:
    using Manipulator::Manipulator;
    const char* libraryName() const override { return "osgGeoFX"; }
    const char* className() const override { return "EarthNavigation"; }

    void setByMatrix(const osg::Matrixd& matrix) override
    {
        if (!this->established() || !picture())
        {
            Manipulator::setByMatrix(matrix);
            return;
        }
        lookFrom(osg::Matrixd::inverse(matrix * this->_mapNodeFrameInverse), this->_distance);
        focus();
    }

    void updateCamera(osg::Camera& camera) override
    {
        _camera = &camera;
        // It is told of the camera as it is drawn.
        const auto callback = this->_updateCameraCallback;
        this->_updateCameraCallback = nullptr;
        Manipulator::updateCamera(camera);
        rise(camera);
        this->_updateCameraCallback = callback;
        if (callback) callback->onUpdateCamera(&camera);
    }

    void pan(double dx, double dy) override
    {
        if (!picture() || this->isTethering())
        {
            const Unchecked unchecked(*this);
            Manipulator::pan(dx, dy);
            return;
        }
        focus();
        constexpr double pace = 0.3; // osgEarth's
        take(moved(focusNow(), osg::Vec2d(dx, dy) * (-pace * this->_distance)));
    }

    void rotate(double dx, double dy) override
    {
        const Unchecked unchecked(*this);
        Manipulator::rotate(dx, dy);
    }

    void zoom(double dx, double dy, osg::View* view) override
    {
        const auto shown = picture();
        if (!shown || this->isTethering())
        {
            const Unchecked unchecked(*this);
            Manipulator::zoom(dx, dy, view);
            return;
        }
        const auto& settings = *this->getSettings();
        const bool toPointer = settings.getZoomToMouse() && view && this->_ga_t0;
        if (!isHolding())
        {
            const osg::Viewport& port = *camera()->getViewport();
            _pixel = toPointer ? pixelOf(this->_ga_t0->getX(), this->_ga_t0->getY())
                               : osg::Vec2d(port.width(), port.height()) * 0.5;
            hold(*shown, _pixel);
        }
        const double former = this->_distance;
        const double distance =
            std::clamp(former * (1.0 + dy), settings.getMinDistance(), settings.getMaxDistance());
        if (isHolding())
        {
            approach(drawnBelow(*shown, this->_lastPointOnEarth), distance / former);
        }
        this->setDistance(distance);
        // A parallel picture grows and shrinks with the distance.
        this->updateProjection(camera());
        bring(_pixel);
        focus();
    }

    void drag(double dx, double dy, osg::View* view) override
    {
        const auto shown = picture();
        if (!shown || this->isTethering() || !this->_ga_t1)
        {
            Manipulator::drag(dx, dy, view);
            return;
        }
        if (!isHolding()) hold(*shown, pixelOf(this->_ga_t1->getX(), this->_ga_t1->getY()));
        if (isHolding())
            bring(pixelOf(this->_ga_t0->getX(), this->_ga_t0->getY()));
        else
            pan(dx, dy);
    }

    void handleTileUpdate(const osgEarth::TileKey& key, osg::Node* tile,
                          osgEarth::TerrainCallbackContext& context) override
    {
        // Each frame looks for new tiles.
        if (!picture()) Manipulator::handleTileUpdate(key, tile, context);
    }

protected:
    ~EarthNavigation() override = default;

    using Action = typename Manipulator::Action;
    using ActionType = typename Manipulator::ActionType;

    void handleMovementAction(const ActionType& type, double dx, double dy, osg::View* view) override
    {
        const auto isWay = [](double way, float to, float from)
        {
            return way == static_cast<double>(to - from);
        };
        const bool pointed = !this->_thrown && !this->_continuous && this->_ga_t0 && this->_ga_t1 &&
                             isWay(dx, this->_ga_t0->getXnormalized(), this->_ga_t1->getXnormalized()) &&
                             isWay(dy, this->_ga_t0->getYnormalized(), this->_ga_t1->getYnormalized());
        if (type == Manipulator::ACTION_PAN && pointed && picture() && !this->isTethering())
            drag(dx, dy, view);
        else
            Manipulator::handleMovementAction(type, dx, dy, view);
    }

    bool handlePointAction(const Action& action, float x, float y, osg::View* view) override
    {
        const auto shown = picture();
        if (!shown || action._type != Manipulator::ACTION_GOTO)
            return Manipulator::handlePointAction(action, x, y, view);
        const osg::Vec2d pixel = pixelOf(x, y);
        const auto hit = shown->pickCurved(pixel.x(), pixel.y(), this->_intersectTraversalMask);
        if (!hit) return true;
        const double factor = action.getDoubleOption(Manipulator::OPTION_GOTO_RANGE_FACTOR, 1.0);
        const osg::Vec3d place = drawnBelow(*shown, hit->world);
        Focus focus{place, this->computeCenterRotation(place)};
        const double range = this->_distance * factor;
        const auto viewAt = [&](const osg::Vec2d& way)
        {
            return viewOf(moved(focus, way), range);
        };
        const osg::Viewport& port = *camera()->getViewport();
        const auto way = GroundGrip::wayOf(*scene(), *camera(), viewAt, step * range, hit->world,
                                           osg::Vec2d(port.width(), port.height()) * 0.5);
        if (way) focus = moved(focus, *way);
        auto there = this->getViewpoint();
        there.range() = there.range().get() * factor;
        there.focalPoint().mutable_value().fromWorld(this->_srs.get(), focus.center);
        this->setViewpoint(there, action.getDoubleOption(Manipulator::OPTION_DURATION, 1.0));
        return true;
    }

private:
    /// What EarthManipulator places the camera by: the focal point, in the map's frame, and the frame there.
    struct Focus
    {
        osg::Vec3d center;
        osg::Quat rotation;
    };

    /// Keeps osgEarth from lifting the camera above ground that is not deformed, while effects deform it.
    class Unchecked
    {
    public:
        explicit Unchecked(EarthNavigation& navigation)
            : _settings(*navigation.getSettings()), _was(_settings.getTerrainAvoidanceEnabled())
        {
            if (navigation.picture()) _settings.setTerrainAvoidanceEnabled(false);
        }
        Unchecked(const Unchecked&) = delete;
        Unchecked& operator=(const Unchecked&) = delete;
        ~Unchecked() { _settings.setTerrainAvoidanceEnabled(_was); }

    private:
        typename Manipulator::Settings& _settings;
        const bool _was;
    };

    /// A way after which pictures differ a little, of the distance to what is seen.
    static constexpr double step = 1e-4;

    Focus focusNow() const { return {this->_center, this->_centerRotation}; }
    osg::Camera* camera() const { return _camera.get(); }

    /// The nearest one above the map; null for none.
    EffectScene* scene() const
    {
        osg::Node* node = this->_mapNode.get();
        while (node && node->getNumParents() > 0)
        {
            node = node->getParent(0);
            if (auto* const found = dynamic_cast<EffectScene*>(node)) return found;
        }
        return nullptr;
    }

    /// The picture from where the manipulator is; empty if nothing in it is deformed.
    std::optional<DeformedView> picture() const
    {
        EffectScene* const effects = camera() && camera()->getViewport() ? scene() : nullptr;
        if (!effects) return std::nullopt;
        DeformedView view = pictureFrom(*effects, this->getInverseMatrix());
        if (view.chain().empty()) return std::nullopt;
        return view;
    }
    DeformedView pictureFrom(EffectScene& effects, const osg::Matrixd& view) const
    {
        const osg::Viewport& port = *camera()->getViewport();
        return DeformedView(effects, view, camera()->getProjectionMatrix(), port.width(), port.height(),
                            static_cast<double>(camera()->getLODScale()));
    }
    osg::Vec2d pixelOf(float x, float y) const
    {
        const osg::Viewport& port = *camera()->getViewport();
        return {static_cast<double>(x) - port.x(), static_cast<double>(y) - port.y()};
    }

    // The place that is held is what osgEarth holds: it lets it go with each new action.
    bool isHolding() const { return this->_lastPointOnEarth != osg::Vec3d(); }
    void hold(const DeformedView& shown, const osg::Vec2d& pixel)
    {
        const auto hit = shown.pickCurved(pixel.x(), pixel.y(), this->_intersectTraversalMask);
        if (hit) this->_lastPointOnEarth = hit->world;
    }
    /// Lets a pixel show the place that is held, if one is and it can be done.
    void bring(const osg::Vec2d& pixel)
    {
        EffectScene* const effects = scene();
        if (!effects || !isHolding()) return;
        const double away =
            (this->_lastPointOnEarth * pictureFrom(*effects, this->getInverseMatrix()).modelView()).length();
        const auto viewAt = [this](const osg::Vec2d& way)
        {
            return viewOf(moved(focusNow(), way), this->_distance);
        };
        const auto way = GroundGrip::wayOf(*effects, *camera(), viewAt, std::max(step * away, step),
                                           this->_lastPointOnEarth, pixel);
        if (way) take(moved(focusNow(), *way));
    }

    /// The view matrix from the viewer's world to eye space; getInverseMatrix() for the focus and distance of now.
    osg::Matrixd viewOf(const Focus& focus, double distance) const
    {
        return this->_mapNodeFrameInverse * osg::Matrixd::translate(-focus.center) *
               osg::Matrixd::rotate(focus.rotation.inverse()) * osg::Matrixd::translate(-this->_posOffset) *
               osg::Matrixd::rotate(this->_tetherRotation.inverse()) *
               osg::Matrixd::rotate(this->_rotation.inverse()) *
               osg::Matrixd::translate(-this->_viewOffset.x(), -this->_viewOffset.y(), -distance);
    }
    osg::Vec3d upAt(const osg::Vec3d& center) const
    {
        osg::CoordinateFrame frame;
        this->createLocalCoordFrame(center, frame);
        return this->getUpVector(frame);
    }
    /// A focus after a way to the right and ahead, metres, at the same height.
    Focus moved(const Focus& focus, const osg::Vec2d& way) const
    {
        const osg::Vec3d& center = focus.center;
        const osg::Vec3d up = upAt(center);
        const osg::Matrixd turn(this->_rotation * focus.rotation);
        osg::Vec3d ahead = up ^ this->getSideVector(turn);
        ahead.normalize();
        osg::Vec3d there = center + (ahead ^ up) * way.x() + ahead * way.y();
        osg::Vec3d from, to;
        if (this->_srs->transformFromWorld(center, from) && this->_srs->transformFromWorld(there, to))
            this->_srs->transformToWorld(osg::Vec3d(to.x(), to.y(), from.z()), there);
        if (this->getSettings()->getLockAzimuthWhilePanning())
            return {there, this->computeCenterRotation(there)};
        osg::Quat bent;
        bent.makeRotate(up, upAt(there));
        return {there, focus.rotation * bent};
    }
    void take(const Focus& focus)
    {
        this->setCenter(focus.center);
        this->_centerRotation = focus.rotation;
        this->_previousUp = this->getUpVector(this->_centerLocalToWorld);
    }
    /// Looks as a view matrix of the map's frame does, with a focus so far from the eye, metres.
    void lookFrom(const osg::Matrixd& view, double distance)
    {
        osg::Vec3d eye, center, up;
        view.getLookAt(eye, center, up, distance);
        this->setByLookAtRaw(eye, center, up);
    }
    /// Puts the focus on the ground that is seen in the picture's middle. The camera stays.
    void focus()
    {
        const auto shown = picture();
        if (!shown) return;
        const osg::Viewport& port = *camera()->getViewport();
        const auto hit =
            shown->pickCurved(0.5 * port.width(), 0.5 * port.height(), this->_intersectTraversalMask);
        const double distance = hit ? -hit->deformed.z() : 0.0;
        const auto& settings = *this->getSettings();
        if (distance > 0.0 && distance >= settings.getMinDistance() && distance <= settings.getMaxDistance())
            lookFrom(this->getWorldInverseMatrix(), distance);
    }
    /// Shortens the way from the focus to a place, in the map's frame, to a share of it.
    void approach(const osg::Vec3d& place, double share)
    {
        const osg::Vec3d& center = this->_center;
        osg::Vec3d there = place + (center - place) * share;
        if (this->_srs->isGeographic())
        {
            osg::Quat turn, part;
            turn.makeRotate(center, place);
            part.slerp(1.0 - share, osg::Quat(), turn);
            there = part * center;
            there *= (place.length() + (center.length() - place.length()) * share) / there.length();
        }
        take({there, this->computeCenterRotation(there)});
    }
    /// Where a place is drawn, in the map's frame, for this camera when it stands as high above the place: there, bends have no
    /// part in it.
    osg::Vec3d drawnBelow(const DeformedView& shown, const osg::Vec3d& place) const
    {
        const osg::Matrixd toMap = shown.modelView() * this->getWorldMatrix();
        const osg::Vec3d flat = place * toMap, up = upAt(flat);
        const osg::Vec3d eye = this->getWorldMatrix().getTrans();
        const double height = std::max(std::abs((eye - flat) * upAt(eye)), 1.0);
        const osg::Matrixd view = viewOf({flat, this->computeCenterRotation(flat)}, 0.0);
        const osg::Vec3d from = osg::Matrixd::inverse(view).getTrans() * this->_mapNodeFrameInverse;
        const osg::Matrixd above = this->_mapNodeFrameInverse *
                                   osg::Matrixd::translate(from - flat - up * height) * this->_mapNodeFrame *
                                   view;
        return pictureFrom(*scene(), above).deform(place) * toMap;
    }
    /// Keeps the eye above the ground.
    void rise(osg::Camera& raised)
    {
        const auto& settings = *this->getSettings();
        if (!settings.getTerrainAvoidanceEnabled() || !picture()) return;
        const auto view = _watch.risen(*scene(), raised, settings.getTerrainAvoidanceMinimumDistance());
        if (!view) return;
        raised.setViewMatrix(*view);
        if (this->isTethering() || this->isSettingViewpoint()) return;
        const osg::Vec3d eye = osg::Matrixd::inverse(*view).getTrans() * this->_mapNodeFrameInverse;
        this->setCenter(this->_center + eye - this->getWorldMatrix().getTrans());
    }

    osg::observer_ptr<osg::Camera> _camera;
    osg::Vec2d _pixel; ///< that shows the place to which one zooms
    AboveGround::Watch _watch;
};

} // namespace osgGeoFX
