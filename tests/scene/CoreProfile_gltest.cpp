// SPDX-License-Identifier: MIT
// SPDX-FileCopyrightText: 2026 the osgGeoFX authors
//
// A context without OpenGL's fixed functions: the effects draw what they draw in one with the compatibility profile.
#include <osgGeoFX/closeup/CloseUps.h>
#include <osgGeoFX/deformation/PedestrianView.h>
#include <osgGeoFX/deformation/VerticalExaggeration.h>
#include <osgGeoFX/effect/detail/ProfileProgram.h>
#include <osgGeoFX/panorama/PanoramaManipulator.h>
#include <osgGeoFX/panorama/PanoramaMap.h>
#include <osgGeoFX/scene/CoreProfile.h>
#include <osgGeoFX/viewer/EarthSky.h>
#include <osgGeoFX/viewer/EffectKinds.h>
#include <tools/CloseUpStage.h>
#include <tools/CoreView.h>
#include <tools/PanoramaHills.h>
#include <tools/RandomSamples.h>

#include <osg/GLExtensions>
#include <osg/Program>

#include <algorithm>
#include <array>
#include <cstdlib>

using namespace osgGeoFX;
using namespace geofx::test;

namespace
{

constexpr int WIDTH = 240, HEIGHT = 160;

/// The program of an application, in both profiles: `calls`, it calls the effects' functions.
osg::ref_ptr<osg::Program> makeProgram(bool core, bool calls)
{
    const std::string version = core ? "#version 330 core\n" : "#version 330 compatibility\n";
    const std::string vertex = calls ? "vec4 geofx_vertex(vec4 eye);\n#define MOVED(eye) geofx_vertex(eye)\n"
                                       "vec3 geofx_normal(vec4 eye, vec3 normal);\n"
                                       "#define TURNED(eye, normal) geofx_normal(eye, normal)\n"
                                     : "#define MOVED(eye) eye\n#define TURNED(eye, normal) normal\n";
    const std::string fragment = calls ? "vec4 geofx_fragment(vec4 color, vec4 map);\n"
                                         "#define COLORED(color) geofx_fragment(color, vec4(0.0))\n"
                                       : "#define COLORED(color) color\n";
    osg::ref_ptr<osg::Program> program = new osg::Program;
    program->addShader(new osg::Shader(
        osg::Shader::VERTEX, version + vertex +
                                 "out vec3 normal;\nout vec2 place;\nvoid main()\n{\n"
                                 "    vec4 eye = gl_ModelViewMatrix * gl_Vertex;\n"
                                 "    normal = TURNED(eye, normalize(gl_NormalMatrix * gl_Normal));\n"
                                 "    place = gl_MultiTexCoord0.xy;\n"
                                 "    gl_Position = gl_ProjectionMatrix * MOVED(eye);\n}\n"));
    program->addShader(new osg::Shader(
        osg::Shader::FRAGMENT, version + fragment +
                                   "in vec3 normal;\nin vec2 place;\nout vec4 color;\nvoid main()\n{\n"
                                   "    vec3 tint = mix(vec3(0.3, 0.6, 0.3), vec3(0.7, 0.6, 0.4), step(0.5, "
                                   "fract(place.x * 10.0)));\n"
                                   "    tint *= 0.4 + 0.6 * abs(normalize(normal).z);\n"
                                   "    color = COLORED(vec4(tint, 1.0));\n}\n"));
    return program;
}

class CoreProfile : public GlFixture
{
protected:
    CoreProfile() : GlFixture(WIDTH, HEIGHT) {}

    void SetUp() override
    {
        GlFixture::SetUp();
        if (HasFailure() || IsSkipped()) return;
        _core = std::make_unique<CoreView>(WIDTH, HEIGHT);
        ASSERT_TRUE(_core->valid());
        // As in the core profile. NVIDIA's driver rounds the mipmaps of the older way otherwise, and the brush moves strokes by them.
        osg::GraphicsContext& here = *viewer().getCamera()->getGraphicsContext();
        here.makeCurrent();
        osg::GLExtensions::Get(here.getState()->getContextID(), true)->preferGenerateMipmapSGISForPowerOfTwo =
            false;
        here.releaseContext();
        look({0.0, -1700.0, 900.0}, {0.0, 0.0, 100.0});
    }
    void TearDown() override
    {
        for (const std::string& error : _core->errors)
            ADD_FAILURE() << error;
        _core = nullptr;
        GlFixture::TearDown();
    }

    void look(const osg::Vec3d& eye, const osg::Vec3d& at, double near = 100.0, double far = 20000.0)
    {
        osg::Camera& camera = *viewer().getCamera();
        camera.setComputeNearFarMode(osg::Camera::DO_NOT_COMPUTE_NEAR_FAR);
        camera.setViewMatrixAsLookAt(eye, at, osg::Z_AXIS);
        camera.setProjectionMatrixAsPerspective(45.0, 1.5, near, far);
    }

    /// The picture of a scene in both contexts. The share of pixels that are off by more than 2 of 255 is at most `share`.
    /// `make` gives the scene for a program of the application.
    osg::ref_ptr<osg::Image> expectSame(const std::function<osg::ref_ptr<osg::Node>(osg::Program*)>& make,
                                        bool calls = true, double share = 0.002)
    {
        const osg::ref_ptr<osg::Node> here = make(makeProgram(false, calls));
        const osg::ref_ptr<osg::Node> there = make(makeProgram(true, calls));
        if (!calls)
        {
            EffectScene::adapt(*_adapted[0]);
            EffectScene::adapt(*_adapted[1]);
        }
        render(here);
        const osg::ref_ptr<osg::Image> wanted = render(here);
        osg::ref_ptr<osg::Image> drawn;
        const std::vector<std::string> messages =
            watch().messagesOf([&] { drawn = _core->render(there, *viewer().getCamera(), 2); });
        for (const std::string& message : messages)
            // What OSG says of the errors of its own calls.
            if (message.find("detected OpenGL error") == std::string::npos) ADD_FAILURE() << message;
        int off = 0;
        const int count = 4 * WIDTH * HEIGHT;
        for (int i = 0; i < count; i += 4)
        {
            int largest = 0;
            for (int c = 0; c < 3; ++c)
                largest = std::max(largest, std::abs(wanted->data()[i + c] - drawn->data()[i + c]));
            off += largest > 2 ? 1 : 0;
        }
        EXPECT_LE(off, share * WIDTH * HEIGHT);
        return drawn;
    }

    std::array<osg::ref_ptr<osg::Program>, 2> _adapted;
    std::unique_ptr<CoreView> _core;
};

/// Ground and close-ups of another fixture.
struct Samples : public CloseUpStage
{
    using CloseUpStage::makeCloseUp;
    using CloseUpStage::makeHills;
    void TestBody() override {}
};

class CoreProfileHills : public CoreProfile
{
protected:
    /// Hills under some effects.
    osg::ref_ptr<osg::Image> expectSameHills(const std::function<void(EffectScene&)>& addEffects,
                                             bool calls = true, double share = 0.002)
    {
        const osg::ref_ptr<osg::Image> plain = picture([](EffectScene&) {}, calls, share);
        const osg::ref_ptr<osg::Image> drawn = picture(addEffects, calls, share);
        EXPECT_FALSE(std::equal(plain->data(), plain->data() + plain->getTotalSizeInBytes(), drawn->data()))
            << "the effect does nothing";
        return drawn;
    }

private:
    osg::ref_ptr<osg::Image> picture(const std::function<void(EffectScene&)>& addEffects, bool calls,
                                     double share)
    {
        int turn = 0;
        return expectSame(
            [&](osg::Program* program)
            {
                osg::ref_ptr<EffectScene> scene = new EffectScene;
                scene->addChild(Samples::makeHills());
                if (calls) EffectScene::addFunctions(*program);
                _adapted[static_cast<std::size_t>(turn++)] = program;
                scene->getOrCreateStateSet()->setAttribute(program);
                addEffects(*scene);
                return scene;
            },
            calls, share);
    }
};

osg::ref_ptr<ProjectiveMappings> makeMappings()
{
    osg::ref_ptr<ProjectiveMapping> mapping = new ProjectiveMapping;
    mapping->setRectangle({100.0, 50.0}, 500.0, 350.0, 0.3);
    mapping->getTransfer()->setSource(ColorTransfer::CONSTANT);
    mapping->getTransfer()->setConstant({0.9, 0.1, 0.1, 0.7});
    osg::ref_ptr<ProjectiveMappings> mappings = new ProjectiveMappings;
    mappings->addMapping(mapping);
    return mappings;
}

osg::ref_ptr<osgGeoFX::CloseUps> makeCloseUps()
{
    osg::ref_ptr<osgGeoFX::CloseUps> closeUps = new osgGeoFX::CloseUps;
    closeUps->addCloseUp(Samples::makeCloseUp({0.0, 0.0}));
    return closeUps;
}

} // namespace

TEST_F(CoreProfileHills, BirdsEyeView)
{
    expectSameHills([](EffectScene& scene) { scene.addEffect(new BirdsEyeView); });
}

TEST_F(CoreProfileHills, PedestrianView)
{
    look({0.0, -950.0, 150.0}, {0.0, 0.0, 100.0}, 5.0);
    expectSameHills([](EffectScene& scene) { scene.addEffect(new PedestrianView); });
}

TEST_F(CoreProfileHills, VerticalExaggeration)
{
    expectSameHills(
        [](EffectScene& scene)
        {
            osg::ref_ptr<osgGeoFX::VerticalExaggeration> effect = new osgGeoFX::VerticalExaggeration;
            effect->setFactor(3.0);
            scene.addEffect(effect);
        });
}

TEST_F(CoreProfileHills, Mappings)
{
    expectSameHills([](EffectScene& scene) { scene.addEffect(makeMappings()); });
}

TEST_F(CoreProfileHills, CloseUps)
{
    expectSameHills([](EffectScene& scene) { scene.addEffect(makeCloseUps()); });
}

TEST_F(CoreProfileHills, SeveralAtOnce)
{
    expectSameHills(
        [](EffectScene& scene)
        {
            scene.addEffect(new BirdsEyeView);
            scene.addEffect(makeMappings());
            scene.addEffect(makeCloseUps());
        });
}

TEST_F(CoreProfileHills, AdaptedProgramsOfApplications)
{
    expectSameHills(
        [](EffectScene& scene)
        {
            scene.addEffect(new BirdsEyeView);
            scene.addEffect(makeMappings());
        },
        false);
}

// Each pair of kinds, in a full test in both orders: its programs compile and link, and its passes draw without an error.
TEST_F(CoreProfileHills, EachPairOfEffects)
{
    const std::vector<std::string> kinds = effectKinds();
    for (std::size_t i = 0; i < kinds.size(); ++i)
    {
        for (std::size_t j = 0; j < kinds.size(); ++j)
        {
            // In the sample each effect is the first of one pair and the second of one.
            if (fullTest() ? i == j : j != (i + 1) % kinds.size()) continue;
            const std::string &first = kinds[i], &second = kinds[j];
            SCOPED_TRACE(first + " " + second);
            const osg::ref_ptr<osg::Program> program = makeProgram(true, true);
            EffectScene::addFunctions(*program);
            const osg::ref_ptr<EffectScene> scene = new EffectScene;
            scene->addChild(Samples::makeHills());
            scene->getOrCreateStateSet()->setAttribute(program);
            for (const std::string& kind : {first, second})
                scene->addEffect(kind == "closeUps"             ? makeCloseUps().get()
                                 : kind == "projectiveMappings" ? static_cast<Effect*>(makeMappings().get())
                                                                : createEffect(kind).get());
            osg::ref_ptr<osg::Image> drawn;
            const std::vector<std::string> messages =
                watch().messagesOf([&] { drawn = _core->render(scene, *viewer().getCamera(), 2); });
            for (const std::string& message : messages)
                EXPECT_TRUE(message.find("detected OpenGL error") != std::string::npos ||
                            message.find("at a time") != std::string::npos ||
                            message.find("finds no sun") != std::string::npos)
                    << message;
            EXPECT_GT(drawn->data(WIDTH / 2, HEIGHT / 3)[1], 0);
        }
    }
}

// Ground, woods, water with its mirror, sky and strokes.
TEST_F(CoreProfile, PanoramaMaps)
{
    PanoramaHills hills{0.8};
    viewer().getCamera()->setComputeNearFarMode(osg::Camera::DO_NOT_COMPUTE_NEAR_FAR);
    viewer().getCamera()->setProjectionMatrixAsPerspective(30.0, 1.5, 1000.0, 1e6);
    const auto make = [&](osg::Program* program)
    {
        EffectScene::addFunctions(*program);
        osg::ref_ptr<EffectScene> scene = new EffectScene;
        osg::ref_ptr<PanoramaMap> map = new PanoramaMap;
        map->setRipples(0.0); // each frame has another time
        scene->addEffect(map);
        osg::ref_ptr<osg::Node> terrain = hills.terrain();
        terrain->getOrCreateStateSet()->setAttribute(program);
        scene->addChild(terrain);
        const osg::ref_ptr<PanoramaManipulator> hand = new PanoramaManipulator(*scene, *map);
        hand->setCameraProjection(viewer().getCamera()->getProjectionMatrix());
        hand->setWidth(40000.0);
        EXPECT_TRUE(hand->setCenter(hills.middle()));
        hand->updateCamera(*viewer().getCamera());
        return scene;
    };
    const osg::ref_ptr<osg::Image> drawn = expectSame(make, true, 0.01);
    // The sky is drawn, too.
    EXPECT_GT(drawn->data(WIDTH / 2, HEIGHT - 2)[2], 100);
}

TEST_F(CoreProfile, TheSkyOfTheEarth)
{
    const osg::ref_ptr<osg::EllipsoidModel> globe = new osg::EllipsoidModel;
    look({2.5e7, 0.0, 0.0}, {0.0, 0.0, 0.0}, 1e5, 1e8);
    expectSame(
        [&](osg::Program*)
        {
            osg::ref_ptr<osg::Group> root = new osg::Group;
            root->addChild(makeEarthSky(*globe, {0.7f, 0.8f, 0.9f}));
            return root;
        });
}

// Nothing is drawn that has no program, and one sentence says why.
TEST_F(CoreProfile, TheStandInForFixedFunctionsSaysThatItNeedsCompatibility)
{
    osg::ref_ptr<EffectScene> scene = new EffectScene;
    scene->addEffect(new BirdsEyeView);
    scene->addChild(Samples::makeHills());
    osg::ref_ptr<osg::Image> drawn;
    const std::vector<std::string> messages =
        watch().messagesOf([&] { drawn = _core->render(scene, *viewer().getCamera(), 3); });
    ASSERT_EQ(messages.size(), 1u);
    EXPECT_NE(messages[0].find("needs a context with the compatibility profile"), std::string::npos)
        << messages[0];
    EXPECT_EQ(drawn->data(WIDTH / 2, HEIGHT / 2)[1], 0);
}

TEST(ProfileProgram, TranslatesWhatTheKitWrote)
{
    const std::string text =
        "#version 330 compatibility\nvoid main()\n{\n"
        "    gl_ClipVertex = vec4(0.0);\n    gl_Position = gl_ProjectionMatrix * gl_Vertex;\n}\n";
    EXPECT_EQ(ProfileProgram::coreText(text, osg::Shader::VERTEX),
              "#version 330 core\n#define GEOFX_CORE\nvec4 geofx_clipVertex; \n#line 2\nvoid main()\n{\n"
              "    geofx_clipVertex = vec4(0.0);\n    gl_Position = gl_ProjectionMatrix * gl_Vertex;\n}\n");
    EXPECT_EQ(ProfileProgram::coreText("#version 400 compatibility\nvec4 gl_FragColors = gl_FragColor;\n",
                                       osg::Shader::FRAGMENT),
              "#version 400 core\n#define GEOFX_CORE\nout vec4 geofx_fragColor; \n#line 2\n"
              "vec4 gl_FragColors = geofx_fragColor;\n");
    EXPECT_EQ(ProfileProgram::coreText("#version 330 compatibility\nmat3 m = gl_NormalMatrix;\n",
                                       osg::Shader::GEOMETRY),
              "#version 330 core\n#define GEOFX_CORE\nuniform mat3 osg_NormalMatrix; \n#line 2\n"
              "mat3 m = osg_NormalMatrix;\n");
}

TEST(ProfileProgram, ShadersOfApplicationsStayAsTheyAre)
{
    const osg::ref_ptr<ProfileProgram> program = new ProfileProgram;
    const osg::ref_ptr<osg::Shader> own =
        new osg::Shader(osg::Shader::FRAGMENT, "#version 330 core\nvoid main() {}\n");
    program->addShader(own);
    const osg::ref_ptr<osg::Shader> kits = ProfileProgram::createShader(
        osg::Shader::VERTEX, "#version 330 compatibility\nvoid main() {}\n", "a kit's");
    program->addShader(kits);
    program->addBindUniformBlock("block", 3);
    const osg::ref_ptr<osg::Program> core = program->core();
    ASSERT_TRUE(core);
    ASSERT_EQ(core->getNumShaders(), 2u);
    EXPECT_EQ(core->getShader(0), own);
    EXPECT_NE(core->getShader(1), kits);
    EXPECT_EQ(core->getUniformBlockBindingList().at("block"), 3u);
    // Translations are shared, so that they are compiled once.
    const osg::ref_ptr<ProfileProgram> other = new ProfileProgram(static_cast<const osg::Program&>(*program));
    EXPECT_EQ(other->core()->getShader(1), core->getShader(1));
}
