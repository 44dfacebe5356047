// SPDX-License-Identifier: MIT
// SPDX-FileCopyrightText: 2026 the osgGeoFX authors
#pragma once

#include <cstdlib>
#include <string>

namespace geofx::test
{

/// Whether a test that needs more of OpenGL than there is has to fail; else it is skipped. So it is in all tests that ctest runs, unless
/// the build was configured with GEOFX_REQUIRE_GL=OFF.
inline bool glIsRequired()
{
    const char* value = std::getenv("GEOFX_REQUIRE_GL");
    return value && std::string(value) == "1";
}

} // namespace geofx::test
