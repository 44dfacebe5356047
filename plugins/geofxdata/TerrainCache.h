// SPDX-License-Identifier: MIT
// SPDX-FileCopyrightText: 2026 the osgGeoFX authors
#pragma once

#include <geofx/SceneFile.h>

namespace osgGeoFX
{

/** The database of a scene's rasters, built if it is not in the cache yet: the path of its terrain.osgb.

    A folder in the cache is named after a hash of all that the database depends on, so changed sources get a
   new one. An interrupted build is resumed. Of several programs at once one builds, and the others wait for
   it. Progress goes to the standard error output. Throws BuildError. */
std::string cachedTerrain(const SceneRasters& rasters);

} // namespace osgGeoFX
