// SPDX-License-Identifier: MIT
// SPDX-FileCopyrightText: 2026 the osgGeoFX authors
#include <osgGeoFX/closeup/detail/CloseUpItems.h>

#include <algorithm>

namespace osgGeoFX
{

void CloseUpItems::resize(std::size_t items)
{
    const std::size_t blocks = (items + perBlock - 1) / perBlock;
    while (_blocks.size() < blocks)
    {
        osg::ref_ptr<Block> block = new Block;
        block->buffer = new osg::UniformBufferObject;
        for (int i = 0; i < perBlock; ++i)
        {
            // Each item has an entry of its own in the buffer. OSG uploads the entries that are dirty.
            block->items.push_back(new osg::Vec4Array(CloseUpItem::rows));
            block->items.back()->setBufferObject(block->buffer);
        }
        _blocks.push_back(block);
    }
}

void CloseUpItems::set(std::size_t item, const CloseUpItem::Values& values)
{
    osg::Vec4Array& array = *_blocks[blockOf(item)]->items[item % perBlock];
    if (std::equal(values.begin(), values.end(), array.begin())) return;
    std::copy(values.begin(), values.end(), array.begin());
    array.dirty();
}

osg::ref_ptr<osg::UniformBufferBinding> CloseUpItems::binding(std::size_t block, unsigned int index) const
{
    const GLsizeiptr size = perBlock * CloseUpItem::rows * static_cast<GLsizeiptr>(sizeof(osg::Vec4f));
    osg::ref_ptr<osg::UniformBufferBinding> binding =
        new osg::UniformBufferBinding(index, _blocks[block]->items.front(), 0, size);
    binding->setUserData(_blocks[block]);
    return binding;
}

void CloseUpItems::resizeGLObjectBuffers(unsigned int size)
{
    for (const osg::ref_ptr<Block>& block : _blocks)
        block->buffer->resizeGLObjectBuffers(size);
}

void CloseUpItems::releaseGLObjects(osg::State* state) const
{
    for (const osg::ref_ptr<Block>& block : _blocks)
        block->buffer->releaseGLObjects(state);
}

} // namespace osgGeoFX
