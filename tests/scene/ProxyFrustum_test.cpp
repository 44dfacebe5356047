// SPDX-License-Identifier: MIT
// SPDX-FileCopyrightText: 2026 the osgGeoFX authors
//
// The blocks of ground from which a proxy frustum is made, and proxies of scenes of any size.
#include <osgGeoFX/scene/detail/GroundShell.h>
#include <osgGeoFX/scene/detail/ProxyFrustum.h>
#include <tools/RandomSamples.h>

#include <gtest/gtest.h>
#include <osg/CoordinateSystemNode>
#include <osg/Math>

#include <algorithm>
#include <cmath>

using namespace osgGeoFX;
using namespace geofx::test;

namespace
{

Ground earth(double lowest, double highest)
{
    Ground ground;
    ground.ellipsoid = new osg::EllipsoidModel;
    ground.minHeight = lowest;
    ground.maxHeight = highest;
    ground.heightsKnown = true;
    return ground;
}

/// By how much a point lies outside of a box with orthogonal axes, metres.
double outside(const EyeBox& box, const osg::Vec3d& point)
{
    double most = 0.0;
    for (const osg::Vec3d& half : box.half)
        most = std::max(most, std::abs((point - box.center) * half) / half.length() - half.length());
    return most;
}

} // namespace

TEST(GroundShell, BoxesHoldTheGroundOfTheirBlocks)
{
    const Ground ground = earth(-11000.0, 9000.0);
    const GroundShell shell(osg::BoundingSphere(osg::Vec3(), 6.4e6f), ground);
    Random random(21);
    for (int i = 0; i < sampleCount(); ++i)
    {
        // A block that halving leads to.
        const std::vector<GroundShell::Block> all = shell.blocks();
        GroundShell::Block block =
            all[static_cast<std::size_t>(random.integer(0, static_cast<int>(all.size()) - 1))];
        for (int halvings = random.integer(0, 40); halvings > 0; --halvings)
        {
            const auto [first, second] = shell.halvesOf(block);
            block = random.integer(0, 1) ? first : second;
        }
        const std::optional<EyeBox> box = shell.boxOf(block);
        ASSERT_TRUE(box);
        for (int j = 0; j < 5; ++j)
        {
            osg::Vec3d at;
            for (int axis = 0; axis < 3; ++axis)
            {
                const double share = random.integer(0, 2) ? random.uniform(0.0, 1.0) : random.integer(0, 1);
                at[axis] = block.low[axis] + (block.high - block.low)[axis] * share;
            }
            osg::Vec3d place;
            ground.ellipsoid->convertLatLongHeightToXYZ(at.y(), at.x(), at.z(), place.x(), place.y(),
                                                        place.z());
            EXPECT_LE(outside(*box, place), 1e-6)
                << "longitude " << block.low.x() << " to " << block.high.x() << ", latitude " << block.low.y()
                << " to " << block.high.y() << ", height " << block.low.z() << " to " << block.high.z();
        }
    }
}

TEST(GroundShell, BlocksHoldAllGround)
{
    const Ground ground = earth(-500.0, 9000.0);
    const GroundShell shell(osg::BoundingSphere(osg::Vec3(), 6.4e6f), ground);
    Random random(22);
    for (int i = 0; i < 1000; ++i)
    {
        const osg::Vec3d at(random.uniform(-osg::PI, osg::PI), random.uniform(-osg::PI_2, osg::PI_2),
                            random.uniform(-500.0, 9000.0));
        const std::vector<GroundShell::Block> all = shell.blocks();
        EXPECT_TRUE(std::any_of(all.begin(), all.end(),
                                [&](const GroundShell::Block& each)
                                {
                                    bool within = true;
                                    for (int axis = 0; axis < 3; ++axis)
                                        within = within && at[axis] >= each.low[axis] - 1e-9 &&
                                                 at[axis] <= each.high[axis] + 1e-9;
                                    return within;
                                }));
    }
}

// A model on a table is terrain, too.
TEST(ProxyFrustumTest, SmallTerrainsHaveOne)
{
    Ground ground;
    for (const double radius : {1e-3, 1.0, 1e3, 1e6})
    {
        // The eye is among the hills.
        const osg::BoundingSphere bound(osg::Vec3(), static_cast<float>(radius));
        const ProxyFrustum::Terrain terrain = {bound,          osg::Matrixd(),
                                               osg::Matrixd(), osg::Vec3d(0.0, 1.0, 0.0),
                                               ground,         {HUGE_VAL, HUGE_VAL, HUGE_VAL, HUGE_VAL},
                                               HUGE_VAL};
        const ProxyFrustum proxy(
            terrain, [](const EyeBox&) { return false; },
            [](const EyeBox& box)
            {
                const Ball ball = box.ball();
                return std::pair(-ball.center.z() - ball.radius, -ball.center.z() + ball.radius);
            },
            [](const EyeBox&) { return false; });
        EXPECT_GE(proxy.depths().second, 0.9 * radius) << "of a terrain of " << radius << " m";
        const osg::Vec3d ahead = osg::Vec3d(0.0, 0.0, -0.9 * radius) * proxy.projection();
        for (int axis = 0; axis < 3; ++axis)
            EXPECT_LE(std::abs(ahead[axis]), 1.0) << "of a terrain of " << radius << " m";
    }
}
