// SPDX-License-Identifier: MIT
// SPDX-FileCopyrightText: 2026 the osgGeoFX authors
#pragma once

// Private to osgGeoFXData: consumers of the library do not need GDAL's headers.

#include <cpl_error.h>

#include <string>

namespace osgGeoFX
{

/// The number of GDAL's message about a file that the guard does not let it read.
constexpr CPLErrorNum refusedByGuard = 5501;

/** Makes GDAL keep to FilesByOthers::Scope, however deep within other files it finds a name, and whenever it opens that file.

    On a thread with such a scope GDAL opens the formats of isFormatByOthers() only. Its file systems open files in the scope's folder
    and below, in memory, in archives of these, and GDAL's own data; none for writing, and no address. Other threads are not concerned.
    It holds for the process and cannot be taken back; VSICurlClearCache() reaches no file system behind it. GDAL's drivers must be
    registered. Thread-safe. */
void guardGdal();

/// Whether files by others may have the format with this short name.
bool isFormatByOthers(const std::string& format);

} // namespace osgGeoFX
