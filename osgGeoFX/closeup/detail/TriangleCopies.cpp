// SPDX-License-Identifier: MIT
// SPDX-FileCopyrightText: 2026 the osgGeoFX authors
#include <osgGeoFX/closeup/detail/TriangleCopies.h>

#include <osgGeoFX/paging/TerrainInfo.h>

#include <algorithm>
#include <array>
#include <cmath>

namespace osgGeoFX
{

namespace
{

/// Both in halves of a region. A drawable may move by `slack` before it is looked at again. The border is several
/// times as wide.
constexpr double slack = 1e-3, border = 1.01;

/// One entry for each vertex, with a bit for each side of a region that the vertex is beyond.
using Sides = std::vector<unsigned char>;

Sides sidesOf(const std::vector<osg::Vec3d>& vertices, const TriangleCopies::Region& region)
{
    Sides sides(vertices.size());
    std::transform(vertices.begin(), vertices.end(), sides.begin(),
                   [&](const osg::Vec3d& vertex)
                   {
                       const osg::Vec3d place = vertex * region.toPlaces;
                       return static_cast<unsigned char>(
                           (place.x() > border ? 1 : 0) | (place.x() < -border ? 2 : 0) |
                           (place.y() > border ? 4 : 0) | (place.y() < -border ? 8 : 0) |
                           (place.z() < region.otherSide ? 16 : 0));
                   });
    return sides;
}

/// Whether a triangle is wanted by some region: not all of it is beyond one of its sides. Without regions all are
/// wanted.
bool wanted(const unsigned int* corners, const std::vector<Sides>& regions)
{
    return regions.empty() ||
           std::any_of(regions.begin(), regions.end(),
                       [&](const Sides& sides)
                       { return (sides[corners[0]] & sides[corners[1]] & sides[corners[2]]) == 0; });
}

/// Whether a triangle of a wall lies so near to a region's border that it shows below the end of the ground.
bool hangsOut(const std::vector<osg::Vec3d>& vertices, const unsigned int* corners,
              const TriangleCopies::Region& region)
{
    if (!region.shape) return false;
    std::array<osg::Vec3d, 7> places;
    for (std::size_t i = 0; i < 3; ++i)
        places[i] = vertices[corners[i]] * region.toPlaces;
    for (std::size_t i = 0; i < 3; ++i)
        places[3 + i] = (places[i] + places[(i + 1) % 3]) * 0.5;
    places[6] = (places[0] + places[1] + places[2]) / 3.0;
    const auto [low, high] = std::minmax({places[0].z(), places[1].z(), places[2].z()});
    const double half = 0.5 * std::min(region.shape->getWidth(), region.shape->getDepth());
    // Seen at more than 18 degrees from above, ground of this width in front of a wall hides the wall.
    const double margin = 3.0 * (high - low) / half;
    double nearest = std::numeric_limits<double>::infinity();
    double farthest = -std::numeric_limits<double>::infinity();
    for (const osg::Vec3d& place : places)
    {
        const double inside = region.shape->maskAt({place.x(), place.y()}).y();
        nearest = std::min(nearest, inside);
        farthest = std::max(farthest, inside);
    }
    return nearest < margin && farthest > -margin;
}

/// Whether a box lies in the same places of the regions, up to the rounding of a camera's matrices.
bool same(const std::vector<TriangleCopies::Region>& some, const std::vector<TriangleCopies::Region>& others,
          const osg::BoundingBox& box)
{
    return std::equal(some.begin(), some.end(), others.begin(), others.end(),
                      [&](const TriangleCopies::Region& one, const TriangleCopies::Region& other)
                      {
                          if (one.shape != other.shape || one.revision != other.revision) return false;
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
    const DrawableTriangles mesh(geometry);
    std::vector<Sides> sides;
    // Instances, and vertices that a shader moves, lie elsewhere than the vertices say.
    const bool cuts = mesh.tellAll() && entry.extent == OVER_REGIONS;
    for (std::size_t i = 0; cuts && i < entry.regions.size(); ++i)
        sides.push_back(sidesOf(mesh.positions(), entry.regions[i]));
    std::vector<osg::ref_ptr<osg::DrawElementsUInt>> copies;
    const std::size_t ground = TileInfo::groundIndices(geometry);
    bool leftOut = false;
    std::size_t count = 0;
    std::size_t corner = 0;
    for (const DrawableTriangles::Part& part : mesh.parts())
    {
        osg::ref_ptr<osg::DrawElementsUInt> indices =
            new osg::DrawElementsUInt(patches ? GL_PATCHES : GL_TRIANGLES);
        indices->setNumInstances(part.instances);
        for (; corner < part.end; corner += 3)
        {
            const unsigned int* corners = &mesh.corners()[corner];
            if (!wanted(corners, sides)) continue;
            const bool visible =
                corner >= ground && std::any_of(entry.regions.begin(), entry.regions.end(),
                                                [&](const Region& region)
                                                { return hangsOut(mesh.positions(), corners, region); });
            leftOut = leftOut || visible;
            if (!visible) indices->insert(indices->end(), corners, corners + 3);
        }
        count += indices->size();
        if (!indices->empty()) copies.push_back(indices);
    }
    // If the vertices could not be read, they may be anywhere.
    const bool unread = mesh.positions().empty();
    entry.empty = count == 0 && !unread;
    entry.copy = nullptr;
    constexpr double most = 0.8;
    const bool worthIt =
        patches || leftOut || static_cast<double>(count) < most * static_cast<double>(mesh.corners().size());
    if (entry.empty || unread || !worthIt) return;
    entry.copy = new osg::Geometry(geometry, osg::CopyOp::SHALLOW_COPY);
    // The arrays belong to another geometry, which may be drawing them. Their buffers stay as they are.
    entry.copy->setUseDisplayList(false);
    entry.copy->removePrimitiveSet(0, entry.copy->getNumPrimitiveSets());
    for (const osg::ref_ptr<osg::DrawElementsUInt>& indices : copies)
    {
        entry.copy->addPrimitiveSet(indices);
        // OSG gives the buffer to the next copy of the same size.
        if (osg::ElementBufferObject* buffer = indices->getElementBufferObject())
            buffer->setUsage(GL_DYNAMIC_DRAW);
    }
}

/// The one that was made for these regions, else one that nothing needs any more, else a new one.
TriangleCopies::Entry& TriangleCopies::entryOf(std::deque<Entry>& places, const osg::Geometry& geometry,
                                               const std::vector<Region>& regions, Extent extent)
{
    Entry* unused = nullptr;
    for (Entry& entry : places)
    {
        if (entry.geometry.valid() && entry.stamp.matches(geometry) && entry.extent == extent &&
            same(entry.regions, regions, geometry.getBoundingBox()))
            return entry;
        if (!entry.used) unused = &entry;
    }
    if (!unused) unused = &places.emplace_back();
    unused->geometry = nullptr;
    return *unused;
}

osg::Geometry* TriangleCopies::of(osg::Geometry& geometry, const std::vector<Region>& regions, bool patches,
                                  Extent extent)
{
    Key key = {&geometry, {}};
    for (const Region& region : regions)
        key.second.push_back(region.item);
    Entry& entry = entryOf((patches ? _patches : _triangles)[key], geometry, regions, extent);
    entry.used = true;
    if (!entry.geometry.valid())
    {
        entry.geometry = &geometry;
        entry.stamp = GeometryStamp(geometry, GeometryStamp::ALL_ARRAYS);
        entry.regions = regions;
        entry.extent = extent;
        build(entry, patches);
    }
    if (entry.empty) return nullptr;
    return entry.copy ? entry.copy.get() : &geometry;
}

double TriangleCopies::longestEdge(const osg::Geometry& geometry)
{
    Measured& measured = _measured[&geometry];
    if (!measured.geometry.valid() || !measured.stamp.matches(geometry))
    {
        const DrawableTriangles mesh(geometry);
        double square = 0.0;
        const auto edge = [&](std::size_t from, std::size_t to)
        {
            const std::vector<unsigned int>& corners = mesh.corners();
            return (mesh.positions()[corners[to]] - mesh.positions()[corners[from]]).length2();
        };
        for (std::size_t i = 0; i < mesh.corners().size(); i += 3)
            square = std::max({square, edge(i, i + 1), edge(i + 1, i + 2), edge(i + 2, i)});
        measured.geometry = &geometry;
        measured.stamp = GeometryStamp(geometry);
        measured.longestEdge = std::sqrt(square);
    }
    return measured.longestEdge;
}

void TriangleCopies::startFrame()
{
    for (auto measured = _measured.begin(); measured != _measured.end();)
        measured = measured->second.geometry.valid() ? std::next(measured) : _measured.erase(measured);
    for (Entries* entries : {&_triangles, &_patches})
    {
        for (auto known = entries->begin(); known != entries->end();)
        {
            std::deque<Entry>& places = known->second;
            const bool gone = std::none_of(places.begin(), places.end(),
                                           [](const Entry& entry) { return entry.geometry.valid(); });
            for (Entry& entry : places)
                entry.used = false;
            known = gone ? entries->erase(known) : std::next(known);
        }
    }
}

void TriangleCopies::resizeGLObjectBuffers(unsigned int size)
{
    for (auto* entries : {&_triangles, &_patches})
    {
        for (auto& [key, places] : *entries)
        {
            for (Entry& entry : places)
                osg::resizeGLObjectBuffers(entry.copy, size);
        }
    }
}

void TriangleCopies::releaseGLObjects(osg::State* state) const
{
    for (const auto* entries : {&_triangles, &_patches})
    {
        for (const auto& [key, places] : *entries)
        {
            for (const Entry& entry : places)
            {
                if (!entry.copy) continue;
                // osg::Geometry's own method would release the arrays' buffers, too. Another geometry draws from these.
                entry.copy->Drawable::releaseGLObjects(state);
                for (const osg::ref_ptr<osg::PrimitiveSet>& indices : entry.copy->getPrimitiveSetList())
                    indices->releaseGLObjects(state);
            }
        }
    }
}

} // namespace osgGeoFX
