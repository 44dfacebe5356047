// SPDX-License-Identifier: MIT
// SPDX-FileCopyrightText: 2026 the osgGeoFX authors
#pragma once

#include <cmath>
#include <cstdint>

namespace osgGeoFX
{

/** The noise and the brush strokes of painted images. Random numbers come from a hash of integers. For the library
    only. */
namespace paint
{

/// 32 bits that look random.
inline std::uint32_t hash(std::uint32_t a, std::uint32_t b = 0, std::uint32_t c = 0)
{
    std::uint32_t h = a * 0x9e3779b1u ^ (b + 0x7f4a7c15u) * 0x85ebca6bu ^ (c + 0x165667b1u) * 0xc2b2ae35u;
    h = (h ^ h >> 16) * 0x7feb352du;
    h = (h ^ h >> 15) * 0x846ca68bu;
    return h ^ h >> 16;
}

/// A number 0…1 from a hash.
inline double unit(std::uint32_t bits)
{
    return bits / 4294967296.0;
}

/// A sequence of random numbers.
class Sequence
{
public:
    explicit Sequence(std::uint32_t seed) : _seed(seed) {}
    double uniform() { return unit(hash(_seed, _count++)); }
    double uniform(double low, double high) { return low + (high - low) * uniform(); }

private:
    std::uint32_t _seed;
    std::uint32_t _count = 0;
};

/// 0 at `low` and below, 1 at `high` and above.
inline double ease(double value, double low, double high)
{
    const double t = value <= low ? 0.0 : value >= high ? 1.0 : (value - low) / (high - low);
    return t * t * (3.0 - 2.0 * t);
}

/// Smooth noise −1…1 with cells of size 1. It repeats after `periodX` and `periodY` cells.
inline double noise(double x, double y, int periodX, int periodY, std::uint32_t seed)
{
    const double cellX = std::floor(x);
    const double cellY = std::floor(y);
    const auto wrap = [](double cell, int period)
    {
        const int i = static_cast<int>(cell) % period;
        return i < 0 ? i + period : i;
    };
    const int left = wrap(cellX, periodX);
    const int right = left + 1 == periodX ? 0 : left + 1;
    const int low = wrap(cellY, periodY);
    const int high = low + 1 == periodY ? 0 : low + 1;
    const double u = x - cellX;
    const double v = y - cellY;
    // Gradients have about eight directions, as Perlin's do, so that no lattice shows.
    const auto corner = [&](int i, int j, double dx, double dy)
    {
        const std::uint32_t bits = hash(static_cast<std::uint32_t>(i), static_cast<std::uint32_t>(j), seed);
        const double gx = (bits & 0xffffu) / 32767.5 - 1.0;
        const double gy = (bits >> 16) / 32767.5 - 1.0;
        return gx * dx + gy * dy;
    };
    const double su = u * u * u * (u * (u * 6.0 - 15.0) + 10.0);
    const double sv = v * v * v * (v * (v * 6.0 - 15.0) + 10.0);
    const double below = (1.0 - su) * corner(left, low, u, v) + su * corner(right, low, u - 1.0, v);
    const double above =
        (1.0 - su) * corner(left, high, u, v - 1.0) + su * corner(right, high, u - 1.0, v - 1.0);
    return 1.5 * ((1.0 - sv) * below + sv * above);
}

/// Octaves of noise, each half as strong and half as wide as the one before; about −1…1.
inline double cloudy(double x, double y, int periodX, int periodY, int octaves, std::uint32_t seed)
{
    double sum = 0.0;
    double strength = 0.6;
    for (int i = 0; i < octaves; ++i)
    {
        sum += strength * noise(x, y, periodX, periodY, seed + static_cast<std::uint32_t>(i));
        x *= 2.0;
        y *= 2.0;
        periodX *= 2;
        periodY *= 2;
        strength *= 0.5;
    }
    return sum;
}

/// A stroke of a flat brush: half lengths along and across (pixels), and its direction.
struct Stroke
{
    double x;
    double y;
    double length;
    double width;
    double angle; // radians, counter-clockwise from the x axis
    std::uint32_t seed;
};

/** Calls touch(x, y, cover, across) for each pixel under a stroke. `cover` is the amount of paint, 0…1. `across` is
    −1…1 over the brush's width. x and y may lie outside the image. */
template<class Touch>
void stamp(const Stroke& stroke, const Touch& touch)
{
    const double c = std::cos(stroke.angle);
    const double s = std::sin(stroke.angle);
    const double reachX = std::abs(c) * stroke.length + std::abs(s) * stroke.width;
    const double reachY = std::abs(s) * stroke.length + std::abs(c) * stroke.width;
    // Each bristle lifts off at its own place.
    double lift[8];
    for (std::uint32_t i = 0; i < 8; ++i)
        lift[i] = 0.55 + 0.9 * unit(hash(stroke.seed, i));
    for (int y = static_cast<int>(std::ceil(stroke.y - reachY)); y <= stroke.y + reachY; ++y)
    {
        for (int x = static_cast<int>(std::ceil(stroke.x - reachX)); x <= stroke.x + reachX; ++x)
        {
            const double dx = x - stroke.x;
            const double dy = y - stroke.y;
            const double u = (dx * c + dy * s) / stroke.length;
            const double v = (dy * c - dx * s) / stroke.width;
            const double round = u * u * u * u + v * v;
            if (round >= 1.0) continue;
            const double place = (v + 1.0) * 3.5;
            const int bristle = static_cast<int>(place);
            const double share = place - bristle;
            const double end = lift[bristle] + share * (lift[bristle < 7 ? bristle + 1 : 7] - lift[bristle]);
            const double cover =
                std::fmin(1.0, 2.5 * (1.0 - round)) * (1.0 - 0.85 * ease(u, end - 0.5, end + 0.3));
            touch(x, y, cover, v);
        }
    }
}

} // namespace paint

} // namespace osgGeoFX
