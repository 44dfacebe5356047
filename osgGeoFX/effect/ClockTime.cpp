// SPDX-License-Identifier: MIT
// SPDX-FileCopyrightText: 2026 the osgGeoFX authors
#include <osgGeoFX/effect/ClockTime.h>

#include <algorithm>
#include <cctype>
#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <ctime>
#include <locale>
#include <sstream>

namespace osgGeoFX
{

namespace
{

constexpr int longestZone = 14 * 3600;

/// Two digits; -1 if there are none.
int twoDigits(const std::string& text, std::size_t at)
{
    const auto digit = [&](std::size_t i)
    {
        return i < text.size() && text[i] >= '0' && text[i] <= '9' ? text[i] - '0' : -100;
    };
    return std::max(10 * digit(at) + digit(at + 1), -1);
}

/// Seconds that the rest of a time says the clock is ahead of UTC.
std::optional<int> readZone(const std::string& text)
{
    if (text == "Z") return 0;
    if (text.size() != 6 || (text[0] != '+' && text[0] != '-') || text[3] != ':') return std::nullopt;
    const int hours = twoDigits(text, 1), minutes = twoDigits(text, 4);
    const int seconds = hours * 3600 + minutes * 60;
    if (hours < 0 || minutes < 0 || minutes > 59 || seconds > longestZone) return std::nullopt;
    return text[0] == '-' ? -seconds : seconds;
}

} // namespace

std::optional<ClockTime> readClockTime(const std::string& text)
{
    std::tm date{};
    std::istringstream stream(text);
    stream.imbue(std::locale::classic());
    char separators[4] = {};
    int fields[5] = {};
    for (int i = 0; i < 5; ++i)
    {
        // Digits alone: a stream would take signs and spaces, too.
        const std::streamsize width = i == 0 ? 4 : 2;
        for (std::streamsize k = 0; k < width; ++k)
        {
            const int digit = stream.get();
            if (digit < '0' || digit > '9') return std::nullopt;
            fields[i] = 10 * fields[i] + digit - '0';
        }
        if (i < 4) separators[i] = static_cast<char>(stream.get());
    }
    if (separators[0] != '-' || separators[1] != '-' || separators[2] != 'T' || separators[3] != ':')
        return std::nullopt;
    double seconds = 0.0;
    if (stream.peek() == ':')
    {
        stream.get();
        std::string digits;
        while (std::isdigit(stream.peek()) || stream.peek() == '.')
            digits += static_cast<char>(stream.get());
        std::istringstream number(digits);
        number.imbue(std::locale::classic());
        if (std::min(digits.find('.'), digits.size()) != 2 || digits.back() == '.' || !(number >> seconds) ||
            !number.eof())
            return std::nullopt;
    }
    std::string rest;
    std::getline(stream, rest);
    const std::optional<int> zone = readZone(rest);
    if (!zone || fields[3] > 23 || fields[4] > 59 || seconds >= 60.0 || fields[0] < 1) return std::nullopt;
    date.tm_year = fields[0] - 1900;
    date.tm_mon = fields[1] - 1;
    date.tm_mday = fields[2];
    date.tm_hour = fields[3];
    date.tm_min = fields[4];
    const std::time_t whole = timegm(&date); // makes the 31st of June the 1st of July
    if (date.tm_mon != fields[1] - 1 || date.tm_mday != fields[2]) return std::nullopt;
    return ClockTime{static_cast<double>(whole) + seconds - *zone, *zone};
}

std::string textOf(const ClockTime& time)
{
    const auto local = static_cast<std::time_t>(std::llround(time.time) + time.zone);
    std::tm date{};
    gmtime_r(&local, &date);
    char text[64];
    const std::size_t length = std::strftime(text, sizeof text, "%Y-%m-%dT%H:%M:%S", &date);
    if (time.zone == 0) return std::string(text, length) + "Z";
    const int minutes = std::abs(time.zone) / 60;
    char zone[16];
    std::snprintf(zone, sizeof zone, "%c%02d:%02d", time.zone < 0 ? '-' : '+', minutes / 60, minutes % 60);
    return std::string(text, length) + zone;
}

} // namespace osgGeoFX
