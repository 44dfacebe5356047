// SPDX-License-Identifier: MIT
// SPDX-FileCopyrightText: 2026 the osgGeoFX authors
#include <osgGeoFX/labels/detail/CairoRows.h>

#include <cairo.h>

#include <algorithm>
#include <cstdint>
#include <cstring>
#include <limits>

namespace osgGeoFX
{

namespace
{

/// Puts a row of Cairo's, whose colors are multiplied by their opacity, over one of a picture.
template<class Channel>
void putOver(const unsigned char* from, unsigned char* to, int width, int channels)
{
    constexpr unsigned int most = std::numeric_limits<Channel>::max();
    constexpr unsigned int scale = most / 255u;
    auto* here = reinterpret_cast<Channel*>(to);
    for (int x = 0; x < width; ++x, here += channels)
    {
        std::uint32_t pixel = 0;
        std::memcpy(&pixel, from + 4 * x, 4);
        const unsigned int alpha = pixel >> 24;
        if (alpha == 0) continue;
        const unsigned int over[3] = {(pixel >> 16) & 255u, (pixel >> 8) & 255u, pixel & 255u};
        const auto under = [&](Channel value)
        {
            return (value * (255u - alpha) + 127u) / 255u;
        };
        for (int channel = 0; channel < 3; ++channel)
            here[channel] =
                static_cast<Channel>(std::min(most, scale * over[channel] + under(here[channel])));
        if (channels == 4) here[3] = static_cast<Channel>(scale * alpha + under(here[3]));
    }
}

} // namespace

bool drawOver(osg::Image& image, int first, int width, const std::function<void(_cairo*)>& draw)
{
    const int channels = image.getPixelFormat() == GL_RGB ? 3 : image.getPixelFormat() == GL_RGBA ? 4 : 0;
    const bool deep = image.getDataType() == GL_UNSIGNED_SHORT;
    if (!channels || !(deep || image.getDataType() == GL_UNSIGNED_BYTE) || image.s() != width) return false;
    // In parts, so that large pictures need no second one.
    constexpr int strip = 512;
    for (int top = 0; top < image.t(); top += strip)
    {
        const int rows = std::min(strip, image.t() - top);
        cairo_surface_t* const surface = cairo_image_surface_create(CAIRO_FORMAT_ARGB32, image.s(), rows);
        cairo_t* const target = cairo_create(surface);
        cairo_translate(target, 0.0, -(first + top));
        draw(target);
        cairo_destroy(target);
        cairo_surface_flush(surface);
        for (int row = 0; row < rows; ++row)
        {
            const unsigned char* const from =
                cairo_image_surface_get_data(surface) + row * cairo_image_surface_get_stride(surface);
            unsigned char* const to = image.data(0, static_cast<unsigned int>(image.t() - 1 - (top + row)));
            if (deep)
                putOver<unsigned short>(from, to, image.s(), channels);
            else
                putOver<unsigned char>(from, to, image.s(), channels);
        }
        cairo_surface_destroy(surface);
    }
    return true;
}

} // namespace osgGeoFX
