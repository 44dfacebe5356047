// SPDX-License-Identifier: MIT
// SPDX-FileCopyrightText: 2026 the osgGeoFX authors
#include "panorama/GroundBuilder.h"

#include <osgGeoFX/batch/OwnFolder.h>
#include <osgGeoFX/terrain/DatabaseBuilder.h>
#include <osgGeoFX/terrain/ProgressLine.h>
#include <osgGeoFX/terrain/ThinnedRaster.h>

#include <osg/CoordinateSystemNode>
#include <osg/Math>

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <filesystem>
#include <functional>

namespace fs = std::filesystem;
using osgGeoFX::ThinnedRaster;

namespace geofx::panorama
{

namespace
{

/// A terrain with at most so many samples serves both purposes.
constexpr double fewSamples = 2.3e6;
/// Samples of the ground for each pixel of the picture's base.
constexpr double samplesPerPixel = 1.0;
/// The ground that the picture may show: so far beyond its sides, before its base and behind its horizon.
constexpr double beside = 1.15, before = 0.6, behind = 1.3;
constexpr int memoryMiB = 512;

std::uint64_t timeOf(const std::string& file)
{
    std::error_code fault;
    const auto time = fs::last_write_time(file, fault);
    return fault ? 0 : static_cast<std::uint64_t>(time.time_since_epoch().count());
}

/// The ground below a picture, as places at its border and within.
std::vector<osg::Vec2d> placesOf(const osgGeoFX::PanoramaComposition& view)
{
    std::vector<osg::Vec2d> result;
    const double latitude = osg::DegreesToRadians(view.place.y()),
                 longitude = osg::DegreesToRadians(view.place.x());
    constexpr int steps = 12;
    for (int row = 0; row <= steps; ++row)
    {
        for (int column = 0; column <= steps; ++column)
        {
            double x = beside * (2.0 * column / steps - 1.0) * view.viewRadius;
            double s = (behind * view.horizonDistance * row / steps - before * (steps - row) / steps) *
                       view.viewRadius;
            if (view.horizontalAngle > 0.0)
            {
                // All around the place.
                const double ring = 2.0 * view.viewRadius / view.horizontalAngle;
                const double away = std::max(ring + s, 0.0), azimuth = x / ring;
                x = away * std::sin(azimuth);
                s = away * std::cos(azimuth);
            }
            const double east = x * std::cos(view.heading) + s * std::sin(view.heading);
            const double north = s * std::cos(view.heading) - x * std::sin(view.heading);
            // Along a great circle.
            const double arc = std::hypot(east, north) / osg::WGS_84_RADIUS_EQUATOR;
            const double azimuth = std::atan2(east, north);
            const double there = std::asin(std::sin(latitude) * std::cos(arc) +
                                           std::cos(latitude) * std::sin(arc) * std::cos(azimuth));
            const double turned = std::atan2(std::sin(azimuth) * std::sin(arc) * std::cos(latitude),
                                             std::cos(arc) - std::sin(latitude) * std::sin(there));
            result.emplace_back(osg::RadiansToDegrees(longitude + turned), osg::RadiansToDegrees(there));
        }
    }
    return result;
}

osgGeoFX::VerticalDatum datumOf(const std::string& name)
{
    return name == "egm96"       ? osgGeoFX::VerticalDatum::Egm96
           : name == "ellipsoid" ? osgGeoFX::VerticalDatum::Ellipsoid
                                 : osgGeoFX::VerticalDatum::None;
}

} // namespace

GroundBuilder::GroundBuilder(const Recipe& recipe, std::string folder, bool quiet)
    : _recipe(recipe), _folder(std::move(folder)), _quiet(quiet)
{
    osgGeoFX::OwnFolder::take(_folder, "--work");
    _lock.emplace(_folder, osgGeoFX::FolderLock::ALONE, "--work");
    _spacing = HUGE_VAL;
    for (const std::string& dem : recipe.dems)
    {
        const ThinnedRaster::Size size = ThinnedRaster::look(dem, recipe.allHeights);
        _samples += static_cast<double>(size.columns) * size.rows;
        _spacing = std::min(_spacing, size.spacing);
    }
}

std::string GroundBuilder::overview()
{
    if (_samples <= fewSamples) return build("ground", 1, {});
    const int factor = std::max(2, static_cast<int>(std::ceil(std::sqrt(_samples / fewSamples))));
    return build("overview", factor, {});
}

std::string GroundBuilder::ground(const osgGeoFX::PanoramaComposition& view)
{
    const std::vector<osg::Vec2d> places = placesOf(view);
    const auto isShown = [&](const std::string& dem)
    {
        return ThinnedRaster::cut(dem, places, 1).columns > 0;
    };
    if (std::none_of(_recipe.dems.begin(), _recipe.dems.end(), isShown))
        throw Failure("None of the DEMs has ground in the picture; choose another place or width.");
    if (_samples <= fewSamples) return build("ground", 1, {});
    const double wanted = 2.0 * view.viewRadius / (_recipe.width * samplesPerPixel);
    const int factor = std::max(1, static_cast<int>(wanted / _spacing));
    char note[300];
    std::snprintf(
        note, sizeof(note),
        "Ground: of %.1f million samples, %.0f m apart, the picture takes its own part%s; a pixel of the "
        "picture's base shows %.0f m.",
        _samples / 1e6, _spacing,
        factor > 1 ? (", " + std::to_string(factor) + " times coarser").c_str() : "",
        wanted * samplesPerPixel);
    _notes.emplace_back(note);
    return build("ground", factor, places);
}

std::string GroundBuilder::groundIn(const std::string& folder)
{
    return folder + "/ground/terrain.osgb";
}

std::string GroundBuilder::build(const std::string& name, int factor, const std::vector<osg::Vec2d>& places)
{
    osgGeoFX::BuildOptions options;
    for (std::size_t i = 0; i < _recipe.dems.size(); ++i)
    {
        const std::string& dem = _recipe.dems[i];
        const ThinnedRaster::Size size = ThinnedRaster::look(dem, _recipe.allHeights);
        // Coarser ones among several sources are not made coarser than needed.
        const int own = std::max(1, static_cast<int>(factor * _spacing / size.spacing + 0.01));
        const ThinnedRaster::Cut cut = ThinnedRaster::cut(dem, places, own);
        if (cut.columns == 0) continue;
        if (own == 1 && cut.columns == size.columns && cut.rows == size.rows && !size.seaFloor)
        {
            options.dems.push_back(dem);
            continue;
        }
        // The name tells all that the copy depends on, so a copy that is there is the right one.
        const std::size_t key = std::hash<std::string>()(
            fs::absolute(dem).string() + ' ' + std::to_string(timeOf(dem)) + ' ' + std::to_string(cut.left) +
            ' ' + std::to_string(cut.top) + ' ' + std::to_string(cut.columns) + ' ' +
            std::to_string(cut.rows) + (_recipe.allHeights ? " all" : ""));
        const std::string copy = _folder + "/" + name + "-" + std::to_string(i) + "-" + std::to_string(own) +
                                 "-" + std::to_string(key) + ".tif";
        if (!fs::exists(copy))
        {
            osgGeoFX::ProgressLine line("osggeofx_panorama");
            ThinnedRaster::write(
                dem, cut, copy,
                [&](double done)
                { return _quiet || line(static_cast<std::uint64_t>(1000.0 * done), 1000, "reading " + dem); },
                _recipe.allHeights);
        }
        options.dems.push_back(copy);
    }
    options.landCover = _recipe.landCover;
    options.landCoverTable = _recipe.landCoverTable;
    options.treeCover = _recipe.treeCover;
    options.vertical = datumOf(_recipe.vertical);
    options.allHeights = _recipe.allHeights;
    options.memoryMiB = memoryMiB;
    options.output = _folder + "/" + name;
    osgGeoFX::ProgressLine line("osggeofx_panorama");
    const osgGeoFX::BuildProgress progress = _quiet ? osgGeoFX::BuildProgress() : std::ref(line);
    try
    {
        options.resume = true;
        return osgGeoFX::buildDatabase(options, progress).file;
    }
    catch (const osgGeoFX::BuildError&)
    {
        // What is there is of other sources, or nothing is there.
        options.resume = false;
        return osgGeoFX::buildDatabase(options, progress).file;
    }
}

} // namespace geofx::panorama
