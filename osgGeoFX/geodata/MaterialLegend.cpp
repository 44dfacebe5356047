// SPDX-License-Identifier: MIT
// SPDX-FileCopyrightText: 2026 the osgGeoFX authors
#include <osgGeoFX/geodata/MaterialLegend.h>

#include <osgGeoFX/geodata/LandCoverTable.h>

namespace osgGeoFX
{

osg::ref_ptr<MaterialCover> readMaterialCover(const std::string& file, unsigned int unit)
{
    const osg::ref_ptr<MaterialCover> result = new MaterialCover(unit);
    for (const LandCoverClass& each : readLandCoverTable(file))
    {
        // A class without a name is no one's material.
        if (!each.id.empty()) result->setCover(each.id, {each.trees, each.town, each.bare, each.water});
    }
    return result;
}

} // namespace osgGeoFX
