// SPDX-License-Identifier: MIT
// SPDX-FileCopyrightText: 2026 the osgGeoFX authors
#pragma once

#include <osgGeoFX/mapping/detail/MappingPage.h>

#include <cstddef>
#include <optional>
#include <unordered_map>
#include <vector>

namespace osgGeoFX
{

/// A part of the ground that a camera sees: a rectangle of the plane between two heights, metres.
struct SeenGround
{
    PlaneBox box;
    double lowest = 0.0, highest = 0.0;
};

/// What a PageCut asks about parts of the ground.
class PageSight
{
public:
    /// Whether no mapping lies over a part of the plane.
    virtual bool empty(const PlaneBox& box) = 0;
    /// Whether some of it may be in the picture.
    virtual bool shows(const SeenGround& ground) = 0;
    /// The largest texels, metres, that are as small as the picture's pixels everywhere on it.
    virtual double texel(const SeenGround& ground) = 0;

protected:
    ~PageSight() = default;
};

/** The pages that a picture needs: squares of a quadtree, which do not overlap. Each is the largest one whose texels are no
    larger than the pixels that show it. There are none where no mapping lies. It depends on what is seen alone, not on the
    order in which it was met, nor on what was drawn before. For one thread at a time. */
class PageCut
{
public:
    /// Nothing if the cut would have more than `most` pages. They are in the order of MappingPage, the coarsest first.
    std::optional<std::vector<MappingPage>> make(const std::vector<SeenGround>& seen, PageSight& sight,
                                                 std::size_t most);

private:
    struct Node
    {
        bool leaf = false;  ///< some of the ground needs it
        bool split = false; ///< some of the ground needs finer ones
    };
    void visit(const MappingPage& page, const SeenGround& ground);
    /// Whether something lies over a page; remembered.
    bool used(const MappingPage& page);

    PageSight* _sight = nullptr;
    std::size_t _most = 0;
    std::unordered_map<MappingPage, Node, MappingPageHash> _nodes;
    std::unordered_map<MappingPage, bool, MappingPageHash> _used;
};

} // namespace osgGeoFX
