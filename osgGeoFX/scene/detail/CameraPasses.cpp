// SPDX-License-Identifier: MIT
// SPDX-FileCopyrightText: 2026 the osgGeoFX authors
#include <osgGeoFX/scene/detail/CameraPasses.h>

#include <osgGeoFX/effect/PassEffect.h>

namespace osgGeoFX
{

namespace
{

CompensatingCullVisitor::Task taskOf(const CompensatingCullVisitor::Task& scene,
                                     const ScenePass::Drawing& drawing)
{
    CompensatingCullVisitor::Task task = scene;
    task.companions.clear();
    if (drawing.companions) task.companions = *drawing.companions;
    task.debugBounds = false;
    task.findsNearAndFar = false;
    task.program = drawing.program;
    task.stage = drawing.stage;
    task.passState = drawing.state;
    task.asksForTiles = drawing.asksForTiles;
    // What a filter looks at is drawn by the camera's chain. The pass' own tells its detail.
    if (drawing.chain && drawing.filter) task.placing = task.chain;
    if (drawing.chain) task.chain = drawing.chain;
    if (drawing.filter) task.compensate = true;
    if (drawing.ofView && task.image)
    {
        task.image = nullptr;
        task.ownView = task.view;
    }
    return task;
}

} // namespace

template<class Visitor>
Visitor& CameraPasses::of(Visitors<Visitor>& visitors, osg::Program* program, osgUtil::CullVisitor& outer)
{
    Known<Visitor>& known = visitors[program];
    if (!known.visitor)
    {
        known.program = program;
        known.visitor = new Visitor;
        known.visitor->startFrame(outer);
    }
    known.used = true;
    return *known.visitor;
}

template<class Visitor>
void CameraPasses::startFrame(Visitors<Visitor>& visitors, osgUtil::CullVisitor& outer)
{
    for (auto entry = visitors.begin(); entry != visitors.end();)
    {
        Known<Visitor>& known = entry->second;
        if (!known.used)
        {
            entry = visitors.erase(entry);
            continue;
        }
        known.used = false;
        known.visitor->startFrame(outer);
        ++entry;
    }
}

void CameraPasses::startFrame(osgUtil::CullVisitor& outer)
{
    ++_frame;
    startFrame(_wholes, outer);
    startFrame(_parts, outer);
}

void CameraPasses::draw(osgUtil::CullVisitor& outer, const CompensatingCullVisitor::Task& task,
                        const ScenePass::Drawing& drawing)
{
    const CompensatingCullVisitor::Task pass = taskOf(task, drawing);
    if (drawing.filter)
        of(_parts, drawing.program, outer).run(outer, pass, *drawing.filter);
    else
        of(_wholes, drawing.program, outer).run(outer, pass);
}

void CameraPasses::draw(osgUtil::CullVisitor& outer, const std::vector<ScenePass::Piece>& pieces,
                        const CompensatingCullVisitor::Task& task, const ScenePass::Drawing& drawing)
{
    CompensatingCullVisitor::Task pass = taskOf(task, drawing);
    // This pass culls nothing. Without compensation OSG would compute near and far planes from it.
    pass.compensate = true;
    of(_wholes, drawing.program, outer).run(outer, pieces, pass);
}

CameraPass::CameraPass(const Traversal& traversal, const Drawer& drawer, const Within* within)
    : ScenePass(traversal.outer, traversal.scene, traversal.view, *traversal.task.chain,
                *traversal.task.state, drawer.prefix, drawer.units, drawer.blocks, traversal.task.depth,
                traversal.task.colorFormat, traversal.task.compensate, traversal.passes.frame()),
      _traversal(traversal), _within(within)
{
}

osg::ref_ptr<osg::Program> CameraPass::program(const PassShaders& shaders) const
{
    if (!_within) return _traversal.programs.passProgramOf(_traversal.effects, shaders, prefix);
    PassShaders inner = shaders;
    inner.within = _within->shaders;
    inner.withinPrefix = _within->prefix;
    return _traversal.programs.passProgramOf(_traversal.effects, inner, prefix);
}

std::vector<DrawableCompanion*> CameraPass::companions(const PassShaders& shaders) const
{
    const Within within{std::make_shared<const PassShaders>(shaders), prefix};
    std::vector<DrawableCompanion*> result;
    for (const Drawer& drawer : _traversal.drawers)
    {
        if (drawer.prefix == prefix) continue;
        if (DrawableCompanion* companion = drawer.effect->companion(CameraPass(_traversal, drawer, &within)))
            result.push_back(companion);
    }
    return result;
}

osg::ref_ptr<osg::Program> CameraPass::sceneProgram() const
{
    return _traversal.programs.programOf(_traversal.effects);
}

void CameraPass::draw(const Drawing& drawing) const
{
    CompensatingCullVisitor::Task task = _traversal.task;
    osg::ref_ptr<osg::StateSet> addition;
    if (_traversal.shaderHost)
        addition =
            _traversal.programs.additionOf(*_traversal.shaderHost, _traversal.effects, drawing.program);
    task.shaderHost = addition ? _traversal.shaderHost : nullptr;
    task.hostAddition = addition;
    _traversal.passes.draw(outer, task, drawing);
}

void CameraPass::draw(const std::vector<Piece>& pieces, const Drawing& drawing) const
{
    _traversal.passes.draw(outer, pieces, _traversal.task, drawing);
}

} // namespace osgGeoFX
