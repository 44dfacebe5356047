// SPDX-License-Identifier: MIT
// SPDX-FileCopyrightText: 2026 the osgGeoFX authors
//
// What gets into the render graph by other ways than a drawable of its own: billboards, light points, and nodes whose state
// alone matters.
#include <osgGeoFX/scene/detail/CompensatingCullVisitor.h>

#include <osgGeoFX/effect/GroundShade.h>

#include <osg/Billboard>
#include <osg/ClearNode>
#include <osg/ClipNode>
#include <osg/LightSource>
#include <osg/OccluderNode>
#include <osg/TexGenNode>

#include <algorithm>
#include <cstring>

namespace osgGeoFX
{

namespace
{

bool isSprites(const osg::Drawable& drawable)
{
    return std::strcmp(drawable.className(), "LightPointSpriteDrawable") == 0;
}

/// Whether it is one of osgSim's, which set modes behind the state's back; as a rule there is one for all nodes of a state. Their
/// classes are not for others to include, and do not name their library.
bool isLightPoints(const osg::Drawable& drawable)
{
    return std::strcmp(drawable.className(), "LightPointDrawable") == 0 || isSprites(drawable);
}

osg::ref_ptr<osg::StateSet> lightPointModes()
{
    osg::ref_ptr<osg::StateSet> state = new osg::StateSet;
    constexpr unsigned int off =
        osg::StateAttribute::OFF | osg::StateAttribute::OVERRIDE | osg::StateAttribute::PROTECTED;
    state->setMode(GL_LIGHTING, off);
    state->setTextureMode(0, GL_TEXTURE_1D, off);
    return state;
}

} // namespace

std::size_t CompensatingCullVisitor::graphsIn(osgUtil::RenderBin& bin)
{
    std::size_t count = bin.getStateGraphList().size();
    for (const auto& [number, inner] : bin.getRenderBinList())
        count += graphsIn(*inner);
    return count;
}

void CompensatingCullVisitor::addLeaf(osg::Drawable& drawable, osg::RefMatrix* matrix, double depth)
{
    if (_currentStateGraph->leaves_empty())
    {
        _ownGraphs.push_back(_currentStateGraph);
        _currentRenderBin->addStateGraph(_currentStateGraph);
    }
    // As the base class has it, with the picture's projection even where engines cull by another one.
    _currentStateGraph->addLeaf(
        createOrReuseRenderLeaf(&drawable, _projection.get(), matrix, static_cast<float>(depth)));
}

void CompensatingCullVisitor::addLeaf(osg::Drawable& drawable, osg::StateSet* own, osg::StateSet* look,
                                      double depth)
{
    osg::StateSet* const following = look ? nullptr : _looks.followingOf(_mode.deformation.program);
    if (look) pushStateSet(look);
    if (own) pushStateSet(own);
    if (following) pushStateSet(following);
    addLeaf(drawable, getModelViewMatrix(), depth);
    if (following) popStateSet();
    if (own) popStateSet();
    if (look) popStateSet();
}

void CompensatingCullVisitor::put(osgUtil::RenderBin& bin, osgUtil::StateGraph& from, osgUtil::StateGraph& to,
                                  osgUtil::RenderLeaf* leaf)
{
    if (to.leaves_empty() && &to != &from) bin.addStateGraph(&to);
    to.addLeaf(leaf);
}

void CompensatingCullVisitor::place(osg::Drawable& drawable)
{
    double depth = 0.0;
    const osg::Matrixd matrix = viewMatrix();
    const bool ofEngine = _task.open && !_mode.chain->empty() && !comesWithOsg(&drawable);
    const DrawableSight::Place where = {*_mode.chain, matrix,    _scale,        _mode.planes,
                                        _mode.tile,   !ofEngine, _mode.rigid.on};
    if (!_drawables.inSight(drawable, where, depth) || !std::isfinite(depth)) return;
    const bool shade = _task.depth.reversed() && GroundShade::is(drawable);
    if (shade && !_ofShades) _ofShades = GroundShade::createReversed();
    if (shade) pushStateSet(_ofShades);
    draw(drawable, depth);
    drawCompanions(drawable, getModelViewMatrix(), depth);
    if (shade) popStateSet();
}

bool CompensatingCullVisitor::isLaidOut(const osg::Drawable& drawable) const
{
    if (!_task.layoutBins) return false;
    // Where nothing is deformed, the picture's own labels stay as they are.
    if (!_task.inPass && (!_task.compensate || _mode.chain->empty())) return false;
    const auto isNamed = [this](const std::string& name)
    {
        return std::find(_task.layoutBins->begin(), _task.layoutBins->end(), name) != _task.layoutBins->end();
    };
    const osg::StateSet* own = drawable.getStateSet();
    // A bin has the name of its prototype.
    return isNamed(_currentRenderBin->getName()) ||
           (own && own->useRenderBinDetails() && isNamed(own->getBinName()));
}

void CompensatingCullVisitor::placeInLayout(osg::Drawable& drawable)
{
    // A pass draws parts of the ground, not of the picture.
    if (_task.inPass) return;
    const osg::Vec3d place = inView(osg::Vec3d());
    if (_mode.chain->isBeyond(place) || _horizon.hidesPlace(place)) return;
    osg::Matrixd placement = rigidPlacement(*_mode.chain, place, false);
    const osg::Vec3d deformed = place * placement;
    const osg::BoundingBox& bounds = drawable.getBoundingBox();
    const double radius =
        bounds.valid() ? _scale * static_cast<double>(bounds.center().length() + bounds.radius()) : 0.0;
    const Ball ball = {deformed, radius};
    Visibility::Mask planes = _sight.all();
    if (drawable.isCullingActive() && _sight.outOfSight(ball, planes, true)) return;
    if (_task.image) placement = _task.image->toView * placement * _task.image->toEye;
    const Mode former = _mode;
    meet(_task.untouched);
    pushStateSet(_task.untouched);
    osg::StateSet* const own = ownState(drawable);
    if (own) pushStateSet(own);
    addLeaf(drawable, createOrReuseMatrix(*getModelViewMatrix() * placement),
            _drawables.depths().depthOf(deformed));
    if (own) popStateSet();
    popStateSet();
    _mode = former;
}

void CompensatingCullVisitor::noteStranger()
{
    // Where nothing is to be moved it is at home.
    if (!_mode.deformation.on || _task.chain->empty()) return;
    const osg::StateAttribute* program = _mode.deformation.program;
    const bool known = std::any_of(_strangers.begin(), _strangers.end(),
                                   [&](const Stranger& each) { return each.program == program; });
    if (!known) _strangers.push_back({program, getNodePath()});
}

void CompensatingCullVisitor::adoptLeaves()
{
    osgUtil::RenderStage& stage = *_currentRenderBin->getStage();
    if (graphsIn(stage) == _graphsBefore + _ownGraphs.size()) return;
    std::sort(_ownGraphs.begin(), _ownGraphs.end());
    adoptLeaves(stage);
    // Not before: what they add would look like more of it. In the order of the nodes: that of state graphs depends on
    // which leaves are in sight.
    std::stable_sort(_adopted.begin(), _adopted.end(),
                     [](const Adopted& a, const Adopted& b) { return a.order < b.order; });
    osgUtil::StateGraph* const former = _currentStateGraph;
    for (const Adopted& each : _adopted)
    {
        _currentStateGraph = each.above;
        drawCompanions(*each.drawable, each.modelView, each.depth);
    }
    _currentStateGraph = former;
    _adopted.clear();
    _adoptedPlaces.clear();
}

osgUtil::StateGraph* CompensatingCullVisitor::stateAbove(osgUtil::StateGraph& graph) const
{
    for (osgUtil::StateGraph* each = &graph; each && each != _top; each = each->_parent)
    {
        if (each->getStateSet() == _ofHost) return each->_parent;
    }
    return _top;
}

bool CompensatingCullVisitor::isForeign(const osgUtil::StateGraph& graph) const
{
    if (std::binary_search(_ownGraphs.begin(), _ownGraphs.end(), &graph)) return false;
    const osgUtil::StateGraph* above = &graph;
    while (above && above != _top)
        above = above->_parent;
    return above != nullptr;
}

void CompensatingCullVisitor::adoptLeaves(osgUtil::RenderBin& bin)
{
    std::vector<osgUtil::StateGraph*> foreign;
    for (osgUtil::StateGraph* graph : bin.getStateGraphList())
    {
        if (isForeign(*graph)) foreign.push_back(graph);
    }
    for (osgUtil::StateGraph* graph : foreign)
        adoptLeaves(bin, *graph);
    for (const auto& [number, inner] : bin.getRenderBinList())
        adoptLeaves(*inner);
}

void CompensatingCullVisitor::adoptLeaves(osgUtil::RenderBin& bin, osgUtil::StateGraph& graph)
{
    const Mode former = _mode;
    _mode = Mode();
    _mode.chain = _task.chain;
    meetAll(graph);
    if (_mode.stranger) noteStranger();
    FixedFunctionState state;
    state.meetAll(graph);
    const auto leaves = graph._leaves;
    graph._leaves.clear();
    for (const auto& leaf : leaves)
    {
        osg::Drawable& drawable = *leaf->_drawable;
        if (_proxy && leaf->_projection == _proxy) leaf->_projection = _projection;
        // Light points do not say that they have moved.
        const osg::BoundingBox bounds =
            isLightPoints(drawable) ? drawable.computeBoundingBox() : drawable.getBoundingBox();
        FixedFunctionState own = state;
        if (isLightPoints(drawable))
        {
            if (!_lightPoints) _lightPoints = lightPointModes();
            _lightPoints->setTextureMode(
                0, GL_TEXTURE_2D,
                (isSprites(drawable) ? osg::StateAttribute::ON : osg::StateAttribute::OFF) |
                    osg::StateAttribute::OVERRIDE | osg::StateAttribute::PROTECTED);
            own.meet(*_lightPoints);
        }
        osg::StateSet* look = _looks.lookFor(drawable, own);
        adopt(bin, graph, *leaf, bounds, look, look ? look : _looks.followingOf(_mode.deformation.program));
    }
    if (graph.leaves_empty())
    {
        auto& graphs = bin.getStateGraphList();
        graphs.erase(std::remove(graphs.begin(), graphs.end(), &graph), graphs.end());
    }
    _mode = former;
}

void CompensatingCullVisitor::adopt(osgUtil::RenderBin& bin, osgUtil::StateGraph& graph,
                                    osgUtil::RenderLeaf& leaf, const osg::BoundingBox& bounds, osg::StateSet*,
                                    osg::StateSet* above)
{
    if (_task.compensate && bounds.valid())
    {
        const osg::Matrixd modelView =
            inView(leaf._modelview ? osg::Matrixd(*leaf._modelview) : osg::Matrixd());
        const EyeBox box = EyeBox::of(bounds, modelView);
        // Whoever has put it there did not know where it goes.
        const bool culled = leaf._drawable->isCullingActive() && _outerCullingMode != NO_CULLING;
        if (culled && _sight.outOfSight(*_mode.chain, box, _sight.all())) return;
        const Ball deformed = _mode.chain->bound(box.ball());
        if (_outerNearFar != DO_NOT_COMPUTE_NEAR_FAR)
            _drawables.depths().add(box, deformed, *_mode.chain, {leaf._drawable.get(), modelView});
        // What is transparent is drawn in the order in which it is seen.
        if (!_mode.chain->empty())
            leaf._depth = static_cast<float>(_drawables.depths().depthOf(deformed.center));
    }
    put(bin, graph, above ? *graph.find_or_insert(above) : graph, &leaf);
    noteAdopted(graph, leaf);
}

void CompensatingCullVisitor::noteAdopted(osgUtil::StateGraph& graph, const osgUtil::RenderLeaf& leaf)
{
    if (_task.companions.empty() || !leaf._modelview) return;
    osg::Drawable* const drawable = &*leaf._drawable;
    osg::RefMatrix* const modelView = leaf._modelview.get();
    // A host that draws it in several passes has a leaf for each.
    if (!_adoptedPlaces.emplace(drawable, modelView).second) return;
    _adopted.push_back({stateAbove(graph), drawable, modelView, static_cast<double>(leaf._depth),
                        leaf._traversalOrderNumber});
}

void CompensatingCullVisitor::apply(osg::Billboard& node)
{
    const Scope scope(*this, node);
    if (scope.skip()) return;
    if (!_mode.ours)
    {
        CullVisitor::apply(node);
        return;
    }
    osg::StateSet* state = node.getStateSet();
    if (state) pushStateSet(state);
    for (unsigned int i = 0; i < node.getNumDrawables(); ++i)
    {
        osg::Drawable* drawable = node.getDrawable(i);
        if (!drawable) continue;
        osg::RefMatrix* matrix =
            createOrReuseMatrix(inEye(billboardModelView(turningChain(), node, i, viewMatrix())));
        if (_task.compensate)
            _modelviewStack.push_back(matrix);
        else
            pushModelViewMatrix(matrix, osg::Transform::RELATIVE_RF);
        apply(*drawable);
        if (_task.compensate)
            _modelviewStack.pop_back();
        else
            popModelViewMatrix();
    }
    if (state) popStateSet();
}

template<typename NodeType>
void CompensatingCullVisitor::applyUntested(NodeType& node)
{
    const Mode former = _mode;
    if (_mode.ours)
    {
        meetPushed();
        meet(node.getStateSet());
    }
    CullVisitor::apply(node);
    _mode = former;
}

void CompensatingCullVisitor::apply(osg::ClipNode& node)
{
    applyUntested(node);
}

void CompensatingCullVisitor::apply(osg::LightSource& node)
{
    applyUntested(node);
}

void CompensatingCullVisitor::apply(osg::TexGenNode& node)
{
    applyUntested(node);
}

void CompensatingCullVisitor::apply(osg::ClearNode& node)
{
    if (!_mode.ours || !(_task.stage || !cullsByPicture()))
    {
        applyUntested(node);
        return;
    }
    // It clears the camera's picture, not that of a pass.
    const Mode former = _mode;
    osg::StateSet* state = node.getStateSet();
    meetPushed();
    meet(state);
    if (state) pushStateSet(state);
    handle_cull_callbacks_and_traverse(node);
    if (state) popStateSet();
    _mode = former;
}

void CompensatingCullVisitor::apply(osg::OccluderNode& node)
{
    const Scope scope(*this, node);
    if (!scope.skip()) CullVisitor::apply(node);
}

} // namespace osgGeoFX
