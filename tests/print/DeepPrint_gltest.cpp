// SPDX-License-Identifier: MIT
// SPDX-FileCopyrightText: 2026 the osgGeoFX authors
//
// Prints with 16 bits for each channel: finer than those of 8 bits, and the same picture.
#include <osgGeoFX/closeup/CloseUps.h>
#include <osgGeoFX/deformation/BirdsEyeView.h>
#include <osgGeoFX/panorama/PanoramaMap.h>
#include <osgGeoFX/print/PicturePrint.h>
#include <print/HillsPicture.h>

#include <OpenImageIO/imageio.h>

#include <cmath>
#include <cstdlib>
#include <filesystem>
#include <vector>

using namespace osgGeoFX;
using namespace geofx::test;

namespace fs = std::filesystem;

namespace
{

constexpr int WIDTH = 300, HEIGHT = 200;

class DeepPrint : public HillsPicture
{
protected:
    using Values = std::vector<unsigned short>;

    DeepPrint() : HillsPicture(WIDTH, HEIGHT) {}

    PicturePrint::Options options(int bits, int tile = 512) const
    {
        PicturePrint::Options result;
        result.size = {WIDTH, HEIGHT, 0.0};
        result.bits = bits;
        result.tile = tile;
        result.renderer.fieldOfView = 40.0;
        result.work = file("tiles");
        return result;
    }
    /// A file's values as 16 bits; those of 8 bits are spread.
    Values read(const std::string& name, OIIO::TypeDesc type) const
    {
        const auto input = OIIO::ImageInput::open(file(name));
        Values values(3 * WIDTH * HEIGHT);
        EXPECT_TRUE(input) << name;
        if (!input) return values;
        EXPECT_EQ(input->spec().format, type) << name;
        EXPECT_TRUE(input->read_image(0, 0, 0, 3, OIIO::TypeDesc::UINT16, values.data()));
        return values;
    }
    Values print(Effect* effect, const PicturePrint::Options& how, const std::string& name) const
    {
        Scene printed = scene(effect);
        std::string error;
        EXPECT_TRUE(PicturePrint::write(printed, how, _view, file(name), error)) << error;
        return read(name, how.bits > 8 ? OIIO::TypeDesc::UINT16 : OIIO::TypeDesc::UINT8);
    }
    /// How many values are none that 8 bits have.
    static int fineIn(const Values& values)
    {
        int count = 0;
        for (const unsigned short value : values)
            count += value % 257 != 0 ? 1 : 0;
        return count;
    }
    /// How many values of two pictures differ by more than so many of 65,535.
    static int differing(const Values& a, const Values& b, int tolerance)
    {
        int count = 0;
        for (std::size_t i = 0; i < a.size(); ++i)
            count += std::abs(a[i] - b[i]) > tolerance ? 1 : 0;
        return count;
    }
    osg::ref_ptr<CloseUps> closeUps() const
    {
        const osg::ref_ptr<CloseUp> closeUp = new CloseUp;
        closeUp->getRegion()->setGeodeticCenter(0.4, 0.65);
        closeUp->getRegion()->setSize(5000.0, 5000.0);
        closeUp->setOffset(osg::Vec3d(0.0, 0.0, 1500.0));
        osg::ref_ptr<CloseUps> result = new CloseUps;
        result->addCloseUp(closeUp);
        return result;
    }
    static osg::ref_ptr<PanoramaMap> map()
    {
        osg::ref_ptr<PanoramaMap> result = new PanoramaMap;
        result->setViewRadius(9000.0);
        return result;
    }
};

} // namespace

TEST_F(DeepPrint, IsThePictureOfEightBitsAndFiner)
{
    for (int i = 0; i < 20; ++i)
        addName(1000.0 * (i % 5 - 2), 1500.0 * (i / 5 - 2));
    const osg::ref_ptr<Effect> effects[] = {nullptr, new BirdsEyeView, map(), closeUps()};
    for (const osg::ref_ptr<Effect>& effect : effects)
    {
        for (const unsigned int samples : {0u, 4u})
        {
            SCOPED_TRACE(std::string(effect ? effect->className() : "plain") + ", " +
                         std::to_string(samples));
            PicturePrint::Options how = options(16);
            how.renderer.samples = samples;
            how.names = names();
            const Values deep = print(effect, how, "deep.png");
            how.bits = 8;
            const Values usual = print(effect, how, "usual.png");
            // A byte is half a step off, and means of samples and names are rounded once more.
            EXPECT_LT(differing(deep, usual, 400), 3 * WIDTH * HEIGHT / 300);
            EXPECT_GT(fineIn(deep), 0.7 * 3 * WIDTH * HEIGHT);
            EXPECT_EQ(fineIn(usual), 0);
        }
    }
}

// Layers of close-ups are drawn apart and put onto the picture.
TEST_F(DeepPrint, CloseUpsAreAsFine)
{
    const Values without = print(nullptr, options(16), "without.png");
    const Values with = print(closeUps(), options(16), "with.png");
    int changed = 0, fine = 0;
    for (std::size_t i = 0; i < with.size(); ++i)
    {
        if (std::abs(with[i] - without[i]) < 3 * 257) continue;
        ++changed;
        fine += with[i] % 257 != 0 ? 1 : 0;
    }
    EXPECT_GT(changed, 3000);
    EXPECT_GT(fine, 0.8 * changed);
}

TEST_F(DeepPrint, TilesAreTheWhole)
{
    const osg::ref_ptr<PanoramaMap> effect = map();
    effect->setRipples(0.0);
    const Values whole = print(effect, options(16), "whole.tif");
    const Values tiles = print(effect, options(16, 60), "tiles.tif");
    EXPECT_EQ(differing(whole, tiles, 257), 0);
    EXPECT_LT(differing(whole, tiles, 20), 3 * WIDTH * HEIGHT / 100);
}

// Tiles of one depth are none for a picture of the other one.
TEST_F(DeepPrint, DoesNotGoOnWithTilesOfEightBits)
{
    PicturePrint::Options how = options(8, 100);
    how.progress = [](int done, int)
    {
        if (done == 3) throw std::runtime_error("interrupted.");
    };
    Scene first = scene(nullptr);
    std::string error;
    EXPECT_FALSE(PicturePrint::write(first, how, _view, file("deep.png"), error));
    const fs::path tile = fs::path(file("tiles")) / "tile-0-1.tif";
    ASSERT_TRUE(fs::exists(tile));
    EXPECT_GT(fineIn(print(nullptr, options(16, 100), "deep.png")), 0.7 * 3 * WIDTH * HEIGHT);
}

// OpenEXR has light, as half floats: their step is a 2048th of the value at most.
TEST_F(DeepPrint, OpenExrIsLinear)
{
    const Values codes = print(nullptr, options(16), "print.png");
    Scene printed = scene(nullptr);
    std::string error;
    ASSERT_TRUE(PicturePrint::write(printed, options(8), _view, file("print.exr"), error)) << error;
    const auto input = OIIO::ImageInput::open(file("print.exr"));
    ASSERT_TRUE(input);
    EXPECT_EQ(input->spec().format, OIIO::TypeDesc::HALF);
    std::vector<float> light(codes.size());
    ASSERT_TRUE(input->read_image(0, 0, 0, 3, OIIO::TypeDesc::FLOAT, light.data()));
    int values = 0;
    for (std::size_t i = 0; i < codes.size(); ++i)
    {
        const double code = codes[i] / 65535.0;
        const double expected = code > 0.04045 ? std::pow((code + 0.055) / 1.055, 2.4) : code / 12.92;
        ASSERT_NEAR(static_cast<double>(light[i]), expected, expected / 2000.0 + 1e-6);
        values += code > 0.1 && code < 0.9 ? 1 : 0;
    }
    EXPECT_GT(values, 1000);
}

// What is drawn over a picture lies below its names, and on the plain picture, too.
TEST_F(DeepPrint, OverlaysLieBelowNames)
{
    addName(0.0, 0.0);
    for (const bool drawOver : {true, false})
    {
        PicturePrint::Options how = options(16, 100);
        how.names = names();
        how.drawOver = drawOver;
        how.plain = file("plain.tif");
        int rows = 0;
        how.overlay = [&](osg::Image& image, int top)
        {
            // All rows, but the middle columns only.
            rows += image.t();
            EXPECT_LE(top + image.t(), HEIGHT);
            for (int y = 0; y < image.t(); ++y)
                for (int x = 100; x < 200; ++x)
                    image.setColor(osg::Vec4(1.0f, 0.0f, 1.0f, 1.0f), static_cast<unsigned int>(x),
                                   static_cast<unsigned int>(y));
        };
        const Values picture = print(nullptr, how, "picture.png");
        EXPECT_EQ(rows, drawOver ? 2 * HEIGHT : HEIGHT);
        const Values plain = read("plain.tif", OIIO::TypeDesc::UINT8);
        int magenta = 0, magentaPlain = 0;
        for (std::size_t i = 0; i < picture.size(); i += 3)
        {
            const auto isMagenta = [&](const Values& values)
            {
                return values[i] == 65535 && values[i + 1] == 0 && values[i + 2] == 65535;
            };
            magenta += isMagenta(picture) ? 1 : 0;
            magentaPlain += isMagenta(plain) ? 1 : 0;
        }
        EXPECT_EQ(magentaPlain, 100 * HEIGHT);
        if (drawOver)
        {
            EXPECT_LT(magenta, 100 * HEIGHT - 20) << "the name lies over it";
            EXPECT_GT(magenta, 95 * HEIGHT);
        }
        else
        {
            EXPECT_EQ(magenta, 0);
        }
    }
}

TEST_F(DeepPrint, FormatsOfEightBitsAreRefused)
{
    Scene printed = scene(nullptr);
    std::string error;
    const PicturePrint::Options how = options(16);
    EXPECT_FALSE(PicturePrint::write(printed, how, _view, file("print.jpg"), error));
    EXPECT_NE(error.find("have no 16 bits"), std::string::npos) << error;
    EXPECT_EQ(error.back(), '.');
    EXPECT_FALSE(fs::exists(file("print.jpg")));
    for (const auto& entry : fs::directory_iterator(how.work))
    {
        const std::string name = entry.path().filename().string();
        EXPECT_TRUE(name.rfind("tile-", 0) == 0 || name == "osggeofx-work.txt") << name;
    }
}
