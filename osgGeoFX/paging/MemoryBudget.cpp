// SPDX-License-Identifier: MIT
// SPDX-FileCopyrightText: 2026 the osgGeoFX authors
#include <osgGeoFX/paging/MemoryBudget.h>

#include <osgGeoFX/paging/detail/TileAges.h>
#include <osgGeoFX/paging/detail/TileBytes.h>

#include <osg/Notify>
#include <osg/Observer>

#include <algorithm>
#include <cmath>
#include <iomanip>
#include <map>
#include <mutex>
#include <sstream>

namespace osgGeoFX
{

namespace
{

constexpr double MIB = 1024.0 * 1024.0;
/// The shares of a limit at which tiles begin to go, and that are taken afterwards.
constexpr double HIGH = 0.9, LOW = 0.8;
/// More than any scene has.
constexpr unsigned int ALL_NODES = 1000000000;
/// Frames in which the pager deletes what it has removed, and frames to wait where nothing can go.
constexpr unsigned int REST = 5, LONG_REST = 30;
/// What OSG's pager demands of what expires, seconds since it was seen.
constexpr double FRESH = 0.1;

std::uint64_t bytesOf(double mebibytes)
{
    return std::isfinite(mebibytes) && mebibytes > 0.0 ? static_cast<std::uint64_t>(mebibytes * MIB) : 0;
}

double share(std::uint64_t bytes, std::uint64_t limit)
{
    return limit > 0 ? static_cast<double>(bytes) / static_cast<double>(limit) : 0.0;
}

std::string inMebibytes(std::uint64_t bytes)
{
    std::ostringstream text;
    text << std::fixed << std::setprecision(1) << static_cast<double>(bytes) / MIB << " MiB";
    return text.str();
}

} // namespace

/** Knows what each tile in memory takes. It observes the tiles, and lives as long as one of them: they may be deleted
    after the budget, and on any thread. */
class MemoryBudget::Ledger : public TileListener, public osg::Observer
{
public:
    void tileRead(osg::Node& tile) override
    {
        const Size size = sizeOf(tile);
        {
            const std::lock_guard<std::mutex> lock(_mutex);
            if (!_sizes.emplace(static_cast<osg::Referenced*>(&tile), size).second) return;
            add(size, 1);
        }
        ref();
        tile.addObserver(this);
    }

    void objectDeleted(void* object) override
    {
        {
            const std::lock_guard<std::mutex> lock(_mutex);
            const auto entry = _sizes.find(object);
            if (entry == _sizes.end()) return;
            add(entry->second, -1);
            _sizes.erase(entry);
        }
        unref();
    }

    Size of(osg::Node& tile) const
    {
        const std::lock_guard<std::mutex> lock(_mutex);
        const auto entry = _sizes.find(static_cast<osg::Referenced*>(&tile));
        return entry == _sizes.end() ? Size() : entry->second;
    }

    void setLimits(const Size& limits)
    {
        const std::lock_guard<std::mutex> lock(_mutex);
        _limits = limits;
    }
    Size limits() const
    {
        const std::lock_guard<std::mutex> lock(_mutex);
        return _limits;
    }
    void tellRemoved(std::uint64_t count, std::uint64_t ahead)
    {
        const std::lock_guard<std::mutex> lock(_mutex);
        _counts.removed += count;
        _counts.removedAhead += ahead;
    }
    Counts counts() const
    {
        const std::lock_guard<std::mutex> lock(_mutex);
        return _counts;
    }
    /// The larger one of both shares.
    double taken() const
    {
        const std::lock_guard<std::mutex> lock(_mutex);
        return std::max(share(_counts.processBytes, _limits.processBytes),
                        share(_counts.gpuBytes, _limits.gpuBytes));
    }

private:
    void add(const Size& size, int count)
    {
        const std::uint64_t sign = count > 0 ? 1 : ~0ull; // −1
        _counts.tiles += sign;
        _counts.processBytes += sign * size.processBytes;
        _counts.gpuBytes += sign * size.gpuBytes;
    }

    mutable std::mutex _mutex;
    std::map<const void*, Size> _sizes;
    Size _limits;
    Counts _counts;
};

class MemoryBudget::Callback : public osg::NodeCallback
{
public:
    explicit Callback(MemoryBudget& budget) : _budget(&budget) {}

    void operator()(osg::Node* node, osg::NodeVisitor* visitor) override
    {
        if (visitor->getFrameStamp()) _budget->update(*node, *visitor->getFrameStamp());
        traverse(node, visitor);
    }

private:
    const osg::ref_ptr<MemoryBudget> _budget;
};

MemoryBudget::MemoryBudget(osgDB::DatabasePager& pager)
    : osg::Referenced(true), _pager(&pager), _ledger(new Ledger)
{
}

MemoryBudget::~MemoryBudget()
{
    release();
}

/// The pager decides by itself again.
void MemoryBudget::release()
{
    osg::ref_ptr<osgDB::DatabasePager> pager;
    if (_formerTarget && _pager.lock(pager)) pager->setTargetMaximumNumberOfPageLOD(*_formerTarget);
    _formerTarget.reset();
    osg::ref_ptr<osg::Node> scene;
    if (!_scene.lock(scene)) return;
    TileAges ages(0);
    scene->accept(ages);
    for (const TileAges::Child& each : ages.sorted())
        each.free();
}

void MemoryBudget::setLimits(double process, double gpu)
{
    _ledger->setLimits({bytesOf(process), bytesOf(gpu)});
    _warned = false;
}

void MemoryBudget::watch(osg::Node& scene, TileGuard& guard)
{
    // The former scene's callback may be the last that keeps it.
    const osg::ref_ptr<MemoryBudget> self = this;
    osg::ref_ptr<osg::Node> former;
    osg::ref_ptr<osg::Callback> formerCallback;
    osg::ref_ptr<TileGuard> formerGuard;
    release();
    if (_guard.lock(formerGuard)) formerGuard->removeListener(_ledger);
    if (_scene.lock(former) && _callback.lock(formerCallback)) former->removeUpdateCallback(formerCallback);
    const osg::ref_ptr<Callback> callback = new Callback(*this);
    scene.addUpdateCallback(callback);
    _callback = callback.get();
    _scene = &scene;
    _guard = &guard;
    guard.addListener(_ledger);
}

MemoryBudget::Counts MemoryBudget::counts() const
{
    return _ledger->counts();
}

bool MemoryBudget::hasRoom() const
{
    return _ledger->taken() < HIGH;
}

MemoryBudget::Size MemoryBudget::sizeOf(osg::Node& node)
{
    TileBytes bytes;
    node.accept(bytes);
    return bytes.size();
}

void MemoryBudget::update(osg::Node& scene, const osg::FrameStamp& stamp)
{
    const unsigned int frame = stamp.getFrameNumber();
    osg::ref_ptr<osgDB::DatabasePager> pager;
    if (frame == _frame || !_pager.lock(pager)) return;
    _frame = frame;
    const Size limits = _ledger->limits();
    if (limits.processBytes > 0 || limits.gpuBytes > 0)
    {
        // The pager has just removed what was chosen a frame ago.
        if (!_formerTarget) _formerTarget = pager->getTargetMaximumNumberOfPageLOD();
        pager->setTargetMaximumNumberOfPageLOD(ALL_NODES);
        _prunes = false;
        if (frame >= _restsUntil && _ledger->taken() > HIGH) choose(scene, stamp);
        if (_prunes) pager->setTargetMaximumNumberOfPageLOD(0);
    }
    else if (_formerTarget)
    {
        release();
    }
    _lastTime = stamp.getReferenceTime();
}

void MemoryBudget::choose(osg::Node& scene, const osg::FrameStamp& stamp)
{
    TileAges ages(stamp.getFrameNumber());
    scene.accept(ages);
    const Size limits = _ledger->limits();
    const Counts before = _ledger->counts();
    Size left = {before.processBytes, before.gpuBytes}, inSight;
    std::uint64_t removed = 0, removedAhead = 0;
    for (const TileAges::Child& each : ages.sorted())
    {
        const Size size = _ledger->of(*each.node());
        if (each.seen >= _lastTime)
        {
            inSight.processBytes += size.processBytes;
            inSight.gpuBytes += size.gpuBytes;
        }
        // What is wanted ahead goes only as far as it must: it would be asked for again.
        const double goal = each.ahead ? HIGH : LOW;
        const bool enough = share(left.processBytes, limits.processBytes) <= goal &&
                            share(left.gpuBytes, limits.gpuBytes) <= goal;
        if (enough || each.seen >= _lastTime || each.seen >= stamp.getReferenceTime() - FRESH) continue;
        each.expire();
        left.processBytes -= std::min(left.processBytes, size.processBytes);
        left.gpuBytes -= std::min(left.gpuBytes, size.gpuBytes);
        ++removed;
        removedAhead += each.ahead ? 1 : 0;
    }
    _prunes = removed > 0;
    _restsUntil = stamp.getFrameNumber() + (_prunes ? REST : LONG_REST);
    _ledger->tellRemoved(removed, removedAhead);
    const bool process = share(inSight.processBytes, limits.processBytes) > 1.0,
               gpu = share(inSight.gpuBytes, limits.gpuBytes) > 1.0;
    if (_warned || !(process || gpu)) return;
    _warned = true;
    OSG_WARN << "osgGeoFX: The tiles in sight take "
             << inMebibytes(process ? inSight.processBytes : inSight.gpuBytes)
             << (process ? " of main memory" : " of OpenGL's memory") << ", and the limit is "
             << inMebibytes(process ? limits.processBytes : limits.gpuBytes)
             << "; they stay. Raise the limit, or draw coarser tiles by a larger LOD scale." << std::endl;
}

} // namespace osgGeoFX
