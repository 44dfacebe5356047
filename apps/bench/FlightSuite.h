// SPDX-License-Identifier: MIT
// SPDX-FileCopyrightText: 2026 the osgGeoFX authors
#pragma once

#include "Suite.h"

namespace geofx::bench
{

/// A flight over what comes from a distant server, with a look ahead and without.
Suite flightSuite();

} // namespace geofx::bench
