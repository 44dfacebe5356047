// SPDX-License-Identifier: MIT
// SPDX-FileCopyrightText: 2026 the osgGeoFX authors
#include <osgGeoFX/mapping/detail/GridPlan.h>

#include <algorithm>
#include <limits>
#include <queue>
#include <utility>

namespace osgGeoFX
{

namespace
{

constexpr double cellsPerMapping = 8; // cells across the smallest mapping whose boundary runs through them
constexpr double shorterList = 0.75;  // a split must shorten lists to this share at least, on average
constexpr std::int64_t blockWords = 64;

std::int64_t listWords(std::size_t count)
{
    return 4 * std::int64_t(listTexels(count));
}

class Planner
{
public:
    Planner(const GridLimits& limits) : _limits(limits), _words(limits.words) {}

    std::vector<PlannedBlock> plan(const PlaneSquare& square, const std::vector<const GridItem*>& items,
                                   bool must)
    {
        const Span all{items.data(), items.size()};
        const Boundaries boundaries = boundariesIn(square, all);
        if (must)
        {
            PlannedBlock block;
            distribute(square, all, std::numeric_limits<std::size_t>::max(), block);
            _words -= extraWords(block, 0);
            add(std::move(block), square);
        }
        else if (worthATry(boundaries, square))
        {
            split(square, all);
        }
        while (!_blocks.empty() && !_candidates.empty())
        {
            const Candidate candidate = _candidates.top();
            _candidates.pop();
            const PlannedBlock& block = _blocks[candidate.block];
            const std::uint32_t child = split(candidate.square, itemsOf(block, candidate.cell));
            _blocks[candidate.block].child[candidate.cell] = child;
        }
        return std::move(_blocks);
    }

private:
    struct Span
    {
        const GridItem* const* first;
        std::size_t count;
    };
    struct Boundaries
    {
        unsigned int count = 0;
        double smallest = std::numeric_limits<double>::max(); ///< width of a mapping
    };
    struct Candidate
    {
        double gain;
        std::uint32_t block;
        unsigned int cell;
        PlaneSquare square;

        bool operator<(const Candidate& other) const
        {
            if (gain != other.gain) return gain < other.gain;
            return std::make_pair(block, cell) > std::make_pair(other.block, other.cell);
        }
    };

    static Span itemsOf(const PlannedBlock& block, unsigned int cell)
    {
        return {block.items.data() + block.begin[cell], block.begin[cell + 1] - block.begin[cell]};
    }

    Boundaries boundariesIn(const PlaneSquare& square, const Span& items) const
    {
        Boundaries result;
        if (items.count < partialsWorthSplitting) return result;
        for (std::size_t i = 0; i < items.count; ++i)
        {
            const FootprintShape& shape = items.first[i]->shape;
            if (shape.covers(square, _limits.margin)) continue;
            ++result.count;
            result.smallest = std::min(result.smallest, shape.width());
        }
        return result;
    }

    bool worthATry(const Boundaries& boundaries, const PlaneSquare& square) const
    {
        return boundaries.count >= partialsWorthSplitting && square.size / 8 >= _limits.smallestCell &&
               square.size / 8 * cellsPerMapping >= boundaries.smallest;
    }

    /// Sorts mappings into cells. False if their lists would have more than `most` entries together.
    bool distribute(const PlaneSquare& square, const Span& items, std::size_t most, PlannedBlock& block)
    {
        _pairs.clear();
        for (std::size_t i = 0; i < items.count; ++i)
        {
            const GridItem* item = items.first[i];
            if (item->shape.covers(square, _limits.margin))
            {
                for (unsigned int cell = 0; cell < 64; ++cell)
                {
                    _pairs.emplace_back(cell, item);
                }
            }
            else
            {
                forCellsUnder(item->shape, square, _limits.margin,
                              [&](unsigned int cell, const PlaneSquare&)
                              { _pairs.emplace_back(cell, item); });
            }
            if (_pairs.size() > most) return false;
        }
        for (const auto& pair : _pairs)
        {
            ++block.begin[pair.first + 1];
        }
        for (unsigned int cell = 0; cell < 64; ++cell)
        {
            block.begin[cell + 1] += block.begin[cell];
        }
        block.items.resize(_pairs.size());
        std::array<std::uint32_t, 65> next = block.begin;
        for (const auto& pair : _pairs)
        {
            block.items[next[pair.first]++] = pair.second;
        }
        return true;
    }

    static std::int64_t extraWords(const PlannedBlock& block, std::size_t count)
    {
        std::int64_t words = blockWords - listWords(count);
        for (unsigned int cell = 0; cell < 64; ++cell)
        {
            words += listWords(block.begin[cell + 1] - block.begin[cell]);
        }
        return words;
    }

    /// The new block. 0 if the split does not pay, or if too few words are left.
    std::uint32_t split(const PlaneSquare& square, const Span& items)
    {
        const auto paying = static_cast<std::size_t>(shorterList * 64 * static_cast<double>(items.count));
        const auto affordable = static_cast<std::size_t>(std::max<std::int64_t>(0, _words)) + 2 * items.count;
        PlannedBlock block;
        if (!distribute(square, items, std::min(paying, affordable), block)) return 0;
        const std::int64_t words = extraWords(block, items.count);
        if (words > _words) return 0;
        _words -= words;
        return add(std::move(block), square);
    }

    std::uint32_t add(PlannedBlock&& planned, const PlaneSquare& square)
    {
        const auto index = static_cast<std::uint32_t>(_blocks.size());
        _blocks.push_back(std::move(planned));
        const PlannedBlock& block = _blocks.back();
        for (unsigned int cell = 0; cell < 64; ++cell)
        {
            const PlaneSquare place = square.cell(cell);
            const Boundaries boundaries = boundariesIn(place, itemsOf(block, cell));
            if (!worthATry(boundaries, place)) continue;
            _candidates.push({boundaries.count * place.size * place.size, index, cell, place});
        }
        return index;
    }

    GridLimits _limits;
    std::int64_t _words;
    std::vector<PlannedBlock> _blocks;
    std::priority_queue<Candidate> _candidates;
    std::vector<std::pair<unsigned int, const GridItem*>> _pairs;
};

} // namespace

std::vector<PlannedBlock> planGrid(const PlaneSquare& square, const std::vector<const GridItem*>& items,
                                   const GridLimits& limits, bool must)
{
    return Planner(limits).plan(square, items, must);
}

} // namespace osgGeoFX
