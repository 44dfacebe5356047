// SPDX-License-Identifier: MIT
// SPDX-FileCopyrightText: 2026 the osgGeoFX authors
#pragma once

#include <osgGeoFX/panorama/PanoramaPose.h>

#include <osgGA/CameraManipulator>

#include <optional>

namespace osgGeoFX
{

/** Moves the camera of a panorama map with mouse and keyboard. The ground under the pointer stays under the pointer
    while it is dragged, anywhere in the picture and at any height.

    The left button drags the ground. The wheel or the right button zooms about the pointer. The middle button or the
    keys Left and Right turn about the middle of the picture. The keys Up and Down zoom about it. Space returns home.
    Buttons with Ctrl, Alt or Shift are left to other handlers. Wheel and keys move the camera smoothly.

    The eye stands above the middle of the picture's base. The heading is clockwise from north (from the grid's north
    on a projected terrain). A zoom changes the eye's height, from 100 m to 5000 km above the map's base. If the eye's
    height does not set the map's width (viewRadius is set, or the camera is orthographic), a zoom changes viewRadius
    instead, from 25 m to 2000 km. There is no roll. The pitch shows only while the map is off; setPitch(), home and
    another manipulator's matrix change it. The manipulator works in the same way while the map is off.

    The scene and its terrain, geocentric or projected, must have no transform above them. One manipulator serves one
    view, in its event traversal.
    @ingroup panorama */
class OSGGEOFX_EXPORT PanoramaManipulator : public osgGA::CameraManipulator
{
public:
    PanoramaManipulator(EffectScene& scene, PanoramaMap& map);
    const char* libraryName() const override { return "osgGeoFX"; }
    const char* className() const override { return "PanoramaManipulator"; }

    /// Moves the camera until this place of the ground (world coordinates) appears in the middle of the picture. If
    /// the middle shows sky, it appears at 70 % of the horizon's height. Returns false if that is impossible.
    bool setCenter(const osg::Vec3d& world);
    osg::Vec3d getCenter() const;
    /// The width of the ground shown at the picture's base, metres, clamped to the limits above. The center stays.
    void setWidth(double metres);
    double getWidth() const { return 2.0 * _pose.radius(); }
    /// Radians clockwise from north. The camera turns about the center.
    void setHeading(double radians);
    double getHeading() const { return _pose.heading(); }
    /// Radians; 0 is level, negative looks down. −85°…0, −35° by default.
    void setPitch(double radians) { _pose.setPitch(radians); }
    double getPitch() const { return _pose.pitch(); }
    /// The projection matrix that widths refer to until the first event supplies the camera's own.
    void setCameraProjection(const osg::Matrixd& projection) { _pose.setProjection(projection); }

    void setByMatrix(const osg::Matrixd& matrix) override;
    void setByInverseMatrix(const osg::Matrixd& matrix) override;
    osg::Matrixd getMatrix() const override { return _pose.matrix(); }
    osg::Matrixd getInverseMatrix() const override;
    void setNode(osg::Node*) override {}
    const osg::Node* getNode() const override { return _scene; }
    osg::Node* getNode() override { return _scene; }
    void home(double time) override;
    void home(const osgGA::GUIEventAdapter& event, osgGA::GUIActionAdapter& action) override;
    void init(const osgGA::GUIEventAdapter& event, osgGA::GUIActionAdapter& action) override;
    bool handle(const osgGA::GUIEventAdapter& event, osgGA::GUIActionAdapter& action) override;
    void getUsage(osg::ApplicationUsage& usage) const override;
    /// Whether a smooth movement is still in progress.
    bool gliding() const { return _glide.has_value(); }

protected:
    ~PanoramaManipulator() override;

private:
    struct Glide
    {
        PanoramaHold hold;
        double radius;
        double heading;
        double time; ///< of the last step, seconds
    };

    void rest();
    void follow(osgGA::GUIActionAdapter& action);
    PanoramaHold holdSeen(const osg::Vec2d& picture, osgGA::GUIActionAdapter& action) const;
    bool push(const osgGA::GUIEventAdapter& event, osgGA::GUIActionAdapter& action);
    bool drag(const osgGA::GUIEventAdapter& event);
    bool scroll(const osgGA::GUIEventAdapter& event, osgGA::GUIActionAdapter& action);
    bool key(const osgGA::GUIEventAdapter& event, osgGA::GUIActionAdapter& action);
    Glide& glideFrom(const osgGA::GUIEventAdapter& event, const PanoramaHold& hold);
    void step(double time);

    const osg::ref_ptr<EffectScene> _scene;
    const osg::ref_ptr<PanoramaMap> _map;
    const double _homeRadius; ///< viewRadius of the map when the manipulator was made
    PanoramaPose _pose;
    std::optional<PanoramaHold> _hold; ///< while a button is down
    int _button = 0;
    osg::Vec2d _pointer; ///< at the last event with a button down, in the picture
    osg::Vec2d _offset;  ///< from the pointer to the point where the hold is kept
    std::optional<Glide> _glide;
};

} // namespace osgGeoFX
