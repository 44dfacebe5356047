// SPDX-License-Identifier: MIT
// SPDX-FileCopyrightText: 2026 the osgGeoFX authors
//
// FlightGear's scenery by SimGear's own loader: materials, objects, trees.
#pragma once

#include <osg/Group>
#include <osg/ref_ptr>

#include <memory>
#include <string>
#include <utility>
#include <vector>

namespace flightgear
{

struct Place
{
    double longitude = 0.0, latitude = 0.0; ///< degrees
};

/** SimGear, set up for FlightGear's data, and its cull visitor in the place of OSG's. One at a time. It outlives all that
    it loads. Throws std::runtime_error with a sentence. */
class Scenery
{
public:
    /// `root`: FlightGear's data folder. `properties`: settings of its property tree, "/sim/rendering/..." and a value.
    Scenery(const std::string& root, const std::vector<std::pair<std::string, std::string>>& properties);
    ~Scenery();
    Scenery(const Scenery&) = delete;
    Scenery& operator=(const Scenery&) = delete;

    /// The tiles within a radius (metres) of a place, below a geocentric osg::CoordinateSystemNode, with the sun and what
    /// SimGear's shaders expect. What stands on the tiles is paged.
    osg::ref_ptr<osg::Group> load(const Place& place, double radius) const;

private:
    struct Parts;
    std::unique_ptr<Parts> _parts;
};

} // namespace flightgear
