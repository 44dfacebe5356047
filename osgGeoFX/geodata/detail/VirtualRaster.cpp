// SPDX-License-Identifier: MIT
// SPDX-FileCopyrightText: 2026 the osgGeoFX authors
#include <osgGeoFX/geodata/detail/VirtualRaster.h>

#include <osgGeoFX/geodata/BuildError.h>

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

void addVirtualRaster(DatasetChain& chain, const std::vector<std::string>& arguments, const std::string& name)
{
    const GdalErrorScope errors;
    if (!addVirtualRaster(chain, arguments))
        throw BuildError(name + ": its bands cannot be used (" + errors.message() +
                         "); convert it to GeoTIFF with gdal_translate.");
}

} // namespace osgGeoFX
