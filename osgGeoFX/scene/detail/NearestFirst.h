// SPDX-License-Identifier: MIT
// SPDX-FileCopyrightText: 2026 the osgGeoFX authors
#pragma once

#include <osgUtil/RenderBin>

#include <vector>

namespace osgGeoFX
{

/** Puts what a cull traversal adds to a bin into the order of distances, so that what is near hides what is far before that is shaded.

    OSG draws states in the order in which the traversal came by. Here what shares the state of a group is drawn first, for buildings and
    trees stand before the ground. Things with a state of their own follow, such as tiles, by the distance of their frames. The drawables of one state are in the
    order of the distances of their boxes. Only that is moved of which any order gives the same picture: without blending, and with a
    depth test that admits no equal depths. A tile's place does not depend on what else is in sight, and its divided parts come after the others, so pictures with and without
    culling are the same to the last bit. Where things in several frames share a state of their own, the first in sight counts for all: there pixels of
    equal depths may differ. Not thread-safe. */
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
