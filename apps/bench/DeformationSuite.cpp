// SPDX-License-Identifier: MIT
// SPDX-FileCopyrightText: 2026 the osgGeoFX authors
#include "DeformationSuite.h"

#include "BenchError.h"
#include "ChildProcess.h"
#include "OahuTerrain.h"
#include "OffscreenView.h"
#include "PaperTables.h"
#include "TerrainSuite.h"
#include "TileCollector.h"
#include "TownCulling.h"
#include "TownShadows.h"
#include "TownTerrain.h"
#include "WorkFolder.h"

#include <osgGeoFX/deformation/PerspectiveBend.h>
#include <osgGeoFX/scene/DeformedView.h>
#include <osgGeoFX/viewer/EffectKinds.h>
#include <osgGeoFX/viewer/Scene.h>

#include <osg/Geometry>
#include <osg/Math>
#include <osg/MatrixTransform>
#include <osg/Switch>
#include <osgDB/WriteFile>

#include <algorithm>
#include <chrono>
#include <cstdio>
#include <random>

namespace geofx::bench
{

namespace
{

constexpr OffscreenView::Size FULL_SIZE = {1600, 900};
const double FIELD_OF_VIEW = osg::DegreesToRadians(40.0);

/// One of the paper's situations on Oahu.
struct Case
{
    const char* name;
    const char* what;
    const char* effect;
    osgGeoFX::ViewPoint place;
    double frames; ///< a second, over those without, at least; 0 where nothing is asked
};

osgGeoFX::ViewPoint place(double longitude, double latitude, double height, double heading, double pitch)
{
    return {osg::DegreesToRadians(longitude), osg::DegreesToRadians(latitude), height,
            osg::DegreesToRadians(heading),   osg::DegreesToRadians(pitch),    0.0};
}

std::vector<Case> cases()
{
    return {{"birdsEye", "bird's-eye view of Honolulu, the Koolau as its skyline",
             "birdsEyeView focusLine=0.4 horizonLine=0.85", place(-157.862, 21.281, 5000.0, 20.0, -50.0),
             0.8},
            {"pedestrian", "pedestrian's view from Honolulu, Oahu folded up ahead",
             "pedestrianView bendAngle=50 focusDistance=1500 zoneWidth=2500 planeHeight=20 tallest=700",
             place(-157.862, 21.281, 250.0, 20.0, 2.0), 1.0},
            {"exaggeration", "vertical exaggeration by 2, over Honolulu", "verticalExaggeration factor=2",
             place(-157.862, 21.24, 3500.0, 20.0, -20.0), 0.0},
            {"liberty", "a liberty with the mountains behind Honolulu: enlarged, widened and turned",
             "regionalLiberty longitude=-157.83 latitude=21.34 across=9000 along=9000 enlarge=1.4 widen=1.3 "
             "turn=15",
             place(-157.862, 21.24, 3500.0, 20.0, -20.0), 0.0}};
}

/// Puts the vertices of collected tiles where a deformation leaves them, in copies.
class BentBeforehand
{
public:
    BentBeforehand(const osgGeoFX::DeformationChain& chain, const osg::Matrixd& view)
        : _chain(chain), _view(view)
    {
    }

    /// The same picture as that of the deformed \p tiles, without a deformation: the light falls on the ground as it was.
    osg::ref_ptr<osg::Group> copy(const osg::Group& tiles)
    {
        osg::ref_ptr<osg::Group> result = new osg::Group;
        result->setStateSet(const_cast<osg::StateSet*>(tiles.getStateSet()));
        for (unsigned int i = 0; i < tiles.getNumChildren(); ++i)
        {
            const osg::Node& child = *tiles.getChild(i);
            if (const auto* tile = dynamic_cast<const osg::MatrixTransform*>(&child))
                result->addChild(moved(*tile));
            else
                result->addChild(copy(*child.asGroup()));
        }
        return result;
    }

private:
    osg::ref_ptr<osg::MatrixTransform> moved(const osg::MatrixTransform& tile)
    {
        const osg::ref_ptr<osg::MatrixTransform> place = new osg::MatrixTransform(tile.getMatrix());
        const osg::Geometry* mesh = tile.getChild(0)->asGeometry();
        const auto* vertices = mesh ? dynamic_cast<const osg::Vec3Array*>(mesh->getVertexArray()) : nullptr;
        if (!vertices) return place;
        osg::ref_ptr<osg::Vec3Array>& array = _known[vertices];
        if (!array)
        {
            const osg::Matrixd modelView = tile.getMatrix() * _view;
            const osg::Matrixd back = osg::Matrixd::inverse(modelView);
            array = new osg::Vec3Array;
            for (const osg::Vec3& vertex : *vertices)
                array->push_back(_chain.deform(osg::Vec3d(vertex) * modelView) * back);
        }
        const osg::ref_ptr<osg::Geometry> bent = new osg::Geometry(*mesh, osg::CopyOp::SHALLOW_COPY);
        bent->setVertexArray(array);
        place->addChild(bent);
        return place;
    }

    const osgGeoFX::DeformationChain& _chain;
    const osg::Matrixd _view;
    /// The meshes of a tile have their vertices in common.
    std::map<const osg::Array*, osg::ref_ptr<osg::Vec3Array>> _known;
};

using Part = OffscreenView::Part;
/// Milliseconds of two things that take turns.
using Pair = std::pair<double, double>;

class Bench
{
public:
    Bench(const std::filesystem::path& terrain, const Settings& settings)
        : _terrain(terrain), _pictures(settings.pictures),
          _size(settings.smoke ? OffscreenView::Size{320, 180} : FULL_SIZE), _rounds(settings.smoke ? 2 : 15),
          _picks(settings.smoke ? 5 : 200)
    {
        std::string error;
        const std::optional<osgGeoFX::Scene> scene = osgGeoFX::Scene::load(terrain.string(), error);
        if (!scene) throw BenchError(error);
        if (!scene->terrain || !scene->reference)
            throw BenchError(terrain.string() + ": it is no terrain database; name one with --terrain FILE.");
        _scene = *scene;
        _root->addChild(_scene.node);
        _view = std::make_unique<OffscreenView>(_size, FIELD_OF_VIEW, _root);
        const float scale =
            osgGeoFX::lodScaleFor(*scene->terrain, osgGeoFX::pixelsPerRadian(_size.height, FIELD_OF_VIEW));
        _view->camera().setLODScale(settings.smoke ? 32.0f : scale);
    }

    std::vector<Figure> measure(const Case& each)
    {
        announce(std::string("drawing the ") + each.what);
        std::string error;
        const osg::ref_ptr<osgGeoFX::Effect> effect = osgGeoFX::parseEffect(each.effect, error);
        if (!effect) throw BenchError(error);
        osg::Matrixd matrix;
        if (!each.place.viewMatrix(*_scene.reference, matrix))
            throw BenchError("The terrain database has no place for the views; take one that covers Oahu.");
        _view->look(matrix);

        std::vector<Figure> figures;
        const OffscreenView::Drawn straight = settled(each, "straight");
        _scene.effects->addEffect(effect);
        const OffscreenView::Drawn bent = settled(each, "bent");
        figures.push_back(path(each, straight, bent, *effect));
        const osg::ref_ptr<osg::Group> tiles = TileCollector::collect(*_view, *_scene.node);
        figures.push_back(picking(each));
        _scene.effects->removeEffect(effect);
        figures.push_back(bytes(each, *effect));
        for (const Figure& figure : sameTiles(each, *effect, *tiles))
            figures.push_back(figure);
        return figures;
    }

    /// Finer levels in the zone, as they are without OpenGL 4, against levels that are none the finer, and divided triangles.
    Figure tessellation(const Case& each)
    {
        announce(std::string("dividing the triangles of the ") + each.what);
        std::string error;
        const osg::ref_ptr<osgGeoFX::Effect> effect = osgGeoFX::parseEffect(each.effect, error);
        auto* bend = dynamic_cast<osgGeoFX::PerspectiveBend*>(effect.get());
        if (!bend) throw BenchError(error);
        osg::Matrixd matrix;
        if (!each.place.viewMatrix(*_scene.reference, matrix))
            throw BenchError("The terrain database has no place for the views; take one that covers Oahu.");
        _view->look(matrix);
        const auto divide = [&](bool on)
        {
            bend->setTessellation(on);
            bend->setTransitionDetail(on ? 1.0 : 2.0);
        };
        _scene.effects->addEffect(bend);
        divide(false);
        const OffscreenView::Drawn finer = settled(each, "finer-levels");
        divide(true);
        const OffscreenView::Drawn divided = settled(each, "tessellated");
        const Pair frames = _view->takeTurns(
            _rounds, Part::ALL, [&] { divide(false); }, [&] { divide(true); });
        const Pair culls = _view->takeTurns(
            _rounds, Part::CULL, [&] { divide(false); }, [&] { divide(true); });
        _scene.effects->removeEffect(bend);
        Figure figure{
            std::string("tessellation-") + each.name,
            std::string("time of a frame with tessellation over one with finer levels: ") + each.what, ""};
        figure.measured = frames.second / frames.first;
        char remark[200];
        std::snprintf(
            remark, sizeof remark,
            "finer levels %.1f ms, %.0f thousand triangles, culled in %.2f ms; tessellation %.1f ms, "
            "%.0f thousand before they are divided, %.2f ms",
            frames.first, static_cast<double>(finer.triangles) * 1e-3, culls.first, frames.second,
            static_cast<double>(divided.triangles) * 1e-3, culls.second);
        figure.remark = remark;
        figure.details = {{"finerMilliseconds", frames.first},
                          {"tessellatedMilliseconds", frames.second},
                          {"finerTriangles", finer.triangles},
                          {"undividedTriangles", divided.triangles}};
        return figure;
    }

    Figure cullOfPagedScene(const Case& each)
    {
        // An exaggeration that no one sees keeps every tile where it is, and goes through all that culling does.
        std::string error;
        const osg::ref_ptr<osgGeoFX::Effect> nothing =
            osgGeoFX::parseEffect("verticalExaggeration factor=1.0000001", error);
        osg::Matrixd matrix;
        each.place.viewMatrix(*_scene.reference, matrix);
        _view->look(matrix);
        _scene.effects->addEffect(nothing);
        _view->settle();
        const Pair cull = _view->takeTurns(
            _rounds, Part::CULL, [&] { nothing->setEnabled(false); }, [&] { nothing->setEnabled(true); });
        _scene.effects->removeEffect(nothing);
        Figure figure{"cull-paged",
                      "time to cull the paged terrain with compensation over OSG's own, same tiles", "",
                      Bound::AtMost, 1.5};
        figure.measured = cull.second / cull.first;
        describe(figure, cull, "OSG", "compensating");
        return figure;
    }

private:
    void draw(osg::Node* what)
    {
        _root->removeChildren(0, _root->getNumChildren());
        _root->addChild(what);
    }

    OffscreenView::Drawn settled(const Case& each, const char* kind)
    {
        _view->settle();
        if (!_pictures.empty())
        {
            const std::filesystem::path file = _pictures / (std::string(each.name) + "-" + kind + ".png");
            if (!osgDB::writeImageFile(*_view->capture(), file.string()))
                throw BenchError(file.string() + ": the picture cannot be written; name another folder.");
        }
        return _view->count();
    }

    static void describe(Figure& figure, const Pair& times, const char* first, const char* second)
    {
        char remark[200];
        std::snprintf(remark, sizeof remark, "%s %.3f ms, %s %.3f ms", first, times.first, second,
                      times.second);
        figure.remark = remark;
        figure.details = {{"firstMilliseconds", times.first}, {"secondMilliseconds", times.second}};
    }

    /// The paper's Table 1: frames with and without the deformation, each with the tiles it needs.
    Figure path(const Case& each, const OffscreenView::Drawn& straight, const OffscreenView::Drawn& bent,
                osgGeoFX::Effect& effect)
    {
        const Pair frames = _view->takeTurns(
            _rounds, Part::ALL, [&] { effect.setEnabled(false); }, [&] { effect.setEnabled(true); });
        Figure figure{
            std::string("frames-") + each.name,
            std::string("frames a second with the deformation over those without, each with its tiles: ") +
                each.what,
            ""};
        figure.bound = each.frames > 0.0 ? Bound::AtLeast : Bound::None;
        figure.asked = each.frames;
        figure.measured = frames.first / frames.second;
        char remark[200];
        std::snprintf(remark, sizeof remark,
                      "%.1f frames/s, %.0f thousand triangles, without; %.1f frames/s, %.0f thousand, with",
                      1000.0 / frames.first, static_cast<double>(straight.triangles) * 1e-3,
                      1000.0 / frames.second, static_cast<double>(bent.triangles) * 1e-3);
        figure.remark = remark;
        figure.details = {{"straightMilliseconds", frames.first},
                          {"bentMilliseconds", frames.second},
                          {"straightTriangles", straight.triangles},
                          {"bentTriangles", bent.triangles}};
        return figure;
    }

    /// What the tiles of the first picture take from the disk.
    double bytesRead(osgGeoFX::Effect* effect)
    {
        std::string error;
        const std::optional<osgGeoFX::Scene> scene = osgGeoFX::Scene::load(_terrain.string(), error);
        if (!scene) throw BenchError(error);
        if (effect) scene->effects->addEffect(effect);
        draw(scene->node);
        _view->settle();
        draw(_scene.node);
        return static_cast<double>(scene->guard->counts().bytesRead);
    }

    Figure bytes(const Case& each, osgGeoFX::Effect& effect)
    {
        const double straight = bytesRead(nullptr);
        const double bent = bytesRead(&effect);
        Figure figure{std::string("bytes-") + each.name,
                      std::string("bytes read from the disk with the deformation over those without: ") +
                          each.what,
                      "", Bound::AtMost, 2.5};
        figure.measured = bent / straight;
        char remark[100];
        std::snprintf(remark, sizeof remark, "%.1f MB without, %.1f MB with", straight * 1e-6, bent * 1e-6);
        figure.remark = remark;
        figure.details = {{"straightBytes", straight}, {"bentBytes", bent}};
        return figure;
    }

    Figure picking(const Case& each)
    {
        const osgGeoFX::DeformedView picture(*_scene.effects, _view->camera());
        std::mt19937 engine(1);
        std::uniform_real_distribution<double> across(0.0, _size.width);
        std::uniform_real_distribution<double> up(0.0, 0.8 * _size.height);
        std::vector<double> times;
        for (int i = 0; i < _picks; ++i)
        {
            const auto start = std::chrono::steady_clock::now();
            picture.pick(across(engine), up(engine));
            times.push_back(
                std::chrono::duration<double, std::milli>(std::chrono::steady_clock::now() - start).count());
        }
        Figure figure{std::string("picking-") + each.name, std::string("time to pick a pixel: ") + each.what,
                      "milliseconds"};
        figure.measured = median(times);
        return figure;
    }

    /// Frame and cull over the very same tiles, without a hierarchy.
    std::vector<Figure> sameTiles(const Case& each, osgGeoFX::Effect& effect, osg::Group& tiles)
    {
        const osg::ref_ptr<osgGeoFX::EffectScene> bent = deformedTiles(_scene, effect, tiles);
        const osg::ref_ptr<osg::Group> straight = new osg::Group;
        straight->addChild(&tiles);
        const auto first = [&]
        {
            draw(straight);
        };
        const auto second = [&]
        {
            draw(bent);
        };

        osg::Camera& camera = _view->camera();
        const osg::CullSettings::CullingMode mode = camera.getCullingMode();
        camera.setCullingMode(osg::CullSettings::NO_CULLING);
        const Pair frames = _view->takeTurns(_rounds, Part::ALL, first, second);
        const osg::ref_ptr<osg::Group> moved =
            BentBeforehand(*bent->deformation(camera.getViewMatrix(), camera.getProjectionMatrix()),
                           camera.getViewMatrix())
                .copy(tiles);
        const Pair samePicture = _view->takeTurns(
            _rounds, Part::ALL, [&] { draw(moved); }, second);
        camera.setCullingMode(mode);
        Figure frame{std::string("bent-") + each.name,
                     std::string("time of a deformed frame over a straight one, same camera and tiles: ") +
                         each.what,
                     ""};
        frame.measured = frames.second / frames.first;
        describe(frame, frames, "straight", "deformed");
        // The straight frame above shows less: tiles that the bend brings into the picture cost it next to nothing.
        Figure bending{
            std::string("bending-") + each.name,
            std::string("time of a deformed frame over one of the same picture, its vertices moved "
                        "beforehand: ") +
                each.what,
            "", Bound::AtMost, 1.1};
        bending.measured = samePicture.second / samePicture.first;
        describe(bending, samePicture, "moved beforehand", "deformed");

        const osg::Matrixd view = camera.getViewMatrix();
        const osg::Matrixd above = viewOfAll(_scene, tiles, FIELD_OF_VIEW);
        const Pair culls = _view->takeTurns(
            _rounds, Part::CULL,
            [&]
            {
                first();
                camera.setViewMatrix(above);
            },
            [&]
            {
                second();
                camera.setViewMatrix(view);
            });
        camera.setViewMatrix(view);
        draw(_scene.node);
        Figure cull{
            std::string("cull-") + each.name,
            std::string("time to cull deformed tiles over OSG's own for the same tiles, all in sight: ") +
                each.what,
            "", Bound::AtMost, 1.5};
        cull.measured = culls.second / culls.first;
        describe(cull, culls, "OSG", "compensating");
        return {frame, bending, cull};
    }

    const std::filesystem::path _terrain;
    const std::filesystem::path _pictures;
    const OffscreenView::Size _size;
    const int _rounds;
    const int _picks;
    osgGeoFX::Scene _scene;
    osg::ref_ptr<osg::Group> _root = new osg::Group;
    std::unique_ptr<OffscreenView> _view;
};

std::vector<Figure> run(const Settings& settings)
{
    const WorkFolder folder(settings.work);
    std::vector<Figure> figures;
    const auto add = [&](const std::vector<Figure>& more)
    {
        figures.insert(figures.end(), more.begin(), more.end());
    };
    const std::vector<Case> all = cases();
    if (std::any_of(all.begin(), all.end(), [&](const Case& each) { return settings.wants(each.name); }) ||
        settings.wants("cull") || settings.wants("tessellation"))
    {
        Bench bench(terrainToDraw(settings, folder), settings);
        for (const Case& each : all)
            if (settings.wants(each.name)) add(bench.measure(each));
        if (settings.wants("cull")) figures.push_back(bench.cullOfPagedScene(all.back()));
        for (std::size_t i = 0; i < 2 && settings.wants("tessellation"); ++i)
            figures.push_back(bench.tessellation(all[i]));
    }
    if (settings.wants("town") || settings.wants("shadows") || settings.wants("tables"))
    {
        const std::filesystem::path town = townToDraw(settings, folder.path());
        if (settings.wants("town")) add(measureTownCulling(settings, town));
        if (settings.wants("shadows")) add(measureTownShadows(settings, town));
        if (settings.wants("tables")) add(measurePaperTables(settings, town, folder.path()));
    }
    return figures;
}

} // namespace

Suite deformationSuite()
{
    return {
        "deformation",
        "Draws Oahu bent and straight: frames, culling, picking (birdsEye, pedestrian, exaggeration, "
        "liberty), divided triangles against finer levels (tessellation), the culling of the paged terrain "
        "(cull) and of a town of 16,000 buildings (town), "
        "what the sun's shadows cost over this town (shadows), and the paper's two tables along paths "
        "over it (tables)",
        {"birdsEye", "pedestrian", "exaggeration", "liberty", "tessellation", "cull", "town", "shadows",
         "tables"},
        run};
}

} // namespace geofx::bench
