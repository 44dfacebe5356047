// SPDX-License-Identifier: MIT
// SPDX-FileCopyrightText: 2026 the osgGeoFX authors
//
// The two pipelines of CloseUps draw the same picture of the same geometry: at most 0.1 % of the pixels differ by more than
// 2 of 255. Not all are alike, since a geometry shader moves a layer's picture by an addition in clip space and a pass of its
// own by the viewport, which are rounded apart by 1/256 of a pixel.
#include <tools/CloseUpStage.h>
#include <tools/GlRequired.h>
#include <tools/ImageComparison.h>
#include <tools/LookFixture.h>

#include <osg/Fog>
#include <osg/LOD>
#include <osg/LightModel>
#include <osg/Program>
#include <osgGeoFX/deformation/VerticalExaggeration.h>

using namespace osgGeoFX;
using namespace geofx::test;

namespace
{

constexpr double most = 0.001;
/// Where both pipelines draw the same pixels, how many of them are alike says little without how many there are.
constexpr double drawnAtLeast = 0.01;

osg::ref_ptr<ProjectiveMapping> makeSpot(const osg::Vec2d& center, double half, const osg::Vec3d& color,
                                         int channels)
{
    osg::ref_ptr<ProjectiveMapping> mapping = new ProjectiveMapping;
    mapping->setRectangle(center, half, half);
    mapping->getTransfer()->setSource(ColorTransfer::CONSTANT);
    mapping->getTransfer()->setConstant(osg::Vec4d(color, 0.8));
    mapping->setChannels(channels);
    return mapping;
}

class CloseUpPipelines : public CloseUpStage
{
protected:
    void expectAlike(const std::string& name, bool alsoDrawn = true)
    {
        const auto [single, multiple] = drawBoth();
        const double share = differing(*single, *multiple);
        _worst = std::max(_worst, share);
        if (share > most)
        {
            EXPECT_TRUE(imagesMatch(*single, *multiple, {2.1f / 255.0f, most, 1.0f}, name));
        }
        _closeUps->setEnabled(false);
        const double drawn = differing(*single, *draw());
        _closeUps->setEnabled(true);
        if (alsoDrawn)
        {
            EXPECT_GT(drawn, drawnAtLeast);
        }
        _drawn += drawn > drawnAtLeast ? 1 : 0;
    }

    double _worst = 0.0;
    int _drawn = 0;
};

/// The states that OpenGL's fixed functions know, which the geometry stage must hand on.
class CloseUpLooks : public LookFixture
{
protected:
    void expectAlike(const std::string& name, const Build& build)
    {
        SCOPED_TRACE(name);
        const osg::ref_ptr<osg::Group> root = new osg::Group;
        const osg::ref_ptr<EffectScene> scene = new EffectScene;
        root->addChild(scene);
        build({*root, *scene});
        const osg::ref_ptr<CloseUps> closeUps = new CloseUps;
        scene->addEffect(closeUps);
        for (const double side : {-1.0, 1.0})
        {
            osg::ref_ptr<CloseUp> closeUp = new CloseUp;
            closeUp->getRegion()->setCenter({2.0 * side, 0.0});
            closeUp->getRegion()->setSize(3.0, 3.0);
            closeUp->setOffset({0.0, 1.0, 2.0});
            closeUp->setTilt(0.4 * side);
            closeUps->addCloseUp(closeUp);
        }
        closeUps->setPipeline(CloseUps::SINGLE_PASS);
        const osg::ref_ptr<osg::Image> single = render(root);
        EXPECT_EQ(closeUps->statistics().pipeline, CloseUps::SINGLE_PASS);
        closeUps->setPipeline(CloseUps::MULTI_PASS);
        const osg::ref_ptr<osg::Image> multiple = render(root);
        EXPECT_TRUE(imagesMatch(*single, *multiple, {2.1f / 255.0f, most, 1.0f}, name));
        closeUps->setEnabled(false);
        EXPECT_FALSE(
            std::equal(single->data(), single->data() + single->getTotalSizeInBytes(), render(root)->data()));
    }
};

} // namespace

TEST_F(CloseUpPipelines, AnySetUp)
{
    const int count = fullTest() ? 100 : 5;
    osg::ref_ptr<VerticalExaggeration> high = new VerticalExaggeration;
    osg::ref_ptr<ProjectiveMappings> before = new ProjectiveMappings;
    osg::ref_ptr<BirdsEyeView> bend = new BirdsEyeView;
    osg::ref_ptr<ProjectiveMappings> after = new ProjectiveMappings;
    after->setUnits(5, 6, 7);
    _scene->removeEffect(_closeUps);
    for (Effect* effect :
         {static_cast<Effect*>(high), static_cast<Effect*>(before), static_cast<Effect*>(bend),
          static_cast<Effect*>(_closeUps), static_cast<Effect*>(after)})
        _scene->addEffect(effect);
    const osg::ref_ptr<osg::Geometry> houses = makeHouses();
    _scene->addChild(houses);
    for (int channels = 1; channels < 4; ++channels)
    {
        before->addMapping(
            makeSpot(osg::Vec2d(250.0 * channels - 500.0, -100.0), 150.0, {0.9, 0.2, 0.3}, channels));
        after->addMapping(
            makeSpot(osg::Vec2d(-100.0, 250.0 * channels - 500.0), 100.0, {0.2, 0.3, 0.9}, channels));
    }
    const CloseUpPlan plan;
    _closeUps->setSurfaceData(makeSurfaceData(plan, 900.0));
    // What it adds follows from all close-ups that a triangle is copied into, so it is not the same geometry.
    _closeUps->setTessellation(1);
    for (int i = 0; i < count; ++i)
    {
        SCOPED_TRACE("set-up " + std::to_string(i));
        Random random(static_cast<std::uint64_t>(i));
        _closeUps->removeCloseUps();
        houses->setNodeMask(i % 2 ? ~0u : 0u);
        for (int number = random.integer(1, 7); number > 0; --number)
        {
            const osg::ref_ptr<CloseUp> closeUp = randomCloseUp(random, plan);
            // Where floors and roofs lie in one plane, rounding says which of them is seen.
            if (i % 2 && closeUp->getScaleHeight() == 0.0)
                closeUp->setScale(closeUp->getScaleX(), closeUp->getScaleY(), 0.5);
            _closeUps->addCloseUp(closeUp);
        }
        _closeUps->setSupersampling(random.integer(0, 2) ? 1 : random.integer(2, 3));
        _closeUps->setDepthTest(random.integer(0, 2) > 0);
        _closeUps->setOpacity(random.integer(0, 3) ? 1.0 : random.uniform(0.3, 1.0));
        high->setEnabled(random.integer(0, 3) == 0);
        high->setFactor(random.uniform(0.5, 2.0));
        before->setEnabled(random.integer(0, 1) == 0);
        bend->setEnabled(random.integer(0, 1) == 0);
        bend->setHorizonLine(random.uniform(0.7, 0.95));
        bend->setFocusLine(random.uniform(0.1, 0.5));
        after->setEnabled(random.integer(0, 1) == 0);
        lookAnyhow(random);
        expectAlike("set-up-" + std::to_string(i), false);
    }
    EXPECT_GT(_drawn, 3 * count / 4);
    RecordProperty("most pixels that differ, per cent", std::to_string(100.0 * _worst));
    std::cout << "pixels that differ: " << 100.0 * _worst << " % at most; " << _drawn << " of " << count
              << " set-ups show close-ups\n";
}

TEST_F(CloseUpPipelines, TessellatedWhereRegionsLieApart)
{
    const int count = fullTest() ? 40 : 4;
    CloseUpPlan plan;
    plan.reach = 60.0;
    plan.size = 250.0;
    for (int i = 0; i < count; ++i)
    {
        SCOPED_TRACE("set-up " + std::to_string(i));
        Random random(static_cast<std::uint64_t>(1000 + i));
        _closeUps->removeCloseUps();
        for (const double x : {-700.0, 0.0, 700.0})
        {
            plan.center.set(x, random.uniform(-600.0, 600.0));
            const osg::ref_ptr<CloseUp> closeUp = randomCloseUp(random, plan);
            closeUp->setRoundness(random.uniform(0.0, 1.0));
            _closeUps->addCloseUp(closeUp);
        }
        lookAnyhow(random);
        expectAlike("tessellated-" + std::to_string(i), false);
        if (_closeUps->statistics().tessellated) continue;
        float version = 0.0f;
        withContext([&](osg::State& state) { version = state.get<osg::GLExtensions>()->glVersion; });
        ASSERT_LT(version, 4.0f) << "OpenGL 4 is here, and nothing was tessellated";
        if (geofx::test::glIsRequired()) FAIL() << "tessellation needs OpenGL 4; here is " << version;
        GTEST_SKIP() << "tessellation needs OpenGL 4; here is " << version;
    }
    EXPECT_GT(_drawn, count / 2);
    std::cout << "pixels that differ: " << 100.0 * _worst << " % at most\n";
}

TEST_F(CloseUpPipelines, MoreThanOneUniformBlock)
{
    for (int i = 0; i < 65; ++i)
    {
        const int column = i % 8;
        const int row = i / 8;
        const osg::ref_ptr<CloseUp> closeUp =
            makeCloseUp(osg::Vec2d(220.0 * column - 800.0, 220.0 * row - 880.0), 160.0, 120.0);
        closeUp->getRegion()->setMaskSide(32);
        closeUp->setColor(
            osg::Vec3(0.2f + 0.1f * static_cast<float>(column), 0.9f, 0.1f * static_cast<float>(row)));
        closeUp->getAnchor()->setKind(static_cast<Anchor::Kind>(i % 3));
        closeUp->setTilt(0.1 * (i % 5));
        _closeUps->addCloseUp(closeUp);
    }
    _closeUps->getCloseUp(64)->setOffset({0.0, 0.0, 500.0});
    expectAlike("65");
    EXPECT_EQ(_closeUps->statistics().closeUps, 65);
    EXPECT_EQ(_closeUps->statistics().layers, 130);
    // The last one is in the second block, and is seen.
    const osg::ref_ptr<osg::Image> all = draw();
    _closeUps->getCloseUp(64)->setEnabled(false);
    EXPECT_GT(differing(*all, *draw()), 0.002);
}

TEST_F(CloseUpPipelines, RegionsThatOverlap)
{
    // More of them over one place than the geometry stage takes at a time.
    for (int i = 0; i < 7; ++i)
    {
        const osg::ref_ptr<CloseUp> closeUp =
            makeCloseUp(osg::Vec2d(60.0 * i - 180.0, 30.0 * i), 500.0, 100.0 + 100.0 * i);
        closeUp->setSaturation(0.3 * i);
        closeUp->setOffset({-500.0 + 160.0 * i, 0.0, 200.0 + 40.0 * i});
        closeUp->setScale(0.8, 0.8, 0.8);
        _closeUps->addCloseUp(closeUp);
    }
    expectAlike("overlapping");
    const osg::ref_ptr<osg::Image> all = draw();
    for (unsigned int i = 0; i < 7; ++i)
    {
        _closeUps->getCloseUp(i)->setEnabled(false);
        EXPECT_GT(differing(*all, *draw()), 0.002) << "close-up " << i << " is not seen";
        _closeUps->getCloseUp(i)->setEnabled(true);
    }
}

TEST_F(CloseUpPipelines, MappingsOfItsOwnChannels)
{
    osg::ref_ptr<ProjectiveMappings> mappings = new ProjectiveMappings;
    mappings->addMapping(makeSpot({0.0, 0.0}, 400.0, {1.0, 0.0, 0.0}, 1));
    mappings->addMapping(makeSpot({0.0, 0.0}, 400.0, {0.0, 0.0, 1.0}, 2));
    _scene->addEffect(mappings);
    const osg::ref_ptr<CloseUp> closeUp = makeCloseUp({0.0, 0.0}, 300.0);
    _closeUps->addCloseUp(closeUp);
    osg::ref_ptr<osg::Image> former;
    for (const int channels : {1, 2, 0, 255})
    {
        closeUp->setMappingChannels(channels);
        expectAlike("channels-" + std::to_string(channels));
        const osg::ref_ptr<osg::Image> now = draw();
        if (former)
        {
            EXPECT_GT(differing(*former, *now, 20), 0.005) << channels;
        }
        former = now;
    }
}

TEST_F(CloseUpPipelines, TooManyLayersAreDrawnByTheOtherPipeline)
{
    for (int i = 0; i < 3; ++i)
        _closeUps->addCloseUp(makeCloseUp(osg::Vec2d(500.0 * i - 500.0, 0.0)));
    _closeUps->setPipeline(CloseUps::SINGLE_PASS);
    const osg::ref_ptr<osg::Image> single = draw();
    _closeUps->setMaxLayers(4);
    osg::ref_ptr<osg::Image> limited;
    const std::vector<std::string> said = watch().messagesOf(
        [&]
        {
            limited = draw();
            limited = draw();
        });
    ASSERT_EQ(said.size(), 1u);
    EXPECT_NE(said[0].find("layers"), std::string::npos) << said[0];
    EXPECT_EQ(_closeUps->statistics().pipeline, CloseUps::MULTI_PASS);
    EXPECT_EQ(_closeUps->statistics().closeUps, 3);
    EXPECT_TRUE(imagesMatch(*single, *limited, {2.1f / 255.0f, most, 1.0f}));
    // Again as many as there is room for.
    _closeUps->removeCloseUp(_closeUps->getCloseUp(2));
    draw();
    EXPECT_EQ(_closeUps->statistics().pipeline, CloseUps::SINGLE_PASS);
}

TEST_F(CloseUpPipelines, LinesPointsAndShadersOfTheirOwnAreDrawnByTheOtherPipeline)
{
    const auto strange = [](GLenum mode, bool program)
    {
        osg::ref_ptr<osg::Geometry> geometry = makeHills(150.0, 6);
        geometry->setPrimitiveSet(0, new osg::DrawArrays(mode, 0, 48));
        geometry->getOrCreateStateSet()->setMode(GL_LIGHTING, osg::StateAttribute::OFF);
        if (!program) return geometry;
        osg::ref_ptr<osg::Program> own = new osg::Program;
        own->addShader(new osg::Shader(osg::Shader::FRAGMENT,
                                       "void main() { gl_FragColor = vec4(1.0, 0.0, 1.0, 1.0); }"));
        geometry->getOrCreateStateSet()->setAttributeAndModes(own);
        return geometry;
    };
    for (const auto& [mode, program] :
         {std::pair<GLenum, bool>(GL_LINES, false), {GL_POINTS, false}, {GL_TRIANGLES, true}})
    {
        SCOPED_TRACE(::testing::Message() << "mode " << mode);
        osg::ref_ptr<CloseUps> fresh = new CloseUps;
        fresh->addCloseUp(makeCloseUp({0.0, 0.0}));
        fresh->setPipeline(CloseUps::SINGLE_PASS);
        _scene->removeEffect(_scene->getEffect(0));
        _scene->addEffect(fresh);
        const osg::ref_ptr<osg::Image> without = draw();
        EXPECT_EQ(fresh->statistics().pipeline, CloseUps::SINGLE_PASS);
        const osg::ref_ptr<osg::Geometry> guest = strange(mode, program);
        _scene->addChild(guest);
        osg::ref_ptr<osg::Image> with;
        const std::vector<std::string> said = watch().messagesOf(
            [&]
            {
                draw();
                with = draw();
            });
        EXPECT_EQ(said.size(), 1u) << ::testing::PrintToString(said);
        EXPECT_EQ(fresh->statistics().pipeline, CloseUps::MULTI_PASS);
        // Automatic says nothing, and takes the same way.
        fresh->setPipeline(CloseUps::AUTOMATIC);
        EXPECT_TRUE(same(*with, *draw()));
        EXPECT_EQ(fresh->statistics().pipeline, CloseUps::MULTI_PASS);
        _scene->removeChild(guest);
    }
}

// What is magnified is drawn from finer levels than the overview's, which a single pass does not have.
TEST_F(CloseUpPipelines, MagnifiedLevelsOfDetailTakePassesOfTheirOwn)
{
    const osg::ref_ptr<osg::Node> ground = _scene->getChild(0);
    osg::ref_ptr<osg::LOD> levels = new osg::LOD;
    levels->addChild(ground, 0.0f, 1e9f);
    for (const double scale : {1.0, 2.0})
    {
        for (osg::Node* below : {ground.get(), static_cast<osg::Node*>(levels)})
        {
            SCOPED_TRACE(::testing::Message() << "scale " << scale << (below == levels ? ", levels" : ""));
            osg::ref_ptr<CloseUps> fresh = new CloseUps;
            // Over one drawable, which a single pass draws once for both.
            for (const double x : {-150.0, 150.0})
            {
                const osg::ref_ptr<CloseUp> closeUp = makeCloseUp({x, 0.0});
                closeUp->setScale(scale, scale, scale);
                fresh->addCloseUp(closeUp);
            }
            fresh->setPipeline(CloseUps::AUTOMATIC);
            _scene->removeEffect(_scene->getEffect(0));
            _scene->addEffect(fresh);
            _scene->setChild(0, below);
            draw();
            draw();
            EXPECT_EQ(fresh->statistics().pipeline,
                      scale > 1.0 && below == levels ? CloseUps::MULTI_PASS : CloseUps::SINGLE_PASS);
        }
    }
}

TEST_F(CloseUpLooks, HandOnWhatOpenGlKnows)
{
    expectAlike("plain", [](const Place& place) { place.scene.addChild(makeWaves()); });
    expectAlike("lit from both sides",
                [](const Place& place)
                {
                    addSun(place);
                    place.scene.addChild(makeWaves());
                    place.state().setAttributeAndModes(makeMaterial(20.0f));
                    osg::ref_ptr<osg::LightModel> model = new osg::LightModel;
                    model->setTwoSided(true);
                    place.state().setAttributeAndModes(model);
                });
    expectAlike("specular color apart",
                [](const Place& place)
                {
                    addSun(place);
                    place.scene.addChild(makeWaves());
                    addTexture(place.state(), 0, GL_RGB, osg::TexEnv::MODULATE);
                    place.state().setAttributeAndModes(makeMaterial(20.0f));
                    osg::ref_ptr<osg::LightModel> model = new osg::LightModel;
                    model->setColorControl(osg::LightModel::SEPARATE_SPECULAR_COLOR);
                    place.state().setAttributeAndModes(model);
                });
    expectAlike("four textures",
                [](const Place& place)
                {
                    place.scene.addChild(makeWaves());
                    addTexture(place.state(), 0, GL_RGB, osg::TexEnv::MODULATE);
                    addTexture(place.state(), 1, GL_RGBA, osg::TexEnv::DECAL);
                    addTexture(place.state(), 2, GL_RGB, osg::TexEnv::BLEND);
                    addTexture(place.state(), 3, GL_RGBA, osg::TexEnv::ADD);
                });
    expectAlike("fog",
                [](const Place& place)
                {
                    place.scene.addChild(makeWaves());
                    osg::ref_ptr<osg::Fog> fog = new osg::Fog;
                    fog->setMode(osg::Fog::LINEAR);
                    fog->setStart(10.0f);
                    fog->setEnd(20.0f);
                    fog->setColor({0.9f, 0.6f, 0.5f, 1.0f});
                    place.state().setAttributeAndModes(fog);
                });
    expectAlike("strips",
                [](const Place& place)
                {
                    place.scene.addChild(makeWaves(GL_TRIANGLE_STRIP));
                    addSun(place);
                });
}
