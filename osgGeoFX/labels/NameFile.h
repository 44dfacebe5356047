// SPDX-License-Identifier: MIT
// SPDX-FileCopyrightText: 2026 the osgGeoFX authors
#pragma once

#include <osgGeoFX/Export.h>
#include <osgGeoFX/labels/MapName.h>

#include <string>
#include <vector>

namespace osgGeoFX
{

/** The names of a vector file, read by the plugin `osgdb_geofxdata`, so that a program which draws needs no GDAL. Programs that link
    osgGeoFXData may call NameVectors themselves.
    @ingroup labels */
struct OSGGEOFXMAPS_EXPORT NameFile
{
    std::string file;
    std::string layer;                           ///< empty: all layers
    std::string name, importance, height, style; ///< fields; empty: the usual ones (NameVectors::Options)
    bool globe = true;                           ///< the places wanted: degrees, else metres of `wkt`
    std::string wkt;                             ///< the coordinate system of a projected terrain
    std::vector<MapName> names;                  ///< what was read, not yet placed (NamePlacement)

    /// Appends the file's names to `names`. False, with a sentence in `error`, if it cannot.
    bool read(std::string& error);
};

} // namespace osgGeoFX
