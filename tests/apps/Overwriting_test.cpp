// SPDX-License-Identifier: MIT
// SPDX-FileCopyrightText: 2026 the osgGeoFX authors
//
// No program writes over a file that it reads, nor into a folder of somebody else: each option that names an output, against each file that
// the program reads, by each of its names.
#include <tools/FolderContents.h>
#include <tools/RandomSamples.h>
#include <tools/RunProgram.h>
#include <tools/TempDir.h>
#include <tools/TestRasters.h>

#include <gtest/gtest.h>

#include <algorithm>
#include <filesystem>
#include <functional>
#include <regex>
#include <set>
#include <sstream>
#include <string>
#include <vector>

using namespace geofx::test;
namespace fs = std::filesystem;

namespace
{

using Words = std::vector<std::string>;

Words operator+(Words left, const Words& right)
{
    left.insert(left.end(), right.begin(), right.end());
    return left;
}

/// A way to name an output: an option, or what a program writes beside its output.
struct Output
{
    std::string what;
    /// Endings that the name may have; the first one is that of links. None: any.
    Words endings;
    std::function<Words(const std::string& file)> words;
};

/// A file that a program reads.
struct Input
{
    std::string file;
    Words words;
};

/// The last word without its ending, with another one.
std::string beside(const std::string& file, const std::string& ending)
{
    return fs::path(file).replace_extension(ending).string();
}

const Words pictures = {".png", ".jpg", ".tif"};

class Overwriting : public ::testing::Test
{
protected:
    ProgramResult run(const std::string& program, const Words& words) const
    {
        ProgramOptions options;
        options.folder = _home.string();
        options.environment = {"DISPLAY="};
        return runProgram(Words{builtProgram(program)} + words, options);
    }

    /// The names by which a program may call a file; links are made and removed.
    void forEachName(const std::string& file, const std::string& ending,
                     const std::function<void(const std::string& how, const std::string& name)>& take) const
    {
        take("as it is", file);
        take("with a dot", "./" + file);
        take("through a folder", "../" + _home.filename().string() + "/" + file);
        take("absolute", (_home / file).string());
        const fs::path link = _home / ("link" + ending);
        fs::create_hard_link(_home / file, link);
        take("a hard link", "link" + ending);
        fs::remove(link);
        fs::create_symlink(file, link);
        take("a symbolic link", "link" + ending);
        fs::remove(link);
        fs::create_directory_symlink(_home, _folder / "alias");
        take("through a linked folder", "../alias/" + file);
        fs::remove(_folder / "alias");
    }

    static bool fits(const std::string& name, const Output& output)
    {
        const auto ends = [&](const std::string& ending)
        {
            return name.size() > ending.size() &&
                   name.compare(name.size() - ending.size(), ending.size(), ending) == 0;
        };
        return output.endings.empty() || std::any_of(output.endings.begin(), output.endings.end(), ends);
    }

    /// Every `step`-th of all combinations, or all in --full.
    void expectRefusals(const std::string& program, const std::vector<Input>& inputs,
                        const std::vector<Output>& outputs, int code = 2, int step = 131)
    {
        int number = 0, runs = 0;
        for (const Input& input : inputs)
        {
            for (const Output& output : outputs)
            {
                const std::string ending = output.endings.empty() ? ".json" : output.endings.front();
                forEachName(input.file, ending,
                            [&](const std::string& how, const std::string& name)
                            {
                                if (!fits(name, output) || (!fullTest() && ++number % step != 0)) return;
                                ++runs;
                                const auto before = contents(_home);
                                const ProgramResult result = run(program, input.words + output.words(name));
                                const std::string what =
                                    program + ": " + output.what + " on " + input.file + ", " + how;
                                EXPECT_EQ(result.exitCode, code) << what << "\n" << result.standardError;
                                EXPECT_TRUE(
                                    std::regex_search(result.standardError,
                                                      std::regex("would (replace (the|a) file|be replaced "
                                                                 "with).*, which is read; choose another")))
                                    << what << "\n"
                                    << result.standardError;
                                EXPECT_TRUE(contents(_home) == before) << what;
                            });
            }
        }
        EXPECT_GT(runs, 0) << program;
    }

    /// That the tables name all options which --help has.
    void expectOptions(const std::string& program, const Words& outputs, const Words& inputs,
                       const Words& others, const Words& command = {}) const
    {
        const ProgramResult result = run(program, command + Words{"--help"});
        std::set<std::string> known{"--help", "-h"}, listed;
        for (const Words& words : {outputs, inputs, others})
            known.insert(words.begin(), words.end());
        std::istringstream lines(result.standardOutput);
        const std::regex option(R"(^  (-[^ ]+|[A-Za-z_]+)( |$))");
        std::smatch match;
        for (std::string line; std::getline(lines, line);)
        {
            if (line.rfind("Examples:", 0) == 0) break;
            if (!std::regex_search(line, match, option)) continue;
            std::istringstream names(match[1]);
            for (std::string name; std::getline(names, name, ',');)
                listed.insert(name.substr(0, name.find('{')));
        }
        for (const std::string& name : listed)
            EXPECT_EQ(known.count(name), 1u)
                << program << ": " << name << " has no verdict; say here whether it names an output.";
        for (const std::string& name : outputs)
            EXPECT_EQ(listed.count(name), 1u) << program << ": there is no " << name << " any more.";
    }

    void write(const std::string& name, const std::string& content) const
    {
        _folder.write("home/" + name, content);
    }

    void writeRaster(const std::string& name) const
    {
        fs::create_directories((_home / name).parent_path());
        TestRaster(4, 4, 1, GDT_Byte).placed(7.0, 46.0, 0.01, 0.01).crs("EPSG:4326").write(_home / name);
    }

    /// A recipe, as far as it is read before anything is drawn.
    void writeRecipe(const std::string& name, const std::string& more = {}) const
    {
        write(name,
              R"({"osggeofx_panorama": 1, "dems": ["dem.tif"], "size": [64, 64], "view": {"place": [7, 46],
"heading": 0, "viewRadius": 1000, "horizonLine": 0.8, "curveDistance": 1, "horizonDistance": 3, "horizonBend": 1,
"exaggeration": 1, "baseHeight": 0, "edgeWidth": 0}, "map": {})" +
                  more + "}");
    }

    TempDir _folder;
    const fs::path _home = _folder.write("home/place", "").parent_path();
};

const char* const emptyScene =
    "#Ascii Scene\n#Version 161\n#Generator OpenSceneGraph 3.6.5\n\nosg::Group {\n  UniqueID 1\n}\n";
const char* const features = R"({"type":"FeatureCollection","features":[]})";

TEST_F(Overwriting, PicturesOfPanorama)
{
    writeRaster("dem.tif");
    write("dem.tif.aux.xml", "<PAMDataset/>");
    writeRaster("inner.tif");
    write("dems.vrt",
          "<VRTDataset rasterXSize=\"4\" rasterYSize=\"4\"><VRTRasterBand dataType=\"Byte\" "
          "band=\"1\"><SimpleSource>"
          "<SourceFilename "
          "relativeToVRT=\"1\">inner.tif</SourceFilename></SimpleSource></VRTRasterBand></VRTDataset>");
    fs::copy_file(GEOFX_SOURCE_DIR "/data/panorama/palette.png", _home / "palette.png");
    write("style.json", R"({"names": {"peak": {"size": 16}}})");
    write("names.geojson", features);
    write("inside.geojson", features);
    write("table.csv", "value,class,name,red,green,blue\n");
    write("font.ttf", "");
    write("cover.tif", "");
    write("terrain.osgb", "");
    write("tiles/1/2.osgb", "");
    writeRecipe("recipe.json");
    writeRecipe("lined.json", R"(, "lines": ["inside.geojson"])");
    const Words names = {"--labels", "names.geojson"};
    std::vector<Input> inputs = {
        {"dem.tif", {"dem.tif"}},
        {"dem.tif.aux.xml", {"dem.tif"}},
        {"inner.tif", {"dems.vrt"}},
        {"terrain.osgb", {"terrain.osgb"}},
        {"tiles/1/2.osgb", {"terrain.osgb"}},
        {"recipe.json", {"recipe.json"}},
        {"dem.tif", {"recipe.json"}},
        {"inside.geojson", {"lined.json"}},
        {"cover.tif", {"dem.tif", "--landcover", "cover.tif", "--landcover-table", "table.csv"}},
        {"table.csv", {"dem.tif", "--landcover", "cover.tif", "--landcover-table", "table.csv"}},
        {"cover.tif", {"dem.tif", "--trees", "cover.tif"}},
        {"palette.png", {"dem.tif", "--palette", "palette.png"}},
        {"names.geojson", {"dem.tif", "--labels", "names.geojson"}},
        {"names.geojson", {"dem.tif", "--lines", "names.geojson"}},
        {"style.json", Words{"dem.tif", "--style", "style.json"} + names},
        {"font.ttf", Words{"dem.tif", "--font", "font.ttf"} + names}};
    const Words free = Words{"-o", "free.png"} + names;
    const std::vector<Output> outputs = {{"-o", pictures,
                                          [](const std::string& file)
                                          {
                                              return Words{"-o", file};
                                          }},
                                         {"the recipe beside",
                                          {".json"},
                                          [](const std::string& file)
                                          {
                                              return Words{"-o", beside(file, ".png")};
                                          }},
                                         {"--recipe",
                                          {},
                                          [&](const std::string& file)
                                          {
                                              return free + Words{"--recipe", file};
                                          }},
                                         {"--svg",
                                          {},
                                          [&](const std::string& file)
                                          {
                                              return free + Words{"--svg", file};
                                          }},
                                         {"--geojson",
                                          {},
                                          [&](const std::string& file)
                                          {
                                              return free + Words{"--geojson", file};
                                          }},
                                         {"--mesh",
                                          {".obj", ".osgb"},
                                          [&](const std::string& file)
                                          {
                                              return free + Words{"--mesh", file};
                                          }},
                                         {"materials of --mesh",
                                          {".mtl"},
                                          [&](const std::string& file)
                                          {
                                              return free + Words{"--mesh", beside(file, ".obj")};
                                          }}};
    // Where a recipe is read that would be the one beside the picture, it stays as it is.
    std::vector<Output> withRecipe = outputs;
    withRecipe.erase(withRecipe.begin() + 1);
    const auto middle = std::stable_partition(inputs.begin(), inputs.end(),
                                              [](const Input& input) { return input.file == "recipe.json"; });
    expectRefusals("osggeofx_panorama", {inputs.begin(), middle}, withRecipe, 2, 13);
    expectRefusals("osggeofx_panorama", {middle, inputs.end()}, outputs);
    expectOptions(
        "osggeofx_panorama",
        {"--output", "--recipe", "--svg", "--geojson", "--mesh", "--layers", "--web", "--work", "--plan"},
        {"sources", "--landcover", "--land-cover", "--landcover-table", "--land-cover-table", "--trees",
         "--tree-cover", "--palette", "--labels", "--lines", "--style", "--font"},
        {"-o",         "--size",    "--view-from",    "--all-heights",  "--focus",
         "--around",   "--width",   "--exaggeration", "--horizon-line", "--horizon-distance",
         "--vertical", "--set",     "--samples",      "--pick",         "--liberties",
         "--liberty",  "--title",   "--label-field",  "--attribution",  "--bits",
         "--stretch",  "--explain", "--quiet"});
}

TEST_F(Overwriting, PicturesOfRender)
{
    write("scene.osgt", emptyScene);
    write("city.osgt", emptyScene);
    write("world.geofx", "<geofx><layer file=\"layer.png\"/></geofx>");
    write("layer.png", "");
    write("terrain.osgb", "");
    write("tiles/1/2.osgb", "");
    write("flight.path", "0 0 0 10 0 0 0 1\n1 0 0 20 0 0 0 1\n");
    writeRaster("rain.tif");
    write("rain.tif.aux.xml", "<PAMDataset/>");
    write("fire.kml", "<kml><href>fire.png</href></kml>");
    write("fire.png", "");
    write("parcels.geojson", features);
    write("parcels.sld", "<sld/>");
    write("plan.sld", "<sld><OnlineResource href=\"mark.png\"/></sld>");
    write("mark.png", "");
    write("radar/1.tif", "");
    write("colors.txt", "");
    write("names.geojson", features);
    write("way.gpx", "<gpx/>");
    write("style.json", R"({"names": {"peak": {"size": 16}}})");
    write("font.ttf", "");
    const Words names = {"--labels", "names.geojson"};
    const std::vector<Input> inputs = {
        {"scene.osgt", {"scene.osgt"}},
        {"world.geofx", {"world.geofx"}},
        {"layer.png", {"world.geofx"}},
        {"terrain.osgb", {"terrain.osgb"}},
        {"tiles/1/2.osgb", {"terrain.osgb"}},
        {"city.osgt", {"scene.osgt", "--city", "city.osgt"}},
        {"rain.tif", {"scene.osgt", "--mapping", "rain.tif"}},
        {"rain.tif.aux.xml", {"scene.osgt", "--mapping", "rain.tif"}},
        {"fire.kml", {"scene.osgt", "--mapping", "fire.kml"}},
        {"fire.png", {"scene.osgt", "--mapping", "fire.kml"}},
        {"parcels.geojson", {"scene.osgt", "--mapping", "parcels.geojson:parcels"}},
        {"parcels.sld", {"scene.osgt", "--mapping", "parcels.geojson"}},
        {"plan.sld", {"scene.osgt", "--mapping", "parcels.geojson", "--mapping-style", "plan.sld"}},
        {"mark.png", {"scene.osgt", "--mapping", "parcels.geojson", "--mapping-style", "plan.sld"}},
        {"rain.tif", {"scene.osgt", "--sequence", "rain.tif:1"}},
        {"radar/1.tif", {"scene.osgt", "--sequence", "radar"}},
        {"way.gpx", {"scene.osgt", "--route", "way.gpx"}},
        {"colors.txt", {"scene.osgt", "--mapping", "rain.tif", "--colors", "colors.txt"}},
        {"names.geojson", {"scene.osgt", "--labels", "names.geojson"}},
        {"names.geojson", {"scene.osgt", "--lines", "names.geojson"}},
        {"style.json", Words{"scene.osgt", "--style", "style.json"} + names},
        {"font.ttf", Words{"scene.osgt", "--font", "font.ttf"} + names}};
    const Words free = Words{"-o", "free.png"} + names;
    const std::vector<Output> outputs = {{"-o", pictures,
                                          [](const std::string& file)
                                          {
                                              return Words{"-o", file};
                                          }},
                                         {"--stats",
                                          {},
                                          [&](const std::string& file)
                                          {
                                              return free + Words{"--stats", file};
                                          }},
                                         {"--series",
                                          {},
                                          [&](const std::string& file)
                                          {
                                              return free + Words{"--values", "1,1", "--series", file};
                                          }},
                                         {"--svg",
                                          {},
                                          [&](const std::string& file)
                                          {
                                              return free + Words{"--svg", file};
                                          }},
                                         {"--geojson",
                                          {},
                                          [&](const std::string& file)
                                          {
                                              return free + Words{"--geojson", file};
                                          }},
                                         {"--mesh",
                                          {".obj", ".osgb"},
                                          [&](const std::string& file)
                                          {
                                              return free + Words{"--mesh", file};
                                          }}};
    expectRefusals("osggeofx_render", inputs, outputs);
    // Pictures of a film, whose camera is read first.
    const Words film = {"scene.osgt", "--path", "flight.path", "--fps", "4"};
    expectRefusals("osggeofx_render", {{"scene.osgt", film}, {"flight.path", film}},
                   {{"-o with a pattern",
                     {"3.png"}, // link3.png
                     [](const std::string& file)
                     {
                         return Words{"-o", file.find("link3") != std::string::npos ? "link%d.png" : file};
                     }},
                    {"--stats",
                     {},
                     [](const std::string& file)
                     {
                         return Words{"-o", "f%d.png", "--stats", file};
                     }}},
                   2, 2);
    expectOptions(
        "osggeofx_render",
        {"--output", "--stats", "--series", "--svg", "--geojson", "--mesh", "--layers", "--web", "--plan"},
        {"scene", "--city", "--path", "--mapping", "--mapping-style", "--sequence", "--route", "--colors",
         "--labels", "--lines", "--style", "--font"},
        {"-o",
         "--size",
         "--stretch",
         "--fov",
         "--view",
         "--eye",
         "--look",
         "--up",
         "--frames",
         "--fps",
         "--label-field",
         "--effect",
         "--help-effects",
         "--route-width",
         "--values",
         "--title",
         "--attribution",
         "--bits",
         "--inset",
         "--inset-corner",
         "--sky",
         "--no-compensation",
         "--debug-bounds",
         "--no-cull",
         "--allow-outside",
         "--samples",
         "--wait-for-tiles",
         "--no-wait-for-tiles",
         "--timeout",
         "--least-triangles",
         "--platform"});
}

TEST_F(Overwriting, LayersAndPages)
{
    writeRaster("dem.tif");
    write("scene.osgt", emptyScene);
    write("layers/labels.png", "");
    write("layers/layers.json", "");
    write("page/data/names.json", features);
    for (const auto& [program, scene] :
         {std::pair("osggeofx_panorama", "dem.tif"), std::pair("osggeofx_render", "scene.osgt")})
    {
        const Words begin = {scene, "-o", "free.png"};
        const std::vector<Input> inputs = {
            {"layers/labels.png", begin + Words{"--labels", "layers/labels.png"}},
            {"layers/layers.json", begin + Words{"--lines", "layers/layers.json"}}};
        expectRefusals(program, inputs,
                       {{"--layers",
                         {},
                         [](const std::string&)
                         {
                             return Words{"--layers", "layers"};
                         }}},
                       2, 4);
        expectRefusals(program, {{"page/data/names.json", begin + Words{"--labels", "page/data/names.json"}}},
                       {{"--web",
                         {},
                         [](const std::string&)
                         {
                             return Words{"--web", "page"};
                         }}},
                       2, 2);
    }
}

TEST_F(Overwriting, OtherPrograms)
{
    write("painting.png", "");
    write("points.csv", "");
    const auto to = [](const std::string& option)
    {
        return [option](const std::string& file)
        {
            return Words{option, file};
        };
    };
    const auto last = [](const std::string& file)
    {
        return Words{file};
    };
    expectRefusals("osggeofx_palette",
                   {{"painting.png", {"painting.png"}},
                    {"points.csv", {"painting.png", "--points", "points.csv"}},
                    {"points.csv", {"painting.png", "--light", "points.csv"}},
                    {"points.csv", {"painting.png", "--light", "painting.png", "--classes", "points.csv"}}},
                   {{"-o", {}, to("-o")}}, 2, 5);
    expectOptions("osggeofx_palette", {"--output"}, {"painting", "--light", "--classes", "--points"},
                  {"-o", "--hillshade", "--around", "--ready"});

    const std::string plan = (fs::path("plan") / "work" / "plan.json").string();
    write(plan, R"({"format": "", "version": 1, "estimate": {"seconds": 1}, "stages": []})");
    write("times.json", "{}");
    expectRefusals(
        "osggeofx_cluster",
        {{plan, {"predict", "plan"}}, {"times.json", {"predict", "plan", "--times", "times.json"}}},
        {{"--save", {}, to("--save")}}, 2, 3);
    expectOptions("osggeofx_cluster", {"--save"}, {"DIR", "--times"},
                  {"--units-per-job", "--until", "--cores", "--workers"}, {"predict"});

    write("terrain.osgb", "");
    write("builder", "");
    write("oahu/elevation.tif", "");
    expectRefusals("osggeofx_bench",
                   {{"terrain.osgb", {"--suite", "terrain", "--terrain", "terrain.osgb"}},
                    {"builder", {"--suite", "terrain", "--builder", "builder"}},
                    {"oahu/elevation.tif", {"--suite", "terrain", "--data", "."}}},
                   {{"--json", {}, to("--json")}}, 2, 4);
    expectOptions("osggeofx_bench", {"--json", "--work", "--pictures"},
                  {"--terrain", "--osgearth", "--fuji", "--builder", "--inventor", "--data"},
                  {"--suite", "--list", "--only", "--check", "--quick", "--smoke"});

    expectOptions("osggeofx_build", {"--output", "--plan", "--work"},
                  {"--dem", "--imagery", "--landcover", "--land-cover", "--landcover-table",
                   "--land-cover-table", "--tree-cover", "--buildings"},
                  {"-o",
                   "--buildings-layer",
                   "--height-field",
                   "--roof-field",
                   "--height-unit",
                   "--no-ambient-occlusion",
                   "--geocentric",
                   "--srs",
                   "--vertical",
                   "--tree-line",
                   "--lake-area",
                   "--stretch",
                   "--all-heights",
                   "--voids",
                   "--void-reach",
                   "--void-smoothing",
                   "--tile-size",
                   "--texture-size",
                   "--pixel-error",
                   "--anisotropy",
                   "--compress-textures",
                   "--texel-error",
                   "--pixels-per-radian",
                   "--memory",
                   "--threads",
                   "--resume",
                   "--anew",
                   "--keep-nothing",
                   "--estimate",
                   "--quiet",
                   "--unit"});

    expectRefusals("geofx_invent", {{"oahu/elevation.tif", {"gardens", "oahu/elevation.tif"}}},
                   {{"FILE", {}, last}}, 2, 1);
    expectRefusals("geofx_bench_draw", {{"terrain.osgb", {"terrain.osgb", "--view", "1,2,3,4,5"}}},
                   {{"--image", {}, to("--image")}, {"--mask", {}, to("--mask")}}, 1, 3);
    write("oahu/landcover.tif", "");
    expectRefusals("example_figure3",
                   {{"oahu/elevation.tif", {"terrain.osgb", "oahu", "A"}},
                    {"terrain.osgb", {"terrain.osgb", "oahu", "A"}}},
                   {{"picture", {}, last}}, 1, 3);
    write("fire-000.jpg", "");
    fs::remove(_home / "oahu/landcover.tif");
    fs::create_symlink("../fire-000.jpg", _home / "oahu/landcover.tif");
    expectRefusals("example_simulation",
                   {{"fire-000.jpg", {"terrain.osgb", "oahu", "fire", "--frames", "."}}},
                   {{"--frames",
                     {},
                     [](const std::string&)
                     {
                         return Words{};
                     }}},
                   1, 1);
}

TEST_F(Overwriting, ThePictureOfAPdf)
{
    write("scene.osgt", emptyScene);
    write("map.unfinished.jpg", "");
    expectRefusals("osggeofx_render",
                   {{"map.unfinished.jpg", {"scene.osgt", "--labels", "map.unfinished.jpg"}}},
                   {{"-o",
                     {},
                     [](const std::string&)
                     {
                         return Words{"-o", "map.pdf"};
                     }}},
                   2, 5);
}

// Folders of work files, and what lies in them.
TEST_F(Overwriting, FoldersOfOthers)
{
    writeRaster("dem.tif");
    write("scene.osgt", emptyScene);
    for (const char* folder : {"map.work", "mine", "map.tiles"})
        write(std::string(folder) + "/years of work.txt", "all of it");
    const auto before = contents(_home);
    const auto expect = [&](const std::string& program, const Words& words, const std::string& folder)
    {
        const ProgramResult result = run(program, words);
        EXPECT_EQ(result.exitCode, 2) << program << " " << folder;
        EXPECT_NE(result.standardError.find(folder + ": the folder for work files holds other files"),
                  std::string::npos)
            << result.standardError;
        EXPECT_TRUE(contents(_home) == before) << program << " " << folder;
    };
    expect("osggeofx_panorama", {"dem.tif", "-o", "map.png"}, "map.work");
    expect("osggeofx_panorama", {"dem.tif", "-o", "new.png", "--work", "mine"}, "mine");
    expect("osggeofx_panorama", {"dem.tif", "-o", "map.png", "--work", "new", "--size", "A6@50dpi"},
           "map.tiles");
    expect("osggeofx_render", {"scene.osgt", "-o", "map.pdf"}, "map.tiles");
}

// The recipe beside a picture replaces recipes alone.
TEST_F(Overwriting, TheRecipeIsNoOtherFile)
{
    writeRaster("dem.tif");
    write("map.json", features);
    write("broken.json", "{");
    const auto before = contents(_home);
    for (const auto& [file, words] : {std::pair<std::string, Words>{"map.json", {"-o", "map.png"}},
                                      {"map.json", {"-o", "new.png", "--recipe", "map.json"}},
                                      {"broken.json", {"-o", "broken.png"}}})
    {
        const ProgramResult result = run("osggeofx_panorama", Words{"dem.tif"} + words);
        EXPECT_EQ(result.exitCode, 2);
        EXPECT_NE(result.standardError.find(
                      file + ": the recipe of the map would replace this file, which is no recipe"),
                  std::string::npos)
            << result.standardError;
        EXPECT_TRUE(contents(_home) == before);
    }
}

} // namespace
