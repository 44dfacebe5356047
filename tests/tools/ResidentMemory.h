// SPDX-License-Identifier: MIT
// SPDX-FileCopyrightText: 2026 the osgGeoFX authors
#pragma once

#include <fstream>
#include <unistd.h>

namespace geofx::test
{

/// The memory of this process that lies in RAM, MiB.
inline double residentMiB()
{
    std::ifstream file("/proc/self/statm");
    double size = 0.0, resident = 0.0;
    file >> size >> resident;
    return resident * static_cast<double>(sysconf(_SC_PAGESIZE)) / 1048576.0;
}

} // namespace geofx::test
