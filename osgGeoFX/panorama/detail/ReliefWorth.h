// SPDX-License-Identifier: MIT
// SPDX-FileCopyrightText: 2026 the osgGeoFX authors
#pragma once

#include <osgGeoFX/panorama/TerrainRelief.h>

#include <vector>

namespace osgGeoFX
{

/// A summit of a relief.
struct ReliefSummit
{
    osg::Vec2d place; ///< in the relief's units
    double height;    ///< metres
    double weight;    ///< its prominence over that of the most prominent one, 0…1
};

/// What is worth seeing of a terrain.
struct ReliefWorth
{
    explicit ReliefWorth(const TerrainRelief& relief);

    std::vector<float> worth; ///< of each cell, 0…1
    /// How far each cell is from the end of the data, metres; 0 where there is no ground. Sea goes on beyond the extent.
    std::vector<float> inside;
    std::vector<ReliefSummit> summits; ///< the most prominent first
    double lowest = 0.0;               ///< metres
    double highest = 0.0;              ///< metres
    double steep = 0.0; ///< rise over run from one cell to the next; nine tenths of the land is less steep
    double total = 0.0; ///< sum of worth over all cells
};

} // namespace osgGeoFX
