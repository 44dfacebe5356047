// SPDX-License-Identifier: MIT
// SPDX-FileCopyrightText: 2026 the osgGeoFX authors
#include <osgGeoFX/terrain/detail/AtomicFile.h>
#include <osgGeoFX/terrain/detail/BuildPlan.h>

#include <osgGeoFX/geodata/BuildError.h>

namespace osgGeoFX
{

namespace
{

/// The number of tiles on so many levels of a unit, from its root on.
std::size_t tilesOn(int levels)
{
    return ((std::size_t{1} << (2 * levels)) - 1) / 3;
}

/// The tiles whose facts a unit settles. Those of an upper tier's lattice are roots of other units.
std::size_t tilesOf(const Unit& unit)
{
    return tilesOn(unit.depth + (unit.sampled ? 1 : 0));
}

} // namespace

BuildPlan::Place BuildPlan::placeOf(const TileKey& key) const
{
    if (key.level < 0 || key.level > scheme.finestLevel || key.x < 0 || key.y < 0 ||
        key.x >= scheme.tilesAcross(key.level) || key.y >= scheme.tilesAcross(key.level) ||
        !scheme.exists(key))
        return {};
    // The deepest tier first: the roots of its units are tiles of the lattice above, too.
    for (std::size_t tier = 0; tier < _roots.size(); ++tier)
    {
        const int level = key.level - _roots[tier];
        if (level < 0 || key.level > _lattices[tier]) continue;
        const auto found = _blocks[tier].find(placeNumber(key.x >> level, key.y >> level));
        if (found == _blocks[tier].end()) continue;
        const Unit& unit = tiers[tier][found->second.unit];
        if (level > unit.depth) continue;
        const int mask = (1 << level) - 1;
        return {&found->second, &unit,
                tilesOn(level) + (static_cast<std::size_t>(key.y & mask) << level) +
                    static_cast<std::size_t>(key.x & mask)};
    }
    return {};
}

bool BuildPlan::has(const TileKey& key) const
{
    return placeOf(key).block != nullptr;
}

TileFacts& BuildPlan::fact(const TileKey& key)
{
    return const_cast<TileFacts&>(static_cast<const BuildPlan*>(this)->fact(key));
}

const TileFacts& BuildPlan::fact(const TileKey& key) const
{
    static const TileFacts none;
    const Place place = placeOf(key);
    if (!place.block) return none;
    if (workers == Workers::ONE_PROCESS)
        return place.block->facts.empty() ? none : place.block->facts[place.index];
    const std::lock_guard<std::mutex> lock(_factsMutex);
    if (place.block->facts.empty() && !loadFacts(*place.unit))
        throw BuildError(workFile("facts", *place.unit) +
                         ": this work file is missing or damaged; build its unit again.");
    return place.block->facts[place.index];
}

bool BuildPlan::isWholeEarth() const
{
    // Files have their outermost posts half a sample from the poles.
    constexpr double nearPole = 85.0;
    return scheme.wholeCircle() && scheme.south <= -nearPole && scheme.north >= nearPole && whole().any &&
           !whole().holes;
}

std::optional<double> BuildPlan::poleHeight(const TileKey& key, int side) const
{
    constexpr double touching = 1e-9; // degrees
    if (side % 2 != 0 || !scheme.endsAt(key, side) || !isWholeEarth()) return std::nullopt;
    if ((side == 0 ? 90.0 + scheme.south : 90.0 - scheme.north) < touching) return std::nullopt;
    return static_cast<double>(whole().ends[side == 0 ? 0 : 1]);
}

void BuildPlan::startFacts(const Unit& unit)
{
    const std::lock_guard<std::mutex> lock(_factsMutex);
    placeOf(unit.root).block->facts.assign(tilesOf(unit), {});
}

bool BuildPlan::loadFacts(const Unit& unit) const
{
    const std::size_t count = tilesOf(unit);
    for (const char* pass : {"facts-filled", "facts"})
    {
        ByteReader reader(workFile(pass, unit));
        if (!reader.good()) continue;
        auto facts = reader.getVector<TileFacts>();
        if (!reader.good() || facts.size() != count) return false;
        placeOf(unit.root).block->facts = std::move(facts);
        return true;
    }
    return false;
}

void BuildPlan::writeFacts(const Unit& unit, const Digest& key) const
{
    ByteWriter writer;
    writer.put(placeOf(unit.root).block->facts);
    writer.put(key);
    writeFileAtomically(heightFile("facts", unit), writer.bytes().data(), writer.bytes().size());
}

Digest BuildPlan::factsDigest(const Unit& unit) const
{
    ContentHash hash;
    for (int level = unit.root.level; level <= unit.latticeLevel(); ++level)
    {
        const int span = 1 << (level - unit.root.level);
        for (int y = 0; y < span; ++y)
            for (int x = 0; x < span; ++x)
            {
                const TileKey key{level, unit.root.x * span + x, unit.root.y * span + y};
                const TileFacts& facts = fact(key);
                hash.add(facts.any);
                if (!facts.any) continue;
                for (const float each :
                     {facts.minHeight, facts.maxHeight, facts.latticeError, facts.rootError, facts.error})
                    hash.add(each);
                hash.add(isLeaf(key));
                for (int side = 0; side < 4; ++side)
                    hash.add(skirt(key, side)).add(poleHeight(key, side).value_or(0.0));
            }
    }
    return hash.digest();
}

void BuildPlan::forgetFacts()
{
    if (workers == Workers::ONE_PROCESS) return;
    for (auto& tier : _blocks)
        for (auto& entry : tier)
            std::vector<TileFacts>().swap(entry.second.facts);
}

std::string BuildPlan::heightFile(const char* pass, const Unit& unit) const
{
    const bool filled = fact(unit.root).voids == TileFacts::FILLED_VOIDS;
    return workFile((std::string(pass) + (filled ? "-filled" : "")).c_str(), unit);
}

} // namespace osgGeoFX
