// SPDX-License-Identifier: MIT
// SPDX-FileCopyrightText: 2026 the osgGeoFX authors
#include <osgGeoFX/map/SequenceFile.h>

#include <osgGeoFX/labels/detail/DataPlugin.h>

namespace osgGeoFX
{

bool SequenceFile::read(std::string& error)
{
    return askDataPlugin("sequence", this, file, error);
}

} // namespace osgGeoFX
