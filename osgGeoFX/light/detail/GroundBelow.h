// SPDX-License-Identifier: MIT
// SPDX-FileCopyrightText: 2026 the osgGeoFX authors
#pragma once

#include <osgGeoFX/effect/ScenePass.h>

namespace osgGeoFX
{

/// How far the ground lies straight below the eye, metres. How large a picture shows the ground goes by the first number, where its
/// shadows lie by the second one.
struct GroundBelow
{
    double drawn = 0.0;      ///< down to the ground as it is drawn, at least 0
    double undeformed = 0.0; ///< down to where that place lies undeformed; less than 0 above the eye

    /// Looks at the loaded tiles at the level that is drawn. Beside them the lowest ground that is stated counts, but not what lies
    /// below the sea. Things that keep their shape (RigidParts, RigidReference) are no ground.
    static GroundBelow find(const ScenePass& pass);
};

} // namespace osgGeoFX
