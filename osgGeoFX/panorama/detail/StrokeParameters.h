// SPDX-License-Identifier: MIT
// SPDX-FileCopyrightText: 2026 the osgGeoFX authors
#pragma once

#include <osgGeoFX/panorama/StrokeLines.h>

#include <osg/ref_ptr>

#include <cstdint>
#include <tuple>

namespace osgGeoFX
{

/** Where the brush strokes of a panorama map stand; Section 3.3 of Brown and Samavati (2017). A plain value. */
struct StrokeParameters
{
    double spacing = 25.0;          ///< step of the lattice, metres, > 0
    double referenceLatitude = 0.0; ///< radians, within ±1.5: where the lattice of a globe is as wide as high
    double jitter = 0.2;        ///< of a stroke from its place in its row, in spacings of its level, 0…1
    double cliffSlope = 1.2;    ///< rise over run above which ground is cliff, > 0
    double treeLine = 2000.0;   ///< metres; for terrain that says nothing of its cover
    unsigned int coverUnit = 7; ///< texture unit of the tiles' cover
    std::uint32_t seed = 0;     ///< another one gives other strokes
    double strokesAlongTile =
        128.0; ///< most lattice points along a tile's edge, ≥ 1: coarser tiles leave finer ones out
    osg::ref_ptr<const StrokeLines> lines; ///< roads, rivers and towns in the terrain's units; null: none

    friend bool operator==(const StrokeParameters& a, const StrokeParameters& b)
    {
        const auto tie = [](const StrokeParameters& p)
        {
            return std::tie(p.spacing, p.referenceLatitude, p.jitter, p.cliffSlope, p.treeLine, p.coverUnit,
                            p.seed, p.strokesAlongTile, p.lines);
        };
        return tie(a) == tie(b);
    }
    friend bool operator!=(const StrokeParameters& a, const StrokeParameters& b) { return !(a == b); }
};

} // namespace osgGeoFX
