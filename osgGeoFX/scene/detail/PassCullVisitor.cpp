// SPDX-License-Identifier: MIT
// SPDX-FileCopyrightText: 2026 the osgGeoFX authors
#include <osgGeoFX/scene/detail/PassCullVisitor.h>

#include <osgGeoFX/effect/PassFilter.h>

namespace osgGeoFX
{

PassCullVisitor::~PassCullVisitor() = default;

void PassCullVisitor::run(osgUtil::CullVisitor& outer, const Task& task, PassFilter& filter)
{
    _filter = &filter;
    // The parts may lie beside the picture that shows them, whether or not anything is deformed.
    Task opened = task;
    opened.open = task.engines;
    CompensatingCullVisitor::run(outer, opened);
}

bool PassCullVisitor::outOfSight(const osg::Node& node)
{
    const osg::BoundingSphere& all = node.getBound();
    if (!node.isCullingActive() || !all.valid()) return false;
    Ball ball = eyeBall(all);
    if (_mode.unplaced) ball.center = ball.center * *_mode.unplaced;
    return _filter->outside(ball);
}

bool PassCullVisitor::boxOutOfSight(const EyeBox& box)
{
    return _filter->outside(box.ball());
}

osg::Matrixd PassCullVisitor::standing(const osg::Matrixd& modelView) const
{
    return _mode.unplaced ? modelView * *_mode.unplaced : modelView;
}

void PassCullVisitor::meetLevels(const osg::LOD& node)
{
    _filter->meet(node);
}

bool PassCullVisitor::drawsItself() const
{
    return OwnPrograms::isOwn(_mode.deformation.program);
}

osg::Drawable* PassCullVisitor::drawn(osg::Drawable& drawable, const std::vector<osg::StateSet*>& states)
{
    // A stranger does not call the functions. The pass would draw it where it stands on the ground.
    return states.empty() || _mode.stranger ? nullptr : _filter->drawn(drawable);
}

void PassCullVisitor::place(osg::Drawable& drawable)
{
    const osg::BoundingBox& bounds = drawable.getBoundingBox();
    if (!bounds.valid()) return;
    const osg::Matrixd modelView = standing(viewMatrix());
    const EyeBox box = EyeBox::of(bounds, modelView);
    if (_filter->outside(box.ball())) return;
    osg::StateSet* const own = ownState(drawable);
    osg::StateSet* look = _looks.lookFor(drawable, own, *_currentStateGraph);
    const std::vector<osg::StateSet*>& states = _filter->states(drawable, box, modelView, drawsItself());
    osg::Drawable* const copy = drawn(drawable, states);
    if (!copy) return;
    for (osg::StateSet* state : states)
    {
        pushStateSet(state);
        addLeaf(*copy, own, look, -box.center.z());
        drawCompanions(drawable, getModelViewMatrix(), -box.center.z());
        popStateSet();
    }
}

void PassCullVisitor::adopt(osgUtil::RenderBin& bin, osgUtil::StateGraph& graph, osgUtil::RenderLeaf& leaf,
                            const osg::BoundingBox& bounds, osg::StateSet*, osg::StateSet* above)
{
    if (!bounds.valid()) return;
    osg::Drawable& drawable = *leaf._drawable;
    const osg::Matrixd modelView =
        standing(inView(leaf._modelview ? osg::Matrixd(*leaf._modelview) : osg::Matrixd()));
    const EyeBox box = EyeBox::of(bounds, modelView);
    if (_filter->outside(box.ball())) return;
    const std::vector<osg::StateSet*>& states = _filter->states(drawable, box, modelView, drawsItself());
    osg::Drawable* const copy = drawn(drawable, states);
    if (!copy) return;
    for (osg::StateSet* state : states)
    {
        osgUtil::StateGraph* target = graph.find_or_insert(state);
        if (above) target = target->find_or_insert(above);
        osgUtil::RenderLeaf* const made =
            createOrReuseRenderLeaf(copy, leaf._projection.get(), leaf._modelview.get(), leaf._depth);
        // Leaves come in the order of state graphs, which depends on what is in sight.
        made->_traversalOrderNumber = leaf._traversalOrderNumber;
        put(bin, graph, *target, made);
    }
}

} // namespace osgGeoFX
