// SPDX-License-Identifier: MIT
// SPDX-FileCopyrightText: 2026 the osgGeoFX authors
// What effects have on the GPU: how much of it there is, that it goes when it is released, and what becomes of it when
// contexts close and open.
#include <bench/GlObjectCount.h>
#include <osgGeoFX/panorama/PanoramaMap.h>
#include <tools/CloseUpStage.h>
#include <tools/SampledCases.h>

#include <osg/Texture2D>

#include <algorithm>

using namespace osgGeoFX;
using namespace geofx::test;
using geofx::bench::GlObjectCount;

namespace
{

osg::ref_ptr<ProjectiveMappings> makeMappings(double shift)
{
    osg::ref_ptr<osg::Image> image = new osg::Image;
    image->allocateImage(32, 32, 1, GL_RGBA, GL_UNSIGNED_BYTE);
    for (int i = 0; i < 32 * 32; ++i)
    {
        unsigned char* texel = image->data() + 4 * i;
        texel[0] = static_cast<unsigned char>(8 * (i % 32));
        texel[1] = static_cast<unsigned char>(8 * (i / 32));
        texel[2] = static_cast<unsigned char>(120);
        texel[3] = static_cast<unsigned char>(160);
    }
    const osg::ref_ptr<ProjectiveMapping> picture = new ProjectiveMapping;
    picture->setLayer(new DataLayer(image));
    picture->setRectangle({shift, 0.0}, 300.0, 400.0);
    const osg::ref_ptr<ProjectiveMapping> solid = new ProjectiveMapping;
    solid->setRectangle({shift, 100.0}, 150.0, 150.0);
    solid->setOpacity(0.6);
    solid->getTransfer()->setSource(ColorTransfer::CONSTANT);
    solid->getTransfer()->setConstant({1.0, 0.3, 0.1, 1.0});
    osg::ref_ptr<ProjectiveMappings> mappings = new ProjectiveMappings;
    mappings->addMapping(picture);
    mappings->addMapping(solid);
    return mappings;
}

/// Says whether its scene hands on what OSG tells it.
class ToldEffect : public BirdsEyeView
{
public:
    void resizeGLObjectBuffers(unsigned int size) override { resized = size; }
    void releaseGLObjects(osg::State*) const override { released = true; }
    unsigned int resized = 0;
    mutable bool released = false;
};

} // namespace

class GlObjects : public CloseUpStage
{
protected:
    void SetUp() override
    {
        CloseUpStage::SetUp();
        if (IsSkipped() || HasFatalFailure()) return;
        _scene->removeEffect(_closeUps);
        for (int i = 0; i < 3; ++i)
        {
            const osg::ref_ptr<CloseUp> closeUp = makeCloseUp(osg::Vec2d(450.0 * i - 450.0, 0.0), 350.0);
            closeUp->getAnchor()->setKind(static_cast<Anchor::Kind>(i));
            _closeUps->addCloseUp(closeUp);
        }
        _closeUps->setSurfaceData(makeSurfaceData({}, 900.0));
        _closeUps->getCloseUp(1)->setSurface("height");
        _panorama->setRipples(0.0);
        // Its ground says what lies on it, so that it has strokes.
        osg::ref_ptr<osg::Image> woods = new osg::Image;
        woods->allocateImage(4, 4, 1, GL_RGBA, GL_UNSIGNED_BYTE);
        for (unsigned int i = 0; i < 16; ++i)
            reinterpret_cast<osg::Vec4ub*>(woods->data())[i].set(200, 0, 255, 255);
        osg::ref_ptr<osg::Texture2D> cover = new osg::Texture2D(woods);
        cover->setFilter(osg::Texture::MIN_FILTER, osg::Texture::LINEAR);
        _scene->getChild(0)->getOrCreateStateSet()->setTextureAttribute(7, cover);
    }

    /// Whose zone lies in the picture.
    static osg::ref_ptr<BirdsEyeView> tessellated()
    {
        osg::ref_ptr<BirdsEyeView> bend = new BirdsEyeView;
        bend->setTessellation(true);
        return bend;
    }
    using NamedEffects = std::pair<const char*, std::vector<osg::ref_ptr<Effect>>>;
    /// All of nine; without --full each third one from `first`.
    std::vector<NamedEffects> all(std::size_t first)
    {
        const std::vector<NamedEffects> nine = {
            {"no effect", {}},
            {"bend", {new BirdsEyeView}},
            {"bend with tessellation", {tessellated()}},
            {"mappings", {makeMappings(0.0)}},
            {"two sets of mappings", {makeMappings(-300.0), makeMappings(200.0)}},
            {"close-ups", {_closeUps}},
            {"panorama map", {_panorama}},
            {"mappings in close-ups", {makeMappings(0.0), _closeUps, makeMappings(200.0)}},
            {"mappings in a panorama map", {_panorama, makeMappings(0.0), makeMappings(200.0)}}};
        return sampledCases(nine, 3, first);
    }
    void show(const std::vector<osg::ref_ptr<Effect>>& effects)
    {
        while (_scene->getNumEffects() > 0)
            _scene->removeEffect(_scene->getEffect(0));
        for (const osg::ref_ptr<Effect>& effect : effects)
            _scene->addEffect(effect);
    }
    /// The third frame: pipelines and reflections have settled by then.
    osg::ref_ptr<osg::Image> drawSettled()
    {
        draw();
        draw();
        return draw();
    }
    GlObjectCount count()
    {
        GlObjectCount result;
        withContext([&](osg::State& state) { result = GlObjectCount::of(state); });
        return result;
    }
    /// Another context in the place of the one that was.
    void reopen()
    {
        const osg::Matrixd view = viewer().getCamera()->getViewMatrix();
        const osg::Matrixd projection = viewer().getCamera()->getProjectionMatrix();
        GlFixture::TearDown();
        GlFixture::SetUp();
        osg::Camera& camera = *viewer().getCamera();
        camera.setComputeNearFarMode(osg::CullSettings::DO_NOT_COMPUTE_NEAR_FAR);
        camera.setClearColor({0.1f, 0.2f, 0.3f, 1.0f});
        camera.setViewMatrix(view);
        camera.setProjectionMatrix(projection);
        viewer().setLightingMode(osg::View::NO_LIGHT);
    }

    osg::ref_ptr<PanoramaMap> _panorama = new PanoramaMap;
};

TEST_F(GlObjects, AllThatASceneHasGoesWhenItIsReleased)
{
    const osg::ref_ptr<osg::Group> empty = new osg::Group;
    for (const auto& [what, effects] : all(1))
    {
        for (const CloseUps::Pipeline pipeline : {CloseUps::SINGLE_PASS, CloseUps::MULTI_PASS})
        {
            SCOPED_TRACE(what);
            // One for each: OSG goes on to draw from buffers that it knows, though they have been deleted.
            reopen();
            render(empty);
            const GlObjectCount none = count();
            _closeUps->setPipeline(pipeline);
            show(effects);
            drawSettled();
            EXPECT_GT(count().textures, none.textures);
            withContext([&](osg::State& state) { _root->releaseGLObjects(&state); });
            EXPECT_EQ(count(), none);
        }
    }
}

TEST_F(GlObjects, AnEffectThatIsElsewhereIsReleasedByItself)
{
    drawSettled();
    const GlObjectCount plain = count();
    for (const auto& [what, effects] : all(2))
    {
        SCOPED_TRACE(what);
        if (effects.empty() || effects[0]->asDeformation()) continue; // its program is the scene's
        show(effects);
        drawSettled();
        show({});
        for (const osg::ref_ptr<Effect>& effect : effects)
            effect->releaseGLObjects(nullptr);
        drawSettled();
        const GlObjectCount left = count();
        EXPECT_EQ(left.textures, plain.textures);
        EXPECT_EQ(left.frameBuffers, plain.frameBuffers);
    }
}

TEST_F(GlObjects, ContextsCloseAndOpen)
{
    _closeUps->setPipeline(CloseUps::MULTI_PASS); // AUTOMATIC goes by the last frame
    for (const auto& [what, effects] : all(0))
    {
        SCOPED_TRACE(what);
        show(effects);
        const osg::ref_ptr<osg::Image> expected = drawSettled();
        reopen();
        EXPECT_TRUE(same(*expected, *drawSettled()));
        // In another context: OSG draws on from buffers that it knows, though they have been deleted.
        withContext([&](osg::State& state) { _root->releaseGLObjects(&state); });
        reopen();
        EXPECT_TRUE(same(*expected, *drawSettled())) << "released, and drawn again";
    }
}

TEST_F(GlObjects, AScenesProgramsLetGoOfAContextThatCloses)
{
    // Programs of the application's own class have copies of this class.
    class OwnProgram : public osg::Program
    {
    public:
        OwnProgram() = default;
        OwnProgram(const OwnProgram& other, const osg::CopyOp& copy) : osg::Program(other, copy) {}
        osg::Object* cloneType() const override { return new OwnProgram; }
        osg::Object* clone(const osg::CopyOp& copy) const override { return new OwnProgram(*this, copy); }
    };
    for (const bool own : {false, true})
    {
        SCOPED_TRACE(own);
        osg::ref_ptr<osg::Program> program;
        if (own)
        {
            program = new OwnProgram;
            program->addShader(new osg::Shader(
                osg::Shader::VERTEX, "#version 330 compatibility\n"
                                     "vec4 geofx_vertex(vec4 eyePosition);\n"
                                     "void main()\n"
                                     "{\n"
                                     "    vec4 eye = geofx_vertex(gl_ModelViewMatrix * gl_Vertex);\n"
                                     "    gl_Position = gl_ProjectionMatrix * eye;\n"
                                     "}\n"));
            program->addShader(
                new osg::Shader(osg::Shader::FRAGMENT,
                                "#version 330 compatibility\n"
                                "vec4 geofx_fragment(vec4 color, vec4 map);\n"
                                "void main() { gl_FragColor = geofx_fragment(vec4(1.0), vec4(0.0)); }\n"));
            EffectScene::addFunctions(*program);
            _scene->getChild(0)->getOrCreateStateSet()->setAttributeAndModes(program);
        }
        const osg::ref_ptr<EffectScene> other = new EffectScene;
        other->addChild(makeHills());
        other->addEffect(new BirdsEyeView);
        show({new BirdsEyeView, makeMappings(0.0)});
        drawSettled();
        // The former scene lives on in no view of the context. OSG leaves what the application has there to the application.
        render(other);
        if (own) withContext([&](osg::State& state) { program->releaseGLObjects(&state); });
        reopen();
        render(other);
        const osg::ref_ptr<osg::Image> expected = render(other);
        // The names that the former scene's programs had are others' now.
        _root->releaseGLObjects(nullptr);
        count(); // deletes what has been released
        EXPECT_TRUE(same(*expected, *render(other))) << "what others have went with the scene";
        reopen();
    }
}

TEST_F(GlObjects, EffectsThatAreElsewhereLetGoOfAContextThatCloses)
{
    _closeUps->setPipeline(CloseUps::MULTI_PASS);
    // It has programs, textures and frame buffers of its own.
    const osg::ref_ptr<CloseUps> other = new CloseUps;
    other->setPipeline(CloseUps::MULTI_PASS);
    other->addCloseUp(makeCloseUp({0.0, 0.0}));
    for (const auto& [what, effects] : all(1))
    {
        SCOPED_TRACE(what);
        show(effects);
        const osg::ref_ptr<osg::Image> expected = drawSettled();
        show({other});
        const osg::ref_ptr<osg::Image> others = drawSettled();
        reopen();
        // The names that the effects had are others' now.
        EXPECT_TRUE(same(*others, *drawSettled()));
        for (const osg::ref_ptr<Effect>& effect : effects)
            effect->releaseGLObjects(nullptr);
        count(); // deletes what has been released
        EXPECT_TRUE(same(*others, *drawSettled())) << "what others have went with the effects";
        show(effects);
        EXPECT_TRUE(same(*expected, *drawSettled()));
        show({other});
        EXPECT_TRUE(same(*others, *drawSettled())) << "what others have went with the effects' former views";
    }
}

TEST_F(GlObjects, ScenesHandOnWhatTheyAreTold)
{
    const osg::ref_ptr<ToldEffect> told = new ToldEffect;
    _scene->addEffect(told);
    _root->resizeGLObjectBuffers(12);
    EXPECT_EQ(told->resized, 12u);
    EXPECT_FALSE(told->released);
    _root->releaseGLObjects(nullptr);
    EXPECT_TRUE(told->released);
    // More contexts than there were: all draw on as they did.
    _closeUps->setPipeline(CloseUps::MULTI_PASS);
    for (const auto& [what, effects] : all(2))
    {
        SCOPED_TRACE(what);
        show(effects);
        const osg::ref_ptr<osg::Image> expected = drawSettled();
        withContext([&](osg::State&) { _root->resizeGLObjectBuffers(40); });
        EXPECT_TRUE(same(*expected, *drawSettled()));
    }
}

TEST_F(GlObjects, MappingsKeepOffTheUnitsOfCloseUpsAndPanoramas)
{
    _closeUps->setPipeline(CloseUps::MULTI_PASS);
    for (const osg::ref_ptr<Effect>& other :
         {osg::ref_ptr<Effect>(_closeUps), osg::ref_ptr<Effect>(_panorama)})
    {
        SCOPED_TRACE(other->className());
        const osg::ref_ptr<ProjectiveMappings> first = makeMappings(-200.0);
        const osg::ref_ptr<ProjectiveMappings> second = makeMappings(150.0);
        const osg::ref_ptr<ProjectiveMappings> both = new ProjectiveMappings;
        for (const auto& set : {first, second})
        {
            for (unsigned int i = 0; i < set->getNumMappings(); ++i)
                both->addMapping(set->getMapping(i));
        }
        show({other, both});
        const osg::ref_ptr<osg::Image> expected = drawSettled();
        show({other, first});
        EXPECT_GT(differing(*expected, *drawSettled()), 0.01);
        show({other, first, second});
        EXPECT_LT(differing(*expected, *drawSettled()), 0.001);
        // What the other effect would have, and has to leave.
        second->setUnits(12, 4, 11);
        EXPECT_LT(differing(*expected, *drawSettled()), 0.001);
        first->setUnits(5, 13, 6);
        EXPECT_LT(differing(*expected, *drawSettled()), 0.001);
        first->setUnits(-1, -1, -1);
        second->setUnits(-1, -1, -1);
        EXPECT_LT(differing(*expected, *drawSettled()), 0.001);
    }
}

// ---------------------------------------------------------------------------------------------------------------------

/// A picture whose samples would be more than a texture has.
class WideCloseUps : public CloseUpStage
{
protected:
    WideCloseUps() : CloseUpStage(4800, 60) {}
};

TEST_F(WideCloseUps, AreSampledAsFinelyAsTheGpuCan)
{
    GLint most = 0;
    withContext([&](osg::State&) { glGetIntegerv(GL_MAX_TEXTURE_SIZE, &most); });
    if (most >= 4 * 4800) GTEST_SKIP() << "This GPU's textures are large enough.";
    const osg::ref_ptr<CloseUp> closeUp = makeCloseUp({0.0, 0.0}, 1500.0, 60.0);
    closeUp->setSaturation(0.0);
    _closeUps->addCloseUp(closeUp);
    _closeUps->setPipeline(CloseUps::MULTI_PASS);
    look({0.0, -3000.0, 900.0}, {0.0, 0.0, 60.0}, 4.0);
    const osg::ref_ptr<osg::Image> once = draw();
    for (const int samples : {3, 4})
    {
        _closeUps->setSupersampling(samples);
        osg::ref_ptr<osg::Image> drawn;
        const std::vector<std::string> said = watch().messagesOf(
            [&]
            {
                draw();
                drawn = draw();
            });
        EXPECT_EQ(said.size(), samples * 4800 > most ? 1u : 0u) << testing::PrintToString(said);
        EXPECT_LT(differing(*once, *drawn, 40), 0.02) << samples;
    }
}
