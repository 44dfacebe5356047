// SPDX-License-Identifier: MIT
// SPDX-FileCopyrightText: 2026 the osgGeoFX authors
#pragma once

#include <unistd.h>

#include <chrono>
#include <cstdint>
#include <cstdio>
#include <string>

namespace osgGeoFX
{

/// Prints the progress of a build to the standard error output: on a terminal as one line that is rewritten, else as
/// one line for each tenth of the work. Pass std::ref() of it as the BuildProgress of buildDatabase(). Not
/// thread-safe; the builder never calls it from two threads at once.
/// @ingroup terrain
class ProgressLine
{
public:
    explicit ProgressLine(std::string title) : _title(std::move(title)) {}
    ~ProgressLine() { end(); }
    ProgressLine(const ProgressLine&) = delete;
    ProgressLine& operator=(const ProgressLine&) = delete;

    bool operator()(std::uint64_t done, std::uint64_t total, const std::string& phase)
    {
        const auto now = std::chrono::steady_clock::now();
        const int percent = static_cast<int>(100 * done / (total ? total : 1));
        if (_terminal && (done >= total || now - _last > std::chrono::milliseconds(100)))
        {
            std::fprintf(stderr, "\r%s: %3d %% (%s)\x1b[K", _title.c_str(), percent, phase.c_str());
            std::fflush(stderr);
            _last = now;
            _open = true;
            if (done >= total) end();
        }
        else if (!_terminal && percent / 10 != _tenths)
        {
            // It goes back where something new begins.
            std::fprintf(stderr, "%s: %d %% (%s)\n", _title.c_str(), percent, phase.c_str());
            _tenths = percent / 10;
        }
        return true;
    }

private:
    void end()
    {
        if (_open) std::fputc('\n', stderr);
        _open = false;
    }

    std::string _title;
    bool _terminal = isatty(STDERR_FILENO) != 0;
    bool _open = false; ///< the line on the terminal is not ended yet
    int _tenths = -1;
    std::chrono::steady_clock::time_point _last;
};

} // namespace osgGeoFX
