// SPDX-License-Identifier: MIT
// SPDX-FileCopyrightText: 2026 the osgGeoFX authors
//
// Liberties with regions of the ground: that nothing folds, that nothing else moves, and that bounds hold.
#include <osgGeoFX/deformation/RegionalLiberty.h>
#include <osgGeoFX/effect/DeformationChain.h>
#include <osgGeoFX/panorama/PanoramaMap.h>
#include <tools/RandomViews.h>

#include <GeographicLib/Geocentric.hpp>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <sstream>

using namespace geofx::test;
using osg::Vec3d;
using osgGeoFX::Ball;
using osgGeoFX::DeformationChain;
using osgGeoFX::DeformationSnapshot;
using osgGeoFX::RegionalLiberty;

namespace
{

osg::ref_ptr<RegionalLiberty> randomLiberty(const CameraPose& pose, Random& random)
{
    const osg::ref_ptr<RegionalLiberty> liberty = new RegionalLiberty;
    const double radius = random.logarithmic(100.0, 5e4);
    const double east = random.uniform(-1.5, 1.5) * radius, north = random.uniform(-1.5, 1.5) * radius;
    if (pose.globe)
        liberty->setGeodeticCenter(
            std::remainder(pose.x + east / 6.4e6 / std::max(std::cos(pose.y), 0.05), 2.0 * osg::PI),
            std::clamp(pose.y + north / 6.4e6, -1.57, 1.57));
    else
        liberty->setCenter({pose.x + east, pose.y + north});
    liberty->setRadii(radius, radius * random.uniform(0.4, 2.5));
    liberty->setHeading(random.uniform(-3.0, 3.0));
    liberty->setStrength(random.integer(0, 2) ? 1.0 : random.uniform(0.01, 1.0));
    if (random.integer(0, 2)) liberty->setEnlarge(random.uniform(0.1, 5.0));
    if (random.integer(0, 1)) liberty->setWiden(random.uniform(0.25, 2.0));
    if (random.integer(0, 1)) liberty->setLengthen(random.uniform(0.25, 2.0));
    if (random.integer(0, 1)) liberty->setTurn(random.uniform(-osg::PI_2, osg::PI_2));
    liberty->setBaseHeight(random.integer(0, 1) ? 0.0 : random.uniform(-100.0, 2000.0));
    return liberty;
}

struct Case
{
    CameraPose pose;
    osg::ref_ptr<RegionalLiberty> liberty;
    osg::ref_ptr<const DeformationSnapshot> snapshot;
    osg::Matrixd frame; ///< from the region's own frame, unturned by its heading, to eye space

    /// A place in half widths from the center.
    Vec3d at(double across, double along, double height) const
    {
        const double c = std::cos(liberty->getHeading()), s = std::sin(liberty->getHeading());
        const double x = across * liberty->getAcross(), y = along * liberty->getAlong();
        const double drop = pose.globe ? (x * x + y * y) / 2.0 / 6.4e6 : 0.0;
        return Vec3d(c * x + s * y, c * y - s * x, height - drop) * frame;
    }
    Vec3d random(Random& random, double reach) const
    {
        return at(random.uniform(-reach, reach), random.uniform(-reach, reach),
                  random.uniform(-300.0, 6000.0));
    }
};

template<class Check>
void forRandom(int count, const Check& check)
{
    for (int sample = 0; sample < count; ++sample)
    {
        Random random(static_cast<std::uint64_t>(sample));
        Case found;
        found.pose = randomPose(random);
        found.liberty = randomLiberty(found.pose, random);
        found.snapshot = found.liberty->snapshot(found.pose.view());
        if (!found.snapshot) continue;
        const osgGeoFX::LocalOrigin origin = {found.liberty->getCenter().x(), found.liberty->getCenter().y(),
                                              found.liberty->getLongitude(), found.liberty->getLatitude()};
        found.frame = origin.toWorld(found.pose.ground().ellipsoid, 0.0) * found.pose.modelView();
        std::ostringstream text;
        text << "sample " << sample << ": " << describe(*found.liberty) << "; " << found.pose;
        SCOPED_TRACE(text.str());
        check(found, random);
        if (::testing::Test::HasFailure()) return;
    }
}

template<class Map>
double determinant(const Map& snapshot, const Vec3d& point, double step)
{
    Vec3d columns[3];
    for (int axis = 0; axis < 3; ++axis)
    {
        Vec3d before = point, after = point;
        before[axis] -= step;
        after[axis] += step;
        columns[axis] = (snapshot.deform(after) - snapshot.deform(before)) / (2.0 * step);
    }
    return columns[0] * (columns[1] ^ columns[2]);
}

} // namespace

TEST(RegionalLiberties, LeaveWhatIsOutsideToTheBit)
{
    forRandom(sampleCount(),
              [](const Case& found, Random& random)
              {
                  const double angle = random.uniform(-3.2, 3.2), away = random.uniform(1.0001, 5.0);
                  const Vec3d outside = found.at(away * std::cos(angle), away * std::sin(angle),
                                                 random.uniform(-500.0, 9000.0));
                  EXPECT_EQ(found.snapshot->deform(outside), outside);
                  EXPECT_EQ(found.snapshot->undeform(outside), outside);
                  EXPECT_EQ(found.snapshot->reach({outside, 0.0}), DeformationSnapshot::Reach::Identity);
              });
}

TEST(RegionalLiberties, NeverFold)
{
    // Sets of several over one ground, one after the other. Each is one to one if its determinant is positive everywhere and
    // its border stays; the inverse finds each place again.
    forRandom(fullTest() ? 10000 : 1000,
              [](const Case& first, Random& random)
              {
                  Case found = first;
                  const int count = random.integer(1, 5);
                  for (int i = 0; i < count; ++i)
                  {
                      if (i > 0)
                      {
                          found.liberty = randomLiberty(found.pose, random);
                          found.snapshot = found.liberty->snapshot(found.pose.view());
                          if (!found.snapshot) continue;
                          const osgGeoFX::LocalOrigin origin = {
                              found.liberty->getCenter().x(), found.liberty->getCenter().y(),
                              found.liberty->getLongitude(), found.liberty->getLatitude()};
                          found.frame =
                              origin.toWorld(found.pose.ground().ellipsoid, 0.0) * found.pose.modelView();
                      }
                      const double small = std::min(found.liberty->getAcross(), found.liberty->getAlong());
                      for (int place = 0; place < 20; ++place)
                      {
                          const Vec3d point = found.random(random, 1.0);
                          EXPECT_GT(determinant(*found.snapshot, point, 1e-4 * small), 0.0);
                          const Vec3d back = found.snapshot->undeform(found.snapshot->deform(point));
                          const double scale = found.frame.getTrans().length() + small;
                          EXPECT_LT((back - point).length(), 1e-8 * scale + 1e-9 * 6.4e6 * found.pose.globe);
                      }
                  }
              });
}

namespace
{

/// A set of liberties of one camera, each over the one before, and the places of all of them.
struct Set
{
    osg::ref_ptr<DeformationChain> chain = new DeformationChain;
    std::vector<Case> members;

    Set(const Case& first, Random& random)
    {
        members.push_back(first);
        for (int more = random.integer(1, 5); more > 0; --more)
        {
            Case next = first;
            next.liberty = randomLiberty(first.pose, random);
            next.snapshot = next.liberty->snapshot(first.pose.view());
            if (!next.snapshot) continue;
            const osgGeoFX::LocalOrigin origin = {next.liberty->getCenter().x(),
                                                  next.liberty->getCenter().y(), next.liberty->getLongitude(),
                                                  next.liberty->getLatitude()};
            next.frame = origin.toWorld(first.pose.ground().ellipsoid, 0.0) * first.pose.modelView();
            members.push_back(next);
        }
        for (const Case& each : members)
            chain->add(each.snapshot);
    }
    double smallest() const
    {
        double result = HUGE_VAL;
        for (const Case& each : members)
            result = std::min({result, each.liberty->getAcross(), each.liberty->getAlong()});
        return result;
    }
};

} // namespace

TEST(RegionalLiberties, SetsStayOneToOne)
{
    // The whole set at once: what a place becomes turns nothing over, and comes back.
    double most = 0.0;
    forRandom(fullTest() ? 10000 : 1000,
              [&](const Case& first, Random& random)
              {
                  const Set set(first, random);
                  const double small = set.smallest(), scale = first.frame.getTrans().length() + 5e4;
                  for (const Case& each : set.members)
                  {
                      for (int place = 0; place < 5; ++place)
                      {
                          const Vec3d point = each.random(random, 1.0);
                          EXPECT_GT(determinant(*set.chain, point, 1e-4 * small), 0.0);
                          const Vec3d moved = set.chain->deform(point);
                          most = std::max(most, (moved - point).length() / small);
                          EXPECT_LT((set.chain->undeform(moved) - point).length(),
                                    1e-7 * scale + 1e-8 * 6.4e6 * first.pose.globe);
                      }
                  }
              });
    EXPECT_GT(most, 0.5) << "they move much";
}

TEST(RegionalLiberties, SetsLeaveOtherGroundToTheBit)
{
    forRandom(sampleCount(),
              [](const Case& first, Random& random)
              {
                  const Set set(first, random);
                  for (int place = 0; place < 10; ++place)
                  {
                      const Vec3d point = first.random(random, 4.0);
                      bool outside = true;
                      for (const Case& each : set.members)
                          outside = outside && each.snapshot->reach({point, 1e-7 * point.length()}) ==
                                                   DeformationSnapshot::Reach::Identity;
                      if (outside)
                      {
                          EXPECT_EQ(set.chain->deform(point), point);
                      }
                  }
              });
}

TEST(RegionalLiberties, StayOneToOneBelowAPanoramaMap)
{
    int seen = 0;
    forRandom(fullTest() ? 10000 : 1000,
              [&](const Case& first, Random& random)
              {
                  const Set set(first, random);
                  const osg::ref_ptr<osgGeoFX::PanoramaMap> map = new osgGeoFX::PanoramaMap;
                  map->setViewRadius(random.logarithmic(5e3, 5e4));
                  const osgGeoFX::ViewGeometry view = first.pose.view();
                  const auto projection = map->snapshot(view);
                  if (!projection) return;
                  for (const Case& each : set.members)
                  {
                      for (int place = 0; place < 5; ++place)
                      {
                          const Vec3d point = each.random(random, 1.0);
                          const Vec3d moved = set.chain->deform(point);
                          // Where the map alone is one to one, it is so after the liberties.
                          const double scale =
                              view.modelView.getTrans().length() * 1e-9 + 1e-6 * moved.length() + 0.1;
                          if (!((projection->undeform(projection->deform(moved)) - moved).length() < scale))
                              continue;
                          ++seen;
                          set.chain->add(projection);
                          const Vec3d back = set.chain->undeform(set.chain->deform(point));
                          EXPECT_LT((back - point).length(), 1000.0 * scale);
                          return;
                      }
                  }
              });
    EXPECT_GT(seen, fullTest() ? 1000 : 100);
}

TEST(RegionalLiberties, KeepTheirBounds)
{
    forRandom(sampleCount(),
              [](const Case& found, Random& random)
              {
                  const Ball ball = {found.random(random, 1.5),
                                     random.logarithmic(1e-3, 2.0) * found.liberty->getAcross()};
                  const auto within = [&]
                  {
                      Vec3d way;
                      do
                          way.set(random.uniform(-1.0, 1.0), random.uniform(-1.0, 1.0),
                                  random.uniform(-1.0, 1.0));
                      while (way.length() > 1.0);
                      return ball.center + way * ball.radius;
                  };
                  const Ball bound = found.snapshot->bound(ball);
                  const double most = found.snapshot->lipschitz(ball);
                  const double rounding = 1e-8 * (ball.center.length() + ball.radius);
                  for (int i = 0; i < 10; ++i)
                  {
                      const Vec3d a = within(), b = within();
                      const Vec3d drawnA = found.snapshot->deform(a), drawnB = found.snapshot->deform(b);
                      EXPECT_LE((drawnA - bound.center).length(), bound.radius * (1.0 + 1e-9) + rounding);
                      EXPECT_LE((drawnA - drawnB).length(), most * (a - b).length() + rounding);
                      const double along = random.uniform(0.0, 1.0);
                      const Vec3d image = found.snapshot->deform(a * (1.0 - along) + b * along);
                      const DeformationSnapshot::Sag sag = found.snapshot->sag(ball, b - a);
                      EXPECT_LE((image - (drawnA * (1.0 - along) + drawnB * along)).length(),
                                std::min(sag.curve / 8.0 + sag.kink / 4.0, sag.most) + rounding);
                  }
              });
}

TEST(RegionalLiberties, TurnNormalsWithTheSurface)
{
    forRandom(sampleCount(),
              [](const Case& found, Random& random)
              {
                  const Vec3d point = found.random(random, 0.95);
                  Vec3d normal(random.uniform(-1.0, 1.0), random.uniform(-1.0, 1.0),
                               random.uniform(-1.0, 1.0));
                  if (!(normal.normalize() > 0.1)) return;
                  const Vec3d turned = found.snapshot->deformNormal(point, normal);
                  Vec3d side = normal ^ Vec3d(0.36, 0.48, 0.8);
                  if (!(side.normalize() > 1e-3)) return;
                  const double step = 1e-4 * std::min(found.liberty->getAcross(), found.liberty->getAlong());
                  for (const Vec3d& way : {side, normal ^ side})
                  {
                      Vec3d drawn = found.snapshot->deform(point + way * step) -
                                    found.snapshot->deform(point - way * step);
                      drawn.normalize();
                      // Positions are millions of metres from the eye now and then.
                      EXPECT_LT(std::abs(drawn * turned), 2e-3 + 1e-8 * point.length() / step);
                  }
              });
}

TEST(RegionalLiberties, DoWhatTheirNamesSay)
{
    CameraPose pose;
    pose.height = 3000.0;
    pose.pitch = -0.6;
    const osg::ref_ptr<RegionalLiberty> liberty = new RegionalLiberty;
    liberty->setRadii(4000.0, 4000.0);
    const auto moved = [&](const Vec3d& world)
    {
        const auto snapshot = liberty->snapshot(pose.view());
        if (!snapshot) return world;
        return snapshot->deform(world * pose.modelView()) * osg::Matrixd::inverse(pose.modelView());
    };
    const auto near = [](const Vec3d& a, const Vec3d& b)
    {
        return (a - b).length() < 1e-6;
    };
    EXPECT_FALSE(liberty->snapshot(pose.view()));
    liberty->setEnlarge(2.0);
    liberty->setBaseHeight(500.0);
    EXPECT_TRUE(near(moved({0.0, 0.0, 1500.0}), {0.0, 0.0, 2500.0}));
    EXPECT_TRUE(near(moved({1000.0, 0.0, 500.0}), {1000.0, 0.0, 500.0}));
    liberty->setStrength(0.5);
    EXPECT_TRUE(near(moved({0.0, 0.0, 1500.0}), {0.0, 0.0, 2000.0}));
    liberty->setStrength(1.0);
    liberty->setEnlarge(1.0);
    // Clockwise from above: what is north comes to the east.
    liberty->setTurn(osg::PI_2);
    const Vec3d turned = moved({0.0, 1.0, 0.0});
    EXPECT_NEAR(turned.x(), 1.0, 1e-3);
    liberty->setTurn(0.0);
    // Across a valley that runs to the east.
    liberty->setHeading(osg::PI_2);
    liberty->setWiden(2.0);
    EXPECT_NEAR(moved({0.0, 10.0, 0.0}).y(), 20.0, 0.1);
    EXPECT_NEAR(moved({10.0, 0.0, 0.0}).x(), 10.0, 1e-6);
    liberty->setStrength(0.0);
    EXPECT_FALSE(liberty->isActive());
}

TEST(RegionalLiberties, FollowTheEarth)
{
    // Ground on the ellipsoid stays at its height, wherever it moves to.
    CameraPose pose;
    pose.globe = true;
    pose.x = 0.3;
    pose.y = 0.8;
    pose.height = 20000.0;
    pose.pitch = -1.0;
    const osg::ref_ptr<RegionalLiberty> liberty = new RegionalLiberty;
    liberty->setGeodeticCenter(0.301, 0.801);
    liberty->setRadii(50000.0, 50000.0);
    liberty->setWiden(1.8);
    liberty->setLengthen(0.6);
    liberty->setTurn(1.0);
    const auto snapshot = liberty->snapshot(pose.view());
    const GeographicLib::Geocentric& earth = GeographicLib::Geocentric::WGS84();
    double worst = 0.0, farthest = 0.0;
    for (int i = 0; i < 1000; ++i)
    {
        Random random(static_cast<std::uint64_t>(i));
        Vec3d point;
        earth.Forward(osg::RadiansToDegrees(0.801 + random.uniform(-0.008, 0.008)),
                      osg::RadiansToDegrees(0.301 + random.uniform(-0.011, 0.011)), 800.0, point.x(),
                      point.y(), point.z());
        const Vec3d moved =
            snapshot->deform(point * pose.modelView()) * osg::Matrixd::inverse(pose.modelView());
        double latitude, longitude, height;
        earth.Reverse(moved.x(), moved.y(), moved.z(), latitude, longitude, height);
        worst = std::max(worst, std::abs(height - 800.0));
        farthest = std::max(farthest, (moved - point).length());
    }
    EXPECT_GT(farthest, 10000.0);
    // The ellipsoid's curvature depends on the direction: over 30 km by 0.2 % of the drop.
    EXPECT_LT(worst, 1.0);
}
