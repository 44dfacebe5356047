// SPDX-License-Identifier: MIT
// SPDX-FileCopyrightText: 2026 the osgGeoFX authors
#include "LinesSuite.h"

#include "BenchError.h"
#include "MapStage.h"
#include "OahuTerrain.h"

#include <osgGeoFX/lines/LinePlacement.h>
#include <osgGeoFX/lines/MapLines.h>

#include <osg/Math>

#include <chrono>
#include <cmath>
#include <cstdio>
#include <map>
#include <memory>
#include <random>

namespace geofx::bench
{

namespace
{

constexpr std::size_t LINES = 500;
constexpr int CORNERS = 40;    ///< of each line
constexpr double STEP = 250.0; ///< between two of them, metres
constexpr double PER_DEGREE = 111320.0;

/// Roads that wander over the land, as long as those of an island: 500 of up to 10 km each.
std::vector<osgGeoFX::MapLine> wander(const osgGeoFX::TerrainRelief& relief, std::size_t count)
{
    std::mt19937 random(11);
    const auto within = [&](double low, double high)
    {
        return low + (high - low) * (static_cast<double>(random()) / 4294967296.0);
    };
    const auto isLand = [&](const osg::Vec2d& place)
    {
        const int column =
            static_cast<int>((place.x() - relief.west) / (relief.east - relief.west) * relief.columns);
        const int row =
            static_cast<int>((place.y() - relief.south) / (relief.north - relief.south) * relief.rows);
        return column >= 0 && row >= 0 && column < relief.columns && row < relief.rows &&
               relief.heights[relief.index(column, row)] > 5.0f;
    };
    const char* const styles[] = {"motorway", "primary", "residential", "trail", "river"};
    std::vector<osgGeoFX::MapLine> lines;
    while (lines.size() < count)
    {
        osg::Vec2d place(within(relief.west, relief.east), within(relief.south, relief.north));
        osgGeoFX::MapLine line;
        line.style = styles[lines.size() % 5];
        double heading = within(0.0, 2.0 * osg::PI);
        for (int i = 0; i < CORNERS && isLand(place); ++i)
        {
            line.places.emplace_back(place.x(), place.y(), std::nan(""));
            heading += within(-0.5, 0.5);
            const double east =
                relief.geocentric ? PER_DEGREE * std::cos(osg::DegreesToRadians(place.y())) : 1.0;
            const double north = relief.geocentric ? PER_DEGREE : 1.0;
            place += osg::Vec2d(STEP * std::sin(heading) / east, STEP * std::cos(heading) / north);
        }
        if (line.places.size() > 3) lines.push_back(std::move(line));
    }
    return lines;
}

/// The lines on the ground, which all views have.
struct PlacedLines
{
    PlacedLines(const Settings& settings, const std::filesystem::path& terrain)
    {
        announce("putting lines on the ground");
        const MapStage stage(mapViews().front(), terrain);
        const osgGeoFX::TerrainRelief relief = stage.relief(settings);
        lines = wander(relief, settings.smoke ? 30 : LINES);
        const auto start = std::chrono::steady_clock::now();
        places = osgGeoFX::LinePlacement()
                     .place(lines, styles, *stage.scene.effects->getTerrain(), stage.ellipsoid(), relief)
                     .places;
        seconds = std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
        if (places == 0) throw BenchError(terrain.string() + ": no line lies on it.");
    }

    const std::map<std::string, osgGeoFX::LineStyle> styles = osgGeoFX::usualLineStyles();
    std::vector<osgGeoFX::MapLine> lines;
    std::size_t places = 0;
    double seconds = 0.0;
};

std::vector<Figure> measure(const MapView& view, const PlacedLines& placed, const Settings& settings,
                            const std::filesystem::path& terrain)
{
    announce(std::string("drawing lines in ") + view.what);
    const MapStage stage(view, terrain);
    const osg::ref_ptr<osgGeoFX::MapLines> node = new osgGeoFX::MapLines(placed.lines, placed.styles);
    stage.scene.effects->addChild(node);
    const std::unique_ptr<OffscreenView> drawing = stage.draw(*stage.scene.node, settings);
    MapStage::save(*drawing, settings, std::string("lines-") + view.name);
    const int rounds = settings.smoke ? 3 : settings.quick ? 15 : 61;
    std::vector<double> with, without, ratios;
    for (int round = 0; round < rounds; ++round)
    {
        node->setNodeMask(0u);
        without.push_back(drawing->frame());
        node->setNodeMask(~0u);
        drawing->frame(); // the buffers are there again
        with.push_back(drawing->frame());
        ratios.push_back(with.back() / without.back());
    }
    Figure figure{std::string("lines-") + view.name,
                  "how much longer a frame takes with 500 lines of up to 10 km, in " + std::string(view.what),
                  "", Bound::AtMost, 1.5};
    figure.measured = median(ratios);
    char remark[200];
    std::snprintf(remark, sizeof remark,
                  "%zu places, put on the ground in %.2f s; frames of %.1f ms with lines, %.1f ms without",
                  placed.places, placed.seconds, 1000.0 * median(with), 1000.0 * median(without));
    figure.remark = remark;
    figure.details = {{"places", placed.places},
                      {"placingSeconds", placed.seconds},
                      {"withMilliseconds", 1000.0 * median(with)},
                      {"withoutMilliseconds", 1000.0 * median(without)}};
    return {figure};
}

std::vector<Figure> run(const Settings& settings)
{
    const WorkFolder folder(settings.work);
    const std::filesystem::path terrain = terrainToDraw(settings, folder);
    const PlacedLines placed(settings, terrain);
    std::vector<Figure> figures;
    for (const MapView& view : mapViews())
    {
        if (!settings.wants(view.name)) continue;
        for (const Figure& figure : measure(view, placed, settings, terrain))
            figures.push_back(figure);
    }
    return figures;
}

} // namespace

Suite linesSuite()
{
    return {
        "lines",
        "Puts 500 lines onto Oahu at 1600 x 900, in a plain, a bent and a painted view, and tells what they "
        "cost",
        {"plain", "bent", "map"},
        run};
}

} // namespace geofx::bench
