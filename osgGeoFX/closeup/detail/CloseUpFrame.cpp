// SPDX-License-Identifier: MIT
// SPDX-FileCopyrightText: 2026 the osgGeoFX authors
#include <osgGeoFX/closeup/detail/CloseUpFrame.h>

#include <osgGeoFX/effect/DrawableCompanion.h>

#include <osgGeoFX/closeup/detail/CloseUpExtent.h>
#include <osgGeoFX/closeup/detail/MultiPass.h>
#include <osgGeoFX/closeup/detail/SinglePass.h>
#include <osgGeoFX/scene/detail/GpuLimits.h>

#include <algorithm>
#include <cmath>

namespace osgGeoFX
{

namespace
{

std::vector<CloseUpItem> itemsOf(const ScenePass& pass, const CloseUpTask& task)
{
    std::vector<CloseUpItem> items;
    const osg::FrameStamp* stamp = pass.outer.getFrameStamp();
    const double time = stamp ? stamp->getSimulationTime() : 0.0;
    for (const osg::ref_ptr<CloseUp>& closeUp : task.closeUps)
        items.emplace_back(*closeUp, pass.view, pass.view.modelView, pass.chain, time);
    return items;
}

bool tessellates(const ScenePass& pass, const CloseUpTask& task, const std::vector<CloseUpItem>& items)
{
    return task.tessellation > 1 && GpuLimits::of(pass.outer).version >= 4.0f &&
           std::any_of(items.begin(), items.end(),
                       [](const CloseUpItem& item) { return item.wantsVertices(); });
}

/// The direction to the sun in the frame of the surface data: x east, y north, z up. The region's own axes stand for
/// these.
osg::Vec3d sunOf(const CloseUp& closeUp)
{
    const double azimuth = closeUp.getSunAzimuth() + closeUp.getRegion()->getHeading();
    const double level = std::cos(closeUp.getSunElevation());
    return {level * std::sin(azimuth), level * std::cos(azimuth), std::sin(closeUp.getSunElevation())};
}

} // namespace

CloseUpFrame::CloseUpFrame(const ScenePass& pass, const CloseUpTask& task, CloseUpTraversal& traversal,
                           CloseUpCompositor& compositor)
    : _pass(pass), _task(task), _traversal(traversal), _compositor(compositor), _items(itemsOf(pass, task)),
      _perArray(std::max(2, std::min(task.maxLayers, GpuLimits::of(pass.outer).textureLayers) / 2 * 2)),
      _regions(pass, task, traversal, _items, tessellates(pass, task, _items))
{
}

std::string CloseUpFrame::cull(Outlook& outlook)
{
    prepare();
    choosePipeline(outlook);
    survey(outlook);
    place();
    if (_visible.empty()) return _sentence;
    allocate();
    draw();
    _compositor.compose(_pass, _task, _items, _visible, _traversal.layers);
    return _sentence;
}

void CloseUpFrame::prepare()
{
    _traversal.fences.resize(_items.size());
    _traversal.states.setUp(_pass, _task, _items, _regions.tessellated());
}

bool CloseUpFrame::singleIsCheaper(const Outlook& outlook) const
{
    // The geometry stage costs more than another pass over a few drawables. It pays only if several passes would draw
    // the same ones.
    constexpr double worthIt = 1.8;
    const bool magnified =
        std::any_of(_items.begin(), _items.end(),
                    [](const CloseUpItem& item)
                    { return std::max(item.closeUp().getScaleX(), item.closeUp().getScaleY()) > 1.0; });
    return outlook.sharing >= worthIt && !(outlook.levels && magnified);
}

void CloseUpFrame::choosePipeline(const Outlook& outlook)
{
    const bool wanted = _task.pipeline == CloseUps::SINGLE_PASS ||
                        (_task.pipeline == CloseUps::AUTOMATIC && singleIsCheaper(outlook));
    const bool fits = 2 * _items.size() <= static_cast<std::size_t>(_perArray);
    if (wanted && fits && _regions.companions.empty())
        _pipeline = std::make_unique<SinglePass>(_regions);
    else
        _pipeline = std::make_unique<MultiPass>(_regions);
    if (wanted && !fits)
        _sentence = "CloseUps has more layers than a texture array of this GPU (" +
                    std::to_string(_perArray) + "), so the multi-pass pipeline draws.";
    else if (_task.pipeline == CloseUps::SINGLE_PASS && !_regions.companions.empty())
        _sentence = "CloseUps shows the strokes of another effect, which are not made of triangles, so the "
                    "multi-pass "
                    "pipeline draws.";
}

void CloseUpFrame::survey(Outlook& outlook)
{
    _survey = _pipeline->survey();
    outlook = {_survey.levels, _survey.sharing()};
    if (_survey.foreign) _regions.simplify();
    if (_pipeline->takes(_survey)) return;
    _pipeline = std::make_unique<MultiPass>(_regions);
    if (_task.pipeline == CloseUps::SINGLE_PASS)
        _sentence = "Something in a close-up's region is not made of triangles or has a shader of its "
                    "own, so the multi-pass pipeline draws.";
}

void CloseUpFrame::place()
{
    double margin = 0.0;
    for (const DrawableCompanion* companion : _regions.companions)
        margin = std::max(margin, companion->reach());
    for (std::size_t i = 0; i < _items.size(); ++i)
    {
        const CloseUpItem& item = _items[i];
        RegionContents& found = _survey.contents[i];
        if (found.empty()) continue;
        // Finer tiles may be a little higher or lower.
        const double slack = 20.0 + 0.1 * (found.highest - found.lowest);
        if (!partOf(_pass, item, found.lowest - slack, found.highest + slack, found.longestEdge, margin,
                    true))
            continue;
        VisibleCloseUp visible;
        visible.item = i;
        _pipeline->draw(visible, found);
        const std::optional<PixelRectangle> part =
            partOf(_pass, item, found.lowest, found.highest, found.longestEdge, margin, true);
        if (!part) continue;
        visible.part = *part;
        visible.lifted = partOf(_pass, item, found.lowest, found.highest, found.longestEdge, margin, false);
        visible.layer = static_cast<int>(2 * _visible.size());
        _visible.push_back(visible);
        widenDepths(_pass, item, found.lowest, found.highest, found.longestEdge);
    }
}

void CloseUpFrame::allocate()
{
    int width = 1, height = 1;
    for (const VisibleCloseUp& visible : _visible)
    {
        width = std::max(width, visible.part.width);
        height = std::max(height, visible.part.height);
    }
    const int samples = _task.samples;
    _traversal.layers.resize(static_cast<int>(2 * _visible.size()), width * samples, height * samples,
                             _perArray, _pass.depth, _pass.colorFormat);
    CloseUpItems& values = _traversal.states.values;
    for (std::size_t i = 0; i < _items.size(); ++i)
        values.set(i, {}); // a close-up out of sight draws nothing
    const osg::Viewport& viewport = *_pass.outer.getViewport();
    for (const VisibleCloseUp& visible : _visible)
    {
        const CloseUpItem& item = _items[visible.item];
        const osg::Vec2d shift(-2.0 * visible.part.x / viewport.width(),
                               -2.0 * visible.part.y / viewport.height());
        CloseUpItem::Places places = _task.textures.places[visible.item];
        places.sun = sunOf(item.closeUp());
        values.set(visible.item, item.values(places, shift, visible.layer, visible.layer + 1, samples));
    }
}

void CloseUpFrame::draw()
{
    CloseUpStates& states = _traversal.states;
    const auto picture = CloseUpLayers::viewport(_pass.outer, -1, osg::Vec2i(), _task.samples);
    states.base().setAttribute(picture);
    _pipeline->handOver(picture);
    for (VisibleCloseUp& visible : _visible)
    {
        const osg::Vec2i corner(visible.part.x, visible.part.y);
        const auto moved = CloseUpLayers::viewport(_pass.outer, visible.layer, corner, _task.samples);
        _pipeline->finish(visible, _survey.contents[visible.item]);
        for (std::size_t which = 0; which < 2; ++which)
        {
            states.layer(visible.item, which).setAttribute(moved);
            states.fence(visible.item, which).setAttribute(moved);
            if (!visible.stages[which]) continue;
            _traversal.layers.draw(_pass.outer, *visible.stages[which],
                                   visible.layer + static_cast<int>(which), moved);
        }
    }
}

CloseUps::Statistics CloseUpFrame::statistics() const
{
    CloseUps::Statistics statistics;
    statistics.drawables = _regions.drawables;
    if (_visible.empty()) return statistics;
    statistics.pipeline = _pipeline->kind();
    statistics.closeUps = static_cast<int>(_visible.size());
    statistics.layers = static_cast<int>(2 * _visible.size());
    statistics.tessellated = _regions.tessellated();
    statistics.width = _traversal.layers.width();
    statistics.height = _traversal.layers.height();
    return statistics;
}

} // namespace osgGeoFX
