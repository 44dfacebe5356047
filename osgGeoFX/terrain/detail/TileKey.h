// SPDX-License-Identifier: MIT
// SPDX-FileCopyrightText: 2026 the osgGeoFX authors
#pragma once

#include <string>

namespace osgGeoFX
{

/// The place of a tile in the quadtree. Level 0 is the root, x counts eastwards, y northwards.
struct TileKey
{
    int level = 0;
    int x = 0;
    int y = 0;

    TileKey child(int dx, int dy) const { return {level + 1, 2 * x + dx, 2 * y + dy}; }

    /// The name of a tile and of its file: "level/x/y".
    std::string path() const
    {
        return std::to_string(level) + "/" + std::to_string(x) + "/" + std::to_string(y);
    }

    friend bool operator==(const TileKey& a, const TileKey& b)
    {
        return a.level == b.level && a.x == b.x && a.y == b.y;
    }
};

} // namespace osgGeoFX
