// SPDX-License-Identifier: MIT
// SPDX-FileCopyrightText: 2026 the osgGeoFX authors
//
// Which programs are adapted, and why others are not.
#include <osgGeoFX/scene/detail/AdaptedPrograms.h>

#include <gtest/gtest.h>

#include <thread>

using namespace osgGeoFX;

namespace
{

const std::string place = "void main() { gl_Position = ftransform(); }\n";
const std::string color = "void main() { gl_FragColor = vec4(1.0); }\n";

osg::ref_ptr<osg::Program> makeProgram(const std::string& vertex, const std::string& fragment,
                                       const std::string& geometry = "")
{
    osg::ref_ptr<osg::Program> program = new osg::Program;
    const auto add = [&](osg::Shader::Type stage, const std::string& text)
    {
        if (!text.empty()) program->addShader(new osg::Shader(stage, text));
    };
    add(osg::Shader::VERTEX, vertex);
    add(osg::Shader::GEOMETRY, geometry);
    add(osg::Shader::FRAGMENT, fragment);
    return program;
}

std::string refusalOf(const std::string& vertex, const std::string& fragment,
                      const std::string& geometry = "")
{
    return ProgramAdaptation(*makeProgram(vertex, fragment, geometry)).refusal();
}

} // namespace

TEST(AdaptedPrograms, ReasonsAreTold)
{
    EXPECT_EQ(refusalOf(place, color), "");
    EXPECT_EQ(refusalOf(place, ""), "");
    EXPECT_EQ(refusalOf("", ""), "it has no vertex shader");
    EXPECT_EQ(refusalOf("", color), "");
    EXPECT_NE(refusalOf("", "void main() { gl_FragDepth = 0.5; }").find("no vertex shader of its own"),
              std::string::npos);
    EXPECT_EQ(refusalOf("", color, "#version 150\nvoid main() { EmitVertex(); }"), "it has no vertex shader");
    EXPECT_EQ(refusalOf("#version 300 es\n" + place, color), "it is written for OpenGL ES");
    EXPECT_EQ(refusalOf("void start() { gl_Position = ftransform(); }", color),
              "its vertex shader has no main()");
    EXPECT_EQ(refusalOf("void main() { ftransform(); }", color), "it does not write gl_Position");
    EXPECT_EQ(refusalOf("void main() {}", color,
                        "#version 120\nvoid main() { gl_Position = gl_ModelViewMatrix[0]; EmitVertex(); }"),
              "its geometry shader is older than GLSL 1.50");
    EXPECT_EQ(refusalOf("void main() {}", color,
                        "#version 150\nuniform mat4 m; void main() { gl_Position = m[0]; EmitVertex(); }\n"
                        "#extension X : enable\n"),
              "its geometry shader has an #extension behind its first declaration");
    // Colors alone are no reason.
    const ProgramAdaptation none(*makeProgram(place, ""));
    EXPECT_EQ(none.colorRefusal(), "it has no fragment shader");
    EXPECT_EQ(ProgramAdaptation(*makeProgram(place, "void main() {}")).colorRefusal(), "");
    EXPECT_NE(ProgramAdaptation(*makeProgram(place, "out ivec4 id; void main() {}")).colorRefusal(), "");
}

TEST(AdaptedPrograms, AreThoseThatWereAddedForAsLongAsTheyLive)
{
    AdaptedPrograms programs;
    osg::ref_ptr<osg::Program> program = makeProgram(place, color);
    EXPECT_FALSE(programs.of(*program));
    programs.add(*program);
    programs.add(*program);
    const auto first = programs.of(*program);
    ASSERT_TRUE(first);
    EXPECT_EQ(programs.of(*program), first);
    // Nothing of it is kept, and the program is as it was.
    EXPECT_EQ(program->referenceCount(), 1);
    EXPECT_EQ(program->getShader(0)->referenceCount(), 1);
    EXPECT_EQ(program->getNumShaders(), 2u);
    EXPECT_FALSE(program->getUserDataContainer());
    program->addBindFragDataLocation("color", 0);
    const auto second = programs.of(*program);
    EXPECT_NE(second, first);
    program->getShader(0)->setShaderSource(place + "// more");
    EXPECT_NE(programs.of(*program), second);
    const osg::ref_ptr<osg::Program> copy = osg::clone(program.get(), osg::CopyOp::SHALLOW_COPY);
    EXPECT_FALSE(programs.of(*copy));
}

TEST(AdaptedPrograms, AnyThreadMayAddThem)
{
    AdaptedPrograms programs;
    std::vector<std::thread> threads;
    const osg::ref_ptr<osg::Program> shared = makeProgram(place, color);
    for (int i = 0; i < 4; ++i)
    {
        threads.emplace_back(
            [&]
            {
                for (int turn = 0; turn < 300; ++turn)
                {
                    const osg::ref_ptr<osg::Program> own = makeProgram(place, color);
                    programs.add(*own);
                    programs.add(*shared);
                    EXPECT_TRUE(programs.of(*own));
                    EXPECT_TRUE(programs.of(*shared));
                }
            });
    }
    for (std::thread& each : threads)
        each.join();
}
