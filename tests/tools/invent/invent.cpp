// SPDX-License-Identifier: MIT
// SPDX-FileCopyrightText: 2026 the osgGeoFX authors
//
// Writes one of the invented terrains: geofx_invent NAME FILE.tif [SAMPLES]
#include <tools/InventedTerrain.h>

#include <cstdio>
#include <cstdlib>
#include <exception>

int main(int argc, char** argv)
{
    if (argc < 3)
    {
        std::fputs("Usage: geofx_invent NAME FILE.tif [SAMPLES]; the names:\n", stderr);
        for (const std::string& name : geofx::test::inventedTerrains())
            std::fprintf(stderr, "  %s\n", name.c_str());
        return 2;
    }
    try
    {
        geofx::test::inventTerrain(argv[1], argv[2], argc > 3 ? std::atoi(argv[3]) : 0);
    }
    catch (const std::exception& error)
    {
        std::fprintf(stderr, "geofx_invent: %s\n", error.what());
        return 2;
    }
    return 0;
}
