// SPDX-License-Identifier: MIT
// SPDX-FileCopyrightText: 2026 the osgGeoFX authors
#include <osgGeoFX/geodata/detail/VirtualRaster.h>

#include <cpl_string.h>
#include <gdal_utils.h>

namespace osgGeoFX
{

bool addVirtualRaster(DatasetChain& chain, const std::vector<std::string>& arguments)
{
    CPLStringList list;
    list.AddString("-of");
    list.AddString("VRT");
    for (const std::string& argument : arguments)
        list.AddString(argument.c_str());
    GDALTranslateOptions* const options = GDALTranslateOptionsNew(list.List(), nullptr);
    GDALDatasetH result = GDALTranslate("", GDALDataset::ToHandle(&chain.top()), options, nullptr);
    GDALTranslateOptionsFree(options);
    return chain.add(DatasetPtr(GDALDataset::FromHandle(result)));
}

} // namespace osgGeoFX
