// SPDX-License-Identifier: MIT
// SPDX-FileCopyrightText: 2026 the osgGeoFX authors
#pragma once

#include <atomic>
#include <cstddef>
#include <exception>
#include <mutex>
#include <thread>
#include <vector>

namespace osgGeoFX
{

/// Calls work(worker, index) for each index below `count`, on `threads` threads, each with one index at a time. The
/// first exception stops the others and is thrown to the caller.
template<typename Work>
void runOnWorkers(int threads, std::size_t count, Work work)
{
    std::atomic<std::size_t> next{0};
    std::exception_ptr failure;
    std::mutex failureMutex;
    const auto run = [&](int worker)
    {
        for (std::size_t index = next++; index < count; index = next++)
        {
            try
            {
                work(worker, index);
            }
            catch (...)
            {
                next = count;
                const std::lock_guard<std::mutex> lock(failureMutex);
                if (!failure) failure = std::current_exception();
            }
        }
    };
    std::vector<std::thread> others;
    for (int worker = 1; worker < threads && static_cast<std::size_t>(worker) < count; ++worker)
        others.emplace_back(run, worker);
    run(0);
    for (auto& thread : others)
        thread.join();
    if (failure) std::rethrow_exception(failure);
}

} // namespace osgGeoFX
