// SPDX-License-Identifier: MIT
// SPDX-FileCopyrightText: 2026 the osgGeoFX authors
#pragma once

#include "SceneXml.h"

namespace osgGeoFX
{

/// Reads what stands inside <projectiveMappings> into the effect, whose own properties are set. Opens no file.
SceneMappings readMappings(const SceneXml& xml, xmlNode* element, ProjectiveMappings& effect);

} // namespace osgGeoFX
