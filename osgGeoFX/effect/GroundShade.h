// SPDX-License-Identifier: MIT
// SPDX-FileCopyrightText: 2026 the osgGeoFX authors
#pragma once

#include <osgGeoFX/Export.h>

#include <osg/Drawable>
#include <osg/StateSet>

namespace osgGeoFX
{

/** Drawables that lie on the ground and darken it, such as the shade at the foot of a town's buildings.

    Such a drawable has vertices on the ground, and in their colors' alpha the share of the ground's color that they take, 0 to 1.
    Effects deform it as they deform the ground. It is drawn after the ground and what stands on it. It hides nothing, since it
    writes no depth; it throws no shadow, and the kit's own picking and the heights of names and lines pass over it. Where
    several lie on one place, each takes its share of what the others leave, in any order.

    OpenGL's fixed functions draw it, too, if depths grow with the distance. In a scene with effects, any depths do.

    The functions only read. Any thread may call them.
    @ingroup effect */
struct OSGGEOFX_EXPORT GroundShade
{
    /// In force in the drawable's own state set; it is how the kit knows them.
    static constexpr const char* define = "GEOFX_GROUND_SHADE";

    static bool is(const osg::Drawable& drawable)
    {
        const osg::StateSet* state = drawable.getStateSet();
        return state && state->getDefinePair(define);
    }
    /// The state set of these drawables. The colors need no light and no texture.
    static osg::ref_ptr<osg::StateSet> createState();
    /// What stands above it where depths fall with the distance.
    static osg::ref_ptr<osg::StateSet> createReversed();
};

} // namespace osgGeoFX
