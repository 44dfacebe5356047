// SPDX-License-Identifier: MIT
// SPDX-FileCopyrightText: 2026 the osgGeoFX authors
#include <osgGeoFX/scene/detail/GlobeHorizon.h>

#include <osgGeoFX/effect/detail/InnerSphere.h>

#include <osg/Math>

#include <algorithm>
#include <cmath>

namespace osgGeoFX
{

namespace
{

/// Radians. Larger parts of a globe are in sight from almost everywhere.
constexpr double LARGEST_ANGLE = 1.45;
/// Metres. Within a ball of this radius an affine map is found exactly enough.
constexpr double SMALLEST = 1000.0;
/// How far triangles sink below the ground's curve at the horizon, of the way there: several pixels' errors of what levels of detail
/// draw. And at least, metres.
constexpr double MESH_ERROR = 0.005, LEAST_SAG = 2000.0;
/// Callbacks hold floats.
constexpr double ROUNDING = 1e-5;
/// The largest angle between a vertical of the ellipsoid and the line to its center, radians.
constexpr double VERTICAL_ERROR = 0.0034;

} // namespace

GlobeHorizon::GlobeHorizon(const DeformationChain& chain, const ViewGeometry& view, const osg::Vec3d& eye)
    : _eye(eye)
{
    const Ground& ground = view.ground;
    if (!ground.ellipsoid || chain.empty()) return;
    _up = view.up;
    const double equator = ground.ellipsoid->getRadiusEquator();
    const double sphere = INNER_SHARE * ground.ellipsoid->getRadiusPolar();
    const double unknown = ground.heightsKnown ? 0.0 : UNKNOWN_SHARE * equator;
    double lowest = std::min(ground.minHeight, -unknown), highest = std::max(ground.maxHeight, unknown);
    const double tallest = highest;
    double lifts = 0.0, surface = 0.0;
    for (const auto& snapshot : chain.snapshots())
    {
        const std::optional<double> low = snapshot->movedHeight(lowest),
                                    high = snapshot->movedHeight(highest);
        if (!low || !high) break;
        lifts += std::max(std::abs(*low - lowest), std::abs(*high - highest));
        surface = snapshot->movedHeight(surface).value_or(surface);
        lowest = *low;
        highest = *high;
        ++_affineFrom;
    }
    _lowest = std::min(lowest, 0.0);
    _highest = std::max(highest, 0.0);
    if (!(_lowest > -0.9 * sphere) || !std::isfinite(_highest)) return;
    _slack = ROUNDING + VERTICAL_ERROR * lifts / (sphere + _lowest);
    _flat = std::acos(sphere / equator);
    _surface = surface;
    const auto beyond = [equator](double height)
    {
        return std::acos(equator / (equator + std::max(height, 0.0)));
    };
    _mountains = std::max(beyond(highest - surface) - beyond(tallest), 0.0);
    _center = osg::Vec3d() * view.modelView;
    _axis = view.polarAxis;
    _equator = equator + surface;
    _polar = ground.ellipsoid->getRadiusPolar() + surface;
    _chain = &chain;
}

std::optional<osg::Vec3d> GlobeHorizon::eyeBefore(const Ball& ball, double stretch) const
{
    const auto& snapshots = _chain->snapshots();
    Ball moved = ball;
    for (std::size_t i = 0; i < _affineFrom; ++i)
        moved = snapshots[i]->bound(moved);
    // Of a single place the map could not be told.
    moved.radius = std::max(moved.radius + stretch, SMALLEST);
    osg::Matrixd whole;
    for (std::size_t i = _affineFrom; i < snapshots.size(); ++i)
    {
        const DeformationSnapshot& snapshot = *snapshots[i];
        const DeformationSnapshot::Reach reach = snapshot.reach(moved);
        if (reach == DeformationSnapshot::Reach::Identity) continue;
        if (reach != DeformationSnapshot::Reach::Affine) return std::nullopt;
        const osg::Vec3d origin = snapshot.deform(moved.center);
        osg::Vec3d axes[3];
        for (int axis = 0; axis < 3; ++axis)
        {
            osg::Vec3d step;
            step[axis] = moved.radius;
            axes[axis] = (snapshot.deform(moved.center + step) - origin) / moved.radius;
        }
        const osg::Matrixd linear(axes[0].x(), axes[0].y(), axes[0].z(), 0.0, axes[1].x(), axes[1].y(),
                                  axes[1].z(), 0.0, axes[2].x(), axes[2].y(), axes[2].z(), 0.0, 0.0, 0.0, 0.0,
                                  1.0);
        whole = whole * osg::Matrixd::translate(-moved.center) * linear * osg::Matrixd::translate(origin);
        moved = snapshot.bound(moved);
    }
    osg::Matrixd inverse;
    if (!inverse.invert(whole)) return std::nullopt;
    return _eye * inverse;
}

double GlobeHorizon::meshSag(const osg::Vec3d& eye) const
{
    const double polar = _polar - _surface;
    const double height = std::max((eye - _center).length() - polar, 0.0);
    const double toHorizon = std::sqrt(height * (height + 2.0 * polar));
    return std::clamp(MESH_ERROR * toHorizon, LEAST_SAG, (1.0 - INNER_SHARE) * polar);
}

double GlobeHorizon::stretchWithin(const Cap& cap, const osg::Vec3d& eye, double highest)
{
    const double longest = std::sqrt(highest * highest - 1.0);
    const osg::Vec3d toEye = eye - cap.middle * highest;
    const double away = toEye.length(), width = 2.0 * highest * cap.radius;
    if (!(away > width)) return longest;
    // Between a line of sight and the line from the place down to the center.
    const double angle =
        std::acos(std::clamp(-(toEye * cap.middle) / away, -1.0, 1.0)) + cap.radius + std::asin(width / away);
    if (!(angle < 0.5 * osg::PI)) return longest;
    const double across = highest * std::sin(angle);
    if (!(across < 1.0)) return longest;
    return std::min(longest, highest * std::cos(angle) - std::sqrt(1.0 - across * across));
}

bool GlobeHorizon::hides(const Cap& cap, const Ball& ball) const
{
    if (!(cap.radius < LARGEST_ANGLE)) return false;
    const std::optional<osg::Vec3d> eye = eyeBefore(ball, 0.0);
    if (!eye) return false;
    // In the space where the ellipsoid within all drawn ground is the unit sphere. There angles are larger by the ratio of its radii at
    // most.
    const double floor = _lowest - meshSag(*eye);
    const Radii radii = {_equator - _surface + floor, _polar - _surface + floor};
    const double highest = (_polar - _surface + _highest) / radii.polar;
    Cap there = {scaled(cap.middle, radii), cap.radius * radii.equator / radii.polar};
    there.middle.normalize();
    const osg::Vec3d from = scaled(*eye - _center, radii);
    const double angle = there.radius + std::acos(1.0 / highest) + _slack;
    if (!(angle < LARGEST_ANGLE)) return false;
    // Lines of sight that graze the sphere and end at the cap's border form a cone.
    const osg::Vec3d fromTip = from - there.middle / std::cos(angle);
    const double distance = fromTip.length();
    if (!(distance > std::tan(angle) && fromTip * there.middle < -std::sin(angle) * distance)) return false;
    // One affine map must hold from the place to the sphere.
    return eyeBefore(ball, radii.equator * stretchWithin(there, from, highest)).has_value();
}

bool GlobeHorizon::hides(const osg::ClusterCullingCallback& callback, const osg::Matrixd& modelView,
                         const Ball& ball) const
{
    if (!_chain) return false;
    const osg::Vec3d tip(callback.getControlPoint()), normal(callback.getNormal());
    const double sine = -static_cast<double>(callback.getDeviation());
    const double radius = static_cast<double>(callback.getRadius()), far = tip.length();
    // The cone touches a sphere about the globe's center.
    const bool ours = sine > 0.0 && sine < 1.0 && std::abs(tip * normal - far) < 1e-6 * far &&
                      std::abs(radius - far * sine) < 1e-3 * radius;
    if (!ours) return false;
    osg::Vec3d middle = osg::Matrixd::transform3x3(normal, modelView);
    middle.normalize();
    return hides({middle, std::max(std::asin(sine) - _flat, 0.0)}, ball);
}

bool GlobeHorizon::hides(const Ball& ball) const
{
    if (!_chain) return false;
    osg::Vec3d middle = ball.center - _center;
    const double distance = middle.normalize();
    if (!(ball.radius < distance)) return false;
    return hides({middle, std::asin(ball.radius / distance)}, ball);
}

osg::Vec3d GlobeHorizon::scaled(const osg::Vec3d& fromCenter, const Radii& radii) const
{
    const osg::Vec3d along = _axis * (fromCenter * _axis);
    return (fromCenter - along) / radii.equator + along / radii.polar;
}

osg::Vec3d GlobeHorizon::scaled(const osg::Vec3d& position) const
{
    return scaled(position - _center, {_equator, _polar});
}

std::optional<osg::Vec3d> GlobeHorizon::eyeAhead() const
{
    if (_affineFrom == _chain->snapshots().size()) return _eye;
    // On the ground, where the horizon is.
    osg::Vec3d forward = osg::Vec3d(0.0, 0.0, -1.0) + _up * _up.z();
    if (forward.normalize() < 1e-3) return std::nullopt;
    const double height = std::max((_eye - _center).length() - _polar, 1.0);
    const double turn = std::acos(_polar / (_polar + height));
    return eyeBefore({_center + (_up * std::cos(turn) + forward * std::sin(turn)) * _polar, 0.0}, 0.0);
}

std::optional<osg::Vec4d> GlobeHorizon::plane() const
{
    if (!_chain) return std::nullopt;
    const std::optional<osg::Vec3d> ahead = eyeAhead();
    if (!ahead) return std::nullopt;
    osg::Vec3d normal = scaled(*ahead), ofEye = scaled(_eye);
    const double distance = normal.normalize(), ofEyeDistance = ofEye.normalize();
    if (distance == 0.0 || ofEyeDistance == 0.0) return std::nullopt;
    const auto toHorizon = [](double length)
    {
        return std::acos(std::min(1.0 / length, 1.0));
    };
    // What is not bent is seen from the eye itself.
    const double turn = std::acos(std::clamp(normal * ofEye, -1.0, 1.0));
    const double angle =
        (turn > 0.0 ? std::max(toHorizon(distance), turn + toHorizon(ofEyeDistance)) : toHorizon(distance)) +
        _mountains;
    if (!(angle < osg::PI)) return std::nullopt;
    // Undeformed: where vertical movements have not yet moved the smooth globe.
    const double equator = _equator - _surface, polar = _polar - _surface;
    const osg::Vec3d along = _axis * (normal * _axis);
    const osg::Vec3d undeformed = (normal - along) / equator + along / polar;
    const double length = undeformed.length();
    return osg::Vec4d(undeformed / length, -(undeformed * _center + std::cos(angle)) / length);
}

bool GlobeHorizon::hidesPlace(const osg::Vec3d& position) const
{
    if (!_chain) return false;
    const std::optional<osg::Vec3d> eye = eyeBefore({position, 0.0}, 0.0);
    if (!eye) return false;
    osg::Vec3d place = position;
    for (std::size_t i = 0; i < _affineFrom; ++i)
        place = _chain->snapshots()[i]->deform(place);
    const osg::Vec3d from = scaled(*eye), toPlace = scaled(place) - from;
    const double half = from * toPlace, square = toPlace.length2();
    const double rest = half * half - square * (from.length2() - 1.0);
    if (!(rest > 0.0)) return false;
    // The line of sight enters the unit sphere, is nearest to its center at the share -half / square of its way to the place, and
    // comes out. A label often stands on the sphere or a little below. It is on the far side if the line has been nearest before.
    if (!(half < 0.0 && -half < square)) return false;
    const double comesOut = std::min((std::sqrt(rest) - half) / square, 1.0);
    // One affine map must hold from there on.
    return eyeBefore({position, 0.0}, (1.0 - comesOut) * (place - *eye).length()).has_value();
}

} // namespace osgGeoFX
