// SPDX-License-Identifier: MIT
// SPDX-FileCopyrightText: 2026 the osgGeoFX authors
#include "CloseUpSuite.h"

#include "BenchError.h"
#include "OahuTerrain.h"
#include "OffscreenView.h"

#include <osgGeoFX/closeup/CloseUps.h>
#include <osgGeoFX/paging/TerrainInfo.h>
#include <osgGeoFX/scene/EffectScene.h>
#include <osgGeoFX/viewer/Scene.h>

#include <osg/Geometry>
#include <osg/Math>
#include <osgDB/WriteFile>

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <functional>

namespace geofx::bench
{

namespace
{

using osgGeoFX::Anchor;
using osgGeoFX::CloseUp;
using osgGeoFX::CloseUps;
using osgGeoFX::EffectScene;

constexpr OffscreenView::Size PAPER_SIZE = {1280, 720};
const double FIELD_OF_VIEW = osg::DegreesToRadians(40.0);
/// The paper's grid has 5,659,666 vertices; this one has 2379 on a side.
constexpr int GRID_QUADS = 2378;
/// Of a patch. The paper's grid is one mesh; terrain comes in tiles, so ours is cut into 41 by 41.
constexpr int PATCH_QUADS = 58;
/// Half the side of the grid, metres.
constexpr double REACH = 10000.0;
/// The paper's Table I: frames a second with so many close-ups.
constexpr double table1[] = {517.9, 226.5, 142.1, 104.8, 81.2};
constexpr int counts[] = {1, 2, 3, 4, 16};

double heightAt(double x, double y)
{
    return 500.0 * std::sin(x / 1700.0) * std::cos(y / 2100.0) + 90.0 * std::sin((x - 2.0 * y) / 500.0);
}

osg::ref_ptr<osg::Geometry> makePatch(int column, int row, int quads, int gridQuads)
{
    const double step = 2.0 * REACH / gridQuads;
    osg::ref_ptr<osg::Vec3Array> places = new osg::Vec3Array;
    osg::ref_ptr<osg::Vec3Array> normals = new osg::Vec3Array;
    osg::ref_ptr<osg::Vec4Array> colors = new osg::Vec4Array;
    for (int j = 0; j <= quads; ++j)
    {
        for (int i = 0; i <= quads; ++i)
        {
            const double x = (column * quads + i) * step - REACH;
            const double y = (row * quads + j) * step - REACH;
            const double height = heightAt(x, y);
            places->push_back(osg::Vec3(osg::Vec3d(x, y, height)));
            osg::Vec3d normal(heightAt(x - 1.0, y) - heightAt(x + 1.0, y),
                              heightAt(x, y - 1.0) - heightAt(x, y + 1.0), 2.0);
            normal.normalize();
            normals->push_back(osg::Vec3(normal));
            const double green = 0.55 + 0.25 * std::sin(height / 120.0);
            colors->push_back(osg::Vec4(osg::Vec4d(0.45 + height / 2500.0, green, 0.35, 1.0)));
        }
    }
    osg::ref_ptr<osg::DrawElementsUInt> triangles = new osg::DrawElementsUInt(GL_TRIANGLES);
    for (int j = 0; j < quads; ++j)
    {
        for (int i = 0; i < quads; ++i)
        {
            const auto a = static_cast<unsigned int>(j * (quads + 1) + i);
            const auto above = a + static_cast<unsigned int>(quads + 1);
            for (const unsigned int index : {a, a + 1, above + 1, a, above + 1, above})
                triangles->push_back(index);
        }
    }
    osg::ref_ptr<osg::Geometry> patch = new osg::Geometry;
    patch->setUseDisplayList(false);
    patch->setUseVertexBufferObjects(true);
    patch->setVertexArray(places);
    patch->setNormalArray(normals, osg::Array::BIND_PER_VERTEX);
    patch->setColorArray(colors, osg::Array::BIND_PER_VERTEX);
    patch->addPrimitiveSet(triangles);
    return patch;
}

/// Close-ups in rows over the ground, each of a hundredth of it.
void addCloseUps(CloseUps& closeUps, int count,
                 const std::function<void(osgGeoFX::RegionOfInterest&, double, double)>& place, double side)
{
    const double diameter = 2.0 * side * std::sqrt(0.01 / osg::PI);
    const int columns = count > 4 ? 4 : 2;
    const osg::Vec3 colors[] = {osg::Vec3(1.0f, 0.55f, 0.1f), osg::Vec3(0.2f, 0.6f, 1.0f),
                                osg::Vec3(0.4f, 0.85f, 0.3f), osg::Vec3(0.9f, 0.3f, 0.6f)};
    for (int i = 0; i < count; ++i)
    {
        osg::ref_ptr<CloseUp> closeUp = new CloseUp;
        const int rows = (count + columns - 1) / columns;
        const int column = i % columns;
        const int row = i / columns;
        place(*closeUp->getRegion(), (column + 0.5) / columns - 0.5, (row + 0.5) / rows - 0.5);
        closeUp->getRegion()->setSize(diameter, diameter);
        closeUp->setOffset(osg::Vec3d(0.0, 0.0, 0.12 * side));
        closeUp->setScale(1.5, 1.5, 1.5);
        closeUp->setColor(colors[i % 4]);
        closeUps.addCloseUp(closeUp);
    }
}

class Bench
{
public:
    explicit Bench(const Settings& settings)
        : _settings(settings), _rounds(settings.smoke   ? 1
                                       : settings.quick ? 5
                                                        : 15),
          _size(settings.smoke ? OffscreenView::Size{160, 90} : PAPER_SIZE)
    {
    }

    std::vector<Figure> grid()
    {
        announce("drawing the paper's Table I: a regular grid with close-ups");
        const int quads = _settings.smoke ? PATCH_QUADS * 2 : GRID_QUADS;
        osg::ref_ptr<osg::Group> ground = new osg::Group;
        for (int row = 0; row < quads / PATCH_QUADS; ++row)
        {
            for (int column = 0; column < quads / PATCH_QUADS; ++column)
                ground->addChild(makePatch(column, row, PATCH_QUADS, quads));
        }
        _scene = new EffectScene;
        _scene->addChild(ground);
        _view = std::make_unique<OffscreenView>(_size, FIELD_OF_VIEW, _scene);
        _view->camera().setViewMatrixAsLookAt(osg::Vec3d(0.0, -22000.0, 15000.0),
                                              osg::Vec3d(0.0, -800.0, 0.0), osg::Vec3d(0.0, 0.0, 1.0));
        const auto place = [](osgGeoFX::RegionOfInterest& region, double x, double y)
        {
            region.setCenter(osg::Vec2d(2.0 * REACH * x, 2.0 * REACH * y));
        };
        return measure("grid", place, 2.0 * REACH);
    }

    std::vector<Figure> paged(const std::filesystem::path& terrain)
    {
        announce("drawing the paged terrain with close-ups");
        std::string error;
        const std::optional<osgGeoFX::Scene> scene = osgGeoFX::Scene::load(terrain.string(), error);
        if (!scene) throw BenchError(error);
        if (!scene->terrain || !scene->reference)
            throw BenchError(terrain.string() + ": it is no terrain database; name one with --terrain FILE.");
        _scene = scene->effects;
        _view = std::make_unique<OffscreenView>(_size, FIELD_OF_VIEW, scene->node);
        _view->camera().setLODScale(scene->lodScale(_size.height, FIELD_OF_VIEW));
        const osgGeoFX::ViewPoint from{osg::DegreesToRadians(-157.97), osg::DegreesToRadians(20.95), 42000.0,
                                       osg::DegreesToRadians(0.0),     osg::DegreesToRadians(-38.0), 0.0};
        osg::Matrixd view;
        if (!from.viewMatrix(*scene->reference, view))
            throw BenchError("The terrain database has no place for the view; take one that covers Oahu.");
        _view->look(view);
        const bool globe = scene->reference->isGeocentric();
        const osgGeoFX::Georeference* reference = scene->reference;
        const auto place = [globe, reference](osgGeoFX::RegionOfInterest& region, double x, double y)
        {
            const double longitude = osg::DegreesToRadians(-157.97 + 0.5 * x);
            const double latitude = osg::DegreesToRadians(21.45 + 0.35 * y);
            osg::Vec3d world;
            if (globe)
                region.setGeodeticCenter(longitude, latitude);
            else if (reference->toWorld(longitude, latitude, 0.0, world))
                region.setCenter(osg::Vec2d(world.x(), world.y()));
        };
        return measure("paged", place, 50000.0);
    }

private:
    std::vector<Figure> measure(const std::string& name,
                                const std::function<void(osgGeoFX::RegionOfInterest&, double, double)>& place,
                                double side)
    {
        std::vector<Figure> figures;
        for (const int count : counts)
        {
            osg::ref_ptr<CloseUps> closeUps = new CloseUps;
            addCloseUps(*closeUps, count, place, side);
            _scene->addEffect(closeUps);
            const std::vector<double> times = takeTurns(*closeUps);
            picture(name + "-" + std::to_string(count));
            Figure figure{name + "-" + std::to_string(count),
                          "frames a second with " + std::to_string(count) + " close-ups over those without",
                          ""};
            if (count == 4 || count == 16)
            {
                figure.bound = Bound::AtLeast;
                figure.asked = count == 4 ? 0.7 : 0.5;
            }
            figure.measured = times[0] / times[1];
            char remark[300];
            std::snprintf(
                remark, sizeof remark,
                "%.2f frames/s without, %.2f with, %.2f in a single pass, %.2f in several (%d triangle "
                "meshes for the layers)",
                1000.0 / times[0], 1000.0 / times[1], 1000.0 / times[2], 1000.0 / times[3],
                closeUps->statistics().drawables);
            figure.remark = remark;
            if (count <= 4)
            {
                std::snprintf(remark, sizeof remark, "; the paper: %.1f without, %.1f with, %.2f", table1[0],
                              table1[count], table1[count] / table1[0]);
                figure.remark += remark;
            }
            figures.push_back(figure);
            _scene->removeEffect(closeUps);
        }
        return figures;
    }

    /// Medians of frames that take turns, milliseconds: without, automatic, single pass, multi-pass.
    std::vector<double> takeTurns(CloseUps& closeUps)
    {
        const auto set = [&](int which)
        {
            closeUps.setEnabled(which > 0);
            if (which > 0)
                closeUps.setPipeline(which == 1   ? CloseUps::AUTOMATIC
                                     : which == 2 ? CloseUps::SINGLE_PASS
                                                  : CloseUps::MULTI_PASS);
        };
        std::vector<double> times[4];
        for (int which = 3; which >= 0; --which)
        {
            set(which);
            _view->settle();
        }
        for (int round = 0; round < _rounds; ++round)
        {
            for (int which = 0; which < 4; ++which)
            {
                set(which);
                times[which].push_back(1000.0 * _view->frame());
            }
        }
        set(1);
        std::vector<double> medians;
        for (const std::vector<double>& each : times)
            medians.push_back(median(each));
        return medians;
    }

    void picture(const std::string& name)
    {
        if (_settings.pictures.empty()) return;
        const std::filesystem::path file = _settings.pictures / (name + ".png");
        if (!osgDB::writeImageFile(*_view->capture(), file.string()))
            throw BenchError(file.string() + ": the picture cannot be written; name another folder.");
    }

    const Settings& _settings;
    const int _rounds;
    const OffscreenView::Size _size;
    osg::ref_ptr<EffectScene> _scene;
    std::unique_ptr<OffscreenView> _view;
};

std::vector<Figure> run(const Settings& settings)
{
    Bench bench(settings);
    std::vector<Figure> figures;
    if (settings.wants("grid")) figures = bench.grid();
    if (settings.wants("paged"))
    {
        const WorkFolder folder(settings.work);
        const std::vector<Figure> more = bench.paged(terrainToDraw(settings, folder));
        figures.insert(figures.end(), more.begin(), more.end());
    }
    return figures;
}

} // namespace

Suite closeUpSuite()
{
    return {"closeup",
            "Draws close-ups: the paper's Table I on a regular grid (grid), and the same on a paged terrain "
            "(paged)",
            {"grid", "paged"},
            run};
}

} // namespace geofx::bench
