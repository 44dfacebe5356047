// SPDX-License-Identifier: MIT
// SPDX-FileCopyrightText: 2026 the osgGeoFX authors
#include <osgGeoFX/labels/NameFile.h>

#include <osgGeoFX/labels/detail/DataPlugin.h>

namespace osgGeoFX
{

bool NameFile::read(std::string& error)
{
    return askDataPlugin("names", this, file, error);
}

} // namespace osgGeoFX
