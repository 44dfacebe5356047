// SPDX-License-Identifier: MIT
// SPDX-FileCopyrightText: 2026 the osgGeoFX authors
#include <osgGeoFX/closeup/detail/CloseUpCompositor.h>

#include <osgGeoFX/effect/ShaderLibrary.h>

#include <algorithm>

namespace osgGeoFX
{

namespace
{

using Turn = CloseUpLayers::Turn;
using Others = std::vector<CloseUpLayers::Other>;
using AllVisible = std::vector<VisibleCloseUp>;

enum class What
{
    All,
    Covered, // fragments that hide everything behind them
    Edges    // fragments with something behind them that shows
};

/// One camera's picture while layers are put into it.
struct Composition
{
    const ScenePass& pass;
    const CloseUpTask& task;
    const std::vector<CloseUpItem>& items;
    CloseUpLayers& layers;
    osg::Program* program;

    void putInOrder(const AllVisible& all) const;
    void putByDepth(const AllVisible& all) const;
    void put(const VisibleCloseUp& visible, What what, Turn turn = Turn::Any,
             const Others& others = {}) const;
    void putAnchor(const VisibleCloseUp& visible, Turn turn = Turn::Any, const Others& others = {}) const;
    double coverOf(const VisibleCloseUp& visible) const;
    AllVisible farthestFirst(const AllVisible& all) const;
    std::vector<Others> overlapping(const AllVisible& sorted) const;
};

/// The alpha above which a fragment covers what is behind it. The edges' alpha lies below; alpha is rounded to 255
/// steps.
double Composition::coverOf(const VisibleCloseUp& visible) const
{
    return 0.985 * items[visible.item].closeUp().getOpacity();
}

void Composition::put(const VisibleCloseUp& visible, What what, Turn turn, const Others& others) const
{
    const CloseUpItem& item = items[visible.item];
    if (!item.showsCloseUp() || !visible.lifted) return;
    const double covered = coverOf(visible);
    layers.show(pass.outer, program, pass.depth,
                {visible.layer, *visible.lifted, osg::Vec2i(visible.part.x, visible.part.y), task.samples,
                 task.opacity, task.depthTest, what != What::Edges, what == What::Covered ? covered : 0.0,
                 what == What::Edges ? covered : 1.0, turn, visible.layer + 1, others});
}

void Composition::putAnchor(const VisibleCloseUp& visible, Turn turn, const Others& others) const
{
    if (!items[visible.item].marksGround()) return;
    layers.show(pass.outer, program, pass.depth,
                {visible.layer + 1, visible.part, osg::Vec2i(visible.part.x, visible.part.y), task.samples,
                 task.opacity, task.depthTest, false, 0.0, 1.0, turn, -1, others});
}

void Composition::putInOrder(const AllVisible& all) const
{
    for (const VisibleCloseUp& visible : all)
    {
        putAnchor(visible);
        put(visible, What::All);
    }
}

/// Sorts by the depth of the close-ups' centers.
AllVisible Composition::farthestFirst(const AllVisible& all) const
{
    AllVisible sorted = all;
    const auto depthOf = [&](const VisibleCloseUp& visible)
    {
        const CloseUpItem& item = items[visible.item];
        return item.lifted(item.regionToEye().getTrans()).z();
    };
    std::stable_sort(sorted.begin(), sorted.end(),
                     [&](const VisibleCloseUp& one, const VisibleCloseUp& other)
                     { return depthOf(one) < depthOf(other); });
    return sorted;
}

/// For each close-up, those that come later and may cross it.
std::vector<Others> Composition::overlapping(const AllVisible& sorted) const
{
    std::vector<Others> others(sorted.size());
    for (std::size_t i = 0; i < sorted.size(); ++i)
    {
        for (std::size_t k = i + 1; k < sorted.size(); ++k)
        {
            const VisibleCloseUp& other = sorted[k];
            if (sorted[i].part.overlaps(other.part) && layers.together(sorted[i].layer, other.layer))
                others[i].push_back({other.layer, other.part, osg::Vec2i(other.part.x, other.part.y),
                                     items[other.item].showsCloseUp() ? coverOf(other) : 0.0});
        }
    }
    return others;
}

void Composition::putByDepth(const AllVisible& all) const
{
    const AllVisible sorted = farthestFirst(all);
    for (const VisibleCloseUp& visible : sorted)
        put(visible, What::Covered);
    // Anchors and edges keep no depth. They come in this order, since an edge with a depth would hide its own anchor
    // and leave a pale line between them. Where they cross those of a later close-up, the nearer pixels wait for it.
    // This is right for any two close-ups.
    const std::vector<Others> others = overlapping(sorted);
    for (const Turn turn : {Turn::First, Turn::Second})
    {
        for (std::size_t i = 0; i < sorted.size(); ++i)
        {
            if (turn == Turn::Second && others[i].empty()) continue;
            putAnchor(sorted[i], turn, others[i]);
            put(sorted[i], What::Edges, turn, others[i]);
        }
    }
}

} // namespace

void CloseUpCompositor::compose(const ScenePass& pass, const CloseUpTask& task,
                                const std::vector<CloseUpItem>& items,
                                const std::vector<VisibleCloseUp>& visible, CloseUpLayers& layers)
{
    if (!_program)
        _program = ShaderLibrary::createProgram("osgGeoFX layer", "stages/closeup.layer.vert",
                                                "stages/closeup.layer.frag");
    if (!_program) return;
    const Composition picture = {pass, task, items, layers, _program};
    if (!task.depthTest)
        picture.putInOrder(visible);
    else if (visible.size() == 1 && !items[visible.front().item].marksGround())
        picture.put(visible.front(), What::All);
    else
        picture.putByDepth(visible);
}

void CloseUpCompositor::resizeGLObjectBuffers(unsigned int size)
{
    osg::resizeGLObjectBuffers(_program, size);
}

void CloseUpCompositor::releaseGLObjects(osg::State* state) const
{
    if (_program) _program->releaseGLObjects(state);
}

} // namespace osgGeoFX
