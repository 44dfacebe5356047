// SPDX-License-Identifier: MIT
// SPDX-FileCopyrightText: 2026 the osgGeoFX authors
#include "LabelsSuite.h"

#include "MapStage.h"
#include "OahuTerrain.h"

#include <osgGeoFX/labels/MapLabels.h>
#include <osgGeoFX/labels/NamePlacement.h>

#include <osg/Group>

#include <chrono>
#include <cmath>
#include <cstdio>
#include <memory>
#include <random>

namespace geofx::bench
{

namespace
{

constexpr std::size_t NAMES = 500;
/// What 500 names may cost, milliseconds.
constexpr double ASKED = 2.0;

std::vector<osgGeoFX::MapName> scatter(const osgGeoFX::TerrainRelief& relief, std::size_t count)
{
    std::mt19937 random(7);
    const auto within = [&](double low, double high)
    {
        return low + (high - low) * (static_cast<double>(random()) / 4294967296.0);
    };
    std::vector<osgGeoFX::MapName> names;
    while (names.size() < count)
    {
        osgGeoFX::MapName name;
        name.text = "Place number " + std::to_string(names.size());
        name.places = {{within(relief.west, relief.east), within(relief.south, relief.north), std::nan("")}};
        const int column = static_cast<int>((name.places[0].x() - relief.west) / (relief.east - relief.west) *
                                            relief.columns);
        const int row = static_cast<int>((name.places[0].y() - relief.south) / (relief.north - relief.south) *
                                         relief.rows);
        // Not in the sea.
        if (!(relief.heights[relief.index(column, row)] > 5.0f)) continue;
        name.importance = static_cast<double>(names.size());
        name.style = "hut";
        names.push_back(std::move(name));
    }
    return names;
}

/// What a traversal of the names takes: all that is done on the CPU before anything is drawn.
class Stopwatch : public osg::NodeCallback
{
public:
    void operator()(osg::Node* node, osg::NodeVisitor* visitor) override
    {
        const auto start = std::chrono::steady_clock::now();
        traverse(node, visitor);
        if (visitor->getVisitorType() == osg::NodeVisitor::CULL_VISITOR)
            seconds = std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
    }
    double seconds = 0.0;
};

/// Names on the ground, which all views have.
std::vector<osgGeoFX::MapName> placeNames(const Settings& settings, const std::filesystem::path& terrain)
{
    announce("putting names on the ground");
    const MapStage stage(mapViews().front(), terrain);
    const osgGeoFX::TerrainRelief relief = stage.relief(settings);
    std::vector<osgGeoFX::MapName> names = scatter(relief, settings.smoke ? 30 : NAMES);
    osgGeoFX::NamePlacement().place(names, *stage.scene.effects->getTerrain(), stage.ellipsoid(), relief);
    return names;
}

std::vector<Figure> measure(const MapView& view, const std::vector<osgGeoFX::MapName>& names,
                            const Settings& settings, const std::filesystem::path& terrain)
{
    announce(std::string("drawing names in ") + view.what);
    const MapStage stage(view, terrain);
    const osg::ref_ptr<osgGeoFX::MapLabels> labels =
        new osgGeoFX::MapLabels(*stage.scene.effects, new osgGeoFX::NameSet(names));
    // The clock of the drawing stands still, so nothing would fade in.
    osgGeoFX::LabelLayout::Rules rules;
    rules.fading = rules.patience = 0.0;
    labels->setRules(rules);
    const osg::ref_ptr<Stopwatch> watch = new Stopwatch;
    labels->setCullCallback(watch);
    const osg::ref_ptr<osg::Group> root = new osg::Group;
    root->addChild(stage.scene.node);
    root->addChild(labels);
    const std::unique_ptr<OffscreenView> offscreen = stage.draw(*root, settings);
    OffscreenView& drawing = *offscreen;
    for (int i = 0; i < 8; ++i)
        drawing.frame(); // depths are known some frames later
    const std::size_t shown = labels->shown(drawing.camera()).size();
    MapStage::save(drawing, settings, std::string("names-") + view.name);
    const int rounds = settings.smoke ? 3 : settings.quick ? 15 : 61;
    std::vector<double> with, without, culling;
    for (int round = 0; round < rounds; ++round)
    {
        labels->setNodeMask(0u);
        without.push_back(drawing.frame());
        labels->setNodeMask(~0u);
        drawing.frame(); // the buffers are there again
        with.push_back(drawing.frame());
        culling.push_back(watch->seconds);
    }
    Figure figure{std::string("names-") + view.name,
                  "what 500 names take of a frame on the CPU: finding, laying out and culling them, in " +
                      std::string(view.what),
                  "ms", Bound::AtMost, ASKED};
    figure.measured = 1000.0 * median(culling);
    char remark[200];
    std::snprintf(remark, sizeof remark,
                  "%zu names shown; frames of %.1f ms with names, %.1f ms without, both with drawing", shown,
                  1000.0 * median(with), 1000.0 * median(without));
    figure.remark = remark;
    figure.details = {{"shown", shown},
                      {"withMilliseconds", 1000.0 * median(with)},
                      {"withoutMilliseconds", 1000.0 * median(without)}};
    Figure whole{std::string("names-drawn-") + view.name,
                 "what 500 names add to a frame, drawn and their depths read, in " + std::string(view.what),
                 "ms"};
    whole.measured = 1000.0 * (median(with) - median(without));
    return {figure, whole};
}

std::vector<Figure> run(const Settings& settings)
{
    const WorkFolder folder(settings.work);
    const std::filesystem::path terrain = terrainToDraw(settings, folder);
    const std::vector<osgGeoFX::MapName> names = placeNames(settings, terrain);
    std::vector<Figure> figures;
    for (const MapView& view : mapViews())
    {
        if (!settings.wants(view.name)) continue;
        for (const Figure& figure : measure(view, names, settings, terrain))
            figures.push_back(figure);
    }
    return figures;
}

} // namespace

Suite labelsSuite()
{
    return {"labels",
            "Puts 500 names onto Oahu at 1600 x 900, in a plain, a bent and a painted view, and tells what "
            "they cost",
            {"plain", "bent", "map"},
            run};
}

} // namespace geofx::bench
