// SPDX-License-Identifier: MIT
// SPDX-FileCopyrightText: 2026 the osgGeoFX authors
//
// Prints in tiles against the picture drawn at once, names and all; interrupted ones; sizes as people write them.
#include <osgGeoFX/deformation/BirdsEyeView.h>
#include <osgGeoFX/labels/LabelPicture.h>
#include <osgGeoFX/lines/MapLines.h>
#include <osgGeoFX/panorama/PanoramaMap.h>
#include <osgGeoFX/print/PicturePrint.h>
#include <print/HillsPicture.h>
#include <tools/ImageComparison.h>

#include <OpenImageIO/imageio.h>
#include <osg/Math>
#include <osgDB/ReadFile>

#include <cstdlib>
#include <filesystem>
#include <stdexcept>

using namespace osgGeoFX;
using namespace geofx::test;

namespace fs = std::filesystem;

namespace
{

constexpr int WIDTH = 300, HEIGHT = 200;

class PicturePrintTest : public HillsPicture
{
protected:
    PicturePrintTest() : HillsPicture(WIDTH, HEIGHT) {}

    void SetUp() override
    {
        HillsPicture::SetUp();
        if (IsSkipped() || HasFatalFailure()) return;
        for (int i = 0; i < 60; ++i)
            addName(1000.0 * (i % 8 - 4), 1500.0 * (i / 8 - 3));
    }

    Scene scene(Effect* effect) const override
    {
        Scene result = HillsPicture::scene(effect);
        if (_lines.empty()) return result;
        std::map<std::string, LineStyle> styles;
        styles[""].width = 2.5;
        styles[""].casingWidth = 0.5;
        result.effects->addChild(new MapLines(_lines, styles));
        return result;
    }
    static osg::ref_ptr<PanoramaMap> map()
    {
        osg::ref_ptr<PanoramaMap> result = new PanoramaMap;
        result->setViewRadius(9000.0);
        result->setRipples(0.0);
        return result;
    }
    PicturePrint::Options options(int tile, const osg::ref_ptr<NameSet>& set = nullptr) const
    {
        PicturePrint::Options result;
        result.size = {WIDTH, HEIGHT, 0.0};
        result.tile = tile;
        result.renderer.fieldOfView = 40.0;
        result.names = set;
        result.work = file("tiles");
        return result;
    }

    std::vector<MapLine> _lines;
};

} // namespace

TEST_F(PicturePrintTest, TilesAreThePictureWithItsNames)
{
    const std::vector<osg::ref_ptr<Effect>> effects = {nullptr, new BirdsEyeView, map()};
    for (const osg::ref_ptr<Effect>& effect : effects)
    {
        SCOPED_TRACE(effect ? effect->className() : "plain");
        const osg::ref_ptr<osg::Image> expected = atOnce(effect, names());
        Scene printed = scene(effect);
        std::string error;
        int tiles = 0;
        PicturePrint::Options how = options(60, names());
        how.progress = [&](int done, int all)
        {
            EXPECT_EQ(all, 20);
            EXPECT_EQ(done, ++tiles);
        };
        ASSERT_TRUE(PicturePrint::write(printed, how, _view, file("print.png"), error)) << error;
        EXPECT_EQ(tiles, 20);
        EXPECT_FALSE(fs::exists(file("tiles"))) << "nothing is left behind";
        const osg::ref_ptr<osg::Image> print = osgDB::readRefImageFile(file("print.png"));
        ASSERT_TRUE(print);
        EXPECT_TRUE(imagesMatch(*print, *expected, {1.1f / 255.0f, 0.0, 1.0f}, "print"));

        // No side of tiles fits 300 x 200 pixels evenly here, so where an edge of a stroke runs through a pixel's middle, rounding decides.
        Scene uneven = scene(effect);
        how = options(190, names());
        how.size = {299, 199, 0.0};
        ASSERT_TRUE(PicturePrint::write(uneven, how, _view, file("uneven.png"), error)) << error;
        how.tile = 512;
        Scene whole = scene(effect);
        ASSERT_TRUE(PicturePrint::write(whole, how, _view, file("whole.png"), error)) << error;
        EXPECT_TRUE(imagesMatch(*osgDB::readRefImageFile(file("uneven.png")),
                                *osgDB::readRefImageFile(file("whole.png")), {1.1f / 255.0f, 0.015, 1.0f},
                                "uneven"));
    }
}

// Lines cross the borders of tiles with the width and the place that they have in the whole picture.
TEST_F(PicturePrintTest, TilesHaveTheLinesOfThePicture)
{
    for (int i = -3; i <= 3; ++i)
    {
        MapLine line;
        for (int k = -20; k <= 20; ++k)
            line.places.push_back(_hills.middle() + _east * (400.0 * k) + _north * (2000.0 * i + 40.0 * k) +
                                  _up * 1600.0);
        _lines.push_back(line);
    }
    const osg::ref_ptr<Effect> bend = new BirdsEyeView;
    const osg::ref_ptr<osg::Image> expected = atOnce(bend, nullptr);
    Scene printed = scene(bend);
    std::string error;
    ASSERT_TRUE(PicturePrint::write(printed, options(60), _view, file("lines.png"), error)) << error;
    const osg::ref_ptr<osg::Image> image = osgDB::readRefImageFile(file("lines.png"));
    ASSERT_TRUE(image);
    EXPECT_TRUE(imagesMatch(*image, *expected, {1.1f / 255.0f, 0.0, 1.0f}, "lines"));
    _lines.clear();
    EXPECT_FALSE(imagesMatch(*image, *atOnce(bend, nullptr), {1.1f / 255.0f, 0.0, 1.0f}, "no lines"));
}

TEST_F(PicturePrintTest, GoesOnWhereItWasInterrupted)
{
    const osg::ref_ptr<PanoramaMap> effect = map();
    Scene first = scene(effect);
    PicturePrint::Options how = options(100);
    how.recipe = "one";
    how.progress = [](int done, int)
    {
        if (done == 3) throw std::runtime_error("interrupted.");
    };
    std::string error;
    EXPECT_FALSE(PicturePrint::write(first, how, _view, file("print.tif"), error));
    EXPECT_EQ(error, "interrupted.");
    EXPECT_FALSE(fs::exists(file("print.tif")));
    const fs::path tile = fs::path(file("tiles")) / "tile-0-1.tif";
    ASSERT_TRUE(fs::exists(tile));
    const auto drawn = fs::last_write_time(tile);
    // One that a power cut has left unfinished.
    fs::resize_file(fs::path(file("tiles")) / "tile-0-2.tif", 90);

    how.progress = nullptr;
    const auto lastTimes = [&](const std::string& recipe)
    {
        Scene again = scene(effect);
        how.recipe = recipe;
        fs::file_time_type time;
        how.progress = [&](int done, int all)
        {
            if (done == all) time = fs::last_write_time(tile);
        };
        EXPECT_TRUE(PicturePrint::write(again, how, _view, file("print.tif"), error)) << error;
        return time;
    };
    EXPECT_EQ(lastTimes("one"), drawn) << "the tile was used again";
    const osg::ref_ptr<osg::Image> whole = atOnce(effect, nullptr);
    const auto readBack = [&]
    {
        const auto input = OIIO::ImageInput::open(file("print.tif"));
        EXPECT_TRUE(input);
        std::vector<unsigned char> pixels(3 * WIDTH * HEIGHT);
        EXPECT_TRUE(input->read_image(0, 0, 0, 3, OIIO::TypeDesc::UINT8, pixels.data()));
        return pixels;
    };
    const std::vector<unsigned char> pixels = readBack();
    int off = 0;
    for (int y = 0; y < HEIGHT; ++y)
        for (int i = 0; i < 3 * WIDTH; ++i)
            off += std::abs(pixels[static_cast<std::size_t>(3 * WIDTH * (HEIGHT - 1 - y) + i)] -
                            whole->data(0, static_cast<unsigned int>(y))[i]) > 1
                       ? 1
                       : 0;
    EXPECT_LT(off, 3 * WIDTH * HEIGHT / 300);

    // Tiles of another picture are not used.
    how.progress = [](int done, int)
    {
        if (done == 2) throw std::runtime_error("interrupted.");
    };
    Scene other = scene(effect);
    how.recipe = "one";
    EXPECT_FALSE(PicturePrint::write(other, how, _view, file("print.tif"), error));
    const auto before = fs::last_write_time(tile);
    EXPECT_NE(lastTimes("two"), before);
}

TEST_F(PicturePrintTest, SaysResolutionAndWhatItIs)
{
    Scene printed = scene(nullptr);
    PicturePrint::Options how = options(512);
    how.size.dpi = 200.0;
    how.metadata = {{"Software", "a test"}};
    std::string error;
    ASSERT_TRUE(PicturePrint::write(printed, how, _view, file("print.tif"), error)) << error;
    const auto input = OIIO::ImageInput::open(file("print.tif"));
    ASSERT_TRUE(input);
    EXPECT_EQ(input->spec().get_float_attribute("XResolution"), 200.0f);
    EXPECT_EQ(input->spec().get_string_attribute("ResolutionUnit"), "in");
    EXPECT_EQ(input->spec().get_string_attribute("Software"), "a test");
    // The color profile, the same in each format.
    std::string former;
    for (const char* const name : {"print.tif", "print.png", "print.jpg"})
    {
        SCOPED_TRACE(name);
        if (std::string(name) != "print.tif")
        {
            ASSERT_TRUE(PicturePrint::write(printed, how, _view, file(name), error)) << error;
        }
        const auto picture = OIIO::ImageInput::open(file(name));
        ASSERT_TRUE(picture);
        const OIIO::ParamValue* const profile = picture->spec().find_attribute("ICCProfile");
        ASSERT_TRUE(profile);
        const std::string bytes(static_cast<const char*>(profile->data()),
                                static_cast<std::size_t>(profile->type().size()));
        ASSERT_GT(bytes.size(), 200u);
        EXPECT_EQ(bytes.substr(16, 4), "RGB ");
        EXPECT_EQ(bytes.substr(36, 4), "acsp");
        if (!former.empty())
        {
            EXPECT_TRUE(bytes == former);
        }
        former = bytes;
    }
}

TEST_F(PicturePrintTest, FaultsAreSentences)
{
    const auto faultOf = [&](const std::string& output, const std::string& work)
    {
        Scene printed = scene(nullptr);
        PicturePrint::Options how = options(512);
        how.work = work;
        std::string error;
        EXPECT_FALSE(PicturePrint::write(printed, how, _view, output, error));
        EXPECT_FALSE(error.empty());
        EXPECT_EQ(error.back(), '.');
        return error;
    };
    EXPECT_NE(faultOf(file("print.xyz"), file("tiles")).find("png, tif, jpg or exr"), std::string::npos);
    EXPECT_NE(faultOf(file("none/print.png"), file("tiles")).find("cannot be written"), std::string::npos);
    EXPECT_NE(faultOf(file("print.png"), "/proc/none/tiles").find("cannot be made"), std::string::npos);
}

TEST(PrintSize, IsReadAsPeopleWriteIt)
{
    const auto expectSize = [](const std::string& text, int width, int height, double dpi)
    {
        SCOPED_TRACE(text);
        std::string error;
        const auto size = PrintSize::parse(text, error);
        ASSERT_TRUE(size) << error;
        EXPECT_EQ(size->width, width);
        EXPECT_EQ(size->height, height);
        EXPECT_EQ(size->dpi, dpi);
    };
    expectSize("1600x900", 1600, 900, 0.0);
    expectSize("1600x900@150dpi", 1600, 900, 150.0);
    expectSize("A1@300dpi", 9933, 7016, 300.0); // 841 x 594 mm
    expectSize("A0", 14043, 9933, 300.0);
    expectSize("A4-portrait@72dpi", 595, 842, 72.0);
    expectSize("a4-portrait@72dpi", 595, 842, 72.0);
    expectSize("Letter@300dpi", 3300, 2550, 300.0); // 11 x 8.5 inches
    expectSize("letter-portrait@100dpi", 850, 1100, 100.0);
    expectSize("Legal-portrait", 2550, 4200, 300.0);
    expectSize("TABLOID@100dpi", 1700, 1100, 100.0);
    expectSize("90x60cm@200dpi", 7087, 4724, 200.0);
    expectSize("25.4x12.7cm@100dpi", 1000, 500, 100.0);
    expectSize("36x24in@300dpi", 10800, 7200, 300.0);
    for (const std::string wrong :
         {"", "1600", "A7", "A1@", "A1@dpi", "A1@0dpi", "A1@300", "1600x900px", "x900", "-5x900", "1e3x900",
          "0x900", "A0@99999dpi", "1000000x900", "A1-landscape", "Letters", "Legal-"})
    {
        SCOPED_TRACE(wrong);
        std::string error;
        EXPECT_FALSE(PrintSize::parse(wrong, error));
        EXPECT_EQ(error.rfind(wrong + ": ", 0), 0u);
        EXPECT_EQ(error.back(), '.');
    }
    std::string error;
    EXPECT_FALSE(PrintSize::parse("A0@9000dpi", error));
    EXPECT_NE(error.find("pixels cannot be had"), std::string::npos) << error;
}
