// SPDX-License-Identifier: MIT
// SPDX-FileCopyrightText: 2026 the osgGeoFX authors
#pragma once

#include <osgGeoFX/Export.h>
#include <osgGeoFX/effect/DeformationChain.h>
#include <osgGeoFX/effect/Effect.h>
#include <osgGeoFX/effect/ViewGeometry.h>

#include <osg/Group>
#include <osg/Program>
#include <osg/Shader>
#include <osgUtil/CullVisitor>

#include <functional>
#include <memory>
#include <vector>

namespace osgGeoFX
{

class PassEffect;
class ScenePass;
class TileGuard;
struct TextureUnits;

/** The group that a program puts above its terrain to have the kit's effects.

    @code
    osg::ref_ptr<osgGeoFX::EffectScene> scene = new osgGeoFX::EffectScene;
    scene->addEffect(new osgGeoFX::BirdsEyeView);
    scene->addChild(terrain);
    viewer.setSceneData(scene);
    @endcode

    **What it draws.** Everything below it, deformed by its effects in their order. Geometry without a shader keeps its
    look: materials, lights, up to four 2D textures with their environments, fog. Geometry with shaders of its own is
    deformed if these call geofx_vertex() and geofx_fragment() (shaders/stages/functions.*), after addFunctions();
    else it is drawn and culled where it is, and a warning tells once of each such program. It may stand below a
    RigidReference, which needs no shaders. A subgraph is left out with `stateSet->setDefine("GEOFX_DEFORMATION", OFF)`. Changes of
    programs and defines below a node that is out of sight are noticed after some frames; `setCullingActive(false)` makes
    it at once.
    Cameras and projections below it (render to texture, head-up displays) are drawn as ever. So is everything in
    cameras above it that are not the view's own or its slaves', such as a shadow map's, unless nestedCameras is on. Shadows are
    thus those of the undeformed world: a program that looks them up by the position that it gives to geofx_vertex() finds
    them wherever the ground goes.

    **Culling.** The terrain's nodes are not touched, whoever loads them, and may be shared with other scenes. Below the
    group a cull visitor of our own takes the place of the camera's: it culls by what the deformation makes of bounds,
    and chooses levels of detail by the deformed distance, for osg::LOD, osg::PagedLOD and whatever asks the visitor for
    distances; near and far planes come out right. Where no enabled effect does anything for the camera, the group draws
    what a plain osg::Group does; without an enabled deformation it is culled like one, too. See osgGeoFX/README.md.

    **Frames.** World coordinates are those of the group's children: geocentric below an osg::CoordinateSystemNode with an
    ellipsoid, which may stand above or below, else projected with z up. Transforms above must not scale.

    **Threads.** May be drawn by any number of cameras, views and contexts, in every threading model. Effects are added,
    removed and changed between frames. Several scenes may share a terrain, each with its own effects; one inside
    another is drawn without the inner one's effects. Views that show a paged terrain below different roots must share a
    pager (`view.setDatabasePager(other.getDatabasePager())`), for OSG keeps one request for each paged child. */
class OSGGEOFX_EXPORT EffectScene : public osg::Group
{
public:
    EffectScene();
    EffectScene(const EffectScene& other, const osg::CopyOp& copy = osg::CopyOp::SHALLOW_COPY);
    META_Node(osgGeoFX, EffectScene);

    enum TerrainFrame
    {
        AUTOMATIC, ///< what an osg::CoordinateSystemNode above or below says; projected where there is none
        GEOCENTRIC,
        PROJECTED
    };

    /// Null and an effect that is there already are refused.
    bool addEffect(Effect* effect);
    bool removeEffect(Effect* effect);
    unsigned int getNumEffects() const { return static_cast<unsigned int>(_effects.size()); }
    Effect* getEffect(unsigned int i) { return _effects[i].get(); }
    const Effect* getEffect(unsigned int i) const { return _effects[i].get(); }

    /// False: only the GPU deforms, and the CPU culls as if it did not. For comparison. True by default.
    void setCompensation(bool on) { _compensation = on; }
    bool getCompensation() const { return _compensation; }
    /// Draws the deformed bounds that culling decides on, yellow, and those in the transition zone red. False by default.
    void setDebugBounds(bool on) { _debugBounds = on; }
    bool getDebugBounds() const { return _debugBounds; }
    /// Whether cameras that stand above in the graph are deformed, too. False by default.
    void setNestedCameras(bool on) { _nestedCameras = on; }
    bool getNestedCameras() const { return _nestedCameras; }
    void setTerrainFrame(TerrainFrame frame) { _terrainFrame = frame; }
    TerrainFrame getTerrainFrame() const { return _terrainFrame; }

    /// Adds the functions geofx_vertex, geofx_normal and geofx_fragment to a program. Wherever an EffectScene draws with it, it draws
    /// with a copy that has the functions of its own effects; the program itself never changes.
    void addFunctions(osg::Program& program);

    /// The deformation of a camera: `modelView` from the children's frame to eye space. Never null; empty where
    /// nothing is deformed.
    osg::ref_ptr<const DeformationChain> deformation(const osg::Matrixd& modelView,
                                                     const osg::Matrixd& projection,
                                                     const osg::NodePath& above = {}) const;
    /// Lets effects work on tiles on the thread of the pager that reads them, in the place of the first frame that shows
    /// them. For the effects that the scene has now; may be called again.
    void listenTo(TileGuard& guard);
    /// What is known of the ground.
    Ground ground(const osg::NodePath& above = {}) const;

    void traverse(osg::NodeVisitor& visitor) override;
    void resizeGLObjectBuffers(unsigned int size) override;
    void releaseGLObjects(osg::State* state = nullptr) const override;

protected:
    ~EffectScene() override;

private:
    struct Drawing;
    bool cull(osgUtil::CullVisitor& outer);
    void forPasses(osgUtil::CullVisitor& outer, const ViewGeometry& view, const DeformationChain& chain,
                   osg::StateSet& state, int mapUnit, const TextureUnits& units,
                   const std::function<void(PassEffect&, const ScenePass&)>& action);

    std::vector<osg::ref_ptr<Effect>> _effects;
    bool _compensation = true;
    bool _debugBounds = false;
    bool _nestedCameras = false;
    TerrainFrame _terrainFrame = AUTOMATIC;
    std::unique_ptr<Drawing> _drawing;
};

} // namespace osgGeoFX
