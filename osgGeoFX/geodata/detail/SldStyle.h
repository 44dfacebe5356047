// SPDX-License-Identifier: MIT
// SPDX-FileCopyrightText: 2026 the osgGeoFX authors
#pragma once

#include <osgGeoFX/geodata/detail/FeatureStyle.h>

#include <string>

namespace osgGeoFX
{

/// Reads the rules for vector data of an SLD file (1.0 and 1.1). What is not drawn (texts, rasters) is told in the notices. Pictures must lie in the
/// file's folder or below unless `allowOutside`. Throws BuildError, with file, line and remedy.
FeatureStyle readSldStyle(const std::string& file, bool allowOutside);

} // namespace osgGeoFX
