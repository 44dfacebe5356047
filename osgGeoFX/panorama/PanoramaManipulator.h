// SPDX-License-Identifier: MIT
// SPDX-FileCopyrightText: 2026 the osgGeoFX authors
#pragma once

#include <osgGeoFX/panorama/PanoramaPose.h>

#include <osgGA/CameraManipulator>

#include <optional>

namespace osgGeoFX
{

/** Moves the camera of a panorama map by hand, as users of Brown and Samavati's maps do: the ground that the pointer has
    taken hold of stays under it, wherever in the picture it is and however high.

    Left button: drags the ground. Wheel, or right button up and down: zooms about the pointer. Middle button, or Left and
    Right: turns about the middle of the picture; Up and Down go on and back. Space: home. With Ctrl, Alt or Shift
    buttons are for other handlers. Wheel and keys glide.

    The eye stands above the middle of the picture's base, heading is clockwise from north (on a projected terrain, from
    the grid's), and a zoom raises and lowers the eye, from 100 m to 5000 km above the map's base; where the map's
    width does not follow from that (viewRadius is set, or the camera is orthographic), a zoom sets viewRadius. The
    camera's pitch, which only shows while the map is off, stays as home or the last manipulator had it; there is no
    roll. While the map is off it moves as if it were on.

    The scene and its terrain, geocentric or projected, have no transform above them. Serves one view, in its event
    traversal. */
class OSGGEOFX_EXPORT PanoramaManipulator : public osgGA::CameraManipulator
{
public:
    PanoramaManipulator(EffectScene& scene, PanoramaMap& map);
    const char* libraryName() const override { return "osgGeoFX"; }
    const char* className() const override { return "PanoramaManipulator"; }

    /// The place of the ground, in the scene's world, in the middle of the picture, or of its ground where that is sky.
    /// False where it cannot be brought there.
    bool setCentre(const osg::Vec3d& world);
    osg::Vec3d getCentre() const;
    /// The width of the ground shown at the picture's base, metres, kept within the limits above. The centre stays.
    void setWidth(double metres);
    double getWidth() const { return 2.0 * _pose.radius(); }
    /// Radians clockwise from north; turns about the centre.
    void setHeading(double radians);
    double getHeading() const { return _pose.heading(); }
    /// Radians, 0 level, less looks down; −85°…0, −35° by default.
    void setPitch(double radians) { _pose.setPitch(radians); }
    double getPitch() const { return _pose.pitch(); }
    /// The projection for which widths are meant, until the first event brings the camera's.
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
    /// Whether it still glides.
    bool gliding() const { return _glide.has_value(); }

protected:
    ~PanoramaManipulator() override;

private:
    struct Glide
    {
        PanoramaHold hold;
        double radius;
        double heading;
        double time; ///< of the last step
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
    const double _homeRadius; ///< the map's own
    PanoramaPose _pose;
    std::optional<PanoramaHold> _hold; ///< while a button is down
    int _button = 0;
    osg::Vec2d _pointer; ///< of the last event with a button down, in the picture
    osg::Vec2d _offset;  ///< from the pointer to where its hold is kept
    std::optional<Glide> _glide;
};

} // namespace osgGeoFX
