// SPDX-License-Identifier: MIT
// SPDX-FileCopyrightText: 2026 the osgGeoFX authors
#include <osgGeoFX/closeup/detail/RegionPass.h>

#include <algorithm>
#include <cmath>
#include <numeric>

namespace osgGeoFX
{

namespace
{

PassShaders plainShaders(unsigned int binding)
{
    PassShaders shaders;
    shaders.vertex = {"stages/closeup.items.glsl", "stages/closeup.vert.glsl"};
    shaders.fragment = {"stages/closeup.items.glsl", "stages/closeup.frag.glsl"};
    shaders.blocks = {{"Items", binding}};
    shaders.varyings = {{"vec2", "surface"}, {"vec3", "place"}};
    return shaders;
}

PassShaders amplifyingShaders(unsigned int binding, bool tessellated)
{
    PassShaders shaders = plainShaders(binding);
    shaders.geometry = {"stages/closeup.items.glsl", "stages/closeup.geom.glsl"};
    if (tessellated)
    {
        shaders.tessellationControl = {"stages/closeup.items.glsl", "stages/closeup.tesc.glsl"};
        shaders.tessellationEvaluation = {"stages/closeup.tese.glsl"};
    }
    return shaders;
}

PassShaders fenceShaders(unsigned int binding)
{
    PassShaders shaders = plainShaders(binding);
    shaders.vertexMain = "stages/closeup.fence.vert";
    shaders.fragmentMain = "stages/closeup.fence.frag";
    return shaders;
}

/// Whether culling is on. If OSG's own is off, everything is drawn for all regions.
bool culls(const ScenePass& pass)
{
    return pass.compensate && (pass.outer.getCullingMode() & osg::CullSettings::VIEW_FRUSTUM_CULLING) != 0;
}

/// Engines draw a whole terrain as one drawable, whose bounds say nothing of the heights over a region. Nothing there is
/// much higher or lower than the ground that they state.
void limitHeights(const Ground& ground, const RegionOfInterest& region, RegionContents& found)
{
    if (!ground.heightsKnown || found.empty()) return;
    constexpr double ofThings = 500.0;
    const double base = region.getBaseHeight();
    const double size = std::hypot(region.getWidth(), region.getDepth());
    const double radius = ground.ellipsoid ? ground.ellipsoid->getRadiusPolar() : HUGE_VAL;
    const double drop = size * size / (2.0 * radius); // the Earth's curve below the region's plane
    found.lowest = std::max(found.lowest, ground.minHeight - base - drop - ofThings);
    found.highest = std::min(found.highest, ground.maxHeight - base + ofThings);
}

} // namespace

RegionPass::RegionPass(const ScenePass& scenePass, const CloseUpTask& task, CloseUpTraversal& needed,
                       const std::vector<CloseUpItem>& closeUps, bool tessellates)
    : pass(scenePass), traversal(needed), items(closeUps),
      companions(pass.companions(plainShaders(task.binding))), _task(task), _tessellated(tessellates)
{
}

void RegionPass::choosePrograms(bool copies)
{
    _amplified = copies || _tessellated;
    traversal.program = pass.program(_amplified ? amplifyingShaders(_task.binding, _tessellated)
                                                : plainShaders(_task.binding));
    traversal.fenceProgram = pass.program(fenceShaders(_task.binding));
}

void RegionPass::simplify()
{
    if (!_amplified) return;
    _amplified = false;
    _tessellated = false;
    traversal.program = pass.program(plainShaders(_task.binding));
}

RegionSurvey RegionPass::run(std::vector<std::size_t> wanted, const RegionFilter::StatesOf& statesOf,
                             osgUtil::RenderStage* stage, const DeformationChain* chain,
                             bool accompanied) const
{
    RegionFilter filter(items, std::move(wanted), culls(pass), traversal.copies, _tessellated, statesOf);
    ScenePass::Drawing drawing{traversal.program, &traversal.states.base(), stage, chain, &filter};
    if (accompanied) drawing.companions = &companions;
    pass.draw(drawing);
    for (std::size_t i = 0; i < items.size(); ++i)
        limitHeights(pass.view.ground, *items[i].closeUp().getRegion(), filter.found.contents[i]);
    return std::move(filter.found);
}

RegionSurvey RegionPass::survey(const RegionFilter::StatesOf& statesOf, osgUtil::RenderStage* stage) const
{
    std::vector<std::size_t> all(items.size());
    std::iota(all.begin(), all.end(), std::size_t{0});
    return run(std::move(all), statesOf, stage, nullptr, false);
}

void RegionPass::draw(const VisibleCloseUp& visible, std::size_t which, const DeformationChain& chain,
                      RegionContents& found)
{
    osg::StateSet* const state = &traversal.states.layer(visible.item, which);
    const RegionSurvey drawn = run(
        {visible.item},
        [&](const std::vector<std::size_t>& touched, std::vector<osg::StateSet*>& states)
        {
            if (!touched.empty()) states.push_back(state);
        },
        visible.stages[which], &chain, which == 0);
    found.lowest = std::min(found.lowest, drawn.contents[visible.item].lowest);
    found.highest = std::max(found.highest, drawn.contents[visible.item].highest);
    drawables += static_cast<int>(drawn.count);
}

void RegionPass::drawFence(const VisibleCloseUp& visible, const RegionContents& found)
{
    const CloseUpItem& item = items[visible.item];
    const double width = item.closeUp().getAnchor()->getLineWidth();
    if (!item.fenced() && width <= 0.0) return;
    ContourFence& fence = traversal.fences[visible.item];
    if (!fence.update(*item.closeUp().getRegion(), found.ground)) return;
    if (!traversal.fenceProgram) return;
    std::vector<ScenePass::Piece> pieces;
    const auto add = [&](osg::Geometry* geometry, std::size_t which)
    {
        osg::StateSet& state = traversal.states.fence(visible.item, which);
        const auto on =
            osg::StateAttribute::ON | osg::StateAttribute::OVERRIDE | osg::StateAttribute::PROTECTED;
        state.merge(traversal.states.layer(visible.item, 1));
        state.setAttributeAndModes(traversal.fenceProgram, on);
        state.setMode(GL_CULL_FACE, osg::StateAttribute::OFF | osg::StateAttribute::OVERRIDE |
                                        osg::StateAttribute::PROTECTED);
        state.setMode(GL_DEPTH_TEST, on);
        const osg::Viewport& window = *pass.outer.getViewport();
        const double pixels = std::max(width, 1.0 / _task.samples);
        state.getOrCreateUniform(pass.prefix + "band", osg::Uniform::FLOAT_VEC2)
            ->set(osg::Vec2(osg::Vec2d(pixels / window.width(), pixels / window.height())));
        pieces.push_back({geometry, item.regionToEye(), &state});
    };
    if (item.fenced()) add(fence.wall(), 0);
    if (width > 0.0) add(fence.line(), 1);
    ScenePass::Drawing drawing;
    drawing.state = &traversal.states.base();
    drawing.stage = visible.stages[1];
    pass.draw(pieces, drawing);
    drawables += static_cast<int>(pieces.size());
}

} // namespace osgGeoFX
