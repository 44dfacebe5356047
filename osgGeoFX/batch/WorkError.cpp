// SPDX-License-Identifier: MIT
// SPDX-FileCopyrightText: 2026 the osgGeoFX authors
#include <osgGeoFX/batch/WorkError.h>

namespace osgGeoFX
{

WorkError::~WorkError() = default;

} // namespace osgGeoFX
