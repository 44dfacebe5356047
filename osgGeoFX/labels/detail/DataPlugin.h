// SPDX-License-Identifier: MIT
// SPDX-FileCopyrightText: 2026 the osgGeoFX authors
#pragma once

#include <string>

namespace osgGeoFX
{

/// Asks the plugin `osgdb_geofxdata` for a service that needs GDAL. `request`: what the service reads and fills; `file`: the one that it
/// reads, for sentences. False, with a sentence in `error`, if it cannot.
bool askDataPlugin(const std::string& service, void* request, const std::string& file, std::string& error);

} // namespace osgGeoFX
