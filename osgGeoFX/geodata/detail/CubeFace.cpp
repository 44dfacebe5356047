// SPDX-License-Identifier: MIT
// SPDX-FileCopyrightText: 2026 the osgGeoFX authors
#include <osgGeoFX/geodata/detail/CubeFace.h>

#include <osg/CoordinateSystemNode>
#include <osg/Math>

#include <algorithm>
#include <cmath>
#include <limits>

namespace osgGeoFX
{

std::array<LocalOrigin, 6> CubeFace::origins()
{
    return {LocalOrigin::onGlobe(0.0, 0.0),       LocalOrigin::onGlobe(osg::PI_2, 0.0),
            LocalOrigin::onGlobe(osg::PI, 0.0),   LocalOrigin::onGlobe(-osg::PI_2, 0.0),
            LocalOrigin::onGlobe(0.0, osg::PI_2), LocalOrigin::onGlobe(0.0, -osg::PI_2)};
}

bool CubeFace::isOrigin(const LocalOrigin& origin)
{
    const std::array<LocalOrigin, 6> all = origins();
    return std::any_of(all.begin(), all.end(),
                       [&](const LocalOrigin& each)
                       { return each.longitude == origin.longitude && each.latitude == origin.latitude; });
}

bool CubeFace::mayHave(const LocalOrigin& origin, const osg::BoundingSphered& ground)
{
    if (!ground.valid()) return true;
    const auto upOf = [](const LocalOrigin& face)
    {
        const double level = std::cos(face.latitude);
        return osg::Vec3d(level * std::cos(face.longitude), level * std::sin(face.longitude),
                          std::sin(face.latitude));
    };
    const osg::Vec3d up = upOf(origin);
    constexpr double border = 1e5; // the ellipsoid's faces are not quite those of a sphere
    for (const LocalOrigin& other : origins())
    {
        osg::Vec3d across = up - upOf(other);
        // Planes part it from its four neighbors.
        if (std::abs(across.length2() - 2.0) > 1e-6) continue;
        across.normalize();
        if (across * ground.center() < -ground.radius() - border) return false;
    }
    return true;
}

MappingRaster::Window CubeFace::window(double texel)
{
    // A face's edges bulge in its frame: their middles are at 45° of arc, its corners at 54.7°, and neither is farther than sin 45°
    // along one of the axes.
    const double face = osg::WGS_84_RADIUS_EQUATOR * std::sin(osg::PI_4);
    // The texels of a coarse raster may be so large that a border of four would lead beyond the globe.
    const double half = face + std::min(4.0 * texel, face / 8.0);
    return {osg::Vec2d(-half, -half), osg::Vec2d(half, half), texel};
}

bool CubeFace::cut(osg::Image& image, const MappingRaster::Window& window, bool polar)
{
    const double equator = osg::WGS_84_RADIUS_EQUATOR, pole = osg::WGS_84_RADIUS_POLAR;
    const osg::Vec2d texel((window.high.x() - window.low.x()) / image.s(),
                           (window.high.y() - window.low.y()) / image.t());
    // Across an edge, one coordinate grows as fast as the other shrinks: two texels on the ground.
    const double border = 4.0 * std::max(texel.x(), texel.y());
    const bool isColor = image.getDataType() == GL_UNSIGNED_BYTE;
    bool any = false;
    for (int row = 0; row < image.t(); ++row)
    {
        for (int column = 0; column < image.s(); ++column)
        {
            const double x = window.low.x() + (column + 0.5) * texel.x();
            const double y = window.low.y() + (row + 0.5) * texel.y();
            // The third coordinate from the Earth's center, on the ellipsoid.
            const double upward = polar ? equator : pole;
            const double rest = 1.0 - x * x / (equator * equator) - y * y / (upward * upward);
            const double outward = (polar ? pole : equator) * std::sqrt(std::max(rest, 0.0));
            const bool isOwn = outward + border >= std::max(std::abs(x), std::abs(y));
            unsigned char* const data =
                image.data(static_cast<unsigned int>(column), static_cast<unsigned int>(row));
            if (isColor)
            {
                // The color stays, for a filter mixes it with the neighbors'.
                if (!isOwn) data[3] = 0;
                any = any || data[3] != 0;
            }
            else
            {
                auto& value = *reinterpret_cast<float*>(data);
                if (!isOwn) value = std::numeric_limits<float>::quiet_NaN();
                any = any || !std::isnan(value);
            }
        }
    }
    return any;
}

} // namespace osgGeoFX
