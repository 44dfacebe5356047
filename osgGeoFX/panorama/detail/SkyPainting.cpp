// SPDX-License-Identifier: MIT
// SPDX-FileCopyrightText: 2026 the osgGeoFX authors
#include <osgGeoFX/panorama/detail/PaintedImages.h>

#include <osgGeoFX/panorama/detail/PaintNoise.h>
#include <osgGeoFX/panorama/detail/SkyCanvas.h>

#include <array>
#include <cmath>

namespace osgGeoFX
{

namespace
{

using Color = glm::vec3;

/// The sky without clouds, from the horizon up.
struct SkyStop
{
    float height;
    Color color;
};
using SkyStops = std::array<SkyStop, 6>;
const SkyStops summerSky = {{{0.0f, {0.985f, 0.905f, 0.800f}},
                             {0.08f, {0.945f, 0.900f, 0.865f}},
                             {0.20f, {0.770f, 0.850f, 0.925f}},
                             {0.42f, {0.500f, 0.705f, 0.910f}},
                             {0.72f, {0.265f, 0.505f, 0.815f}},
                             {1.0f, {0.120f, 0.320f, 0.665f}}}};
const Color winterVeil(0.86f, 0.88f, 0.93f);
const Color autumnGlow(1.0f, 0.82f, 0.60f);

Color between(const SkyStops& stops, float height)
{
    std::size_t next = 1;
    while (next + 1 < stops.size() && height > stops[next].height)
        ++next;
    const SkyStop& below = stops[next - 1];
    const float share = glm::clamp((height - below.height) / (stops[next].height - below.height), 0.0f, 1.0f);
    return glm::mix(below.color, stops[next].color, share);
}

SkyStops skyOf(double season)
{
    constexpr double turn = 6.283185307179586;
    const auto winter = static_cast<float>(std::max(0.0, std::cos(turn * season)));
    const auto autumn = static_cast<float>(std::max(0.0, std::cos(turn * (season - 0.75))));
    SkyStops stops = summerSky;
    for (SkyStop& stop : stops)
    {
        stop.color = glm::mix(stop.color, winterVeil, 0.3f * winter);
        stop.color =
            glm::mix(stop.color, autumnGlow, 0.3f * autumn * (1.0f - stop.height) * (1.0f - stop.height));
    }
    return stops;
}

} // namespace

osg::ref_ptr<osg::Image> paintSky(int width, int height, unsigned seed, double season)
{
    SkyCanvas canvas(std::clamp(width, 64, 8192), std::clamp(height, 32, 2048));
    const SkyStops stops = skyOf(std::isfinite(season) ? season : 0.5);
    const double unit = canvas.height();
    const int turn = std::max(1, static_cast<int>(std::lround(canvas.width() / unit)));
    for (int y = 0; y < canvas.height(); ++y)
    {
        for (int x = 0; x < canvas.width(); ++x)
        {
            // Washes that a wide brush has left: the blue is not as even as a print's.
            const double u = static_cast<double>(x) / canvas.width() * turn;
            const double v = y / unit;
            const double wash = paint::cloudy(u, 3.0 * v, turn, 64, 3, seed + 101);
            canvas.at(x, y) = between(stops, static_cast<float>(v + 0.09 * wash * v * (1.3 - v) * 2.0));
        }
    }
    paintClouds(canvas, seed, stops[0].color);
    paintInStrokes(canvas, seed);

    osg::ref_ptr<osg::Image> image = new osg::Image;
    image->allocateImage(canvas.width(), canvas.height(), 1, GL_RGBA, GL_UNSIGNED_BYTE);
    for (int y = 0; y < canvas.height(); ++y)
    {
        for (int x = 0; x < canvas.width(); ++x)
        {
            const Color color = glm::clamp(canvas.at(x, y), 0.0f, 1.0f) * 255.0f + 0.5f;
            unsigned char* texel = image->data(x, y);
            for (int i = 0; i < 3; ++i)
                texel[i] = static_cast<unsigned char>(color[i]);
            texel[3] = 255;
        }
    }
    return image;
}

} // namespace osgGeoFX
