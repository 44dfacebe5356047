// SPDX-License-Identifier: MIT
// SPDX-FileCopyrightText: 2026 the osgGeoFX authors
//
// Where routes with geographic way points lie, against GeographicLib's geodesics: far legs, over the antimeridian, at 80° of latitude,
// on a globe and on projected terrains.
#include <osgGeoFX/mapping/RoutePath.h>
#include <osgGeoFX/paging/Georeference.h>
#include <tools/GeofxPlugins.h>
#include <tools/RandomSamples.h>
#include <tools/TestRasters.h>

#include <GeographicLib/Geodesic.hpp>
#include <GeographicLib/GeodesicLine.hpp>
#include <GeographicLib/TransverseMercator.hpp>
#include <osg/CoordinateSystemNode>

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <functional>
#include <limits>

using namespace osgGeoFX;
using osg::Vec2d;

namespace
{

using Degrees = std::vector<Vec2d>;

const GeographicLib::Geodesic& geodesic()
{
    return GeographicLib::Geodesic::WGS84();
}

/// Places of the geodesics between way points, metres apart.
Degrees alongLegs(const Degrees& wayPoints, double apart)
{
    Degrees result;
    for (std::size_t i = 1; i < wayPoints.size(); ++i)
    {
        const GeographicLib::GeodesicLine line = geodesic().InverseLine(
            wayPoints[i - 1].y(), wayPoints[i - 1].x(), wayPoints[i].y(), wayPoints[i].x());
        const int count = static_cast<int>(std::ceil(line.Distance() / apart));
        for (int k = 0; k <= count; ++k)
        {
            double latitude = 0.0, longitude = 0.0;
            line.Position(line.Distance() * k / count, latitude, longitude);
            result.emplace_back(longitude, latitude);
        }
    }
    return result;
}

/// Of a place to a line of straight pieces.
double distanceTo(const std::vector<Vec2d>& line, const Vec2d& place)
{
    double least = 1e30;
    for (std::size_t i = 1; i < line.size(); ++i)
    {
        const Vec2d along = line[i] - line[i - 1];
        const double share = std::clamp((place - line[i - 1]) * along / along.length2(), 0.0, 1.0);
        least = std::min(least, (line[i - 1] + along * share - place).length());
    }
    return least;
}

class RoutePlaces : public geofx::test::GeofxPlugins
{
protected:
    using PlaceOf = std::function<Vec2d(const Vec2d& degrees)>;
    std::string _error;

    osg::ref_ptr<Georeference> referenceOf(int epsg)
    {
        const osg::ref_ptr<osg::CoordinateSystemNode> node = new osg::CoordinateSystemNode;
        node->setFormat("WKT");
        node->setCoordinateSystem(geofx::test::wktOf(epsg));
        osg::ref_ptr<Georeference> reference = Georeference::create(node, _error);
        EXPECT_TRUE(reference) << _error;
        return reference;
    }

    /// Lays a route; each way point is where `placeOf` has it, and the line is nowhere farther than so many metres of the frame from
    /// the geodesic.
    void expectAlongGeodesics(const Degrees& wayPoints, ProjectiveMappings& effect,
                              const osg::EllipsoidModel* ellipsoid, const Georeference* reference,
                              const PlaceOf& placeOf, double most)
    {
        const osg::ref_ptr<RouteMapping> route = new RouteMapping;
        effect.addRoute(route);
        ASSERT_TRUE(route->setGeographicWayPoints(wayPoints, ellipsoid, reference, _error)) << _error;
        EXPECT_EQ(route->getGeographicWayPoints(), wayPoints);
        const std::vector<Vec2d> points = route->getWayPoints();
        ASSERT_EQ(points.size(), wayPoints.size());
        for (std::size_t i = 0; i < points.size(); ++i)
            EXPECT_LT((points[i] - placeOf(wayPoints[i])).length(), 0.01) << i;
        double farthest = 0.0;
        for (const Vec2d& degrees : alongLegs(wayPoints, 7000.0))
            farthest = std::max(farthest, distanceTo(route->getWay().line, placeOf(degrees)));
        EXPECT_LT(farthest, most);
        EXPECT_EQ(route->mappings(RouteMapping::POINTS).size(), wayPoints.size()) << "no marks between";
        EXPECT_LT(route->getWay().line.size(), 4000u);
        effect.removeRoute(route);
    }

    void expectOnGlobe(const Degrees& wayPoints, const Vec2d& origin)
    {
        SCOPED_TRACE(testing::Message() << wayPoints[0].x() << ", " << wayPoints[0].y());
        const osg::EllipsoidModel earth;
        const osg::ref_ptr<ProjectiveMappings> effect = new ProjectiveMappings;
        effect->setGeodeticOrigin(osg::DegreesToRadians(origin.x()), osg::DegreesToRadians(origin.y()));
        const auto placeOf = [&](const Vec2d& degrees)
        {
            osg::Vec3d world;
            earth.convertLatLongHeightToXYZ(osg::DegreesToRadians(degrees.y()),
                                            osg::DegreesToRadians(degrees.x()), 0.0, world.x(), world.y(),
                                            world.z());
            const osg::Vec3d place = effect->placeOf(world, &earth);
            return Vec2d(place.x(), place.y());
        };
        expectAlongGeodesics(wayPoints, *effect, &earth, nullptr, placeOf, 2.0);
    }
};

} // namespace

TEST_F(RoutePlaces, GeodesicsAreThoseOfGeographicLib)
{
    using geofx::test::Random;
    double farthest = 0.0;
    int far = 0;
    for (int i = 0; i < geofx::test::sampleCount() / 10; ++i)
    {
        Random random(static_cast<std::uint64_t>(i));
        RoutePath path;
        for (int k = 0; k < 2; ++k)
            path.places.emplace_back(random.uniform(-180.0, 180.0),
                                     osg::RadiansToDegrees(std::asin(random.uniform(-1.0, 1.0))), 0.0);
        const GeographicLib::GeodesicLine line = geodesic().InverseLine(
            path.places[0].y(), path.places[0].x(), path.places[1].y(), path.places[1].x());
        if (line.Distance() > 1e7) continue;
        far += line.Distance() > 5e6;
        const Degrees points = path.alongGeodesics();
        EXPECT_NEAR(static_cast<double>(points.size() - 1), line.Distance() / 2e4,
                    1.0 + 0.01 * line.Distance() / 2e4);
        for (const Vec2d& point : points)
        {
            // How far from the line: the azimuths from its start differ by the distance over the reduced length.
            double distance = 0.0, azimuth = 0.0, end = 0.0, reduced = 0.0;
            geodesic().Inverse(path.places[0].y(), path.places[0].x(), point.y(), point.x(), distance,
                               azimuth, end, reduced);
            const double turn = osg::DegreesToRadians(std::remainder(azimuth - line.Azimuth(), 360.0));
            farthest = std::max(farthest, std::abs(turn * reduced));
        }
    }
    EXPECT_GT(far, 10);
    EXPECT_LT(farthest, 1.0);
}

TEST_F(RoutePlaces, OnAGlobe)
{
    expectOnGlobe({{-158.0, 21.3}, {-157.9, 21.4}, {-157.8, 21.3}}, {-158.0, 21.3});
    // Honolulu, San Francisco.
    expectOnGlobe({{-157.86, 21.31}, {-122.42, 37.77}}, {-140.0, 30.0});
    // Over the antimeridian, with longitudes of either kind, and at 80°.
    expectOnGlobe({{170.0, -17.0}, {-171.0, -14.0}, {179.9, -10.0}}, {180.0, -14.0});
    expectOnGlobe({{170.0, -17.0}, {189.0, -14.0}}, {-180.0, -14.0});
    expectOnGlobe({{165.0, 80.0}, {-150.0, 79.0}, {100.0, 81.0}}, {180.0, 80.0});
    // Over the pole.
    expectOnGlobe({{20.0, 80.0}, {-155.0, 78.0}}, {0.0, 90.0});
}

TEST_F(RoutePlaces, OnProjectedTerrains)
{
    const GeographicLib::TransverseMercator& utm = GeographicLib::TransverseMercator::UTM();
    const auto onZone = [&](double meridian)
    {
        return [&utm, meridian](const Vec2d& degrees)
        {
            double x = 0.0, y = 0.0;
            utm.Forward(meridian, degrees.y(), degrees.x(), x, y);
            return Vec2d(x + 5e5 - 4e5, y - 8e6);
        };
    };
    const osg::ref_ptr<ProjectiveMappings> effect = new ProjectiveMappings;
    effect->setOrigin({4e5, 8e6});
    // UTM's zone 60, whose edge is the antimeridian, and 33 at 80°.
    expectAlongGeodesics({{176.0, 40.0}, {-179.5, 44.0}, {179.9, 41.0}}, *effect, nullptr, referenceOf(32660),
                         onZone(177.0), 2.0);
    expectAlongGeodesics({{10.0, 80.0}, {20.0, 79.0}, {15.0, 81.0}}, *effect, nullptr, referenceOf(32633),
                         onZone(15.0), 2.0);
    // Mercator's projection, where a geodesic is far from straight; 80° is 5.8 times as large.
    const osg::ref_ptr<Georeference> mercator = referenceOf(3395);
    const auto onMercator = [](const Vec2d& degrees)
    {
        constexpr double a = 6378137.0, e = 0.0818191908426215;
        const double s = std::sin(osg::DegreesToRadians(degrees.y()));
        return Vec2d(a * osg::DegreesToRadians(degrees.x()) - 4e5,
                     a * (std::atanh(s) - e * std::atanh(e * s)) - 8e6);
    };
    expectAlongGeodesics({{-40.0, 40.0}, {30.0, 60.0}}, *effect, nullptr, mercator, onMercator, 2.0 * 2.0);
    expectAlongGeodesics({{10.0, 80.0}, {60.0, 79.0}}, *effect, nullptr, mercator, onMercator, 2.0 * 6.0);
}

TEST_F(RoutePlaces, WhatCannotBeLaidIsRefusedInASentence)
{
    const osg::EllipsoidModel earth;
    const osg::ref_ptr<ProjectiveMappings> effect = new ProjectiveMappings;
    const osg::ref_ptr<RouteMapping> route = new RouteMapping;
    const auto faultOf = [&](const Degrees& degrees, bool globe, const Georeference* reference)
    {
        const std::vector<Vec2d> before = route->getWay().line;
        _error.clear();
        EXPECT_FALSE(route->setGeographicWayPoints(degrees, globe ? &earth : nullptr, reference, _error));
        EXPECT_EQ(route->getWay().line, before) << "it stays as it is";
        EXPECT_TRUE(!_error.empty() && _error.back() == '.') << _error;
        return _error;
    };
    const auto has = [](const std::string& text, const char* part)
    {
        EXPECT_NE(text.find(part), std::string::npos) << text;
    };
    has(faultOf({{0, 0}, {1, 1}}, true, nullptr), "add it first");
    effect->addRoute(route);
    EXPECT_TRUE(route->setGeographicWayPoints({{0, 0}, {1, 1}}, &earth, nullptr, _error));
    constexpr double none = std::numeric_limits<double>::quiet_NaN();
    for (const Vec2d& bad : {Vec2d(0, 91), Vec2d(361, 0), Vec2d(none, 0), Vec2d(0, none)})
    {
        has(faultOf({{0, 0}, bad}, true, nullptr), "is no place");
        has(faultOf({bad}, true, nullptr), "is no place");
    }
    has(faultOf({{0, 0}, {100, 0}}, true, nullptr), "other side of the globe");
    has(faultOf({{0, 0}, {1, 1}}, false, nullptr), "georeference");
    has(faultOf({{179, 10}, {-179, 10}}, false, referenceOf(3395)), "edge of the terrain's projection");
    has(faultOf({{10, 60}, {20, 90}}, false, referenceOf(3395)), "projection");
    has(faultOf(Degrees(20001, Vec2d(1, 1)), true, nullptr), "20000 way points");
    // A way of its own is still possible, and has no degrees any more.
    EXPECT_TRUE(route->setWayPoints({{0, 0}, {100, 0}}));
    EXPECT_TRUE(route->getGeographicWayPoints().empty());
    EXPECT_TRUE(route->setGeographicWayPoints({{1, 1}, {1, 1}}, &earth, nullptr, _error));
    EXPECT_EQ(route->getGeographicWayPoints().size(), 1u) << "neighbours at one place count once";
    EXPECT_TRUE(route->setGeographicWayPoints({}, &earth, nullptr, _error));
    EXPECT_EQ(route->getNumMappings(), 0u);
}

TEST_F(RoutePlaces, WaysOfFilesAreSimplifiedOrKeptAndHaveAnEnd)
{
    const osg::EllipsoidModel earth;
    const osg::ref_ptr<ProjectiveMappings> effect = new ProjectiveMappings;
    RoutePath path;
    path.name = "zigzag";
    RoutePath::Look look;
    look.style.halfWidth = 0.0; // no line; this was a tolerance that never grew
    for (int i = 0; i < 20001; ++i)
        path.places.emplace_back(i * 1e-5, i % 2 * 0.05, 0.0);
    ASSERT_TRUE(path.showOn(*effect, &earth, nullptr, look, _error)) << _error;
    EXPECT_LE(effect->getRoute(0)->getWayPoints().size(), 20000u);
    EXPECT_EQ(effect->getRoute(0)->getName(), "zigzag");
    path.wayPoints = true;
    EXPECT_FALSE(path.showOn(*effect, &earth, nullptr, look, _error)) << "too many";
    EXPECT_FALSE(RoutePath().showOn(*effect, &earth, nullptr, look, _error));
    EXPECT_EQ(effect->getNumRoutes(), 1u) << "nothing is left of what is refused";
    // A track along a geodesic is one leg, and no mark.
    path.wayPoints = false;
    path.places = {{0.0, 0.0, 0.0}, {10.0, 0.0, 0.0}, {20.0, 0.0, 0.0}};
    look = {};
    look.width = 500.0;
    look.properties = {{"dash", 70.0}, {"casing", 3.0}};
    ASSERT_TRUE(path.showOn(*effect, &earth, nullptr, look, _error)) << _error;
    const RouteMapping& way = *effect->getRoute(1);
    EXPECT_EQ(way.legs(), 1u);
    EXPECT_EQ(way.mappings(RouteMapping::POINTS).size(), 0u);
    EXPECT_EQ(way.getStyle().halfWidth, 250.0);
    EXPECT_EQ(way.getStyle().dash, 70.0);
    EXPECT_EQ(way.getStyle().casing, 3.0) << "as it says";
    // A long way over small ground is no band across all of it.
    look = {};
    look.groundExtent = 60000.0;
    ASSERT_TRUE(path.showOn(*effect, &earth, nullptr, look, _error)) << _error;
    EXPECT_EQ(effect->getRoute(2)->getStyle().halfWidth, 250.0);
    look.groundExtent = 0.0;
    ASSERT_TRUE(path.showOn(*effect, &earth, nullptr, look, _error)) << _error;
    EXPECT_GT(effect->getRoute(3)->getStyle().halfWidth, 5000.0);
    look.properties = {{"dash", -1.0}};
    EXPECT_FALSE(path.showOn(*effect, &earth, nullptr, look, _error));
    EXPECT_NE(_error.find("dash"), std::string::npos) << _error;
}
