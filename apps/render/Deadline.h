// SPDX-License-Identifier: MIT
// SPDX-FileCopyrightText: 2026 the osgGeoFX authors
#pragma once

#include <chrono>
#include <condition_variable>
#include <mutex>
#include <optional>
#include <string>
#include <thread>

namespace geofx::render
{

/** Ends the program, with a sentence that names the file, where it waits for a raster or vector data (osgGeoFX::ReadingFile) for too long:
    nothing stops GDAL's readers. Threads of its own go on reading while the program takes an error apart, so that a wait ends only with
    stop(). Thread-safe. */
class Deadline
{
public:
    /// `program`: its name; `exitCode`: what it ends with.
    Deadline(std::string program, int exitCode);
    ~Deadline();
    Deadline(const Deadline&) = delete;
    Deadline& operator=(const Deadline&) = delete;

    /// A wait of so many seconds begins, in the place of the one before.
    void start(double seconds);
    void stop();

private:
    using Clock = std::chrono::steady_clock;
    void run();
    void end(const std::string& file) const;

    const std::string _program;
    const int _exitCode;
    std::mutex _mutex;
    std::condition_variable _changed;
    std::optional<Clock::time_point> _end;
    double _seconds = 0.0;
    bool _done = false;
    std::thread _thread; ///< the last one, as it uses the others
};

} // namespace geofx::render
