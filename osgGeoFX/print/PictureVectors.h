// SPDX-License-Identifier: MIT
// SPDX-FileCopyrightText: 2026 the osgGeoFX authors
#pragma once

#include <osgGeoFX/Export.h>
#include <osgGeoFX/labels/LabelPicture.h>
#include <osgGeoFX/lines/LinePicture.h>

#include <string>

namespace osgGeoFX
{

/** The names and lines of one picture as vectors over it, for programs in which people finish maps by hand.

    Everything lies at the pixels where the picture has it. Files are written whole or not at all. One thread at a time.
    @ingroup print */
struct OSGGEOFXMAPS_EXPORT PictureVectors
{
    double width = 0.0; ///< of the picture, pixels
    double height = 0.0;
    const LabelPicture* names = nullptr; ///< null for none; of the same size
    const LinePicture* lines = nullptr;  ///< null for none; of the same size

    /// Writes an SVG file of the picture's size: each name as text that can be searched and edited, in a group of its style's class; lines
    /// as paths, below them. `picture`: a file to be shown behind them, named as from the SVG file; empty: none. False, with a
    /// sentence in `error`, if it cannot be written.
    bool writeSvg(const std::string& file, const std::string& picture, std::string& error) const;

    static constexpr int largestPdfSide = 32767; ///< pixels

    /** Writes a PDF file of one page: the picture, and over it lines and names as vectors, with text that can be searched. `picture`: a JPEG file
        of this size, which becomes a part of the PDF as it is; sides of up to `largestPdfSide`. `dpi`: pixels for each inch of the paper,
        > 0. `title`: for the document's metadata. False, with a sentence in `error`, if it cannot. */
    bool writePdf(const std::string& file, const std::string& picture, double dpi, const std::string& title,
                  std::string& error) const;

    /** Writes a GeoJSON file (RFC 7946 but for its coordinates, which are pixels): names as points with `name`, `style` and `importance`, and with
        `curve`, the pixels of the curve that the text follows; lines with `name`, `style` and `width`, pixels. x goes to the right
        from the picture's left side, y upwards from its upper side, so it is negative, and the map stands upright where y goes up.
        False, with a sentence in `error`, if it cannot be written. */
    bool writeGeoJson(const std::string& file, std::string& error) const;
};

} // namespace osgGeoFX
