// SPDX-License-Identifier: MIT
// SPDX-FileCopyrightText: 2026 the osgGeoFX authors
#include "SoakSuite.h"

#include "BenchError.h"
#include "ChildProcess.h"
#include "Growth.h"
#include "Machine.h"
#include "OahuSource.h"
#include "OffscreenView.h"
#include "TerrainSuite.h"
#include "WorkFolder.h"

#include <osgGeoFX/closeup/CloseUps.h>
#include <osgGeoFX/deformation/BirdsEyeView.h>
#include <osgGeoFX/deformation/PedestrianView.h>
#include <osgGeoFX/deformation/VerticalExaggeration.h>
#include <osgGeoFX/mapping/ProjectiveMappings.h>
#include <osgGeoFX/paging/TerrainInfo.h>
#include <osgGeoFX/panorama/PanoramaMap.h>
#include <osgGeoFX/scene/EffectScene.h>
#include <osgGeoFX/viewer/Scene.h>

#include <osg/Geometry>
#include <osg/Math>
#include <osg/NodeVisitor>
#include <osg/Notify>
#include <osg/Texture>

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <mutex>
#include <random>
#include <set>
#include <sstream>

namespace geofx::bench
{

namespace
{

using osgGeoFX::ViewPoint;

constexpr OffscreenView::Size SIZE = {192, 120}; ///< small, for so many frames
const double FIELD_OF_VIEW = osg::DegreesToRadians(40.0);
constexpr double FRAMES_A_SECOND = 30.0; ///< of the flights' own clock
constexpr int FRAMES_A_FLIGHT = 400;     ///< then another one begins elsewhere, with other effects
// The same flights in each, with new objects: freed memory stays with the C library, and what the first round takes is enough
// for the others.
constexpr int ROUNDS = 10;
constexpr int FRAMES_A_SAMPLE = 100; ///< of memory

constexpr double WEST = -158.35, EAST = -157.55, SOUTH = 21.15, NORTH = 21.8; ///< where they fly, degrees
constexpr double METRES_PER_RADIAN = 6371000.0;

constexpr int BUILD_MEMORY = 1024; ///< MiB; with 512, imagery so fine leaves room for one thread
constexpr int TEXELS_PER_POST = 4; ///< along an edge, in the finest tiles
// The build's work files and database together, and the database alone; measured, with a margin.
constexpr double DISK_BYTES_PER_SAMPLE = 90.0, DATABASE_BYTES_PER_SAMPLE = 60.0;

struct Extent
{
    int frames;
    double gigabytes; ///< of the database that is built for it
};

Extent extentFor(const Settings& settings)
{
    if (settings.smoke) return {3 * FRAMES_A_FLIGHT, 0.002};
    if (settings.quick) return {10000, 1.0};
    return {100000, 20.0};
}

/// Counts OSG's warnings and errors, of all threads, and shows them.
class MessageCount : public osg::NotifyHandler
{
public:
    MessageCount() : _former(osg::getNotifyHandler()) { osg::setNotifyHandler(this); }
    void release() { osg::setNotifyHandler(_former); }
    int count() const { return _count; }

    void notify(osg::NotifySeverity severity, const char* message) override
    {
        const std::lock_guard<std::mutex> lock(_mutex);
        if (severity <= osg::WARN) ++_count;
        std::fputs(message, stderr);
    }

private:
    osg::ref_ptr<osg::NotifyHandler> _former;
    std::mutex _mutex;
    int _count = 0;
};

/// Counts the buffers and textures of what of a scene is in memory, drawn now or not.
class SceneObjects : public osg::NodeVisitor
{
public:
    explicit SceneObjects(unsigned int contextId) : NodeVisitor(TRAVERSE_ALL_CHILDREN), _contextId(contextId)
    {
    }
    std::size_t count() const { return _objects.size(); }

    void apply(osg::Node& node) override
    {
        if (node.getStateSet()) addTextures(*node.getStateSet());
        traverse(node);
    }
    void apply(osg::Geometry& geometry) override
    {
        if (geometry.getStateSet()) addTextures(*geometry.getStateSet());
        osg::Geometry::ArrayList arrays;
        geometry.getArrayList(arrays);
        for (const osg::ref_ptr<osg::Array>& array : arrays)
            add(array->getBufferObject());
        for (const osg::ref_ptr<osg::PrimitiveSet>& primitives : geometry.getPrimitiveSetList())
            add(primitives->getBufferObject());
    }

private:
    void add(const osg::BufferObject* buffer)
    {
        if (buffer && buffer->getGLBufferObject(_contextId))
            _objects.insert(buffer->getGLBufferObject(_contextId));
    }
    void addTextures(const osg::StateSet& state)
    {
        for (unsigned int unit = 0; unit < state.getTextureAttributeList().size(); ++unit)
        {
            const auto* texture = dynamic_cast<const osg::Texture*>(
                state.getTextureAttribute(unit, osg::StateAttribute::TEXTURE));
            if (texture && texture->getTextureObject(_contextId))
                _objects.insert(texture->getTextureObject(_contextId));
        }
    }

    unsigned int _contextId;
    std::set<const void*> _objects;
};

/// The same numbers with every standard library.
class Dice
{
public:
    double within(double low, double high)
    {
        return low + (high - low) * (static_cast<double>(_random()) / 4294967296.0);
    }
    int below(int count) { return static_cast<int>(_random() % static_cast<std::uint32_t>(count)); }

private:
    std::mt19937 _random{100000u};
};

struct Flight
{
    ViewPoint begin;
    double speed;    ///< m/s
    double turnRate; ///< radians for each second

    ViewPoint at(int frame) const
    {
        const double seconds = frame / FRAMES_A_SECOND;
        ViewPoint place = begin;
        place.heading += turnRate * seconds;
        // Along the arc of a circle, on ground that is as good as flat for that.
        const double mean = begin.heading + 0.5 * turnRate * seconds;
        const double chord =
            turnRate == 0.0 ? speed * seconds : 2.0 * speed / turnRate * std::sin(0.5 * turnRate * seconds);
        place.latitude += chord * std::cos(mean) / METRES_PER_RADIAN;
        place.longitude += chord * std::sin(mean) / (METRES_PER_RADIAN * std::cos(begin.latitude));
        return place;
    }
};

Flight randomFlight(Dice& dice)
{
    const double height = 600.0 * std::pow(20.0, dice.within(0.0, 1.0));
    return {{osg::DegreesToRadians(dice.within(WEST, EAST)), osg::DegreesToRadians(dice.within(SOUTH, NORTH)),
             height, dice.within(0.0, 2.0 * osg::PI), osg::DegreesToRadians(dice.within(-50.0, -5.0)), 0.0},
            dice.within(50.0, 800.0),
            dice.below(2) ? 0.0 : dice.within(-0.1, 0.1)};
}

osg::ref_ptr<osg::Image> randomImage(Dice& dice)
{
    osg::ref_ptr<osg::Image> image = new osg::Image;
    const int side = 16 << dice.below(4);
    image->allocateImage(side, side, 1, GL_RGBA, GL_UNSIGNED_BYTE);
    for (unsigned int i = 0; i < image->getTotalSizeInBytes(); ++i)
        image->data()[i] = static_cast<unsigned char>(dice.below(256));
    return image;
}

osg::ref_ptr<osgGeoFX::ProjectiveMappings> randomMappings(Dice& dice, const ViewPoint& place)
{
    const osg::ref_ptr<osgGeoFX::ProjectiveMappings> mappings = new osgGeoFX::ProjectiveMappings;
    mappings->setGeodeticOrigin(place.longitude, place.latitude);
    for (int i = dice.below(20); i >= 0; --i)
    {
        const osg::ref_ptr<osgGeoFX::ProjectiveMapping> mapping = new osgGeoFX::ProjectiveMapping;
        // Arguments have no order among themselves, so each number has a name.
        const double x = dice.within(-8000.0, 8000.0), y = dice.within(-8000.0, 8000.0),
                     width = dice.within(200.0, 3000.0), height = dice.within(200.0, 3000.0),
                     turn = dice.within(-3.0, 3.0);
        mapping->setRectangle({x, y}, width, height, turn);
        mapping->setLayer(new osgGeoFX::DataLayer(randomImage(dice)));
        mapping->setOpacity(dice.within(0.2, 1.0));
        mappings->addMapping(mapping);
    }
    return mappings;
}

osg::ref_ptr<osgGeoFX::CloseUps> randomCloseUps(Dice& dice, const ViewPoint& place)
{
    const osg::ref_ptr<osgGeoFX::CloseUps> closeUps = new osgGeoFX::CloseUps;
    for (int i = dice.below(4); i >= 0; --i)
    {
        const osg::ref_ptr<osgGeoFX::CloseUp> closeUp = new osgGeoFX::CloseUp;
        const double away = dice.within(1000.0, 9000.0) / METRES_PER_RADIAN;
        const double heading = place.heading + dice.within(-0.4, 0.4);
        closeUp->getRegion()->setGeodeticCenter(place.longitude +
                                                    away * std::sin(heading) / std::cos(place.latitude),
                                                place.latitude + away * std::cos(heading));
        const double width = dice.within(800.0, 3000.0), depth = dice.within(800.0, 3000.0);
        closeUp->getRegion()->setSize(width, depth);
        closeUp->setOffset({0.0, 0.0, dice.within(300.0, 1500.0)});
        closeUp->setScale(1.5, 1.5, 2.0);
        closeUps->addCloseUp(closeUp);
    }
    return closeUps;
}

void removeEffects(osgGeoFX::EffectScene& scene)
{
    while (scene.getNumEffects())
        scene.removeEffect(scene.getEffect(0));
}

/// Other effects in the scene than before, most of them new objects.
void changeEffects(osgGeoFX::EffectScene& scene, Dice& dice, const ViewPoint& place)
{
    removeEffects(scene);
    const int kind = dice.below(5);
    if (kind != 1 && dice.below(3) == 0)
    {
        const osg::ref_ptr<osgGeoFX::VerticalExaggeration> exaggeration = new osgGeoFX::VerticalExaggeration;
        exaggeration->setFactor(dice.within(1.0, 3.0));
        scene.addEffect(exaggeration);
    }
    switch (kind)
    {
    case 0:
        scene.addEffect(new osgGeoFX::BirdsEyeView);
        break;
    case 1:
        scene.addEffect(new osgGeoFX::PanoramaMap);
        break;
    case 2:
        scene.addEffect(new osgGeoFX::PedestrianView);
        break;
    default:
        break;
    }
    if (dice.below(2)) scene.addEffect(randomMappings(dice, place));
    if (dice.below(2)) scene.addEffect(randomCloseUps(dice, place));
}

/// What was seen while it flew.
struct Log
{
    Growth memory; ///< MiB
    // In the same place with no effect, between two flights.
    Growth allocated; ///< MiB
    Growth objects;   ///< of OpenGL
    Growth others;    ///< of them, but for those of tiles in memory
    std::vector<double> seconds;
    int messages = 0;
};

Log fly(const std::filesystem::path& terrain, const Settings& settings, int frames)
{
    std::string error;
    const std::optional<osgGeoFX::Scene> scene = osgGeoFX::Scene::load(terrain.string(), error);
    if (!scene) throw BenchError(error);
    if (!scene->reference || !scene->reference->isGeocentric() || !scene->terrain)
        throw BenchError(terrain.string() + ": it is no globe; name a database of Oahu with --terrain FILE.");
    const osg::ref_ptr<MessageCount> messages = new MessageCount;
    Log log;
    {
        OffscreenView view(SIZE, FIELD_OF_VIEW, scene->node);
        // As coarse as so small a picture may be, within a pixel's error.
        view.camera().setLODScale(static_cast<float>(scene->terrain->pixelsPerRadian /
                                                     osgGeoFX::pixelsPerRadian(SIZE.height, FIELD_OF_VIEW)));
        Dice dice;
        Flight flight{};
        const int sampled = settings.smoke ? FRAMES_A_SAMPLE / 5 : FRAMES_A_SAMPLE;
        // An effect's first frames compile shaders, so objects are counted where there is none.
        const ViewPoint home{osg::DegreesToRadians(-157.9),
                             osg::DegreesToRadians(21.25),
                             9000.0,
                             0.0,
                             osg::DegreesToRadians(-30.0),
                             0.0};
        osg::Matrixd matrix;
        const auto look = [&](const ViewPoint& place)
        {
            if (!place.viewMatrix(*scene->reference, matrix))
                throw BenchError(terrain.string() +
                                 ": it has no place for the flights; take one that covers Oahu.");
            view.look(matrix);
        };
        const auto wholeFlights = [](int least)
        {
            return std::max(least / FRAMES_A_FLIGHT, 1) * FRAMES_A_FLIGHT;
        };
        const int round = wholeFlights(frames / ROUNDS), counted = wholeFlights(frames / 40);
        const auto countObjects = [&](int frame)
        {
            removeEffects(*scene->effects);
            look(home);
            for (int i = 0; i < 30; ++i)
                view.frame(frame / FRAMES_A_SECOND);
            const GlObjectCount objects = view.objects();
            SceneObjects ofTiles(view.camera().getGraphicsContext()->getState()->getContextID());
            scene->node->accept(ofTiles);
            const int others = objects.all() - static_cast<int>(ofTiles.count());
            log.objects.add(frame, objects.all());
            log.others.add(frame, others);
            log.allocated.add(frame, allocatedMiB());
            std::ostringstream text;
            text << frame << " frames of " << frames << ": " << static_cast<int>(residentMiB()) << " MiB, "
                 << static_cast<int>(allocatedMiB()) << " of them in use, " << objects << "; " << others
                 << " objects but for those of tiles in memory";
            announce(text.str());
        };
        for (int frame = 0; frame < frames; ++frame)
        {
            const double time = frame / FRAMES_A_SECOND;
            if (frame % counted == 0) countObjects(frame);
            if (frame % FRAMES_A_FLIGHT == 0)
            {
                if (frame % round == 0) dice = Dice();
                flight = randomFlight(dice);
                changeEffects(*scene->effects, dice, flight.begin);
            }
            look(flight.at(frame % FRAMES_A_FLIGHT));
            log.seconds.push_back(view.frame(time));
            if (frame % sampled == 0) log.memory.add(frame, residentMiB());
        }
        countObjects(frames);
    }
    messages->release();
    log.messages = messages->count();
    return log;
}

std::filesystem::path build(const Settings& settings, const std::filesystem::path& folder, double& gigabytes)
{
    const double room = static_cast<double>(std::filesystem::space(folder).available);
    // The rest of the disk is not ours alone.
    const double samples =
        std::min(gigabytes * 1e9 / DATABASE_BYTES_PER_SAMPLE, 0.8 * room / DISK_BYTES_PER_SAMPLE);
    const int side = static_cast<int>(std::sqrt(samples));
    const std::filesystem::path source = folder / "heights.vrt", database = folder / "database";
    const std::filesystem::path imagery = folder / "colors.vrt";
    writeResampledOahu(settings.data / "oahu" / "elevation.tif", side, source);
    writeNoisyImagery(TEXELS_PER_POST * side, imagery);
    announce("building " + std::to_string(side) + " x " + std::to_string(side) +
             " samples of Oahu under imagery of noise");
    std::vector<std::string> command = builderCommand(settings, source, database, 2, BUILD_MEMORY);
    command.insert(command.end(), {"--imagery", imagery.string()});
    runChild(command);
    gigabytes = static_cast<double>(bytesBelow(database)) * 1e-9;
    return database / "terrain.osgb";
}

std::vector<Figure> run(const Settings& settings)
{
    const WorkFolder folder(settings.work);
    const Extent extent = extentFor(settings);
    double gigabytes = extent.gigabytes;
    std::filesystem::path terrain = settings.terrain;
    if (terrain.empty())
        terrain = build(settings, folder.path(), gigabytes);
    else
        gigabytes = static_cast<double>(bytesBelow(terrain.parent_path())) * 1e-9;
    const Log log = fly(terrain, settings, extent.frames);

    const double settled = 0.1 * extent.frames;
    char remark[300];
    Figure memory{"memory",
                  "how much resident memory grows in 10,000 frames, after the first tenth of " +
                      std::to_string(extent.frames),
                  "MiB", Bound::Below, 1.0};
    memory.measured = log.memory.slopeFrom(settled);
    const double third = (extent.frames - settled) / 3.0;
    std::snprintf(remark, sizeof remark,
                  "a database of %.2f GB; typically %.1f MiB; median of memory in "
                  "the first, second and last third: %.0f, %.0f, %.0f MiB",
                  gigabytes, log.memory.typicalSlopeFrom(settled),
                  log.memory.medianWithin(settled, settled + third),
                  log.memory.medianWithin(settled + third, settled + 2.0 * third),
                  log.memory.medianWithin(settled + 2.0 * third, extent.frames));
    memory.remark = remark;
    memory.details = {{"gigabytes", gigabytes}, {"samples", log.memory.samples()}};

    Figure allocated{"allocated",
                     "how much memory in use grows in 10,000 frames, after the first tenth, in one place "
                     "with no effect",
                     "MiB", Bound::Below, 1.0};
    allocated.measured = log.allocated.slopeFrom(settled);
    std::snprintf(remark, sizeof remark, "median in the first, second and last third: %.0f, %.0f, %.0f MiB",
                  log.allocated.medianWithin(settled, settled + third),
                  log.allocated.medianWithin(settled + third, settled + 2.0 * third),
                  log.allocated.medianWithin(settled + 2.0 * third, extent.frames + 1.0));
    allocated.remark = remark;
    allocated.details = {{"samples", log.allocated.samples()}};

    Figure objects{"objects", "OpenGL's objects in the last third of the frames over those in the first", "",
                   Bound::AtMost, 1.05};
    const double first = log.objects.medianWithin(settled, settled + third);
    const double last = log.objects.medianWithin(settled + 2.0 * third, extent.frames + 1.0);
    objects.measured = first > 0.0 ? last / first : 1.0;
    // A tile has objects from when it was drawn first, so their number follows the last flights.
    std::snprintf(
        remark, sizeof remark,
        "%.0f and %.0f, in one place with no effect; but for those of tiles in memory %.0f and %.0f", first,
        last, log.others.medianWithin(settled, settled + third),
        log.others.medianWithin(settled + 2.0 * third, extent.frames + 1.0));
    objects.remark = remark;
    objects.details = {{"samples", log.objects.samples()}, {"others", log.others.samples()}};

    Figure messages{"messages", "warnings and errors of OSG and the kit", "", Bound::AtMost, 0.0};
    messages.measured = log.messages;
    Figure frames{"frames", "longest frame over the median one", "", Bound::None};
    const double middle = median(log.seconds);
    frames.measured = *std::max_element(log.seconds.begin(), log.seconds.end()) / middle;
    std::snprintf(remark, sizeof remark,
                  "median %.1f ms, at %d x %d; shaders of new effects compile within frames", 1000.0 * middle,
                  SIZE.width, SIZE.height);
    frames.remark = remark;
    return {memory, allocated, objects, messages, frames};
}

} // namespace

Suite soakSuite()
{
    return {"soak",
            "Flies 100,000 frames over 20 GB of Oahu under noise while effects, views and layers change, and "
            "tells "
            "whether memory and OpenGL's objects grow",
            {"soak"},
            run};
}

} // namespace geofx::bench
