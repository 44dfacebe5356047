// SPDX-License-Identifier: MIT
// SPDX-FileCopyrightText: 2026 the osgGeoFX authors
#include <osgGeoFX/panorama/detail/EdgeDistances.h>

#include <algorithm>
#include <cmath>

namespace osgGeoFX
{

namespace
{

/// Squared distances, metres, from each cell's middle to that of the nearest marked cell.
std::vector<double> squaredDistances(const std::vector<char>& marks, std::size_t n, double stepX,
                                     double stepY)
{
    std::vector<double> distances(n * n, HUGE_VAL);
    for (std::size_t column = 0; column < n; ++column)
    {
        for (const bool upwards : {true, false})
        {
            double away = HUGE_VAL;
            for (std::size_t i = 0; i < n; ++i)
            {
                const std::size_t row = upwards ? i : n - 1 - i;
                away = marks[row * n + column] ? 0.0 : away + stepY;
                distances[row * n + column] = std::min(distances[row * n + column], away * away);
            }
        }
    }
    // In a row, the lowest of the parabolas over all columns counts (Felzenszwalb and Huttenlocher, 2012).
    std::vector<double> row(n), starts(n + 1);
    std::vector<std::size_t> lowest(n);
    for (std::size_t y = 0; y < n; ++y)
    {
        double* values = &distances[y * n];
        std::copy_n(values, n, row.begin());
        std::size_t count = 0;
        for (std::size_t x = 0; x < n; ++x)
        {
            if (std::isinf(row[x])) continue;
            const auto meet = [&](std::size_t other)
            {
                const double here = stepX * static_cast<double>(x),
                             there = stepX * static_cast<double>(other);
                return (row[x] + here * here - row[other] - there * there) / (2.0 * (here - there));
            };
            while (count > 0 && meet(lowest[count - 1]) <= starts[count - 1])
                --count;
            starts[count] = count > 0 ? meet(lowest[count - 1]) : -HUGE_VAL;
            lowest[count++] = x;
        }
        for (std::size_t x = 0, which = 0; x < n && count > 0; ++x)
        {
            const double here = stepX * static_cast<double>(x);
            while (which + 1 < count && starts[which + 1] < here)
                ++which;
            const double off = here - stepX * static_cast<double>(lowest[which]);
            values[x] = off * off + row[lowest[which]];
        }
    }
    return distances;
}

} // namespace

std::vector<float> signedDistances(const std::vector<char>& marks, std::size_t side, double stepX,
                                   double stepY)
{
    std::vector<char> others(marks.size());
    std::transform(marks.begin(), marks.end(), others.begin(), [](char mark) { return mark ? 0 : 1; });
    const std::vector<double> outside = squaredDistances(marks, side, stepX, stepY);
    const std::vector<double> inside = squaredDistances(others, side, stepX, stepY);
    const double most = (stepX + stepY) * static_cast<double>(side), half = 0.25 * (stepX + stepY);
    std::vector<float> distances(marks.size());
    for (std::size_t i = 0; i < marks.size(); ++i)
    {
        const double off = std::min(std::sqrt(marks[i] ? inside[i] : outside[i]) - half, most);
        distances[i] = static_cast<float>(marks[i] ? -off : off);
    }
    return distances;
}

} // namespace osgGeoFX
