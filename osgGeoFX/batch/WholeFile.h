// SPDX-License-Identifier: MIT
// SPDX-FileCopyrightText: 2026 the osgGeoFX authors
#pragma once

#include <osgGeoFX/Export.h>

#include <cstddef>
#include <string>

namespace osgGeoFX
{

/// The end of names that temporaryName() gives.
constexpr const char* TEMPORARY_ENDING = ".tmp";

/// A name beside `path` that no other thread, process or machine uses. It ends with TEMPORARY_ENDING. Any thread may
/// call it.
/// @ingroup batch
OSGGEOFX_EXPORT std::string temporaryName(const std::string& path);

/** Writes a file under a temporary name and renames it, so that a reader finds all of it or nothing. Returns 0.
    If the folder is missing or read-only, or the disk is full, it leaves nothing behind and returns the error number.
    Any thread may call it.
    @ingroup batch */
OSGGEOFX_EXPORT int writeWholeFile(const std::string& path, const char* data, std::size_t size);

} // namespace osgGeoFX
