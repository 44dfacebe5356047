// SPDX-License-Identifier: MIT
// SPDX-FileCopyrightText: 2026 the osgGeoFX authors
#include <osgGeoFX/scene/detail/MeshBoxes.h>

#include <algorithm>
#include <cmath>

namespace osgGeoFX
{

namespace
{

constexpr int mostOnSide = 6;

/// Sorts triangles into the cells of a grid. The grid spans the two longer sides of a box.
struct Sorter
{
    void add(const osg::Vec3& a, const osg::Vec3& b, const osg::Vec3& c)
    {
        const osg::Vec3 middle = (a + b + c) / 3.0f;
        osg::BoundingBox& box =
            boxes[static_cast<std::size_t>(cell(middle, first) * onSide + cell(middle, second))];
        box.expandBy(a);
        box.expandBy(b);
        box.expandBy(c);
    }
    int cell(const osg::Vec3& point, int axis) const
    {
        const float size = bounds._max[axis] - bounds._min[axis];
        const float share = size > 0.0f ? (point[axis] - bounds._min[axis]) / size : 0.0f;
        return std::clamp(static_cast<int>(share * static_cast<float>(onSide)), 0, onSide - 1);
    }

    osg::BoundingBox bounds;
    int first = 0;
    int second = 1;
    int onSide = 1;
    MeshBoxes::Boxes boxes;
};

/// Whether an entry still holds. A drawable that is no geometry has no boxes at any time.
bool isCurrent(const MeshBoxes::Entry& entry, const osg::Drawable& drawable)
{
    if (!entry.drawable.valid()) return false;
    const osg::Geometry* geometry = drawable.asGeometry();
    return !geometry || entry.stamp.matches(*geometry);
}

} // namespace

MeshBoxes::Entry& MeshBoxes::of(const osg::Drawable& drawable)
{
    Entry& entry = _entries[&drawable];
    if (isCurrent(entry, drawable)) return entry;
    const osg::Geometry* geometry = drawable.asGeometry();
    entry.drawable = &drawable;
    entry.stamp = geometry ? GeometryStamp(*geometry) : GeometryStamp();
    entry.boxes.clear();
    entry.witness = 0;
    if (!geometry) return entry;
    // The mesh may draw something that its vertices do not tell. Then only the whole box is known.
    const DrawableTriangles mesh(drawable);
    if (!mesh.tellAll()) return entry;
    // For a few triangles the whole box is as good.
    constexpr double trianglesInCell = 2.0;
    const double triangles = static_cast<double>(mesh.corners().size()) / 3.0;
    Sorter sorter;
    sorter.onSide = std::min(mostOnSide, static_cast<int>(std::sqrt(triangles / trianglesInCell)));
    if (sorter.onSide < 2) return entry;
    sorter.boxes.resize(static_cast<std::size_t>(sorter.onSide * sorter.onSide));
    sorter.bounds = drawable.getBoundingBox();
    const osg::Vec3 size = sorter.bounds._max - sorter.bounds._min;
    const int shortest = size.x() < size.y() ? (size.x() < size.z() ? 0 : 2) : (size.y() < size.z() ? 1 : 2);
    sorter.first = shortest == 0 ? 1 : 0;
    sorter.second = shortest == 2 ? 1 : 2;
    const auto at = [&](std::size_t corner)
    {
        return osg::Vec3(mesh.positions()[mesh.corners()[corner]]);
    };
    for (std::size_t i = 0; i < mesh.corners().size(); i += 3)
        sorter.add(at(i), at(i + 1), at(i + 2));
    std::copy_if(sorter.boxes.begin(), sorter.boxes.end(), std::back_inserter(entry.boxes),
                 [](const osg::BoundingBox& box) { return box.valid(); });
    return entry;
}

const MeshBoxes::Entry* MeshBoxes::find(const osg::Drawable& drawable) const
{
    const auto found = _entries.find(&drawable);
    if (found == _entries.end()) return nullptr;
    return isCurrent(found->second, drawable) ? &found->second : nullptr;
}

void MeshBoxes::purge()
{
    for (auto entry = _entries.begin(); entry != _entries.end();)
    {
        entry = entry->second.drawable.valid() ? std::next(entry) : _entries.erase(entry);
    }
}

} // namespace osgGeoFX
