// SPDX-License-Identifier: MIT
// SPDX-FileCopyrightText: 2026 the osgGeoFX authors
#include <osgGeoFX/web/detail/PlaceGrid.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <optional>

namespace osgGeoFX
{

namespace
{

constexpr const char* alphabet = "ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789-_";
constexpr double metresPerDegree = 111320.0;
/// How far a place may lie from where its square lets expect it, of the square's size on the ground, and in metres.
constexpr double bend = 0.2, slack = 4.0;

using Sample = std::optional<WebPlaces::Place>;

void append(std::string& text, std::uint64_t value)
{
    do
    {
        const std::uint64_t low = value & 31u;
        value >>= 5;
        text += alphabet[low | (value ? 32u : 0u)];
    } while (value);
}

void appendSigned(std::string& text, std::int64_t value)
{
    append(text, value < 0 ? (static_cast<std::uint64_t>(-(value + 1)) << 1 | 1u)
                           : static_cast<std::uint64_t>(value) << 1);
}

/// From one place to another, metres: east, north and up, and which way around the Earth is shorter.
osg::Vec3d wayOf(const WebPlaces::Place& from, const WebPlaces::Place& to)
{
    return {std::remainder(to.longitude - from.longitude, 360.0) * metresPerDegree *
                std::cos(from.latitude * M_PI / 180.0),
            (to.latitude - from.latitude) * metresPerDegree, to.height - from.height};
}

/// Whether the places within a square of samples are what its corners let expect.
bool isEven(const WebPlaces& places, const std::array<const Sample*, 4>& corners, int x, int y, int step)
{
    for (const Sample* const corner : corners)
        if (!*corner) return false;
    const WebPlaces::Place& origin = **corners[0];
    std::array<osg::Vec3d, 4> ways;
    double size = 0.0;
    for (std::size_t i = 0; i < 4; ++i)
    {
        ways[i] = wayOf(origin, **corners[i]);
        for (std::size_t k = 0; k < i; ++k)
            size = std::max(size, (ways[i] - ways[k]).length());
    }
    const int half = step / 2;
    const std::array<std::array<int, 2>, 5> within = {
        {{half, half}, {half, 0}, {0, half}, {step, half}, {half, step}}};
    for (const auto& [right, down] : within)
    {
        const Sample seen = places.at(x + right, y + down);
        if (!seen) return false;
        const double u = static_cast<double>(right) / step, v = static_cast<double>(down) / step;
        const osg::Vec3d expected =
            (ways[0] * (1.0 - u) + ways[1] * u) * (1.0 - v) + (ways[2] * (1.0 - u) + ways[3] * u) * v;
        if ((wayOf(origin, *seen) - expected).length() > std::max(bend * size, slack)) return false;
    }
    return true;
}

} // namespace

PlaceGrid::PlaceGrid(const WebPlaces& places)
{
    const double all = static_cast<double>(places.width) * places.height;
    step = std::max(2, 2 * static_cast<int>(std::ceil(0.5 * std::sqrt(all / most))));
    first = step / 2;
    columns = std::max(0, (places.width - 1 - first) / step + 1);
    rows = std::max(0, (places.height - 1 - first) / step + 1);
    if (places.width <= first || places.height <= first) columns = rows = 0;
    const auto count = static_cast<std::size_t>(columns);
    std::vector<Sample> upper(count), row(count);
    using Numbers = std::array<std::int64_t, 3>;
    std::vector<Numbers> upperNumbers(count), numbers(count);
    Numbers last = {0, 0, 0};
    std::uint64_t sky = 0;
    unsigned int bits = 0, bitCount = 0;
    const auto appendBit = [&](bool bit)
    {
        bits |= (bit ? 1u : 0u) << bitCount;
        if (++bitCount < 6) return;
        squares += alphabet[bits];
        bits = bitCount = 0;
    };
    const auto endSky = [&]
    {
        if (sky == 0) return;
        samples += '.';
        append(samples, sky);
        sky = 0;
    };
    for (int j = 0; j < rows; ++j)
    {
        const int y = first + j * step;
        for (std::size_t i = 0; i < count; ++i)
        {
            row[i] = places.at(first + static_cast<int>(i) * step, y);
            if (!row[i])
            {
                ++sky;
                continue;
            }
            endSky();
            numbers[i] = {std::llround(row[i]->longitude / unit), std::llround(row[i]->latitude / unit),
                          std::llround(row[i]->height)};
            const bool left = i > 0 && row[i - 1], above = j > 0 && upper[i],
                       corner = i > 0 && j > 0 && upper[i - 1];
            for (std::size_t k = 0; k < 3; ++k)
            {
                const std::int64_t expected =
                    left && above && corner ? numbers[i - 1][k] + upperNumbers[i][k] - upperNumbers[i - 1][k]
                    : left                  ? numbers[i - 1][k]
                    : above                 ? upperNumbers[i][k]
                                            : last[k];
                appendSigned(samples, numbers[i][k] - expected);
            }
            last = numbers[i];
        }
        for (std::size_t i = 0; j > 0 && i + 1 < count; ++i)
            appendBit(isEven(places, {&upper[i], &upper[i + 1], &row[i], &row[i + 1]},
                             first + static_cast<int>(i) * step, y - step, step));
        std::swap(upper, row);
        std::swap(upperNumbers, numbers);
    }
    endSky();
    if (bitCount > 0) squares += alphabet[bits];
}

} // namespace osgGeoFX
