// SPDX-License-Identifier: MIT
// SPDX-FileCopyrightText: 2026 the osgGeoFX authors
#pragma once

#include <osgGeoFX/Export.h>
#include <osgGeoFX/mapping/RoutePath.h>

#include <string>
#include <vector>

namespace osgGeoFX
{

/** The ways of a GPX, KML or other vector file, read by the plugin `osgdb_geofxdata`, so that a program which draws needs no GDAL. Programs that
    link osgGeoFXData may call RouteVectors themselves, which says what is read.
    @ingroup map */
struct OSGGEOFXMAPS_EXPORT RouteFile
{
    std::string file;
    std::string layer;              ///< empty: all layers
    std::vector<RoutePath> routes;  ///< what was read
    std::vector<std::string> files; ///< of KML: the file itself and those that it links

    /// Appends the file's ways to `routes`. False, with a sentence in `error`, if it cannot.
    bool read(std::string& error);
};

} // namespace osgGeoFX
