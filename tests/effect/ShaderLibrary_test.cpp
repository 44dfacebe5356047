// SPDX-License-Identifier: MIT
// SPDX-FileCopyrightText: 2026 the osgGeoFX authors
// Assembling shader text without OpenGL, and what glslangValidator thinks of the kit's shaders.
#include <osgGeoFX/effect/ShaderLibrary.h>
#include <osgGeoFX/effect/detail/ProfileProgram.h>
#include <osgGeoFX/scene/detail/EffectProgram.h>
#include <osgGeoFX/viewer/EffectKinds.h>
#include <tools/RandomSamples.h>
#include <tools/RunProgram.h>
#include <tools/TempDir.h>

#include <gtest/gtest.h>

#include <algorithm>
#include <cstdlib>
#include <fstream>
#include <functional>
#include <iterator>
#include <map>
#include <set>
#include <sstream>

using geofx::test::Random;
using geofx::test::TempDir;
using osgGeoFX::EffectProgram;
using osgGeoFX::ProfileProgram;
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

void expectAccepted(const geofx::test::ProgramResult& result)
{
    // The validator says the same thing of each line that follows from a wrong one.
    const std::string said = (result.standardOutput + result.standardError).substr(0, 2000);
    EXPECT_EQ(result.exitCode, 0) << said;
    EXPECT_EQ(result.standardOutput.find("WARNING"), std::string::npos) << said;
}

/// The names of the defines that a shader takes from OSG.
std::vector<std::string> importedDefines(const std::string& text)
{
    std::vector<std::string> names;
    const std::string pragma = "#pragma import_defines(";
    for (std::size_t found = text.find(pragma); found != std::string::npos; found = text.find(pragma, found))
    {
        found += pragma.size();
        std::string list = text.substr(found, text.find(')', found) - found);
        std::replace(list.begin(), list.end(), ',', ' ');
        std::istringstream words(list);
        std::copy(std::istream_iterator<std::string>(words), {}, std::back_inserter(names));
    }
    return names;
}

/// The text as OSG gives it to the compiler: the defines that are set stand behind the line with the version.
std::string withDefines(const std::string& text, const std::map<std::string, std::string>& defines)
{
    std::string lines;
    for (const std::string& name : importedDefines(text))
    {
        const auto found = defines.find(name);
        if (found != defines.end()) lines += "#define " + name + " " + found->second + "\n";
    }
    const std::size_t end = text.find('\n') + 1;
    EXPECT_EQ(text.rfind("#version", 0), 0u);
    return text.substr(0, end) + lines + text.substr(end);
}

const char* endingOf(osg::Shader::Type stage)
{
    switch (stage)
    {
    case osg::Shader::GEOMETRY:
        return ".geom";
    case osg::Shader::TESSCONTROL:
        return ".tesc";
    case osg::Shader::TESSEVALUATION:
        return ".tese";
    case osg::Shader::VERTEX:
        return ".vert";
    default:
        return ".frag";
    }
}

/// The text of a stage in a version in which the validator knows the compatibility profile's variables in it.
std::string validatorsText(const osg::Shader& shader)
{
    const std::string version = "#version 330 compatibility";
    std::string text = shader.getShaderSource();
    if (shader.getType() == osg::Shader::GEOMETRY && text.rfind(version, 0) == 0)
        text.replace(0, version.size(), "#version 400 compatibility");
    return text;
}

/// The stages that copy triangles hand on what the fixed functions' stand-in has for its fragments.
bool needsFixedFunctions(const osg::Shader& shader)
{
    return shader.getShaderSource().find("gl_FrontColor") != std::string::npos;
}

/// As OSG gives it to the compiler of a core profile.
std::string coreText(const osg::Shader& shader)
{
    std::string text = ProfileProgram::coreText(shader.getShaderSource(), shader.getType());
    const osg::ref_ptr<osg::State> state = new osg::State;
    state->setUseModelViewAndProjectionUniforms(true);
    state->setUseVertexAttributeAliasing(true);
    if (shader.getType() == osg::Shader::VERTEX) state->convertVertexShaderSourceToOsgBuiltIns(text);
    return text;
}

/// Compiles all shaders of a program in both profiles, each as a unit, with a share of their defines set. The validator cannot link
/// several units that use the compatibility profile's own variables; drivers do that in the tests with OpenGL.
void expectProgramAccepted(const osg::Program* program, Random& random, double share)
{
    ASSERT_TRUE(program);
    // The stages share their defines.
    std::map<std::string, std::string> defines;
    for (unsigned int i = 0; i < program->getNumShaders(); ++i)
    {
        for (const std::string& name : importedDefines(program->getShader(i)->getShaderSource()))
        {
            if (random.uniform(0.0, 1.0) <= share && share > 0.0)
                defines.emplace(name, std::to_string(random.integer(1, 3)));
        }
    }
    // Programs share most of their shaders, so each text is compiled once.
    static std::set<std::string> compiled;
    const TempDir folder;
    std::vector<std::string> arguments = {"glslangValidator"};
    for (unsigned int i = 0; i < program->getNumShaders(); ++i)
    {
        const osg::Shader& shader = *program->getShader(i);
        const std::string name = "unit" + std::to_string(i) + endingOf(shader.getType());
        const std::string text = withDefines(validatorsText(shader), defines);
        if (!compiled.insert(endingOf(shader.getType()) + text).second) continue;
        folder.write(name, text);
        arguments.push_back((std::filesystem::path(folder.path()) / name).string());
        // In a core profile, without what needs the fixed functions.
        if (shader.getName().rfind("stages/fixed.", 0) == 0 || needsFixedFunctions(shader)) continue;
        folder.write("core" + name, withDefines(coreText(shader), defines));
        arguments.push_back((std::filesystem::path(folder.path()) / ("core" + name)).string());
    }
    if (arguments.size() == 1) return;
    std::string set;
    for (const auto& [name, value] : defines)
        set.append(name).append("=").append(value).append(" ");
    SCOPED_TRACE(set);
    expectAccepted(geofx::test::runProgram(arguments));
}

/// The scene's program, with the functions of all stages.
void expectProgramAccepted(const EffectProgram::Effects& effects, Random& random, double share)
{
    const osg::ref_ptr<osg::Program> program = EffectProgram::create(effects);
    ASSERT_TRUE(program);
    program->addShader(new osg::Shader(
        osg::Shader::TESSEVALUATION, "#version 400 compatibility\nlayout(triangles) in;\nvoid main() {}\n"));
    program->addShader(new osg::Shader(osg::Shader::GEOMETRY,
                                       "#version 330 compatibility\nlayout(triangles) in;\n"
                                       "layout(triangle_strip, max_vertices = 3) out;\nvoid main() {}\n"));
    EffectProgram::addFunctions(*program, effects);
    EXPECT_EQ(program->getNumShaders(), 8u);
    expectProgramAccepted(program, random, share);
    const osg::ref_ptr<osg::Program> tessellating = EffectProgram::createTessellating(effects);
    ASSERT_TRUE(tessellating);
    EXPECT_EQ(tessellating->getNumShaders(), 6u);
    expectProgramAccepted(tessellating, random, share);
}

/// What CloseUps draws with: triangles as they are, copied into layers, divided and copied, and anchors' walls and lines.
std::vector<osgGeoFX::PassShaders> closeUpPasses()
{
    osgGeoFX::PassShaders plain;
    plain.vertex = {"stages/closeup.items.glsl", "stages/closeup.vert.glsl"};
    plain.fragment = {"stages/closeup.items.glsl", "stages/closeup.frag.glsl"};
    plain.blocks = {{"Items", 7}};
    osgGeoFX::PassShaders amplifying = plain;
    amplifying.geometry = {"stages/closeup.items.glsl", "stages/closeup.geom.glsl"};
    osgGeoFX::PassShaders tessellating = amplifying;
    tessellating.tessellationControl = {"stages/closeup.items.glsl", "stages/closeup.tesc.glsl"};
    tessellating.tessellationEvaluation = {"stages/closeup.tese.glsl"};
    osgGeoFX::PassShaders fence = plain;
    fence.vertexMain = "stages/closeup.fence.vert";
    fence.fragmentMain = "stages/closeup.fence.frag";
    return {plain, amplifying, tessellating, fence};
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

TEST(ShaderLibrary, TakesFilesOfApplications)
{
    const ShaderLibrary library{std::filesystem::path()};
    EXPECT_NE(errorOf([&] { library.read("mine/wave.glsl"); }), "");
    EXPECT_TRUE(ShaderLibrary::add("mine/wave.glsl", "float wave() { return 1.0; }\n"));
    EXPECT_EQ(library.read("mine/wave.glsl"), "float wave() { return 1.0; }\n");
    EXPECT_TRUE(ShaderLibrary::add("mine/wave.glsl", "float wave() { return 2.0; }\n")) << "replaced";
    EXPECT_NE(library.assemble("#include \"mine/wave.glsl\"\n", "own").find("return 2.0"), std::string::npos);
    // The kit's own stay.
    const std::string bend = library.read("lib/bend.glsl");
    EXPECT_FALSE(ShaderLibrary::add("lib/bend.glsl", "// mine\n"));
    EXPECT_EQ(library.read("lib/bend.glsl"), bend);
    const TempDir folder;
    folder.write("mine/wave.glsl", "// edited\n");
    EXPECT_EQ(ShaderLibrary(folder.path()).read("mine/wave.glsl"), "// edited\n") << "the folder comes first";
}

TEST(ShaderLibrary, SaysWhatIsMissing)
{
    const ShaderLibrary library{std::filesystem::path()};
    const std::string sentence =
        "there is no shader file \"lib/none.glsl\" in the library; correct the name, or add the file, one of "
        "the "
        "kit's to the list in shaders/CMakeLists.txt, another one with ShaderLibrary::add().";
    EXPECT_EQ(errorOf([&] { library.source("lib/none.glsl"); }), sentence);
    EXPECT_EQ(errorOf([&] { library.assemble("\n#include \"lib/none.glsl\"\n", "own"); }),
              "own:2: " + sentence);
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

TEST(ShaderLibrary, EveryLibraryFileIsAcceptedByGlslangValidator)
{
    const ShaderLibrary library{std::filesystem::path()};
    for (const std::string& name : ShaderLibrary::files())
    {
        // What lies in stages/ is put together from several files; see below.
        if (name.rfind("lib/", 0) != 0) continue;
        SCOPED_TRACE(name);
        geofx::test::ProgramOptions options;
        // A file of functions alone becomes a stage.
        options.input = library.assemble("#version 330 compatibility\n#include \"" + name +
                                             "\"\nvoid main() { gl_Position = vec4(0.0); }\n",
                                         "stage");
        expectAccepted(geofx::test::runProgram({"glslangValidator", "--stdin", "-S", "vert"}, options));
    }
}

TEST(ShaderLibrary, ThePutTogetherStagesAreAcceptedByGlslangValidator)
{
    std::vector<EffectProgram::Effects> lists(1);
    EffectProgram::Effects all;
    for (const std::string& kind : osgGeoFX::effectKinds())
    {
        const osg::ref_ptr<osgGeoFX::Effect> effect = osgGeoFX::createEffect(kind);
        lists.push_back({effect});
        all.push_back(effect);
        std::string refusal;
        // The other curves are other constants.
        for (double curve = 0.0; kind == "birdsEyeView" && curve <= effect->property("curve")->maximum;
             ++curve)
        {
            const osg::ref_ptr<osgGeoFX::Effect> other = osgGeoFX::createEffect(kind);
            EXPECT_TRUE(other->setProperty("curve", curve, refusal));
            lists.push_back({other});
        }
    }
    // Pairs, in both orders; in the sample each effect is the first of one and the second of one.
    for (std::size_t first = 0; first < all.size(); ++first)
        for (std::size_t second = 0; second < all.size(); ++second)
            if (geofx::test::fullTest() ? first != second : second == (first + 1) % all.size())
                lists.push_back({all[first], all[second]});
    lists.push_back(all);
    all.insert(all.end(), all.rbegin(), all.rend()); // each twice
    lists.push_back(all);
    for (const EffectProgram::Effects& effects : lists)
    {
        SCOPED_TRACE(EffectProgram::key(effects));
        // Every define on; for the shortest and the longest also off, and in the full test on by chance.
        Random random(effects.size());
        expectProgramAccepted(effects, random, 1.0);
        if (effects.empty() || effects.size() > 2)
        {
            expectProgramAccepted(effects, random, 0.0);
            if (geofx::test::fullTest()) expectProgramAccepted(effects, random, 0.5);
        }
    }
}

TEST(ShaderLibrary, EveryStageOfCloseUpsIsInAPass)
{
    std::set<std::string> used = {"stages/closeup.layer.vert", "stages/closeup.layer.frag"};
    for (const osgGeoFX::PassShaders& pass : closeUpPasses())
    {
        for (const auto& files : {pass.vertex, pass.geometry, pass.fragment, pass.tessellationControl,
                                  pass.tessellationEvaluation})
            used.insert(files.begin(), files.end());
        used.insert({pass.vertexMain, pass.fragmentMain});
    }
    for (const std::string& name : ShaderLibrary::files())
    {
        const bool isOne = name.rfind("stages/closeup.", 0) == 0;
        EXPECT_TRUE(!isOne || used.count(name) == 1) << name;
    }
}

TEST(ShaderLibrary, ThePassesOfCloseUpsAreAcceptedWithAnyDefines)
{
    // Alone, behind and before others, and with another one of its kind.
    const std::vector<std::vector<std::string>> lists = {
        {"closeUps"},
        {"birdsEyeView", "closeUps", "projectiveMappings"},
        {"projectiveMappings", "verticalExaggeration", "pedestrianView", "closeUps", "closeUps"},
    };
    const int samples = geofx::test::fullTest() ? 50 : 2;
    for (const std::vector<std::string>& kinds : lists)
    {
        EffectProgram::Effects effects;
        std::string prefix;
        for (const std::string& kind : kinds)
        {
            if (kind == "closeUps") prefix = EffectProgram::prefix(effects.size());
            effects.push_back(osgGeoFX::createEffect(kind));
        }
        for (std::size_t pass = 0; pass < closeUpPasses().size(); ++pass)
        {
            SCOPED_TRACE(kinds.front() + " " + std::to_string(pass));
            Random random(pass);
            for (int sample = 0; sample < samples; ++sample)
            {
                // None, all, and by chance.
                const double share = sample < 2 ? sample : random.uniform(0.0, 1.0);
                expectProgramAccepted(EffectProgram::create(effects, closeUpPasses()[pass], prefix), random,
                                      share);
                if (HasFailure()) return;
            }
        }
    }
}

TEST(ShaderLibrary, TheStagesThatShowLayersAreAccepted)
{
    const ShaderLibrary library{std::filesystem::path()};
    const osg::ref_ptr<osg::Program> program = new osg::Program;
    program->addShader(library.createShader(osg::Shader::VERTEX, "stages/closeup.layer.vert"));
    program->addShader(library.createShader(osg::Shader::FRAGMENT, "stages/closeup.layer.frag"));
    Random random(0);
    expectProgramAccepted(program, random, 1.0);
    expectProgramAccepted(program, random, 0.0);
}

TEST(ShaderLibrary, TheFixedStagesAreAcceptedWithAnyDefines)
{
    const osg::ref_ptr<osgGeoFX::Effect> effect = osgGeoFX::createEffect("birdsEyeView");
    const int samples = geofx::test::fullTest() ? 500 : 8;
    for (int sample = 0; sample < samples; ++sample)
    {
        SCOPED_TRACE(sample);
        Random random(static_cast<std::uint64_t>(sample));
        const double share = random.uniform(0.0, 1.0);
        expectProgramAccepted({effect}, random, share);
        if (HasFailure()) return;
    }
}
