// SPDX-License-Identifier: MIT
// SPDX-FileCopyrightText: 2026 the osgGeoFX authors
#pragma once

#include <osgGeoFX/effect/Deformation.h>

#include <osg/Drawable>
#include <osg/LOD>
#include <osg/StateSet>

#include <vector>

namespace osgGeoFX
{

/// Selects the parts of a scene that a pass draws again, and the states to draw them with. The pass asks it while it
/// culls. Only one thread at a time may use an object.
/// @ingroup effect
class PassFilter
{
public:
    /// Whether nothing within a sphere is wanted. The sphere is undeformed, in eye space, metres.
    virtual bool outside(const Ball& ball) const = 0;
    /** The states to draw a drawable with, once with each; none if the drawable is not wanted. They stand above the
        drawable's own state set, so a value that must win needs OVERRIDE. `box`: undeformed, in eye space.
        `modelView`: from the frame of the drawable to eye space. `ownProgram`: a program of the application draws
        it. A drawable whose program does not call geofx_vertex(), and is not adapted, is never drawn. */
    virtual const std::vector<osg::StateSet*>& states(const osg::Drawable& drawable, const EyeBox& box,
                                                      const osg::Matrixd& modelView, bool ownProgram) = 0;
    /// Called for each node with levels of detail that is not outside.
    virtual void meet(const osg::LOD&) {}
    /// The drawable to draw in place of the one that states() was asked about last. By default it is the same one; null
    /// draws nothing.
    virtual osg::Drawable* drawn(osg::Drawable& drawable) { return &drawable; }

protected:
    ~PassFilter() = default;
};

} // namespace osgGeoFX
