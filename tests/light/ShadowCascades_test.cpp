// SPDX-License-Identifier: MIT
// SPDX-FileCopyrightText: 2026 the osgGeoFX authors
//
// Where the maps of shadows lie, and that their texels stay where they are.
#include <osgGeoFX/light/detail/ShadowCascades.h>

#include <gtest/gtest.h>

#include <cmath>

using namespace osgGeoFX;

namespace
{

constexpr int texels = 1024;

ViewGeometry viewFrom(const osg::Vec3d& eye, const osg::Vec3d& at)
{
    return ViewGeometry(osg::Matrixd::lookAt(eye, at, osg::Vec3d(0.0, 0.0, 1.0)),
                        osg::Matrixd::perspective(40.0, 1.5, 1.0, 1e5), Ground());
}

/// Over a plain at sea level.
GroundBelow above(const ViewGeometry& view)
{
    return {view.eyeHeight, view.eyeHeight};
}

osg::Vec3d inView(const ViewGeometry& view, const osg::Vec3d& direction)
{
    return osg::Matrixd::transform3x3(direction, view.modelView);
}

osg::Vec3d unit(double x, double y, double z)
{
    osg::Vec3d vector(x, y, z);
    vector.normalize();
    return vector;
}

/// Where a place is within a texel of a map, 0…1 along both axes.
osg::Vec2d inTexel(const ShadowCascade& cascade, const ViewGeometry& view, const osg::Vec3d& place)
{
    const osg::Vec3d in = place * view.modelView * cascade.toMap * texels;
    return {in.x() - std::floor(in.x()), in.y() - std::floor(in.y())};
}

/// The same place within a texel; the end of one is the beginning of the next.
double apart(const osg::Vec2d& a, const osg::Vec2d& b)
{
    const auto along = [](double x)
    {
        return std::min(std::abs(x), 1.0 - std::abs(x));
    };
    return std::max(along(a.x() - b.x()), along(a.y() - b.y()));
}

} // namespace

TEST(ShadowCascades, KeepTheirTexelsWhileTheCameraMovesAndTurns)
{
    const osg::Vec3d sun = unit(0.4, -0.3, 0.6), place(1234.5, 987.6, 43.2);
    ShadowGrid grid;
    std::vector<osg::Vec2d> first;
    for (int i = 0; i < 50; ++i)
    {
        const osg::Vec3d eye(1000.0 + 13.7 * i, 800.0 - 5.3 * i, 300.0);
        const ViewGeometry view =
            viewFrom(eye, eye + osg::Vec3d(std::cos(0.1 * i), std::sin(0.1 * i), -0.01 * i));
        const ShadowCascades cascades(view, above(view), grid, inView(view, sun), 0.0, 4, texels);
        ASSERT_EQ(cascades.all().size(), 4u);
        for (std::size_t j = 0; j < 4; ++j)
        {
            const osg::Vec2d now = inTexel(cascades.all()[j], view, place);
            if (i == 0) first.push_back(now);
            EXPECT_LT(apart(now, first[j]), 1e-4) << i << " " << j;
        }
    }
}

TEST(ShadowCascades, TurnAboutTheEyeWithTheSun)
{
    const osg::Vec3d eye(4e6, 3e6, 2e6), at = eye + osg::Vec3d(0.0, 100.0, -40.0);
    const ViewGeometry view = viewFrom(eye, at);
    ShadowGrid grid;
    osg::Vec2d former;
    // Right through the zenith, where axes by the compass would jump.
    for (int i = -100; i <= 100; ++i)
    {
        const osg::Vec3d sun = unit(0.004 * i, 1e-4, 1.0);
        const ShadowCascades cascades(view, above(view), grid, inView(view, sun), 0.0, 1, texels);
        const osg::Vec2d now = inTexel(cascades.all()[0], view, eye);
        if (i > -100)
        {
            EXPECT_LT(apart(now, former), 1e-3) << i;
        }
        former = now;
    }
}

TEST(ShadowCascades, AreWiderByFourAndAheadOfTheEye)
{
    const osg::Vec3d eye(100.0, 200.0, 300.0), sun = unit(0.3, 0.5, 0.5);
    const ViewGeometry view = viewFrom(eye, eye + osg::Vec3d(0.0, 100.0, -20.0));
    ShadowGrid grid;
    const ShadowCascades cascades(view, above(view), grid, inView(view, sun), 0.0, 5, texels);
    double radius = 256.0; // a power of four below 1.2 times the height
    for (const ShadowCascade& each : cascades.all())
    {
        EXPECT_DOUBLE_EQ(each.radius, radius);
        EXPECT_DOUBLE_EQ(each.texel, 2.0 * radius / texels);
        // The ground before the eye, as far as the map is wide.
        const osg::Vec3d ground = osg::Vec3d(100.0, 200.0 + radius, 0.0) * view.modelView * each.toMap;
        for (int axis = 0; axis < 3; ++axis)
        {
            EXPECT_GT(ground[axis], 0.05) << radius;
            EXPECT_LT(ground[axis], 0.95) << radius;
        }
        radius *= 4.0;
    }
    EXPECT_GT(cascades.firstShare(), 0.0);
    EXPECT_LT(cascades.firstShare(), 1.0);
    const ShadowCascades chosen(view, above(view), grid, inView(view, sun), 100.0, 2, texels);
    EXPECT_DOUBLE_EQ(chosen.all()[1].radius, 400.0);
    EXPECT_DOUBLE_EQ(chosen.firstShare(), 1.0);
}

TEST(ShadowCascades, GoByTheGroundBelowTheEye)
{
    const osg::Vec3d sun = unit(0.3, 0.5, 0.5), ahead(0.0, 100.0, -20.0);
    // The same height above other ground, and above ground that an exaggeration has put there.
    struct Case
    {
        double eye;
        GroundBelow ground;
    };
    for (const Case& each : {Case{300.0, {300.0, 300.0}}, Case{4800.0, {300.0, 300.0}},
                             Case{4800.0, {300.0, 2550.0}}, Case{4800.0, {300.0, -1950.0}}})
    {
        const osg::Vec3d eye(100.0, 200.0, each.eye);
        const ViewGeometry view = viewFrom(eye, eye + ahead);
        ShadowGrid grid;
        const ShadowCascades cascades(view, each.ground, grid, inView(view, sun), 0.0, 5, texels);
        double radius = 256.0; // a power of four below 1.2 times the height
        for (const ShadowCascade& map : cascades.all())
        {
            EXPECT_DOUBLE_EQ(map.radius, radius);
            const osg::Vec3d ground(100.0, 200.0 + radius, each.eye - each.ground.undeformed);
            const osg::Vec3d place = ground * view.modelView * map.toMap;
            for (int axis = 0; axis < 3; ++axis)
            {
                EXPECT_GT(place[axis], 0.05) << each.eye << " " << radius;
                EXPECT_LT(place[axis], 0.95) << each.eye << " " << radius;
            }
            radius *= 4.0;
        }
    }
}

TEST(ShadowCascades, LeaveOutWhatThrowsNoShadowIntoThem)
{
    const osg::Vec3d eye(0.0, 0.0, 100.0), sun = unit(0.0, 0.6, 0.8);
    const ViewGeometry view = viewFrom(eye, eye + osg::Vec3d(0.0, 100.0, -20.0));
    ShadowGrid grid;
    const ShadowCascades cascades(view, above(view), grid, inView(view, sun), 0.0, 2, texels);
    const ShadowCascade& first = cascades.all().front();
    const auto ball = [&](const osg::Vec3d& way, double radius)
    {
        return Ball{first.center + inView(view, way), radius};
    };
    EXPECT_FALSE(cascades.outside(0, ball(sun * 1e5, 1.0))) << "towards the sun";
    EXPECT_TRUE(cascades.outside(0, ball(sun * -2.0 * first.depth, 1.0))) << "behind";
    EXPECT_TRUE(cascades.outside(0, ball({2.0 * first.radius, 0.0, 0.0}, 1.0))) << "beside";
    EXPECT_FALSE(cascades.outside(0, ball({2.0 * first.radius, 0.0, 0.0}, 1.1 * first.radius)));
    EXPECT_FALSE(cascades.outside(1, ball({2.0 * first.radius, 0.0, 0.0}, 1.0)));
}
