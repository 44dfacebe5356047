// SPDX-License-Identifier: MIT
// SPDX-FileCopyrightText: 2026 the osgGeoFX authors
//
// Films and prints of osggeofx_render and osggeofx_panorama, drawn by one process and by many.
#include <tools/FolderContents.h>
#include <tools/GlFixture.h>
#include <tools/InventedTerrain.h>
#include <tools/OahuScene.h>
#include <tools/PagedScene.h>
#include <tools/RandomSamples.h>
#include <tools/RunProgram.h>
#include <tools/TempDir.h>

#include <nlohmann/json.hpp>
#include <osg/AnimationPath>

#include <algorithm>
#include <csignal>
#include <cstdio>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <random>
#include <thread>

using namespace geofx::test;
namespace fs = std::filesystem;

namespace
{

class FilmProgram : public GlFixture
{
protected:
    ProgramResult run(const std::string& program, std::vector<std::string> arguments, double killAfter = 0.0)
    {
        arguments.insert(arguments.begin(), builtProgram(program));
        ProgramOptions options;
        options.folder = _folder.path().string();
        options.environment = {"DISPLAY=", "LC_ALL=de_DE.UTF-8"};
        if (killAfter > 0.0)
        {
            options.seconds = killAfter;
            options.signal = SIGKILL;
        }
        return runProgram(arguments, options);
    }
    void expectDone(const std::string& program, const std::vector<std::string>& arguments)
    {
        const ProgramResult result = run(program, arguments);
        EXPECT_EQ(result.exitCode, 0) << result.standardError;
        EXPECT_EQ(result.standardError, "");
    }
    /// One sentence with a word of what is wrong.
    void expectRefusal(const std::vector<std::string>& arguments, const std::string& word,
                       const std::string& program = "osggeofx_render")
    {
        const ProgramResult result = run(program, arguments);
        EXPECT_EQ(result.exitCode, 2) << result.standardError;
        EXPECT_NE(result.standardError.find(word), std::string::npos) << result.standardError;
        EXPECT_EQ(std::count(result.standardError.begin(), result.standardError.end(), '\n'), 1)
            << result.standardError;
    }
    std::string file(const std::string& name) const { return (_folder / name).string(); }
    std::string bytes(const std::string& name) const
    {
        std::ifstream stream(_folder / name, std::ios::binary);
        return {std::istreambuf_iterator<char>(stream), std::istreambuf_iterator<char>()};
    }
    /// A flight over the terrain of PagedScene, whose levels have colors of their own: near, far and near again.
    void writePath()
    {
        PagedScene::write(_folder.path(), PagedScene::Kind::Geocentric);
        _folder.write("flight.csv", "time,lon,lat,alt,heading,pitch\n"
                                    "0,-157.8,21.4,8100,0,-90\n2,-157.8,21.4,60000,90,-90\n"
                                    "4,-157.801,21.401,9000,120,-85\n");
    }
    std::vector<std::string> film(const std::string& output) const
    {
        return {"terrain.osgb", "-o", output, "--size", "80x60", "--path", "flight.csv", "--fps", "2"};
    }
    static std::vector<std::string> with(std::vector<std::string> first, const std::vector<std::string>& more)
    {
        first.insert(first.end(), more.begin(), more.end());
        return first;
    }

    /// Two processes at a time do all parts of a stage, each of which is killed once at some moment.
    void doInParts(const std::string& program, const std::string& plan, const std::string& stage, int parts,
                   double usual)
    {
        std::mt19937 random(4711);
        std::vector<std::thread> threads;
        std::vector<std::string> faults(static_cast<std::size_t>(parts));
        std::vector<double> moments;
        for (int part = 0; part < parts; ++part)
            moments.push_back(std::uniform_real_distribution<>(0.2 * usual, usual)(random));
        std::atomic<int> next{0};
        const auto work = [&]
        {
            for (int part = next++; part < parts; part = next++)
            {
                const std::vector<std::string> call = {"--work",
                                                       plan,
                                                       "--quiet",
                                                       "--threads",
                                                       "1",
                                                       "--unit",
                                                       stage + ":" + std::to_string(part) + "/" +
                                                           std::to_string(parts)};
                _kills += run(program, call, moments[static_cast<std::size_t>(part)]).timedOut;
                const ProgramResult result = run(program, call);
                if (result.exitCode != 0) faults[static_cast<std::size_t>(part)] = result.standardError;
            }
        };
        for (int i = 0; i < 2; ++i)
            threads.emplace_back(work);
        for (std::thread& thread : threads)
            thread.join();
        for (const std::string& fault : faults)
            EXPECT_EQ(fault, "");
    }

    TempDir _folder;
    std::atomic<int> _kills{0};
};

} // namespace

TEST_F(FilmProgram, PicturesHaveTheirTimes)
{
    writePath();
    expectDone("osggeofx_render", film("f%02d.png"));
    EXPECT_TRUE(fs::exists(file("f08.png")));
    EXPECT_FALSE(fs::exists(file("f09.png"))) << "four seconds have nine pictures at two a second";
    EXPECT_NE(bytes("f00.png"), bytes("f04.png"));
    // The same pictures, evenly in time.
    std::vector<std::string> even = {"terrain.osgb", "-o",         "e%02d.png", "--size", "80x60",
                                     "--path",       "flight.csv", "--frames",  "9"};
    expectDone("osggeofx_render", even);
    // A part of them.
    expectDone("osggeofx_render", with(film("p%02d.png"), {"--frames", "3-4"}));
    EXPECT_FALSE(fs::exists(file("p02.png")) || fs::exists(file("p05.png")));
    for (const char* number : {"03", "04"})
    {
        const std::string whole = bytes(std::string("f") + number + ".png");
        EXPECT_FALSE(whole.empty());
        EXPECT_TRUE(whole == bytes(std::string("e") + number + ".png")) << number;
        EXPECT_TRUE(whole == bytes(std::string("p") + number + ".png")) << number;
    }
}

// What a viewer of OpenSceneGraph's records: its picture at a time is that of --eye and --look there.
TEST_F(FilmProgram, TakesThePathOfAViewer)
{
    PagedScene::write(_folder.path(), PagedScene::Kind::Flat);
    osg::ref_ptr<osg::AnimationPath> path = new osg::AnimationPath;
    const osg::Matrixd down = osg::Matrixd::inverse(
        osg::Matrixd::lookAt(osg::Vec3d(0.0, 0.0, 8000.0), osg::Vec3d(), osg::Vec3d(0.0, 1.0, 0.0)));
    path->insert(5.0, osg::AnimationPath::ControlPoint(down.getTrans(), down.getRotate()));
    path->insert(7.0, osg::AnimationPath::ControlPoint(osg::Vec3d(1000.0, 500.0, 6000.0), down.getRotate()));
    std::ofstream stream(_folder / "saved_animation.path");
    stream.precision(15);
    path->write(stream);
    stream.close();
    expectDone("osggeofx_render", {"terrain.osgb", "-o", "f%d.png", "--size", "80x60", "--path",
                                   "saved_animation.path", "--fps", "1"});
    EXPECT_FALSE(fs::exists(file("f3.png")));
    const auto expectView = [&](const std::string& picture, const std::string& eye, const std::string& look)
    {
        expectDone("osggeofx_render", {"terrain.osgb", "-o", "view.png", "--size", "80x60", "--eye", eye,
                                       "--look", look, "--up", "0,1,0"});
        EXPECT_TRUE(bytes(picture) == bytes("view.png")) << picture;
    };
    expectView("f0.png", "0,0,8000", "0,0,0");
    expectView("f1.png", "500,250,7000", "500,250,0");
    expectView("f2.png", "1000,500,6000", "1000,500,0"); // and not the first one again
    _folder.write("broken.path", "0 1 2 3 0 0 0 1\n1 1 2 3 0 0 0\n");
    expectRefusal({"terrain.osgb", "-o", "f%d.png", "--path", "broken.path", "--fps", "1"}, "line 2");
}

TEST_F(FilmProgram, RefusesWhatIsNoPartOfAFilm)
{
    writePath();
    const std::vector<std::string> call = {"terrain.osgb", "-o", "f%d.png", "--path", "flight.csv"};
    expectRefusal(call, "--fps");
    expectRefusal(with(call, {"--frames", "3-4"}), "--fps");
    expectRefusal(with(call, {"--frames", "x"}), "write a number");
    expectRefusal(with(call, {"--frames", "0"}), "1 to 1000000");
    expectRefusal(with(call, {"--fps", "2", "--frames", "9"}), "leave --fps out");
    expectRefusal(with(call, {"--fps", "2", "--frames", "4-9"}), "pictures 0 to 8");
    expectRefusal(with(call, {"--fps", "2", "--frames", "4-3"}), "pictures 0 to 8");
    expectRefusal(with(call, {"--fps", "1e9"}), "1000000");
}

// A picture is the same whichever process draws it, and whatever was drawn before.
TEST_F(FilmProgram, ManyProcessesDrawTheFilmOfOne)
{
    // Oahu, or small tiles that are read at once.
    std::string terrain = GEOFX_BUILD_DIR "/test-data/oahu/terrain.osgb";
    ASSERT_TRUE(fs::exists(terrain));
    if (!fullTest())
    {
        terrain = "terrain.osgb";
        PagedScene::write(_folder.path(), PagedScene::Kind::Geocentric);
    }
    _folder.write("flight.csv", "time,lon,lat,alt,heading,pitch\n0,-157.81,21.37,5000,20,-50\n"
                                "1,-157.8,21.39,2500,60,-60\n2,-157.801,21.401,9000,300,-85\n");
    _folder.write(
        "names.geojson",
        R"({"type": "FeatureCollection", "features": [{"type": "Feature", "properties": {"name": "Here"},
                      "geometry": {"type": "Point", "coordinates": [-157.8, 21.4]}}]})");
    const auto call = [&](const std::string& output, const std::vector<std::string>& more)
    {
        return with({terrain, "-o", output, "--size", "200x120", "--path", "flight.csv", "--fps", "2",
                     "--effect", "birdsEyeView", "--labels", "names.geojson"},
                    more);
    };
    fs::create_directory(_folder / "one");
    const ProgramResult whole = run("osggeofx_render", call("one/f%03d.png", {}));
    ASSERT_EQ(whole.exitCode, 0) << whole.standardError;
    expectDone("osggeofx_render", call("f%03d.png", {"--plan", "many"}));
    const auto plan =
        nlohmann::json::parse(bytes((std::filesystem::path("many") / "work" / "plan.json").string()));
    EXPECT_EQ(plan.at("program"), "osggeofx_render");
    EXPECT_EQ(plan.at("stages").at(0).at("name"), "frames");
    EXPECT_EQ(plan.at("stages").at(0).at("units"), 5);
    // The last picture first, then all, by processes that are killed.
    expectDone("osggeofx_render", {"--work", "many", "--quiet", "--unit", "frames:4"});
    EXPECT_TRUE(fs::exists(file("many/f004.png")));
    EXPECT_FALSE(fs::exists(file("many/f003.png")));
    expectRefusal({"--work", "many", "--unit", "film"}, "4 of 5 units are missing");
    doInParts("osggeofx_render", file("many"), "frames", 2, 0.5 * whole.seconds);
    const ProgramResult status = run("osggeofx_cluster", {"status", "many"});
    EXPECT_NE(status.standardOutput.find("5/5"), std::string::npos) << status.standardOutput;
    expectDone("osggeofx_render", {"--work", "many", "--quiet", "--unit", "film"});
    EXPECT_FALSE(fs::exists(file("many/work")));
    fs::remove(_folder / "many" / "finished.json");
    EXPECT_TRUE(contents(_folder / "many") == contents(_folder / "one"));
    EXPECT_GE(_kills, 1);
}

TEST_F(FilmProgram, PlansTellWhatTheyCannotDo)
{
    writePath();
    expectRefusal({"terrain.osgb", "-o", "out.png", "--plan", "plan"}, "has parts");
    expectRefusal(with(film("a/f%d.png"), {"--plan", "plan"}), "a name alone");
    expectRefusal(with(film("f%d.png"), {"--plan", "plan", "--stats", "s.json"}), "--stats");
    expectDone("osggeofx_render", with(film("f%d.png"), {"--plan", "plan"}));
    expectRefusal(with(film("f%d.png"), {"--plan", "plan"}), "not empty");
    expectRefusal({"--work", "plan", "--unit", "frames:9"}, "has the units 0 to 8");
    expectRefusal({"--work", "plan", "--unit", "tiles:0"}, "it has frames, film");
    expectRefusal({"--work", "plan", "--unit", "frames:0"}, "plan of osggeofx_render", "osggeofx_panorama");
    expectRefusal({"--work", "nowhere", "--unit", "frames:0"}, "no work is planned here");
    // A path that has changed since is another film.
    fs::last_write_time(_folder / "flight.csv",
                        fs::last_write_time(_folder / "flight.csv") + std::chrono::seconds(5));
    expectRefusal({"--work", "plan", "--unit", "frames:0"}, "other files");
}

// The tiles of a print are drawn by several processes, which are killed; the print has the bytes of one process.
TEST_F(FilmProgram, ManyProcessesDrawThePrintOfOne)
{
    inventTerrain("volcano", file("volcano.tif"), fullTest() ? 201 : 101);
    fs::create_directories(_folder / "one");
    for (const std::string name : {"map.tif", "map.pdf"})
    {
        if (!fullTest() && name == "map.pdf") continue;
        SCOPED_TRACE(name);
        const bool tiled = name == "map.tif"; // the other one has one tile
        const std::vector<std::string> how = {
            "volcano.tif", "--size", tiled ? "4160x96@300dpi" : "640x96@300dpi", "--samples", "0", "--quiet"};
        const ProgramResult whole = run("osggeofx_panorama", with(how, {"-o", "one/" + name}));
        ASSERT_EQ(whole.exitCode, 0) << whole.standardError;
        const std::string plan = "plan-" + name;
        expectDone("osggeofx_panorama", with(how, {"-o", name, "--plan", plan}));
        const auto json =
            nlohmann::json::parse(bytes((std::filesystem::path(plan) / "work" / "plan.json").string()));
        EXPECT_EQ(json.at("program"), "osggeofx_panorama");
        const int tiles = json.at("stages").at(0).at("units");
        EXPECT_GE(tiles, tiled ? 3 : 1);
        if (tiled) doInParts("osggeofx_panorama", file(plan), "tiles", tiles, 0.3 * whole.seconds);
        expectDone("osggeofx_panorama", {"--work", plan, "--quiet", "--unit", "tiles"});
        EXPECT_FALSE(fs::exists(file(plan + "/" + name)));
        expectDone("osggeofx_panorama", {"--work", plan, "--quiet", "--unit", "picture"});
        EXPECT_FALSE(fs::exists(file(plan + "/work")));
        const bool same = bytes(plan + "/" + name) == bytes("one/" + name);
        EXPECT_TRUE(same);
        EXPECT_FALSE(bytes(plan + "/" + name).empty());
        EXPECT_TRUE(bytes(plan + "/map.json") == bytes("one/map.json")) << "the recipe";
        expectDone("osggeofx_panorama", {"--work", plan, "--quiet", "--unit", "tiles:0"}); // too late
    }
    EXPECT_GE(_kills, 1);
}
