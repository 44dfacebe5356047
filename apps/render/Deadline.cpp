// SPDX-License-Identifier: MIT
// SPDX-FileCopyrightText: 2026 the osgGeoFX authors
#include "render/Deadline.h"

#include <osgGeoFX/paging/ReadingFile.h>

#include <unistd.h>

#include <algorithm>
#include <iostream>
#include <sstream>
#include <utility>

namespace geofx::render
{

Deadline::Deadline(std::string program, int exitCode)
    : _program(std::move(program)), _exitCode(exitCode), _thread([this] { run(); })
{
}

Deadline::~Deadline()
{
    {
        const std::lock_guard<std::mutex> lock(_mutex);
        _done = true;
    }
    _changed.notify_all();
    _thread.join();
}

void Deadline::start(double seconds)
{
    // Who waits by himself comes first; and a wait of years is none.
    constexpr double grace = 1.0, longest = 1e8;
    {
        const std::lock_guard<std::mutex> lock(_mutex);
        _seconds = seconds;
        _end = Clock::now() + std::chrono::duration_cast<Clock::duration>(
                                  std::chrono::duration<double>(std::min(seconds, longest) + grace));
    }
    _changed.notify_all();
}

void Deadline::stop()
{
    const std::lock_guard<std::mutex> lock(_mutex);
    _end.reset();
}

void Deadline::run()
{
    constexpr auto step = std::chrono::milliseconds(50);
    std::unique_lock<std::mutex> lock(_mutex);
    while (!_done)
    {
        if (!_end)
            _changed.wait(lock);
        else if (Clock::now() < *_end)
            _changed.wait_until(lock, *_end);
        else
        {
            const std::string file = osgGeoFX::ReadingFile::longest();
            if (!file.empty()) end(file);
            _changed.wait_for(lock, step);
        }
    }
}

void Deadline::end(const std::string& file) const
{
    std::ostringstream text;
    text << _program << ": " << file << ": it was not read within " << _seconds
         << " s; allow more time with --timeout, or give a large raster overviews with gdaladdo.\n";
    std::cerr << text.str() << std::flush;
    _exit(_exitCode);
}

} // namespace geofx::render
