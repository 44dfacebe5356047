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

/** The texels of a data layer as they go to the GPU: a square with a power of two as its side, and its mip levels.

    A texel is 32 bits. Of a picture: red in bits 0…7, green, blue, alpha above. Of values and classes: the bits of a
    32-bit float, the numbers as the image holds them, 0x7fc00000 where there is none. Uploaded as GL_RGBA,
    GL_UNSIGNED_INT_8_8_8_8_REV both arrive in the same four bytes on every machine.

    The picture lies at the lower left, t growing upwards: row 0 is the image's row 0, or its last row where the image's
    origin is TOP_LEFT, as in films. What is left of the square repeats the last column and row. Each further level is
    the box of 2 × 2 texels of the one below. Thread-safe: make() may be called from any thread. */
struct OSGGEOFX_EXPORT LayerPixels
{
    using Texel = std::uint32_t;

    enum class Kind
    {
        Colour, ///< bytes, filtered; integers are scaled as OpenGL does it, floats are cut to 0…1
        Value,  ///< numbers to interpolate, of the image's first channel
        Class   ///< numbers that stand for something; they are never averaged
    };

    struct Options
    {
        Kind kind = Kind::Colour;
        /// The colours are sRGB-coded. They stay so, and are averaged in linear light.
        bool sRGB = true;
        /// The number that stands for "none" in values and classes. Infinite numbers and NaN always do.
        std::optional<double> noData;
        /// 1…16384; a larger image is reduced to it.
        int maxSide = 2048;
        /// How many levels to make; 0 for all, 1 for a film's frames.
        int levels = 0;
    };

    /// Marks a texel of values or classes without one: a quiet NaN.
    static constexpr Texel none = 0x7fc00000u;

    int width = 0; ///< of the picture in the square, in texels of level 0
    int height = 0;
    int side = 0;         ///< the power of two at or above the larger of both
    bool reduced = false; ///< the image was larger than `maxSide`; it was reduced by area
    /// Level l has (side >> l)² texels, row by row from below.
    std::vector<std::vector<Texel>> levels;

    /** Of an image with the format GL_RGB, RGBA, BGR, BGRA, LUMINANCE, LUMINANCE_ALPHA, ALPHA (white), RED or RG and
        the type of bytes, shorts, ints (signed or not), floats or doubles, with any packing.

        Averages of colours are weighted with alpha, so that transparent texels do not bleed; averages of values leave
        "none" out; of classes the most frequent is taken, the first met where some are equally frequent.
        Nothing, with a sentence in `error`, for any other image and for options out of range. */
    static std::optional<LayerPixels> make(const osg::Image& image, const Options& options,
                                           std::string& error);

    /// The float in a texel of values or classes, NaN for none; and the reverse.
    static float value(Texel texel);
    static Texel texel(float value);
};

} // namespace osgGeoFX
