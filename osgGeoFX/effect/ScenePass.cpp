// SPDX-License-Identifier: MIT
// SPDX-FileCopyrightText: 2026 the osgGeoFX authors
#include <osgGeoFX/effect/ScenePass.h>

namespace osgGeoFX
{

ScenePass::~ScenePass() = default;

} // namespace osgGeoFX
