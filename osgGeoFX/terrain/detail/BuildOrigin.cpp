// SPDX-License-Identifier: MIT
// SPDX-FileCopyrightText: 2026 the osgGeoFX authors
//
// What a database is made from, in words.
#include <osgGeoFX/terrain/BuilderCode.h>
#include <osgGeoFX/terrain/detail/BuildFolder.h>
#include <osgGeoFX/terrain/detail/BuildPlan.h>

#include <osgGeoFX/geodata/detail/RasterFile.h>
#include <osgGeoFX/paging/TerrainInfo.h>

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <sstream>

namespace osgGeoFX
{

namespace
{

/// A file's path, size and time as a line. A file that has changed has another line. `name`: may have a variable of the file (RasterFile).
std::string sourceLine(const char* kind, const std::string& name)
{
    const auto [file, variable] = RasterFile::parse(name);
    const std::string part = variable.empty() ? "" : ":" + variable;
    std::ostringstream text;
    // GDAL's own file systems: archives, and what lies on servers.
    if (file.rfind("/vsi", 0) == 0)
    {
        VSIStatBufL remote{};
        text << kind << " " << name;
        if (VSIStatL(file.c_str(), &remote) == 0)
            text << ", " << remote.st_size << " bytes, changed " << remote.st_mtime;
        text << "\n";
        return text.str();
    }
    std::error_code code;
    const auto size = std::filesystem::file_size(file, code);
    text << kind << " " << std::filesystem::absolute(file).lexically_normal().string() << part;
    if (!code)
        text << ", " << size << " bytes, changed "
             << std::filesystem::last_write_time(file, code).time_since_epoch().count();
    text << "\n";
    return text.str();
}

} // namespace

void BuildPlan::chooseFingerprint()
{
    for (std::size_t i = 0; i < options.dems.size(); ++i)
    {
        std::string line = sourceLine("elevation", options.dems[i]);
        if (!demVoids[i].isEmpty()) line.insert(line.size() - 1, ", where " + demVoids[i].text());
        demSources.push_back({line, _dems[i], {}});
    }
    for (std::size_t i = 0; i < options.imagery.size(); ++i)
        imagerySources[i].identity = sourceLine("imagery", options.imagery[i]);
    if (landCoverSource) landCoverSource->identity = sourceLine("land cover", options.landCover);
    if (treeCoverSource) treeCoverSource->identity = sourceLine("tree cover", options.treeCover);
    std::string legend;
    if (landCoverSource)
    {
        const auto legends = readyLegends();
        legend = std::find(legends.begin(), legends.end(), options.landCoverTable) != legends.end()
                     ? "legend " + options.landCoverTable + "\n"
                     : sourceLine("land-cover table", options.landCoverTable);
    }

    std::ostringstream head, sources, settings, grid;
    head << ORIGIN_BEGIN << ", format " << TerrainInfo::newestFormat << ", content " << DATABASE_CONTENT
         << "\nbuilder " << builderCode() << "\n";
    for (const auto* list : {&demSources, &imagerySources})
        for (const Source& source : *list)
            sources << source.identity;
    if (landCoverSource) sources << landCoverSource->identity << legend;
    if (treeCoverSource) sources << treeCoverSource->identity;

    settings.precision(17);
    if (options.stretch)
        settings << "imagery stretched from " << options.stretch->first << " to " << options.stretch->second
                 << "\n";
    if (options.treeLine) settings << "tree line " << *options.treeLine << "\n";
    if (options.allHeights) settings << "all heights\n";
    settings << "lake area " << options.lakeArea << "\n";
    if (options.voids == Voids::FILL)
        settings << "voids filled up to " << options.voidReach << " samples, smoothed "
                 << options.voidSmoothing << " times\n";
    else
        settings << "voids kept\n";
    settings << "CRS "
             << (options.epsg ? "EPSG:" + std::to_string(options.epsg) : std::string("geocentric WGS 84"))
             << "\nvertical datum " << static_cast<int>(options.vertical) << "\ntile size "
             << options.tileSize << "\ntexture size " << options.textureSize << "\npixel error "
             << options.pixelError << "\ntexel error " << options.texelError << "\nanisotropy "
             << options.anisotropy << "\npixels per radian " << options.pixelsPerRadian << "\n"
             << (options.compressTextures ? "textures compressed\n" : "");
    fingerprint = head.str() + sources.str() + settings.str();

    // Finer levels do not change those above them, so the grid is told as the root's.
    const double root = std::ldexp(1.0, -scheme.finestLevel);
    grid.precision(17);
    grid << "extent " << scheme.west << " to " << scheme.east << ", " << scheme.south << " to "
         << scheme.north << "\nintervals of the root level " << scheme.lastColumn * root << " by "
         << scheme.lastRow * root << "\nunits with roots on the levels " << _roots.back();
    for (std::size_t tier = _roots.size() - 1; tier-- > 0 && _roots[tier] < scheme.anchorLevel;)
        grid << ", " << _roots[tier];
    grid << "\nlevel of voids " << voidLevel << "\ntexture intervals";
    for (int level = 0; level <= scheme.anchorLevel; ++level)
        grid << " " << scheme.textureIntervals(level);
    grid << "\n"
         << (options.imagery.empty() ? "" : "with imagery\n")
         << (landCoverSource ? "" : "without land cover\n")
         << (options.treeCover.empty() ? "" : "with tree cover\n");
    common = head.str() + legend + settings.str() + grid.str();
}

} // namespace osgGeoFX
