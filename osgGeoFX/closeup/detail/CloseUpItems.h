// SPDX-License-Identifier: MIT
// SPDX-FileCopyrightText: 2026 the osgGeoFX authors
#pragma once

#include <osgGeoFX/closeup/detail/CloseUpItem.h>

#include <osg/BufferIndexBinding>
#include <osg/BufferObject>

#include <vector>

namespace osgGeoFX
{

/** The uniform blocks with one camera's items, `perBlock` items in each. Only items that changed are uploaded. */
class CloseUpItems
{
public:
    static constexpr int perBlock = 64; ///< together 16 KiB, for which every GPU has room

    void resize(std::size_t items);
    void set(std::size_t item, const CloseUpItem::Values& values);
    static std::size_t blockOf(std::size_t item) { return item / perBlock; }
    static int placeInBlock(std::size_t item) { return static_cast<int>(item % perBlock); }
    /// Binds a block. `index` is its binding point.
    osg::ref_ptr<osg::UniformBufferBinding> binding(std::size_t block, unsigned int index) const;
    void resizeGLObjectBuffers(unsigned int size);
    void releaseGLObjects(osg::State* state) const;

private:
    /// A buffer does not hold its entries. So who draws with it holds the block.
    struct Block : public osg::Referenced
    {
        osg::ref_ptr<osg::UniformBufferObject> buffer;
        std::vector<osg::ref_ptr<osg::Vec4Array>> items;

    protected:
        ~Block() override = default;
    };
    std::vector<osg::ref_ptr<Block>> _blocks;
};

} // namespace osgGeoFX
