// SPDX-License-Identifier: MIT
// SPDX-FileCopyrightText: 2026 the osgGeoFX authors
#include <osgGeoFX/scene/detail/DrawableSight.h>

#include <osgGeoFX/effect/RigidParts.h>

#include <cstddef>

namespace osgGeoFX
{

void DrawableSight::begin(const Wishes& wishes)
{
    _wishes = wishes;
    _depths.clear(_sight.depths(), wishes.meshes, &_sight.picture());
    _complaint.clear();
    if (wishes.bounds) _bounds.begin();
}

bool DrawableSight::inSight(const osg::Drawable& drawable, const Place& place, double& depth)
{
    const osg::BoundingBox& bounds = drawable.getBoundingBox();
    depth = 0.0;
    if (!bounds.valid()) return true;
    const bool test = drawable.isCullingActive();
    const bool small = test && place.smallCounts && _sight.cullsSmall();
    Visibility::Mask planes = test ? place.planes : 0;
    // Most drawables lie beside the picture, or in the middle of it and between near and far. Their bounding spheres settle it,
    // and nothing else in memory is looked at, which takes longer than to compute.
    if (!small && !place.chain.looksAtBoxes() && !_wishes.bounds)
    {
        const osg::BoundingSphere& sphere = drawable.getBound();
        const Ball roughly = place.chain.bound({osg::Vec3d(sphere.center()) * place.modelView,
                                                static_cast<double>(sphere.radius()) * place.scale});
        if (planes && _sight.outOfSight(roughly, planes, true)) return false;
        depth = _depths.depthOf(roughly.center);
        const bool depthSettled = !_wishes.depths || !place.depthCounts || _depths.covers(roughly);
        if (!planes && depthSettled) return true;
    }
    const EyeBox box = EyeBox::of(bounds, place.modelView);
    const Ball deformed = place.chain.bound(box.ball());
    depth = _depths.depthOf(deformed.center);
    if (test && _wishes.hides && _sight.hides(place.chain, box)) return false;
    if (small && _sight.tooSmall(deformed)) return false;
    if (planes && _sight.outOfSight(deformed, planes, true)) return false;
    // The hull and the smaller boxes are tested only where no point is known to show: neither the box's middle nor
    // the small box that showed last time.
    const bool crosses = planes && !_sight.holds(deformed.center, planes);
    const bool depthWanted = _wishes.depths && place.depthCounts && !_depths.covers(deformed);
    // Things that keep their shape are not squeezed where the ground around them is, so they reach beyond what becomes of their box.
    const bool rigid = place.rigid && RigidParts::of(drawable);
    const double margin = rigid && (crosses || depthWanted)
                              ? RigidParts::reach(drawable, place.chain, box.ball(), place.scale)
                              : 0.0;
    if (crosses && !witnessInSight(drawable, place, planes) &&
        (_sight.misses(place.chain, box, planes, margin) || meshOutside(drawable, place, planes)))
        return false;
    // What keeps its shape does not fold.
    if (place.chain.looksAtBoxes() && _complaint.empty() && !rigid)
        for (const auto& snapshot : place.chain.snapshots())
            if (_complaint.empty()) _complaint = snapshot->complaint(box);
    if (place.rigid && !rigid && !place.chain.empty() && _complaint.empty())
        _complaint =
            "GEOFX_RIGID is in force for the drawable \"" + drawable.getName() +
            "\" whose vertices have no references (RigidParts::of), so it is drawn where it does not "
            "belong; give it references with RigidParts::finish(), or set the define to OFF for it.";
    if (depthWanted) _depths.add(box, deformed, place.chain, {&drawable, place.modelView}, margin);
    if (_wishes.bounds) _bounds.add(box, place.chain);
    return true;
}

bool DrawableSight::meshOutside(const osg::Drawable& drawable, const Place& place, Visibility::Mask planes)
{
    MeshBoxes::Entry& mesh = _meshBoxes.of(drawable);
    const std::size_t count = mesh.boxes.size();
    const std::size_t former = mesh.witness;
    if (former < count && !misses(mesh.boxes[former], place, planes)) return false;
    // Middles are quick to test, and most often one of them shows.
    for (const bool wholly : {false, true})
    {
        for (mesh.witness = 0; mesh.witness < count; ++mesh.witness)
        {
            const osg::BoundingBox& box = mesh.boxes[mesh.witness];
            if (wholly ? !misses(box, place, planes) : middleInSight(box, place, planes)) return false;
        }
    }
    return count > 0;
}

bool DrawableSight::misses(const osg::BoundingBox& box, const Place& place, Visibility::Mask planes)
{
    const EyeBox eyeBox = EyeBox::of(box, place.modelView);
    return _sight.hides(place.chain, eyeBox) || _sight.misses(place.chain, eyeBox, planes);
}

bool DrawableSight::middleInSight(const osg::BoundingBox& box, const Place& place,
                                  Visibility::Mask planes) const
{
    return _sight.holds(place.chain.roughly(osg::Vec3d(box.center()) * place.modelView), planes);
}

bool DrawableSight::witnessInSight(const osg::Drawable& drawable, const Place& place, Visibility::Mask planes)
{
    const MeshBoxes::Entry* mesh = _meshBoxes.find(drawable);
    return mesh && mesh->witness < mesh->boxes.size() &&
           middleInSight(mesh->boxes[mesh->witness], place, planes);
}

} // namespace osgGeoFX
