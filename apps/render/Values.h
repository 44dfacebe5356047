// SPDX-License-Identifier: MIT
// SPDX-FileCopyrightText: 2026 the osgGeoFX authors
#pragma once

#include <osgGeoFX/viewer/Scene.h>

#include <osg/Camera>

#include <string>
#include <vector>

namespace CLI
{
class App;
}

namespace geofx::render
{

/// What the picture's layers have at some of its pixels: --values and --series.
struct Values
{
    std::vector<std::string> pixels; ///< "X,Y", counted from the upper left
    std::string
        series; ///< a file for a table of the topmost layer in time at the first pixel; empty for none

    bool any() const { return !pixels.empty(); }
    /// Adds the options to a program.
    void addOptions(CLI::App& app);
    /// Throws std::runtime_error with a sentence if a pixel is none.
    void check() const;
    /// Prints the values to the standard output, and writes the table. `camera`: the one that has drawn the picture. Throws
    /// std::runtime_error with a sentence.
    void print(const osgGeoFX::Scene& scene, const osg::Camera& camera) const;
};

} // namespace geofx::render
