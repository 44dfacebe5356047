// SPDX-License-Identifier: MIT
// SPDX-FileCopyrightText: 2026 the osgGeoFX authors
// The program osggeofx_render, as a person calls it.
#include <osgGeoFX/paging/PluginFolder.h>
#include <osgGeoFX/scene/RigidReference.h>
#include <tools/GlFixture.h>
#include <tools/ImageComparison.h>
#include <tools/PagedScene.h>
#include <tools/PixelsApart.h>
#include <tools/RunProgram.h>
#include <tools/TempDir.h>

#include <nlohmann/json.hpp>
#include <osg/Image>
#include <osg/MatrixTransform>
#include <osgDB/ReadFile>
#include <osgDB/WriteFile>

#include <algorithm>
#include <filesystem>
#include <fstream>
#include <iterator>

using geofx::test::PagedScene;
using geofx::test::ProgramResult;
using geofx::test::TempDir;

namespace fs = std::filesystem;

namespace
{

class RenderProgram : public geofx::test::GlFixture
{
protected:
    ProgramResult run(std::vector<std::string> arguments)
    {
        arguments.insert(arguments.begin(), geofx::test::builtProgram("osggeofx_render"));
        geofx::test::ProgramOptions options;
        options.folder = _folder.path().string();
        options.environment = {"DISPLAY=", "LC_ALL=de_DE.UTF-8"};
        return geofx::test::runProgram(arguments, options);
    }

    void expectPicture(const std::vector<std::string>& arguments)
    {
        const ProgramResult result = run(arguments);
        EXPECT_EQ(result.exitCode, 0) << result.standardError;
        EXPECT_EQ(result.standardError, "");
        EXPECT_EQ(result.standardOutput, "");
    }

    /// Exit code 2 and one sentence, no more, that holds a word of what is wrong.
    void expectRefusal(const std::vector<std::string>& arguments, const std::string& word)
    {
        const ProgramResult result = run(arguments);
        EXPECT_EQ(result.exitCode, 2) << result.standardError;
        EXPECT_NE(result.standardError.find(word), std::string::npos) << result.standardError;
        EXPECT_EQ(std::count(result.standardError.begin(), result.standardError.end(), '\n'), 1)
            << result.standardError;
        EXPECT_EQ(result.standardError.rfind("osggeofx_render: ", 0), 0u) << result.standardError;
        EXPECT_FALSE(fs::exists(_folder / "out.png"));
    }

    osg::ref_ptr<osg::Image> image(const std::string& name) const
    {
        return osgDB::readRefImageFile((_folder / name).string());
    }

    std::string bytes(const std::string& name) const
    {
        std::ifstream stream(_folder / name, std::ios::binary);
        return {std::istreambuf_iterator<char>(stream), std::istreambuf_iterator<char>()};
    }

    osg::Vec3i pixel(const osg::Image& picture, int x, int y) const
    {
        const unsigned char* p = picture.data(x, y);
        return osg::Vec3i(p[0], p[1], p[2]);
    }

    TempDir _folder;
    const osg::Vec3i _blue = {0, 0, 255};
};

} // namespace

TEST_F(RenderProgram, DrawsFromAboveWithViewAndWithEye)
{
    PagedScene::write(_folder.path(), PagedScene::Kind::Geocentric);
    expectPicture({"terrain.osgb", "-o", "a.png", "--size", "160x120", "--view", "-157.8,21.4,8100,0,-90",
                   "--stats", "a.json"});
    const osg::ref_ptr<osg::Image> picture = image("a.png");
    ASSERT_TRUE(picture.valid());
    EXPECT_EQ(picture->s(), 160);
    EXPECT_EQ(picture->t(), 120);
    EXPECT_EQ(pixel(*picture, 80, 60), _blue);
    EXPECT_EQ(pixel(*picture, 2, 2), osg::Vec3i(184, 204, 224)) << "the background";

    const auto stats = nlohmann::json::parse(bytes("a.json"));
    EXPECT_FALSE(stats.at("renderer").get<std::string>().empty());
    EXPECT_FALSE(stats.at("gl_version").get<std::string>().empty());
    EXPECT_GT(stats.at("peak_memory_bytes").get<double>(), 1e6);
    EXPECT_EQ(stats.at("size"), nlohmann::json({160, 120}));
    ASSERT_EQ(stats.at("frames").size(), 1u);
    const auto frame = stats.at("frames").at(0);
    EXPECT_EQ(frame.at("tiles_drawn"), 16);
    EXPECT_EQ(frame.at("triangles"), 32);
    EXPECT_EQ(frame.at("drawables"), 16);
    EXPECT_EQ(frame.at("tiles_loaded"), 5);
    EXPECT_GT(frame.at("bytes_read"), 1000);
    EXPECT_GT(frame.at("cull_ms"), 0.0);
    EXPECT_GT(frame.at("draw_ms"), 0.0);
    EXPECT_GT(frame.at("total_ms"), 0.0);
    EXPECT_FALSE(frame.contains("least_triangles")) << "nobody asked";
    expectPicture({"terrain.osgb", "-o", "a.png", "--size", "160x120", "--view", "-157.8,21.4,8100,0,-90",
                   "--stats", "least.json", "--least-triangles"});
    EXPECT_EQ(nlohmann::json::parse(bytes("least.json")).at("frames").at(0).at("least_triangles"), 0)
        << "the tiles are level";

    TempDir other;
    PagedScene::write(_folder / "flat", PagedScene::Kind::Flat);
    expectPicture({"flat/terrain.osgb", "-o", "b.png", "--size", "160x120", "--eye", "0,0,8000", "--look",
                   "0,0,0", "--up", "0,1,0"});
    EXPECT_EQ(bytes("b.png"), bytes("a.png")) << "the same view, told in world coordinates";
}

// The ground lies at 100 m.
TEST_F(RenderProgram, AnEyeBelowTheGroundIsTold)
{
    PagedScene::write(_folder.path(), PagedScene::Kind::Geocentric);
    for (const bool below : {true, false})
    {
        const ProgramResult result = run({"terrain.osgb", "-o", "a.png", "--size", "160x120", "--view",
                                          below ? "-157.8,21.4,91,0,-10" : "-157.8,21.4,109,0,-10"});
        EXPECT_EQ(result.exitCode, 0) << result.standardError;
        if (below)
            EXPECT_NE(result.standardError.find("eye is 9 m below the ground"), std::string::npos)
                << result.standardError;
        else
            EXPECT_EQ(result.standardError, "");
    }
}

TEST_F(RenderProgram, SameCommandGivesSameBytesInEachFormat)
{
    PagedScene::write(_folder.path(), PagedScene::Kind::Geocentric);
    for (const std::string extension : {"png", "jpg", "tiff"})
    {
        for (const std::string name : {"a.", "b."})
        {
            expectPicture({"terrain.osgb", "-o", name + extension, "--size", "200x150", "--samples", "4"});
        }
        EXPECT_FALSE(bytes("a." + extension).empty());
        EXPECT_EQ(bytes("a." + extension), bytes("b." + extension));
    }
}

TEST_F(RenderProgram, FollowsAPath)
{
    PagedScene::write(_folder.path(), PagedScene::Kind::Geocentric);
    _folder.write("flight.csv",
                  "time,lon,lat,alt,heading,pitch\n0,-157.8,21.4,8100,0,-90\n10,-157.8,22.4,8100,0,-90\n");
    expectPicture(
        {"terrain.osgb", "-o", "f%03d.png", "--size", "64x64", "--path", "flight.csv", "--frames", "3"});
    ASSERT_TRUE(image("f000.png").valid());
    ASSERT_TRUE(image("f002.png").valid());
    EXPECT_EQ(pixel(*image("f000.png"), 32, 32), _blue);
    EXPECT_NE(pixel(*image("f001.png"), 32, 32), _blue) << "half a degree away there is no terrain";
    EXPECT_FALSE(fs::exists(_folder / "f003.png"));
}

TEST_F(RenderProgram, HelpIsOnStandardOutput)
{
    const ProgramResult result = run({"--help"});
    EXPECT_EQ(result.exitCode, 0);
    for (const char* option :
         {"--size", "--view", "--eye", "--look", "--up", "--fov", "--path", "--frames", "--no-cull",
          "--samples", "--stats", "--wait-for-tiles", "--platform", "--timeout"})
    {
        EXPECT_NE(result.standardOutput.find(option), std::string::npos) << option;
    }
}

TEST_F(RenderProgram, RefusesBadInputWithASentence)
{
    PagedScene::write(_folder.path(), PagedScene::Kind::Flat);
    expectRefusal({}, "scene");
    expectRefusal({"terrain.osgb"}, "--output");
    expectRefusal({"missing.osgb", "-o", "out.png"}, "missing.osgb");
    _folder.write("broken.osgb", "garbage");
    expectRefusal({"broken.osgb", "-o", "out.png"}, "broken.osgb");
    expectRefusal({"terrain.osgb", "-o", "out.nosuchformat"}, "nosuchformat");
    expectRefusal({"terrain.osgb", "-o", "no/such/folder/out.png"}, "folder");
    expectRefusal({"terrain.osgb", "-o", "out.png", "--size", "10"}, "--size");
    expectRefusal({"terrain.osgb", "-o", "out.png", "--size", "0x10"}, "--size");
    expectRefusal({"terrain.osgb", "-o", "out.png", "--view", "1,2"}, "--view");
    expectRefusal({"terrain.osgb", "-o", "out.png", "--view", "1,2,3,4,5"}, "coordinate system");
    expectRefusal({"terrain.osgb", "-o", "out.png", "--eye", "1,2,3"}, "--look");
    expectRefusal({"terrain.osgb", "-o", "out.png", "--eye", "1,2,3", "--look", "1,2,0"}, "--up");
    expectRefusal({"terrain.osgb", "-o", "out.png", "--fov", "180"}, "--fov");
    expectRefusal({"terrain.osgb", "-o", "out.png", "--path", "missing.csv", "--frames", "2"}, "pattern");
    expectRefusal({"terrain.osgb", "-o", "f%d.png", "--path", "missing.csv", "--frames", "2"}, "missing.csv");
    expectRefusal({"terrain.osgb", "-o", "out.png", "--path", "missing.csv"}, "--frames");
    expectRefusal(
        {"terrain.osgb", "-o", "out.png", "--view", "1,2,3,4,5", "--eye", "1,2,3", "--look", "0,0,0"},
        "excludes");
    expectRefusal({"terrain.osgb", "-o", "out.png", "--platform", "wayland"}, "wayland");
    expectRefusal({"terrain.osgb", "-o", "out.png", "--platform", "x11"}, "DISPLAY");
    expectRefusal({"terrain.osgb", "-o", "out.png", "--stats", "no/such/folder.json"}, "folder.json");
    expectRefusal({"terrain.osgb", "-o", "out.png", "--least-triangles"}, "--stats");
    expectRefusal({"terrain.osgb", "-o", "out.png", "--size", "64x48@100dpi", "--inset"}, "--inset");
    expectRefusal({"terrain.osgb", "-o", "out.png", "--city", "missing.obj"}, "--city: The city model");
}

// Buildings of a file that knows nothing of the kit stand as those that have a node each.
TEST_F(RenderProgram, CitiesKeepTheirShape)
{
    PagedScene::write(_folder.path(), PagedScene::Kind::Flat);
    const std::string corners[] = {"-60 -60 0",   "60 -60 0",   "-60 60 0",   "60 60 0",
                                   "-60 -60 200", "60 -60 200", "-60 60 200", "60 60 200"};
    std::string text;
    for (const std::string& corner : corners)
        text += "v " + corner + '\n';
    _folder.write("house.obj", text + "f 1 2 6 5\nf 2 4 8 6\nf 4 3 7 8\nf 3 1 5 7\nf 5 6 8 7\n");
    osgGeoFX::addPluginFolder();
    watch().ignore("unable to find material");
    // OSG's reader of .obj turns models upright unless it is told not to.
    const osg::ref_ptr<osgDB::Options> asItIs = new osgDB::Options("noRotation");
    const osg::ref_ptr<osg::Node> house = osgDB::readRefNodeFile((_folder / "house.obj").string(), asItIs);
    ASSERT_TRUE(house);
    const osg::ref_ptr<osg::Group> city = new osg::Group, nodes = new osg::Group;
    for (int i = 0; i < 60; ++i)
    {
        const osg::Vec3d foot(-900.0 + 300.0 * (i % 6), -1400.0 + 300.0 * (i / 6), 0.0);
        const osg::ref_ptr<osg::MatrixTransform> place =
            new osg::MatrixTransform(osg::Matrix::translate(foot));
        place->addChild(house);
        city->addChild(osg::clone(place.get(), osg::CopyOp::DEEP_COPY_ALL));
        const osg::ref_ptr<osgGeoFX::RigidReference> rigid = new osgGeoFX::RigidReference;
        rigid->setReference(foot);
        rigid->addChild(place);
        nodes->addChild(rigid);
    }
    ASSERT_TRUE(osgDB::writeNodeFile(*city, (_folder / "city.osgb").string()));
    ASSERT_TRUE(osgDB::writeNodeFile(*nodes, (_folder / "nodes.osgb").string()));
    const auto draw = [&](const std::string& name, std::vector<std::string> more)
    {
        more.insert(more.end(),
                    {"terrain.osgb", "-o", name, "--size", "320x240", "--eye", "0,-2600,700", "--look",
                     "0,0,0", "--up", "0,0,1", "--effect", "birdsEyeView contextTilt=0.7"});
        expectPicture(more);
        return image(name);
    };
    const osg::ref_ptr<osg::Image> without = draw("without.png", {}),
                                   rigid = draw("nodes.png", {"--city", "nodes.osgb"}),
                                   found = draw("city.png", {"--city", "city.osgb"});
    const int seen = geofx::test::pixelsApart(*rigid, *without);
    EXPECT_GT(seen, 2000);
    EXPECT_LE(geofx::test::pixelsApart(*found, *rigid), seen / 50);
}

// A print is the picture in tiles, with its resolution.
TEST_F(RenderProgram, Prints)
{
    PagedScene::write(_folder.path(), PagedScene::Kind::Flat);
    const std::vector<std::string> view = {"--eye", "0,0,8000", "--look", "0,0,0", "--up", "0,1,0"};
    const auto draw = [&](std::vector<std::string> arguments)
    {
        arguments.insert(arguments.begin(), "terrain.osgb");
        arguments.insert(arguments.end(), view.begin(), view.end());
        const ProgramResult result = run(arguments);
        EXPECT_EQ(result.exitCode, 0) << result.standardError;
    };
    draw({"-o", "plain.png", "--size", "160x120"});
    draw({"-o", "print.png", "--size", "160x120@100dpi"});
    const osg::ref_ptr<osg::Image> plain = osgDB::readRefImageFile((_folder.path() / "plain.png").string());
    const osg::ref_ptr<osg::Image> print = osgDB::readRefImageFile((_folder.path() / "print.png").string());
    ASSERT_TRUE(plain && print);
    EXPECT_TRUE(geofx::test::imagesMatch(*print, *plain));
    EXPECT_FALSE(std::filesystem::exists(_folder.path() / "print.tiles"));
}

// What a print shows stands in the print.
TEST_F(RenderProgram, PrintsTellTheirView)
{
    PagedScene::write(_folder.path(), PagedScene::Kind::Geocentric);
    const ProgramResult result = run({"terrain.osgb", "-o", "print.png", "--size", "160x120@100dpi", "--view",
                                      "-157.8,21.4,5000,30,-60", "--effect", "birdsEyeView"});
    ASSERT_EQ(result.exitCode, 0) << result.standardError;
    geofx::test::ProgramOptions options;
    options.folder = _folder.path().string();
    const std::string told =
        geofx::test::runProgram({"/usr/bin/oiiotool", "--info", "-v", "print.png"}, options).standardOutput;
    const std::size_t begin = told.find("ImageDescription: \"");
    ASSERT_NE(begin, std::string::npos) << told;
    const std::size_t from = told.find('{', begin), to = told.find('\n', from);
    std::string text = told.substr(from, told.rfind('}', to) + 1 - from);
    // oiiotool shows quotes with backslashes.
    text.erase(std::remove(text.begin(), text.end(), '\\'), text.end());
    const nlohmann::json json = nlohmann::json::parse(text, nullptr, false);
    ASSERT_TRUE(json.is_object()) << text;
    EXPECT_EQ(json["scene"], "terrain.osgb");
    EXPECT_EQ(json["effects"][0], "birdsEyeView");
    EXPECT_NEAR(json["eye"]["longitude"].get<double>(), -157.8, 1e-6);
    EXPECT_NEAR(json["eye"]["latitude"].get<double>(), 21.4, 1e-6);
    EXPECT_NEAR(json["eye"]["height"].get<double>(), 5000.0, 0.01);
    EXPECT_EQ(json["viewMatrix"].size(), 16u);
}

TEST_F(RenderProgram, GivesUpAfterTheTimeout)
{
    PagedScene::write(_folder.path(), PagedScene::Kind::Flat);
    const ProgramResult result = run({"terrain.osgb", "-o", "out.png", "--timeout", "0.000001"});
    EXPECT_EQ(result.exitCode, 1);
    EXPECT_NE(result.standardError.find("did not arrive"), std::string::npos) << result.standardError;
    EXPECT_FALSE(fs::exists(_folder / "out.png"));
    expectPicture({"terrain.osgb", "-o", "out.png", "--timeout", "0.000001", "--no-wait-for-tiles"});
}

TEST_F(RenderProgram, NothingIsLeftOnAFullDisk)
{
    PagedScene::write(_folder.path(), PagedScene::Kind::Flat);
    // No file may have more than a kilobyte.
    geofx::test::ProgramOptions options;
    options.folder = _folder.path().string();
    options.environment = {"DISPLAY="};
    const ProgramResult result = geofx::test::runProgram(
        {"/bin/bash", "-c", "trap '' XFSZ; ulimit -f 1; exec \"$@\"", "limited",
         geofx::test::builtProgram("osggeofx_render"), "terrain.osgb", "-o", "out.png"},
        options);
    EXPECT_EQ(result.exitCode, 2);
    EXPECT_NE(result.standardError.find("space"), std::string::npos) << result.standardError;
    for (const auto& entry : fs::directory_iterator(_folder.path()))
        EXPECT_EQ(entry.path().filename().string().find("out.png"), std::string::npos) << entry.path();
}

TEST_F(RenderProgram, InsetsStandInTheCornerThatIsAskedFor)
{
    PagedScene::write(_folder.path(), PagedScene::Kind::Geocentric);
    const std::vector<std::string> picture = {
        "terrain.osgb", "-o", "a.png", "--size", "320x240", "--view", "-157.8,21.4,8100,0,-90"};
    // The frame's lower left pixel and its upper right one: a white pixel around an 80 × 60 picture, 4 pixels from the border.
    struct Corner
    {
        const char* name;
        int left, low;
    };
    for (const Corner& corner :
         {Corner{"", 235, 3}, Corner{"lower-right", 235, 3}, Corner{"lower-left", 3, 3},
          Corner{"upper-left", 3, 175}, Corner{"upper-right", 235, 175}})
    {
        SCOPED_TRACE(corner.name);
        std::vector<std::string> arguments = picture;
        arguments.emplace_back("--inset");
        if (*corner.name) arguments.insert(arguments.end(), {"--inset-corner", corner.name});
        expectPicture(arguments);
        const osg::ref_ptr<osg::Image> found = image("a.png");
        ASSERT_TRUE(found);
        const osg::Vec3i white(255, 255, 255);
        EXPECT_EQ(pixel(*found, corner.left, corner.low), white);
        EXPECT_EQ(pixel(*found, corner.left + 81, corner.low + 61), white);
        EXPECT_NE(pixel(*found, corner.left + 40, corner.low + 30), white);
        EXPECT_NE(pixel(*found, 320 - 4 - corner.left - 40, 240 - 5 - corner.low - 30), white);
    }
    std::vector<std::string> wrong = picture;
    wrong[2] = "out.png";
    wrong.insert(wrong.end(), {"--inset", "--inset-corner", "middle"});
    expectRefusal(wrong, "--inset-corner");
}
