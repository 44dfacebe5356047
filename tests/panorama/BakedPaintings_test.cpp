// SPDX-License-Identifier: MIT
// SPDX-FileCopyrightText: 2026 the osgGeoFX authors
//
// The images that are painted when the kit is built are those that would be painted now.
#include <osgGeoFX/panorama/PanoramaBrush.h>
#include <osgGeoFX/panorama/PanoramaSky.h>
#include <osgGeoFX/panorama/detail/PaintedImages.h>

#include <gtest/gtest.h>

#include <algorithm>

using namespace osgGeoFX;

namespace
{

bool equal(const osg::Image& a, const osg::Image& b)
{
    return a.s() == b.s() && a.t() == b.t() && a.getPixelFormat() == b.getPixelFormat() &&
           a.getTotalSizeInBytes() == b.getTotalSizeInBytes() &&
           std::equal(a.data(), a.data() + a.getTotalSizeInBytes(), b.data());
}

} // namespace

TEST(BakedPaintings, AreWhatWouldBePaintedNow)
{
    EXPECT_TRUE(equal(*makeSky(), *paintSky(4096, 256, 1, 0.5)));
    EXPECT_TRUE(equal(*makeBrushTexture(), *paintBrush(512)));
    // Any other wish is painted.
    EXPECT_TRUE(equal(*makeSky(4096, 256, 2), *paintSky(4096, 256, 2, 0.5)));
    EXPECT_FALSE(equal(*makeSky(4096, 256, 2), *makeSky()));
    EXPECT_FALSE(equal(*makeSky(4096, 256, 1, 0.75), *makeSky()));
}

// Each map has its own, which its owner may change.
TEST(BakedPaintings, AreCopies)
{
    const osg::ref_ptr<osg::Image> first = makeBrushTexture();
    const unsigned char before = *first->data();
    *first->data() = static_cast<unsigned char>(before + 1);
    EXPECT_EQ(*makeBrushTexture()->data(), before);
}
