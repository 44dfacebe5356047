// SPDX-License-Identifier: MIT
// SPDX-FileCopyrightText: 2026 the osgGeoFX authors
#include <osgGeoFX/geodata/FileSources.h>

#include <osgGeoFX/geodata/detail/DataGuard.h>
#include <osgGeoFX/geodata/detail/GdalSupport.h>
#include <osgGeoFX/geodata/detail/TileAddress.h>
#include <osgGeoFX/geodata/detail/VirtualNames.h>
#include <osgGeoFX/paging/FilesByOthers.h>

#include <cpl_string.h>

#include <algorithm>
#include <cstring>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <memory>
#include <set>

namespace osgGeoFX
{

namespace
{

namespace fs = std::filesystem;

/// Formats whose files only say where in a network or a data base the data are.
const std::set<std::string> services = {
    "AmigoCloud", "Carto",  "CSW",    "DAAS",      "EEDA",         "EEDAI",    "Elasticsearch",
    "GeoRaster",  "HANA",   "HTTP",   "MongoDBv3", "MSSQLSpatial", "MySQL",    "NGW",
    "OAPIF",      "OCI",    "ODBC",   "OGCAPI",    "PLMOSAIC",     "PLSCENES", "PostGISRaster",
    "PostgreSQL", "STACIT", "STACTA", "WCS",       "WFS",          "WMS",      "WMTS"};

/// XML beyond this is no description of data.
constexpr std::uintmax_t largestDescription = 64u << 20u;

/// The XML of a virtual raster or virtual vector data; empty for any other file.
std::string virtualFile(const std::string& file)
{
    std::error_code code;
    if (fs::file_size(file, code) > largestDescription || code) return {};
    std::ifstream stream(file, std::ios::binary);
    std::string text(1024, '\0');
    stream.read(text.data(), static_cast<std::streamsize>(text.size()));
    text.resize(static_cast<std::size_t>(stream.gcount()));
    if (text.find('<') == std::string::npos) return {};
    stream.clear();
    text.append(std::istreambuf_iterator<char>(stream), std::istreambuf_iterator<char>());
    const std::size_t root = std::min(text.find("<VRTDataset"), text.find("<OGRVRTDataSource"));
    return root == std::string::npos ? std::string() : text.substr(root);
}

} // namespace

FileSources FileSources::of(const std::string& file)
{
    // Whatever the file holds, nothing is fetched.
    const FilesByOthers::Scope scope(FilesByOthers::Scope::folder().value_or("/"));
    initialiseGdal();
    const GdalErrorScope quiet;
    FileSources result;
    // Whoever reads it says so.
    if (!faultOfArchive(file).empty()) return result;
    if (TileAddress::is(file))
    {
        result.service = "WMS";
        return result;
    }
    GDALDriverH driver =
        GDALIdentifyDriverEx(file.c_str(), GDAL_OF_RASTER | GDAL_OF_VECTOR, nullptr, nullptr);
    const std::string format = driver ? GDALGetDriverShortName(driver) : "";
    if (services.count(format) > 0)
    {
        result.service = format;
        return result;
    }
    const std::string xml = virtualFile(file);
    if (!xml.empty())
    {
        // Not opened: that would open what it names.
        result.files = VirtualNames::in(xml, file);
        return result;
    }
    if (!driver) return result;
    const DatasetPtr dataset(GDALDataset::Open(file.c_str(), GDAL_OF_RASTER | GDAL_OF_VECTOR));
    const CPLStringList files(dataset ? dataset->GetFileList() : nullptr);
    for (int i = 0; i < files.size(); ++i)
    {
        const std::string name = VirtualNames::complete(files[i], false, file);
        if (name != file) result.files.push_back(name);
    }
    return result;
}

bool FileSources::isFormatByOthers(const std::string& format)
{
    return osgGeoFX::isFormatByOthers(format);
}

} // namespace osgGeoFX
