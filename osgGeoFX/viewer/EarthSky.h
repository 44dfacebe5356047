// SPDX-License-Identifier: MIT
// SPDX-FileCopyrightText: 2026 the osgGeoFX authors
#pragma once

#include <osgGeoFX/Export.h>

#include <osg/CoordinateSystemNode>
#include <osg/Node>
#include <osg/Vec3>

namespace osgGeoFX
{

class EffectScene;

/// Of a day of good sight, metres.
constexpr double DEFAULT_VISIBILITY = 150e3;

/// How much of the light haze scatters, to a metre, if it has left 2 % of the contrast at so many metres, above 0 (Koschmieder); 0 for
/// infinity. The density for an osg::Fog of mode EXP. From any thread.
OSGGEOFX_EXPORT double hazeDensity(double visibility);

/** Makes a sky for a geocentric scene, at any height from the ground to beyond orbit: black space, a blue rim around
    the Earth that thins out by exp(-height / 8 km), and the sky of a bright day near the ground, with haze that thins
    out by exp(-height / 1.2 km). Where no terrain is drawn, the Earth is a blue sea in this haze. `air` is the color of
    deep air and of haze, as at the horizon, 0 to 1. `visibility`: metres, above 0, at which haze at the sea has left 2 % of the
    contrast; infinity for none. Give the terrain the haze that goes with it by an osg::Fog of this color, EXP, of
    the density hazeDensity(visibility); scene files do so.

    The node is drawn before everything else of its camera. It writes no depth and does not count for near and far, so
    it never fights with the terrain. It takes the place of the camera's clear color; hide the node to have that again.
    Put it beside an EffectScene, not below: deformations do not bend it. Where a bend of `scene`, if there is one, moves the
    horizon down in the picture, as a bird's-eye view does, the sky comes down with it. Where a bend lifts the ground up into
    the sky, the sky stays. A panorama map's own sky is drawn over it. The sky does not keep the scene alive.
    It is for perspective cameras. Light is the same all around; there is no night. Each camera that culls has its own
    state, so the node may be shared by cameras and threads. */
OSGGEOFX_EXPORT osg::ref_ptr<osg::Node> makeEarthSky(const osg::EllipsoidModel& ellipsoid,
                                                     const osg::Vec3& air,
                                                     double visibility = DEFAULT_VISIBILITY,
                                                     EffectScene* scene = nullptr);

} // namespace osgGeoFX
