// SPDX-License-Identifier: MIT
// SPDX-FileCopyrightText: 2026 the osgGeoFX authors
#include <osgGeoFX/paging/PagerMonitor.h>

#include <chrono>
#include <thread>

namespace osgGeoFX
{

namespace
{

bool isReading(const osgDB::DatabasePager& pager)
{
    for (unsigned int i = 0; i < pager.getNumDatabaseThreads(); ++i)
    {
        if (pager.getDatabaseThread(i)->getActive()) return true;
    }
    return pager.getFileRequestListSize() > 0;
}

} // namespace

PagerMonitor::PagerMonitor(osgDB::DatabasePager* pager, TileGuard* guard, unsigned int quietFrames)
    : _pager(pager), _guard(guard), _quietFrames(quietFrames)
{
    takeProgress();
}

bool PagerMonitor::frameFinished()
{
    osg::ref_ptr<osgDB::DatabasePager> pager;
    // OSG looks at the list of tiles to merge before it looks whether a thread reads. A tile that goes from the one to the other
    // between the two looks is in neither, and a second look finds it.
    const bool busy =
        _pager.lock(pager) && (pager->getRequestsInProgress() || pager->getRequestsInProgress());
    _quiet = busy ? 0 : _quiet + 1;
    return _quiet >= _quietFrames;
}

void PagerMonitor::waitForReads(double seconds) const
{
    using Clock = std::chrono::steady_clock;
    const auto end = Clock::now() + std::chrono::duration<double>(seconds);
    osg::ref_ptr<osgDB::DatabasePager> pager;
    while (_pager.lock(pager) && isReading(*pager) && Clock::now() < end)
    {
        std::this_thread::sleep_for(std::chrono::milliseconds(1));
    }
}

PagerMonitor::Progress PagerMonitor::takeProgress()
{
    if (!_guard)
    {
        return {};
    }
    const TileGuard::Counts now = _guard->counts();
    const Progress progress = {now.tilesRead - _last.tilesRead, now.bytesRead - _last.bytesRead};
    _last = now;
    return progress;
}

} // namespace osgGeoFX
