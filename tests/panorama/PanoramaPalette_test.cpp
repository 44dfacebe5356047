// SPDX-License-Identifier: MIT
// SPDX-FileCopyrightText: 2026 the osgGeoFX authors
//
// Palettes of panorama maps: the kit's own, those that users draw, and those taken from paintings.
#include <osgGeoFX/effect/GlslFunctions.h>
#include <osgGeoFX/panorama/PanoramaPalette.h>
#include <osgGeoFX/panorama/detail/ColorDifference.h>
#include <tools/RandomSamples.h>
#include <tools/TempDir.h>

#include <gtest/gtest.h>
#include <osgDB/ReadFile>
#include <osgDB/WriteFile>

#include <cmath>
#include <cstring>
#include <limits>

using namespace osgGeoFX;
using geofx::test::Random;
using geofx::test::TempDir;
using glsl::Rgb;

namespace
{

constexpr int columns = glsl::GEOFX_PALETTE_COLUMNS;
constexpr int rows = glsl::GEOFX_PALETTE_ROWS;

Rgb texel(const osg::Image& palette, int column, int row)
{
    const unsigned char* bytes = palette.data(column, row);
    return Rgb(bytes[0], bytes[1], bytes[2]) / 255.0;
}

Rgb at(const osg::Image& palette, double light, int row)
{
    return texel(palette, static_cast<int>(std::lround((light + 1.0) / 2.0 * (columns - 1))), row);
}

double luminance(const Rgb& color)
{
    return 0.2126 * color.x + 0.7152 * color.y + 0.0722 * color.z;
}

double hueDistance(const Rgb& a, const Rgb& b)
{
    const double d = glsl::geofx_toHsv(a).x - glsl::geofx_toHsv(b).x;
    return std::min(d - std::floor(d), std::ceil(d) - d);
}

/// The largest difference of two palettes' parts, in 1/255.
int difference(const osg::Image& a, const osg::Image& b)
{
    int most = 0;
    for (int row = 0; row < rows; ++row)
        for (int column = 0; column < columns; ++column)
            for (int i = 0; i < 4; ++i)
                most = std::max(most, std::abs(a.data(column, row)[i] - b.data(column, row)[i]));
    return most;
}

void expectPalette(const osg::Image& palette)
{
    ASSERT_EQ(palette.s(), columns);
    ASSERT_EQ(palette.t(), rows);
    ASSERT_EQ(palette.getPixelFormat(), static_cast<GLenum>(GL_RGBA));
    ASSERT_EQ(palette.getDataType(), static_cast<GLenum>(GL_UNSIGNED_BYTE));
    for (int row = 0; row < rows; ++row)
        for (int column = 0; column < columns; ++column)
            ASSERT_EQ(palette.data(column, row)[3], 255);
}

osg::ref_ptr<osg::Image> grey(int width, int height, unsigned char value = 0)
{
    osg::ref_ptr<osg::Image> image = new osg::Image;
    image->allocateImage(width, height, 1, GL_LUMINANCE, GL_UNSIGNED_BYTE);
    std::memset(image->data(), value, image->getTotalSizeInBytes());
    return image;
}

} // namespace

TEST(PanoramaPalette, LightRisesAndTurnsTheHue)
{
    for (const double season : {0.0, 0.25, 0.5, 0.75, 0.9})
    {
        const osg::ref_ptr<osg::Image> palette = makePalette(season);
        expectPalette(*palette);
        for (int row = 0; row < rows; ++row)
        {
            for (int column = 1; column < columns; ++column)
            {
                ASSERT_GE(luminance(texel(*palette, column, row)),
                          luminance(texel(*palette, column - 1, row)) - 0.008)
                    << "season " << season << " row " << row << " column " << column;
                ASSERT_LT(glm::distance(texel(*palette, column, row), texel(*palette, column - 1, row)), 0.04)
                    << "no edges";
            }
            // Shade varies, too, and is blue to violet.
            EXPECT_GT(luminance(at(*palette, -0.2, row)) - luminance(at(*palette, -1.0, row)), 0.1);
            const double shade = glsl::geofx_toHsv(at(*palette, -0.7, row)).x;
            EXPECT_TRUE(shade > 0.55 && shade < 0.75) << "row " << row << " " << shade;
        }
    }
    const osg::ref_ptr<osg::Image> palette = makePalette();
    for (const int row : {glsl::GEOFX_PALETTE_FIELD, glsl::GEOFX_PALETTE_HILL, glsl::GEOFX_PALETTE_CLIFF,
                          glsl::GEOFX_PALETTE_TOWN, glsl::GEOFX_PALETTE_BARE})
        EXPECT_GT(hueDistance(at(*palette, 0.7, row), at(*palette, -0.6, row)), 0.36)
            << "complements, row " << row;
    for (int row = 0; row < rows; ++row)
        for (int other = 0; other < row; ++other)
            EXPECT_GT(glm::distance(at(*palette, 0.65, row), at(*palette, 0.65, other)), 0.06)
                << row << " and " << other << " can be told apart";
}

TEST(PanoramaPalette, LightIsWarmAndShadeIsViolet)
{
    // In L*a*b*, a grows from green over grey to red, and b from blue to yellow.
    const osg::ref_ptr<osg::Image> palette = makePalette();
    for (int row = 0; row < rows; ++row)
    {
        const glm::dvec3 light = labOf(at(*palette, 0.7, row));
        const glm::dvec3 shade = labOf(at(*palette, -0.6, row));
        EXPECT_GT(shade.y, 10.0) << "the shade is blue or green, row " << row;
        EXPECT_LT(shade.z, -25.0) << "the shade is red, row " << row;
        EXPECT_GT(light.z, 5.0) << "the light is cold, row " << row;
        EXPECT_GT(light.z - shade.z, row == glsl::GEOFX_PALETTE_SNOW ? 40.0 : 55.0) << "row " << row;
    }
}

TEST(PanoramaPalette, SeasonsChangeWhatGrowsInTheLight)
{
    const osg::ref_ptr<osg::Image> summer = makePalette(0.5);
    for (int step = 0; step <= 1000; ++step)
    {
        const double season = step / 1000.0;
        const osg::ref_ptr<osg::Image> palette = makePalette(season);
        ASSERT_LE(difference(*palette, *makePalette(season + 0.001)), 2) << "season " << season;
        for (const int row : {glsl::GEOFX_PALETTE_CLIFF, glsl::GEOFX_PALETTE_SNOW, glsl::GEOFX_PALETTE_TOWN,
                              glsl::GEOFX_PALETTE_BARE})
            ASSERT_EQ(std::memcmp(palette->data(0, row), summer->data(0, row), 4 * columns), 0);
        for (int row = 0; row < rows; ++row)
            ASSERT_EQ(std::memcmp(palette->data(0, row), summer->data(0, row), 4 * 102), 0) << "the shade";
    }
    EXPECT_EQ(difference(*makePalette(0.0), *makePalette(1.0)), 0);
    EXPECT_EQ(difference(*makePalette(-0.25), *makePalette(0.75)), 0);
    EXPECT_EQ(difference(*makePalette(std::numeric_limits<double>::quiet_NaN()), *summer), 0);
    const int trees = glsl::GEOFX_PALETTE_TREES;
    const Rgb autumn = at(*makePalette(0.75), 0.7, trees);
    EXPECT_GT(autumn.x, autumn.y) << "russet";
    const Rgb green = at(*summer, 0.7, trees);
    EXPECT_GT(green.y, green.x);
    EXPECT_LT(glsl::geofx_toHsv(at(*makePalette(0.0), 0.7, trees)).y, glsl::geofx_toHsv(green).y) << "paler";
}

TEST(PanoramaPalette, ColorDifferencesAreThoseOfTheStandard)
{
    // Of the pairs in Table 1 of Sharma, Wu and Dalal (2005).
    const struct
    {
        glm::dvec3 first, second;
        double difference;
    } pairs[] = {
        {{50.0, 2.6772, -79.7751}, {50.0, 0.0, -82.7485}, 2.0425},
        {{50.0, -1.3802, -84.2814}, {50.0, 0.0, -82.7485}, 1.0000},
        {{50.0, 0.0, 0.0}, {50.0, -1.0, 2.0}, 2.3669},
        {{50.0, 2.4900, -0.0010}, {50.0, -2.4900, 0.0009}, 7.1792},
        {{50.0, 2.4900, -0.0010}, {50.0, -2.4900, 0.0011}, 7.2195},
        {{50.0, -0.0010, 2.4900}, {50.0, 0.0011, -2.4900}, 4.7461},
        {{50.0, 2.5, 0.0}, {73.0, 25.0, -18.0}, 27.1492},
        {{50.0, 2.5, 0.0}, {58.0, 24.0, 15.0}, 19.4535},
        {{60.2574, -34.0099, 36.2677}, {60.4626, -34.1751, 39.4387}, 1.2644},
        {{22.7233, 20.0904, -46.6940}, {23.0331, 14.9730, -42.5619}, 2.0373},
        {{2.0776, 0.0795, -1.1350}, {0.9033, -0.0636, -0.5514}, 0.9082},
    };
    for (const auto& pair : pairs)
    {
        EXPECT_NEAR(colorDifference(pair.first, pair.second), pair.difference, 1e-4);
        EXPECT_NEAR(colorDifference(pair.second, pair.first), pair.difference, 1e-4);
    }
    const glm::dvec3 white = labOf(Rgb(1.0)), red = labOf(Rgb(1.0, 0.0, 0.0));
    EXPECT_LT(glm::distance(white, glm::dvec3(100.0, 0.0, 0.0)), 0.02);
    EXPECT_LT(glm::distance(red, glm::dvec3(53.24, 80.09, 67.20)), 0.02);
}

TEST(PanoramaPalette, DichromatsConfuseRedAndGreen)
{
    for (const ColorVision vision : {ColorVision::PROTANOPIA, ColorVision::DEUTERANOPIA})
    {
        for (int i = 0; i <= 10; ++i)
            EXPECT_LT(glm::distance(seenWith(vision, Rgb(i / 10.0)), Rgb(i / 10.0)), 0.001) << "grey stays";
        // A red and a green that differ only in what the missing cones see, and a blue and a yellow that do not.
        const auto apart = [&](const Rgb& a, const Rgb& b)
        {
            return colorDifference(labOf(seenWith(vision, a)), labOf(seenWith(vision, b)));
        };
        const Rgb red = vision == ColorVision::PROTANOPIA ? Rgb(0.85, 0.35, 0.2) : Rgb(0.8, 0.4, 0.2);
        const Rgb green = vision == ColorVision::PROTANOPIA ? Rgb(0.45, 0.45, 0.2) : Rgb(0.52, 0.55, 0.2);
        EXPECT_GT(colorDifference(labOf(red), labOf(green)), 2.0 * apart(red, green));
        EXPECT_GT(apart(Rgb(0.3, 0.4, 0.9), Rgb(0.9, 0.8, 0.3)), 40.0);
    }
    // Parts of the matrices, coded: linear light counts.
    const auto expectSeen = [](ColorVision vision, const Rgb& color, const Rgb& seen)
    {
        EXPECT_LT(glm::distance(seenWith(vision, color), seen), 1e-3);
    };
    expectSeen(ColorVision::DEUTERANOPIA, Rgb(1.0, 0.0, 0.0), Rgb(0.6401, 0.5658, 0.0));
    expectSeen(ColorVision::PROTANOPIA, Rgb(1.0, 0.0, 0.0), Rgb(0.4266, 0.3727, 0.0));
    expectSeen(ColorVision::DEUTERANOPIA, Rgb(0.0, 0.0, 0.5), Rgb(0.0, 0.1008, 0.4927));
    EXPECT_EQ(seenWith(ColorVision::USUAL, Rgb(0.1, 0.5, 0.9)), Rgb(0.1, 0.5, 0.9));
}

TEST(PanoramaPalette, ColorBlindReadersTellClassesApart)
{
    const osg::ref_ptr<osg::Image> palette = makeColorBlindPalette();
    expectPalette(*palette);
    for (const ColorVision vision : {ColorVision::USUAL, ColorVision::PROTANOPIA, ColorVision::DEUTERANOPIA})
    {
        // Each pair at each light once more, by itself.
        double least = HUGE_VAL;
        for (int column = 0; column < columns; ++column)
            for (int row = 0; row < rows; ++row)
                for (int other = 0; other < row; ++other)
                    least = std::min(
                        least, colorDifference(labOf(seenWith(vision, texel(*palette, column, row))),
                                               labOf(seenWith(vision, texel(*palette, column, other)))));
        EXPECT_GE(least, 10.0);
        const PaletteContrast found = leastContrast(*palette, vision);
        // Its colors are floats.
        EXPECT_NEAR(found.difference, least, 1e-3);
        EXPECT_NEAR(colorDifference(labOf(seenWith(vision, at(*palette, found.light, found.row))),
                                    labOf(seenWith(vision, at(*palette, found.light, found.otherRow)))),
                    least, 1e-3);
    }
    for (int row = 0; row < rows; ++row)
        for (int column = 1; column < columns; ++column)
            ASSERT_GE(luminance(texel(*palette, column, row)),
                      luminance(texel(*palette, column - 1, row)) - 0.008)
                << "row " << row << " column " << column;
    EXPECT_LT(leastContrast(*makePalette(), ColorVision::DEUTERANOPIA).difference, 10.0)
        << "the kit's own is not such a palette, so the measure tells";
    EXPECT_EQ(leastContrast(*grey(256, 8, 90), ColorVision::USUAL).difference, 0.0);
}

TEST(PanoramaPalette, FewSamplesGoOnAsTheKitsOwn)
{
    const osg::ref_ptr<osg::Image> own = makePalette();
    std::string error;
    const std::vector<PaletteSample> samples = {{glsl::GEOFX_PALETTE_HILL, 0.2, osg::Vec3d(0.5, 0.3, 0.3)},
                                                {glsl::GEOFX_PALETTE_HILL, 0.6, osg::Vec3d(0.7, 0.5, 0.4)},
                                                {glsl::GEOFX_PALETTE_TOWN, 0.0, osg::Vec3d(0.1, 0.1, 0.1)},
                                                {99, 0.0, osg::Vec3d(1.0, 0.0, 1.0)}};
    const osg::ref_ptr<osg::Image> palette = paletteFromSamples(samples, 2, error);
    ASSERT_TRUE(palette) << error;
    expectPalette(*palette);
    const int hill = glsl::GEOFX_PALETTE_HILL;
    EXPECT_LT(glm::distance(at(*palette, 0.2, hill), Rgb(0.5, 0.3, 0.3)), 0.02);
    EXPECT_LT(glm::distance(at(*palette, 0.4, hill), Rgb(0.6, 0.4, 0.35)), 0.02);
    const Rgb change = at(*own, -0.8, hill) - at(*own, 0.2, hill);
    EXPECT_LT(
        glm::distance(at(*palette, -0.8, hill), glm::clamp(Rgb(0.5, 0.3, 0.3) + change, Rgb(0.0), Rgb(1.0))),
        0.02);
    for (const int row : {glsl::GEOFX_PALETTE_TOWN, glsl::GEOFX_PALETTE_FIELD})
        EXPECT_EQ(std::memcmp(palette->data(0, row), own->data(0, row), 4 * columns), 0)
            << "one sample is too few";
    EXPECT_FALSE(paletteFromSamples(samples, 3, error));
    EXPECT_NE(error.find("as many as 3 samples"), std::string::npos) << error;
}

TEST(PanoramaPalette, ImagesOfOtherSizesAreResampled)
{
    const osg::ref_ptr<osg::Image> own = makePalette();
    std::string error;
    const osg::ref_ptr<osg::Image> same = paletteFromImage(*own, error);
    ASSERT_TRUE(same) << error;
    EXPECT_EQ(difference(*own, *same), 0);

    for (const int width : {33, 128, 256, 300, 1024})
    {
        for (const int height : {8, 12, 20, 64, 129})
        {
            // Drawn as a user would: bands, with colors that belong to none where two of them meet.
            osg::ref_ptr<osg::Image> drawn = new osg::Image;
            drawn->allocateImage(width, height, 1, GL_RGB, GL_UNSIGNED_BYTE);
            for (int y = 0; y < height; ++y)
            {
                const double band = (y + 0.5) / height * rows;
                const bool border = height >= 64 && std::abs(band - std::floor(band) - 0.5) > 0.35;
                for (int x = 0; x < width; ++x)
                {
                    const double light = 2.0 * (x + 0.5) / width - 1.0;
                    const Rgb color = border ? Rgb(1, 0, 1) : at(*own, light, static_cast<int>(band));
                    drawn->setColor(osg::Vec4(osg::Vec3d(color.x, color.y, color.z), 1.0f), x, y);
                }
            }
            const osg::ref_ptr<osg::Image> palette = paletteFromImage(*drawn, error);
            ASSERT_TRUE(palette) << error;
            expectPalette(*palette);
            // A column of 33 is eight of the palette's, over which it changes by up to 20.
            EXPECT_LE(difference(*own, *palette), width < 100 ? 22 : 4) << width << " x " << height;
        }
    }
}

TEST(PanoramaPalette, ColumnsOfWideImagesAreAveraged)
{
    const osg::ref_ptr<osg::Image> stripes = grey(1024, 8);
    for (int y = 0; y < 8; ++y)
        for (int x = 0; x < 1024; x += 4)
            *stripes->data(x, y) = 200;
    std::string error;
    const osg::ref_ptr<osg::Image> palette = paletteFromImage(*stripes, error);
    ASSERT_TRUE(palette) << error;
    for (int column = 0; column < columns; ++column)
        ASSERT_EQ(palette->data(column, 3)[0], 50) << column;
}

TEST(PanoramaPalette, TheFilesAreTheKitsOwn)
{
    std::string error;
    const osg::ref_ptr<osg::Image> palette =
        readPalette(GEOFX_SOURCE_DIR "/data/panorama/palette.png", error);
    ASSERT_TRUE(palette) << error;
    EXPECT_EQ(difference(*makePalette(), *palette), 0);
    const osg::ref_ptr<osg::Image> readable =
        readPalette(GEOFX_SOURCE_DIR "/data/panorama/colorblind.png", error);
    ASSERT_TRUE(readable) << error;
    EXPECT_EQ(difference(*makeColorBlindPalette(), *readable), 0);
}

TEST(PanoramaPalette, WhatCannotBeUsedIsToldInASentence)
{
    const TempDir folder;
    std::string error;
    EXPECT_FALSE(readPalette((folder / "none.png").string(), error));
    EXPECT_NE(error.find("none.png does not exist"), std::string::npos) << error;
    EXPECT_FALSE(readPalette(folder.write("text.png", "no picture").string(), error));
    EXPECT_NE(error.find("text.png is not a picture"), std::string::npos) << error;
    const std::string low = (folder / "low.png").string();
    ASSERT_TRUE(osgDB::writeImageFile(*grey(256, 7), low));
    EXPECT_FALSE(readPalette(low, error));
    EXPECT_NE(error.find("low.png"), std::string::npos) << error;
    EXPECT_NE(error.find("7 pixels high"), std::string::npos) << error;
    EXPECT_FALSE(paletteFromImage(*osg::ref_ptr<osg::Image>(new osg::Image), error));
    EXPECT_NE(error.find("no pixels"), std::string::npos) << error;
}

TEST(PanoramaPalette, APaintingGivesBackWhatItWasPaintedWith)
{
    const osg::ref_ptr<osg::Image> own = makePalette(0.8);
    Random random(1);
    const int side = 300;
    osg::ref_ptr<osg::Image> painting = new osg::Image;
    painting->allocateImage(side, side, 1, GL_RGB, GL_UNSIGNED_BYTE);
    const osg::ref_ptr<osg::Image> light = grey(side, side);
    const osg::ref_ptr<osg::Image> classes = grey(side, side);
    for (int y = 0; y < side; ++y)
    {
        for (int x = 0; x < side; ++x)
        {
            const int row = random.integer(0, rows);
            const int column = random.integer(0, columns - 1);
            *light->data(x, y) = static_cast<unsigned char>(column);
            // Snow is not seen in this painting; and what has no class does not count.
            const bool seen = row < rows && row != glsl::GEOFX_PALETTE_SNOW;
            *classes->data(x, y) = static_cast<unsigned char>(seen ? row : 255);
            const unsigned char odd[] = {255, 0, 255};
            std::memcpy(painting->data(x, y), seen ? own->data(column, row) : odd, 3);
        }
    }
    std::string error;
    const osg::ref_ptr<osg::Image> palette = paletteFromPainting(*painting, *light, *classes, error);
    ASSERT_TRUE(palette) << error;
    expectPalette(*palette);
    const osg::ref_ptr<osg::Image> summer = makePalette();
    for (int row = 0; row < rows; ++row)
    {
        const osg::Image& expected = row == glsl::GEOFX_PALETTE_SNOW ? *summer : *own;
        // Averages over 8 columns; the ends have none beyond them.
        for (int column = 0; column < columns; ++column)
            ASSERT_LT(glm::distance(texel(*palette, column, row), texel(expected, column, row)), 0.06)
                << row << " " << column;
    }

    // A light map of half the size tells nearly the same where light changes slowly.
    EXPECT_TRUE(paletteFromPainting(*painting, *grey(20, 10, 128), *classes, error));
    EXPECT_FALSE(paletteFromPainting(*painting, *light, *grey(side, side, 255), error));
    EXPECT_NE(error.find("map of classes"), std::string::npos) << error;
    EXPECT_FALSE(paletteFromPainting(*painting, *osg::ref_ptr<osg::Image>(new osg::Image), *classes, error));
    EXPECT_NE(error.find("The light map has no pixels"), std::string::npos) << error;
}
