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

/// A place between points of a raster. It is computed in whole numbers, so that all tiles get the same place.
struct Place
{
    int index = -1; ///< −1 outside
    double fraction = 0.0;
    double inside = 1.0; ///< how much the raster counts here, 0…1
};

/// The share of a patch's width over which it fades into the one before. Around its elevation it has an eighth of
/// that one's width on each side, which is a tenth of its own.
constexpr double FADE = 0.08;

} // namespace

std::string GroundRaster::file(const BuildPlan& plan, std::size_t patch)
{
    return plan.workFolder() + "/ground/raster" + std::to_string(patch);
}

GroundRaster::GroundRaster(const BuildPlan& plan) : _plan(plan)
{
    for (std::size_t i = 0; i < plan.groundPatches.size(); ++i)
        _files.push_back(std::make_unique<RowFile>(
            file(plan, i), static_cast<std::size_t>(plan.groundPatches[i].columns) * sizeof(GroundCell),
            RowFile::Mode::READ));
}

std::vector<GroundCell> GroundRaster::sample(const Texels& texels, int columns, int rows) const
{
    const TilingScheme& scheme = _plan.scheme;
    const auto placesOf = [&](int first, int count, int points, int start, int end, int last)
    {
        std::vector<Place> places;
        const std::int64_t divisor = static_cast<std::int64_t>(end - start) * texels.texels;
        const double fade = FADE * static_cast<double>(divisor);
        for (int i = 0; i < count; ++i)
        {
            // In parts of a finest post, of which each has `texels`.
            const std::int64_t from = static_cast<std::int64_t>(first - start) * texels.texels +
                                      static_cast<std::int64_t>(i) * texels.posts;
            Place place;
            if (from >= 0 && from <= divisor)
            {
                const std::int64_t product = from * (points - 1);
                place.index = static_cast<int>(std::min<std::int64_t>(product / divisor, points - 2));
                place.fraction = std::min(1.0, static_cast<double>(product - place.index * divisor) /
                                                   static_cast<double>(divisor));
                // The extent's own border is no border of the patch.
                const double before = start > 0 ? static_cast<double>(from) / fade : 1.0;
                const double after = end < last ? static_cast<double>(divisor - from) / fade : 1.0;
                place.inside = std::min({1.0, before, after});
            }
            places.push_back(place);
        }
        return places;
    };
    std::vector<GroundCell> result(static_cast<std::size_t>(columns) * static_cast<std::size_t>(rows));
    for (std::size_t number = 0; number < _files.size(); ++number)
    {
        const GroundPatch& patch = _plan.groundPatches[number];
        const std::vector<Place> across = placesOf(texels.firstColumn, columns, patch.columns,
                                                   patch.firstColumn, patch.lastColumn, scheme.lastColumn);
        const std::vector<Place> along =
            placesOf(texels.firstRow, rows, patch.rows, patch.firstRow, patch.lastRow, scheme.lastRow);
        const auto isInside = [](const Place& place)
        {
            return place.index >= 0;
        };
        if (std::none_of(across.begin(), across.end(), isInside)) continue;
        std::vector<GroundCell> south(static_cast<std::size_t>(patch.columns)), north(south);
        int atSouth = -1, atNorth = -1;
        for (std::size_t j = 0; j < along.size(); ++j)
        {
            const Place& row = along[j];
            if (row.index < 0) continue;
            if (atNorth == row.index)
            {
                south.swap(north);
                std::swap(atSouth, atNorth);
            }
            if (atSouth != row.index) _files[number]->read(atSouth = row.index, south.data());
            if (atNorth != row.index + 1) _files[number]->read(atNorth = row.index + 1, north.data());
            for (std::size_t i = 0; i < across.size(); ++i)
            {
                const Place& column = across[i];
                if (column.index < 0) continue;
                const GroundCell* cells[] = {&south[static_cast<std::size_t>(column.index)],
                                             &north[static_cast<std::size_t>(column.index)]};
                GroundCell& cell = result[j * static_cast<std::size_t>(columns) + i];
                const double share = number == 0 ? 1.0 : std::min(row.inside, column.inside);
                const auto mixed = [&](auto member)
                {
                    const auto along1 = [&](const GroundCell* each)
                    {
                        return (1.0 - column.fraction) * static_cast<double>(each[0].*member) +
                               column.fraction * static_cast<double>(each[1].*member);
                    };
                    const double own =
                        (1.0 - row.fraction) * along1(cells[0]) + row.fraction * along1(cells[1]);
                    return std::lround(
                        share >= 1.0 ? own : share * own + (1.0 - share) * static_cast<double>(cell.*member));
                };
                cell = {static_cast<std::uint16_t>(mixed(&GroundCell::shore)),
                        static_cast<std::uint8_t>(mixed(&GroundCell::trees)),
                        static_cast<std::uint8_t>(mixed(&GroundCell::bare))};
            }
        }
    }
    return result;
}

Digest GroundRaster::digest(int firstColumn, int firstRow, int lastColumn, int lastRow) const
{
    // Levels below the finest of before change the numbers of posts, but not the places.
    const double root = std::ldexp(1.0, -_plan.scheme.finestLevel);
    const auto range = [](int first, int last, int start, int end, int points)
    {
        const auto point = [&](int post)
        {
            return static_cast<double>(post - start) / (end - start) * (points - 1);
        };
        return std::pair(std::max(static_cast<int>(std::floor(point(first))) - 1, 0),
                         std::min(static_cast<int>(std::ceil(point(last))) + 1, points - 1));
    };
    ContentHash hash;
    for (std::size_t number = 0; number < _files.size(); ++number)
    {
        const GroundPatch& patch = _plan.groundPatches[number];
        if (patch.firstColumn > lastColumn || patch.lastColumn < firstColumn || patch.firstRow > lastRow ||
            patch.lastRow < firstRow)
            continue;
        for (const int post : {patch.firstColumn, patch.firstRow, patch.lastColumn, patch.lastRow})
            hash.add(post * root);
        hash.add(patch.columns).add(patch.rows).add(number == 0);
        const auto [west, east] =
            range(firstColumn, lastColumn, patch.firstColumn, patch.lastColumn, patch.columns);
        const auto [south, north] = range(firstRow, lastRow, patch.firstRow, patch.lastRow, patch.rows);
        std::vector<GroundCell> cells(static_cast<std::size_t>(east - west + 1));
        for (int row = south; row <= north; ++row)
        {
            _files[number]->read(row, static_cast<std::size_t>(west) * sizeof(GroundCell),
                                 cells.size() * sizeof(GroundCell), cells.data());
            hash.add(cells);
        }
    }
    return hash.digest();
}

} // namespace osgGeoFX
