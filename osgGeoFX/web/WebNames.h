// SPDX-License-Identifier: MIT
// SPDX-FileCopyrightText: 2026 the osgGeoFX authors
#pragma once

#include <osgGeoFX/Export.h>
#include <osgGeoFX/labels/NameSet.h>
#include <osgGeoFX/paging/Georeference.h>
#include <osgGeoFX/scene/DepthReader.h>

#include <osg/Matrixd>

#include <memory>
#include <optional>
#include <string>
#include <vector>

namespace osgGeoFX
{

/// A name of a picture that people zoom: where it stands at which zooms. A plain value.
/// @ingroup web
struct WebName
{
    std::string text;
    std::string style; ///< its name; empty for the usual one
    NameStyle look;
    bool alongCurve = false;
    osg::Vec2d
        anchor; ///< the place itself, or the middle of its curve: pixels of the picture, from its upper left corner
    std::vector<osg::Vec2d>
        curve;       ///< of a name along a curve, in the reading direction; pixels of the picture
    osg::Vec2d size; ///< of the text's box, pixels of the screen
    std::optional<double> longitude, latitude; ///< degrees
    std::optional<double> height; ///< metres: as the data say it, or else the ground's; of one place only

    /// Zooms at which the name is shown, and where.
    struct Shown
    {
        int from = 0, to = 0; ///< steps, both included
        osg::Vec2d corner; ///< the upper left corner of the text's box, from the anchor; pixels of the screen
    };
    std::vector<Shown> shown; ///< none, if there is no room at any zoom
};

/** Lays the names of a picture out for each zoom. At each one no two overlap. Those of the zoom before stay, and more important ones come first.
    Within a zoom names keep their places as one zooms in, as long as they can.

    Zoom 0 shows the picture at most 256 pixels wide and high, as the lowest level of its tiles does; each zoom doubles that. A step is a quarter of a zoom.
    @ingroup web */
struct OSGGEOFXMAPS_EXPORT WebNames
{
    static constexpr int stepsOfZoom = 4;

    int width = 0; ///< of the picture at its highest level, pixels
    int height = 0;
    osg::Matrixd view;       ///< the picture's, from world to eye coordinates
    osg::Matrixd projection; ///< the picture's
    /// Depths of the same view, of any size; what they show to be hidden gets no name. Empty: nothing counts as hidden.
    std::vector<std::shared_ptr<const DepthPicture>> depths;
    const Georeference* reference = nullptr; ///< null: names get neither longitude nor latitude
    std::size_t most = 2000;                 ///< names at a zoom

    /// The zoom at which a pixel of the screen is one of the picture.
    int nativeZoom() const;
    /// The last step: one zoom beyond the native one.
    int lastStep() const { return stepsOfZoom * (nativeZoom() + 1); }
    /// Screen pixels for each pixel of the picture, at a step.
    double scaleAt(int step) const;

    /// The names that the picture shows, the most important ones first, in their styles' own sizes.
    std::vector<WebName> layOut(NameSet& names, EffectScene& scene) const;
};

} // namespace osgGeoFX
