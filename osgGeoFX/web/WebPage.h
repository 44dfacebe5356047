// SPDX-License-Identifier: MIT
// SPDX-FileCopyrightText: 2026 the osgGeoFX authors
#pragma once

#include <osgGeoFX/Export.h>
#include <osgGeoFX/web/WebNames.h>

#include <functional>
#include <optional>
#include <string>
#include <vector>

namespace osgGeoFX
{

/// What the pixels of a picture show. A plain value.
/// @ingroup web
struct WebPlaces
{
    struct Place
    {
        double longitude = 0.0; ///< degrees
        double latitude = 0.0;
        double height = 0.0; ///< metres
    };
    int width = 0; ///< of the picture whose pixels are asked for, which may be a reduced one
    int height = 0;
    /// The place of a pixel, from the left and from the uppermost row; empty for the sky.
    std::function<std::optional<Place>(int x, int y)> at;
};

/** A folder with a picture that any browser shows, from a web server or by a double click, and asks nobody else for anything.

    It has the picture's tiles at all zooms, a page with Leaflet, the names as text that people search and click, and the place under the pointer.

    One thread at a time.
    @ingroup web */
class OSGGEOFXMAPS_EXPORT WebPage
{
public:
    struct Options
    {
        /// The picture without names, sRGB: any file that OpenImageIO reads row by row. Memory has a few of its rows.
        std::string picture;
        std::string title = "Panorama map";
        std::string attribution; ///< a line at the page's bottom, such as the data's authors; plain text
        std::vector<WebName> names;
        WebPlaces places; ///< none: the page tells nothing about the place under the pointer
        int quality = 88; ///< of the tiles, which are JPEG; 1…100
        /// The folder with leaflet.js and leaflet.css; empty for the one that was found when the library was built, or Debian's.
        std::string leaflet;
    };

    /// Why a page cannot be written to a folder, as a sentence with the remedy; empty if it can. Programs ask before they draw for long.
    static std::string faultOf(const std::string& folder, const std::string& leaflet = {});

    /** Writes the folder, whole or not at all. A former page of this class is replaced; a folder with anything else in it is refused. False,
        with a sentence in `error`, if it cannot. */
    static bool write(const Options& options, const std::string& folder, std::string& error);
};

} // namespace osgGeoFX
