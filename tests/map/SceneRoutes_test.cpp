// SPDX-License-Identifier: MIT
// SPDX-FileCopyrightText: 2026 the osgGeoFX authors
//
// Which ways a scene takes, and what it says of the others.
#include <osgGeoFX/map/SceneRoutes.h>
#include <tools/HeightMesh.h>

#include <osg/CoordinateSystemNode>
#include <osg/Geometry>
#include <osg/Math>
#include <osg/MatrixTransform>

#include <gtest/gtest.h>

#include <cmath>
#include <limits>

using namespace osgGeoFX;

namespace
{

class SceneRoutesTest : public ::testing::Test
{
protected:
    void SetUp() override
    {
        _node->setEllipsoidModel(new osg::EllipsoidModel);
        _scene->addChild(_node);
    }
    std::string faultOf(const RoutePath& route)
    {
        SceneRoutes routes(*_node, *_scene);
        std::string error;
        EXPECT_FALSE(routes.add(route, {}, error));
        EXPECT_TRUE(!error.empty() && error.back() == '.') << error;
        return error;
    }
    static RoutePath wayPoints(int count)
    {
        RoutePath route;
        route.wayPoints = true;
        for (int i = 0; i < count; ++i)
            route.places.emplace_back(7.0 + i * 1e-4, 45.0 + i % 2 * 0.01, 0.0);
        return route;
    }

    osg::ref_ptr<osg::CoordinateSystemNode> _node = new osg::CoordinateSystemNode;
    osg::ref_ptr<EffectScene> _scene = new EffectScene;
};

bool contains(const std::string& text, const std::string& part)
{
    return text.find(part) != std::string::npos;
}

} // namespace

TEST_F(SceneRoutesTest, AWayLongerThanTheGroundIsNoWiderForIt)
{
    osg::Vec3d place;
    _node->getEllipsoidModel()->convertLatLongHeightToXYZ(
        osg::DegreesToRadians(45.0), osg::DegreesToRadians(7.0), 0.0, place.x(), place.y(), place.z());
    osg::ref_ptr<osg::MatrixTransform> ground = new osg::MatrixTransform(osg::Matrixd::translate(place));
    ground->addChild(geofx::test::HeightMesh{
        [](double, double)
        {
            return 0.0;
        }}.mesh(2));
    _node->addChild(ground);
    RoutePath route;
    route.places = {{7.0, 45.0, 0.0}, {17.0, 45.0, 0.0}};
    SceneRoutes routes(*_node, *_scene);
    std::string error;
    ASSERT_TRUE(routes.add(route, {}, error)) << error;
    const auto* const effect = dynamic_cast<ProjectiveMappings*>(_scene->getEffect(0));
    ASSERT_TRUE(effect);
    const double width = 2.0 * effect->getRoute(0)->getStyle().halfWidth;
    EXPECT_NEAR(width, 2.0 * static_cast<double>(_node->getBound().radius()) / 120.0, 1.0);
    EXPECT_LT(width, 300.0);
}

TEST_F(SceneRoutesTest, WaysWithoutPlacesAreRefused)
{
    EXPECT_TRUE(contains(faultOf({}), "has no place"));
    for (const double bad : {95.0, std::numeric_limits<double>::quiet_NaN()})
    {
        RoutePath route = wayPoints(2);
        route.places[1].y() = bad;
        EXPECT_TRUE(contains(faultOf(route), "one that is none"));
    }
    EXPECT_EQ(_scene->getNumEffects(), 0u) << "no effect for what is not shown";
}

TEST_F(SceneRoutesTest, ThereIsAnEndOfThem)
{
    EXPECT_TRUE(contains(faultOf(wayPoints(20001)), "20000 way points"));
    SceneRoutes routes(*_node, *_scene);
    std::string error;
    int shown = 0;
    while (shown < 100 && routes.add(wayPoints(10000), {}, error))
        ++shown;
    EXPECT_GT(shown, 1);
    EXPECT_LT(shown, 100);
    EXPECT_TRUE(contains(error, "too many places")) << error;
}

// A slope that rises by 100 m for each hundredth of a degree to the east.
TEST_F(SceneRoutesTest, HeightsAboveTheGroundAreThoseOfTheScenesGround)
{
    const osg::EllipsoidModel earth;
    const auto world = [&](double longitude, double latitude, double height)
    {
        osg::Vec3d place;
        earth.convertLatLongHeightToXYZ(osg::DegreesToRadians(latitude), osg::DegreesToRadians(longitude),
                                        height, place.x(), place.y(), place.z());
        return place;
    };
    const auto slope = [](double longitude)
    {
        return 300.0 + 1e4 * (longitude - 7.0);
    };
    RoutePath route;
    route.name = "drone";
    route.altitude = RoutePath::ABOVE_GROUND;
    route.extruded = true;
    route.places = {{7.0, 45.0, 100.0}, {7.02, 45.0, 50.0}};
    EXPECT_TRUE(contains(faultOf(route), "count from the ground, and there is none"));

    const osg::Vec3d middle = world(7.0, 45.0, 0.0);
    const auto ground =
        geofx::test::makeMesh(30,
                              [&](double east, double north)
                              {
                                  const double longitude = 6.97 + 0.08 * east;
                                  return world(longitude, 44.96 + 0.08 * north, slope(longitude)) - middle;
                              });
    const osg::ref_ptr<osg::MatrixTransform> place =
        new osg::MatrixTransform(osg::Matrixd::translate(middle));
    place->addChild(ground);
    _node->addChild(place);

    SceneRoutes routes(*_node, *_scene);
    std::string error;
    ASSERT_TRUE(routes.add(route, {}, error)) << error;
    ASSERT_TRUE(routes.add(route, {}, error)) << error; // The first one is no ground of the second.
    int ways = 0;
    for (unsigned int i = 0; i < _scene->getNumChildren(); ++i)
    {
        auto* const node = dynamic_cast<osg::MatrixTransform*>(_scene->getChild(i));
        if (!node || node->getName() != "drone") continue;
        ++ways;
        double lowest = 1e9, highest = -1e9;
        const auto& all =
            static_cast<const osg::Vec3Array&>(*node->getChild(0)->asGeometry()->getVertexArray());
        for (const osg::Vec3& vertex : all)
        {
            const osg::Vec3d at = osg::Vec3d(vertex) * node->getMatrix();
            double latitude = 0.0, longitude = 0.0, height = 0.0;
            earth.convertXYZToLatLongHeight(at.x(), at.y(), at.z(), latitude, longitude, height);
            const double above = height - slope(osg::RadiansToDegrees(longitude));
            lowest = std::min(lowest, above);
            highest = std::max(highest, above);
        }
        // A tube of 8 m, and a curtain.
        const bool curtain = all.size() < 500;
        EXPECT_NEAR(lowest, curtain ? 0.0 : 46.0, 2.0);
        EXPECT_NEAR(highest, curtain ? 100.0 : 104.0, 2.0);
    }
    EXPECT_EQ(ways, 4);
}
