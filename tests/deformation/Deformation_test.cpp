// SPDX-License-Identifier: MIT
// SPDX-FileCopyrightText: 2026 the osgGeoFX authors
// What must hold for any deformation before any camera: continuity, inverse, orientation, rigid pieces, normals, turns.
#include <osgGeoFX/deformation/PerspectiveBend.h>
#include <osgGeoFX/deformation/VerticalExaggeration.h>
#include <osgGeoFX/effect/GlslFunctions.h>
#include <osgGeoFX/viewer/EffectKinds.h>
#include <tools/RandomViews.h>

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <sstream>

namespace glsl = osgGeoFX::glsl;
using namespace geofx::test;
using osg::Vec3d;
using osgGeoFX::DeformationSnapshot;
using osgGeoFX::PerspectiveBend;

namespace
{

/// An effect that does something before a camera.
struct Case
{
    CameraPose pose;
    osg::ref_ptr<osgGeoFX::Deformation> effect;
    osgGeoFX::ViewGeometry view;
    osg::ref_ptr<const DeformationSnapshot> snapshot;
    BendNumbers bend;
    bool bends = false;
    int curve = 0;

    /// Whether the whole height of a point lies on this side of the fold: behind it, places have several originals.
    bool unfolded(const Vec3d& point) const
    {
        return !bends || bend.heightOf(point) * bendCurvature(bend, curve) < 0.95;
    }
    /// By how much a bend stretches at a point: 1 outside of the zone, 0 at the fold.
    double stretch(const Vec3d& point) const
    {
        if (!bends) return 1.0;
        return glsl::geofx_bendStretch(
            glsl::geofx_bendFrame(glsl::geofx_makeBend(curve, bend.size, bend.angle), bend.alongOf(point)),
            bend.heightOf(point));
    }
};

/// Whether it moves heights within the picture alone: normals and what stands stay as they are, and what is behind its horizon has
/// no inverse. Panorama_test knows what it keeps.
bool paints(const osgGeoFX::Deformation& effect)
{
    return osgGeoFX::kindOf(effect) == "panoramaMap";
}

Case randomCase(Random& random, bool painting = false)
{
    for (;;)
    {
        const CameraPose pose = randomPose(random);
        const auto effect = randomDeformation(random);
        bringNear(*effect, pose, random);
        if (paints(*effect) && !painting) continue;
        Case found{pose, effect, pose.view(), nullptr, {}, false, 0};
        found.snapshot = effect->snapshot(found.view);
        if (!found.snapshot) continue;
        found.bends = bendNumbers(*found.snapshot, found.bend);
        if (found.bends) found.curve = static_cast<const PerspectiveBend&>(*effect).getCurve();
        return found;
    }
}

Case randomBend(Random& random)
{
    for (;;)
    {
        Case found = randomCase(random);
        if (found.bends) return found;
    }
}

/// For each random case; says which sample failed.
template<class Make, class Check>
void forRandom(const Make& make, const Check& check)
{
    for (int sample = 0; sample < sampleCount(); ++sample)
    {
        Random random(static_cast<std::uint64_t>(sample));
        const Case found = make(random);
        std::ostringstream text;
        text << "sample " << sample << ": " << describe(*found.effect) << "; " << found.pose << "; start "
             << found.bend.start << ", size " << found.bend.size << ", angle " << found.bend.angle
             << ", height " << found.bend.height;
        SCOPED_TRACE(text.str());
        check(found, random);
        if (::testing::Test::HasFailure()) return;
    }
}

Case anyCase(Random& random)
{
    return randomCase(random);
}

Case anyCaseAtAll(Random& random)
{
    return randomCase(random, true);
}

/// A point where nothing folds.
Vec3d unfoldedPoint(const Case& found, Random& random)
{
    for (;;)
    {
        const Vec3d point = randomPointFor(*found.snapshot, found.view, random);
        if (found.unfolded(point)) return point;
    }
}

/// What rounding errors are relative to.
double scaleOf(const Case& found, const Vec3d& point)
{
    return point.length() + found.snapshot->deform(point).length() + std::abs(found.view.eyeHeight) +
           std::abs(found.bend.start) + std::abs(found.bend.height) + found.bend.size;
}

/// The derivative by central differences: columns[i] is what becomes of a step along axis i.
struct Jacobian
{
    Vec3d columns[3];

    Jacobian(const DeformationSnapshot& snapshot, const Vec3d& point, double step)
    {
        for (int axis = 0; axis < 3; ++axis)
        {
            Vec3d offset;
            offset[axis] = step;
            columns[axis] =
                (snapshot.deform(point + offset) - snapshot.deform(point - offset)) / (2.0 * step);
        }
    }
    double determinant() const { return columns[0] * (columns[1] ^ columns[2]); }
    /// The inverse transpose, times the determinant.
    Vec3d normal(const Vec3d& n) const
    {
        return (columns[1] ^ columns[2]) * n.x() + (columns[2] ^ columns[0]) * n.y() +
               (columns[0] ^ columns[1]) * n.z();
    }
    Vec3d operator*(const Vec3d& v) const
    {
        return columns[0] * v.x() + columns[1] * v.y() + columns[2] * v.z();
    }
};

/// Small beside what the function changes over, large beside rounding.
double stepAt(const Case& found, const Vec3d& point)
{
    const double step = 1e-5 * scaleOf(found, point);
    LibertyNumbers liberty;
    if (libertyNumbers(*found.snapshot, liberty))
        return std::min(step, 1e-3 * std::min(liberty.across, liberty.along));
    return found.bends ? std::min(step, 1e-4 * found.bend.size) : step;
}

bool nearBorder(const Case& found, const Vec3d& point, double step)
{
    if (!found.bends) return false;
    const double s = found.bend.alongOf(point);
    return std::abs(s) < 3.0 * step || std::abs(s - found.bend.size) < 3.0 * step;
}

} // namespace

TEST(Deformation, IsContinuousAtTheZonesBorders)
{
    forRandom(randomBend,
              [](const Case& found, Random& random)
              {
                  const BendNumbers& bend = found.bend;
                  const double across = random.uniform(-1e5, 1e5);
                  const double h = random.uniform(-400.0, 9000.0);
                  for (const double border : {0.0, bend.size})
                  {
                      const double step = 1e-10 * scaleOf(found, bend.point(border, h, across));
                      const Vec3d before = bend.point(border - step, h, across);
                      const Vec3d after = bend.point(border + step, h, across);
                      const double moved =
                          (found.snapshot->deform(after) - found.snapshot->deform(before)).length();
                      const double factor = found.snapshot->lipschitz({before, 2.0 * step});
                      EXPECT_LT(moved, 2.5 * step * factor);
                      EXPECT_NEAR(found.snapshot->style(before), found.snapshot->style(after),
                                  1e-9 + 2.5 * step / std::max(bend.size, 1e-3));
                  }
              });
}

TEST(Deformation, IsUndoneByItsInverse)
{
    double worst = 0.0;
    forRandom(anyCase,
              [&](const Case& found, Random& random)
              {
                  const Vec3d point = unfoldedPoint(found, random);
                  // The wedge that a hinge opens has no original, and a hinge's fold no zone.
                  if (found.bends && found.bend.size < 1e-3) return;
                  const double error =
                      (found.snapshot->undeform(found.snapshot->deform(point)) - point).length() /
                      scaleOf(found, point);
                  worst = std::max(worst, error);
                  EXPECT_LT(error, 1e-9) << point.x() << " " << point.y() << " " << point.z();
              });
    RecordProperty("worst_relative_error", std::to_string(worst * 1e12) + "e-12");
}

TEST(Deformation, KeepsOrientation)
{
    forRandom(anyCase,
              [](const Case& found, Random& random)
              {
                  const Vec3d point = unfoldedPoint(found, random);
                  const double step = stepAt(found, point);
                  if (nearBorder(found, point, step)) return;
                  const double determinant = Jacobian(*found.snapshot, point, step).determinant();
                  EXPECT_GT(determinant, 0.0);
                  if (found.bends)
                  {
                      EXPECT_NEAR(determinant, found.stretch(point), 1e-3 * std::max(1.0, determinant));
                  }
              });
}

TEST(Deformation, MovesFocusAndContextRigidly)
{
    forRandom(randomBend,
              [](const Case& found, Random& random)
              {
                  const BendNumbers& bend = found.bend;
                  const auto pointAt = [&](double s)
                  {
                      return bend.point(s, random.uniform(-400.0, 9000.0), random.uniform(-1e5, 1e5));
                  };
                  const Vec3d focus = pointAt(-random.logarithmic(1e-3, 3e5));
                  EXPECT_EQ(found.snapshot->deform(focus), focus);
                  EXPECT_EQ(found.snapshot->style(focus), 0.0);
                  const Vec3d a = pointAt(bend.size + random.logarithmic(1e-3, 3e5));
                  const Vec3d b = pointAt(bend.size + random.logarithmic(1e-3, 3e5));
                  const double distance = (found.snapshot->deform(b) - found.snapshot->deform(a)).length();
                  EXPECT_NEAR(distance, (b - a).length(), 1e-9 * scaleOf(found, a));
                  EXPECT_NEAR(found.snapshot->style(a), 1.0, 1e-9);
                  EXPECT_EQ(found.snapshot->reach({focus, 1e-4}), DeformationSnapshot::Reach::Identity);
                  EXPECT_EQ(found.snapshot->reach({a, 1e-4}), DeformationSnapshot::Reach::Affine);
              });
}

TEST(Deformation, TurnsNormalsAsItsDerivativeDoes)
{
    double worst = 0.0;
    forRandom(anyCase,
              [&](const Case& found, Random& random)
              {
                  const Vec3d point = unfoldedPoint(found, random);
                  const double step = stepAt(found, point);
                  if (nearBorder(found, point, step)) return;
                  const Vec3d normal = randomDirection(random);
                  Vec3d expected = Jacobian(*found.snapshot, point, step).normal(normal);
                  expected.normalize();
                  const Vec3d given = found.snapshot->deformNormal(point, normal);
                  EXPECT_NEAR(given.length(), 1.0, 1e-12);
                  double allowed = 1e-4;
                  if (!found.bends && found.pose.globe)
                  {
                      // The exaggeration leaves out how verticals spread: by lift / radius.
                      allowed += 1.2 * (found.snapshot->deform(point) - point).length() / 6.3e6;
                  }
                  worst = std::max(worst, (given - expected).length() / allowed);
                  EXPECT_LT((given - expected).length(), allowed);
              });
    RecordProperty("worst_share_of_allowed", std::to_string(worst));
}

TEST(Deformation, TurnIsTheDerivativesRotation)
{
    forRandom(anyCase,
              [](const Case& found, Random& random)
              {
                  const Vec3d point = unfoldedPoint(found, random);
                  const osg::Matrixd turn = found.snapshot->turn(point);
                  const auto turned = [&](const Vec3d& v)
                  {
                      return osg::Matrixd::transform3x3(v, turn);
                  };
                  const Vec3d x = turned({1, 0, 0});
                  const Vec3d y = turned({0, 1, 0});
                  const Vec3d z = turned({0, 0, 1});
                  EXPECT_LT(((x ^ y) - z).length() + std::abs(x * y), 1e-12);
                  EXPECT_NEAR(x.length(), 1.0, 1e-12);
                  EXPECT_EQ(turn.getTrans(), Vec3d());
                  const double step = stepAt(found, point);
                  if (nearBorder(found, point, step)) return;
                  // J = turn * stretch: what is left of J without the turn is symmetric.
                  const Jacobian jacobian(*found.snapshot, point, step);
                  Vec3d a = randomDirection(random);
                  Vec3d b = randomDirection(random);
                  // What stands in a region that a painter has changed stays upright, and turns as the ground does.
                  LibertyNumbers liberty;
                  if (libertyNumbers(*found.snapshot, liberty))
                  {
                      a -= liberty.up * (liberty.up * a);
                      b -= liberty.up * (liberty.up * b);
                      EXPECT_LT((turned(liberty.up) - liberty.up).length(), 1e-9);
                  }
                  const double size = (jacobian * a).length() + (jacobian * b).length();
                  EXPECT_NEAR((jacobian * a) * turned(b), (jacobian * b) * turned(a), 1e-3 * size);
                  EXPECT_GT((jacobian * a) * turned(a), 0.0);
              });
}

TEST(Deformation, KeepsEverythingFinite)
{
    forRandom(anyCaseAtAll,
              [](const Case& found, Random& random)
              {
                  // Also what folds, and what is farther than anything on the Earth.
                  const Vec3d point = randomDirection(random) * random.logarithmic(1e-3, 1e8);
                  const Vec3d deformed = found.snapshot->deform(point);
                  EXPECT_TRUE(deformed.valid());
                  EXPECT_TRUE(found.snapshot->undeform(point).valid());
                  EXPECT_TRUE(found.snapshot->deformNormal(point, randomDirection(random)).valid());
                  EXPECT_GE(found.snapshot->lipschitz({point, 10.0}), 1.0);
                  EXPECT_GT(found.snapshot->detail({point, 10.0}), 0.0);
                  for (const auto& [name, value] : found.snapshot->uniforms())
                  {
                      for (int i = 0; i < 4; ++i)
                          EXPECT_TRUE(std::isfinite(static_cast<float>(value[i]))) << name;
                  }
              });
}

TEST(DeformationChain, ActsInItsOrderAndIsUndoneInTheReverse)
{
    for (int sample = 0; sample < sampleCount(); ++sample)
    {
        SCOPED_TRACE(sample);
        Random random(static_cast<std::uint64_t>(sample));
        const CameraPose pose = randomCommonPose(random);
        const osgGeoFX::ViewGeometry view = pose.view();
        const osg::ref_ptr<osgGeoFX::DeformationChain> chain = new osgGeoFX::DeformationChain;
        std::vector<osg::ref_ptr<osgGeoFX::Deformation>> effects;
        bool folds = false;
        for (int i = random.integer(0, 3); i > 0; --i)
        {
            effects.push_back(randomDeformation(random));
            bringNear(*effects.back(), pose, random);
            folds = folds || paints(*effects.back());
            if (const auto snapshot = effects.back()->snapshot(view)) chain->add(snapshot);
        }
        const Vec3d point = randomGroundPoint(random, view);
        Vec3d expected = point;
        Vec3d normal = randomDirection(random);
        const Vec3d before = normal;
        double style = 0.0;
        double scale = point.length() + std::abs(view.eyeHeight);
        for (const auto& snapshot : chain->snapshots())
        {
            style = std::max(style, snapshot->style(expected));
            normal = snapshot->deformNormal(expected, normal);
            const Vec3d next = snapshot->deform(expected);
            BendNumbers numbers;
            // Only what is certainly not folded: a curve's curvature is at most 2 tan(π/4) / (d cos(π/4)).
            if (bendNumbers(*snapshot, numbers))
            {
                folds = folds || std::abs(numbers.heightOf(expected)) * 2.9 > 0.9 * numbers.size;
                scale += std::abs(numbers.start) + numbers.size;
            }
            // Several exaggerations can take a valley through the middle of the Earth, from where no way leads back.
            if (view.ground.ellipsoid)
            {
                const double radius = view.ground.ellipsoid->getRadiusPolar();
                const Vec3d middle = view.up * -(radius + view.eyeHeight);
                folds = folds ||
                        (next - middle) * (expected - middle) < 0.1 * radius * (expected - middle).length();
            }
            expected = next;
            scale += expected.length();
        }
        EXPECT_EQ(chain->deform(point), expected);
        EXPECT_EQ(chain->deformNormal(point, before), normal);
        EXPECT_EQ(chain->style(point), style);
        EXPECT_EQ(chain->empty(), chain->snapshots().empty());
        if (!folds)
        {
            EXPECT_LT((chain->undeform(expected) - point).length(), 1e-8 * scale);
        }
        // What keeps its shape: the reference goes with the ground, lengths stay, neighbours turn with it.
        const osg::Matrixd placement = chain->placement(point);
        EXPECT_LT((point * placement - expected).length(), 1e-9 * scale);
        const Vec3d neighbour = point + randomDirection(random) * 30.0;
        EXPECT_NEAR((neighbour * placement - expected).length(), 30.0, 1e-9 * scale);
        if (HasFailure()) return;
    }
}
