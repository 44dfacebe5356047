// SPDX-License-Identifier: MIT
// SPDX-FileCopyrightText: 2026 the osgGeoFX authors
#include <osgGeoFX/lines/LineFile.h>

#include <osgGeoFX/labels/detail/DataPlugin.h>

namespace osgGeoFX
{

bool LineFile::read(std::string& error)
{
    return askDataPlugin("lines", this, file, error);
}

} // namespace osgGeoFX
