// SPDX-License-Identifier: MIT
// SPDX-FileCopyrightText: 2026 the osgGeoFX authors
//
// The folder of a web page: its tiles, its data, and what it refuses.
#include <osgGeoFX/web/WebPage.h>
#include <tools/TempDir.h>

#include <OpenImageIO/imageio.h>
#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

#include <cmath>
#include <filesystem>
#include <fstream>
#include <functional>
#include <iterator>
#include <optional>
#include <regex>
#include <set>
#include <string>
#include <vector>

using geofx::test::TempDir;
using osgGeoFX::WebName;
using osgGeoFX::WebPage;
using osgGeoFX::WebPlaces;

namespace fs = std::filesystem;

namespace
{

struct Picture
{
    int width = 0, height = 0, channels = 3;
    std::vector<unsigned char> pixels;

    int at(int x, int y, int channel) const
    {
        return pixels[static_cast<std::size_t>((y * width + x) * channels + channel)];
    }
};

Picture drawn(int width, int height, int channels, const std::function<int(int, int, int)>& value)
{
    Picture picture{width, height, channels, {}};
    for (int y = 0; y < height; ++y)
        for (int x = 0; x < width; ++x)
            for (int channel = 0; channel < channels; ++channel)
                picture.pixels.push_back(static_cast<unsigned char>(value(x, y, channel)));
    return picture;
}

void write(const Picture& picture, const fs::path& file)
{
    const auto output = OIIO::ImageOutput::create(file.string());
    ASSERT_TRUE(output);
    ASSERT_TRUE(output->open(file.string(), OIIO::ImageSpec(picture.width, picture.height, picture.channels,
                                                            OIIO::TypeDesc::UINT8)));
    ASSERT_TRUE(output->write_image(OIIO::TypeDesc::UINT8, picture.pixels.data()));
    ASSERT_TRUE(output->close());
}

Picture read(const fs::path& file)
{
    const auto input = OIIO::ImageInput::open(file.string());
    if (!input)
    {
        ADD_FAILURE() << file << ": " << OIIO::geterror();
        return {};
    }
    Picture picture{input->spec().width, input->spec().height, input->spec().nchannels, {}};
    picture.pixels.resize(static_cast<std::size_t>(picture.width * picture.height * picture.channels));
    EXPECT_TRUE(input->read_image(0, 0, 0, picture.channels, OIIO::TypeDesc::UINT8, picture.pixels.data()));
    return picture;
}

std::string bytes(const fs::path& file)
{
    std::ifstream stream(file, std::ios::binary);
    return {std::istreambuf_iterator<char>(stream), std::istreambuf_iterator<char>()};
}

nlohmann::json dataOf(const fs::path& folder, const std::string& key)
{
    const std::string text = bytes(folder / "data" / (key + ".js")), before = "geofx.data." + key + " = ";
    EXPECT_EQ(text.compare(0, before.size(), before), 0) << text.substr(0, 100);
    EXPECT_EQ(text.substr(text.size() - 2), ";\n");
    return nlohmann::json::parse(text.substr(before.size(), text.size() - before.size() - 2));
}

/// A level of a page's tiles, put together. A tile's last column and last row are the first ones of its neighbors, too.
Picture levelOf(const fs::path& folder, int level, int width, int height)
{
    Picture whole{width, height, 3, std::vector<unsigned char>(static_cast<std::size_t>(3 * width * height))};
    for (int column = 0; 256 * column < width; ++column)
    {
        for (int row = 0; 256 * row < height; ++row)
        {
            const Picture tile = read(folder / "tiles" / std::to_string(level) / std::to_string(column) /
                                      (std::to_string(row) + ".jpg"));
            EXPECT_EQ(tile.width, std::min(257, width - 256 * column));
            EXPECT_EQ(tile.height, std::min(257, height - 256 * row));
            EXPECT_EQ(tile.channels, 3);
            for (int y = 0; y < tile.height; ++y)
                for (int x = 0; x < tile.width; ++x)
                    // Twice, where two tiles have a pixel.
                    for (int channel = 0; channel < 3; ++channel)
                        whole.pixels[static_cast<std::size_t>(
                            3 * ((256 * row + y) * width + 256 * column + x) + channel)] =
                            static_cast<unsigned char>(tile.at(x, y, channel));
        }
    }
    return whole;
}

/// The byte of the mean light of a square of pixels, worked out in sRGB's own terms.
double meanOf(const Picture& picture, int left, int top, int side, int channel)
{
    double light = 0.0;
    int count = 0;
    for (int y = top; y < std::min(top + side, picture.height); ++y)
    {
        for (int x = left; x < std::min(left + side, picture.width); ++x)
        {
            const double code = picture.at(x, y, channel) / 255.0;
            light += code <= 0.04045 ? code / 12.92 : std::pow((code + 0.055) / 1.055, 2.4);
            ++count;
        }
    }
    light /= count;
    return 255.0 * (light <= 0.0031308 ? 12.92 * light : 1.055 * std::pow(light, 1.0 / 2.4) - 0.055);
}

class WebPageTest : public testing::Test
{
protected:
    /// Writes a page of a picture that need not be looked at.
    std::string faultOf(WebPage::Options options, const std::string& folder)
    {
        if (options.picture.empty())
        {
            write(drawn(40, 30, 3, [](int x, int y, int) { return x + y; }), _folder / "small.png");
            options.picture = (_folder / "small.png").string();
        }
        std::string error;
        const bool good = WebPage::write(options, (_folder / folder).string(), error);
        EXPECT_EQ(good, error.empty());
        return error;
    }
    fs::path path(const std::string& name) const { return _folder / name; }

    TempDir _folder;
};

} // namespace

// Each level has the light of the picture. Finest stripes of black and white are where means of bytes would be far darker.
TEST_F(WebPageTest, TilesHaveThePicturesLightAtEachZoom)
{
    const int width = 1111, height = 777;
    const Picture picture =
        drawn(width, height, 3,
              [&](int x, int y, int channel)
              {
                  if (x < 512) return (x + y) % 2 ? 255 : 0;
                  return channel == 0 ? 40 + x / 8 : channel == 1 ? 30 + y / 4 : 200 - x / 10;
              });
    write(picture, path("picture.png"));
    WebPage::Options options;
    options.picture = path("picture.png").string();
    ASSERT_EQ(faultOf(options, "page"), "");
    EXPECT_EQ(dataOf(path("page"), "picture")["zoom"], 3);
    EXPECT_EQ(dataOf(path("page"), "picture")["width"], width);
    EXPECT_EQ(dataOf(path("page"), "picture")["height"], height);
    int levelWidth = width, levelHeight = height;
    for (int level = 3; level >= 0; --level)
    {
        const int side = 1 << (3 - level);
        const Picture tiles = levelOf(path("page"), level, levelWidth, levelHeight);
        double worst = 0.0;
        for (int y = 0; y < levelHeight; ++y)
        {
            for (int x = 0; x < levelWidth; ++x)
            {
                // JPEG's blocks of eight pixels smear what meets in one, and make noise of the finest stripes themselves.
                if (std::abs(x * side - 512) < 10 * side || (level == 3 && x < 512)) continue;
                for (int channel = 0; channel < 3; ++channel)
                    worst = std::max(worst, std::abs(tiles.at(x, y, channel) -
                                                     meanOf(picture, x * side, y * side, side, channel)));
            }
        }
        EXPECT_LE(worst, 4.0) << "level " << level;
        levelWidth = (levelWidth + 1) / 2;
        levelHeight = (levelHeight + 1) / 2;
    }
    EXPECT_FALSE(fs::exists(path("page/tiles/4")));
    EXPECT_FALSE(fs::exists(path("page/tiles/3/5")));
    EXPECT_FALSE(fs::exists(path("page/tiles/3/0/4.jpg")));
}

// Also where a whole number of tiles leaves nothing, or a single pixel, and the pixels that tiles share are the same.
TEST_F(WebPageTest, TilesShareTheirBorders)
{
    for (const auto& [width, height] : {std::pair(512, 256), std::pair(513, 257), std::pair(256, 600)})
    {
        const auto value = [](int x, int y, int channel)
        {
            return channel == 2 ? 90 : (channel == 0 ? x : y) * 200 / 600 + 20;
        };
        write(drawn(width, height, 3, value), path("picture.png"));
        WebPage::Options options;
        options.picture = path("picture.png").string();
        ASSERT_EQ(faultOf(options, "page"), "");
        const int level = dataOf(path("page"), "picture")["zoom"];
        const Picture whole = levelOf(path("page"), level, width, height);
        for (int y = 0; y < height; ++y)
            for (int x = 0; x < width; ++x)
                for (int channel = 0; channel < 3; ++channel)
                    ASSERT_NEAR(whole.at(x, y, channel), value(x, y, channel), 3) << x << "," << y;
        int tiles = 0;
        for (const auto& entry : fs::recursive_directory_iterator(path("page/tiles") / std::to_string(level)))
            tiles += entry.is_regular_file() ? 1 : 0;
        EXPECT_EQ(tiles, ((width + 255) / 256) * ((height + 255) / 256));
    }
    const Picture upper = read(path("page/tiles/2/0/0.jpg")), lower = read(path("page/tiles/2/0/1.jpg"));
    for (int x = 0; x < 256; ++x)
        EXPECT_NEAR(upper.at(x, 256, 1), lower.at(x, 0, 1), 3);
}

TEST_F(WebPageTest, PicturesMayBeGrayOrHaveAnotherChannel)
{
    for (const int channels : {1, 2, 4})
    {
        write(drawn(300, 20, channels,
                    [](int x, int, int channel) { return channel == 3 ? 255 : 20 + x / 2 + 10 * channel; }),
              path("picture.tif"));
        WebPage::Options options;
        options.picture = path("picture.tif").string();
        ASSERT_EQ(faultOf(options, "page"), "");
        const Picture tiles = levelOf(path("page"), 1, 300, 20);
        for (int channel = 0; channel < 3; ++channel)
            EXPECT_NEAR(tiles.at(200, 10, channel), 120 + (channels == 4 ? 10 * channel : 0), 3) << channels;
    }
}

TEST_F(WebPageTest, NamesAndTextsArriveWhole)
{
    WebPage::Options options;
    options.title = "A <b> & \"B\"";
    options.attribution = "© Names <script>";
    WebName name;
    name.text = "Pu\"ʻu\\ </script>\n\xff";
    name.style = "hut";
    name.look.manner = osgGeoFX::LabelCandidate::BESIDE;
    name.look.text.color.set(1.0f, 0.0f, 0.5f, 1.0f);
    name.anchor.set(12.25, 7.5);
    name.size.set(50.0, 14.0);
    name.longitude = -157.8106;
    name.latitude = 21.26;
    name.height = 231.7;
    name.shown = {{2, 5, {3.0, -20.0}}, {6, 8, {-1.5, -18.0}}};
    WebName river;
    river.text = "River";
    river.alongCurve = true;
    river.curve = {{1.0, 2.0}, {30.0, 4.0}};
    options.names = {name, river};
    ASSERT_EQ(faultOf(options, "page"), "");
    const nlohmann::json json = dataOf(path("page"), "names");
    EXPECT_EQ(json["stepsOfZoom"], 4);
    ASSERT_EQ(json["names"].size(), 2u);
    const nlohmann::json& first = json["names"][0];
    EXPECT_EQ(first["text"], "Pu\"ʻu\\ </script>\n\xEF\xBF\xBD");
    EXPECT_EQ(first["at"], nlohmann::json({12.25, 7.5}));
    EXPECT_EQ(first["size"], nlohmann::json({50.0, 14.0}));
    EXPECT_EQ(first["place"], nlohmann::json({-157.8106, 21.26}));
    EXPECT_EQ(first["height"], 232);
    EXPECT_EQ(first["shown"], nlohmann::json::parse("[[2,5,3.0,-20.0],[6,8,-1.5,-18.0]]"));
    EXPECT_FALSE(first.contains("curve"));
    EXPECT_EQ(json["names"][1]["curve"], nlohmann::json::parse("[[1.0,2.0],[30.0,4.0]]"));
    EXPECT_FALSE(json["names"][1].contains("place"));
    EXPECT_FALSE(json["names"][1].contains("height"));
    EXPECT_EQ(json["styles"]["hut"]["color"], "#ff0080ff");
    EXPECT_EQ(json["styles"]["hut"]["leader"], false);
    const std::string page = bytes(path("page/index.html"));
    EXPECT_NE(page.find("<title>A &lt;b&gt; &amp; &quot;B&quot;</title>"), std::string::npos);
    EXPECT_NE(page.find("© Names &lt;script&gt;"), std::string::npos);
    EXPECT_EQ(page.find("{{"), std::string::npos);
}

// Whatever the page names lies beside it, and it runs nothing that stands in the page itself.
TEST_F(WebPageTest, ThePageNeedsNothingFromElsewhere)
{
    ASSERT_EQ(faultOf({}, "page"), "");
    const std::string page = bytes(path("page/index.html"));
    const std::regex reference("(?:src|href)=\"([^\"]*)\"");
    int files = 0;
    for (auto i = std::sregex_iterator(page.begin(), page.end(), reference); i != std::sregex_iterator(); ++i)
    {
        const std::string to = (*i)[1];
        if (to.compare(0, 5, "data:") == 0) continue;
        EXPECT_TRUE(fs::is_regular_file(path("page") / to)) << to;
        ++files;
    }
    EXPECT_GE(files, 8);
    EXPECT_NE(page.find("Content-Security-Policy"), std::string::npos);
    EXPECT_EQ(page.find("unsafe"), std::string::npos);
    EXPECT_FALSE(std::regex_search(page, std::regex("<script(?![^>]*src=)|<style|\\son[a-z]+=|\\sstyle=")));
    const std::string leaflet = bytes(path("page/leaflet/leaflet.js"));
    EXPECT_GT(leaflet.size(), 100000u);
    EXPECT_EQ(leaflet.find("sourceMappingURL"), std::string::npos);
    EXPECT_NE(bytes(path("page/leaflet/LICENSE.txt")).find("Redistribution and use"), std::string::npos);
}

namespace
{

/// Reads what data/places.js says, by its description alone.
struct Grid
{
    explicit Grid(const nlohmann::json& data)
        : columns(data["columns"]), rows(data["rows"]), first(data["first"]), step(data["step"]),
          squares(data["squares"])
    {
        const std::string text = data["samples"];
        std::size_t at = 0;
        const auto number = [&]
        {
            std::int64_t value = 0;
            for (int shift = 0;; shift += 5)
            {
                const std::int64_t digit = digitOf(text.at(at++));
                value |= (digit & 31) << shift;
                if (digit < 32) return value;
            }
        };
        std::array<std::int64_t, 3> last = {0, 0, 0};
        const int count = columns * rows;
        values.resize(static_cast<std::size_t>(count));
        const auto sample = [&](int i)
        {
            return i < 0 ? std::nullopt : values[static_cast<std::size_t>(i)];
        };
        for (int i = 0; i < count;)
        {
            if (text.at(at) == '.')
            {
                ++at;
                i += static_cast<int>(number());
                continue;
            }
            const auto left = i % columns ? sample(i - 1) : std::nullopt, upper = sample(i - columns),
                       corner = i % columns ? sample(i - columns - 1) : std::nullopt;
            for (std::size_t k = 0; k < 3; ++k)
            {
                const std::int64_t coded = number(), difference = coded & 1 ? -(coded >> 1) - 1 : coded >> 1;
                last[k] = difference + (left && upper && corner ? (*left)[k] + (*upper)[k] - (*corner)[k]
                                        : left                  ? (*left)[k]
                                        : upper                 ? (*upper)[k]
                                                                : last[k]);
            }
            values[static_cast<std::size_t>(i++)] = last;
        }
        EXPECT_EQ(at, text.size());
    }
    static std::int64_t digitOf(char c)
    {
        return static_cast<std::int64_t>(
            std::string("ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789-_").find(c));
    }
    bool isEven(int column, int row) const
    {
        const int bit = row * (columns - 1) + column;
        return (digitOf(squares.at(static_cast<std::size_t>(bit / 6))) >> bit % 6 & 1) != 0;
    }

    int columns, rows, first, step;
    std::string squares;
    std::vector<std::optional<std::array<std::int64_t, 3>>> values; ///< steps of 1e-5 degrees, and metres
};

} // namespace

// A near slope below a ridge, a far one behind it, beyond the antimeridian, and the sky.
TEST_F(WebPageTest, PlacesAreThoseOfThePicture)
{
    WebPage::Options options;
    options.places.width = 640;
    options.places.height = 360;
    const auto ridge = [](int x)
    {
        return 200.0 + 30.0 * std::sin(x / 70.0);
    };
    options.places.at = [&](int x, int y) -> std::optional<WebPlaces::Place>
    {
        if (y < 60) return std::nullopt;
        const double east = 179.99 + x * 1e-4,
                     north = y < ridge(x) ? -16.0 + (360 - y) * 1e-4 : -16.2 + (360 - y) * 2e-4;
        return WebPlaces::Place{east > 180.0 ? east - 360.0 : east, north, 0.02 * (y - 60) * (y - 60)};
    };
    ASSERT_EQ(faultOf(options, "page"), "");
    const nlohmann::json json = dataOf(path("page"), "places");
    EXPECT_EQ(json["width"], 640);
    EXPECT_EQ(json["height"], 360);
    EXPECT_EQ(json["unit"], 1e-5);
    const Grid grid(json);
    ASSERT_EQ(grid.step % 2, 0);
    ASSERT_EQ(grid.columns, (640 - 1 - grid.first) / grid.step + 1);
    ASSERT_EQ(grid.rows, (360 - 1 - grid.first) / grid.step + 1);
    int sky = 0, edges = 0, even = 0;
    for (int row = 0; row < grid.rows; ++row)
    {
        for (int column = 0; column < grid.columns; ++column)
        {
            const int x = grid.first + column * grid.step, y = grid.first + row * grid.step;
            const auto expected = options.places.at(x, y);
            const auto& value = grid.values[static_cast<std::size_t>(row * grid.columns + column)];
            ASSERT_EQ(value.has_value(), expected.has_value()) << x << "," << y;
            if (!value)
            {
                ++sky;
                continue;
            }
            EXPECT_NEAR(static_cast<double>((*value)[0]) * 1e-5, expected->longitude, 0.51e-5);
            EXPECT_NEAR(static_cast<double>((*value)[1]) * 1e-5, expected->latitude, 0.51e-5);
            EXPECT_NEAR(static_cast<double>((*value)[2]), expected->height, 0.51);
            if (column + 1 == grid.columns || row + 1 == grid.rows) continue;
            // Whether the ridge's edge goes through the square: then no mean of its corners is a place of the picture.
            bool above = false, below = false;
            for (int i = 0; i <= grid.step; ++i)
                for (int k = 0; k <= grid.step; ++k)
                    (y + k < ridge(x + i) ? above : below) = true;
            EXPECT_EQ(grid.isEven(column, row), !(above && below)) << x << "," << y;
            (above && below ? edges : even) += 1;
        }
    }
    EXPECT_GT(sky, 1000);
    EXPECT_GT(edges, 100);
    EXPECT_GT(even, 10000);
}

// The text is made for pictures of any size, and has no more samples than a page loads quickly.
TEST_F(WebPageTest, PlacesStayFew)
{
    for (const auto& [width, height] :
         {std::pair(1, 1), std::pair(2, 3), std::pair(3000, 40), std::pair(1500, 1000)})
    {
        WebPage::Options options;
        options.places.width = width;
        options.places.height = height;
        options.places.at = [](int x, int y)
        {
            return WebPlaces::Place{x * 1e-3, y * 1e-3, 5.0};
        };
        ASSERT_EQ(faultOf(options, "page"), "");
        const Grid grid(dataOf(path("page"), "places"));
        EXPECT_LE(grid.columns * grid.rows, 100000);
        EXPECT_LT(fs::file_size(path("page/data/places.js")), 700000u);
    }
}

TEST_F(WebPageTest, ReplacesAFormerPageAndNothingElse)
{
    WebPage::Options options;
    write(drawn(600, 300, 3, [](int, int, int) { return 99; }), path("large.png"));
    options.picture = path("large.png").string();
    ASSERT_EQ(faultOf(options, "page"), "");
    EXPECT_TRUE(fs::exists(path("page/tiles/2/2/1.jpg")));
    EXPECT_EQ(faultOf({}, "page/"), "") << "a former page, with a slash";
    EXPECT_FALSE(fs::exists(path("page/tiles/2"))) << "of the former one";
    fs::create_directory(path("empty"));
    EXPECT_EQ(faultOf({}, "empty"), "");
    fs::create_directory_symlink("empty", path("link"));
    EXPECT_EQ(faultOf({}, "link"), "");
    EXPECT_TRUE(fs::is_symlink(path("link"))) << "what it leads to is replaced";

    const auto refused =
        [&](const std::string& folder, const std::string& why, const WebPage::Options& asked = {})
    {
        const std::string error = faultOf(asked, folder);
        EXPECT_NE(error.find(why), std::string::npos) << folder << ": " << error;
        EXPECT_EQ(error.back(), '.');
    };
    _folder.write("notes/mine.txt", "mine");
    refused("notes", "no page of osgGeoFX");
    EXPECT_EQ(bytes(path("notes/mine.txt")), "mine");
    _folder.write("page/mine.txt", "mine");
    refused("page", "\"mine.txt\"");
    EXPECT_EQ(bytes(path("page/mine.txt")), "mine");
    EXPECT_TRUE(fs::exists(path("page/index.html")));
    _folder.write("file", "mine");
    refused("file", "is a file");
    refused("none/page", "no folder");
    WebPage::Options without;
    without.leaflet = path("notes").string();
    refused("other", "install libjs-leaflet", without);
    EXPECT_NE(WebPage::faultOf(path("other").string(), path("notes").string()).find("libjs-leaflet"),
              std::string::npos);

    // A page that cannot be finished leaves the former one as it was.
    WebPage::Options broken;
    broken.picture = path("file").string();
    refused("empty", "cannot be read", broken);
    EXPECT_TRUE(fs::exists(path("empty/index.html")));
    // Nothing is left beside them, and what others have there stays.
    std::set<std::string> names;
    for (const auto& entry : fs::directory_iterator(_folder.path()))
        names.insert(entry.path().filename().string());
    EXPECT_EQ(names,
              (std::set<std::string>{"page", "empty", "link", "notes", "file", "large.png", "small.png"}));
    // A server of another user may read it.
    EXPECT_EQ(fs::status(path("empty")).permissions(), fs::status(path("notes")).permissions());
}
