// SPDX-License-Identifier: MIT
// SPDX-FileCopyrightText: 2026 the osgGeoFX authors
#pragma once

#include <osgGeoFX/Export.h>
#include <osgGeoFX/paging/TileGuard.h>

#include <osg/observer_ptr>
#include <osgDB/DatabasePager>

namespace osgGeoFX
{

/** Tells when a view has all the tiles that it asks for: nothing requested, read, compiled or waiting to be merged
    for some frames on end. A tile that cannot be read does not keep it waiting, if a TileGuard is there.

    Call `frameFinished()` once after each frame, from the thread that runs the frames. One frame is enough
    where culling ends with the frame (the single-threaded model): such a frame asked for nothing, so its
    picture is final. In the other models take two or more. */
class OSGGEOFX_EXPORT PagerMonitor
{
public:
    struct Progress
    {
        std::uint64_t tilesLoaded = 0;
        std::uint64_t bytesRead = 0;
    };

    explicit PagerMonitor(osgDB::DatabasePager* pager, TileGuard* guard = nullptr,
                          unsigned int quietFrames = 2);

    /// Notes the state after a frame; true if the pager is done for the view.
    bool frameFinished();

    /// Sleeps until the pager's threads have read what was asked for, at most so many seconds. Between frames it spares
    /// drawing pictures that nobody wants.
    void waitForReads(double seconds) const;

    /// Forgets the quiet frames so far; call it when the view jumps.
    void restart() { _quiet = 0; }

    /// What the guard has read since the last call (or the making of the monitor); zeros without a guard.
    Progress takeProgress();

private:
    osg::observer_ptr<osgDB::DatabasePager> _pager;
    osg::ref_ptr<TileGuard> _guard;
    TileGuard::Counts _last;
    unsigned int _quietFrames;
    unsigned int _quiet = 0;
};

} // namespace osgGeoFX
