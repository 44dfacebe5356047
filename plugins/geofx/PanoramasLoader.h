// SPDX-License-Identifier: MIT
// SPDX-FileCopyrightText: 2026 the osgGeoFX authors
#pragma once

#include "SceneLoading.h"

namespace osgGeoFX
{

/// Gives the panorama maps of a scene the pictures that it names. Throws SceneFailure.
void loadPanoramas(const SceneFile& scene);

} // namespace osgGeoFX
