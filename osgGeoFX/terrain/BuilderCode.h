// SPDX-License-Identifier: MIT
// SPDX-FileCopyrightText: 2026 the osgGeoFX authors
#pragma once

#include <osgGeoFX/Export.h>

namespace osgGeoFX
{

/** A hash of the sources that determine a database's bytes, computed when the library is built: 16 hexadecimal digits.
    A database that other code has built or begun counts as a different one, even if its rasters and options are the
    same. */
OSGGEOFXDATA_EXPORT const char* builderCode();

} // namespace osgGeoFX
