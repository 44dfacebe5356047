// SPDX-License-Identifier: MIT
// SPDX-FileCopyrightText: 2026 the osgGeoFX authors
#include <osgGeoFX/scene/TilePrefetch.h>

#include <osgGeoFX/scene/detail/AheadVisitor.h>
#include <osgGeoFX/scene/detail/CameraMotion.h>
#include <osgGeoFX/scene/detail/CameraRoles.h>
#include <osgGeoFX/scene/detail/CameraState.h>

#include <osg/Transform>
#include <osg/View>
#include <osg/Viewport>

#include <algorithm>
#include <chrono>
#include <cmath>
#include <map>
#include <mutex>
#include <set>

namespace osgGeoFX
{

namespace
{

using Handler = osg::NodeVisitor::DatabaseRequestHandler;
using Effects = std::vector<osg::ref_ptr<Effect>>;

/// Into how many parts the lead is divided. Ranges of tiles are far longer than what a camera goes in one of them.
constexpr int STEPS = 4;
/// How long a request goes on that no camera wishes for any more, seconds.
constexpr double HOLD = 0.5;
constexpr double SHORTEST = 0.1, LONGEST = 60.0;

/// One traversal of a camera, as it was culled.
struct Seen
{
    unsigned int frame = 0;
    osg::observer_ptr<osg::Group> top;
    osg::observer_ptr<Handler> handler;
    ViewGeometry view = ViewGeometry({}, {}, {});
    Effects effects;
    bool compensates = false;
    osg::ref_ptr<const osg::Viewport> viewport;
    double lodScale = 1.0;
    bool sides = true, horizons = true;
    osg::Node::NodeMask mask = ~0u, override = 0;
    osg::Matrixd above;                          ///< from the scene's children to the world
    osg::observer_ptr<const osg::Camera> leader; ///< the view's camera; null for cameras that no path leads
    osg::Matrixd beside;                         ///< from the leader's eye space to this camera's
    double time = 0.0;                           ///< of the simulation
    CameraMotion motion;

    AheadVisitor::Outlook outlook(const osg::Matrixd& modelView) const
    {
        ViewGeometry there(modelView, view.projection, view.ground);
        if (!view.image.ofView) there.setImage(modelView * view.image.toEye, view.image.projection);
        osg::ref_ptr<const DeformationChain> chain;
        if (compensates)
            chain = CameraSnapshots(effects, EffectsAtWork(effects), there).chain(there.ground);
        else
            chain = new DeformationChain;
        return {there, chain, viewport, lodScale, sides, horizons, compensates};
    }
};

/// The traversals of one camera in a frame, in their order.
struct Watched
{
    osg::observer_ptr<const osg::Camera> camera;
    unsigned int frame = 0;
    std::size_t used = 0;
    std::vector<Seen> traversals;
};

struct Request
{
    osg::observer_ptr<osg::PagedLOD> group;
    unsigned int child = 0;
    float priority = 0.0f;
    osg::Matrixd model;
    osg::observer_ptr<Handler> handler;
    osg::observer_ptr<osg::Node> terrain; ///< an osgTerrain::Terrain above it
    double wished = 0.0;                  ///< the last time, seconds
};

osg::Node* terrainIn(const osg::NodePath& path)
{
    const auto found =
        std::find_if(path.begin(), path.end(), [](osg::Node* node) { return node->asTerrain(); });
    return found == path.end() ? nullptr : *found;
}

void ask(const Request& request, osg::PagedLOD& group, Handler& handler, const osg::FrameStamp& stamp)
{
    osg::ref_ptr<osg::Node> terrain;
    osg::NodePath path;
    if (request.terrain.lock(terrain)) path.push_back(terrain.get());
    path.push_back(&group);
    handler.requestNodeFile(group.getDatabasePath() + group.getFileName(request.child), path,
                            request.priority, &stamp, group.getDatabaseRequest(request.child),
                            group.getDatabaseOptions());
}

} // namespace

struct TilePrefetch::Parts
{
    struct Led
    {
        bool all = false;
        osg::observer_ptr<const osg::Camera> camera;
        Path path;
    };

    const Path* pathOf(const Seen& seen) const;
    /// Where a camera is going to be.
    std::optional<osg::Matrixd> modelView(const Seen& seen, double ahead) const;
    std::vector<Seen*> current(unsigned int frameNumber);
    /// All that is missing ahead, what is needed sooner first.
    std::vector<Request> look(const std::vector<Seen*>& seen, unsigned int frameNumber, double now);
    /// Those for which the pager must not be told anything: the cameras that are there already ask for them.
    void leaveOutPresent(std::vector<Request>& requests, const std::vector<Seen*>& seen) const;
    void mind(double now);
    double lead() const { return length * reach; }

    mutable std::mutex mutex;
    std::map<const osg::Camera*, Watched> cameras;
    std::vector<Led> paths;
    std::vector<Request> waiting;
    osg::ref_ptr<MemoryBudget> budget;
    osg::ref_ptr<AheadVisitor> visitor = new AheadVisitor;
    double length = 3.0; ///< seconds
    double reach = 1.0;  ///< the share of it for which there is memory
    std::uint64_t removed = 0;
    std::optional<unsigned int> frame;
    double lastTime = 0.0;
    Counts counts;
};

TilePrefetch::TilePrefetch() : osg::Referenced(true), _parts(std::make_unique<Parts>()) {}

TilePrefetch::~TilePrefetch() = default;

void TilePrefetch::setLead(double seconds)
{
    const std::lock_guard<std::mutex> lock(_parts->mutex);
    _parts->length = std::isfinite(seconds) ? std::clamp(seconds, SHORTEST, LONGEST) : 3.0;
}

double TilePrefetch::getLead() const
{
    const std::lock_guard<std::mutex> lock(_parts->mutex);
    return _parts->length;
}

void TilePrefetch::setPath(Path path, const osg::Camera* camera)
{
    const std::lock_guard<std::mutex> lock(_parts->mutex);
    auto& paths = _parts->paths;
    paths.erase(std::remove_if(paths.begin(), paths.end(),
                               [&](const Parts::Led& each) {
                                   return camera ? each.camera.get() == camera ||
                                                       (!each.all && !each.camera.valid())
                                                 : each.all;
                               }),
                paths.end());
    if (path) paths.push_back({!camera, camera, std::move(path)});
}

TilePrefetch::Path TilePrefetch::along(const osg::AnimationPath& path, double start)
{
    const osg::ref_ptr<const osg::AnimationPath> kept = &path;
    return [kept, start](double time) -> std::optional<osg::Matrixd>
    {
        const double since = time - start;
        const bool ends = kept->getLoopMode() == osg::AnimationPath::NO_LOOPING;
        osg::Matrixd view;
        if (kept->empty() || (ends && since > kept->getLastTime()) || !kept->getInverse(since, view))
            return std::nullopt;
        return view;
    };
}

void TilePrefetch::setBudget(MemoryBudget* budget)
{
    const std::lock_guard<std::mutex> lock(_parts->mutex);
    _parts->budget = budget;
    _parts->removed = budget ? budget->counts().removedAhead : 0;
    _parts->reach = 1.0;
}

TilePrefetch::Counts TilePrefetch::counts() const
{
    const std::lock_guard<std::mutex> lock(_parts->mutex);
    Counts result = _parts->counts;
    result.waiting = static_cast<unsigned int>(_parts->waiting.size());
    result.lead = _parts->lead();
    return result;
}

void TilePrefetch::note(osgUtil::CullVisitor& outer, osg::Group& top, const ViewGeometry& view,
                        const Effects& effects, bool compensates)
{
    const osg::FrameStamp* stamp = outer.getFrameStamp();
    const osg::Camera* camera = outer.getCurrentCamera();
    if (!stamp || !camera || !outer.getDatabaseRequestHandler()) return;
    const osg::Camera* const leader = leaderOf(outer);
    const std::lock_guard<std::mutex> lock(_parts->mutex);
    Watched& watched = _parts->cameras[camera];
    // Another camera may have got the address of one that is gone.
    if (!watched.camera.valid() || watched.camera != camera) watched = Watched();
    watched.camera = camera;
    if (watched.frame != stamp->getFrameNumber()) watched.used = 0;
    watched.frame = stamp->getFrameNumber();
    if (watched.used == watched.traversals.size()) watched.traversals.emplace_back();
    Seen& seen = watched.traversals[watched.used++];
    seen.frame = watched.frame;
    seen.top = &top;
    seen.handler = outer.getDatabaseRequestHandler();
    seen.view = view;
    seen.effects = effects;
    seen.compensates = compensates;
    seen.viewport = outer.getViewport() ? new osg::Viewport(*outer.getViewport()) : nullptr;
    seen.lodScale = static_cast<double>(outer.getLODScale());
    seen.sides = (outer.getCullingMode() & osg::CullSettings::VIEW_FRUSTUM_SIDES_CULLING) != 0;
    seen.horizons = (outer.getCullingMode() & osg::CullSettings::CLUSTER_CULLING) != 0;
    seen.mask = outer.getTraversalMask();
    seen.override = outer.getNodeMaskOverride();
    seen.above = osg::computeLocalToWorld(outer.getNodePath());
    seen.leader = leader;
    seen.beside = osg::Matrixd();
    if (leader && leader != camera)
        seen.beside = osg::Matrixd::inverse(seen.above * leader->getViewMatrix()) * view.modelView;
    seen.time = stamp->getSimulationTime();
    seen.motion.add(*stamp, view.modelView);
}

const TilePrefetch::Path* TilePrefetch::Parts::pathOf(const Seen& seen) const
{
    osg::ref_ptr<const osg::Camera> camera;
    if (!seen.leader.lock(camera)) return nullptr;
    const Led* found = nullptr;
    for (const Led& each : paths)
        if (each.camera.get() == camera.get() || (each.all && !found)) found = &each;
    return found ? &found->path : nullptr;
}

std::optional<osg::Matrixd> TilePrefetch::Parts::modelView(const Seen& seen, double ahead) const
{
    const Path* path = pathOf(seen);
    if (!path) return seen.motion.at(ahead);
    const std::optional<osg::Matrixd> view = (*path)(seen.time + ahead);
    if (!view) return std::nullopt;
    return seen.above * *view * seen.beside;
}

std::vector<Seen*> TilePrefetch::Parts::current(unsigned int frameNumber)
{
    std::vector<Seen*> result;
    for (auto entry = cameras.begin(); entry != cameras.end();)
    {
        Watched& watched = entry->second;
        watched.traversals.resize(watched.used);
        // The frame before this one was culled in whole.
        const bool isCurrent = watched.camera.valid() && watched.frame + 1 >= frameNumber;
        for (Seen& each : watched.traversals)
            if (isCurrent) result.push_back(&each);
        entry = isCurrent ? std::next(entry) : cameras.erase(entry);
    }
    return result;
}

std::vector<Request> TilePrefetch::Parts::look(const std::vector<Seen*>& seen, unsigned int frameNumber,
                                               double now)
{
    std::vector<Request> result;
    std::set<const osg::PagedLOD*> known;
    std::set<const Seen*> moving;
    for (int step = 1; step <= STEPS; ++step)
    {
        for (const Seen* each : seen)
        {
            osg::ref_ptr<osg::Group> top;
            if (!each->top.lock(top)) continue;
            const std::optional<osg::Matrixd> there = modelView(*each, lead() * step / STEPS);
            if (!there || *there == each->view.modelView) continue;
            moving.insert(each);
            visitor->found = [&](const AheadVisitor::Missing& missing)
            {
                if (!known.insert(&missing.group).second) return;
                const float later = static_cast<float>(step);
                result.push_back({&missing.group, missing.child,
                                  std::clamp(missing.priority, -1.0f, 1.0f) - 3.0f * later, missing.model,
                                  each->handler, terrainIn(visitor->getNodePath()), now});
            };
            visitor->begin(each->outlook(*there), frameNumber);
            visitor->setTraversalMask(each->mask);
            visitor->setNodeMaskOverride(each->override);
            top->traverse(*visitor);
        }
    }
    visitor->found = nullptr;
    counts.cameras = static_cast<unsigned int>(moving.size());
    return result;
}

void TilePrefetch::Parts::leaveOutPresent(std::vector<Request>& requests,
                                          const std::vector<Seen*>& seen) const
{
    if (requests.empty()) return;
    for (const Seen* each : seen)
    {
        visitor->begin(each->outlook(each->view.modelView), 0);
        const auto isPresent = [&](const Request& request)
        {
            osg::ref_ptr<osg::PagedLOD> group;
            return request.group.lock(group) &&
                   visitor->wants({*group, request.child, request.priority, request.model});
        };
        requests.erase(std::remove_if(requests.begin(), requests.end(), isPresent), requests.end());
    }
}

void TilePrefetch::Parts::mind(double now)
{
    if (!budget) return;
    constexpr double least = 0.05, recovery = 0.05; // a second
    reach = std::min(1.0, reach + recovery * std::clamp(now - lastTime, 0.0, 1.0));
    const std::uint64_t gone = budget->counts().removedAhead;
    if (gone > removed) reach = std::max(least, 0.5 * reach);
    removed = gone;
}

void TilePrefetch::update(const osg::FrameStamp& stamp)
{
    Parts& parts = *_parts;
    const std::lock_guard<std::mutex> lock(parts.mutex);
    if (parts.frame == stamp.getFrameNumber()) return;
    parts.frame = stamp.getFrameNumber();
    const auto start = std::chrono::steady_clock::now();
    const double now = stamp.getReferenceTime();
    parts.mind(now);
    const std::vector<Seen*> seen = parts.current(stamp.getFrameNumber());
    std::vector<Request> wishes = parts.look(seen, stamp.getFrameNumber(), now);

    // What is on its way goes on for a while.
    std::set<const osg::PagedLOD*> wished, waits;
    for (const Request& each : wishes)
        wished.insert(each.group.get());
    for (Request& each : parts.waiting)
    {
        osg::ref_ptr<osg::PagedLOD> group;
        if (!each.group.lock(group) || group->getNumChildren() != each.child) continue;
        waits.insert(group.get());
        if (wished.count(group.get()) || now - each.wished > HOLD) continue;
        each.priority = -3.0f * (STEPS + 1);
        wishes.push_back(each);
    }
    parts.leaveOutPresent(wishes, seen);

    // The pager takes younger requests first, whatever their priority. These are older than all that cameras lack now.
    const osg::ref_ptr<osg::FrameStamp> late = new osg::FrameStamp(stamp);
    late->setReferenceTime(std::min(parts.lastTime, now) - 1.0);
    // The pager learns of this frame when culling begins. Until then it would take its number for a difference of billions, and
    // drop requests, and what has been read for them. The number before is young enough in both frames.
    late->setFrameNumber(stamp.getFrameNumber() - 1);
    const bool hasRoom = !parts.budget || parts.budget->hasRoom();
    parts.waiting.clear();
    for (const Request& each : wishes)
    {
        osg::ref_ptr<osg::PagedLOD> group;
        osg::ref_ptr<Handler> handler;
        if (!each.group.lock(group) || !each.handler.lock(handler)) continue;
        const bool isNew = !waits.count(group.get());
        if (isNew && !hasRoom) continue;
        ask(each, *group, *handler, *late);
        parts.counts.asked += isNew ? 1 : 0;
        parts.waiting.push_back(each);
    }
    parts.lastTime = now;
    parts.counts.milliseconds =
        std::chrono::duration<double, std::milli>(std::chrono::steady_clock::now() - start).count();
}

} // namespace osgGeoFX
