// SPDX-License-Identifier: MIT
// SPDX-FileCopyrightText: 2026 the osgGeoFX authors
// Assembling shader text without OpenGL, and what glslangValidator thinks of every shader file of the kit.
#include <osgGeoFX/scene/ShaderLibrary.h>
#include <tools/RunProgram.h>
#include <tools/TempDir.h>

#include <gtest/gtest.h>

#include <algorithm>
#include <cstdlib>
#include <fstream>
#include <functional>
#include <map>
#include <sstream>

using geofx::test::TempDir;
using osgGeoFX::ShaderError;
using osgGeoFX::ShaderLibrary;

namespace
{

std::string errorOf(const std::function<void()>& action)
{
    try
    {
        action();
    }
    catch (const ShaderError& error)
    {
        return error.what();
    }
    return "no error";
}

std::string readFile(const std::filesystem::path& path)
{
    std::ostringstream text;
    text << std::ifstream(path).rdbuf();
    return text.str();
}

} // namespace

TEST(ShaderLibrary, HasEveryFileAsItLiesInTheSources)
{
    const std::filesystem::path folder = std::filesystem::path(GEOFX_SOURCE_DIR) / "shaders";
    const std::vector<std::string> files = ShaderLibrary::files();
    const ShaderLibrary library{std::filesystem::path()};
    for (const auto& entry : std::filesystem::recursive_directory_iterator(folder))
    {
        const std::string extension = entry.path().extension();
        if (extension == ".glsl" || extension == ".vert" || extension == ".geom" || extension == ".frag")
        {
            const std::string name = std::filesystem::relative(entry.path(), folder);
            EXPECT_EQ(std::count(files.begin(), files.end(), name), 1)
                << name << " is not in the list in shaders/CMakeLists.txt.";
            const std::string text = library.read(name);
            EXPECT_EQ(text, readFile(entry.path()));
            // GLSL 3.30 knows no other characters, not even in comments.
            EXPECT_TRUE(std::all_of(text.begin(), text.end(), [](char c) { return c > 0; })) << name;
        }
    }
}

TEST(ShaderLibrary, AssemblesTextWithTrueLineNumbers)
{
    const TempDir folder;
    folder.write("lib/a.glsl", "float a;\n#include \"lib/b.glsl\"\nfloat afterB;\n");
    folder.write("lib/b.glsl", "float b;");
    folder.write("main.vert", "#version 330\n"
                              "  #  include  \"lib/a.glsl\" // with a comment\n"
                              "#include \"lib/b.glsl\"\n"
                              "void main() {}\n");
    EXPECT_EQ(ShaderLibrary(folder.path()).source("main.vert"), "#version 330\n"
                                                                "#line 1 1 // lib/a.glsl\n"
                                                                "float a;\n"
                                                                "#line 1 2 // lib/b.glsl\n"
                                                                "float b;\n"
                                                                "#line 3 1 // lib/a.glsl\n"
                                                                "float afterB;\n"
                                                                "#line 3 0 // main.vert\n"
                                                                "\n"
                                                                "void main() {}\n");
}

TEST(ShaderLibrary, LineNumbersAreThoseOfTheCompiler)
{
    const TempDir folder;
    folder.write("lib/wrong.glsl", "float right;\n\nfloat wrong = vec3(1.0);\n");
    folder.write("lib/right.glsl", "float right;\n\n\n\n");
    const ShaderLibrary library(folder.path());
    const auto messages = [&](const std::string& text)
    {
        geofx::test::ProgramOptions options;
        options.input = library.assemble(text, "own");
        return geofx::test::runProgram({"glslangValidator", "--stdin", "-S", "vert"}, options).standardOutput;
    };
    const std::string within = messages("#version 330\n#include \"lib/wrong.glsl\"\n");
    EXPECT_NE(within.find("ERROR: 1:3:"), std::string::npos) << within;
    const std::string behind = messages("#version 330\n#include \"lib/right.glsl\"\nfloat x = vec2(1.0);\n");
    EXPECT_NE(behind.find("ERROR: 0:3:"), std::string::npos) << behind;
}

TEST(ShaderLibrary, AFileOnDiskOverridesTheBakedOne)
{
    const TempDir folder;
    folder.write("lib/bend.glsl", "// mine\n");
    const ShaderLibrary library(folder.path());
    EXPECT_EQ(library.read("lib/bend.glsl"), "// mine\n");
    EXPECT_EQ(library.read("lib/series.glsl"),
              ShaderLibrary(std::filesystem::path()).read("lib/series.glsl"));
    folder.write("lib/bend.glsl", "// edited\n");
    EXPECT_EQ(library.source("lib/bend.glsl"), "// edited\n");
}

TEST(ShaderLibrary, TheEnvironmentNamesTheOverrideFolder)
{
    const TempDir folder;
    folder.write("lib/bend.glsl", "// mine\n");
    setenv("OSGGEOFX_SHADER_PATH", folder.path().c_str(), 1);
    const ShaderLibrary library;
    unsetenv("OSGGEOFX_SHADER_PATH");
    EXPECT_EQ(library.read("lib/bend.glsl"), "// mine\n");
    EXPECT_NE(ShaderLibrary().read("lib/bend.glsl"), "// mine\n");
}

TEST(ShaderLibrary, SaysWhatIsMissing)
{
    const ShaderLibrary library{std::filesystem::path()};
    EXPECT_EQ(errorOf([&] { library.source("lib/none.glsl"); }),
              "there is no shader file \"lib/none.glsl\" in the library; correct the name, or add the file "
              "to the list "
              "in shaders/CMakeLists.txt.");
    EXPECT_EQ(errorOf([&] { library.assemble("\n#include \"lib/none.glsl\"\n", "own"); }),
              "own:2: there is no shader file \"lib/none.glsl\" in the library; correct the name, or add the "
              "file to "
              "the list in shaders/CMakeLists.txt.");
    const TempDir folder;
    EXPECT_NE(errorOf([&] { ShaderLibrary(folder.path()).read("none"); }).find(folder.path()),
              std::string::npos);
    // A folder is not a file.
    EXPECT_NE(errorOf([&] { ShaderLibrary(folder.path().parent_path()).read(folder.path().filename()); }),
              "no error");
}

TEST(ShaderLibrary, SaysWhichFilesIncludeEachOther)
{
    const TempDir folder;
    folder.write("lib/a.glsl", "#include \"lib/b.glsl\"\n");
    folder.write("lib/b.glsl", "\n#include \"lib/a.glsl\"\n");
    EXPECT_EQ(errorOf([&] { ShaderLibrary(folder.path()).source("lib/a.glsl"); }),
              "lib/b.glsl:2: the shader file includes itself (lib/a.glsl > lib/b.glsl > lib/a.glsl); move "
              "what both "
              "need into a file of its own.");
}

TEST(ShaderLibrary, MakesNamedOsgShaders)
{
    const ShaderLibrary library{std::filesystem::path()};
    const osg::ref_ptr<osg::Shader> shader = library.createShader(osg::Shader::FRAGMENT, "lib/bend.glsl");
    EXPECT_EQ(shader->getType(), osg::Shader::FRAGMENT);
    EXPECT_EQ(shader->getName(), "lib/bend.glsl");
    EXPECT_EQ(shader->getShaderSource(), library.source("lib/bend.glsl"));
}

TEST(ShaderLibrary, EveryFileIsAcceptedByGlslangValidator)
{
    const ShaderLibrary library{std::filesystem::path()};
    const std::map<std::string, std::string> stages = {
        {".vert", "vert"}, {".geom", "geom"}, {".frag", "frag"}};
    for (const std::string& name : ShaderLibrary::files())
    {
        SCOPED_TRACE(name);
        const auto stage = stages.find(std::filesystem::path(name).extension());
        geofx::test::ProgramOptions options;
        // A file of functions alone becomes a stage.
        options.input = stage != stages.end()
                            ? library.source(name)
                            : library.assemble("#version 330 compatibility\n#include \"" + name +
                                                   "\"\nvoid main() { gl_Position = vec4(0.0); }\n",
                                               "stage");
        const auto result = geofx::test::runProgram(
            {"glslangValidator", "--stdin", "-S", stage != stages.end() ? stage->second : "vert"}, options);
        EXPECT_EQ(result.exitCode, 0) << result.standardOutput << result.standardError;
        EXPECT_EQ(result.standardOutput.find("WARNING"), std::string::npos) << result.standardOutput;
    }
}
