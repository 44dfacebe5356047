// SPDX-License-Identifier: MIT
// SPDX-FileCopyrightText: 2026 the osgGeoFX authors
// A close-up against the same picture made by OSG alone: the ground drawn a second time below a transform, cut by clip
// planes.
#include <tools/CloseUpStage.h>

#include <osg/ClipNode>
#include <osg/MatrixTransform>

#include <gtest/gtest.h>

using namespace osgGeoFX;

namespace
{

class CloseUpModel : public geofx::test::CloseUpStage
{
protected:
    CloseUpModel() : CloseUpStage(400, 300) {}

    /// The ground within a rectangle, where a close-up of it would be.
    osg::ref_ptr<osg::Node> makeModel(const CloseUp& closeUp)
    {
        const RegionOfInterest& region = *closeUp.getRegion();
        const osg::Matrixd frame = region.frameToWorld(nullptr);
        osg::ref_ptr<osg::MatrixTransform> moved =
            new osg::MatrixTransform(osg::Matrixd::inverse(frame) * closeUp.shape(0.0) * frame);
        moved->getOrCreateStateSet()->setMode(GL_NORMALIZE, osg::StateAttribute::ON);
        osg::ref_ptr<osg::ClipNode> cut = new osg::ClipNode;
        const osg::Vec3d centre = frame.getTrans();
        const double half[2] = {region.getWidth() / 2.0, region.getDepth() / 2.0};
        for (unsigned int i = 0; i < 4; ++i)
        {
            // Within the region, along its own axes.
            const unsigned int axis = i / 2;
            const double side = i % 2 == 0 ? 1.0 : -1.0;
            osg::Vec3d normal(axis == 0 ? side : 0.0, axis == 1 ? side : 0.0, 0.0);
            normal = osg::Matrixd::transform3x3(normal, frame);
            cut->addClipPlane(new osg::ClipPlane(i, osg::Vec4d(normal, half[axis] - normal * centre)));
        }
        cut->addChild(_scene->getChild(0));
        moved->addChild(cut);
        return moved;
    }

    void expectSame(CloseUp& closeUp)
    {
        closeUp.getRegion()->setShape(RegionOfInterest::RECTANGLE);
        closeUp.getAnchor()->setKind(Anchor::NONE);
        closeUp.getAnchor()->setLineWidth(0.0);
        _closeUps->removeCloseUps();
        _closeUps->addCloseUp(&closeUp);
        _closeUps->setEnabled(false);
        const osg::ref_ptr<osg::Image> overview = draw();
        const osg::ref_ptr<osg::Node> model = makeModel(closeUp);
        _root->addChild(model);
        const osg::ref_ptr<osg::Image> expected = draw();
        _root->removeChild(model);
        _closeUps->setEnabled(true);
        EXPECT_GT(differing(*overview, *expected), 0.03) << "the model does not show";
        const auto [single, multi] = drawBoth();
        // The close-up's border is smooth, the planes' is not.
        EXPECT_LT(differing(*expected, *single), 0.012);
        EXPECT_LT(differing(*expected, *multi), 0.012);
    }
};

TEST_F(CloseUpModel, IsTheGroundCutScaledAndLifted)
{
    const osg::ref_ptr<CloseUp> closeUp = makeCloseUp({100.0, -200.0}, 500.0, 400.0);
    closeUp->setScale(1.4, 1.4, 1.4);
    expectSame(*closeUp);
    closeUp->getRegion()->setSize(700.0, 300.0);
    closeUp->getRegion()->setHeading(0.6);
    closeUp->getRegion()->setBase(80.0);
    closeUp->setOffset({150.0, -60.0, 350.0});
    expectSame(*closeUp);
}

TEST_F(CloseUpModel, IsTheGroundTurnedAndTilted)
{
    // The close-up keeps the light of its place; a model that turns does not.
    _root->getOrCreateStateSet()->setMode(GL_LIGHTING, osg::StateAttribute::OFF);
    const osg::ref_ptr<CloseUp> closeUp = makeCloseUp({-150.0, 50.0}, 500.0, 450.0);
    closeUp->setScale(1.2, 0.8, 2.0);
    closeUp->setTurn(0.7);
    closeUp->setTilt(0.4);
    expectSame(*closeUp);
    // Nearly flat: clip planes do not survive a singular matrix.
    closeUp->setScale(1.3, 1.3, 0.01);
    expectSame(*closeUp);
}

} // namespace
