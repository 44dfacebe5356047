// SPDX-License-Identifier: MIT
// SPDX-FileCopyrightText: 2026 the osgGeoFX authors
#include "render/Values.h"

#include <osgGeoFX/mapping/LayerProbe.h>
#include <osgGeoFX/mapping/LayerSeries.h>
#include <osgGeoFX/viewer/ViewPoint.h>

#include <CLI/CLI.hpp>
#include <osg/Math>

#include <cstdio>
#include <stdexcept>

namespace geofx::render
{

namespace
{

osg::Vec2d pixelOf(const std::string& text)
{
    const auto numbers = osgGeoFX::parseNumbers(text);
    if (!numbers || numbers->size() != 2)
        throw std::runtime_error("--values " + text + ": write a pixel as two numbers, such as 640,360.");
    return {(*numbers)[0], (*numbers)[1]};
}

std::string placeOf(const osgGeoFX::Scene& scene, const osg::Vec3d& world)
{
    double longitude = 0.0, latitude = 0.0, height = 0.0;
    char text[128];
    if (scene.reference && scene.reference->toGeodetic(world, longitude, latitude, height))
        std::snprintf(text, sizeof text, "longitude %.6f, latitude %.6f, height %.1f m",
                      osg::RadiansToDegrees(longitude), osg::RadiansToDegrees(latitude), height);
    else
        std::snprintf(text, sizeof text, "x %.2f, y %.2f, z %.2f", world.x(), world.y(), world.z());
    return text;
}

} // namespace

void Values::addOptions(CLI::App& app)
{
    auto* const option =
        app.add_option(
               "--values", pixels,
               "Print what each layer has at a pixel, with its unit: those of --mapping, --sequence and the "
               "scene; pixels count from the upper left. As often as wanted")
            ->expected(1)
            ->type_name("X,Y")
            ->multi_option_policy(CLI::MultiOptionPolicy::TakeAll);
    app.add_option(
           "--series", series,
           "… and write a table of all times of the topmost layer in time at the first of these pixels")
        ->type_name("FILE.csv")
        ->needs(option);
}

void Values::check() const
{
    for (const std::string& text : pixels)
        pixelOf(text);
}

void Values::print(const osgGeoFX::Scene& scene, const osg::Camera& camera) const
{
    bool first = true;
    for (const std::string& text : pixels)
    {
        const osg::Vec2d pixel = pixelOf(text);
        const auto probe = osgGeoFX::LayerProbe::under(*scene.effects, camera, pixel.x() + 0.5,
                                                       camera.getViewport()->height() - pixel.y() - 0.5);
        std::printf("%s: %s\n", text.c_str(), probe ? placeOf(scene, probe->world).c_str() : "no ground");
        const osgGeoFX::LayerReading* inTime = nullptr;
        for (std::size_t i = 0; probe && i < probe->readings.size(); ++i)
        {
            const osgGeoFX::LayerReading& reading = probe->readings[i];
            std::printf("  %s\n", reading.text().c_str());
            if (!inTime && reading.sequence) inTime = &reading;
        }
        if (!series.empty() && first)
        {
            if (!inTime)
                throw std::runtime_error("--series: there is no layer in time at the pixel " + text +
                                         "; name another one.");
            const osg::ref_ptr<osgGeoFX::LayerSeries> values = new osgGeoFX::LayerSeries(*inTime->sequence);
            values->setPlace(inTime->raster);
            values->wait();
            std::string error;
            if (!values->writeCsv(series, inTime->name, inTime->unit, error))
                throw std::runtime_error("--series: " + error);
        }
        first = false;
    }
}

} // namespace geofx::render
