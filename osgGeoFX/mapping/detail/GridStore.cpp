// SPDX-License-Identifier: MIT
// SPDX-FileCopyrightText: 2026 the osgGeoFX authors
#include <osgGeoFX/mapping/detail/GridStore.h>

#include <algorithm>

namespace osgGeoFX
{

void GridStore::setWord(std::uint32_t block, unsigned int cell, std::uint32_t word)
{
    if (wordAt(block, cell) != word) (*_arena.edit(block + cell / 4, 1))[cell % 4] = word;
}

void GridStore::read(std::uint32_t list, std::vector<std::uint32_t>& ids) const
{
    ids.resize(count(list));
    for (std::size_t i = 0; i < ids.size(); ++i)
    {
        ids[i] = wordAt(list, i + 1);
    }
}

bool GridStore::replace(std::uint32_t& list, const std::vector<std::uint32_t>& ids)
{
    const std::uint32_t before = listTexels(count(list));
    const std::uint32_t after = listTexels(ids.size());
    const std::uint32_t old = list;
    if (after > before)
    {
        const std::uint32_t longer = allocate(after);
        if (longer == 0) return false;
        list = longer;
    }
    for (std::uint32_t i = 0; i < after; ++i)
    {
        TexelArena::Texel texel{};
        for (std::size_t j = 0; j < 4; ++j)
        {
            const std::size_t word = 4 * std::size_t(i) + j;
            if (word == 0)
                texel[j] = static_cast<std::uint32_t>(ids.size());
            else if (word <= ids.size())
                texel[j] = ids[word - 1];
        }
        if (list != old || _arena.texels()[list + i] != texel) *_arena.edit(list + i, 1) = texel;
    }
    if (list != old && old != 0)
        giveBack(old, before);
    else if (before > after)
        giveBack(list + after, before - after);
    if (after == 0) list = 0;
    _longestList = std::max(_longestList, ids.size());
    return true;
}

std::uint32_t GridStore::write(const std::vector<PlannedBlock>& blocks)
{
    return blocks.empty() ? 0 : writeBlock(blocks, blocks.front());
}

std::uint32_t GridStore::writeBlock(const std::vector<PlannedBlock>& blocks, const PlannedBlock& block)
{
    const std::uint32_t offset = allocate(blockTexels);
    if (offset == 0) return 0;
    std::fill_n(_arena.edit(offset, blockTexels), blockTexels, TexelArena::Texel{});
    for (unsigned int cell = 0; cell < 64; ++cell)
    {
        if (block.begin[cell] == block.begin[cell + 1]) continue;
        const std::uint32_t content = writeCell(blocks, block, cell);
        if (content == 0)
        {
            release(offset);
            return 0;
        }
        setWord(offset, cell, content);
    }
    return offset;
}

std::uint32_t GridStore::writeCell(const std::vector<PlannedBlock>& blocks, const PlannedBlock& block,
                                   unsigned int cell)
{
    if (block.child[cell] != 0)
    {
        const std::uint32_t child = writeBlock(blocks, blocks[block.child[cell]]);
        return child == 0 ? 0 : child | childBit;
    }
    std::vector<std::uint32_t> ids;
    ids.reserve(block.begin[cell + 1] - block.begin[cell]);
    for (std::uint32_t i = block.begin[cell]; i < block.begin[cell + 1]; ++i)
    {
        ids.push_back(block.items[i]->id);
    }
    std::uint32_t list = 0;
    return replace(list, ids) ? list : 0;
}

void GridStore::release(std::uint32_t block)
{
    for (unsigned int cell = 0; cell < 64; ++cell)
    {
        const std::uint32_t content = word(block, cell);
        if (isChild(content))
            release(offsetOf(content));
        else if (content != 0)
            giveBack(content, listTexels(count(content)));
    }
    giveBack(block, blockTexels);
}

std::uint32_t GridStore::allocate(std::uint32_t count)
{
    const std::uint32_t offset = _arena.allocate(count);
    if (offset != 0) _texels += count;
    return offset;
}

void GridStore::giveBack(std::uint32_t offset, std::uint32_t count)
{
    _arena.release(offset, count);
    _texels -= count;
}

} // namespace osgGeoFX
