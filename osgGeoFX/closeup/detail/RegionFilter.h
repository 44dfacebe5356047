// SPDX-License-Identifier: MIT
// SPDX-FileCopyrightText: 2026 the osgGeoFX authors
#pragma once

#include <osgGeoFX/closeup/detail/CloseUpItem.h>
#include <osgGeoFX/closeup/detail/ContourFence.h>
#include <osgGeoFX/closeup/detail/TriangleCopies.h>
#include <osgGeoFX/effect/PassFilter.h>

#include <functional>
#include <limits>
#include <vector>

namespace osgGeoFX
{

/// What was found over one region.
struct RegionContents
{
    double lowest = std::numeric_limits<double>::infinity(); ///< metres above the region's base
    double highest = -std::numeric_limits<double>::infinity();
    /// The longest edge of the triangles there, metres. Stretched triangles reach that far beyond the region.
    double longestEdge = 0.0;
    std::vector<ContourFence::Ground> ground;

    bool empty() const { return !(lowest <= highest); }
};

/// What was found over all regions.
struct RegionSurvey
{
    /// How many regions a drawable over some region touches on average; 1 if the count tells nothing.
    double sharing() const { return drawables > 0 && !foreign ? 1.0 * touches / drawables : 1.0; }

    /// One entry for each item. Those of unwanted items are empty.
    std::vector<RegionContents> contents;
    bool foreign = false;       ///< something is not made of triangles or has shaders of its own
    bool levels = false;        ///< something has levels of detail
    unsigned int touches = 0;   ///< the sum of the regions that drawables touch
    unsigned int drawables = 0; ///< those that touch a region
    unsigned int count = 0;     ///< drawables drawn, once for each state
};

/// Selects what lies over any of the regions, and notes what it finds.
class RegionFilter final : public PassFilter
{
public:
    /// Adds the states that a drawable is drawn with, for the items that it touches; none for no drawing. Without
    /// `culls`, all drawables touch all regions.
    using StatesOf =
        std::function<void(const std::vector<std::size_t>& items, std::vector<osg::StateSet*>& states)>;
    /// `copies` are drawn in place of the drawables, as patches if `patches` is true.
    RegionFilter(const std::vector<CloseUpItem>& items, std::vector<std::size_t> wanted, bool culls,
                 TriangleCopies& copies, bool patches, StatesOf statesOf);

    bool outside(const Ball& ball) const override;
    const std::vector<osg::StateSet*>& states(const osg::Drawable& drawable, const EyeBox& box,
                                              const osg::Matrixd& modelView, bool ownProgram) override;
    void meet(const osg::LOD&) override { found.levels = true; }
    osg::Drawable* drawn(osg::Drawable& drawable) override;

    RegionSurvey found;

private:
    const std::vector<CloseUpItem>& _items;
    std::vector<std::size_t> _wanted;
    bool _culls;
    TriangleCopies& _copies;
    bool _patches;
    StatesOf _statesOf;
    std::vector<std::size_t> _touched;
    std::vector<std::size_t> _beyond; ///< what it does not touch and is drawn for, since nothing is culled
    std::vector<TriangleCopies::Region> _places;
    std::vector<osg::StateSet*> _states;
};

} // namespace osgGeoFX
