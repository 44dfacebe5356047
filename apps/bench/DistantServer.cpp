// SPDX-License-Identifier: MIT
// SPDX-FileCopyrightText: 2026 the osgGeoFX authors
#include "DistantServer.h"

#include "BenchError.h"
#include "Interruption.h"

#include <spawn.h>
#include <sys/wait.h>

#include <chrono>
#include <csignal>
#include <cstring>
#include <fstream>
#include <thread>
#include <vector>

extern char** environ;

namespace geofx::bench
{

DistantServer::DistantServer(const std::filesystem::path& folder, double delay,
                             const std::filesystem::path& work)
{
    const std::filesystem::path portFile = work / "port";
    std::filesystem::remove(portFile);
    std::vector<std::string> command = {GEOFX_WEB_SERVER,      folder.string(), "--delay",
                                        std::to_string(delay), "--port-file",   portFile.string()};
    std::vector<char*> pointers;
    for (std::string& argument : command)
        pointers.push_back(argument.data());
    pointers.push_back(nullptr);
    const int failure = posix_spawnp(&_process, pointers[0], nullptr, nullptr, pointers.data(), environ);
    if (failure != 0)
        throw BenchError(std::string(GEOFX_WEB_SERVER) + " cannot be started (" + std::strerror(failure) +
                         "); this suite needs the sources of osgGeoFX and Python.");
    try
    {
        const auto end = std::chrono::steady_clock::now() + std::chrono::seconds(30);
        while (!(std::ifstream(portFile) >> _port))
        {
            Interruption::throwIfInterrupted();
            if (std::chrono::steady_clock::now() > end)
                throw BenchError(std::string(GEOFX_WEB_SERVER) + " did not begin within 30 seconds.");
            std::this_thread::sleep_for(std::chrono::milliseconds(20));
        }
    }
    catch (...)
    {
        stop();
        throw;
    }
}

DistantServer::~DistantServer()
{
    stop();
}

void DistantServer::stop()
{
    ::kill(_process, SIGTERM);
    ::waitpid(_process, nullptr, 0);
}

std::string DistantServer::url(const std::string& name) const
{
    return "http://127.0.0.1:" + _port + "/" + name;
}

} // namespace geofx::bench
