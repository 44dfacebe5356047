// SPDX-License-Identifier: MIT
// SPDX-FileCopyrightText: 2026 the osgGeoFX authors
#include <osgGeoFX/light/SunLight.h>

#include <osg/Math>

#include <algorithm>
#include <cmath>

namespace osgGeoFX
{

namespace
{

/// Of red, green and blue, with the sun in the zenith: half of the usual ones of clear air with a little haze.
constexpr double opticalDepths[] = {0.05, 0.09, 0.18};

double smoothly(double from, double to, double value)
{
    const double t = std::clamp((value - from) / (to - from), 0.0, 1.0);
    return t * t * (3.0 - 2.0 * t);
}

/// How many times the zenith's air light passes (Kasten and Young 1989). `elevation` in degrees.
double airMass(double elevation)
{
    const double above = std::max(elevation, 0.0);
    return 1.0 / (std::sin(osg::DegreesToRadians(above)) + 0.50572 * std::pow(above + 6.07995, -1.6364));
}

} // namespace

SunLight::SunLight()
    : _color(1.0f, 244.0f / 255.0f, 224.0f / 255.0f, 1.0f),
      _ambient(76.0f / 255.0f, 85.0f / 255.0f, 0.4f, 1.0f)
{
    getLight()->setLightNum(0);
    getLight()->setDataVariance(osg::Object::DYNAMIC);
    update();
}

SunLight::SunLight(const SunLight& other, const osg::CopyOp& copy)
    : osg::LightSource(other, copy), _longitude(other._longitude), _latitude(other._latitude),
      _frame(other._frame), _time(other._time), _color(other._color), _ambient(other._ambient)
{
    // The original moves its own light.
    if (other.getLight()) setLight(new osg::Light(*other.getLight()));
    update();
}

SunLight::~SunLight() = default;

void SunLight::setPlace(double longitude, double latitude, const osg::Matrixd& frame)
{
    _longitude = longitude;
    _latitude = latitude;
    _frame = frame;
    update();
}

void SunLight::setTime(const ClockTime& time)
{
    _time = time;
    update();
}

void SunLight::setColor(const osg::Vec4& color)
{
    _color = color;
    update();
}

void SunLight::setAmbient(const osg::Vec4& color)
{
    _ambient = color;
    update();
}

void SunLight::update()
{
    if (!getLight()) return;
    _position = sunPosition(_longitude, _latitude, _time.time);
    const double flat = std::cos(_position.elevation);
    const osg::Vec3d local(std::sin(_position.azimuth) * flat, std::cos(_position.azimuth) * flat,
                           std::sin(_position.elevation));
    osg::Light& light = *getLight();
    light.setPosition({osg::Matrixd::transform3x3(local, _frame), 0.0});

    const double elevation = osg::RadiansToDegrees(_position.elevation);
    const double air = airMass(elevation) - 1.0;
    const double risen = smoothly(-1.0, 1.0, elevation);
    osg::Vec4 direct = _color;
    for (int i = 0; i < 3; ++i)
        direct[i] = _color[i] * static_cast<float>(risen * std::exp(-opticalDepths[i] * air));
    light.setDiffuse(direct);
    light.setSpecular(direct);
    const double day = 1.0 / 9.0 + 8.0 / 9.0 * smoothly(-9.0, 12.0, elevation);
    light.setAmbient(
        {osg::Vec3(_ambient.x(), _ambient.y(), _ambient.z()) * static_cast<float>(day), _ambient.w()});
}

} // namespace osgGeoFX
