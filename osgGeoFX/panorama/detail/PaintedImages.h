// SPDX-License-Identifier: MIT
// SPDX-FileCopyrightText: 2026 the osgGeoFX authors
#pragma once

#include <osg/Image>
#include <osg/ref_ptr>

namespace osgGeoFX
{

/// What makeSky() gives, painted on the spot, which takes half a second for the usual one.
osg::ref_ptr<osg::Image> paintSky(int width, int height, unsigned seed, double season);

/// What makeBrushTexture() gives, painted on the spot.
osg::ref_ptr<osg::Image> paintBrush(int side);

/// The sky and the brush texture of a map that has chosen nothing.
struct UsualPaintings
{
    static constexpr int SKY_WIDTH = 4096, SKY_HEIGHT = 256, BRUSH_SIDE = 512;
    static constexpr unsigned SEED = 1;
    static constexpr double SEASON = 0.5;
};

} // namespace osgGeoFX
