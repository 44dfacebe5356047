// SPDX-License-Identifier: MIT
// SPDX-FileCopyrightText: 2026 the osgGeoFX authors
#pragma once

#include <osgGeoFX/mapping/detail/TexelArena.h>

#include <cstdint>
#include <memory>
#include <vector>

namespace osgGeoFX
{

/** A camera's list of mappings, lowest first, in an arena: how many there are, then their records.

    The list belongs to the arena that it was written into. It may outlive that arena, whose end makes it invalid:
    release() gives texels back to no arena but their own, whichever it is told. A list that goes without release() leaves its
    texels taken. For one thread at a time, the arena included. */
class CameraList
{
public:
    CameraList() = default;
    CameraList(const CameraList&) = delete;
    CameraList& operator=(const CameraList&) = delete;

    /// Fills an empty list; it stays empty without records, and where the arena has no room.
    void write(const std::shared_ptr<TexelArena>& arena, const std::vector<std::uint32_t>& records);
    /// Empties the list. The arena has its texels again, if they are of this one.
    void release(const std::shared_ptr<TexelArena>& arena);

    /// The list's first texel; 0 where it is empty.
    std::uint32_t offset() const { return _offset; }

private:
    std::uint32_t _offset = 0;
    std::uint32_t _texels = 0;
    std::weak_ptr<TexelArena> _arena; ///< and no pointer: another arena may come to lie at its address
};

} // namespace osgGeoFX
