// SPDX-License-Identifier: MIT
// SPDX-FileCopyrightText: 2026 the osgGeoFX authors
#pragma once

#include "Suite.h"

namespace geofx::bench
{

/// Flights of many frames over more terrain than fits into memory: whether memory and OpenGL's objects grow.
Suite soakSuite();

} // namespace geofx::bench
