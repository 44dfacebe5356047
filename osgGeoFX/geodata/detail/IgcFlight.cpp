// SPDX-License-Identifier: MIT
// SPDX-FileCopyrightText: 2026 the osgGeoFX authors
#include <osgGeoFX/geodata/detail/IgcFlight.h>

#include <osgGeoFX/geodata/BuildError.h>

#include <algorithm>
#include <cctype>
#include <cmath>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <optional>
#include <string_view>
#include <utility>

namespace osgGeoFX
{

namespace
{

constexpr std::size_t fixLength = 35;
/// What a recorder writes before its first fix is a few dozen lines.
constexpr int mostHeaderLines = 1000;

bool isFix(std::string_view line)
{
    return line.size() >= fixLength && line[0] == 'B' && (line[14] == 'N' || line[14] == 'S') &&
           (line[23] == 'E' || line[23] == 'W') && (line[24] == 'A' || line[24] == 'V');
}

/// Columns of a record, counted from 1 as the specification does; empty if these are none or not digits.
std::optional<double> number(std::string_view line, std::size_t first, std::size_t last)
{
    if (first < 1 || last < first || line.size() < last) return std::nullopt;
    const std::string text(line.substr(first - 1, last - first + 1));
    const std::size_t sign = text[0] == '-' ? 1 : 0; // heights below the sea
    if (text.size() == sign || !std::all_of(text.begin() + static_cast<std::ptrdiff_t>(sign), text.end(),
                                            [](unsigned char each) { return std::isdigit(each); }))
        return std::nullopt;
    return std::atof(text.c_str());
}

/// Where an I record has more digits of minutes.
struct Digits
{
    std::size_t first = 0, last = 0; ///< columns; 0: none

    /// Thousandths of a minute.
    double of(std::string_view line) const
    {
        const std::optional<double> value = number(line, first, last);
        return value ? *value / std::pow(10.0, static_cast<double>(last - first + 1)) : 0.0;
    }
};

struct Extensions
{
    Digits latitude, longitude;

    /// I, the number of extensions, and for each first column, last column and three letters.
    static Extensions read(std::string_view line)
    {
        Extensions result;
        for (std::size_t at = 3; at + 7 <= line.size(); at += 7)
        {
            const std::optional<double> first = number(line, at + 1, at + 2),
                                        last = number(line, at + 3, at + 4);
            const std::string_view kind = line.substr(at + 4, 3);
            if (!first || !last) break;
            const Digits digits = {static_cast<std::size_t>(*first), static_cast<std::size_t>(*last)};
            if (kind == "LAD") result.latitude = digits;
            if (kind == "LOD") result.longitude = digits;
        }
        return result;
    }
};

/// Lines end as any system ends them.
bool nextLine(std::istream& stream, std::string& line)
{
    if (!std::getline(stream, line)) return false;
    if (!line.empty() && line.back() == '\r') line.pop_back();
    return true;
}

} // namespace

bool isIgcFlight(const std::string& file)
{
    std::ifstream stream(file, std::ios::binary);
    std::string line;
    if (stream.peek() != 'A' || !nextLine(stream, line) || line.size() < 4 || line.size() > 100) return false;
    for (int i = 0; i < mostHeaderLines && nextLine(stream, line); ++i)
        if (isFix(line)) return true;
    return false;
}

RoutePath readIgcFlight(const std::string& file, std::size_t mostPlaces)
{
    std::ifstream stream(file, std::ios::binary);
    RoutePath flight;
    flight.name = std::filesystem::path(file).stem().string();
    flight.altitude = RoutePath::ABSOLUTE;
    std::vector<double> pressureHeights;
    bool bySatellites = false;
    Extensions more;
    std::string line;
    for (int at = 1; nextLine(stream, line); ++at)
    {
        if (!line.empty() && line[0] == 'I') more = Extensions::read(line);
        if (line.empty() || line[0] != 'B') continue;
        const auto latitude = number(line, 8, 9), northMinutes = number(line, 10, 14);
        const auto longitude = number(line, 16, 18), eastMinutes = number(line, 19, 23);
        const auto pressure = number(line, 26, 30), satellites = number(line, 31, 35);
        if (!isFix(line) || !latitude || !northMinutes || !longitude || !eastMinutes || !pressure ||
            !satellites || *latitude > 90.0 || *longitude > 180.0)
            throw BuildError(
                file + ":" + std::to_string(at) +
                ": this fix cannot be read; a B record has time, latitude, longitude, A or V and two "
                "heights in 35 columns. Take the line out, or write the flight again.");
        double y = *latitude + (*northMinutes + more.latitude.of(line)) / 60000.0;
        double x = *longitude + (*eastMinutes + more.longitude.of(line)) / 60000.0;
        if (line[24] == 'V' && x == 0.0 && y == 0.0) continue;
        if (line[14] == 'S') y = -y;
        if (line[23] == 'W') x = -x;
        if (flight.places.size() == mostPlaces)
            throw BuildError(file + ": it has more than " + std::to_string(mostPlaces) + " fixes; cut it.");
        flight.places.emplace_back(x, y, *satellites);
        pressureHeights.push_back(*pressure);
        bySatellites = bySatellites || *satellites != 0.0;
    }
    if (!bySatellites)
        for (std::size_t i = 0; i < flight.places.size(); ++i)
            flight.places[i].z() = pressureHeights[i];
    return flight;
}

} // namespace osgGeoFX
