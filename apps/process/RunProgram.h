// SPDX-License-Identifier: MIT
// SPDX-FileCopyrightText: 2026 the osgGeoFX authors
#pragma once

#include <sys/types.h>

#include <csignal>
#include <functional>
#include <string>
#include <vector>

namespace geofx
{

struct ProgramOptions
{
    std::string input;                    ///< what the program reads from its standard input
    std::vector<std::string> environment; ///< "NAME=VALUE", added to our own
    std::string folder;                   ///< where it runs; empty: where we do
    double seconds = 120.0;               ///< when it is sent the signal; 0: never
    int signal = SIGTERM;                 ///< SIGKILL is how a crash of the machine looks to it
    /// Called with the program's process id as soon as it runs, and with 0 after its end.
    std::function<void(pid_t)> runs;
};

struct ProgramResult
{
    /// What a shell would say: 128 + the signal's number for a program that a signal ended.
    int exitCode = -1;
    bool timedOut = false;
    std::string standardOutput;
    std::string standardError;
    double seconds = 0.0;    ///< wall-clock time
    double cpuSeconds = 0.0; ///< of all its threads, in user and system mode
    /// Largest resident size; at least our own largest until the start, which the kernel counts into it.
    double peakMiB = 0.0;
};

/// Runs a program, arguments[0] a path or a name on PATH, and waits for its end. Throws std::system_error if it cannot be
/// started.
ProgramResult runProgram(const std::vector<std::string>& arguments, const ProgramOptions& options = {});

} // namespace geofx
