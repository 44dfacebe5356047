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

namespace osgGeoFX
{

class FollowingPrograms;

/** With which state sets drawables are drawn below effects: those without a program with a look that stands in for OpenGL's
    fixed functions, those with one of the application's with a copy of that. What it hands out stays the same for as long as the
    program does. For one thread at a time. */
class LookCache
{
public:
    /// For one traversal. Another program forgets all looks. No program: nothing has a look. `mapUnit`: −1 for none.
    void begin(osg::Program* program, FollowingPrograms* following, int mapUnit);

    /// Null for what is drawn by a program of its own.
    osg::StateSet* lookFor(const osg::Drawable& drawable, const osgUtil::StateGraph& graph);
    osg::StateSet* lookFor(const FixedFunctionState& state);
    /// The copy of the program in force that has the effects' functions; null where that draws by itself.
    osg::StateSet* followingOf(const osg::StateAttribute* program);

private:
    osg::ref_ptr<osg::Program> _program;
    int _mapUnit = -1;
    std::map<FixedFunctionLook::Key, osg::ref_ptr<osg::StateSet>> _looks;
    osg::StateSet* _look = nullptr; ///< the last one; neighbours mostly look alike
    FixedFunctionLook::Key _lookKey{};
    FollowingPrograms* _following = nullptr;
    std::map<const osg::StateAttribute*, osg::ref_ptr<osg::StateSet>>
        _copies;                                 ///< by programs, of this traversal
    const osgUtil::StateGraph* _graph = nullptr; ///< whose state is gathered
    FixedFunctionState _state;
    const osg::StateSet* _ownState = nullptr; ///< of the drawable that was looked for last
    osg::StateSet* _ownLook = nullptr;
    bool _warned = false;
};

} // namespace osgGeoFX
