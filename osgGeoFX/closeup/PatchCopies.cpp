// SPDX-License-Identifier: MIT
// SPDX-FileCopyrightText: 2026 the osgGeoFX authors
#include <osgGeoFX/closeup/PatchCopies.h>

#include <osg/TriangleIndexFunctor>

namespace osgGeoFX
{

namespace
{

struct Collect
{
    osg::DrawElementsUInt* indices = nullptr;
    void operator()(unsigned int a, unsigned int b, unsigned int c)
    {
        for (const unsigned int index : {a, b, c})
            indices->push_back(index);
    }
};

unsigned int modifiedCount(const osg::Geometry& geometry)
{
    unsigned int count = geometry.getVertexArray() ? geometry.getVertexArray()->getModifiedCount() : 0;
    for (const osg::ref_ptr<osg::PrimitiveSet>& primitives : geometry.getPrimitiveSetList())
        count += primitives->getModifiedCount() + primitives->getNumIndices();
    return count;
}

} // namespace

osg::Geometry& PatchCopies::of(const osg::Geometry& geometry)
{
    Entry& entry = _entries[&geometry];
    const unsigned int modified = modifiedCount(geometry);
    if (entry.geometry.valid() && entry.modified == modified) return *entry.copy;
    entry.geometry = &geometry;
    entry.modified = modified;
    entry.copy = new osg::Geometry(geometry, osg::CopyOp::SHALLOW_COPY);
    // The arrays are another's, who may be drawing them: their buffers stay as they are.
    entry.copy->setUseDisplayList(false);
    entry.copy->removePrimitiveSet(0, entry.copy->getNumPrimitiveSets());
    osg::ref_ptr<osg::DrawElementsUInt> indices = new osg::DrawElementsUInt(GL_PATCHES);
    osg::TriangleIndexFunctor<Collect> collect;
    collect.indices = indices;
    geometry.accept(collect);
    entry.copy->addPrimitiveSet(indices);
    return *entry.copy;
}

void PatchCopies::purge()
{
    for (auto entry = _entries.begin(); entry != _entries.end();)
        entry = entry->second.geometry.valid() ? std::next(entry) : _entries.erase(entry);
}

} // namespace osgGeoFX
