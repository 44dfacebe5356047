// SPDX-License-Identifier: MIT
// SPDX-FileCopyrightText: 2026 the osgGeoFX authors
#pragma once

#include <osgGeoFX/Export.h>
#include <osgGeoFX/mapping/RoutePath.h>

#include <string>
#include <vector>

namespace osgGeoFX
{

/** Reads ways with their heights.

    - **GPX** (by GDAL): routes, whose places are way points, and each segment of a track; neighbouring segments of one point each are joined.
      If all points of one have `ele`, it is ABSOLUTE, else CLAMPED.
    - **IGC**, flights of gliders: one track, ABSOLUTE.
    - **KML and KMZ**: LineString and gx:Track of placemarks that are not switched off, with altitudeMode (`clampToGround`
      without one), `extrude` and the color of their LineStyle; also of files that it links within its folder, at most 1000. GDAL tells no altitudeMode of tracks, so the text is read
      as a stream, as KmlOverlays does.
    - **All else that GDAL opens**: lines. With a third coordinate they are ABSOLUTE, without CLAMPED. A field `name` is
      their name.

    Lost fixes of receivers are left out, with one warning for each way: places at exactly 0, 0 far from all others, and in tracks places
    far off to which the track jumps and from which it comes back.

    Thread-safe.
    @ingroup geodata */
struct OSGGEOFXDATA_EXPORT RouteVectors
{
    /// Appends the ways of a file. `layer`: one layer, empty for all (not of KML). If it fails, or if the file has no way, `routes` stays
    /// unchanged and a sentence in `error` names file and remedy. Ways of less than two places are left out. A file of more than ten
    /// million places is refused. `files` gets a KML file and those that it links.
    static bool read(const std::string& file, const std::string& layer, std::vector<RoutePath>& routes,
                     std::string& error, std::vector<std::string>* files = nullptr);
};

} // namespace osgGeoFX
