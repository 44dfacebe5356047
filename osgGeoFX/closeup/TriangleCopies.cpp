// SPDX-License-Identifier: MIT
// SPDX-FileCopyrightText: 2026 the osgGeoFX authors
#include <osgGeoFX/closeup/TriangleCopies.h>

#include <osg/TriangleFunctor>
#include <osg/TriangleIndexFunctor>

#include <algorithm>
#include <cmath>

namespace osgGeoFX
{

namespace
{

/// Of a region's half: what a drawable may move by before it is looked at again, and a border as wide as several of these.
constexpr double slack = 1e-3, border = 1.01;

/// Where vertices are, seen from a region, a bit for each side that they are beyond.
using Sides = std::vector<unsigned char>;

Sides sidesOf(const osg::Vec3Array& vertices, const TriangleCopies::Region& region)
{
    Sides sides(vertices.size());
    std::transform(vertices.begin(), vertices.end(), sides.begin(),
                   [&](const osg::Vec3& vertex)
                   {
                       const osg::Vec3d place = osg::Vec3d(vertex) * region.toPlaces;
                       return static_cast<unsigned char>(
                           (place.x() > border ? 1 : 0) | (place.x() < -border ? 2 : 0) |
                           (place.y() > border ? 4 : 0) | (place.y() < -border ? 8 : 0) |
                           (place.z() < region.otherSide ? 16 : 0));
                   });
    return sides;
}

struct Collect
{
    osg::DrawElementsUInt* indices = nullptr;
    const std::vector<Sides>* regions = nullptr; ///< empty: everything is wanted
    std::size_t all = 0;

    bool wanted(unsigned int a, unsigned int b, unsigned int c) const
    {
        return regions->empty() || std::any_of(regions->begin(), regions->end(),
                                               [&](const Sides& sides)
                                               {
                                                   return a >= sides.size() || b >= sides.size() ||
                                                          c >= sides.size() ||
                                                          (sides[a] & sides[b] & sides[c]) == 0;
                                               });
    }
    void operator()(unsigned int a, unsigned int b, unsigned int c)
    {
        ++all;
        if (!wanted(a, b, c)) return;
        for (const unsigned int index : {a, b, c})
            indices->push_back(index);
    }
};

struct LongestEdge
{
    void operator()(const osg::Vec3& a, const osg::Vec3& b, const osg::Vec3& c, bool = false)
    {
        square = std::max({square, (b - a).length2(), (c - b).length2(), (a - c).length2()});
    }
    float square = 0.0f;
};

unsigned int modifiedCount(const osg::Geometry& geometry)
{
    unsigned int count = geometry.getVertexArray() ? geometry.getVertexArray()->getModifiedCount() : 0;
    for (const osg::ref_ptr<osg::PrimitiveSet>& primitives : geometry.getPrimitiveSetList())
        count += primitives->getModifiedCount() + primitives->getNumIndices();
    return count;
}

/// Whether what is in a box is in the same place of the regions, but for what a camera's matrices round.
bool same(const std::vector<TriangleCopies::Region>& some, const std::vector<TriangleCopies::Region>& others,
          const osg::BoundingBox& box)
{
    return std::equal(some.begin(), some.end(), others.begin(), others.end(),
                      [&](const TriangleCopies::Region& one, const TriangleCopies::Region& other)
                      {
                          for (unsigned int i = 0; i < 8; ++i)
                          {
                              const osg::Vec3d corner(box.corner(i));
                              const osg::Vec3d moved = corner * one.toPlaces - corner * other.toPlaces;
                              if (!(std::abs(moved.x()) < slack && std::abs(moved.y()) < slack)) return false;
                          }
                          return true;
                      });
}

} // namespace

void TriangleCopies::build(Entry& entry, bool patches)
{
    const osg::Geometry& geometry = *entry.geometry;
    std::vector<Sides> sides;
    const auto* vertices = dynamic_cast<const osg::Vec3Array*>(geometry.getVertexArray());
    for (std::size_t i = 0; vertices && i < entry.regions.size(); ++i)
        sides.push_back(sidesOf(*vertices, entry.regions[i]));
    osg::ref_ptr<osg::DrawElementsUInt> indices =
        new osg::DrawElementsUInt(patches ? GL_PATCHES : GL_TRIANGLES);
    osg::TriangleIndexFunctor<Collect> collect;
    collect.indices = indices;
    collect.regions = &sides;
    geometry.accept(collect);
    entry.empty = indices->empty();
    entry.copy = nullptr;
    constexpr double most = 0.8;
    const bool worthIt =
        patches || static_cast<double>(indices->size()) < 3.0 * most * static_cast<double>(collect.all);
    if (entry.empty || !worthIt) return;
    entry.copy = new osg::Geometry(geometry, osg::CopyOp::SHALLOW_COPY);
    // The arrays are another's, who may be drawing them: their buffers stay as they are.
    entry.copy->setUseDisplayList(false);
    entry.copy->removePrimitiveSet(0, entry.copy->getNumPrimitiveSets());
    entry.copy->addPrimitiveSet(indices);
    // OSG gives it to the next copy of the same size.
    if (osg::ElementBufferObject* buffer = indices->getElementBufferObject())
        buffer->setUsage(GL_DYNAMIC_DRAW);
}

osg::Geometry* TriangleCopies::of(osg::Geometry& geometry, const std::vector<Region>& regions, bool patches)
{
    Key key = {&geometry, {}};
    for (const Region& region : regions)
        key.second.push_back(region.item);
    Entry& entry = (patches ? _patches : _triangles)[key];
    const unsigned int modified = modifiedCount(geometry);
    const bool known = entry.geometry.valid() && entry.modified == modified &&
                       same(entry.regions, regions, geometry.getBoundingBox());
    if (!known)
    {
        entry.geometry = &geometry;
        entry.modified = modified;
        entry.regions = regions;
        build(entry, patches);
    }
    if (entry.empty) return nullptr;
    return entry.copy ? entry.copy.get() : &geometry;
}

double TriangleCopies::longestEdge(const osg::Geometry& geometry)
{
    Measured& measured = _measured[&geometry];
    const unsigned int modified = modifiedCount(geometry);
    if (!measured.geometry.valid() || measured.modified != modified)
    {
        osg::TriangleFunctor<LongestEdge> longest;
        geometry.accept(longest);
        measured.geometry = &geometry;
        measured.modified = modified;
        measured.longestEdge = std::sqrt(static_cast<double>(longest.square));
    }
    return measured.longestEdge;
}

void TriangleCopies::purge()
{
    for (auto measured = _measured.begin(); measured != _measured.end();)
        measured = measured->second.geometry.valid() ? std::next(measured) : _measured.erase(measured);
    for (auto* entries : {&_triangles, &_patches})
    {
        for (auto entry = entries->begin(); entry != entries->end();)
            entry = entry->second.geometry.valid() ? std::next(entry) : entries->erase(entry);
    }
}

} // namespace osgGeoFX
