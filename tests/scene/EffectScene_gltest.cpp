// SPDX-License-Identifier: MIT
// SPDX-FileCopyrightText: 2026 the osgGeoFX authors
// What an EffectScene makes of the picture: focus and context, own shaders, what is left out, changes at run time, styles.
#include <osgGeoFX/deformation/PedestrianView.h>
#include <osgGeoFX/deformation/VerticalExaggeration.h>
#include <tools/BentGround.h>
#include <tools/ImageComparison.h>
#include <tools/RandomSamples.h>

#include <osg/Light>
#include <osg/LightSource>
#include <osg/Program>
#include <osg/Texture2D>

#include <cstdlib>
#include <cstring>

using namespace osgGeoFX;
using namespace geofx::test;

class EffectSceneTest : public BentGround
{
protected:
    /// Unlit and untextured, as stages/fixed.* draws it, with the calls, and a uniform and a define to see.
    static osg::ref_ptr<osg::Program> makeProgram(bool calls)
    {
        const std::string vertex =
            "#version 330 compatibility\n"
            "vec4 geofx_vertex(vec4 eyePosition);\n"
            "void main()\n{\n"
            "    vec4 eye = gl_ModelViewMatrix * gl_Vertex;\n" +
            std::string(calls ? "    vec4 deformed = geofx_vertex(eye);\n" : "    vec4 deformed = eye;\n") +
            "    gl_Position = deformed == eye ? ftransform() : gl_ProjectionMatrix * deformed;\n"
            "    gl_FrontColor = gl_Color;\n}\n";
        const std::string fragment =
            "#version 330 compatibility\n"
            "#pragma import_defines(GEOFX_DEFORMATION, SHOW_DEFINE)\n"
            "vec4 geofx_fragment(vec4 color, vec4 map);\n"
            "uniform float blue;\n"
            "void main()\n{\n" +
            std::string(calls ? "    vec4 color = geofx_fragment(gl_Color, vec4(0.0));\n"
                              : "    vec4 color = gl_Color;\n") +
            "#if defined(SHOW_DEFINE) && defined(GEOFX_DEFORMATION)\n"
            "    color = vec4(1.0, 0.0, blue, 1.0);\n"
            "#elif defined(SHOW_DEFINE)\n"
            "    color = vec4(0.0, 1.0, blue, 1.0);\n"
            "#endif\n"
            "    gl_FragColor = color;\n}\n";
        osg::ref_ptr<osg::Program> program = new osg::Program;
        program->addShader(new osg::Shader(osg::Shader::VERTEX, vertex));
        program->addShader(new osg::Shader(osg::Shader::FRAGMENT, fragment));
        return program;
    }

    static osg::ref_ptr<osg::Texture2D> makeMap()
    {
        osg::ref_ptr<osg::Image> image = new osg::Image;
        image->allocateImage(8, 8, 1, GL_RGB, GL_UNSIGNED_BYTE);
        for (unsigned int i = 0; i < image->getTotalSizeInBytes(); ++i)
            image->data()[i] = static_cast<unsigned char>(60 + 37 * i % 190);
        osg::ref_ptr<osg::Texture2D> map = new osg::Texture2D(image);
        map->setWrap(osg::Texture::WRAP_S, osg::Texture::REPEAT);
        map->setWrap(osg::Texture::WRAP_T, osg::Texture::REPEAT);
        return map;
    }

    /// The row of the picture where the bend begins.
    static int focusRow() { return static_cast<int>(HEIGHT * makeBend()->getFocusLine()); }
};

// ---------------------------------------------------------------------------------------------------------------------

TEST_F(EffectSceneTest, TheFocusIsKept)
{
    for (const bool lit : {false, true})
    {
        const auto dress = [&](const osg::ref_ptr<osg::Group>& group)
        {
            if (lit)
            {
                osg::ref_ptr<osg::LightSource> source = new osg::LightSource;
                source->getLight()->setPosition({-0.5f, -0.3f, 0.6f, 0});
                group->addChild(source);
                group->getOrCreateStateSet()->setMode(GL_LIGHTING, osg::StateAttribute::ON);
                group->getOrCreateStateSet()->setMode(GL_LIGHT0, osg::StateAttribute::ON);
                group->getOrCreateStateSet()->setTextureAttributeAndModes(0, makeMap());
            }
            return group;
        };
        const std::vector<osg::ref_ptr<osg::Node>> things = {makeGround(), makeBox(5, {-10, -80, 0}),
                                                             makeBox(8, {10, -90, 0})};
        const osg::ref_ptr<osg::Image> plain = render(dress(makePlain(things)));
        const osg::ref_ptr<osg::Image> bent = render(dress(makeScene(things)));
        int worst = 0;
        // A triangle across the line ends behind it: its cells are 2 m long, up to 3 pixels here.
        for (int row = 0; row < focusRow() - 3; ++row)
        {
            for (int i = 0; i < 4 * WIDTH; ++i)
                worst = std::max(worst, std::abs(plain->data(0, row)[i] - bent->data(0, row)[i]));
        }
        // Rounding to 8 bits.
        EXPECT_LE(worst, 1) << (lit ? "lit" : "unlit");
        EXPECT_GT(differing(*plain, *bent, focusRow(), HEIGHT), WIDTH * HEIGHT / 3);
    }
}

TEST_F(EffectSceneTest, OwnShadersThatCallAreDeformed)
{
    const osg::ref_ptr<osg::Geometry> ground = makeGround();
    const osg::ref_ptr<EffectScene> scene = makeScene({ground});
    static_cast<BirdsEyeView*>(scene->getEffect(0))->setContextSaturation(0.3);
    const osg::ref_ptr<osg::Image> expected = render(scene);
    const osg::ref_ptr<osg::Program> program = makeProgram(true);
    scene->addFunctions(*program);
    ground->getOrCreateStateSet()->setAttribute(program);
    ground->getStateSet()->addUniform(new osg::Uniform("blue", 0.6f));
    EXPECT_TRUE(same(*render(scene), *expected, "deformed"));

    // The functions follow the scene's effects.
    scene->getEffect(0)->setEnabled(false);
    const osg::ref_ptr<osg::Image> plain = render(makePlain({makeGround()}));
    EXPECT_TRUE(same(*render(scene), *plain, "switched off"));
    scene->getEffect(0)->setEnabled(true);
    const osg::ref_ptr<VerticalExaggeration> lift = new VerticalExaggeration;
    lift->setFactor(4);
    scene->addEffect(lift);
    const osg::ref_ptr<EffectScene> two = makeScene({makeGround()});
    static_cast<BirdsEyeView*>(two->getEffect(0))->setContextSaturation(0.3);
    two->addEffect(lift);
    EXPECT_TRUE(same(*render(scene), *render(two), "two effects"));
    scene->removeEffect(lift);
    EXPECT_TRUE(same(*render(scene), *expected, "one again"));

    // Defines reach them, and uniforms of the application.
    ground->getStateSet()->setDefine("SHOW_DEFINE");
    const osg::ref_ptr<osg::Image> shown = render(scene);
    const unsigned char red[] = {255, 0, 153};
    EXPECT_EQ(std::memcmp(shown->data(WIDTH / 2, 5), red, 3), 0);
    ground->getStateSet()->setDefine("GEOFX_DEFORMATION", osg::StateAttribute::OFF);
    const osg::ref_ptr<osg::Image> left = render(scene);
    const unsigned char green[] = {0, 255, 153};
    EXPECT_EQ(std::memcmp(left->data(WIDTH / 2, 5), green, 3), 0);
}

TEST_F(EffectSceneTest, OwnShadersThatDoNotCallStay)
{
    const osg::ref_ptr<osg::Geometry> ground = makeGround();
    ground->getOrCreateStateSet()->setAttribute(makeProgram(false));
    const osg::ref_ptr<osg::Image> expected = render(makePlain({ground}));
    osg::ref_ptr<osg::Image> drawn;
    const std::vector<std::string> said = watch().messagesOf([&] { drawn = render(makeScene({ground})); });
    EXPECT_TRUE(same(*drawn, *expected));
    EXPECT_EQ(said.size(), 1u) << ::testing::PrintToString(said);
}

// Functions that were added before the effects, and to a second program.
TEST_F(EffectSceneTest, FunctionsMayComeFirst)
{
    const osg::ref_ptr<EffectScene> scene = new EffectScene;
    std::vector<osg::ref_ptr<osg::Geometry>> grounds;
    for (int i = 0; i < 2; ++i)
    {
        const osg::ref_ptr<osg::Program> program = makeProgram(true);
        scene->addFunctions(*program);
        grounds.push_back(makeGround());
        grounds.back()->getOrCreateStateSet()->setAttribute(program);
        scene->addChild(grounds.back());
    }
    EXPECT_TRUE(same(*render(scene), *render(makePlain({makeGround()})), "no effect"));
    scene->addEffect(makeBend());
    EXPECT_TRUE(same(*render(scene), *render(makeScene({makeGround()})), "an effect"));
}

// ---------------------------------------------------------------------------------------------------------------------

TEST_F(EffectSceneTest, ChangesBetweenFrames)
{
    const osg::ref_ptr<EffectScene> scene = makeScene({makeGround()});
    auto* bend = static_cast<BirdsEyeView*>(scene->getEffect(0));
    const osg::ref_ptr<osg::Image> plain = render(makePlain({makeGround()}));
    const osg::ref_ptr<osg::Image> bent = render(scene);
    EXPECT_GT(differing(*plain, *bent), WIDTH * HEIGHT / 3);
    for (int i = 0; i < 2; ++i)
    {
        bend->setEnabled(false);
        EXPECT_TRUE(same(*render(scene), *plain, "off"));
        bend->setEnabled(true);
        EXPECT_TRUE(same(*render(scene), *bent, "on"));
    }
    const auto fresh = [&](const std::function<void(EffectScene&, BirdsEyeView&)>& change)
    {
        const osg::ref_ptr<EffectScene> other = makeScene({makeGround()});
        change(*other, *static_cast<BirdsEyeView*>(other->getEffect(0)));
        return render(other);
    };
    for (const PerspectiveBend::Curve curve :
         {PerspectiveBend::BEZIER, PerspectiveBend::CIRCULAR_ARC, PerspectiveBend::ARC_LENGTH})
    {
        bend->setCurve(curve);
        const osg::ref_ptr<osg::Image> expected =
            fresh([&](EffectScene&, BirdsEyeView& other) { other.setCurve(curve); });
        EXPECT_TRUE(same(*render(scene), *expected, "curve " + std::to_string(curve)));
        EXPECT_EQ(differing(*expected, *bent) == 0, curve == PerspectiveBend::ARC_LENGTH);
    }

    const osg::ref_ptr<VerticalExaggeration> lift = new VerticalExaggeration;
    lift->setFactor(5);
    scene->addEffect(lift);
    const osg::ref_ptr<osg::Image> both =
        fresh([&](EffectScene& other, BirdsEyeView&) { other.addEffect(lift); });
    EXPECT_TRUE(same(*render(scene), *both, "added"));
    EXPECT_GT(differing(*both, *bent), 100);
    scene->removeEffect(bend);
    const osg::ref_ptr<osg::Image> lifted = fresh(
        [&](EffectScene& other, BirdsEyeView& first)
        {
            other.removeEffect(&first);
            other.addEffect(lift);
        });
    EXPECT_TRUE(same(*render(scene), *lifted, "the first removed"));
    scene->removeEffect(lift);
    EXPECT_TRUE(same(*render(scene), *plain, "none"));

    const osg::ref_ptr<PedestrianView> walk = new PedestrianView;
    walk->setFocusDistance(80);
    walk->setZoneWidth(60);
    scene->addEffect(walk);
    const osg::ref_ptr<osg::Image> folded = fresh(
        [&](EffectScene& other, BirdsEyeView& first)
        {
            other.removeEffect(&first);
            other.addEffect(walk);
        });
    EXPECT_TRUE(same(*render(scene), *folded, "another kind"));
    EXPECT_GT(differing(*folded, *plain), 100);
}

// ---------------------------------------------------------------------------------------------------------------------

namespace
{

void leaveOut(osg::Node& node, unsigned int flags = osg::StateAttribute::OFF)
{
    node.getOrCreateStateSet()->setDefine("GEOFX_DEFORMATION", flags);
}

} // namespace

// Posts that are deformed and posts that are not, by turns, drawn as if each kind were alone.
TEST_F(EffectSceneTest, LeftOutIsNeitherDeformedNorCulledSo)
{
    osg::Camera& camera = *viewer().getCamera();
    const osg::Matrixd view = camera.getViewMatrix();
    int seen = 0;
    int undeformedOnly = 0;
    const osg::ref_ptr<PedestrianView> walk = new PedestrianView;
    walk->setFocusDistance(80);
    walk->setBendAngle(1.5);
    walk->setTallest(50);
    const osg::ref_ptr<EffectScene> scene = makeScene({});
    const osg::ref_ptr<EffectScene> deformed = makeScene({});
    scene->addEffect(walk);
    deformed->addEffect(walk);
    const int count = fullTest() ? 400 : 30;
    for (int i = 0; i < count; ++i)
    {
        SCOPED_TRACE("sample " + std::to_string(i));
        Random random(static_cast<std::uint64_t>(i));
        // Folds what is far out of the picture.
        walk->setZoneWidth(random.uniform(20, 80));
        for (EffectScene* each : {scene.get(), deformed.get()})
        {
            each->removeChildren(0, each->getNumChildren());
            each->getEffect(0)->setEnabled(i % 2 == 0);
            each->getEffect(1)->setEnabled(i % 2 == 1);
        }
        const osg::ref_ptr<osg::Group> plain = new osg::Group;
        // Few posts and close views, so that a scene's posts are often out of sight all together.
        for (int post = 0; post < 8; ++post)
        {
            const osg::Vec3d place(random.uniform(-60, 60), random.uniform(-60, 140), random.uniform(0, 20));
            const auto size = static_cast<float>(random.uniform(2, 12));
            const bool out = post % 2 == 0;
            const osg::ref_ptr<osg::Group> box = makeBox(size, place);
            scene->addChild(post % 3 ? makePlain({box}) : box);
            if (out)
            {
                leaveOut(post % 4 == 0 ? *box : *box->getChild(0));
                box->setCullingActive(false);
            }
            (out ? plain.get() : static_cast<osg::Group*>(deformed.get()))->addChild(makeBox(size, place));
        }
        const osg::ref_ptr<osg::Group> apart = makePlain({deformed, plain});
        // The bend needs the natural horizon above its line, so the picture is moved and not the camera.
        const double shift = random.uniform(-0.6, 0.6);
        camera.setViewMatrix(view * osg::Matrix::rotate(shift, osg::Vec3d(0, 1, 0)));
        const osg::ref_ptr<osg::Image> expected = render(apart);
        EXPECT_TRUE(same(*render(scene), *expected, "sample " + std::to_string(i)));
        seen += covered(*expected) > 0 ? 1 : 0;
        undeformedOnly += covered(*render(makePlain({plain}))) > 0 ? 1 : 0;
    }
    EXPECT_GT(seen, count / 2);
    EXPECT_GT(undeformedOnly, count / 3);
}

// A box that the picture shows only where it is not deformed, and one that it shows only where it is.
TEST_F(EffectSceneTest, LeftOutAtTheBorder)
{
    // High above the context: undeformed it is above the picture, deformed in it.
    const osg::Vec3d high(0, 130, 40);
    EXPECT_EQ(covered(*render(makePlain({makeBox(20, high)}))), 0);
    const osg::ref_ptr<EffectScene> scene = makeScene({makeBox(20, high)});
    EXPECT_GT(covered(*render(scene)), 0);
    leaveOut(*scene->getChild(0));
    EXPECT_EQ(covered(*render(scene)), 0);

    // Folded up, a box in the picture goes out of it. Groups above learn from setCullingActive() that something below
    // them is elsewhere than their bound says.
    const osg::Vec3d low(0, 130, 0);
    const osg::ref_ptr<osg::Image> plain = render(makePlain({makeBox(8, low)}));
    EXPECT_GT(covered(*plain), 0);
    const osg::ref_ptr<PedestrianView> walk = new PedestrianView;
    walk->setFocusDistance(80);
    walk->setZoneWidth(60);
    const osg::ref_ptr<osg::Group> outer = makePlain({makePlain({makeBox(8, low)})});
    const osg::ref_ptr<EffectScene> other = new EffectScene;
    other->addEffect(walk);
    other->addChild(outer);
    EXPECT_EQ(covered(*render(other)), 0);
    osg::Node& box = *outer->getChild(0)->asGroup()->getChild(0);
    leaveOut(box);
    box.setCullingActive(false);
    EXPECT_TRUE(same(*render(other), *plain));
}

// What is left out may have parts that are not; OVERRIDE and PROTECTED decide as everywhere.
TEST_F(EffectSceneTest, LeftOutIsInherited)
{
    using Attribute = osg::StateAttribute;
    const osg::Vec3d high(0, 130, 40);
    const auto drawn = [&](unsigned int above, unsigned int outer, unsigned int inner)
    {
        const osg::ref_ptr<osg::Group> group = new osg::Group;
        group->addChild(makeBox(20, high));
        const osg::ref_ptr<EffectScene> scene = makeScene({group});
        const osg::ref_ptr<osg::Group> root = makePlain({scene});
        if (above != Attribute::INHERIT) leaveOut(*root, above);
        leaveOut(*group, outer);
        leaveOut(*group->getChild(0), inner);
        group->getChild(0)->setCullingActive(false);
        return covered(*render(root)) > 0;
    };
    // Deformed it is seen, undeformed it is not.
    EXPECT_TRUE(drawn(Attribute::INHERIT, Attribute::OFF, Attribute::ON));
    EXPECT_FALSE(drawn(Attribute::INHERIT, Attribute::ON, Attribute::OFF));
    EXPECT_FALSE(drawn(Attribute::INHERIT, Attribute::OFF | Attribute::OVERRIDE, Attribute::ON));
    EXPECT_TRUE(drawn(Attribute::INHERIT, Attribute::OFF | Attribute::OVERRIDE,
                      Attribute::ON | Attribute::PROTECTED));
    EXPECT_TRUE(drawn(Attribute::INHERIT, Attribute::ON | Attribute::OVERRIDE, Attribute::OFF));
    // Above the scene it has no say, unless it overrides.
    EXPECT_TRUE(drawn(Attribute::OFF, Attribute::ON, Attribute::ON));
}

// ---------------------------------------------------------------------------------------------------------------------

TEST_F(EffectSceneTest, TheContextTurnsGrey)
{
    const osg::ref_ptr<EffectScene> scene = makeScene({makeGround()});
    auto* bend = static_cast<BirdsEyeView*>(scene->getEffect(0));
    const osg::ref_ptr<osg::Image> colored = render(scene);
    bend->setContextSaturation(0);
    const osg::ref_ptr<osg::Image> grey = render(scene);
    EXPECT_TRUE(differing(*colored, *grey, 0, focusRow() - 3) == 0);
    // The ground's last 60 m are context: just below the highest row that it covers, in the middle.
    int top = HEIGHT - 1;
    const auto background = [&](int row)
    {
        return grey->data(WIDTH / 2, row)[0] == 26;
    };
    while (top > 0 && background(top))
        --top;
    ASSERT_GT(top, focusRow() + 10);
    int spread = 0;
    for (int column = WIDTH / 2 - 20; column < WIDTH / 2 + 20; ++column)
    {
        const unsigned char* pixel = grey->data(column, top - 3);
        spread = std::max({spread, std::abs(pixel[0] - pixel[1]), std::abs(pixel[1] - pixel[2])});
    }
    EXPECT_LE(spread, 1);
    bend->setContextBrightness(0);
    const osg::ref_ptr<osg::Image> black = render(scene);
    EXPECT_EQ(black->data(WIDTH / 2, top - 3)[1], 0);
    EXPECT_TRUE(differing(*colored, *black, 0, focusRow() - 3) == 0);
}

TEST_F(EffectSceneTest, TheContextShowsTheMap)
{
    // The picture as it is with the map in the place of the photo.
    const osg::ref_ptr<EffectScene> mapped = makeScene({makeGround()});
    mapped->getOrCreateStateSet()->setTextureAttributeAndModes(0, makeMap());
    const osg::ref_ptr<osg::Image> map = render(mapped);

    const osg::ref_ptr<EffectScene> scene = makeScene({makeGround()});
    auto* bend = static_cast<BirdsEyeView*>(scene->getEffect(0));
    const osg::ref_ptr<osg::Image> photo = render(scene);
    scene->getOrCreateStateSet()->setTextureAttribute(1, makeMap());
    EXPECT_TRUE(same(*render(scene), *photo, "not asked for"));
    bend->setMapUnit(1);
    const osg::ref_ptr<osg::Image> both = render(scene);
    EXPECT_EQ(differing(*both, *photo, 0, focusRow() - 3), 0);
    int top = HEIGHT - 1;
    while (top > 0 && map->data(WIDTH / 2, top)[0] == 26)
        --top;
    // Rounding to 8 bits.
    int worst = 0;
    for (int row = top - 6; row <= top; ++row)
    {
        for (int i = 4 * (WIDTH / 2 - 20); i < 4 * (WIDTH / 2 + 20); ++i)
            worst = std::max(worst, std::abs(both->data(0, row)[i] - map->data(0, row)[i]));
    }
    EXPECT_LE(worst, 1);
    EXPECT_GT(differing(*both, *photo, top - 6, top), WIDTH / 2);
    bend->setMapUnit(2);
    EXPECT_TRUE(same(*render(scene), *photo, "no map on that unit"));
}
