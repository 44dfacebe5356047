// SPDX-License-Identifier: MIT
// SPDX-FileCopyrightText: 2026 the osgGeoFX authors
//
// Layers of surface data: what is taken and what is refused, where it lies, and colors from images.
#include <osgGeoFX/closeup/SurfaceData.h>
#include <tools/NotifyWatch.h>
#include <tools/SurfaceLayers.h>

#include <gtest/gtest.h>
#include <osg/Math>

#include <array>
#include <cmath>
#include <cstring>
#include <functional>
#include <limits>
#include <string>
#include <utility>
#include <vector>

namespace
{

using geofx::test::layerImage;
using geofx::test::none;
using geofx::test::NotifyWatch;
using geofx::test::Texel;
using geofx::test::texelAt;
using geofx::test::texelOf;
using geofx::test::valueAt;
using osgGeoFX::SurfaceData;

class SurfaceDataLayers : public testing::Test
{
protected:
    NotifyWatch _watch;

    bool isRefused(const std::function<bool()>& action, const std::string& words)
    {
        bool taken = true;
        const std::vector<std::string> messages = _watch.messagesOf([&] { taken = action(); });
        EXPECT_EQ(messages.size(), 1u);
        return !taken && messages.size() == 1 && messages[0].find(words) != std::string::npos;
    }
};

TEST_F(SurfaceDataLayers, AreFoundByTheirNamesUntilTheyAreRemoved)
{
    const osg::ref_ptr<SurfaceData> data = new SurfaceData;
    EXPECT_EQ(data->getNumLayers(), 0);
    EXPECT_EQ(data->getWidth(), 0);
    EXPECT_EQ(data->getSpacing(), osg::Vec2d());
    EXPECT_TRUE(data->setRectangle(osg::Vec2d(-100.0, 0.0), osg::Vec2d(300.0, 90.0)));
    const osg::ref_ptr<osg::Image> first = layerImage(8, 6);
    const osg::ref_ptr<osg::Image> second = layerImage(8, 6);
    const unsigned int before = data->revision();
    EXPECT_TRUE(data->addLayer("a", SurfaceData::HEIGHT, first));
    EXPECT_TRUE(data->addLayer("b", SurfaceData::CLASS, second));
    EXPECT_EQ(data->revision(), before + 2);
    EXPECT_EQ(data->getNumLayers(), 2);
    EXPECT_EQ(data->findLayer("b"), 1);
    EXPECT_EQ(data->findLayer("c"), -1);
    EXPECT_EQ(data->getLayerName(1), "b");
    EXPECT_EQ(data->getLayerKind(1), SurfaceData::CLASS);
    EXPECT_EQ(data->getLayerImage(1), second);
    EXPECT_EQ(data->getWidth(), 8);
    EXPECT_EQ(data->getHeight(), 6);
    EXPECT_EQ(data->getSpacing(), osg::Vec2d(50.0, 15.0));
    EXPECT_FALSE(data->removeLayer("c"));
    EXPECT_EQ(data->revision(), before + 2);
    EXPECT_TRUE(data->removeLayer("a"));
    EXPECT_EQ(data->revision(), before + 3);
    EXPECT_EQ(data->findLayer("b"), 0);
    EXPECT_TRUE(data->removeLayer("b"));
    EXPECT_TRUE(data->addLayer("c", SurfaceData::COLOR, layerImage(3, 3))) << "an empty one takes any size";
}

TEST_F(SurfaceDataLayers, OfNoUseAreRefused)
{
    const osg::ref_ptr<SurfaceData> data = new SurfaceData;
    const osg::ref_ptr<osg::Image> good = layerImage(8, 6);
    ASSERT_TRUE(data->addLayer("a", SurfaceData::HEIGHT, good));
    const unsigned int before = data->revision();
    const auto refuses =
        [&](const std::string& name, const osg::ref_ptr<osg::Image>& image, const std::string& words)
    {
        return isRefused([&] { return data->addLayer(name, SurfaceData::VALUE, image); }, words);
    };
    EXPECT_TRUE(refuses("b", nullptr, "GL_RGBA"));
    EXPECT_TRUE(refuses("b", new osg::Image, "GL_RGBA"));
    EXPECT_TRUE(refuses("", good, "needs a name"));
    EXPECT_TRUE(refuses("a", good, "remove it first"));
    EXPECT_TRUE(refuses("b", layerImage(8, 5), "8 × 5 texels"));
    EXPECT_TRUE(refuses("b", layerImage(6, 6), "the first layer's 8 × 6"));
    EXPECT_TRUE(refuses("b", layerImage(8, 6, GL_RGB), "GL_RGBA"));
    EXPECT_TRUE(refuses("b", layerImage(8, 6, GL_RGBA, GL_UNSIGNED_BYTE), "GL_FLOAT"));
    const osg::ref_ptr<osg::Image> fromAbove = layerImage(8, 6);
    fromAbove->setOrigin(osg::Image::TOP_LEFT);
    EXPECT_TRUE(refuses("b", fromAbove, "from below"));
    EXPECT_TRUE(isRefused([&] { return data->addLayer("b", static_cast<SurfaceData::Kind>(8), good); },
                          "kind is not known"));
    const osg::ref_ptr<SurfaceData> large = new SurfaceData;
    EXPECT_TRUE(
        isRefused([&] { return large->addLayer("b", SurfaceData::VALUE, layerImage(16385, 1)); }, "16384"));
    EXPECT_TRUE(large->addLayer("b", SurfaceData::VALUE, layerImage(1, 16384)));
    EXPECT_TRUE(isRefused([&] { return large->addDerived("c", SurfaceData::SLOPE); }, "layer of heights"));
    EXPECT_TRUE(isRefused([&] { return data->addDerived("c", SurfaceData::COLOR); }, "derives"));
    EXPECT_TRUE(isRefused([&] { return data->addDerived("a", SurfaceData::SLOPE); }, "remove it first"));
    EXPECT_EQ(data->getNumLayers(), 1);
    EXPECT_EQ(data->revision(), before);
}

TEST_F(SurfaceDataLayers, LieInARectangleThatHasAnArea)
{
    const osg::ref_ptr<SurfaceData> data = new SurfaceData;
    EXPECT_EQ(data->getLow(), osg::Vec2d(-1000.0, -1000.0));
    EXPECT_EQ(data->getHigh(), osg::Vec2d(1000.0, 1000.0));
    // All at once, so that it may move beyond itself.
    EXPECT_TRUE(data->setRectangle(osg::Vec2d(5000.0, 6000.0), osg::Vec2d(7000.0, 9000.0)));
    for (const osg::Vec2d& high : {osg::Vec2d(5000.0, 9000.0), osg::Vec2d(7000.0, 5999.0),
                                   osg::Vec2d(none, 9000.0), osg::Vec2d(1e9, 9000.0)})
        EXPECT_TRUE(isRefused([&] { return data->setRectangle(osg::Vec2d(5000.0, 6000.0), high); },
                              "The former values stay"));
    EXPECT_EQ(data->getLow(), osg::Vec2d(5000.0, 6000.0));
    EXPECT_EQ(data->getHigh(), osg::Vec2d(7000.0, 9000.0));

    EXPECT_TRUE(data->setOrigin(osg::Vec2d(400.0, 500.0)));
    EXPECT_EQ(osg::Vec3d(1.0, 2.0, 3.0) * data->frameToWorld(nullptr), osg::Vec3d(401.0, 502.0, 3.0));
    const osg::ref_ptr<osg::EllipsoidModel> ellipsoid = new osg::EllipsoidModel;
    EXPECT_TRUE(data->setGeodeticOrigin(0.5 * osg::PI, 0.0));
    const osg::Vec3d world = osg::Vec3d(1.0, 2.0, 3.0) * data->frameToWorld(ellipsoid);
    EXPECT_NEAR(world.x(), -1.0, 1e-6) << "east at 90° E";
    EXPECT_NEAR(world.y(), 6378137.0 + 3.0, 1e-6);
    EXPECT_NEAR(world.z(), 2.0, 1e-6);
}

TEST_F(SurfaceDataLayers, AreSharedOrCopiedWithTheirObject)
{
    const osg::ref_ptr<SurfaceData> data = new SurfaceData;
    data->setRectangle(osg::Vec2d(1.0, 2.0), osg::Vec2d(3.0, 4.0));
    data->setOrigin(osg::Vec2d(5.0, 6.0));
    data->setGeodeticOrigin(0.7, 0.8);
    ASSERT_TRUE(data->addLayer("a", SurfaceData::HEIGHT, layerImage(2, 2)));
    const osg::ref_ptr<SurfaceData> shallow = new SurfaceData(*data);
    const osg::ref_ptr<SurfaceData> deep = new SurfaceData(*data, osg::CopyOp::DEEP_COPY_ALL);
    for (const osg::ref_ptr<SurfaceData>& each : {shallow, deep})
    {
        EXPECT_EQ(each->getLow(), osg::Vec2d(1.0, 2.0));
        EXPECT_EQ(each->getHigh(), osg::Vec2d(3.0, 4.0));
        EXPECT_EQ(each->getOrigin(), osg::Vec2d(5.0, 6.0));
        EXPECT_EQ(each->getLongitude(), 0.7);
        EXPECT_EQ(each->getLatitude(), 0.8);
        EXPECT_EQ(each->getLayerKind(0), SurfaceData::HEIGHT);
    }
    EXPECT_EQ(shallow->getLayerImage(0), data->getLayerImage(0));
    EXPECT_NE(deep->getLayerImage(0), data->getLayerImage(0));
}

TEST_F(SurfaceDataLayers, OfColorsComeFromAnyPlainImage)
{
    struct Format
    {
        GLenum format;
        std::vector<int> bytes;
        std::array<int, 4> color;
    };
    const Format formats[] = {
        {GL_RGB, {51, 102, 153}, {51, 102, 153, 255}},
        {GL_RGBA, {51, 102, 153, 204}, {51, 102, 153, 204}},
        {GL_BGR, {51, 102, 153}, {153, 102, 51, 255}},
        {GL_BGRA, {51, 102, 153, 204}, {153, 102, 51, 204}},
        {GL_LUMINANCE, {51}, {51, 51, 51, 255}},
        {GL_LUMINANCE_ALPHA, {51, 204}, {51, 51, 51, 204}},
        {GL_INTENSITY, {51}, {51, 51, 51, 51}},
        {GL_ALPHA, {51}, {255, 255, 255, 51}},
        {GL_RED, {51}, {51, 0, 0, 255}},
        {GL_RG, {51, 102}, {51, 102, 0, 255}},
    };
    for (const Format& format : formats)
    {
        SCOPED_TRACE(format.format);
        // Three wide, in rows that begin at multiples of four bytes.
        const osg::ref_ptr<osg::Image> image = new osg::Image;
        image->allocateImage(3, 2, 1, format.format, GL_UNSIGNED_BYTE, 4);
        for (unsigned int x = 0; x < 3; ++x)
            for (unsigned int y = 0; y < 2; ++y)
                for (std::size_t channel = 0; channel < format.bytes.size(); ++channel)
                    image->data(x, y)[channel] =
                        static_cast<unsigned char>(x == 2 && y == 1 ? format.bytes[channel] : 7);
        for (const bool fromAbove : {false, true})
        {
            image->setOrigin(fromAbove ? osg::Image::TOP_LEFT : osg::Image::BOTTOM_LEFT);
            const osg::ref_ptr<osg::Image> layer = SurfaceData::toLayer(*image);
            ASSERT_TRUE(layer);
            const Texel texel = texelAt(*layer, 2, fromAbove ? 0 : 1);
            for (std::size_t channel = 0; channel < 4; ++channel)
                EXPECT_NEAR(static_cast<double>(texel[channel]), format.color[channel] / 255.0, 1e-6)
                    << channel;
            EXPECT_NE(texelAt(*layer, 2, fromAbove ? 1 : 0), texel);
            const osg::ref_ptr<SurfaceData> data = new SurfaceData;
            EXPECT_TRUE(data->addLayer("a", SurfaceData::COLOR, layer));
        }
    }
    const auto firstOf = [](GLenum type, const auto& number)
    {
        const osg::ref_ptr<osg::Image> image = layerImage(1, 1, GL_RED, type);
        std::memcpy(image->data(), &number, sizeof(number));
        return static_cast<double>(texelAt(*SurfaceData::toLayer(*image), 0, 0)[0]);
    };
    EXPECT_NEAR(firstOf(GL_BYTE, GLbyte(64)), 64.0 / 127.0, 1e-6);
    EXPECT_EQ(firstOf(GL_BYTE, GLbyte(-64)), 0.0);
    EXPECT_NEAR(firstOf(GL_SHORT, GLshort(16384)), 0.5, 1e-4);
    EXPECT_NEAR(firstOf(GL_UNSIGNED_SHORT, GLushort(32768)), 0.5, 1e-4);
    EXPECT_NEAR(firstOf(GL_INT, GLint(1) << 30), 0.5, 1e-4);
    EXPECT_NEAR(firstOf(GL_UNSIGNED_INT, GLuint(1) << 31), 0.5, 1e-4);
    EXPECT_NEAR(firstOf(GL_FLOAT, 0.25f), 0.25, 1e-7);
    EXPECT_EQ(firstOf(GL_FLOAT, 7.0f), 1.0);
    EXPECT_EQ(firstOf(GL_FLOAT, std::numeric_limits<float>::quiet_NaN()), 0.0);

    const auto refuses = [&](const osg::ref_ptr<osg::Image>& image, int width, int height)
    {
        return isRefused([&] { return SurfaceData::toLayer(*image, width, height).valid(); }, "plain RGB");
    };
    EXPECT_TRUE(refuses(new osg::Image, 0, 0));
    EXPECT_TRUE(refuses(layerImage(4, 4, GL_RGBA, GL_HALF_FLOAT), 0, 0));
    EXPECT_TRUE(refuses(layerImage(4, 4, GL_DEPTH_COMPONENT), 0, 0));
    EXPECT_TRUE(refuses(layerImage(4, 4), -1, 4));
    EXPECT_TRUE(refuses(layerImage(4, 4), 4, 16385));
    const osg::ref_ptr<osg::Image> deep = new osg::Image;
    deep->allocateImage(4, 4, 2, GL_RGBA, GL_FLOAT);
    EXPECT_TRUE(refuses(deep, 0, 0));
}

TEST_F(SurfaceDataLayers, OfAnotherSizeAreAveragedOrInterpolated)
{
    const osg::ref_ptr<osg::Image> image = layerImage(64, 48);
    for (int y = 0; y < 48; ++y)
        for (int x = 0; x < 64; ++x)
        {
            float* texel = texelOf(*image, x, y);
            const bool dark = (x + y) % 2 == 0;
            texel[0] = static_cast<float>(x + 0.5) / 64.0f; // a ramp
            texel[1] = dark ? 0.0f : 1.0f;                  // a fine pattern
            texel[2] = dark ? 0.75f : 0.0f;                 // one that only half of the texels show
            texel[3] = dark ? 1.0f : 0.0f;
        }
    for (const auto& [width, height] : {std::pair(16, 12), std::pair(23, 48), std::pair(64, 7)})
    {
        const osg::ref_ptr<osg::Image> less = SurfaceData::toLayer(*image, width, height);
        ASSERT_EQ(less->s(), width);
        ASSERT_EQ(less->t(), height);
        for (int y = 1; y < height - 1; ++y)
            for (int x = 1; x < width - 1; ++x)
            {
                const Texel texel = texelAt(*less, x, y);
                EXPECT_NEAR(static_cast<double>(texel[0]), (x + 0.5) / width, 0.01);
                EXPECT_EQ(texel[1], 0.0f) << "transparent ones do not bleed";
                EXPECT_NEAR(static_cast<double>(texel[2]), 0.75, 1e-5);
                // Where sizes do not divide, a trace of the finest pattern stays.
                EXPECT_NEAR(static_cast<double>(texel[3]), 0.5, 0.06);
            }
    }
    for (int y = 0; y < 48; ++y)
        for (int x = 0; x < 64; ++x)
            texelOf(*image, x, y)[3] = 1.0f;
    const osg::ref_ptr<osg::Image> more = SurfaceData::toLayer(*image, 160, 100);
    for (int x = 2; x < 158; ++x)
        EXPECT_NEAR(valueAt(*more, x, 50), (x + 0.5) / 160.0, 1e-5);
    EXPECT_NEAR(valueAt(*more, 0, 0), valueAt(*image, 0, 0), 1e-6) << "no black border";
}

} // namespace
