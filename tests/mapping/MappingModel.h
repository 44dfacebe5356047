// SPDX-License-Identifier: MIT
// SPDX-FileCopyrightText: 2026 the osgGeoFX authors
#pragma once

#include <osgGeoFX/mapping/detail/MappingIndex.h>
#include <tools/RandomSamples.h>

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <map>
#include <vector>

/// Random mappings, and a plain list of them to compare a MappingIndex with.
namespace geofx::test
{

using osg::Vec2d;
using osgGeoFX::MappingIndex;
using osgGeoFX::PlaneFootprint;
using osgGeoFX::TexelArena;

using Entry = MappingIndex::Entry;
using Ids = std::vector<std::uint32_t>;

inline PlaneFootprint turnedRectangle(const Vec2d& middle, double width, double height, double angle)
{
    const Vec2d u = Vec2d(std::cos(angle), std::sin(angle)) * (width / 2);
    const Vec2d v = Vec2d(-std::sin(angle), std::cos(angle)) * (height / 2);
    return {{middle - u - v, middle + u - v, middle + u + v, middle - u + v}};
}

/// Tiny to huge, long and square, turned or not, in either direction.
inline PlaneFootprint randomFootprint(Random& random, double smallest, double largest)
{
    const Vec2d middle(random.uniform(-5e3, 5e3), random.uniform(-5e3, 5e3));
    const double width = random.logarithmic(smallest, largest);
    const double height = width * random.logarithmic(0.05, 1.0);
    PlaneFootprint result =
        turnedRectangle(middle, width, height, random.integer(0, 2) ? random.uniform(0.0, 7.0) : 0.0);
    if (random.integer(0, 3) == 0)
    {
        result.corners[0] += (result.corners[2] - result.corners[0]) * random.uniform(-0.5, 0.4);
    }
    if (random.integer(0, 1)) std::reverse(result.corners.begin(), result.corners.end());
    return result;
}

/// One of 100 places in rows of ten, one apart.
inline Vec2d gridPlace(int index)
{
    const int row = index / 10;
    return Vec2d(index % 10, row);
}

inline bool contains(const PlaneFootprint& footprint, const Vec2d& place)
{
    bool left = true;
    bool right = true;
    for (std::size_t i = 0; i < 4; ++i)
    {
        const Vec2d along = footprint.corners[(i + 1) % 4] - footprint.corners[i];
        const Vec2d to = place - footprint.corners[i];
        const double side = along.x() * to.y() - along.y() * to.x();
        left = left && side >= 0;
        right = right && side <= 0;
    }
    return left || right;
}

/// All mappings, in drawing order, and what must hold of the grid over them.
struct Model
{
    void insert(const Entry& entry) { byRank[entry.rank] = entry; }
    void erase(std::uint64_t rank) { byRank.erase(rank); }

    std::vector<Entry> entries() const
    {
        std::vector<Entry> result;
        for (const auto& [rank, entry] : byRank)
        {
            result.push_back(entry);
        }
        return result;
    }

    Vec2d randomPlace(Random& random) const
    {
        const int choice = random.integer(0, 3);
        if (choice == 0 || byRank.empty()) return {random.uniform(-7e3, 7e3), random.uniform(-7e3, 7e3)};
        // By rank and not evenly, for std::map has no nth; near a corner, an edge, or inside.
        auto found = byRank.lower_bound(
            static_cast<std::uint64_t>(random.uniform(0.0, static_cast<double>(byRank.rbegin()->first))));
        if (found == byRank.end()) found = byRank.begin();
        const auto& corners = found->second.footprint.corners;
        const double s = choice == 1 ? random.integer(0, 1) : random.uniform(0.0, 1.0);
        const double t = choice == 3 ? random.uniform(0.0, 1.0) : random.integer(0, 1);
        const double within = 1 - 1e-9;
        const Vec2d middle = (corners[0] + corners[1] + corners[2] + corners[3]) / 4;
        const Vec2d place = corners[0] * ((1 - s) * (1 - t)) + corners[1] * (s * (1 - t)) +
                            corners[2] * (s * t) + corners[3] * ((1 - s) * t);
        return middle + (place - middle) * within;
    }

    /// Nothing is missing at random places, all is in drawing order, and nothing is from far away.
    void compare(const MappingIndex& index, Random& random, int places) const
    {
        ASSERT_EQ(index.size(), byRank.size());
        std::map<std::uint32_t, const Entry*> byId;
        for (const auto& [rank, entry] : byRank)
        {
            byId[entry.id] = &entry;
        }
        for (int i = 0; i < places; ++i)
        {
            const Vec2d place = randomPlace(random);
            const Ids found = index.at(place);
            std::size_t next = 0;
            for (const auto& [rank, entry] : byRank)
            {
                if (!contains(entry.footprint, place)) continue;
                while (next < found.size() && found[next] != entry.id)
                {
                    ++next;
                }
                ASSERT_LT(next, found.size()) << "mapping " << entry.id << " is missing at " << place.x()
                                              << ", " << place.y() << ", or not in order";
            }
            for (std::size_t j = 0; j < found.size(); ++j)
            {
                ASSERT_EQ(byId.count(found[j]), 1u) << "a mapping that is no more";
                ASSERT_TRUE(j == 0 || byId[found[j - 1]]->rank < byId[found[j]]->rank);
            }
        }
    }

    std::map<std::uint64_t, Entry> byRank;
};

/// Ids are not ranks, and not in their order.
inline Entry entryOf(std::uint64_t rank, const PlaneFootprint& footprint)
{
    return {static_cast<std::uint32_t>(rank * 2654435761u), rank, footprint};
}

inline std::vector<Entry> smallOnes(std::size_t count, std::uint64_t seed)
{
    Random random(seed);
    std::vector<Entry> entries;
    const double width = 10e3 / std::sqrt(static_cast<double>(count));
    for (std::size_t i = 0; i < count; ++i)
    {
        entries.push_back(entryOf(i + 1, randomFootprint(random, width / 2, width)));
    }
    return entries;
}

inline std::size_t wordsOf(const osgGeoFX::GridStatistics& statistics)
{
    return 64 * statistics.blocks + statistics.listWords;
}

} // namespace geofx::test
