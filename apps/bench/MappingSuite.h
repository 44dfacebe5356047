// SPDX-License-Identifier: MIT
// SPDX-FileCopyrightText: 2026 the osgGeoFX authors
#pragma once

#include "Suite.h"

namespace geofx::bench
{

/// Projective mappings: the paper's Table 1 with our numbers, the grid against the list of all, many mappings, edits.
Suite mappingSuite();

} // namespace geofx::bench
