// SPDX-License-Identifier: MIT
// SPDX-FileCopyrightText: 2026 the osgGeoFX authors
#pragma once

#include <osgGeoFX/mapping/RoutePath.h>

#include <cstddef>

namespace osgGeoFX
{

/** Takes lost fixes out of a way: places that a receiver without a view of the sky wrote.

    In any way of three places or more these are places at exactly 0, 0 that lie 100 km or more from all others. In tracks (not
    `wayPoints`), which have a place every few seconds, these are also up to ten places in a row far from where the way goes on: the
    jumps there and back are above 5 km and 50 times the median step, and the way's ends of the gap are near each other. At the
    beginning and the end of a track, where nothing tells the way back, the jump is above 50 km and 1,000 times the median step.
    Returns their number. Two places stay at least. Thread-safe. */
std::size_t takeOutLostFixes(RoutePath& way);

} // namespace osgGeoFX
