// SPDX-License-Identifier: MIT
// SPDX-FileCopyrightText: 2026 the osgGeoFX authors
#include "TerrainCache.h"

#include <osgGeoFX/geodata/SequenceRaster.h>
#include <osgGeoFX/paging/TerrainInfo.h>
#include <osgGeoFX/terrain/BuilderCode.h>
#include <osgGeoFX/terrain/DatabaseBuilder.h>
#include <osgGeoFX/terrain/ProgressLine.h>

#include <gdal_priv.h>

#include <sys/file.h>

#include <cerrno>
#include <cstdio>
#include <cstring>
#include <fcntl.h>
#include <filesystem>
#include <map>
#include <sstream>
#include <unistd.h>

namespace osgGeoFX
{

namespace
{

namespace fs = std::filesystem;

constexpr const char* remedy = "; name another folder in the attribute \"cache\" of <rasters>.";

fs::path cacheFolder(const SceneRasters& rasters)
{
    if (!rasters.cache.empty()) return rasters.cache;
    const char* cache = std::getenv("XDG_CACHE_HOME");
    if (cache && fs::path(cache).is_absolute()) return fs::path(cache) / "osgGeoFX";
    const char* home = std::getenv("HOME");
    if (home && *home) return fs::path(home) / ".cache" / "osgGeoFX";
    throw BuildError(
        "No folder is known in which to keep the database, because neither XDG_CACHE_HOME nor HOME is "
        "set; set one, or name a folder in the attribute \"cache\" of <rasters>.");
}

BuildOptions buildOptions(const SceneRasters& rasters)
{
    const std::map<std::string, VerticalDatum> datums{{"none", VerticalDatum::None},
                                                      {"ellipsoid", VerticalDatum::Ellipsoid},
                                                      {"egm96", VerticalDatum::Egm96}};
    BuildOptions options;
    for (const ScenePath& dem : rasters.dems)
        options.dems.push_back(dem.name());
    for (const ScenePath& imagery : rasters.imagery)
        options.imagery.push_back(imagery.name());
    if (rasters.landCover)
    {
        options.landCover = rasters.landCover->file.name();
        options.landCoverTable = rasters.landCover->table.path;
    }
    if (rasters.treeCover) options.treeCover = rasters.treeCover->name();
    options.epsg = rasters.epsg;
    options.vertical = datums.at(rasters.vertical);
    options.voids = rasters.voids == "keep" ? Voids::KEEP : Voids::FILL;
    options.voidReach = rasters.voidReach;
    options.voidSmoothing = rasters.voidSmoothing;
    options.tileSize = rasters.tileSize;
    options.textureSize = rasters.textureSize;
    options.pixelError = rasters.pixelError;
    options.texelError = rasters.texelError;
    options.memoryMiB = rasters.memoryMiB;
    options.resume = true;
    return options;
}

/// Name, size and time of a file and, for a raster, of the files that belong to it (those of a VRT, a world
/// file…).
void describe(std::ostream& text, const std::string& name, bool isRaster)
{
    CPLStringList files;
    const auto [file, variable] = isRaster ? SequenceRaster::parse(name) : std::pair(name, std::string());
    text << variable << "\n";
    if (isRaster)
    {
        const CPLErrorHandlerPusher quiet(CPLQuietErrorHandler); // the builder says it better
        if (GDALDataset* dataset = GDALDataset::Open(file.c_str(), GDAL_OF_RASTER))
        {
            files.Assign(dataset->GetFileList());
            GDALClose(dataset);
        }
    }
    if (files.FindString(file.c_str()) < 0) files.AddString(file.c_str());
    files.Sort();
    for (int i = 0; i < files.size(); ++i)
    {
        std::error_code code;
        const auto size = fs::file_size(files[i], code);
        const auto time = fs::last_write_time(files[i], code).time_since_epoch().count();
        text << files[i] << "\n";
        if (!code) text << size << " " << time << "\n";
    }
}

/// FNV-1a, 64 bits, in hexadecimal: the same in each run and on each machine, which std::hash is not.
std::string hashOf(const std::string& text)
{
    std::uint64_t hash = 0xcbf29ce484222325u;
    for (const char c : text)
        hash = (hash ^ static_cast<unsigned char>(c)) * 0x100000001b3u;
    char name[17];
    std::snprintf(name, sizeof name, "%016llx", static_cast<unsigned long long>(hash));
    return name;
}

std::string nameOf(const BuildOptions& options)
{
    std::ostringstream key;
    key.imbue(std::locale::classic());
    key.precision(17);
    key << GEOFX_VERSION << "\n"
        << TerrainInfo::newestFormat << "\n"
        << DATABASE_CONTENT << "\n"
        << builderCode() << "\n";
    key << options.epsg << "\n";
    key << static_cast<int>(options.vertical) << "\n"
        << options.tileSize << "\n"
        << options.textureSize << "\n";
    key << static_cast<int>(options.voids) << "\n"
        << options.voidReach << "\n"
        << options.voidSmoothing << "\n";
    key << options.pixelError << "\n" << options.texelError << "\n" << options.pixelsPerRadian << "\n";
    for (const auto* files : {&options.dems, &options.imagery})
    {
        key << files->size() << "\n";
        for (const std::string& file : *files)
            describe(key, file, true);
    }
    if (!options.landCover.empty())
    {
        describe(key, options.landCover, true);
        describe(key, options.landCoverTable, false);
    }
    if (!options.treeCover.empty())
    {
        key << "tree cover\n";
        describe(key, options.treeCover, true);
    }
    return fs::path(options.dems.front()).stem().string() + "-" + hashOf(key.str());
}

/// Held by one program (and one thread of it) at a time; the system lets it go when the program ends, however
/// it ends.
class FileLock
{
public:
    FileLock(const fs::path& path, const std::string& waitingMessage)
        : _descriptor(open(path.c_str(), O_RDWR | O_CREAT | O_CLOEXEC, 0666))
    {
        if (_descriptor >= 0 && flock(_descriptor, LOCK_EX | LOCK_NB) == 0) return;
        if (_descriptor >= 0 && errno == EWOULDBLOCK)
        {
            std::fprintf(stderr, "%s\n", waitingMessage.c_str());
            int result = 0;
            do
                result = flock(_descriptor, LOCK_EX);
            while (result != 0 && errno == EINTR);
            if (result == 0) return;
        }
        const std::string reason = std::strerror(errno);
        if (_descriptor >= 0) close(_descriptor);
        throw BuildError(path.string() +
                         ": the file that keeps two programs from building at once cannot be used (" +
                         reason + ")" + remedy);
    }
    ~FileLock() { close(_descriptor); }
    FileLock(const FileLock&) = delete;
    FileLock& operator=(const FileLock&) = delete;

private:
    int _descriptor;
};

} // namespace

std::string cachedTerrain(const SceneRasters& rasters)
{
    GDALAllRegister();
    BuildOptions options = buildOptions(rasters);
    const fs::path cache = cacheFolder(rasters), folder = cache / nameOf(options);
    const fs::path database = folder / "terrain.osgb"; // written last: where it is, all is
    std::error_code code;
    if (fs::exists(database, code)) return database.string();

    fs::create_directories(cache, code);
    if (!fs::is_directory(cache))
        throw BuildError(cache.string() + ": the folder cannot be made (" +
                         (code ? code.message() : std::string("a file has this name")) + ")" + remedy);
    const FileLock lock(folder.string() + ".lock",
                        "osgGeoFX: another program builds this terrain; waiting for it to finish.");
    if (!fs::exists(database, code))
    {
        options.output = folder.string();
        const std::string title = "osgGeoFX: building the terrain of " + rasters.place.file;
        std::fprintf(stderr, "%s: %s.\n", title.c_str(), estimateBuild(options).text().c_str());
        ProgressLine progress(title);
        buildDatabase(options, std::ref(progress));
    }
    return database.string();
}

} // namespace osgGeoFX
