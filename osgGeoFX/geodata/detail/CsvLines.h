// SPDX-License-Identifier: MIT
// SPDX-FileCopyrightText: 2026 the osgGeoFX authors
#pragma once

#include <istream>
#include <vector>

namespace osgGeoFX
{

/// Where the records of a CSV file begin, the first line among them; lines are counted from 1. GDAL passes over blank
/// lines, and quoted text may have line breaks.
std::vector<int> recordLines(std::istream& stream);

} // namespace osgGeoFX
