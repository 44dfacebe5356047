// SPDX-License-Identifier: MIT
// SPDX-FileCopyrightText: 2026 the osgGeoFX authors
// Colors of mappings that random scenes against the CPU do not tell of: linear light, and neighbours on a page.
#include <tools/MappingStage.h>

#include <cmath>
#include <cstring>

using namespace geofx::test;
using namespace osgGeoFX;

class MappingColors : public MappingStage
{
};

TEST_F(MappingColors, AreMadeLinearAsSRgbSays)
{
    lookDown({0.0, 0.0}, 2.0);
    _mappings->setLinear(true);
    const osg::ref_ptr<ProjectiveMapping> mapping = makeSolid({0.0, 0.0}, 100.0, {0.0, 0.0, 0.0});
    _mappings->addMapping(mapping);
    // IEC 61966-2-1, on both sides of where its curve begins.
    const auto linear = [](double shade)
    {
        return shade <= 0.04045 ? shade / 12.92 : std::pow((shade + 0.055) / 1.055, 2.4);
    };
    for (const double shade : {0.0, 0.02, 0.04, 0.1, 0.3, 0.5, 0.8, 1.0})
    {
        mapping->getTransfer()->setConstant({shade, 1.0 - shade, 0.5 * shade, 1.0});
        const osg::Vec3d drawn = at(*draw(), pixelOf(osg::Vec2d(0.0, 0.0)));
        const osg::Vec3d expected(linear(shade), linear(1.0 - shade), linear(0.5 * shade));
        EXPECT_LE(difference(drawn, expected), tolerance) << shade << ": " << drawn.x();
    }
}

TEST_F(MappingColors, OfNeighboursOnAPageDoNotMix)
{
    // Four pictures fill a page; each seen at levels between two, to its very edges.
    _mappings->setPageSide(256);
    const osg::Vec3d colors[4] = {{0.9, 0.1, 0.1}, {0.1, 0.9, 0.1}, {0.1, 0.1, 0.9}, {0.9, 0.9, 0.9}};
    const double half = 450.0;
    for (int i = 0; i < 4; ++i)
        _mappings->addMapping(
            makePicture({i % 2 ? 480.0 : -480.0, i / 2 ? 480.0 : -480.0}, half, makeImage(128, colors[i])));
    for (const double level : {0.3, 0.8, 1.2, 1.5, 1.9})
    {
        const double pixel = std::exp2(level) * 2.0 * half / 128.0;
        lookDown({0.0, 0.0}, pixel);
        const osg::ref_ptr<osg::Image> drawn = draw();
        for (int i = 0; i < 4; ++i)
        {
            const osg::Vec2d middle(i % 2 ? 480.0 : -480.0, i / 2 ? 480.0 : -480.0);
            const osg::Vec2d low = pixelOf(middle - osg::Vec2d(half, half));
            const osg::Vec2d high = pixelOf(middle + osg::Vec2d(half, half));
            for (int y = static_cast<int>(std::ceil(low.y())); y < std::floor(high.y()); ++y)
            {
                for (int x = static_cast<int>(std::ceil(low.x())); x < std::floor(high.x()); ++x)
                {
                    if (!inside({x + 0.5, y + 0.5})) continue;
                    ASSERT_LE(difference(at(*drawn, x, y), colors[i]), tolerance)
                        << "picture " << i << ", level " << level << ", pixel " << x << ", " << y;
                }
            }
        }
    }
    EXPECT_EQ(_mappings->capacity().pagesUsed, 1);
}

TEST_F(MappingColors, OfAnImageThatGrowsInPlaceAreIts)
{
    const osg::Vec3d before(0.9, 0.2, 0.1), after(0.2, 0.8, 0.3), other(0.1, 0.2, 0.9);
    lookDown({0.0, 0.0}, 2.0);
    const osg::ref_ptr<osg::Image> image = makeImage(16, before);
    _mappings->addMapping(makePicture({-80.0, 0.0}, 50.0, image));
    _mappings->addMapping(makePicture({80.0, 0.0}, 50.0, makeImage(16, other)));
    const osg::Vec2d here = pixelOf(osg::Vec2d(-80.0, 0.0)), there = pixelOf(osg::Vec2d(80.0, 0.0));
    EXPECT_TRUE(alike(at(*draw(), here), before));
    // It has no room any more where it is on the pages.
    const osg::ref_ptr<osg::Image> grown = makeImage(64, after);
    image->allocateImage(64, 64, 1, GL_RGBA, GL_UNSIGNED_BYTE);
    std::memcpy(image->data(), grown->data(), grown->getTotalSizeInBytes());
    image->dirty();
    const osg::ref_ptr<osg::Image> drawn = draw();
    EXPECT_TRUE(alike(at(*drawn, here), after)) << at(*drawn, here).x();
    EXPECT_TRUE(alike(at(*drawn, there), other)) << at(*drawn, there).x();
}

TEST_F(MappingColors, OfALayerThatHadToGoAreNoOtherLayers)
{
    const osg::Vec3d lesser(0.9, 0.2, 0.1), better(0.1, 0.2, 0.9);
    lookDown({0.0, 0.0}, 2.0);
    _mappings->setPageSide(64);
    _mappings->setMaxPages(1);
    const osg::Vec2d here = pixelOf(osg::Vec2d(-80.0, 0.0)), there = pixelOf(osg::Vec2d(80.0, 0.0));
    const osg::ref_ptr<ProjectiveMapping> first = makePicture({-80.0, 0.0}, 50.0, makeImage(64, lesser));
    first->getLayer()->setImportance(0.2);
    _mappings->addMapping(first);
    draw();
    EXPECT_TRUE(alike(at(*draw(), here), lesser));
    const osg::ref_ptr<ProjectiveMapping> second = makePicture({80.0, 0.0}, 50.0, makeImage(64, better));
    second->getLayer()->setImportance(0.9);
    _mappings->addMapping(second);
    osg::ref_ptr<osg::Image> drawn;
    EXPECT_EQ(watch().messagesOf([&] { drawn = draw(); }).size(), 1u);
    EXPECT_TRUE(alike(at(*drawn, here), groundColor())) << at(*drawn, here).x();
    EXPECT_TRUE(alike(at(*drawn, there), better)) << at(*drawn, there).x();
}
