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
    double trees = 0.0;                   ///< share under trees, 0…1
    double town = 0.0;                    ///< share under buildings, 0…1
    double bare = 0.0;                    ///< 0 fields, 0.5 bare ground, 1 ice that stays
    bool water = false;
};

/** Reads a land-cover table: CSV with the columns value, class, name, red, green, blue (any order, any more).

    `file` may be the name of a ready legend instead: worldcover, corine, nlcd, flightgear. The columns trees, town, bare
    and water (0 or 1) are optional; where a table lacks one, or a line leaves it empty, coverOfClass() tells.
    Throws BuildError with file and line. Thread-safe. */
OSGGEOFXDATA_EXPORT std::vector<LandCoverClass> readLandCoverTable(const std::string& file);

/// Fills in trees, town, bare and water for a class whose identifier is that of a class of data/oahu or of a ready
/// legend, in upper or lower case; any other is a field. Thread-safe.
OSGGEOFXDATA_EXPORT void coverOfClass(LandCoverClass& entry);

/// What a table's file, or the ready legend of this name, holds; empty where it cannot be read. Thread-safe.
OSGGEOFXDATA_EXPORT std::string landCoverTableText(const std::string& file);

/// Names of the ready legends.
OSGGEOFXDATA_EXPORT std::vector<std::string> readyLegends();

} // namespace osgGeoFX
