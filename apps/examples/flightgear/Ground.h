// SPDX-License-Identifier: MIT
// SPDX-FileCopyrightText: 2026 the osgGeoFX authors
//
// What the kit is told of SimGear's terrain: its materials, its heights, and triangles that are small enough to bend.
#pragma once

#include "Drawing.h"

#include <osgGeoFX/panorama/MaterialCover.h>
#include <osgGeoFX/scene/MeshRefiner.h>
#include <osgGeoFX/viewer/Scene.h>

#include <set>
#include <string>
#include <vector>

namespace flightgear
{

/** Tells a scene what it needs to know of SimGear's terrain. It lives as long as the scene is drawn, for a pager tells
    it of the tiles that it reads. */
class Ground
{
public:
    /// The texture unit of the covers; PanoramaMap::coverUnit. FlightGear's shaders read unit 7, the kit's own.
    static constexpr unsigned int coverUnit = 31;

    /// Gives the terrain covers by its materials, and tells the scene how high it is. Objects keep their look in panorama
    /// maps. `covers`: of materials, "NAME,TREES,TOWN,BARE", in the place of what the legend has. Call it before the
    /// scene is drawn. Throws std::runtime_error with a sentence.
    Ground(const osgGeoFX::Scene& scene, const std::vector<std::string>& covers);

    /// How long edges may be for the effects that the scene has now, metres. `distance`: how near cameras come to the
    /// ground, metres.
    double longestEdge(const Frame& frame, double distance) const;
    /// Splits longer edges, and those of what is read from now on; nothing for HUGE_VAL.
    void refine(double longestEdge);

    /// The highest ground, metres.
    double highest() const { return _highest; }
    /// Materials that the legend does not know.
    std::set<std::string> unknownMaterials() const { return _cover->unknownMaterials(); }

private:
    const osgGeoFX::Scene& _scene;
    osg::ref_ptr<osgGeoFX::MaterialCover> _cover;
    osg::ref_ptr<osgGeoFX::MeshRefiner> _refiner;
    double _highest = 0.0;
};

} // namespace flightgear
