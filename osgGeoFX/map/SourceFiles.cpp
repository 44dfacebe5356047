// SPDX-License-Identifier: MIT
// SPDX-FileCopyrightText: 2026 the osgGeoFX authors
#include <osgGeoFX/map/SourceFiles.h>

#include <osgGeoFX/labels/detail/DataPlugin.h>

namespace osgGeoFX
{

bool SourceFiles::read(std::string& error)
{
    return askDataPlugin("sources", this, file, error);
}

} // namespace osgGeoFX
