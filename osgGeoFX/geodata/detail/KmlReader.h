// SPDX-License-Identifier: MIT
// SPDX-FileCopyrightText: 2026 the osgGeoFX authors
#pragma once

#include <osgGeoFX/geodata/KmlOverlays.h>

#include <cstddef>
#include <string>
#include <vector>

namespace osgGeoFX
{

/// One KML text, read as a stream by libxml2. Nothing that it names is opened.
struct KmlReader
{
    /// What an overlay gets of the folders around it.
    struct Inherited
    {
        bool visible = true;
        double pixelsNone = 0.0, pixelsFull = 0.0;
        std::string begin, end; ///< as KmlOverlay has them
    };
    struct Overlay
    {
        KmlOverlay overlay; ///< without its image
        std::string href;   ///< as it stands in the text
        int line = 0;
        bool inAir = false; ///< whether its altitudeMode lifts it off the ground
    };
    struct Link
    {
        std::string href;
        int line = 0;
        Inherited inherited;
    };
    struct Content
    {
        std::vector<Overlay> overlays;
        std::vector<Link> links;
        std::size_t bytes = 0;
    };

    /// Throws BuildError, with file and line, where the text is no KML, is too long, or says what cannot be.
    static Content read(const std::string& document, const Inherited& inherited);
};

} // namespace osgGeoFX
