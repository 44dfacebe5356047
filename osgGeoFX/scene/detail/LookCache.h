// SPDX-License-Identifier: MIT
// SPDX-FileCopyrightText: 2026 the osgGeoFX authors
#pragma once

#include <osgGeoFX/scene/detail/FixedFunctionLook.h>

#include <osg/Drawable>
#include <osg/Program>
#include <osg/StateSet>
#include <osg/ref_ptr>
#include <osgUtil/StateGraph>

#include <map>
#include <utility>

namespace osgGeoFX
{

class FollowingPrograms;
class ShaderHost;

/** The state sets that drawables below effects are drawn with. A drawable without a program gets a look, which stands
    in for OpenGL's fixed functions. A drawable with a program of the application gets a copy of that program. If this
    has a fragment stage alone, the drawable gets a look whose vertex stage stands in for the fixed one. These state
    sets stay the same as long as the scene's program does. For one thread at a time. */
class LookCache
{
public:
    /// Starts a traversal. A new program clears all looks; without a program nothing has a look. `mapUnit`: −1 for
    /// none. `normals`: whether effects look at normals, so that it matters which drawables have none.
    void begin(osg::Program* program, FollowingPrograms* following, int mapUnit, bool normals);
    /// What is drawn below the programs of an engine that assembles its shaders itself; null for nothing. After begin().
    void setHost(const ShaderHost* host, osg::StateSet* addition);

    /// The look of a drawable with a state set of its own, or none, below a node of the state graph. Null for one whose vertices a
    /// program of its own places.
    osg::StateSet* lookFor(const osg::Drawable& drawable, const osg::StateSet* own,
                           const osgUtil::StateGraph& graph);
    osg::StateSet* lookFor(const osg::Drawable& drawable, const FixedFunctionState& state);
    /// The copy of the program in force that has the effects' functions, or what its engine adds to it, for a drawable
    /// without a look. Null for a program that draws without them.
    osg::StateSet* followingOf(const osg::StateAttribute* program);

    /// Whether this traversal has met something with a texture on the map's unit, or what may have one; and something without.
    bool metMap() const { return _metMap; }
    bool metNoMap() const { return _metNoMap; }

private:
    /// What is drawn in the place of a program of the application, in this traversal.
    struct Copy
    {
        osg::ref_ptr<osg::StateSet> state; ///< null where nothing is
        osg::Program* fixedVertices =
            nullptr; ///< the copy itself, if it has the stand-in for the fixed vertex stage
    };
    const Copy& copyOf(const osg::StateAttribute& program);
    osg::StateSet* lookFor(const FixedFunctionState& state, bool noNormal);

    osg::ref_ptr<osg::Program> _program;
    int _mapUnit = -1;
    using Key = std::pair<const osg::Program*, FixedFunctionLook::Key>;
    std::map<Key, osg::ref_ptr<osg::StateSet>> _looks;
    osg::StateSet* _look = nullptr; ///< the last one; neighbours mostly look alike
    Key _lookKey{};
    FollowingPrograms* _following = nullptr;
    const ShaderHost* _host = nullptr;
    osg::StateSet* _addition = nullptr;
    std::map<const osg::StateAttribute*, Copy> _copies;
    const osgUtil::StateGraph* _graph = nullptr; ///< the node whose state _state has
    FixedFunctionState _state;
    const osg::StateSet* _ownState = nullptr; ///< that of the last drawable
    osg::StateSet* _ownLook = nullptr;
    bool _ownNoNormal = false;
    bool _normals = false;
    bool _warned = false;
    bool _metMap = false, _metNoMap = false;
};

} // namespace osgGeoFX
