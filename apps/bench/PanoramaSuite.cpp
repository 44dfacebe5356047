// SPDX-License-Identifier: MIT
// SPDX-FileCopyrightText: 2026 the osgGeoFX authors
#include "PanoramaSuite.h"

#include "BenchError.h"
#include "OahuTerrain.h"
#include "OffscreenView.h"

#include <osgGeoFX/panorama/PanoramaMap.h>
#include <osgGeoFX/scene/EffectScene.h>
#include <osgGeoFX/viewer/Scene.h>

#include <osg/Math>
#include <osgDB/WriteFile>

#include <cstdio>
#include <functional>

namespace geofx::bench
{

namespace
{

using osgGeoFX::PanoramaMap;

constexpr OffscreenView::Size PAPER_SIZE = {1089, 690};
const double FIELD_OF_VIEW = osg::DegreesToRadians(30.0);
/// The paper's frames a second.
constexpr double PAPER_SPEED = 23.0;

struct NamedView
{
    const char* name;
    const char* what;
    osgGeoFX::ViewPoint place;
    double viewRadius; ///< metres
    bool whole;
};

std::vector<NamedView> views()
{
    const auto place = [](double longitude, double latitude, double heading)
    {
        return osgGeoFX::ViewPoint{osg::DegreesToRadians(longitude), osg::DegreesToRadians(latitude), 8000.0,
                                   osg::DegreesToRadians(heading),   osg::DegreesToRadians(-40.0),    0.0};
    };
    return {{"whole", "the whole terrain", place(-157.753, 21.22, 0.0), 24000.0, true},
            {"near", "Honolulu and the Koolau", place(-157.87, 21.28, 20.0), 6000.0, false}};
}

struct Part
{
    const char* name;
    const char* what;
    bool (PanoramaMap::*set)(bool);
};

constexpr Part parts[] = {{"paint", "the ground's painting", &PanoramaMap::setPaint},
                          {"strokes", "strokes", &PanoramaMap::setStrokes},
                          {"water", "water", &PanoramaMap::setWater},
                          {"sky", "the sky", &PanoramaMap::setSky}};

/// The paged scene, and the same with all its finest tiles and nothing culled.
class Bench
{
public:
    Bench(const Settings& settings, const std::filesystem::path& terrain)
        : _settings(settings), _rounds(settings.smoke   ? 1
                                       : settings.quick ? 5
                                                        : 15),
          _size(settings.smoke ? OffscreenView::Size{160, 100} : PAPER_SIZE)
    {
        std::string error;
        const std::optional<osgGeoFX::Scene> scene = osgGeoFX::Scene::load(terrain.string(), error);
        if (!scene) throw BenchError(error);
        if (!scene->terrain || !scene->reference)
            throw BenchError(terrain.string() + ": it is no terrain database; name one with --terrain FILE.");
        _reference = scene->reference;
        scene->effects->addEffect(_map);
        _view = std::make_unique<OffscreenView>(_size, FIELD_OF_VIEW, scene->node);
        _lodScale = (settings.smoke ? 4.0f : 1.0f) * scene->lodScale(_size.height, FIELD_OF_VIEW);
    }

    std::vector<Figure> measure(const NamedView& view)
    {
        announce(std::string("drawing the view ") + view.name);
        osg::Matrixd matrix;
        if (!view.place.viewMatrix(*_reference, matrix))
            throw BenchError("The terrain database has no place for the views; take one that covers Oahu.");
        _view->look(matrix);
        _map->setViewRadius(view.viewRadius);
        std::vector<Figure> figures = {speed(view)};
        for (const Part& part : parts)
            figures.push_back(cost(view, part));
        return figures;
    }

private:
    void show(bool whole)
    {
        osg::Camera& camera = _view->camera();
        camera.setLODScale(!whole ? _lodScale : _settings.smoke ? 0.5f * _lodScale : 1e-9f);
        camera.setCullingMode(whole ? osg::CullSettings::NO_CULLING : osg::CullSettings::DEFAULT_CULLING);
        _view->settle();
    }

    Figure speed(const NamedView& view)
    {
        std::vector<double> seconds[2];
        OffscreenView::Drawn drawn[2];
        for (int round = 0; round < _rounds; ++round)
        {
            for (const int whole : {0, 1})
            {
                show(whole);
                seconds[whole].push_back(_view->frame());
                if (!whole) seconds[whole].push_back(_view->frame());
            }
        }
        for (const int whole : {1, 0})
        {
            show(whole);
            drawn[whole] = _view->count();
            save(view, whole ? "whole" : "paged");
        }
        const double paged = median(seconds[0]), all = median(seconds[1]);
        Figure figure{std::string("speed-") + view.name,
                      std::string("frames a second of the paged map over those of all its finest tiles: ") +
                          view.what,
                      "", view.whole ? Bound::AtLeast : Bound::None, view.whole ? 15.0 : 0.0};
        figure.measured = all / paged;
        char remark[300];
        std::snprintf(
            remark, sizeof remark,
            "paged %.2f frames/s, %.0f thousand triangles; whole %.2f frames/s, %.0f thousand triangles; the "
            "paper: %.0f frames/s of its whole scene on a laptop's GPU",
            1.0 / paged, static_cast<double>(drawn[0].triangles) * 1e-3, 1.0 / all,
            static_cast<double>(drawn[1].triangles) * 1e-3, PAPER_SPEED);
        figure.remark = remark;
        figure.details = {{"pagedMilliseconds", 1000.0 * paged},  {"pagedTriangles", drawn[0].triangles},
                          {"pagedDrawables", drawn[0].drawables}, {"wholeMilliseconds", 1000.0 * all},
                          {"wholeTriangles", drawn[1].triangles}, {"wholeDrawables", drawn[1].drawables}};
        return figure;
    }

    /// Frames with all, over frames without one part, which take turns.
    Figure cost(const NamedView& view, const Part& part)
    {
        std::vector<double> seconds[2];
        for (const bool on : {false, true})
        {
            (_map->*part.set)(on);
            _view->settle();
        }
        for (int round = 0; round < _rounds; ++round)
        {
            for (const bool on : {false, true})
            {
                (_map->*part.set)(on);
                seconds[on].push_back(_view->frame());
            }
        }
        const double without = median(seconds[0]), with = median(seconds[1]);
        Figure figure{std::string(part.name) + "-" + view.name,
                      std::string("a frame over one without ") + part.what + ": " + view.what, ""};
        figure.measured = with / without;
        char remark[120];
        std::snprintf(remark, sizeof remark, "%.1f ms with, %.1f ms without", 1000.0 * with,
                      1000.0 * without);
        figure.remark = remark;
        return figure;
    }

    void save(const NamedView& view, const std::string& kind)
    {
        if (_settings.pictures.empty()) return;
        const std::filesystem::path file =
            _settings.pictures / (std::string(view.name) + "-" + kind + ".png");
        if (!osgDB::writeImageFile(*_view->capture(), file.string()))
            throw BenchError(file.string() +
                             ": the picture cannot be written; name another folder with --pictures.");
    }

    const Settings& _settings;
    const int _rounds;
    const OffscreenView::Size _size;
    const osg::ref_ptr<PanoramaMap> _map = new PanoramaMap;
    osg::ref_ptr<osgGeoFX::Georeference> _reference;
    std::unique_ptr<OffscreenView> _view;
    float _lodScale = 1.0f;
};

std::vector<Figure> run(const Settings& settings)
{
    const WorkFolder folder(settings.work);
    Bench bench(settings, windowToDraw(settings, folder.path(),
                                       osgGeoFX::pixelsPerRadian(PAPER_SIZE.height, FIELD_OF_VIEW)));
    std::vector<Figure> figures;
    for (const NamedView& view : views())
    {
        if (!settings.wants(view.name)) continue;
        for (const Figure& figure : bench.measure(view))
            figures.push_back(figure);
    }
    return figures;
}

} // namespace

Suite panoramaSuite()
{
    return {"panorama",
            "Draws the panorama map of a scene with 5.25 million triangles at 1089 x 690, paged and whole, "
            "and tells what "
            "its parts cost",
            {"whole", "near"},
            run};
}

} // namespace geofx::bench
