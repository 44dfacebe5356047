// SPDX-License-Identifier: MIT
// SPDX-FileCopyrightText: 2026 the osgGeoFX authors
#include <osgGeoFX/paging/TilePosts.h>

#include <osgGeoFX/paging/TerrainInfo.h>

#include <osg/Geometry>
#include <osg/Texture>
#include <osg/ValueObject>
#include <osg/Vec2i>

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>

namespace osgGeoFX
{

TilePosts::TilePosts(int cells)
    : _cells(cells), _places(static_cast<std::size_t>(cells + 1) * static_cast<std::size_t>(cells + 1))
{
    constexpr double nowhere = std::numeric_limits<double>::quiet_NaN();
    std::fill(_places.begin(), _places.end(), osg::Vec3d(nowhere, nowhere, nowhere));
}

std::optional<TilePosts> TilePosts::read(const osg::Transform& tile)
{
    const std::optional<TileInfo> info = TileInfo::read(tile);
    const osg::ref_ptr<osg::Geometry> ground = info && info->cells > 0 ? TileInfo::ground(tile) : nullptr;
    if (!ground || !ground->getStateSet() || ground->getNumPrimitiveSets() == 0) return std::nullopt;
    const auto* vertices = dynamic_cast<const osg::Vec3Array*>(ground->getVertexArray());
    const auto* coordinates = dynamic_cast<const osg::Vec2Array*>(ground->getTexCoordArray(0));
    const auto* texture = dynamic_cast<const osg::Texture*>(
        ground->getStateSet()->getTextureAttribute(0, osg::StateAttribute::TEXTURE));
    const osg::Image* image = texture ? texture->getImage(0) : nullptr;
    if (!vertices || !coordinates || coordinates->size() != vertices->size() || !image) return std::nullopt;

    // The middles of texels lie on the tile's border. A compressed texture has more texels beyond it.
    const int size = image->s();
    int texels = size - 1;
    tile.getUserValue("geofx.texels", texels);
    const auto post = [&](float coordinate)
    {
        const double share = (static_cast<double>(coordinate) * size - 0.5) / texels;
        return std::clamp(static_cast<int>(std::lround(share * info->cells)), 0, info->cells);
    };
    TilePosts result(info->cells);
    const osg::PrimitiveSet& triangles = *ground->getPrimitiveSet(0);
    for (unsigned int i = 0; i + 2 < triangles.getNumIndices(); i += 3)
    {
        std::array<osg::Vec2i, 3> at;
        std::array<osg::Vec3d, 3> corner;
        for (unsigned int k = 0; k < 3; ++k)
        {
            const osg::Vec2& place = (*coordinates)[triangles.index(i + k)];
            at[k].set(post(place.x()), post(place.y()));
            corner[k] = (*vertices)[triangles.index(i + k)];
        }
        const osg::Vec2i u = at[1] - at[0], v = at[2] - at[0];
        const int area = u.x() * v.y() - u.y() * v.x();
        if (area == 0) continue;
        const auto [west, east] = std::minmax({at[0].x(), at[1].x(), at[2].x()});
        const auto [south, north] = std::minmax({at[0].y(), at[1].y(), at[2].y()});
        for (int row = south; row <= north; ++row)
            for (int column = west; column <= east; ++column)
            {
                const osg::Vec2i p = osg::Vec2i(column, row) - at[0];
                const double s = static_cast<double>(p.x() * v.y() - p.y() * v.x()) / area;
                const double t = static_cast<double>(u.x() * p.y() - u.y() * p.x()) / area;
                if (s < 0.0 || t < 0.0 || s + t > 1.0) continue;
                result._places[result.index(column, row)] =
                    corner[0] * (1.0 - s - t) + corner[1] * s + corner[2] * t;
            }
    }
    return result;
}

} // namespace osgGeoFX
