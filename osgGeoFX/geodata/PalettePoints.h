// SPDX-License-Identifier: MIT
// SPDX-FileCopyrightText: 2026 the osgGeoFX authors
#pragma once

#include <osgGeoFX/Export.h>

#include <osg/Vec2d>

#include <optional>
#include <string>
#include <vector>

namespace osgGeoFX
{

/// A place of a painting where a class of the ground is seen (Figures 6 and 7 of Brown and Samavati, 2017).
/// @ingroup geodata
struct PalettePoint
{
    /// Row of the palette, 0…7.
    int row = 0;
    /// Pixels of the painting, from its upper left corner.
    osg::Vec2d place;
    /// The same place in the light map, in pixels from its upper left corner; without it, the light map shows the same
    /// view as the painting.
    std::optional<osg::Vec2d> lightPlace;
    /// How the light falls there, −1 (turned away) to 1 (facing); without it, the light map tells.
    std::optional<double> light;
};

/** Reads points from a CSV file with the columns class, x and y; and, where wanted, lightX and lightY, or light. Their
    order is free. A class is field, hill, cliff, snow, forest, trees, town or bare, or its row, 0…7. Cells of the
    columns that may be left out may be empty. Throws BuildError, with a sentence that names the file and the line.
    Thread-safe.
    @ingroup geodata */
OSGGEOFXDATA_EXPORT std::vector<PalettePoint> readPalettePoints(const std::string& file);

} // namespace osgGeoFX
