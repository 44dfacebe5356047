// SPDX-License-Identifier: MIT
// SPDX-FileCopyrightText: 2026 the osgGeoFX authors
#pragma once

#include <osgGeoFX/Export.h>

#include <osg/Vec4>

#include <map>
#include <string>

namespace osgGeoFX
{

/// How lines of one kind are drawn. Pixels are those of a picture 900 pixels high. A plain value.
/// @ingroup lines
struct LineStyle
{
    osg::Vec4 color = {0.25f, 0.22f, 0.20f, 1.0f}; ///< sRGB-coded, 0…1
    osg::Vec4 casing = {1.0f, 1.0f, 1.0f, 1.0f};
    double width = 1.6;       ///< the greatest width, pixels, > 0
    double least = 0.6;       ///< the least width, pixels, > 0
    double ground = 0.0;      ///< the width on the ground, metres, between these two; 0: `width` everywhere
    double casingWidth = 0.0; ///< of an outline on each side, pixels; 0: none
    double dash = 0.0;        ///< the length of a dash on the ground, metres; 0: no dashes
    double gap = 0.0;         ///< the length of a gap, metres
    double hand = 0.15;       ///< how much a hand's pressure changes the width, 0…1
    double rank = 0.0;        ///< lines of higher ranks lie over those of lower ones
    bool straight = false;    ///< whether it runs through the air from place to place, as lifts do
    bool shown = true;
};

/** Styles for what OpenStreetMap and other maps call lines, by the words that they use: roads (motorway, primary, residential …) with
    outlines, paths (track, path, footway …) dashed, railways, lifts (cable_car, chair_lift …) through the air, water (river, stream …)
    and borders (administrative …). That of the empty name is for all others.
    @ingroup lines */
OSGGEOFXMAPS_EXPORT std::map<std::string, LineStyle> usualLineStyles();

/// The style of a name, or that of the empty one.
/// @ingroup lines
OSGGEOFXMAPS_EXPORT const LineStyle& lineStyleOf(const std::map<std::string, LineStyle>& styles,
                                                 const std::string& name);

} // namespace osgGeoFX
