// SPDX-License-Identifier: MIT
// SPDX-FileCopyrightText: 2026 the osgGeoFX authors
#pragma once

#include <osgGeoFX/effect/ScenePass.h>
#include <osgGeoFX/scene/ShaderHost.h>
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

/// The programs that draw a scene's effects. A program is made anew when effects or shaders change, and is never
/// changed itself. Thread-safe.
class ProgramCache
{
public:
    using Effects = EffectProgram::Effects;

    /// The program for geometry that has none. Null, after a warning, if a shader file is missing.
    osg::ref_ptr<osg::Program> programOf(const Effects& effects);
    /// The same for patches of triangles (EffectProgram::createTessellating()). After programOf().
    osg::ref_ptr<osg::Program> tessellatingProgramOf(const Effects& effects);
    /// Gives the texts of the effects to a host that has other ones. After programOf(). Returns the state with its addition;
    /// null if it has none.
    osg::ref_ptr<osg::StateSet> tell(ShaderHost& host, const Effects& effects);
    /// The state with a host's addition for a pass that passProgramOf() has given a program; null if it has none, or if the
    /// pass has more stages than the host. Also for the program of the scene itself.
    osg::ref_ptr<osg::StateSet> additionOf(ShaderHost& host, const Effects& effects,
                                           const osg::Program* program);
    /// The program of a pass of the effect with this prefix.
    osg::ref_ptr<osg::Program> passProgramOf(const Effects& effects, const PassShaders& shaders,
                                             const std::string& prefix);
    /// The copies of the application's programs.
    FollowingPrograms& following() { return _following; }
    /// Notes that the list of effects has changed.
    void dirty();
    /// The same, and keeps none of them.
    void forgetEffects();
    /// All programs that may have GL objects.
    std::vector<osg::ref_ptr<osg::Program>> all();

private:
    struct PassProgram
    {
        bool made = false;
        std::string effects; ///< the key of the effects that it was made for
        osg::ref_ptr<osg::Program> program;
        PassShaders shaders = {};
        std::string prefix = {};
        osg::ref_ptr<ShaderHost> host = {}; ///< that was asked for its addition
        osg::ref_ptr<osg::StateSet> addition = {};
    };
    /// Whether an effect or the list of effects has changed since the last call.
    bool changed(const Effects& effects);
    /// Remembers a program that is no longer in use. State sets of frames on their way, or of cameras that are gone,
    /// may keep it for a while.
    void retire(const osg::ref_ptr<osg::Program>& former);

    std::mutex _mutex;
    Effects _effects; ///< the effects at the last call of changed(); their revisions come next
    std::vector<unsigned int> _revisions;
    std::string _key;
    osg::ref_ptr<ShaderHost> _host; ///< that was told last, and
    std::string _toldKey;           ///< the key of what it was told
    osg::ref_ptr<osg::StateSet> _addition;
    bool _made = false;
    osg::ref_ptr<osg::Program> _program;
    std::string _tessellatingKey; ///< the key of what the next one was made for
    osg::ref_ptr<osg::Program> _tessellating;
    std::map<std::string, PassProgram> _passes;
    std::vector<osg::observer_ptr<osg::Program>> _retired;
    FollowingPrograms _following;
};

} // namespace osgGeoFX
