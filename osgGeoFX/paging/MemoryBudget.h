// SPDX-License-Identifier: MIT
// SPDX-FileCopyrightText: 2026 the osgGeoFX authors
#pragma once

#include <osgGeoFX/Export.h>
#include <osgGeoFX/paging/TileGuard.h>

#include <osg/Callback>
#include <osg/FrameStamp>
#include <osg/Node>
#include <osg/Referenced>
#include <osg/observer_ptr>
#include <osg/ref_ptr>
#include <osgDB/DatabasePager>

#include <cstdint>
#include <optional>

namespace osgGeoFX
{

/** Keeps the tiles of a paged scene within an amount of memory.

    @code
    osg::ref_ptr<osgGeoFX::MemoryBudget> budget = new osgGeoFX::MemoryBudget(*viewer.getDatabasePager());
    budget->setLimits(512.0, 256.0);
    budget->watch(*scene.node, *scene.guard);
    @endcode

    It measures each tile that is read: its vertices, indices and images. OSG's pager counts nodes, which tell little of memory.
    When the tiles take more than nine tenths of a limit, the least recently seen of them go, until eight tenths are taken. The
    pager removes them as it removes all tiles, and deletes them on its threads; the budget only says which have expired. Tiles
    that a TilePrefetch wants to keep go last, and tiles in sight never. If these alone take more than a limit, one warning says so.

    While it has a limit, nothing else expires. The pager's target number of PagedLODs and the minimum expiry times of PagedLODs
    below the scene are the budget's to set. Without a limit the pager has its former target again, and the expiry times are 0, as
    OSG has them. A scene with a budget should have a pager of its own: when tiles must go, the pager removes what it may
    of other scenes, too. Memory that is not tiles' does not count: programs, frame buffers, strokes and whatever else listeners add to
    tiles, what the scene's root brings, and what OpenGL has not given back yet. Nor does what the C library keeps of memory that was
    freed. That may be more than what is in use; a FreedMemory makes it little.

    Threads: tiles are measured on the pager's threads. The rest happens in the update traversal of the watched node. Call all
    functions between frames, but counts() and hasRoom(), which any thread may call.

    @ingroup paging */
class OSGGEOFX_EXPORT MemoryBudget : public osg::Referenced
{
public:
    explicit MemoryBudget(osgDB::DatabasePager& pager);

    /// How much tiles may take, MiB. `process`: of main memory, where OSG keeps all that is drawn. `gpu`: of OpenGL's objects,
    /// textures with their mipmaps. 0, the default, and negative numbers: no limit.
    void setLimits(double process, double gpu);

    /// Watches a scene in the place of a former one. The guard must be the scene's. Call it before the first frame, since tiles
    /// that have been read already are not known.
    void watch(osg::Node& scene, TileGuard& guard);

    struct Counts
    {
        std::uint64_t tiles = 0;        ///< files that were read, and are still in memory
        std::uint64_t processBytes = 0; ///< what they take of main memory
        std::uint64_t gpuBytes = 0; ///< what they take of OpenGL's objects once all of them have been drawn
        std::uint64_t removed = 0;  ///< files that were given up; one that comes in sight at once may stay
        std::uint64_t removedAhead = 0; ///< of these, those that a TilePrefetch wanted to keep
    };
    Counts counts() const;

    /// Whether all limits leave room for more than what is in sight.
    bool hasRoom() const;

    /// What a node and all below it take.
    struct Size
    {
        std::uint64_t processBytes = 0, gpuBytes = 0;
    };
    /// Arrays and images that are shared below the node count once. The nodes' own bytes are a rough estimate.
    static Size sizeOf(osg::Node& node);

protected:
    ~MemoryBudget() override;

private:
    class Ledger;
    class Callback;
    void update(osg::Node& scene, const osg::FrameStamp& stamp);
    void choose(osg::Node& scene, const osg::FrameStamp& stamp);
    void release();

    osg::observer_ptr<osgDB::DatabasePager> _pager;
    const osg::ref_ptr<Ledger> _ledger;
    osg::observer_ptr<osg::Node> _scene;
    osg::observer_ptr<TileGuard> _guard;
    osg::observer_ptr<osg::Callback> _callback; ///< of the scene; it keeps the budget
    unsigned int _frame = 0;                    ///< of the last update
    unsigned int _restsUntil = 0;               ///< the frame before which nothing is chosen
    double _lastTime = 0.0;                     ///< reference time of the last update
    std::optional<unsigned int> _formerTarget;  ///< of the pager, while the budget sets it
    bool _prunes = false;                       ///< whether the pager is about to remove what has been chosen
    bool _warned = false;
};

} // namespace osgGeoFX
