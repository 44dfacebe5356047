// SPDX-License-Identifier: MIT
// SPDX-FileCopyrightText: 2026 the osgGeoFX authors
#include <osgGeoFX/mapping/detail/PageResidency.h>

#include <algorithm>
#include <cmath>
#include <set>

namespace osgGeoFX
{

namespace
{

/// Coarser pages that are kept beside a cut, to show while finer ones are drawn: levels above its own.
constexpr int backing[] = {2, 4};
/// A page is drawn again so many frames after the last change below it, where changes are too large to be followed.
constexpr std::uint64_t restFrames = 3;

} // namespace

PageResidency::PageResidency(int slots) : _slots(slots)
{
    clear();
}

void PageResidency::clear()
{
    _pages.clear();
    _free.clear();
    // The lowest slot is taken first.
    for (int slot = _slots - 1; slot > 0; --slot)
        _free.push_back(slot);
}

void PageResidency::change(const PlaneBox& box)
{
    for (auto& [key, page] : _pages)
    {
        // Edges and filters reach a texel or two beyond.
        const PlaneBox part = box.grown(2.0 * key.texel()).within(key.whole());
        if (part.empty()) continue;
        page.stale = page.stale ? page.stale->with(part) : part;
        page.changed = _frame + 1;
    }
}

std::int64_t PageResidency::texelsOf(const MappingPage& page, const PlaneBox& part)
{
    const osg::Vec2d size = (part.high - part.low) / page.texel();
    return static_cast<std::int64_t>(std::ceil(size.x()) * std::ceil(size.y()));
}

std::optional<int> PageResidency::takeSlot()
{
    if (_free.empty())
    {
        const auto oldest =
            std::min_element(_pages.begin(), _pages.end(),
                             [](const auto& a, const auto& b) { return a.second.needed < b.second.needed; });
        if (oldest == _pages.end() || oldest->second.needed == _frame) return std::nullopt;
        _free.push_back(oldest->second.slot);
        _pages.erase(oldest);
    }
    const int slot = _free.back();
    _free.pop_back();
    return slot;
}

PageResidency::Entry PageResidency::find(const MappingPage& page)
{
    const Entry known = _pages.find(page);
    if (known != _pages.end()) return known;
    const std::optional<int> slot = takeSlot();
    if (!slot) return _pages.end();
    Page made;
    made.slot = *slot;
    made.needed = _frame;
    made.stale = page.whole();
    return _pages.emplace(page, made).first;
}

void PageResidency::draw(Entry entry, Frame& frame, std::int64_t& left)
{
    Page& page = entry->second;
    left -= texelsOf(entry->first, *page.stale);
    frame.pieces.push_back({entry->first, page.slot, *page.stale});
    page.stale.reset();
    page.drawn = true;
}

bool PageResidency::findSources(const std::vector<MappingPage>& cut, Frame& frame) const
{
    for (const MappingPage& wanted : cut)
    {
        MappingPage page = wanted;
        auto found = _pages.find(page);
        while (page.level < MappingPage::coarsest && (found == _pages.end() || !isCurrent(found->second)))
        {
            page = page.parent();
            found = _pages.find(page);
        }
        if (found == _pages.end() || !isCurrent(found->second)) return false;
        frame.coarsest = std::max(frame.coarsest, page.level - wanted.level);
        frame.sources.push_back({wanted, page, found->second.slot});
    }
    return true;
}

PageResidency::Frame PageResidency::plan(const std::vector<MappingPage>& cut, const Budget& budget)
{
    ++_frame;
    Frame frame;
    std::set<MappingPage> wanted(cut.begin(), cut.end());
    for (const MappingPage& page : cut)
    {
        for (const int levels : backing)
        {
            if (page.level + levels <= MappingPage::coarsest) wanted.insert(page.above(levels));
        }
    }
    frame.fits = static_cast<int>(wanted.size()) < _slots;
    if (!frame.fits) return frame;
    for (const MappingPage& page : wanted)
    {
        const Entry known = _pages.find(page);
        if (known != _pages.end()) known->second.needed = _frame;
    }
    // What has changed below pages that are shown is drawn at once, or the pages are not shown.
    std::vector<Entry> changed;
    std::int64_t texels = 0, missing = 0;
    for (const MappingPage& page : cut)
    {
        const Entry known = _pages.find(page);
        if (known == _pages.end() || !known->second.drawn)
            missing += texelsOf(page, page.whole());
        else if (known->second.stale)
        {
            changed.push_back(known);
            texels += texelsOf(page, *known->second.stale);
        }
    }
    std::int64_t left = budget.changes;
    if (texels <= budget.changes && (budget.shown || missing <= budget.others))
    {
        for (const Entry entry : changed)
            draw(entry, frame, left);
    }
    left = budget.others;
    for (const MappingPage& page : wanted)
    {
        if (left <= 0) break;
        const Entry entry = find(page);
        if (entry == _pages.end() || !entry->second.stale) continue;
        if (entry->second.drawn && entry->second.changed + restFrames > _frame) continue;
        draw(entry, frame, left);
    }
    frame.complete = findSources(cut, frame);
    frame.settled = frame.complete && frame.coarsest == 0;
    return frame;
}

} // namespace osgGeoFX
