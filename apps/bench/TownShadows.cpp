// SPDX-License-Identifier: MIT
// SPDX-FileCopyrightText: 2026 the osgGeoFX authors
#include "TownShadows.h"

#include "BenchError.h"
#include "OffscreenView.h"
#include "PaperPath.h"

#include <osgGeoFX/light/SunLight.h>
#include <osgGeoFX/light/SunShadows.h>
#include <osgGeoFX/viewer/EffectKinds.h>
#include <osgGeoFX/viewer/Scene.h>

#include <osg/Math>

#include <cstdio>
#include <optional>
#include <utility>

namespace geofx::bench
{

namespace
{

const double FIELD_OF_VIEW = osg::DegreesToRadians(40.0);
constexpr const char* AFTERNOON = "2026-06-21T16:30:00-10:00";

/// The sun of an afternoon, where the database is.
osg::ref_ptr<osg::Group> lit(const osgGeoFX::Scene& scene, const osgGeoFX::ViewPoint& place)
{
    osg::Matrixd frame;
    if (!scene.reference || !scene.reference->localToWorld(place.longitude, place.latitude, 0.0, frame))
        throw BenchError("The database does not say where on the Earth it is.");
    const osg::ref_ptr<osgGeoFX::SunLight> sun = new osgGeoFX::SunLight;
    sun->setPlace(place.longitude, place.latitude, frame);
    sun->setTime(*osgGeoFX::readClockTime(AFTERNOON));
    const osg::ref_ptr<osg::Group> both = new osg::Group;
    both->addChild(sun);
    both->addChild(scene.node);
    both->getOrCreateStateSet()->setMode(GL_LIGHTING, osg::StateAttribute::ON);
    both->getStateSet()->setMode(GL_LIGHT0, osg::StateAttribute::ON);
    return both;
}

Figure measure(const Settings& settings, const std::filesystem::path& terrain, const PaperPath& path)
{
    announce("shadows of the town: " + path.name);
    std::string error;
    std::optional<osgGeoFX::Scene> scene = osgGeoFX::Scene::load(terrain.string(), error);
    const osg::ref_ptr<osgGeoFX::Effect> effect = scene ? osgGeoFX::parseEffect(path.effect, error) : nullptr;
    if (!effect) throw BenchError(error);
    const osg::ref_ptr<osgGeoFX::SunShadows> shadows = new osgGeoFX::SunShadows;
    scene->effects->addEffect(shadows);
    scene->effects->addEffect(effect);
    const osg::ref_ptr<osg::Group> root = lit(*scene, path.places.front());
    OffscreenView view(settings.smoke ? OffscreenView::Size{160, 120} : OffscreenView::Size{1600, 1200},
                       FIELD_OF_VIEW, root);
    view.view().setLightingMode(osg::View::NO_LIGHT);
    view.camera().setLODScale(scene->lodScale(view.camera().getViewport()->height(), FIELD_OF_VIEW));
    view.look(path.view(0.5, *scene->reference));
    view.settle();
    const std::pair<double, double> times = view.takeTurns(
        settings.smoke ? 2 : 9, OffscreenView::Part::ALL, [&] { shadows->setEnabled(false); },
        [&] { shadows->setEnabled(true); });
    const std::pair<double, double> culls = view.takeTurns(
        settings.smoke ? 2 : 9, OffscreenView::Part::CULL, [&] { shadows->setEnabled(false); },
        [&] { shadows->setEnabled(true); });
    Figure figure{"shadows-" + path.name,
                  "time of a frame with the shadows of the sun over one without them: " + path.what, "",
                  Bound::None, 0.0};
    figure.measured = times.second / times.first;
    char remark[200];
    std::snprintf(remark, sizeof remark,
                  "without %.0f ms, with %.0f ms; culling without %.2f ms, with %.2f ms", times.first,
                  times.second, culls.first, culls.second);
    figure.remark = remark;
    return figure;
}

} // namespace

std::vector<Figure> measureTownShadows(const Settings& settings, const std::filesystem::path& terrain)
{
    std::vector<Figure> figures;
    for (const PaperPath& path : paperPaths())
        figures.push_back(measure(settings, terrain, path));
    return figures;
}

} // namespace geofx::bench
