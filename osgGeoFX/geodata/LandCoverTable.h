// SPDX-License-Identifier: MIT
// SPDX-FileCopyrightText: 2026 the osgGeoFX authors
#pragma once

#include <osgGeoFX/Export.h>

#include <array>
#include <string>
#include <vector>

namespace osgGeoFX
{

/// What one value of a land-cover raster stands for.
struct LandCoverClass
{
    int value = 0;                        ///< 0…255; 0 is kept for "no data" and cannot be a class
    std::string id;                       ///< short and stable, such as evergreen_forest
    std::string name;                     ///< in a person's words
    std::array<unsigned char, 3> color{}; ///< red, green, blue
};

/** Reads a land-cover table: CSV with the columns value, class, name, red, green, blue (any order, any more).
    Throws BuildError with file and line. Thread-safe. */
OSGGEOFXDATA_EXPORT std::vector<LandCoverClass> readLandCoverTable(const std::string& file);

} // namespace osgGeoFX
