// SPDX-License-Identifier: MIT
// SPDX-FileCopyrightText: 2026 the osgGeoFX authors
#pragma once

#include <osgGeoFX/mapping/RoutePath.h>

#include <string>
#include <vector>

namespace osgGeoFX
{

/// More of a file's places are no person's.
constexpr std::size_t mostRoutePlaces = 10000000;

struct KmlLines
{
    std::vector<RoutePath> routes;
    std::vector<std::string> links; ///< what its network links name, as it stands in the text
    std::size_t places = 0;         ///< of its lines, also of those that are switched off
    std::size_t bytes = 0;
};

/// The ways of a KML text, as GDAL opens it. Throws BuildError, with file and line, where the text is no KML, says what cannot be, or has
/// more places than that.
KmlLines readKmlLines(const std::string& document, std::size_t mostPlaces = mostRoutePlaces);

} // namespace osgGeoFX
