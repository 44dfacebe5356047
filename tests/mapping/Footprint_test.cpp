// SPDX-License-Identifier: MIT
// SPDX-FileCopyrightText: 2026 the osgGeoFX authors
// Footprints against squares, compared with a raster of places.
#include "MappingModel.h"

#include <osgGeoFX/mapping/detail/MappingIndex.h>

#include <gtest/gtest.h>

using namespace geofx::test;
using osgGeoFX::FootprintShape;
using osgGeoFX::PlaneSquare;

TEST(Footprint, overlapsAndCoversSquares)
{
    Random random(41);
    int covered = 0;
    int apart = 0;
    for (int i = 0; i < geofx::test::sampleCount(); ++i)
    {
        const PlaneFootprint footprint = randomFootprint(random, 500.0, 2e4);
        const FootprintShape shape(footprint);
        const PlaneSquare square = {{random.uniform(-5e3, 5e3), random.uniform(-5e3, 5e3)},
                                    random.logarithmic(10, 1e4)};
        const bool overlaps = shape.overlaps(square, 1e-6);
        const bool covers = shape.covers(square, 1e-6);
        ASSERT_TRUE(overlaps || !covers);
        int inside = 0;
        for (int j = 0; j < 100; ++j)
        {
            const Vec2d place = square.origin + gridPlace(j) * (square.size / 9);
            inside += contains(footprint, place);
        }
        ASSERT_TRUE(overlaps || inside == 0) << "sample " << i;
        ASSERT_TRUE(!covers || inside == 100) << "sample " << i;
        // A corner of a convex footprint that is outside is enough not to be covered, and the converse.
        ASSERT_TRUE(inside < 100 || shape.covers(square, -1e-6)) << "sample " << i;
        covered += covers;
        apart += !overlaps;
    }
    EXPECT_GT(covered, 10);
    EXPECT_GT(apart, 100);
    // Apart by a slanted edge only: the boxes around them overlap.
    const FootprintShape slanted(turnedRectangle({0, 0}, 100, 100, 3.14159265358979 / 4));
    EXPECT_FALSE(slanted.overlaps({{40, 40}, 20}, 1e-6));
    EXPECT_TRUE(slanted.overlaps({{30, 30}, 20}, 1e-6));
}
