// SPDX-License-Identifier: MIT
// SPDX-FileCopyrightText: 2026 the osgGeoFX authors
#pragma once

#include <string>

namespace geofx::test
{

/** Writes a made-up town for Oahu as a GeoPackage: houses, blocks of flats, halls and high-rises, where the land cover in
    data/oahu says town, city or industry, along streets of their own, and on none of its roads. High-rises stand downtown, at Ala Moana
    and at Waikiki. The layer "buildings" has the fields height (metres), storeys, roof (flat or gabled) and use. There are at
    most `count`, those nearest to the line from downtown to Waikiki; 0 stands for all that find a place. The same count gives
    the same bytes. Throws std::runtime_error. */
int inventTown(const std::string& file, int count);

/** Writes the local streets of the same town as GeoJSON lines with the style "residential": around each block that has houses, as
    far as no house and no water, freeway or railroad is in the way. Returns how many there are. Throws std::runtime_error. */
int inventStreets(const std::string& file, int count);

/** Copies a land cover of Oahu's grid, with the class of ground.csv for houses with gardens in the blocks of all houses. Returns the number of these
    cells. Throws std::runtime_error. */
int inventGardens(const std::string& source, const std::string& file);

/** Writes `count` houses, or somewhat fewer, evenly over all of Oahu's land, in the same form: far more than a town has, for
    measuring. Throws std::runtime_error. */
int inventCrowd(const std::string& file, int count);

} // namespace geofx::test
