// SPDX-License-Identifier: MIT
// SPDX-FileCopyrightText: 2026 the osgGeoFX authors
#pragma once

#include <osgGeoFX/Export.h>
#include <osgGeoFX/labels/LabelPicture.h>
#include <osgGeoFX/offscreen/SceneRenderer.h>
#include <osgGeoFX/viewer/Scene.h>

#include <osg/Image>
#include <osg/Matrixd>

#include <functional>
#include <map>
#include <memory>
#include <optional>
#include <string>

namespace osgGeoFX
{

/// The size of a print, pixels, and its resolution.
/// @ingroup print
struct OSGGEOFXMAPS_EXPORT PrintSize
{
    int width = 0;
    int height = 0;
    double dpi = 0.0; ///< pixels for each inch; 0: not said

    /** Reads "1600x900", "1600x900@300dpi", "A1@300dpi", "A1-portrait@300dpi" (the usual one is landscape), "90x60cm@200dpi" or
        "36x24in@300dpi". A0 to A6, Letter, Legal and Tabloid, in any case; paper without a resolution gets 300. Empty, with a sentence in `error` that tells what can be had, if it is none of these, or
        has a side of no pixel or of more than 200,000. */
    static std::optional<PrintSize> parse(const std::string& text, std::string& error);
};

/** Writes pictures of any size, far beyond what the GPU can draw at once.

    It draws tiles, keeps each one as a file in a work folder, and puts them together row by row, with names over them. So memory has one row
    of tiles, and a print that was interrupted goes on with the tiles that are there. Tiles show the same deformed world (CameraRole), so there
    are no seams.

    One thread at a time.
    @ingroup print */
class OSGGEOFXMAPS_EXPORT PicturePrint
{
public:
    struct Options
    {
        PrintSize size;
        int bits = 8;                    ///< of each channel, 8 or 16; OpenEXR always gets 16
        int tile = 2048;                 ///< the longest side of a tile, pixels, 64…16,384
        SceneRenderer::Options renderer; ///< sizes and format in it do not count
        osg::ref_ptr<NameSet> names;     ///< null for none
        /// Draws below the names onto some rows of the picture, which have its bits, such as lines; empty: nothing. `top`: the picture's
        /// row, from the uppermost one, that is the uppermost of the image.
        std::function<void(osg::Image& rows, int top)> overlay;
        /// Whether overlay and names are drawn on the picture; false for those that become vectors.
        bool drawOver = true;
        /// Called with the placed names when all tiles are there; empty for nobody.
        std::function<void(const LabelPicture& names)> placed;
        /// A file for the picture with the overlay and without names, of 8 bits, such as a web page is made of; empty: none.
        std::string plain;
        std::string
            work; ///< the folder for tiles, an OwnFolder; it is made, and removed when the picture is there
        /// What the picture is made of, in any words: tiles of a former run are used only if it is the same.
        std::string recipe;
        /// Metadata to be written, by name and value.
        std::map<std::string, std::string> metadata;
        std::function<void(int done, int all)> progress; ///< called after each tile; empty for nobody
    };

    /** A print whose tiles are drawn one by one, by any number of processes that have the same options and a shared folder for tiles.
        write() then puts them together. The tiles have the same bytes whoever draws them. Null, with a sentence in `error`, if the folder cannot be
        made. `scene` must outlive it. */
    static std::unique_ptr<PicturePrint> create(Scene& scene, const Options& options,
                                                const osg::Matrixd& view, const std::string& file,
                                                std::string& error);
    ~PicturePrint();
    PicturePrint(const PicturePrint&) = delete;
    PicturePrint& operator=(const PicturePrint&) = delete;

    /// The number of tiles of a print of this size.
    static int countTiles(const Options& options);
    /// Whether a tile, from 0, row by row, is in the folder.
    bool isDrawn(int tile) const;
    /// Draws a tile unless it is in the folder. False, with a sentence in `error`, if it cannot.
    bool draw(int tile, std::string& error);

    /// Whether a picture should be printed in tiles: whether it is larger than what any GPU draws at once.
    static bool isLarge(const PrintSize& size) { return size.width > 4096 || size.height > 4096; }

    /** Draws a scene from a view matrix and writes it. The file's extension names the format: png, tif, jpg, exr (linear, half floats), or any other one that
        OpenImageIO writes; tiff files beyond 4 GB are BigTIFF. Formats without 16 bits are refused where these are wanted. A whole file or none is written. False, with a sentence in `error`, if it cannot; finished
        tiles stay. `scene`: its node gets a child that reads depths. */
    static bool write(Scene& scene, const Options& options, const osg::Matrixd& view, const std::string& file,
                      std::string& error);

private:
    struct Parts;
    explicit PicturePrint(std::unique_ptr<Parts> parts);
    std::unique_ptr<Parts> _parts;
};

} // namespace osgGeoFX
