// SPDX-License-Identifier: MIT
// SPDX-FileCopyrightText: 2026 the osgGeoFX authors
#pragma once

#include "panorama/Recipe.h"

#include <osgGeoFX/batch/FolderLock.h>
#include <osgGeoFX/panorama/TerrainRelief.h>

#include <optional>
#include <string>
#include <vector>

namespace geofx::panorama
{

/** Builds the terrains of a panorama map in a folder: one to choose the view from, and one that the picture shows,
    both no finer than needed. What is finished from an earlier run with the same sources is taken over. */
class GroundBuilder
{
public:
    /// Takes the folder (OwnFolder), which nobody else may use meanwhile. Throws WorkError if it has other files, or somebody else uses it.
    /// `quiet`: without progress.
    GroundBuilder(const Recipe& recipe, std::string folder, bool quiet);

    /// The terrain as a whole, for the choice of a view; with at most some two million samples. Returns the database's file.
    std::string overview();
    /// The terrain for the picture of the recipe's view. Returns the database's file. Throws Failure if no DEM has ground there.
    std::string ground(const osgGeoFX::PanoramaComposition& view);
    /// The database's file that ground() has left in a folder.
    static std::string groundIn(const std::string& folder);
    /// What was made coarser, and why, as sentences.
    const std::vector<std::string>& notes() const { return _notes; }

private:
    std::string build(const std::string& name, int factor, const std::vector<osg::Vec2d>& places);

    const Recipe& _recipe;
    const std::string _folder;
    std::optional<osgGeoFX::FolderLock> _lock;
    const bool _quiet;
    double _spacing = 0.0; ///< of the densest DEM, metres
    double _samples = 0.0; ///< of all DEMs
    std::vector<std::string> _notes;
};

} // namespace geofx::panorama
