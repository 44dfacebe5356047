// SPDX-License-Identifier: MIT
// SPDX-FileCopyrightText: 2026 the osgGeoFX authors
//
// The shade around the feet of buildings: where it lies, how dark it is, and where it ends.
#include <osgGeoFX/effect/GroundShade.h>
#include <osgGeoFX/effect/detail/DrawableTriangles.h>
#include <osgGeoFX/town/detail/BuildingMesh.h>
#include <osgGeoFX/town/detail/ContactShade.h>
#include <tools/RandomSamples.h>
#include <town/TownShapes.h>

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

using namespace osgGeoFX;
using namespace geofx::test;

namespace
{

constexpr ContactShade::Fineness FINE = {12.0, 1.0 / 32.0};
constexpr double GRAIN = 4.0 / 32.0; ///< what lies at a ring's end may be off by so much

/// Not steep: uphill walls are high enough everywhere.
double hills(const osg::Vec2d& at, double)
{
    return 30.0 + 0.05 * at.x() + 2.0 * std::sin(at.y() / 60.0);
}

struct Shade
{
    std::vector<osg::Vec3d> places;
    std::vector<int> shares; ///< of 255
    std::vector<unsigned int> corners;
};

Shade shadeOf(const PlacedBuilding& each, const ContactShade::Fineness& fineness = FINE)
{
    ContactShade shade(hills, fineness);
    shade.add(each);
    const osg::ref_ptr<osg::StateSet> state = GroundShade::createState();
    const osg::ref_ptr<osg::Geometry> geometry = shade.create(state);
    EXPECT_TRUE(geometry);
    Shade result;
    if (!geometry) return result;
    EXPECT_TRUE(GroundShade::is(*geometry));
    const DrawableTriangles mesh(*geometry);
    result.corners = mesh.corners();
    for (const osg::Vec3d& place : mesh.positions())
        result.places.push_back(place);
    for (const osg::Vec4ub& color : static_cast<const osg::Vec4ubArray&>(*geometry->getColorArray()))
    {
        EXPECT_EQ(color.r() + color.g() + color.b(), 0);
        result.shares.push_back(color.a());
    }
    return result;
}

/// Metres from a place to the nearest side of all rings.
double awayFrom(const std::vector<Ring>& rings, const osg::Vec2d& place)
{
    double nearest = HUGE_VAL;
    for (const Ring& ring : rings)
        for (std::size_t i = 0; i < ring.size(); ++i)
        {
            const osg::Vec2d side = ring[(i + 1) % ring.size()] - ring[i];
            const double share = std::clamp(((place - ring[i]) * side) / side.length2(), 0.0, 1.0);
            nearest = std::min(nearest, (place - ring[i] - side * share).length());
        }
    return nearest;
}

osg::Vec2d flat(const osg::Vec3d& place)
{
    return {place.x(), place.y()};
}

} // namespace

TEST(ContactShadeTest, LiesOnTheGroundAroundTheBuildingAndEndsWithNothing)
{
    Random random(4);
    for (int i = 0; i < 200; ++i)
    {
        SCOPED_TRACE(i);
        std::vector<Ring> rings = {box({random.uniform(-200, 200), random.uniform(-200, 200)},
                                       random.logarithmic(8, 60), random.logarithmic(8, 60),
                                       random.uniform(0, 6))};
        // An L.
        if (i % 3 == 1)
        {
            const Ring& all = rings.front();
            const osg::Vec2d a = (all[1] - all[0]) * 0.5, b = (all[3] - all[0]) * 0.5;
            rings = {{all[0], all[1], all[1] + b, all[0] + a + b, all[3] + a, all[3]}};
        }
        if (i % 3 == 2)
        {
            Ring yard = box(ringMiddle(rings.front()), 4.0, 4.0, random.uniform(0, 6));
            std::reverse(yard.begin(), yard.end());
            rings.push_back(yard);
        }
        const double base = hills(ringMiddle(rings.front()), 0.0);
        const PlacedBuilding each = building(rings, base, random.logarithmic(6, 120));
        const Shade shade = shadeOf(each);
        const double width = ContactShade::width(each);
        int walls = 0, ends = 0;
        for (std::size_t k = 0; k < shade.places.size(); ++k)
        {
            const osg::Vec3d& place = shade.places[k];
            EXPECT_NEAR(place.z(), hills(flat(place), 0.0), GRAIN + 1e-3);
            const double away = awayFrom(rings, flat(place));
            // At the wall, or where it takes nothing.
            if (shade.shares[k] > 0)
            {
                EXPECT_LT(away, 0.05);
                ++walls;
                continue;
            }
            EXPECT_LT(away, 1.5 * width + 2.0 * GRAIN);
            // Corners that turn inward have less room.
            if (i % 3 == 0)
            {
                EXPECT_GT(away, 0.99 * width - 2.0 * GRAIN);
            }
            EXPECT_FALSE(isWithin(rings, flat(place)) && away > 0.1);
            ++ends;
        }
        EXPECT_GE(walls, 4);
        EXPECT_EQ(walls, ends);
        // No triangle lies below the building, and none on another one.
        double area = 0.0;
        for (std::size_t c = 0; c < shade.corners.size(); c += 3)
        {
            const osg::Vec2d p = flat(shade.places[shade.corners[c]]),
                             q = flat(shade.places[shade.corners[c + 1]]),
                             r = flat(shade.places[shade.corners[c + 2]]);
            const double twice = (q.x() - p.x()) * (r.y() - p.y()) - (q.y() - p.y()) * (r.x() - p.x());
            EXPECT_GT(twice, -4.0); // places are rounded
            area += 0.5 * twice;
            const osg::Vec2d middle = (p + q + r) / 3.0;
            EXPECT_FALSE(isWithin(rings, middle) && awayFrom(rings, middle) > 0.2);
        }
        if (i % 3 > 0) continue;
        const Ring& ring = rings.front();
        const double a = (ring[1] - ring[0]).length(), b = (ring[2] - ring[1]).length();
        const double whole = (a + 2.0 * width) * (b + 2.0 * width) - a * b;
        EXPECT_NEAR(area, whole, 0.03 * whole + 2.0);
    }
}

// A long wall shuts in half of what a place at its foot sees.
TEST(ContactShadeTest, TakesHalfOfTheDarkeningAtALongWall)
{
    for (const double height : {12.0, 30.0, 100.0})
    {
        const Shade shade =
            shadeOf(building({box({0.0, 0.0}, 12.0, 200.0, 0.0)}, 30.0, height), {500.0, 0.01});
        for (const int share : shade.shares)
            if (share > 0)
            {
                // Of the whole darkening, 0.6; short sides have a little less, and mean with the long ones.
                EXPECT_NEAR(share / 255.0, 0.3, 0.03);
            }
    }
}

TEST(ContactShadeTest, IsWiderForATallBuilding)
{
    const auto widthOf = [](double height)
    {
        return ContactShade::width(building({box({0.0, 0.0}, 20.0, 12.0, 0.0)}, 30.0, height));
    };
    EXPECT_GT(widthOf(10.0), 1.4 * widthOf(5.0));
    EXPECT_GT(widthOf(20.0), 1.5 * widthOf(10.0));
    EXPECT_GE(widthOf(1.0), 2.0);
    EXPECT_LE(widthOf(400.0), 15.0);
}

// Long sides follow the ground.
TEST(ContactShadeTest, HasVerticesAlongTheGround)
{
    const PlacedBuilding hall = building({box({0.0, 0.0}, 12.0, 240.0, 0.0)}, 30.0, 8.0);
    const Shade coarse = shadeOf(hall, {1000.0, 1.0 / 32.0}), fine = shadeOf(hall);
    EXPECT_EQ(coarse.places.size(), 8u);
    EXPECT_EQ(fine.places.size(), 8u + 2u * 2u * 19u);
}

TEST(ContactShadeTest, BadOutlinesGiveNothing)
{
    ContactShade shade(hills, FINE);
    shade.add(building({{{0.0, 0.0}, {5.0, 0.0}}}, 30.0, 8.0));
    shade.add(building({{{0.0, 0.0}, {0.0, 0.0}, {0.0, 0.0}, {0.0, 0.0}}}, 30.0, 8.0));
    EXPECT_FALSE(shade.create(nullptr));
    // A side that goes back where it came from stays finite.
    shade.add(building({{{0.0, 0.0}, {20.0, 0.0}, {10.0, 0.0}, {10.0, 9.0}, {0.0, 9.0}}}, 30.0, 8.0));
    const osg::ref_ptr<osg::Geometry> geometry = shade.create(nullptr);
    ASSERT_TRUE(geometry);
    EXPECT_LT(geometry->getBoundingBox().radius(), 100.0f);
}
