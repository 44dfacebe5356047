// SPDX-License-Identifier: MIT
// SPDX-FileCopyrightText: 2026 the osgGeoFX authors
#pragma once

#include <osgGeoFX/mapping/detail/GpuMappings.h>
#include <osgGeoFX/mapping/detail/PageDrawing.h>
#include <osgGeoFX/mapping/detail/PageTable.h>
#include <osgGeoFX/mapping/detail/PageView.h>

#include <atomic>
#include <memory>
#include <mutex>
#include <optional>

namespace osgGeoFX
{

/** The composed mappings of one camera: a runtime virtual texture.

    What mappings do to the scene's color, c' = (1 - a) c + p, is one color and one opacity wherever all of them mix a color
    of their own with what lies below. It is drawn into pages (MappingPage) once, and fragments fetch it from there. In each
    frame, culling tells which ground is in sight (PageWatch); a cut through the quadtree of pages follows from that
    (PageCut), and what of it must be drawn (PageResidency). Pages are drawn in a stage before the scene (PageDrawing).
    Until all pages are there, and where something cannot be drawn beforehand, fragments go through the mappings themselves.
    For one thread at a time, but for those methods that say otherwise. */
class CameraPages
{
public:
    /// What a frame is drawn with.
    struct Task
    {
        std::shared_ptr<GpuMappings> gpu;
        GpuMappings::Frame frame;
        PageFrame plane;
        double opacity = 1.0;
        int anisotropy = 1;
        const char* obstacle = nullptr; ///< a sentence that tells why nothing can be drawn beforehand
        int megabytes = 0;
        int pagesPerFrame = 1;
    };

    /// Begins a frame, before the scene is culled. The state draws without pages until draw() finds that all are there.
    void begin(Task task, osg::StateSet& state, const std::string& prefix);
    /// Pages are no longer wanted.
    void stop(osg::StateSet& state, const std::string& prefix);
    /// Nothing is drawn in this frame.
    void skip() { _task.reset(); }
    PageWatch& watch() { return _watch; }
    /// After the scene has been culled.
    void draw(const ScenePass& pass, int pageUnit, int tableUnit);

    /// May be called from any thread.
    ProjectiveMappings::CacheStatistics statistics() const;
    void releaseGLObjects(osg::State* state);
    void resizeGLObjectBuffers(unsigned int size);

private:
    const char* obstacle(const ScenePass& pass, const std::vector<SeenGround>& seen, bool beyond) const;
    void applyChanges(const ScenePass& pass);
    bool plan(const ScenePass& pass, PageResidency::Frame& frame);
    void show(const ScenePass& pass, int pageUnit, int tableUnit);
    void say(const char* why);

    std::optional<Task> _task;
    PageWatch _watch;
    PageCut _cut;
    std::unique_ptr<PageDrawing> _drawing;
    std::unique_ptr<PageResidency> _residency;
    PageTable _table;
    const GpuMappings* _gpu = nullptr; ///< whose changes are known up to this number
    std::uint64_t _changes = 0;
    double _opacity = -1.0;
    int _anisotropy = 0;
    bool _begun = false;  ///< whether the state has been told of pages
    bool _showed = false; ///< in the last frame
    std::atomic<bool> _lost{false};
    mutable std::mutex _mutex;
    ProjectiveMappings::CacheStatistics _statistics;
};

} // namespace osgGeoFX
