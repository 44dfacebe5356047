// SPDX-License-Identifier: MIT
// SPDX-FileCopyrightText: 2026 the osgGeoFX authors
#include "FlightSuite.h"

#include "BenchError.h"
#include "ChildProcess.h"
#include "DistantServer.h"
#include "FlightPath.h"
#include "Interruption.h"
#include "Machine.h"
#include "TerrainSuite.h"
#include "WorkFolder.h"

#include <osgGeoFX/effect/Tessellation.h>
#include <osgGeoFX/offscreen/EglGraphicsContext.h>
#include <osgGeoFX/paging/MemoryBudget.h>
#include <osgGeoFX/paging/PagerMonitor.h>
#include <osgGeoFX/paging/RemoteFiles.h>
#include <osgGeoFX/scene/TilePrefetch.h>
#include <osgGeoFX/viewer/Scene.h>

#include <osgUtil/RenderStage>
#include <osgViewer/Renderer>
#include <osgViewer/Viewer>

#include <unistd.h>

#include <algorithm>
#include <chrono>
#include <cstdio>
#include <memory>
#include <numeric>
#include <set>
#include <thread>
#include <tuple>

namespace geofx::bench
{

namespace
{

using Clock = std::chrono::steady_clock;

constexpr int WIDTH = 320, HEIGHT = 240;
constexpr double FIELD_OF_VIEW = 45.0; ///< vertical, degrees
constexpr double RATE = 30.0;          ///< frames a second
constexpr double DELAY = 50.0;         ///< milliseconds
constexpr double MIB = 1024.0 * 1024.0;

double secondsSince(Clock::time_point start)
{
    return std::chrono::duration<double>(Clock::now() - start).count();
}

/// Level, x, y.
using Tile = std::tuple<int, int, int>;
using Tiles = std::set<Tile>;

/// Takes down which tiles a frame draws. The time that this takes is told apart.
class TilesDrawn : public osg::Camera::DrawCallback
{
public:
    using osg::Camera::DrawCallback::operator();
    void operator()(osg::RenderInfo& info) const override
    {
        const auto start = Clock::now();
        tiles.clear();
        auto* renderer = dynamic_cast<osgViewer::Renderer*>(info.getCurrentCamera()->getRenderer());
        // The single-threaded model uses the first of two.
        if (renderer) add(*renderer->getSceneView(0)->getRenderStage());
        seconds = secondsSince(start);
    }

    mutable Tiles tiles;
    mutable double seconds = 0.0;

private:
    void add(const osgUtil::RenderBin& bin) const
    {
        for (const osgUtil::StateGraph* graph : bin.getStateGraphList())
            for (const auto& leaf : graph->_leaves)
                add(*leaf);
        for (const osgUtil::RenderLeaf* leaf : bin.getRenderLeafList())
            add(*leaf);
        for (const auto& inner : bin.getRenderBinList())
            add(*inner.second);
    }
    void add(const osgUtil::RenderLeaf& leaf) const
    {
        const osg::Geometry* mesh =
            leaf._drawable ? osgGeoFX::PatchGeometry::originalOf(*leaf._drawable).asGeometry() : nullptr;
        const osg::Transform* tile = mesh ? osgGeoFX::TileInfo::tileOf(*mesh) : nullptr;
        int level = 0, x = 0, y = 0;
        if (tile && std::sscanf(tile->getName().c_str(), "tile %d/%d/%d", &level, &x, &y) == 3)
            tiles.insert({level, x, y});
    }
};

struct FinishCallback : public osg::Camera::DrawCallback
{
    using osg::Camera::DrawCallback::operator();
    void operator()(osg::RenderInfo&) const override { glFinish(); }
};

/// How a flight is flown.
struct Conditions
{
    std::string file; ///< or its address
    bool looksAhead = false;
    double memory = 0.0; ///< limit of OpenGL's objects of tiles, MiB; 0: none
    int frames = 0;
    float coarser = 1.0f; ///< factor of the camera's LOD scale
};

struct Flown
{
    std::vector<Tiles> tiles;      ///< that each frame has drawn
    std::vector<double> seconds;   ///< that each frame took, without waiting for the next one
    std::vector<double> processor; ///< processor time that its thread took
    double duration = 0.0;         ///< of the whole flight, seconds
    double aheadMilliseconds = 0.0;
    double firstMiB = 0.0;    ///< of OpenGL's objects of tiles, when the first picture is there
    double mostMiB = 0.0;     ///< of them, at any time
    double residentMiB = 0.0; ///< that the process has got more during the flight
    std::uint64_t read = 0, asked = 0;

    double median() const { return bench::median(seconds); }
    double longest() const { return *std::max_element(seconds.begin(), seconds.end()); }
};

/// A flight in real time. Each frame has its place on the way and its time; a frame that is late is drawn at once.
Flown fly(const Conditions& conditions, const FlightPath& path)
{
    std::string error;
    std::optional<osgGeoFX::Scene> scene = osgGeoFX::Scene::load(conditions.file, error);
    if (!scene) throw BenchError(error);
    osg::ref_ptr<osg::GraphicsContext::Traits> traits = new osg::GraphicsContext::Traits;
    traits->width = WIDTH;
    traits->height = HEIGHT;
    const osg::ref_ptr<osgGeoFX::EglGraphicsContext> context = new osgGeoFX::EglGraphicsContext(traits);
    if (!context->valid()) throw BenchError("Nothing can be drawn: " + context->error());
    osgViewer::Viewer viewer;
    viewer.setThreadingModel(osgViewer::ViewerBase::SingleThreaded);
    viewer.setUseConfigureAffinity(false);
    osg::Camera& camera = *viewer.getCamera();
    camera.setGraphicsContext(context);
    camera.setViewport(0, 0, WIDTH, HEIGHT);
    camera.setProjectionMatrixAsPerspective(FIELD_OF_VIEW, static_cast<double>(WIDTH) / HEIGHT, 1.0, 1e6);
    camera.setLODScale(conditions.coarser * scene->lodScale(HEIGHT, osg::DegreesToRadians(FIELD_OF_VIEW)));
    const osg::ref_ptr<TilesDrawn> drawn = new TilesDrawn;
    camera.setPreDrawCallback(drawn);
    camera.addFinalDrawCallback(new FinishCallback);
    osgGeoFX::RemoteFiles::setUpThreads(*viewer.getDatabasePager(), 1);
    scene->setUpView(viewer);
    viewer.setSceneData(scene->node);
    const osg::ref_ptr<osgGeoFX::MemoryBudget> budget =
        new osgGeoFX::MemoryBudget(*viewer.getDatabasePager());
    budget->watch(*scene->node, *scene->guard);
    // Without a limit no tile is to come twice, so that all flights have the same to fetch.
    budget->setLimits(0.0, conditions.memory > 0.0 ? conditions.memory : 1e6);
    const osg::ref_ptr<osgGeoFX::TilePrefetch> ahead = new osgGeoFX::TilePrefetch;
    ahead->setBudget(budget);
    if (conditions.looksAhead) scene->effects->setPrefetch(ahead);
    viewer.realize();

    // It begins when all of the first picture is there.
    camera.setViewMatrix(path.view(0.0));
    osgGeoFX::PagerMonitor monitor(viewer.getDatabasePager(), nullptr, 2);
    for (viewer.frame(0.0); !monitor.frameFinished(); viewer.frame(0.0))
    {
        Interruption::throwIfInterrupted();
        monitor.waitForReads(1.0);
    }
    Flown flown;
    const std::uint64_t before = scene->guard->counts().tilesRead;
    flown.firstMiB = static_cast<double>(budget->counts().gpuBytes) / MIB;
    const double residentBefore = residentMiB();
    std::vector<double> aheadTimes;
    const auto start = Clock::now();
    for (int i = 0; i < conditions.frames; ++i)
    {
        Interruption::throwIfInterrupted();
        const double time = i / RATE;
        std::this_thread::sleep_until(
            start + std::chrono::duration_cast<Clock::duration>(std::chrono::duration<double>(time)));
        camera.setViewMatrix(path.view(time));
        const double processor = threadSeconds();
        const auto begin = Clock::now();
        viewer.frame(time);
        flown.processor.push_back(threadSeconds() - processor - drawn->seconds);
        flown.seconds.push_back(secondsSince(begin) - drawn->seconds);
        flown.tiles.push_back(drawn->tiles);
        aheadTimes.push_back(ahead->counts().milliseconds);
        flown.mostMiB = std::max(flown.mostMiB, static_cast<double>(budget->counts().gpuBytes) / MIB);
    }
    flown.duration = secondsSince(start);
    flown.aheadMilliseconds = bench::median(aheadTimes);
    flown.residentMiB = residentMiB() - residentBefore;
    flown.read = scene->guard->counts().tilesRead - before;
    flown.asked = ahead->counts().asked;
    // OSG's pager goes before the scene that it reads for.
    viewer.getDatabasePager()->cancel();
    return flown;
}

/// Whether one of two frames is nowhere coarser than the other.
bool isAsFine(const Tiles& tiles, const Tiles& wanted)
{
    return std::all_of(wanted.begin(), wanted.end(),
                       [&](const Tile& tile)
                       {
                           auto [level, x, y] = tile;
                           while (--level >= 0)
                               if (tiles.count({level, x /= 2, y /= 2})) return false;
                           return true;
                       });
}

double shareAsFine(const Flown& flown, const Flown& wanted)
{
    std::size_t count = 0;
    for (std::size_t i = 0; i < flown.tiles.size(); ++i)
        count += isAsFine(flown.tiles[i], wanted.tiles[i]) ? 1 : 0;
    return static_cast<double>(count) / static_cast<double>(flown.tiles.size());
}

std::string describe(const Flown& flown)
{
    char text[300];
    std::snprintf(
        text, sizeof text,
        "%zu frames in %.1f s, the median frame %.1f ms, the longest %.1f ms; %llu tiles came, %llu asked "
        "for ahead",
        flown.seconds.size(), flown.duration, 1000.0 * flown.median(), 1000.0 * flown.longest(),
        static_cast<unsigned long long>(flown.read), static_cast<unsigned long long>(flown.asked));
    return text;
}

nlohmann::ordered_json detailsOf(const Flown& flown)
{
    return {{"frames", flown.seconds.size()},
            {"seconds", flown.duration},
            {"medianMilliseconds", 1000.0 * flown.median()},
            {"longestMilliseconds", 1000.0 * flown.longest()},
            {"above3Medians", std::count_if(flown.seconds.begin(), flown.seconds.end(),
                                            [&](double each) { return each > 3.0 * flown.median(); })},
            {"processorMedianMilliseconds", 1000.0 * bench::median(flown.processor)},
            {"processorLongestMilliseconds",
             1000.0 * *std::max_element(flown.processor.begin(), flown.processor.end())},
            {"tilesRead", flown.read},
            {"askedAhead", flown.asked},
            {"aheadMilliseconds", flown.aheadMilliseconds},
            {"mostTileMiB", flown.mostMiB},
            {"residentGrowthMiB", flown.residentMiB}};
}

Figure figureOf(const std::string& name, const std::string& what, const std::string& unit, Bound bound,
                double asked, double measured, const Flown& flown)
{
    Figure figure{name, what, unit, bound, asked};
    figure.measured = measured;
    figure.remark = describe(flown);
    figure.details = detailsOf(flown);
    return figure;
}

/// Oahu for pictures of this size, within a pixel's error, in small tiles.
std::filesystem::path terrainFor(const Settings& settings, const WorkFolder& folder)
{
    if (!settings.terrain.empty()) return settings.terrain;
    const std::filesystem::path oahu = settings.data / "oahu";
    const double pixels = osgGeoFX::pixelsPerRadian(HEIGHT, osg::DegreesToRadians(FIELD_OF_VIEW));
    std::vector<std::string> command =
        builderCommand(settings, oahu / "elevation.tif", folder.path() / "oahu", 2);
    command.insert(command.end(), {"--landcover", (oahu / "landcover.tif").string(), "--landcover-table",
                                   (oahu / "landcover.csv").string(), "--pixels-per-radian",
                                   std::to_string(pixels), "--tile-size", "32"});
    announce("building the terrain to fly over");
    runChild(command);
    return folder.path() / "oahu" / "terrain.osgb";
}

std::vector<Figure> run(const Settings& settings)
{
    const WorkFolder folder(settings.work);
    const std::filesystem::path terrain = terrainFor(settings, folder);
    std::string error;
    const std::optional<osgGeoFX::Scene> scene = osgGeoFX::Scene::load(terrain.string(), error);
    if (!scene) throw BenchError(error);
    if (!scene->reference) throw BenchError(scene->referenceError);
    const std::optional<osgGeoFX::TerrainRelief> relief = osgGeoFX::TerrainRelief::read(
        *scene->node, scene->effects->ground().ellipsoid.get(), settings.smoke ? 64 : 1024, error);
    if (!relief) throw BenchError(error);
    if (!relief->geocentric) throw BenchError(terrain.string() + ": a globe's database is needed.");
    const FlightPath path(*relief, *scene->reference);
    const double seconds = settings.smoke ? 0.5 : settings.quick ? 20.0 : 90.0;

    Conditions conditions;
    conditions.frames = static_cast<int>(seconds * RATE);
    if (settings.smoke) conditions.coarser = 4.0f;
    conditions.file = terrain.string();
    announce("flying over a local disk");
    // Once before, so that no flight but this one finds files that the system has not read yet.
    if (!settings.smoke) fly(conditions, path);
    const Flown disk = fly(conditions, path);
    const DistantServer server(terrain.parent_path(), DELAY, folder.path());
    conditions.file = server.url(terrain.filename().string());
    announce("flying over a server at 50 ms");
    const Flown without = fly(conditions, path);
    announce("the same with a look ahead");
    conditions.looksAhead = true;
    const Flown with = fly(conditions, path);
    announce("the same with little memory");
    // Enough for what is in sight, and not for the whole way.
    conditions.memory = 1.4 * with.firstMiB;
    const Flown little = fly(conditions, path);

    const std::string where = "over HTTP at 50 ms, 500 m above Oahu at 200 m/s: ";
    std::vector<Figure> figures;
    figures.push_back(figureOf("level-without",
                               where + "frames as fine as from a local disk, without a look ahead", "",
                               Bound::None, 0.0, shareAsFine(without, disk), without));
    figures.push_back(figureOf("level-with", where + "the same with a look ahead", "", Bound::AtLeast, 0.95,
                               shareAsFine(with, disk), with));
    figures.push_back(figureOf("longest-with", where + "the longest frame over the median", "", Bound::AtMost,
                               3.0, with.longest() / with.median(), with));
    figures.push_back(figureOf("longest-disk", "the same from a local disk, without a look ahead", "",
                               Bound::None, 0.0, disk.longest() / disk.median(), disk));
    figures.push_back(figureOf("ahead", "what looking ahead takes of a frame", "", Bound::None, 0.0,
                               0.001 * with.aheadMilliseconds / with.median(), with));
    figures.push_back(figureOf("memory-limit",
                               "what tiles take at most over a limit of 1.4 times those of the first picture",
                               "", Bound::AtMost, 1.0, little.mostMiB / conditions.memory, little));
    figures.push_back(figureOf("level-limit", where + "frames as fine as from a disk, with this limit", "",
                               Bound::None, 0.0, shareAsFine(little, disk), little));
    figures.erase(std::remove_if(figures.begin(), figures.end(),
                                 [&](const Figure& each)
                                 { return !settings.wants(each.name.substr(0, each.name.find('-'))); }),
                  figures.end());
    return figures;
}

} // namespace

Suite flightSuite()
{
    return {"flight",
            "Flies across Oahu in real time, from a disk and from a server at 50 ms, with a look ahead and "
            "without, and "
            "compares what is drawn",
            {"level", "longest", "ahead", "memory"},
            run};
}

} // namespace geofx::bench
