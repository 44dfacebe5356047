// SPDX-License-Identifier: MIT
// SPDX-FileCopyrightText: 2026 the osgGeoFX authors
#pragma once

#include <osgGeoFX/town/detail/Building.h>

#include <osg/Geometry>

#include <functional>
#include <vector>

namespace osgGeoFX
{

class Openness;

/** The shade that buildings throw on the ground around their feet, on a day without a sun: a ring around each outline, and one
    within each courtyard, that lies on the ground (GroundShade). Collects them into one geometry in a local frame, metres.

    At the wall the ground loses what Openness tells of a level place there with this building alone, as walls lose what it tells
    with all buildings; at width() it loses nothing. Rings of neighbors overlap, and each takes its share. Not thread-safe. */
class ContactShade
{
public:
    /// The height of the ground, in the frame, at a place; the second number where there is none.
    using Ground = std::function<double(const osg::Vec2d&, double)>;
    /// How fine rings are.
    struct Fineness
    {
        double step; ///< between vertices along an outline, metres, at most: the ground is not level
        /// So far may vertices at the wall be moved, metres; at the ring's end and up or down, four times as far. So files are small.
        double grain;
    };

    ContactShade(Ground ground, const Fineness& fineness) : _ground(std::move(ground)), _fineness(fineness) {}

    void add(const PlacedBuilding& building);
    /// All that was added, as one geometry with this state; null if nothing was.
    osg::ref_ptr<osg::Geometry> create(osg::StateSet* state) const;

    /// How far from a building's outline its shade ends, metres: more for a tall one.
    static double width(const PlacedBuilding& building);

private:
    struct Side;
    struct Corner;
    unsigned int atWall(const osg::Vec2d& place, double share);
    unsigned int atEnd(const osg::Vec2d& place);
    unsigned int vertex(const osg::Vec2d& place, double share, double grain);
    double shareAt(const osg::Vec2d& place) const;
    std::vector<Side> sidesOf(const Ring& ring) const;
    Corner cornerOf(Side& before, Side& after);
    void addRing(const Ring& ring);
    void addTriangle(unsigned int a, unsigned int b, unsigned int c);

    const Ground _ground;
    const Fineness _fineness;
    // Of the building that is being added.
    const Openness* _own = nullptr;
    double _base = 0.0, _width = 0.0;

    std::vector<osg::Vec3> _places;
    std::vector<osg::Vec4ub> _colors;
    std::vector<unsigned int> _triangles;
};

} // namespace osgGeoFX
