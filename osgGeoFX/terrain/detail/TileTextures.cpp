// SPDX-License-Identifier: MIT
// SPDX-FileCopyrightText: 2026 the osgGeoFX authors
#include <osgGeoFX/terrain/detail/TileTextures.h>

#include <osg/Texture>

#include <squish.h>

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <cstdlib>
#include <cstring>
#include <vector>

namespace osgGeoFX
{

namespace
{

constexpr int BLOCK = TileTextures::BLOCK;

/// The bytes of a block's texels for libsquish: red, green, blue, alpha of each, row by row.
constexpr std::size_t BLOCK_RGBA = 4 * BLOCK * BLOCK;

int channelsOf(const osg::Image& image)
{
    return static_cast<int>(image.getPixelSizeInBits() / 8);
}

/// The bytes of a texture and its mipmaps, down to a single texel.
std::uint64_t chainBytes(int size, GLenum format, bool mipmaps)
{
    std::uint64_t bytes = 0;
    for (;; size /= 2)
    {
        bytes += osg::Image::computeImageSizeInBytes(size, size, 1, format, GL_UNSIGNED_BYTE, 1);
        if (size == 1 || !mipmaps) return bytes;
    }
}

/// Halves a line of texels to the number of OpenGL's next mipmap. If the number is odd, each new texel is the mean of
/// a little more than two. `stride` is the way from texel to texel, in the source and in the target.
void halveLine(const float* from, float* to, int size, std::size_t stride)
{
    const int half = size / 2;
    const double width = static_cast<double>(size) / half;
    for (int i = 0; i < half; ++i)
    {
        const double low = i * width, high = std::min<double>((i + 1) * width, size);
        double sum = 0.0;
        for (int k = static_cast<int>(low); k < high; ++k)
            sum += (std::min(high, k + 1.0) - std::max<double>(low, k)) *
                   static_cast<double>(from[static_cast<std::size_t>(k) * stride]);
        to[static_cast<std::size_t>(i) * stride] = static_cast<float>(sum / (high - low));
    }
}

/// The next mipmap. Means stay unrounded from one mipmap to the next; rounding would shift the smallest ones.
std::vector<float> halved(const std::vector<float>& texels, int size)
{
    const auto all = static_cast<std::size_t>(size), half = all / 2;
    std::vector<float> narrow(all * half * 4), result(half * half * 4), line(all * 4);
    for (std::size_t row = 0; row < all; ++row)
        for (std::size_t channel = 0; channel < 4; ++channel)
            halveLine(texels.data() + row * all * 4 + channel, narrow.data() + row * half * 4 + channel, size,
                      4);
    for (std::size_t column = 0; column < half; ++column)
        for (std::size_t channel = 0; channel < 4; ++channel)
            halveLine(narrow.data() + column * 4 + channel, result.data() + column * 4 + channel, size,
                      half * 4);
    return result;
}

/// The blocks of an image. squish::CompressImage would use threads of its own for each image (OpenMP). They never
/// sleep while they wait for the next image, and our workers have all cores already.
void encode(const std::vector<float>& texels, int size, int flags, unsigned char* blocks)
{
    const int bytes = squish::GetStorageRequirements(BLOCK, BLOCK, flags);
    for (int y = 0; y < size; y += BLOCK)
        for (int x = 0; x < size; x += BLOCK, blocks += bytes)
        {
            std::array<unsigned char, BLOCK_RGBA> rgba{};
            int within = 0; // one bit for each texel of the block within the image
            for (int row = y; row < std::min(y + BLOCK, size); ++row)
                for (int column = x; column < std::min(x + BLOCK, size); ++column)
                {
                    const int texel = (row - y) * BLOCK + column - x;
                    within |= 1 << texel;
                    std::transform(
                        texels.begin() + 4 * (static_cast<std::ptrdiff_t>(row) * size + column),
                        texels.begin() + 4 * (static_cast<std::ptrdiff_t>(row) * size + column + 1),
                        rgba.begin() + static_cast<std::ptrdiff_t>(4) * texel,
                        [](float value) { return static_cast<unsigned char>(std::lround(value)); });
                }
            squish::CompressMasked(rgba.data(), within, blocks, flags);
        }
}

/// The texels of a block, as a GPU reads it.
void decode(const unsigned char* block, bool colors, std::array<unsigned char, BLOCK_RGBA>& rgba)
{
    if (colors)
    {
        squish::Decompress(rgba.data(), block, squish::kDxt1);
        return;
    }
    // libsquish writes BC5 and does not read it. Each half of a BC5 block is the alpha part of a BC3 block.
    for (std::size_t channel = 0; channel < 2; ++channel)
    {
        std::array<unsigned char, 16> asBc3{};
        std::array<unsigned char, BLOCK_RGBA> half{};
        std::memcpy(asBc3.data(), block + 8 * channel, 8);
        squish::Decompress(half.data(), asBc3.data(), squish::kDxt5);
        for (std::size_t texel = 0; texel < BLOCK_RGBA; texel += 4)
            rgba[texel + channel] = half[texel + 3];
    }
}

} // namespace

void TextureFigures::add(const TextureFigures& other)
{
    bytes += other.bytes;
    uncompressedBytes += other.uncompressedBytes;
    colorTexels += other.colorTexels;
    normalTexels += other.normalTexels;
    for (std::size_t i = 0; i < squares.size(); ++i)
    {
        squares[i] += other.squares[i];
        largest[i] = std::max(largest[i], other.largest[i]);
    }
}

TextureSummary TextureFigures::summary() const
{
    TextureSummary result;
    result.bytes = bytes;
    result.uncompressedBytes = uncompressedBytes;
    const auto error = [&](std::size_t channel, std::uint64_t texels)
    {
        TextureError each;
        if (texels > 0)
            each.rootMeanSquare =
                std::sqrt(static_cast<double>(squares[channel]) / static_cast<double>(texels));
        each.largest = static_cast<int>(largest[channel]);
        return each;
    };
    for (std::size_t i = 0; i < result.colors.size(); ++i)
        result.colors[i] = error(i, colorTexels);
    for (std::size_t i = 0; i < result.normals.size(); ++i)
        result.normals[i] = error(result.colors.size() + i, normalTexels);
    return result;
}

osg::ref_ptr<osg::Image> TileTextures::widened(const osg::ref_ptr<osg::Image>& image) const
{
    const int size = (image->s() + BLOCK - 1) / BLOCK * BLOCK;
    if (!_compress || size == image->s()) return image;
    const auto channels = static_cast<std::size_t>(channelsOf(*image));
    osg::ref_ptr<osg::Image> result = new osg::Image;
    result->allocateImage(size, size, 1, image->getPixelFormat(), GL_UNSIGNED_BYTE, 1);
    result->setInternalTextureFormat(image->getInternalTextureFormat());
    for (int row = 0; row < size; ++row)
        for (int column = 0; column < size; ++column)
            std::memcpy(result->data(static_cast<unsigned int>(column), static_cast<unsigned int>(row)),
                        image->data(static_cast<unsigned int>(std::min(column, image->s() - 1)),
                                    static_cast<unsigned int>(std::min(row, image->t() - 1))),
                        channels);
    return result;
}

osg::ref_ptr<osg::Image> TileTextures::data(const osg::ref_ptr<osg::Image>& image, bool mipmaps)
{
    osg::ref_ptr<osg::Image> result = widened(image);
    _figures.bytes += chainBytes(result->s(), result->getPixelFormat(), mipmaps);
    _figures.uncompressedBytes += chainBytes(image->s(), image->getPixelFormat(), mipmaps);
    return result;
}

osg::ref_ptr<osg::Image> TileTextures::picture(const osg::ref_ptr<osg::Image>& image)
{
    if (!_compress) return data(image, true);
    const osg::ref_ptr<osg::Image> source = widened(image);
    const bool colors = channelsOf(*image) == 3;
    const GLenum format = colors ? GL_COMPRESSED_RGB_S3TC_DXT1_EXT : GL_COMPRESSED_RED_GREEN_RGTC2_EXT;
    const int flags = colors ? squish::kDxt1 | squish::kColourClusterFit : squish::kBc5;
    const int size = source->s();
    const std::uint64_t bytes = chainBytes(size, format, true);
    _figures.bytes += bytes;
    _figures.uncompressedBytes += chainBytes(image->s(), image->getPixelFormat(), true);

    const auto channels = static_cast<std::size_t>(channelsOf(*image));
    const std::size_t count = static_cast<std::size_t>(size) * static_cast<std::size_t>(size);
    std::vector<float> texels(4 * count, 255.0f);
    for (std::size_t i = 0; i < count; ++i)
        std::copy_n(source->data() + i * channels, channels, texels.data() + 4 * i);
    auto* const blocks = new unsigned char[bytes];
    osg::ref_ptr<osg::Image> result = new osg::Image;
    result->setImage(size, size, 1, static_cast<GLint>(format), format, GL_UNSIGNED_BYTE, blocks,
                     osg::Image::USE_NEW_DELETE, 1);
    osg::Image::MipmapDataType offsets;
    unsigned int offset = 0;
    for (int level = size;; level /= 2)
    {
        encode(texels, level, flags, blocks + offset);
        if (level == 1) break;
        offset += osg::Image::computeImageSizeInBytes(level, level, 1, format, GL_UNSIGNED_BYTE, 1);
        offsets.push_back(offset);
        texels = halved(texels, level);
    }
    result->setMipmapLevels(offsets);
    this->count(*image, blocks);
    return result;
}

void TileTextures::count(const osg::Image& before, const unsigned char* blocks)
{
    const auto channels = static_cast<std::size_t>(channelsOf(before));
    const bool colors = channels == 3;
    const std::size_t first = colors ? 0 : 3, bytes = colors ? 8 : 16;
    std::array<unsigned char, BLOCK_RGBA> rgba{};
    for (int y = 0; y < before.t(); y += BLOCK)
        for (int x = 0; x < before.s(); x += BLOCK, blocks += bytes)
        {
            decode(blocks, colors, rgba);
            for (int row = y; row < std::min(y + BLOCK, before.t()); ++row)
                for (int column = x; column < std::min(x + BLOCK, before.s()); ++column)
                {
                    const unsigned char* was =
                        before.data(static_cast<unsigned int>(column), static_cast<unsigned int>(row));
                    const unsigned char* is = rgba.data() + 4 * ((row - y) * BLOCK + column - x);
                    for (std::size_t channel = 0; channel < channels; ++channel)
                    {
                        const auto difference =
                            static_cast<std::uint64_t>(std::abs(was[channel] - is[channel]));
                        _figures.squares[first + channel] += difference * difference;
                        _figures.largest[first + channel] =
                            std::max(_figures.largest[first + channel], difference);
                    }
                }
        }
    (colors ? _figures.colorTexels : _figures.normalTexels) +=
        static_cast<std::uint64_t>(before.s()) * static_cast<std::uint64_t>(before.t());
}

} // namespace osgGeoFX
