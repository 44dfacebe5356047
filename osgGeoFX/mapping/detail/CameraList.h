// SPDX-License-Identifier: MIT
// SPDX-FileCopyrightText: 2026 the osgGeoFX authors
#pragma once

#include <osgGeoFX/mapping/detail/TexelArena.h>

#include <cstdint>
#include <memory>
#include <vector>

namespace osgGeoFX
{

/** A camera's list of mappings in an arena, the lowest mapping first. It holds their number, and then their records.

    The list belongs to the arena that it was written into. It may outlive this arena, and is not valid then.
    release() gives texels back to their own arena only, whichever arena it gets. Without release() the texels stay
    taken. For one thread at a time; the same holds for the arena. */
class CameraList
{
public:
    CameraList() = default;
    CameraList(const CameraList&) = delete;
    CameraList& operator=(const CameraList&) = delete;

    /// Fills an empty list. It stays empty without records, and if the arena has no room.
    void write(const std::shared_ptr<TexelArena>& arena, const std::vector<std::uint32_t>& records);
    /// Empties the list, and gives its texels back if they are this arena's.
    void release(const std::shared_ptr<TexelArena>& arena);

    /// The first texel of the list; 0 for an empty list.
    std::uint32_t offset() const { return _offset; }

private:
    std::uint32_t _offset = 0;
    std::uint32_t _texels = 0;
    std::weak_ptr<TexelArena> _arena; ///< not a pointer: another arena may get the same address later
};

} // namespace osgGeoFX
