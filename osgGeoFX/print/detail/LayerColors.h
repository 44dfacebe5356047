// SPDX-License-Identifier: MIT
// SPDX-FileCopyrightText: 2026 the osgGeoFX authors
#pragma once

#include <algorithm>
#include <array>
#include <cmath>

/// How pictures of the same view become layers that, put together, are the last of them. Pictures are bytes, and layers, too; what has been
/// put together so far is known exactly. So errors of rounding do not add up from layer to layer.
namespace osgGeoFX::layers
{

using Color = std::array<float, 3>; ///< 0…1

inline Color colorOf(const unsigned char* bytes)
{
    return {static_cast<float>(bytes[0]) / 255.0f, static_cast<float>(bytes[1]) / 255.0f,
            static_cast<float>(bytes[2]) / 255.0f};
}

inline unsigned char byteOf(float share)
{
    return static_cast<unsigned char>(std::lround(255.0f * std::clamp(share, 0.0f, 1.0f)));
}

/// By how much a channel may be off without a layer that makes it good.
constexpr float slack = 1.2f / 255.0f;

/// The least opacity of a layer over `under` that can give the picture.
inline float leastOpacity(const Color& under, const Color& picture)
{
    float least = 0.0f;
    for (std::size_t i = 0; i < 3; ++i)
    {
        const float difference = picture[i] - under[i];
        if (std::abs(difference) <= slack) continue;
        least = std::max(least, difference > 0.0f ? difference / (1.0f - under[i]) : -difference / under[i]);
    }
    return std::min(least, 1.0f);
}

/// An opacity as a byte, not less than it is.
inline unsigned char opacityOf(float opacity)
{
    return static_cast<unsigned char>(std::ceil(255.0f * std::clamp(opacity, 0.0f, 1.0f) - 0.01f));
}

/// The color of a layer whose opacity is known, which gives the picture over `under`.
inline Color colorOver(const Color& under, const Color& picture, float opacity)
{
    Color color{};
    for (std::size_t i = 0; i < 3; ++i)
        color[i] = std::clamp((picture[i] - (1.0f - opacity) * under[i]) / opacity, 0.0f, 1.0f);
    return color;
}

/// A pixel of a layer, RGBA, and what it makes of `under`. `opacity`: what it should be; it is more where that cannot give the picture.
inline void putLayer(Color& under, const Color& picture, float opacity, unsigned char* layer)
{
    layer[3] = opacityOf(std::max(opacity, leastOpacity(under, picture)));
    const float covered = static_cast<float>(layer[3]) / 255.0f;
    if (layer[3] == 0) return;
    const Color color = colorOver(under, picture, covered);
    for (std::size_t i = 0; i < 3; ++i)
    {
        layer[i] = byteOf(color[i]);
        under[i] = (1.0f - covered) * under[i] + covered * static_cast<float>(layer[i]) / 255.0f;
    }
}

/// A pixel of the ground over `under` in two layers: the unlit color, RGBA, and the factors that make it the lit one.
inline void putGround(Color& under, const Color& lit, const Color& flat, float opacity, unsigned char* layer,
                      float* shade)
{
    constexpr float mostShade = 16.0f;
    std::fill(shade, shade + 3, 1.0f);
    layer[3] = opacityOf(std::max(opacity, leastOpacity(under, lit)));
    const float covered = static_cast<float>(layer[3]) / 255.0f;
    if (layer[3] == 0) return;
    const Color unlit = colorOver(under, flat, covered);
    for (std::size_t i = 0; i < 3; ++i)
    {
        // Black would stay black in any light.
        layer[i] = std::max<unsigned char>(byteOf(unlit[i]), 1);
        const float color = static_cast<float>(layer[i]) / 255.0f;
        shade[i] = std::clamp((lit[i] - (1.0f - covered) * under[i]) / (covered * color), 0.0f, mostShade);
        under[i] = (1.0f - covered) * under[i] + covered * color * shade[i];
    }
}

} // namespace osgGeoFX::layers
