// SPDX-License-Identifier: MIT
// SPDX-FileCopyrightText: 2026 the osgGeoFX authors
#pragma once

#include <osgGeoFX/terrain/DatabaseBuilder.h>

#include <osg/Image>

#include <array>
#include <cstdint>

namespace osgGeoFX
{

/// What textures take and what compression has changed in them: whole numbers, so that they add up to the same in any order.
struct TextureFigures
{
    std::uint64_t bytes = 0, uncompressedBytes = 0; ///< as TextureSummary has them
    std::uint64_t colorTexels = 0, normalTexels = 0;
    /// Squares of differences and the largest ones: red, green, blue of colors, x and y of normals.
    std::array<std::uint64_t, 5> squares{}, largest{};

    void add(const TextureFigures& other);
    TextureSummary summary() const;
};

/** Makes a tile's images what its textures have: as they are, or, if it compresses, with a number of texels along their edges that
    blocks of 4 × 4 divide. Texels beyond an image repeat its last ones. Keeps account of all of them.

    OSG 3.6 makes an error of a compressed texture whose edges are others (Texture::applyTexImage2D_load). Not thread-safe. */
class TileTextures
{
public:
    explicit TileTextures(bool compress) : _compress(compress) {}

    /// Texels along a compressed texture's edges come in as many.
    static constexpr int BLOCK = 4;

    /// Three channels are colors, two are normals: both can be compressed, to BC1 and BC5 (RGTC2), with their mipmaps.
    osg::ref_ptr<osg::Image> picture(const osg::ref_ptr<osg::Image>& image);
    /// What must stay as it is. OpenGL makes its mipmaps, or it has none.
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
