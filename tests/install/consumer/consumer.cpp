// SPDX-License-Identifier: MIT
// SPDX-FileCopyrightText: 2026 the osgGeoFX authors
#include <osgGeoFX/effect/GlslFunctions.h>
#include <osgGeoFX/effect/ShaderLibrary.h>

#include <iostream>

int main()
{
    const auto bend = osgGeoFX::glsl::geofx_makeBend(osgGeoFX::glsl::GEOFX_CURVE_ARC_LENGTH, 100.0, 0.5);
    const glm::dvec2 place = osgGeoFX::glsl::geofx_bend(bend, {150.0, 10.0});
    const std::string text = osgGeoFX::ShaderLibrary().source("lib/bend.glsl");
    std::cout << place.x << ' ' << place.y << ' ' << text.size() << std::endl;
    return place.y > 10.0 && text.find("geofx_bend") != std::string::npos ? 0 : 1;
}
