// SPDX-License-Identifier: MIT
// SPDX-FileCopyrightText: 2026 the osgGeoFX authors
#include <osgGeoFX/panorama/detail/PanoramaProfile.h>

#include <osgGeoFX/effect/detail/EyeVector.h>

#include <algorithm>
#include <cmath>
#include <iterator>

namespace osgGeoFX
{

namespace
{

const glm::dvec3 horizonKnot(1.0, 1.0, 0.0);
/// The slope at the base, of the way to the first point, at least: ground before the base must leave the picture.
constexpr double leastFirst = 0.25;

/// Steffen's slope at a point between two parts of the curve, with these widths and mean slopes.
double slopeBetween(double widthBefore, double before, double widthAfter, double after)
{
    const double parabola = (before * widthAfter + after * widthBefore) / (widthBefore + widthAfter);
    return std::min({2.0 * before, 2.0 * after, parabola});
}

} // namespace

glsl::geofx_Profile profileThrough(const std::vector<osg::Vec2d>& points)
{
    glsl::geofx_Profile profile{};
    std::vector<glm::dvec3> knots = {glm::dvec3(0.0)};
    for (const osg::Vec2d& point : points)
        knots.emplace_back(point.x(), point.y(), 0.0);
    knots.push_back(horizonKnot);
    if (!points.empty())
    {
        const auto width = [&](std::size_t part)
        {
            return knots[part + 1].x - knots[part].x;
        };
        const auto mean = [&](std::size_t part)
        {
            return (knots[part + 1].y - knots[part].y) / width(part);
        };
        for (std::size_t i = 1; i + 1 < knots.size(); ++i)
            knots[i].z = slopeBetween(width(i - 1), mean(i - 1), width(i), mean(i));
        const double straight = mean(0) + (mean(0) - mean(1)) * width(0) / (width(0) + width(1));
        profile.first = std::clamp(straight, leastFirst * mean(0), 2.0 * mean(0));
    }
    glm::dvec3* const all[] = {&profile.knot1, &profile.knot2, &profile.knot3,
                               &profile.knot4, &profile.knot5, &profile.knot6};
    for (std::size_t i = 0; i < std::size(all); ++i)
        *all[i] = i < points.size() ? knots[i + 1] : horizonKnot;
    return profile;
}

std::array<osg::Vec3d, 6> knotsOf(const glsl::geofx_Profile& profile)
{
    return {toOsg(profile.knot1), toOsg(profile.knot2), toOsg(profile.knot3),
            toOsg(profile.knot4), toOsg(profile.knot5), toOsg(profile.knot6)};
}

ProfileRates ratesOf(const glsl::geofx_Profile& profile, double from, double to)
{
    ProfileRates rates;
    if (from < 0.0) rates.slope = profile.first;
    glm::dvec3 before(0.0, 0.0, profile.first);
    for (const glm::dvec3& after : {profile.knot1, profile.knot2, profile.knot3, profile.knot4, profile.knot5,
                                    profile.knot6, horizonKnot})
    {
        if (after.x > before.x && from < after.x && to > before.x)
        {
            const glsl::geofx_ProfilePart part = glsl::geofx_profileBetween(before, after);
            const double low = std::max(from - part.begin, 0.0) / part.width;
            const double high = std::min((to - part.begin) / part.width, 1.0);
            // The slope is a parabola, which may have its summit between.
            const double turns = std::abs(part.third) > 0.0 ? -part.second / (3.0 * part.third) : low;
            for (const double t : {low, high, std::clamp(turns, low, high)})
            {
                const double slope = part.slope + t * (2.0 * part.second + 3.0 * t * part.third);
                const double second = 2.0 * part.second + 6.0 * t * part.third;
                rates.slope = std::max(rates.slope, slope / part.width);
                rates.second = std::max(rates.second, std::abs(second) / (part.width * part.width));
            }
        }
        before = after;
    }
    return rates;
}

} // namespace osgGeoFX
