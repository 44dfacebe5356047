// SPDX-License-Identifier: MIT
// SPDX-FileCopyrightText: 2026 the osgGeoFX authors
#include <osgGeoFX/paging/detail/ServerRests.h>

#include <chrono>
#include <map>
#include <mutex>

namespace osgGeoFX
{

namespace
{

using Clock = std::chrono::steady_clock;

constexpr int mostFailures = 3;
constexpr std::chrono::seconds rest(2);

struct Server
{
    int failures = 0; ///< in a row
    Clock::time_point restsUntil;
    bool asked = false; ///< after its rest
};

std::mutex mutex;

/// Only those whose last request had no answer.
std::map<std::string, Server>& servers()
{
    static std::map<std::string, Server> all;
    return all;
}

} // namespace

bool ServerRests::isAtRest(const std::string& server)
{
    const std::lock_guard<std::mutex> lock(mutex);
    const auto found = servers().find(server);
    if (found == servers().end() || found->second.failures < mostFailures) return false;
    if (found->second.asked || Clock::now() < found->second.restsUntil) return true;
    found->second.asked = true;
    return false;
}

void ServerRests::tell(const std::string& server, bool answered)
{
    const std::lock_guard<std::mutex> lock(mutex);
    if (answered)
    {
        servers().erase(server);
        return;
    }
    Server& failing = servers()[server];
    ++failing.failures;
    failing.asked = false;
    failing.restsUntil = Clock::now() + rest;
}

} // namespace osgGeoFX
