// SPDX-License-Identifier: MIT
// SPDX-FileCopyrightText: 2026 the osgGeoFX authors
// A close-up against the same picture made by OSG alone: the ground drawn a second time below a transform, cut by clip
// planes.
#include <tools/CloseUpStage.h>

#include <osg/ClipNode>
#include <osg/MatrixTransform>

#include <gtest/gtest.h>

#include <cstddef>

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

TEST_F(CloseUpModel, RectanglesHaveWholeOutlinesWhateverTheirMask)
{
    _root->getOrCreateStateSet()->setMode(GL_LIGHTING, osg::StateAttribute::OFF);
    look({0.0, -1.0, 2600.0}, {0.0, 0.0, 0.0});
    const osg::ref_ptr<CloseUp> closeUp = makeCloseUp({100.0, -50.0}, 500.0, 400.0);
    closeUp->getRegion()->setShape(RegionOfInterest::RECTANGLE);
    closeUp->getRegion()->setSize(800.0, 300.0);
    closeUp->getRegion()->setHeading(0.3);
    closeUp->getAnchor()->setKind(Anchor::NONE);
    closeUp->getAnchor()->setLineWidth(3.0);
    closeUp->setColor({1.0, 0.0, 1.0});
    _closeUps->addCloseUp(closeUp);

    // Texels of 50 by 19 m, each some ten pixels wide, and of less than a metre.
    closeUp->getRegion()->setMaskSide(16);
    const auto [coarse, coarseAgain] = drawBoth();
    closeUp->getRegion()->setMaskSide(1024);
    const auto [fine, fineAgain] = drawBoth();
    EXPECT_LT(differing(*coarse, *fine, 8), 0.001);
    EXPECT_LT(differing(*coarseAgain, *fineAgain, 8), 0.001);

    // Seen from above the outline is as long as the region's border, magnified, and as wide as it is said to be.
    const osg::Matrixd lift = osg::Matrixd::inverse(closeUp->getRegion()->frameToWorld(nullptr)) *
                              closeUp->shape(0.0) * closeUp->getRegion()->frameToWorld(nullptr);
    osg::Camera& camera = *viewer().getCamera();
    const osg::Matrixd toPicture = lift * camera.getViewMatrix() * camera.getProjectionMatrix();
    double length = 0.0;
    osg::Vec3d before;
    for (int corner = 0; corner <= 4; ++corner)
    {
        const osg::Vec3d place(corner % 4 < 2 ? 400.0 : -400.0, (corner + 1) % 4 < 2 ? 150.0 : -150.0, 0.0);
        const osg::Vec3d at = place * closeUp->getRegion()->frameToWorld(nullptr) * toPicture;
        const osg::Vec3d pixel(0.5 * _width * at.x(), 0.5 * _height * at.y(), 0.0);
        if (corner > 0) length += (pixel - before).length();
        before = pixel;
    }
    closeUp->getRegion()->setMaskSide(16);
    closeUp->getAnchor()->setLineWidth(0.0);
    const osg::ref_ptr<osg::Image> without = draw();
    double covered = 0.0;
    for (int i = 0; i < without->s() * without->t(); ++i)
    {
        const auto colorOf = [&](const osg::Image& image)
        {
            const unsigned char* rgb = image.data() + 4 * static_cast<std::ptrdiff_t>(i);
            return osg::Vec3d(rgb[0], rgb[1], rgb[2]) / 255.0;
        };
        const osg::Vec3d toLine = osg::Vec3d(closeUp->getColor()) - colorOf(*without);
        covered += (colorOf(*coarseAgain) - colorOf(*without)) * toLine / toLine.length2();
    }
    EXPECT_NEAR(covered / (3.0 * length), 1.0, 0.15) << length << " pixels of outline";
}

TEST_F(CloseUpModel, EdgesLetTheirAnchorsShow)
{
    // From above, nothing stands before a close-up, and its anchor is all below it: as painted one over the other.
    look({0.0, -1500.0, 1800.0}, {0.0, 0.0, 100.0});
    const osg::ref_ptr<CloseUp> closeUp = makeCloseUp({0.0, 0.0}, 500.0, 400.0);
    closeUp->setScale(1.4, 1.4, 1.4);
    closeUp->setColor({1.0, 0.0, 1.0});
    closeUp->getAnchor()->setStyle(Anchor::SOLID);
    _closeUps->addCloseUp(closeUp);
    for (const auto shape : {RegionOfInterest::ELLIPSE, RegionOfInterest::RECTANGLE, RegionOfInterest::STAR})
    {
        SCOPED_TRACE(shape);
        closeUp->getRegion()->setShape(shape);
        for (const double softness : {0.0, 0.3})
        {
            SCOPED_TRACE(softness);
            closeUp->getRegion()->setSoftness(softness);
            _closeUps->setDepthTest(false);
            const osg::ref_ptr<osg::Image> painted = draw();
            _closeUps->setDepthTest(true);
            const auto [single, multi] = drawBoth();
            // But for the anchor's foot, which the ground hides here and there.
            EXPECT_LT(differing(*painted, *single, 4), 0.0006);
            EXPECT_LT(differing(*painted, *multi, 4), 0.0006);
        }
    }
}

} // namespace
