// SPDX-License-Identifier: MIT
// SPDX-FileCopyrightText: 2026 the osgGeoFX authors
#include "Growth.h"

#include "Figure.h"

namespace geofx::bench
{

double Growth::slopeFrom(double frame) const
{
    double count = 0.0, x = 0.0, y = 0.0, xx = 0.0, xy = 0.0;
    for (const auto& [at, value] : _samples)
    {
        if (at < frame) continue;
        const double when = (at - frame) / 10000.0;
        count += 1.0;
        x += when;
        y += value;
        xx += when * when;
        xy += when * value;
    }
    const double spread = count * xx - x * x;
    return spread > 0.0 ? (count * xy - x * y) / spread : 0.0;
}

double Growth::medianWithin(double first, double end) const
{
    std::vector<double> values;
    for (const auto& [at, value] : _samples)
    {
        if (at >= first && at < end) values.push_back(value);
    }
    return values.empty() ? 0.0 : median(std::move(values));
}

} // namespace geofx::bench
