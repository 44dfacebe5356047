// SPDX-License-Identifier: MIT
// SPDX-FileCopyrightText: 2026 the osgGeoFX authors
//
// How long the edges of a mesh may be that is made before a camera is known: bounds over all cameras of a range.
#include <osgGeoFX/deformation/BlendedView.h>
#include <osgGeoFX/deformation/VerticalExaggeration.h>
#include <osgGeoFX/effect/GlslFunctions.h>

#include <osg/Math>

#include <algorithm>
#include <cmath>

namespace osgGeoFX
{

namespace
{

/// As in PerspectiveBend.cpp.
constexpr double foldMargin = 0.9;
/// Of a camera's level axis along its right vector, rolled by 60°.
constexpr double leastLevel = 0.5;
/// tan(β/2)/cos(β/2) for the largest bend, 90°: the curvature of a bend whose tangents meet a metre from its ends.
const double sharpestBend = std::sqrt(2.0);

/// The steepest edges, rise over run, that bends reckon with: steeper ones are short in any mesh of a ground.
constexpr double climb = 0.25;
/// Of ARC_LENGTH, whose speed in the zone is 0.81 for the largest bend.
constexpr double mostSpeedJump = 0.19;

/// Of the ground's distance from T in the curve's radius, where neither is known; and by how much more it is on a globe, which falls
/// away below T: by 80 m at 32 km, where curves have radii of kilometres.
constexpr double usualShare = 0.3, globeShare = 0.05;

/// The longest edge whose image's second derivative, for each square metre of the edge, is `second`.
double longestFor(double second, double error)
{
    return second > 0.0 ? std::sqrt(8.0 * error / second) : HUGE_VAL;
}

/// Of a bend P = C(s) + h·N(s): beside the curve itself the turn of N counts, by h, and by how much an edge climbs. `share`: of h,
/// at most, in the radius of the curve.
double secondOf(double curvature, double share)
{
    const double along = 1.0 + 2.05 * share;
    return curvature * 0.5 * (along + std::sqrt(along * along + 4.0));
}

osg::Vec3d rayOf(const osg::Matrixd& projection, double line, osg::Vec3d& origin)
{
    osg::Vec3d direction;
    ViewGeometry::ray(projection, osg::Matrixd::inverse(projection), 0.0, 2.0 * line - 1.0, origin,
                      direction);
    direction.normalize();
    return direction;
}

} // namespace

double PerspectiveBend::foldCurvature(const Ground& ground, double angle) const
{
    double extent = _tallest;
    if (_tallest < 0.0)
    {
        // Below the eye the plane may be anywhere.
        const bool placed = _planeReference == GROUND;
        extent = !placed       ? 0.0
                 : angle > 0.0 ? ground.maxHeight - _planeHeight
                               : _planeHeight - ground.minHeight;
    }
    return foldMargin / std::max(extent, 1.0);
}

double PerspectiveBend::leastPlaneHeight(const CameraRange& cameras) const
{
    if (_planeReference == EYE) return -_planeHeight;
    return cameras.distance + std::min(0.0, cameras.ground.minHeight - _planeHeight);
}

double PerspectiveBend::mostCurvatureOf(Curve, const CameraRange& cameras) const
{
    return std::max(foldCurvature(cameras.ground, 1.0), foldCurvature(cameras.ground, -1.0));
}

double PerspectiveBend::heightShare(const Ground& ground, double curvature) const
{
    if (!ground.heightsKnown || _planeReference != GROUND) return usualShare;
    const double share = curvature * std::max(std::abs(ground.maxHeight - _planeHeight),
                                              std::abs(ground.minHeight - _planeHeight));
    return ground.ellipsoid ? share + globeShare : share;
}

double PerspectiveBend::longestEdge(const CameraRange& cameras, double tolerance) const
{
    const double curvature = mostCurvatureOf(getCurve(), cameras);
    const double share = heightShare(cameras.ground, curvature);
    // An error of second·L²/8, and of kink·L/4 where the zone begins and ends: there lengths along the bend change at once, by h and by
    // the curve's own speed, which turns edges that climb.
    const double second = secondOf(curvature, share);
    const double jump = std::min(0.95, share + (getCurve() == ARC_LENGTH ? mostSpeedJump : 0.0));
    const double kink = jump * climb / std::hypot(1.0 - jump, climb);
    const double error = tolerance * cameras.distance;
    return (std::sqrt(kink * kink / 4.0 + 2.0 * second * error) - kink / 2.0) / (second / 2.0);
}

double BlendedView::heightShare(const Ground& ground, double curvature) const
{
    // Each of the two has a plane of its own.
    return std::max(_birdsEye->heightShare(ground, curvature), _pedestrian->heightShare(ground, curvature));
}

double BirdsEyeView::heightShare(const Ground& ground, double curvature) const
{
    const double share = PerspectiveBend::heightShare(ground, curvature);
    if (!sinks(ground)) return share;
    const double most = curvature * (ground.maxHeight - ground.minHeight);
    return std::max(share, ground.ellipsoid ? most + globeShare : most);
}

double PerspectiveBend::mostGrowth(const Ground&) const
{
    return 1.0 + foldMargin;
}

double BirdsEyeView::mostCurvatureOf(Curve, const CameraRange& cameras) const
{
    double folds = foldCurvature(cameras.ground, -1.0);
    // T sinks no lower than to half of the eye's height above the lowest ground.
    const double least = 0.5 * cameras.distance + std::max(getPlaneHeight(), 0.0);
    if (sinks(cameras.ground) && getTallest() < 0.0)
        folds = std::max(folds, foldMargin / std::max(least, 1.0));
    osg::Vec3d low, high;
    const osg::Vec3d focus = rayOf(cameras.projection, _focusLine, low);
    const osg::Vec3d horizon = rayOf(cameras.projection, _horizonLine, high);
    // How far the tangents of the bend meet from its ends, at least: two rays from the eye are H·sin(Δ)/(sin(ν1)·sin(ν2))
    // apart on T; parallel ones, their distance at least.
    double reach = 0.0;
    if (cameras.projection(3, 3) == 0.0)
        reach = leastPlaneHeight(cameras) * (focus ^ horizon).length();
    else
        reach = std::abs(high.y() - low.y());
    reach *= leastLevel * (1.0 - _contextTilt);
    return reach > 0.0 ? std::min(folds, sharpestBend / reach) : folds;
}

double PedestrianView::mostCurvatureOf(Curve curve, const CameraRange& cameras) const
{
    const double folds = foldCurvature(cameras.ground, 1.0);
    const double curvature = glsl::geofx_bendCurvature(glsl::geofx_makeBend(curve, 1.0, _bendAngle));
    return _zoneWidth > 0.0 ? std::min(folds, curvature / _zoneWidth) : folds;
}

double BlendedView::mostCurvatureOf(Curve curve, const CameraRange& cameras) const
{
    return std::max(_birdsEye->mostCurvatureOf(curve, cameras), _pedestrian->mostCurvatureOf(curve, cameras));
}

double VerticalExaggeration::longestEdge(const CameraRange& cameras, double tolerance) const
{
    const osg::EllipsoidModel* ellipsoid = cameras.ground.ellipsoid;
    if (!ellipsoid) return HUGE_VAL;
    // As in the bounds for one camera: lift·up, of which the height's second derivative is at most the curvature k.
    const double k = 1.0 / ellipsoid->getRadiusPolar();
    const double lift = std::max(std::abs(cameras.ground.minHeight - _baseHeight),
                                 std::abs(cameras.ground.maxHeight - _baseHeight));
    const double second = std::abs(_factor - 1.0) * 1.3 * (3.0 * k + 3.0 * k * k * lift);
    return longestFor(second, tolerance * cameras.distance);
}

double VerticalExaggeration::mostGrowth(const Ground& ground) const
{
    double growth = std::max(1.0, _factor);
    if (!ground.ellipsoid) return growth;
    const double lift = std::abs(_factor - 1.0) * std::max(std::abs(ground.minHeight - _baseHeight),
                                                           std::abs(ground.maxHeight - _baseHeight));
    return growth * (1.0 + 1.1 * lift / ground.ellipsoid->getRadiusPolar());
}

} // namespace osgGeoFX
