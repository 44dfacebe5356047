// SPDX-License-Identifier: MIT
// SPDX-FileCopyrightText: 2026 the osgGeoFX authors
#pragma once

#include <csignal>
#include <string>
#include <vector>

namespace geofx::test
{

struct ProgramOptions
{
    std::string input;                    ///< what the program reads from its standard input
    std::vector<std::string> environment; ///< "NAME=VALUE", added to our own
    std::string folder;                   ///< where it runs; empty: where we do
    double seconds = 120.0;               ///< when it is sent the signal
    int signal = SIGTERM;                 ///< SIGKILL is how a crash of the machine looks to it
};

struct ProgramResult
{
    /// What a shell would say: 128 + the signal's number for a program that a signal ended.
    int exitCode = -1;
    bool timedOut = false;
    std::string standardOutput;
    std::string standardError;
};

/// Runs a program, arguments[0] a path or a name on PATH, and waits for its end.
ProgramResult runProgram(const std::vector<std::string>& arguments, const ProgramOptions& options = {});

/// The path of a program that this build made, for example "osggeofx_build".
std::string builtProgram(const std::string& name);

} // namespace geofx::test
