// SPDX-License-Identifier: MIT
// SPDX-FileCopyrightText: 2026 the osgGeoFX authors
#pragma once

#include <sys/types.h>

namespace geofx::bench
{

/** Turns SIGINT and SIGTERM into an exception, so that temporary folders and child processes go with us.

    One object lives in main(); what runs long calls throwIfInterrupted() now and then. */
class Interruption
{
public:
    Interruption();

    static void throwIfInterrupted();

    /// The child that gets our signals too; 0 for none.
    static void passOnTo(pid_t child);
};

} // namespace geofx::bench
