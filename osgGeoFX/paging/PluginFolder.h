// SPDX-License-Identifier: MIT
// SPDX-FileCopyrightText: 2026 the osgGeoFX authors
#pragma once

#include <osgGeoFX/Export.h>

namespace osgGeoFX
{

/** Lets OSG find the kit's plugins, which lie below the folder of this library, in a build tree and in a prefix alike. OSG itself
    looks only in its own prefix and in OSG_LIBRARY_PATH; what it finds there goes first. The kit calls this before it asks a
    plugin of its own. A program needs it before it reads scene files by osgDB itself. One thread at a time.
    @ingroup paging */
OSGGEOFX_EXPORT void addPluginFolder();

} // namespace osgGeoFX
