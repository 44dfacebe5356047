// SPDX-License-Identifier: MIT
// SPDX-FileCopyrightText: 2026 the osgGeoFX authors
#pragma once

#include <osgUtil/RenderBin>

#include <vector>

namespace osgGeoFX
{

/** Puts the tiles and towns that a cull traversal adds to a bin into the order of distances, so that what is near hides what is far
    before that is shaded.

    OSG draws states in the order in which the traversal came by. Where two surfaces have equal depths, that order tells which one
    is seen, so an application's things keep it, and nothing goes past them. The surfaces of a database of the kit's builder meet
    at edges alone. Among these, what shares the state of a group is drawn first, for buildings stand before the ground. Tiles
    follow, by the distance of their frames. The drawables of one state are in the order of the distances of their boxes. A state
    that blends, or has a depth test of its own, keeps them where they are.

    A tile's place does not depend on what else is in sight, and its divided parts come after the others, so pictures with and without
    culling are the same to the last bit. Not thread-safe. */
class NearestFirst
{
public:
    /// Before the traversal. Bins that a host has sorted otherwise stay as they are.
    explicit NearestFirst(osgUtil::RenderBin& bin);

    /// After it.
    void sort();

private:
    using Graphs = std::vector<osgUtil::StateGraph*>;

    osgUtil::RenderBin& _bin;
    Graphs _before; ///< sorted by address
    bool _sorts = false;
};

} // namespace osgGeoFX
