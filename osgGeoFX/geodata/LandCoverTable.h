// SPDX-License-Identifier: MIT
// SPDX-FileCopyrightText: 2026 the osgGeoFX authors
#pragma once

#include <osgGeoFX/Export.h>

#include <array>
#include <string>
#include <vector>

namespace osgGeoFX
{

/// The meaning of one value of a land-cover raster.
/// @ingroup geodata
struct LandCoverClass
{
    int value = 0;                        ///< 1…255; 0 is reserved for "no data"
    std::string id;                       ///< short and stable, such as evergreen_forest
    std::string name;                     ///< as people write it
    std::array<unsigned char, 3> color{}; ///< red, green, blue
    double trees = 0.0;                   ///< share of the ground under trees, 0…1
    double town = 0.0;                    ///< share of the ground under buildings, 0…1
    double bare = 0.0;                    ///< 0 fields, 0.5 bare ground, 1 permanent ice
    bool water = false;
};

/** Reads a land-cover table: a CSV file with the columns value, class, name, red, green and blue. Their order is free
    and other columns may follow.

    `file` may also be the name of a ready legend: worldcover, corine, nlcd or flightgear. The columns trees, town,
    bare (0…1) and water (0 or 1) are optional. If a column is missing or a field is empty, coverOfClass() supplies the
    value. Throws BuildError with file and line. Thread-safe. */
OSGGEOFXDATA_EXPORT std::vector<LandCoverClass> readLandCoverTable(const std::string& file);

/// Sets trees, town, bare and water of a class whose identifier is that of a class of data/oahu or of a ready legend,
/// in upper or lower case. Other classes are left as they are; by default that is a field. Thread-safe.
OSGGEOFXDATA_EXPORT void coverOfClass(LandCoverClass& entry);

/// The text of a table's file or of the ready legend of this name. Empty if the file cannot be read. Thread-safe.
OSGGEOFXDATA_EXPORT std::string landCoverTableText(const std::string& file);

/// The names of the ready legends.
OSGGEOFXDATA_EXPORT std::vector<std::string> readyLegends();

} // namespace osgGeoFX
