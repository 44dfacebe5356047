// SPDX-License-Identifier: MIT
// SPDX-FileCopyrightText: 2026 the osgGeoFX authors
//
// Pictures and color tables that go through files, and what is left of them.
#pragma once

#include <osgGeoFX/raster/ColorTable.h>
#include <tools/RandomSamples.h>

#include <osg/Image>

#include <gtest/gtest.h>

#include <cstring>
#include <limits>

namespace geofx::test
{

inline osg::ref_ptr<osg::Image> byteImage()
{
    osg::ref_ptr<osg::Image> image = new osg::Image;
    image->allocateImage(5, 3, 1, GL_RGBA, GL_UNSIGNED_BYTE);
    for (unsigned int i = 0; i < image->getTotalSizeInBytes(); ++i)
        image->data()[i] = static_cast<unsigned char>(i * 37);
    return image;
}

inline osg::ref_ptr<osg::Image> floatImage()
{
    osg::ref_ptr<osg::Image> image = new osg::Image;
    image->allocateImage(4, 2, 1, GL_RED, GL_FLOAT);
    auto* values = reinterpret_cast<float*>(image->data());
    for (int i = 0; i < 8; ++i)
        values[i] = static_cast<float>(i) / 3.0f - 1e6f;
    values[3] = std::numeric_limits<float>::quiet_NaN();
    values[4] = -0.0f;
    return image;
}

inline osg::ref_ptr<osgGeoFX::ColorTable> sampleTable(int seed)
{
    Random random(static_cast<std::uint64_t>(seed));
    osg::ref_ptr<osgGeoFX::ColorTable> table = new osgGeoFX::ColorTable;
    table->setMode(static_cast<osgGeoFX::ColorTable::Mode>(seed % 4));
    const auto color = [&]
    {
        osg::Vec4 result;
        for (int i = 0; i < 4; ++i)
            result[i] = static_cast<float>(random.uniform(0.0, 1.0));
        return result;
    };
    for (int i = seed % 7; i > 0; --i)
    {
        const double value = random.uniform(-1e4, 1e4) * random.logarithmic(1e-9, 1e3);
        table->addStop(value, color());
        // A jump.
        if (i % 2 == 0) table->addStop(value, color());
    }
    if (seed % 3 != 0) table->setNoDataColor(color());
    return table;
}

inline void expectSameTable(const osgGeoFX::ColorTable* actual, const osgGeoFX::ColorTable* expected)
{
    ASSERT_EQ(!actual, !expected);
    if (!expected) return;
    EXPECT_EQ(actual->getName(), expected->getName());
    EXPECT_EQ(actual->getMode(), expected->getMode());
    EXPECT_EQ(actual->getNoDataColor(), expected->getNoDataColor());
    ASSERT_EQ(actual->getStops().size(), expected->getStops().size());
    for (std::size_t i = 0; i < expected->getStops().size(); ++i)
    {
        EXPECT_EQ(actual->getStops()[i].value, expected->getStops()[i].value);
        EXPECT_EQ(actual->getStops()[i].color, expected->getStops()[i].color);
    }
}

inline void expectSameImage(const osg::Image* actual, const osg::Image* expected)
{
    ASSERT_EQ(!actual, !expected);
    if (!expected) return;
    EXPECT_EQ(actual->s(), expected->s());
    EXPECT_EQ(actual->t(), expected->t());
    EXPECT_EQ(actual->getPixelFormat(), expected->getPixelFormat());
    EXPECT_EQ(actual->getDataType(), expected->getDataType());
    ASSERT_EQ(actual->getTotalSizeInBytes(), expected->getTotalSizeInBytes());
    EXPECT_EQ(std::memcmp(actual->data(), expected->data(), expected->getTotalSizeInBytes()), 0);
}

} // namespace geofx::test
