// SPDX-License-Identifier: MIT
// SPDX-FileCopyrightText: 2026 the osgGeoFX authors
#pragma once

#include <tools/DatabaseReader.h>

#include <gtest/gtest.h>
#include <osg/TexMat>

#include <algorithm>
#include <array>
#include <map>
#include <string>
#include <vector>

namespace geofx::test
{

/// Calls for each texel of a level: its place in the grid's CRS, its tile, column and row.
template<typename Visit>
void forEachTexel(const std::string& folder, int level, unsigned int unit, const Visit& visit)
{
    const FinestLevel finest(folder);
    const int last = DatabaseRoot(folder).finestLevel();
    int texels = 0;
    readDatabase(folder,
                 [&](const DatabaseTile& tile)
                 {
                     if (tile.level != level || !tile.geometry) return;
                     const osg::Image* image = tile.image(unit);
                     ASSERT_NE(image, nullptr) << tile.transform->getName();
                     const int span = finest.tileIntervals << (last - level);
                     for (int row = 0; row < image->t(); ++row)
                         for (int column = 0; column < image->s(); ++column)
                         {
                             // Counted in finest posts; beyond the ground's end is its end.
                             const double c = (tile.x + column / (image->s() - 1.0)) * span;
                             const double r = (tile.y + row / (image->t() - 1.0)) * span;
                             if (c > finest.columns - 1 || r > finest.rows - 1) continue;
                             visit(finest.x0 + c * finest.dx, finest.y0 + r * finest.dy, *image, column, row);
                             ++texels;
                         }
                 });
    EXPECT_GT(texels, 0);
}

/// On each level the texels along the edges that tiles share are equal, and so are texture coordinates there.
inline void expectNoSeams(const std::string& folder, unsigned int unit)
{
    std::map<std::array<int, 3>, std::vector<int>> shared; // level and place, counted in texels
    int compared = 0;
    readDatabase(
        folder,
        [&](const DatabaseTile& tile)
        {
            const osg::Image* image = tile.image(unit);
            ASSERT_NE(image, nullptr);
            const int m = image->s() - 1;
            ASSERT_EQ(image->t() - 1, m);
            for (int k = 0; k <= m; ++k)
                for (const auto& [column, row] :
                     {std::pair(k, 0), std::pair(k, m), std::pair(0, k), std::pair(m, k)})
                {
                    const unsigned char* bytes =
                        image->data(static_cast<unsigned>(column), static_cast<unsigned>(row));
                    const std::vector<int> color(bytes, bytes + image->getPixelSizeInBits() / 8);
                    const auto [place, fresh] = shared.emplace(
                        std::array<int, 3>{tile.level, tile.x * m + column, tile.y * m + row}, color);
                    if (fresh) continue;
                    ++compared;
                    ASSERT_EQ(place->second, color)
                        << tile.transform->getName() << ", texel " << column << " " << row;
                }
            // Texel centers lie on the tile's edges.
            float low = 1.0f, high = 0.0f;
            // The unit's coordinates are those of the colors, or follow from them by a matrix.
            const auto* matrix = dynamic_cast<const osg::TexMat*>(
                tile.geometry->getStateSet()->getTextureAttribute(unit, osg::StateAttribute::TEXMAT));
            for (const osg::Vec2& color : tile.places)
            {
                const osg::Vec3d place(color, 0.0);
                const osg::Vec2 t(
                    matrix ? osg::Vec2d((place * matrix->getMatrix()).x(), (place * matrix->getMatrix()).y())
                           : osg::Vec2d(color));
                low = std::min({low, t.x(), t.y()});
                high = std::max({high, t.x(), t.y()});
            }
            EXPECT_NEAR(low * static_cast<float>(m + 1), 0.5f, 1e-4f);
            EXPECT_LE(high * static_cast<float>(m + 1), static_cast<float>(m) * 1.00001f + 0.5f);
        });
    EXPECT_GT(compared, 1000);
}

} // namespace geofx::test
