// SPDX-License-Identifier: MIT
// SPDX-FileCopyrightText: 2026 the osgGeoFX authors
//
// Adapted programs in their scenes: several scenes and no scene, threads that draw, what cannot be adapted, culling and picking,
// subgraphs and pagers.
#include <tools/HostPrograms.h>
#include <tools/ImageComparison.h>
#include <tools/PagedScene.h>
#include <tools/RandomSamples.h>
#include <tools/TempDir.h>
#include <tools/ThreadedViews.h>

#include <osg/Geode>
#include <osg/LightSource>
#include <osg/Material>
#include <osg/PagedLOD>
#include <osg/TexGen>
#include <osg/Texture2D>
#include <osgDB/ReadFile>
#include <osgGeoFX/deformation/VerticalExaggeration.h>
#include <osgGeoFX/scene/DeformedView.h>
#include <osgGeoFX/scene/ProgramAdapter.h>
#include <osgText/Text>

#include <atomic>
#include <cstring>
#include <thread>

using namespace osgGeoFX;
using namespace geofx::test;

namespace
{

constexpr const char* fixed = "gl_Position = ftransform();";

osg::ref_ptr<VerticalExaggeration> makeLift()
{
    osg::ref_ptr<VerticalExaggeration> lift = new VerticalExaggeration;
    lift->setFactor(4.0);
    return lift;
}

bool contains(const std::string& text, const std::string& part)
{
    return text.find(part) != std::string::npos;
}

std::vector<std::string> textsOf(const osg::Program& program)
{
    std::vector<std::string> texts;
    for (unsigned int i = 0; i < program.getNumShaders(); ++i)
        texts.push_back(program.getShader(i)->getShaderSource());
    return texts;
}

/// What is below a group, some triangles more or less: those left of a line, or right of it.
osg::ref_ptr<osg::Geometry> half(osg::Geometry& whole, bool left)
{
    const osg::ref_ptr<osg::Geometry> part = osg::clone(&whole, osg::CopyOp::SHALLOW_COPY);
    const auto& vertices = *static_cast<const osg::Vec3Array*>(whole.getVertexArray());
    const auto& all = *static_cast<const osg::DrawElementsUInt*>(whole.getPrimitiveSet(0));
    const osg::ref_ptr<osg::DrawElementsUInt> some = new osg::DrawElementsUInt(GL_TRIANGLES);
    for (std::size_t i = 0; i < all.size(); i += 3)
    {
        const osg::Vec3 middle = (vertices[all[i]] + vertices[all[i + 1]] + vertices[all[i + 2]]) / 3.0f;
        // A line with many corners.
        const bool isLeft = middle.x() + 20.0f * std::sin(middle.y() / 15.0f) < 0.0f;
        if (isLeft == left)
            some->insert(some->end(), all.begin() + static_cast<std::ptrdiff_t>(i),
                         all.begin() + static_cast<std::ptrdiff_t>(i) + 3);
    }
    part->setPrimitiveSet(0, some);
    return part;
}

class AdaptedScenesTest : public BentGround
{
protected:
    static osg::ref_ptr<osg::Program> makeAdapted(const HostProgram& host = HostProgram("#version 120\n",
                                                                                        fixed))
    {
        const osg::ref_ptr<osg::Program> program = host.make(false);
        EffectScene::adapt(*program);
        return program;
    }
    static osg::ref_ptr<osg::Geometry> groundWith(osg::Program* program)
    {
        const osg::ref_ptr<osg::Geometry> ground = makeGround();
        ground->getOrCreateStateSet()->setAttribute(program);
        return ground;
    }
    static osg::ref_ptr<EffectScene> painted(const std::vector<osg::ref_ptr<osg::Node>>& children)
    {
        const osg::ref_ptr<EffectScene> scene = new EffectScene;
        scene->addEffect(makeLift());
        scene->addEffect(makePaint());
        for (const auto& child : children)
            scene->addChild(child);
        return scene;
    }
    std::vector<std::string> saidOf(osg::Node* scene, osg::ref_ptr<osg::Image>& image)
    {
        return watch().messagesOf(
            [&]
            {
                render(scene);
                image = render(scene);
            });
    }
    /// One refused program: drawn where it is, one sentence, with these words.
    void expectRefused(osg::Program* program, const std::string& words)
    {
        SCOPED_TRACE(words);
        EffectScene::adapt(*program);
        const osg::ref_ptr<osg::Geometry> ground = groundWith(program);
        const osg::ref_ptr<osg::Image> expected = render(makePlain({ground}));
        osg::ref_ptr<osg::Image> drawn;
        const std::vector<std::string> said = saidOf(makeScene({ground}), drawn);
        EXPECT_TRUE(same(*drawn, *expected));
        ASSERT_EQ(said.size(), 1u) << ::testing::PrintToString(said);
        for (const std::string& part : {std::string("\"the host's\" cannot be adapted, since " + words),
                                        std::string("geofx_vertex()"), std::string("RigidReference")})
            EXPECT_TRUE(contains(said[0], part)) << said[0];
    }
};

} // namespace

// One program, below two scenes with other effects and below none, in turns; equal to terrains of their own.
TEST_F(AdaptedScenesTest, EachSceneDrawsItsOwnEffects)
{
    HostProgram called("#version 330 compatibility\n",
                       "vec4 eye = gl_ModelViewMatrix * gl_Vertex;\n    vec4 to = DEFORM(eye);\n"
                       "    gl_Position = to == eye ? ftransform() : gl_ProjectionMatrix * to;");
    const osg::ref_ptr<osg::Program> functions = called.make(true);
    EffectScene::addFunctions(*functions);
    const osg::ref_ptr<osg::Image> plain = render(makePlain({makeGround()}));
    const osg::ref_ptr<osg::Image> bent = render(makeScene({makeGround()}));
    const osg::ref_ptr<osg::Image> colored = render(painted({makeGround()}));
    EXPECT_GT(differing(*bent, *colored), WIDTH * HEIGHT / 10);
    for (const osg::ref_ptr<osg::Program>& program : {functions, makeAdapted()})
    {
        const std::vector<std::string> texts = textsOf(*program);
        const osg::ref_ptr<osg::Geometry> ground = groundWith(program);
        const osg::ref_ptr<EffectScene> first = makeScene({ground});
        const osg::ref_ptr<EffectScene> second = painted({ground});
        for (int turn = 0; turn < 2; ++turn)
        {
            EXPECT_TRUE(same(*render(first), *bent));
            EXPECT_TRUE(same(*render(second), *colored));
            EXPECT_TRUE(same(*render(makePlain({ground})), *plain));
            // Again, and with functions that it does not need.
            EffectScene::adapt(*program);
            EXPECT_EQ(textsOf(*program), texts);
        }
    }
}

TEST_F(AdaptedScenesTest, NothingIsDoneTwice)
{
    HostProgram called("#version 330 compatibility\n",
                       "gl_Position = gl_ProjectionMatrix * DEFORM(gl_ModelViewMatrix * gl_Vertex);");
    const osg::ref_ptr<osg::Program> program = called.make(true);
    EffectScene::addFunctions(*program);
    const osg::ref_ptr<EffectScene> scene = painted({groundWith(program)});
    const osg::ref_ptr<osg::Image> expected = render(scene);
    EffectScene::adapt(*program);
    EXPECT_TRUE(same(*render(scene), *expected));
    // The other way round, with a text that does not call them.
    const osg::ref_ptr<osg::Program> first = makeAdapted();
    const osg::ref_ptr<EffectScene> other = painted({groundWith(first)});
    const osg::ref_ptr<osg::Image> adapted = render(other);
    EXPECT_TRUE(same(*adapted, *render(painted({makeGround()}))));
    const osg::ref_ptr<osg::Program> both = makeAdapted();
    EffectScene::addFunctions(*both);
    EXPECT_TRUE(same(*render(painted({groundWith(both)})), *adapted));
    EXPECT_TRUE(same(*render(makePlain({groundWith(both)})), *render(makePlain({makeGround()}))));
}

// Shaders that change in an adapted program, one that comes to its end, and another one at its place.
TEST_F(AdaptedScenesTest, CopiesFollowTheirProgram)
{
    const osg::ref_ptr<osg::Image> expected = render(makeScene({makeGround()}));
    for (int turn = 0; turn < 3; ++turn)
    {
        const osg::ref_ptr<osg::Program> program = makeAdapted();
        const osg::ref_ptr<EffectScene> scene = makeScene({groundWith(program)});
        EXPECT_TRUE(same(*render(scene), *expected));
        osg::Shader* fragment = program->getShader(1);
        const std::string text = fragment->getShaderSource();
        fragment->setShaderSource("#version 120\nvoid main() { gl_FragColor = vec4(1, 0, 1, 1); }\n");
        const osg::ref_ptr<osg::Image> changed = render(scene);
        EXPECT_EQ(differing(*changed, *expected), covered(*expected));
        EXPECT_EQ(covered(*changed), covered(*expected));
        fragment->setShaderSource(text);
        EXPECT_TRUE(same(*render(scene), *expected));
    }
}

// OpenGL's fixed functions place the vertices of a program with a fragment stage alone. The kit's stand in for them.
TEST_F(AdaptedScenesTest, FragmentsAloneAreAdapted)
{
    osg::ref_ptr<osg::Image> squares = new osg::Image;
    squares->allocateImage(8, 8, 1, GL_RGB, GL_UNSIGNED_BYTE);
    for (int i = 0; i < 8 * 8 * 3; ++i)
        squares->data()[i] = static_cast<unsigned char>((i / 3 + i / 24) % 2 ? 250 : 90 + i % 3 * 40);
    const osg::ref_ptr<osg::LightSource> sun = new osg::LightSource;
    sun->getLight()->setPosition({0.5f, -0.4f, 0.7f, 0.0f});
    // Coordinates of a texture by the place in eye space, light, and colors.
    const auto dress = [&](osg::Geometry& geometry)
    {
        osg::StateSet& state = *geometry.getOrCreateStateSet();
        state.setTextureAttributeAndModes(1, new osg::Texture2D(squares));
        osg::ref_ptr<osg::TexGen> places = new osg::TexGen;
        places->setMode(osg::TexGen::EYE_LINEAR);
        places->setPlane(osg::TexGen::S, {0.05, 0.0, 0.0, 0.3});
        places->setPlane(osg::TexGen::T, {0.0, 0.03, 0.03, 0.1});
        state.setTextureAttributeAndModes(1, places);
        state.setMode(GL_LIGHTING, osg::StateAttribute::ON);
        state.setMode(GL_LIGHT0, osg::StateAttribute::ON);
        osg::ref_ptr<osg::Material> material = new osg::Material;
        material->setColorMode(osg::Material::AMBIENT_AND_DIFFUSE);
        state.setAttributeAndModes(material);
        return &geometry;
    };
    const auto ofProgram = [&]
    {
        HostProgram fragments("#version 120\n", fixed);
        fragments.vertices.clear();
        fragments.fragments = {"#version 120\nuniform sampler2D squares;\nvoid main()\n{\n"
                               "    gl_FragColor = gl_Color * texture2DProj(squares, gl_TexCoord[1]);\n}\n"};
        const osg::ref_ptr<osg::Program> program = fragments.make(false);
        EffectScene::adapt(*program);
        const osg::ref_ptr<osg::Geometry> ground = makeGround();
        dress(*ground);
        ground->getStateSet()->setAttributeAndModes(program);
        ground->getStateSet()->addUniform(new osg::Uniform("squares", 1));
        return ground;
    };
    const auto below = [&](const osg::ref_ptr<EffectScene>& scene)
    {
        scene->addChild(sun);
        return scene;
    };
    const ImageTolerance rounding{1.0f / 255.0f, 0.0, 1.0f / 255.0f};
    const osg::ref_ptr<osg::Image> expected = render(below(makeScene({dress(*makeGround())})));
    EXPECT_TRUE(imagesMatch(*render(below(makeScene({ofProgram()}))), *expected, rounding, "bent"));
    const osg::ref_ptr<osg::Image> colored = render(below(painted({dress(*makeGround())})));
    EXPECT_GT(differing(*colored, *expected), WIDTH * HEIGHT / 10);
    EXPECT_TRUE(imagesMatch(*render(below(painted({ofProgram()}))), *colored, rounding, "painted"));
    // Alone, OpenGL's own stage places it.
    EXPECT_TRUE(imagesMatch(*render(makePlain({ofProgram(), sun})),
                            *render(makePlain({dress(*makeGround()), sun})), rounding, "plain"));
}

// With setAdaptsPrograms() the scene adapts what it meets, above it and below.
TEST_F(AdaptedScenesTest, ScenesAdaptWhatTheyMeet)
{
    const osg::ref_ptr<osg::Image> expected = render(makeScene({makeGround()}));
    const auto strange = [&]
    {
        return HostProgram("#version 120\n", fixed).make(false);
    };
    const osg::ref_ptr<EffectScene> below = makeScene({groundWith(strange())});
    below->setAdaptsPrograms(true);
    EXPECT_TRUE(same(*render(below), *expected));
    const osg::ref_ptr<EffectScene> scene = makeScene({makeGround()});
    scene->setAdaptsPrograms(true);
    const osg::ref_ptr<osg::Group> above = makePlain({scene});
    above->getOrCreateStateSet()->setAttributeAndModes(strange());
    EXPECT_TRUE(same(*render(above), *expected));
}

TEST_F(AdaptedScenesTest, WhatCannotBeAdaptedStaysAndSaysWhy)
{
    const std::string version = "#version 330 compatibility\n";
    const auto with = [&](const std::string& place, const std::string& declarations = "")
    {
        return HostProgram(version, place, declarations).make(false);
    };
    HostProgram depthAlone(version, fixed);
    depthAlone.vertices.clear();
    depthAlone.fragments = {version + "void main() { gl_FragColor = gl_Color; gl_FragDepth = 0.25; }\n"};
    expectRefused(depthAlone.make(false), "its fragment shader writes a gl_FragDepth, and no vertex shader");
    expectRefused(with("run();\n}\n#define main start\nvoid main() {",
                       "void run() { gl_Position = ftransform(); gl_FrontColor = gl_Color; }\n"),
                  "its vertex shader defines main by a directive");
    expectRefused(with("gl_Position = vec4(gl_Vertex.xy / 200.0, 0.0, 1.0);"),
                  "no matrix takes its vertices");
    expectRefused(with("gl_Position = gl_ModelViewProjectionMatrix * gl_Vertex;",
                       "out gl_PerVertex { vec4 gl_Position; vec4 gl_FrontColor; };\n"),
                  "it declares gl_PerVertex anew");
    HostProgram depth(version, fixed);
    depth.fragments = {version + "uniform float far;\n"
                                 "void main() { gl_FragColor = gl_Color; gl_FragDepth = 0.25; }\n"};
    expectRefused(depth.make(false), "its fragment shader writes a gl_FragDepth that cannot follow");
    HostProgram streams(version, "gl_Position = ftransform();");
    streams.geometry =
        "#version 400 compatibility\nlayout(triangles) in;\n"
        "layout(points, max_vertices = 3) out;\nvoid main()\n{\n"
        "    for (int i = 0; i < 3; ++i)\n    {\n        gl_Position = gl_in[i].gl_Position;\n"
        "        gl_FrontColor = gl_in[i].gl_FrontColor;\n        EmitStreamVertex(0);\n    }\n}\n";
    expectRefused(streams.make(false), "its geometry shader emits vertices in another way");
}

// What it can do by its own is left to it: a depth of the fragment's place.
TEST_F(AdaptedScenesTest, DepthsOfTheFragmentsPlaceFollowByThemselves)
{
    HostProgram host("#version 120\n", fixed);
    host.fragments = {
        "#version 120\nvoid main() { gl_FragColor = gl_Color; gl_FragDepth = gl_FragCoord.z; }\n"};
    const osg::ref_ptr<osg::Node> box = makeBox(12, {20, 20, 0});
    EXPECT_TRUE(same(*render(makeScene({groundWith(makeAdapted(host)), box})),
                     *render(makeScene({makeGround(), box}))));
}

// Only where effects color is there something to say.
TEST_F(AdaptedScenesTest, ColorsThatCannotBeFoundStay)
{
    HostProgram host("#version 330 compatibility\n", fixed);
    host.fragments = {"#version 330 compatibility\nout vec4 a;\nout vec4 b;\n"
                      "void main() { a = gl_Color; b = gl_Color; }\n"};
    const osg::ref_ptr<EffectScene> lifted = new EffectScene;
    lifted->addEffect(makeLift());
    lifted->addChild(makeGround());
    const osg::ref_ptr<osg::Image> expected = render(lifted);
    const osg::ref_ptr<osg::Geometry> ground = groundWith(makeAdapted(host));
    lifted->setChild(0, ground);
    EXPECT_TRUE(same(*render(lifted), *expected));
    osg::ref_ptr<osg::Image> drawn;
    const std::vector<std::string> said = saidOf(painted({ground}), drawn);
    EXPECT_TRUE(same(*drawn, *expected));
    ASSERT_EQ(said.size(), 1u) << ::testing::PrintToString(said);
    EXPECT_TRUE(contains(said[0], "\"the host's\" is adapted, but keeps its colors")) << said[0];
    EXPECT_TRUE(contains(said[0], "geofx_fragment()")) << said[0];
}

// Half of a ground without a program, half adapted: no line in between.
TEST_F(AdaptedScenesTest, NoGapBesideGeometryWithoutProgram)
{
    osg::Camera& camera = *viewer().getCamera();
    const osg::ref_ptr<osg::Geometry> ground = makeGround();
    const osg::ref_ptr<osg::Geometry> left = half(*ground, true);
    const osg::ref_ptr<osg::Geometry> right = half(*ground, false);
    constexpr double away = 40000.0;
    for (const char* place : {fixed, "gl_Position = gl_ProjectionMatrix * (gl_ModelViewMatrix * gl_Vertex);",
                              "gl_Position = gl_ModelViewProjectionMatrix * gl_Vertex;"})
    {
        SCOPED_TRACE(place);
        left->getOrCreateStateSet()->setAttribute(makeAdapted(HostProgram("#version 120\n", place)));
        const osg::ref_ptr<EffectScene> scene = makeScene({left, right});
        const osg::ref_ptr<EffectScene> whole = makeScene({ground});
        for (const bool far : {false, true})
        {
            // The same picture from far away, where single numbers of eye space have few digits left.
            camera.setViewMatrixAsLookAt(osg::Vec3d(0, -150, 70) * (far ? away / 165.0 : 1.0), {0, -40, 0},
                                         {0, 0, 1});
            camera.setProjectionMatrixAsPerspective(far ? 0.2 : 40.0, 4.0 / 3.0, far ? away - 400 : 5,
                                                    far ? away + 400 : 2000);
            const osg::ref_ptr<osg::Image> expected = render(whole);
            EXPECT_LE(differing(*render(scene), *expected), 2) << (far ? "far" : "near");
            EXPECT_GT(covered(*expected), WIDTH * HEIGHT / 4);
        }
        camera.setViewMatrixAsLookAt({0, -150, 70}, {0, -40, 0}, {0, 0, 1});
        camera.setProjectionMatrixAsPerspective(40, 4.0 / 3.0, 5, 2000);
    }
}

// Boxes that only the bend brings into the picture, or takes out of it: culled and picked as without a program.
TEST_F(AdaptedScenesTest, AreCulledAndPickedDeformed)
{
    const osg::ref_ptr<osg::Program> program = makeAdapted();
    Random random(7);
    int hits = 0;
    for (int i = 0; i < 12; ++i)
    {
        std::vector<osg::ref_ptr<osg::Node>> own;
        std::vector<osg::ref_ptr<osg::Node>> plain;
        for (int post = 0; post < 8; ++post)
        {
            const osg::Vec3d place(random.uniform(-60, 60), random.uniform(-60, 340), random.uniform(0, 20));
            const auto size = static_cast<float>(random.uniform(4, 16));
            own.push_back(makeBox(size, place));
            own.back()->getOrCreateStateSet()->setAttribute(program);
            plain.push_back(makeBox(size, place));
        }
        const osg::ref_ptr<EffectScene> scene = makeScene(own);
        const osg::ref_ptr<EffectScene> expected = makeScene(plain);
        const osg::ref_ptr<osg::Image> drawn = render(scene);
        EXPECT_TRUE(same(*drawn, *render(expected)));
        const DeformedView picture(*scene, *viewer().getCamera());
        const DeformedView other(*expected, *viewer().getCamera());
        for (int pixel = 0; pixel < 60; ++pixel)
        {
            const double x = random.uniform(0, WIDTH);
            const double y = random.uniform(0, HEIGHT);
            const auto hit = picture.pick(x, y);
            const auto wanted = other.pick(x, y);
            ASSERT_EQ(hit.has_value(), wanted.has_value());
            if (!hit) continue;
            EXPECT_LT((hit->world - wanted->world).length(), 1e-9);
            ++hits;
        }
    }
    EXPECT_GT(hits, 20);
}

// Two threads adapt programs while others cull and draw them.
TEST_F(AdaptedScenesTest, ProgramsAreAdaptedWhileTheyAreDrawn)
{
    const osg::ref_ptr<osg::Image> expected = render(makeScene({makeGround()}));
    for (const ThreadedViews::Threading model : ThreadedViews::models)
    {
        SCOPED_TRACE(model);
        const osg::ref_ptr<osg::Program> program = HostProgram("#version 120\n", fixed).make(false);
        std::vector<osg::ref_ptr<osg::Node>> things = {groundWith(program)};
        std::vector<osg::ref_ptr<osg::Program>> others;
        for (int i = 0; i < 6; ++i)
        {
            others.push_back(HostProgram("#version 120\n", fixed).make(false));
            things.push_back(makeBox(4, {-30.0 + 10.0 * i, -60, -40})); // below the ground
            things.back()->getOrCreateStateSet()->setAttribute(others.back());
        }
        const osg::ref_ptr<EffectScene> scene = makeScene(things);
        std::vector<osg::ref_ptr<osg::Image>> after;
        const std::vector<std::string> said = watch().messagesOf(
            [&]
            {
                ThreadedViews views(model);
                views.add(scene, *viewer().getCamera());
                views.add(scene, *viewer().getCamera());
                views.realize();
                views.frame();
                views.frame();
                std::atomic<bool> done{false};
                std::vector<std::thread> adapters;
                for (int thread = 0; thread < 2; ++thread)
                {
                    adapters.emplace_back(
                        [&]
                        {
                            while (!done)
                            {
                                EffectScene::adapt(*program);
                                for (const auto& each : others)
                                    EffectScene::adapt(*each);
                            }
                        });
                }
                for (int i = 0; i < 6; ++i)
                    views.frame();
                done = true;
                for (std::thread& each : adapters)
                    each.join();
                after = views.pictures();
            });
        for (const std::string& each : said)
            EXPECT_TRUE(contains(each, "does not call geofx_vertex()")) << each;
        ASSERT_EQ(after.size(), 2u);
        for (const auto& image : after)
            EXPECT_TRUE(same(*image, *expected));
    }
}

TEST_F(AdaptedScenesTest, AVisitorAdaptsASubgraph)
{
    // At nodes, drawables, in a geode, below a switch that is off and in a level of detail.
    const osg::ref_ptr<osg::Geometry> ground = groundWith(HostProgram("#version 120\n", fixed).make(false));
    const osg::ref_ptr<osg::Geode> geode = new osg::Geode;
    geode->addChild(ground);
    const osg::ref_ptr<osg::MatrixTransform> box = makeBox(8, {-20, -50, 0});
    box->getOrCreateStateSet()->setAttribute(HostProgram("#version 330 compatibility\n", fixed).make(false));
    const osg::ref_ptr<osg::MatrixTransform> hidden = makeBox(8, {20, -50, 0});
    hidden->getChild(0)->getOrCreateStateSet()->setAttribute(HostProgram("", fixed).make(false));
    hidden->setNodeMask(0);
    const osg::ref_ptr<osg::MatrixTransform> plain = makeBox(8, {0, -20, 0});
    plain->getOrCreateStateSet()->setAttribute(new osg::Program); // the fixed functions
    const osg::ref_ptr<osg::Group> root = makePlain({geode, makePlain({box}), hidden, plain});
    ProgramAdapter adapter;
    root->accept(adapter);
    EXPECT_EQ(adapter.met(), 3u);
    hidden->setNodeMask(~0u);
    const osg::ref_ptr<osg::Image> drawn = render(makeScene({root}));
    EXPECT_TRUE(same(*drawn, *render(makeScene({makeGround(), makeBox(8, {-20, -50, 0}),
                                                makeBox(8, {20, -50, 0}), makeBox(8, {0, -20, 0})}))));
}

// Labels have a program of OSG's, which leaves the version to OSG.
TEST_F(AdaptedScenesTest, LabelsAreAdapted)
{
    const osg::ref_ptr<osgText::Text> label = new osgText::Text;
    label->setText("AHA");
    label->setCharacterSize(30.0f);
    label->setPosition({-40.0f, 60.0f, 0.0f});
    label->setAxisAlignment(osgText::TextBase::XZ_PLANE);
    const osg::ref_ptr<osg::Image> expected = render(makePlain({label}));
    EXPECT_GT(covered(*expected), 100);
    ProgramAdapter adapter;
    static_cast<osg::Node*>(label.get())->accept(adapter);
    EXPECT_EQ(adapter.met(), 1u);
    const osg::ref_ptr<EffectScene> scene = makeScene({label});
    const osg::ref_ptr<osg::Image> bent = render(scene);
    EXPECT_GT(covered(*bent), 50);
    EXPECT_GT(differing(*bent, *expected), 100);
    scene->getEffect(0)->setEnabled(false);
    EXPECT_TRUE(same(*render(scene), *expected));
}

// The tiles of a pager get programs by a loader of the application's; the listener adapts them before they are drawn.
TEST_F(AdaptedScenesTest, AListenerAdaptsThePagersTiles)
{
    class Dressing : public TileListener
    {
    public:
        void tileRead(osg::Node& tile) override
        {
            tile.getOrCreateStateSet()->setAttribute(HostProgram("#version 120\n", fixed).make(false));
            ++count;
        }
        std::atomic<int> count{0};
    };
    const TempDir folder;
    const std::string file = PagedScene::write(folder.path(), PagedScene::Kind::Flat).string();
    osg::Camera& camera = *viewer().getCamera();
    camera.setViewMatrixAsLookAt({0, -6000, 3000}, {0, -500, 0}, {0, 0, 1});
    camera.setProjectionMatrixAsPerspective(40, 4.0 / 3.0, 100, 40000);
    const auto build = [&](bool own, Dressing& dressing, TileProgramAdapter& adapter)
    {
        const osg::ref_ptr<osg::Node> terrain = osgDB::readRefNodeFile(file);
        const osg::ref_ptr<TileGuard> guard = TileGuard::install(terrain);
        if (own)
        {
            guard->addListener(&dressing);
            guard->addListener(&adapter);
        }
        const osg::ref_ptr<EffectScene> scene = makeScene({terrain});
        return scene;
    };
    osg::ref_ptr<osg::Image> pictures[2];
    std::vector<osg::ref_ptr<EffectScene>> scenes; // OSG gives a buffer to the next one that has gone
    const osg::ref_ptr<Dressing> dressing = new Dressing;
    const osg::ref_ptr<TileProgramAdapter> adapter = new TileProgramAdapter;
    for (const bool own : {false, true})
    {
        const osg::ref_ptr<EffectScene> scene = build(own, *dressing, *adapter);
        scenes.push_back(scene);
        for (int i = 0; i < 60; ++i)
        {
            pictures[own ? 1 : 0] = render(scene);
            std::this_thread::sleep_for(std::chrono::milliseconds(10));
        }
    }
    EXPECT_GE(dressing->count, 5);
    EXPECT_GT(covered(*pictures[0]), WIDTH * HEIGHT / 6);
    EXPECT_TRUE(same(*pictures[0], *pictures[1]));
}
