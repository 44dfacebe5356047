// SPDX-License-Identifier: MIT
// SPDX-FileCopyrightText: 2026 the osgGeoFX authors
// The test tools themselves: a comparison that fails says where, and leaves the three pictures; a program's
// result is what a shell would report.
#include <tools/ImageComparison.h>
#include <tools/NotifyWatch.h>
#include <tools/TempDir.h>

#include <gtest/gtest-spi.h>
#include <gtest/gtest.h>
#include <osgDB/ReadFile>
#include <osgDB/WriteFile>

#include <cmath>
#include <cstring>
#include <limits>

using geofx::test::imagesMatch;
using geofx::test::ImageTolerance;

namespace
{

osg::ref_ptr<osg::Image> makeGrey(int width, int height, unsigned char value)
{
    osg::ref_ptr<osg::Image> image = new osg::Image;
    image->allocateImage(width, height, 1, GL_RGB, GL_UNSIGNED_BYTE);
    std::memset(image->data(), value, image->getTotalSizeInBytes());
    return image;
}

/// Ten by ten pixels of value 100, and one of them, 2 from the left, 3 from the top, of another green.
osg::ref_ptr<osg::Image> makeSpotted(unsigned char value)
{
    const osg::ref_ptr<osg::Image> image = makeGrey(10, 10, 100);
    image->data(2, 6)[1] = value;
    return image;
}

} // namespace

TEST(ImageComparison, AcceptsEqualImages)
{
    EXPECT_TRUE(imagesMatch(*makeSpotted(110), *makeSpotted(110)));
}

TEST(ImageComparison, ByDefaultRefusesTheLeastDifference)
{
    EXPECT_FALSE(imagesMatch(*makeSpotted(101), *makeSpotted(100)));
}

TEST(ImageComparison, HasThreeNumbers)
{
    const osg::ref_ptr<osg::Image> expected = makeGrey(10, 10, 100);
    // One pixel of a hundred is off by 10/255 = 0.039.
    EXPECT_TRUE(imagesMatch(*makeSpotted(110), *expected, {0.04f, 0.0, 0.04f}));
    EXPECT_TRUE(imagesMatch(*makeSpotted(110), *expected, {0.03f, 0.01, 0.04f}));
    EXPECT_FALSE(imagesMatch(*makeSpotted(110), *expected, {0.03f, 0.009, 0.04f}));
    EXPECT_FALSE(imagesMatch(*makeSpotted(110), *expected, {0.03f, 0.01, 0.035f}));
}

TEST(ImageComparison, NamesTheWorstPixelAndLeavesThreePictures)
{
    const std::filesystem::path folder = geofx::test::testOutputFolder();
    std::filesystem::remove_all(folder);
    const auto result = imagesMatch(*makeSpotted(110), *makeSpotted(100), {}, "spot");
    ASSERT_FALSE(result);
    const std::string message = result.message();
    EXPECT_NE(message.find("pixel (2, 3) from the upper left, channel 1"), std::string::npos) << message;
    EXPECT_EQ(folder.filename(), "ImageComparison.NamesTheWorstPixelAndLeavesThreePictures");
    for (const char* what : {"actual", "expected", "difference"})
    {
        const std::filesystem::path picture = folder / ("spot-" + std::string(what) + ".png");
        EXPECT_NE(message.find(picture), std::string::npos) << message;
        EXPECT_TRUE(std::filesystem::exists(picture));
    }
    EXPECT_TRUE(imagesMatch(*osgDB::readRefImageFile(folder / "spot-actual.png"), *makeSpotted(110)));
    EXPECT_TRUE(imagesMatch(*osgDB::readRefImageFile(folder / "spot-expected.png"), *makeSpotted(100)));
    const osg::ref_ptr<osg::Image> difference = makeGrey(10, 10, 0);
    difference->data(2, 6)[1] = 255;
    EXPECT_TRUE(imagesMatch(*osgDB::readRefImageFile(folder / "spot-difference.png"), *difference));
}

TEST(ImageComparison, RefusesAnotherSize)
{
    const auto result = imagesMatch(*makeGrey(10, 10, 100), *makeGrey(10, 11, 100));
    ASSERT_FALSE(result);
    EXPECT_NE(std::string(result.message()).find("10x10 pixels, 3 channels instead of 10x11"),
              std::string::npos)
        << result.message();
}

TEST(ImageComparison, RefusesNotANumber)
{
    osg::ref_ptr<osg::Image> images[2];
    for (osg::ref_ptr<osg::Image>& image : images)
    {
        image = new osg::Image;
        image->allocateImage(4, 4, 1, GL_RED, GL_FLOAT);
        std::memset(image->data(), 0, image->getTotalSizeInBytes());
    }
    EXPECT_TRUE(imagesMatch(*images[0], *images[1]));
    reinterpret_cast<float*>(images[0]->data())[5] = std::numeric_limits<float>::quiet_NaN();
    EXPECT_FALSE(imagesMatch(*images[0], *images[1], {1.0f, 1.0, 1.0f}));
}

TEST(ImageComparison, ReadsFiles)
{
    const geofx::test::TempDir folder;
    osgDB::writeImageFile(*makeSpotted(110), folder / "a.png");
    osgDB::writeImageFile(*makeSpotted(111), folder / "b.png");
    EXPECT_TRUE(imagesMatch(folder / "a.png", folder / "a.png"));
    EXPECT_FALSE(imagesMatch(folder / "a.png", folder / "b.png"));
    EXPECT_FALSE(imagesMatch(folder / "a.png", folder / "none.png"));
}

TEST(TempDir, IsGoneAfterwards)
{
    std::filesystem::path path;
    {
        const geofx::test::TempDir folder;
        path = folder.write("deep/file", "text");
        EXPECT_TRUE(std::filesystem::exists(path));
    }
    EXPECT_FALSE(std::filesystem::exists(path.parent_path().parent_path()));
}

TEST(NotifyWatch, MakesNoticesOfOsgFatal)
{
    geofx::test::NotifyWatch watch;
    EXPECT_NONFATAL_FAILURE(OSG_WARN << "osgGeoFX: a deliberate warning" << std::endl,
                            "a deliberate warning");
    OSG_INFO << "harmless" << std::endl;
    const auto messages = watch.messagesOf([] { OSG_WARN << "expected" << std::endl; });
    ASSERT_EQ(messages.size(), 1u);
    EXPECT_EQ(messages[0], "OSG: expected\n");
    EXPECT_NONFATAL_FAILURE(OSG_NOTICE << "a deliberate notice" << std::endl, "a deliberate notice");
    EXPECT_NONFATAL_FAILURE(OSG_FATAL << "fatal again" << std::endl, "fatal again");
}
