// SPDX-License-Identifier: MIT
// SPDX-FileCopyrightText: 2026 the osgGeoFX authors
#include <osgGeoFX/paging/FreedMemory.h>

#include <chrono>
#include <condition_variable>
#include <mutex>
#include <thread>

#ifdef __GLIBC__
#include <malloc.h>
#endif

namespace osgGeoFX
{

#ifdef __GLIBC__

class FreedMemory::Thread
{
public:
    explicit Thread(double seconds) : _pause(seconds), _thread([this] { run(); }) {}
    ~Thread()
    {
        {
            const std::lock_guard<std::mutex> lock(_mutex);
            _end = true;
        }
        _ended.notify_all();
        _thread.join();
    }

private:
    void run()
    {
        std::unique_lock<std::mutex> lock(_mutex);
        while (!_ended.wait_for(lock, _pause, [this] { return _end; }))
        {
            lock.unlock();
            malloc_trim(0);
            lock.lock();
        }
    }

    const std::chrono::duration<double> _pause;
    std::mutex _mutex;
    std::condition_variable _ended;
    bool _end = false;
    std::thread _thread; ///< last, since it uses the others
};

FreedMemory::FreedMemory(double seconds)
{
    // A threshold that is set does not move any more.
    mallopt(M_MMAP_THRESHOLD, 256 * 1024);
    mallopt(M_ARENA_MAX, 1);
    if (seconds > 0.0) _thread = std::make_unique<Thread>(seconds);
}

#else

class FreedMemory::Thread
{
};

FreedMemory::FreedMemory(double) {}

#endif

FreedMemory::~FreedMemory() = default;

} // namespace osgGeoFX
