// SPDX-License-Identifier: MIT
// SPDX-FileCopyrightText: 2026 the osgGeoFX authors
#pragma once

#include <osgGeoFX/Export.h>

#include <string>

namespace osgGeoFX
{

/** Names of files in JSON, which is UTF-8, while a name may be any bytes. Thread-safe.
    @ingroup batch */
struct OSGGEOFX_EXPORT PathText
{
    /// A name as UTF-8. Bytes that are no UTF-8 become characters of a private area, U+10FF80 to U+10FFFF.
    static std::string of(const std::string& path);
    /// The name again.
    static std::string path(const std::string& text);
};

} // namespace osgGeoFX
