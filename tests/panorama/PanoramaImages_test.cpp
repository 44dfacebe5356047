// SPDX-License-Identifier: MIT
// SPDX-FileCopyrightText: 2026 the osgGeoFX authors
//
// The images that panorama maps are painted with: brush and sky.
#include <osgGeoFX/panorama/PanoramaBrush.h>
#include <osgGeoFX/panorama/PanoramaSky.h>

#include <gtest/gtest.h>
#include <osg/Image>

#include <algorithm>
#include <cmath>
#include <cstring>

using namespace osgGeoFX;

namespace
{

bool equal(const osg::Image& a, const osg::Image& b)
{
    return a.s() == b.s() && a.t() == b.t() && a.getTotalSizeInBytes() == b.getTotalSizeInBytes() &&
           std::memcmp(a.data(), b.data(), a.getTotalSizeInBytes()) == 0;
}

double part(const osg::Image& image, int x, int y, int channel)
{
    return image.data(x, y)[channel] / 255.0;
}

/// Mean difference between neighbours across the columns x and x + 1 (or rows, for `upwards`), which may be the seam.
double step(const osg::Image& image, int channel, int x, bool upwards)
{
    const int across = upwards ? image.t() : image.s();
    const int along = upwards ? image.s() : image.t();
    double sum = 0.0;
    for (int i = 0; i < along; ++i)
    {
        const int next = (x + 1) % across;
        sum += std::abs(upwards ? part(image, i, x, channel) - part(image, i, next, channel)
                                : part(image, x, i, channel) - part(image, next, i, channel));
    }
    return sum / along;
}

/// The seam must not differ from the other columns more than they do from each other.
void expectNoSeam(const osg::Image& image, int channel, bool upwards)
{
    const int across = upwards ? image.t() : image.s();
    double sum = 0.0;
    double squares = 0.0;
    for (int x = 0; x + 1 < across; ++x)
    {
        const double inside = step(image, channel, x, upwards);
        sum += inside;
        squares += inside * inside;
    }
    const double mean = sum / (across - 1);
    const double deviation = std::sqrt(std::max(squares / (across - 1) - mean * mean, 0.0));
    EXPECT_LT(step(image, channel, across - 1, upwards), mean + 4.0 * deviation)
        << "channel " << channel << (upwards ? " upwards" : "");
}

double mean(const osg::Image& image, int channel, int firstRow, int lastRow)
{
    double sum = 0.0;
    for (int y = firstRow; y <= lastRow; ++y)
        for (int x = 0; x < image.s(); ++x)
            sum += part(image, x, y, channel);
    return sum / (image.s() * (lastRow - firstRow + 1.0));
}

double deviation(const osg::Image& image, int channel)
{
    const double middle = mean(image, channel, 0, image.t() - 1);
    double sum = 0.0;
    for (int y = 0; y < image.t(); ++y)
        for (int x = 0; x < image.s(); ++x)
            sum += std::pow(part(image, x, y, channel) - middle, 2);
    return std::sqrt(sum / (image.s() * image.t()));
}

/// The share of texels that are nearly white, from a row upwards.
double white(const osg::Image& image, int firstRow)
{
    int count = 0;
    for (int y = firstRow; y < image.t(); ++y)
        for (int x = 0; x < image.s(); ++x)
            count += part(image, x, y, 0) > 0.8;
    return static_cast<double>(count) / (image.s() * (image.t() - firstRow));
}

} // namespace

TEST(PanoramaBrush, RepeatsWithoutASeam)
{
    for (const int side : {64, 256, 512})
    {
        const osg::ref_ptr<osg::Image> image = makeBrushTexture(side);
        ASSERT_EQ(image->s(), side);
        ASSERT_EQ(image->t(), side);
        ASSERT_EQ(image->getPixelFormat(), static_cast<GLenum>(GL_RGBA));
        for (int channel = 0; channel < 4; ++channel)
        {
            expectNoSeam(*image, channel, false);
            expectNoSeam(*image, channel, true);
            // Far from a mipmap's bias, and neither flat nor cut off.
            EXPECT_NEAR(mean(*image, channel, 0, side - 1), 0.5, channel == 3 ? 0.05 : 0.02)
                << "channel " << channel;
            EXPECT_GT(deviation(*image, channel), 0.08) << "channel " << channel;
            EXPECT_LT(deviation(*image, channel), 0.25) << "channel " << channel;
        }
    }
}

TEST(PanoramaBrush, IsTheSameEachTime)
{
    EXPECT_TRUE(equal(*makeBrushTexture(128), *makeBrushTexture(128)));
    EXPECT_EQ(makeBrushTexture(1)->s(), 64);
}

TEST(PanoramaBrush, StrokesAndRipplesRunAlongX)
{
    const osg::ref_ptr<osg::Image> image = makeBrushTexture();
    for (const int channel : {2, 3})
    {
        double along = 0.0;
        double across = 0.0;
        for (int x = 0; x < image->s(); x += 8)
        {
            along += step(*image, channel, x, false);
            across += step(*image, channel, x, true);
        }
        EXPECT_GT(across, 1.3 * along) << "channel " << channel;
    }
}

TEST(PanoramaSky, TurnsWithoutASeam)
{
    for (const unsigned seed : {1u, 2u, 3u})
    {
        const osg::ref_ptr<osg::Image> sky = makeSky(1024, 128, seed);
        ASSERT_EQ(sky->s(), 1024);
        ASSERT_EQ(sky->t(), 128);
        ASSERT_EQ(sky->getPixelFormat(), static_cast<GLenum>(GL_RGBA));
        for (int channel = 0; channel < 3; ++channel)
            expectNoSeam(*sky, channel, false);
        for (int y = 0; y < sky->t(); ++y)
            for (int x = 0; x < sky->s(); ++x)
                ASSERT_EQ(sky->data(x, y)[3], 255);
    }
}

TEST(PanoramaSky, GoesFromWarmHazeToBlue)
{
    for (const double season : {0.0, 0.25, 0.5, 0.75})
    {
        const osg::ref_ptr<osg::Image> sky = makeSky(1024, 128, 5, season);
        const int top = sky->t() - 1;
        EXPECT_GT(mean(*sky, 0, 0, 2), mean(*sky, 2, 0, 2)) << "season " << season;
        EXPECT_GT(mean(*sky, 0, 0, 2), 0.85) << "season " << season;
        EXPECT_GT(mean(*sky, 2, top - 2, top), mean(*sky, 0, top - 2, top) + 0.3) << "season " << season;
        // Clouds, and sky between them.
        EXPECT_GT(white(*sky, 30), 0.04) << "season " << season;
        EXPECT_LT(white(*sky, 30), 0.5) << "season " << season;
    }
    const auto warmth = [](double season)
    {
        const osg::ref_ptr<osg::Image> sky = makeSky(512, 64, 5, season);
        return mean(*sky, 0, 0, 1) - mean(*sky, 2, 0, 1);
    };
    EXPECT_GT(warmth(0.75), warmth(0.5));
    EXPECT_LT(warmth(0.0), warmth(0.5));
}

TEST(PanoramaSky, SeedsArrangeIt)
{
    const osg::ref_ptr<osg::Image> sky = makeSky(512, 64, 1);
    EXPECT_TRUE(equal(*sky, *makeSky(512, 64, 1)));
    EXPECT_FALSE(equal(*sky, *makeSky(512, 64, 2)));
    // Nothing comes twice in a turn.
    for (int shift = 64; shift <= 256; shift += 16)
    {
        double sum = 0.0;
        for (int y = 16; y < 48; ++y)
            for (int x = 0; x < 512; ++x)
                sum += std::abs(part(*sky, x, y, 0) - part(*sky, (x + shift) % 512, y, 0));
        EXPECT_GT(sum / (32 * 512), 0.04) << shift;
    }
    EXPECT_EQ(makeSky(1, 1)->s(), 64);
    EXPECT_EQ(makeSky(1, 1)->t(), 32);
}
