// SPDX-License-Identifier: MIT
// SPDX-FileCopyrightText: 2026 the osgGeoFX authors
#pragma once

#include <osgGeoFX/Export.h>

#include <osg/Vec2d>
#include <osg/Vec4>

#include <array>
#include <string>
#include <vector>

namespace osgGeoFX
{

/// A picture that lies on the ground by its corners: a GroundOverlay of KML.
/// @ingroup geodata
struct KmlOverlay
{
    std::string name;
    /// What GDAL opens: a path, or a place within a KMZ file (`/vsizip/…`). Empty: a plain area of `color`.
    std::string image;
    /// Lower left, lower right, upper right, upper left; degrees of longitude and latitude. Longitudes go on beyond
    /// ±180 where the overlay crosses the antimeridian. The picture is straight between them in degrees: affine for a
    /// box, projective for a quadrilateral.
    std::array<osg::Vec2d, 4> corners;
    osg::Vec4 color = {1.0f, 1.0f, 1.0f, 1.0f}; ///< multiplies the picture's colors and alpha, 0…1
    int order = 0;                              ///< drawOrder: the higher one lies on top
    bool visible =
        true; ///< false if the overlay or a folder around it is switched off, or if it is of a later time
    /// When it is there, from a TimeSpan or TimeStamp of it or of a folder around it: dates as ISO 8601 has them. Empty: no limit.
    std::string begin, end;
    /// The size on the screen, pixels, from which on it shows, and from which on it shows fully; both 0: at any size. As
    /// ProjectiveMapping::setPixels().
    double pixelsNone = 0.0, pixelsFull = 0.0;
};

/** Reads the ground overlays of a KML or KMZ file, and of the files that its network links name.

    LatLonBox with rotation and gx:LatLonQuad give the corners. A rotation is counter-clockwise about the box's middle, and
    keeps the shape that the box has on the ground, as in Google Earth. `color`, `drawOrder`, `visibility` and the limits
    minLodPixels and minFadeExtent of a Region are taken, also those of the folders around an overlay. maxLodPixels is
    not: a coarse overlay stays below the finer ones that cover it. Overlays come by their drawOrder; of equal ones
    those of a linked file come after those of the file that links it. Of overlays with times those of the earliest time are visible. All lie on the
    ground, whatever their altitude is.

    **Reach.** A file's pictures and links must lie in its own folder or below (of a KMZ: within it), links followed.
    Others are left out unless `allowOutside`, and so are pictures that are not there; a file without any other overlay is refused. Names
    may have back slashes and letters of another case. Pictures there are opened as PNG, JPEG, GIF, TIFF, BMP, WebP or JPEG 2000
    only, since other formats name further files. No address is fetched unless `allowOutside`.

    **Size.** Files are read as a stream. One of more than 256 MiB (all linked ones together 1 GiB), more than 10,000 overlays
    or 10,000 linked files are refused.

    Thread-safe.
    @ingroup geodata */
struct OSGGEOFXDATA_EXPORT KmlOverlays
{
    /// Appends the overlays of a file, in the order in which they are drawn. False, with a sentence in `error` that names
    /// file, line and remedy, if it cannot be used or has none; `overlays` stays unchanged then. `notices` gets sentences
    /// on what was left out, `files` the files on disk that were read or are named as pictures, and `isNone` whether the only fault is that there are
    /// no overlays, or that all were left out.
    static bool read(const std::string& file, bool allowOutside, std::vector<KmlOverlay>& overlays,
                     std::vector<std::string>& notices, std::string& error,
                     std::vector<std::string>* files = nullptr, bool* isNone = nullptr);
    /// Whether a file's name is that of KML or KMZ.
    static bool isKml(const std::string& file);
};

} // namespace osgGeoFX
