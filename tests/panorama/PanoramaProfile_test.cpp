// SPDX-License-Identifier: MIT
// SPDX-FileCopyrightText: 2026 the osgGeoFX authors
// The bending curve of a panorama map through points that a user sets: it passes through them, rises all the way, is level at the
// horizon and smooth, and what culling and picking trust of it holds.
#include <osgGeoFX/effect/detail/EyeVector.h>
#include <osgGeoFX/panorama/PanoramaMap.h>
#include <osgGeoFX/panorama/detail/PanoramaProfile.h>
#include <osgGeoFX/panorama/detail/PanoramaSnapshot.h>
#include <tools/NotifyWatch.h>
#include <tools/RandomViews.h>

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

namespace glsl = osgGeoFX::glsl;
namespace glslf = osgGeoFX::glslf;
using namespace geofx::test;
using osgGeoFX::PanoramaMap;
using osgGeoFX::PanoramaSnapshot;

namespace
{

using Points = std::vector<osg::Vec2d>;

osg::ref_ptr<const PanoramaSnapshot> frameOf(const PanoramaMap& map)
{
    Random random(1);
    CameraPose pose = randomCommonPose(random);
    pose.globe = false;
    pose.lens = CameraPose::PERSPECTIVE;
    pose.height = 5000.0;
    return dynamic_cast<const PanoramaSnapshot*>(map.snapshot(pose.view()).get());
}

/// The picture's y, from 0 at the base to 1 on the horizon line, of ground at a share of the horizon's distance.
double heightAt(const PanoramaMap& map, const glsl::geofx_Panorama& view, double share)
{
    const glm::dvec3 picture = glsl::geofx_panoramaPicture(view, {0.0, share * view.horizon, view.base});
    return (picture.y + 1.0) / (2.0 * map.getHorizonLine());
}

template<class Check>
void forRandomCurves(const Check& check)
{
    for (int sample = 0; sample < sampleCount(); ++sample)
    {
        Random random(static_cast<std::uint64_t>(sample));
        const Points points = randomCurve(random);
        ::testing::Message text;
        text << "sample " << sample << ":";
        for (const osg::Vec2d& point : points)
            text << " (" << point.x() << ", " << point.y() << ")";
        SCOPED_TRACE(text);
        check(points, random);
        if (::testing::Test::HasFailure()) return;
    }
}

glslf::geofx_Profile inFloats(const glsl::geofx_Profile& profile)
{
    glslf::geofx_Profile result{};
    result.first = static_cast<float>(profile.first);
    glm::vec3* const knots[] = {&result.knot1, &result.knot2, &result.knot3,
                                &result.knot4, &result.knot5, &result.knot6};
    const auto all = osgGeoFX::knotsOf(profile);
    for (std::size_t i = 0; i < all.size(); ++i)
        *knots[i] = glm::vec3(osgGeoFX::toGlm(all[i]));
    return result;
}

} // namespace

TEST(PanoramaProfile, PassesThroughItsPointsAndRisesToTheHorizon)
{
    forRandomCurves(
        [](const Points& points, Random& random)
        {
            const osg::ref_ptr<PanoramaMap> map = new PanoramaMap;
            map->setHorizonBend(0.0);
            map->setHorizonLine(random.uniform(0.1, 1.0));
            map->setHorizonDistance(random.uniform(0.5, 12.0));
            ASSERT_TRUE(map->setCurvePoints(points));
            EXPECT_EQ(map->getCurvePoints(), points);
            const auto frame = frameOf(*map);
            ASSERT_TRUE(frame);
            const glsl::geofx_Panorama& view = frame->view();
            EXPECT_NEAR(heightAt(*map, view, 0.0), 0.0, 1e-12);
            EXPECT_NEAR(heightAt(*map, view, 1.0), 1.0, 1e-12);
            EXPECT_NEAR(heightAt(*map, view, 1.2), 1.0, 1e-12);
            for (const osg::Vec2d& point : points)
                EXPECT_NEAR(heightAt(*map, view, point.x()), point.y(), 1e-12);
            double last = -HUGE_VAL;
            for (double share = -0.5; share < 1.1; share += random.uniform(0.0, 0.01))
            {
                const double height = heightAt(*map, view, share);
                EXPECT_GE(height, last - 1e-12) << "at " << share;
                last = height;
            }
            EXPECT_LT(heightAt(*map, view, -0.5), 0.0);
            // Level at the horizon, as no curve that goes on is.
            const double step = 1e-5, left = 1.0 - points.back().x();
            EXPECT_LT(1.0 - heightAt(*map, view, 1.0 - step),
                      6.0 * (1.0 - points.back().y()) * (step / left) * (step / left) + 1e-12);
        });
}

TEST(PanoramaProfile, IsSteffensCubic)
{
    const osg::ref_ptr<PanoramaMap> map = new PanoramaMap;
    map->setHorizonBend(0.0);
    ASSERT_TRUE(map->setCurvePoints({{0.5, 0.5}}));
    // Both ways have a slope of 1: the first is straight, the second Hermite's from a slope of 1 to none.
    const auto even = frameOf(*map);
    EXPECT_NEAR(heightAt(*map, even->view(), -0.1), -0.1, 1e-12);
    EXPECT_NEAR(heightAt(*map, even->view(), 0.2), 0.2, 1e-12);
    EXPECT_NEAR(heightAt(*map, even->view(), 0.75), 0.5 * 0.5 + 0.5 * 1.0 + 0.5 * 0.125, 1e-12);
    // Slopes of 3 and 1/3 on ways of 1/4 and 3/4: at the point twice the less, at the base 3 + (3 - 1/3) / 4.
    ASSERT_TRUE(map->setCurvePoints({{0.25, 0.75}}));
    const auto steep = frameOf(*map);
    const double first = 3.0 + (3.0 - 1.0 / 3.0) / 4.0, second = 2.0 / 3.0;
    EXPECT_NEAR(heightAt(*map, steep->view(), 0.125), 0.375 + 0.25 * (first - second) / 8.0, 1e-12);
    EXPECT_NEAR(glsl::geofx_panoramaSlope(steep->view(), 0.25 * steep->view().horizon), second, 1e-12);
    EXPECT_NEAR(glsl::geofx_panoramaSlope(steep->view(), -1.0), first, 1e-12);
}

TEST(PanoramaProfile, HasTheSlopeThatItsHeightsTell)
{
    forRandomCurves(
        [](const Points& points, Random& random)
        {
            const glsl::geofx_Profile profile = osgGeoFX::profileThrough(points);
            const double steepest = osgGeoFX::ratesOf(profile, -1.0, 2.0).second;
            for (int i = 0; i < 20; ++i)
            {
                const double u = random.uniform(-0.2, 1.2);
                const double step = 1e-6;
                const double slope = glsl::geofx_profileSlope(profile, u);
                const double measured = (glsl::geofx_profileRise(profile, u + step) -
                                         glsl::geofx_profileRise(profile, u - step)) /
                                        (2.0 * step);
                EXPECT_NEAR(slope, measured, 1e-8 + steepest * step) << "at " << u;
                EXPECT_GE(slope, 0.0);
            }
            // No kinks at the points.
            for (const osg::Vec2d& point : points)
                EXPECT_NEAR(glsl::geofx_profileSlope(profile, point.x() - 1e-9),
                            glsl::geofx_profileSlope(profile, point.x() + 1e-9), 1e-8 * (1.0 + steepest));
        });
}

TEST(PanoramaProfile, BoundsHoldItsDerivatives)
{
    double tight = 0.0;
    int count = 0;
    forRandomCurves(
        [&](const Points& points, Random& random)
        {
            const glsl::geofx_Profile profile = osgGeoFX::profileThrough(points);
            const double from = random.uniform(-0.3, 1.1), to = from + random.logarithmic(1e-3, 1.5);
            const osgGeoFX::ProfileRates rates = osgGeoFX::ratesOf(profile, from, to);
            double slope = 0.0, second = 0.0;
            constexpr int steps = 400;
            const double step = (to - from) / steps;
            for (int i = 0; i < steps; ++i)
            {
                const double here = glsl::geofx_profileSlope(profile, from + i * step);
                slope = std::max(slope, here);
                second = std::max(
                    second, std::abs(glsl::geofx_profileSlope(profile, from + (i + 1) * step) - here) / step);
            }
            EXPECT_LE(slope, rates.slope * (1.0 + 1e-9));
            EXPECT_LE(second, rates.second * (1.0 + 1e-6) + 1e-6);
            if (!(rates.slope > 0.01 && to - from < 0.2)) return;
            tight += slope / rates.slope;
            ++count;
        });
    RecordProperty("tight", std::to_string(tight / count));
    EXPECT_GT(tight / count, 0.99) << "the bound of the slope is that of another interval";
}

TEST(PanoramaProfile, IsUndoneByItsInverse)
{
    forRandomCurves(
        [](const Points& points, Random& random)
        {
            const glsl::geofx_Profile profile = osgGeoFX::profileThrough(points);
            const glslf::geofx_Profile narrow = inFloats(profile);
            for (int i = 0; i < 20; ++i)
            {
                const double u = random.uniform(-0.5, 0.999);
                const double height = glsl::geofx_profileRise(profile, u);
                const double found = glsl::geofx_profileDistance(profile, height);
                EXPECT_NEAR(glsl::geofx_profileRise(profile, found), height, 1e-9) << "at " << u;
                // The place itself, where the curve is not nearly level.
                if (glsl::geofx_profileSlope(profile, u) > 0.05)
                {
                    EXPECT_NEAR(found, u, 1e-10);
                }
                // As the GPU does it.
                const auto low = static_cast<float>(height);
                EXPECT_NEAR(static_cast<double>(glslf::geofx_profileRise(narrow, static_cast<float>(u))),
                            height, 3e-6 * (1.0 + std::abs(height)))
                    << "at " << u;
                EXPECT_NEAR(static_cast<double>(
                                glslf::geofx_profileRise(narrow, glslf::geofx_profileDistance(narrow, low))),
                            height, 3e-6 * (1.0 + std::abs(height)))
                    << "at " << u;
            }
        });
}

TEST(PanoramaProfile, WithoutPointsTheCurveIsThePapersToTheBit)
{
    for (int sample = 0; sample < sampleCount(); ++sample)
    {
        Random random(static_cast<std::uint64_t>(sample));
        const osg::ref_ptr<PanoramaMap> map = new PanoramaMap;
        map->setHorizonDistance(random.uniform(0.5, 12.0));
        map->setCurveDistance(random.uniform(0.0, 0.9) * map->getHorizonDistance());
        ASSERT_TRUE(map->setCurvePoints(randomCurve(random)));
        ASSERT_TRUE(map->setCurvePoints({}));
        EXPECT_TRUE(map->getCurvePoints().empty());
        const auto frame = frameOf(*map);
        const glsl::geofx_Panorama& view = frame->view();
        const double s = random.uniform(-0.5, 1.5) * view.horizon;
        const double width = view.horizon - view.curve;
        const double bent = std::clamp(s - view.curve, 0.0, width);
        EXPECT_EQ(glsl::geofx_panoramaRise(view, s),
                  std::min(s, view.curve) + bent - bent * bent / (2.0 * width));
        EXPECT_EQ(glsl::geofx_panoramaSlope(view, s), std::clamp((view.horizon - s) / width, 0.0, 1.0));
        EXPECT_EQ(view.along, 4.0 * map->getHorizonLine() / (view.curve + view.horizon));
    }
}

TEST(PanoramaProfile, RefusesPointsInDisorderWithASentence)
{
    const osg::ref_ptr<PanoramaMap> map = new PanoramaMap;
    const Points good = {{0.3, 0.5}, {0.6, 0.8}};
    ASSERT_TRUE(map->setCurvePoints(good));
    const std::pair<Points, const char*> wrong[] = {
        {{{0.6, 0.5}, {0.3, 0.8}}, "must increase"},
        {{{0.3, 0.5}, {0.3, 0.8}}, "must increase"},
        {{{0.3, 0.5}, {0.3005, 0.8}}, "must increase"},
        {{{0.3, 0.5}, {0.9995, 0.8}}, "at most 0.999"},
        {{{0.0005, 0.5}}, "must increase"},
        {{{0.3, 0.8}, {0.6, 0.5}}, "must not decrease"},
        {{{0.3, 0.0005}}, "at least 0.001"},
        {{{0.3, 0.0}}, "above 0"},
        {{{-0.3, 0.2}}, "above 0"},
        {{{0.3, 1.2}}, "curve1Height"},
        {{{0.3, std::nan("")}}, "above 0"},
        {Points(7, osg::Vec2d(0.5, 0.5)), "at most 6"},
    };
    NotifyWatch watch;
    for (const auto& [points, sentence] : wrong)
    {
        const auto said = watch.messagesOf([&, &each = points] { EXPECT_FALSE(map->setCurvePoints(each)); });
        ASSERT_EQ(said.size(), 1u) << sentence;
        EXPECT_NE(said[0].find(sentence), std::string::npos) << said[0];
        EXPECT_EQ(map->getCurvePoints(), good);
    }
    // One after the other, in any order, and with gaps; a point without a height does not count.
    std::string error;
    ASSERT_TRUE(map->setCurvePoints({}));
    EXPECT_TRUE(map->setProperty("curve4Distance", 0.7, error)) << error;
    EXPECT_TRUE(map->getCurvePoints().empty());
    EXPECT_TRUE(map->setProperty("curve4Height", 0.6, error)) << error;
    EXPECT_TRUE(map->setPropertyTexts({{"curve2Height", "0.2"}, {"curve2Distance", "0.5"}}, error)) << error;
    EXPECT_EQ(map->getCurvePoints(), (Points{{0.5, 0.2}, {0.7, 0.6}}));
    EXPECT_FALSE(map->setProperty("curve2Distance", 0.8, error));
    EXPECT_NE(error.find("PanoramaMap: the distances of the curve's points"), std::string::npos) << error;
    EXPECT_FALSE(map->setProperty("curve2Height", 0.61, error));
    EXPECT_NE(error.find("must not decrease"), std::string::npos) << error;
}
