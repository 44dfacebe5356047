// SPDX-License-Identifier: MIT
// SPDX-FileCopyrightText: 2026 the osgGeoFX authors
#pragma once

#include <osgGeoFX/batch/InputFiles.h>
#include <osgGeoFX/panorama/PanoramaComposer.h>

#include <map>
#include <stdexcept>
#include <string>
#include <vector>

namespace geofx::panorama
{

/// One sentence for the person at the keyboard.
struct Failure : public std::runtime_error
{
    using std::runtime_error::runtime_error;
};

/// The ready palette that is no season's.
constexpr const char* colorBlind = "colorblind";

/** All that a panorama map is made of: the sources, and each choice. The same recipe makes the same picture, to the
    byte, on the same machine. As a file it is JSON; its paths are relative to the file's folder where they can be. */
struct Recipe
{
    std::vector<std::string> dems; ///< or
    std::string terrain;           ///< a file that OpenSceneGraph reads, in their place
    bool geocentric = true; ///< whether places are longitude and latitude, or the terrain's own x and y
    std::string landCover, landCoverTable, treeCover;
    std::string vertical = "none"; ///< as osggeofx_build's --vertical
    bool allHeights = false;       ///< as osggeofx_build's --all-heights
    std::string palette;           ///< an image, or `colorBlind`; empty for the season's own
    int width = 1600, height = 900;
    double dpi = 0.0;         ///< pixels for each inch of a print; 0: none
    unsigned int samples = 4; ///< for each pixel
    osgGeoFX::PanoramaComposition view;
    bool island = false; ///< whether the sea goes on beyond the data
    /// The map's properties that are not their defaults, by name, in text form.
    std::map<std::string, std::string> map;
    std::vector<std::string> labels;  ///< files with names, or FILE:LAYER
    std::vector<std::string> lines;   ///< files with lines, or FILE:LAYER
    std::string labelStyle;           ///< a style file; empty for the usual styles
    std::string labelField;           ///< the field of the names; empty for the usual ones
    std::string font;                 ///< a font's file or families; empty for the styles'
    std::vector<std::string> reasons; ///< for people; not read
    /// The properties of each liberty (RegionalLiberty) that are not their defaults, as those of the map. They come before it.
    std::vector<std::map<std::string, std::string>> liberties;

    /// Whether a file is a recipe, by its name.
    static bool isRecipe(const std::string& file);
    /// Whether there is a recipe of any version in a file.
    static bool isIn(const std::string& file);
    /// Whether it is a terrain or a scene of OpenSceneGraph's, by its name.
    static bool isTerrain(const std::string& file);
    static Recipe read(const std::string& file); ///< throws Failure
    void write(const std::string& file) const;   ///< a whole file or none; throws Failure
    /// Adds the files that it names.
    void addInputs(osgGeoFX::InputFiles& inputs) const;
    /// What read() needs, as a file in the current folder would have it.
    std::string text() const;
};

} // namespace geofx::panorama
