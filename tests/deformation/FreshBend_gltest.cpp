// SPDX-License-Identifier: MIT
// SPDX-FileCopyrightText: 2026 the osgGeoFX authors
//
// What a bend that has just been switched on asks the pager for first. Triangles that are too large for it reach out of its zone as
// planes, most of all those of a sea, which nothing else refines; the farther they are off, the sooner finer ones must come.
#include <tools/CullHarness.h>
#include <tools/GlFixture.h>
#include <tools/OahuScene.h>

#include <osgGeoFX/deformation/PedestrianView.h>
#include <osgGeoFX/viewer/ViewPoint.h>

#include <algorithm>
#include <cmath>

using namespace osgGeoFX;
using namespace geofx::test;

namespace
{

constexpr int WIDTH = 240, HEIGHT = 180;

class FreshBend : public GlFixture
{
protected:
    FreshBend() : GlFixture(WIDTH, HEIGHT) {}
};

} // namespace

TEST_F(FreshBend, RefinesFirstWhatIsTooCoarseForItMost)
{
    const std::optional<Scene> oahu = loadOahu("oahu");
    if (!oahu) return;
    ViewPoint point;
    point.longitude = osg::DegreesToRadians(-158.3);
    point.latitude = osg::DegreesToRadians(21.42);
    point.height = 20000.0;
    point.heading = osg::DegreesToRadians(80.0);
    point.pitch = osg::DegreesToRadians(-15.0);
    osg::Matrixd view;
    ASSERT_TRUE(point.viewMatrix(*oahu->reference, view));
    const osg::Matrixd projection =
        osg::Matrixd::perspective(60.0, static_cast<double>(WIDTH) / HEIGHT, 5.0, 3e5);
    CullHarness harness(context(), oahu->node, WIDTH, HEIGHT);
    harness.setCamera(view, projection);
    Random random(0);
    while (CullHarness::load(harness.frame(true, false).requests, random, 1.0) > 0)
    {
    }
    const osg::ref_ptr<PedestrianView> bend = new PedestrianView;
    bend->setFocusDistance(20000.0);
    bend->setZoneWidth(1500.0);
    bend->setBendAngle(1.2);
    oahu->effects->addEffect(bend);
    const osg::ref_ptr<const DeformationChain> chain = oahu->effects->deformation(view, projection);
    ASSERT_EQ(chain->snapshots().size(), 1u);
    struct Wish
    {
        double excess; ///< how many times an edge is longer than the bend allows
        double priority;
    };
    std::vector<Wish> wishes;
    // The error that a bend may leave enters as its root into each length, the same for all tiles.
    constexpr double tolerance = 1e-3;
    for (const RequestRecorder::Request& request : harness.frame(true, false).requests)
    {
        const osg::NodePath path = request.group->getParentalNodePaths().front();
        const osg::Matrixd toEye =
            osg::computeLocalToWorld(osg::NodePath(path.begin(), path.end() - 1)) * view;
        const Ball ball = {osg::Vec3d(request.group->getCenter()) * toEye,
                           static_cast<double>(request.group->getBound().radius())};
        // Those for which the bend is the stronger reason, but for the most urgent ones, which are all as urgent.
        if (chain->lodLimit(*request.group, ball) > chain->lodDistance(ball, osg::Vec3d())) continue;
        if (request.priority > 0.99f) continue;
        wishes.push_back({ball.radius / chain->snapshots().front()->longestEdge(ball, tolerance),
                          static_cast<double>(request.priority)});
    }
    ASSERT_GT(wishes.size(), 8u);
    std::sort(wishes.begin(), wishes.end(),
              [](const Wish& one, const Wish& other) { return one.excess < other.excess; });
    for (std::size_t i = 0; i + 1 < wishes.size(); ++i)
    {
        if (wishes[i + 1].excess < 1.01 * wishes[i].excess) continue;
        EXPECT_LE(wishes[i].priority, wishes[i + 1].priority);
    }
    // An edge misses its curve by its square: what is missing to the highest priority falls with it.
    const Wish& least = wishes.front();
    const Wish& most = wishes.back();
    ASSERT_GT(most.excess, 1.2 * least.excess);
    const double squares = std::pow(most.excess / least.excess, 2.0);
    EXPECT_NEAR((1.0 - least.priority) / (1.0 - most.priority), squares, 0.02 * squares);
    EXPECT_GT(least.priority, 0.0);
}
