// SPDX-License-Identifier: MIT
// SPDX-FileCopyrightText: 2026 the osgGeoFX authors
//
// Cylindrical panorama maps before any camera: azimuths and distances of what they show are those of trigonometry, the parts of
// a picture agree with the whole, and bounds hold over the seam and below the eye, too.
#include <osgGeoFX/effect/detail/EyeVector.h>
#include <osgGeoFX/panorama/PanoramaMap.h>
#include <osgGeoFX/panorama/detail/PanoramaSnapshot.h>
#include <tools/RandomViews.h>

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <optional>

using namespace geofx::test;
using namespace osgGeoFX;
using osg::Vec3d;

namespace
{

/// A cylindrical map before a camera, or before one that draws a column of the picture.
struct Case
{
    CameraPose pose;
    osg::ref_ptr<PanoramaMap> map = new PanoramaMap;
    double low = -1.0, high = 1.0; ///< the column, of the picture's x
    osg::ref_ptr<const PanoramaSnapshot> frame;

    explicit Case(Random& random)
    {
        do
        {
            pose = randomCommonPose(random);
            pose.roll = 0.0;
            map->setHorizontalAngle(random.integer(0, 2) ? random.uniform(0.1, 2.0 * osg::PI)
                                                         : 2.0 * osg::PI);
            map->setHorizonDistance(random.uniform(0.5, 8.0));
            map->setCurveDistance(random.uniform(0.0, 0.9) * map->getHorizonDistance());
            map->setHorizonBend(random.integer(0, 1) ? 0.0 : random.uniform(0.0, 0.2));
            map->setExaggeration(random.logarithmic(0.1, 8.0));
            map->setBaseFromTerrain(false);
            map->setBaseHeight(random.uniform(-200.0, 800.0));
            if (random.integer(0, 1)) map->setViewRadius(random.logarithmic(500.0, 8e4));
            if (random.integer(0, 1))
            {
                low = random.uniform(-1.0, 0.8);
                high = random.uniform(low + 0.1, std::min(1.0, low + 1.0));
            }
            update();
        } while (!frame || (pose.globe && reach() > 1e6));
    }

    ViewGeometry view() const
    {
        ViewGeometry result = pose.view();
        if (low > -1.0 || high < 1.0)
            result.setImage(pose.modelView(), pose.projection() *
                                                  osg::Matrixd::translate(-0.5 * (low + high), 0.0, 0.0) *
                                                  osg::Matrixd::scale(2.0 / (high - low), 1.0, 1.0));
        return result;
    }
    void update() { frame = dynamic_cast<const PanoramaSnapshot*>(map->snapshot(view()).get()); }
    const glsl::geofx_Panorama& panorama() const { return frame->view(); }
    double radius() const { return 1.0 / panorama().across; }
    /// Of the circle that is the picture's base.
    double ring() const { return 2.0 * radius() / map->getHorizontalAngle(); }
    double reach() const { return ring() + panorama().end; }
    /// Half of the column, of the picture's x. One camera leaves a gap opposite of what it draws.
    double halfColumn() const
    {
        return std::min(0.5 * (high - low), 0.95 * 2.0 * osg::PI / map->getHorizontalAngle());
    }
    /// The x of a place that is drawn.
    double randomX(Random& random) const
    {
        return 0.5 * (low + high) + 0.99 * halfColumn() * random.uniform(-1.0, 1.0);
    }

    /// On a plane: by a way from the eye's foot. On the globe: with the same way as an arc, on the ellipsoid's sphere.
    Vec3d at(double azimuth, double away, double height) const
    {
        const Vec3d right = toOsg(panorama().right), forward = toOsg(panorama().forward);
        const Vec3d direction = right * std::sin(azimuth) + forward * std::cos(azimuth);
        const Vec3d up = toOsg(panorama().globe.up);
        const double k = panorama().globe.curvature;
        if (!(k > 0.0)) return direction * away + up * (height - panorama().globe.height);
        const double earth = 1.0 / k;
        return up * (-panorama().globe.height - earth) +
               (up * std::cos(away * k) + direction * std::sin(away * k)) * (earth + height);
    }
    Vec3d seen(const Vec3d& position) const { return frame->deform(position) * pose.projection(); }
    double scaleOf(const Vec3d& point) const
    {
        return point.length() + frame->deform(point).length() + std::abs(panorama().globe.height) + reach();
    }
    /// Anywhere on the ground, at the seam and below the eye more often than elsewhere.
    Vec3d anywhere(Random& random) const
    {
        const double away = random.integer(0, 2) ? random.uniform(0.0, 1.2) * reach()
                                                 : random.logarithmic(1e-3, 1.0) * ring();
        double azimuth = random.uniform(-osg::PI, osg::PI);
        const double middle = 0.25 * map->getHorizontalAngle() * (low + high);
        if (random.integer(0, 2) == 0) azimuth = middle + osg::PI + random.uniform(-0.3, 0.3);
        return at(azimuth, away, random.uniform(-200.0, 4000.0));
    }
};

template<class Check>
void forSample(int sample, const Check& check)
{
    Random random(static_cast<std::uint64_t>(sample));
    const Case found(random);
    SCOPED_TRACE(::testing::Message()
                 << sample << ": " << describe(*found.map) << "; " << found.pose << "; column " << found.low
                 << " to " << found.high << "; radius " << found.radius());
    check(found, random);
}

template<class Check>
void forRandom(int samples, const Check& check)
{
    for (int sample = 0; sample < samples && !::testing::Test::HasFailure(); ++sample)
        forSample(sample, check);
}

} // namespace

TEST(PanoramaCylinder, ShowsAzimuthsAcrossAndDistancesUpwards)
{
    forRandom(sampleCount(),
              [](const Case& found, Random& random)
              {
                  // On the globe the test's sphere is not the ellipsoid.
                  const double exact = found.pose.globe ? 4e-3 : 1e-9;
                  const double angle = found.map->getHorizontalAngle();
                  const double bend = 2.0 * found.map->getHorizonBend();
                  const double x = found.randomX(random);
                  const double azimuth = 0.5 * angle * x;
                  const double arch = bend * (1.0 - std::cos(x * osg::PI_2));
                  const double base = found.map->getBaseHeight();
                  // Its ground is higher or lower by a share of the sagitta, which the exaggeration enlarges.
                  const auto exactUpwards = [&](double away)
                  {
                      const double sagitta = found.pose.globe ? 0.5 * away * away / 6.37e6 : 0.0;
                      return 4.0 * exact + 0.0067 * sagitta * found.map->getExaggeration() / found.radius();
                  };
                  const Vec3d foot = found.seen(found.at(azimuth, found.ring(), base));
                  EXPECT_NEAR(foot.x(), x, exact);
                  EXPECT_NEAR(foot.y(), -1.0 - arch, exactUpwards(found.ring()));
                  const double d2 = found.map->getHorizonDistance() * found.radius();
                  const Vec3d horizon = found.seen(found.at(azimuth, found.ring() + d2, base));
                  EXPECT_NEAR(horizon.x(), x, exact);
                  EXPECT_NEAR(horizon.y(), 2.0 * found.map->getHorizonLine() - 1.0 - arch,
                              exactUpwards(found.ring() + d2));
              });
}

TEST(PanoramaCylinder, HeightsKeepTheirRatioToWidthsAtAnyDistance)
{
    forRandom(sampleCount(),
              [](const Case& found, Random& random)
              {
                  if (found.pose.globe) return; // verticals spread there
                  const double away = found.ring() + random.uniform(0.0, 1.0) * found.panorama().horizon;
                  const double azimuth = 0.5 * found.map->getHorizontalAngle() * found.randomX(random);
                  const double height = random.uniform(100.0, 3000.0);
                  const double base = found.map->getBaseHeight();
                  const Vec3d foot = found.seen(found.at(azimuth, away, base));
                  const Vec3d tip = found.seen(found.at(azimuth, away, base + height));
                  // As wide as an arc of so many metres around the eye, in pixels.
                  const double wide = height / away / (0.5 * found.map->getHorizontalAngle());
                  const osg::Matrixd projection = found.pose.projection();
                  const double aspect = projection(1, 1) / projection(0, 0);
                  EXPECT_NEAR(tip.y() - foot.y(), found.map->getExaggeration() * wide * aspect,
                              1e-9 * (1.0 + std::abs(tip.y())));
                  EXPECT_NEAR(tip.x(), foot.x(), 1e-9);
              });
}

TEST(PanoramaCylinder, IsUndoneByItsInverse)
{
    forRandom(sampleCount(),
              [](const Case& found, Random& random)
              {
                  const double azimuth = 0.5 * found.map->getHorizontalAngle() * found.randomX(random);
                  const double away =
                      random.uniform(0.75 * found.ring(), found.ring() + found.panorama().horizon);
                  const Vec3d point = found.at(azimuth, away, random.uniform(-200.0, 4000.0));
                  const Vec3d back = found.frame->undeform(found.frame->deform(point));
                  EXPECT_LT((back - point).length(), 1e-8 * found.scaleOf(point));
              });
}

TEST(PanoramaCylinder, PartsOfAPictureAgreeWithTheWhole)
{
    forRandom(sampleCount(),
              [](const Case& found, Random& random)
              {
                  Case other = found;
                  other.low = std::max(-1.0, found.low - random.uniform(0.0, 0.2));
                  other.high = std::min(1.0, other.low + random.uniform(0.3, 1.0));
                  other.update();
                  const double from = std::max(found.low, other.low), to = std::min(found.high, other.high);
                  if (!(from < to)) return;
                  const double azimuth = 0.5 * found.map->getHorizontalAngle() * random.uniform(from, to);
                  // One camera does not reach the seam of a whole turn.
                  if (std::abs(azimuth) > 0.94 * osg::PI && found.high - found.low > 1.8) return;
                  const Vec3d point = found.at(azimuth, random.uniform(0.8, 3.0) * found.ring(), 500.0);
                  EXPECT_LT((found.frame->deform(point) - other.frame->deform(point)).length(),
                            1e-9 * found.scaleOf(point));
              });
}

TEST(PanoramaCylinder, BallsHoldWhereverTheyLie)
{
    const auto holds = [](const Case& found, Random& random)
    {
        const Ball ball = {found.anywhere(random), random.logarithmic(1e-3, 1.0) * found.ring()};
        const double grows = found.frame->lipschitz(ball);
        for (int i = 0; i < 20; ++i)
        {
            const Vec3d a = ball.center + randomDirection(random) * (ball.radius * random.uniform(0.0, 1.0));
            const Vec3d b =
                random.integer(0, 1) ? ball.center : a + randomDirection(random) * (1e-3 * ball.radius);
            if ((b - ball.center).length() > ball.radius) continue;
            const double apart = (found.frame->deform(a) - found.frame->deform(b)).length();
            EXPECT_LE(apart, grows * (a - b).length() * (1.0 + 1e-6) + 1e-9 * found.scaleOf(a))
                << "radius " << ball.radius << ", grows by " << apart / (a - b).length() << " instead of "
                << grows;
        }
    };
    // A narrow column far to the left: what is kept out of it goes a long way to its middle.
    forSample(45533, holds);
    forRandom(sampleCount(), holds);
}

TEST(PanoramaCylinder, EdgesSagNoMoreThanTheySay)
{
    forRandom(sampleCount(),
              [](const Case& found, Random& random)
              {
                  const Vec3d a = found.anywhere(random);
                  const Vec3d b =
                      a + randomDirection(random) * (random.logarithmic(1e-3, 0.5) * found.ring());
                  const Ball ball = {(a + b) * 0.5, (b - a).length() * 0.5};
                  const DeformationSnapshot::Sag sag = found.frame->sag(ball, b - a);
                  const double most = std::min(sag.curve / 8.0 + sag.kink / 4.0, sag.most);
                  for (int i = 1; i < 16; ++i)
                  {
                      const double t = i / 16.0;
                      const Vec3d straight = found.frame->deform(a) * (1.0 - t) + found.frame->deform(b) * t;
                      const Vec3d bent = found.frame->deform(a * (1.0 - t) + b * t);
                      EXPECT_LE((bent - straight).length(), most * (1.0 + 1e-6) + 1e-9 * found.scaleOf(a));
                  }
              });
}

TEST(PanoramaCylinder, HidesNothingThatItsPartShows)
{
    int hidden = 0;
    forRandom(sampleCount(),
              [&](const Case& found, Random& random)
              {
                  EyeBox box;
                  box.center = found.anywhere(random);
                  const double size = random.logarithmic(1e-3, 0.5) * found.ring();
                  for (Vec3d& half : box.half)
                      half = randomDirection(random) * size;
                  const osg::Vec2d room(random.uniform(0.0, 0.05), 0.0);
                  if (!found.frame->hidesBox(box, room)) return;
                  ++hidden;
                  // All of it lies beyond one border of the picture, or around the circle from what the part shows.
                  const double middle = 0.5 * (found.low + found.high);
                  bool beside = true, under = true, over = true, gone = true, below = true;
                  for (int i = 0; i < 40; ++i)
                  {
                      Vec3d point = box.center;
                      for (const Vec3d& half : box.half)
                          point += half * random.uniform(-1.0, 1.0);
                      const glm::dvec3 place = glsl::geofx_panoramaPlace(found.panorama(), toGlm(point));
                      const glm::dvec3 picture = glsl::geofx_panoramaPicture(found.panorama(), place);
                      const double x = place.x * found.panorama().across;
                      beside = beside && std::abs(x - middle) > found.halfColumn() + room.x() - 1e-9;
                      under = under && picture.y < -1.0;
                      over = over && picture.y > 1.0;
                      gone = gone && place.y > found.panorama().end;
                      below = below && picture.z < 1e-9 * found.panorama().nearest;
                  }
                  EXPECT_TRUE(beside || under || over || gone || below);
              });
    EXPECT_GT(hidden, sampleCount() / 20);
}

TEST(PanoramaCylinder, NothingJumpsAtTheSeamOrBelowTheEye)
{
    forRandom(sampleCount(),
              [](const Case& found, Random& random)
              {
                  const double middle = 0.25 * found.map->getHorizontalAngle() * (found.low + found.high);
                  const double away = random.logarithmic(1e-4, 3.0) * found.ring();
                  const double step = 1e-9;
                  const Vec3d a = found.at(middle + osg::PI - step, away, 300.0);
                  const Vec3d b = found.at(middle + osg::PI + step, away, 300.0);
                  EXPECT_LT((found.frame->deform(a) - found.frame->deform(b)).length(), 1e-4 * found.reach());
                  const Vec3d c = found.at(random.uniform(-osg::PI, osg::PI), 1e-9 * found.ring(), 300.0);
                  const Vec3d d = found.at(random.uniform(-osg::PI, osg::PI), 1e-9 * found.ring(), 300.0);
                  EXPECT_LT((found.frame->deform(c) - found.frame->deform(d)).length(), 1e-4 * found.reach());
              });
}

TEST(PanoramaCylinder, AWholeTurnNeedsTwoCamerasAndStrengthOne)
{
    const osg::ref_ptr<PanoramaMap> map = new PanoramaMap;
    EXPECT_EQ(map->leastParts(), 1u);
    EXPECT_TRUE(map->setHorizontalAngle(osg::PI));
    EXPECT_EQ(map->leastParts(), 1u);
    EXPECT_TRUE(map->setHorizontalAngle(2.0 * osg::PI));
    EXPECT_EQ(map->leastParts(), 2u);
    std::string error;
    EXPECT_FALSE(map->setProperty("strength", 0.5, error));
    EXPECT_NE(error.find("horizontalAngle"), std::string::npos) << error;
    EXPECT_EQ(map->getStrength(), 1.0);
    EXPECT_TRUE(map->setStrength(0.0));
    EXPECT_TRUE(map->setStrength(1.0));
    EXPECT_TRUE(map->setProjection(false));
    EXPECT_EQ(map->leastParts(), 1u);
}

TEST(PanoramaCylinder, OneCameraSaysThatAWholeTurnHasAGap)
{
    Random random(1);
    Case found(random);
    found.map->setHorizontalAngle(2.0 * osg::PI);
    const auto complains = [&](double low, double high)
    {
        found.low = low;
        found.high = high;
        found.update();
        EyeBox box;
        box.center = found.at(0.25 * 2.0 * osg::PI * (low + high) + osg::PI, 2.0 * found.ring(), 0.0);
        box.half[0] = box.half[1] = box.half[2] = Vec3d(1.0, 1.0, 1.0);
        return found.frame->complaint(box).find("drawInParts") != std::string::npos;
    };
    EXPECT_TRUE(complains(-1.0, 1.0));
    EXPECT_FALSE(complains(-1.0, 0.0));
    EXPECT_FALSE(complains(0.0, 1.0));
}
