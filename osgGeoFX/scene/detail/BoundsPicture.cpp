// SPDX-License-Identifier: MIT
// SPDX-FileCopyrightText: 2026 the osgGeoFX authors
#include <osgGeoFX/scene/detail/BoundsPicture.h>

#include <algorithm>
#include <cstddef>
#include <vector>

namespace osgGeoFX
{

void BoundsPicture::begin()
{
    _lines = new osg::Vec3Array;
    _colors = new osg::Vec4Array;
}

void BoundsPicture::add(const EyeBox& box, const DeformationChain& chain)
{
    const Ball ball = box.ball();
    const auto& snapshots = chain.snapshots();
    const bool curved = std::any_of(snapshots.begin(), snapshots.end(),
                                    [&](const auto& snapshot)
                                    { return snapshot->reach(ball) == DeformationSnapshot::Reach::Curved; });
    const osg::Vec4 color = curved ? osg::Vec4(1, 0.2f, 0.1f, 1) : osg::Vec4(1, 0.9f, 0.2f, 1);
    // The lines show what the deformation makes of the box's twelve edges.
    constexpr int pieces = 8;
    std::vector<osg::Vec3d> corners;
    box.corners(corners);
    for (std::size_t a = 0; a < corners.size(); ++a)
    {
        for (const std::size_t axis : {1u, 2u, 4u})
        {
            if (a & axis) continue;
            const osg::Vec3d step = (corners[a | axis] - corners[a]) / pieces;
            osg::Vec3d from = chain.deform(corners[a]);
            for (int piece = 1; piece <= pieces; ++piece)
            {
                const osg::Vec3d to = chain.deform(corners[a] + step * piece);
                for (const osg::Vec3d& end : {from, to})
                {
                    _lines->push_back(end);
                    _colors->push_back(color);
                }
                from = to;
            }
        }
    }
}

osg::Geometry& BoundsPicture::geometry()
{
    if (!_geometry)
    {
        _geometry = new osg::Geometry;
        _geometry->setUseDisplayList(false);
        _geometry->setUseVertexBufferObjects(false);
        _geometry->setCullingActive(false);
        osg::StateSet* state = _geometry->getOrCreateStateSet();
        state->setMode(GL_LIGHTING, osg::StateAttribute::OFF);
        state->setMode(GL_DEPTH_TEST, osg::StateAttribute::OFF);
    }
    _geometry->setVertexArray(_lines);
    _geometry->setColorArray(_colors, osg::Array::BIND_PER_VERTEX);
    _geometry->removePrimitiveSet(0, _geometry->getNumPrimitiveSets());
    _geometry->addPrimitiveSet(new osg::DrawArrays(GL_LINES, 0, static_cast<GLsizei>(_lines->size())));
    return *_geometry;
}

} // namespace osgGeoFX
