// SPDX-License-Identifier: MIT
// SPDX-FileCopyrightText: 2026 the osgGeoFX authors
#pragma once

#include <osgGeoFX/town/detail/Building.h>

#include <osg/Vec2d>
#include <osg/Vec3d>

#include <cstdint>
#include <limits>
#include <unordered_map>
#include <vector>

namespace osgGeoFX
{

/** How open places on walls and roofs are to their surroundings (ambient obscurance, after Zhukov et al. 1998).

    Of all directions above a surface, weighted by the cosine to its normal, those count in full that leave the town. Where a
    building is in the way, a direction counts by the building's distance, from 0 at hand to 1 at `reach`. So does the ground,
    from 0 to 1 at `groundReach`: it is near the foot of a wall only. A lone wall is half open at its foot, and fully from
    `groundReach` on.

    Buildings are prisms, the ground is level below each place. For a vertical half plane, the share is worked out exactly
    from the skyline; half planes are `azimuths` of equal angles. First add() all; then any threads may ask. */
class Openness
{
public:
    static constexpr double reach = 40.0, groundReach = 6.0; ///< metres
    static constexpr int azimuths = 24;
    /// What a place that is wholly shut in loses of its color. The sun's light is darkened, too, so it is less than all.
    static constexpr double darkening = 0.6;
    /// No building.
    static constexpr std::size_t none = std::numeric_limits<std::size_t>::max();

    /// Adds a building in the frame of all places (PlacedBuilding). Returns its number.
    std::size_t add(const PlacedBuilding& building);

    /// Asks for some heights of one vertical, 0 (shut in) to 1 (open) for each. `ground`: the height of the ground below. `except`: a building that is
    /// not in the way.
    void at(const osg::Vec2d& place, const osg::Vec3d& normal, double ground, const double* heights,
            double* results, std::size_t count, std::size_t except = none) const;

private:
    struct Prism
    {
        osg::Vec2d low, high;
        double top;
        std::vector<Ring> rings;
    };
    std::vector<Prism> _prisms;
    std::unordered_map<std::uint64_t, std::vector<std::uint32_t>> _cells;
};

} // namespace osgGeoFX
