// SPDX-License-Identifier: MIT
// SPDX-FileCopyrightText: 2026 the osgGeoFX authors
#pragma once

#include <optional>
#include <string>

namespace osgGeoFX
{

/// The unit of times, from a text such as "hours since 2026-01-12 06:00:00".
struct TimeUnit
{
    double seconds = 1.0; ///< of one unit; a mean for months and years
    int months = 0;       ///< of one unit, 1 or 12, if its length goes by the calendar; else 0
    double start = 0.0;   ///< seconds since 1970
    bool dated = true;    ///< not so of a year 0, which climatologies have: their years stand for any

    /// Nothing for other texts.
    static std::optional<TimeUnit> parse(const std::string& text);
    /// Seconds since 1970 of so many units. Months go by the calendar; a part of a month is a part of its days.
    double timeOf(double count) const;
};

/// Whether a dimension of this name counts times, as the models of weather and of the sea write it, in any case.
bool isTimeDimension(const std::string& name);

/** The date in a file's name or in a band's description, seconds since 1970; nothing if there is none.

    A date is eight digits, year, month and day, alone or with the same mark between them. A time of day may follow: hour and
    minute, perhaps seconds. If a text has several dates, the first counts: of a satellite's picture that is the day when it was
    taken. Without a date, a year and a month count, "2026-01" or "202601". */
std::optional<double> dateIn(const std::string& text);

/// Whether a name stands before another one, with the numbers in them by value: step_2 before step_10.
bool standsBefore(const std::string& a, const std::string& b);

} // namespace osgGeoFX
