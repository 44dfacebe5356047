// SPDX-License-Identifier: MIT
// SPDX-FileCopyrightText: 2026 the osgGeoFX authors
#pragma once

#include "names/SceneNames.h"

#include <osgGeoFX/lines/LinePicture.h>
#include <osgGeoFX/lines/MapLines.h>

#include <map>
#include <string>
#include <vector>

namespace geofx::names
{

/// The lines of the option --lines, on a scene's ground.
struct SceneLines
{
    std::vector<osgGeoFX::MapLine> lines;
    std::map<std::string, osgGeoFX::LineStyle> styles;

    /** Reads all files and places their lines. Throws std::runtime_error with a sentence. `notice`: what people should know of the lines, in a
        sentence; empty where all are well. */
    static SceneLines read(const Options& options, const osgGeoFX::Scene& scene, std::string& notice);

    /// Adds them to the scene, for pictures of a height in pixels; 900 for those on the screen.
    void addTo(osgGeoFX::Scene& scene, double height) const;
};

} // namespace geofx::names
