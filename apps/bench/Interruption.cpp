// SPDX-License-Identifier: MIT
// SPDX-FileCopyrightText: 2026 the osgGeoFX authors
#include "Interruption.h"

#include "BenchError.h"

#include <atomic>
#include <csignal>

namespace geofx::bench
{

namespace
{

std::atomic<pid_t> runningChild{0};
std::atomic<bool> interrupted{false};
static_assert(std::atomic<pid_t>::is_always_lock_free && std::atomic<bool>::is_always_lock_free,
              "a signal handler may use no lock");

void note(int signal)
{
    interrupted = true;
    const pid_t child = runningChild;
    if (child > 0) kill(child, signal);
}

} // namespace

Interruption::Interruption()
{
    struct sigaction action = {};
    action.sa_handler = note;
    sigaction(SIGINT, &action, nullptr);
    sigaction(SIGTERM, &action, nullptr);
}

void Interruption::throwIfInterrupted()
{
    if (interrupted) throw BenchError("Interrupted; nothing was left behind.");
}

void Interruption::passOnTo(pid_t child)
{
    runningChild = child;
}

} // namespace geofx::bench
