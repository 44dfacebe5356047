// SPDX-License-Identifier: MIT
// SPDX-FileCopyrightText: 2026 the osgGeoFX authors
//
// How open places of a town are: against rays over the hemisphere that meet the triangles which are drawn, and what is known.
#include <osgGeoFX/effect/detail/DrawableTriangles.h>
#include <osgGeoFX/town/detail/BuildingMesh.h>
#include <osgGeoFX/town/detail/Openness.h>
#include <tools/RandomSamples.h>
#include <town/TownShapes.h>

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

using namespace osgGeoFX;
using namespace geofx::test;

namespace
{

double ask(const Openness& openness, const osg::Vec3d& place, const osg::Vec3d& normal, double ground,
           std::size_t except = Openness::none)
{
    double result = -1.0;
    const double height = place.z();
    openness.at({place.x(), place.y()}, normal, ground, &height, &result, 1, except);
    return result;
}

/// The triangles of buildings as prisms, as they are drawn.
class DrawnTown
{
public:
    explicit DrawnTown(const std::vector<PlacedBuilding>& buildings)
    {
        BuildingMesh mesh(50.0);
        for (const PlacedBuilding& each : buildings)
            mesh.add(each, BuildingLevel::SINGLE);
        const DrawableTriangles triangles(*mesh.create());
        for (const unsigned int corner : triangles.corners())
            _corners.push_back(triangles.positions()[corner]);
    }

    /// By rays in strata of equal weight: `side` of azimuth times `side` of the cosine's square.
    double openness(const osg::Vec3d& place, const osg::Vec3d& normal, double ground, int side) const
    {
        const osg::Vec3d other = std::abs(normal.z()) < 0.9 ? osg::Vec3d(0, 0, 1) : osg::Vec3d(1, 0, 0);
        osg::Vec3d u = other ^ normal;
        u.normalize();
        const osg::Vec3d v = normal ^ u;
        double sum = 0.0;
        for (int i = 0; i < side; ++i)
            for (int j = 0; j < side; ++j)
            {
                const double turn = 2.0 * osg::PI * (i + 0.5) / side, square = (j + 0.5) / side,
                             flat = std::sqrt(square), up = std::sqrt(1.0 - square);
                sum += seen(place, u * (flat * std::cos(turn)) + v * (flat * std::sin(turn)) + normal * up,
                            ground);
            }
        return sum / (side * side);
    }

private:
    double seen(const osg::Vec3d& from, const osg::Vec3d& way, double ground) const
    {
        double nearest = HUGE_VAL;
        for (std::size_t i = 0; i < _corners.size(); i += 3)
        {
            const osg::Vec3d ab = _corners[i + 1] - _corners[i], ac = _corners[i + 2] - _corners[i],
                             normal = way ^ ac;
            const double volume = ab * normal;
            if (std::abs(volume) < 1e-12) continue;
            const osg::Vec3d to = from - _corners[i];
            const double b = (to * normal) / volume;
            if (b < 0.0 || b > 1.0) continue;
            const osg::Vec3d across = to ^ ab;
            const double c = (way * across) / volume;
            if (c < 0.0 || b + c > 1.0) continue;
            const double distance = (ac * across) / volume;
            if (distance > 1e-6) nearest = std::min(nearest, distance);
        }
        if (way.z() < 0.0)
        {
            const double distance = (ground - from.z()) / way.z();
            if (distance <= nearest) return std::min(1.0, distance / Openness::groundReach);
        }
        return std::min(1.0, nearest / Openness::reach);
    }

    std::vector<osg::Vec3d> _corners;
};

} // namespace

// One method samples azimuths and is exact in elevation, the other one throws rays. A corner of a house between two of 24
// azimuths, 15 degrees apart, is what they may differ by: half of a sector that counts for 0.13 of a wall. In the mean
// this cancels out.
TEST(Openness, IsWhatRaysSee)
{
    constexpr double usual = 0.04, halfSector = 0.065;
    double worst = 0.0, sum = 0.0;
    int count = 0, dark = 0, beyond = 0;
    const int towns = fullTest() ? 60 : 6, side = fullTest() ? 96 : 48;
    for (int town = 0; town < towns; ++town)
    {
        SCOPED_TRACE("town " + std::to_string(town));
        Random random(static_cast<std::uint64_t>(town));
        // A street grid with houses on slightly uneven ground, one with a courtyard, one a tower.
        std::vector<PlacedBuilding> all;
        const double angle = random.uniform(0.0, 6.28);
        for (int i = 0; i < 16; ++i)
        {
            const osg::Vec2d middle(26.0 * (i % 4) + random.uniform(-3, 3),
                                    24.0 * (i / 4) + random.uniform(-3, 3));
            std::vector<Ring> rings = {
                box(middle, random.uniform(8, 17), random.uniform(8, 16), angle + random.uniform(-0.1, 0.1))};
            if (i == 5)
            {
                rings = {box(middle, 18, 18, angle), box(middle, 9, 8, angle)};
                std::reverse(rings.back().begin(), rings.back().end());
            }
            all.push_back(building(std::move(rings), random.uniform(-1.0, 1.0),
                                   i == 9 ? 60.0 : random.uniform(4.0, 18.0)));
            all.back().gabled = i % 3 == 0;
        }
        Openness openness;
        for (const PlacedBuilding& each : all)
            openness.add(each);
        const DrawnTown drawn(all);
        for (std::size_t i = 4; i < 12; ++i)
        {
            const double base = all[i].reference.z(), top = meanTop(all[i]);
            for (const Ring& ring : all[i].rings)
            {
                const std::size_t corner = static_cast<std::size_t>(random.integer(0, 3));
                const osg::Vec2d a = ring[corner], along = ring[(corner + 1) % 4] - a;
                osg::Vec3d normal(along.y(), -along.x(), 0.0);
                normal.normalize();
                const osg::Vec2d before =
                    a + along * random.uniform(0.05, 0.95) + osg::Vec2d(normal.x(), normal.y()) * 0.05;
                for (const double share : {0.0, 0.3, 1.0})
                {
                    const osg::Vec3d place(before, base + share * (top - base));
                    const double truth = drawn.openness(place, normal, base, side),
                                 found = ask(openness, place, normal, base);
                    EXPECT_NEAR(found, truth, halfSector) << "wall of " << i << " at " << share;
                    worst = std::max(worst, std::abs(found - truth));
                    sum += std::abs(found - truth);
                    beyond += std::abs(found - truth) > usual ? 1 : 0;
                    ++count;
                    dark += truth < 0.4 ? 1 : 0;
                }
            }
            // The roof, level and tilted, a little above it.
            const osg::Vec2d middle = all[i].rings.front()[0] * 0.6 + all[i].rings.front()[1] * 0.4;
            for (osg::Vec3d normal : {osg::Vec3d(0, 0, 1), osg::Vec3d(0.4, 0.3, 0.87)})
            {
                normal.normalize();
                const osg::Vec3d place(middle, top + 0.02);
                std::vector<PlacedBuilding> others = all;
                others.erase(others.begin() + static_cast<std::ptrdiff_t>(i));
                const double truth = DrawnTown(others).openness(place, normal, base, side),
                             found = ask(openness, place, normal, base, i);
                EXPECT_NEAR(found, truth, halfSector) << "roof of " << i;
                worst = std::max(worst, std::abs(found - truth));
                sum += std::abs(found - truth);
                beyond += std::abs(found - truth) > usual ? 1 : 0;
                ++count;
            }
        }
    }
    EXPECT_LT(sum / count, 0.01);
    EXPECT_LE(beyond, fullTest() ? count / 100 : 0) << "of " << count << " differ by more than " << usual;
    EXPECT_GT(dark, count / 20);
    RecordProperty("worst", std::to_string(worst));
    RecordProperty("mean", std::to_string(sum / count));
}

TEST(Openness, OfALoneWall)
{
    Openness openness;
    openness.add(building({box({0, 0}, 20, 10)}, 3.0, 12.0));
    const osg::Vec3d south(0, -1, 0);
    EXPECT_NEAR(ask(openness, {0, -5.05, 3.0}, south, 3.0), 0.5, 1e-9);
    EXPECT_NEAR(ask(openness, {0, -5.05, 3.0 + Openness::groundReach}, south, 3.0), 1.0, 1e-9);
    EXPECT_EQ(ask(openness, {0, 0, 15.0}, {0, 0, 1}, 3.0, 0), 1.0);
    double last = 0.0;
    for (double z = 3.0; z <= 9.0; z += 0.25)
    {
        const double here = ask(openness, {3, -5.05, z}, south, 3.0);
        EXPECT_GT(here, last);
        last = here;
    }
    // Within a building: nothing is seen of it, so it may not be bright.
    EXPECT_EQ(ask(openness, {0, 0, 6.0}, south, 3.0), 0.0);
}

// Between two long walls: the ground in the middle of the street, integrated over azimuths and elevations.
TEST(Openness, OfAStreet)
{
    Openness openness;
    openness.add(building({box({0, 15}, 4000, 10)}, 0.0, 10.0));
    openness.add(building({box({0, -15}, 4000, 10)}, 0.0, 10.0));
    // From the middle each wall's top is seen at atan(10 / (10 / |cos azimuth|)). Integrated numerically.
    double open = 0.0;
    const int steps = 20000;
    for (int i = 0; i < steps; ++i)
    {
        const double azimuth = 2.0 * osg::PI * (i + 0.5) / steps, away = 10.0 / std::abs(std::sin(azimuth));
        const double top = std::atan2(10.0, away);
        const double seen = std::cos(top) * std::cos(top);
        // What the wall counts for: the mean of its distance over the reach, elevations weighted by sin and cos.
        double wall = 0.0;
        for (int j = 0; j < 50; ++j)
        {
            const double e = top * (j + 0.5) / 50;
            wall += 2.0 * std::sin(e) * std::cos(e) * (top / 50) *
                    std::min(1.0, away / std::cos(e) / Openness::reach);
        }
        open += (seen + wall) / steps;
    }
    EXPECT_NEAR(ask(openness, {0, 0, 0}, {0, 0, 1}, 0.0), open, 0.01);
}
