// SPDX-License-Identifier: MIT
// SPDX-FileCopyrightText: 2026 the osgGeoFX authors
#pragma once

#include "Suite.h"

namespace geofx::bench
{

/// What a deformed terrain costs: its frames, its culling, its tiles, picking in it.
Suite deformationSuite();

} // namespace geofx::bench
