// SPDX-License-Identifier: MIT
// SPDX-FileCopyrightText: 2026 the osgGeoFX authors
#pragma once

#include <osgGeoFX/town/detail/BuildingMesh.h>

#include <cmath>
#include <utility>
#include <vector>

namespace geofx::test
{

/// A building with its foot at `base`, all heights in metres.
inline osgGeoFX::PlacedBuilding building(std::vector<osgGeoFX::Ring> rings, double base, double height)
{
    osgGeoFX::PlacedBuilding result;
    const osg::Vec2d middle = osgGeoFX::ringMiddle(rings.front());
    result.reference.set(middle.x(), middle.y(), base);
    result.foot = base;
    result.top = base + height;
    result.rings = std::move(rings);
    return result;
}

/// A rectangle, counter-clockwise. `angle`: of its width from the x axis, radians.
inline osgGeoFX::Ring box(const osg::Vec2d& middle, double width, double depth, double angle = 0.0)
{
    const osg::Vec2d along(std::cos(angle), std::sin(angle)), across(-along.y(), along.x());
    const osg::Vec2d a = along * (0.5 * width), b = across * (0.5 * depth);
    return {middle - a - b, middle + a - b, middle + a + b, middle - a + b};
}

} // namespace geofx::test
