// SPDX-License-Identifier: MIT
// SPDX-FileCopyrightText: 2026 the osgGeoFX authors
#pragma once

#include <osgGeoFX/Export.h>
#include <osgGeoFX/labels/NameSet.h>
#include <osgGeoFX/offscreen/SceneRenderer.h>
#include <osgGeoFX/print/PicturePrint.h>
#include <osgGeoFX/viewer/Scene.h>

#include <osg/Image>
#include <osg/Matrixd>

#include <functional>
#include <string>
#include <vector>

namespace osgGeoFX
{

/** Writes a picture as layers, for people who finish it by hand.

    Colors, PNG with straight alpha, from the lowest to the uppermost:
    - `sky.png`: what stands behind the ground, also the sea and the haze beyond the data;
    - `terrain.png`: the ground without shade, forest and water, and `shade.tif`: the factors for its colors, floats;
    - `forest.png` and `water.png` (with its reflections), where a panorama map paints them; `strokes.png`: its trees, houses and lines;
    - `labels.png`: the names, and whatever a program draws over its pictures.

    Values: `classes.png` (a byte, named in `layers.json`), `distance.tif` (metres from the eye, as drawn), `height.tif` (metres) and
    `lonlat.tif` (degrees, two bands of doubles, since floats would be metres off). They are those of the ground at the middle of each pixel, as
    DeformedView::pick() tells; none is NaN, and class 0.

    `layers.json` lists the files, and what this picture does not have and why. It tells how they are put together: the result is
    the picture within 2/255. Colors that an own program of the application draws are in `terrain.png`.

    One thread at a time.
    @ingroup print */
class OSGGEOFXMAPS_EXPORT PictureLayers
{
public:
    /// What a program draws over finished pictures, as a layer of its own.
    struct Overlay
    {
        std::string name;    ///< of the file, without extension
        std::string meaning; ///< a sentence for `layers.json`
        /// Draws onto some rows of the picture, 8 bits of RGB. `top`: the picture's row, from the uppermost one, that is the uppermost of the
        /// image. It must draw the same onto any color, with one transparency for all channels.
        std::function<void(osg::Image& rows, int top)> draw;
        bool belowNames = false;
    };

    struct Options
    {
        PrintSize size;
        /// The longest side of what is drawn at once, pixels, 64…16,384. That of the picture: where its sides have no divisor, edges of strokes
        /// depend on it.
        int tile = 2048;
        SceneRenderer::Options renderer; ///< sizes and format in it do not count
        osg::ref_ptr<NameSet> names;     ///< null for none
        std::vector<Overlay> overlays;   ///< the lowest first
        std::function<void(int done, int all)>
            progress; ///< called after each part that is drawn; empty for nobody
    };

    /// Makes the folder where there is none, in a folder that is there. False, with a sentence in `error`, if layers cannot be written there.
    static bool prepare(const std::string& folder, std::string& error);

    /// The names that files of layers may have, but for those of overlays.
    static std::vector<std::string> fileNames();

    /** Draws a scene from a view matrix, several times, and writes its layers into a folder; memory has one row of tiles. False, with a sentence
        in `error`, if it cannot. No other renderer may show the scene meanwhile. */
    static bool write(const Scene& scene, const Options& options, const osg::Matrixd& view,
                      const std::string& folder, std::string& error);
};

} // namespace osgGeoFX
