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

/// Of the equator's radius: no mountain is higher, and no sea deeper, on the Earth, the Moon and Mars.
constexpr double UNKNOWN_SHARE = 0.0035;
/// Radians. Larger parts of a globe are in sight from almost everywhere.
constexpr double LARGEST_ANGLE = 1.45;
/// Metres. Within a ball of this radius an affine map is found exactly enough.
constexpr double SMALLEST = 1000.0;
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
    double sinks = 0.0, lifts = 0.0, surface = 0.0;
    for (const auto& snapshot : chain.snapshots())
    {
        const std::optional<double> low = snapshot->movedHeight(lowest),
                                    high = snapshot->movedHeight(highest);
        if (!low || !high) break;
        // The sphere lies below the meshes' triangles as far as it did.
        sinks += std::min({*low - lowest, *high - highest, 0.0});
        lifts += std::max(std::abs(*low - lowest), std::abs(*high - highest));
        surface = snapshot->movedHeight(surface).value_or(surface);
        lowest = *low;
        highest = *high;
        ++_affineFrom;
    }
    _inner = sphere + sinks;
    _highest = equator + std::max(highest, 0.0);
    if (!(_inner > 0.1 * sphere) || !std::isfinite(_highest)) return;
    _slack = ROUNDING + VERTICAL_ERROR * lifts / _inner;
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

double GlobeHorizon::stretchWithin(const Cap& cap, const osg::Vec3d& eye) const
{
    const double longest = std::sqrt(_highest * _highest - _inner * _inner);
    const osg::Vec3d toEye = eye - _center - cap.middle * _highest;
    const double away = toEye.length(), width = 2.0 * _highest * cap.radius;
    if (!(away > width)) return longest;
    // Between a line of sight and the line from the place down to the center.
    const double angle =
        std::acos(std::clamp(-(toEye * cap.middle) / away, -1.0, 1.0)) + cap.radius + std::asin(width / away);
    if (!(angle < 0.5 * osg::PI)) return longest;
    const double across = _highest * std::sin(angle);
    if (!(across < _inner)) return longest;
    return std::min(longest, _highest * std::cos(angle) - std::sqrt(_inner * _inner - across * across));
}

bool GlobeHorizon::hides(const Cap& cap, const Ball& ball) const
{
    const double angle = cap.radius + std::acos(_inner / _highest) + _slack;
    if (!(angle < LARGEST_ANGLE)) return false;
    const std::optional<osg::Vec3d> eye = eyeBefore(ball, 0.0);
    if (!eye) return false;
    // Lines of sight that graze the sphere and end at the cap's border form a cone.
    const osg::Vec3d fromTip = *eye - _center - cap.middle * (_inner / std::cos(angle));
    const double distance = fromTip.length();
    if (!(distance > _inner * std::tan(angle) && fromTip * cap.middle < -std::sin(angle) * distance))
        return false;
    // One affine map must hold from the place to the sphere.
    return eyeBefore(ball, stretchWithin(cap, *eye)).has_value();
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

osg::Vec3d GlobeHorizon::scaled(const osg::Vec3d& position) const
{
    const osg::Vec3d fromCenter = position - _center;
    const osg::Vec3d along = _axis * (fromCenter * _axis);
    return (fromCenter - along) / _equator + along / _polar;
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
    // Where the line of sight comes out of the unit sphere, as a share of its way to the place. An eye before the map may be within.
    const osg::Vec3d from = scaled(*eye), toPlace = scaled(place) - from;
    const double half = from * toPlace, square = toPlace.length2();
    const double rest = half * half - square * (from.length2() - 1.0);
    if (!(rest > 0.0)) return false;
    const double comesOut = (std::sqrt(rest) - half) / square;
    if (!(comesOut > 0.0 && comesOut < 1.0)) return false;
    // One affine map must hold from there on.
    return eyeBefore({position, 0.0}, (1.0 - comesOut) * (place - *eye).length()).has_value();
}

} // namespace osgGeoFX
