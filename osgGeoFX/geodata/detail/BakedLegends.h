// SPDX-License-Identifier: MIT
// SPDX-FileCopyrightText: 2026 the osgGeoFX authors
#pragma once

#include <cstddef>
#include <string>

namespace osgGeoFX
{

/// A file of data/legends, baked into the library by osgGeoFX/cmake/BakeLegends.cmake.
struct BakedLegend
{
    const char* name; ///< without folder and extension
    const char* text;
};
extern const BakedLegend bakedLegends[];
extern const std::size_t bakedLegendCount;

/// Null where there is none of this name.
const BakedLegend* findLegend(const std::string& name);

} // namespace osgGeoFX
