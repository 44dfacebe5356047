// SPDX-License-Identifier: MIT
// SPDX-FileCopyrightText: 2026 the osgGeoFX authors
#include <osgGeoFX/deformation/MeshBoxes.h>

#include <osg/Geometry>
#include <osg/TriangleFunctor>

#include <algorithm>

namespace osgGeoFX
{

namespace
{

constexpr int cellsOnSide = 6;

/// Sorts triangles into the cells of a grid over the two longer sides of a box.
struct Sorter
{
    void operator()(const osg::Vec3& a, const osg::Vec3& b, const osg::Vec3& c, bool = false)
    {
        const osg::Vec3 middle = (a + b + c) / 3.0f;
        osg::BoundingBox& box =
            boxes[static_cast<std::size_t>(cell(middle, first) * cellsOnSide + cell(middle, second))];
        box.expandBy(a);
        box.expandBy(b);
        box.expandBy(c);
        ++triangles;
    }
    int cell(const osg::Vec3& point, int axis) const
    {
        const float size = bounds._max[axis] - bounds._min[axis];
        const float share = size > 0.0f ? (point[axis] - bounds._min[axis]) / size : 0.0f;
        return std::clamp(static_cast<int>(share * static_cast<float>(cellsOnSide)), 0, cellsOnSide - 1);
    }

    osg::BoundingBox bounds;
    int first = 0;
    int second = 1;
    std::size_t triangles = 0;
    MeshBoxes::Boxes boxes = MeshBoxes::Boxes(static_cast<std::size_t>(cellsOnSide * cellsOnSide));
};

/// Whether a drawable is nothing but triangles that can be read.
bool onlyTriangles(const osg::Drawable& drawable)
{
    const osg::Geometry* geometry = drawable.asGeometry();
    if (!geometry) return false;
    for (unsigned int i = 0; i < geometry->getNumPrimitiveSets(); ++i)
    {
        const GLenum mode = geometry->getPrimitiveSet(i)->getMode();
        if (mode == GL_POINTS || mode == GL_LINES || mode == GL_LINE_STRIP || mode == GL_LINE_LOOP ||
            mode >= 0xA)
        {
            return false;
        }
    }
    return geometry->getVertexArray() != nullptr;
}

unsigned int modifiedCount(const osg::Drawable& drawable)
{
    const osg::Geometry* geometry = drawable.asGeometry();
    const osg::Array* vertices = geometry ? geometry->getVertexArray() : nullptr;
    return vertices ? vertices->getModifiedCount() : 0;
}

} // namespace

MeshBoxes::Entry& MeshBoxes::of(const osg::Drawable& drawable)
{
    Entry& entry = _entries[&drawable];
    const unsigned int modified = modifiedCount(drawable);
    if (entry.drawable.valid() && entry.modified == modified) return entry;
    entry.drawable = &drawable;
    entry.modified = modified;
    entry.boxes.clear();
    entry.witness = 0;
    // A callback may draw what the vertices do not tell.
    if (!onlyTriangles(drawable) || drawable.getComputeBoundingBoxCallback()) return entry;
    osg::TriangleFunctor<Sorter> sorter;
    sorter.bounds = drawable.getBoundingBox();
    const osg::Vec3 size = sorter.bounds._max - sorter.bounds._min;
    const int shortest = size.x() < size.y() ? (size.x() < size.z() ? 0 : 2) : (size.y() < size.z() ? 1 : 2);
    sorter.first = shortest == 0 ? 1 : 0;
    sorter.second = shortest == 2 ? 1 : 2;
    drawable.accept(sorter);
    // For a handful of triangles the whole box is as good.
    if (sorter.triangles < 2 * sorter.boxes.size()) return entry;
    std::copy_if(sorter.boxes.begin(), sorter.boxes.end(), std::back_inserter(entry.boxes),
                 [](const osg::BoundingBox& box) { return box.valid(); });
    return entry;
}

const MeshBoxes::Entry* MeshBoxes::find(const osg::Drawable& drawable) const
{
    const auto found = _entries.find(&drawable);
    if (found == _entries.end()) return nullptr;
    const Entry& entry = found->second;
    return entry.drawable.valid() && entry.modified == modifiedCount(drawable) ? &entry : nullptr;
}

void MeshBoxes::purge()
{
    for (auto entry = _entries.begin(); entry != _entries.end();)
    {
        entry = entry->second.drawable.valid() ? std::next(entry) : _entries.erase(entry);
    }
}

} // namespace osgGeoFX
