// SPDX-License-Identifier: MIT
// SPDX-FileCopyrightText: 2026 the osgGeoFX authors
#pragma once

#include <osgGeoFX/effect/ScenePass.h>

#include <osg/Vec3d>

#include <string>

namespace osgGeoFX
{

/// The sun that OpenGL will light a pass' camera with: its light 0, as OSG applies the lights that it meets on its way through the
/// graph. Where several have the number 0, the last one counts, also one that stands behind the scene. The headlight of a view is
/// no sun.
struct Sun
{
    enum Kind
    {
        NONE,         ///< there is no light 0
        OTHER_NUMBER, ///< no light 0, but another one with a direction
        WITHOUT_RAYS, ///< light 0 has a place, not a direction
        DARK,         ///< light 0 has no diffuse color, as at night
        SHINING
    };
    Kind kind = NONE;
    osg::Vec3d towards; ///< of length 1, in the eye space of the view; while it shines
    int number = 0;     ///< of the light that has another number

    static Sun find(const ScenePass& pass);
    /// What to tell who expects shadows and gets none; empty where all is well.
    std::string complaint() const;
};

} // namespace osgGeoFX
