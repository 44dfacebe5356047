// SPDX-License-Identifier: MIT
// SPDX-FileCopyrightText: 2026 the osgGeoFX authors
//
// Lists of effects that change while they are drawn: always the picture of a scene that was made as it is now.
#include <osgGeoFX/deformation/VerticalExaggeration.h>
#include <osgGeoFX/scene/PassEffect.h>
#include <tools/CloseUpStage.h>
#include <tools/ImageComparison.h>

using namespace osgGeoFX;
using namespace geofx::test;

namespace
{

class EffectChanges : public CloseUpStage
{
protected:
    void SetUp() override
    {
        CloseUpStage::SetUp();
        if (IsSkipped() || HasFatalFailure()) return;
        for (const double x : {-300.0, 350.0})
        {
            const osg::ref_ptr<CloseUp> closeUp = makeCloseUp({x, 0.5 * x}, 350.0, 350.0);
            closeUp->getAnchor()->setKind(x < 0.0 ? Anchor::CONTOUR : Anchor::STRETCHED);
            _closeUps->addCloseUp(closeUp);
        }
    }

    /// The picture of a new scene with copies of the same effects.
    osg::ref_ptr<osg::Image> fresh()
    {
        const osg::ref_ptr<EffectScene> scene = new EffectScene;
        for (unsigned int i = 0; i < _scene->getNumEffects(); ++i)
            scene->addEffect(osg::clone(_scene->getEffect(i), osg::CopyOp::DEEP_COPY_ALL));
        for (unsigned int i = 0; i < _scene->getNumChildren(); ++i)
            scene->addChild(_scene->getChild(i));
        _root->replaceChild(_scene, scene);
        osg::ref_ptr<osg::Image> image = draw();
        _root->replaceChild(scene, _scene);
        return image;
    }

    void compare(const std::string& name) { EXPECT_TRUE(imagesMatch(*draw(), *fresh(), {}, name)) << name; }
};

/// Asks for the programs of two passes.
class TwoPasses : public PassEffect
{
public:
    META_Object(osgGeoFX, TwoPasses);
    TwoPasses() = default;
    TwoPasses(const TwoPasses& other, const osg::CopyOp& copy) : PassEffect(other, copy) {}

    const Properties& properties() const override
    {
        static const Properties none;
        return none;
    }
    void cull(const ScenePass& pass) override
    {
        programs.clear();
        for (const PassShaders& each : shaders)
            programs.push_back(pass.program(each));
    }

    std::vector<PassShaders> shaders;
    std::vector<osg::ref_ptr<osg::Program>> programs;

protected:
    ~TwoPasses() override = default;
};

} // namespace

TEST_F(EffectChanges, CloseUpsFollowTheirPlaceInTheList)
{
    for (const CloseUps::Pipeline pipeline : {CloseUps::SINGLE_PASS, CloseUps::MULTI_PASS})
    {
        SCOPED_TRACE(pipeline);
        _closeUps->setPipeline(pipeline);
        const osg::ref_ptr<osg::Image> alone = draw();
        const osg::ref_ptr<BirdsEyeView> bend = new BirdsEyeView;
        bend->setHorizonLine(0.8);
        bend->setFocusLine(0.2);
        bend->setContextTilt(0.7);
        const osg::ref_ptr<VerticalExaggeration> lift = new VerticalExaggeration;
        lift->setFactor(2.0);
        _scene->removeEffect(_closeUps);
        _scene->addEffect(bend);
        _scene->addEffect(_closeUps);
        compare("a bend came before them");
        EXPECT_GT(differing(*alone, *draw()), 0.02);
        draw();
        _scene->removeEffect(bend);
        EXPECT_TRUE(same(*alone, *draw())) << "as before the bend came";
        compare("it went");
        _scene->removeEffect(_closeUps);
        _scene->addEffect(lift);
        _scene->addEffect(bend);
        _scene->addEffect(_closeUps);
        compare("two effects before them");
        _scene->removeEffect(bend);
        compare("one of two");
        _scene->removeEffect(lift);
        EXPECT_TRUE(same(*alone, *draw())) << "none";
    }
}

TEST_F(EffectChanges, CloseUpsFollowTheirBindingAndUnits)
{
    for (const CloseUps::Pipeline pipeline : {CloseUps::SINGLE_PASS, CloseUps::MULTI_PASS})
    {
        SCOPED_TRACE(pipeline);
        _closeUps->setPipeline(pipeline);
        const osg::ref_ptr<osg::Image> first = draw();
        const int binding = _closeUps->getBlockBinding();
        _closeUps->setBlockBinding(binding + 3);
        EXPECT_TRUE(same(*first, *draw()));
        compare("another binding");
        // Others may bind what they like to the former place.
        _closeUps->setBlockBinding(binding);
        EXPECT_TRUE(same(*first, *draw()));
        _closeUps->setUnits(5, 6, 8);
        EXPECT_TRUE(same(*first, *draw()));
        _closeUps->setUnits(8, 5, 6);
        EXPECT_TRUE(same(*first, *draw()));
        compare("other units");
        _closeUps->setUnits(11, 12, 13);
    }
}

// Passes that differ in one stage only are different programs; those that agree share one.
TEST_F(EffectChanges, EachPassHasAProgramOfItsOwn)
{
    PassShaders first;
    first.vertex = {"stages/closeup.items.glsl", "stages/closeup.vert.glsl"};
    first.fragment = {"stages/closeup.items.glsl", "stages/closeup.frag.glsl"};
    first.geometry = {"stages/closeup.items.glsl", "stages/closeup.geom.glsl"};
    first.tessellationControl = {"stages/closeup.items.glsl", "stages/closeup.tesc.glsl"};
    first.tessellationEvaluation = {"stages/closeup.tese.glsl"};
    const osg::ref_ptr<TwoPasses> passes = new TwoPasses;
    passes->shaders = {first, first};
    // A stage's files, one more of them, and the same in another stage.
    passes->shaders.push_back(first);
    passes->shaders.back().tessellationEvaluation = {"stages/closeup.items.glsl", "stages/closeup.tese.glsl"};
    passes->shaders.push_back(first);
    passes->shaders.back().tessellationControl.pop_back();
    passes->shaders.back().tessellationEvaluation.insert(
        passes->shaders.back().tessellationEvaluation.begin(), "stages/closeup.tesc.glsl");
    _scene->removeEffect(_closeUps);
    _scene->addEffect(passes);
    draw();
    ASSERT_EQ(passes->programs.size(), 4u);
    EXPECT_EQ(passes->programs[0], passes->programs[1]);
    for (const std::size_t other : {2u, 3u})
    {
        ASSERT_TRUE(passes->programs[other]);
        for (std::size_t i = 0; i < other; ++i)
            EXPECT_NE(passes->programs[i], passes->programs[other]) << i << ", " << other;
    }
    const auto texts = [](const osg::Program& program)
    {
        std::string all;
        for (unsigned int i = 0; i < program.getNumShaders(); ++i)
            all += program.getShader(i)->getShaderSource();
        return all;
    };
    EXPECT_NE(texts(*passes->programs[0]), texts(*passes->programs[2]));
}
