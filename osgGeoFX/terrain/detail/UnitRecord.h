// SPDX-License-Identifier: MIT
// SPDX-FileCopyrightText: 2026 the osgGeoFX authors
#pragma once

#include <osgGeoFX/batch/detail/ContentHash.h>
#include <osgGeoFX/terrain/detail/TileTextures.h>

#include <array>
#include <cstdint>
#include <optional>
#include <string>
#include <vector>

namespace osgGeoFX
{

/** What the tiles of a unit were made from. It is a work file, and is kept for updates. If nothing that a unit reads has
    changed, all its tiles stay. Else those stay whose own arrays have not changed. */
struct UnitRecord
{
    /// The file with the four children of a tile.
    struct Group
    {
        Digest key;                               ///< of all that the file's bytes follow from
        std::uint64_t bytes = 0;                  ///< its size; 0 if there is none
        std::array<TextureFigures, 4> textures{}; ///< by tile, whichever unit has made it
    };
    Digest key;      ///< of all that the unit reads
    Digest handedOn; ///< of what the unit above takes from this one
    Digest root;     ///< of all that the root tile's bytes follow from
    TextureFigures rootTextures;
    std::vector<Group> groups; ///< level after level from the unit's root on, row by row

    /// The place of a group in the list: of the tile x, y, counted from the unit's south-west corner, so many levels
    /// below its root.
    static std::size_t place(int levels, int x, int y)
    {
        return ((std::size_t{1} << (2 * levels)) - 1) / 3 + (static_cast<std::size_t>(y) << levels) +
               static_cast<std::size_t>(x);
    }
    /// Null if there is none at this place.
    const Group* group(int levels, int x, int y) const
    {
        const std::size_t at = place(levels, x, y);
        return at < groups.size() && groups[at].bytes > 0 ? &groups[at] : nullptr;
    }

    /// Empty if there is no such file, or a damaged one.
    static std::optional<UnitRecord> read(const std::string& file);
    void write(const std::string& file) const;
};

} // namespace osgGeoFX
