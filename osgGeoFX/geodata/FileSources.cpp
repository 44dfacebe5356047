// SPDX-License-Identifier: MIT
// SPDX-FileCopyrightText: 2026 the osgGeoFX authors
#include <osgGeoFX/geodata/FileSources.h>

#include <osgGeoFX/geodata/detail/DataGuard.h>
#include <osgGeoFX/geodata/detail/GdalSupport.h>
#include <osgGeoFX/geodata/detail/TileAddress.h>
#include <osgGeoFX/paging/FilesByOthers.h>

#include <cpl_minixml.h>
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

struct XmlDestroyer
{
    void operator()(CPLXMLNode* node) const { CPLDestroyXMLNode(node); }
};
using Xml = std::unique_ptr<CPLXMLNode, XmlDestroyer>;

std::string textOf(const CPLXMLNode& node)
{
    for (const CPLXMLNode* child = node.psChild; child; child = child->psNext)
        if (child->eType == CXT_Text) return child->pszValue;
    return {};
}

std::string attributeOf(const CPLXMLNode& node, const char* name)
{
    for (const CPLXMLNode* child = node.psChild; child; child = child->psNext)
        if (child->eType == CXT_Attribute && EQUAL(child->pszValue, name)) return textOf(*child);
    return {};
}

bool namesFile(const CPLXMLNode& node)
{
    constexpr const char* elements[] = {"SourceFilename", "SourceDataset", "SrcDataSource", "IndexDataset",
                                        "FileName",       "OverviewFile",  "Filename"};
    if (std::any_of(std::begin(elements), std::end(elements),
                    [&](const char* element) { return EQUAL(node.pszValue, element); }))
        return true;
    // Rasters of places, such as X_DATASET and Y_DATASET.
    const std::string key = EQUAL(node.pszValue, "MDI") ? attributeOf(node, "key") : std::string();
    return key.size() > 7 && EQUAL(key.c_str() + key.size() - 7, "DATASET");
}

/// What GDAL makes of a name in a virtual file.
std::string complete(const std::string& name, bool beside, const std::string& file)
{
    const bool isPath = !name.empty() && name[0] != '<' && name.rfind("/vsi", 0) != 0 &&
                        name.find("://") == std::string::npos;
    if (!isPath) return name;
    std::error_code code;
    const fs::path folder = beside ? fs::path(file).parent_path() : fs::current_path(code);
    return (folder / name).lexically_normal().string();
}

void collect(const CPLXMLNode* node, const std::string& file, std::vector<std::string>& names)
{
    for (; node; node = node->psNext)
    {
        if (node->eType != CXT_Element) continue;
        const std::string name = namesFile(*node) ? textOf(*node) : std::string();
        if (!name.empty()) names.push_back(complete(name, attributeOf(*node, "relativeToVRT") == "1", file));
        collect(node->psChild, file, names);
    }
}

/// The XML of a virtual raster or virtual vector data; null for any other file.
Xml virtualFile(const std::string& file)
{
    std::error_code code;
    if (fs::file_size(file, code) > largestDescription || code) return nullptr;
    std::ifstream stream(file, std::ios::binary);
    std::string text(1024, '\0');
    stream.read(text.data(), static_cast<std::streamsize>(text.size()));
    text.resize(static_cast<std::size_t>(stream.gcount()));
    if (text.find('<') == std::string::npos) return nullptr;
    stream.clear();
    text.append(std::istreambuf_iterator<char>(stream), std::istreambuf_iterator<char>());
    const std::size_t root = std::min(text.find("<VRTDataset"), text.find("<OGRVRTDataSource"));
    if (root == std::string::npos) return nullptr;
    return Xml(CPLParseXMLString(text.c_str() + root));
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
    if (const Xml xml = virtualFile(file))
    {
        // Not opened: that would open what it names.
        collect(xml.get(), file, result.files);
        return result;
    }
    if (!driver) return result;
    const DatasetPtr dataset(GDALDataset::Open(file.c_str(), GDAL_OF_RASTER | GDAL_OF_VECTOR));
    const CPLStringList files(dataset ? dataset->GetFileList() : nullptr);
    for (int i = 0; i < files.size(); ++i)
    {
        const std::string name = complete(files[i], false, file);
        if (name != file) result.files.push_back(name);
    }
    return result;
}

bool FileSources::isFormatByOthers(const std::string& format)
{
    return osgGeoFX::isFormatByOthers(format);
}

} // namespace osgGeoFX
