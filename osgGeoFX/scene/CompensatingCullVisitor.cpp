// SPDX-License-Identifier: MIT
// SPDX-FileCopyrightText: 2026 the osgGeoFX authors
#include <osgGeoFX/scene/CompensatingCullVisitor.h>

#include <osgGeoFX/paging/TerrainInfo.h>
#include <osgGeoFX/scene/FollowingPrograms.h>
#include <osgGeoFX/scene/RigidReference.h>

#include <osg/LOD>
#include <osg/OcclusionQueryNode>
#include <osg/Projection>

#include <algorithm>
#include <cfloat>
#include <cmath>
#include <mutex>
#include <typeinfo>

namespace osgGeoFX
{

namespace
{

/// Members of OSG's cull visitor that have no accessors; a pointer to member may be formed in a derived class.
struct Access : public osgUtil::CullVisitor
{
    static unsigned int& order(osgUtil::CullVisitor& visitor)
    {
        return visitor.*(&Access::_traversalOrderNumber);
    }
    static unsigned int& overrides(osgUtil::CullVisitor& visitor)
    {
        return visitor.*(&Access::_numberOfEncloseOverrideRenderBinDetails);
    }
    static std::vector<osgUtil::RenderBin*>& bins(osgUtil::CullVisitor& visitor)
    {
        return visitor.*(&Access::_renderBinStack);
    }
};

double planeDistance(const osg::Vec4d& plane, const osg::Vec3d& point)
{
    return plane.x() * point.x() + plane.y() * point.y() + plane.z() * point.z() + plane.w();
}

/// Whether a transform's children ask for nothing but its matrix: geometry, and no callbacks.
bool holdsGeometryOnly(const osg::Transform& node)
{
    if (node.getCullCallback() || node.getReferenceFrame() != osg::Transform::RELATIVE_RF) return false;
    for (unsigned int i = 0; i < node.getNumChildren(); ++i)
    {
        const osg::Node* child = node.getChild(i);
        if (!child->asGeometry() || child->getCullCallback()) return false;
    }
    return true;
}

/// A block of a tile with nothing that OSG's own traversal would have to look at: with many of them in a view, what
/// a visitor does for any node is most of the time.
bool isPlain(const osg::LOD& block)
{
    return TileInfo::meshesOf(block) && block.isCullingActive() && !block.getStateSet() &&
           !block.getCullCallback() && block.getRangeMode() == osg::LOD::DISTANCE_FROM_EYE_POINT;
}

/// A group that does nothing but hold its children.
bool isPlain(const osg::Node& node)
{
    return typeid(node) == typeid(osg::Group) && node.isCullingActive() && !node.getStateSet() &&
           !node.getCullCallback();
}

/// Tiles that came make the bounds above them unknown, and OSG computes bounds when they are asked for. Below a group
/// with a bound of its own, as paged ones have, that may be by cull threads, two at once; so one after the other.
void computeBounds(const osg::Group& group)
{
    static std::mutex mutex;
    const std::lock_guard<std::mutex> lock(mutex);
    for (unsigned int i = 0; i < group.getNumChildren(); ++i)
        group.getChild(i)->getBound();
}

} // namespace

CompensatingCullVisitor::Scope::Scope(CompensatingCullVisitor& visitor, const osg::Node& node)
    : _visitor(visitor), _former(visitor._mode)
{
    if (!visitor._mode.ours) return;
    visitor.meet(node.getStateSet());
    if (visitor._task.compensate) _skip = visitor.outOfSight(node);
}

CompensatingCullVisitor::CompensatingCullVisitor() : _nothing(new DeformationChain) {}

CompensatingCullVisitor::~CompensatingCullVisitor() = default;

bool CompensatingCullVisitor::startsFrame(osgUtil::CullVisitor& outer)
{
    // The outer visitor's leaves of the last frame have been drawn when it begins a new one; so have ours.
    const unsigned int frame = outer.getFrameStamp() ? outer.getFrameStamp()->getFrameNumber() : 0;
    const bool starts = frame != _frame || Access::order(outer) < _order;
    _frame = frame;
    // Also where nothing is drawn until it is asked again.
    _order = Access::order(outer);
    if (starts) reset();
    if (starts) _placedUsed = 0;
    if (starts) _programs.startFrame();
    if (starts) _meshBoxes.purge();
    return starts;
}

void CompensatingCullVisitor::begin(osgUtil::CullVisitor& outer, const Task& task)
{
    _task = task;
    if (_program != task.program)
    {
        _program = task.program;
        _looks.clear();
        _look = nullptr;
    }
    _following.clear();

    setFrameStamp(const_cast<osg::FrameStamp*>(outer.getFrameStamp()));
    setTraversalNumber(outer.getTraversalNumber());
    setTraversalMode(outer.getTraversalMode());
    setTraversalMask(outer.getTraversalMask());
    setNodeMaskOverride(outer.getNodeMaskOverride());
    setDatabaseRequestHandler(outer.getDatabaseRequestHandler());
    setImageRequestHandler(outer.getImageRequestHandler());
    getNodePath() = outer.getNodePath();
    setUserDataContainer(outer.getUserDataContainer());
    setIdentifier(outer.getIdentifier());
    setRenderInfo(outer.getRenderInfo());
    setCullSettings(outer);

    _rootStateGraph = outer.getRootStateGraph();
    _currentStateGraph = outer.getCurrentStateGraph();
    _rootRenderStage = outer.getRenderStage();
    _currentRenderBin = outer.getCurrentRenderBin();
    _renderBinStack = Access::bins(outer);
    if (task.stage)
    {
        _rootRenderStage = task.stage;
        _currentRenderBin = task.stage;
        _renderBinStack.clear();
    }
    _traversalOrderNumber = Access::order(outer);
    _numberOfEncloseOverrideRenderBinDetails = Access::overrides(outer);
    _entry = _currentStateGraph;
    _stateGraph = nullptr;

    _outerCullingMode = outer.getCullingMode();
    // Near and far are the camera's own picture's.
    _outerNearFar = task.stage || task.filter ? DO_NOT_COMPUTE_NEAR_FAR : outer.getComputeNearFarMode();
    if (task.compensate)
    {
        setComputeNearFarMode(DO_NOT_COMPUTE_NEAR_FAR);
    }
    pushViewport(outer.getViewport());
    pushProjectionMatrix(outer.getProjectionMatrix());
    const bool frustumCulls = (_outerCullingMode & VIEW_FRUSTUM_CULLING) && !task.filter;
    setFrustum(frustumCulls);
    // OSG's own tests, which the base class makes, pass everything.
    if (task.compensate) getProjectionCullingStack().back().setCullingMask(NO_CULLING);
    pushReferenceViewPoint(outer.getReferenceViewPoint());
    // OSG knows a matrix by its address, and each stage loads another one behind its back: stages must not share any.
    osg::RefMatrix* modelView =
        task.stage ? createOrReuseMatrix(*outer.getModelViewMatrix()) : outer.getModelViewMatrix();
    pushModelViewMatrix(modelView, osg::Transform::RELATIVE_RF);
    if (task.compensate) getCurrentCullingSet().setCullingMask(NO_CULLING);

    const double height = getViewport() ? getViewport()->height() : 0.0;
    _cullSmall = (_outerCullingMode & SMALL_FEATURE_CULLING) && height > 0.0 && !task.filter;
    _smallPixels = static_cast<double>(getSmallFeatureCullingPixelSize());
    if (height > 0.0)
    {
        _pixelSize =
            osg::CullingSet::computePixelSizeVector(*getViewport(), *getProjectionMatrix(), osg::Matrix());
    }
    _mode = Mode();
    _mode.chain = task.chain;
    meetAll(*_entry);
    meet(task.state);
    _strangers.clear();
    _ownGraphs.clear();
    _graphsBefore = graphsIn(*_currentRenderBin->getStage());
    _top = _entry;
    _mode.planes = _frustum.all();
    _scale = largestScale(*getModelViewMatrix());
    _depths.clear();
    _complaint.clear();
    if (task.debugBounds)
    {
        _bounds.lines = new osg::Vec3Array;
        _bounds.colours = new osg::Vec4Array;
    }
}

void CompensatingCullVisitor::setFrustum(bool culls)
{
    double reach = 0.0;
    for (const DrawableCompanion* each : _task.companions)
        reach = std::max(reach, each->reach());
    const osg::Viewport* viewport = getViewport();
    const bool sides = (_outerCullingMode & VIEW_FRUSTUM_SIDES_CULLING) != 0;
    if (!(reach > 0.0) || !viewport || viewport->width() < 1.0 || viewport->height() < 1.0)
    {
        _room.set(0.0, 0.0);
        _frustum.set(culls ? &getProjectionCullingStack().back().getFrustum() : nullptr,
                     *getProjectionMatrix(), sides);
        return;
    }
    // A wider picture, so that what stands beside the camera's is drawn while it still reaches into it.
    _room.set(2.0 * reach / viewport->width(), 2.0 * reach / viewport->height());
    const osg::Matrixd wider =
        *getProjectionMatrix() * osg::Matrixd::scale(1.0 / (1.0 + _room.x()), 1.0 / (1.0 + _room.y()), 1.0);
    osg::Polytope planes;
    planes.setToUnitFrustum((_outerCullingMode & NEAR_PLANE_CULLING) != 0,
                            (_outerCullingMode & FAR_PLANE_CULLING) != 0);
    planes.transformProvidingInverse(wider);
    _frustum.set(culls ? &planes : nullptr, wider, sides);
}

void CompensatingCullVisitor::end(osgUtil::CullVisitor& outer)
{
    adoptLeaves();
    _order = _traversalOrderNumber;
    Access::order(outer) = _traversalOrderNumber;
    if (!_task.compensate)
    {
        // Found by the base class, as OSG finds it.
        computeNearPlane();
        if (_computed_zfar >= _computed_znear) _depths.include(_computed_znear, _computed_zfar);
        _computed_znear = static_cast<value_type>(FLT_MAX);
        _computed_zfar = -static_cast<value_type>(FLT_MAX);
    }
    _depths.settle();
    if (_outerNearFar != DO_NOT_COMPUTE_NEAR_FAR && _depths.farthest() >= _depths.nearest())
    {
        outer.setCalculatedNearPlane(std::min(outer.getCalculatedNearPlane(), _depths.nearest()));
        outer.setCalculatedFarPlane(std::max(outer.getCalculatedFarPlane(), _depths.farthest()));
    }
    popModelViewMatrix();
    popReferenceViewPoint();
    setComputeNearFarMode(DO_NOT_COMPUTE_NEAR_FAR);
    popProjectionMatrix();
    popViewport();
}

void CompensatingCullVisitor::run(osgUtil::CullVisitor& outer, osg::Group& scene, const Task& task)
{
    begin(outer, task);
    for (DrawableCompanion* each : task.companions)
        each->start();
    if (task.state) pushStateSet(task.state);
    if (task.passState) pushStateSet(task.passState);
    _top = _currentStateGraph;
    for (unsigned int i = 0; i < scene.getNumChildren(); ++i)
        scene.getChild(i)->accept(*this);
    if (task.passState) popStateSet();
    if (task.state) popStateSet();
    if (task.debugBounds) drawBounds();
    end(outer);
}

void CompensatingCullVisitor::run(osgUtil::CullVisitor& outer, const std::vector<Piece>& pieces,
                                  const Task& task)
{
    begin(outer, task);
    pushStateSet(task.state);
    if (task.passState) pushStateSet(task.passState);
    for (const Piece& piece : pieces)
    {
        pushStateSet(piece.state);
        addLeaf(*piece.drawable, createOrReuseMatrix(piece.modelView), 0.0);
        popStateSet();
    }
    if (task.passState) popStateSet();
    popStateSet();
    end(outer);
}

Ball CompensatingCullVisitor::eyeBall(const osg::BoundingSphere& sphere) const
{
    const auto* modelView = _modelviewStack.back().get();
    return {osg::Vec3d(sphere.center()) * *modelView, static_cast<double>(sphere.radius()) * _scale};
}

bool CompensatingCullVisitor::outOfSight(const osg::Node& node)
{
    if (_task.filter)
    {
        const osg::BoundingSphere& all = node.getBound();
        return node.isCullingActive() && all.valid() && _task.filter->outside(eyeBall(all));
    }
    if (!node.isCullingActive())
    {
        _mode.planes = _frustum.all();
        return false;
    }
    if (_mode.planes == 0 && !_cullSmall) return false;
    const osg::BoundingSphere& sphere = node.getBound();
    if (!sphere.valid()) return false;
    const Ball undeformed = eyeBall(sphere);
    bool out = _mode.chain->hides(undeformed, _room);
    if (!out)
    {
        const Ball ball = _mode.chain->bound(undeformed);
        _middle = ball.centre;
        out = outOfSight(ball, _mode.planes);
    }
    return out && !partsInSight(node, undeformed);
}

bool CompensatingCullVisitor::outOfSight(const Ball& ball, EyeFrustum::Mask& planes) const
{
    if (_frustum.side(ball, planes) == EyeFrustum::Side::Outside) return true;
    return _cullSmall && planeDistance(_pixelSize, ball.centre) * _smallPixels > ball.radius;
}

bool CompensatingCullVisitor::partsInSight(const osg::Node& node, const Ball& undeformed)
{
    if (_mode.chain->empty()) return false;
    EyeFrustum::Mask planes = _frustum.all();
    if (outOfSight(undeformed, planes) || !_undeformedParts.below(node, _programs, _frame)) return false;
    _mode.planes = _frustum.all();
    _middle = undeformed.centre;
    return true;
}

void CompensatingCullVisitor::apply(osg::Node& node)
{
    const Scope scope(*this, node);
    if (!scope.skip()) CullVisitor::apply(node);
}

void CompensatingCullVisitor::apply(osg::Geode& node)
{
    const Scope scope(*this, node);
    if (!scope.skip()) CullVisitor::apply(node);
}

void CompensatingCullVisitor::apply(osg::Group& node)
{
    if (_mode.ours)
    {
        if (auto* rigid = dynamic_cast<RigidReference*>(&node))
        {
            applyRigid(*rigid);
            return;
        }
    }
    const Scope scope(*this, node);
    if (!scope.skip()) CullVisitor::apply(node);
}

void CompensatingCullVisitor::meet(const osg::StateSet* state)
{
    if (!state) return;
    const osg::StateAttribute* former = _mode.deformation.program;
    _mode.deformation.meet(state);
    const osg::StateAttribute* program = _mode.deformation.program;
    if (program != former) _mode.stranger = _programs.isStranger(program);
    _mode.chain = _mode.stranger ? _nothing.get() : &definedChain();
}

const DeformationChain& CompensatingCullVisitor::definedChain() const
{
    return _mode.deformation.on ? *_task.chain : *_nothing;
}

void CompensatingCullVisitor::meetAll(const osgUtil::StateGraph& state)
{
    if (state._parent) meetAll(*state._parent);
    meet(state.getStateSet());
}

void CompensatingCullVisitor::applyRigid(RigidReference& node)
{
    // Moved as a whole, and then culled and drawn as if nothing were deformed.
    const Mode former = _mode;
    meet(node.getStateSet());
    const osg::Matrixd& modelView = *getModelViewMatrix();
    const osg::Vec3d reference = node.referencePoint() * modelView;
    const osg::Matrixd placement = rigidPlacement(definedChain(), reference, node.getTurn());
    pushModelViewMatrix(createOrReuseMatrix(modelView * placement), osg::Transform::RELATIVE_RF);
    meet(_task.untouched);
    pushStateSet(_task.untouched);
    pushStateSet(placed(placement));
    {
        const Scope scope(*this, node);
        if (!scope.skip()) CullVisitor::apply(node);
    }
    popStateSet();
    popStateSet();
    popModelViewMatrix();
    _mode = former;
}

osg::StateSet* CompensatingCullVisitor::placed(const osg::Matrixd& placement)
{
    if (_placedUsed == _placed.size())
    {
        _placed.push_back(new osg::StateSet);
        _placed.back()->setDefine("GEOFX_PLACED");
    }
    osg::StateSet* state = _placed[_placedUsed++];
    state->getOrCreateUniform("geofx_unplaced", osg::Uniform::FLOAT_MAT4)
        ->set(osg::Matrixf(osg::Matrixd::inverse(placement)));
    return state;
}

void CompensatingCullVisitor::applyTile(osg::Transform& node)
{
    // Its geometry is tested by boxes, which are tighter than its sphere, and asks for no more than a matrix: what the
    // base class would also work out, culling sets and eye points, no one would look at.
    const Mode former = _mode;
    osg::StateSet* state = node.getStateSet();
    meet(state);
    if (!node.isCullingActive())
    {
        _mode.planes = _frustum.all();
    }
    else if (_cullSmall && node.getNumChildren() > 1 && !_task.filter)
    {
        // OSG leaves out nodes that are too small, never single drawables.
        EyeFrustum::Mask planes = _mode.planes;
        const osg::BoundingSphere& sphere = node.getBound();
        if (sphere.valid() && outOfSight(_mode.chain->bound(eyeBall(sphere)), planes) &&
            !partsInSight(node, eyeBall(sphere)))
        {
            _mode = former;
            return;
        }
    }
    _mode.tile = node.getNumChildren() == 1;
    if (state) pushStateSet(state);
    osg::RefMatrix* matrix = createOrReuseMatrix(*getModelViewMatrix());
    node.computeLocalToWorldMatrix(*matrix, this);
    _modelviewStack.push_back(matrix);
    node.traverse(*this);
    _modelviewStack.pop_back();
    if (state) popStateSet();
    _mode = former;
}

void CompensatingCullVisitor::apply(osg::Transform& node)
{
    if (_mode.ours && _task.compensate && holdsGeometryOnly(node))
    {
        applyTile(node);
        return;
    }
    const Scope scope(*this, node);
    if (scope.skip()) return;
    if (!_mode.ours || !_task.compensate)
    {
        CullVisitor::apply(node);
        return;
    }
    // As the base class has it, and with the matrix' scale.
    pushCurrentMask();
    osg::StateSet* state = node.getStateSet();
    if (state) pushStateSet(state);
    osg::RefMatrix* matrix = createOrReuseMatrix(*getModelViewMatrix());
    node.computeLocalToWorldMatrix(*matrix, this);
    pushModelViewMatrix(matrix, node.getReferenceFrame());
    const double formerScale = _scale;
    _scale = largestScale(*matrix);
    handle_cull_callbacks_and_traverse(node);
    _scale = formerScale;
    popModelViewMatrix();
    if (state) popStateSet();
    popCurrentMask();
}

void CompensatingCullVisitor::applyBlock(osg::LOD& block)
{
    const EyeFrustum::Mask formerPlanes = _mode.planes;
    const Ball ball = eyeBall(block.getBound());
    const Ball deformed = _mode.chain->bound(ball);
    // Never left out for being small: a deformation may squeeze many of them into a few pixels.
    const bool out = formerPlanes && (_mode.chain->hides(ball, _room) ||
                                      _frustum.side(deformed, _mode.planes) == EyeFrustum::Side::Outside);
    if (!out || partsInSight(block, ball))
    {
        computeBounds(block);
        const double distance = _mode.chain->lodDistance(ball, getReferenceViewPoint(), &deformed);
        const auto told = static_cast<float>(
            std::min(distance * static_cast<double>(getLODScale()), _mode.chain->lodLimit(block, ball)));
        for (unsigned int i = 0; i < block.getNumChildren(); ++i)
        {
            if (block.getMinRange(i) <= told && told < block.getMaxRange(i)) applyPart(*block.getChild(i));
        }
    }
    _mode.planes = formerPlanes;
}

void CompensatingCullVisitor::applyPart(osg::Node& part)
{
    if (!isPlain(part))
    {
        part.accept(*this);
        return;
    }
    if (!validNodeMask(part)) return;
    pushOntoNodePath(&part);
    part.traverse(*this);
    popFromNodePath();
}

void CompensatingCullVisitor::apply(osg::LOD& node)
{
    if (_mode.ours && _task.compensate && !_task.filter && isPlain(node))
    {
        applyBlock(node);
        return;
    }
    // As in applyBlock(): a part of a tile is never left out for being small.
    const bool cullSmall = _cullSmall;
    if (cullSmall && TileInfo::meshesOf(node)) _cullSmall = false;
    const Scope scope(*this, node);
    _cullSmall = cullSmall;
    if (scope.skip()) return;
    if (!_mode.ours || !_task.compensate)
    {
        CullVisitor::apply(node);
        return;
    }
    computeBounds(node);
    // The mesh and its box lie elsewhere in memory; where the middle shows they have nothing to tell.
    if (_mode.planes && !_frustum.holds(_middle, _mode.planes) && tileOutOfSight(node)) return;
    _mode.lodRadius = static_cast<double>(node.getBound().radius()) * _scale;
    _mode.lodLimit = _mode.chain->lodLimit(node, eyeBall(node.getBound()));
    if (node.getRangeMode() != osg::LOD::PIXEL_SIZE_ON_SCREEN)
    {
        CullVisitor::apply(node);
        return;
    }
    // OSG divides the undeformed size in pixels by the LOD scale; the scale makes it the deformed one.
    const float former = getLODScale();
    const Ball ball = eyeBall(node.getBound());
    const Ball deformed = _mode.chain->bound(ball);
    const double undeformedSize = static_cast<double>(clampedPixelSize(node.getBound()));
    const double deformedSize =
        std::abs(ball.radius / planeDistance(_pixelSize, deformed.centre)) * _mode.chain->detail(ball);
    if (deformedSize > 0.0 && std::isfinite(undeformedSize / deformedSize))
    {
        setLODScale(static_cast<float>(static_cast<double>(former) * undeformedSize / deformedSize));
    }
    CullVisitor::apply(node);
    setLODScale(former);
}

void CompensatingCullVisitor::apply(osg::OcclusionQueryNode& node)
{
    // Its query would ask for the box where the box is not.
    if (_mode.ours)
        apply(static_cast<osg::Group&>(node));
    else
        CullVisitor::apply(node);
}

template<typename NodeType>
void CompensatingCullVisitor::passUntouched(NodeType& node)
{
    if (!_mode.ours)
    {
        CullVisitor::apply(node);
        return;
    }
    const Mode formerMode = _mode;
    const osg::CullSettings formerSettings(*this);
    osgUtil::StateGraph* const formerGraph = _currentStateGraph;
    // The state from the entry on, without ours.
    std::vector<const osg::StateSet*> below;
    for (osgUtil::StateGraph* graph = _currentStateGraph; graph && graph != _entry; graph = graph->_parent)
    {
        const osg::StateSet* set = graph->getStateSet();
        if (set != _task.state && set != _task.untouched && !isPlaced(set)) below.push_back(set);
    }
    _currentStateGraph = _entry;
    for (auto set = below.rbegin(); set != below.rend(); ++set)
    {
        _currentStateGraph = _currentStateGraph->find_or_insert(*set);
    }
    _mode.ours = false;
    _mode.chain = _nothing.get();
    const std::size_t graphs = graphsIn(*_currentRenderBin->getStage());
    setCullingMode(_outerCullingMode);
    setComputeNearFarMode(_outerNearFar);
    const value_type formerNear = _computed_znear;
    const value_type formerFar = _computed_zfar;
    CullVisitor::apply(node);
    _computed_znear = formerNear;
    _computed_zfar = formerFar;
    setCullSettings(formerSettings);
    _currentStateGraph = formerGraph;
    _mode = formerMode;
    // Not to be looked for among what is ours.
    _graphsBefore += graphsIn(*_currentRenderBin->getStage()) - graphs;
}

void CompensatingCullVisitor::apply(osg::Camera& node)
{
    if (_task.filter) return;
    passUntouched(node);
}

void CompensatingCullVisitor::apply(osg::Projection& node)
{
    if (_task.filter) return;
    passUntouched(node);
}

bool CompensatingCullVisitor::meshOutside(const osg::Drawable& drawable, EyeFrustum::Mask planes)
{
    MeshBoxes::Entry& mesh = _meshBoxes.of(drawable);
    const std::size_t count = mesh.boxes.size();
    const std::size_t former = mesh.witness;
    if (former < count && !misses(mesh.boxes[former], planes)) return false;
    // The middles are quick to test, and most often one of them settles it.
    for (const bool wholly : {false, true})
    {
        for (mesh.witness = 0; mesh.witness < count; ++mesh.witness)
        {
            const osg::BoundingBox& box = mesh.boxes[mesh.witness];
            if (wholly ? !misses(box, planes) : middleInSight(box, planes)) return false;
        }
    }
    return count > 0;
}

bool CompensatingCullVisitor::misses(const osg::BoundingBox& box, EyeFrustum::Mask planes)
{
    const EyeBox eyeBox = EyeBox::of(box, *getModelViewMatrix());
    if (_mode.chain->hides(eyeBox, _room)) return true;
    _mode.chain->bound(eyeBox, _hull);
    return _frustum.misses(_hull, planes);
}

bool CompensatingCullVisitor::middleInSight(const osg::BoundingBox& box, EyeFrustum::Mask planes) const
{
    return _frustum.holds(_mode.chain->roughly(osg::Vec3d(box.center()) * *_modelviewStack.back()), planes);
}

bool CompensatingCullVisitor::witnessInSight(const osg::Drawable& drawable, EyeFrustum::Mask planes)
{
    const MeshBoxes::Entry* mesh = _meshBoxes.find(drawable);
    return mesh && mesh->witness < mesh->boxes.size() && middleInSight(mesh->boxes[mesh->witness], planes);
}

bool CompensatingCullVisitor::tileOutOfSight(const osg::LOD& node)
{
    // Its sphere is wide for a flat tile, which has a box.
    const osg::Transform* tile = _task.tileError > 0.0 ? TileInfo::coarseOf(node) : nullptr;
    osg::BoundingBoxd tileBox;
    if (!tile || !TileInfo::readBox(*tile, tileBox)) return false;
    osg::Matrixd matrix = *getModelViewMatrix();
    tile->computeLocalToWorldMatrix(matrix, this);
    const double range = static_cast<double>(node.getMaxRange(1));
    const auto radius = static_cast<double>(node.getBound().radius());
    const double error = std::max(0.0, range - radius) * _task.tileError;
    osg::BoundingBox bounds(osg::Vec3(tileBox._min), osg::Vec3(tileBox._max));
    const osg::Vec3 more(osg::Vec3d(error, error, error));
    bounds._min -= more;
    bounds._max += more;
    const EyeBox box = EyeBox::of(bounds, matrix);
    EyeFrustum::Mask planes = _mode.planes;
    if (_mode.chain->hides(box, _room)) return true;
    const Ball deformed = _mode.chain->bound(box.ball());
    const EyeFrustum::Side side = _frustum.side(deformed, planes);
    if (side != EyeFrustum::Side::Crossing) return side == EyeFrustum::Side::Outside;
    if (_frustum.holds(deformed.centre, planes)) return false;
    _mode.chain->bound(box, _hull);
    return _frustum.misses(_hull, planes);
}

bool CompensatingCullVisitor::drawableInSight(const osg::Drawable& drawable, double& depth)
{
    const osg::BoundingBox& bounds = drawable.getBoundingBox();
    depth = 0.0;
    if (!bounds.valid()) return true;
    const bool test = drawable.isCullingActive();
    // Most are in the middle of the picture, and of what is near and far in it: their spheres say so.
    if (!(test && (_mode.planes || (_mode.tile && _cullSmall))) && !_mode.chain->looksAtBoxes() &&
        !_task.debugBounds)
    {
        const Ball roughly = _mode.chain->bound(eyeBall(drawable.getBound()));
        depth = -roughly.centre.z();
        if (_outerNearFar == DO_NOT_COMPUTE_NEAR_FAR || _depths.covers(roughly)) return true;
    }
    const EyeBox box = EyeBox::of(bounds, *getModelViewMatrix());
    const Ball ball = box.ball();
    const Ball deformed = _mode.chain->bound(ball);
    depth = -deformed.centre.z();
    if (test && _outerCullingMode != NO_CULLING && _mode.chain->hides(box, _room)) return false;
    if (test && _mode.tile && _cullSmall &&
        planeDistance(_pixelSize, deformed.centre) * _smallPixels > deformed.radius)
        return false;
    EyeFrustum::Mask planes = test ? _mode.planes : 0;
    if (planes && _frustum.side(deformed, planes) == EyeFrustum::Side::Outside) return false;
    // Where the box's middle shows there is no more to be found out; nor where the part does that showed last time.
    if (planes && !_frustum.holds(deformed.centre, planes) && !witnessInSight(drawable, planes))
    {
        _mode.chain->bound(box, _hull);
        if (_frustum.misses(_hull, planes) || meshOutside(drawable, planes)) return false;
    }
    for (const auto& frame : _mode.chain->frames())
    {
        if (_complaint.empty()) _complaint = frame->complaint(box);
    }
    if (_outerNearFar != DO_NOT_COMPUTE_NEAR_FAR) _depths.add(box, deformed, *_mode.chain);
    if (_task.debugBounds) showBounds(box);
    return true;
}

osg::StateSet* CompensatingCullVisitor::lookFor(const osg::Drawable& drawable)
{
    if (!_task.program) return nullptr;
    const bool otherGraph = _currentStateGraph != _stateGraph;
    if (otherGraph)
    {
        _stateGraph = _currentStateGraph;
        _state = FixedFunctionState();
        _state.meetAll(*_currentStateGraph);
    }
    // The meshes of a tile share theirs.
    if (otherGraph || drawable.getStateSet() != _ownState)
    {
        _ownState = drawable.getStateSet();
        FixedFunctionState state = _state;
        if (_ownState) state.meet(*_ownState);
        _ownLook = lookOf(state.look(_task.mapUnit));
    }
    return _ownLook;
}

osg::StateSet* CompensatingCullVisitor::lookOf(const FixedFunctionLook& look)
{
    if (look.ownProgram) return nullptr;
    if (look.unsupported && !_warnedOfLook)
    {
        _warnedOfLook = true;
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
        if (!set) set = look.createStateSet(_task.program);
        _look = set;
        _lookKey = key;
    }
    return _look;
}

osg::StateSet* CompensatingCullVisitor::followingState()
{
    const osg::StateAttribute* program = _mode.deformation.program;
    if (!program || !_task.following) return nullptr;
    const auto [found, isNew] = _following.try_emplace(program);
    if (isNew) found->second = _task.following->of(*program);
    return found->second;
}

void CompensatingCullVisitor::apply(osg::Drawable& drawable)
{
    if (!_mode.ours)
    {
        CullVisitor::apply(drawable);
        return;
    }
    const Mode former = _mode;
    meet(drawable.getStateSet());
    if (_mode.stranger) noteStranger();
    if (!_task.compensate)
    {
        osg::StateSet* look = lookFor(drawable);
        if (!look) look = followingState();
        if (look) pushStateSet(look);
        const osg::StateSet* own = drawable.getStateSet();
        const osgUtil::StateGraph* graph = own ? _currentStateGraph->find_or_insert(own) : _currentStateGraph;
        const bool empty = graph->leaves_empty();
        CullVisitor::apply(drawable);
        if (empty && !graph->leaves_empty()) _ownGraphs.push_back(graph);
        if (look) popStateSet();
        drawCompanions(drawable, 0.0);
        _mode = former;
        return;
    }
    if (osg::Callback* callback = drawable.getCullCallback())
    {
        osg::DrawableCullCallback* cull = callback->asDrawableCullCallback();
        if (cull && cull->cull(this, &drawable, &_renderInfo))
        {
            _mode = former;
            return;
        }
        if (!cull) callback->run(&drawable, this);
    }
    double depth = 0.0;
    if (_task.filter)
        applyInPass(drawable);
    else if (drawableInSight(drawable, depth) && std::isfinite(depth))
    {
        osg::StateSet* look = lookFor(drawable);
        osg::StateSet* following = look ? nullptr : followingState();
        if (look) pushStateSet(look);
        osg::StateSet* state = drawable.getStateSet();
        if (state) pushStateSet(state);
        if (following) pushStateSet(following);
        addLeaf(drawable, getModelViewMatrix(), depth);
        if (following) popStateSet();
        if (state) popStateSet();
        if (look) popStateSet();
        drawCompanions(drawable, depth);
    }
    _mode = former;
}

void CompensatingCullVisitor::drawCompanions(osg::Drawable& drawable, double depth)
{
    for (DrawableCompanion* each : _task.companions)
    {
        osg::Drawable* companion = each->companion(drawable, *getModelViewMatrix());
        if (!companion) continue;
        pushStateSet(each->state());
        addLeaf(*companion, getModelViewMatrix(), depth);
        popStateSet();
    }
}

void CompensatingCullVisitor::applyInPass(osg::Drawable& drawable)
{
    const osg::BoundingBox& bounds = drawable.getBoundingBox();
    if (!bounds.valid()) return;
    const osg::Matrixd& modelView = *_modelviewStack.back();
    const EyeBox box = EyeBox::of(bounds, modelView);
    if (_task.filter->outside(box.ball())) return;
    osg::StateSet* look = lookFor(drawable);
    const std::vector<osg::StateSet*>& passes =
        _task.filter->states(drawable, box, modelView, look == nullptr);
    osg::StateSet* following = look ? nullptr : followingState();
    // What does not call the functions would stand in the pass where it stands on the ground.
    osg::Drawable* drawn = passes.empty() || _mode.stranger ? nullptr : _task.filter->drawn(drawable);
    if (!drawn) return;
    for (osg::StateSet* pass : passes)
    {
        pushStateSet(pass);
        if (look) pushStateSet(look);
        osg::StateSet* state = drawable.getStateSet();
        if (state) pushStateSet(state);
        if (following) pushStateSet(following);
        addLeaf(*drawn, getModelViewMatrix(), -box.centre.z());
        if (following) popStateSet();
        if (state) popStateSet();
        if (look) popStateSet();
        popStateSet();
    }
}

float CompensatingCullVisitor::getDistanceToViewPoint(const osg::Vec3& position, bool withLodScale) const
{
    if (!_mode.ours || !_task.compensate) return CullVisitor::getDistanceToViewPoint(position, withLodScale);
    const Ball ball = {osg::Vec3d(position) * *_modelviewStack.back(), _mode.lodRadius};
    // The reference view point is in eye space: the origin but for cameras that inherit another one's.
    const double distance = _mode.chain->lodDistance(ball, getReferenceViewPoint());
    return static_cast<float>(
        std::min(withLodScale ? distance * static_cast<double>(getLODScale()) : distance, _mode.lodLimit));
}

float CompensatingCullVisitor::getDistanceToEyePoint(const osg::Vec3& position, bool withLodScale) const
{
    if (!_mode.ours || !_task.compensate) return CullVisitor::getDistanceToEyePoint(position, withLodScale);
    const Ball ball = {osg::Vec3d(position) * *_modelviewStack.back(), _mode.lodRadius};
    const double distance = _mode.chain->lodDistance(ball, osg::Vec3d());
    return static_cast<float>(withLodScale ? distance * static_cast<double>(getLODScale()) : distance);
}

float CompensatingCullVisitor::getDistanceFromEyePoint(const osg::Vec3& position, bool withLodScale) const
{
    if (!_mode.ours || !_task.compensate) return CullVisitor::getDistanceFromEyePoint(position, withLodScale);
    const osg::Vec3d deformed = _mode.chain->deform(osg::Vec3d(position) * *_modelviewStack.back());
    return static_cast<float>(withLodScale ? -deformed.z() * static_cast<double>(getLODScale())
                                           : -deformed.z());
}

void CompensatingCullVisitor::showBounds(const EyeBox& box)
{
    const Ball ball = box.ball();
    const auto& frames = _mode.chain->frames();
    const bool curved =
        std::any_of(frames.begin(), frames.end(),
                    [&](const auto& frame) { return frame->reach(ball) == DeformationFrame::Reach::Curved; });
    const osg::Vec4 colour = curved ? osg::Vec4(1, 0.2f, 0.1f, 1) : osg::Vec4(1, 0.9f, 0.2f, 1);
    // What the box's twelve edges became.
    constexpr int pieces = 8;
    std::vector<osg::Vec3d> corners;
    box.corners(corners);
    for (std::size_t a = 0; a < corners.size(); ++a)
    {
        for (const std::size_t axis : {1u, 2u, 4u})
        {
            if (a & axis) continue;
            const osg::Vec3d step = (corners[a | axis] - corners[a]) / pieces;
            osg::Vec3d from = _mode.chain->deform(corners[a]);
            for (int piece = 1; piece <= pieces; ++piece)
            {
                const osg::Vec3d to = _mode.chain->deform(corners[a] + step * piece);
                for (const osg::Vec3d& end : {from, to})
                {
                    _bounds.lines->push_back(end);
                    _bounds.colours->push_back(colour);
                }
                from = to;
            }
        }
    }
}

void CompensatingCullVisitor::drawBounds()
{
    if (!_bounds.geometry)
    {
        _bounds.geometry = new osg::Geometry;
        _bounds.geometry->setUseDisplayList(false);
        _bounds.geometry->setUseVertexBufferObjects(false);
        _bounds.geometry->setCullingActive(false);
        osg::StateSet* state = _bounds.geometry->getOrCreateStateSet();
        state->setMode(GL_LIGHTING, osg::StateAttribute::OFF);
        state->setMode(GL_DEPTH_TEST, osg::StateAttribute::OFF);
    }
    osg::Geometry& geometry = *_bounds.geometry;
    geometry.setVertexArray(_bounds.lines);
    geometry.setColorArray(_bounds.colours, osg::Array::BIND_PER_VERTEX);
    geometry.removePrimitiveSet(0, geometry.getNumPrimitiveSets());
    geometry.addPrimitiveSet(new osg::DrawArrays(GL_LINES, 0, static_cast<GLsizei>(_bounds.lines->size())));
    pushStateSet(geometry.getStateSet());
    addLeaf(geometry, createOrReuseMatrix(osg::Matrix()), 0.0);
    popStateSet();
}

} // namespace osgGeoFX
