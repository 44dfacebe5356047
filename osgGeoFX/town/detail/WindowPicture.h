// SPDX-License-Identifier: MIT
// SPDX-FileCopyrightText: 2026 the osgGeoFX authors
#pragma once

#include <osgGeoFX/town/detail/Building.h>

#include <osg/Image>
#include <osg/StateSet>

namespace osgGeoFX
{

/** The picture that walls are drawn with: one for all of a town, made by rules. It is multiplied with a wall's color.

    It has a band of storeys for each use, `columns` windows wide, and repeats sideways. Ground floors of all bands are at the
    row `ground`. A band has `above` storeys from there on, and `ground` storeys below for slopes. A strip at the top is white,
    for what has no windows. */
struct WindowPicture
{
    static constexpr int columns = 8, above = 16, ground = 8, rows = above + ground;
    static constexpr int cell = 16; ///< texels along a window's part of the wall

    static osg::ref_ptr<osg::Image> create();
    /// The mean of a band, 0 to 1, in red, green and blue.
    static osg::Vec3d mean(BuildingUse use);

    /// v of a storey of a band, counted from the ground floor's lower edge; −ground to above.
    static double storey(BuildingUse use, double storeys);
    /// A texture coordinate in the white strip.
    static osg::Vec2d plain();
};

/// The state of a town: this picture, colors of vertices that count in light, and what RigidParts needs.
osg::ref_ptr<osg::StateSet> createTownState();

} // namespace osgGeoFX
