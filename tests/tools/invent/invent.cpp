// SPDX-License-Identifier: MIT
// SPDX-FileCopyrightText: 2026 the osgGeoFX authors
//
// Writes one of the invented terrains: geofx_invent NAME FILE.tif [SAMPLES]
// or, for the terrain of data/oahu, a town (geofx_invent town FILE.gpkg [BUILDINGS]), houses all over the island (geofx_invent
// crowd FILE.gpkg [BUILDINGS]), the streets between a town's houses (geofx_invent streets FILE.geojson [BUILDINGS]), a land cover with their
// gardens (geofx_invent gardens FROM.tif FILE.tif), or an aerial picture (geofx_invent aerial FILE.tif [COLUMNS]).
#include <osgGeoFX/batch/InputFiles.h>
#include <tools/InventedAerial.h>
#include <tools/InventedTerrain.h>
#include <tools/InventedTown.h>

#include <cstdio>
#include <cstdlib>
#include <exception>
#include <string>

int main(int argc, char** argv)
{
    if (argc < 3)
    {
        std::fputs(
            "Usage: geofx_invent town FILE.gpkg [BUILDINGS],\n       geofx_invent crowd FILE.gpkg "
            "[BUILDINGS],\n       geofx_invent streets FILE.geojson [BUILDINGS],\n       geofx_invent "
            "gardens "
            "FROM.tif FILE.tif,\n       geofx_invent aerial FILE.tif [COLUMNS], or\n       geofx_invent NAME "
            "FILE.tif [SAMPLES]; the names:\n",
            stderr);
        for (const std::string& name : geofx::test::inventedTerrains())
            std::fprintf(stderr, "  %s\n", name.c_str());
        return 2;
    }
    try
    {
        const std::string name = argv[1];
        if (name == "town" || name == "crowd")
        {
            const int count =
                name == "town" ? geofx::test::inventTown(argv[2], argc > 3 ? std::atoi(argv[3]) : 16000)
                               : geofx::test::inventCrowd(argv[2], argc > 3 ? std::atoi(argv[3]) : 1000000);
            std::printf("%s: %d buildings.\n", argv[2], count);
            return 0;
        }
        if (name == "streets")
        {
            std::printf("%s: %d streets.\n", argv[2],
                        geofx::test::inventStreets(argv[2], argc > 3 ? std::atoi(argv[3]) : 16000));
            return 0;
        }
        if (name == "gardens" && argc > 3)
        {
            osgGeoFX::InputFiles inputs;
            inputs.add(argv[2]);
            inputs.claim("The land cover", argv[3], "FILE.tif");
            std::printf("%s: %d cells with gardens.\n", argv[3],
                        geofx::test::inventGardens(argv[2], argv[3]));
            return 0;
        }
        if (name == "aerial")
        {
            geofx::test::inventAerial(argv[2], argc > 3 ? std::atoi(argv[3]) : 12960);
            return 0;
        }
        geofx::test::inventTerrain(argv[1], argv[2], argc > 3 ? std::atoi(argv[3]) : 0);
    }
    catch (const std::exception& error)
    {
        std::fprintf(stderr, "geofx_invent: %s\n", error.what());
        return 2;
    }
    return 0;
}
