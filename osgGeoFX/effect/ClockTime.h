// SPDX-License-Identifier: MIT
// SPDX-FileCopyrightText: 2026 the osgGeoFX authors
#pragma once

#include <osgGeoFX/Export.h>

#include <optional>
#include <string>

namespace osgGeoFX
{

/// A point in time, and the clock by which people there read it.
/// @ingroup effect
struct ClockTime
{
    double time = 0.0; ///< seconds since 1970-01-01T00:00:00Z
    int zone = 0;      ///< what the clock is ahead of UTC, seconds

    bool operator==(const ClockTime& other) const { return time == other.time && zone == other.zone; }
    bool operator!=(const ClockTime& other) const { return !(*this == other); }
};

/** Reads `2026-06-21T08:00:00-10:00` (ISO 8601): the zone is "Z" or hours and minutes from -14:00 to 14:00; seconds may have
    a fraction, or be left out. Nothing if the text is no such time, or the month has no such day. Any thread may call it. */
OSGGEOFX_EXPORT std::optional<ClockTime> readClockTime(const std::string& text);

/// What readClockTime() reads, in whole seconds, rounded. Any thread may call it.
OSGGEOFX_EXPORT std::string textOf(const ClockTime& time);

} // namespace osgGeoFX
