// SPDX-License-Identifier: MIT
// SPDX-FileCopyrightText: 2026 the osgGeoFX authors
//
// Pairs of options, as --help lists them: no crash, no message and no difference of the picture that neither option explains. A sample
// in CI, all in ./tests/run --full.
#include <tools/FolderContents.h>
#include <tools/MapProgram.h>
#include <tools/RandomSamples.h>
#include <tools/TestRasters.h>

#include <osgDB/ReadFile>

#include <algorithm>
#include <cmath>
#include <map>
#include <optional>
#include <regex>
#include <set>
#include <utility>

using namespace geofx::test;
namespace fs = std::filesystem;

namespace
{

using Words = std::vector<std::string>;

/// An option with all words that it needs.
struct Sample
{
    std::string option;
    Words words;
};

/// What an option is excluded from, by --help.
using Exclusions = std::map<std::string, std::set<std::string>>;

struct Trial
{
    int exitCode = 0;
    std::set<std::string> lines; ///< without their numbers
    std::string text;
    osg::ref_ptr<osg::Image> picture;         ///< null if there is none
    std::map<std::string, std::string> files; ///< of a database; empty for pictures
};

/// Numbers such as times differ from run to run, and so does the room before them.
std::string withoutNumbers(const std::string& line)
{
    return std::regex_replace(line, std::regex(" *[-+]?[0-9]+([.][0-9]+)?"), "#");
}

/// Whether a line tells what a layer has at a place, and the layer's file is one of these words.
bool isValueOf(const std::string& line, const Words& words)
{
    return std::any_of(words.begin(), words.end(),
                       [&](const std::string& word) { return line.rfind("  " + word + ": ", 0) == 0; });
}

bool isBeside(const osg::Image& a, const osg::Image& b, int x, int y)
{
    const auto* const left = a.data(static_cast<unsigned int>(x), static_cast<unsigned int>(y));
    const auto* const right = b.data(static_cast<unsigned int>(x), static_cast<unsigned int>(y));
    for (unsigned int i = 0; i < a.getPixelSizeInBits() / 8; ++i)
        if (std::abs(left[i] - right[i]) > 2) return true;
    return false;
}

bool haveOneForm(const osg::Image& a, const osg::Image& b)
{
    return a.s() == b.s() && a.t() == b.t() && a.getPixelFormat() == b.getPixelFormat() &&
           a.getDataType() == b.getDataType() && a.getDataType() == GL_UNSIGNED_BYTE;
}

class OptionPairs : public MapProgram
{
protected:
    void SetUp() override
    {
        MapProgram::SetUp();
        if (IsSkipped() || HasFatalFailure()) return;
        const std::string names = collection(pointFeature("Top", "peak", {174.1, -39.3}) + "," +
                                             pointFeature("Town", "town", {174.05, -39.15}));
        const std::regex name(R"("name":("[^"]*"))");
        write("names.geojson", std::regex_replace(names, name, R"("name":$1,"title":$1)"));
        write("titles.geojson", std::regex_replace(names, name, R"("title":$1)"));
        write("lines.geojson", collection(lineFeature("motorway", {173.95, -39.1}, {174.25, -39.35})));
        write("style.json", R"({"names":{"peak":{"size":20}},"lines":{"motorway":{"width":6}}})");
        write("area.geojson",
              R"({"type":"Feature","properties":{},"geometry":{"type":"Polygon","coordinates":)"
              R"([[[174,-39.3],[174.1,-39.3],[174.1,-39.15],[174,-39.15],[174,-39.3]]]}})");
        write("area.style.sld",
              R"(<StyledLayerDescriptor version="1.0.0" xmlns="http://www.opengis.net/sld"><NamedLayer>
<UserStyle><FeatureTypeStyle><Rule><PolygonSymbolizer><Fill><CssParameter name="fill">#ff00ff</CssParameter></Fill>
</PolygonSymbolizer></Rule></FeatureTypeStyle></UserStyle></NamedLayer></StyledLayerDescriptor>)");
        write("ramp.txt", "0 0 0 255\n100 255 0 0\n");
        write("route.geojson", collection(lineFeature("path", {174.0, -39.1}, {174.2, -39.25})));
        write("path.csv",
              "time,lon,lat,alt,heading,pitch\n0,174.1,-39.5,5000,0,-15\n1,174.1,-39.48,5000,0,-15\n");
        TestRaster(12, 12, 3)
            .placed(173.9, -39.0, 0.05, 0.05)
            .crs("EPSG:4326")
            .fill([](int column, int row, int band) { return column * 4.0 + row * 2.0 + band * 10.0; })
            .write(file("rain.tif"));
        TestRaster(60, 60, 1, GDT_Byte)
            .placed(173.8, -39.0, 0.01, 0.01)
            .crs("EPSG:4326")
            .fill([](int column, int row, int) { return (column + row) % 3 == 0 ? 10.0 : 30.0; })
            .write(file("classes.tif"));
        write("classes.csv",
              "value,class,name,red,green,blue\n10,tree_cover,Trees,0,100,0\n30,grass,Grass,200,220,100\n");
        TestRaster(41, 41, 3, GDT_Byte)
            .placed(173.9, -39.1, 0.01, 0.01)
            .crs("EPSG:4326")
            .fill([](int column, int row, int band) { return column + row + 50.0 * band; })
            .write(file("colors.tif"));
        std::string houses;
        for (int i = 0; i < 4; ++i)
        {
            const std::string west = std::to_string(174.05 + i * 0.001),
                              east = std::to_string(174.0503 + i * 0.001);
            houses += std::string(i ? "," : "") + R"({"type":"Feature","properties":{"high":)" +
                      std::to_string(10 + i) +
                      R"(,"top":"gabled"},"geometry":{"type":"Polygon","coordinates":[[[)" + west +
                      ",-39.2],[" + east + ",-39.2],[" + east + ",-39.1998],[" + west + ",-39.1998],[" +
                      west + ",-39.2]]]}}";
        }
        write("houses.geojson", collection(houses));
        TestRaster(41, 41)
            .placed(173.9, -39.1, 0.01, 0.01)
            .crs("EPSG:4326")
            .fill([](int column, int row, int) { return 50.0 * relief(column * 0.3, row * 0.3) / 10.0; })
            .write(file("small.tif"));
    }

    /// What osggeofx_render and osggeofx_viewer put onto the ground.
    static std::vector<Sample> onTheGround()
    {
        return {
            {"--mapping", {"--mapping", "area.geojson"}},
            {"--sequence", {"--sequence", "rain.tif"}},
            {"--route", {"--route", "route.geojson"}},
            {"--route-width", {"--route", "route.geojson", "--route-width", "400"}},
            {"--mapping-style", {"--mapping", "area.geojson", "--mapping-style", "area.style.sld"}},
            {"--colors", {"--sequence", "rain.tif", "--colors", "ramp.txt"}},
            {"--stretch", {"--mapping", "colors.tif", "--stretch", "20,120"}},
        };
    }

    /// The options that a help text lists, but those that end the program or that it cannot do without.
    static std::set<std::string> optionsIn(const std::string& help, const std::set<std::string>& others,
                                           Exclusions& exclusions)
    {
        std::set<std::string> options;
        std::istringstream stream(help);
        for (std::string line; std::getline(stream, line);)
        {
            std::smatch match;
            if (!std::regex_search(line, match, std::regex("^  (?:-[a-z],)?(--[a-z-]+)"))) continue;
            const std::string option = match[1];
            if (!others.count(option)) options.insert(option);
            if (std::regex_search(line, match, std::regex("Excludes:((?: --[a-z-]+)+)")))
            {
                std::istringstream words(match[1]);
                for (std::string each; words >> each;)
                {
                    exclusions[option].insert(each);
                    exclusions[each].insert(option);
                }
            }
        }
        return options;
    }

    /// A run. Options go before those of the base that they replace. The picture is the first one in the folder out.
    Trial tryOut(const std::string& program, const Words& sources, const std::vector<Sample>& base,
                 const Words& words, const Exclusions& exclusions)
    {
        fs::remove_all(file("out"));
        fs::create_directories(file("out"));
        Words all = sources;
        const auto has = [&](const std::string& option)
        {
            return std::find(words.begin(), words.end(), option) != words.end();
        };
        for (const Sample& each : base)
        {
            const auto excluded = exclusions.find(each.option);
            const bool isReplaced =
                has(each.option) || (excluded != exclusions.end() &&
                                     std::any_of(excluded->second.begin(), excluded->second.end(), has));
            if (!isReplaced) all.insert(all.end(), each.words.begin(), each.words.end());
        }
        if (makesPictures(program))
        {
            all.push_back("-o");
            all.push_back(std::string(has("--plan") ? "" : "out/") + (has("--path") ? "p%04d.png" : "p.png"));
        }
        all.insert(all.end(), words.begin(), words.end());
        const ProgramResult result = program == viewer ? runViewer(all) : run(program, all);
        Trial done;
        done.exitCode = result.exitCode;
        done.text = result.standardOutput + result.standardError;
        std::istringstream stream(done.text);
        for (std::string line; std::getline(stream, line);)
            done.lines.insert(withoutNumbers(line));
        if (program == "osggeofx_build") done.files = contents(file("out"));
        // What it prints is its work.
        if (program == "osggeofx_cluster") done.files["standard output"] = result.standardOutput;
        std::set<std::string> pictures;
        for (const auto& each : fs::directory_iterator(file("out")))
            if (each.path().extension() == ".png") pictures.insert(each.path().string());
        if (!pictures.empty()) done.picture = osgDB::readImageFile(*pictures.begin());
        return done;
    }

    void tryPairs(const std::string& program, const Words& sources, const std::vector<Sample>& base,
                  const std::vector<Sample>& samples, const std::set<std::string>& others, int sampleSize)
    {
        Exclusions exclusions;
        // A program of several commands has a help text for each.
        const Words help = program == "osggeofx_cluster" ? Words{sources.front(), "--help"} : Words{"--help"};
        const std::set<std::string> options =
            optionsIn(run(program, help).standardOutput, others, exclusions);
        std::set<std::string> tried;
        for (const Sample& each : samples)
            tried.insert(each.option);
        ASSERT_EQ(tried, options) << "a sample for each option of " << program << " --help, and no other";
        const Trial none = tryOut(program, sources, base, {}, exclusions);
        ASSERT_EQ(none.exitCode, 0) << none.text;
        std::map<std::string, Trial> alone;
        const auto runOf = [&](const Sample& sample) -> const Trial&
        {
            const auto found = alone.find(sample.option);
            if (found != alone.end()) return found->second;
            Trial& trial = alone[sample.option] = tryOut(program, sources, base, sample.words, exclusions);
            EXPECT_EQ(trial.exitCode, 0) << sample.option << ": " << trial.text;
            return trial;
        };
        if (samples.empty()) return;
        for (const auto& [i, j] : pairsOf(samples.size(), sampleSize))
        {
            const Sample &first = samples[i], &second = samples[j];
            SCOPED_TRACE(program + " " + first.option + " " + second.option);
            const Trial &a = runOf(first), &b = runOf(second);
            const Trial both = tryOut(program, sources, base, joined(first.words, second.words), exclusions);
            if (areExcluded(first.words, second.words, exclusions))
            {
                EXPECT_EQ(both.exitCode, 2) << both.text;
                EXPECT_NE(both.text.find("excludes"), std::string::npos) << both.text;
            }
            else
                expectExplained(both, none, a, b, joined(first.words, second.words));
        }
    }

    static constexpr const char* viewer = "osggeofx_viewer";

private:
    static bool makesPictures(const std::string& program)
    {
        return program == "osggeofx_render" || program == "osggeofx_panorama" ||
               program == "osggeofx_palette";
    }

    /// Some frames in a window, on a display of its own.
    ProgramResult runViewer(Words arguments) const
    {
        const Words begin = {"sh", "-c",
                             R"(rm -f display; mkfifo display
Xvfb -displayfd 1 -screen 0 320x240x24 >display 2>/dev/null & server=$!
read -r number <display
DISPLAY=:$number "$@"; code=$?
kill $server; wait $server
exit $code)",
                             "sh", builtProgram(viewer)};
        arguments.insert(arguments.begin(), begin.begin(), begin.end());
        ProgramOptions options;
        options.folder = std::filesystem::path(file("")).string();
        options.environment = {"LIBGL_ALWAYS_SOFTWARE=1", "OSG_NOTIFY_LEVEL=WARN", "OSG_WINDOW=0 0 160 120",
                               "OSG_RUN_FRAME_COUNT=4"};
        return runProgram(arguments, options);
    }

    static bool areExcluded(const Words& first, const Words& second, Exclusions& exclusions)
    {
        for (const std::string& each : first)
            for (const std::string& other : second)
                if (exclusions[each].count(other)) return true;
        return false;
    }

    /// All pairs, or neighbours in a random order.
    static std::vector<std::pair<std::size_t, std::size_t>> pairsOf(std::size_t count, int sampleSize)
    {
        std::vector<std::pair<std::size_t, std::size_t>> pairs;
        if (fullTest())
        {
            for (std::size_t i = 0; i < count; ++i)
                for (std::size_t j = i + 1; j < count; ++j)
                    pairs.emplace_back(i, j);
            return pairs;
        }
        Random random(56);
        for (int i = 0; i < sampleSize; ++i)
        {
            const auto a = static_cast<std::size_t>(random.integer(0, static_cast<int>(count) - 1));
            const auto b = static_cast<std::size_t>(random.integer(0, static_cast<int>(count) - 1));
            if (a != b) pairs.emplace_back(std::min(a, b), std::max(a, b));
        }
        return pairs;
    }

    /// Options of both, those with one value once.
    static Words joined(Words words, const Words& more)
    {
        for (std::size_t i = 0; i < more.size();)
        {
            std::size_t end = i + 1;
            while (end < more.size() && more[end].rfind("--", 0) != 0)
                ++end;
            const auto from = more.begin() + static_cast<std::ptrdiff_t>(i);
            const auto to = more.begin() + static_cast<std::ptrdiff_t>(end);
            if (std::search(words.begin(), words.end(), from, to) == words.end())
                words.insert(words.end(), from, to);
            i = end;
        }
        return words;
    }

    /// `words`: all that was given beside the base.
    static void expectExplained(const Trial& both, const Trial& none, const Trial& a, const Trial& b,
                                const Words& words)
    {
        EXPECT_LT(both.exitCode, 3) << both.text;
        const bool isRefused = both.exitCode != 0;
        bool isNamed = false;
        const auto has = [&](const char* option)
        {
            return std::find(words.begin(), words.end(), option) != words.end();
        };
        std::istringstream stream(both.text);
        for (std::string line; std::getline(stream, line);)
        {
            const bool names =
                std::any_of(words.begin(), words.end(),
                            [&](const std::string& each)
                            { return each.rfind("--", 0) == 0 && line.find(each) != std::string::npos; });
            isNamed = isNamed || names;
            const std::string plain = withoutNumbers(line);
            // --explain gives the reasons of what the other option has chosen, and a palette its measures.
            const bool isReason = (has("--explain") || has("--light")) && line.rfind("osggeofx", 0) != 0;
            // The command of a job has all of its options in one line.
            const bool isCommand = line.find(" --work ") != std::string::npos;
            // Values are those of all layers.
            const bool isValue = has("--values") && isValueOf(line, words);
            EXPECT_TRUE(names || isReason || isCommand || isValue || none.lines.count(plain) ||
                        a.lines.count(plain) || b.lines.count(plain))
                << line;
        }
        EXPECT_TRUE(isNamed || !isRefused) << both.text;
        // A plan keeps all options that it was made with.
        if (!isRefused && !none.files.empty() && !has("--plan"))
        {
            EXPECT_TRUE(a.files != none.files || both.files == b.files)
                << "the first option alone changes nothing";
            EXPECT_TRUE(b.files != none.files || both.files == a.files)
                << "the second option alone changes nothing";
        }
        if (isRefused || !both.picture || !none.picture || !a.picture || !b.picture) return;
        if (!haveOneForm(*none.picture, *a.picture) || !haveOneForm(*none.picture, *b.picture)) return;
        ASSERT_TRUE(haveOneForm(*none.picture, *both.picture));
        // Names and lines leave the picture for the SVG file, and lines become a layer of their own.
        if (has("--svg") || (has("--lines") && has("--layers"))) return;
        // What a light map takes out of colors changes what samples make of them.
        if (has("--light")) return;
        const bool movesGround = has("--liberties") || has("--liberty") || has("--vertical");
        // Without compensation no deformed bounds decide, so that none are drawn.
        if (has("--no-compensation") && has("--debug-bounds")) return;
        // Lines have bounds, too, an inset shows those of all, and samples draw the boxes' edges softer and so broader.
        const bool addsBounds =
            (has("--lines") || has("--inset") || has("--samples")) && has("--debug-bounds");
        expectNoOtherPixels(*both.picture, *none.picture, *a.picture, *b.picture, movesGround || addsBounds);
    }

    /// Where neither option changes the picture both do not; if one of them changes nothing, both make the other's picture.
    static void expectNoOtherPixels(const osg::Image& both, const osg::Image& none, const osg::Image& a,
                                    const osg::Image& b, bool mayDiffer)
    {
        int byA = 0, byB = 0, others = 0, besideA = 0, besideB = 0;
        for (int y = 0; y < none.t(); ++y)
            for (int x = 0; x < none.s(); ++x)
            {
                const bool inA = isBeside(a, none, x, y), inB = isBeside(b, none, x, y);
                byA += inA;
                byB += inB;
                others += !inA && !inB && isBeside(both, none, x, y);
                besideA += isBeside(both, a, x, y);
                besideB += isBeside(both, b, x, y);
            }
        const int most = none.s() * none.t() / 500;
        EXPECT_TRUE(byA > 0 || besideB <= most) << besideB << ": the first option alone changes nothing";
        EXPECT_TRUE(byB > 0 || besideA <= most) << besideA << ": the second option alone changes nothing";
        // What moves the eye or the ground moves what the other draws.
        const bool isMoved = mayDiffer || std::max(byA, byB) >= none.s() * none.t() / 2;
        EXPECT_TRUE(isMoved || others <= most)
            << others << " pixels differ that neither option changes alone";
    }
};

} // namespace

TEST_F(OptionPairs, OfRender)
{
    std::vector<Sample> samples = {
        {"--size", {"--size", "120x80"}},
        {"--fov", {"--fov", "40"}},
        {"--view", {"--view", "174.1,-39.5,5000,0,-15"}},
        {"--eye", {"--eye", "-4919000,507000,-4025000", "--look", "-4919000,506000,-4018000"}},
        {"--look", {"--eye", "-4919000,507000,-4025000", "--look", "-4919000,506000,-4018000"}},
        {"--up",
         {"--eye", "-4919000,507000,-4025000", "--look", "-4919000,506000,-4018000", "--up", "-1,0,0"}},
        {"--path", {"--path", "path.csv", "--frames", "1"}},
        {"--frames", {"--path", "path.csv", "--frames", "1"}},
        {"--fps", {"--path", "path.csv", "--fps", "1"}},
        {"--plan", {"--path", "path.csv", "--frames", "1", "--plan", "out/plan"}},
        {"--effect", {"--effect", "verticalExaggeration factor=2"}},
        {"--city", {"--city", "city.obj"}},
    };
    const std::vector<Sample> ground = onTheGround();
    samples.insert(samples.end(), ground.begin(), ground.end());
    const std::vector<Sample> others = {
        {"--labels", {"--labels", "names.geojson"}},
        {"--label-field", {"--labels", "titles.geojson", "--label-field", "title"}},
        {"--lines", {"--lines", "lines.geojson"}},
        {"--style", {"--labels", "names.geojson", "--style", "style.json"}},
        {"--font", {"--labels", "names.geojson", "--font", "DejaVu Sans"}},
        {"--svg", {"--labels", "names.geojson", "--svg", "out/map.svg"}},
        {"--geojson", {"--labels", "names.geojson", "--geojson", "out/map.geojson"}},
        {"--values", {"--sequence", "rain.tif", "--values", "80,60"}},
        {"--series", {"--sequence", "rain.tif", "--values", "80,60", "--series", "out/rain.csv"}},
        {"--layers", {"--layers", "out/layers"}},
        {"--mesh", {"--mesh", "out/mesh.obj"}},
        {"--web", {"--web", "out/web"}},
        {"--title", {"--web", "out/web", "--title", "Volcano"}},
        {"--attribution", {"--web", "out/web", "--attribution", "Nobody"}},
        {"--bits", {"--bits", "16"}},
        {"--inset", {"--inset"}},
        {"--inset-corner", {"--inset", "--inset-corner", "upper-left"}},
        {"--sky", {"--sky"}},
        {"--no-compensation", {"--no-compensation"}},
        {"--debug-bounds", {"--debug-bounds"}},
        {"--no-cull", {"--no-cull"}},
        {"--allow-outside", {"--allow-outside"}},
        {"--samples", {"--samples", "4"}},
        {"--wait-for-tiles", {"--wait-for-tiles"}},
        {"--timeout", {"--timeout", "60"}},
        {"--stats", {"--stats", "out/stats.json"}},
        {"--least-triangles", {"--stats", "out/stats.json", "--least-triangles"}},
        {"--platform", {"--platform", "egl"}},
    };
    samples.insert(samples.end(), others.begin(), others.end());
    write("city.obj", "v 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 3\n");
    tryPairs("osggeofx_render", {"work/ground/terrain.osgb"},
             {{"--size", {"--size", "160x100"}}, {"--view", {"--view", "174.1,-39.55,4000,0,-12"}}}, samples,
             {"--help", "--output", "--help-effects"}, 3);

    // Values of colors are stretched as those that are shown.
    const auto colorAt = [&](const Words& more)
    {
        Words words = {"work/ground/terrain.osgb", "-o",        "values.png", "--size",   "160x100", "--view",
                       "174.1,-39.55,4000,0,-12",  "--mapping", "colors.tif", "--values", "80,60"};
        words.insert(words.end(), more.begin(), more.end());
        const std::string text = run("osggeofx_render", words).standardOutput;
        std::smatch color;
        EXPECT_TRUE(std::regex_search(text, color, std::regex("colors.tif: #([0-9a-f]{6})"))) << text;
        return color.empty() ? 0ul : std::stoul(color[1], nullptr, 16);
    };
    const unsigned long plain = colorAt({}), stretched = colorAt({"--stretch", "20,120"});
    // Both are rounded to bytes.
    for (const unsigned int shift : {16u, 8u, 0u})
    {
        const double from = (plain >> shift) & 255u;
        EXPECT_NEAR((stretched >> shift) & 255u, std::clamp((from - 20.0) * 2.55, 0.0, 255.0), 4.0);
    }
}

TEST_F(OptionPairs, OfPanorama)
{
    const std::vector<Sample> samples = {
        {"--size", {"--size", "120x80"}},
        {"--view-from", {"--view-from", "north"}},
        {"--focus", {"--focus", "174.1,-39.3"}},
        {"--around", {"--around", "180", "--view-from", "174.1,-39.3"}},
        {"--width", {"--width", "20000"}},
        {"--exaggeration", {"--exaggeration", "1.5"}},
        {"--horizon-line", {"--horizon-line", "0.7"}},
        {"--horizon-distance", {"--horizon-distance", "3"}},
        {"--palette", {"--palette", "winter"}},
        {"--landcover", {"--landcover", "classes.tif", "--landcover-table", "classes.csv"}},
        {"--landcover-table", {"--landcover", "classes.tif", "--landcover-table", "classes.csv"}},
        {"--trees", {"--trees", "classes.tif"}},
        {"--vertical", {"--vertical", "egm96"}},
        {"--all-heights", {"--all-heights"}},
        {"--set", {"--set", "snowLine=100"}},
        {"--samples", {"--samples", "4"}},
        {"--recipe", {"--recipe", "none"}},
        {"--work", {"--work", "out/work"}},
        {"--plan", {"--size", "4200x60", "--plan", "out/plan"}},
        {"--pick", {"--pick", "80,60"}},
        {"--liberties", {"--liberties"}},
        {"--liberty", {"--liberty", "174.1,-39.3 radius=6000 enlarge=1.2"}},
        {"--labels", {"--labels", "names.geojson"}},
        {"--label-field", {"--labels", "titles.geojson", "--label-field", "title"}},
        {"--lines", {"--lines", "lines.geojson"}},
        {"--style", {"--labels", "names.geojson", "--style", "style.json"}},
        {"--font", {"--labels", "names.geojson", "--font", "DejaVu Sans"}},
        {"--svg", {"--labels", "names.geojson", "--svg", "out/map.svg"}},
        {"--geojson", {"--labels", "names.geojson", "--geojson", "out/map.geojson"}},
        {"--layers", {"--layers", "out/layers"}},
        {"--mesh", {"--mesh", "out/mesh.obj"}},
        {"--web", {"--web", "out/web"}},
        {"--title", {"--web", "out/web", "--title", "Volcano"}},
        {"--attribution", {"--web", "out/web", "--attribution", "Nobody"}},
        {"--bits", {"--bits", "16"}},
        {"--explain", {"--explain"}},
        {"--quiet", {"--quiet"}},
    };
    tryPairs("osggeofx_panorama", {"small.tif"},
             {{"--size", {"--size", "160x100"}}, {"--samples", {"--samples", "0"}}}, samples,
             {"--help", "--output"}, 1);
}

TEST_F(OptionPairs, OfBuild)
{
    const Words town = {"--buildings", "houses.geojson"};
    const auto withTown = [&](Words words)
    {
        words.insert(words.begin(), town.begin(), town.end());
        return words;
    };
    const std::vector<Sample> samples = {
        {"--imagery", {"--imagery", "colors.tif"}},
        {"--stretch", {"--imagery", "colors.tif", "--stretch", "20,120"}},
        {"--landcover", {"--landcover", "classes.tif", "--landcover-table", "classes.csv"}},
        {"--landcover-table", {"--landcover", "classes.tif", "--landcover-table", "classes.csv"}},
        {"--tree-cover", {"--tree-cover", "classes.tif"}},
        {"--buildings", town},
        {"--buildings-layer", withTown({"--buildings-layer", "houses"})},
        {"--height-field", withTown({"--height-field", "high"})},
        {"--roof-field", withTown({"--roof-field", "top"})},
        {"--height-unit", withTown({"--height-unit", "ft"})},
        {"--no-ambient-occlusion", withTown({"--no-ambient-occlusion"})},
        {"--geocentric", {"--geocentric"}},
        {"--srs", {"--srs", "EPSG:2193"}},
        {"--vertical", {"--vertical", "egm96"}},
        {"--tree-line", {"--tree-line", "1000"}},
        {"--lake-area", {"--lake-area", "1"}},
        {"--voids", {"--voids", "keep"}},
        {"--all-heights", {"--all-heights"}},
        {"--void-reach", {"--void-reach", "10"}},
        {"--void-smoothing", {"--void-smoothing", "2"}},
        {"--tile-size", {"--tile-size", "32"}},
        {"--texture-size", {"--texture-size", "64"}},
        {"--pixel-error", {"--pixel-error", "2"}},
        {"--anisotropy", {"--anisotropy", "2"}},
        {"--compress-textures", {"--compress-textures"}},
        {"--texel-error", {"--texel-error", "4"}},
        {"--pixels-per-radian", {"--pixels-per-radian", "1000"}},
        {"--memory", {"--memory", "256"}},
        {"--threads", {"--threads", "1"}},
        {"--resume", {"--resume"}},
        {"--anew", {"--anew"}},
        {"--keep-nothing", {"--keep-nothing"}},
        {"--estimate", {"--estimate"}},
        {"--quiet", {"--quiet"}},
        {"--plan", {"--plan", "out/plan"}},
    };
    tryPairs("osggeofx_build", {"--dem", "small.tif"}, {{"--output", {"-o", "out/db"}}}, samples,
             {"--help", "--dem", "--output", "--work", "--unit"}, 3);
}

TEST_F(OptionPairs, OfPalette)
{
    write("points.csv", "class,x,y,light\nfield,100,200,0.2\nfield,140,210,0.8\nsnow,240,120,0.3\n"
                        "snow,250,125,0.9\n");
    TestRaster(WIDTH, HEIGHT, 3, GDT_Byte)
        .fill([](int column, int, int band) { return band == 0 ? column / 60 : 0.0; })
        .write(file("rows.tif"));
    const Words light = {"--light", "plain.png"};
    const std::vector<Sample> samples = {
        {"--light", light},
        {"--hillshade", {"--light", "plain.png", "--hillshade"}},
        {"--classes", {"--light", "plain.png", "--classes", "rows.tif"}},
        {"--points", {"--points", "points.csv"}},
        {"--around", {"--points", "points.csv", "--around", "4"}},
    };
    // A ready palette has no painting.
    tryPairs("osggeofx_palette", {"plain.png"}, {{"--points", {"--points", "points.csv"}}}, samples,
             {"--help", "--output", "--ready"}, 2);
}

TEST_F(OptionPairs, OfCluster)
{
    const ProgramResult planned = run("osggeofx_build", {"--dem", "small.tif", "--plan", "plan"});
    ASSERT_EQ(planned.exitCode, 0) << planned.standardError;
    std::smatch stage;
    const std::string plan = bytes((fs::path("plan") / "work" / "plan.json").string());
    ASSERT_TRUE(std::regex_search(plan, stage, std::regex(R"x("name": *"([a-z]+)")x"))) << plan;
    const std::vector<Sample> both = {
        {"--max-workers", {"--max-workers", "2"}},
        {"--memory", {"--memory", "256"}},
        {"--builder", {"--builder", "/usr/bin/osggeofx_build"}},
        {"--units-per-job", {"--units-per-job", "2"}},
        {"--until", {"--until", stage[1]}},
    };
    // A makefile comes whole or not at all.
    const ProgramResult refused = run("osggeofx_cluster", {"make", "plan", "--until", "nothing"});
    EXPECT_EQ(refused.exitCode, 2);
    EXPECT_EQ(refused.standardOutput, "");
    tryPairs("osggeofx_cluster", {"make", "plan"}, {}, both, {"--help"}, 3);
    std::vector<Sample> submitted = both;
    submitted.push_back({"--partition", {"--partition", "fast"}});
    tryPairs("osggeofx_cluster", {"submit", "plan", "--dry-run"}, {}, submitted, {"--help", "--dry-run"}, 3);
    // It has no options, so that no pairs of them are tried: those that it gets must stand here.
    tryPairs("osggeofx_cluster", {"status", "plan"}, {}, {}, {"--help"}, 0);

    const std::string first = stage[1].str() + ":0-0";
    const ProgramResult measured = run("osggeofx_build", {"--quiet", "--work", "plan", "--unit", first});
    ASSERT_EQ(measured.exitCode, 0) << measured.standardError;
    const ProgramResult saved = run("osggeofx_cluster", {"predict", "plan", "--save", "times.json"});
    ASSERT_EQ(saved.exitCode, 0) << saved.standardError;
    const std::vector<Sample> predicted = {
        {"--units-per-job", {"--units-per-job", "2"}},
        {"--until", {"--until", stage[1]}},
        {"--cores", {"--cores", "2"}},
        {"--workers", {"--cores", "2", "--workers", "3"}},
        {"--times", {"--times", "times.json"}},
        {"--save", {"--save", "out/times.json"}},
    };
    tryPairs("osggeofx_cluster", {"predict", "plan"}, {}, predicted, {"--help"}, 3);
    tryPairs("osggeofx_cluster", {"status", "plan"}, {}, {}, {"--help"}, 0);
}

TEST_F(OptionPairs, OfViewer)
{
    write("city.obj", "v 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 3\n");
    write("saved.path", "0 -4919000 507000 -4025000 0 0 0 1\n1 -4919000 507100 -4025000 0 0 0 1\n");
    std::vector<Sample> samples = onTheGround();
    const std::vector<Sample> own = {
        {"--fov", {"--fov", "40"}},
        {"--effect", {"--effect", "verticalExaggeration factor=2"}},
        {"--city", {"--city", "city.obj"}},
        {"--cache-mappings", {"--mapping", "area.geojson", "--cache-mappings"}},
        {"--labels", {"--labels", "names.geojson"}},
        {"--lines", {"--lines", "lines.geojson"}},
        {"--style", {"--labels", "names.geojson", "--style", "style.json"}},
        {"--font", {"--labels", "names.geojson", "--font", "DejaVu Sans"}},
        {"--sky", {"--sky"}},
        {"--allow-outside", {"--allow-outside"}},
        {"--memory", {"--memory", "500"}},
        {"--gpu-memory", {"--gpu-memory", "500"}},
        {"--prefetch", {"--prefetch", "3"}},
    };
    samples.insert(samples.end(), own.begin(), own.end());
    // OSG's own options are not the kit's, nor is --speed, which osgviewer has, too.
    Exclusions none;
    std::set<std::string> others =
        optionsIn(runProgram({"osgviewer", "--help"}, {}).standardOutput, {}, none);
    others.insert({"--help", "--help-effects"});
    tryPairs(viewer, {"work/ground/terrain.osgb"}, {}, samples, others, 1);
}
