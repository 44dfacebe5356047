// SPDX-License-Identifier: MIT
// SPDX-FileCopyrightText: 2026 the osgGeoFX authors
#include <osgGeoFX/map/RouteFile.h>

#include <osgGeoFX/labels/detail/DataPlugin.h>

namespace osgGeoFX
{

bool RouteFile::read(std::string& error)
{
    return askDataPlugin("routes", this, file, error);
}

} // namespace osgGeoFX
