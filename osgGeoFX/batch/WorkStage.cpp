// SPDX-License-Identifier: MIT
// SPDX-FileCopyrightText: 2026 the osgGeoFX authors
#include <osgGeoFX/batch/WorkStage.h>

namespace osgGeoFX
{

WorkStage::~WorkStage() = default;

} // namespace osgGeoFX
