// SPDX-License-Identifier: MIT
// SPDX-FileCopyrightText: 2026 the osgGeoFX authors
#pragma once

#include <osgGeoFX/mapping/RoutePath.h>

#include <cstddef>
#include <string>

namespace osgGeoFX
{

/// Whether a file is a flight of gliders: IGC (FAI, Technical Specification for GNSS Flight Recorders, Appendix A). Its first record is A, and it
/// has a fix. Thread-safe.
bool isIgcFlight(const std::string& file);

/** Reads the fixes (B records) of a flight as a track; thousandths of a minute and what an I record adds to them.

    Heights are those of the satellites, or of the barometer if these are all 0. A fix without a place (V, at 0° 0°) is left out. The
    flight's name is that of the file. Throws BuildError, with file and line, where a fix cannot be read or where there are more than
    `mostPlaces`. Thread-safe. */
RoutePath readIgcFlight(const std::string& file, std::size_t mostPlaces);

} // namespace osgGeoFX
