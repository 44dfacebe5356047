// SPDX-License-Identifier: MIT
// SPDX-FileCopyrightText: 2026 the osgGeoFX authors
// The pages that a picture needs, by plain geometry.
#include <osgGeoFX/mapping/detail/PageCut.h>
#include <tools/RandomSamples.h>

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

using namespace geofx::test;
using namespace osgGeoFX;

namespace
{

/// Texels may be as large as a share of the distance from an eye above the plane. Something lies over a disc.
class PlainSight final : public PageSight
{
public:
    osg::Vec2d eye;
    double height = 100.0, share = 0.004, disc = 3000.0;
    double behind = -1e9; ///< nothing below this y is in sight

    static double away(const PlaneBox& box, const osg::Vec2d& from)
    {
        const osg::Vec2d nearest(std::clamp(from.x(), box.low.x(), box.high.x()),
                                 std::clamp(from.y(), box.low.y(), box.high.y()));
        return (nearest - from).length();
    }
    bool empty(const PlaneBox& box) override { return away(box, osg::Vec2d()) > disc; }
    bool shows(const SeenGround& ground) override { return ground.box.high.y() >= behind; }
    double texel(const SeenGround& ground) override
    {
        return share * std::hypot(away(ground.box, eye), height - ground.highest);
    }
};

std::vector<SeenGround> someGround(Random& random)
{
    std::vector<SeenGround> seen = {{{{-2000.0, -2000.0}, {2000.0, 2000.0}}, 0.0, 20.0}};
    for (int i = 0; i < 20; ++i)
    {
        const osg::Vec2d at(random.uniform(-1900.0, 1900.0), random.uniform(-1900.0, 1900.0));
        seen.push_back({{at, at + osg::Vec2d(30.0, 20.0)}, 0.0, random.uniform(20.0, 90.0)});
    }
    return seen;
}

bool isAbove(const MappingPage& above, const MappingPage& page)
{
    return above.level > page.level && page.above(above.level - page.level) == above;
}

} // namespace

TEST(PageCut, CoversWhatIsSeenWithPagesThatDoNotOverlap)
{
    Random random(11);
    PageCut cut;
    for (int round = 0; round < 10; ++round)
    {
        PlainSight sight;
        sight.eye.set(random.uniform(-1500.0, 1500.0), random.uniform(-1500.0, 1500.0));
        sight.behind = random.uniform(-2500.0, 0.0);
        const std::vector<SeenGround> seen = someGround(random);
        const auto pages = cut.make(seen, sight, 5000);
        ASSERT_TRUE(pages);
        for (const MappingPage& page : *pages)
        {
            EXPECT_FALSE(sight.empty(page.whole()));
            for (const MappingPage& other : *pages)
                EXPECT_FALSE(isAbove(page, other));
        }
        for (int i = 0; i < 300; ++i)
        {
            const SeenGround& ground = seen[static_cast<std::size_t>(random.integer(0, 20))];
            const osg::Vec2d place(random.uniform(ground.box.low.x(), ground.box.high.x()),
                                   random.uniform(ground.box.low.y(), ground.box.high.y()));
            const PlaneBox point{place, place};
            const auto found =
                std::find_if(pages->begin(), pages->end(),
                             [&](const MappingPage& page) { return page.square().contains(point); });
            if (place.y() < sight.behind || sight.empty(point)) continue;
            ASSERT_NE(found, pages->end());
            // Fine enough, and not finer than four times that.
            EXPECT_LE(found->texel(), sight.texel({point, 0.0, ground.highest}));
        }
    }
}

TEST(PageCut, DoesNotDependOnTheOrder)
{
    Random random(12);
    PageCut cut;
    PlainSight sight;
    std::vector<SeenGround> seen = someGround(random);
    const auto expected = cut.make(seen, sight, 5000);
    ASSERT_TRUE(expected);
    for (int round = 0; round < 10; ++round)
    {
        std::rotate(seen.begin(), seen.begin() + 1 + round, seen.end());
        EXPECT_EQ(*cut.make(seen, sight, 5000), *expected);
    }
}

TEST(PageCut, IsAsCoarseAsCanBe)
{
    PageCut cut;
    PlainSight sight;
    sight.height = 1000.0;
    const auto pages = cut.make({{{{-2000.0, -2000.0}, {2000.0, 2000.0}}, 0.0, 0.0}}, sight, 5000);
    ASSERT_TRUE(pages);
    // Pages of twice the size would have texels that are too large somewhere on the ground of their parent.
    for (const MappingPage& page : *pages)
        EXPECT_GT(page.parent().texel(), sight.texel({page.parent().square(), 0.0, 0.0}));
    // Texels of 4 m in the distance of 1000 m and more: pages of 512 m.
    EXPECT_EQ(
        std::count_if(pages->begin(), pages->end(), [](const MappingPage& page) { return page.level < 9; }),
        0);
    EXPECT_FALSE(cut.make({{{{-2000.0, -2000.0}, {2000.0, 2000.0}}, 0.0, 0.0}}, sight, 10));
    EXPECT_TRUE(cut.make({}, sight, 10)->empty());
}
