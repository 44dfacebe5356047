// SPDX-License-Identifier: MIT
// SPDX-FileCopyrightText: 2026 the osgGeoFX authors
#pragma once

#include <osgGeoFX/effect/ScenePass.h>
#include <osgGeoFX/scene/detail/EffectProgram.h>
#include <osgGeoFX/scene/detail/FollowingPrograms.h>

#include <osg/Program>
#include <osg/observer_ptr>

#include <map>
#include <mutex>
#include <string>
#include <vector>

namespace osgGeoFX
{

/// The programs that a scene's effects are drawn with: made anew where effects or shaders change, and never changed. Thread-safe.
class ProgramCache
{
public:
    using Effects = EffectProgram::Effects;

    /// For geometry that has none. Null, after a warning, where a shader file is missing.
    osg::ref_ptr<osg::Program> programOf(const Effects& effects);
    /// Of an effect, with that prefix, that draws the scene again.
    osg::ref_ptr<osg::Program> passProgramOf(const Effects& effects, const PassShaders& shaders,
                                             const std::string& prefix);
    /// For what has programs of the application's.
    FollowingPrograms& following() { return _following; }
    /// The list of effects has changed.
    void dirty();
    /// All programs that may have GL objects.
    std::vector<osg::ref_ptr<osg::Program>> all();

private:
    struct PassProgram
    {
        bool made = false;
        std::string effects; ///< the key of those that it was made for
        osg::ref_ptr<osg::Program> program;
    };
    /// Whether an effect has changed, or the list of them, since the last call.
    bool changed(const Effects& effects);
    /// One that is in use no more; state sets of frames and of cameras that have gone may hold it for a while.
    void retire(const osg::ref_ptr<osg::Program>& former);

    std::mutex _mutex;
    Effects _effects; ///< those that the program was made for, and
    std::vector<unsigned int> _revisions;
    std::string _key;
    bool _made = false;
    osg::ref_ptr<osg::Program> _program;
    std::map<std::string, PassProgram> _passes;
    std::vector<osg::observer_ptr<osg::Program>> _retired;
    FollowingPrograms _following;
};

} // namespace osgGeoFX
