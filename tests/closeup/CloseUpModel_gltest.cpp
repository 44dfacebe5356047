// SPDX-License-Identifier: MIT
// SPDX-FileCopyrightText: 2026 the osgGeoFX authors
// A close-up against the same picture made by OSG alone: the ground drawn a second time below a transform, cut by clip
// planes.
#include <tools/CloseUpStage.h>

#include <osg/ClipNode>
#include <osg/MatrixTransform>

#include <gtest/gtest.h>
#include <osg/Math>

#include <algorithm>
#include <cmath>
#include <string>

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
        const osg::Vec3d center = frame.getTrans();
        const double half[2] = {region.getWidth() / 2.0, region.getDepth() / 2.0};
        for (unsigned int i = 0; i < 4; ++i)
        {
            // Within the region, along its own axes.
            const unsigned int axis = i / 2;
            const double side = i % 2 == 0 ? 1.0 : -1.0;
            osg::Vec3d normal(axis == 0 ? side : 0.0, axis == 1 ? side : 0.0, 0.0);
            normal = osg::Matrixd::transform3x3(normal, frame);
            cut->addClipPlane(new osg::ClipPlane(i, osg::Vec4d(normal, half[axis] - normal * center)));
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
    closeUp->getRegion()->setBaseHeight(80.0);
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

TEST_F(CloseUpModel, OutlinesAreWholeWhateverTheirMask)
{
    _root->getOrCreateStateSet()->setMode(GL_LIGHTING, osg::StateAttribute::OFF);
    look({0.0, -1.0, 2600.0}, {0.0, 0.0, 0.0});
    const osg::ref_ptr<CloseUp> closeUp = makeCloseUp({100.0, -50.0}, 500.0, 400.0);
    RegionOfInterest& region = *closeUp->getRegion();
    region.setSize(800.0, 400.0);
    region.setHeading(0.3);
    closeUp->getAnchor()->setKind(Anchor::NONE);
    closeUp->setColor({1.0, 0.0, 1.0});
    _closeUps->addCloseUp(closeUp);
    const osg::Matrixd frame = region.frameToWorld(nullptr);
    const osg::Camera& camera = *viewer().getCamera();
    const osg::Matrixd toPicture = osg::Matrixd::inverse(frame) * closeUp->shape(0.0) * frame *
                                   camera.getViewMatrix() * camera.getProjectionMatrix() *
                                   osg::Matrixd::translate(1.0, 1.0, 0.0) *
                                   osg::Matrixd::scale(0.5 * _width, 0.5 * _height, 1.0);
    const auto pixelOf = [&](double angle, RegionOfInterest::Shape shape)
    {
        osg::Vec3d place(std::cos(angle), std::sin(angle), 0.0);
        if (shape == RegionOfInterest::RECTANGLE) place /= std::max(std::abs(place.x()), std::abs(place.y()));
        osg::Vec3d at = osg::Vec3d(400.0 * place.x(), 200.0 * place.y(), 0.0) * frame;
        at.z() = groundHeight(at.x(), at.y());
        return at * toPicture;
    };

    for (const auto shape : {RegionOfInterest::RECTANGLE, RegionOfInterest::ELLIPSE})
    {
        region.setShape(shape);
        // Texels of 25 by 13 m, each several pixels wide, and of less than a metre.
        for (const int side : {32, 1024})
        {
            SCOPED_TRACE(std::to_string(shape) + ", " + std::to_string(side) + " texels");
            region.setMaskSide(side);
            closeUp->getAnchor()->setLineWidth(3.0);
            const auto [single, multi] = drawBoth();
            closeUp->getAnchor()->setLineWidth(0.0);
            const osg::ref_ptr<osg::Image> without = draw();
            const auto share = [&](const osg::Image& image, int x, int y)
            {
                const auto colorOf = [&](const osg::Image& picture)
                {
                    const unsigned char* rgb = picture.data(x, y);
                    return osg::Vec3d(rgb[0], rgb[1], rgb[2]) / 255.0;
                };
                const osg::Vec3d toLine = osg::Vec3d(closeUp->getColor()) - colorOf(*without);
                return (colorOf(image) - colorOf(*without)) * toLine / toLine.length2();
            };
            for (const osg::Image* image : {single.get(), multi.get()})
            {
                // There all along the border, and as wide as it is said to be.
                double length = 0.0;
                constexpr int steps = 2000;
                osg::Vec3d before = pixelOf(0.0, shape);
                for (int i = 1; i <= steps; ++i)
                {
                    const osg::Vec3d border = pixelOf(2.0 * osg::PI * i / steps, shape);
                    osg::Vec3d along = border - before;
                    along.z() = 0.0;
                    length += along.length();
                    along.normalize();
                    const osg::Vec3d inwards(-along.y(), along.x(), 0.0);
                    double most = 0.0;
                    for (double way = -1.0; way < 5.0; way += 0.5)
                    {
                        const osg::Vec3d at = border + inwards * way;
                        most =
                            std::max(most, share(*image, static_cast<int>(at.x()), static_cast<int>(at.y())));
                    }
                    EXPECT_GT(most, 0.6) << "a gap at " << border.x() << ", " << border.y();
                    before = border;
                }
                double covered = 0.0;
                for (int y = 0; y < _height; ++y)
                    for (int x = 0; x < _width; ++x)
                        covered += share(*image, x, y);
                EXPECT_NEAR(covered / (3.0 * length), 1.0, 0.1) << length << " pixels of outline";
            }
        }
    }
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
