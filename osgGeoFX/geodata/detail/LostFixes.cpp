// SPDX-License-Identifier: MIT
// SPDX-FileCopyrightText: 2026 the osgGeoFX authors
#include <osgGeoFX/geodata/detail/LostFixes.h>

#include <algorithm>
#include <utility>
#include <vector>

namespace osgGeoFX
{

namespace
{

constexpr std::size_t longestRun = 10; ///< of lost fixes
constexpr double farFromZero = 1e5;    ///< metres
constexpr double leastJump = 5e3, medianSteps = 50.0;
constexpr double leastJumpAtEnds = 5e4, medianStepsAtEnds = 1000.0;
/// Of the jumps: what the way may have gone on meanwhile.
constexpr double mostProgress = 0.1;

double between(const osg::Vec3d& a, const osg::Vec3d& b)
{
    return RoutePath::distance({a.x(), a.y()}, {b.x(), b.y()});
}

bool isZero(const osg::Vec3d& place)
{
    return place.x() == 0.0 && place.y() == 0.0;
}

/// 0 if the way stands still.
double medianStep(const std::vector<osg::Vec3d>& places)
{
    std::vector<double> steps;
    for (std::size_t i = 1; i < places.size(); ++i)
        if (const double step = between(places[i - 1], places[i]); step > 0.0) steps.push_back(step);
    if (steps.empty()) return 0.0;
    const auto middle = steps.begin() + static_cast<std::ptrdiff_t>(steps.size() / 2);
    std::nth_element(steps.begin(), middle, steps.end());
    return *middle;
}

/// Lost fixes within a track have `true`.
std::vector<bool> jumps(const std::vector<osg::Vec3d>& places)
{
    const std::size_t count = places.size();
    std::vector<bool> lost(count);
    const double step = medianStep(places);
    const double far = std::max(leastJump, medianSteps * step);
    std::size_t before = 0;
    for (std::size_t i = 1; i + 1 < count; ++i)
    {
        if (between(places[before], places[i]) <= far)
        {
            before = i;
            continue;
        }
        std::size_t after = i + 1;
        const auto comesBack = [&]
        {
            const double jump =
                std::min(between(places[before], places[i]), between(places[after - 1], places[after]));
            return jump > far && between(places[before], places[after]) < mostProgress * jump;
        };
        while (after < count && after - i <= longestRun && !comesBack())
            ++after;
        if (after == count || after - i > longestRun)
        {
            before = i; // a gap in the track
            continue;
        }
        std::fill(lost.begin() + static_cast<std::ptrdiff_t>(i),
                  lost.begin() + static_cast<std::ptrdiff_t>(after), true);
        before = after;
        i = after;
    }
    return lost;
}

/// The same of its beginning and its end.
std::vector<bool> jumpsAtEnds(const std::vector<osg::Vec3d>& places)
{
    const std::size_t count = places.size();
    std::vector<bool> lost(count);
    const double farAtEnds = std::max(leastJumpAtEnds, medianStepsAtEnds * medianStep(places));
    for (std::size_t i = 1; i <= longestRun && 2 * i < count; ++i)
    {
        if (between(places[i - 1], places[i]) > farAtEnds)
            std::fill(lost.begin(), lost.begin() + static_cast<std::ptrdiff_t>(i), true);
        if (between(places[count - i - 1], places[count - i]) > farAtEnds)
            std::fill(lost.end() - static_cast<std::ptrdiff_t>(i), lost.end(), true);
    }
    return lost;
}

std::size_t keepOthers(const std::vector<bool>& lost, std::vector<osg::Vec3d>& places)
{
    const auto number = static_cast<std::size_t>(std::count(lost.begin(), lost.end(), true));
    if (number == 0 || places.size() - number < 2) return 0;
    std::vector<osg::Vec3d> kept;
    for (std::size_t i = 0; i < places.size(); ++i)
        if (!lost[i]) kept.push_back(places[i]);
    places = std::move(kept);
    return number;
}

} // namespace

std::size_t takeOutLostFixes(RoutePath& way)
{
    std::vector<osg::Vec3d>& places = way.places;
    if (places.size() < 3) return 0;
    std::vector<bool> lost(places.size());
    const bool farAway = std::all_of(
        places.begin(), places.end(),
        [](const osg::Vec3d& place) { return isZero(place) || between(place, osg::Vec3d()) >= farFromZero; });
    for (std::size_t i = 0; farAway && i < places.size(); ++i)
        lost[i] = isZero(places[i]);
    std::size_t number = keepOthers(lost, places);
    if (way.wayPoints) return number;
    for (const auto& find : {&jumps, &jumpsAtEnds})
        if (places.size() > 2) number += keepOthers(find(places), places);
    return number;
}

} // namespace osgGeoFX
