// SPDX-License-Identifier: MIT
// SPDX-FileCopyrightText: 2026 the osgGeoFX authors
//
// Which ways a scene takes, and what it says of the others.
#include <osgGeoFX/map/SceneRoutes.h>

#include <osg/CoordinateSystemNode>

#include <gtest/gtest.h>

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
