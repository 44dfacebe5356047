// SPDX-License-Identifier: MIT
// SPDX-FileCopyrightText: 2026 the osgGeoFX authors
#pragma once

#include <string>

namespace osgGeoFX
{

/// Servers that do not answer rest a while, so that a hundred tiles do not wait a hundred times. Thread-safe.
class ServerRests
{
public:
    /// Whether a server shall not be asked now. When its rest is over, one thread is told so, which is to ask it.
    static bool isAtRest(const std::string& server);
    /// What came of a request. A third one in a row without an answer begins a rest.
    static void tell(const std::string& server, bool answered);
};

} // namespace osgGeoFX
