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
constexpr double STEP = 100.0 / 30.0; ///< metres from frame to frame: a flight at 100 m/s
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

/// What share of a path is a step of a flight, in its middle.
double shareOfStep(const PaperPath& path, const osgGeoFX::Georeference& reference)
{
    constexpr double part = 1e-3;
    const osg::Vec3d from = osg::Matrixd::inverse(path.view(0.5, reference)).getTrans();
    const osg::Vec3d to = osg::Matrixd::inverse(path.view(0.5 + part, reference)).getTrans();
    return part * STEP / (to - from).length();
}

/// The medians of frames in milliseconds, without and with shadows, after a step of the camera.
std::pair<double, double> fly(OffscreenView& view, const PaperPath& path,
                              const osgGeoFX::Georeference& reference, osgGeoFX::SunShadows& shadows,
                              int rounds)
{
    const double share = shareOfStep(path, reference);
    std::vector<double> times[2];
    for (int turn = 0; turn < 2 * rounds; ++turn)
    {
        shadows.setEnabled(turn % 2 == 1);
        const int round = turn / 2;
        // Each kind flies the same way; its first step only follows the other kind.
        for (int step = 0; step < 3; ++step)
        {
            view.look(path.view(0.5 + share * (3 * round + step), reference));
            const double seconds = view.frame();
            if (step > 0) times[turn % 2].push_back(1000.0 * seconds);
        }
    }
    return {median(times[0]), median(times[1])};
}

std::vector<Figure> measure(const Settings& settings, const std::filesystem::path& terrain,
                            const PaperPath& path)
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

    const osgGeoFX::SunShadows::Statistics before = shadows->statistics();
    const std::pair<double, double> flown =
        fly(view, path, *scene->reference, *shadows, settings.smoke ? 2 : 9);
    const osgGeoFX::SunShadows::Statistics after = shadows->statistics();
    Figure flight{"shadows-flight-" + path.name, "the same while the camera flies at 100 m/s", "",
                  Bound::None, 0.0};
    flight.measured = flown.second / flown.first;
    const auto drawn = static_cast<double>(after.drawn - before.drawn),
               kept = static_cast<double>(after.kept - before.kept);
    std::snprintf(remark, sizeof remark,
                  "without %.0f ms, with %.0f ms; %.1f of %d maps are drawn anew in a frame", flown.first,
                  flown.second, shadows->getCascades() * drawn / (drawn + kept), shadows->getCascades());
    flight.remark = remark;
    return {figure, flight};
}

} // namespace

std::vector<Figure> measureTownShadows(const Settings& settings, const std::filesystem::path& terrain)
{
    std::vector<Figure> figures;
    for (const PaperPath& path : paperPaths())
        for (const Figure& figure : measure(settings, terrain, path))
            figures.push_back(figure);
    return figures;
}

} // namespace geofx::bench
