// SPDX-License-Identifier: MIT
// SPDX-FileCopyrightText: 2026 the osgGeoFX authors
#pragma once

#include <string>
#include <vector>

namespace geofx::test
{

/// Terrains of different kinds that no file in data/ has, made by formulas; each differs in its reference system, unit or
/// grid, too. The names: "alps", "islands", "canyon", "volcano", "hills", "atoll", "glacier", "feet", "rotated", "huge",
/// "earth" (a whole one, but no known one);
/// and what is hardly a terrain: "flat", "cliff", "sea", "tiny", "nowhere" (without a georeference).
std::vector<std::string> inventedTerrains();

/// Its height, metres, at x to the east and y to the north, 0…1 over the terrain. Throws std::runtime_error.
double inventedHeight(const std::string& name, double x, double y);

/// Writes one as a GeoTIFF. `samples` along each side; 0 for its own number (1,201; "earth" has 5,400, "huge" 30,000, "tiny" 10).
/// Throws std::runtime_error.
void inventTerrain(const std::string& name, const std::string& file, int samples = 0);

} // namespace geofx::test
