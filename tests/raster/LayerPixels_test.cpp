// SPDX-License-Identifier: MIT
// SPDX-FileCopyrightText: 2026 the osgGeoFX authors
//
// A layer's texels: every format, odd sizes, no-data, mip levels and reduction against plain loops.
#include <osgGeoFX/raster/LayerPixels.h>
#include <tools/RandomSamples.h>

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstring>
#include <functional>
#include <limits>
#include <map>

using namespace osgGeoFX;
using geofx::test::Random;
using Kind = LayerPixels::Kind;
using Texel = LayerPixels::Texel;
using Options = LayerPixels::Options;

namespace
{

Texel rgba(unsigned r, unsigned g, unsigned b, unsigned a = 255)
{
    return r | g << 8 | b << 16 | a << 24;
}

unsigned channel(Texel texel, int index)
{
    return (texel >> (8 * index)) & 255u;
}

struct Format
{
    GLenum format;
    const char* channels; ///< as they lie in memory; L is a grey
};

const Format formats[] = {{GL_RGB, "RGB"},   {GL_RGBA, "RGBA"},   {GL_BGR, "BGR"},
                          {GL_BGRA, "BGRA"}, {GL_LUMINANCE, "L"}, {GL_LUMINANCE_ALPHA, "LA"},
                          {GL_ALPHA, "A"},   {GL_RED, "R"},       {GL_RG, "RG"}};

/// An image of any type, whose numbers come from a function of column, row and channel letter.
template<typename T>
osg::ref_ptr<osg::Image> makeImage(const Format& format, GLenum type, int width, int height, int packing,
                                   const std::function<T(int, int, char)>& number)
{
    const std::size_t count = std::strlen(format.channels);
    const std::size_t row = (count * sizeof(T) * width + packing - 1) / packing * packing;
    // osg::Image cannot allocate doubles.
    auto* bytes = new unsigned char[row * height]();
    for (int y = 0; y < height; ++y)
        for (int x = 0; x < width; ++x)
            for (std::size_t c = 0; c < count; ++c)
            {
                const T value = number(x, y, format.channels[c]);
                std::memcpy(bytes + row * y + (count * x + c) * sizeof(T), &value, sizeof(T));
            }
    osg::ref_ptr<osg::Image> image = new osg::Image;
    image->setImage(width, height, 1, static_cast<GLint>(format.format), format.format, type, bytes,
                    osg::Image::USE_NEW_DELETE, packing);
    return image;
}

osg::ref_ptr<osg::Image> makePicture(int width, int height, const std::function<Texel(int, int)>& texel)
{
    return makeImage<unsigned char>(formats[1], GL_UNSIGNED_BYTE, width, height, 1,
                                    [&](int x, int y, char c)
                                    {
                                        const auto index = std::string("RGBA").find(c);
                                        return static_cast<unsigned char>(
                                            channel(texel(x, y), static_cast<int>(index)));
                                    });
}

osg::ref_ptr<osg::Image> makeValues(int width, int height, const std::function<float(int, int)>& value)
{
    return makeImage<float>(formats[7], GL_FLOAT, width, height, 1,
                            [&](int x, int y, char) { return value(x, y); });
}

LayerPixels make(const osg::Image& image, const Options& options = {})
{
    std::string error;
    auto pixels = LayerPixels::make(image, options, error);
    EXPECT_TRUE(pixels) << error;
    return pixels ? *pixels : LayerPixels{};
}

Options optionsOf(Kind kind, std::optional<double> noData = std::nullopt)
{
    Options options;
    options.kind = kind;
    options.noData = noData;
    return options;
}

Texel at(const LayerPixels& pixels, int level, int x, int y)
{
    return pixels.levels[level][static_cast<std::size_t>(y) * (pixels.side >> level) + x];
}

float valueAt(const LayerPixels& pixels, int level, int x, int y)
{
    return LayerPixels::value(at(pixels, level, x, y));
}

/// The color that a format shows, byteOf() giving a channel's byte.
Texel expectedColor(const Format& format, const std::function<unsigned(char)>& byteOf)
{
    const std::string channels = format.channels;
    const auto has = [&](char c)
    {
        return channels.find(c) != std::string::npos;
    };
    const unsigned alpha = has('A') ? byteOf('A') : 255;
    if (has('L')) return rgba(byteOf('L'), byteOf('L'), byteOf('L'), alpha);
    if (channels == "A") return rgba(255, 255, 255, alpha);
    return rgba(byteOf('R'), has('G') ? byteOf('G') : 0, has('B') ? byteOf('B') : 0, alpha);
}

/// Every format with every packing as colors and as values; `share` is a number's part of full intensity.
template<typename T>
void checkType(GLenum type, const std::function<T(Random&)>& draw, const std::function<double(T)>& share)
{
    Random random(type);
    for (const Format& format : formats)
        for (const int packing : {1, 4})
            for (const int width : {1, 3, 8})
            {
                std::map<std::string, T> numbers;
                const auto key = [](int x, int y, char c)
                {
                    return std::to_string(x) + "," + std::to_string(y) + c;
                };
                const auto image =
                    makeImage<T>(format, type, width, 5, packing,
                                 [&](int x, int y, char c) { return numbers[key(x, y, c)] = draw(random); });
                const LayerPixels colors = make(*image), values = make(*image, optionsOf(Kind::Value));
                for (int y = 0; y < 5; ++y)
                    for (int x = 0; x < width; ++x)
                    {
                        const Texel expected =
                            expectedColor(format,
                                          [&](char c)
                                          {
                                              const double part =
                                                  std::clamp(share(numbers[key(x, y, c)]), 0.0, 1.0);
                                              return static_cast<unsigned>(std::lround(part * 255.0));
                                          });
                        ASSERT_EQ(at(colors, 0, x, y), expected) << format.channels << " type " << type;
                        const char first = std::strchr(format.channels, 'R') ? 'R' : format.channels[0];
                        ASSERT_EQ(valueAt(values, 0, x, y), static_cast<float>(numbers[key(x, y, first)]))
                            << format.channels << " type " << type;
                    }
            }
}

template<typename T>
void checkIntegers(GLenum type)
{
    const auto most = static_cast<double>(std::numeric_limits<T>::max());
    const auto draw = [](Random& random)
    {
        return static_cast<T>(std::floor(random.uniform(static_cast<double>(std::numeric_limits<T>::min()),
                                                        static_cast<double>(std::numeric_limits<T>::max()))));
    };
    checkType<T>(type, draw, [=](T number) { return static_cast<double>(number) / most; });
}

TEST(LayerPixels, EveryFormatTypeAndPacking)
{
    checkIntegers<std::uint8_t>(GL_UNSIGNED_BYTE);
    checkIntegers<std::int8_t>(GL_BYTE);
    checkIntegers<std::uint16_t>(GL_UNSIGNED_SHORT);
    checkIntegers<std::int16_t>(GL_SHORT);
    checkIntegers<std::uint32_t>(GL_UNSIGNED_INT);
    checkIntegers<std::int32_t>(GL_INT);
    checkType<float>(
        GL_FLOAT, [](Random& r) { return static_cast<float>(r.uniform(-0.5, 1.5)); },
        [](float number) { return static_cast<double>(number); });
    checkType<double>(
        GL_DOUBLE, [](Random& r) { return r.uniform(-0.5, 1.5); }, [](double number) { return number; });
}

TEST(LayerPixels, IntegersKeepTheirNumbers)
{
    const auto image =
        makeImage<std::int16_t>(formats[4], GL_SHORT, 2, 1, 1,
                                [](int x, int, char) { return static_cast<std::int16_t>(x ? -1234 : 1234); });
    const LayerPixels pixels = make(*image, optionsOf(Kind::Value));
    EXPECT_EQ(valueAt(pixels, 0, 0, 0), 1234.0f);
    EXPECT_EQ(valueAt(pixels, 0, 1, 0), -1234.0f);
    EXPECT_EQ(at(pixels, 0, 0, 0), 0x449a4000u); // the bits of the float 1234
}

TEST(LayerPixels, SizesAndPadding)
{
    struct Size
    {
        int width, height, side;
        std::size_t levels;
    };
    for (const Size& size : {Size{1, 1, 1, 1}, Size{2, 1, 2, 2}, Size{1, 7, 8, 4}, Size{7, 1, 8, 4},
                             Size{513, 3, 1024, 11}, Size{64, 64, 64, 7}})
    {
        const auto texel = [](int x, int y)
        {
            return rgba(x & 255, x >> 8, y, 255);
        };
        const LayerPixels pixels = make(*makePicture(size.width, size.height, texel));
        EXPECT_EQ(pixels.width, size.width);
        EXPECT_EQ(pixels.height, size.height);
        EXPECT_EQ(pixels.side, size.side);
        EXPECT_FALSE(pixels.reduced);
        ASSERT_EQ(pixels.levels.size(), size.levels);
        for (std::size_t level = 0; level < size.levels; ++level)
        {
            const auto side = static_cast<std::size_t>(size.side >> level);
            EXPECT_EQ(pixels.levels[level].size(), side * side);
        }
        for (int y = 0; y < size.side; ++y)
            for (int x = 0; x < size.side; ++x)
                ASSERT_EQ(at(pixels, 0, x, y),
                          texel(std::min(x, size.width - 1), std::min(y, size.height - 1)))
                    << x << " " << y;
    }
}

TEST(LayerPixels, FewerLevelsWhereAsked)
{
    const auto image = makePicture(640, 360, [](int x, int y) { return rgba(x & 255, y & 255, 0); });
    Options options;
    options.levels = 1;
    EXPECT_EQ(make(*image, options).levels.size(), 1u);
    options.levels = 3;
    EXPECT_EQ(make(*image, options).levels.size(), 3u);
    options.levels = 99;
    EXPECT_EQ(make(*image, options).levels.size(), 11u);
}

TEST(LayerPixels, FilmsStandUpright)
{
    const auto image = makePicture(2, 4, [](int x, int y) { return rgba(x, y, 0); });
    image->setOrigin(osg::Image::TOP_LEFT);
    const LayerPixels pixels = make(*image);
    for (int y = 0; y < 4; ++y)
        EXPECT_EQ(at(pixels, 0, 1, y), rgba(1, 3 - y, 0));
}

TEST(LayerPixels, RowsOfAnImagePart)
{
    // A window of 2 columns in rows of 5 pixels.
    std::vector<unsigned char> bytes(15);
    for (std::size_t i = 0; i < bytes.size(); ++i)
        bytes[i] = static_cast<unsigned char>(i);
    osg::ref_ptr<osg::Image> image = new osg::Image;
    image->setImage(2, 3, 1, GL_LUMINANCE, GL_LUMINANCE, GL_UNSIGNED_BYTE, bytes.data(),
                    osg::Image::NO_DELETE, 1, 5);
    const LayerPixels pixels = make(*image, optionsOf(Kind::Value));
    for (int y = 0; y < 3; ++y)
        for (int x = 0; x < 2; ++x)
            EXPECT_EQ(valueAt(pixels, 0, x, y), static_cast<float>(5 * y + x));
}

TEST(LayerPixels, NoData)
{
    const float nan = std::nanf("");
    const float infinite = std::numeric_limits<float>::infinity();
    const float numbers[] = {nan, -nan, infinite, -infinite, -9999.0f, 0.1f, -0.0f, 7.0f};
    const auto image = makeValues(8, 1, [&](int x, int) { return numbers[x]; });
    for (const Kind kind : {Kind::Value, Kind::Class})
    {
        LayerPixels pixels = make(*image, optionsOf(kind, -9999.0));
        for (int x = 0; x < 5; ++x)
            EXPECT_EQ(at(pixels, 0, x, 0), 0x7fc00000u) << x;
        EXPECT_EQ(valueAt(pixels, 0, 5, 0), 0.1f);
        EXPECT_EQ(at(pixels, 0, 6, 0), 0u);
        // What is written in decimals means the float next to it.
        pixels = make(*image, optionsOf(kind, 0.1));
        EXPECT_EQ(at(pixels, 0, 5, 0), 0x7fc00000u);
        EXPECT_EQ(valueAt(pixels, 0, 4, 0), -9999.0f);
        pixels = make(*image, optionsOf(kind, std::nan("")));
        EXPECT_EQ(valueAt(pixels, 0, 7, 0), 7.0f);
    }

    const double large[] = {-1.7976931348623157e308, -3.4028234663852886e38, 1e39, 5.0};
    const auto doubles =
        makeImage<double>(formats[7], GL_DOUBLE, 4, 1, 1, [&](int x, int, char) { return large[x]; });
    const LayerPixels pixels = make(*doubles, optionsOf(Kind::Value, -3.4028234663852886e38));
    for (int x = 0; x < 3; ++x)
        EXPECT_EQ(at(pixels, 0, x, 0), LayerPixels::none) << x;
    EXPECT_EQ(valueAt(pixels, 0, 3, 0), 5.0f);
}

/// The one texel of level 1 of a picture of 2 × 2.
Texel average(const std::array<Texel, 4>& four, bool sRGB)
{
    Options options;
    options.sRGB = sRGB;
    return make(*makePicture(2, 2, [&](int x, int y) { return four[2 * y + x]; }), options)
        .levels.at(1)
        .at(0);
}

TEST(LayerPixels, AveragesOfColorsByHand)
{
    const Texel black = rgba(0, 0, 0), white = rgba(255, 255, 255), grey = rgba(100, 100, 100);
    // Half the light of white is 0.7354 in sRGB, 187.5 of 255.
    EXPECT_EQ(average({black, white, white, black}, true), rgba(188, 188, 188));
    EXPECT_EQ(average({black, white, white, black}, false), rgba(128, 128, 128));
    EXPECT_EQ(average({grey, grey, grey, grey}, true), grey);
    // A quarter of the light: 0.5371.
    EXPECT_EQ(average({black, white, black, black}, true), rgba(137, 137, 137));
    // Red on transparent green stays red; twice as opaque counts twice.
    EXPECT_EQ(average({rgba(255, 0, 0), rgba(0, 255, 0, 0), rgba(0, 255, 0, 0), rgba(0, 255, 0, 0)}, true),
              rgba(255, 0, 0, 64));
    EXPECT_EQ(average({rgba(90, 0, 0, 200), rgba(0, 0, 0, 100), rgba(0, 9, 0, 0), rgba(0, 9, 0, 0)}, false),
              rgba(60, 0, 0, 75));
    // All transparent: their color is kept.
    EXPECT_EQ(average({rgba(10, 0, 0, 0), rgba(30, 0, 0, 0), rgba(10, 0, 0, 0), rgba(30, 0, 0, 0)}, false),
              rgba(20, 0, 0, 0));
}

TEST(LayerPixels, AveragesOfValuesAndClassesByHand)
{
    const float none = std::nanf("");
    const auto level1 = [](Kind kind, const std::array<float, 4>& four)
    {
        return make(*makeValues(2, 2, [&](int x, int y) { return four[2 * y + x]; }), optionsOf(kind))
            .levels.at(1)
            .at(0);
    };
    EXPECT_EQ(level1(Kind::Value, {1, 2, 3, 6}), LayerPixels::texel(3.0f));
    EXPECT_EQ(level1(Kind::Value, {1, none, none, 6}), LayerPixels::texel(3.5f));
    EXPECT_EQ(level1(Kind::Value, {none, none, none, -6}), LayerPixels::texel(-6.0f));
    EXPECT_EQ(level1(Kind::Value, {none, none, none, none}), 0x7fc00000u);
    // Four of the largest floats must not become infinite.
    EXPECT_EQ(level1(Kind::Value, {3e38f, 3e38f, 3e38f, 2e38f}), LayerPixels::texel(2.75e38f));

    EXPECT_EQ(level1(Kind::Class, {1, 2, 2, 3}), LayerPixels::texel(2.0f));
    EXPECT_EQ(level1(Kind::Class, {3, 2, 2, 3}), LayerPixels::texel(3.0f));
    EXPECT_EQ(level1(Kind::Class, {4, 3, 2, 1}), LayerPixels::texel(4.0f));
    EXPECT_EQ(level1(Kind::Class, {none, none, none, 9}), LayerPixels::texel(9.0f));
    EXPECT_EQ(level1(Kind::Class, {none, 5, 9, 9}), LayerPixels::texel(9.0f));
    EXPECT_EQ(level1(Kind::Class, {none, none, none, none}), 0x7fc00000u);
    EXPECT_EQ(level1(Kind::Class, {5, 0.0f, -0.0f, 6}), LayerPixels::texel(0.0f));
}

double toLight(double c)
{
    return c <= 0.04045 ? c / 12.92 : std::pow((c + 0.055) / 1.055, 2.4);
}

double fromLight(double c)
{
    return c <= 0.0031308 ? c * 12.92 : 1.055 * std::pow(c, 1.0 / 2.4) - 0.055;
}

TEST(LayerPixels, LevelsOfColorsAgainstPlainLoops)
{
    for (const bool sRGB : {true, false})
        for (int sample = 0; sample < 20; ++sample)
        {
            Random random(sample);
            Options options;
            options.sRGB = sRGB;
            const int width = random.integer(1, 40), height = random.integer(1, 40);
            const LayerPixels pixels =
                make(*makePicture(width, height,
                                  [&](int, int)
                                  {
                                      const unsigned a = random.integer(0, 2) * 100;
                                      return rgba(random.integer(0, 255), random.integer(0, 20),
                                                  random.integer(0, 255), a);
                                  }),
                     options);
            const auto light = [&](Texel texel, int c)
            {
                const double code = channel(texel, c) / 255.0;
                return sRGB ? toLight(code) : code;
            };
            for (int level = 1; level < static_cast<int>(pixels.levels.size()); ++level)
                for (int y = 0; y < pixels.side >> level; ++y)
                    for (int x = 0; x < pixels.side >> level; ++x)
                    {
                        const Texel four[] = {at(pixels, level - 1, 2 * x, 2 * y),
                                              at(pixels, level - 1, 2 * x + 1, 2 * y),
                                              at(pixels, level - 1, 2 * x, 2 * y + 1),
                                              at(pixels, level - 1, 2 * x + 1, 2 * y + 1)};
                        double alpha = 0.0;
                        for (const Texel texel : four)
                            alpha += channel(texel, 3);
                        const Texel made = at(pixels, level, x, y);
                        ASSERT_NEAR(channel(made, 3), alpha / 4.0, 0.501);
                        for (int c = 0; c < 3 && alpha > 0.0; ++c)
                        {
                            double sum = 0.0;
                            for (const Texel texel : four)
                                sum += channel(texel, 3) * light(texel, c);
                            const double mean = sum / alpha;
                            ASSERT_NEAR(channel(made, c), 255.0 * (sRGB ? fromLight(mean) : mean), 0.54);
                        }
                    }
        }
}

TEST(LayerPixels, LevelsOfValuesAgainstPlainLoops)
{
    for (int sample = 0; sample < 20; ++sample)
    {
        Random random(sample);
        const int width = random.integer(1, 40), height = random.integer(1, 40);
        const auto image = makeValues(
            width, height,
            [&](int, int)
            { return random.integer(0, 2) == 0 ? -1.0f : static_cast<float>(random.integer(1, 3)); });
        const LayerPixels values = make(*image, optionsOf(Kind::Value, -1.0));
        const LayerPixels classes = make(*image, optionsOf(Kind::Class, -1.0));
        for (int level = 1; level < static_cast<int>(values.levels.size()); ++level)
            for (int y = 0; y < values.side >> level; ++y)
                for (int x = 0; x < values.side >> level; ++x)
                {
                    double sum = 0.0;
                    int count = 0;
                    std::map<float, int> votes;
                    for (int i = 0; i < 4; ++i)
                    {
                        const float value = valueAt(values, level - 1, 2 * x + i % 2, 2 * y + i / 2);
                        if (!std::isnan(value)) sum += static_cast<double>(value), ++count;
                        const float vote = valueAt(classes, level - 1, 2 * x + i % 2, 2 * y + i / 2);
                        if (!std::isnan(vote)) ++votes[vote];
                    }
                    if (count == 0)
                        ASSERT_EQ(at(values, level, x, y), LayerPixels::none);
                    else
                        ASSERT_EQ(valueAt(values, level, x, y), static_cast<float>(sum / count));
                    if (votes.empty())
                    {
                        ASSERT_EQ(at(classes, level, x, y), LayerPixels::none);
                        continue;
                    }
                    int most = 0;
                    for (const auto& [vote, number] : votes)
                        most = std::max(most, number);
                    ASSERT_EQ(votes[valueAt(classes, level, x, y)], most);
                }
    }
}

TEST(LayerPixels, LargeImagesAreReducedAndKeepTheirAspect)
{
    const auto image = makePicture(2049, 100, [](int, int) { return rgba(50, 60, 70); });
    const LayerPixels pixels = make(*image);
    EXPECT_TRUE(pixels.reduced);
    EXPECT_EQ(pixels.width, 2048);
    EXPECT_EQ(pixels.height, 100);
    EXPECT_EQ(pixels.side, 2048);
    EXPECT_EQ(at(pixels, 0, 1000, 50), rgba(50, 60, 70));

    Options options;
    options.maxSide = 64;
    const LayerPixels narrow = make(*makePicture(3, 1000, [](int, int) { return rgba(1, 2, 3); }), options);
    EXPECT_EQ(narrow.width, 1);
    EXPECT_EQ(narrow.height, 64);
    EXPECT_EQ(make(*makePicture(64, 64, [](int, int) { return 0u; }), options).reduced, false);
    // The picture may not fill a power of two.
    options.maxSide = 48;
    EXPECT_EQ(make(*makePicture(96, 96, [](int, int) { return 0u; }), options).width, 48);
    EXPECT_EQ(make(*makePicture(96, 96, [](int, int) { return 0u; }), options).side, 64);
}

TEST(LayerPixels, ReductionAgainstPlainLoops)
{
    for (int sample = 0; sample < 30; ++sample)
    {
        Random random(sample);
        const int width = random.integer(9, 40), height = random.integer(9, 40);
        Options options = optionsOf(Kind::Value, -1.0);
        options.maxSide = 8;
        std::vector<float> numbers(static_cast<std::size_t>(width) * height);
        for (float& number : numbers)
            number = static_cast<float>(random.integer(0, 3) == 0 ? -1 : random.integer(1, 3));
        const auto image = makeValues(width, height, [&](int x, int y) { return numbers[y * width + x]; });
        const LayerPixels values = make(*image, options);
        options.kind = Kind::Class;
        const LayerPixels classes = make(*image, options);
        EXPECT_TRUE(values.reduced);
        for (int y = 0; y < values.height; ++y)
            for (int x = 0; x < values.width; ++x)
            {
                // The target pixel's rectangle in the source, and its common part with every pixel.
                double sum = 0.0, area = 0.0;
                std::map<float, double> areas;
                const auto common = [](double i, int source, int target, int k)
                {
                    const double begin = i * source / target, end = (i + 1) * source / target;
                    return std::max(0.0, std::min(end, k + 1.0) - std::max(begin, static_cast<double>(k)));
                };
                for (int v = 0; v < height; ++v)
                    for (int u = 0; u < width; ++u)
                    {
                        const float number = numbers[v * width + u];
                        const double share =
                            common(x, width, values.width, u) * common(y, height, values.height, v);
                        if (number < 0.0f || share < 1e-9) continue;
                        sum += share * static_cast<double>(number);
                        area += share;
                        areas[number] += share;
                    }
                if (area == 0.0)
                {
                    ASSERT_EQ(at(values, 0, x, y), LayerPixels::none);
                    ASSERT_EQ(at(classes, 0, x, y), LayerPixels::none);
                    continue;
                }
                ASSERT_NEAR(static_cast<double>(valueAt(values, 0, x, y)), sum / area, 1e-6);
                double most = 0.0;
                for (const auto& [number, share] : areas)
                    most = std::max(most, share);
                ASSERT_NEAR(areas[valueAt(classes, 0, x, y)], most, 1e-6);
            }
    }
}

TEST(LayerPixels, ReductionAveragesLightAndAlpha)
{
    Options options;
    options.maxSide = 1;
    const auto checks = makePicture(2, 2, [](int x, int y) { return (x + y) % 2 ? ~0u : rgba(0, 0, 0); });
    EXPECT_EQ(make(*checks, options).levels[0][0], rgba(188, 188, 188));
    const auto thirds =
        makePicture(3, 1, [](int x, int) { return x ? rgba(0, 255, 0, 0) : rgba(255, 0, 0); });
    EXPECT_EQ(make(*thirds, options).levels[0][0], rgba(255, 0, 0, 85));

    // Two pixels of three: one and a half below each.
    options.maxSide = 2;
    options.sRGB = false;
    const auto steps = makePicture(3, 1, [](int x, int) { return rgba(90 * x, 0, 0); });
    EXPECT_EQ(at(make(*steps, options), 0, 0, 0), rgba(30, 0, 0));
    EXPECT_EQ(at(make(*steps, options), 0, 1, 0), rgba(150, 0, 0));
}

/// The sentence with which an image is refused.
std::string refusal(const osg::Image& image, const Options& options = {})
{
    std::string error;
    EXPECT_FALSE(LayerPixels::make(image, options, error));
    EXPECT_EQ(error.back(), '.') << error;
    return error;
}

TEST(LayerPixels, RemakesWhatHasChanged)
{
    Random random(31);
    std::string error;
    for (int i = 0; i < 60; ++i)
    {
        const int width = random.integer(1, 70), height = random.integer(1, 70);
        Options options;
        options.kind = static_cast<Kind>(i % 3);
        const bool colors = options.kind == Kind::Color;
        const osg::ref_ptr<osg::Image> image = new osg::Image;
        image->allocateImage(width, height, 1, colors ? GL_RGBA : GL_RED,
                             colors ? GL_UNSIGNED_BYTE : GL_FLOAT);
        const auto paint = [&](int x, int y)
        {
            unsigned char* texel = image->data(x, y);
            if (!colors)
                *reinterpret_cast<float*>(texel) = static_cast<float>(random.integer(0, 5));
            else
                for (int c = 0; c < 4; ++c)
                    texel[c] = static_cast<unsigned char>(random.integer(0, 255));
        };
        for (int y = 0; y < height; ++y)
            for (int x = 0; x < width; ++x)
                paint(x, y);
        std::optional<LayerPixels> pixels = LayerPixels::make(*image, options, error);
        ASSERT_TRUE(pixels) << error;
        for (int change = 0; change < 4; ++change)
        {
            const std::vector<Texel> before = pixels->levels[0];
            const int from = random.integer(0, height - 1), to = random.integer(from, height - 1);
            for (int y = from; y <= to; ++y)
                paint(random.integer(0, width - 1), y);
            LayerPixels::Rows rows;
            pixels = LayerPixels::remake(*image, options, *pixels, rows, error);
            ASSERT_TRUE(pixels) << error;
            const std::optional<LayerPixels> anew = LayerPixels::make(*image, options, error);
            ASSERT_EQ(pixels->levels, anew->levels);
            // All rows that differ, and no others beside them.
            const auto side = static_cast<std::size_t>(pixels->side);
            for (int y = 0; y < pixels->side; ++y)
            {
                const auto at = static_cast<std::ptrdiff_t>(y * side);
                const bool same = std::equal(before.begin() + at, before.begin() + at + pixels->side,
                                             pixels->levels[0].begin() + at);
                const bool within = y >= rows.first && y < rows.end;
                EXPECT_TRUE(within || same) << y;
                EXPECT_FALSE(same && y == rows.first && rows.end > rows.first);
            }
            EXPECT_LE(rows.end, to + 1 == height ? pixels->side : to + 1);
        }
        LayerPixels::Rows rows{3, 9};
        ASSERT_TRUE(LayerPixels::remake(*image, options, *pixels, rows, error));
        EXPECT_EQ(rows.first, rows.end) << "nothing has changed";
        options.maxSide = 4;
        const std::optional<LayerPixels> reduced = LayerPixels::remake(*image, options, *pixels, rows, error);
        ASSERT_TRUE(reduced);
        EXPECT_EQ(reduced->levels, LayerPixels::make(*image, options, error)->levels);
        EXPECT_TRUE(std::max(width, height) <= 4 || rows.end == reduced->side) << "all of it";
    }
}

TEST(LayerPixels, RefusesWithASentence)
{
    osg::ref_ptr<osg::Image> image = new osg::Image;
    EXPECT_NE(refusal(*image).find("Layer: the image is empty"), std::string::npos);
    image->setFileName("photo.dds");
    EXPECT_NE(refusal(*image).find("photo.dds: the image is empty"), std::string::npos);
    image->allocateImage(4, 4, 2, GL_RGB, GL_UNSIGNED_BYTE);
    EXPECT_NE(refusal(*image).find("has depth"), std::string::npos);
    image->allocateImage(8, 8, 1, GL_COMPRESSED_RGB_S3TC_DXT1_EXT, GL_UNSIGNED_BYTE);
    EXPECT_NE(refusal(*image).find("is compressed"), std::string::npos);
    image->allocateImage(4, 4, 1, GL_DEPTH_COMPONENT, GL_FLOAT);
    EXPECT_NE(refusal(*image).find("pixel format"), std::string::npos);
    image->allocateImage(4, 4, 1, GL_RGB, GL_UNSIGNED_SHORT_5_6_5);
    EXPECT_NE(refusal(*image).find("data type"), std::string::npos);

    image->allocateImage(4, 4, 1, GL_RGB, GL_UNSIGNED_BYTE);
    Options options;
    options.maxSide = 0;
    EXPECT_NE(refusal(*image, options).find("largest side"), std::string::npos);
    options.maxSide = 16385;
    EXPECT_NE(refusal(*image, options).find("largest side"), std::string::npos);
    options = {};
    options.levels = -1;
    EXPECT_NE(refusal(*image, options).find("number of levels"), std::string::npos);
}

} // namespace
