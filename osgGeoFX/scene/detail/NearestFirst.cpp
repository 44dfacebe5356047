// SPDX-License-Identifier: MIT
// SPDX-FileCopyrightText: 2026 the osgGeoFX authors
#include <osgGeoFX/scene/detail/NearestFirst.h>

#include <osgGeoFX/effect/Tessellation.h>
#include <osgGeoFX/effect/detail/TileNormals.h>
#include <osgGeoFX/effect/detail/TownState.h>

#include <osg/Depth>

#include <algorithm>
#include <tuple>
#include <unordered_map>
#include <utility>

namespace osgGeoFX
{

namespace
{

/// Whether what has this state may be drawn in any order where no two surfaces have equal depths, as far as this state tells.
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

/// Whether a state is that of a tile or a town of the kit's builder.
bool isBuilt(const osg::StateSet& state)
{
    const auto named = [&](unsigned int unit, const char* name)
    {
        const osg::StateAttribute* texture = state.getTextureAttribute(unit, osg::StateAttribute::TEXTURE);
        return texture && texture->getName() == name;
    };
    return named(TileNormals::unit, TileNormals::texture) || named(0, TownState::texture);
}

/// What the states from the root down to a graph tell. Most graphs share those above.
class Orders
{
public:
    /// Whether any order will do.
    bool any(const osgUtil::StateGraph& graph)
    {
        const Known known = of(&graph);
        return known.built && known.admits;
    }

private:
    struct Known
    {
        bool admits = true;
        bool built = false;
    };
    Known of(const osgUtil::StateGraph* graph)
    {
        if (!graph) return {};
        const auto entry = _known.find(graph);
        if (entry != _known.end()) return entry->second;
        Known known = of(graph->_parent);
        if (const osg::StateSet* state = graph->getStateSet())
        {
            known.admits = known.admits && admitsAnyOrder(*state);
            known.built = known.built || isBuilt(*state);
        }
        return _known[graph] = known;
    }

    std::unordered_map<const osgUtil::StateGraph*, Known> _known;
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

void sortGraphs(std::vector<osgUtil::StateGraph*>::iterator begin,
                std::vector<osgUtil::StateGraph*>::iterator end)
{
    struct Entry
    {
        double distance; ///< squared, of a tile's frame; nothing in sight or out of it changes it
        bool divided;
        osgUtil::StateGraph* graph;
    };
    std::vector<Entry> entries;
    for (auto graph = begin; graph != end; ++graph)
    {
        const osgUtil::RenderLeaf& first = *(*graph)->_leaves.front();
        const double distance =
            hasOwnState(first) && first._modelview ? first._modelview->getTrans().length2() : -1.0;
        entries.push_back({distance, isDivided(first), *graph});
        sortLeaves((*graph)->_leaves);
    }
    std::stable_sort(entries.begin(), entries.end(),
                     [](const Entry& a, const Entry& b)
                     { return std::tie(a.distance, a.divided) < std::tie(b.distance, b.divided); });
    std::transform(entries.begin(), entries.end(), begin, [](const Entry& each) { return each.graph; });
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
    Graphs& graphs = _bin.getStateGraphList();
    Orders orders;
    const auto stays = [&](osgUtil::StateGraph* graph)
    {
        return graph->_leaves.empty() || std::binary_search(_before.begin(), _before.end(), graph) ||
               !orders.any(*graph);
    };
    // Nothing goes past what stays.
    for (auto begin = graphs.begin(); begin != graphs.end();)
    {
        begin = std::find_if_not(begin, graphs.end(), stays);
        const auto end = std::find_if(begin, graphs.end(), stays);
        sortGraphs(begin, end);
        begin = end;
    }
}

} // namespace osgGeoFX
