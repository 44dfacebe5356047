// SPDX-License-Identifier: MIT
// SPDX-FileCopyrightText: 2026 the osgGeoFX authors
#pragma once

#include <osgGeoFX/Export.h>

#include <osg/Image>

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

namespace osgGeoFX
{

/** The texels of a data layer, ready for the GPU: a square with a power of two as its side, and its mip levels.

    A texel has 32 bits. A texel of colors has red in bits 0…7, then green, blue and alpha above. A texel of values
    or classes has the bits of a 32-bit float: the number that the image holds, or 0x7fc00000 for none. If they are
    uploaded as GL_RGBA, GL_UNSIGNED_INT_8_8_8_8_REV, colors and numbers arrive in the same four bytes on every
    machine.

    The image lies at the lower left, with t upwards. Row 0 is the image's row 0, or its last row if the image's
    origin is TOP_LEFT, as in films. The rest of the square repeats the last column and row. A texel of each further
    level stands for the box of 2 × 2 texels of the level below. Thread-safe: make() may be called from any thread.

    @ingroup raster */
struct OSGGEOFX_EXPORT LayerPixels
{
    using Texel = std::uint32_t;

    enum class Kind
    {
        Color, ///< bytes, filtered; integers are scaled as in OpenGL, floats are clamped to 0…1
        Value, ///< numbers to interpolate, from the image's first channel
        Class  ///< numbers that stand for classes; they are never averaged
    };

    struct Options
    {
        Kind kind = Kind::Color;
        /// Whether the colors are sRGB-coded. They stay so and are averaged in linear light.
        bool sRGB = true;
        /// The number that stands for "none" in values and classes. Infinite numbers and NaN always stand for it.
        std::optional<double> noData;
        /// The largest side of the image, 1…16384 pixels. A larger image is reduced to it.
        int maxSide = 2048;
        /// The number of levels to make; 0 for all, 1 for the frames of a film.
        int levels = 0;
    };

    /// Marks a texel of values or classes as "none": a quiet NaN.
    static constexpr Texel none = 0x7fc00000u;

    int width = 0; ///< the image's size in the square, texels of level 0
    int height = 0;
    int side = 0;         ///< the power of two at or above the larger of both
    bool reduced = false; ///< whether the image was larger than `maxSide` and was reduced by area
    /// Level l has (side >> l)² texels, row by row from the bottom.
    std::vector<std::vector<Texel>> levels;

    /** Makes the texels of an image. The format may be GL_RGB, RGBA, BGR, BGRA, LUMINANCE, LUMINANCE_ALPHA, ALPHA
        (white), RED or RG. The type may be bytes, shorts, ints (signed or not), floats or doubles, with any packing.

        Averages of colors are weighted with alpha, so that transparent texels do not bleed. Averages of values
        leave out "none". Of classes the most frequent one is taken, without "none"; if several are equally frequent,
        it is the first one found. Empty, with a sentence in `error`, for any other image and for options out of
        range. */
    static std::optional<LayerPixels> make(const osg::Image& image, const Options& options,
                                           std::string& error);

    /// A range of rows of level 0: first, first + 1, … end − 1. Empty if both are equal.
    struct Rows
    {
        int first = 0;
        int end = 0;
    };
    /** The same for an image that has changed since `former` was made of it with the same options, in less time: only the
        rows that differ and the levels above them are made anew. `changed` tells which rows of level 0 these are; all, if
        the image has another size or is reduced. */
    static std::optional<LayerPixels> remake(const osg::Image& image, const Options& options,
                                             const LayerPixels& former, Rows& changed, std::string& error);

    /// The number in a texel of values or classes; NaN for none.
    static float value(Texel texel);
    /// The texel of a number; `none` for NaN.
    static Texel texel(float value);
};

} // namespace osgGeoFX
