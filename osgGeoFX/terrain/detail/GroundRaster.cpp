// SPDX-License-Identifier: MIT
// SPDX-FileCopyrightText: 2026 the osgGeoFX authors
#include <osgGeoFX/terrain/detail/GroundRaster.h>

#include <osgGeoFX/terrain/detail/BuildPlan.h>

#include <algorithm>
#include <cmath>

namespace osgGeoFX
{

namespace
{

// The most points along a side. It limits the time to some minutes and the work files to two gigabytes.
constexpr int LARGEST_SIDE = 16385;

std::string finishedFile(const BuildPlan& plan)
{
    return plan.workFolder() + "/ground/raster";
}

} // namespace

GroundRaster::Size GroundRaster::sizeFor(const BuildPlan& plan)
{
    const TilingScheme& scheme = plan.scheme;
    const auto points = [](double extent, double step)
    {
        return static_cast<int>(std::clamp(std::ceil(extent / step - 1e-4), 1.0, LARGEST_SIDE - 1.0)) + 1;
    };
    return {points(scheme.east - scheme.west, plan.groundStepX),
            points(scheme.north - scheme.south, plan.groundStepY)};
}

GroundRaster::GroundRaster(const BuildPlan& plan)
    : _plan(plan), _size(sizeFor(plan)),
      _file(finishedFile(plan), static_cast<std::size_t>(_size.columns) * sizeof(GroundCell),
            RowFile::Mode::READ)
{
}

std::vector<GroundCell> GroundRaster::sample(std::int64_t firstColumn, std::int64_t firstRow, int columns,
                                             int rows) const
{
    // A place between points. It is computed from texels in whole numbers, so that all tiles get the same place.
    struct Place
    {
        int index;
        double fraction;
    };
    const TilingScheme& scheme = _plan.scheme;
    const auto placesOf = [&](std::int64_t first, int count, int points, int lastPost)
    {
        std::vector<Place> places;
        const std::int64_t divisor = static_cast<std::int64_t>(lastPost) * scheme.texels;
        for (std::int64_t texel = first; texel < first + count; ++texel)
        {
            const std::int64_t product = texel * scheme.intervals * (points - 1);
            const auto index = std::min<std::int64_t>(product / divisor, points - 2);
            const std::int64_t rest = product - index * divisor;
            places.push_back({static_cast<int>(index),
                              std::min(1.0, static_cast<double>(rest) / static_cast<double>(divisor))});
        }
        return places;
    };
    const std::vector<Place> across = placesOf(firstColumn, columns, _size.columns, scheme.lastColumn);
    const std::vector<Place> along = placesOf(firstRow, rows, _size.rows, scheme.lastRow);

    std::vector<GroundCell> result;
    result.reserve(static_cast<std::size_t>(columns) * static_cast<std::size_t>(rows));
    std::vector<GroundCell> south(static_cast<std::size_t>(_size.columns)), north(south);
    int atSouth = -1, atNorth = -1;
    for (const Place& row : along)
    {
        if (atNorth == row.index)
        {
            south.swap(north);
            std::swap(atSouth, atNorth);
        }
        if (atSouth != row.index) _file.read(atSouth = row.index, south.data());
        if (atNorth != row.index + 1) _file.read(atNorth = row.index + 1, north.data());
        for (const Place& column : across)
        {
            const GroundCell* cells[] = {&south[static_cast<std::size_t>(column.index)],
                                         &north[static_cast<std::size_t>(column.index)]};
            const auto mixed = [&](auto member)
            {
                const auto along1 = [&](const GroundCell* cell)
                {
                    return (1.0 - column.fraction) * static_cast<double>(cell[0].*member) +
                           column.fraction * static_cast<double>(cell[1].*member);
                };
                return std::lround((1.0 - row.fraction) * along1(cells[0]) + row.fraction * along1(cells[1]));
            };
            result.push_back({static_cast<std::uint16_t>(mixed(&GroundCell::shore)),
                              static_cast<std::uint8_t>(mixed(&GroundCell::trees)),
                              static_cast<std::uint8_t>(mixed(&GroundCell::bare))});
        }
    }
    return result;
}

} // namespace osgGeoFX
