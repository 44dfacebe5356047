// SPDX-License-Identifier: MIT
// SPDX-FileCopyrightText: 2026 the osgGeoFX authors
#include <osgGeoFX/raster/RasterBands.h>

#include <charconv>
#include <cmath>
#include <system_error>

namespace osgGeoFX
{

namespace
{

std::optional<double> numberIn(const char* begin, const char* end)
{
    double number = 0.0;
    const auto [stop, failure] = std::from_chars(begin, end, number);
    if (failure != std::errc() || stop != end || !std::isfinite(number)) return std::nullopt;
    return number;
}

} // namespace

bool RasterBands::setRange(const std::string& text)
{
    const std::size_t comma = text.find(',');
    if (comma == std::string::npos) return false;
    const std::optional<double> black = numberIn(text.data(), text.data() + comma);
    const std::optional<double> white = numberIn(text.data() + comma + 1, text.data() + text.size());
    if (!black || !white || *black == *white) return false;
    for (Channel& channel : channels)
        channel.range = {*black, *white};
    return true;
}

} // namespace osgGeoFX
