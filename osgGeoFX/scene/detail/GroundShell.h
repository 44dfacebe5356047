// SPDX-License-Identifier: MIT
// SPDX-FileCopyrightText: 2026 the osgGeoFX authors
#pragma once

#include <osgGeoFX/effect/Deformation.h>
#include <osgGeoFX/effect/ViewGeometry.h>

#include <osg/BoundingSphere>
#include <osg/Vec3d>

#include <optional>
#include <utility>
#include <vector>

namespace osgGeoFX
{

/** The ground between its lowest and its highest height, cut into blocks along longitude, latitude and height, or along x, y and z. On a
    globe whose heights are unknown, those of the highest mountains and the deepest seas count.

    Boxes are in the terrain's frame, metres. Immutable, so every thread may use it. */
class GroundShell
{
public:
    /// Longitude and latitude, radians, and height, metres; or x, y and z, metres.
    struct Block
    {
        osg::Vec3d low, high;
    };

    /// `bound`: of the terrain, in its frame. `ground` must outlive the object.
    GroundShell(const osg::BoundingSphere& bound, const Ground& ground);

    /// Blocks that hold all ground; none if the bound is empty.
    std::vector<Block> blocks() const;
    /// A box around a block. Empty where the bound has nothing of it.
    std::optional<EyeBox> boxOf(const Block& block) const;
    /// A block in two, across its longest side.
    std::pair<Block, Block> halvesOf(const Block& block) const;

private:
    EyeBox boxOnGlobe(const Block& block) const;

    const osg::BoundingSphere _bound;
    const osg::EllipsoidModel* _ellipsoid;
    double _lowest, _highest;
};

} // namespace osgGeoFX
