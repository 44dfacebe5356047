// SPDX-License-Identifier: MIT
// SPDX-FileCopyrightText: 2026 the osgGeoFX authors
#include <osgGeoFX/scene/detail/PatchTwins.h>

#include <osgGeoFX/effect/GroundShade.h>
#include <osgGeoFX/effect/RigidParts.h>
#include <osgGeoFX/effect/Tessellation.h>

#include <algorithm>
#include <iterator>
#include <typeinfo>

namespace osgGeoFX
{

namespace
{

/// After so many frames without use a twin is made anew when it is wanted.
constexpr unsigned int mostIdle = 300;

bool hasValuesOfSets(const osg::Geometry& geometry)
{
    osg::Geometry::ArrayList arrays;
    geometry.getArrayList(arrays);
    return std::any_of(arrays.begin(), arrays.end(),
                       [](const auto& each)
                       { return each && each->getBinding() == osg::Array::BIND_PER_PRIMITIVE_SET; });
}

bool isOfTriangles(GLenum mode)
{
    switch (mode)
    {
    case GL_TRIANGLES:
    case GL_TRIANGLE_STRIP:
    case GL_TRIANGLE_FAN:
    case GL_QUADS:
    case GL_QUAD_STRIP:
    case GL_POLYGON:
        return true;
    default:
        return false;
    }
}

} // namespace

bool PatchTwins::mayHave(const osg::Drawable& drawable)
{
    const osg::Geometry* geometry = drawable.asGeometry();
    if (!geometry || typeid(*geometry) != typeid(osg::Geometry) || geometry->getDrawCallback() ||
        DrawableTriangles::instanced(*geometry) || RigidParts::of(drawable) || GroundShade::is(drawable) ||
        hasValuesOfSets(*geometry))
        return false;
    for (unsigned int i = 0; i < geometry->getNumPrimitiveSets(); ++i)
        if (!isOfTriangles(geometry->getPrimitiveSet(i)->getMode())) return false;
    return geometry->getNumPrimitiveSets() > 0;
}

osg::ref_ptr<osg::Geometry> PatchTwins::make(osg::Geometry& geometry)
{
    if (!mayHave(geometry)) return nullptr;
    const DrawableTriangles mesh(geometry);
    if (mesh.positions().empty()) return nullptr;
    osg::ref_ptr<osg::Geometry> twin = new PatchGeometry(geometry);
    const osg::ref_ptr<osg::DrawElementsUInt> indices =
        new osg::DrawElementsUInt(GL_PATCHES, mesh.corners().begin(), mesh.corners().end());
    twin->addPrimitiveSet(indices);
    // OSG gives the buffer to the next twin of the same size.
    if (osg::ElementBufferObject* buffer = indices->getElementBufferObject())
        buffer->setUsage(GL_DYNAMIC_DRAW);
    return twin;
}

osg::Geometry* PatchTwins::of(osg::Geometry& geometry)
{
    Entry& entry = _entries[&geometry];
    entry.idle = 0;
    if (!entry.geometry.valid() || !entry.stamp.matches(geometry))
    {
        entry.geometry = &geometry;
        entry.stamp = GeometryStamp(geometry, GeometryStamp::ALL_ARRAYS);
        entry.twin = make(geometry);
    }
    return entry.twin.get();
}

void PatchTwins::startFrame()
{
    for (auto entry = _entries.begin(); entry != _entries.end();)
    {
        const bool gone = !entry->second.geometry.valid() || ++entry->second.idle > mostIdle;
        entry = gone ? _entries.erase(entry) : std::next(entry);
    }
}

void PatchTwins::resizeGLObjectBuffers(unsigned int size)
{
    for (auto& [geometry, entry] : _entries)
        osg::resizeGLObjectBuffers(entry.twin, size);
}

void PatchTwins::releaseGLObjects(osg::State* state) const
{
    for (const auto& [geometry, entry] : _entries)
    {
        if (!entry.twin) continue;
        // osg::Geometry's own method would release the arrays' buffers, too. Another geometry draws from these.
        entry.twin->Drawable::releaseGLObjects(state);
        for (const osg::ref_ptr<osg::PrimitiveSet>& indices : entry.twin->getPrimitiveSetList())
            indices->releaseGLObjects(state);
    }
}

} // namespace osgGeoFX
