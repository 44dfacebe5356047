// SPDX-License-Identifier: MIT
// SPDX-FileCopyrightText: 2026 the osgGeoFX authors
#include <osgGeoFX/labels/detail/CairoRows.h>

#include <cairo.h>

#include <algorithm>
#include <cstdint>
#include <cstring>

namespace osgGeoFX
{

bool drawOver(osg::Image& image, int first, int width, const std::function<void(_cairo*)>& draw)
{
    const int channels = image.getPixelFormat() == GL_RGB ? 3 : image.getPixelFormat() == GL_RGBA ? 4 : 0;
    if (!channels || image.getDataType() != GL_UNSIGNED_BYTE || image.s() != width) return false;
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
            for (int x = 0; x < image.s(); ++x)
            {
                std::uint32_t pixel = 0;
                std::memcpy(&pixel, from + 4 * x, 4);
                const unsigned int alpha = pixel >> 24;
                if (alpha == 0) continue;
                unsigned char* const here = to + channels * x;
                const unsigned int over[3] = {(pixel >> 16) & 255u, (pixel >> 8) & 255u, pixel & 255u};
                for (int channel = 0; channel < 3; ++channel)
                    here[channel] = static_cast<unsigned char>(
                        std::min(255u, over[channel] + (here[channel] * (255u - alpha) + 127u) / 255u));
                if (channels == 4)
                    here[3] = static_cast<unsigned char>(alpha + (here[3] * (255u - alpha) + 127u) / 255u);
            }
        }
        cairo_surface_destroy(surface);
    }
    return true;
}

} // namespace osgGeoFX
