// SPDX-License-Identifier: MIT
// SPDX-FileCopyrightText: 2026 the osgGeoFX authors
//
// Lines on the pictures of osggeofx_panorama and osggeofx_render, and names and lines as SVG, GeoJSON and PDF, as a person asks for
// them.
#include <tools/MapProgram.h>
#include <tools/RandomSamples.h>

#include <nlohmann/json.hpp>
#include <osg/Image>
#include <osgDB/ReadFile>
#include <osgDB/WriteFile>

#include <algorithm>
#include <array>
#include <cmath>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <regex>
#include <vector>

using geofx::test::ProgramResult;

namespace fs = std::filesystem;

namespace
{

class LinesProgram : public geofx::test::MapProgram
{
protected:
    void SetUp() override
    {
        MapProgram::SetUp();
        if (IsSkipped() || HasFatalFailure()) return;
        write("style.json",
              R"({"lines": {"trail": {"color": "#ff00ff", "width": 14, "least": 14, "hand": 0},
                                          "secret": {"shown": false}},
                                "names": {"hut": {"manner": "beside", "color": "#ff00ff", "halo": "#ff00ff"}}})");
    }

    void writeLine(const std::string& style, const osg::Vec2d& from, const osg::Vec2d& to) const
    {
        write("lines.geojson", collection(lineFeature(style, from, to)));
    }
    /// From pixel 150, 200 to pixel 300, 215.
    void writeTrail()
    {
        const std::vector<osg::Vec2d> ends = placesOf({{150, 200}, {300, 215}});
        writeLine("trail", ends[0], ends[1]);
    }
};

} // namespace

// A line begins and ends where --pick says that its places are: in the picture, in the SVG and in the GeoJSON file.
TEST_F(LinesProgram, LieWhereTheirPlacesArePicked)
{
    writeTrail();
    const std::vector<std::string> usual = {"plain.json", "--lines", "lines.geojson", "--style",
                                            "style.json"};
    const auto with = [&](std::vector<std::string> more)
    {
        more.insert(more.begin(), usual.begin(), usual.end());
        return panorama(more);
    };
    const ProgramResult raster = with({"-o", "lines.png", "--geojson", "picture.geojson"});
    ASSERT_EQ(raster.exitCode, 0) << raster.standardError;
    EXPECT_EQ(raster.standardError, "");
    const osg::ref_ptr<osg::Image> image = osgDB::readRefImageFile(file("lines.png"));
    ASSERT_TRUE(image);
    const nlohmann::json vectors = nlohmann::json::parse(bytes("picture.geojson"));
    double left = 1e9, right = 0.0;
    int on = 0, all = 0;
    for (const nlohmann::json& feature : vectors.at("features"))
    {
        EXPECT_EQ(feature.at("geometry").at("type"), "LineString");
        EXPECT_EQ(feature.at("properties").at("name"), "Way & <way>");
        for (const nlohmann::json& place : feature.at("geometry").at("coordinates"))
        {
            const double x = place[0].get<double>(), y = -place[1].get<double>();
            ++all;
            on += isMagenta(*image, static_cast<int>(x), static_cast<int>(y)) ? 1 : 0;
            left = std::min(left, x);
            right = std::max(right, x);
        }
    }
    // Gaps of a few pixels behind strokes are closed.
    EXPECT_GT(on, 0.9 * all);
    EXPECT_NEAR(left, 150.5, 1.0);
    EXPECT_NEAR(right, 300.5, 1.0);
    EXPECT_GT(magentaIn(*image), 400);
    EXPECT_LT(magentaIn(*image), 1400) << "a line 4.2 pixels wide";

    const ProgramResult svg = with({"-o", "map.png", "--svg", "map.svg"});
    ASSERT_EQ(svg.exitCode, 0) << svg.standardError;
    EXPECT_TRUE(bytes("map.png") == bytes("plain.png")) << "the lines are in the SVG file";
    const std::string text = bytes("map.svg");
    EXPECT_NE(text.find("class=\"line trail\""), std::string::npos);
    EXPECT_NE(text.find("Way &amp; &lt;way&gt;</title>"), std::string::npos);
    EXPECT_NE(text.find("stroke=\"#ff00ff\""), std::string::npos);
    std::smatch match;
    ASSERT_TRUE(std::regex_search(text, match, std::regex("d=\"M([0-9.]+) ([0-9.]+)L"))) << text;
    EXPECT_NEAR(std::stod(match[1]), 150.5, 1.0);
    EXPECT_NEAR(std::stod(match[2]), 200.5, 1.0);

    // The recipe has them.
    const ProgramResult again =
        run("osggeofx_panorama", {"lines.json", "-o", "again.png", "--quiet", "--work", "work"});
    ASSERT_EQ(again.exitCode, 0) << again.standardError;
    EXPECT_TRUE(bytes("again.png") == bytes("lines.png"));
}

// With layers, lines are one of them: where the picture has them, and nowhere else.
TEST_F(LinesProgram, AreALayerOfTheirOwn)
{
    writeTrail();
    const ProgramResult result = panorama({"plain.json", "-o", "map.png", "--lines", "lines.geojson",
                                           "--style", "style.json", "--layers", "layers"});
    ASSERT_EQ(result.exitCode, 0) << result.standardError;
    const osg::ref_ptr<osg::Image> picture = osgDB::readRefImageFile(file("map.png"));
    const osg::ref_ptr<osg::Image> layer = osgDB::readRefImageFile(file("layers/lines.png"));
    const osg::ref_ptr<osg::Image> ground = osgDB::readRefImageFile(file("layers/terrain.png"));
    ASSERT_TRUE(picture && layer && ground);
    int lines = 0;
    for (int y = 0; y < HEIGHT; ++y)
        for (int x = 0; x < WIDTH; ++x)
        {
            const bool drawn =
                layer->getColor(static_cast<unsigned int>(x), static_cast<unsigned int>(y)).a() > 0.95f;
            lines += drawn ? 1 : 0;
            EXPECT_TRUE(!drawn || isMagenta(*picture, x, HEIGHT - 1 - y)) << x << ", " << y;
            EXPECT_FALSE(isMagenta(*ground, x, y));
        }
    EXPECT_GT(lines, 150);
    const std::string list = bytes("layers/layers.json");
    EXPECT_NE(list.find("--no-autopremult lines.png --premult strokes.png"), std::string::npos) << list;
}

// The same of a print, which is drawn in tiles: its lines are over the picture, and in the layer at the same pixels.
TEST_F(LinesProgram, AreALayerOfPrints)
{
    writeTrail();
    const auto print = [&](const std::string& output, std::vector<std::string> more)
    {
        more.insert(more.begin(), {"plain.json", "-o", output, "--work", "work", "--size", "6.4x3.6in@75dpi",
                                   "--quiet", "--lines", "lines.geojson", "--style", "style.json"});
        const ProgramResult result = run("osggeofx_panorama", more);
        EXPECT_EQ(result.exitCode, 0) << result.standardError;
        return osgDB::readRefImageFile(file(output));
    };
    const osg::ref_ptr<osg::Image> picture = print("print.png", {"--layers", "layers", "--bits", "16"});
    const osg::ref_ptr<osg::Image> layer = osgDB::readRefImageFile(file("layers/lines.png"));
    ASSERT_TRUE(picture && layer);
    ASSERT_EQ(picture->s(), WIDTH);
    ASSERT_EQ(layer->s(), WIDTH);
    int drawn = 0;
    for (int y = 0; y < HEIGHT; ++y)
        for (int x = 0; x < WIDTH; ++x)
        {
            const auto column = static_cast<unsigned int>(x), row = static_cast<unsigned int>(y);
            const osg::Vec4 color = picture->getColor(column, row);
            const bool magenta = color.r() > 0.9f && color.g() < 0.2f && color.b() > 0.9f;
            drawn += magenta ? 1 : 0;
            // Edges are anything between.
            const float opacity = layer->getColor(column, row).a();
            EXPECT_TRUE(opacity <= 0.97f || magenta) << x << ", " << y;
            EXPECT_TRUE(opacity >= 0.5f || !magenta) << x << ", " << y;
        }
    EXPECT_GT(drawn, 150);
    // Without layers the scene draws the lines; they lie at the same pixels.
    const osg::ref_ptr<osg::Image> usual = print("usual.png", {});
    ASSERT_TRUE(usual);
    EXPECT_GT(magentaIn(*usual), 0.6 * drawn);
    EXPECT_LT(magentaIn(*usual), 3.0 * drawn);
}

// A web page has lines even where the picture has them as vectors.
TEST_F(LinesProgram, AreOnTheWebPageBesideVectors)
{
    writeTrail();
    const auto linesOf = [&](const std::string& output, std::vector<std::string> more)
    {
        more.insert(more.begin(), {"plain.json", "-o", output, "--lines", "lines.geojson", "--style",
                                   "style.json", "--web", "page"});
        const ProgramResult result = panorama(more);
        EXPECT_EQ(result.exitCode, 0) << result.standardError;
        int count = 0;
        // The tiles of the picture's own size.
        for (const auto& entry : fs::recursive_directory_iterator(file("page/tiles/1")))
            if (entry.is_regular_file()) count += magentaIn(*osgDB::readRefImageFile(entry.path().string()));
        return count;
    };
    const int usual = linesOf("map.png", {});
    EXPECT_GT(usual, 150);
    // The GPU's lines have hard edges here, and those of vectors soft ones.
    EXPECT_GT(linesOf("map.png", {"--svg", "map.svg"}), 0.5 * usual);
    if (!geofx::test::fullTest()) return;
    EXPECT_GT(linesOf("map.pdf", {}), 0.5 * usual);
}

// A PDF is the picture with its names and lines, which are letters and paths.
TEST_F(LinesProgram, APdfIsThePictureWithVectors)
{
    const std::vector<osg::Vec2d> places = placesOf({{150, 200}, {300, 215}, {220, 240}});
    writeLine("trail", places[0], places[1]);
    write("names.geojson", collection(pointFeature("Zirbenhütte", "hut", places[2])));
    const auto make = [&](const std::string& output)
    {
        return run("osggeofx_panorama", {"plain.json", "-o", output, "--lines", "lines.geojson", "--labels",
                                         "names.geojson", "--style", "style.json", "--samples", "0",
                                         "--quiet", "--work", "work", "--size", "6.4x3.6in@75dpi"});
    };
    const ProgramResult pdf = make("map.pdf");
    ASSERT_EQ(pdf.exitCode, 0) << pdf.standardError;
    EXPECT_EQ(pdf.standardError, "");
    EXPECT_FALSE(fs::exists(file("map.tiles")) || fs::exists(file("map.unfinished.jpg")));
    EXPECT_FALSE(fs::exists(file("map.unfinished.pdf")));
    ASSERT_EQ(make("map.png").exitCode, 0);

    const auto poppler = [&](const std::string& program, std::vector<std::string> arguments)
    {
        arguments.insert(arguments.begin(), "/usr/bin/" + program);
        geofx::test::ProgramOptions options;
        options.folder = fs::path(_folder.path()).string();
        return geofx::test::runProgram(arguments, options);
    };
    EXPECT_NE(poppler("pdftotext", {"map.pdf", "-"}).standardOutput.find("Zirbenhütte"), std::string::npos);
    EXPECT_NE(poppler("pdfinfo", {"map.pdf"}).standardOutput.find("460.8 x 259.2 pts"), std::string::npos)
        << "6.4 x 3.6 inches";
    const std::string images = poppler("pdfimages", {"-list", "map.pdf"}).standardOutput;
    EXPECT_NE(images.find("480   270"), std::string::npos) << images;
    EXPECT_NE(images.find("jpeg"), std::string::npos) << images;
    ASSERT_EQ(poppler("pdftoppm", {"-r", "75", "-png", "-singlefile", "map.pdf", "page"}).exitCode, 0);
    const osg::ref_ptr<osg::Image> page = osgDB::readRefImageFile(file("page.png"));
    const osg::ref_ptr<osg::Image> picture = osgDB::readRefImageFile(file("map.png"));
    ASSERT_TRUE(page && picture);
    ASSERT_EQ(page->s(), picture->s());
    ASSERT_EQ(page->t(), picture->t());
    // A JPEG's loss in single pixels depends on how rough the picture is. It hardly changes means over small squares.
    const osg::ref_ptr<osgDB::Options> quality = new osgDB::Options("JPEG_QUALITY 75");
    ASSERT_TRUE(osgDB::writeImageFile(*picture, file("alone.jpg"), quality));
    const osg::ref_ptr<osg::Image> alone = osgDB::readRefImageFile(file("alone.jpg"));
    ASSERT_TRUE(alone && alone->s() == picture->s() && alone->t() == picture->t());
    double loss = 0.0, single = 0.0;
    constexpr int square = 10, columns = WIDTH / square, squares = columns * (HEIGHT / square);
    std::vector<std::array<int, 3>> sums(squares);
    int both = 0, either = 0;
    for (int y = 0; y < page->t(); ++y)
        for (int x = 0; x < page->s(); ++x)
        {
            const bool here = isMagenta(*page, x, y), there = isMagenta(*picture, x, y);
            both += here && there ? 1 : 0;
            either += here || there ? 1 : 0;
            auto& sum = sums.at(static_cast<std::size_t>(y / square * columns + x / square));
            for (unsigned int channel = 0; channel < 3; ++channel)
            {
                const int right = picture->data(x, y)[channel];
                const int off = static_cast<int>(page->data(x, y)[channel]) - right;
                sum.at(channel) += off;
                single += std::abs(off);
                loss += std::abs(static_cast<int>(alone->data(x, y)[channel]) - right);
            }
        }
    double difference = 0.0;
    for (const auto& sum : sums)
        for (const int each : sum)
            difference += std::abs(each) / (3.0 * square * square * squares);
    EXPECT_LT(difference, 2.0) << "of 255";
    EXPECT_LT(single, 1.1 * loss) << "more than a JPEG loses";
    EXPECT_GT(both, 0.6 * either);
    EXPECT_GT(both, 400);
}

// Scenes of any kind; a line that no style shows is not there.
TEST_F(LinesProgram, AreOnPicturesOfAnyScene)
{
    const std::vector<osg::Vec2d> ends = placesOf({{150, 200}, {300, 215}});
    ASSERT_EQ(run("osggeofx_build", {"--dem", "volcano.tif", "-o", "db"}).exitCode, 0);
    const auto render = [&](const std::string& style)
    {
        writeLine(style, ends[0], ends[1]);
        const ProgramResult result =
            run("osggeofx_render", {"db/terrain.osgb", "-o", "scene.png", "--size", "480x270", "--lines",
                                    "lines.geojson", "--style", "style.json", "--effect", "birdsEyeView"});
        EXPECT_EQ(result.exitCode, 0) << result.standardError;
        return osgDB::readRefImageFile(file("scene.png"));
    };
    EXPECT_GT(magentaIn(*render("trail")), 40);
    EXPECT_EQ(magentaIn(*render("secret")), 0);
}

TEST_F(LinesProgram, FaultsAreSentences)
{
    writeLine("trail", {100.0, -80.0}, {100.1, -80.0});
    const auto faultOf = [&](std::vector<std::string> more)
    {
        more.insert(more.begin(), {"plain.json", "-o", "map.png"});
        const ProgramResult result = panorama(more);
        EXPECT_EQ(result.exitCode, 2) << result.standardError;
        EXPECT_FALSE(fs::exists(file("map.png")));
        return result.standardError;
    };
    const auto has = [](const std::string& text, const std::string& part)
    {
        EXPECT_NE(text.find(part), std::string::npos) << text;
    };
    has(faultOf({"--lines", "lines.geojson"}), "lie beside the terrain");
    has(faultOf({"--lines", "none.gpkg"}), "none.gpkg");
    const ProgramResult bits = panorama({"plain.json", "-o", "map.jpg", "--bits", "16"});
    EXPECT_EQ(bits.exitCode, 2);
    has(bits.standardError, "write png, tiff or exr");
    has(faultOf({"--geojson", "picture.geojson"}), "give some with --labels or --lines");
    has(faultOf({"--lines", "lines.geojson", "--svg", "none/map.svg"}), "none/map.svg");
    write("bad.json", R"({"lines": {"trail": {"widht": 2}}})");
    has(faultOf({"--lines", "lines.geojson", "--style", "bad.json"}), "\"widht\" is not known");
    write("bad.json", R"({"lines": {"trail": {"width": 0}}})");
    has(faultOf({"--lines", "lines.geojson", "--style", "bad.json"}), "must be a number from");
    write("bad.json", R"({"roads": {}})");
    has(faultOf({"--lines", "lines.geojson", "--style", "bad.json"}), "is no style file");
    write("bad.json", R"({"lines": {}, "lineField": "grade"})");
    has(faultOf({"--lines", "lines.geojson", "--style", "bad.json"}), "no field \"grade\"");
}
