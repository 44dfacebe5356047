// SPDX-License-Identifier: MIT
// SPDX-FileCopyrightText: 2026 the osgGeoFX authors
#pragma once

#include <osgGeoFX/effect/RigidParts.h>
#include <osgGeoFX/scene/DeformedIntersector.h>
#include <osgGeoFX/scene/RigidReference.h>

namespace osgGeoFX
{

/// Visits the ground alone: passes over things that keep their shape.
class GroundVisitor : public DeformedIntersectionVisitor
{
public:
    using DeformedIntersectionVisitor::apply;
    using DeformedIntersectionVisitor::DeformedIntersectionVisitor;
    void apply(osg::Group& node) override
    {
        if (!dynamic_cast<RigidReference*>(&node)) DeformedIntersectionVisitor::apply(node);
    }
    void apply(osg::Drawable& drawable) override
    {
        if (!RigidParts::inForce(getNodePath())) DeformedIntersectionVisitor::apply(drawable);
    }
};

} // namespace osgGeoFX
