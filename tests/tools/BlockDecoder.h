// SPDX-License-Identifier: MIT
// SPDX-FileCopyrightText: 2026 the osgGeoFX authors
#pragma once

#include <osg/Image>
#include <osg/Texture>

#include <algorithm>
#include <array>
#include <cstddef>
#include <cstdint>
#include <cstring>
#include <stdexcept>

namespace geofx::test
{

/// A value of RGTC (BC4, and each half of BC5): two ends and three bits for each texel, as GL_ARB_texture_compression_rgtc has it.
inline int valueOfRgtc(const unsigned char* block, int texel)
{
    std::uint64_t bits = 0;
    std::memcpy(&bits, block + 2, 6);
    const int code = static_cast<int>(bits >> (3 * texel) & 7), a = block[0], b = block[1];
    if (code < 2) return code == 0 ? a : b;
    if (a > b) return ((8 - code) * a + (code - 1) * b) / 7;
    if (code < 6) return ((6 - code) * a + (code - 1) * b) / 5;
    return code == 6 ? 0 : 255;
}

/// A color of DXT1 (BC1): two ends of 5, 6 and 5 bits and two bits for each texel, as GL_EXT_texture_compression_s3tc has it.
inline std::array<int, 3> colorOfDxt1(const unsigned char* block, int texel)
{
    const int ends[] = {block[0] | block[1] << 8, block[2] | block[3] << 8};
    const int code = block[4 + texel / 4] >> (2 * (texel % 4)) & 3;
    std::array<int, 3> result{};
    for (std::size_t channel = 0; channel < 3; ++channel)
    {
        const auto end = [&](std::size_t which)
        {
            const int bits = channel == 1 ? 6 : 5, shift = channel == 0 ? 11 : channel == 1 ? 5 : 0;
            const int value = ends[which] >> shift & ((1 << bits) - 1);
            return value << (8 - bits) | value >> (2 * bits - 8);
        };
        const bool four = ends[0] > ends[1];
        result[channel] = code < 2    ? end(static_cast<std::size_t>(code))
                          : four      ? (code == 2 ? (2 * end(0) + end(1)) / 3 : (end(0) + 2 * end(1)) / 3)
                          : code == 2 ? (end(0) + end(1)) / 2
                                      : 0;
    }
    return result;
}

/// One of the mipmaps of a compressed image as bytes: GL_RGB of DXT1, GL_RG of RGTC2.
inline osg::ref_ptr<osg::Image> decoded(const osg::Image& image, unsigned int level = 0)
{
    const bool colors = image.getPixelFormat() == GL_COMPRESSED_RGB_S3TC_DXT1_EXT;
    if (!colors && image.getPixelFormat() != GL_COMPRESSED_RED_GREEN_RGTC2_EXT)
        throw std::runtime_error("this image is not compressed");
    const int width = std::max(image.s() >> level, 1), height = std::max(image.t() >> level, 1);
    osg::ref_ptr<osg::Image> result = new osg::Image;
    result->allocateImage(width, height, 1, colors ? GL_RGB : GL_RG, GL_UNSIGNED_BYTE, 1);
    for (int row = 0; row < height; ++row)
        for (int column = 0; column < width; ++column)
        {
            const int index = row / 4 * ((width + 3) / 4) + column / 4, texel = row % 4 * 4 + column % 4;
            const unsigned char* block = image.getMipmapData(level) + index * (colors ? 8 : 16);
            unsigned char* bytes =
                result->data(static_cast<unsigned int>(column), static_cast<unsigned int>(row));
            if (colors)
                for (const int value : colorOfDxt1(block, texel))
                    *bytes++ = static_cast<unsigned char>(value);
            else
                for (const int half : {0, 8})
                    *bytes++ = static_cast<unsigned char>(valueOfRgtc(block + half, texel));
        }
    return result;
}

} // namespace geofx::test
