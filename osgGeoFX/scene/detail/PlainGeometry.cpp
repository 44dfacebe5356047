// SPDX-License-Identifier: MIT
// SPDX-FileCopyrightText: 2026 the osgGeoFX authors
#include <osgGeoFX/scene/detail/PlainGeometry.h>

#include <osgGeoFX/effect/GroundShade.h>
#include <osgGeoFX/effect/RigidParts.h>
#include <osgGeoFX/paging/TerrainInfo.h>
#include <osgGeoFX/scene/RigidReference.h>

#include <osg/Billboard>
#include <osg/Camera>

#include <string>
#include <typeinfo>
#include <utility>

namespace osgGeoFX
{

PlainGeometry::PlainGeometry() : osg::NodeVisitor(TRAVERSE_ALL_CHILDREN)
{
    setNodeMaskOverride(~0u);
}

void PlainGeometry::apply(osg::Node& node)
{
    descend(node);
}

void PlainGeometry::apply(osg::Group& group)
{
    if (!dynamic_cast<const RigidReference*>(&group)) descend(group);
}

void PlainGeometry::apply(osg::Transform& transform)
{
    // Those that follow the eye have no matrix of their own; the kit's tiles are as they should be.
    osg::Matrixd matrix = _matrix;
    if (TileInfo::isTile(transform) || transform.getReferenceFrame() != osg::Transform::RELATIVE_RF ||
        transform.className() == std::string("AutoTransform") ||
        !transform.computeLocalToWorldMatrix(matrix, this) || !enters(matrix))
        return;
    std::swap(matrix, _matrix);
    descend(transform);
    _matrix = matrix;
}

void PlainGeometry::apply(osg::Geometry& geometry)
{
    DeformationSwitch state = _state;
    state.meet(geometry.getStateSet());
    if (!state.on || _programs.isStranger(state.program) || typeid(geometry) != typeid(osg::Geometry) ||
        geometry.getDataVariance() == osg::Object::DYNAMIC || RigidParts::of(geometry) ||
        GroundShade::is(geometry))
        return;
    meet(geometry, _matrix);
}

void PlainGeometry::descend(osg::Node& node)
{
    const DeformationSwitch former = _state;
    _state.meet(node.getStateSet());
    traverse(node);
    _state = former;
}

} // namespace osgGeoFX
