// SPDX-License-Identifier: MIT
// SPDX-FileCopyrightText: 2026 the osgGeoFX authors
#pragma once

#include "Field.h"

#include <functional>

namespace simulation
{

/** Land that goes under as the sea rises: a bath tub with connectivity. Water comes to a place only over ground that is under
    water, too, so low ground behind a ridge stays dry until the sea has climbed the ridge.

    The level at which each cell goes under is found once: the least of the highest ground on any way from the sea (a flood by a
    priority queue; Barnes, Lehman and Mulla 2014). So any level takes one look at each cell, and time may run backwards. Cells touch by
    their sides. */
class Flood
{
public:
    /// `heights`: metres above the sea. `isSea`: where it is already. Neither is kept.
    Flood(const Field& heights, const std::function<bool(int column, int row)>& isSea);

    /// The sea's level at which a cell goes under, metres; -infinity in the sea itself.
    const Field& levels() const { return _levels; }
    /// Writes the depth of the water over land, metres, for a level of the sea. Where the sea has to rise less than five metres more, it
    /// is negative: so filters find the shore between cells. Cells of the sea beside land have the sea's rise, so that no strip of land is
    /// left between both. NaN elsewhere. `image` has floats in one channel, and
    /// the grid's size.
    void draw(double level, osg::Image& image) const;
    /// Cells of land that are under water at a level.
    std::size_t flooded(double level) const;

private:
    void findShore();

    Field _heights, _levels;
    std::vector<bool> _sea, _shore;
};

} // namespace simulation
