// SPDX-License-Identifier: MIT
// SPDX-FileCopyrightText: 2026 the osgGeoFX authors
#include <osgGeoFX/mapping/detail/CameraList.h>

#include <algorithm>
#include <cassert>

namespace osgGeoFX
{

void CameraList::write(const std::shared_ptr<TexelArena>& arena, const std::vector<std::uint32_t>& records)
{
    assert(_offset == 0);
    const auto count = static_cast<std::uint32_t>((records.size() + 1 + 3) / 4);
    const std::uint32_t offset = records.empty() ? 0 : arena->allocate(count);
    if (offset == 0) return;
    _offset = offset;
    _texels = count;
    _arena = arena;
    TexelArena::Texel* texels = arena->edit(offset, count);
    std::fill_n(texels, count, TexelArena::Texel{});
    texels[0][0] = static_cast<std::uint32_t>(records.size());
    for (std::size_t i = 0; i < records.size(); ++i)
        texels[(i + 1) / 4][(i + 1) % 4] = records[i];
}

void CameraList::release(const std::shared_ptr<TexelArena>& arena)
{
    if (_texels > 0 && _arena.lock() == arena) arena->release(_offset, _texels);
    _offset = 0;
    _texels = 0;
    _arena.reset();
}

} // namespace osgGeoFX
