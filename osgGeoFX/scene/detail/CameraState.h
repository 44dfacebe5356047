// SPDX-License-Identifier: MIT
// SPDX-FileCopyrightText: 2026 the osgGeoFX authors
#pragma once

#include <osgGeoFX/effect/DeformationChain.h>
#include <osgGeoFX/effect/DepthConvention.h>
#include <osgGeoFX/effect/TextureUnits.h>
#include <osgGeoFX/scene/detail/EffectProgram.h>

#include <osg/StateSet>
#include <osg/Uniform>
#include <osgUtil/CullVisitor>

#include <memory>
#include <string>
#include <vector>

namespace osgGeoFX
{

/// Which effects of a scene a camera draws: those that are switched on, but of several projections
/// (Deformation::isProjection) the first alone.
class EffectsAtWork
{
public:
    explicit EffectsAtWork(const EffectProgram::Effects& effects);
    bool operator[](std::size_t effect) const { return _work[effect]; }
    /// What to tell the user; empty if nothing is left out.
    const std::string& sentence() const { return _sentence; }

private:
    std::vector<bool> _work;
    std::string _sentence;
};

/// The deformations of one camera, one entry for each effect of its scene.
class CameraSnapshots
{
public:
    CameraSnapshots(const EffectProgram::Effects& effects, const EffectsAtWork& work,
                    const ViewGeometry& view);

    /// The chain of all deformations, in their order.
    osg::ref_ptr<DeformationChain> chain(const Ground& ground) const;

    /// What one deformation does for the camera. The snapshot is null where it does nothing.
    struct Placed
    {
        osg::ref_ptr<const DeformationSnapshot> snapshot;
        DeformationSnapshot::Uniforms uniforms;
    };
    const std::vector<Placed>& all() const { return _all; }

private:
    std::vector<Placed> _all;
};

/// The uniforms, defines and textures of all effects, for one traversal of one camera. For one thread at a time.
class CameraState
{
public:
    CameraState(const EffectProgram::Effects& effects, int mapUnit,
                const std::shared_ptr<const TextureUnits>& units);

    /// The texture units of the effects that this state was made for.
    const std::shared_ptr<const TextureUnits>& units() const { return _units; }
    osg::StateSet& set() const { return *_set; }
    void fill(const CameraSnapshots& snapshots, const ViewGeometry& view, const CameraDepth& depth,
              int mapUnit);
    /// Whether colors above 1 stay what they are.
    void setBright(bool on);
    /// The plane at which osgEarth clips, in the world; null: its own one.
    void setHorizonPlane(const osg::Vec4d* plane);
    /// Of the effects that color surfaces; whether there are any at work.
    bool fillSurfaces(const EffectProgram::Effects& effects, const EffectsAtWork& work,
                      const ViewGeometry& geometry, osgUtil::CullVisitor& outer);

private:
    void fillImage(const ViewGeometry& view);
    osg::Uniform& uniformAt(std::size_t effect, std::size_t place, const std::string& name);

    osg::ref_ptr<osg::StateSet> _set = new osg::StateSet;
    std::shared_ptr<const TextureUnits> _units;
    /// The uniforms of each effect, in the order of its list. Finding them by name takes longer than setting them.
    std::vector<std::vector<osg::ref_ptr<osg::Uniform>>> _uniforms;
};

} // namespace osgGeoFX
