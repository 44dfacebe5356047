// SPDX-License-Identifier: MIT
// SPDX-FileCopyrightText: 2026 the osgGeoFX authors
//
// Lists of effects that change while they are drawn: always the picture of a scene that was made as it is now.
#include <osgGeoFX/deformation/VerticalExaggeration.h>
#include <osgGeoFX/effect/PassEffect.h>
#include <tools/CloseUpStage.h>
#include <tools/ImageComparison.h>
#include <tools/TempDir.h>

#include <cstdlib>

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

// A shader file that is broken while a program runs: what was given out stays as it is, and nothing is thrown at OSG.
TEST_F(EffectChanges, ABrokenShaderFileIsSaidAndNothingElse)
{
    _scene->removeEffect(_closeUps);
    const osg::ref_ptr<osg::Program> program = new osg::Program;
    program->addShader(new osg::Shader(
        osg::Shader::VERTEX,
        "#version 330 compatibility\n"
        "vec4 geofx_vertex(vec4 eyePosition);\n"
        "void main()\n{\n"
        "    gl_Position = gl_ProjectionMatrix * geofx_vertex(gl_ModelViewMatrix * gl_Vertex);\n"
        "    gl_FrontColor = vec4(gl_Normal, 1.0);\n}\n"));
    program->addShader(new osg::Shader(osg::Shader::FRAGMENT, "#version 330 compatibility\n"
                                                              "void main() { gl_FragColor = gl_Color; }\n"));
    _scene->addFunctions(*program);
    _scene->getChild(0)->getOrCreateStateSet()->setAttribute(program);
    const osg::ref_ptr<osg::Image> plain = draw();
    const osg::ref_ptr<VerticalExaggeration> lift = new VerticalExaggeration;
    lift->setFactor(3.0);
    const TempDir folder;
    folder.write("stages/functions.vert", "#version 330 compatibility\n#include \"lib/missing.glsl\"\n");
    ASSERT_EQ(setenv("OSGGEOFX_SHADER_PATH", folder.path().c_str(), 1), 0);
    _scene->addEffect(lift);
    osg::ref_ptr<osg::Image> broken;
    std::vector<std::string> said;
    EXPECT_NO_THROW(said = watch().messagesOf([&] { broken = draw(); }));
    ASSERT_EQ(said.size(), 1u) << ::testing::PrintToString(said);
    EXPECT_NE(said.front().find("missing.glsl"), std::string::npos) << said.front();
    ASSERT_TRUE(broken);
    EXPECT_TRUE(same(*plain, *broken)) << "as it was before the effect came";
    EXPECT_TRUE(same(*plain, *draw())) << "and it is not said again";
    // Repaired, and the effects change: all is well again.
    unsetenv("OSGGEOFX_SHADER_PATH");
    _scene->removeEffect(lift);
    EXPECT_TRUE(same(*plain, *draw()));
    _scene->addEffect(lift);
    EXPECT_GT(differing(*plain, *draw()), 0.05);
}

// Tiles that are gone go wholly, arrays and states too, whatever the number of the frame.
TEST_F(EffectChanges, NothingKeepsTheDeadAlive)
{
    _scene->addEffect(new BirdsEyeView);
    for (const CloseUps::Pipeline pipeline : {CloseUps::SINGLE_PASS, CloseUps::MULTI_PASS})
    {
        SCOPED_TRACE(pipeline);
        _closeUps->setPipeline(pipeline);
        osg::ref_ptr<osg::Geometry> hills = makeHills();
        hills->setStateSet(new osg::StateSet);
        const osg::observer_ptr<osg::Geometry> drawable = hills;
        const osg::observer_ptr<osg::Array> vertices = hills->getVertexArray();
        const osg::observer_ptr<osg::StateSet> state = hills->getStateSet();
        _scene->addChild(hills);
        draw();
        draw();
        EXPECT_GT(_closeUps->statistics().closeUps, 0);
        _scene->removeChild(hills);
        hills = nullptr;
        for (int frame = 0; frame < 4; ++frame)
            draw();
        EXPECT_FALSE(drawable.valid());
        EXPECT_FALSE(vertices.valid());
        EXPECT_FALSE(state.valid());
    }
}
