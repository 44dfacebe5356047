// SPDX-License-Identifier: MIT
// SPDX-FileCopyrightText: 2026 the osgGeoFX authors
#include <osgGeoFX/scene/detail/NearestFirst.h>

#include <osgGeoFX/effect/Tessellation.h>

#include <osg/Depth>

#include <algorithm>
#include <tuple>
#include <unordered_map>
#include <utility>

namespace osgGeoFX
{

namespace
{

/// Whether what has this state gives the same picture in any order, as far as this state tells.
bool admitsAnyOrder(const osg::StateSet& state)
{
    for (const GLenum mode : {GL_BLEND, GL_STENCIL_TEST})
        if (state.getMode(mode) & osg::StateAttribute::ON) return false;
    const osg::StateAttribute::GLModeValue test = state.getMode(GL_DEPTH_TEST);
    if (!(test & (osg::StateAttribute::ON | osg::StateAttribute::INHERIT))) return false;
    const auto* depth = dynamic_cast<const osg::Depth*>(state.getAttribute(osg::StateAttribute::DEPTH));
    return !depth || (depth->getWriteMask() && (depth->getFunction() == osg::Depth::LESS ||
                                                depth->getFunction() == osg::Depth::GREATER));
}

/// The same of all states above. Most graphs share them.
class Orders
{
public:
    bool any(const osgUtil::StateGraph* graph)
    {
        if (!graph) return true;
        const auto [entry, isNew] = _known.try_emplace(graph, false);
        if (!isNew) return entry->second;
        const bool result =
            (!graph->getStateSet() || admitsAnyOrder(*graph->getStateSet())) && any(graph->_parent);
        return _known[graph] = result;
    }

private:
    std::unordered_map<const osgUtil::StateGraph*, bool> _known;
};

/// From the eye to where the thing is undeformed.
double squaredDistance(const osgUtil::RenderLeaf& leaf)
{
    const osg::Vec3d middle = leaf._drawable->getBoundingBox().center();
    return (leaf._modelview ? middle * *leaf._modelview : middle).length2();
}

void sortLeaves(osgUtil::StateGraph::LeafList& leaves)
{
    if (leaves.size() < 2) return;
    std::vector<std::pair<double, osg::ref_ptr<osgUtil::RenderLeaf>>> placed;
    placed.reserve(leaves.size());
    for (const auto& leaf : leaves)
        placed.emplace_back(squaredDistance(*leaf), leaf);
    std::stable_sort(placed.begin(), placed.end(),
                     [](const auto& a, const auto& b) { return a.first < b.first; });
    for (std::size_t i = 0; i < leaves.size(); ++i)
        leaves[i] = placed[i].second;
}

/// Whether the GPU divides its triangles, with a program of their own. A tile may have such parts and others.
bool isDivided(const osgUtil::RenderLeaf& leaf)
{
    return &PatchGeometry::originalOf(*leaf._drawable) != leaf._drawable.get();
}

/// Tiles have a state each. What shares the state of a group stands on them, as buildings do.
bool hasOwnState(const osgUtil::RenderLeaf& leaf)
{
    return PatchGeometry::originalOf(*leaf._drawable).getStateSet() != nullptr;
}

} // namespace

NearestFirst::NearestFirst(osgUtil::RenderBin& bin)
    : _bin(bin), _sorts(bin.getSortMode() == osgUtil::RenderBin::SORT_BY_STATE && !bin.getSortCallback())
{
    if (!_sorts) return;
    _before = bin.getStateGraphList();
    std::sort(_before.begin(), _before.end());
}

void NearestFirst::sort()
{
    if (!_sorts) return;
    struct Entry
    {
        double distance; ///< squared, of a tile's frame; nothing in sight or out of it changes it
        bool divided;
        osgUtil::StateGraph* graph;
    };
    std::vector<Entry> entries;
    std::vector<std::size_t> slots;
    Graphs& graphs = _bin.getStateGraphList();
    Orders orders;
    for (std::size_t i = 0; i < graphs.size(); ++i)
    {
        auto& leaves = graphs[i]->_leaves;
        if (leaves.empty() || std::binary_search(_before.begin(), _before.end(), graphs[i])) continue;
        if (!orders.any(graphs[i])) continue;
        const osgUtil::RenderLeaf& first = *leaves.front();
        const double distance =
            hasOwnState(first) && first._modelview ? first._modelview->getTrans().length2() : -1.0;
        entries.push_back({distance, isDivided(first), graphs[i]});
        slots.push_back(i);
        sortLeaves(leaves);
    }
    std::stable_sort(entries.begin(), entries.end(),
                     [](const Entry& a, const Entry& b)
                     { return std::tie(a.distance, a.divided) < std::tie(b.distance, b.divided); });
    for (std::size_t i = 0; i < slots.size(); ++i)
        graphs[slots[i]] = entries[i].graph;
}

} // namespace osgGeoFX
