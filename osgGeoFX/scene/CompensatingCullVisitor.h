// SPDX-License-Identifier: MIT
// SPDX-FileCopyrightText: 2026 the osgGeoFX authors
#pragma once

#include <osgGeoFX/effect/DeformationChain.h>
#include <osgGeoFX/scene/EyeFrustum.h>
#include <osgGeoFX/scene/FixedFunctionLook.h>
#include <osgGeoFX/scene/MeshBoxes.h>
#include <osgGeoFX/scene/OwnPrograms.h>
#include <osgGeoFX/scene/UndeformedParts.h>

#include <osg/Geometry>
#include <osgUtil/CullVisitor>
#include <osgUtil/RenderLeaf>

#include <algorithm>
#include <map>
#include <utility>
#include <vector>

namespace osgGeoFX
{

class FollowingPrograms;
class RigidReference;

/// Which parts of a scene are drawn again, and with what: asked while such a pass culls.
class PassFilter
{
public:
    /// Whether nothing in a ball is wanted; undeformed, in eye space.
    virtual bool outside(const Ball& ball) const = 0;
    /// The states with which a drawable in this box is drawn, once with each; none where it is not wanted.
    virtual const std::vector<osg::StateSet*>& states(const osg::Drawable& drawable, const EyeBox& box,
                                                      const osg::Matrixd& modelView, bool ownProgram) = 0;
    /// Told of each node with levels of detail that is not outside.
    virtual void meet(const osg::LOD&) {}
    /// What is drawn in the place of the drawable that states() was asked of last; null where nothing of it is wanted.
    virtual osg::Drawable* drawn(osg::Drawable& drawable) = 0;

protected:
    ~PassFilter() = default;
};

/// What an effect draws together with a drawable of the scene, wherever that is in sight.
class DrawableCompanion
{
public:
    /// A traversal begins.
    virtual void start() {}
    /// Null where there is nothing to be drawn with it.
    virtual osg::Drawable* companion(osg::Drawable& drawable, const osg::Matrixd& modelView) = 0;
    /// With which it is drawn, below the effects' uniforms; the drawable's own state does not count.
    virtual osg::StateSet* state() = 0;
    /// How far beyond the drawable's own picture it reaches at most, pixels.
    virtual double reach() const { return 0.0; }

protected:
    ~DrawableCompanion() = default;
};

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
    - what is drawn by a program that does not call the effects' functions is culled undeformed, and left out of passes;
    - below cameras and projections it is OSG's cull visitor, without our state. */
class CompensatingCullVisitor : public osgUtil::CullVisitor
{
public:
    CompensatingCullVisitor();

    /// What a scene wants for one traversal.
    struct Task
    {
        osg::ref_ptr<const DeformationChain> chain;
        osg::StateSet* state = nullptr; ///< uniforms and defines of the effects; null where they draw nothing
        osg::Program* program = nullptr; ///< for what has none
        FollowingPrograms* following =
            nullptr; ///< for what has one of the application's with the effects' functions
        osg::StateSet* untouched = nullptr; ///< takes the deformation away
        int mapUnit = -1;
        bool compensate = true;
        bool debugBounds = false;
        double tileError = 0.0; ///< Ground::tileError
        std::vector<DrawableCompanion*> companions;
        /// Of a pass that draws parts of the scene again, else null: what says which; then the planes of the picture cull
        /// nothing, near and far stay as they are, and cameras below are left out.
        PassFilter* filter = nullptr;
        osgUtil::RenderStage* stage = nullptr; ///< the pass' own; null for a look without drawing
        osg::StateSet* passState = nullptr;    ///< below `state`
    };

    /// Whether `outer` begins a new frame; if so, forgets what was drawn in the last one. To be asked before run().
    bool startsFrame(osgUtil::CullVisitor& outer);
    /// Traverses a group's children in the place of `outer`.
    void run(osgUtil::CullVisitor& outer, osg::Group& scene, const Task& task);

    /// A drawable of a pass' own.
    struct Piece
    {
        osg::Drawable* drawable = nullptr;
        osg::Matrixd modelView;
        osg::StateSet* state = nullptr;
    };
    /// Draws pieces in a pass, in the place of the scene.
    void run(osgUtil::CullVisitor& outer, const std::vector<Piece>& pieces, const Task& task);

    /// A program that does not call the functions, though effects would move what it draws.
    struct Stranger
    {
        osg::observer_ptr<const osg::StateAttribute> program;
        osg::NodePath path; ///< to where it was met
    };
    /// Those of the last run.
    const std::vector<Stranger>& strangers() const { return _strangers; }

    /// What is to be said once, from the last run; empty as a rule.
    const std::string& complaint() const { return _complaint; }

    using osgUtil::CullVisitor::apply;
    void apply(osg::Node& node) override;
    void apply(osg::Geode& node) override;
    void apply(osg::Group& node) override;
    void apply(osg::Transform& node) override;
    void apply(osg::LOD& node) override;
    void apply(osg::Billboard& node) override;
    void apply(osg::ClearNode& node) override;
    void apply(osg::ClipNode& node) override;
    void apply(osg::LightSource& node) override;
    void apply(osg::OccluderNode& node) override;
    void apply(osg::OcclusionQueryNode& node) override;
    void apply(osg::TexGenNode& node) override;
    void apply(osg::Camera& node) override;
    void apply(osg::Projection& node) override;
    void apply(osg::Drawable& drawable) override;

    float getDistanceToEyePoint(const osg::Vec3& position, bool withLodScale) const override;
    float getDistanceToViewPoint(const osg::Vec3& position, bool withLodScale) const override;
    float getDistanceFromEyePoint(const osg::Vec3& position, bool withLodScale) const override;

protected:
    ~CompensatingCullVisitor() override;

private:
    /// What is in force for a subgraph.
    struct Mode
    {
        const DeformationChain* chain = nullptr; ///< empty below what keeps its shape or is left out
        DeformationSwitch deformation;
        bool stranger = false;       ///< the program in force does not call the functions
        bool tile = false;           ///< a drawable's own size tells whether its node is too small
        EyeFrustum::Mask planes = 0; ///< frustum planes that bounds may still cross
        bool ours = true;            ///< false below cameras: OSG's culling, no state of ours
        double lodRadius = 0.0;      ///< of the LOD that is asking for distances
        double lodLimit = HUGE_VAL;  ///< what it hears at most
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
    };

    /// For what is below an object that was moved as a whole: the way back.
    osg::StateSet* placed(const osg::Matrixd& placement);
    bool isPlaced(const osg::StateSet* state) const
    {
        return std::find(_placed.begin(), _placed.end(), state) != _placed.end();
    }
    void applyRigid(RigidReference& node);
    /// Takes a state set's word on whether what is below it is deformed.
    void meet(const osg::StateSet* state);
    void meetAll(const osgUtil::StateGraph& state);
    void begin(osgUtil::CullVisitor& outer, const Task& task);
    void end(osgUtil::CullVisitor& outer);
    /// What the define says, whatever the program does.
    const DeformationChain& definedChain() const;
    template<typename NodeType>
    void applyUntested(NodeType& node);
    void noteStranger();
    /// As the base class does it, and remembers that it was done here.
    void addLeaf(osg::Drawable& drawable, osg::RefMatrix* matrix, double depth);
    /// Gives what nodes have put into the render graph by themselves the state of what is drawn here.
    void adoptLeaves();
    void adoptLeaves(osgUtil::RenderBin& bin);
    void adoptLeaves(osgUtil::RenderBin& bin, osgUtil::StateGraph& graph);
    /// Those with leaves that a bin and those in it know.
    static std::size_t graphsIn(osgUtil::RenderBin& bin);
    bool isForeign(const osgUtil::StateGraph& graph) const;
    osg::StateSet* lookOf(const FixedFunctionLook& look);
    /// The copy of the program in force that has the effects' functions; null where that draws by itself.
    osg::StateSet* followingState();
    /// The planes that cull, with room for the companions.
    void setFrustum(bool culls);
    /// Whether a node is out of sight; narrows the planes for what is below it.
    bool outOfSight(const osg::Node& node);
    /// Of a ball that has been deformed, or not.
    bool outOfSight(const Ball& ball, EyeFrustum::Mask& planes) const;
    /// Whether parts of a node that is out of sight, deformed, are in sight since they are not.
    bool partsInSight(const osg::Node& node, const Ball& undeformed);
    Ball eyeBall(const osg::BoundingSphere& sphere) const;
    /// Whether all smaller boxes of a drawable miss the picture; false where it has none.
    bool meshOutside(const osg::Drawable& drawable, EyeFrustum::Mask planes);
    bool misses(const osg::BoundingBox& box, EyeFrustum::Mask planes);
    /// Whether the middle of one of them shows; of that one which showed last time.
    bool middleInSight(const osg::BoundingBox& box, EyeFrustum::Mask planes) const;
    bool witnessInSight(const osg::Drawable& drawable, EyeFrustum::Mask planes);
    /// Whether a paged tile of the kit's databases, with all that is finer, is out of sight.
    bool tileOutOfSight(const osg::LOD& node);
    /// A transform with nothing but geometry below it.
    void applyTile(osg::Transform& node);
    /// A block of a tile, and what is below it.
    void applyBlock(osg::LOD& block);
    void applyPart(osg::Node& part);
    /// Culls a drawable by its box. False where it is out of sight; `depth` of its middle otherwise.
    bool drawableInSight(const osg::Drawable& drawable, double& depth);
    osg::StateSet* lookFor(const osg::Drawable& drawable);
    template<typename NodeType>
    void passUntouched(NodeType& node);
    void applyInPass(osg::Drawable& drawable);
    void drawCompanions(osg::Drawable& drawable, double depth);
    void showBounds(const EyeBox& box);
    void drawBounds();

    Task _task;
    Mode _mode;
    osg::ref_ptr<const DeformationChain> _nothing;
    EyeFrustum _frustum;
    osg::Vec2d _room; ///< that companions take beside their drawables, in the picture's x and y (−1…1)
    DepthRange _depths;
    CullingMode _outerCullingMode = 0;
    ComputeNearFarMode _outerNearFar = DO_NOT_COMPUTE_NEAR_FAR;
    bool _cullSmall = false;
    double _smallPixels = 0.0;
    osg::Vec4d _pixelSize; ///< for eye space
    double _scale = 1.0;   ///< of the current modelview matrix
    osg::Vec3d _middle;    ///< where that of the node goes which outOfSight() tested last
    Hull _hull;
    MeshBoxes _meshBoxes;
    std::vector<osg::ref_ptr<osg::StateSet>> _placed; ///< one for each such object of a frame
    std::size_t _placedUsed = 0;
    std::string _complaint;
    OwnPrograms _programs;
    UndeformedParts _undeformedParts;
    std::vector<Stranger> _strangers;
    osgUtil::StateGraph* _top = nullptr;                ///< below which all is ours
    std::vector<const osgUtil::StateGraph*> _ownGraphs; ///< that got their first leaf here
    std::size_t _graphsBefore = 0;                      ///< with leaves, when the run began
    osg::ref_ptr<osg::StateSet> _lightPoints; ///< the modes that osgSim's light points set themselves
    osgUtil::StateGraph* _entry = nullptr;    ///< the outer visitor's, where our state begins

    unsigned int _frame = 0;
    unsigned int _order = 0;
    osg::ref_ptr<osg::Program> _program;
    std::map<FixedFunctionLook::Key, osg::ref_ptr<osg::StateSet>> _looks;
    osg::StateSet* _look = nullptr; ///< the last one; neighbours mostly look alike
    FixedFunctionLook::Key _lookKey{};
    std::map<const osg::StateAttribute*, osg::ref_ptr<osg::StateSet>>
        _following;                                   ///< by programs, of this run
    const osgUtil::StateGraph* _stateGraph = nullptr; ///< whose state is gathered
    FixedFunctionState _state;
    const osg::StateSet* _ownState = nullptr; ///< of the drawable that was looked for last
    osg::StateSet* _ownLook = nullptr;
    bool _warnedOfLook = false;
    /// Deformed boxes to show: lines in eye space, by whether they are in the transition zone.
    struct Bounds
    {
        osg::ref_ptr<osg::Geometry> geometry;
        osg::ref_ptr<osg::Vec3Array> lines;
        osg::ref_ptr<osg::Vec4Array> colours;
    };
    Bounds _bounds;
};

} // namespace osgGeoFX
