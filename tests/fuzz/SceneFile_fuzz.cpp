// SPDX-License-Identifier: MIT
// SPDX-FileCopyrightText: 2026 the osgGeoFX authors
//
// Any bytes are a scene or give sentences that say why not; what comes out as a scene keeps the schema's
// promises.
#include <geofx/SceneFile.h>
#include <geofx/SceneReach.h>
#include <osgGeoFX/effect/Effect.h>

#include <cmath>
#include <cstdint>
#include <cstdio>
#include <cstdlib>

namespace
{

void require(bool condition, const char* what)
{
    if (condition) return;
    std::fprintf(stderr, "not so: %s\n", what);
    std::abort();
}

bool within(double value, double low, double high)
{
    return value >= low && value <= high;
}

bool isColor(const osgGeoFX::SceneColor& c)
{
    return within(c[0], 0.0, 1.0) && within(c[1], 0.0, 1.0) && within(c[2], 0.0, 1.0);
}

void check(osgGeoFX::PropertyHolder& effect)
{
    for (const osgGeoFX::Property& property : effect.properties())
    {
        std::string error;
        require(effect.setProperty(property.name, property.get(effect), error),
                "properties that fit each other");
    }
    for (const osgGeoFX::PropertyHolder::Part& part : effect.parts())
        check(*part.object);
}

void check(const osgGeoFX::SceneFile& scene)
{
    require(scene.database.has_value() != scene.rasters.has_value(), "one terrain");
    if (scene.rasters)
    {
        require(!scene.rasters->dems.empty(), "an elevation raster");
        require(within(scene.rasters->tileSize, 8, 240), "tile size in its range");
        require(within(scene.rasters->pixelError, 0.01, 100.0), "pixel error in its range");
        require(scene.rasters->memoryMiB >= 128, "memory in its range");
        require(within(scene.rasters->epsg, 0, 999999), "EPSG number in its range");
    }
    if (scene.homeView)
    {
        require(within(scene.homeView->longitude, -180.0, 180.0), "longitude in its range");
        require(within(scene.homeView->latitude, -90.0, 90.0), "latitude in its range");
        require(within(scene.homeView->pitch, -90.0, 90.0), "pitch in its range");
        require(within(scene.homeView->verticalFieldOfView.value_or(1.0), 1.0, 170.0),
                "field of view in its range");
    }
    if (scene.sun)
    {
        require(within(scene.sun->elevation, -90.0, 90.0), "elevation in its range");
        require(isColor(scene.sun->color) && isColor(scene.sun->ambient), "colors in their range");
    }
    require(!scene.background || isColor(scene.background->color), "background in its range");
    require(!scene.background || !scene.background->visibility ||
                (*scene.background->visibility >= 10.0 && *scene.background->visibility <= 1e7),
            "visibility in its range");
    for (const auto& effect : scene.effects)
    {
        require(effect.valid(), "an effect");
        check(*effect);
    }
}

} // namespace

// NOLINTNEXTLINE(readability-identifier-naming): the name is libFuzzer's
extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size)
{
    const std::string text(reinterpret_cast<const char*>(data), size);
    const osgGeoFX::SceneResult result = osgGeoFX::parseScene(text, "fuzz.geofx", "/folder");
    require(result.scene.has_value() == result.errors.empty(), "a scene or errors");
    for (const std::string& error : result.errors)
        require(error.rfind("fuzz.geofx:", 0) == 0, "each error begins with the file");
    if (result.scene)
    {
        check(*result.scene);
        for (const std::string& error : osgGeoFX::outsidePaths(*result.scene, "/folder"))
            require(error.find("--allow-outside") != std::string::npos, "the remedy for what leads out");
    }
    return 0;
}
