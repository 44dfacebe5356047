// SPDX-License-Identifier: MIT
// SPDX-FileCopyrightText: 2026 the osgGeoFX authors
#pragma once

#include <osgGeoFX/effect/Deformation.h>
#include <osgGeoFX/effect/ViewGeometry.h>
#include <osgGeoFX/light/detail/GroundBelow.h>

#include <osg/Matrixd>
#include <osg/Vec3d>

#include <cstddef>
#include <vector>

namespace osgGeoFX
{

/** The texels of shadow maps in the world: a lattice across the sun's rays. A camera that moves leaves it where it is, so the
    edges of shadows stay as they are. A sun that moves turns it about the place where the camera is.

    It remembers, so each camera needs one. Coordinates are those of the EffectScene's children. */
class ShadowGrid
{
public:
    /// `towards`: to the sun, of length 1. `here`: about which the lattice turns.
    void turn(const osg::Vec3d& towards, const osg::Vec3d& here);
    const osg::Vec3d& towards() const { return _towards; }
    const osg::Vec3d& right() const { return _right; }
    const osg::Vec3d& up() const { return _up; }
    /// A place moved to a corner of the lattice, across the rays by less than `step` along each axis, along them by less than
    /// `along`; both in metres.
    osg::Vec3d snapped(const osg::Vec3d& place, double step, double along) const;

private:
    bool _known = false;
    osg::Vec3d _origin, _towards, _right, _up;
};

/// One of the maps: a box along the sun's rays, in the view's eye space.
struct ShadowCascade
{
    osg::Vec3d center;
    double radius = 0.0; ///< half of its width and height across the rays, metres
    double depth = 0.0;  ///< half of its length along them
    double texel = 0.0;  ///< the side of a texel, metres
    /// From eye space to places in the map, 0…1; the third one grows away from the sun.
    osg::Matrixd toMap;
};

/** The maps of one view, the sharpest first, each four times as wide as the one before it.

    Their widths are powers of 4, and their places follow the eye and where it looks to along the ground, so they do not
    depend on what is in the picture: a bend shows ground that the plain picture does not have. They follow in steps of some texels,
    so that a map can stay as it is for some frames. */
class ShadowCascades
{
public:
    static constexpr int most = 6;
    static constexpr double step = 4.0;
    static constexpr double smallest = 64.0; ///< metres, the least radius that an eye's height leads to
    static constexpr int stride = 8;         ///< texels by which a map moves

    /// `towards`: to the sun, in the view's eye space. `nearest`: the radius of the first one; 0 goes by the eye's height above
    /// the ground below it. `count`: 1…most. `texels`: along the side of a map.
    ShadowCascades(const ViewGeometry& view, const GroundBelow& ground, ShadowGrid& grid,
                   const osg::Vec3d& towards, double nearest, int count, int texels);

    const std::vector<ShadowCascade>& all() const { return _all; }
    /// How much the first one counts, 0…1, where it comes or goes as the eye rises or sinks.
    double firstShare() const { return _firstShare; }
    /// Whether nothing within a sphere in eye space throws a shadow into a map.
    bool outside(std::size_t cascade, const Ball& ball) const;

private:
    std::vector<ShadowCascade> _all;
    double _firstShare = 1.0;
    osg::Vec3d _towards, _right, _up; ///< the grid's axes, in eye space
};

} // namespace osgGeoFX
