// SPDX-License-Identifier: MIT
// SPDX-FileCopyrightText: 2026 the osgGeoFX authors
//
// What is told of an application's shader from its text.
#include <osgGeoFX/scene/detail/ShaderText.h>

#include <gtest/gtest.h>

using osgGeoFX::ShaderText;

TEST(ShaderText, VersionsAreFoundBehindComments)
{
    EXPECT_EQ(ShaderText("void main() {}").version(), 110);
    EXPECT_EQ(ShaderText("").version(), 110);
    EXPECT_EQ(ShaderText("#version 450 core").version(), 450);
    EXPECT_EQ(ShaderText("// #version 120\n/* \n*/  #  version 330 compatibility // 150\n").version(), 330);
    EXPECT_FALSE(ShaderText("#version 330 compatibility\n").embedded());
    EXPECT_TRUE(ShaderText("#version 300 es\nvoid main() {}").embedded());
    EXPECT_TRUE(ShaderText("#version 100\n").embedded());
    EXPECT_FALSE(ShaderText("#version 330\nes").embedded());
}

TEST(ShaderText, WordsAreThoseOutsideOfComments)
{
    const ShaderText text(
        "#define COLOR gl_FragColor\n// main\n/* log2( \n */ float remain, main2;\nstart();");
    EXPECT_TRUE(text.names("gl_FragColor"));
    EXPECT_TRUE(text.names("start"));
    for (const char* word : {"main", "log2", "gl_Frag", ""})
        EXPECT_FALSE(text.names(word)) << word;
    EXPECT_TRUE(text.namesLike("gl_Frag"));
    EXPECT_FALSE(text.namesLike("Frag"));
}

TEST(ShaderText, DirectivesThatDefineAWordAreFound)
{
    EXPECT_TRUE(ShaderText("#define main start\n").redefines("main"));
    EXPECT_TRUE(ShaderText("  # undef \\\n main\n").redefines("main"));
    EXPECT_FALSE(ShaderText("#define ENTRY void main()\n#define main2 3\n#ifdef main\n").redefines("main"));
    EXPECT_FALSE(ShaderText("// #define main start\n").redefines("main"));
}

TEST(ShaderText, OutputsAreThoseOfTheWholeStage)
{
    const ShaderText text("#version 420\n"
                          "layout(location = 2, index = 0) out highp vec4 glow;\n"
                          "out uvec4 ids; // out vec4 none;\n"
                          "layout ( early_fragment_tests ) in;\n"
                          "void shade(out vec4 result, in vec3 at, inout vec4 more);\n"
                          "layout(location=0)\n  out vec4 colors [ 2 ];\n"
                          "out Block { vec4 inside; } block;\n"
                          "#define OTHER out vec4 other;\n"
                          "void main() { vec4 out_; }\n");
    const std::vector<ShaderText::Output> all = text.outputs();
    ASSERT_EQ(all.size(), 3u);
    EXPECT_EQ(all[0].name, "glow");
    EXPECT_EQ(all[0].type, "vec4");
    EXPECT_EQ(all[0].location, 2);
    EXPECT_FALSE(all[0].array);
    EXPECT_EQ(all[1].name, "ids");
    EXPECT_EQ(all[1].type, "uvec4");
    EXPECT_EQ(all[1].location, -1);
    EXPECT_EQ(all[2].name, "colors");
    EXPECT_EQ(all[2].location, 0);
    EXPECT_TRUE(all[2].array);
    EXPECT_TRUE(ShaderText("out vec4 a").outputs().empty());
    EXPECT_TRUE(ShaderText("out").outputs().empty());
    EXPECT_TRUE(ShaderText("layout(location = 1").outputs().empty());
}

TEST(ShaderText, AssignmentsTellWhereValuesComeFrom)
{
    const char* const from = "gl_FragCoord";
    EXPECT_TRUE(ShaderText("gl_FragDepth = 0.5 * gl_FragCoord.z;").assignsFrom("gl_FragDepth", from));
    EXPECT_FALSE(ShaderText("gl_FragDepth = far; x = gl_FragCoord.x;").assignsFrom("gl_FragDepth", from));
    EXPECT_FALSE(
        ShaderText("gl_FragDepth = gl_FragCoord.z; gl_FragDepth = far;").assignsFrom("gl_FragDepth", from));
    EXPECT_FALSE(ShaderText("if (gl_FragDepth == gl_FragCoord.z) x = 1;").assignsFrom("gl_FragDepth", from));
    EXPECT_FALSE(ShaderText("void main() {}").assignsFrom("gl_FragDepth", from));
}

// Before version 330 a #line counts from the line behind it.
TEST(ShaderText, DirectivesGoBehindTheVersion)
{
    EXPECT_EQ(ShaderText("void main() {}").withDirective("#define A"), "#define A\n#line 0\nvoid main() {}");
    EXPECT_EQ(ShaderText("// x\n#version 120\nvoid main() {}").withDirective("#define A"),
              "// x\n#version 120\n#define A\n#line 2\nvoid main() {}");
    EXPECT_EQ(ShaderText("#version 330\n#extension X : enable\n").withDirective("#define A"),
              "#version 330\n#define A\n#line 2\n#extension X : enable\n");
    EXPECT_EQ(ShaderText("$OSG_GLSL_VERSION\nvoid main() {}").withDirective("#define A"),
              "$OSG_GLSL_VERSION\n#define A\n#line 1\nvoid main() {}");
    EXPECT_EQ(ShaderText("#version 330").withDirective("#define A"), "#version 330\n#define A\n#line 1\n");
}

TEST(ShaderText, DeclarationsGoBeforeTheFirstOne)
{
    const auto added = [](const std::string& source)
    {
        std::string text = source;
        return ShaderText(source).addDeclaration("int a;", text) ? text : "refused";
    };
    EXPECT_EQ(added("#version 330\n#extension X : enable\nvoid main() {}"),
              "#version 330\n#extension X : enable\nint a; void main() {}");
    EXPECT_EQ(added("#ifdef A\n#define B\n#endif\n  #if C\n#ifdef D\nfloat d;\n#endif\n#endif\nfloat e;"),
              "#ifdef A\n#define B\n#endif\n  int a;\n#if C\n#ifdef D\nfloat d;\n#endif\n#endif\nfloat e;");
    EXPECT_EQ(added("float e;\n#extension X : enable\n"), "refused");
    EXPECT_EQ(added("// nothing\n"), "refused");
    // Into a text that has got a directive already.
    const ShaderText text("#version 330\nfloat e;\n");
    std::string both = text.withDirective("#define A");
    EXPECT_TRUE(text.addDeclaration("int a;", both));
    EXPECT_EQ(both, "#version 330\n#define A\n#line 2\nint a; float e;\n");
}
