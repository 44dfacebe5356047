// SPDX-License-Identifier: MIT
// SPDX-FileCopyrightText: 2026 the osgGeoFX authors
#include "LabelsSuite.h"

#include "BenchError.h"
#include "OahuTerrain.h"
#include "OffscreenView.h"

#include <osgGeoFX/deformation/BirdsEyeView.h>
#include <osgGeoFX/labels/MapLabels.h>
#include <osgGeoFX/labels/NamePlacement.h>
#include <osgGeoFX/panorama/PanoramaMap.h>
#include <osgGeoFX/viewer/Scene.h>

#include <osg/Group>
#include <osg/Math>
#include <osgDB/WriteFile>

#include <chrono>
#include <cmath>
#include <cstdio>
#include <random>

namespace geofx::bench
{

namespace
{

constexpr OffscreenView::Size FULL_SIZE = {1600, 900};
const double FIELD_OF_VIEW = osg::DegreesToRadians(30.0);
constexpr int NAMES = 500;
/// What 500 names may cost, milliseconds.
constexpr double ASKED = 2.0;

struct NamedView
{
    const char* name;
    const char* what;
    osgGeoFX::ViewPoint place;
    osg::ref_ptr<osgGeoFX::Effect> effect;
};

std::vector<NamedView> views()
{
    const auto place = [](double longitude, double latitude, double height, double heading, double pitch)
    {
        return osgGeoFX::ViewPoint{osg::DegreesToRadians(longitude), osg::DegreesToRadians(latitude), height,
                                   osg::DegreesToRadians(heading),   osg::DegreesToRadians(pitch),    0.0};
    };
    osg::ref_ptr<osgGeoFX::BirdsEyeView> bird = new osgGeoFX::BirdsEyeView;
    bird->setFocusLine(0.35);
    bird->setHorizonLine(0.85);
    osg::ref_ptr<osgGeoFX::PanoramaMap> map = new osgGeoFX::PanoramaMap;
    map->setViewRadius(24000.0);
    return {{"plain", "a plain view", place(-157.9, 21.2, 12000.0, 0.0, -25.0), nullptr},
            {"bent", "a bird's-eye view", place(-157.9, 21.25, 9000.0, 0.0, -45.0), bird},
            {"map", "a panorama map", place(-157.753, 21.22, 8000.0, 0.0, -40.0), map}};
}

std::vector<osgGeoFX::MapName> scatter(const osgGeoFX::TerrainRelief& relief)
{
    std::mt19937 random(7);
    const auto within = [&](double low, double high)
    {
        return low + (high - low) * (static_cast<double>(random()) / 4294967296.0);
    };
    std::vector<osgGeoFX::MapName> names;
    while (names.size() < NAMES)
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

std::vector<Figure> measure(const NamedView& view, const Settings& settings,
                            const std::filesystem::path& terrain)
{
    announce(std::string("drawing names in ") + view.what);
    std::string error;
    std::optional<osgGeoFX::Scene> scene = osgGeoFX::Scene::load(terrain.string(), error);
    if (!scene) throw BenchError(error);
    osg::Matrixd matrix;
    if (!scene->reference || !view.place.viewMatrix(*scene->reference, matrix))
        throw BenchError(terrain.string() +
                         ": it has no place for the views; name a database of Oahu with --terrain FILE.");
    const osg::ref_ptr<const osg::EllipsoidModel> ellipsoid = scene->effects->ground().ellipsoid;
    const auto relief =
        osgGeoFX::TerrainRelief::read(*scene->node, ellipsoid.get(), settings.smoke ? 256 : 1024, error);
    if (!relief) throw BenchError(terrain.string() + ": " + error);
    std::vector<osgGeoFX::MapName> names = scatter(*relief);
    osgGeoFX::NamePlacement().place(names, *scene->node, ellipsoid.get(), *relief);
    if (view.effect) scene->effects->addEffect(view.effect);
    const osg::ref_ptr<osgGeoFX::MapLabels> labels =
        new osgGeoFX::MapLabels(*scene->effects, new osgGeoFX::NameSet(std::move(names)));
    // The clock of the drawing stands still, so nothing would fade in.
    osgGeoFX::LabelLayout::Rules rules;
    rules.fading = rules.patience = 0.0;
    labels->setRules(rules);
    const osg::ref_ptr<Stopwatch> watch = new Stopwatch;
    labels->setCullCallback(watch);
    const osg::ref_ptr<osg::Group> root = new osg::Group;
    root->addChild(scene->node);
    root->addChild(labels);
    const OffscreenView::Size size = settings.smoke ? OffscreenView::Size{320, 180} : FULL_SIZE;
    OffscreenView drawing(size, FIELD_OF_VIEW, root);
    drawing.camera().setLODScale(scene->lodScale(size.height, FIELD_OF_VIEW));
    drawing.look(matrix);
    drawing.settle();
    for (int i = 0; i < 8; ++i)
        drawing.frame(); // depths are known some frames later
    const std::size_t shown = labels->shown(drawing.camera()).size();
    if (!settings.pictures.empty())
    {
        const std::filesystem::path file = settings.pictures / (std::string("names-") + view.name + ".png");
        if (!osgDB::writeImageFile(*drawing.capture(), file.string()))
            throw BenchError(file.string() +
                             ": the picture cannot be written; name another folder with --pictures.");
    }
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
    std::vector<Figure> figures;
    for (const NamedView& view : views())
    {
        if (!settings.wants(view.name)) continue;
        for (const Figure& figure : measure(view, settings, terrain))
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
