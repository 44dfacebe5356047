// SPDX-License-Identifier: MIT
// SPDX-FileCopyrightText: 2026 the osgGeoFX authors
#include <osgGeoFX/scene/MeshRefiner.h>

#include <osgGeoFX/scene/EffectScene.h>
#include <osgGeoFX/scene/detail/GeometryRefinement.h>
#include <osgGeoFX/scene/detail/PlainGeometry.h>

#include <osg/Geometry>
#include <osg/Notify>

#include <algorithm>
#include <cmath>
#include <map>

namespace osgGeoFX
{

/// Finds the geometries to split, each once, with the matrix that makes its edges the longest.
class MeshRefiner::Visitor : public PlainGeometry
{
public:
    std::map<osg::ref_ptr<osg::Geometry>, osg::Matrixd> found;

private:
    void meet(osg::Geometry& geometry, const osg::Matrixd& matrix) override
    {
        const auto [entry, isNew] = found.try_emplace(&geometry, matrix);
        if (!isNew && largestScale(matrix) > largestScale(entry->second)) entry->second = matrix;
    }
};

MeshRefiner::MeshRefiner(double longestEdge) : _longestEdge(longestEdge)
{
    if (longestEdge > 0.0) return;
    OSG_WARN << "osgGeoFX: MeshRefiner: the longest edge must be more than 0 m, not " << longestEdge
             << ". Nothing will be split." << std::endl;
    _longestEdge = HUGE_VAL;
}

MeshRefiner::~MeshRefiner() = default;

double MeshRefiner::longestEdge(const EffectScene& scene, const CameraRange& cameras, double tolerance)
{
    std::vector<const Deformation*> bending;
    for (unsigned int i = 0; i < scene.getNumEffects(); ++i)
    {
        const Effect& effect = *scene.getEffect(i);
        if (effect.getEnabled() && effect.asDeformation()) bending.push_back(effect.asDeformation());
    }
    // Each adds its error to those before it.
    const auto limits = [&](const Deformation* each)
    {
        return each->longestEdge(cameras, tolerance) < HUGE_VAL;
    };
    const double share = tolerance / static_cast<double>(std::max<std::ptrdiff_t>(
                                         1, std::count_if(bending.begin(), bending.end(), limits)));
    CameraRange now = cameras;
    double longest = HUGE_VAL, growth = 1.0;
    for (const Deformation* each : bending)
    {
        longest = std::min(longest, each->longestEdge(now, share) / growth);
        growth *= each->mostGrowth(now.ground);
        each->changeGround(now.ground);
    }
    return longest;
}

bool MeshRefiner::setMostTriangles(unsigned int count)
{
    constexpr unsigned int least = 1000, most = 10000000;
    if (count < least || count > most)
    {
        OSG_WARN
            << "osgGeoFX: MeshRefiner::setMostTriangles: the number must be from 1,000 to 10,000,000, not "
            << count << ". The former one stays." << std::endl;
        return false;
    }
    _mostTriangles = count;
    return true;
}

void MeshRefiner::refine(osg::Node& node)
{
    if (!(_longestEdge < HUGE_VAL)) return;
    Visitor visitor;
    node.accept(visitor);
    for (const auto& [geometry, matrix] : visitor.found)
    {
        const RefinedGeometry result = refineGeometry(*geometry, matrix, _longestEdge, _mostTriangles);
        if (result.triangles == 0) continue;
        ++_geometries;
        _triangles += result.triangles;
        if (result.inside == 1.0 || _said.exchange(true)) continue;
        OSG_WARN << "osgGeoFX: MeshRefiner: the geometry \"" << geometry->getName()
                 << "\" would need more than " << _mostTriangles << " triangles for edges of " << _longestEdge
                 << " m, so edges inside of it are up to " << result.inside
                 << " times as long. Raise the limit (setMostTriangles), or the cameras' least distance from "
                    "the ground."
                 << std::endl;
    }
}

} // namespace osgGeoFX
