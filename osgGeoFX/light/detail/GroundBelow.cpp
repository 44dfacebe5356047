// SPDX-License-Identifier: MIT
// SPDX-FileCopyrightText: 2026 the osgGeoFX authors
#include <osgGeoFX/light/detail/GroundBelow.h>

#include <osgGeoFX/scene/EffectScene.h>
#include <osgGeoFX/scene/detail/GroundVisitor.h>

#include <algorithm>

namespace osgGeoFX
{

namespace
{

/// No ground lies farther below the ellipsoid, metres; beyond it lies the other side of a globe.
constexpr double deepest = 12000.0;
/// An eye may be so far below the ground that is drawn, metres, where a coarser tile lies above a finer one.
constexpr double highest = 100.0;

} // namespace

GroundBelow GroundBelow::find(const ScenePass& pass)
{
    const ViewGeometry& view = pass.view;
    const double above = std::max(view.eyeHeight - std::max(view.ground.minHeight, 0.0), 0.0);
    GroundBelow found = {above, above};
    auto* const scene = dynamic_cast<EffectScene*>(&pass.scene);
    if (!scene) return found;
    const osg::ref_ptr<DeformedLineIntersector> ray =
        new DeformedLineIntersector(view.up * highest, -view.up);
    const osg::ref_ptr<GroundVisitor> visitor =
        new GroundVisitor(ray, pass.chain, view.modelView, static_cast<double>(pass.outer.getLODScale()));
    visitor->setTraversalMask(pass.outer.getTraversalMask());
    scene->getTerrain()->traverse(*visitor);
    // From above the eye on, down to the first ground that is not.
    for (const DeformedLineIntersector::Intersection& hit : ray->intersections())
    {
        const double drawn = hit.distance - highest;
        const double undeformed = -(hit.world * view.modelView * view.up);
        if (undeformed > view.eyeHeight + deepest) break;
        found = {std::max(drawn, 0.0), undeformed};
        if (drawn >= 0.0) break;
    }
    return found;
}

} // namespace osgGeoFX
