// SPDX-License-Identifier: MIT
// SPDX-FileCopyrightText: 2026 the osgGeoFX authors
//
// Programs that know nothing of the effects (EffectScene::adapt): pictures of them against pictures of the same programs with the
// calls written by hand.
#include <tools/DepthKinds.h>
#include <tools/HostPrograms.h>

#include <osg/ClipNode>
#include <osg/Depth>
#include <osgGeoFX/deformation/VerticalExaggeration.h>
#include <osgGeoFX/effect/ShaderLibrary.h>
#include <osgGeoFX/effect/SurfaceEffect.h>

#include <cstring>

using namespace osgGeoFX;
using namespace geofx::test;

namespace
{

/// Colors by what the attributes say.
class Checkers : public SurfaceEffect
{
public:
    Checkers()
    {
        ShaderLibrary::add("test/checkers.vert.glsl",
                           "out vec2 SLOT_at;\n"
                           "void SLOT_locate(vec3 p) { SLOT_at = gl_MultiTexCoord0.xy; }\n");
        ShaderLibrary::add(
            "test/checkers.frag.glsl",
            "in vec2 SLOT_at;\n"
            "vec4 SLOT_color(vec4 color) { return vec4(fract(SLOT_at), color.b, color.a); }\n");
    }
    Checkers(const Checkers& other, const osg::CopyOp& copy) : SurfaceEffect(other, copy) {}
    META_Object(geofxTest, Checkers);
    const Properties& properties() const override
    {
        static const Properties all = {enabledProperty()};
        return all;
    }
    std::string vertexFile() const override { return "test/checkers.vert.glsl"; }
    std::string fragmentFile() const override { return "test/checkers.frag.glsl"; }
    bool fill(osg::StateSet&, const std::string&, const SurfaceView&) override { return true; }

protected:
    ~Checkers() override = default;
};

osg::ref_ptr<osg::Program> makeProgram(const char* vertex, const char* fragment)
{
    osg::ref_ptr<osg::Program> program = new osg::Program;
    program->addShader(new osg::Shader(osg::Shader::VERTEX, vertex));
    program->addShader(new osg::Shader(osg::Shader::FRAGMENT, fragment));
    return program;
}

class AdaptedProgramsTest : public BentGround
{
protected:
    /// A ground and two boxes with a program, below a bend that takes colors away from the context, and a lift.
    static osg::ref_ptr<EffectScene> sceneWith(osg::Program* program)
    {
        const osg::ref_ptr<EffectScene> scene =
            makeScene({makeGround(), makeBox(8, {-25, -60, 0}), makeBox(12, {20, 20, 0})});
        static_cast<BirdsEyeView*>(scene->getEffect(0))->setContextSaturation(0.3);
        const osg::ref_ptr<VerticalExaggeration> lift = new VerticalExaggeration;
        lift->setFactor(3.0);
        scene->addEffect(lift);
        if (!program) return scene;
        const osg::ref_ptr<osg::Group> dressed = new osg::Group;
        for (unsigned int i = 0; i < scene->getNumChildren(); ++i)
            dressed->addChild(scene->getChild(i));
        scene->removeChildren(0, scene->getNumChildren());
        scene->addChild(dressed);
        dressed->getOrCreateStateSet()->setAttribute(program);
        dressed->getStateSet()->setAttribute(new osg::Depth(osg::Depth::LEQUAL)); // a sky shows
        return scene;
    }

    /// Pixels that differ by more than rounding.
    static int apart(const osg::Image& a, const osg::Image& b)
    {
        int count = 0;
        for (int i = 0; i < WIDTH * HEIGHT; ++i)
        {
            int most = 0;
            for (int channel = 0; channel < 4; ++channel)
                most = std::max(most, std::abs(a.data()[4 * i + channel] - b.data()[4 * i + channel]));
            count += most > 1 ? 1 : 0;
        }
        return count;
    }

    /// A host's program as it is, adapted, against the one with the calls. `exact`: to the last bit.
    void compare(const HostProgram& host, bool exact)
    {
        const osg::ref_ptr<osg::Program> byHand = host.make(true);
        EffectScene::addFunctions(*byHand);
        const osg::ref_ptr<osg::Image> expected = render(sceneWith(byHand));
        const osg::ref_ptr<osg::Program> program = host.make(false);
        EffectScene::adapt(*program);
        const osg::ref_ptr<osg::Image> drawn = render(sceneWith(program));
        if (exact)
            EXPECT_TRUE(same(*drawn, *expected));
        else
            // The place is worked out anew, so an edge may run on the other side of a pixel's middle.
            EXPECT_LE(apart(*drawn, *expected), 5);
        // It is moved, and colored, at all.
        const osg::ref_ptr<osg::Group> plain = new osg::Group;
        const osg::ref_ptr<EffectScene> still = sceneWith(program);
        plain->addChild(still->getChild(0));
        EXPECT_GT(differing(*expected, *render(plain)), WIDTH * HEIGHT / 4);
    }

    /// A picture of a ground and of boxes in it, each with a program, with calls by hand or adapted.
    osg::ref_ptr<osg::Image> withBoxes(const osg::ref_ptr<osg::Program>& ground,
                                       const osg::ref_ptr<osg::Program>& boxes, bool byHand,
                                       osg::Depth::Function notBehind = osg::Depth::LEQUAL)
    {
        for (osg::Program* each : {ground.get(), boxes.get()})
        {
            if (byHand)
                EffectScene::addFunctions(*each);
            else
                EffectScene::adapt(*each);
        }
        const osg::ref_ptr<EffectScene> scene = sceneWith(ground);
        for (const double y : {-60.0, -20.0, 30.0, 80.0})
        {
            const osg::ref_ptr<osg::MatrixTransform> box = makeBox(9, {y / 4, y, -6});
            box->getOrCreateStateSet()->setAttribute(boxes);
            scene->addChild(box);
        }
        scene->getChild(0)->getStateSet()->setAttribute(new osg::Depth(notBehind));
        return render(scene);
    }
};

/// Those that Mesa's compatibility contexts have.
const char* const versions[] = {"",
                                "#version 110\n",
                                "#version 120\n",
                                "#version 130\n",
                                "#version 150 compatibility\n",
                                "#version 330 compatibility\n",
                                "#version 420 compatibility\n",
                                "#version 450 compatibility\n"};

/// As a fixed-function stage would, as shaders have it.
constexpr const char* multiplied =
    "gl_Position = gl_ProjectionMatrix * DEFORM(gl_ModelViewMatrix * gl_Vertex);";
/// Moved by a wave of its own.
constexpr const char* displaced =
    "vec4 place = gl_Vertex;\n"
    "    place.z += 3.0 * sin(place.x / 9.0 + wave);\n"
    "    gl_Position = gl_ProjectionMatrix * DEFORM(gl_ModelViewMatrix * place);";

} // namespace

// As the fixed functions have it, to the last bit.
TEST_F(AdaptedProgramsTest, EveryVersionIsDrawnAsByHand)
{
    const osg::ref_ptr<osg::Image> expected = render(sceneWith(nullptr));
    for (const char* version : versions)
    {
        SCOPED_TRACE(version);
        compare(HostProgram(version, multiplied), true);
        compare(HostProgram(version, displaced, "uniform float wave;\n"), false);
        const osg::ref_ptr<osg::Program> program =
            HostProgram(version, "gl_Position = ftransform();").make(false);
        EffectScene::adapt(*program);
        EXPECT_TRUE(same(*render(sceneWith(program)), *expected));
        const osg::ref_ptr<osg::Program> whole =
            HostProgram(version, "gl_Position = gl_ModelViewProjectionMatrix * gl_Vertex;").make(false);
        EffectScene::adapt(*whole);
        EXPECT_LE(apart(*render(sceneWith(whole)), *expected), 3);
    }
}

TEST_F(AdaptedProgramsTest, PicturesInParallelProjectionToo)
{
    viewer().getCamera()->setProjectionMatrixAsOrtho(-120, 120, -90, 90, 5, 2000);
    compare(HostProgram("#version 120\n", multiplied), true);
    compare(HostProgram("#version 120\n", displaced, "uniform float wave;\n"), false);
}

// A picture of half a frustum, as of walls of screens.
TEST_F(AdaptedProgramsTest, PicturesOfAskewFrustumToo)
{
    viewer().getCamera()->setProjectionMatrixAsFrustum(-0.5, 2.9, -1.2, 1.6, 5, 2000);
    compare(HostProgram("#version 120\n", multiplied), true);
    compare(HostProgram("#version 120\n", displaced, "uniform float wave;\n"), false);
}

TEST_F(AdaptedProgramsTest, ColorsComeFromAnyOutput)
{
    const std::string vertex = "#version 330 compatibility\n";
    const auto output =
        [&](const std::string& version, const std::string& declarations, const std::string& statement)
    {
        HostProgram host(vertex, multiplied);
        host.fragments = {version + "DEFINES\n" + declarations + "void main()\n{\n    " + statement +
                          "\n}\n"};
        return host;
    };
    const std::string late = "#version 420 compatibility\n";
    compare(output("#version 120\n", "", "gl_FragData[0] = TINT(gl_Color);"), true);
    compare(output(vertex, "out vec4 color;\n", "color = TINT(gl_Color);"), true);
    compare(output(vertex, "layout(location = 0) out vec4 color; // and nothing else\n",
                   "color = TINT(gl_Color);"),
            true);
    compare(output(vertex,
                   "layout(location = 1) out vec4 glow;\nlayout(location = 0) out vec4 color;\n"
                   "void shade(out vec4 result) { result = gl_Color; }\n",
                   "vec4 own; shade(own); glow = vec4(1.0); color = TINT(own);"),
            true);
    compare(output(late, "layout(location = 0, index = 0) out mediump vec4 colors[2];\n",
                   "colors[0] = TINT(gl_Color); colors[1] = vec4(0.0);"),
            true);
    compare(output(vertex,
                   "#if __VERSION__ >= 130\nout vec4 color;\n#else\n#define color gl_FragColor\n#endif\n",
                   "color = TINT(gl_Color);"),
            true);
    // Some fragments are left out, and main() comes to its end early.
    compare(output(vertex, "",
                   "if (gl_Color.r < 0.3) discard;\n    gl_FragColor = TINT(vec4(1, 0, 0, 1));\n"
                   "    if (gl_Color.r < 0.6) return;\n    gl_FragColor = TINT(gl_Color);"),
            true);
    // The application says which is which.
    HostProgram bound =
        output(vertex, "out vec4 glow;\nout vec4 color;\n", "glow = vec4(1.0);\n    color = TINT(gl_Color);");
    bound.locations = {{"color", 0}, {"glow", 1}};
    compare(bound, true);
}

TEST_F(AdaptedProgramsTest, ShadersMayBeSeveralAndSayMainInOtherPlaces)
{
    HostProgram host("#version 120\n", multiplied);
    host.vertices = {
        "// main() is below\n/* void main() { } */\n#version 120\n#extension GL_ARB_texture_rectangle : "
        "enable\n"
        "DEFINES\nvec4 mainPlace(vec4 at);\n#define main_color gl_Color\n"
        "void main(void)\n{\n    gl_Position = mainPlace(gl_Vertex);\n    gl_FrontColor = main_color;\n}\n",
        "#version 130\nDEFINES\nvec4 mainPlace(vec4 at)\n{\n    // not main()\n"
        "    return gl_ProjectionMatrix * DEFORM(gl_ModelViewMatrix * at);\n}"};
    host.fragments = {
        "DEFINES\nvec4 shade();\n#define ENTRY void main()\nENTRY { gl_FragColor = TINT(shade()); }// end",
        "vec4 shade() { return gl_Color; }"};
    compare(host, true);
    // The color is another shader's than main()'s.
    host.fragments = {
        "#version 330 compatibility\nvoid shade();\nvoid main() { shade(); }\n",
        "#version 330 compatibility\nDEFINES\nout vec4 color;\nvoid shade() { color = TINT(gl_Color); }\n"};
    compare(host, true);
}

// Fragments show their depth, which is that of the same formula at the new place.
TEST_F(AdaptedProgramsTest, DepthsFollowTheHostsFormula)
{
    const std::string log =
        "gl_Position.z = (log2(max(1e-6, 1.0 + gl_Position.w)) * 0.17 - 1.0) * gl_Position.w;";
    for (const std::string& formula : {std::string(), log, std::string("gl_Position.z = gl_Position.w;"),
                                       std::string("gl_Position.z -= 0.01 * gl_Position.w;")})
    {
        SCOPED_TRACE(formula);
        HostProgram host("#version 120\n", std::string(displaced) + "\n    " + formula,
                         "uniform float wave;\n");
        host.fragments = {
            "#version 120\nDEFINES\nvoid main()\n{\n    float depth = gl_FragCoord.z;\n"
            "    gl_FragColor = TINT(vec4(depth, fract(depth * 64.0), fract(depth * 4096.0), 1.0));\n}\n"};
        compare(host, false);
    }
    // Logarithms for another purpose.
    compare(HostProgram("#version 120\n",
                        std::string(displaced) +
                            "\n    gl_TexCoord[0] = vec4(log2(2.0 + gl_Vertex.x * gl_Vertex.x));",
                        "uniform float wave;\n"),
            false);
}

// Things whose fragments have logarithmic depths among things whose vertices have.
TEST_F(AdaptedProgramsTest, DepthsOfFragmentsFollow)
{
    const std::string vertex =
        "gl_Position.z = (log2(max(1e-6, 1.0 + gl_Position.w)) * 0.17 - 1.0) * gl_Position.w;";
    for (const char* version : {"#version 120\n", "#version 330 compatibility\n"})
    {
        SCOPED_TRACE(version);
        const bool old = std::strcmp(version, "#version 120\n") == 0;
        const auto picture = [&](bool byHand)
        {
            const osg::ref_ptr<osg::Program> ground =
                HostProgram("#version 120\n", std::string(multiplied) + "\n    " + vertex).make(byHand);
            HostProgram own(version, std::string(multiplied) + "\n    far = 1.0 + gl_Position.w;",
                            old ? "varying float far;\n" : "out float far;\n");
            own.fragments = {std::string(version) + "DEFINES\n" + (old ? "varying" : "in") +
                             " float far;\nvoid main()\n{\n    gl_FragColor = TINT(gl_Color);\n"
                             "    gl_FragDepth = 0.5 * 0.17 * log2(far);\n}\n"};
            return withBoxes(ground, own.make(byHand), byHand);
        };
        EXPECT_LE(apart(*picture(false), *picture(true)), 5);
    }
}

// Things whose fragments have the depth of a place beside theirs, as relief maps do.
TEST_F(AdaptedProgramsTest, ProjectedDepthsOfFragmentsFollow)
{
    bool reversed = false;
    const auto picture = [&](bool byHand, double nearer)
    {
        const osg::ref_ptr<osg::Program> ground = HostProgram("#version 120\n", multiplied).make(byHand);
        HostProgram own("#version 120\n",
                        "place = DEFORM(gl_ModelViewMatrix * gl_Vertex);\n"
                        "    gl_Position = gl_ProjectionMatrix * place;",
                        "varying vec4 place;\n");
        own.fragments = {"#version 120\nDEFINES\nvarying vec4 place;\nvoid main()\n{\n"
                         "    gl_FragColor = TINT(gl_Color);\n    vec3 at = place.xyz / place.w;\n"
                         "    vec4 clip = gl_ProjectionMatrix * vec4(at - " +
                         std::to_string(nearer) +
                         " * normalize(at), 1.0);\n"
                         "    if (gl_Color.r > 0.5)\n        gl_FragDepth = " +
                         (reversed ? "clip.z / clip.w" : "0.5 * (clip.z / clip.w + 1.0)") +
                         ";\n"
                         "    else\n        gl_FragDepth = gl_FragCoord.z;\n}\n"};
        return withBoxes(ground, own.make(byHand), byHand,
                         reversed ? osg::Depth::GEQUAL : osg::Depth::LEQUAL);
    };
    for (const bool otherWay : {false, true})
    {
        SCOPED_TRACE(otherWay);
        reversed = otherWay;
        const osg::ref_ptr<EffectScene> unused = new EffectScene;
        if (reversed) DepthKind{"", DepthKind::REVERSED, true}.setUp(*viewer().getCamera(), *unused);
        const osg::ref_ptr<osg::Image> drawn = picture(false, 5.0);
        EXPECT_LE(apart(*drawn, *picture(true, 5.0)), 12);
        EXPECT_GT(apart(*drawn, *picture(true, 0.0)), 60);
    }
}

// With reversed depths, too: an offset, and a sky at the far plane.
TEST_F(AdaptedProgramsTest, ReversedDepthsFollow)
{
    const osg::ref_ptr<EffectScene> unused = new EffectScene;
    DepthKind{"", DepthKind::REVERSED, true}.setUp(*viewer().getCamera(), *unused);
    const auto picture = [&](bool byHand, const std::string& formula)
    {
        HostProgram host("#version 120\n",
                         "gl_Position = gl_ProjectionMatrix * DEFORM(gl_ModelViewMatrix * gl_Vertex);\n    " +
                             formula);
        host.fragments = {
            "#version 120\nDEFINES\nvoid main()\n{\n    float depth = gl_FragCoord.z;\n"
            "    gl_FragColor = TINT(vec4(depth, fract(depth * 16.0), fract(depth * 256.0), 1.0));\n}\n"};
        const osg::ref_ptr<osg::Program> program = host.make(byHand);
        if (byHand)
            EffectScene::addFunctions(*program);
        else
            EffectScene::adapt(*program);
        const osg::ref_ptr<EffectScene> scene = sceneWith(program);
        scene->getChild(0)->getStateSet()->setAttribute(new osg::Depth(osg::Depth::GEQUAL));
        return render(scene);
    };
    for (const std::string& formula : {std::string(), std::string("gl_Position.z += 0.002 * gl_Position.w;"),
                                       std::string("gl_Position.z = 0.0;")})
    {
        SCOPED_TRACE(formula);
        const osg::ref_ptr<osg::Image> expected = picture(true, formula);
        EXPECT_GT(covered(*expected), WIDTH * HEIGHT / 2);
        EXPECT_LE(apart(*picture(false, formula), *expected), 12);
    }
}

// Planes cut the ground as it lies, whether the host's shader tells where that is or not.
TEST_F(AdaptedProgramsTest, ClipPlanesCutAsWithoutProgram)
{
    const auto cut = [](osg::Program* program)
    {
        const osg::ref_ptr<EffectScene> scene = sceneWith(program);
        const osg::ref_ptr<osg::ClipNode> clip = new osg::ClipNode;
        clip->addClipPlane(new osg::ClipPlane(0, 1.0, 0.4, 0.0, 10.0));
        for (unsigned int i = 0; i < scene->getNumChildren(); ++i)
            clip->addChild(scene->getChild(i));
        scene->removeChildren(0, scene->getNumChildren());
        scene->addChild(clip);
        return scene;
    };
    const osg::ref_ptr<osg::Image> expected = render(cut(nullptr));
    EXPECT_LT(covered(*expected), covered(*render(sceneWith(nullptr))) * 9 / 10);
    for (const char* tells :
         {"", "\n    gl_ClipVertex = gl_ModelViewMatrix * gl_Vertex;",
          "\n    gl_ClipDistance[0] = dot(gl_ClipPlane[0], gl_ModelViewMatrix * gl_Vertex);"})
    {
        SCOPED_TRACE(tells);
        const osg::ref_ptr<osg::Program> program =
            HostProgram("#version 130\n", std::string("gl_Position = ftransform();") + tells).make(false);
        EffectScene::adapt(*program);
        EXPECT_LE(apart(*render(cut(program)), *expected), 5);
    }
}

TEST_F(AdaptedProgramsTest, GeometryStagesAreAdapted)
{
    HostProgram host("#version 330 compatibility\n", "gl_Position = gl_Vertex;");
    // Each triangle a little smaller, and as light as its vertices are.
    host.geometry =
        "#version 330 compatibility\n#ifdef GL_ES\nprecision highp float;\n#endif\nDEFINES\n"
        "layout(triangles) in;\nlayout(triangle_strip, max_vertices = 3) out;\nuniform float wave;\n"
        "void main()\n{\n    for (int i = 0; i < 3; ++i)\n    {\n"
        "        vec4 place = gl_in[i].gl_Position;\n        place.z += 2.0 + wave;\n"
        "        gl_Position = gl_ProjectionMatrix * DEFORM(gl_ModelViewMatrix * place);\n"
        "        gl_FrontColor = gl_in[i].gl_FrontColor;\n        EmitVertex();\n    }\n"
        "    EndPrimitive();\n}\n";
    compare(host, false);
}

TEST_F(AdaptedProgramsTest, TessellationStagesAreAdapted)
{
    HostProgram host("#version 400 compatibility\n", "gl_Position = gl_Vertex;");
    host.control = "#version 400 compatibility\nlayout(vertices = 3) out;\nvoid main()\n{\n"
                   "    gl_out[gl_InvocationID].gl_Position = gl_in[gl_InvocationID].gl_Position;\n"
                   "    gl_out[gl_InvocationID].gl_FrontColor = gl_in[gl_InvocationID].gl_FrontColor;\n"
                   "    gl_TessLevelOuter[0] = gl_TessLevelOuter[1] = gl_TessLevelOuter[2] = 2.0;\n"
                   "    gl_TessLevelInner[0] = 2.0;\n}\n";
    host.evaluation =
        "#version 400 compatibility\nDEFINES\nlayout(triangles, equal_spacing, ccw) in;\nvoid main()\n{\n"
        "    vec3 w = gl_TessCoord;\n    vec4 place = w.x * gl_in[0].gl_Position + "
        "w.y * gl_in[1].gl_Position + w.z * gl_in[2].gl_Position;\n"
        "    gl_Position = gl_ProjectionMatrix * DEFORM(gl_ModelViewMatrix * place);\n"
        "    gl_FrontColor = w.x * gl_in[0].gl_FrontColor + w.y * gl_in[1].gl_FrontColor + "
        "w.z * gl_in[2].gl_FrontColor;\n}\n";
    // Clip planes cut what these stages make, too.
    HostProgram cutting = host;
    const std::string ending = "    gl_FrontColor = w.x";
    cutting.evaluation.insert(cutting.evaluation.find(ending),
                              "    gl_ClipDistance[0] = dot(gl_ClipPlane[0], gl_ModelViewMatrix * place);\n");
    const auto patched = [&](bool byHand)
    {
        const osg::ref_ptr<osg::Program> program = (byHand ? cutting : host).make(byHand);
        if (byHand)
            EffectScene::addFunctions(*program);
        else
            EffectScene::adapt(*program);
        const osg::ref_ptr<osg::Geometry> ground = makeGround();
        auto* triangles = static_cast<osg::DrawElementsUInt*>(ground->getPrimitiveSet(0));
        triangles->setMode(GL_PATCHES);
        ground->getOrCreateStateSet()->setAttribute(program);
        ground->getStateSet()->setAttribute(new osg::PatchParameter(3));
        // Clip planes cut what these stages make, too.
        const osg::ref_ptr<osg::ClipNode> clip = new osg::ClipNode;
        clip->addClipPlane(new osg::ClipPlane(0, 1.0, 0.4, 0.0, 30.0));
        clip->addChild(ground);
        const osg::ref_ptr<EffectScene> scene = makeScene({clip});
        static_cast<BirdsEyeView*>(scene->getEffect(0))->setContextSaturation(0.3);
        return scene;
    };
    const osg::ref_ptr<osg::Image> expected = render(patched(true));
    EXPECT_GT(covered(*expected), WIDTH * HEIGHT / 4);
    const osg::ref_ptr<EffectScene> scene = patched(false);
    EXPECT_LE(apart(*render(scene), *expected), 5);
    scene->getEffect(0)->setEnabled(false);
    EXPECT_GT(differing(*render(scene), *expected), WIDTH * HEIGHT / 4);
}

// Attributes do not reach these stages: the application says what an effect would read.
TEST_F(AdaptedProgramsTest, LaterStagesTellTextureCoordinates)
{
    const auto scene = [](osg::Program* program)
    {
        const osg::ref_ptr<EffectScene> result = new EffectScene;
        result->addEffect(new Checkers);
        result->addChild(makeGround());
        if (program) result->getChild(0)->getOrCreateStateSet()->setAttribute(program);
        return result;
    };
    const osg::ref_ptr<osg::Image> expected = render(scene(nullptr));
    EXPECT_GT(differing(*expected, *render(makePlain({makeGround()}))), WIDTH * HEIGHT / 4);
    for (const bool byHand : {true, false})
    {
        SCOPED_TRACE(byHand);
        HostProgram host("#version 330 compatibility\n",
                         "gl_TexCoord[0] = gl_MultiTexCoord0;\n    gl_Position = gl_Vertex;");
        host.geometry = std::string("#version 330 compatibility\nDEFINES\n") +
                        (byHand ? "void geofx_texture(vec4 coordinates);\n" : "") +
                        "layout(triangles) in;\nlayout(triangle_strip, max_vertices = 3) out;\n"
                        "void main()\n{\n    for (int i = 0; i < 3; ++i)\n    {\n" +
                        (byHand ? "        geofx_texture(gl_in[i].gl_TexCoord[0]);\n" : "") +
                        "        vec4 eye = gl_ModelViewMatrix * gl_in[i].gl_Position;\n"
                        "        gl_Position = gl_ProjectionMatrix * DEFORM(eye);\n"
                        "        gl_FrontColor = gl_in[i].gl_FrontColor;\n"
                        "        gl_TexCoord[0] = gl_in[i].gl_TexCoord[0];\n"
                        "        EmitVertex();\n    }\n    EndPrimitive();\n}\n";
        const osg::ref_ptr<osg::Program> program = host.make(byHand);
        if (byHand)
            EffectScene::addFunctions(*program);
        else
            EffectScene::adapt(*program);
        EXPECT_LE(apart(*render(scene(program)), *expected), 5);
    }
}

// The core profile's language, with attributes and matrices of the application's, in a context that has both.
TEST_F(AdaptedProgramsTest, CoreShadersAreAdaptedInCompatibilityContexts)
{
    const osg::Camera& camera = *viewer().getCamera();
    const osg::ref_ptr<osg::Program> program = makeProgram(
        "#version 330 core\nlayout(location = 0) in vec4 place;\nlayout(location = 3) in vec4 tint;\n"
        "uniform mat4 toPicture;\nout vec4 shade;\n"
        "void main() { gl_Position = toPicture * place; shade = tint; }\n",
        "#version 330 core\nin vec4 shade;\nout vec4 color;\nvoid main() { color = shade; }\n");
    EffectScene::adapt(*program);
    const osg::ref_ptr<osg::Geometry> ground = makeGround();
    ground->setInitialBound(ground->getBoundingBox());
    ground->setVertexAttribArray(0, ground->getVertexArray(), osg::Array::BIND_PER_VERTEX);
    ground->setVertexAttribArray(3, ground->getColorArray(), osg::Array::BIND_PER_VERTEX);
    ground->setVertexArray(nullptr);
    ground->setColorArray(nullptr);
    ground->getOrCreateStateSet()->setAttribute(program);
    ground->getStateSet()->addUniform(
        new osg::Uniform("toPicture", osg::Matrixf(camera.getViewMatrix() * camera.getProjectionMatrix())));
    const osg::ref_ptr<osg::Image> expected = render(makeScene({makeGround()}));
    EXPECT_LE(apart(*render(makeScene({ground})), *expected), 5);
}
