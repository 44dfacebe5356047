// SPDX-License-Identifier: MIT
// SPDX-FileCopyrightText: 2026 the osgGeoFX authors
//
// The tiles of a picture, each drawn by a camera in the role LIKE, are the picture in parts, whatever the effects.
#include <osgGeoFX/deformation/PedestrianView.h>
#include <osgGeoFX/deformation/VerticalExaggeration.h>
#include <tools/CloseUpStage.h>
#include <tools/ImageComparison.h>
#include <tools/PictureTiles.h>

#include <osg/Math>

#include <iostream>

using namespace osgGeoFX;
using namespace geofx::test;

namespace
{

constexpr int width = 240, height = 160;

class PictureTiles : public CloseUpStage
{
protected:
    PictureTiles() : CloseUpStage(width, height) {}

    void SetUp() override
    {
        CloseUpStage::SetUp();
        if (IsSkipped() || HasFatalFailure()) return;
        _scene->removeEffect(_closeUps);
        _scene->addChild(makeHouses());
        viewer().getCamera()->setComputeNearFarMode(osg::CullSettings::DO_NOT_COMPUTE_NEAR_FAR);
    }

    /// Where an edge runs through the middle of a pixel, rounding decides whose it is.
    void expectTheWhole(const std::string& name, double most = 0.0005)
    {
        const osg::ref_ptr<osg::Image> whole = draw();
        const osg::ref_ptr<osg::Image> parts = drawTiles(*viewer().getCamera(), 4, [this] { return draw(); });
        const double off = differing(*whole, *parts);
        std::cout << name << ": " << 100.0 * off << " % of the pixels are off by more than 2 of 255\n";
        EXPECT_TRUE(imagesMatch(*parts, *whole, {2.1f / 255.0f, most, 1.0f}, name));
    }
};

osg::ref_ptr<ProjectiveMapping> makeSpot(const osg::Vec2d& center, double half, const osg::Vec3d& color)
{
    const osg::ref_ptr<ProjectiveMapping> mapping = new ProjectiveMapping;
    mapping->setRectangle(center, half, half);
    mapping->getTransfer()->setSource(ColorTransfer::CONSTANT);
    mapping->getTransfer()->setConstant(osg::Vec4d(color, 0.8));
    return mapping;
}

} // namespace

TEST_F(PictureTiles, OfDeformations)
{
    const osg::ref_ptr<VerticalExaggeration> high = new VerticalExaggeration;
    high->setFactor(3.0);
    const osg::ref_ptr<BirdsEyeView> bend = new BirdsEyeView;
    const osg::ref_ptr<PedestrianView> pedestrian = new PedestrianView;
    for (const std::vector<Effect*>& effects :
         {std::vector<Effect*>{high}, std::vector<Effect*>{bend}, std::vector<Effect*>{pedestrian},
          std::vector<Effect*>{high, bend}})
    {
        const osg::ref_ptr<osg::Image> straight = draw();
        for (Effect* each : effects)
            _scene->addEffect(each);
        EXPECT_GT(differing(*draw(), *straight), 0.01);
        expectTheWhole(std::string(effects.back()->className()) + std::to_string(effects.size()));
        for (Effect* each : effects)
            _scene->removeEffect(each);
    }
}

TEST_F(PictureTiles, OfMappings)
{
    const osg::ref_ptr<BirdsEyeView> bend = new BirdsEyeView;
    const osg::ref_ptr<ProjectiveMappings> mappings = new ProjectiveMappings;
    mappings->addMapping(makeSpot({100.0, -300.0}, 300.0, {0.9, 0.2, 0.3}));
    // Of the same size on the screen wherever it lies.
    const osg::ref_ptr<ProjectiveMapping> symbol = makeSpot({-250.0, -400.0}, 20.0, {0.2, 0.9, 0.3});
    symbol->setSizeInPixels(30.0);
    mappings->addMapping(symbol);
    const osg::ref_ptr<osg::Image> before = draw();
    _scene->addEffect(bend);
    _scene->addEffect(mappings);
    EXPECT_GT(differing(*draw(), *before), 0.01);
    expectTheWhole("mappings");
}

TEST_F(PictureTiles, OfCloseUps)
{
    const osg::ref_ptr<BirdsEyeView> bend = new BirdsEyeView;
    _scene->addEffect(bend);
    _scene->addEffect(_closeUps);
    for (const auto pipeline : {CloseUps::SINGLE_PASS, CloseUps::MULTI_PASS})
    {
        _closeUps->setPipeline(pipeline);
        for (int i = 0; i < 4; ++i)
        {
            Random random(static_cast<std::uint64_t>(i));
            _closeUps->removeCloseUps();
            const CloseUpPlan plan;
            for (int number = 3; number > 0; --number)
                _closeUps->addCloseUp(randomCloseUp(random, plan));
            expectTheWhole("close-ups " + std::to_string(i) + " by pipeline " + std::to_string(pipeline),
                           0.002);
        }
    }
}
