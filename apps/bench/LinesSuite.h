// SPDX-License-Identifier: MIT
// SPDX-FileCopyrightText: 2026 the osgGeoFX authors
#pragma once

#include "Suite.h"

namespace geofx::bench
{

Suite linesSuite();

} // namespace geofx::bench
