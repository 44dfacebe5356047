// SPDX-License-Identifier: MIT
// SPDX-FileCopyrightText: 2026 the osgGeoFX authors
#include <osgGeoFX/terrain/detail/BuildPlan.h>

#include <osgGeoFX/geodata/BuildError.h>

#include <algorithm>
#include <cmath>
#include <filesystem>

namespace osgGeoFX
{

namespace
{

namespace fs = std::filesystem;

// Bytes after compression, and seconds of one core. They were measured on Oahu (smooth, much sea) and on noise with
// the relief of the Himalaya, with colors by heights and by land cover. The bytes of normals are the mean of Oahu and
// Fuji.
constexpr double BYTES_PER_POST = 12.0, BYTES_PER_TEXEL = 5.0, BYTES_PER_NORMAL = 1.0;
constexpr double SECONDS_PER_POST = 4.5e-6, SECONDS_PER_TEXEL = 4e-7, SECONDS_OF_COMPRESSION = 7.5e-7;
// Even a plain takes this share of the estimate. With less room the disk would be full before the end.
constexpr double LEAST_SHARE = 0.25;
// Work files, bytes. Posts: heights, and what units hand on. Ground cells: heights, covers and distances.
constexpr double WORK_PER_POST = 8.0, WORK_PER_GROUND_CELL = 15.0;

/// The nearest folder above that exists and whose free space is known.
fs::path standingFolder(fs::path folder)
{
    std::error_code code;
    folder = fs::absolute(folder, code);
    while (!fs::exists(folder, code) && folder.has_parent_path() && folder != folder.parent_path())
        folder = folder.parent_path();
    return folder;
}

double bytesBelow(const fs::path& folder)
{
    std::error_code code;
    double bytes = 0.0;
    if (fs::is_directory(folder, code))
        for (fs::recursive_directory_iterator entry(folder, code), end; !code && entry != end;
             entry.increment(code))
            if (entry->is_regular_file(code)) bytes += static_cast<double>(entry->file_size(code));
    return bytes;
}

} // namespace

void BuildPlan::chooseEstimate()
{
    double posts = (scheme.lastColumn + 1.0) * (scheme.lastRow + 1.0);
    if (!uniform())
    {
        posts = 0.0;
        for (const auto& units : tiers)
            for (const Unit& unit : units)
                if (unit.sampled) posts += static_cast<double>(validColumns(unit)) * validRows(unit);
    }
    const double perPost =
        static_cast<double>(scheme.textureIntervals(scheme.finestLevel)) / scheme.intervals;
    // Levels that keep the finest texels have all of them again. Each level above has a quarter of the one before.
    const double texels = posts * perPost * perPost * (scheme.textureDepth + 4.0 / 3.0);
    double groundCells = 0.0;
    for (const GroundPatch& patch : groundPatches)
        groundCells += static_cast<double>(patch.columns) * patch.rows;
    double tiles = 0.0;
    for (int level = 0; level <= scheme.finestLevel; ++level)
    {
        const double width = static_cast<double>(scheme.intervals) * scheme.step(level);
        tiles += std::ceil(scheme.lastColumn / width) * std::ceil(scheme.lastRow / width);
    }
    if (!uniform()) tiles = static_cast<double>(_tiles);
    const double workBytes = posts * WORK_PER_POST + WORK_PER_GROUND_CELL * groundCells;
    const double normals = posts * (std::min(scheme.finestLevel, TilingScheme::normalDepth) + 4.0 / 3.0);
    const double bytes = posts * BYTES_PER_POST + texels * BYTES_PER_TEXEL + normals * BYTES_PER_NORMAL;
    estimate.samples = static_cast<std::uint64_t>(posts);
    estimate.tiles = static_cast<std::uint64_t>(tiles);
    estimate.levels = scheme.finestLevel + 1;
    estimate.bytes = static_cast<std::uint64_t>(bytes);
    estimate.workBytes = static_cast<std::uint64_t>(workBytes);
    const int cores = options.threads > 0 ? options.threads : coreCount();
    const double perTexel = SECONDS_PER_TEXEL + (options.compressTextures ? SECONDS_OF_COMPRESSION : 0.0);
    estimate.seconds = (posts * SECONDS_PER_POST + texels * perTexel) / cores;

    const std::string remedy = "give a smaller region or coarser rasters (gdal_translate -projwin, gdalwarp "
                               "-tr); the finest raster of all sets the "
                               "density of the whole terrain";
    const auto inWords = [](double value)
    {
        const char* units[] = {"", " million", " thousand million"};
        const int unit = value < 1e6 ? 0 : value < 1e9 ? 1 : 2;
        return std::string(
            CPLSPrintf("%.3g%s", value / std::pow(1000.0, unit == 0 ? 0 : unit + 1), units[unit]));
    };
    std::error_code code;
    const fs::path folder = standingFolder(options.output);
    const fs::space_info space = fs::space(folder, code);
    // Files in the folder are replaced, or are a part of this build already.
    const double room = code ? 1e300 : static_cast<double>(space.available) + bytesBelow(options.output);
    const double least = bytes * LEAST_SHARE + workBytes;
    // A plan may be made on a machine that does not build.
    if (workers == Workers::MANY_PROCESSES) return;
    if (least > room)
        throw BuildError(options.output + ": the terrain would have " + inWords(posts) + " samples in " +
                         inWords(tiles) + " tiles and take about " + sizeInWords(bytes + workBytes) +
                         " on the disk while it is built, at the very least " + sizeInWords(least) +
                         "; only " + sizeInWords(room) +
                         " are free there. Choose another folder with -o, or " + remedy + ".");
    const double memory = tiles * sizeof(TileFacts);
    if (memory > options.memoryMiB * 1024.0 * 1024.0)
        throw BuildError(options.dems.front() + ": the terrain would have " + inWords(posts) +
                         " samples in " + inWords(tiles) +
                         " tiles, of which the builder cannot keep account in " +
                         std::to_string(options.memoryMiB) +
                         " MiB of memory; give it more with --memory, or " + remedy + ".");
}

std::string sizeInWords(double bytes)
{
    const char* units[] = {"kB", "MB", "GB", "TB", "PB"};
    std::size_t unit = 0;
    for (bytes /= 1e3; bytes >= 999.5 && unit + 1 < std::size(units); bytes /= 1e3)
        ++unit;
    return CPLSPrintf(bytes < 10.0 ? "%.1f %s" : "%.0f %s", bytes, units[unit]);
}

std::string BuildEstimate::text() const
{
    std::string time = CPLSPrintf("%.0f s", std::max(1.0, seconds));
    if (seconds >= 90.0) time = CPLSPrintf("%.0f minutes", seconds / 60.0);
    if (seconds >= 5400.0) time = CPLSPrintf("%.1f hours", seconds / 3600.0);
    return CPLSPrintf(
        "%.3f million samples, up to %llu tiles, %d levels; about %s on the disk, and %s more while it is "
        "built; about %s",
        static_cast<double>(samples) * 1e-6, static_cast<unsigned long long>(tiles), levels,
        sizeInWords(static_cast<double>(bytes)).c_str(), sizeInWords(static_cast<double>(workBytes)).c_str(),
        time.c_str());
}

std::string TextureSummary::text() const
{
    std::string result = "Textures: " + sizeInWords(static_cast<double>(bytes)) + " with their mipmaps, " +
                         sizeInWords(static_cast<double>(uncompressedBytes)) +
                         " if nothing were compressed.\n";
    const auto line =
        [&](const char* kind, const char* const* names, const TextureError* errors, std::size_t count)
    {
        result += kind;
        for (std::size_t i = 0; i < count; ++i)
            result += CPLSPrintf("%s %s %.2f (at most %d)", i == 0 ? "" : ",", names[i],
                                 errors[i].rootMeanSquare, errors[i].largest);
        result += ".\n";
    };
    const char* const channels[] = {"red", "green", "blue"};
    const char* const axes[] = {"x", "y"};
    line("Root mean square errors of colors, of 255:", channels, colors.data(), colors.size());
    line("The same of normals:", axes, normals.data(), normals.size());
    return result;
}

BuildEstimate estimateBuild(const BuildOptions& options)
{
    return BuildPlan(options).estimate;
}

} // namespace osgGeoFX
