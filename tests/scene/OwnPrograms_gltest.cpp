// SPDX-License-Identifier: MIT
// SPDX-FileCopyrightText: 2026 the osgGeoFX authors
//
// Programs that do not call the effects' functions: one warning tells of each, and what they draw is culled, picked and lifted as
// what it is, which is not deformed.
#include <tools/BentGround.h>
#include <tools/CullHarness.h>
#include <tools/RandomSamples.h>

#include <osg/GLObjects>
#include <osg/Geode>
#include <osg/VertexProgram>
#include <osgFX/AnisotropicLighting>
#include <osgGeoFX/deformation/PedestrianView.h>
#include <osgGeoFX/scene/DeformedView.h>
#include <osgGeoFX/scene/RigidReference.h>
#include <osgGeoFX/scene/detail/OwnPrograms.h>

#include <cstring>
#include <string>
#include <utility>
#include <vector>

using namespace osgGeoFX;
using namespace geofx::test;

namespace
{

/// `more`: at the end of its vertex shader's text.
osg::ref_ptr<osg::Program> makeStranger(const std::string& name = "", const std::string& more = "")
{
    osg::ref_ptr<osg::Program> program = new osg::Program;
    program->setName(name);
    program->addShader(new osg::Shader(
        osg::Shader::VERTEX, "#version 120\n"
                             "// geofx_vertex(eye) is not called here\n"
                             "void main() { gl_Position = ftransform(); gl_FrontColor = gl_Color; }\n" +
                                 more));
    program->addShader(
        new osg::Shader(osg::Shader::FRAGMENT, "#version 120\nvoid main() { gl_FragColor = gl_Color; }\n"));
    return program;
}

/// Another engine's class for programs, which is no osg::Program.
class ForeignProgram : public osg::StateAttribute
{
public:
    ForeignProgram() : _program(makeStranger()) {}
    ForeignProgram(const ForeignProgram& other, const osg::CopyOp& copy)
        : osg::StateAttribute(other, copy), _program(other._program)
    {
    }
    META_StateAttribute(foreign, ForeignProgram,
                        PROGRAM) int compare(const osg::StateAttribute& other) const override
    {
        return this < &other ? -1 : this > &other;
    }
    void apply(osg::State& state) const override { _program->apply(state); }

protected:
    ~ForeignProgram() override = default;

private:
    osg::ref_ptr<osg::Program> _program;
};

class OwnProgramsTest : public BentGround
{
protected:
    /// The messages that drawing makes, twice.
    std::vector<std::string> saidOf(osg::Node* scene, osg::ref_ptr<osg::Image>* image = nullptr)
    {
        return watch().messagesOf(
            [&]
            {
                render(scene);
                const osg::ref_ptr<osg::Image> second = render(scene);
                if (image) *image = second;
            });
    }
};

/// Of a tile in rows of twenty.
osg::Vec3d placeOf(int tile)
{
    return {4.0 * (tile % 20) - 40.0, 4.0 * (tile / 20) - 90.0, 0.0};
}

bool contains(const std::string& text, const std::string& part)
{
    return text.find(part) != std::string::npos;
}

} // namespace

TEST(OwnPrograms, CallsAreFound)
{
    EXPECT_TRUE(OwnPrograms::calls("void main() { gl_Position = p * geofx_vertex(eye); }"));
    EXPECT_TRUE(
        OwnPrograms::calls("vec4 geofx_vertex(vec4 e);\nvoid main() { vec4 at = geofx_vertex (e); }"));
    EXPECT_TRUE(OwnPrograms::calls("#define DEFORM geofx_vertex\nvoid main() {}"));
    EXPECT_TRUE(OwnPrograms::calls("/* vec4 */geofx_vertex(e)"));
    EXPECT_FALSE(OwnPrograms::calls(""));
    EXPECT_FALSE(OwnPrograms::calls("vec4 geofx_vertex(vec4 e);\nvoid main() {}"));
    EXPECT_FALSE(OwnPrograms::calls("vec4\n  geofx_vertex(vec4 e) { return e; }"));
    EXPECT_FALSE(OwnPrograms::calls("// geofx_vertex(e)\nvoid main() {} /* geofx_vertex(e) */"));
    EXPECT_FALSE(OwnPrograms::calls("void main() { my_geofx_vertex(e); geofx_vertexes(e); }"));
}

TEST(OwnPrograms, AreLookedAtAgain)
{
    OwnPrograms programs;
    EXPECT_FALSE(OwnPrograms::isOwn(nullptr));
    const osg::ref_ptr<osg::Program> program = new osg::Program;
    EXPECT_FALSE(OwnPrograms::isOwn(program));
    const osg::ref_ptr<osg::Shader> shader = new osg::Shader(osg::Shader::VERTEX, "void main() {}");
    program->addShader(shader);
    EXPECT_TRUE(programs.isStranger(program));
    shader->setShaderSource("void main() { geofx_vertex(e); }");
    programs.startFrame();
    EXPECT_FALSE(programs.isStranger(program));
    // A fragment shader moves nothing.
    const osg::ref_ptr<osg::Program> other = new osg::Program;
    other->addShader(new osg::Shader(osg::Shader::FRAGMENT, "void main() { geofx_vertex(e); }"));
    EXPECT_TRUE(programs.isStranger(other));
    EXPECT_TRUE(programs.isStranger(osg::ref_ptr<ForeignProgram>(new ForeignProgram)));
}

TEST_F(OwnProgramsTest, OneWarningForEach)
{
    const osg::ref_ptr<osg::Geometry> ground = makeGround();
    const osg::ref_ptr<EffectScene> scene = makeScene({ground});
    EXPECT_TRUE(saidOf(scene).empty());
    ground->getOrCreateStateSet()->setAttribute(makeStranger("the glow"));
    std::vector<std::string> said = saidOf(scene);
    ASSERT_EQ(said.size(), 1u) << ::testing::PrintToString(said);
    EXPECT_TRUE(contains(said[0], "\"the glow\"")) << said[0];
    EXPECT_TRUE(contains(said[0], "addFunctions")) << said[0];
    EXPECT_TRUE(contains(said[0], "RigidReference")) << said[0];

    // Two with other texts that are called alike are two, and so are two without a name.
    const osg::ref_ptr<osg::Group> more = new osg::Group;
    more->setName("more of it");
    for (const auto& [name, text] :
         {std::pair{"the glow", "// 1"}, std::pair{"", "// 2"}, std::pair{"", "// 3"}})
    {
        const osg::ref_ptr<osg::MatrixTransform> box = makeBox(5, {10, -90, 0});
        box->getOrCreateStateSet()->setAttribute(makeStranger(name, text));
        more->addChild(box);
    }
    scene->addChild(more);
    said = saidOf(scene);
    ASSERT_EQ(said.size(), 3u) << ::testing::PrintToString(said);
    EXPECT_TRUE(contains(said[1], "\"more of it\"")) << said[1];
    // Of all that they have been told.
    EXPECT_TRUE(saidOf(scene).empty());
}

// As an engine may have a program for each tile.
TEST_F(OwnProgramsTest, OneWarningForAllWithEqualTexts)
{
    const osg::ref_ptr<osg::Group> tiles = new osg::Group;
    const osg::ref_ptr<EffectScene> scene = makeScene({tiles});
    const auto fill = [&](const std::string& name)
    {
        tiles->removeChildren(0, tiles->getNumChildren());
        for (int i = 0; i < 200; ++i)
        {
            const osg::ref_ptr<osg::MatrixTransform> tile = makeBox(2, placeOf(i));
            tile->setName("tile " + std::to_string(i));
            tile->getOrCreateStateSet()->setAttribute(
                makeStranger(name.empty() ? name : name + static_cast<char>('a' + i % 26)));
            tiles->addChild(tile);
        }
    };
    fill("");
    const std::vector<std::string> said = saidOf(scene);
    ASSERT_EQ(said.size(), 1u) << ::testing::PrintToString(said);
    // Others at their place.
    fill("the program of tile ");
    EXPECT_TRUE(saidOf(scene).empty());
}

// Drawn with the functions, by one program of OpenGL.
TEST_F(OwnProgramsTest, OneProgramForAllWithEqualTexts)
{
    const auto programs = [this](int tiles, bool adapted)
    {
        const osg::ref_ptr<osg::Group> all = new osg::Group;
        for (int i = 0; i < tiles; ++i)
        {
            const osg::ref_ptr<osg::MatrixTransform> tile = makeBox(2, placeOf(i));
            const osg::ref_ptr<osg::Program> program = makeStranger(
                "tile " + std::to_string(i),
                adapted ? "" : "vec4 geofx_vertex(vec4 eye);\nvoid more() { geofx_vertex(gl_Vertex); }\n");
            if (adapted)
                EffectScene::adapt(*program);
            else
                EffectScene::addFunctions(*program);
            tile->getOrCreateStateSet()->setAttribute(program);
            all->addChild(tile);
        }
        // OSG compiles what it finds in a scene that is new to a view, whoever draws it.
        const osg::ref_ptr<osg::Group> root = makePlain({});
        render(root);
        root->addChild(makeScene({all}));
        // The names that are taken in both counts.
        int before = 0, after = 0;
        const auto count = [](int& number)
        {
            return [&number](osg::State& state)
            {
                // Those of scenes that are gone.
                osg::flushAllDeletedGLObjects(state.getContextID());
                for (GLuint name = 1; name < 20000; ++name)
                    number += state.get<osg::GLExtensions>()->glIsProgram(name) ? 1 : 0;
            };
        };
        withContext(count(before));
        render(root);
        withContext(count(after));
        return after - before;
    };
    for (const bool adapted : {true, false})
    {
        SCOPED_TRACE(adapted);
        const int one = programs(1, adapted);
        EXPECT_GT(one, 0);
        EXPECT_EQ(programs(200, adapted), one);
    }
}

TEST_F(OwnProgramsTest, NoWarningWhereNothingIsAmiss)
{
    // Left out, rigid, without a bend, or with the functions.
    const osg::ref_ptr<osg::MatrixTransform> left = makeBox(5, {10, -90, 0});
    left->getOrCreateStateSet()->setAttribute(makeStranger());
    left->getStateSet()->setDefine("GEOFX_DEFORMATION", osg::StateAttribute::OFF);
    const osg::ref_ptr<osg::MatrixTransform> rigid =
        new osg::MatrixTransform(osg::Matrix::translate(0, 100, 0));
    const osg::ref_ptr<RigidReference> reference = new RigidReference;
    reference->addChild(makeBox(12));
    rigid->addChild(reference);
    const osg::ref_ptr<osg::Image> expected = render(makeScene({rigid}));
    EXPECT_GT(covered(*expected), 100);
    reference->getOrCreateStateSet()->setAttribute(makeStranger());
    EXPECT_TRUE(saidOf(makeScene({left, rigid})).empty());
    // It stands where it stood with the kit's shader.
    EXPECT_LT(differing(*render(makeScene({rigid})), *expected), 5);

    const osg::ref_ptr<osg::Geometry> ground = makeGround();
    ground->getOrCreateStateSet()->setAttribute(makeStranger());
    const osg::ref_ptr<EffectScene> level = makeScene({ground});
    level->getEffect(0)->setEnabled(false);
    EXPECT_TRUE(saidOf(level).empty());
}

TEST_F(OwnProgramsTest, OtherClassesArePrograms)
{
    const osg::ref_ptr<osg::Geometry> ground = makeGround();
    const osg::ref_ptr<osg::Image> expected = render(makePlain({makeGround()}));
    ground->getOrCreateStateSet()->setAttribute(new ForeignProgram);
    osg::ref_ptr<osg::Image> drawn;
    const std::vector<std::string> said = saidOf(makeScene({ground}), &drawn);
    ASSERT_EQ(said.size(), 1u) << ::testing::PrintToString(said);
    EXPECT_TRUE(contains(said[0], "foreign::ForeignProgram")) << said[0];
    EXPECT_LT(differing(*drawn, *expected), 20);
}

// Posts with the kit's shader, and posts with a program that does not call the functions, at all places in the graph: drawn, and
// picked, as if each kind were alone.
TEST_F(OwnProgramsTest, AreCulledAsWhatTheyAre)
{
    osg::Camera& camera = *viewer().getCamera();
    const osg::Matrixd view = camera.getViewMatrix();
    const osg::ref_ptr<PedestrianView> walk = new PedestrianView;
    walk->setFocusDistance(80);
    walk->setBendAngle(1.5);
    walk->setTallest(50);
    const osg::ref_ptr<osg::Program> program = makeStranger("the post");
    const osg::ref_ptr<EffectScene> scene = makeScene({});
    const osg::ref_ptr<EffectScene> deformed = makeScene({});
    scene->addEffect(walk);
    deformed->addEffect(walk);
    int undeformedOnly = 0;
    int hits = 0;
    const int count = fullTest() ? 200 : 24;
    std::vector<std::string> said;
    for (int i = 0; i < count; ++i)
    {
        SCOPED_TRACE("sample " + std::to_string(i));
        Random random(static_cast<std::uint64_t>(i));
        walk->setZoneWidth(random.uniform(20, 80));
        for (EffectScene* each : {scene.get(), deformed.get()})
        {
            each->removeChildren(0, each->getNumChildren());
            each->getEffect(0)->setEnabled(i % 2 == 0);
            each->getEffect(1)->setEnabled(i % 2 == 1);
        }
        const osg::ref_ptr<osg::Group> plain = new osg::Group;
        for (int post = 0; post < 8; ++post)
        {
            const osg::Vec3d place(random.uniform(-60, 60), random.uniform(-60, 140), random.uniform(0, 20));
            const auto size = static_cast<float>(random.uniform(2, 12));
            const bool own = post % 2 == 0;
            const osg::ref_ptr<osg::MatrixTransform> box = makeBox(size, place);
            const osg::ref_ptr<osg::Node> mesh = box->getChild(0);
            if (post % 3 == 0)
            {
                // A Geode in between.
                const osg::ref_ptr<osg::Geode> geode = new osg::Geode;
                geode->addChild(mesh);
                box->setChild(0, geode);
            }
            const osg::ref_ptr<osg::Group> outer = makePlain({makePlain({box})});
            if (own)
            {
                osg::Node* const places[] = {mesh.get(), box.get(), outer->getChild(0), outer.get()};
                places[post / 2]->getOrCreateStateSet()->setAttribute(program);
            }
            scene->addChild(outer);
            (own ? plain.get() : static_cast<osg::Group*>(deformed.get()))->addChild(makeBox(size, place));
        }
        const double shift = random.uniform(-0.6, 0.6);
        camera.setViewMatrix(view * osg::Matrix::rotate(shift, osg::Vec3d(0, 1, 0)));
        plain->getOrCreateStateSet()->setAttribute(program);
        const osg::ref_ptr<osg::Image> expected = render(makePlain({deformed, plain}));
        osg::ref_ptr<osg::Image> drawn;
        for (const std::string& each : watch().messagesOf([&] { drawn = render(scene); }))
            said.push_back(each);
        EXPECT_TRUE(same(*drawn, *expected, "sample " + std::to_string(i)));
        undeformedOnly += covered(*render(makePlain({plain}))) > 0 ? 1 : 0;

        // What the picture shows can be picked, and nothing else.
        const DeformedView picture(*scene, camera);
        constexpr unsigned char background[] = {26, 51, 77};
        for (int pixel = 0; pixel < 60; ++pixel)
        {
            const int x = random.integer(1, WIDTH - 2);
            const int y = random.integer(1, HEIGHT - 2);
            // Not where the pixel is on an edge.
            bool clear = true;
            const bool covers = std::memcmp(drawn->data(x, y), background, 3) != 0;
            for (const auto& [dx, dy] :
                 {std::pair(-1, 0), std::pair(1, 0), std::pair(0, -1), std::pair(0, 1)})
                clear = clear && (std::memcmp(drawn->data(x + dx, y + dy), background, 3) != 0) == covers;
            if (!clear) continue;
            EXPECT_EQ(picture.pick(x + 0.5, y + 0.5).has_value(), covers) << x << ' ' << y;
            hits += covers ? 1 : 0;
        }
    }
    EXPECT_EQ(said.size(), 1u) << ::testing::PrintToString(said);
    EXPECT_GT(undeformedOnly, count / 3);
    EXPECT_GT(hits, count / 2);
}

// OSG's intersection visitor does not traverse a geode's drawables as nodes: what their own state says was passed over.
TEST_F(OwnProgramsTest, OfADrawableInAGeodeIsPickedWhereItIsDrawn)
{
    const osg::Camera& camera = *viewer().getCamera();
    int moved = 0;
    for (const bool own : {false, true})
    {
        const osg::ref_ptr<osg::MatrixTransform> box = makeBox(8, {10, 60, 0});
        const osg::ref_ptr<osg::Geode> geode = new osg::Geode;
        geode->addChild(box->getChild(0));
        box->setChild(0, geode);
        if (own) geode->getDrawable(0)->getOrCreateStateSet()->setAttribute(makeStranger("the post"));
        const osg::ref_ptr<EffectScene> scene = makeScene({box});
        osg::ref_ptr<osg::Image> drawn;
        watch().messagesOf([&] { drawn = render(scene); });
        const DeformedView picture(*scene, camera);
        int missed = 0;
        int hits = 0;
        for (int y = 1; y < HEIGHT - 1; ++y)
        {
            for (int x = 1; x < WIDTH - 1; ++x)
            {
                constexpr unsigned char background[] = {26, 51, 77};
                const bool covers = std::memcmp(drawn->data(x, y), background, 3) != 0;
                const bool picked = picture.pick(x + 0.5, y + 0.5).has_value();
                hits += covers ? 1 : 0;
                missed += covers != picked ? 1 : 0;
            }
        }
        EXPECT_GT(hits, 50);
        // Along its edges by half a pixel.
        EXPECT_LT(missed, hits / 5) << (own ? "with" : "without") << " a program of its own";
        moved += own ? hits : -hits;
    }
    EXPECT_NE(moved, 0) << "the program makes no difference";
}

/// osgFX has programs in assembly language, which no function can be added to.
TEST_F(OwnProgramsTest, InAssemblyLanguageKeepTheirLookAndPlace)
{
    const auto assembly = []
    {
        const osg::ref_ptr<osg::VertexProgram> program = new osg::VertexProgram;
        program->setVertexProgram(
            "!!ARBvp1.0\nOPTION ARB_position_invariant;\nMOV result.color, vertex.normal;\nEND\n");
        return program;
    };
    const auto things = [&]
    {
        const osg::ref_ptr<osg::Group> all = new osg::Group;
        for (const float x : {-20.0f, 20.0f})
        {
            const osg::ref_ptr<osg::MatrixTransform> box = makeBox(9.0f, {x, 20.0f, 0.0f});
            box->getOrCreateStateSet()->setAttributeAndModes(assembly());
            all->addChild(box);
        }
        return all;
    };
    const osg::ref_ptr<osg::Image> expected = render(things());
    const osg::ref_ptr<EffectScene> scene = makeScene({things()});
    osg::ref_ptr<osg::Image> actual;
    const std::vector<std::string> said = saidOf(scene, &actual);
    EXPECT_TRUE(same(*actual, *expected));
    ASSERT_EQ(said.size(), 1u); // once for equal texts
    EXPECT_TRUE(contains(said[0], "The program of osg::VertexProgram")) << said[0];
    EXPECT_TRUE(contains(said[0], "is in assembly language, so what it draws stays where it is")) << said[0];
    // A mode that is off leaves the drawing to the fixed functions, which are deformed.
    const osg::ref_ptr<osg::Group> off = makePlain({makeBox(9.0f, {20.0f, 20.0f, 0.0f})});
    const osg::ref_ptr<osg::Image> bent = render(makeScene({off}));
    off->getOrCreateStateSet()->setAttribute(assembly());
    EXPECT_TRUE(same(*render(makeScene({off})), *bent));
}

/// A node of osgFX pushes the states of its passes by itself.
TEST_F(OwnProgramsTest, OfOsgFxKeepTheirLookAndPlace)
{
    const auto shining = []
    {
        const osg::ref_ptr<osgFX::AnisotropicLighting> result = new osgFX::AnisotropicLighting;
        result->addChild(makeBox(9.0f, {20.0f, 20.0f, 0.0f}));
        result->addChild(makeBox(9.0f, {-20.0f, 30.0f, 0.0f}));
        return result;
    };
    const auto second = [this](osg::Node* scene)
    {
        render(scene);
        return render(scene);
    };
    const osg::ref_ptr<osg::Image> expected = second(shining());
    const osg::ref_ptr<osgFX::AnisotropicLighting> dull = shining();
    dull->setEnabled(false);
    EXPECT_GT(differing(*expected, *second(dull)), 100);
    osg::ref_ptr<osg::Image> actual;
    const osg::ref_ptr<EffectScene> scene = makeScene({shining()});
    const std::vector<std::string> said = saidOf(scene, &actual);
    EXPECT_TRUE(same(*actual, *expected));
    EXPECT_EQ(said.size(), 1u);
}
