// SPDX-License-Identifier: MIT
// SPDX-FileCopyrightText: 2026 the osgGeoFX authors
#pragma once

#include <osgGeoFX/Export.h>

namespace osgGeoFX
{

/** A hash of the sources that decide on a database's bytes, made when the library is built: 16 hexadecimal digits. A database that
    other code has built, or has begun, is another one, though its sources and options are the same. */
OSGGEOFXDATA_EXPORT const char* builderCode();

} // namespace osgGeoFX
