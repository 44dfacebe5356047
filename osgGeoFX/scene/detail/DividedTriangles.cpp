// SPDX-License-Identifier: MIT
// SPDX-FileCopyrightText: 2026 the osgGeoFX authors
#include <osgGeoFX/scene/detail/DividedTriangles.h>

#include <osgGeoFX/effect/Tessellation.h>

#include <algorithm>
#include <cmath>

namespace osgGeoFX
{

namespace
{

const TessellatedSnapshot* tessellated(const DeformationSnapshot& snapshot)
{
    return dynamic_cast<const TessellatedSnapshot*>(&snapshot);
}

EyeBox boxAround(const Ball& ball)
{
    EyeBox box;
    box.center = ball.center;
    for (int axis = 0; axis < 3; ++axis)
        box.half[axis][axis] = ball.radius;
    return box;
}

} // namespace

bool DividedTriangles::wanted(const DeformationChain& chain)
{
    return std::any_of(chain.snapshots().begin(), chain.snapshots().end(),
                       [](const auto& each)
                       {
                           const TessellatedSnapshot* divider = tessellated(*each);
                           return divider && divider->dividesTriangles();
                       });
}

bool DividedTriangles::within(const DeformationChain& chain, const EyeBox& box)
{
    EyeBox here = box;
    for (const auto& each : chain.snapshots())
    {
        const TessellatedSnapshot* divider = tessellated(*each);
        if (divider && divider->divides(here)) return true;
        if (each != chain.snapshots().back()) here = boxAround(each->bound(here.ball()));
    }
    return false;
}

bool DividedTriangles::curves(const DeformationChain& chain, const EyeBox& box)
{
    Ball here = box.ball();
    for (const auto& each : chain.snapshots())
    {
        if (tessellated(*each) && each->reach(here) == DeformationSnapshot::Reach::Curved) return true;
        here = each->bound(here);
    }
    return false;
}

int DividedTriangles::parts(const DeformationChain& chain, osg::Vec3d from, osg::Vec3d to)
{
    osg::Vec2d sag;
    for (const auto& each : chain.snapshots())
    {
        if (const TessellatedSnapshot* divider = tessellated(*each))
        {
            const osg::Vec2d own = divider->edgeSag(from, to);
            sag.set(std::max(sag.x(), own.x()), std::max(sag.y(), own.y()));
        }
        from = each->deform(from);
        to = each->deform(to);
    }
    if (!(sag.x() > 0.0 || sag.y() > 0.0)) return 1;
    constexpr double share = 1e-4, sliding = 2.0; // the latter as bendview.sag.glsl has it
    const double near = std::min(from.length(), to.length()), far = std::max(from.length(), to.length());
    const double allowed = share * std::max({near - sag.x() - sag.y(), 0.05 * far, 1e-3});
    return static_cast<int>(
        std::ceil(std::clamp(std::max(std::sqrt(sag.x() / allowed), sag.y() / (sliding * allowed)), 1.0,
                             TessellatedSnapshot::mostParts)));
}

} // namespace osgGeoFX
