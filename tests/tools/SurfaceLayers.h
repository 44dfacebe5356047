// SPDX-License-Identifier: MIT
// SPDX-FileCopyrightText: 2026 the osgGeoFX authors
#pragma once

#include <osg/Image>

#include <algorithm>
#include <array>
#include <limits>

namespace geofx::test
{

/// Of a layer of surface data.
using Texel = std::array<float, 4>;

inline osg::ref_ptr<osg::Image> layerImage(int width, int height, GLenum format = GL_RGBA,
                                           GLenum type = GL_FLOAT)
{
    osg::ref_ptr<osg::Image> image = new osg::Image;
    image->allocateImage(width, height, 1, format, type);
    std::fill_n(image->data(), image->getTotalSizeInBytes(), static_cast<unsigned char>(0));
    return image;
}

inline float* texelOf(osg::Image& image, int x, int y)
{
    return reinterpret_cast<float*>(image.data(static_cast<unsigned int>(x), static_cast<unsigned int>(y)));
}

inline Texel texelAt(const osg::Image& image, int x, int y)
{
    const auto* texel = reinterpret_cast<const float*>(
        image.data(static_cast<unsigned int>(x), static_cast<unsigned int>(y)));
    return {texel[0], texel[1], texel[2], texel[3]};
}

inline double valueAt(const osg::Image& image, int x, int y)
{
    return static_cast<double>(texelAt(image, x, y)[0]);
}

inline bool hasTexel(const osg::Image& image, int x, int y)
{
    return texelAt(image, x, y)[3] > 0.0f;
}

constexpr double none = std::numeric_limits<double>::quiet_NaN();

} // namespace geofx::test
