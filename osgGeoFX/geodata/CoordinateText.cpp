// SPDX-License-Identifier: MIT
// SPDX-FileCopyrightText: 2026 the osgGeoFX authors
#include <osgGeoFX/geodata/CoordinateText.h>

#include <ogr_spatialref.h>

#include <algorithm>
#include <cctype>

namespace osgGeoFX
{

namespace
{

/// AUTHORITY:CODE, or two codes for ground and heights.
bool isCode(const std::string& text)
{
    const std::size_t colon = text.find(':');
    const auto isPart = [](const std::string& part)
    {
        return !part.empty() && std::all_of(part.begin(), part.end(),
                                            [](unsigned char letter) {
                                                return std::isalnum(letter) || letter == '_' || letter == '+';
                                            });
    };
    return colon != std::string::npos && isPart(text.substr(0, colon)) && isPart(text.substr(colon + 1));
}

/// A keyword and a bracket, or an object of JSON.
bool isWkt(const std::string& text)
{
    const auto begin =
        std::find_if(text.begin(), text.end(), [](unsigned char letter) { return !std::isspace(letter); });
    if (begin != text.end() && *begin == '{') return true;
    const auto end = std::find_if(
        begin, text.end(),
        [](unsigned char letter) { return !std::isupper(letter) && !std::isdigit(letter) && letter != '_'; });
    return end != begin && end != text.end() && (*end == '[' || *end == '(');
}

/// Whether a text names files of grids, or of definitions, by their paths.
bool namesPaths(std::string text)
{
    std::transform(text.begin(), text.end(), text.begin(),
                   [](unsigned char letter) { return static_cast<char>(std::tolower(letter)); });
    if (text.find("+init=") != std::string::npos || text.find("+catalog=") != std::string::npos) return true;
    const auto isPath = [&](const std::string& key, const char* ends)
    {
        for (std::size_t i = text.find(key); i != std::string::npos; i = text.find(key, i + 1))
        {
            const std::string value = text.substr(i, text.find_first_of(ends, i) - i);
            if (value.find('/') != std::string::npos || value.find('\\') != std::string::npos) return true;
        }
        return false;
    };
    return isPath("grids=", " \t\r\n\"") || isPath("file=", " \t\r\n\"") || isPath("parameterfile", "]") ||
           isPath("\"parameter_file\"", "}");
}

} // namespace

bool setCoordinateSystem(OGRSpatialReference& system, const std::string& text)
{
    const bool isProj = text.find("+proj=") != std::string::npos && text.find("://") == std::string::npos;
    if (!isCode(text) && !isWkt(text) && !isProj) return false;
    if (namesPaths(text)) return false;
    OGRSpatialReference read;
    const char* const limits[] = {"ALLOW_NETWORK_ACCESS=NO", "ALLOW_FILE_ACCESS=NO", nullptr};
    if (read.SetFromUserInput(text.c_str(), limits) != OGRERR_NONE) return false;
    system = read;
    return true;
}

} // namespace osgGeoFX
