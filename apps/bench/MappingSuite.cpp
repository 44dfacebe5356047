// SPDX-License-Identifier: MIT
// SPDX-FileCopyrightText: 2026 the osgGeoFX authors
#include "MappingSuite.h"

#include "BenchError.h"
#include "LiveLayers.h"
#include "OffscreenView.h"
#include "PatternLayers.h"

#include <osgGeoFX/mapping/LayerProbe.h>
#include <osgGeoFX/mapping/ProjectiveMappings.h>
#include <osgGeoFX/scene/EffectScene.h>

#include <osg/Geometry>
#include <osg/Math>
#include <osgDB/WriteFile>

#include <algorithm>
#include <chrono>
#include <cmath>
#include <cstdio>
#include <functional>
#include <random>

namespace geofx::bench
{

namespace
{

using osgGeoFX::ColorTable;
using osgGeoFX::ColorTransfer;
using osgGeoFX::DataLayer;
using osgGeoFX::EffectScene;
using osgGeoFX::ProjectiveMapping;
using osgGeoFX::ProjectiveMappings;
using Clock = std::chrono::steady_clock;

constexpr OffscreenView::Size PAPER_SIZE = {1600, 1200};
const double FIELD_OF_VIEW = osg::DegreesToRadians(45.0);
/// Half the side of the ground, metres.
constexpr double REACH = 5000.0;

/// A row of the paper's Table 1: what it drew, and its frames a second without and with mappings.
struct Row
{
    const char* figure;
    const char* what;
    int vertices;
    int mappings;
    double without;
    double with;
};

constexpr Row table1[] = {{"1", "values on a city", 1040503, 3, 10.41, 9.87},
                          {"3A", "noise on a city", 41032, 4, 52.88, 51.20},
                          {"3B", "a route and its context", 61756, 27, 156.10, 27.94},
                          {"3C", "textures by masks", 6, 4, 1063.83, 236.97},
                          {"3E", "symbols", 37404, 16, 206.21, 45.70},
                          {"3F", "ranges that overlap", 6, 6, 1075.27, 110.54}};

/// A hilly ground with as many vertices as wanted, about.
osg::ref_ptr<osg::Geometry> makeGround(int vertices)
{
    const int side = std::max(2, static_cast<int>(std::lround(std::sqrt(static_cast<double>(vertices)))));
    const auto height = [](double x, double y)
    {
        return 150.0 * std::sin(x / 900.0) * std::cos(y / 1100.0) + 40.0 * std::sin((x - 2.0 * y) / 300.0);
    };
    osg::ref_ptr<osg::Vec3Array> places = new osg::Vec3Array;
    osg::ref_ptr<osg::Vec3Array> normals = new osg::Vec3Array;
    osg::ref_ptr<osg::Vec4Array> colors = new osg::Vec4Array;
    for (int j = 0; j < side; ++j)
    {
        for (int i = 0; i < side; ++i)
        {
            const double x = REACH * (2.0 * i / (side - 1) - 1.0);
            const double y = REACH * (2.0 * j / (side - 1) - 1.0);
            const bool flat = side < 10;
            places->push_back(osg::Vec3(osg::Vec3d(x, y, flat ? 0.0 : height(x, y))));
            osg::Vec3d normal(flat ? 0.0 : height(x - 1.0, y) - height(x + 1.0, y),
                              flat ? 0.0 : height(x, y - 1.0) - height(x, y + 1.0), 2.0);
            normal.normalize();
            normals->push_back(osg::Vec3(normal));
            colors->push_back(osg::Vec4(
                osg::Vec4d(0.5 + 0.2 * std::sin(x / 400.0), 0.6 + 0.2 * std::cos(y / 500.0), 0.45, 1.0)));
        }
    }
    osg::ref_ptr<osg::DrawElementsUInt> triangles = new osg::DrawElementsUInt(GL_TRIANGLES);
    for (int j = 0; j + 1 < side; ++j)
    {
        for (int i = 0; i + 1 < side; ++i)
        {
            const auto a = static_cast<unsigned int>(j * side + i);
            const auto above = a + static_cast<unsigned int>(side);
            for (const unsigned int index : {a, a + 1, above + 1, a, above + 1, above})
                triangles->push_back(index);
        }
    }
    osg::ref_ptr<osg::Geometry> ground = new osg::Geometry;
    ground->setUseVertexBufferObjects(true);
    ground->setVertexArray(places);
    ground->setNormalArray(normals, osg::Array::BIND_PER_VERTEX);
    ground->setColorArray(colors, osg::Array::BIND_PER_VERTEX);
    ground->addPrimitiveSet(triangles);
    return ground;
}

/// A soft disc in one color, or a picture with rings.
osg::ref_ptr<DataLayer> makePicture(int side, bool rings)
{
    osg::ref_ptr<osg::Image> image = new osg::Image;
    image->allocateImage(side, side, 1, GL_RGBA, GL_UNSIGNED_BYTE);
    for (int y = 0; y < side; ++y)
    {
        for (int x = 0; x < side; ++x)
        {
            const double r = 2.0 * std::hypot(x + 0.5 - side / 2.0, y + 0.5 - side / 2.0) / side;
            const double shade = rings ? 0.5 + 0.5 * std::cos(25.0 * r) : 1.0;
            unsigned char* texel = image->data(x, y);
            texel[0] = static_cast<unsigned char>(230.0 * shade);
            texel[1] = static_cast<unsigned char>(120.0 * shade);
            texel[2] = static_cast<unsigned char>(40.0 + 100.0 * shade);
            texel[3] = static_cast<unsigned char>(255.0 * std::clamp(10.0 * (1.0 - r), 0.0, 1.0));
        }
    }
    return new DataLayer(image);
}

osg::ref_ptr<DataLayer> makeValues(int side)
{
    osg::ref_ptr<osg::Image> image = new osg::Image;
    image->allocateImage(side, side, 1, GL_LUMINANCE, GL_FLOAT);
    for (int y = 0; y < side; ++y)
    {
        for (int x = 0; x < side; ++x)
        {
            const double value = 50.0 + 30.0 * std::sin(9.0 * x / side) + 20.0 * std::cos(13.0 * y / side);
            *reinterpret_cast<float*>(image->data(x, y)) = static_cast<float>(value);
        }
    }
    osg::ref_ptr<DataLayer> layer = new DataLayer(image);
    layer->setKind(DataLayer::VALUE);
    return layer;
}

osg::ref_ptr<ProjectiveMapping> makeMapping(DataLayer* layer, const osg::Vec2d& center, double halfWidth,
                                            double halfHeight, double heading = 0.0)
{
    osg::ref_ptr<ProjectiveMapping> mapping = new ProjectiveMapping;
    mapping->setLayer(layer);
    mapping->setRectangle(center, halfWidth, halfHeight, heading);
    return mapping;
}

/// As 3.B: the context darkened and without color, and a route over it.
void addRoute(ProjectiveMappings& mappings, int count)
{
    osg::ref_ptr<ProjectiveMapping> context = makeMapping(nullptr, {0.0, 0.0}, REACH, REACH);
    context->getTransfer()->setSource(ColorTransfer::SCENE);
    context->getTransfer()->setSaturation(0.2);
    context->getTransfer()->setBrightness(0.6);
    context->setOrder(-1);
    mappings.addMapping(context);
    const osg::ref_ptr<DataLayer> disc = makePicture(128, false);
    osg::Vec2d former;
    const int points = count / 2;
    for (int i = 0; i < points; ++i)
    {
        const double t = 2.0 * i / (points - 1) - 1.0;
        const osg::Vec2d place(0.8 * REACH * t, 0.5 * REACH * std::sin(3.0 * t));
        mappings.addMapping(makeMapping(disc, place, 150.0, 150.0));
        if (i > 0)
        {
            const osg::Vec2d along = place - former;
            mappings.addMapping(makeMapping(disc, (place + former) / 2.0, 60.0, along.length() / 2.0,
                                            std::atan2(along.x(), along.y())));
        }
        former = place;
    }
}

void addValues(ProjectiveMappings& mappings, int count, double size)
{
    std::mt19937 engine(3);
    std::uniform_real_distribution<double> where(-0.6 * REACH, 0.6 * REACH);
    const osg::ref_ptr<ColorTable> table = ColorTable::named("viridis", 0.0, 100.0);
    for (int i = 0; i < count; ++i)
    {
        const osg::ref_ptr<ProjectiveMapping> mapping =
            makeMapping(makeValues(256), {where(engine), where(engine)}, size, size, 0.4 * i);
        mapping->setTable(table);
        mapping->getTransfer()->setSource(ColorTransfer::TABLE);
        mapping->getTransfer()->setValueRange(0.0, 100.0);
        mapping->setOpacity(0.7);
        mappings.addMapping(mapping);
    }
}

void addSymbols(ProjectiveMappings& mappings, int count, double size)
{
    std::mt19937 engine(5);
    std::uniform_real_distribution<double> where(-0.9 * REACH, 0.9 * REACH);
    const osg::ref_ptr<DataLayer> picture = makePicture(128, true);
    for (int i = 0; i < count; ++i)
        mappings.addMapping(makeMapping(picture, {where(engine), where(engine)}, size, size, 0.1 * i));
}

void addMasked(ProjectiveMappings& mappings, int count)
{
    for (int i = 0; i < count; ++i)
    {
        const osg::ref_ptr<ProjectiveMapping> mapping =
            makeMapping(makePicture(512, true), {0.0, 0.0}, REACH, REACH);
        mapping->setMask(makePicture(256, i % 2 == 0));
        mapping->getTransfer()->setAlpha(ColorTransfer::FROM_MASK);
        mappings.addMapping(mapping);
    }
}

osg::ref_ptr<ProjectiveMappings> mappingsOf(const Row& row)
{
    osg::ref_ptr<ProjectiveMappings> mappings = new ProjectiveMappings;
    const std::string figure = row.figure;
    if (figure == "3B") addRoute(*mappings, row.mappings);
    if (figure == "3C") addMasked(*mappings, row.mappings);
    if (figure == "3E") addSymbols(*mappings, row.mappings, 250.0);
    if (figure == "1" || figure == "3A") addValues(*mappings, row.mappings, 0.5 * REACH);
    if (figure == "3F") addValues(*mappings, row.mappings, 0.6 * REACH);
    return mappings;
}

/// n mappings that cover the same share of the ground, three deep on average, whatever n is.
osg::ref_ptr<ProjectiveMappings> manyMappings(int count)
{
    osg::ref_ptr<ProjectiveMappings> mappings = new ProjectiveMappings;
    addSymbols(*mappings, count, REACH * std::sqrt(3.0 / count));
    return mappings;
}

class Bench
{
public:
    explicit Bench(const Settings& settings)
        : _pictures(settings.pictures), _smoke(settings.smoke), _rounds(settings.smoke   ? 1
                                                                        : settings.quick ? 5
                                                                                         : 11),
          _size(settings.smoke ? OffscreenView::Size{160, 120} : PAPER_SIZE)
    {
        _view = std::make_unique<OffscreenView>(_size, FIELD_OF_VIEW, _scene);
        _view->camera().setViewMatrixAsLookAt(osg::Vec3d(0.0, -7000.0, 5500.0), osg::Vec3d(0.0, -700.0, 0.0),
                                              osg::Vec3d(0.0, 0.0, 1.0));
    }

    std::vector<Figure> table()
    {
        std::vector<Figure> figures;
        for (const Row& row : table1)
        {
            announce(std::string("drawing the paper's Figure ") + row.figure + ", " + row.what);
            const osg::ref_ptr<ProjectiveMappings> mappings = mappingsOf(row);
            show(_smoke ? std::min(row.vertices, 1000) : row.vertices, *mappings);
            const bool route = std::string(row.figure) == "3B";
            const std::vector<double> times = takeTurns({[&] { mappings->setEnabled(false); },
                                                         [&]
                                                         {
                                                             mappings->setEnabled(true);
                                                         }},
                                                        _rounds);
            picture(std::string("table1-") + row.figure);
            Figure figure{std::string("table1-") + row.figure,
                          std::string("frames a second with mappings over those without, as Figure ") +
                              row.figure + " of the paper: " + row.what,
                          ""};
            if (route)
            {
                figure.bound = Bound::AtLeast;
                figure.asked = 0.6;
            }
            figure.measured = times[0] / times[1];
            char remark[250];
            std::snprintf(
                remark, sizeof remark,
                "%d mappings on %d vertices: %.1f frames/s with, %.1f without; the paper: %.1f with, %.1f "
                "without, %.2f",
                row.mappings, row.vertices, 1000.0 / times[1], 1000.0 / times[0], row.with, row.without,
                row.with / row.without);
            figure.remark = remark;
            figures.push_back(figure);
            if (route) figures.push_back(againstList(*mappings, times[0]));
            figures.push_back(cached(row, route));
        }
        return figures;
    }

    std::vector<Figure> many()
    {
        announce("drawing 100 and 10,000 mappings");
        const osg::ref_ptr<ProjectiveMappings> few = manyMappings(100);
        const osg::ref_ptr<ProjectiveMappings> many = manyMappings(_smoke ? 1000 : 10000);
        show(61756, *few);
        _scene->addEffect(many);
        const std::vector<double> times = takeTurns({[&]
                                                     {
                                                         few->setEnabled(true);
                                                         many->setEnabled(false);
                                                     },
                                                     [&]
                                                     {
                                                         few->setEnabled(false);
                                                         many->setEnabled(true);
                                                     }},
                                                    _rounds);
        picture("many");
        Figure figure{
            "many", "frames a second with 10,000 mappings over those with 100, the same cover of the screen",
            "", Bound::AtLeast, 0.7};
        figure.measured = times[0] / times[1];
        figure.remark = milliseconds("100: ", times[0]) + milliseconds(", 10,000: ", times[1]);
        std::vector<Figure> figures = {figure};
        for (const Figure& each : edits(*many))
            figures.push_back(each);
        few->setEnabled(false);
        many->setEnabled(true);
        figures.push_back(probe(times[1]));
        return figures;
    }

    /// The same with pages: at rest, while one mapping moves, and on a flight.
    std::vector<Figure> manyCached()
    {
        announce("drawing 100 and 10,000 mappings by pages");
        const osg::ref_ptr<ProjectiveMappings> few = manyMappings(100);
        const osg::ref_ptr<ProjectiveMappings> many = manyMappings(_smoke ? 1000 : 10000);
        few->setCaching(ProjectiveMappings::AUTOMATIC);
        many->setCaching(ProjectiveMappings::AUTOMATIC);
        // Units of their own: a set whose units change when the other one is switched off makes its pages anew.
        few->setUnits(8, 9, 10);
        few->setCacheUnits(11, 12);
        many->setUnits(13, 14, 15);
        many->setCacheUnits(16, 17);
        show(61756, *few);
        _scene->addEffect(many);
        const auto show100 = [&]
        {
            few->setEnabled(true);
            many->setEnabled(false);
        };
        const auto showMany = [&]
        {
            few->setEnabled(false);
            many->setEnabled(true);
        };
        show100();
        settle(*few);
        showMany();
        settle(*many);
        const std::vector<double> times = takeTurns({show100, showMany}, _rounds);
        picture("many-cached");
        Figure figure{"cached-many", "the same by pages", "", Bound::AtLeast, 0.95};
        figure.measured = times[0] / times[1];
        figure.remark = milliseconds("100: ", times[0]) + milliseconds(", 10,000: ", times[1]);
        return {figure, movingOne(*many), flight(*many)};
    }

    /// What changes in time, and what is larger than memory.
    std::vector<Figure> live(const Settings& settings)
    {
        const osg::ref_ptr<ProjectiveMappings> none = new ProjectiveMappings;
        show(61756, *none);
        _scene->removeEffect(none);
        return liveLayers(*_view, *_scene, settings);
    }
    std::vector<Figure> patterns(const Settings& settings)
    {
        const osg::ref_ptr<ProjectiveMappings> none = new ProjectiveMappings;
        show(61756, *none);
        _scene->removeEffect(none);
        return patternLayers(*_view, *_scene, settings);
    }
    std::vector<Figure> paged(const Settings& settings)
    {
        const osg::ref_ptr<ProjectiveMappings> none = new ProjectiveMappings;
        show(61756, *none);
        _scene->removeEffect(none);
        return pagedRaster(*_view, *_scene, settings);
    }

    std::vector<Figure> huge()
    {
        announce("setting up 100,000 mappings");
        const osg::ref_ptr<ProjectiveMappings> mappings = manyMappings(_smoke ? 2000 : 100000);
        const auto start = Clock::now();
        show(61756, *mappings);
        _view->frame();
        const double setUp = std::chrono::duration<double>(Clock::now() - start).count();
        std::vector<double> times;
        for (int i = 0; i < _rounds; ++i)
            times.push_back(1000.0 * _view->frame());
        picture("huge");
        const ProjectiveMappings::Capacity capacity = mappings->capacity();
        const Figure pages = hugeCached();
        Figure time{"huge-time", "time from 100,000 mappings to their first frame", "seconds"};
        time.measured = setUp;
        time.remark = milliseconds("a frame then takes ", median(times));
        Figure memory{"huge-memory", "memory of 100,000 mappings and their grid on the GPU", "MiB"};
        memory.measured = capacity.texelsUsed / 65536.0;
        memory.remark = std::to_string(capacity.mappingsLeftOut) + " mappings left out";
        return {time, memory, pages};
    }

private:
    /// Draws until all pages are there.
    void settle(ProjectiveMappings& mappings)
    {
        for (int i = 0; i < 2000; ++i)
        {
            _view->frame();
            const ProjectiveMappings::CacheStatistics now = mappings.cacheStatistics();
            if (now.settled && now.reason.empty()) return;
            if (i > 2 && now.reason != "pages are being drawn" && !now.reason.empty())
                throw BenchError("The pages of mappings are not used, since " + now.reason + ".");
        }
        throw BenchError("The pages of mappings are never all drawn.");
    }

    /// A row of Table 1 with pages, over the same without mappings.
    Figure cached(const Row& row, bool route)
    {
        const osg::ref_ptr<ProjectiveMappings> mappings = mappingsOf(row);
        mappings->setCaching(ProjectiveMappings::AUTOMATIC);
        show(_smoke ? std::min(row.vertices, 1000) : row.vertices, *mappings);
        settle(*mappings);
        const std::vector<double> times = takeTurns({[&] { mappings->setEnabled(false); },
                                                     [&]
                                                     {
                                                         mappings->setEnabled(true);
                                                     }},
                                                    _rounds);
        picture(std::string("cached-") + row.figure);
        const std::string name = std::string("cached-") + row.figure;
        Figure figure{name, "the same by pages of composed mappings", "", Bound::AtLeast, route ? 0.9 : 0.8};
        figure.measured = times[0] / times[1];
        const ProjectiveMappings::CacheStatistics pages = mappings->cacheStatistics();
        figure.remark = milliseconds("with pages ", times[1]) +
                        milliseconds(", without mappings ", times[0]) +
                        ", pages: " + std::to_string(pages.pagesUsed);
        return figure;
    }

    Figure hugeCached()
    {
        const osg::ref_ptr<ProjectiveMappings> mappings = manyMappings(_smoke ? 2000 : 100000);
        mappings->setCaching(ProjectiveMappings::AUTOMATIC);
        show(61756, *mappings);
        settle(*mappings);
        const std::vector<double> times = takeTurns({[&] { mappings->setEnabled(false); },
                                                     [&]
                                                     {
                                                         mappings->setEnabled(true);
                                                     }},
                                                    _rounds);
        Figure figure{"cached-huge", "frames a second with 100,000 mappings by pages over those without", "",
                      Bound::AtLeast, 0.85};
        figure.measured = times[0] / times[1];
        figure.remark = milliseconds("with pages ", times[1]) + milliseconds(", without mappings ", times[0]);
        return figure;
    }

    /// One of many mappings goes on in each frame.
    Figure movingOne(ProjectiveMappings& mappings)
    {
        ProjectiveMapping* mapping = mappings.getMapping(mappings.getNumMappings() / 2);
        mapping->setCenter({0.0, -500.0});
        settle(mappings);
        bool moves = false;
        const std::uint64_t before = mappings.cacheStatistics().exactFrames;
        std::vector<double> resting, moving;
        for (int i = 0; i < 4 * _rounds; ++i)
        {
            // Each frame after a move would be drawn as it is after a rest; so both have their turns.
            moves = !moves;
            if (moves) mapping->setCenter(mapping->getCenter() + osg::Vec2d(3.0, 2.0));
            (moves ? moving : resting).push_back(1000.0 * _view->frame());
        }
        Figure figure{"cached-moving",
                      "frames a second while one of 10,000 mappings moves over those at rest, by pages", "",
                      Bound::AtLeast, 0.8};
        figure.measured = median(resting) / median(moving);
        figure.remark =
            milliseconds("resting ", median(resting)) + milliseconds(", moving ", median(moving)) +
            ", frames without pages: " + std::to_string(mappings.cacheStatistics().exactFrames - before);
        return figure;
    }

    /// A flight at 100 m/s, thirty frames a second, with mappings and without.
    Figure flight(ProjectiveMappings& mappings)
    {
        const osg::Matrixd view = _view->camera().getViewMatrix();
        const int count = _smoke ? 4 : 150;
        const auto look = [&](int i)
        {
            const osg::Vec3d eye(-300.0, -4500.0 + 100.0 / 30.0 * i, 1200.0);
            _view->camera().setViewMatrixAsLookAt(eye, eye + osg::Vec3d(100.0, 2500.0, -1100.0),
                                                  osg::Vec3d(0.0, 0.0, 1.0));
        };
        look(0);
        mappings.setEnabled(true);
        settle(mappings);
        const std::uint64_t before = mappings.cacheStatistics().exactFrames;
        std::vector<double> with, without;
        for (int i = 0; i < count; ++i)
        {
            look(i);
            mappings.setEnabled(true);
            with.push_back(1000.0 * _view->frame());
            mappings.setEnabled(false);
            without.push_back(1000.0 * _view->frame());
        }
        mappings.setEnabled(true);
        _view->camera().setViewMatrix(view);
        Figure figure{"cached-flight",
                      "frames a second on a flight over 10,000 mappings by pages over those without", "",
                      Bound::AtLeast, 0.7};
        figure.measured = median(without) / median(with);
        char worst[40];
        std::snprintf(worst, sizeof worst, "%.2f",
                      *std::max_element(with.begin(), with.end()) / median(with));
        figure.remark =
            milliseconds("with pages ", median(with)) + milliseconds(", without ", median(without)) +
            ", longest over median " + worst +
            ", frames without pages: " + std::to_string(mappings.cacheStatistics().exactFrames - before);
        return figure;
    }

    /// Reads all layers below pixels, as a pointer that moves does.
    Figure probe(double frame)
    {
        announce("reading 10,000 mappings below pixels");
        std::vector<double> times;
        std::size_t readings = 0;
        const int count = _smoke ? 3 : 60;
        for (int i = 0; i < count; ++i)
        {
            const double x = _size.width * (0.2 + 0.6 * i / count),
                         y = _size.height * (0.5 - 0.4 * i / count);
            const auto start = Clock::now();
            const auto found = osgGeoFX::LayerProbe::under(*_scene, _view->camera(), x, y);
            times.push_back(std::chrono::duration<double, std::milli>(Clock::now() - start).count());
            if (found) readings += found->readings.size();
        }
        Figure figure{"probe",
                      "time to read all layers below a pixel, of 10,000 mappings, over that of a frame", ""};
        figure.measured = median(times) / frame;
        figure.remark = milliseconds("", median(times)) + milliseconds(", a frame ", frame) + "; " +
                        std::to_string(readings) + " layers below " + std::to_string(count) + " pixels";
        return figure;
    }

    void show(int vertices, ProjectiveMappings& mappings)
    {
        while (_scene->getNumEffects() > 0)
            _scene->removeEffect(_scene->getEffect(0));
        _scene->removeChildren(0, _scene->getNumChildren());
        _scene->addChild(makeGround(vertices));
        _scene->addEffect(&mappings);
        mappings.setEnabled(true);
    }

    /// Medians of frames that take turns, milliseconds.
    std::vector<double> takeTurns(const std::vector<std::function<void()>>& settings, int rounds)
    {
        std::vector<std::vector<double>> times(settings.size());
        for (const auto& set : settings)
        {
            set();
            _view->frame();
        }
        for (int round = 0; round < rounds; ++round)
        {
            for (std::size_t i = 0; i < settings.size(); ++i)
            {
                settings[i]();
                times[i].push_back(1000.0 * _view->frame());
            }
        }
        std::vector<double> medians;
        for (std::vector<double>& each : times)
            medians.push_back(median(each));
        return medians;
    }

    /// The paper's loop over all mappings, in the same scene.
    Figure againstList(ProjectiveMappings& mappings, double without)
    {
        const std::vector<double> times = takeTurns({[&] { mappings.setWholeList(true); },
                                                     [&]
                                                     {
                                                         mappings.setWholeList(false);
                                                     }},
                                                    std::max(1, _rounds / 3));
        Figure figure{"grid", "time of the mappings in a frame, the paper's loop over all over the grid", "",
                      Bound::AtLeast, 10.0};
        figure.measured = (times[0] - without) / std::max(times[1] - without, 1e-3);
        figure.remark = milliseconds("loop ", times[0]) + milliseconds(", grid ", times[1]) +
                        milliseconds(", without mappings ", without);
        return figure;
    }

    /// Moves one mapping of many again and again.
    std::vector<Figure> edits(ProjectiveMappings& mappings)
    {
        announce("moving one of 10,000 mappings");
        std::mt19937 engine(7);
        std::uniform_real_distribution<double> step(-200.0, 200.0);
        std::uniform_int_distribution<unsigned int> which(0, mappings.getNumMappings() - 1);
        std::vector<double> times;
        std::vector<double> bytes;
        for (int i = 0; i < (_smoke ? 3 : 200); ++i)
        {
            ProjectiveMapping* mapping = mappings.getMapping(which(engine));
            const bool drawn = i % 50 == 0;
            if (drawn) _view->frame();
            const std::uint64_t before = mappings.capacity().uploadedBytes;
            const auto start = Clock::now();
            mapping->setCenter(mapping->getCenter() + osg::Vec2d(step(engine), step(engine)));
            mappings.update(nullptr);
            times.push_back(std::chrono::duration<double, std::milli>(Clock::now() - start).count());
            if (!drawn) continue;
            _view->frame();
            bytes.push_back(static_cast<double>(mappings.capacity().uploadedBytes - before));
        }
        Figure time{"move-time", "time to move one of 10,000 mappings", "milliseconds", Bound::AtMost, 0.5};
        time.measured = median(times);
        time.remark = milliseconds("the longest ", *std::max_element(times.begin(), times.end()));
        Figure upload{"move-upload", "bytes that are uploaded when one of 10,000 mappings moves", "bytes",
                      Bound::AtMost, 4096.0};
        upload.measured = *std::max_element(bytes.begin(), bytes.end());
        upload.remark = "the most of " + std::to_string(bytes.size()) + " moves";
        return {time, upload};
    }

    void picture(const std::string& name)
    {
        if (_pictures.empty()) return;
        const std::filesystem::path file = _pictures / (name + ".png");
        if (!osgDB::writeImageFile(*_view->capture(), file.string()))
            throw BenchError(file.string() + ": the picture cannot be written; name another folder.");
    }

    static std::string milliseconds(const std::string& what, double time)
    {
        char text[60];
        std::snprintf(text, sizeof text, "%.2f ms", time);
        return what + text;
    }

    const std::filesystem::path _pictures;
    const bool _smoke;
    const int _rounds;
    const OffscreenView::Size _size;
    osg::ref_ptr<EffectScene> _scene = new EffectScene;
    std::unique_ptr<OffscreenView> _view;
};

std::vector<Figure> run(const Settings& settings)
{
    Bench bench(settings);
    std::vector<Figure> figures;
    const auto add = [&](const std::vector<Figure>& more)
    {
        figures.insert(figures.end(), more.begin(), more.end());
    };
    if (settings.wants("table")) add(bench.table());
    if (settings.wants("many")) add(bench.many());
    if (settings.wants("pages")) add(bench.manyCached());
    if (settings.wants("huge")) add(bench.huge());
    if (settings.wants("patterns")) add(bench.patterns(settings));
    if (settings.wants("live")) add(bench.live(settings));
    if (settings.wants("paged")) add(bench.paged(settings));
    return figures;
}

} // namespace

Suite mappingSuite()
{
    return {"mapping",
            "Draws projective mappings: the paper's Table 1 and its loop against the grid (table), 10,000 "
            "against 100 "
            "and edits and the probe (many), the same by pages, one that moves and a flight (pages), 100,000 "
            "(huge), contour lines and other patterns (patterns), a "
            "layer that changes in each frame (live), a raster of "
            "60,000² pixels (paged)",
            {"table", "many", "pages", "huge", "patterns", "live", "paged"},
            run};
}

} // namespace geofx::bench
