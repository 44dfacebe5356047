// SPDX-License-Identifier: MIT
// SPDX-FileCopyrightText: 2026 the osgGeoFX authors
#pragma once

#include <osgGeoFX/paging/MemoryBudget.h>

#include <osg/NodeVisitor>
#include <osg/StateSet>

#include <set>

namespace osgGeoFX
{

/// Adds up what a tile takes.
class TileBytes : public osg::NodeVisitor
{
public:
    TileBytes() : osg::NodeVisitor(TRAVERSE_ALL_CHILDREN) { setNodeMaskOverride(~0u); }

    void apply(osg::Node& node) override;
    void apply(osg::Drawable& drawable) override;

    const MemoryBudget::Size& size() const { return _size; }

private:
    /// True for the first time.
    bool meet(const void* object) { return _known.insert(object).second; }
    void add(const osg::StateSet* state);
    void add(const osg::BufferData* data);
    void add(const osg::Texture& texture);

    MemoryBudget::Size _size;
    std::set<const void*> _known;
};

} // namespace osgGeoFX
