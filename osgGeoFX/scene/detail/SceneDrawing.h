// SPDX-License-Identifier: MIT
// SPDX-FileCopyrightText: 2026 the osgGeoFX authors
#pragma once

#include <osgGeoFX/effect/PerCamera.h>
#include <osgGeoFX/scene/EffectScene.h>
#include <osgGeoFX/scene/detail/CameraPasses.h>
#include <osgGeoFX/scene/detail/CameraState.h>
#include <osgGeoFX/scene/detail/CompensatingCullVisitor.h>
#include <osgGeoFX/scene/detail/GroundFinder.h>
#include <osgGeoFX/scene/detail/Misuse.h>
#include <osgGeoFX/scene/detail/ProgramCache.h>

#include <map>
#include <memory>
#include <mutex>
#include <optional>
#include <set>
#include <string>
#include <vector>

namespace osgGeoFX
{

/// Draws the terrain of an EffectScene with its effects, for any number of cameras at once. Thread-safe.
class SceneDrawing
{
public:
    using Effects = EffectProgram::Effects;
    using Traverse = CompensatingCullVisitor::Traverse;

    SceneDrawing();

    /// Culls what is below `top`, where `outer` has come to, and has it drawn with or without effects, the nearest tiles first.
    /// `traverse` goes on below it. False if `outer` is a visitor of ours, or draws nothing; nothing has been culled then.
    bool cull(EffectScene& scene, const Effects& effects, osgUtil::CullVisitor& outer, osg::Group& top,
              const Traverse& traverse);

    /// As EffectScene::turnOfHorizon().
    osg::Matrixd turnOfHorizon(EffectScene& scene, const Effects& effects, osgUtil::CullVisitor& outer);

    /// Computes the bounds of all nodes below one, whatever is known of those above them: a node with a bound of its own
    /// says nothing of its children.
    static void computeBoundsBelow(const osg::Group& top);

    /// Keeps no effect that the scene has removed. Not while it is culled.
    void forgetEffects();

    void resizeGLObjectBuffers(unsigned int size);
    void releaseGLObjects(osg::State* state);

    /// Notes that the list of effects, or what draws them, has changed.
    void dirty();

    GroundFinder ground;
    ProgramCache programs;
    Misuse misuse;

private:
    class Traversal;
    /// For one cull visitor of OSG: so for one camera, and one of the frames that are on their way.
    struct Camera
    {
        osg::ref_ptr<CompensatingCullVisitor> visitor = new CompensatingCullVisitor;
        CameraPasses passes;
        std::vector<std::unique_ptr<CameraState>> states; ///< one for each traversal of a frame
        std::size_t used = 0;

        void startFrame(osgUtil::CullVisitor& outer);
        void forgetStates()
        {
            states.clear();
            used = 0;
        }
        void resizeGLObjectBuffers(unsigned int size) { visitor->twins().resizeGLObjectBuffers(size); }
        void releaseGLObjects(osg::State* state) const { visitor->twins().releaseGLObjects(state); }
        CameraState& nextState(const Effects& effects, int mapUnit,
                               const std::shared_ptr<const TextureUnits>& units);
    };

    /// The same; false if the camera draws the scene without effects.
    bool cullWithEffects(EffectScene& scene, const Effects& effects, osgUtil::CullVisitor& outer,
                         osg::Group& top, const Traverse& traverse);
    /// The effects that a camera draws in the places of a scene's.
    Effects effectsFor(const Effects& effects, const CameraEffects& camera);
    /// The programs of a camera whose effects need other shaders than the scene's; null where they need the same. `needing`:
    /// those that they are made for.
    std::shared_ptr<ProgramCache> otherPrograms(const EffectScene& scene, const Effects& effects,
                                                const Effects& shown, Effects& needing);
    std::vector<osg::ref_ptr<osg::Program>> allPrograms();
    std::shared_ptr<const TextureUnits> unitsOf(const Effects& effects, const EffectScene& scene);
    void completeBounds(const EffectScene& scene, const osg::Group& top, const osg::FrameStamp* stamp);
    void sayOnce(const std::string& sentence);
    void warnOf(const CompensatingCullVisitor::Stranger& stranger);

    std::mutex _mutex;
    PerCamera<Camera> _cameras;
    std::map<std::string, std::shared_ptr<ProgramCache>> _otherPrograms; ///< by EffectProgram::key()
    std::shared_ptr<const TextureUnits> _units;
    int _lowestUnit = TextureUnits::first, _lowestBlock = TextureUnits::firstBlock;
    TextureUnits::Units _choice;
    Effects _unitEffects; ///< those that the units were given to, and
    std::vector<unsigned int> _unitRevisions;
    osg::ref_ptr<osg::StateSet> _untouched = new osg::StateSet;
    const osg::ref_ptr<osg::StateSet> _inPass = new osg::StateSet;
    std::optional<unsigned int> _boundsFrame; ///< the frame that another node's bounds were completed in
    std::set<std::string> _said;
    /// Those that have been warned of, by themselves and by OwnPrograms::numberOf().
    std::map<const osg::StateAttribute*, osg::observer_ptr<const osg::StateAttribute>> _strangers;
    std::set<std::size_t> _strangerNumbers;
    std::size_t _strangersPurgeSize = 64;
};

} // namespace osgGeoFX
