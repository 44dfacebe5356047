// SPDX-License-Identifier: MIT
// SPDX-FileCopyrightText: 2026 the osgGeoFX authors
//
// Cameras whose near and far planes go by triangles (osg::CullSettings::COMPUTE_NEAR_FAR_USING_PRIMITIVES).
#include <osgGeoFX/deformation/VerticalExaggeration.h>
#include <tools/BentGround.h>
#include <tools/CullHarness.h>
#include <tools/DrawnDepths.h>

#include <osgUtil/SceneView>

#include <algorithm>
#include <vector>

using namespace osgGeoFX;
using namespace geofx::test;

namespace
{

using Range = DepthSpan;

class NearFarByPrimitives : public BentGround
{
protected:
    /// What the projection of a frame has. OSG widens it a little, and equally for all.
    Range planesOf(osg::Node* scene, osg::CullSettings::ComputeNearFarMode mode)
    {
        CullHarness harness(context(), scene, WIDTH, HEIGHT);
        harness.camera().setComputeNearFarMode(mode);
        harness.setCamera(view, projection);
        const osg::Matrixd made = harness.frame(true).projection;
        Range range;
        double left = 0.0, right = 0.0, bottom = 0.0, top = 0.0;
        made.getFrustum(left, right, bottom, top, range.nearest, range.farthest);
        return range;
    }
    static void expectNear(const Range& actual, const Range& expected, const char* what)
    {
        EXPECT_NEAR(actual.nearest / expected.nearest, 1.0, 1e-3) << what;
        EXPECT_NEAR(actual.farthest / expected.farthest, 1.0, 1e-3) << what;
    }
    static osg::ref_ptr<osg::Group> contents()
    {
        return makePlain({makeGround(), makeBox(9.0f, {10.0, 20.0, 0.0})});
    }

    const osg::Matrixd view =
        osg::Matrixd::lookAt(osg::Vec3d(0, -150, 70), osg::Vec3d(0, -40, 0), osg::Vec3d(0, 0, 1));
    const osg::Matrixd projection = osg::Matrixd::perspective(40.0, 4.0 / 3.0, 1.0, 2000.0);
};

constexpr auto byTriangles = osg::CullSettings::COMPUTE_NEAR_FAR_USING_PRIMITIVES;
constexpr auto nearByTriangles = osg::CullSettings::COMPUTE_NEAR_USING_PRIMITIVES;
constexpr auto byBoxes = osg::CullSettings::COMPUTE_NEAR_FAR_USING_BOUNDING_VOLUMES;

} // namespace

TEST_F(NearFarByPrimitives, AreThoseOfOsgWhereNothingMoves)
{
    const Range expected = planesOf(contents(), byTriangles), boxes = planesOf(contents(), byBoxes);
    EXPECT_GT(expected.nearest, 1.5 * boxes.nearest);
    const osg::ref_ptr<EffectScene> weak = new EffectScene;
    const osg::ref_ptr<VerticalExaggeration> lift = new VerticalExaggeration;
    lift->setFactor(1.00001);
    weak->addEffect(lift);
    weak->addChild(contents());
    expectNear(planesOf(weak, byTriangles), expected, "weak");
    // OSG's far plane goes by boxes then, and the kit's by what is closer to the triangles.
    const Range nearAlone = planesOf(weak, nearByTriangles);
    EXPECT_NEAR(nearAlone.nearest / planesOf(contents(), nearByTriangles).nearest, 1.0, 1e-3);
    EXPECT_GE(nearAlone.farthest, 0.999 * expected.farthest);
    EXPECT_LE(nearAlone.farthest, 1.1 * expected.farthest);
    const osg::ref_ptr<EffectScene> painted = new EffectScene;
    painted->addEffect(makePaint());
    painted->addChild(contents());
    expectNear(planesOf(painted, byTriangles), expected, "painted");
}

TEST_F(NearFarByPrimitives, AreThoseOfTheDeformedTrianglesInThePicture)
{
    const osg::ref_ptr<osg::Geometry> ground = makeGround();
    const osg::ref_ptr<EffectScene> scene = makeScene({ground});
    Range expected;
    include(expected, *ground, view, projection, *scene->deformation(view, projection));
    const Range plain = planesOf(ground, byTriangles);
    EXPECT_GT(std::abs(expected.farthest / plain.farthest - 1.0), 0.02);
    // OSG puts the planes 2 % nearer and farther.
    const Range actual = planesOf(scene, byTriangles);
    EXPECT_NEAR(actual.nearest / (0.98 * expected.nearest), 1.0, 1e-3);
    EXPECT_NEAR(actual.farthest / (1.02 * expected.farthest), 1.0, 1e-3);
}
