// SPDX-License-Identifier: MIT
// SPDX-FileCopyrightText: 2026 the osgGeoFX authors
#pragma once

#include <osgGeoFX/Export.h>

#include <string>
#include <vector>

namespace osgGeoFX
{

/** Where a file takes its data from, as the plugin `osgdb_geofxdata` tells, so that a program which draws needs no GDAL. Programs that
    link osgGeoFXData may call FileSources themselves.
    @ingroup map */
struct OSGGEOFXMAPS_EXPORT SourceFiles
{
    std::string file;
    std::vector<std::string>
        files;           ///< as complete paths where they are paths; empty for a file that GDAL does not know
    std::string service; ///< the format's name, where the data come from a network or a data base

    /// Sets `files` and `service`. False, with a sentence in `error`, if the plugin is not there.
    bool read(std::string& error);
};

} // namespace osgGeoFX
