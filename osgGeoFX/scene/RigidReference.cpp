// SPDX-License-Identifier: MIT
// SPDX-FileCopyrightText: 2026 the osgGeoFX authors
#include <osgGeoFX/scene/RigidReference.h>

#include <osgGeoFX/scene/detail/CompensatingCullVisitor.h>

namespace osgGeoFX
{

RigidReference::RigidReference(const RigidReference& other, const osg::CopyOp& copy)
    : osg::Group(other, copy), _reference(other._reference), _useBoundCenter(other._useBoundCenter),
      _turn(other._turn)
{
}

RigidReference::~RigidReference() = default;

void RigidReference::accept(osg::NodeVisitor& visitor)
{
    if (!visitor.validNodeMask(*this)) return;
    visitor.pushOntoNodePath(this);
    if (auto* culling = dynamic_cast<CompensatingCullVisitor*>(visitor.asCullVisitor()))
        culling->apply(*this);
    else
        visitor.apply(*this);
    visitor.popFromNodePath();
}

osg::BoundingSphere RigidReference::computeBound() const
{
    osg::BoundingSphere sphere = osg::Group::computeBound();
    if (!sphere.valid()) return sphere;
    if (!_useBoundCenter) sphere.expandBy(_reference);
    // A ball (c, R) above has the bound (f(c), L·R). With the inner radius r: |rigid(p) − f(c)| is at most
    // L·(R − 3r) + L·r + 2r, since the reference is at most r from the middle and 2r from p.
    sphere.radius() *= 3.0f;
    return sphere;
}

} // namespace osgGeoFX
