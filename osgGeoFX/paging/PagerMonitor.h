// SPDX-License-Identifier: MIT
// SPDX-FileCopyrightText: 2026 the osgGeoFX authors
#pragma once

#include <osgGeoFX/Export.h>
#include <osgGeoFX/paging/TileGuard.h>

#include <osg/observer_ptr>
#include <osgDB/DatabasePager>

namespace osgGeoFX
{

/** Tells when a view has all the tiles that it asks for. The pager must have nothing requested, read, compiled or
    waiting to be merged, for several frames in a row. With a TileGuard, a tile that cannot be read does not keep the
    monitor waiting.

    Call frameFinished() once after each frame, from the thread that runs the frames. In the single-threaded model
    culling ends with the frame, and one quiet frame is enough: it asked for nothing, so its picture is final. In the
    other models use two or more.

    @ingroup paging */
class OSGGEOFX_EXPORT PagerMonitor
{
public:
    /// What the guard has read.
    struct Progress
    {
        std::uint64_t tilesLoaded = 0;
        std::uint64_t bytesRead = 0; ///< sizes of the files
    };

    /// `quietFrames`: the number of frames in a row without work for the pager.
    explicit PagerMonitor(osgDB::DatabasePager* pager, TileGuard* guard = nullptr,
                          unsigned int quietFrames = 2);

    /// Checks the pager after a frame. True if the pager is done for the view.
    bool frameFinished();

    /// Sleeps until the pager's threads have read all requested files, but no longer than `seconds`. Between frames
    /// this saves drawing pictures that nobody wants.
    void waitForReads(double seconds) const;

    /// Forgets the quiet frames so far. Call it when the view jumps.
    void restart() { _quiet = 0; }

    /// What the guard has read since the last call, or since the monitor was made; zeros without a guard.
    Progress takeProgress();

private:
    osg::observer_ptr<osgDB::DatabasePager> _pager;
    osg::ref_ptr<TileGuard> _guard;
    TileGuard::Counts _last;
    unsigned int _quietFrames;
    unsigned int _quiet = 0;
};

} // namespace osgGeoFX
