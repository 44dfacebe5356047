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

/// What was found over a region.
struct RegionContents
{
    double lowest = std::numeric_limits<double>::infinity(); ///< metres above the region's base
    double highest = -std::numeric_limits<double>::infinity();
    /// Of the triangles there, metres: what is stretched reaches that far beyond the region.
    double longestEdge = 0.0;
    std::vector<ContourFence::Ground> ground;

    bool empty() const { return !(lowest <= highest); }
};

/// What was found over regions.
struct RegionSurvey
{
    /// Regions that a drawable over any of them touches on average; 1 where that says nothing.
    double sharing() const { return drawables > 0 && !foreign ? 1.0 * touches / drawables : 1.0; }

    /// Of all items; those that are not wanted have found nothing.
    std::vector<RegionContents> contents;
    bool foreign = false;       ///< something is not made of triangles or has shaders of its own
    bool levels = false;        ///< something has levels of detail
    unsigned int touches = 0;   ///< regions that drawables touch, summed up
    unsigned int drawables = 0; ///< that touch any
    unsigned int count = 0;     ///< drawables drawn, once for each state
};

/// Wants what lies over any of the regions, and remembers it.
class RegionFilter final : public PassFilter
{
public:
    /// `state` names what a drawable is drawn with, for the items that it touches; it may name nothing. Without
    /// `culls`, all drawables touch all regions.
    using StatesOf =
        std::function<void(const std::vector<std::size_t>& items, std::vector<osg::StateSet*>& states)>;
    /// `copies` are drawn in the place of drawables, as patches where `patches` are wanted.
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
    std::vector<TriangleCopies::Region> _places;
    std::vector<osg::StateSet*> _states;
};

} // namespace osgGeoFX
