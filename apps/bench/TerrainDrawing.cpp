// SPDX-License-Identifier: MIT
// SPDX-FileCopyrightText: 2026 the osgGeoFX authors
#include "BenchError.h"
#include "OahuTerrain.h"
#include "OffscreenView.h"
#include "Outline.h"
#include "SingleMesh.h"
#include "TerrainSuite.h"

#include <osgGeoFX/viewer/Scene.h>

#include <osg/Math>
#include <osg/Program>
#include <osg/Switch>
#include <osgDB/WriteFile>

#include <cstdio>

namespace geofx::bench
{

namespace
{

constexpr OffscreenView::Size SIZE = {1089, 690};
const double FIELD_OF_VIEW = osg::DegreesToRadians(30.0);
enum Which
{
    PAGED,
    SINGLE
};

/// What is drawn for how long.
struct Effort
{
    int rounds;
    double seconds; ///< of each scene in each round, at least one frame
};

struct NamedView
{
    const char* name;
    const char* what;
    osgGeoFX::ViewPoint place;
    double frames; ///< a second, over those of the single mesh, at least
};

osgGeoFX::ViewPoint place(double longitude, double latitude, double height, double heading, double pitch)
{
    return {osg::DegreesToRadians(longitude), osg::DegreesToRadians(latitude), height,
            osg::DegreesToRadians(heading),   osg::DegreesToRadians(pitch),    0.0};
}

std::vector<NamedView> views()
{
    return {
        {"whole", "the whole terrain, obliquely from the south", place(-157.753, 20.79, 46000.0, 0.0, -35.0),
         20.0},
        {"mid", "Honolulu and the Koolau from 4 km above the sea", place(-157.90, 21.16, 4000.0, 15.0, -9.0),
         10.0},
        {"low", "over Honolulu towards the Koolau ridge", place(-157.875, 21.275, 350.0, 45.0, -3.0), 8.0}};
}

/// The database and the single mesh beside each other; one of them is on.
class Comparison
{
public:
    Comparison(const std::filesystem::path& terrain, const Settings& settings)
        : _pictures(settings.pictures), _effort(settings.smoke ? Effort{1, 0.0} : Effort{7, 0.5})
    {
        std::string error;
        const std::optional<osgGeoFX::Scene> scene = osgGeoFX::Scene::load(terrain.string(), error);
        if (!scene) throw BenchError(error);
        if (!scene->terrain || !scene->reference)
            throw BenchError(terrain.string() + ": it is no terrain database; name one with --terrain FILE.");
        _reference = scene->reference;
        _switch->addChild(scene->node);
        announce("putting the single mesh together");
        _switch->addChild(readAsSingleMesh(terrain));
        _view = std::make_unique<OffscreenView>(SIZE, FIELD_OF_VIEW, _switch);
        _view->camera().setLODScale(
            osgGeoFX::lodScaleFor(*scene->terrain, osgGeoFX::pixelsPerRadian(SIZE.height, FIELD_OF_VIEW)));
    }

    /// The figures speed and outline of a view.
    std::vector<Figure> measure(const NamedView& view)
    {
        announce(std::string("drawing the view ") + view.name);
        osg::Matrixd matrix;
        if (!view.place.viewMatrix(*_reference, matrix))
            throw BenchError("The terrain database has no place for the views; take one that covers Oahu.");
        _view->look(matrix);
        return {speed(view), outline(view)};
    }

private:
    void show(Which which)
    {
        _switch->setSingleChildOn(static_cast<unsigned int>(which));
        _view->settle();
    }

    Figure speed(const NamedView& view)
    {
        OffscreenView::Drawn drawn[2];
        std::vector<double> seconds[2];
        for (int round = 0; round < _effort.rounds; ++round)
        {
            for (const Which which : {PAGED, SINGLE})
            {
                show(which); // also the untimed frame that brings buffers and caches back
                double total = 0.0;
                do
                {
                    seconds[which].push_back(_view->frame());
                    total += seconds[which].back();
                } while (total < _effort.seconds);
            }
        }
        for (const Which which : {PAGED, SINGLE})
        {
            show(which);
            drawn[which] = _view->count();
            save(*_view->capture(), view, which == PAGED ? "paged" : "single");
        }

        Figure figure{std::string("speed-") + view.name,
                      std::string("frames a second of the paged database over those of the single mesh: ") +
                          view.what,
                      "", Bound::AtLeast, view.frames};
        const double paged = median(seconds[PAGED]), single = median(seconds[SINGLE]);
        figure.measured = single / paged;
        char remark[200];
        std::snprintf(
            remark, sizeof remark,
            "paged %.1f frames/s, %.0f thousand triangles in %d drawables; single mesh %.2f frames/s, %.0f "
            "thousand triangles",
            1.0 / paged, static_cast<double>(drawn[PAGED].triangles) * 1e-3,
            static_cast<int>(drawn[PAGED].drawables), 1.0 / single,
            static_cast<double>(drawn[SINGLE].triangles) * 1e-3);
        figure.remark = remark;
        figure.details = {
            {"pagedMilliseconds", 1000.0 * paged},       {"pagedFrames", seconds[PAGED].size()},
            {"pagedTriangles", drawn[PAGED].triangles},  {"pagedDrawables", drawn[PAGED].drawables},
            {"singleMilliseconds", 1000.0 * single},     {"singleFrames", seconds[SINGLE].size()},
            {"singleTriangles", drawn[SINGLE].triangles}};
        return figure;
    }

    Figure outline(const NamedView& view)
    {
        // White on black, whatever the terrain's colors are.
        osg::StateSet& state = *_switch->getOrCreateStateSet();
        const auto off = osg::StateAttribute::OFF | osg::StateAttribute::OVERRIDE;
        state.setMode(GL_LIGHTING, off);
        state.setTextureMode(0, GL_TEXTURE_2D, off);
        // The database's own program cannot see modes; an empty one gives the fixed functions back.
        state.setAttribute(new osg::Program, osg::StateAttribute::ON | osg::StateAttribute::OVERRIDE);
        const osg::Vec4 clearColor = _view->camera().getClearColor();
        _view->camera().setClearColor(osg::Vec4(0.0f, 0.0f, 0.0f, 1.0f));
        osg::ref_ptr<osg::Image> masks[2];
        for (const Which which : {PAGED, SINGLE})
        {
            show(which);
            masks[which] = _view->capture();
        }
        _switch->setStateSet(nullptr);
        _view->camera().setClearColor(clearColor);

        const OutlineDifference difference = compareOutlines(*masks[PAGED], *masks[SINGLE]);
        save(*drawOutlines(*masks[PAGED], *masks[SINGLE]), view, "outlines");
        Figure figure{std::string("outline-") + view.name,
                      "largest distance between both outlines in that view", "pixels", Bound::AtMost, 1.0};
        figure.measured = difference.distance;
        figure.remark =
            std::to_string(difference.pixels) + " pixels are covered in one of both pictures alone";
        figure.details = {{"pixels", difference.pixels}};
        return figure;
    }

    void save(const osg::Image& image, const NamedView& view, const std::string& kind) const
    {
        if (_pictures.empty()) return;
        const std::filesystem::path file = _pictures / (std::string(view.name) + "-" + kind + ".png");
        if (!osgDB::writeImageFile(image, file.string()))
            throw BenchError(file.string() +
                             ": the picture cannot be written; name another folder with --pictures.");
    }

    const std::filesystem::path _pictures;
    const Effort _effort;
    osg::ref_ptr<osg::Switch> _switch = new osg::Switch;
    osg::ref_ptr<osgGeoFX::Georeference> _reference;
    std::unique_ptr<OffscreenView> _view;
};

} // namespace

std::vector<Figure> measureDrawing(const Settings& settings, const std::filesystem::path& folder)
{
    if (!settings.wants("drawing")) return {};
    const std::filesystem::path terrain =
        windowToDraw(settings, folder, osgGeoFX::pixelsPerRadian(SIZE.height, FIELD_OF_VIEW));
    Comparison comparison(terrain, settings);
    std::vector<Figure> figures;
    for (const NamedView& view : views())
    {
        for (const Figure& figure : comparison.measure(view))
            figures.push_back(figure);
    }
    return figures;
}

} // namespace geofx::bench
