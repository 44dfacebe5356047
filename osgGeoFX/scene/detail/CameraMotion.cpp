// SPDX-License-Identifier: MIT
// SPDX-FileCopyrightText: 2026 the osgGeoFX authors
#include <osgGeoFX/scene/detail/CameraMotion.h>

#include <osg/Quat>

#include <algorithm>
#include <array>
#include <cmath>
#include <vector>

namespace osgGeoFX
{

namespace
{

constexpr double WINDOW = 0.5; ///< seconds whose frames count
constexpr std::size_t FEWEST = 4, MOST = 64;
// A camera that moves less stands still: metres and radians a second.
constexpr double STILL = 0.01, STARING = 1e-3;
/// After this many seconds a turn has two thirds of its whole angle behind it.
constexpr double TURNING = 1.0;
/// What moves by so many times the way that was to be expected has jumped.
constexpr double JUMP = 10.0;

osg::Matrixd rotationOf(osg::Matrixd matrix)
{
    matrix.setTrans(0.0, 0.0, 0.0);
    return matrix;
}

/// An axis with the length of the angle, radians.
osg::Vec3d turnOf(const osg::Matrixd& rotation)
{
    double angle = 0.0;
    osg::Vec3d axis;
    rotation.getRotate().getRotate(angle, axis);
    if (angle > osg::PI) angle -= 2.0 * osg::PI;
    return axis * angle;
}

osg::Matrixd turned(const osg::Vec3d& turn)
{
    const double angle = turn.length();
    return angle > 0.0 ? osg::Matrixd::rotate(angle, turn / angle) : osg::Matrixd();
}

} // namespace

double CameraMotion::timeOf(const osg::FrameStamp& stamp) const
{
    if (_samples.empty()) return 0.0;
    const double simulated = stamp.getSimulationTime() - _simulation;
    return _samples.back().time + (simulated != 0.0 ? simulated : stamp.getReferenceTime() - _reference);
}

void CameraMotion::add(const osg::FrameStamp& stamp, const osg::Matrixd& modelView)
{
    Sample next = {timeOf(stamp), modelView, osg::Matrixd::inverse(modelView).getTrans(), {}, {}};
    _simulation = stamp.getSimulationTime();
    _reference = stamp.getReferenceTime();
    if (!_samples.empty() && next.time == _samples.back().time) _samples.pop_back();
    if (!_samples.empty())
    {
        const Sample& last = _samples.back();
        const double duration = next.time - last.time;
        next.move = osg::Matrixd::transform3x3(next.eye - last.eye, modelView) / duration;
        next.turn =
            turnOf(osg::Matrixd::inverse(rotationOf(last.modelView)) * rotationOf(modelView)) / duration;
        // Time that goes back is a jump, too.
        if (duration < 0.0 || (settled() && jumps(next, duration))) _samples.clear();
    }
    _samples.push_back(next);
    while (_samples.size() > MOST || (_samples.size() > FEWEST && _samples.front().time < next.time - WINDOW))
        _samples.pop_front();
}

bool CameraMotion::settled() const
{
    return _samples.size() >= FEWEST;
}

bool CameraMotion::jumps(const Sample& next, double duration) const
{
    constexpr double corner = 0.2; // radians, which a hand turns from one frame to the next
    const double way = median(&Sample::move).length(), angle = median(&Sample::turn).length();
    return next.move.length() > JUMP * way + STILL ||
           next.turn.length() * duration > JUMP * angle * duration + corner;
}

osg::Vec3d CameraMotion::median(osg::Vec3d Sample::*value) const
{
    osg::Vec3d result;
    std::vector<double> values(_samples.size() - 1);
    for (int axis = 0; axis < 3; ++axis)
    {
        std::transform(_samples.begin() + 1, _samples.end(), values.begin(),
                       [&](const Sample& each) { return (each.*value)[axis]; });
        const auto middle = values.begin() + static_cast<std::ptrdiff_t>(values.size() / 2);
        std::nth_element(values.begin(), middle, values.end());
        result[axis] = *middle;
    }
    return result;
}

std::optional<osg::Matrixd> CameraMotion::at(double seconds) const
{
    if (!settled()) return std::nullopt;
    const osg::Vec3d move = median(&Sample::move), turn = median(&Sample::turn);
    if (move.length() < STILL && turn.length() < STARING) return std::nullopt;
    const Sample& last = _samples.back();
    const osg::Matrixd now = rotationOf(last.modelView);
    const auto rotationIn = [&](double time)
    {
        return now * turned(turn * (TURNING * (1.0 - std::exp(-time / TURNING))));
    };
    // The camera goes where it looks: along a curve, in steps.
    osg::Vec3d eye = last.eye;
    constexpr int steps = 8;
    for (int i = 0; i < steps; ++i)
    {
        const osg::Matrixd rotation = rotationIn(seconds * (i + 0.5) / steps);
        eye += osg::Matrixd::transform3x3(rotation, move) * (seconds / steps);
    }
    return osg::Matrixd::translate(-eye) * rotationIn(seconds);
}

} // namespace osgGeoFX
