// SPDX-License-Identifier: MIT
// SPDX-FileCopyrightText: 2026 the osgGeoFX authors
#include "Figure.h"

#include <algorithm>

namespace geofx::bench
{

std::optional<bool> Figure::reached() const
{
    if (bound == Bound::None) return std::nullopt;
    if (!measured) return false;
    switch (bound)
    {
    case Bound::Below:
        return *measured < asked;
    case Bound::AtMost:
        return *measured <= asked;
    default:
        return *measured >= asked;
    }
}

double median(std::vector<double> values)
{
    std::sort(values.begin(), values.end());
    const std::size_t middle = values.size() / 2;
    return values.size() % 2 == 1 ? values[middle] : (values[middle - 1] + values[middle]) / 2.0;
}

} // namespace geofx::bench
