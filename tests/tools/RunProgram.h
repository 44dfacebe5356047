// SPDX-License-Identifier: MIT
// SPDX-FileCopyrightText: 2026 the osgGeoFX authors
#pragma once

#include <process/RunProgram.h>

#include <string>

namespace geofx::test
{

using geofx::ProgramOptions;
using geofx::ProgramResult;
using geofx::runProgram;

/// The path of a program that this build made, for example "osggeofx_build".
inline std::string builtProgram(const std::string& name)
{
    return std::string(GEOFX_BUILD_DIR "/bin/") + name;
}

} // namespace geofx::test
