// SPDX-License-Identifier: MIT
// SPDX-FileCopyrightText: 2026 the osgGeoFX authors
#include <osgGeoFX/map/OverlayFile.h>

#include <osgGeoFX/labels/detail/DataPlugin.h>

namespace osgGeoFX
{

bool OverlayFile::read(std::string& error)
{
    return askDataPlugin("overlays", this, file, error);
}

} // namespace osgGeoFX
