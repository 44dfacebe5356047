// SPDX-License-Identifier: MIT
// SPDX-FileCopyrightText: 2026 the osgGeoFX authors
#include <osgGeoFX/scene/ShaderHost.h>

namespace osgGeoFX
{

ShaderHost::~ShaderHost() = default;

} // namespace osgGeoFX
