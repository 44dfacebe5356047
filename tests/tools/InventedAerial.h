// SPDX-License-Identifier: MIT
// SPDX-FileCopyrightText: 2026 the osgGeoFX authors
#pragma once

#include <string>

namespace geofx::test
{

/** Writes a picture of Oahu that looks like one from the air, as an uncompressed GeoTIFF of three bytes a pixel: the classes of
    the land cover in data/oahu with ragged borders, and in each a grain of its own, such as crowns, roofs, waves. `columns` is
    its width over the whole raster of data/oahu, 1 to 65,536; 12,960 has 7.7 m to a pixel and 420 MB. The same width gives the same
    bytes. Throws std::runtime_error. */
void inventAerial(const std::string& file, int columns);

} // namespace geofx::test
