// SPDX-License-Identifier: MIT
// SPDX-FileCopyrightText: 2026 the osgGeoFX authors
#pragma once

#include <osgGeoFX/effect/Effect.h>
#include <osgGeoFX/effect/ViewGeometry.h>

#include <osg/Group>
#include <osg/Program>
#include <osg/StateSet>

#include <string>
#include <utility>
#include <vector>

namespace osgUtil
{
class CullVisitor;
}

namespace osgGeoFX
{

class DeformationChain;
class DrawableCompanion;
class FollowingPrograms;
class TileListener;

/** The shader files of an effect that draws the scene again. In all of them `SLOT_` stands for the effect's prefix.

    The vertex files have `vec3 SLOT_move(vec3 located, vec3 bent)`: where a point goes, from its undeformed place and the one that the
    scene's deformations give it. The fragment files have `vec4 SLOT_finish(vec4 colour)`, which has the last word, and
    `int SLOT_channels()`, the mappings to be shown. Where there is a geometry file, it has main(); the vertex and the
    fragment files then see GEOFX_AMPLIFY, and in the geometry file GEOFX_VARYINGS stands for the declarations of all that the other effects hand to
    the fragment stage and GEOFX_COPY(i) for handing on the i-th vertex' values. Where there are files for tessellation, which
    need a geometry file, too, the vertex files also see GEOFX_TESSELLATE, and GEOFX_COPY(w) in the evaluation's stands for
    values weighted by w. */
struct PassShaders
{
    std::vector<std::string> vertex, tessellationControl, tessellationEvaluation, geometry, fragment;
    /// main() of the vertex and the fragment stage; the kit's stand-in for the fixed functions where they are empty.
    std::string vertexMain, fragmentMain;
    std::vector<std::pair<std::string, unsigned int>>
        blocks; ///< uniform blocks by their names without the prefix
};

/// What an effect that draws the scene again is given, by one camera that culls.
class OSGGEOFX_EXPORT ScenePass
{
public:
    osgUtil::CullVisitor& outer; ///< at the EffectScene
    osg::Group& scene;           ///< whose children are drawn
    const ViewGeometry& view;
    const DeformationChain& chain;
    osg::StateSet& state;         ///< uniforms and defines of all effects for this camera
    osg::StateSet& untouched;     ///< takes the deformation away
    FollowingPrograms& following; ///< for programs of the application's own
    const std::string& prefix;    ///< of the effect's names
    double tileError;             ///< Ground::tileError
    int mapUnit;
    bool compensate;               ///< EffectScene::getCompensation()
    const std::vector<int>& units; ///< texture units that the effect has here (TextureUser)

    virtual ~ScenePass();
    /// A program of all effects with the pass' own shaders; the same one until effects or shaders change. Null, after a
    /// warning, where a shader file is missing.
    virtual osg::ref_ptr<osg::Program> program(const PassShaders& shaders) const = 0;
    /// The one that the scene itself is drawn with.
    virtual osg::ref_ptr<osg::Program> sceneProgram() const = 0;

protected:
    ScenePass(osgUtil::CullVisitor& visitor, osg::Group& group, const ViewGeometry& geometry,
              const DeformationChain& deformations, osg::StateSet& stateSet, osg::StateSet& left,
              FollowingPrograms& programs, const std::string& names, double error, int unit,
              bool compensation, const std::vector<int>& textureUnits)
        : outer(visitor), scene(group), view(geometry), chain(deformations), state(stateSet), untouched(left),
          following(programs), prefix(names), tileError(error), mapUnit(unit), compensate(compensation),
          units(textureUnits)
    {
    }
};

/** An effect that draws parts of the scene again, into pictures of its own, and puts these into the camera's. */
class OSGGEOFX_EXPORT PassEffect : public Effect
{
public:
    PassEffect* asPassEffect() override { return this; }
    using Effect::asPassEffect;

    /** Adds its stages to the camera's. Called after the scene has been culled. Several cameras' threads may call it at
        once. */
    virtual void cull(const ScenePass& pass) = 0;
    /// What is drawn with the scene's drawables as they are culled; null, the default, for nothing. Called before the scene is culled,
    /// by that camera's thread, and to be kept until the same cull visitor asks again.
    virtual DrawableCompanion* companion(const ScenePass&) { return nullptr; }
    /// Who is to be told of tiles that a pager reads; null, the default, for no one.
    virtual osg::ref_ptr<TileListener> tileListener(const Ground&);

protected:
    PassEffect() = default;
    PassEffect(const PassEffect& other, const osg::CopyOp& copy) : Effect(other, copy) {}
    ~PassEffect() override;
};

} // namespace osgGeoFX
