// SPDX-License-Identifier: MIT
// SPDX-FileCopyrightText: 2026 the osgGeoFX authors
#pragma once

#include <osgGeoFX/Export.h>
#include <osgGeoFX/effect/ClockTime.h>
#include <osgGeoFX/light/SunPosition.h>

#include <osg/LightSource>
#include <osg/Matrixd>

namespace osgGeoFX
{

/** The sun as a light of OpenGL, number 0, that follows a clock.

    @code
    osg::ref_ptr<osgGeoFX::SunLight> sun = new osgGeoFX::SunLight;
    sun->setPlace(longitude, latitude, localToWorld);
    sun->setTime(*osgGeoFX::readClockTime("2026-06-21T07:30:00-10:00"));
    scene->addChild(sun);
    @endcode

    The direction is that of the sun as seen from one place (sunPosition()); the whole scene has it, for the sun is far away.
    So a globe has a day side and a night side. The farther down the sun stands, the longer its way through the air, and the
    darker and redder its light is: half of what clear air takes away, since pictures have no pupils that widen. As it sets,
    its light goes out within two degrees. The ambient light fades from an elevation of 12° to a ninth at 9° below the horizon.

    Specular light has the color of diffuse light. Shader programs read it as any light. Setters are for the
    thread that updates the scene, between two frames.

    @ingroup light */
class OSGGEOFX_EXPORT SunLight : public osg::LightSource
{
public:
    SunLight();
    SunLight(const SunLight& other, const osg::CopyOp& copy = osg::CopyOp::SHALLOW_COPY);
    META_Node(osgGeoFX, SunLight);

    /// Where the sun is seen from: longitude and latitude in radians, and the frame there (x east, y north, z up) in that of the
    /// light's parent, such as Georeference::localToWorld() gives it. 0°, 0° and the parent's own frame by default.
    void setPlace(double longitude, double latitude, const osg::Matrixd& frame);
    double getLongitude() const { return _longitude; }
    double getLatitude() const { return _latitude; }
    const osg::Matrixd& getFrame() const { return _frame; }

    /// Noon in UTC on March 20th, 2026, when day and night are as long as each other, by default.
    void setTime(const ClockTime& time);
    const ClockTime& getTime() const { return _time; }
    static ClockTime firstTime() { return {1774008000.0, 0}; } ///< the default

    /// The light of a sun in the zenith; #fff4e0 by default.
    void setColor(const osg::Vec4& color);
    const osg::Vec4& getColor() const { return _color; }
    /// The light that reaches every surface by day; #4c5566 by default.
    void setAmbient(const osg::Vec4& color);
    const osg::Vec4& getAmbient() const { return _ambient; }

    /// Where the sun stands now.
    const SunPosition& position() const { return _position; }

protected:
    ~SunLight() override;

private:
    void update();

    double _longitude = 0.0, _latitude = 0.0;
    osg::Matrixd _frame;
    ClockTime _time = firstTime();
    osg::Vec4 _color, _ambient;
    SunPosition _position;
};

} // namespace osgGeoFX
