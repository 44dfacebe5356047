// SPDX-License-Identifier: MIT
// SPDX-FileCopyrightText: 2026 the osgGeoFX authors
#include <osgGeoFX/scene/detail/CompensatingCullVisitor.h>

#include <osgGeoFX/effect/DrawableCompanion.h>
#include <osgGeoFX/scene/RigidReference.h>
#include <osgGeoFX/scene/detail/CullVisitorAccess.h>
#include <osgGeoFX/scene/detail/DividedTriangles.h>
#include <osgGeoFX/scene/detail/GroundFinder.h>
#include <osgGeoFX/scene/detail/OpenCulling.h>

#include <osg/OcclusionQueryNode>
#include <osg/PatchParameter>
#include <osg/Projection>

#include <algorithm>
#include <cfloat>
#include <cmath>
#include <utility>

namespace osgGeoFX
{

namespace
{

/// The factor by which a transform takes things nearer to the eye or away from it; 1 where it does anything else.
/// `above`, `below`: to eye space.
double nearness(const osg::Matrixd& above, const osg::Matrixd& below)
{
    constexpr double close = 1e-6;
    const auto row = [](const osg::Matrixd& matrix, int i)
    {
        return osg::Vec3d(matrix(i, 0), matrix(i, 1), matrix(i, 2));
    };
    const double factor = row(below, 0).length() / row(above, 0).length();
    if (!(std::abs(factor - 1.0) > close)) return 1.0;
    for (int i = 0; i < 3; ++i)
        if (!((row(below, i) - row(above, i) * factor).length() <= close * row(above, i).length()))
            return 1.0;
    const osg::Vec3d eye = osg::Vec3d() * osg::Matrixd::inverse(above);
    // OSG tells hosts where the eye is in floats.
    return (eye * below).length() <= close * (1.0 + eye.length()) ? factor : 1.0;
}

/// Whether a transform's children ask for nothing but its matrix: geometry, and no callbacks.
bool holdsGeometryOnly(const osg::Transform& node)
{
    // Others may do something that depends on the eye.
    if (!node.asMatrixTransform() && !node.asPositionAttitudeTransform()) return false;
    if (node.getCullCallback() || node.getReferenceFrame() != osg::Transform::RELATIVE_RF) return false;
    for (unsigned int i = 0; i < node.getNumChildren(); ++i)
    {
        const osg::Node* child = node.getChild(i);
        if (!child->asGeometry() || child->getCullCallback()) return false;
    }
    return true;
}

} // namespace

CompensatingCullVisitor::Lens::Lens(CompensatingCullVisitor& visitor, const osg::Node& node)
    : _visitor(visitor)
{
    // What is not moved is culled by the picture itself.
    const bool moved = !visitor._mode.chain->empty() || !visitor.cullsByPicture();
    const bool engine = !comesWithOsg(&node) && visitor._mode.ours && moved;
    _proxies = visitor._task.proxy && engine != visitor._proxied;
    _raises = visitor._task.open && visitor._mode.ours && &node == visitor._task.engineTerrain;
    if (!_proxies && !_raises) return;
    _formerMode = visitor.getCullingMode();
    if (_proxies)
    {
        visitor._proxied = engine;
        visitor.pushProjectionWithFrusta(engine ? visitor._proxy.get() : visitor._projection.get());
        visitor.getProjectionCullingStack().back().setCullingMask(NO_CULLING);
    }
    if (_raises) visitor.pushReferenceViewPoint(visitor._highPoint);
    visitor.pushModelViewMatrix(visitor.getModelViewMatrix(), osg::Transform::RELATIVE_RF);
    visitor.getCurrentCullingSet().setCullingMask(NO_CULLING);
    if (_proxies)
        visitor.setCullingMode(engine ? visitor._outerCullingMode & VIEW_FRUSTUM_CULLING : NO_CULLING);
}

CompensatingCullVisitor::Lens::~Lens()
{
    if (!_proxies && !_raises) return;
    _visitor.setCullingMode(_formerMode);
    _visitor.popModelViewMatrix();
    if (_raises)
    {
        _visitor.popReferenceViewPoint();
        _visitor.showDepthsOfGround();
    }
    if (!_proxies) return;
    _visitor.popProjectionMatrix();
    _visitor._proxied = !_visitor._proxied;
}

void CompensatingCullVisitor::showDepthsOfGround()
{
    if (!_task.compensate || !std::isfinite(_farthestGround) || !(_farthestGround > 0.0)) return;
    _computed_znear = std::min(_computed_znear, _farthestGround * getNearFarRatio());
    _computed_zfar = std::max(_computed_zfar, _farthestGround);
}

CompensatingCullVisitor::Scope::Scope(CompensatingCullVisitor& visitor, const osg::Node& node)
    : _visitor(visitor), _former(visitor._mode)
{
    if (!visitor._mode.ours) return;
    visitor.meetPushed();
    visitor.meet(node.getStateSet());
    if (visitor._task.compensate) _skip = visitor.outOfSight(node);
    if (visitor._task.open && !_skip) _lens.emplace(visitor, node);
}

CompensatingCullVisitor::CompensatingCullVisitor() : _nothing(new DeformationChain) {}

CompensatingCullVisitor::~CompensatingCullVisitor()
{
    // A draw thread may still draw the last frame's leaves, which the render graph holds. OSG's destructor would empty them.
    _currentReuseRenderLeafIndex = 0;
}

bool CompensatingCullVisitor::startsFrame(osgUtil::CullVisitor& outer)
{
    // The outer visitor's leaves of the last frame have been drawn when it begins a new one; so have ours.
    const unsigned int frame = outer.getFrameStamp() ? outer.getFrameStamp()->getFrameNumber() : 0;
    const bool starts = frame != _frame || CullVisitorAccess::order(outer) < _order;
    if (starts) startFrame(outer);
    // Also where nothing is drawn until it is asked again.
    _order = CullVisitorAccess::order(outer);
    return starts;
}

void CompensatingCullVisitor::startFrame(osgUtil::CullVisitor& outer)
{
    _frame = outer.getFrameStamp() ? outer.getFrameStamp()->getFrameNumber() : 0;
    reset();
    _placedUsed = 0;
    _nearerUsed = 0;
    _programs.startFrame();
    _drawables.purge();
    _twins.startFrame();
}

void CompensatingCullVisitor::begin(osgUtil::CullVisitor& outer, const Task& task)
{
    _task = task;
    setHost(outer);
    _programs.setAdapting(task.adapts);
    _programs.setHost(task.shaderHost);
    _looks.begin(task.program, task.following, task.mapUnit, task.normals);
    _looks.setHost(task.shaderHost, task.hostAddition);
    if (task.tessellating) beginPatches(*task.tessellating, *outer.getViewport());

    setFrameStamp(const_cast<osg::FrameStamp*>(outer.getFrameStamp()));
    setTraversalNumber(outer.getTraversalNumber());
    setTraversalMode(outer.getTraversalMode());
    setTraversalMask(outer.getTraversalMask());
    setNodeMaskOverride(outer.getNodeMaskOverride());
    setDatabaseRequestHandler(task.asksForTiles ? outer.getDatabaseRequestHandler() : nullptr);
    setImageRequestHandler(task.asksForTiles ? outer.getImageRequestHandler() : nullptr);
    getNodePath() = outer.getNodePath();
    setUserDataContainer(outer.getUserDataContainer());
    setIdentifier(outer.getIdentifier());
    setRenderInfo(outer.getRenderInfo());
    setCullSettings(outer);

    _rootStateGraph = outer.getRootStateGraph();
    _currentStateGraph = outer.getCurrentStateGraph();
    _rootRenderStage = outer.getRenderStage();
    _currentRenderBin = outer.getCurrentRenderBin();
    _renderBinStack = CullVisitorAccess::bins(outer);
    if (task.stage)
    {
        _rootRenderStage = task.stage;
        _currentRenderBin = task.stage;
        _renderBinStack.clear();
    }
    _traversalOrderNumber = CullVisitorAccess::order(outer);
    _numberOfEncloseOverrideRenderBinDetails = CullVisitorAccess::overrides(outer);
    _entry = _currentStateGraph;

    _outerCullingMode = outer.getCullingMode();
    _task.proxy = task.proxy && task.open && (_outerCullingMode & VIEW_FRUSTUM_CULLING);
    const bool findsDepths = task.findsNearAndFar || task.ownView;
    _outerNearFar = findsDepths ? outer.getComputeNearFarMode() : DO_NOT_COMPUTE_NEAR_FAR;
    if (task.compensate)
    {
        setComputeNearFarMode(DO_NOT_COMPUTE_NEAR_FAR);
    }
    // Of this mode, engines make culling stacks of their own.
    if (task.open) setCullingMode(NO_CULLING);
    pushMatrices(outer);
    // The horizon that tiles know (osg::ClusterCullingCallback) is that of the undeformed Earth, for the eye. GlobeHorizon has that of
    // the deformed one.
    if (!task.chain->empty() || !cullsByPicture()) setCullingMode(getCullingMode() & ~CLUSTER_CULLING);

    _mode = Mode();
    _mode.chain = task.chain;
    meetAll(*_entry);
    meet(task.state);
    _strangers.clear();
    _ownGraphs.clear();
    _graphsBefore = graphsIn(*_currentRenderBin->getStage());
    _top = _entry;
    _mode.planes = _sight.all();
    _scale = largestScale(*getModelViewMatrix());
    // What the GPU divides reaches beyond its triangles.
    const DepthRange::Meshes meshes =
        task.tessellating                                    ? DepthRange::Meshes::No
        : _outerNearFar == COMPUTE_NEAR_FAR_USING_PRIMITIVES ? DepthRange::Meshes::NearAndFar
        : _outerNearFar == COMPUTE_NEAR_USING_PRIMITIVES     ? DepthRange::Meshes::Near
                                                             : DepthRange::Meshes::Loosely;
    _drawables.begin({_outerNearFar != DO_NOT_COMPUTE_NEAR_FAR, _outerCullingMode != NO_CULLING,
                      task.debugBounds, meshes});
    // The drawables of engines are as large as the terrain, and say nothing of near and far.
    if (_task.open && _outerNearFar != DO_NOT_COMPUTE_NEAR_FAR && std::isfinite(_proxyDepths.second))
        _drawables.depths().include(_proxyDepths.first, _proxyDepths.second);
}

void CompensatingCullVisitor::pushMatrices(osgUtil::CullVisitor& outer)
{
    const ViewGeometry* own = _task.ownView;
    pushViewport(outer.getViewport());
    _projection = own ? createOrReuseMatrix(own->projection) : outer.getProjectionMatrix();
    _proxied = false;
    pushProjectionMatrix(_projection);
    // In the eye space of the camera, also where a view of its own is drawn.
    osg::CullingSet::StateFrustumList& frusta = getProjectionCullingStack().back().getStateFrustumList();
    frusta = outer.getProjectionCullingStack().back().getStateFrustumList();
    for (osg::CullingSet::StateFrustumPair& each : frusta)
        if (own)
            each.second.transformProvidingInverse(osg::Matrixd::inverse(own->modelView) *
                                                  *outer.getModelViewMatrix());
    setVisibility(outer);
    setHorizon();
    // OSG's own tests, which the base class makes, pass everything.
    if (_task.compensate) getProjectionCullingStack().back().setCullingMask(NO_CULLING);
    _outerViewPoint = outer.getReferenceViewPoint();
    // OSG knows a matrix by its address, and each stage loads another one behind its back: stages must not share any.
    osg::RefMatrix* modelView =
        _task.stage ? createOrReuseMatrix(own ? own->modelView : osg::Matrixd(*outer.getModelViewMatrix()))
                    : outer.getModelViewMatrix();
    if (_task.open)
    {
        const osg::Vec3 ofProxy = setProxy(*modelView);
        _highPoint = _task.proxy ? ofProxy : raisedViewPoint();
    }
    pushReferenceViewPoint(_task.open && !_task.engineTerrain ? _highPoint : outer.getReferenceViewPoint());
    pushModelViewMatrix(modelView, osg::Transform::RELATIVE_RF);
    if (_task.compensate) getCurrentCullingSet().setCullingMask(NO_CULLING);
}

void CompensatingCullVisitor::setVisibility(const osgUtil::CullVisitor& outer)
{
    const bool culls = cullsByPicture();
    Visibility::Camera camera;
    camera.projection = *getProjectionMatrix();
    camera.image = _task.image;
    camera.viewport = getViewport();
    camera.sides = (_outerCullingMode & VIEW_FRUSTUM_SIDES_CULLING) != 0;
    const bool cut = _task.depth.cutByProjection();
    camera.nearPlane = cut && (_outerCullingMode & NEAR_PLANE_CULLING) != 0;
    camera.farPlane = cut && (_outerCullingMode & FAR_PLANE_CULLING) != 0;
    // These are the planes of the depths −1 and 1. A reversed far plane may also be at 0; what lies between is not culled.
    if (_task.depth.reversed()) std::swap(camera.nearPlane, camera.farPlane);
    if (culls && (_outerCullingMode & VIEW_FRUSTUM_CULLING))
    {
        _planes.setToUnitFrustum(camera.nearPlane, camera.farPlane);
        _planes.transformProvidingInverse(camera.projection);
        camera.planes = &_planes;
    }
    if (culls && (_outerCullingMode & SMALL_FEATURE_CULLING))
        camera.smallPixels = static_cast<double>(outer.getSmallFeatureCullingPixelSize());
    for (const DrawableCompanion* each : _task.companions)
        camera.reach = std::max(camera.reach, each->reach());
    _sight.set(camera);
}

void CompensatingCullVisitor::setHorizon()
{
    _horizon = GlobeHorizon();
    const osg::Matrixd& projection = *getProjectionMatrix();
    const bool parallel = projection(0, 3) == 0.0 && projection(1, 3) == 0.0 && projection(2, 3) == 0.0;
    if (parallel || !_task.compensate || !cullsByPicture() || !(_outerCullingMode & CLUSTER_CULLING)) return;
    _horizon = GlobeHorizon(*_task.chain, *_task.view,
                            _task.image ? osg::Vec3d() * _task.image->toView : osg::Vec3d());
}

void CompensatingCullVisitor::end(osgUtil::CullVisitor& outer)
{
    adoptLeaves();
    _order = _traversalOrderNumber;
    CullVisitorAccess::order(outer) = _traversalOrderNumber;
    if (!_task.compensate)
    {
        // Found by the base class, as OSG finds it.
        computeNearPlane();
        if (_computed_zfar >= _computed_znear) _drawables.depths().include(_computed_znear, _computed_zfar);
    }
    _computed_znear = static_cast<value_type>(FLT_MAX);
    _computed_zfar = -static_cast<value_type>(FLT_MAX);
    DepthRange& depths = _drawables.depths();
    depths.settle();
    const bool found = _outerNearFar != DO_NOT_COMPUTE_NEAR_FAR && depths.farthest() >= depths.nearest();
    if (found && _task.ownView)
    {
        // The camera's own is clamped when all has been culled; no one else does it for this one.
        value_type nearest = depths.nearest(), farthest = depths.farthest();
        outer.clampProjectionMatrix(*getProjectionMatrix(), nearest, farthest);
    }
    else if (found)
    {
        if (_task.open) keepFromBeingCut(outer, depths.nearest(), depths.farthest());
        outer.setCalculatedNearPlane(std::min(outer.getCalculatedNearPlane(), depths.nearest()));
        outer.setCalculatedFarPlane(std::max(outer.getCalculatedFarPlane(), depths.farthest()));
    }
    popModelViewMatrix();
    popReferenceViewPoint();
    setComputeNearFarMode(DO_NOT_COMPUTE_NEAR_FAR);
    popProjectionMatrix();
    popViewport();
    // The stage of a pass belongs to its effect, which may go before this visitor culls again.
    _rootRenderStage = nullptr;
}

void CompensatingCullVisitor::run(osgUtil::CullVisitor& outer, const Task& task)
{
    begin(outer, task);
    for (DrawableCompanion* each : task.companions)
        each->start();
    if (task.state) pushStateSet(task.state);
    if (task.inPass) pushStateSet(task.inPass);
    if (task.passState) pushStateSet(task.passState);
    _top = _currentStateGraph;
    _mode.met = _top;
    task.traverse(*this);
    if (task.passState) popStateSet();
    if (task.inPass) popStateSet();
    if (task.state) popStateSet();
    if (task.debugBounds)
    {
        osg::Geometry& bounds = _drawables.bounds().geometry();
        pushStateSet(bounds.getStateSet());
        addLeaf(bounds, createOrReuseMatrix(osg::Matrix()), 0.0);
        popStateSet();
    }
    end(outer);
}

void CompensatingCullVisitor::run(osgUtil::CullVisitor& outer, const std::vector<ScenePass::Piece>& pieces,
                                  const Task& task)
{
    begin(outer, task);
    pushStateSet(task.state);
    if (task.inPass) pushStateSet(task.inPass);
    if (task.passState) pushStateSet(task.passState);
    for (const ScenePass::Piece& piece : pieces)
    {
        if (piece.state) pushStateSet(piece.state);
        addLeaf(*piece.drawable, createOrReuseMatrix(inEye(piece.modelView)), 0.0);
        if (piece.state) popStateSet();
    }
    if (task.passState) popStateSet();
    if (task.inPass) popStateSet();
    popStateSet();
    end(outer);
}

Ball CompensatingCullVisitor::eyeBall(const osg::BoundingSphere& sphere) const
{
    return {inView(osg::Vec3d(sphere.center())), static_cast<double>(sphere.radius()) * _scale};
}

bool CompensatingCullVisitor::outOfSight(const osg::Node& node)
{
    if (!node.isCullingActive())
    {
        _mode.planes = _sight.all();
        return false;
    }
    if (_mode.planes == 0 && (_mayBeSmall || !_sight.cullsSmall())) return false;
    const osg::BoundingSphere& sphere = node.getBound();
    if (!sphere.valid()) return false;
    const Ball undeformed = eyeBall(sphere);
    bool out = _sight.hides(*_mode.chain, undeformed);
    if (!out)
    {
        const Ball ball = _mode.chain->bound(undeformed);
        _middle = ball.center;
        out = _sight.outOfSight(ball, _mode.planes, _mayBeSmall);
    }
    return out && !partsInSight(node, undeformed);
}

bool CompensatingCullVisitor::leavesOut(const osg::Node& node)
{
    if (!_mode.ours || !_task.compensate) return false;
    const osg::BoundingSphere& bound = node.getBound();
    if (bound.valid() && _mode.chain == _task.chain && _horizon.hides(eyeBall(bound))) return true;
    const Mode former = _mode;
    _mode.planes = _sight.all();
    const bool out = outOfSight(node);
    _mode = former;
    return out;
}

bool CompensatingCullVisitor::leavesOut(const osg::BoundingBox& box, const osg::Matrixd& placement)
{
    if (!_mode.ours || !_task.compensate || _mode.chain != _task.chain || !box.valid()) return false;
    return boxOutOfSight(EyeBox::of(box, placement * viewMatrix()));
}

double CompensatingCullVisitor::pixelSize(const osg::Node& node)
{
    if (!_mode.ours || !_task.compensate || _mode.chain->empty()) return -1.0;
    if (leavesOut(node)) return 0.0;
    const Ball ball = eyeBall(node.getBound());
    const double distance = std::max(_mode.chain->lodDistance(ball, viewPoint()), 1e-3);
    // Straight ahead, since the distance says already where in the picture it is.
    const double pixel = _sight.radiusOfPixel(osg::Vec3d(0.0, 0.0, -distance));
    return ball.radius / std::max(std::abs(pixel), 1e-30) / static_cast<double>(getLODScale());
}

bool CompensatingCullVisitor::movesVertically(const osg::Node& node) const
{
    if (_mode.ours && _task.inPass) return false;
    if (!_mode.ours || _mode.chain->empty()) return true;
    const osg::BoundingSphere& bound = node.getBound();
    return _mode.chain->movesVertically(
        {inView(osg::Vec3d(bound.center())), static_cast<double>(bound.radius()) * _scale});
}

std::optional<osg::Vec3d> CompensatingCullVisitor::highPoint() const
{
    if (!_task.open || !_mode.ours) return std::nullopt;
    const osg::Vec3d inEyeSpace(_highPoint);
    return (_task.image ? inEyeSpace * _task.image->toView : inEyeSpace) *
           osg::Matrixd::inverse(_task.view->modelView);
}

bool CompensatingCullVisitor::partsInSight(const osg::Node& node, const Ball& undeformed)
{
    if (_mode.chain->empty()) return false;
    Visibility::Mask planes = _sight.all();
    if (_sight.outOfSight(undeformed, planes, _mayBeSmall) ||
        !_undeformedParts.below(node, _programs, _frame))
        return false;
    _mode.planes = _sight.all();
    _middle = undeformed.center;
    return true;
}

void CompensatingCullVisitor::apply(osg::Node& node)
{
    const Scope scope(*this, node);
    // A host may collect it even if it is out of sight. A pass needs nothing of nodes that hold no geometry.
    if (_task.findsNearAndFar && drawByHost(node)) return;
    if (!scope.skip()) CullVisitor::apply(node);
}

void CompensatingCullVisitor::apply(osg::Geode& node)
{
    const Scope scope(*this, node);
    if (!scope.skip() && !drawByHost(node)) CullVisitor::apply(node);
}

void CompensatingCullVisitor::apply(osg::Group& node)
{
    const Scope scope(*this, node);
    if (scope.skip()) return;
    tellHost(node);
    CullVisitor::apply(node);
}

void CompensatingCullVisitor::apply(osg::CoordinateSystemNode& node)
{
    if (_task.ground) _task.ground->meet(*_task.terrain, getNodePath());
    apply(static_cast<osg::Group&>(node));
}

void CompensatingCullVisitor::meet(const osg::StateSet* state)
{
    if (!state) return;
    const osg::StateAttribute* former = _mode.deformation.program;
    _mode.deformation.meet(state);
    _mode.rigid.meet(state);
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

void CompensatingCullVisitor::meetPushed()
{
    if (_currentStateGraph == _mode.met) return;
    meetBelow(*_currentStateGraph);
    _mode.met = _currentStateGraph;
}

void CompensatingCullVisitor::meetBelow(const osgUtil::StateGraph& state)
{
    if (&state == _mode.met) return;
    if (state._parent) meetBelow(*state._parent);
    meet(state.getStateSet());
}

void CompensatingCullVisitor::apply(RigidReference& node)
{
    if (!_mode.ours)
    {
        apply(static_cast<osg::Group&>(node));
        return;
    }
    // Moved as a whole, and then culled and drawn as if nothing were deformed.
    const Mode former = _mode;
    meetPushed();
    meet(node.getStateSet());
    const osg::Matrixd& modelView = *getModelViewMatrix();
    const DeformationChain& placing = _task.placing && _mode.deformation.on ? *_task.placing : definedChain();
    const osg::Vec3d reference = inView(osg::Vec3d(node.referencePoint()));
    if (placing.isBeyond(reference))
    {
        _mode = former;
        return;
    }
    osg::Matrixd placement = rigidPlacement(placing, reference, node.getTurn());
    _mode.unplaced = osg::Matrixd::inverse(placement);
    if (_task.image) placement = _task.image->toView * placement * _task.image->toEye;
    osg::CullingSet::StateFrustumList& frusta = getProjectionCullingStack().back().getStateFrustumList();
    const osg::CullingSet::StateFrustumList formerFrusta = frusta;
    for (osg::CullingSet::StateFrustumPair& each : frusta)
        each.second.transformProvidingInverse(osg::Matrixd::inverse(placement));
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
    getProjectionCullingStack().back().getStateFrustumList() = formerFrusta;
    _mode = former;
}

void CompensatingCullVisitor::pushProjectionWithFrusta(osg::RefMatrix* projection)
{
    const osg::CullingSet::StateFrustumList frusta = getProjectionCullingStack().back().getStateFrustumList();
    pushProjectionMatrix(projection);
    getProjectionCullingStack().back().getStateFrustumList() = frusta;
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
    // What is drawn nearer to the eye than it is, so that the ground does not hide it, is deformed where it is.
    const bool moves = node.getReferenceFrame() == osg::Transform::RELATIVE_RF && !_mode.chain->empty();
    const double nearer = moves ? nearness(*getModelViewMatrix(), *matrix) : 1.0;
    if (nearer != 1.0)
    {
        matrix->set(*getModelViewMatrix());
        _mode.nearer *= nearer;
        pushStateSet(nearerBy(_mode.nearer));
    }
    pushModelViewMatrix(matrix, node.getReferenceFrame());
    const double formerScale = _scale;
    _scale = largestScale(*matrix);
    handle_cull_callbacks_and_traverse(node);
    _scale = formerScale;
    popModelViewMatrix();
    if (nearer != 1.0) popStateSet();
    if (state) popStateSet();
    popCurrentMask();
}

osg::StateSet* CompensatingCullVisitor::nearerBy(double factor)
{
    if (_nearerUsed == _nearer.size())
    {
        _nearer.push_back(new osg::StateSet);
        _nearer.back()->setDefine("GEOFX_NEARER");
    }
    osg::StateSet* state = _nearer[_nearerUsed++];
    state->getOrCreateUniform("geofx_nearer", osg::Uniform::FLOAT)->set(static_cast<float>(factor));
    return state;
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
    std::optional<Lens> lens;
    if (_task.open) lens.emplace(*this, node);
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
    passToHost(node);
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
    passUntouched(node);
}

void CompensatingCullVisitor::apply(osg::Projection& node)
{
    passUntouched(node);
}

void CompensatingCullVisitor::apply(osg::Drawable& drawable)
{
    if (!_mode.ours)
    {
        CullVisitor::apply(drawable);
        return;
    }
    if (drawByHost(drawable)) return;
    const Mode former = _mode;
    meetPushed();
    meet(drawable.getStateSet());
    const int pushed = pushStatesOfFrusta(drawable);
    if (_mode.stranger) noteStranger();
    bool culled = false;
    if (osg::Callback* callback = drawable.getCullCallback())
    {
        osg::DrawableCullCallback* cull = callback->asDrawableCullCallback();
        culled = cull && cull->cull(this, &drawable, &_renderInfo);
        if (!cull) callback->run(&drawable, this);
    }
    if (!culled)
    {
        if (isLaidOut(drawable))
            placeInLayout(drawable);
        else if (_task.compensate)
            place(drawable);
        else
            placeAsOsg(drawable);
    }
    for (int i = 0; i < pushed; ++i)
        popStateSet();
    _mode = former;
}

int CompensatingCullVisitor::pushStatesOfFrusta(osg::Drawable& drawable)
{
    // Those of the eye space: tiles and billboards have no culling sets of their own.
    const osg::CullingSet::StateFrustumList& frusta =
        getProjectionCullingStack().back().getStateFrustumList();
    const osg::BoundingBox& bounds = drawable.getBoundingBox();
    int pushed = 0;
    for (const auto& [state, frustum] : frusta)
    {
        // Not by the polytope's own test, which leaves out planes that hold what was tested last.
        const auto misses = [&](osg::Plane plane)
        {
            plane.transformProvidingInverse(*getModelViewMatrix());
            return plane.intersect(bounds) < 0;
        };
        const osg::Polytope::PlaneList& planes = frustum.getPlaneList();
        if (std::any_of(planes.begin(), planes.end(), misses)) continue;
        osg::StateSet* const own = pushed == 0 ? drawable.getStateSet() : nullptr;
        for (osg::StateSet* each : {own, state.get()})
        {
            if (!each) continue;
            pushStateSet(each);
            ++pushed;
        }
        meet(state);
    }
    _mode.ownStatePushed = pushed > 0;
    return pushed;
}

void CompensatingCullVisitor::draw(osg::Drawable& drawable, double depth)
{
    osg::StateSet* look = nullptr;
    osg::StateSet* const own = ownState(drawable);
    if (osg::Geometry* const twin = divided(drawable, look))
    {
        pushStateSet(_ofPatches);
        addLeaf(*twin, own, look, depth);
        popStateSet();
    }
    else
        addLeaf(drawable, own, _looks.lookFor(drawable, own, *_currentStateGraph), depth);
}

void CompensatingCullVisitor::placeAsOsg(osg::Drawable& drawable)
{
    osg::RefMatrix& modelView = *getModelViewMatrix();
    const osg::BoundingBox& bounds = drawable.getBoundingBox();
    const bool culled = drawable.isCullingActive() && isCulled(bounds);
    const bool behind = !culled && getComputeNearFarMode() != DO_NOT_COMPUTE_NEAR_FAR && bounds.valid() &&
                        !updateCalculatedNearFar(modelView, drawable, false);
    const double depth = bounds.valid() ? -(osg::Vec3d(bounds.center()) * modelView).z() : 0.0;
    if (!culled && !behind && std::isfinite(depth)) draw(drawable, depth);
    // What an effect draws with it reaches farther.
    drawCompanions(drawable, &modelView, 0.0);
}

void CompensatingCullVisitor::beginPatches(osg::Program& program, const osg::Viewport& viewport)
{
    _dividedLooks.begin(&program, nullptr, _task.mapUnit, _task.normals);
    if (!_ofPatches)
    {
        _ofPatches = new osg::StateSet;
        _ofPatches->setAttribute(new osg::PatchParameter(3));
    }
    _ofPatches->getOrCreateUniform("geofx_halfPicture", osg::Uniform::FLOAT_VEC2)
        ->set(osg::Vec2f(osg::Vec2d(0.5 * viewport.width(), 0.5 * viewport.height())));
}

osg::Geometry* CompensatingCullVisitor::divided(osg::Drawable& drawable, osg::StateSet*& look)
{
    if (!_task.tessellating || _mode.chain->empty() || _mode.nearer != 1.0) return nullptr;
    const osg::BoundingBox& bounds = drawable.getBoundingBox();
    if (!bounds.valid() || !DividedTriangles::within(*_mode.chain, EyeBox::of(bounds, viewMatrix())) ||
        !PatchTwins::mayHave(drawable))
        return nullptr;
    osg::Geometry* const twin = _twins.of(*drawable.asGeometry());
    // Without a look an own program draws it.
    if (twin) look = _dividedLooks.lookFor(drawable, ownState(drawable), *_currentStateGraph);
    return look ? twin : nullptr;
}

void CompensatingCullVisitor::drawCompanions(osg::Drawable& drawable, osg::RefMatrix* modelView, double depth)
{
    for (DrawableCompanion* each : _task.companions)
    {
        osg::Matrixd matrix = inView(*modelView);
        if (each->standing() && _mode.unplaced) matrix = matrix * *_mode.unplaced;
        osg::Drawable* companion = each->companion(drawable, matrix);
        if (!companion) continue;
        pushStateSet(each->state());
        addLeaf(*companion, modelView, depth);
        popStateSet();
    }
}

} // namespace osgGeoFX
