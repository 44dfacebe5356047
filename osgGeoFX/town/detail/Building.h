// SPDX-License-Identifier: MIT
// SPDX-FileCopyrightText: 2026 the osgGeoFX authors
#pragma once

#include <osg/Vec2d>
#include <osg/Vec3d>

#include <cstdint>
#include <vector>

namespace osgGeoFX
{

/// A closed line without its last point. The solid lies on its left.
using Ring = std::vector<osg::Vec2d>;

/// What a building looks as if it were used for.
enum class BuildingUse : std::uint8_t
{
    HOUSE,
    FLATS,
    OFFICE,
    HALL,
    TOWER
};
constexpr int BUILDING_USES = 5;

/// A building as the source has it, in coordinates of the terrain's grid (degrees, or metres of a projection).
struct Building
{
    std::vector<Ring> rings; ///< the outline, counter-clockwise, then courtyards, clockwise
    double height = 0.0;     ///< from the ground to the highest point of the roof, metres
    double bottom = 0.0;     ///< from the ground to the underside, metres; 0 for what stands on it
    BuildingUse use = BuildingUse::HOUSE;
    bool gabled = false;
    /// What the summary counts.
    enum Note : std::uint8_t
    {
        GABLED = 1,
        BY_STOREYS = 2,
        BY_AREA = 4,
        BAD_HEIGHT = 8,
        REPAIRED = 16
    };
    std::uint8_t notes = 0;
};

/// A building where it stands, metres, in a local frame: x east, y north, z up.
struct PlacedBuilding
{
    std::vector<Ring> rings;
    osg::Vec3d reference; ///< in the middle of the outline, on the ground
    double foot = 0.0; ///< the lowest ground below the outline, or the underside of what does not stand on it
    bool raised = false; ///< whether it is a part above the ground, which has a floor
    double top = 0.0;    ///< the highest point of the roof
    double area = 0.0;   ///< square metres
    BuildingUse use = BuildingUse::HOUSE;
    bool gabled = false;
    std::uint32_t seed = 0; ///< for what differs from building to building
};

/// The area to the left of a ring: negative for a clockwise one.
inline double ringArea(const Ring& ring)
{
    double twice = 0.0;
    for (std::size_t i = 0; i < ring.size(); ++i)
    {
        const osg::Vec2d &a = ring[i], &b = ring[(i + 1) % ring.size()];
        // About the first point, so that large coordinates cost no digits.
        twice +=
            (a.x() - ring[0].x()) * (b.y() - ring[0].y()) - (b.x() - ring[0].x()) * (a.y() - ring[0].y());
    }
    return 0.5 * twice;
}

/// The center of gravity of a ring's area; the mean of its points if it has none.
inline osg::Vec2d ringMiddle(const Ring& ring)
{
    osg::Vec2d sum, mean;
    double twice = 0.0;
    for (std::size_t i = 0; i < ring.size(); ++i)
    {
        const osg::Vec2d a = ring[i] - ring[0], b = ring[(i + 1) % ring.size()] - ring[0];
        const double part = a.x() * b.y() - b.x() * a.y();
        sum += (a + b) * part;
        twice += part;
        mean += a / static_cast<double>(ring.size());
    }
    return ring[0] + (twice != 0.0 ? sum / (3.0 * twice) : mean);
}

/// Whether a place lies within rings: an outline and its courtyards, by the even-odd rule.
inline bool isWithin(const std::vector<Ring>& rings, const osg::Vec2d& place)
{
    bool inside = false;
    for (const Ring& ring : rings)
        for (std::size_t i = 0, j = ring.size() - 1; i < ring.size(); j = i++)
        {
            const osg::Vec2d &a = ring[i], &b = ring[j];
            if ((a.y() > place.y()) != (b.y() > place.y()) &&
                place.x() < (b.x() - a.x()) * (place.y() - a.y()) / (b.y() - a.y()) + a.x())
                inside = !inside;
        }
    return inside;
}

} // namespace osgGeoFX
