// SPDX-License-Identifier: MIT
// SPDX-FileCopyrightText: 2026 the osgGeoFX authors
#include "PaperTables.h"

#include "BenchError.h"
#include "Machine.h"
#include "OffscreenView.h"
#include "PaperPath.h"

#include <osgGeoFX/viewer/EffectKinds.h>
#include <osgGeoFX/viewer/Scene.h>

#include <osg/Math>
#include <osg/NodeVisitor>
#include <osg/Texture>
#include <osgDB/WriteFile>

#include <array>
#include <cstddef>
#include <cstdint>
#include <cstdio>
#include <fstream>
#include <optional>
#include <string>
#include <utility>

namespace geofx::bench
{

namespace
{

const double FIELD_OF_VIEW = osg::DegreesToRadians(40.0);
constexpr std::array<OffscreenView::Size, 3> SIZES = {{{1600, 1200}, {1024, 768}, {800, 600}}};
/// Of a flight, seconds of the viewer's clock: after ten of them, tiles that have not been drawn any more may go.
constexpr double DURATION = 30.0;

/// What a flight along a path took.
struct Flight
{
    double seconds = 0.0, processorSeconds = 0.0;
    std::uint64_t bytes = 0, firstBytes = 0; ///< on the way, and of the picture at its start
    double triangles = 0.0, drawables = 0.0; ///< of a frame, a mean
};

struct Flights
{
    Flight straight, bent;
};

/// Takes anisotropic filtering out of what is read: a processor that draws pays for each sample of it, and graphics cards do not, so
/// it would be most of a frame with grounds that are seen from their edge.
class PlainFiltering : public osgGeoFX::TileListener
{
public:
    static void applyTo(osg::Node& node)
    {
        struct Visitor : osg::NodeVisitor
        {
            Visitor() : osg::NodeVisitor(TRAVERSE_ALL_CHILDREN) {}
            void apply(osg::Node& each) override
            {
                osg::StateSet* state = each.getStateSet();
                const unsigned int units = state ? state->getNumTextureAttributeLists() : 0;
                for (unsigned int unit = 0; unit < units; ++unit)
                    if (auto* texture = dynamic_cast<osg::Texture*>(
                            state->getTextureAttribute(unit, osg::StateAttribute::TEXTURE)))
                        texture->setMaxAnisotropy(1.0f);
                traverse(each);
            }
        } visitor;
        node.accept(visitor);
    }

    void tileRead(osg::Node& tile) override { applyTo(tile); }
};

/// Shows the scenes of flights, one after the other.
struct Cockpit
{
    /// `lines`: of the picture that tiles are chosen for, which may be larger than the one that is drawn.
    Cockpit(OffscreenView::Size size, int lines) : view(size, FIELD_OF_VIEW, root)
    {
        osg::Camera& camera = view.camera();
        camera.setSmallFeatureCullingPixelSize(camera.getSmallFeatureCullingPixelSize() *
                                               static_cast<float>(size.height) / static_cast<float>(lines));
    }

    const osg::ref_ptr<osg::Group> root = new osg::Group;
    OffscreenView view;
};

/// Flies along paths, with the terrain read anew each time.
class Pilot
{
public:
    /// `lines`: as for Cockpit.
    Pilot(const Settings& settings, std::filesystem::path scene, OffscreenView::Size size, int lines,
          int frames)
        : _file(std::move(scene)), _pictures(settings.pictures), _lines(lines), _frames(frames),
          _straight(size, lines), _bent(size, lines)
    {
    }

    /// Straight frames and bent ones take turns, each with its own terrain and pager: a scene that one viewer shows in every other
    /// frame would lose its tiles in between. Frames have all their tiles, for a frame without them is sooner drawn.
    Flights time(const PaperPath& path)
    {
        Flight straight, bent;
        Cruise cruises[] = {Cruise{_straight, load(path, false), straight},
                            Cruise{_bent, load(path, true), bent}};
        for (Cruise& cruise : cruises)
            start(cruise, path);
        for (int frame = 1; frame <= _frames; ++frame)
        {
            const double share = static_cast<double>(frame) / _frames;
            // Each is first in every other round.
            for (const int which : {frame % 2, 1 - frame % 2})
            {
                Cruise& cruise = cruises[which];
                show(cruise, path, share);
                cruise.cockpit.view.settle(share * DURATION);
                const double before = processSeconds();
                cruise.flight.seconds += cruise.cockpit.view.frame(share * DURATION);
                cruise.flight.processorSeconds += processSeconds() - before;
            }
        }
        if (!_pictures.empty())
            for (const int which : {0, 1})
                picture(cruises[which], path, which == 0 ? "straight" : "bent");
        for (const Cruise& cruise : cruises)
            land(cruise);
        return {straight, bent};
    }

    /// What is read and drawn. Frames have all their tiles.
    Flights count(const PaperPath& path) { return {count(path, false), count(path, true)}; }

private:
    /// Frames from one that is counted to the next; those of the shortest flight have one.
    static constexpr int PERIOD = 3;

    struct Cruise
    {
        Cockpit& cockpit;
        osgGeoFX::Scene scene;
        Flight& flight;
    };

    osgGeoFX::Scene load(const PaperPath& path, bool bent) const
    {
        std::string error;
        const osg::ref_ptr<osgDB::Options> options = new osgDB::Options("allowOutside");
        const std::optional<osgGeoFX::Scene> scene = osgGeoFX::Scene::load(_file.string(), error, options);
        if (!scene) throw BenchError(error);
        if (!scene->terrain || !scene->reference)
            throw BenchError("The database is no terrain; name one with --terrain FILE.");
        PlainFiltering::applyTo(*scene->node);
        scene->guard->addListener(_filtering);
        if (!bent) return *scene;
        const osg::ref_ptr<osgGeoFX::Effect> effect = osgGeoFX::parseEffect(path.effect, error);
        if (!effect) throw BenchError(error);
        scene->effects->addEffect(effect);
        return *scene;
    }

    static void show(Cruise& cruise, const PaperPath& path, double share)
    {
        cruise.cockpit.view.look(path.view(share, *cruise.scene.reference));
    }

    void start(Cruise& cruise, const PaperPath& path)
    {
        OffscreenView& view = cruise.cockpit.view;
        cruise.cockpit.root->addChild(cruise.scene.node);
        cruise.scene.setUpView(view.view());
        view.camera().setLODScale(cruise.scene.lodScale(_lines, FIELD_OF_VIEW));
        show(cruise, path, 0.0);
        view.settle();
    }

    Flight count(const PaperPath& path, bool bent)
    {
        Flight flight;
        Cruise cruise{bent ? _bent : _straight, load(path, bent), flight};
        OffscreenView& view = cruise.cockpit.view;
        start(cruise, path);
        const osgGeoFX::TileGuard& guard = *cruise.scene.guard;
        flight.firstBytes = guard.counts().bytesRead;
        int counted = 0;
        for (int frame = 1; frame <= _frames; ++frame)
        {
            const double share = static_cast<double>(frame) / _frames;
            show(cruise, path, share);
            view.settle(share * DURATION);
            if (frame % PERIOD != PERIOD / 2) continue;
            const OffscreenView::Drawn drawn = view.count(share * DURATION);
            flight.triangles += static_cast<double>(drawn.triangles);
            flight.drawables += static_cast<double>(drawn.drawables);
            ++counted;
        }
        flight.bytes = guard.counts().bytesRead - flight.firstBytes;
        flight.triangles /= counted;
        flight.drawables /= counted;
        land(cruise);
        return flight;
    }

    void picture(Cruise& cruise, const PaperPath& path, const std::string& kind)
    {
        show(cruise, path, 0.5);
        cruise.cockpit.view.settle(DURATION);
        const std::filesystem::path file =
            _pictures / (path.name + "-" + std::to_string(_lines) + "-" + kind + ".png");
        if (!osgDB::writeImageFile(*cruise.cockpit.view.capture(), file.string()))
            throw BenchError(file.string() + ": the picture cannot be written; name another folder.");
    }

    static void land(const Cruise& cruise) { cruise.cockpit.root->removeChild(cruise.scene.node); }

    const std::filesystem::path _file, _pictures;
    const int _lines, _frames;
    const osg::ref_ptr<PlainFiltering> _filtering = new PlainFiltering;
    Cockpit _straight, _bent;
};

/// A row of the paper's Table 1.
Figure speed(Pilot& pilot, const PaperPath& path, std::size_t size, int frames)
{
    const OffscreenView::Size paper = SIZES[size];
    const std::string pixels = std::to_string(paper.width) + "x" + std::to_string(paper.height);
    const auto [straight, bent] = pilot.time(path);
    Figure figure{"table1-" + path.name + "-" + pixels,
                  "frames a second with the deformation over those without, at " + pixels +
                      ", each frame with all its tiles, without anisotropic filtering: " + path.what,
                  "", Bound::AtLeast, path.leastSpeed};
    figure.measured = straight.seconds / bent.seconds;
    const PaperPath::Speed& theirs = path.paperSpeeds[size];
    char remark[250];
    std::snprintf(
        remark, sizeof remark,
        "%.2f with, %.2f without (by processor time %.2f); the paper: %.2f with, %.2f without, %.2f",
        frames / bent.seconds, frames / straight.seconds, straight.processorSeconds / bent.processorSeconds,
        theirs.bent, theirs.straight, theirs.bent / theirs.straight);
    figure.remark = remark;
    figure.details = {{"bentFramesPerSecond", frames / bent.seconds},
                      {"straightFramesPerSecond", frames / straight.seconds},
                      {"bentProcessorSeconds", bent.processorSeconds},
                      {"straightProcessorSeconds", straight.processorSeconds},
                      {"paperBentFramesPerSecond", theirs.bent},
                      {"paperStraightFramesPerSecond", theirs.straight}};
    announce("  " + figure.remark);
    return figure;
}

/// A row of the paper's Table 2.
Figure bytes(Pilot& pilot, const PaperPath& path, int frames)
{
    const auto [straight, bent] = pilot.count(path);
    Figure figure{
        "table2-" + path.name,
        "bytes read for each frame with the deformation over those without, each frame with all its "
        "tiles: " +
            path.what,
        "", path.below ? Bound::Below : Bound::AtMost, path.mostBytes};
    const auto each = [frames](std::uint64_t all)
    {
        return static_cast<double>(all) / frames;
    };
    // A path so short that nothing comes on it tells nothing.
    figure.measured = straight.bytes > 0 ? each(bent.bytes) / each(straight.bytes)
                                         : each(bent.firstBytes) / each(straight.firstBytes);
    char remark[400];
    std::snprintf(remark, sizeof remark,
                  "%.0f with, %.0f without; the first picture %.1f and %.1f MB; %.0f and %.0f thousand "
                  "triangles in %.0f and %.0f drawables; the paper: %.0f with, %.0f without, %.2f",
                  each(bent.bytes), each(straight.bytes), static_cast<double>(bent.firstBytes) * 1e-6,
                  static_cast<double>(straight.firstBytes) * 1e-6, bent.triangles * 1e-3,
                  straight.triangles * 1e-3, bent.drawables, straight.drawables, path.paperBentBytes,
                  path.paperStraightBytes, path.paperBentBytes / path.paperStraightBytes);
    figure.remark = remark;
    figure.details = {{"bentBytesPerFrame", each(bent.bytes)},
                      {"straightBytesPerFrame", each(straight.bytes)},
                      {"bentFirstBytes", bent.firstBytes},
                      {"straightFirstBytes", straight.firstBytes},
                      {"bentTriangles", bent.triangles},
                      {"straightTriangles", straight.triangles},
                      {"paperBentBytesPerFrame", path.paperBentBytes},
                      {"paperStraightBytesPerFrame", path.paperStraightBytes}};
    announce("  " + figure.remark);
    return figure;
}

/// A scene with the light of an afternoon, for without one a viewer's own lamp lights the ground.
std::filesystem::path writeScene(const std::filesystem::path& folder, const std::filesystem::path& terrain)
{
    std::filesystem::path file = folder / "paper.geofx";
    std::ofstream stream(file);
    stream << "<geofx version=\"1\">\n  <terrain><database file=\"" << terrain.string()
           << "\"/></terrain>\n"
              "  <sun azimuth=\"300\" elevation=\"34\" color=\"#d8d0be\" ambient=\"#59606b\"/>\n"
              "  <background color=\"#b9d3ea\"/>\n</geofx>\n";
    stream.close();
    if (!stream) throw BenchError(file.string() + ": it cannot be written; is the disk full?");
    return file;
}

} // namespace

std::vector<Figure> measurePaperTables(const Settings& settings, const std::filesystem::path& terrain,
                                       const std::filesystem::path& folder)
{
    const int frames = settings.smoke ? 3 : settings.quick ? 30 : 120;
    const std::filesystem::path scene = writeScene(folder, terrain);
    const auto size = [&](std::size_t i, int part)
    {
        const int smaller = settings.smoke ? 10 : part;
        return OffscreenView::Size{SIZES[i].width / smaller, SIZES[i].height / smaller};
    };
    // First, so that the files lie in the system's cache for whatever is timed. Bytes do not depend on the pixels.
    std::vector<Figure> reads;
    {
        Pilot pilot(settings, scene, size(0, 8), size(0, 1).height, frames);
        for (const PaperPath& path : paperPaths())
        {
            announce("counting the bytes of " + path.name);
            reads.push_back(bytes(pilot, path, frames));
        }
    }
    std::vector<Figure> figures;
    for (std::size_t i = 0; i < SIZES.size(); ++i)
    {
        Pilot pilot(settings, scene, size(i, 1), size(i, 1).height, frames);
        for (const PaperPath& path : paperPaths())
        {
            announce("flying " + path.name + " at " + std::to_string(SIZES[i].width) + "x" +
                     std::to_string(SIZES[i].height));
            figures.push_back(speed(pilot, path, i, frames));
        }
    }
    figures.insert(figures.end(), reads.begin(), reads.end());
    return figures;
}

} // namespace geofx::bench
