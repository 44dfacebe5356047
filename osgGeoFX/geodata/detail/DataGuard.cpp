// SPDX-License-Identifier: MIT
// SPDX-FileCopyrightText: 2026 the osgGeoFX authors
#include <osgGeoFX/geodata/detail/DataGuard.h>

#include <osgGeoFX/paging/FilesByOthers.h>

#include <cpl_conv.h>
#include <cpl_http.h>
#include <cpl_minixml.h>
#include <cpl_string.h>
#include <cpl_vsi_virtual.h>
#include <gdal_priv.h>

#include <algorithm>
#include <array>
#include <cerrno>
#include <cstring>
#include <map>
#include <memory>
#include <mutex>
#include <optional>
#include <set>
#include <utility>
#include <vector>

namespace osgGeoFX
{
namespace
{

/// Those that read through GDAL's file systems alone, or nothing but the file itself, and run nothing. SQLite reads through them, too,
/// if it is told to; netCDF's classic files name no others, while those upon HDF5 do.
const std::set<std::string> formats = {
    "AAIGrid",    "AIG",          "BIGGIF",  "BMP",         "BT",      "CSV",
    "DTED",       "DXF",          "EHdr",    "ENVI",        "ERS",     "ESRIJSON",
    "FlatGeobuf", "GIF",          "GPKG",    "GPX",         "GRIB",    "GRASSASCIIGrid",
    "GS7BG",      "GSAG",         "GSBG",    "GTiff",       "GeoJSON", "GeoJSONSeq",
    "HFA",        "JP2OpenJPEG",  "JPEG",    "KML",         "LIBKML",  "MBTiles",
    "MVT",        "MapInfo File", "OGR_GMT", "OpenFileGDB", "PNG",     "PNM",
    "RST",        "SAGA",         "SQLite",  "SRTMHGT",     "TGA",     "TopoJSON",
    "USGSDEM",    "VRT",          "WEBP",    "XYZ",         "Zarr",    "ESRI Shapefile",
    "netCDF"};

struct XmlDestroyer
{
    void operator()(CPLXMLNode* node) const { CPLDestroyXMLNode(node); }
};

/// Whether a virtual raster runs a program, or reads in threads of its own, which have no scope.
bool hasProgramsOrThreads(const CPLXMLNode* node)
{
    for (; node; node = node->psNext)
    {
        if (node->eType == CXT_Text &&
            (EQUAL(node->pszValue, "Python") || EQUAL(node->pszValue, "NUM_THREADS")))
            return true;
        if (hasProgramsOrThreads(node->psChild)) return true;
    }
    return false;
}

bool isHarmlessVirtual(const GDALOpenInfo& info)
{
    constexpr GIntBig largest = GIntBig{64} << 20;
    const char* text = info.pszFilename;
    GByte* bytes = nullptr;
    if (info.fpL)
    {
        if (!VSIIngestFile(nullptr, info.pszFilename, &bytes, nullptr, largest)) return false;
        text = reinterpret_cast<const char*>(bytes);
    }
    const std::unique_ptr<CPLXMLNode, XmlDestroyer> xml(std::strchr(text, '<') ? CPLParseXMLString(text)
                                                                               : nullptr);
    CPLFree(bytes);
    return !hasProgramsOrThreads(xml.get());
}

bool isClassicNetcdf(const GDALOpenInfo& info)
{
    if (info.nHeaderBytes < 4 || std::memcmp(info.pabyHeader, "CDF", 3) != 0) return false;
    const GByte version = info.pabyHeader[3];
    return version == 1 || version == 2 || version == 5;
}

bool isRead(const std::string& format, bool isIdentified, const GDALOpenInfo& info)
{
    if (!isFormatByOthers(format) || info.eAccess != GA_ReadOnly) return false;
    if (format == "VRT") return !isIdentified || isHarmlessVirtual(info);
    if (format == "netCDF") return isClassicNetcdf(info);
    // A virtual raster may give options to what it names; this one is SQL.
    return CSLFetchNameValue(info.papszOpenOptions, "PRELUDE_STATEMENTS") == nullptr;
}

template<typename Original>
GDALDataset* openWithin(GDALDriver& driver, GDALOpenInfo& info, const Original& original)
{
    if (!FilesByOthers::Scope::folder()) return original();
    const std::string format = driver.GetDescription();
    const bool isIdentified = driver.pfnIdentify && driver.pfnIdentify(&info) > 0;
    if (!isRead(format, isIdentified, info))
    {
        // A warning, since GDAL tries no other driver after a failure.
        if (isIdentified)
            CPLError(CE_Warning, refusedByGuard,
                     "the format %s is not read in files by others; convert the file to GeoTIFF with "
                     "gdal_translate, or to GeoPackage "
                     "with ogr2ogr, or, if you trust the scene, start the program with --allow-outside",
                     format.c_str());
        return nullptr;
    }
    const CPLConfigOptionSetter sqlite("SQLITE_USE_OGR_VFS", "YES", false);
    const CPLConfigOptionSetter spatialite("SPATIALITE_LOAD", "NO", false);
    const CPLConfigOptionSetter threads("GDAL_NUM_THREADS", "1", false);
    return original();
}

using Open = GDALDataset* (*)(GDALOpenInfo*);
using OpenWithDriver = GDALDataset* (*)(GDALDriver*, GDALOpenInfo*);

constexpr std::size_t mostDrivers = 512;
std::array<std::pair<GDALDriver*, Open>, mostDrivers> opens;
std::array<std::pair<GDALDriver*, OpenWithDriver>, mostDrivers> opensWithDriver;

/// GDAL's function gets no driver, so each driver has a function.
template<std::size_t N>
GDALDataset* openNth(GDALOpenInfo* info)
{
    return openWithin(*opens[N].first, *info, [&] { return opens[N].second(info); });
}

template<std::size_t... N>
constexpr std::array<Open, sizeof...(N)> openers(std::index_sequence<N...>)
{
    return {&openNth<N>...};
}

GDALDataset* openWithDriver(GDALDriver* driver, GDALOpenInfo* info)
{
    for (const auto& [each, original] : opensWithDriver)
        if (each == driver)
        {
            const OpenWithDriver call = original;
            return openWithin(*driver, *info, [&] { return call(driver, info); });
        }
    return nullptr;
}

void guardDrivers()
{
    constexpr std::array<Open, mostDrivers> functions = openers(std::make_index_sequence<mostDrivers>());
    GDALDriverManager& manager = *GetGDALDriverManager();
    const auto count = std::min(mostDrivers, static_cast<std::size_t>(manager.GetDriverCount()));
    for (std::size_t i = 0; i < count; ++i)
    {
        GDALDriver* const driver = manager.GetDriver(static_cast<int>(i));
        if (driver->pfnOpen)
        {
            opens[i] = {driver, driver->pfnOpen};
            driver->pfnOpen = functions[i];
        }
        if (driver->pfnOpenWithDriverArg)
        {
            opensWithDriver[i] = {driver, driver->pfnOpenWithDriverArg};
            driver->pfnOpenWithDriverArg = &openWithDriver;
        }
    }
}

/// One of GDAL's file systems.
class GuardedFiles final : public VSIFilesystemHandler
{
public:
    /// `data`: where GDAL's own files are. `local`: the computer's own files, else all of them lie elsewhere.
    GuardedFiles(VSIFilesystemHandler& files, std::string data, bool local)
        : _files(&files), _data(std::move(data)), _local(local)
    {
    }

    VSIVirtualHandle* Open(const char* name, const char* access, bool setError, CSLConstList options) override
    {
        const bool reads = std::strpbrk(access, "wa+") == nullptr;
        return isTrusted() || (reads && isOpen(name)) ? _files->Open(name, access, setError, options)
                                                      : nullptr;
    }
    int Stat(const char* name, VSIStatBufL* status, int flags) override
    {
        return isOpen(name) ? _files->Stat(name, status, flags) : -1;
    }
    char** ReadDirEx(const char* name, int most) override
    {
        return isOpen(name) ? _files->ReadDirEx(name, most) : nullptr;
    }
    char** SiblingFiles(const char* name) override
    {
        return isOpen(name) ? _files->SiblingFiles(name) : nullptr;
    }
    VSIDIR* OpenDir(const char* name, int depth, const char* const* options) override
    {
        return isOpen(name) ? _files->OpenDir(name, depth, options) : nullptr;
    }
    char** GetFileMetadata(const char* name, const char* domain, CSLConstList options) override
    {
        return isOpen(name) ? _files->GetFileMetadata(name, domain, options) : nullptr;
    }
    const char* GetActualURL(const char* name) override
    {
        return isOpen(name) ? _files->GetActualURL(name) : nullptr;
    }
    char* GetSignedURL(const char* name, CSLConstList options) override
    {
        return isOpen(name) ? _files->GetSignedURL(name, options) : nullptr;
    }

    int Unlink(const char* name) override { return isTrusted() ? _files->Unlink(name) : -1; }
    int* UnlinkBatch(CSLConstList names) override
    {
        return isTrusted() ? _files->UnlinkBatch(names) : nullptr;
    }
    int Mkdir(const char* name, long mode) override { return isTrusted() ? _files->Mkdir(name, mode) : -1; }
    int Rmdir(const char* name) override { return isTrusted() ? _files->Rmdir(name) : -1; }
    int RmdirRecursive(const char* name) override { return isTrusted() ? _files->RmdirRecursive(name) : -1; }
    int Rename(const char* from, const char* to) override
    {
        return isTrusted() ? _files->Rename(from, to) : -1;
    }
    bool Sync(const char* from, const char* to, const char* const* options, GDALProgressFunc progress,
              void* data, char*** outputs) override
    {
        return isTrusted() && _files->Sync(from, to, options, progress, data, outputs);
    }
    bool SetFileMetadata(const char* name, CSLConstList metadata, const char* domain,
                         CSLConstList options) override
    {
        return isTrusted() && _files->SetFileMetadata(name, metadata, domain, options);
    }
    bool AbortPendingUploads(const char* name) override
    {
        return isTrusted() && _files->AbortPendingUploads(name);
    }

    // These open nothing.
    int IsCaseSensitive(const char* name) override { return _files->IsCaseSensitive(name); }
    GIntBig GetDiskFreeSpace(const char* name) override
    {
        return isTrusted() ? _files->GetDiskFreeSpace(name) : -1;
    }
    int SupportsSparseFiles(const char* name) override
    {
        return isTrusted() ? _files->SupportsSparseFiles(name) : FALSE;
    }
    int HasOptimizedReadMultiRange(const char* name) override
    {
        return isTrusted() ? _files->HasOptimizedReadMultiRange(name) : FALSE;
    }
    const char* GetOptions() override { return _files->GetOptions(); }
    std::string GetStreamingFilename(const std::string& name) const override
    {
        return _files->GetStreamingFilename(name);
    }
    bool IsLocal(const char* name) override { return _files->IsLocal(name); }
    bool SupportsSequentialWrite(const char* name, bool temporary) override
    {
        return isTrusted() && _files->SupportsSequentialWrite(name, temporary);
    }
    bool SupportsRandomWrite(const char* name, bool temporary) override
    {
        return isTrusted() && _files->SupportsRandomWrite(name, temporary);
    }
    bool SupportsRead(const char* name) override { return _files->SupportsRead(name); }

private:
    static bool isTrusted()
    {
        if (!FilesByOthers::Scope::folder()) return true;
        errno = EACCES;
        return false;
    }
    bool isOpen(const std::string& name) const
    {
        const std::optional<std::string>& folder = FilesByOthers::Scope::folder();
        if (!folder) return true;
        const bool isAddress = name.find("://") != std::string::npos;
        const auto isIn = [&](const std::string& place)
        {
            return !place.empty() && FilesByOthers::isWithin(name, place);
        };
        if (_local && !isAddress && (isIn(*folder) || isIn(_data))) return true;
        errno = EACCES;
        return false;
    }

    const std::unique_ptr<VSIFilesystemHandler> _files;
    const std::string _data;
    const bool _local;
};

void guardFiles()
{
    // Of memory, and of what lies within other files, which are opened by name.
    const std::set<std::string> within = {"/vsimem/", "/vsizip/",  "/vsizip{",     "/vsitar/",
                                          "/vsitar{", "/vsigzip/", "/vsisubfile/", "/vsisparse/"};
    const char* const found = CPLFindFile("gdal", "gdalvrt.xsd");
    const std::string data = found ? CPLGetPath(found) : "";
    std::vector<std::string> prefixes;
    const CPLStringList listed(VSIFileManager::GetPrefixes());
    for (int i = 0; i < listed.size(); ++i)
    {
        prefixes.emplace_back(listed[i]);
        // Such as "/vsicurl?", which GDAL does not list.
        prefixes.push_back(prefixes.back().substr(0, prefixes.back().size() - 1) + "?");
    }
    VSIFilesystemHandler* const local = VSIFileManager::GetHandler("");
    // Several names may have the same file system, which GDAL deletes once.
    std::map<VSIFilesystemHandler*, GuardedFiles*> guards;
    std::set<VSIFilesystemHandler*> done = {local};
    for (const std::string& prefix : prefixes)
    {
        VSIFilesystemHandler* const files = VSIFileManager::GetHandler(prefix.c_str());
        if (within.count(prefix) > 0 || done.count(files) > 0) continue;
        GuardedFiles*& guard = guards[files];
        if (!guard) guard = new GuardedFiles(*files, data, false);
        done.insert(guard);
        VSIFileManager::InstallHandler(prefix, guard);
    }
    VSIFileManager::InstallHandler("", new GuardedFiles(*local, data, true));
}

/// Null where the address may be fetched.
CPLHTTPResult* refuseFetch(const char*, CSLConstList, GDALProgressFunc, void*, CPLHTTPFetchWriteFunc, void*,
                           void*)
{
    if (!FilesByOthers::Scope::folder()) return nullptr;
    constexpr const char* reason = "Nothing is fetched for files by others.";
    CPLError(CE_Failure, CPLE_AppDefined, reason);
    auto* const result = static_cast<CPLHTTPResult*>(CPLCalloc(1, sizeof(CPLHTTPResult)));
    result->nStatus = 1;
    result->pszErrBuf = CPLStrdup(reason);
    return result;
}

} // namespace

bool isFormatByOthers(const std::string& format)
{
    return formats.count(format) > 0;
}

void guardGdal()
{
    static std::once_flag once;
    std::call_once(once,
                   []
                   {
                       guardDrivers();
                       guardFiles();
                       CPLHTTPSetFetchCallback(&refuseFetch, nullptr);
                   });
}

} // namespace osgGeoFX
