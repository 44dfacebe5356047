// SPDX-License-Identifier: MIT
// SPDX-FileCopyrightText: 2026 the osgGeoFX authors
#pragma once

#include <osgGeoFX/effect/DeformationChain.h>
#include <osgGeoFX/effect/DepthConvention.h>
#include <osgGeoFX/effect/RigidParts.h>
#include <osgGeoFX/effect/ScenePass.h>
#include <osgGeoFX/scene/detail/DrawableSight.h>
#include <osgGeoFX/scene/detail/GlobeHorizon.h>
#include <osgGeoFX/scene/detail/LookCache.h>
#include <osgGeoFX/scene/detail/OwnPrograms.h>
#include <osgGeoFX/scene/detail/PatchTwins.h>
#include <osgGeoFX/scene/detail/UndeformedParts.h>
#include <osgGeoFX/scene/detail/Visibility.h>

#include <osg/CoordinateSystemNode>
#include <osgUtil/CullVisitor>
#include <osgUtil/RenderLeaf>

#include <algorithm>
#include <array>
#include <cmath>
#include <functional>
#include <optional>
#include <string>
#include <utility>
#include <vector>

namespace osgGeoFX
{

class DrawableCompanion;
class ShaderHost;
class FollowingPrograms;
class GroundFinder;
class RigidReference;

/** Culls what the GPU is going to deform.

    One stands in for a cull visitor of OSG below an EffectScene: it shares the other one's state graph, render stage
    and bins, and hands back what it found of near and far. One belongs to one cull visitor, and so to one thread at a
    time and to one of the frames that are on their way.

    What it does instead of OSG's:
    - frustum and small-feature culling by a ball around what the deformation makes of a node's bounding sphere, then
      by the hull of what it makes of a drawable's box;
    - levels of detail by DeformationChain::lodDistance;
    - near and far planes from the deformed boxes;
    - what nodes put into the render graph by themselves (osgSim::LightPointNode) gets the effects' state afterwards;
    - what is drawn by a program that does not call the effects' functions is culled undeformed;
    - below cameras and projections it is OSG's cull visitor, without our state. */
class CompensatingCullVisitor : public osgUtil::CullVisitor
{
public:
    CompensatingCullVisitor();

    /// Goes on below a scene's terrain.
    using Traverse = std::function<void(osg::NodeVisitor&)>;

    /// What a scene wants for one traversal.
    struct Task
    {
        Traverse traverse;
        osg::ref_ptr<const DeformationChain> chain;
        /// Where it is another one, that which has placed the things that keep their shape.
        osg::ref_ptr<const DeformationChain> placing;
        osg::StateSet* state = nullptr; ///< uniforms and defines of the effects; null where they draw nothing
        osg::Program* program = nullptr; ///< for what has none
        osg::Program* tessellating =
            nullptr; ///< for patches of what has none; null where no triangle is divided
        FollowingPrograms* following =
            nullptr; ///< for what has one of the application's with the effects' functions
        osg::StateSet* untouched = nullptr; ///< takes the deformation away
        /// The camera's image, where it draws another camera's view; null where it draws its own.
        const ViewGeometry::Image* image = nullptr;
        const ViewGeometry* view = nullptr; ///< that is drawn
        const ViewGeometry* ownView =
            nullptr;                   ///< the view whose own image is drawn in the place of the camera's
        CameraDepth depth;             ///< of the camera
        GLenum colorFormat = GL_RGBA8; ///< targetFormat()
        int mapUnit = -1;
        bool compensate = true;
        bool normals = false; ///< whether effects look at normals
        bool debugBounds = false;
        const ShaderHost* shaderHost =
            nullptr; ///< EffectScene::getShaderHost(); null in passes whose functions it has not
        osg::StateSet* hostAddition = nullptr; ///< ShaderHost::addition(); null for none
        bool adapts = false;                   ///< EffectScene::getAdaptsPrograms()
        bool engines = false;                  ///< EffectScene::OPEN or PROXY
        bool open = false;  ///< nothing else is to cull, since what engines cull by is not what is shown
        bool proxy = false; ///< where `open`, engines cull by a ProxyFrustum: EffectScene::PROXY
        const std::vector<std::string>* layoutBins = nullptr; ///< EffectScene::getLayoutBins(); null for none
        const osg::Node* engineTerrain = nullptr;             ///< EffectScene::getEngineTerrain()
        osg::BoundingSphere bound;                            ///< of the terrain, for this frustum
        GroundFinder* ground = nullptr;                       ///< hears of coordinate systems that are met
        const osg::Group* terrain = nullptr;                  ///< below which they are looked for
        double tileError = 0.0;                               ///< Ground::tileError
        std::vector<DrawableCompanion*> companions;
        bool asksForTiles = true;    ///< false: pagers hear nothing, and what is met does not count as seen
        bool findsNearAndFar = true; ///< false: the camera's stay as they are
        osgUtil::RenderStage* stage = nullptr; ///< where it draws; null for where `outer` does
        osg::StateSet* inPass =
            nullptr; ///< below `state`: tells shaders that this is a pass, not the scene itself
        osg::StateSet* passState = nullptr; ///< below these
    };

    /// Whether `outer` begins a new frame. To be asked once before each frame's or traversal's run().
    bool startsFrame(osgUtil::CullVisitor& outer);
    /// Forgets what was drawn in the last frame; where startsFrame() says so, or that of another visitor of the same camera.
    void startFrame(osgUtil::CullVisitor& outer);
    /// Traverses a scene's terrain in the place of `outer`.
    void run(osgUtil::CullVisitor& outer, const Task& task);
    /// Draws pieces in the place of a scene.
    void run(osgUtil::CullVisitor& outer, const std::vector<ScenePass::Piece>& pieces, const Task& task);

    /// A program that does not call the functions, though effects would move what it draws.
    struct Stranger
    {
        osg::observer_ptr<const osg::StateAttribute> program;
        osg::NodePath path; ///< to where it was met
    };
    /// Those of the last run.
    const std::vector<Stranger>& strangers() const { return _strangers; }

    /// What is to be said once, from the last run; empty as a rule.
    const std::string& complaint() const { return _drawables.complaint(); }

    /// Whether the last run drew something with a texture on the map's unit, or that may have one; and something without.
    bool metMap() const { return _looks.metMap() || (_task.tessellating && _dividedLooks.metMap()); }
    bool metNoMap() const { return _looks.metNoMap() || (_task.tessellating && _dividedLooks.metNoMap()); }

    /// What was made for tessellation.
    const PatchTwins& twins() const { return _twins; }
    PatchTwins& twins() { return _twins; }

    /// Whether a node at the current matrix is out of sight; nothing of it has been culled then.
    bool leavesOut(const osg::Node& node);
    /// Whether a box is, whose frame `placement` takes to that of the current matrix.
    bool leavesOut(const osg::BoundingBox& box, const osg::Matrixd& placement);
    /// The size in pixels of a node's deformed bounding sphere, as tilePixelSize() has it.
    double pixelSize(const osg::Node& node);
    /// As osgGeoFX::isMovedVertically() has it.
    bool movesVertically(const osg::Node& node) const;
    /// As osgGeoFX::raisedViewPoint() has it.
    std::optional<osg::Vec3d> highPoint() const;

    using osgUtil::CullVisitor::apply;
    void apply(osg::Node& node) override;
    void apply(osg::Geode& node) override;
    void apply(osg::Group& node) override;
    void apply(osg::Transform& node) override;
    void apply(osg::LOD& node) override;
    void apply(osg::Billboard& node) override;
    void apply(osg::ClearNode& node) override;
    void apply(osg::ClipNode& node) override;
    void apply(osg::CoordinateSystemNode& node) override;
    void apply(osg::LightSource& node) override;
    void apply(osg::OccluderNode& node) override;
    void apply(osg::OcclusionQueryNode& node) override;
    void apply(osg::TexGenNode& node) override;
    void apply(osg::Camera& node) override;
    void apply(osg::Projection& node) override;
    void apply(osg::Drawable& drawable) override;
    /// A rigid object, which tells its own visitor what it is.
    void apply(RigidReference& node);

    float getDistanceToEyePoint(const osg::Vec3& position, bool withLodScale) const override;
    float getDistanceToViewPoint(const osg::Vec3& position, bool withLodScale) const override;
    float getDistanceFromEyePoint(const osg::Vec3& position, bool withLodScale) const override;

protected:
    ~CompensatingCullVisitor() override;

    /// What is in force for a subgraph.
    struct Mode
    {
        const DeformationChain* chain = nullptr; ///< empty below what keeps its shape or is left out
        DeformationSwitch deformation;
        RigidParts::Switch rigid;
        bool stranger = false;       ///< the program in force does not call the functions
        bool tile = false;           ///< a drawable's own size tells whether its node is too small
        Visibility::Mask planes = 0; ///< frustum planes that bounds may still cross
        double nearer =
            1.0; ///< the share of its distance at which a thing is drawn, so that nothing at its place hides it
        /// Of what was placed as a whole: from the view's eye space back to where it stands.
        std::optional<osg::Matrixd> unplaced;
        bool ours = true;                         ///< false below cameras: OSG's culling, no state of ours
        const osgUtil::StateGraph* met = nullptr; ///< down to which the state has been looked at
        bool ownStatePushed = false;              ///< the drawable's own state set is in force already
        double lodRadius = 0.0;                   ///< of the LOD that is asking for distances
        double lodLimit = HUGE_VAL;               ///< what it hears at most
    };

    /// Whether the borders of the camera's picture cull; false where something else says what is wanted.
    virtual bool cullsByPicture() const { return true; }
    /// Whether a box of ground, undeformed, is out of sight, so that engines need not draw what is in it.
    virtual bool boxOutOfSight(const EyeBox& box);
    /// Whether a node is out of sight; narrows the planes for what is below it.
    virtual bool outOfSight(const osg::Node& node);
    /// A node with levels of detail that is not out of sight.
    virtual void meetLevels(const osg::LOD&) {}
    /// Whether a render bin of the host lays a drawable out in the picture (EffectScene::setLayoutBins()).
    bool isLaidOut(const osg::Drawable& drawable) const;
    /// A drawable that is laid out: only its place moves.
    void placeInLayout(osg::Drawable& drawable);
    /// A drawable whose callbacks leave it to be drawn, with compensation.
    virtual void place(osg::Drawable& drawable);
    /// What a node has put into the render graph by itself. `look`, `above`: as for drawables; null for none.
    virtual void adopt(osgUtil::RenderBin& bin, osgUtil::StateGraph& graph, osgUtil::RenderLeaf& leaf,
                       const osg::BoundingBox& bounds, osg::StateSet* look, osg::StateSet* above);
    /// By which billboards turn to the eye.
    virtual const DeformationChain& turningChain() const { return *_mode.chain; }

    /// From the current node to the eye space of the view, which is the camera's own unless it draws another one's.
    osg::Matrixd viewMatrix() const { return inView(*_modelviewStack.back()); }
    osg::Matrixd inView(const osg::Matrixd& modelView) const
    {
        return _task.image ? modelView * _task.image->toView : modelView;
    }
    osg::Vec3d inView(const osg::Vec3d& position) const
    {
        const osg::Vec3d eye = position * *_modelviewStack.back();
        return _task.image ? eye * _task.image->toView : eye;
    }
    /// The other way: a matrix to the view's eye space, changed to lead to the camera's.
    osg::Matrixd inEye(const osg::Matrixd& viewMatrix) const
    {
        return _task.image ? viewMatrix * _task.image->toEye : viewMatrix;
    }
    Ball eyeBall(const osg::BoundingSphere& sphere) const;
    /// Puts a drawable into the graph below a look, its own state and a copy of its program, and remembers that it was done here.
    void addLeaf(osg::Drawable& drawable, osg::StateSet* own, osg::StateSet* look, double depth);
    /// As the base class does it, and remembers that it was done here.
    void addLeaf(osg::Drawable& drawable, osg::RefMatrix* matrix, double depth);
    /// What is drawn in the place of a drawable whose triangles are to be divided, and its look; null where they are not.
    osg::Geometry* divided(osg::Drawable& drawable, osg::StateSet*& look);
    /// The state set that is still to be pushed for a drawable.
    osg::StateSet* ownState(osg::Drawable& drawable) const
    {
        return _mode.ownStatePushed ? nullptr : drawable.getStateSet();
    }
    /// Draws what effects draw together with a drawable. `modelView`: to the camera's eye space.
    void drawCompanions(osg::Drawable& drawable, osg::RefMatrix* modelView, double depth);
    static void put(osgUtil::RenderBin& bin, osgUtil::StateGraph& from, osgUtil::StateGraph& to,
                    osgUtil::RenderLeaf* leaf);

    Task _task;
    Mode _mode;
    osg::ref_ptr<const DeformationChain> _nothing;
    LookCache _looks, _dividedLooks;

private:
    /// For as long as a node is visited: the matrices that it may cull by. Those of nodes that come with OSG are the picture's. Others
    /// may be terrain engines, and get the proxy frustum.
    class Lens
    {
    public:
        Lens(CompensatingCullVisitor& visitor, const osg::Node& node);
        ~Lens();
        Lens(const Lens&) = delete;
        Lens& operator=(const Lens&) = delete;

    private:
        CompensatingCullVisitor& _visitor;
        bool _proxies = false; ///< whether the projection changes from the picture's to the proxy's, or back
        bool _raises = false;  ///< whether the view point is raised
        CullingMode _formerMode = 0;
    };

    /// For as long as a node is visited: its mode, and whether it is out of sight.
    class Scope
    {
    public:
        Scope(CompensatingCullVisitor& visitor, const osg::Node& node);
        ~Scope() { _visitor._mode = _former; }
        Scope(const Scope&) = delete;
        Scope& operator=(const Scope&) = delete;

        bool skip() const { return _skip; }

    private:
        CompensatingCullVisitor& _visitor;
        const Mode _former;
        bool _skip = false;
        std::optional<Lens> _lens;
    };

    /// For what is below an object that was moved as a whole: the way back.
    osg::StateSet* placed(const osg::Matrixd& placement);
    bool isPlaced(const osg::StateSet* state) const
    {
        return std::find(_placed.begin(), _placed.end(), state) != _placed.end();
    }
    /// For what is drawn at another distance than its own.
    osg::StateSet* nearerBy(double factor);
    /// Takes a state set's word on whether what is below it is deformed.
    void meet(const osg::StateSet* state);
    void meetAll(const osgUtil::StateGraph& state);
    /// Meets the state sets that a node has pushed by itself, such as the passes of osgFX.
    void meetPushed();
    void meetBelow(const osgUtil::StateGraph& state);
    /// Pushes the state sets of the frusta that hold a drawable (osg::CullingSet::addStateFrustum), behind the drawable's own. Returns
    /// how many state sets it has pushed.
    int pushStatesOfFrusta(osg::Drawable& drawable);
    /// Pushes a projection that has the frusta of the one below it.
    void pushProjectionWithFrusta(osg::RefMatrix* projection);
    /// Draws a drawable that is in sight.
    void draw(osg::Drawable& drawable, double depth);
    /// Draws a drawable as OSG does, without compensation.
    void placeAsOsg(osg::Drawable& drawable);
    void begin(osgUtil::CullVisitor& outer, const Task& task);
    void end(osgUtil::CullVisitor& outer);
    /// What the define says, whatever the program does.
    const DeformationChain& definedChain() const;
    template<typename NodeType>
    void applyUntested(NodeType& node);
    void noteStranger();
    /// Gives what nodes have put into the render graph by themselves the state of what is drawn here.
    void adoptLeaves();
    void adoptLeaves(osgUtil::RenderBin& bin);
    void adoptLeaves(osgUtil::RenderBin& bin, osgUtil::StateGraph& graph);
    /// Those with leaves that a bin and those in it know.
    static std::size_t graphsIn(osgUtil::RenderBin& bin);
    bool isForeign(const osgUtil::StateGraph& graph) const;
    void setVisibility(const osgUtil::CullVisitor& outer);
    void setHorizon();
    /// Whether deformed ground hides a node with tiles of a whole Earth.
    bool belowHorizon(const osg::LOD& node);
    void beginPatches(osg::Program& program, const osg::Viewport& viewport);
    void pushMatrices(osgUtil::CullVisitor& outer);
    /// Lets an engine read the near and far planes of its undeformed terrain, as OSG finds them in the bounds of a globe. Those of
    /// the picture are found otherwise.
    void showDepthsOfGround();
    /// Where everything is above the horizon, for those who look for the view point.
    osg::Vec3 raisedViewPoint() const;
    /// The tangents of the angles to the picture's left, right, bottom and top, seen from the eye; infinite where there are none, or
    /// where what is drawn may lie beside the picture.
    std::array<double, 4> pictureSides() const;
    /// Sets the proxy frustum, and returns the view point that goes with it.
    osg::Vec3 setProxy(const osg::Matrixd& modelView);
    /// From where levels of detail are chosen, in the view's eye space.
    osg::Vec3d viewPoint() const;
    /// Whether parts of a node that is out of sight, deformed, are in sight since they are not.
    bool partsInSight(const osg::Node& node, const Ball& undeformed);
    /// A transform with nothing but geometry below it.
    void applyTile(osg::Transform& node);
    /// A block of a tile, and what is below it.
    void applyBlock(osg::LOD& block);
    void applyPart(osg::Node& part);
    /// Goes on below a node by its ranges. Where no tile is asked for, none counts as seen.
    void applyLevels(osg::LOD& node);
    template<typename NodeType>
    void passUntouched(NodeType& node);
    /// Remembers a leaf for what effects draw together with it.
    void noteAdopted(osgUtil::StateGraph& graph, const osgUtil::RenderLeaf& leaf);
    /// The state above what a node has put into the render graph by itself, without that of a host.
    osgUtil::StateGraph* stateAbove(osgUtil::StateGraph& graph) const;
    /// Whether a class comes with OSG or the kit, so that no host and no engine has a use for it of its own.
    static bool comesWithOsg(const osg::Object* object);
    /// Finds out whether the outer visitor does more than OSG's.
    void setHost(osgUtil::CullVisitor& outer);
    /// Lets the host apply a node with this visitor's matrices, state graph and bins. `traverses`: also to what is below
    /// it. `culls`: with the host's own culling, and its near and far.
    template<typename NodeType>
    void lend(NodeType& node, bool traverses, bool culls);
    /// Lets the host draw a node of its own; what it adds is culled and gets the effects' state afterwards. False if
    /// there is no host, or it cannot know the node.
    template<typename NodeType>
    bool drawByHost(NodeType& node);
    /// Lets the host do for a node of its own what it does beside the traversal, such as collecting lights.
    template<typename NodeType>
    void tellHost(NodeType& node);
    /// Culls what is not deformed.
    template<typename NodeType>
    void passToHost(NodeType& node);

    osg::Polytope _planes; ///< those of the camera's frustum that cull
    Visibility _sight;
    GlobeHorizon _horizon;
    DrawableSight _drawables = DrawableSight(_sight);
    osg::ref_ptr<osg::RefMatrix> _projection,
        _proxy;                             ///< that of the picture, and the one that engines cull by
    bool _proxied = false;                  ///< whether the second one is in force
    std::pair<double, double> _proxyDepths; ///< near and far of the ground that is shown
    double _farthestGround = HUGE_VAL;      ///< how far ahead it lies at most before it is deformed
    osg::Vec3 _highPoint;                   ///< from which all that is shown is above the horizon
    CullingMode _outerCullingMode = 0;
    ComputeNearFarMode _outerNearFar = DO_NOT_COMPUTE_NEAR_FAR;
    bool _mayBeSmall = false; ///< what is looked at is never left out for being small
    double _scale = 1.0;      ///< of the current modelview matrix
    osg::Vec3d _middle;       ///< where that of the node goes which outOfSight() tested last
    std::vector<osg::ref_ptr<osg::StateSet>> _placed; ///< one for each such object of a frame
    std::size_t _placedUsed = 0;
    std::vector<osg::ref_ptr<osg::StateSet>> _nearer; ///< one for each such transform of a frame
    std::size_t _nearerUsed = 0;
    OwnPrograms _programs;
    UndeformedParts _undeformedParts;
    std::vector<Stranger> _strangers;
    osg::Vec3d _outerViewPoint;            ///< the outer visitor's reference view point, in eye space
    osgUtil::CullVisitor* _host = nullptr; ///< the outer visitor, if it is of a class of its own
    osg::ref_ptr<osg::StateSet> _ofHost = new osg::StateSet; ///< above what the host adds to the render graph
    osgUtil::StateGraph* _top = nullptr;                     ///< below which all is ours
    std::vector<const osgUtil::StateGraph*> _ownGraphs;      ///< that got their first leaf here
    std::size_t _graphsBefore = 0;                           ///< with leaves, when the run began
    struct Adopted
    {
        osgUtil::StateGraph* above; ///< of the nodes above it
        osg::Drawable* drawable;
        osg::RefMatrix* modelView;
        double depth;
        unsigned int order; ///< of the traversal
    };
    std::vector<Adopted> _adopted; ///< what nodes have put into the render graph, once for each place
    std::set<std::pair<const osg::Drawable*, const osg::RefMatrix*>> _adoptedPlaces;
    osg::ref_ptr<osg::StateSet> _lightPoints; ///< the modes that osgSim's light points set themselves
    osgUtil::StateGraph* _entry = nullptr;    ///< the outer visitor's, where our state begins
    PatchTwins _twins;
    osg::ref_ptr<osg::StateSet> _ofPatches; ///< above their looks
    osg::ref_ptr<osg::StateSet> _ofShades;  ///< above GroundShades where depths are reversed
    unsigned int _frame = 0;
    unsigned int _order = 0;
};

} // namespace osgGeoFX
