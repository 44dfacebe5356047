// SPDX-License-Identifier: MIT
// SPDX-FileCopyrightText: 2026 the osgGeoFX authors
#include <osgGeoFX/scene/PassEffect.h>

namespace osgGeoFX
{

ScenePass::~ScenePass() = default;

PassEffect::~PassEffect() = default;

} // namespace osgGeoFX
