// SPDX-License-Identifier: MIT
// SPDX-FileCopyrightText: 2026 the osgGeoFX authors
// The deformation profile (shaders/lib/bend.glsl) as C++: what must hold for any bend, on random ones.
#include <osgGeoFX/effect/GlslFunctions.h>
#include <tools/RandomSamples.h>

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <ostream>

namespace glsl = osgGeoFX::glsl;
namespace glslf = osgGeoFX::glslf;
using geofx::test::Random;
using glm::dvec2;

namespace
{

constexpr double pi = 3.14159265358979323846;
constexpr int curves[] = {glsl::GEOFX_CURVE_BEZIER, glsl::GEOFX_CURVE_ARC_LENGTH,
                          glsl::GEOFX_CURVE_CIRCULAR_ARC};

glsl::geofx_Bend randomBend(Random& random)
{
    const int curve = curves[random.integer(0, 2)];
    const double size = random.logarithmic(1.0, 1e5);
    // Every fourth is nearly straight, where formulas with 1 - cos(beta) or d/beta lose their digits.
    const double angle = random.integer(0, 3) ? random.uniform(0.0, pi / 2) : random.logarithmic(1e-9, 1e-2);
    return glsl::geofx_makeBend(curve, size, random.sign() * angle);
}

/// A height within `margin` of the fold on the inner side, and of any size on the outer.
double randomHeight(Random& random, const glsl::geofx_Bend& bend, double margin)
{
    const double limit = std::min(margin / std::abs(glsl::geofx_bendCurvature(bend)), 10 * bend.size);
    const double inner = bend.angle > 0 ? 1.0 : -1.0;
    return inner * random.uniform(-3 * limit, limit);
}

dvec2 randomPoint(Random& random, const glsl::geofx_Bend& bend, double margin)
{
    return {random.uniform(-2.0, 3.0) * bend.size, randomHeight(random, bend, margin)};
}

/// What rounding errors are relative to.
double scaleOf(const glsl::geofx_Bend& bend, const dvec2& point)
{
    return bend.size + std::abs(point.x) + std::abs(point.y);
}

/// For each random bend; says which sample failed.
template<class Check>
void forRandomBends(const Check& check)
{
    for (int sample = 0; sample < geofx::test::sampleCount(); ++sample)
    {
        Random random(static_cast<std::uint64_t>(sample));
        const glsl::geofx_Bend bend = randomBend(random);
        SCOPED_TRACE(::testing::Message() << "sample " << sample << ": curve " << bend.curve << ", d "
                                          << bend.size << ", beta " << bend.angle);
        check(bend, random);
        if (::testing::Test::HasFailure())
        {
            return;
        }
    }
}

/// Derivative of the deformation along s by central differences.
dvec2 slopeAlongS(const glsl::geofx_Bend& bend, const dvec2& point)
{
    const dvec2 step(1e-5 * bend.size, 0.0);
    return (glsl::geofx_bend(bend, point + step) - glsl::geofx_bend(bend, point - step)) / (2.0 * step.x);
}

} // namespace

TEST(Bend, DoesNotMoveTheFocus)
{
    forRandomBends(
        [](const glsl::geofx_Bend& bend, Random& random)
        {
            const dvec2 point(random.uniform(-10.0, 0.0) * bend.size, random.uniform(-1.0, 1.0) * bend.size);
            EXPECT_EQ(glsl::geofx_bend(bend, point), point);
            EXPECT_EQ(glsl::geofx_unbend(bend, point), point);
        });
}

TEST(Bend, TurnsTheContextRigidly)
{
    forRandomBends(
        [](const glsl::geofx_Bend& bend, Random& random)
        {
            const dvec2 a(random.uniform(1.0, 10.0) * bend.size, random.uniform(-1.0, 1.0) * bend.size);
            const dvec2 b(random.uniform(1.0, 10.0) * bend.size, random.uniform(-1.0, 1.0) * bend.size);
            const dvec2 before = b - a;
            const dvec2 after = glsl::geofx_bend(bend, b) - glsl::geofx_bend(bend, a);
            const dvec2 turned(std::cos(bend.angle) * before.x - std::sin(bend.angle) * before.y,
                               std::sin(bend.angle) * before.x + std::cos(bend.angle) * before.y);
            EXPECT_LT(glm::length(after - turned), 1e-13 * bend.size);
            if (bend.curve != glsl::GEOFX_CURVE_CIRCULAR_ARC)
            {
                // About r, the middle of the zone, as the paper has it.
                const dvec2 axis(bend.size / 2, 0.0);
                const double distance = glm::length(a - axis);
                EXPECT_NEAR(glm::length(glsl::geofx_bend(bend, a) - axis), distance, 1e-13 * bend.size);
            }
        });
}

TEST(Bend, IsTheDeCasteljauConstructionOfThePaper)
{
    forRandomBends(
        [](const glsl::geofx_Bend& anyBend, Random& random)
        {
            const glsl::geofx_Bend bend =
                glsl::geofx_makeBend(glsl::GEOFX_CURVE_BEZIER, anyBend.size, anyBend.angle);
            const double t = random.uniform(0.0, 1.0);
            const double d = bend.size;
            const double beta = bend.angle;
            const double h = randomHeight(random, bend, 0.99);
            const dvec2 rb(t * d / 2, 0.0);
            const dvec2 re(d / 2 * (1 + t * std::cos(beta)), d / 2 * t * std::sin(beta));
            const dvec2 tangent = glm::normalize(re - rb);
            const dvec2 expected = rb + t * (re - rb) + h * dvec2(-tangent.y, tangent.x);
            const dvec2 point(t * d, h);
            EXPECT_LT(glm::length(glsl::geofx_bend(bend, point) - expected), 1e-13 * scaleOf(bend, point));
        });
}

TEST(Bend, IsContinuousWithItsFrameAtBothEnds)
{
    forRandomBends(
        [](const glsl::geofx_Bend& bend, Random& random)
        {
            const double h = randomHeight(random, bend, 0.99);
            for (const double end : {0.0, bend.size})
            {
                const double step = 1e-12 * bend.size;
                const dvec2 before(end - step, h);
                const dvec2 after(end + step, h);
                EXPECT_LT(glm::length(glsl::geofx_bend(bend, after) - glsl::geofx_bend(bend, before)),
                          1e-10 * scaleOf(bend, after));
                const glsl::geofx_BendFrame frameBefore = glsl::geofx_bendFrame(bend, before.x);
                const glsl::geofx_BendFrame frameAfter = glsl::geofx_bendFrame(bend, after.x);
                EXPECT_LT(glm::length(frameAfter.tangent - frameBefore.tangent), 1e-10);
                if (bend.curve != glsl::GEOFX_CURVE_ARC_LENGTH)
                {
                    EXPECT_NEAR(frameAfter.speed, frameBefore.speed, 1e-10);
                }
            }
        });
}

TEST(Bend, FrameIsTheDerivative)
{
    forRandomBends(
        [](const glsl::geofx_Bend& bend, Random& random)
        {
            // Away from the ends, which central differences must not cross.
            const dvec2 point(random.uniform(0.001, 0.999) * bend.size, randomHeight(random, bend, 0.99));
            const glsl::geofx_BendFrame frame = glsl::geofx_bendFrame(bend, point.x);
            EXPECT_NEAR(glm::length(frame.tangent), 1.0, 1e-14);
            EXPECT_LT(glm::length(slopeAlongS(bend, {point.x, 0.0}) - frame.speed * frame.tangent), 1e-8);
            // Orientation is kept: the determinant is positive before the fold, and is the stretch.
            const double stretch = glsl::geofx_bendStretch(frame, point.y);
            EXPECT_GT(stretch, 0.0);
            EXPECT_LT(glm::length(slopeAlongS(bend, point) - stretch * frame.tangent),
                      1e-8 * (1.0 + std::abs(point.y) / bend.size));
            const dvec2 up = glsl::geofx_bend(bend, point + dvec2(0.0, 0.1 * bend.size));
            EXPECT_LT(glm::length(up - glsl::geofx_bend(bend, point) -
                                  0.1 * bend.size * glsl::geofx_bendTurn(frame, {0.0, 1.0})),
                      1e-13 * scaleOf(bend, point));
        });
}

TEST(Bend, ExactNormalStandsOnTheDeformedSurface)
{
    forRandomBends(
        [](const glsl::geofx_Bend& bend, Random& random)
        {
            const dvec2 point(random.uniform(0.0, 1.0) * bend.size, randomHeight(random, bend, 0.9));
            const double slope = random.uniform(-3.0, 3.0);
            const glsl::geofx_BendFrame frame = glsl::geofx_bendFrame(bend, point.x);
            const double stretch = glsl::geofx_bendStretch(frame, point.y);
            const dvec2 surface = glsl::geofx_bendTurn(frame, {stretch, slope});
            const dvec2 normal = glsl::geofx_bendTurn(frame, {-slope / stretch, 1.0});
            EXPECT_NEAR(glm::dot(glm::normalize(surface), glm::normalize(normal)), 0.0, 1e-13);
        });
}

TEST(Bend, InverseUndoesIt)
{
    forRandomBends(
        [](const glsl::geofx_Bend& bend, Random& random)
        {
            // A margin of 1 % to the fold costs two digits.
            const dvec2 point = randomPoint(random, bend, 0.99);
            const dvec2 back = glsl::geofx_unbend(bend, glsl::geofx_bend(bend, point));
            EXPECT_LT(glm::length(back - point), 1e-12 * scaleOf(bend, point));
        });
}

TEST(Bend, InverseStaysFiniteBeyondTheFold)
{
    forRandomBends(
        [](const glsl::geofx_Bend& bend, Random& random)
        {
            const dvec2 anywhere(random.uniform(-100.0, 100.0) * bend.size,
                                 random.uniform(-100.0, 100.0) * bend.size);
            const dvec2 back = glsl::geofx_unbend(bend, anywhere);
            EXPECT_TRUE(std::isfinite(back.x) && std::isfinite(back.y)) << anywhere.x << ", " << anywhere.y;
            // In the zone if the place is between the borders, else rigidly before or behind it.
            EXPECT_LT(std::abs(back.x), 1000 * bend.size) << anywhere.x << ", " << anywhere.y;
        });
}

TEST(Bend, InverseConvergesNextToTheFold)
{
    // Slowest where the curvature is largest: the middle of the paper's curve at a right angle.
    for (const double sign : {-1.0, 1.0})
    {
        const glsl::geofx_Bend bend = glsl::geofx_makeBend(glsl::GEOFX_CURVE_BEZIER, 1.0, sign * pi / 2);
        const double h = 0.99 / glsl::geofx_bendCurvature(bend);
        for (int i = -5000; i <= 5000; ++i)
        {
            const dvec2 point(0.5 + i * 1e-4, h);
            const dvec2 back = glsl::geofx_unbend(bend, glsl::geofx_bend(bend, point));
            ASSERT_LT(glm::length(back - point), 1e-13) << point.x;
        }
    }
}

TEST(Bend, ArcLengthTakesEqualGroundToEqualCurve)
{
    forRandomBends(
        [](const glsl::geofx_Bend& anyBend, Random& random)
        {
            const glsl::geofx_Bend bend =
                glsl::geofx_makeBend(glsl::GEOFX_CURVE_ARC_LENGTH, anyBend.size, anyBend.angle);
            const double s = random.uniform(0.001, 0.999) * bend.size;
            const double speed = glm::length(slopeAlongS(bend, {s, 0.0}));
            EXPECT_NEAR(speed, glsl::geofx_bendFrame(bend, bend.size / 2).speed, 1e-9);
            EXPECT_NEAR(speed, glsl::geofx_bendFrame(bend, s).speed, 1e-9);
            // The same curve as the paper's: its middle is where the paper's is.
            const glsl::geofx_Bend bezier =
                glsl::geofx_makeBend(glsl::GEOFX_CURVE_BEZIER, anyBend.size, anyBend.angle);
            const dvec2 middle(bend.size / 2, 0.0);
            EXPECT_LT(glm::length(glsl::geofx_bend(bend, middle) - glsl::geofx_bend(bezier, middle)),
                      1e-13 * bend.size);
        });
}

TEST(Bend, CircularArcKeepsLengthsAlongTheGround)
{
    forRandomBends(
        [](const glsl::geofx_Bend& anyBend, Random& random)
        {
            const glsl::geofx_Bend bend =
                glsl::geofx_makeBend(glsl::GEOFX_CURVE_CIRCULAR_ARC, anyBend.size, anyBend.angle);
            const double s = random.uniform(0.001, 0.999) * bend.size;
            EXPECT_NEAR(glm::length(slopeAlongS(bend, {s, 0.0})), 1.0, 1e-9);
            // On a circle of radius d/beta about (0, d/beta).
            const double radius = bend.size / bend.angle;
            const dvec2 place = glsl::geofx_bend(bend, {s, 0.0});
            EXPECT_NEAR(glm::length(place - dvec2(0.0, radius)), std::abs(radius), 1e-12 * std::abs(radius));
        });
}

TEST(Bend, VanishesWithItsAngle)
{
    forRandomBends(
        [](const glsl::geofx_Bend& anyBend, Random& random)
        {
            const double size = anyBend.size;
            const dvec2 point(random.uniform(-2.0, 3.0) * size, random.uniform(-1.0, 1.0) * size);
            const glsl::geofx_Bend flat = glsl::geofx_makeBend(anyBend.curve, size, 0.0);
            EXPECT_LT(glm::length(glsl::geofx_bend(flat, point) - point), 1e-14 * scaleOf(flat, point));
            EXPECT_LT(glm::length(glsl::geofx_unbend(flat, point) - point), 1e-14 * scaleOf(flat, point));
            const double angle = random.logarithmic(1e-12, 1e-3);
            const glsl::geofx_Bend small = glsl::geofx_makeBend(anyBend.curve, size, random.sign() * angle);
            EXPECT_LT(glm::length(glsl::geofx_bend(small, point) - point),
                      angle * scaleOf(small, point) + 1e-14 * scaleOf(small, point));
        });
}

TEST(Bend, WithoutAZoneIsAHinge)
{
    forRandomBends(
        [](const glsl::geofx_Bend& anyBend, Random& random)
        {
            const glsl::geofx_Bend bend = glsl::geofx_makeBend(anyBend.curve, 0.0, -std::abs(anyBend.angle));
            // A hinge that opens upwards folds below itself, hence heights above zero only.
            const dvec2 point(random.uniform(-1.0, 1.0), random.uniform(0.0, 1.0));
            const dvec2 place = glsl::geofx_bend(bend, point);
            EXPECT_NEAR(glm::length(place), glm::length(point), 1e-14);
            EXPECT_LT(glm::length(glsl::geofx_unbend(bend, place) - point), 1e-14);
            const glsl::geofx_Bend narrow = glsl::geofx_makeBend(bend.curve, 1e-9, bend.angle);
            EXPECT_LT(glm::length(glsl::geofx_bend(narrow, point) - place), 1e-8);
        });
    // The wedge that it opens belongs to the line itself.
    const glsl::geofx_Bend bend = glsl::geofx_makeBend(glsl::GEOFX_CURVE_BEZIER, 0.0, -1.0);
    EXPECT_EQ(glsl::geofx_unbend(bend, {0.3, 4.0}), dvec2(0.0, std::hypot(0.3, 4.0)));
    const glsl::geofx_Bend upwards = glsl::geofx_makeBend(glsl::GEOFX_CURVE_BEZIER, 0.0, 1.0);
    EXPECT_EQ(glsl::geofx_unbend(upwards, {0.3, -4.0}), dvec2(0.0, -std::hypot(0.3, 4.0)));
}

TEST(Bend, FloatLosesOnlyItsRounding)
{
    // The parameters come from double, as uniforms do; 16 roundings of 6e-8 are the budget. For the inverse,
    // half of the way to the fold doubles them.
    forRandomBends(
        [](const glsl::geofx_Bend& bend, Random& random)
        {
            const auto bendf = glslf::geofx_makeBend(bend.curve, static_cast<float>(bend.size),
                                                     static_cast<float>(bend.angle));
            const auto rounded = glsl::geofx_makeBend(bend.curve, static_cast<double>(bendf.size),
                                                      static_cast<double>(bendf.angle));
            const glm::vec2 pointf(randomPoint(random, rounded, 0.5));
            const dvec2 point(pointf);
            const dvec2 place = glsl::geofx_bend(rounded, point);
            const glm::vec2 placef = glslf::geofx_bend(bendf, pointf);
            EXPECT_LT(glm::length(dvec2(placef) - place), 1e-6 * scaleOf(bend, point));
            const dvec2 back(glslf::geofx_unbend(bendf, placef));
            EXPECT_LT(glm::length(back - point), 2e-6 * scaleOf(bend, point));
        });
}

TEST(Bend, RefusesAnglesBeyondARightAngle)
{
    EXPECT_EQ(glsl::geofx_makeBend(glsl::GEOFX_CURVE_BEZIER, 1.0, 2.0).angle, pi / 2);
    EXPECT_EQ(glsl::geofx_makeBend(glsl::GEOFX_CURVE_BEZIER, 1.0, -2.0).angle, -pi / 2);
}

TEST(Series, AreExactNextToZeroAndAtTheirLimits)
{
    for (const double x : {1e-300, 1e-9, 1e-3, 0.1, 0.5, 0.9, 1.0})
    {
        EXPECT_NEAR(glsl::geofx_asinhc(x), std::asinh(x) / x, 4e-16) << x;
        EXPECT_NEAR(glsl::geofx_atanc(-x), std::atan(x) / x, 4e-16) << x;
        EXPECT_NEAR(glsl::geofx_sinc(x * pi / 2), std::sin(x * pi / 2) / (x * pi / 2), 4e-16) << x;
    }
    EXPECT_EQ(glsl::geofx_sinc(0.0), 1.0);
    EXPECT_EQ(glsl::geofx_asinhc(0.0), 1.0);
    EXPECT_EQ(glsl::geofx_atanc(0.0), 1.0);
}
