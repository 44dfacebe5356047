// SPDX-License-Identifier: MIT
// SPDX-FileCopyrightText: 2026 the osgGeoFX authors
#pragma once

#include <osgGeoFX/Export.h>
#include <osgGeoFX/lines/MapLine.h>

#include <string>
#include <vector>

namespace osgGeoFX
{

/** The lines of a vector file, read by the plugin `osgdb_geofxdata`, so that a program which draws needs no GDAL. Programs that link
    osgGeoFXData may call LineVectors themselves.
    @ingroup lines */
struct OSGGEOFXMAPS_EXPORT LineFile
{
    std::string file;
    std::string layer; ///< empty: all layers
    std::string style; ///< the field that names the style; empty: the usual ones (LineVectors::Options)
    bool globe = true; ///< the places wanted: degrees, else metres of `wkt`
    std::string wkt;   ///< the coordinate system of a projected terrain
    std::vector<MapLine> lines; ///< what was read, not yet placed (LinePlacement)

    /// Appends the file's lines to `lines`. False, with a sentence in `error`, if it cannot.
    bool read(std::string& error);
};

} // namespace osgGeoFX
