// SPDX-License-Identifier: MIT
// SPDX-FileCopyrightText: 2026 the osgGeoFX authors
#include <osgGeoFX/terrain/detail/TileHorizon.h>

#include <osgGeoFX/effect/detail/InnerSphere.h>

#include <GeographicLib/Constants.hpp>

#include <osg/Math>

#include <algorithm>
#include <cmath>
#include <utility>

namespace osgGeoFX
{

namespace
{

/// Radians. Larger tiles are in sight from almost everywhere.
constexpr double LARGEST_ANGLE = 1.4;

} // namespace

osg::ref_ptr<osg::ClusterCullingCallback> createHorizonCulling(const TilingScheme& scheme, const TileKey& key,
                                                               double maxHeight)
{
    const TileFrame frame(scheme, key);
    const osg::Matrixd toWorld = frame.localToWorld();
    osg::Vec3d middle = toWorld.getTrans();
    middle.normalize();

    // From the Earth's center, between the tile's middle and its farthest point, which is on its border.
    constexpr int points = 32;
    const double width = static_cast<double>(scheme.intervals) * scheme.step(key.level);
    double radius = 0.0;
    const auto include = [&](osg::Vec3d place)
    {
        place.normalize();
        radius = std::max(radius, std::acos(std::clamp(place * middle, -1.0, 1.0)));
    };
    for (int i = 0; i <= points; ++i)
        for (const auto& [x, y] :
             {std::pair(i, 0), std::pair(i, points), std::pair(0, i), std::pair(points, i)})
        {
            const osg::Vec3d place =
                frame.position(scheme.gridX(scheme.firstColumn(key) + width * x / points),
                               scheme.gridY(scheme.firstRow(key) + width * y / points), 0.0) *
                toWorld;
            include(place);
        }
    // The caps at the poles.
    if (scheme.endsAt(key, 0)) include({0.0, 0.0, -1.0});
    if (scheme.endsAt(key, 2)) include({0.0, 0.0, 1.0});

    const double a = GeographicLib::Constants::WGS84_a();
    const double inner = INNER_SHARE * a * (1.0 - GeographicLib::Constants::WGS84_f());
    const double highest = a + std::max(maxHeight, 0.0);
    // The lines of sight that graze the sphere and end at the tile's border graze it at this angle from the middle.
    const double angle = radius + std::acos(inner / highest);
    if (angle > LARGEST_ANGLE) return nullptr;
    // They form a cone. Its tip is above the tile, where eyes are, too: those within the circle of touch.
    return new osg::ClusterCullingCallback(osg::Vec3(middle * (inner / std::cos(angle))), osg::Vec3(middle),
                                           static_cast<float>(-std::sin(angle)),
                                           static_cast<float>(inner * std::tan(angle)));
}

} // namespace osgGeoFX
