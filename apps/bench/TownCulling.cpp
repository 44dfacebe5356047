// SPDX-License-Identifier: MIT
// SPDX-FileCopyrightText: 2026 the osgGeoFX authors
#include "TownCulling.h"

#include "BenchError.h"
#include "OffscreenView.h"
#include "PaperPath.h"
#include "TileCollector.h"

#include <osgGeoFX/effect/RigidParts.h>
#include <osgGeoFX/viewer/EffectKinds.h>
#include <osgGeoFX/viewer/Scene.h>

#include <osg/Math>
#include <osgDB/ReadFile>

#include <cstdio>
#include <optional>
#include <utility>

namespace geofx::bench
{

namespace
{

const double FIELD_OF_VIEW = osg::DegreesToRadians(40.0);

/// A town without its ground, in one view.
class TownCulling
{
public:
    TownCulling(const Settings& settings, const std::filesystem::path& terrain)
        : _rounds(settings.smoke ? 2 : 15),
          _view(settings.smoke ? OffscreenView::Size{160, 120} : OffscreenView::Size{1600, 1200},
                FIELD_OF_VIEW, _root)
    {
        const osg::ref_ptr<osg::Node> node = osgDB::readRefNodeFile(terrain.string());
        osg::Group* database = node ? node->asGroup() : nullptr;
        if (!database) throw BenchError(terrain.string() + ": it cannot be read.");
        for (unsigned int i = database->getNumChildren(); i-- > 0;)
            if (database->getChild(i)->getName() != "buildings") database->removeChild(i);
        std::string error;
        std::optional<osgGeoFX::Scene> scene = osgGeoFX::Scene::adopt(database, error);
        if (!scene) throw BenchError(error);
        if (!scene->reference || database->getNumChildren() == 0)
            throw BenchError(terrain.string() +
                             ": it has no town; name a database with one with --terrain FILE.");
        _scene = std::move(*scene);
        _view.camera().setLODScale(_scene.lodScale(_view.camera().getViewport()->height(), FIELD_OF_VIEW));
    }

    std::vector<Figure> measure(const PaperPath& path)
    {
        announce("culling the town: " + path.name);
        std::string error;
        const osg::ref_ptr<osgGeoFX::Effect> effect = osgGeoFX::parseEffect(path.effect, error);
        if (!effect) throw BenchError(error);
        _scene.effects->addEffect(effect);
        draw(_scene.node);
        const osg::Matrixd look = path.view(0.5, *_scene.reference);
        _view.look(look);
        _view.settle();
        const double paged = _view
                                 .takeTurns(
                                     _rounds, OffscreenView::Part::CULL, [] {}, [] {})
                                 .second;
        const osg::ref_ptr<osg::Group> town = TileCollector::collect(
            _view, *_scene.node,
            [](const osg::Drawable& drawable) { return osgGeoFX::RigidParts::of(drawable) != nullptr; });
        const std::size_t drawables = _view.count().drawables;
        _scene.effects->removeEffect(effect);

        const osg::ref_ptr<osgGeoFX::EffectScene> bent = deformedTiles(_scene, *effect, *town);
        const osg::ref_ptr<osg::Group> straight = new osg::Group;
        straight->addChild(town);
        const osg::Matrixd above = viewOfAll(_scene, *town, FIELD_OF_VIEW);
        const std::pair<double, double> same = _view.takeTurns(
            _rounds, OffscreenView::Part::CULL,
            [&]
            {
                draw(straight);
                _view.look(above);
            },
            [&]
            {
                draw(bent);
                _view.look(look);
            });
        draw(_scene.node);

        Figure ratio{"cull-town-" + path.name,
                     "time to cull a deformed town's drawables over OSG's own for the same, all in sight: " +
                         path.what,
                     "", Bound::AtMost, 1.3};
        ratio.measured = same.second / same.first;
        char remark[200];
        std::snprintf(remark, sizeof remark, "OSG %.3f ms, compensating %.3f ms, %zu drawables", same.first,
                      same.second, drawables);
        ratio.remark = remark;
        Figure time{"cull-town-time-" + path.name,
                    "time to cull the deformed town with its levels of detail: " + path.what, "ms",
                    Bound::Below, 2.0};
        time.measured = paged;
        return {ratio, time};
    }

private:
    void draw(osg::Node* what)
    {
        _root->removeChildren(0, _root->getNumChildren());
        _root->addChild(what);
    }

    const int _rounds;
    const osg::ref_ptr<osg::Group> _root = new osg::Group;
    OffscreenView _view;
    osgGeoFX::Scene _scene;
};

} // namespace

std::vector<Figure> measureTownCulling(const Settings& settings, const std::filesystem::path& terrain)
{
    TownCulling culling(settings, terrain);
    std::vector<Figure> figures;
    for (const PaperPath& path : paperPaths())
        for (const Figure& figure : culling.measure(path))
            figures.push_back(figure);
    return figures;
}

} // namespace geofx::bench
