// SPDX-License-Identifier: MIT
// SPDX-FileCopyrightText: 2026 the osgGeoFX authors
#pragma once

#include <osgGeoFX/Export.h>
#include <osgGeoFX/effect/DeformationChain.h>
#include <osgGeoFX/effect/DepthConvention.h>
#include <osgGeoFX/effect/Effect.h>
#include <osgGeoFX/effect/ViewGeometry.h>
#include <osgGeoFX/scene/CameraRole.h>
#include <osgGeoFX/scene/ShaderHost.h>

#include <osg/Group>
#include <osg/Program>
#include <osg/Shader>
#include <osg/observer_ptr>
#include <osgUtil/CullVisitor>

#include <functional>
#include <memory>
#include <mutex>
#include <optional>
#include <string>
#include <vector>

namespace osgGeoFX
{

class SceneDrawing;
class TileGuard;
class TilePrefetch;

/** The group that a program puts above its terrain to use the kit's effects.

    @code
    osg::ref_ptr<osgGeoFX::EffectScene> scene = new osgGeoFX::EffectScene;
    scene->addEffect(new osgGeoFX::BirdsEyeView);
    scene->addChild(terrain);
    viewer.setSceneData(scene);
    @endcode

    **Drawing.** The group draws everything below it, deformed by its effects in their order.
    - Geometry without a shader keeps its look: materials, lights, up to four 2D textures with their environments,
      fog.
    - Geometry with shaders of its own is deformed if these call geofx_vertex() and geofx_fragment()
      (shaders/stages/functions.*), after addFunctions(), or after adapt(), without any change of these shaders.
      Otherwise it is drawn and culled where it is, and a warning reports each such program once. It may also stand
      below a RigidReference, which needs no shaders.
    - `stateSet->setDefine("GEOFX_DEFORMATION", OFF)` leaves a subgraph undeformed.
    - A change of programs or defines below a node that is out of sight takes effect after some frames. It takes
      effect at once if the node has `setCullingActive(false)`.
    - Cameras and projections below the group (render to texture, head-up displays) are drawn without effects.

    **Cameras.** Each camera that meets the group has a role (CameraRole):
    - The camera of a view, and its slaves with absolute matrices, are VIEWs. Each is deformed for itself.
    - Slaves with relative matrices are LIKE their view's camera, so the channels of a wall of screens show one deformed
      world. So do the two eyes of a stereo pair.
    - Cameras above the group, and cameras of techniques such as osgShadow's and osgSim's, are UNDEFORMED. Shadows are
      therefore those of the undeformed world. A program finds them if it looks them up by the position that it passes to
      geofx_vertex(). osgEarth's cameras for picking are LIKE the view's camera.
    - CameraEffects, attached to a camera, and setRoleCallback() decide otherwise.

    **Culling.** The group does not change the terrain's nodes. Any loader may make them, and other scenes may share
    them. Below the group, a cull visitor of the kit replaces the camera's. It culls deformed bounds and chooses
    levels of detail by the deformed distance, for osg::LOD, osg::PagedLOD and any node that asks the visitor for
    distances. Near and far planes are correct. If no enabled effect does anything for the camera, the group draws
    the same as a plain osg::Group. If no deformation is enabled, it is also culled like one. See osgGeoFX/README.md.

    **Frames.** World coordinates are those of the group's children. They are geocentric below an
    osg::CoordinateSystemNode with an ellipsoid, which may stand above or below the group; otherwise they are
    projected with z up. Transforms above must not scale.

    **Threads.** Any number of cameras, views and contexts may draw the group, in every threading model. Add, remove
    and change effects between frames. Several scenes may share a terrain, each with its own effects. A scene inside
    another one is drawn without the inner scene's effects. Views that show a paged terrain below different roots
    must share a pager (`view.setDatabasePager(other.getDatabasePager())`), because OSG keeps only one request for
    each paged child.

    @ingroup scene */
class OSGGEOFX_EXPORT EffectScene : public osg::Group
{
public:
    EffectScene();
    EffectScene(const EffectScene& other, const osg::CopyOp& copy = osg::CopyOp::SHALLOW_COPY);
    META_Node(osgGeoFX, EffectScene);

    /// The kind of world coordinates.
    enum TerrainFrame
    {
        AUTOMATIC, ///< as an osg::CoordinateSystemNode above or below says; projected without one
        GEOCENTRIC,
        PROJECTED
    };

    /** What an application says of terrain that is not one of the kit's databases, which say all of this themselves.
        What is left open here follows from the database, where it says so. */
    struct OSGGEOFX_EXPORT GroundDescription
    {
        TerrainFrame frame = AUTOMATIC;
        /// The least and the greatest height of the ground, metres above the ellipsoid, or above z = 0 where the frame is
        /// projected; −12 000…100 000. State both or neither. Without them, a bend does not know what would fold over.
        std::optional<double> minHeight, maxHeight;
        /// The least number of edges of triangles along a side of a tile, 1…4,096. 0, the default: unknown. Where it is
        /// known, tiles with two levels of detail become finer where a deformation bends them more than their triangles
        /// can follow. Where there are no finer tiles, MeshRefiner helps.
        int tileCells = 0;

        /// A sentence that tells why the description cannot be right, and the remedy; empty where it can.
        std::string fault() const;
    };

    /// Adds an effect after the others. Null, and an effect that the scene already has, are refused with a warning.
    bool addEffect(Effect* effect);
    /// Adds an effect before the one at an index; after the others if there is none. It refuses what addEffect() refuses.
    bool insertEffect(unsigned int index, Effect* effect);
    /// Removes an effect. False if the scene does not have it.
    bool removeEffect(Effect* effect);
    unsigned int getNumEffects() const { return static_cast<unsigned int>(_effects.size()); }
    Effect* getEffect(unsigned int i) { return _effects[i].get(); }
    const Effect* getEffect(unsigned int i) const { return _effects[i].get(); }

    /// Whether culling takes the deformation into account. If false, only the GPU deforms, and the CPU culls as without
    /// deformation, which is useful for comparison. True by default.
    void setCompensation(bool on) { _compensation = on; }
    bool getCompensation() const { return _compensation; }
    /// Whether the deformed bounds that culling uses are drawn: red where a deformation bends them, yellow elsewhere.
    /// False by default.
    void setDebugBounds(bool on) { _debugBounds = on; }
    bool getDebugBounds() const { return _debugBounds; }
    /// Whether programs that know nothing of effects are adapted as the scene meets them, as adapt() does: those below the
    /// group, and those that nodes above it put into force, such as the shadow techniques of osgShadow. False by default.
    void setAdaptsPrograms(bool on) { _adaptsPrograms = on; }
    bool getAdaptsPrograms() const { return _adaptsPrograms; }
    /// Whether cameras that would be UNDEFORMED by default are VIEWs: cameras above the group other than the view's own,
    /// such as a shadow map's. False by default.
    void setNestedCameras(bool on) { _nestedCameras = on; }
    bool getNestedCameras() const { return _nestedCameras; }
    /** Sets the lowest texture unit that the scene chooses for its effects, 4 to 31; 4 by default. Those below belong to what
        it draws. An application whose own shaders read more units than 0 to 3 names the first that none of them reads;
        otherwise its textures and the effects' get into each other's place. Units that an effect's property names stay:
        such an application also sets PanoramaMap's coverUnit. False, with a warning, for any other number. Call it
        between frames. */
    bool setFirstTextureUnit(int unit);
    int getFirstTextureUnit() const { return _firstTextureUnit; }
    /** Sets the texture units that the scene may choose for its effects, for an engine that gives them out one by one, as
        osgEarth's TerrainResources do; 4 to 31, each once. Unit 7 is not chosen; what terrain databases have there, PanoramaMap's
        coverUnit says. Empty, the default: all from getFirstTextureUnit() on. Units that an effect's property names stay.
        Files do not keep it. False, with a warning, for other numbers. Call it between frames. */
    bool setTextureUnits(const std::vector<int>& units);
    const std::vector<int>& getTextureUnits() const { return _textureUnits; }
    /** Sets the lowest binding point that the scene chooses for uniform blocks of its effects, 0 to 35; 7 by default. An
        application whose own programs have blocks at 7 or above names the first binding point that none of them has.
        Binding points that an effect's property names stay. False, with a warning, for any other number. Call it between
        frames. */
    bool setFirstBlockBinding(int binding);
    int getFirstBlockBinding() const { return _firstBlockBinding; }
    /** What the application's own programs write as depth. Geometry without a shader, sky, strokes, and close-ups with
        their layers and walls then get the same kind of depth, with or without effects. It holds for cameras that are not
        UNDEFORMED; CameraEffects says otherwise for one camera. Depths of the projection by default, which may be
        reversed. False, after a warning, for a convention with a fault. Call it between frames. */
    bool setDepthConvention(const DepthConvention& convention);
    const DepthConvention& getDepthConvention() const { return _depthConvention; }
    /// Gives the texts of the effects to an engine that assembles its shaders itself; null, the default, for none.
    void setShaderHost(ShaderHost* host);
    ShaderHost* getShaderHost() { return _shaderHost.get(); }
    const ShaderHost* getShaderHost() const { return _shaderHost.get(); }
    /// Decides on the role of each camera, after CameraEffects; null, the default, for none.
    void setRoleCallback(const CameraRoleCallback* callback) { _roleCallback = callback; }
    const CameraRoleCallback* getRoleCallback() const { return _roleCallback.get(); }
    /** How terrain engines below the group cull that have culling stacks of their own, such as osgEarth's.

        They make these of the cull visitor's mode and projection, and know nothing of the deformation. */
    enum EngineCulling
    {
        AS_IT_IS, ///< the engines cull what they think is out of sight; right where there are none, or nothing is deformed
        OPEN, ///< the engines cull nothing, neither by the frustum nor by the horizon; the group still does
        PROXY ///< the engines cull by a frustum and a view point that contain all ground which the deformed picture shows
    };
    /** AS_IT_IS by default. OPEN and PROXY take effect where a deformation is enabled, and in passes of parts
        of the scene, such as those of close-ups. They also keep a clamp callback of the
        host's from cutting off what the group draws, and hold osgEarth's horizon clip plane (oe_ClipPlane_plane) neutral.

        PROXY draws less than OPEN where engines have many tiles. Any node of a class that is neither OSG's nor the kit's
        gets its matrices. Finding them takes 1 to 2 ms for each camera. The frustum is tight if the heights of the ground
        are known, from the kit's database or from setGround(); state heights that include what stands on the ground. */
    void setEngineCulling(EngineCulling culling) { _engineCulling = culling; }
    EngineCulling getEngineCulling() const { return _engineCulling; }
    /// Sets the node below which the engine culls its terrain by the horizon of a view point. That node gets the raised view point of
    /// OPEN and PROXY, and all other nodes get the camera's own, which osgEarth's draping fits its texture to. Null, the default: any
    /// node may cull so, and all get the raised one. The scene does not keep the node alive. Files do not keep it. Call it between frames.
    void setEngineTerrain(const osg::Node* node) { _engineTerrain = node; }
    const osg::Node* getEngineTerrain() const { return _engineTerrain.get(); }
    /** Sets the names of render bins that lay things out in the picture, such as osgEarth's labels and icons; none by default.

        A drawable in such a bin stands for the origin of its own frame. The scene moves that point with the ground. It leaves the
        drawable's shape and colors alone, and draws it unless the deformed globe hides the point. The names are those of
        osg::StateSet::setRenderBinDetails(). Files do not keep them. Call it between frames. */
    void setLayoutBins(const std::vector<std::string>& names) { _layoutBins = names; }
    const std::vector<std::string>& getLayoutBins() const { return _layoutBins; }
    /// Asks for the tiles of where the cameras will be; null, the default, for not looking ahead. Files do not keep it, and
    /// copies have none. Call it between frames.
    void setPrefetch(TilePrefetch* prefetch);
    TilePrefetch* getPrefetch() { return _prefetch.get(); }
    const TilePrefetch* getPrefetch() const { return _prefetch.get(); }
    /// AUTOMATIC by default.
    void setTerrainFrame(TerrainFrame frame) { _groundDescription.frame = frame; }
    TerrainFrame getTerrainFrame() const { return _groundDescription.frame; }
    /// States what the ground is like. It includes the terrain frame. A description with a fault is refused with a
    /// warning, and the former one stays. Call it between frames.
    bool setGround(const GroundDescription& description);
    const GroundDescription& getGround() const { return _groundDescription; }

    /** Adds the functions geofx_vertex, geofx_normal and geofx_fragment to a program, as functions that do nothing. An
        EffectScene does not draw with this program, but with a copy that has the functions of its own effects. So
        any number of scenes may draw it, each with its own effects. The program itself never changes after this
        call, and draws the same outside of scenes.

        Add the program's own shaders first. If it has a tessellation evaluation or a geometry shader, these stages get
        geofx_vertex and geofx_normal, too, and geofx_texture, for what the vertex stage knows by its attributes (the
        texture coordinates of unit 0). Call geofx_vertex once for each vertex, in the last stage that places vertices.
        That is the geometry stage, if there is one, before each EmitVertex(). shaders/stages/functions.vert is the
        reference. Call this function before the program is drawn. */
    static void addFunctions(osg::Program& program);

    /** Lets scenes deform a program that knows nothing of effects. Scenes draw a copy of the program whose `main` is
        called by one of the kit's. This one takes the eye position from gl_Position as the program wrote it, deforms
        it, and then gives the fragment's color to the effects that color. So a shader may displace its vertices, and
        needs no change. The program itself does not change at all. For light, fog and its own variables it goes on to
        see the undeformed place.

        What can be adapted: GLSL 1.10 to 4.60 in a compatibility context; one or several shaders for each stage;
        displaced vertices; a depth with an offset, or the logarithmic one, `z = (log2(max(1e-6, 1 + w)) * F - 1) * w`,
        in the vertex stage or as gl_FragDepth from a variable; a gl_FragDepth that gl_ProjectionMatrix gives to a place
        beside the fragment's; clip vertices and distances; a tessellation evaluation
        stage; a geometry stage of GLSL 1.50 or later; a fragment stage alone, whose vertices OpenGL's fixed functions place. The eye position has w = 1, unless gl_Position is that of
        gl_Vertex. The color is gl_FragColor, gl_FragData[0], or the `out vec4` at location 0.

        A scene draws a program that cannot be adapted where it is, and culls it undeformed; a warning names the
        reason and the remedy once. If only its colors cannot be adapted, its vertices are deformed all the same.

        Calling it twice, or for a program that calls geofx_vertex() itself, does no harm. Scenes may share the program.
        A copy of the program is not adapted, and files do not keep this. ProgramAdapter calls it for a subgraph or
        for the tiles of a pager. Threads: may be called from any thread, at any time, even while the program is drawn;
        the next frame that is culled shows it. */
    static void adapt(osg::Program& program);

    /// The deformation of a camera. `modelView`: from the children's frame to eye space. `above`: the nodes above the
    /// group. Never null; empty if nothing is deformed.
    osg::ref_ptr<const DeformationChain> deformation(const osg::Matrixd& modelView,
                                                     const osg::Matrixd& projection,
                                                     const osg::NodePath& above = {}) const;
    /// The same for a camera that draws a column of the picture, from `low` to `high` of its x, −1…1.
    osg::ref_ptr<const DeformationChain> deformationOfColumn(const osg::Matrixd& modelView,
                                                             const osg::Matrixd& projection, double low,
                                                             double high,
                                                             const osg::NodePath& above = {}) const;
    /// How a sky behind the scene turns about the eye for the camera that a visitor culls for, in its eye space: as bends
    /// turn the far ground, where that brings the horizon down; otherwise the identity. Threads: for those that cull,
    /// several at once.
    osg::Matrixd turnOfHorizon(osgUtil::CullVisitor& visitor);
    /// The least number of cameras, side by side, that draw a whole picture of the scene with the effects that are switched
    /// on now; 1 for most. A panorama map of 360° needs two (drawInParts()).
    unsigned int leastParts() const;
    /// Lets effects process a tile on the thread of the pager that reads it, instead of in the first frame that shows
    /// it. This applies to the effects that the scene has now. It may be called again.
    void listenTo(TileGuard& guard);
    /// What is known of the ground, stated or found. `above`: the nodes above the group.
    Ground ground(const osg::NodePath& above = {}) const;

    /// The node whose children are drawn with the effects: the group itself, or the one whose EffectCullCallback drew them
    /// last. Threads: may be called from any thread.
    osg::ref_ptr<osg::Group> getTerrain();
    osg::ref_ptr<const osg::Group> getTerrain() const;

    void traverse(osg::NodeVisitor& visitor) override;
    osg::BoundingSphere computeBound() const override;
    void resizeGLObjectBuffers(unsigned int size) override;
    void releaseGLObjects(osg::State* state = nullptr) const override;

protected:
    ~EffectScene() override;

private:
    friend class EffectCullCallback;
    /// Culls what is below a terrain. `traverse` goes on below it. False if the camera draws it without effects; nothing has
    /// been culled then.
    bool cull(osgUtil::CullVisitor& outer, osg::Group& terrain,
              const std::function<void(osg::NodeVisitor&)>& traverse);
    void setTerrain(osg::Group& terrain);

    std::vector<osg::ref_ptr<Effect>> _effects;
    bool _compensation = true;
    bool _debugBounds = false;
    bool _nestedCameras = false;
    bool _adaptsPrograms = false;
    int _firstTextureUnit = 4;
    std::vector<int> _textureUnits; ///< ascending
    int _firstBlockBinding = 7;
    DepthConvention _depthConvention;
    osg::ref_ptr<ShaderHost> _shaderHost;
    osg::ref_ptr<const CameraRoleCallback> _roleCallback;
    GroundDescription _groundDescription;
    EngineCulling _engineCulling = AS_IT_IS;
    osg::observer_ptr<const osg::Node> _engineTerrain;
    std::vector<std::string> _layoutBins;
    osg::ref_ptr<TilePrefetch> _prefetch;
    std::unique_ptr<SceneDrawing> _drawing;
    mutable std::mutex _terrainMutex;
    osg::observer_ptr<osg::Group> _terrain; ///< of an EffectCullCallback
};

} // namespace osgGeoFX
