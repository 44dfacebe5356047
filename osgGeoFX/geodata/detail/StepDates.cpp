// SPDX-License-Identifier: MIT
// SPDX-FileCopyrightText: 2026 the osgGeoFX authors
#include <osgGeoFX/geodata/detail/StepDates.h>

#include <osgGeoFX/mapping/LayerClock.h>

#include <cpl_time.h>
#include <osgDB/FileNameUtils>

#include <algorithm>
#include <cctype>
#include <cmath>
#include <cstdio>
#include <ctime>
#include <iterator>
#include <regex>

namespace osgGeoFX
{

namespace
{

constexpr double day = 86400.0;

struct NamedUnit
{
    const char* word;
    double seconds;
    int months;
};

constexpr NamedUnit units[] = {
    {"ns", 1e-9, 0},           {"nanosecond", 1e-9, 0},
    {"us", 1e-6, 0},           {"microsecond", 1e-6, 0},
    {"ms", 1e-3, 0},           {"msec", 1e-3, 0},
    {"millisecond", 1e-3, 0},  {"s", 1.0, 0},
    {"sec", 1.0, 0},           {"second", 1.0, 0},
    {"min", 60.0, 0},          {"minute", 60.0, 0},
    {"h", 3600.0, 0},          {"hr", 3600.0, 0},
    {"hour", 3600.0, 0},       {"d", day, 0},
    {"day", day, 0},           {"week", 7.0 * day, 0},
    {"mon", 30.4375 * day, 1}, {"month", 30.4375 * day, 1},
    {"yr", 365.25 * day, 12},  {"year", 365.25 * day, 12},
};

/// The second of 1970 of a day of the calendar; nothing if there is no such day.
std::optional<double> secondOf(int year, int month, int dayOfMonth)
{
    char date[16];
    std::snprintf(date, sizeof date, "%04d-%02d-%02d", year, month, dayOfMonth);
    return LayerClock::parseDate(date);
}

/// A time that lies so many whole months later, at the same day and hour of its month.
double monthsLater(double start, double months)
{
    std::tm at{};
    CPLUnixTimeToYMDHMS(static_cast<GIntBig>(std::floor(start)), &at);
    const auto total = static_cast<long>(at.tm_year) * 12 + at.tm_mon + static_cast<long>(months);
    at.tm_year = static_cast<int>(total / 12);
    at.tm_mon = static_cast<int>(total % 12);
    return static_cast<double>(CPLYMDHMSToUnixTime(&at)) + (start - std::floor(start));
}

} // namespace

std::optional<TimeUnit> TimeUnit::parse(const std::string& text)
{
    const std::string all = osgDB::convertToLowerCase(text);
    TimeUnit unit;
    if (all == "sec utc") return unit;
    const std::size_t since = all.find(" since ");
    if (since == std::string::npos) return std::nullopt;
    const std::string word = all.substr(0, since);
    const auto* const known = std::find_if(
        std::begin(units), std::end(units),
        [&](const NamedUnit& each) { return word == each.word || word == std::string(each.word) + "s"; });
    if (known == std::end(units)) return std::nullopt;
    unit.seconds = known->seconds;
    unit.months = known->months;
    const std::string date = text.substr(since + 7);
    const std::size_t zeros = date.find_first_not_of('0');
    unit.dated = !(zeros != std::string::npos && zeros > 0 && date[zeros] == '-');
    if (!unit.dated) return unit;
    const std::optional<double> start = LayerClock::parseDate(date);
    if (!start) return std::nullopt;
    unit.start = *start;
    return unit;
}

double TimeUnit::timeOf(double count) const
{
    // Years of ten digits have no calendar.
    if (months == 0 || !(std::abs(count) < 1e6)) return start + count * seconds;
    const double whole = std::floor(count * months);
    const double from = monthsLater(start, whole);
    return from + (count * months - whole) * (monthsLater(start, whole + 1.0) - from);
}

bool isTimeDimension(const std::string& name)
{
    const std::string lower = osgDB::convertToLowerCase(name);
    return lower == "time" || lower == "valid_time";
}

std::optional<double> dateIn(const std::string& text)
{
    // Year, month and day with one mark between them, then perhaps a time of day; no further digit follows.
    static const std::regex date("([0-9]{4})([-_.:]?)([0-9]{2})\\2([0-9]{2})"
                                 "(?:[Tt _-]?([0-9]{2})[:_-]?([0-9]{2})(?:[:_-]?([0-9]{2}))?(?![0-9])|[Tt "
                                 "_-]?([0-9]{2})(?![0-9])|(?![0-9]))");
    static const std::regex month("([0-9]{4})[-_.]?([0-9]{2})(?![0-9])");
    const auto search = [&](const std::regex& pattern, const auto& take) -> std::optional<double>
    {
        std::smatch found;
        for (auto from = text.cbegin(); std::regex_search(from, text.cend(), found, pattern);
             from = found[0].first + 1)
            if (found[0].first == text.cbegin() ||
                !std::isdigit(static_cast<unsigned char>(*(found[0].first - 1))))
                if (const std::optional<double> time = take(found)) return time;
        return std::nullopt;
    };
    const auto number = [](const std::ssub_match& part)
    {
        return part.matched ? std::stoi(part.str()) : 0;
    };
    const auto dated =
        search(date,
               [&](const std::smatch& found) -> std::optional<double>
               {
                   const std::optional<double> midnight =
                       secondOf(number(found[1]), number(found[3]), number(found[4]));
                   const int hour = number(found[5]) + number(found[8]);
                   if (!midnight || hour > 23 || number(found[6]) > 59 || number(found[7]) > 59)
                       return std::nullopt;
                   return *midnight + hour * 3600.0 + number(found[6]) * 60.0 + number(found[7]);
               });
    if (dated) return dated;
    return search(month,
                  [&](const std::smatch& found) -> std::optional<double>
                  {
                      // Other numbers of six digits are no years and months.
                      const int year = number(found[1]);
                      if (year < 1800 || year > 2199) return std::nullopt;
                      return secondOf(year, number(found[2]), 1);
                  });
}

bool standsBefore(const std::string& a, const std::string& b)
{
    const auto digit = [](char c)
    {
        return std::isdigit(static_cast<unsigned char>(c)) != 0;
    };
    std::size_t i = 0, j = 0;
    while (i < a.size() && j < b.size())
    {
        if (!digit(a[i]) || !digit(b[j]))
        {
            if (a[i] != b[j]) return a[i] < b[j];
            ++i;
            ++j;
            continue;
        }
        const auto run = [&](const std::string& text, std::size_t& place)
        {
            while (place + 1 < text.size() && text[place] == '0' && digit(text[place + 1]))
                ++place;
            const std::size_t from = place;
            while (place < text.size() && digit(text[place]))
                ++place;
            return text.substr(from, place - from);
        };
        const std::string left = run(a, i), right = run(b, j);
        if (left.size() != right.size()) return left.size() < right.size();
        if (left != right) return left < right;
    }
    if (i < a.size() || j < b.size()) return j < b.size();
    return a < b; // 07 and 7
}

} // namespace osgGeoFX
