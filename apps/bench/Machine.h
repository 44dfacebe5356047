// SPDX-License-Identifier: MIT
// SPDX-FileCopyrightText: 2026 the osgGeoFX authors
#pragma once

#include <cstdint>
#include <string>

namespace geofx::bench
{

/// What the figures depend on, beside the program.
struct Machine
{
    std::string processor;
    unsigned int processors = 0;
    std::uint64_t memoryMiB = 0;
    std::string renderer; ///< why there is none, where there is none
    std::string glVersion;

    /// Makes an OpenGL context for a moment.
    static Machine describe();
};

/// Main memory that this process has now, MiB.
double residentMiB();

/// Main memory that the C library has handed out and not got back, MiB: what is in use, without what it keeps of freed memory.
double allocatedMiB();

/// Processor time that this process has taken, in all of its threads, seconds. What other programs take does not count.
double processSeconds();
/// The same of this thread alone: OpenGL's own threads do not count.
double threadSeconds();

} // namespace geofx::bench
