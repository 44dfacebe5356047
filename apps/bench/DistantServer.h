// SPDX-License-Identifier: MIT
// SPDX-FileCopyrightText: 2026 the osgGeoFX authors
#pragma once

#include <sys/types.h>

#include <filesystem>
#include <string>

namespace geofx::bench
{

/// tests/serve/web_server.py on a folder, as long as this lives.
class DistantServer
{
public:
    /// `delay`: before each answer, milliseconds. `work`: a folder for what it writes. Throws BenchError where it cannot be
    /// started.
    DistantServer(const std::filesystem::path& folder, double delay, const std::filesystem::path& work);
    ~DistantServer();
    DistantServer(const DistantServer&) = delete;
    DistantServer& operator=(const DistantServer&) = delete;

    std::string url(const std::string& name) const;

private:
    void stop();

    pid_t _process = 0;
    std::string _port;
};

} // namespace geofx::bench
