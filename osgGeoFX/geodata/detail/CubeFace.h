// SPDX-License-Identifier: MIT
// SPDX-FileCopyrightText: 2026 the osgGeoFX authors
#pragma once

#include <osgGeoFX/effect/LocalOrigin.h>
#include <osgGeoFX/geodata/MappingRaster.h>

#include <osg/BoundingSphere>
#include <osg/Image>

#include <array>

namespace osgGeoFX
{

/** A sixth of the globe, as a cube around it has six faces: the part that is nearer to one of six origins than to the others. A raster that reaches around
    the globe is cut into these. */
struct CubeFace
{
    /// What lies farther than this from its own middle, radians, reaches around the globe: a frame's plane has no room for it.
    static constexpr double leastRadius = 1.0471975511965976; // 60°

    /// 0° and 180° on the equator, 90° and −90°, and both poles.
    static std::array<LocalOrigin, 6> origins();
    static bool isOrigin(const LocalOrigin& origin);

    /// Whether a face may have ground within a sphere; Earth-centered coordinates, metres. An invalid sphere is everywhere.
    static bool mayHave(const LocalOrigin& origin, const osg::BoundingSphered& ground);

    /// The square around a face in the frame of its origin.
    static MappingRaster::Window window(double texel);

    /// Makes the texels transparent that are not the face's, all but a border of two texels, over which the next face lies. `image`: RGBA bytes, or
    /// floats, whose NaN is nothing, in the window of a polar or another face. False if nothing is left.
    static bool cut(osg::Image& image, const MappingRaster::Window& window, bool polar);
};

} // namespace osgGeoFX
