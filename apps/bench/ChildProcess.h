// SPDX-License-Identifier: MIT
// SPDX-FileCopyrightText: 2026 the osgGeoFX authors
#pragma once

#include "process/RunProgram.h"

#include <string>
#include <vector>

namespace geofx::bench
{

/** Runs a program to its end; its messages are shown only if it fails.

    Throws BenchError where it cannot be started, fails, or we are interrupted. The kernel counts our own size
   at the start into the child's peak, so what a child's memory is must be measured before we grow large
   ourselves. `environment`: "NAME=VALUE", added to our own. */
ProgramResult runChild(const std::vector<std::string>& arguments,
                       const std::vector<std::string>& environment = {});

} // namespace geofx::bench
