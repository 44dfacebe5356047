// SPDX-License-Identifier: MIT
// SPDX-FileCopyrightText: 2026 the osgGeoFX authors
#include <osgGeoFX/scene/detail/LookCache.h>

#include <osgGeoFX/scene/detail/FollowingPrograms.h>

#include <osg/Geometry>
#include <osg/Notify>

namespace osgGeoFX
{

namespace
{

bool hasNoNormal(const osg::Drawable& drawable)
{
    const osg::Geometry* geometry = drawable.asGeometry();
    return geometry &&
           (!geometry->getNormalArray() || geometry->getNormalArray()->getBinding() == osg::Array::BIND_OFF);
}

} // namespace

void LookCache::begin(osg::Program* program, FollowingPrograms* following, int mapUnit)
{
    if (_program != program)
    {
        _program = program;
        _looks.clear();
        _look = nullptr;
    }
    _mapUnit = mapUnit;
    _following = following;
    _copies.clear();
    _graph = nullptr;
}

osg::StateSet* LookCache::lookFor(const osg::Drawable& drawable, const osgUtil::StateGraph& graph)
{
    if (!_program) return nullptr;
    const bool otherGraph = &graph != _graph;
    if (otherGraph)
    {
        _graph = &graph;
        _state = FixedFunctionState();
        _state.meetAll(graph);
    }
    // The meshes of a tile share one state set.
    const bool noNormal = hasNoNormal(drawable);
    if (otherGraph || drawable.getStateSet() != _ownState || noNormal != _ownNoNormal)
    {
        _ownNoNormal = noNormal;
        _ownState = drawable.getStateSet();
        FixedFunctionState state = _state;
        if (_ownState) state.meet(*_ownState);
        _ownLook = lookFor(state, noNormal);
    }
    return _ownLook;
}

osg::StateSet* LookCache::lookFor(const osg::Drawable& drawable, const FixedFunctionState& state)
{
    return lookFor(state, hasNoNormal(drawable));
}

osg::StateSet* LookCache::lookFor(const FixedFunctionState& state, bool noNormal)
{
    if (!_program) return nullptr;
    FixedFunctionLook look = state.look(_mapUnit);
    look.noNormal = noNormal && !look.ownProgram;
    if (look.ownProgram) return nullptr;
    if (look.unsupported && !_warned)
    {
        _warned = true;
        OSG_NOTICE
            << "osgGeoFX: something in the scene uses a texture that is not two-dimensional, or a texture "
               "environment or generation mode that the kit's shaders do not have; it is drawn without. Give "
               "it "
               "a shader that calls geofx_vertex()."
            << std::endl;
    }
    const FixedFunctionLook::Key key = look.key();
    if (!_look || key != _lookKey)
    {
        osg::ref_ptr<osg::StateSet>& set = _looks[key];
        if (!set) set = look.createStateSet(_program);
        _look = set;
        _lookKey = key;
    }
    return _look;
}

osg::StateSet* LookCache::followingOf(const osg::StateAttribute* program)
{
    if (!program || !_following) return nullptr;
    const auto [found, isNew] = _copies.try_emplace(program);
    if (isNew) found->second = _following->of(*program, _program);
    return found->second;
}

} // namespace osgGeoFX
