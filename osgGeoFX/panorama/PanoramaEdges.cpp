// SPDX-License-Identifier: MIT
// SPDX-FileCopyrightText: 2026 the osgGeoFX authors
//
// How long the edges of a mesh may be that is made before a camera is known.
#include <osgGeoFX/panorama/PanoramaMap.h>
#include <osgGeoFX/panorama/detail/PanoramaProfile.h>

#include <algorithm>
#include <cmath>

namespace osgGeoFX
{

namespace
{

/// Of x, s and height on a globe, for each metre of its curvature: as in PanoramaSnapshot.cpp, up to 60° of arc.
constexpr double globeCurvature = 2.1 * 4.1 * 1.55;

} // namespace

// Behind the end of heights all ground is gathered in one point of the horizon; how it comes there is not looked at.
double PanoramaMap::longestEdge(const CameraRange& cameras, double tolerance) const
{
    if (!_projection) return HUGE_VAL;
    const osgGeoFX::Ground& ground = cameras.ground;
    const bool perspective = cameras.projection(3, 3) == 0.0;
    const double wide = std::abs(cameras.projection(0, 0)), high = std::abs(cameras.projection(1, 1));
    double base = _baseHeight;
    if (_baseFromTerrain && ground.heightsKnown) base = std::max(base, ground.minHeight);
    // The least radius; all that follows is at most what it is there.
    const double eye = cameras.distance + std::min(0.0, ground.minHeight - base);
    double radius = _viewRadius;
    if (radius == 0.0) radius = perspective ? std::max(eye, 1.0) / wide : 1.0 / wide;
    const double nearest = radius * (perspective ? wide : 1.0);
    const double curve = _curveDistance * radius, horizon = _horizonDistance * radius;
    const double across = 1.0 / radius;
    double along = 4.0 * _horizonLine / (curve + horizon); // at most
    double along2 = along / (horizon - curve);
    if (const glsl::geofx_Profile profile = profileThrough(getCurvePoints()); profile.first > 0.0)
    {
        const ProfileRates rates = ratesOf(profile, -1.0, 1.0);
        along = 2.0 * _horizonLine / horizon * rates.slope;
        along2 = 2.0 * _horizonLine / (horizon * horizon) * rates.second;
    }
    const double farther = _horizonExaggeration < 0.0 ? _exaggeration : _horizonExaggeration;
    const double lift = std::max(_exaggeration, farther) * high / wide / radius;
    const double growth = std::abs(farther - _exaggeration) * high / wide / radius / horizon;
    const double arch = 2.0 * std::abs(_horizonBend);
    const double fading = (endOfHeights - 1.0) * horizon;
    const double tallest =
        ground.heightsKnown ? std::max(std::abs(ground.maxHeight - base), std::abs(ground.minHeight - base))
                            : 0.0;
    const double globe = ground.ellipsoid ? globeCurvature / ground.ellipsoid->getRadiusPolar() : 0.0;

    // Around a cylinder heights get smaller, most at the base, and places turn about the eye's foot: most where the nearest
    // ground is drawn in full.
    const double ring = _horizontalAngle > 0.0 ? 2.0 * radius / _horizontalAngle : 0.0;
    const double around = ring > 0.0 ? 1.0 / ring : 0.0, turns = around / glsl::GEOFX_CYLINDER_FULL;
    const double side = std::max(1.0, turns * ring);

    // Derivatives of the picture's x and y along an edge, for each metre of it and of its square.
    const double x2 = across * (side * globe + 2.0 * turns * turns * ring);
    // Heights fade only where their scale no longer changes. Around a cylinder they shrink everywhere.
    const double bare1 = std::max(1.5 * lift / fading, 1.5 * growth);
    const double bare2 = std::max(6.0 * lift / (fading * fading), 6.0 * growth / horizon);
    const double lift1 = bare1 + lift * around;
    const double lift2 = bare2 + 2.0 * bare1 * around + 2.0 * lift * around * around;
    const double y1 = std::hypot(along, lift) + lift1 * tallest + arch * 1.5708 * across * side;
    const double y2 = along2 + (along + lift) * globe + along * turns + lift2 * tallest +
                      lift1 * (1.0 + tallest * turns) +
                      arch * (2.4675 * across * across * side * side + 1.5708 * x2);
    // In eye space, for each metre of distance: the picture's, the way through the depths, and that before the base.
    const double widthX = 1.0 / wide / (perspective ? 1.0 : nearest);
    const double widthY = 1.0 / high / (perspective ? 1.0 : nearest);
    double second = x2 * widthX + y2 * widthY +
                    (2.0 / nearest + globe + turns) / nearest * std::hypot(1.0, 1.0 / wide, 1.0 / high);
    if (perspective) second += 2.0 * (across * side / wide + y1 / high) / nearest;
    return std::sqrt(8.0 * tolerance / second);
}

} // namespace osgGeoFX
