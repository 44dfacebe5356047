// SPDX-License-Identifier: MIT
// SPDX-FileCopyrightText: 2026 the osgGeoFX authors
#pragma once

#include "SceneXml.h"

namespace osgGeoFX
{

/// Reads what stands inside <closeUps> into the effect, whose own properties are set. Opens no file.
SceneCloseUps readCloseUps(const SceneXml& xml, xmlNode* element, CloseUps& effect);

} // namespace osgGeoFX
