// SPDX-License-Identifier: MIT
// SPDX-FileCopyrightText: 2026 the osgGeoFX authors
#pragma once

#include <osgGeoFX/panorama/PanoramaComposer.h>
#include <osgGeoFX/panorama/detail/PanoramaProfile.h>

#include <osg/Math>

#include <algorithm>
#include <cmath>

namespace osgGeoFX
{

/// The tip of the highest summit: so much of the sky lies below it. The title says "the sky's lower half".
constexpr double tipInSky = 0.42;
/// The ground before the picture's base that may rise into it, in view radii.
constexpr double beforeBase = 1.0;
/// The same in a cylindrical map, of the way from the base to the eye's foot.
constexpr double leastWay = 0.7;

/// Eq. 1 and the curve of a composition, for x in view radii and s in metres (shaders/lib/panorama.glsl).
struct PictureCurve
{
    PictureCurve(const PanoramaComposition& composition, double aspect)
        : radius(composition.viewRadius),
          ring(composition.horizontalAngle > 0.0 ? 2.0 * radius / composition.horizontalAngle : 0.0),
          before(ring > 0.0 ? std::min(leastWay * ring, radius) : beforeBase * radius),
          curve(composition.curveDistance * radius), horizon(composition.horizonDistance * radius),
          end(endOfHeights * horizon), along(4.0 * composition.horizonLine / (curve + horizon)),
          lift(aspect / radius), arch(2.0 * composition.horizonBend), base(composition.baseHeight),
          near(composition.exaggeration), far(composition.horizonExaggeration),
          profile(profileThrough(composition.curvePoints))
    {
        if (profile.first > 0.0) along = 2.0 * composition.horizonLine / horizon;
    }

    /// What the curve makes of a distance, for the many places at it.
    struct Reach
    {
        double climbed;      ///< twice the y of ground at the base height in the picture's middle
        double share;        ///< of the horizon's own exaggeration
        double exaggeration; ///< there
        double lift, shown;  ///< of a height
    };
    Reach at(double s) const { return {climbed(s), share(s), exaggeration(s), lift * width(s), shown(s)}; }

    /// The picture's y, 0…1 from its base, of ground at the base height.
    double foot(double x, double s) const { return 0.5 * (climbed(s) - dip(x)); }
    double foot(double dip, const Reach& there) const { return 0.5 * (there.climbed - dip); }
    /// Twice what horizontals lie lower at x than in the middle.
    double dip(double x) const { return arch * (1.0 - std::cos(x * osg::PI_2)); }
    /// The share of the horizon's own exaggeration at a distance.
    double share(double s) const { return far < 0.0 ? 0.0 : glsl::geofx_profileLift(0.0, 1.0, s / horizon); }
    /// The exaggeration at a distance.
    double exaggeration(double s) const { return near * (1.0 - share(s)) + far * share(s); }
    /// How much a height raises it.
    double lifted(double height, double s) const { return lifted(height, at(s)); }
    double lifted(double height, const Reach& there) const
    {
        return there.exaggeration * raised(height, there);
    }
    /// How much a height raises it, for an exaggeration of 1.
    double raised(double height, double s) const { return raised(height, at(s)); }
    double raised(double height, const Reach& there) const
    {
        return 0.5 * there.lift * (height - base) * there.shown;
    }
    /// How much wider than at the base a column is at a distance s.
    double widening(double s) const { return ring > 0.0 ? std::max(ring + s, 0.0) / ring : 1.0; }

    double climbed(double s) const
    {
        const double width = std::max(horizon - curve, 1e-3);
        const double bent = std::clamp(s - curve, 0.0, width);
        double rise = std::min(s, curve) + bent - bent * bent / (2.0 * width);
        if (profile.first > 0.0) rise = horizon * glsl::geofx_profileRise(profile, s / horizon);
        return along * rise;
    }
    /// Heights get smaller with the distance as widths do.
    double width(double s) const { return ring > 0.0 ? ring / (ring + std::max(s, 0.0)) : 1.0; }
    /// Beyond the horizon they go down to nothing.
    double shown(double s) const
    {
        const double t = std::clamp(1.0 - (s - horizon) / std::max(end - horizon, 1e-3), 0.0, 1.0);
        return t * t * (3.0 - 2.0 * t);
    }

    double radius, ring, before, curve, horizon, end, along, lift, arch, base, near, far;
    glsl::geofx_Profile profile;
};

/// Places around the picture's base, up to the second order of the distance over the Earth's radius.
class PicturePlace
{
public:
    PicturePlace(const TerrainRelief& relief, const PanoramaComposition& view)
        : _place(view.place), _unit(relief.metre(view.place.y())), _sine(std::sin(view.heading)),
          _cosine(std::cos(view.heading)),
          _turn(relief.geocentric ? std::tan(osg::DegreesToRadians(std::clamp(view.place.y(), -89.0, 89.0))) /
                                        osg::WGS_84_RADIUS_EQUATOR
                                  : 0.0),
          _ring(view.horizontalAngle > 0.0 ? 2.0 * view.viewRadius / view.horizontalAngle : 0.0)
    {
    }

    /// From x to the right and s up in the picture, metres, to the relief's units.
    osg::Vec2d at(double x, double s) const
    {
        if (_ring > 0.0)
        {
            const double away = std::max(_ring + s, 0.0), azimuth = x / _ring;
            x = away * std::sin(azimuth);
            s = away * std::cos(azimuth);
        }
        const double east = x * _cosine + s * _sine, north = s * _cosine - x * _sine;
        return {_place.x() + east * (1.0 + north * _turn) * _unit.x(),
                _place.y() + (north - 0.5 * east * east * _turn) * _unit.y()};
    }
    /// The inverse.
    osg::Vec2d of(const osg::Vec2d& place) const
    {
        double east = (place.x() - _place.x()) / _unit.x(), north = (place.y() - _place.y()) / _unit.y();
        const double first = east;
        for (int i = 0; i < 4; ++i)
        {
            east = first / (1.0 + north * _turn);
            north = (place.y() - _place.y()) / _unit.y() + 0.5 * east * east * _turn;
        }
        const osg::Vec2d ground(east * _cosine - north * _sine, east * _sine + north * _cosine);
        if (!(_ring > 0.0)) return ground;
        return {_ring * std::atan2(ground.x(), ground.y()), ground.length() - _ring};
    }

private:
    osg::Vec2d _place, _unit;
    double _sine, _cosine, _turn, _ring;
};

} // namespace osgGeoFX
