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

double Growth::typicalSlopeFrom(double frame) const
{
    std::vector<double> slopes;
    for (std::size_t i = 0; i < _samples.size(); ++i)
    {
        const auto& [first, before] = _samples[i];
        if (first < frame) continue;
        for (std::size_t j = i + 1; j < _samples.size(); ++j)
            slopes.push_back((_samples[j].second - before) / (_samples[j].first - first) * 10000.0);
    }
    return slopes.empty() ? 0.0 : median(std::move(slopes));
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
