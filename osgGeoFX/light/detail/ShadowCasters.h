// SPDX-License-Identifier: MIT
// SPDX-FileCopyrightText: 2026 the osgGeoFX authors
#pragma once

#include <osgGeoFX/effect/Deformation.h>
#include <osgGeoFX/light/detail/ShadowCascades.h>

#include <osg/Drawable>
#include <osg/Observer>
#include <osg/ref_ptr>

#include <array>
#include <cstdint>
#include <vector>

namespace osgGeoFX
{

/** What was drawn into a shadow map, and where the map lay: as long as neither changes, the map stays right. It holds no drawable,
    and it is not misled by another one at the address of one that is gone. */
class ShadowCasters
{
public:
    /// Begins a map anew. `toWorld`: from the view's eye space.
    void begin(const ShadowCascade& cascade, const osg::Matrixd& toWorld);
    /// A drawable whose box is given in eye space.
    void add(const osg::Drawable& drawable, const EyeBox& box);
    /// Whether a map with all this is that one. Not if something changes by means that nobody can see from outside.
    bool same(const ShadowCasters& other) const;

private:
    struct Caster
    {
        osg::ref_ptr<osg::ObserverSet> who;
        std::uint64_t contents = 0;
        std::array<osg::Vec3d, 4> place; ///< the middle of its box and three half edges, in the world
    };

    osg::Matrixd _toWorld;
    double _slack = 0.0; ///< metres, by which places may differ by rounding
    std::array<osg::Vec3d, 4> _frame;
    double _radius = 0.0, _depth = 0.0;
    bool _changing = false;
    std::vector<Caster> _casters;
};

} // namespace osgGeoFX
