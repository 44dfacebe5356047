// SPDX-License-Identifier: MIT
// SPDX-FileCopyrightText: 2026 the osgGeoFX authors
#pragma once

#include <osgGeoFX/mapping/detail/MappingPage.h>

#include <cstdint>
#include <map>
#include <optional>
#include <vector>

namespace osgGeoFX
{

/** Which pages have a slot in the texture, and what of them is to be drawn in a frame. Slot 0 stays blank.

    The pages of the last frames stay; the one that was needed longest ago goes first. For one thread at a time. */
class PageResidency
{
public:
    explicit PageResidency(int slots);

    /// The texels that a frame may draw.
    struct Budget
    {
        std::int64_t changes =
            0; ///< where mappings have changed below pages that are shown; all of them or none
        std::int64_t others = 0; ///< at least one page
        /// Whether changes are followed while pages are missing, too: where pages are shown, coarser ones stand in.
        bool shown = true;
    };
    /// A part of a page to draw.
    struct Piece
    {
        MappingPage page;
        int slot = 0;
        PlaneBox part;
    };
    /// What a page of the cut is shown by: itself, or a coarser page.
    struct Source
    {
        MappingPage wanted, page;
        int slot = 0;
    };
    struct Frame
    {
        bool fits = true;      ///< whether there are slots for all
        bool settled = false;  ///< all pages are as they should be
        bool complete = false; ///< each page has a source, if a coarser one
        int coarsest = 0;      ///< by how many levels sources are coarser, at most
        std::vector<Piece> pieces;
        std::vector<Source> sources; ///< one for each page of the cut, where it is complete
    };

    /// Something has changed within a box.
    void change(const PlaneBox& box);
    /// Nothing that was drawn holds any more.
    void clear();
    /// Chooses what to draw for a cut. What it chooses counts as drawn.
    Frame plan(const std::vector<MappingPage>& cut, const Budget& budget);

    int slots() const { return _slots; }
    int used() const { return static_cast<int>(_pages.size()); }

private:
    struct Page
    {
        int slot = 0;
        std::uint64_t needed = 0;      ///< the last frame that needed it
        std::uint64_t changed = 0;     ///< the last frame in which something below it changed
        bool drawn = false;            ///< whether it has ever been
        std::optional<PlaneBox> stale; ///< what must be drawn anew
    };
    using Pages = std::map<MappingPage, Page>;
    using Entry = Pages::iterator;

    bool isCurrent(const Page& page) const { return page.drawn && !page.stale; }
    static std::int64_t texelsOf(const MappingPage& page, const PlaneBox& part);
    /// The page, which is made if there is a slot for it.
    Entry find(const MappingPage& page);
    std::optional<int> takeSlot();
    void draw(Entry entry, Frame& frame, std::int64_t& left);
    bool findSources(const std::vector<MappingPage>& cut, Frame& frame) const;

    const int _slots;
    Pages _pages;
    std::vector<int> _free;
    std::uint64_t _frame = 0;
};

} // namespace osgGeoFX
