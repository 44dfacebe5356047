// SPDX-License-Identifier: MIT
// SPDX-FileCopyrightText: 2026 the osgGeoFX authors
#include <osgGeoFX/mapping/detail/PageCut.h>

#include <algorithm>
#include <map>

namespace osgGeoFX
{

bool PageCut::used(const MappingPage& page)
{
    const auto [found, isNew] = _used.try_emplace(page, false);
    if (isNew) found->second = !_sight->empty(page.whole());
    return found->second;
}

void PageCut::visit(const MappingPage& page, const SeenGround& ground)
{
    if (_nodes.size() > _most) return;
    const PlaneBox square = page.square();
    const SeenGround part{ground.box.within(square), ground.lowest, ground.highest};
    if (part.box.empty() || !used(page)) return;
    // What lies within one page is known to be in sight.
    if (!square.contains(ground.box) && !_sight->shows(part)) return;
    const bool fine = page.level <= MappingPage::finest || page.texel() <= _sight->texel(part);
    Node& node = _nodes[page];
    (fine ? node.leaf : node.split) = true;
    if (fine) return;
    for (int i = 0; i < 4; ++i)
        visit(page.child(i), part);
}

std::optional<std::vector<MappingPage>> PageCut::make(const std::vector<SeenGround>& seen, PageSight& sight,
                                                      std::size_t most)
{
    _sight = &sight;
    // With the nodes that are split.
    _most = 2 * most + 64;
    _nodes.clear();
    _used.clear();
    if (seen.empty()) return std::vector<MappingPage>();
    PlaneBox all = seen.front().box;
    for (const SeenGround& ground : seen)
        all = all.with(ground.box);
    const osg::Vec2d size = all.high - all.low;
    const double longest = std::max({size.x(), size.y(), MappingPage::sideOf(MappingPage::finest)});
    const int level = std::min(static_cast<int>(std::ceil(std::log2(longest))), MappingPage::coarsest);
    const double side = MappingPage::sideOf(level);
    const auto cell = [&](double metres)
    {
        return static_cast<std::int64_t>(std::floor(metres / side));
    };
    for (const SeenGround& ground : seen)
    {
        for (std::int64_t y = cell(ground.box.low.y()); y <= cell(ground.box.high.y()); ++y)
        {
            for (std::int64_t x = cell(ground.box.low.x()); x <= cell(ground.box.high.x()); ++x)
                visit({level, x, y}, ground);
        }
        if (_nodes.size() > _most) return std::nullopt;
    }
    // A page that some of the ground needs, and that is split for other ground, is split for all.
    std::map<MappingPage, Node> ordered(_nodes.begin(), _nodes.end());
    std::vector<MappingPage> cut;
    for (auto entry = ordered.begin(); entry != ordered.end(); ++entry)
    {
        if (!entry->second.leaf) continue;
        if (!entry->second.split)
        {
            cut.push_back(entry->first);
            continue;
        }
        for (int i = 0; i < 4; ++i)
        {
            const MappingPage child = entry->first.child(i);
            if (used(child)) ordered[child].leaf = true;
        }
    }
    if (cut.size() > most) return std::nullopt;
    return cut;
}

} // namespace osgGeoFX
