// SPDX-License-Identifier: MIT
// SPDX-FileCopyrightText: 2026 the osgGeoFX authors
#pragma once

#include <tools/RandomSamples.h>
#include <tools/TestRasters.h>

#include <algorithm>
#include <cmath>
#include <string>
#include <vector>

namespace geofx::test
{

/// Rough mountains on a plane: relief that is alike at all sizes, by halving, with ever smaller chance.
class Mountains
{
public:
    /// UTM zone 4 north; the corner of the north-western post's pixel, in whose middle it lies.
    static constexpr double WEST = 500000.0, NORTH = 2400000.0;

    /// `side`: posts along each side, a power of two and one; `post`: metres from one to the next.
    Mountains(int side, double post, std::uint64_t seed)
        : _side(side), _post(post), _heights(static_cast<std::size_t>(side) * static_cast<std::size_t>(side))
    {
        Random random(seed);
        double swing = 0.12 * post * side;
        for (int step = side - 1; step > 1; step /= 2, swing *= 0.47)
        {
            const int half = step / 2;
            const auto mean = [&](int column, int row, int dc, int dr)
            {
                double sum = 0.0;
                int count = 0;
                for (int turn = 0; turn < 4; ++turn)
                {
                    const int c = column + dc, r = row + dr;
                    if (c >= 0 && r >= 0 && c < side && r < side) sum += height(c, r), ++count;
                    const int former = dc;
                    dc = -dr;
                    dr = former;
                }
                return sum / count + random.uniform(-0.5, 0.5) * swing;
            };
            for (int row = half; row < side; row += step)
                for (int column = half; column < side; column += step)
                    height(column, row) = mean(column, row, half, half);
            for (int row = 0; row < side; row += half)
                for (int column = (row / half) % 2 ? 0 : half; column < side; column += step)
                    height(column, row) = mean(column, row, half, 0);
        }
    }

    int side() const { return _side; }
    double post() const { return _post; }
    /// Metres, of a post.
    double at(int column, int row) const
    {
        return _heights[static_cast<std::size_t>(row) * static_cast<std::size_t>(_side) +
                        static_cast<std::size_t>(column)];
    }
    /// Of the post at a place or before it, easting and northing.
    double near(double x, double y) const
    {
        const auto place = [&](double metres)
        {
            return std::clamp(static_cast<int>(metres / _post), 0, _side - 1);
        };
        return at(place(x - WEST), place(NORTH - y));
    }
    std::string write(const std::string& file) const
    {
        return TestRaster(_side, _side)
            .placed(WEST, NORTH, _post, _post)
            .crs("EPSG:32604")
            .fill([&](int column, int row, int) { return at(column, row); })
            .write(file);
    }

private:
    double& height(int column, int row)
    {
        return _heights[static_cast<std::size_t>(row) * static_cast<std::size_t>(_side) +
                        static_cast<std::size_t>(column)];
    }

    const int _side;
    const double _post;
    std::vector<double> _heights;
};

} // namespace geofx::test
