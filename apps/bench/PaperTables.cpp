// SPDX-License-Identifier: MIT
// SPDX-FileCopyrightText: 2026 the osgGeoFX authors
#include "PaperTables.h"

#include "BenchError.h"
#include "CameraPath.h"
#include "OffscreenView.h"

#include <osgGeoFX/viewer/EffectKinds.h>
#include <osgGeoFX/viewer/Scene.h>

#include <osg/Math>
#include <osgDB/WriteFile>

#include <array>
#include <cstddef>
#include <cstdint>
#include <cstdio>
#include <memory>
#include <optional>

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
    double seconds = 0.0;
    std::uint64_t bytes = 0, firstBytes = 0; ///< on the way, and of the picture at its start
    double triangles = 0.0, drawables = 0.0; ///< of a frame, a mean
};

/// Flies along paths, with the terrain read anew each time.
class Flights
{
public:
    /// `lines`: of the picture that tiles are chosen for, which may be larger than the one that is drawn.
    Flights(const Settings& settings, std::filesystem::path terrain, OffscreenView::Size size, int lines,
            int frames)
        : _terrain(std::move(terrain)), _pictures(settings.pictures), _lines(lines), _frames(frames),
          _view(size, FIELD_OF_VIEW, _root)
    {
        osg::Camera& camera = _view.camera();
        camera.setSmallFeatureCullingPixelSize(camera.getSmallFeatureCullingPixelSize() *
                                               static_cast<float>(size.height) / static_cast<float>(lines));
    }

    /// `complete`: each frame waits for its tiles, and is counted and not timed. Otherwise tiles come beside the frames, as they do for users.
    Flight fly(const CameraPath& path, bool bent, bool complete)
    {
        std::string error;
        const std::optional<osgGeoFX::Scene> scene = osgGeoFX::Scene::load(_terrain.string(), error);
        if (!scene) throw BenchError(error);
        if (!scene->terrain || !scene->reference)
            throw BenchError(_terrain.string() + ": it is no terrain database; name one with --terrain FILE.");
        const osg::ref_ptr<osgGeoFX::Effect> effect =
            bent ? osgGeoFX::parseEffect(path.effect, error) : nullptr;
        if (bent && !effect) throw BenchError(error);
        if (effect) scene->effects->addEffect(effect);
        _view.camera().setLODScale(scene->lodScale(_lines, FIELD_OF_VIEW));
        _root->addChild(scene->node);
        _view.look(path.view(0.0, *scene->reference));
        _view.settle();

        Flight flight;
        flight.firstBytes = scene->guard->counts().bytesRead;
        int counted = 0;
        for (int frame = 1; frame <= _frames; ++frame)
        {
            const double share = static_cast<double>(frame) / _frames;
            _view.look(path.view(share, *scene->reference));
            flight.seconds += _view.frame(share * DURATION);
            if (!complete) continue;
            _view.settle(share * DURATION);
            if (frame % PERIOD == PERIOD / 2)
            {
                const OffscreenView::Drawn drawn = _view.count(share * DURATION);
                flight.triangles += static_cast<double>(drawn.triangles);
                flight.drawables += static_cast<double>(drawn.drawables);
                ++counted;
            }
        }
        flight.bytes = scene->guard->counts().bytesRead - flight.firstBytes;
        if (counted > 0)
        {
            flight.triangles /= counted;
            flight.drawables /= counted;
        }
        if (!complete && !_pictures.empty())
        {
            _view.look(path.view(0.5, *scene->reference));
            _view.settle(DURATION);
            const std::filesystem::path file =
                _pictures / (path.name + "-" + std::to_string(_lines) + (bent ? "-bent.png" : "-straight.png"));
            if (!osgDB::writeImageFile(*_view.capture(), file.string()))
                throw BenchError(file.string() + ": the picture cannot be written; name another folder.");
        }
        _root->removeChildren(0, _root->getNumChildren());
        return flight;
    }

private:
    /// Frames from one that is counted to the next; those of the shortest flight have one.
    static constexpr int PERIOD = 3;

    const std::filesystem::path _terrain, _pictures;
    const int _lines, _frames;
    const osg::ref_ptr<osg::Group> _root = new osg::Group;
    OffscreenView _view;
};

/// A row of the paper's Table 1.
Figure speed(Flights& flights, const CameraPath& path, std::size_t size, int frames, int rounds)
{
    const OffscreenView::Size paper = SIZES[size];
    const std::string pixels = std::to_string(paper.width) + "x" + std::to_string(paper.height);
    double straight = 0.0, bent = 0.0;
    for (int round = 0; round < rounds; ++round)
    {
        // In turns, and each is once the first.
        for (const bool which : {round % 2 == 1, round % 2 == 0})
            (which ? bent : straight) += flights.fly(path, which, false).seconds;
    }
    Figure figure{"table1-" + path.name + "-" + pixels,
                  "frames a second with the deformation over those without, at " + pixels +
                      ", tiles coming as one flies: " + path.what,
                  "", Bound::AtLeast, path.leastSpeed};
    figure.measured = straight / bent;
    const double drawn = static_cast<double>(frames) * rounds;
    const CameraPath::Speed& theirs = path.paperSpeeds[size];
    char remark[200];
    std::snprintf(remark, sizeof remark, "%.2f with, %.2f without; the paper: %.2f with, %.2f without, %.2f",
                  drawn / bent, drawn / straight, theirs.bent, theirs.straight, theirs.bent / theirs.straight);
    figure.remark = remark;
    figure.details = {{"bentFramesPerSecond", drawn / bent},
                      {"straightFramesPerSecond", drawn / straight},
                      {"paperBentFramesPerSecond", theirs.bent},
                      {"paperStraightFramesPerSecond", theirs.straight}};
    return figure;
}

/// A row of the paper's Table 2.
Figure bytes(Flights& flights, const CameraPath& path, int frames)
{
    const Flight straight = flights.fly(path, false, true), bent = flights.fly(path, true, true);
    Figure figure{"table2-" + path.name,
                  "bytes read for each frame with the deformation over those without, each frame with all its tiles: " +
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
                  "%.0f with, %.0f without; the first picture %.1f and %.1f MB; %.0f and %.0f thousand triangles in %.0f and "
                  "%.0f drawables; the paper: %.0f with, %.0f without, %.2f",
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
    return figure;
}

} // namespace

std::vector<Figure> measurePaperTables(const Settings& settings, const std::filesystem::path& terrain)
{
    const int frames = settings.smoke ? 3 : settings.quick ? 30 : 60, rounds = settings.smoke ? 1 : 2;
    const auto size = [&](std::size_t i, int part)
    {
        const int smaller = settings.smoke ? 10 : part;
        return OffscreenView::Size{SIZES[i].width / smaller, SIZES[i].height / smaller};
    };
    // First, so that the files lie in the system's cache for whatever is timed. Bytes do not depend on the pixels.
    std::vector<Figure> reads;
    {
        Flights flights(settings, terrain, size(0, 4), settings.smoke ? size(0, 1).height : SIZES[0].height,
                        frames);
        for (const CameraPath& path : cameraPaths())
        {
            announce("counting the bytes of " + path.name);
            reads.push_back(bytes(flights, path, frames));
        }
    }
    std::vector<Figure> figures;
    for (std::size_t i = 0; i < SIZES.size(); ++i)
    {
        Flights flights(settings, terrain, size(i, 1), size(i, 1).height, frames);
        for (const CameraPath& path : cameraPaths())
        {
            announce("flying " + path.name + " at " + std::to_string(SIZES[i].width) + "x" +
                     std::to_string(SIZES[i].height));
            figures.push_back(speed(flights, path, i, frames, rounds));
        }
    }
    figures.insert(figures.end(), reads.begin(), reads.end());
    return figures;
}

} // namespace geofx::bench
