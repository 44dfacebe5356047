// SPDX-License-Identifier: MIT
// SPDX-FileCopyrightText: 2026 the osgGeoFX authors
#pragma once

#include <osgGeoFX/terrain/DatabaseBuilder.h>

#include <osg/Image>

#include <array>
#include <cstdint>

namespace osgGeoFX
{

/// The bytes of textures and the errors of compression, in whole numbers. So their sums do not depend on the order.
struct TextureFigures
{
    std::uint64_t bytes = 0, uncompressedBytes = 0; ///< as in TextureSummary
    std::uint64_t colorTexels = 0, normalTexels = 0;
    /// Sums of squared differences, and the largest ones: red, green, blue of colors, x and y of normals.
    std::array<std::uint64_t, 5> squares{}, largest{};

    void add(const TextureFigures& other);
    TextureSummary summary() const;
};

/** Makes textures' images of a tile's images: unchanged, or compressed. A compressed image has blocks of 4 × 4
    texels. Texels beyond the original repeat its last ones. The object counts all of them.

    OSG 3.6 reports an error for a compressed texture with other edges (Texture::applyTexImage2D_load). Not
    thread-safe. */
class TileTextures
{
public:
    explicit TileTextures(bool compress) : _compress(compress) {}

    /// Texels along the edge of a block of a compressed texture.
    static constexpr int BLOCK = 4;

    /// An image that can be compressed, with its mipmaps: three channels are colors (BC1), two are normals (BC5,
    /// RGTC2).
    osg::ref_ptr<osg::Image> picture(const osg::ref_ptr<osg::Image>& image);
    /// An image that must not change. OpenGL makes its mipmaps, or it has none.
    osg::ref_ptr<osg::Image> data(const osg::ref_ptr<osg::Image>& image, bool mipmaps);

    const TextureFigures& figures() const { return _figures; }
    void forget() { _figures = {}; }

private:
    osg::ref_ptr<osg::Image> widened(const osg::ref_ptr<osg::Image>& image) const;
    void count(const osg::Image& before, const unsigned char* blocks);

    const bool _compress;
    TextureFigures _figures;
};

} // namespace osgGeoFX
