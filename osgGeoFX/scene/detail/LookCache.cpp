// SPDX-License-Identifier: MIT
// SPDX-FileCopyrightText: 2026 the osgGeoFX authors
#include <osgGeoFX/scene/detail/LookCache.h>

#include <osgGeoFX/scene/ShaderHost.h>
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

void LookCache::begin(osg::Program* program, FollowingPrograms* following, int mapUnit, bool normals)
{
    if (_program != program)
    {
        _program = program;
        _looks.clear();
        _look = nullptr;
    }
    _mapUnit = mapUnit;
    _normals = normals;
    _following = following;
    _copies.clear();
    _graph = nullptr;
    _metMap = _metNoMap = false;
}

osg::StateSet* LookCache::lookFor(const osg::Drawable& drawable, const osg::StateSet* own,
                                  const osgUtil::StateGraph& graph)
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
    // Each look at a geometry's arrays costs as much as culling the geometry.
    const bool noNormal = _normals && hasNoNormal(drawable);
    if (otherGraph || own != _ownState || noNormal != _ownNoNormal)
    {
        _ownNoNormal = noNormal;
        _ownState = own;
        FixedFunctionState state = _state;
        if (_ownState) state.meet(*_ownState);
        _ownLook = lookFor(state, noNormal);
    }
    return _ownLook;
}

osg::StateSet* LookCache::lookFor(const osg::Drawable& drawable, const FixedFunctionState& state)
{
    return lookFor(state, _normals && hasNoNormal(drawable));
}

osg::StateSet* LookCache::lookFor(const FixedFunctionState& state, bool noNormal)
{
    if (!_program) return nullptr;
    osg::Program* program = _program;
    FixedFunctionLook look = state.look(_mapUnit);
    // An application's shaders may find it elsewhere.
    const bool map = look.map || look.ownProgram;
    _metMap = _metMap || map;
    _metNoMap = _metNoMap || !map;
    if (look.ownProgram)
    {
        program = copyOf(*state.program()).fixedVertices;
        if (!program) return nullptr;
        look = state.vertexLook();
    }
    look.noNormal = noNormal;
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
    const Key key(program, look.key());
    if (!_look || key != _lookKey)
    {
        osg::ref_ptr<osg::StateSet>& set = _looks[key];
        if (!set) set = look.createStateSet(program);
        _look = set;
        _lookKey = key;
    }
    return _look;
}

void LookCache::setHost(const ShaderHost* host, osg::StateSet* addition)
{
    _host = addition ? host : nullptr;
    _addition = addition;
}

osg::StateSet* LookCache::followingOf(const osg::StateAttribute* program)
{
    if (program && _host && _host->draws(*program)) return _addition;
    return program && _following ? copyOf(*program).state : nullptr;
}

const LookCache::Copy& LookCache::copyOf(const osg::StateAttribute& program)
{
    const auto [found, isNew] = _copies.try_emplace(&program);
    Copy& copy = found->second;
    if (isNew && _following) copy.state = _following->of(program, _program);
    if (isNew && copy.state && FollowingPrograms::hasFixedVertices(program))
        copy.fixedVertices =
            static_cast<osg::Program*>(copy.state->getAttribute(osg::StateAttribute::PROGRAM));
    return copy;
}

} // namespace osgGeoFX
