// SPDX-License-Identifier: MIT
// SPDX-FileCopyrightText: 2026 the osgGeoFX authors
#include <osgGeoFX/town/detail/ContactShade.h>

#include <osgGeoFX/town/detail/BuildingMesh.h>
#include <osgGeoFX/town/detail/Openness.h>
#include <osgGeoFX/town/detail/TownGeometry.h>

#include <algorithm>
#include <cmath>

namespace osgGeoFX
{

namespace
{

/// A wall is asked for so far before it, metres.
constexpr double BEFORE = 0.05;
/// And so far from its ends, as a share of its length and in metres: half of a corner's surroundings are open.
constexpr double INWARD = 0.25, MOST_INWARD = 3.0;
/// The most from a corner to the ring's end, in its widths.
constexpr double LONGEST = 1.5;
/// Of a side, that a ring may take at a corner which turns inward.
constexpr double ROOM = 0.45;
constexpr double LEAST_SIDE = 0.05; ///< metres
/// What does not show as much as the wall's foot may be off by so many grains.
constexpr double COARSER = 4.0;

double cross(const osg::Vec2d& a, const osg::Vec2d& b)
{
    return a.x() * b.y() - a.y() * b.x();
}

/// A number that is off by so much at most.
double multipleOf(double grain, double value)
{
    return std::round(value / (2.0 * grain)) * (2.0 * grain);
}

} // namespace

/// A side of a ring.
struct ContactShade::Side
{
    osg::Vec2d start, along, outward;
    double length = 0.0;
    std::vector<double> shares; ///< at the wall, at each station along it
    /// How far from the wall the ring may end a metre from its ends along it: corners that turn inward halve their angle.
    double room = HUGE_VAL, endRoom = HUGE_VAL;

    double spacing() const { return length / static_cast<double>(shares.size() - 1); }
};

/// The vertices at a corner: at the wall, and at the ring's end.
struct ContactShade::Corner
{
    unsigned int inner, outer;
};

double ContactShade::width(const PlacedBuilding& building)
{
    return std::clamp(0.5 * (meanTop(building) - building.reference.z()) + 2.0, 3.0, 12.0);
}

unsigned int ContactShade::vertex(const osg::Vec2d& place, double share, double grain)
{
    const osg::Vec2d at(multipleOf(grain, place.x()), multipleOf(grain, place.y()));
    _places.emplace_back(osg::Vec3d(at, multipleOf(COARSER * _fineness.grain, _ground(at, _base))));
    const auto opacity = static_cast<unsigned char>(std::lround(255.0 * std::clamp(share, 0.0, 1.0)));
    _colors.emplace_back(0, 0, 0, opacity);
    return static_cast<unsigned int>(_places.size() - 1);
}

unsigned int ContactShade::atWall(const osg::Vec2d& place, double share)
{
    return vertex(place, share, _fineness.grain);
}

unsigned int ContactShade::atEnd(const osg::Vec2d& place)
{
    return vertex(place, 0.0, COARSER * _fineness.grain);
}

void ContactShade::addTriangle(unsigned int a, unsigned int b, unsigned int c)
{
    _triangles.insert(_triangles.end(), {a, b, c});
}

double ContactShade::shareAt(const osg::Vec2d& place) const
{
    double open = 1.0;
    const double ground = _ground(place, _base);
    _own->at(place, osg::Vec3d(0.0, 0.0, 1.0), ground, &ground, &open, 1);
    return Openness::darkening * (1.0 - open);
}

std::vector<ContactShade::Side> ContactShade::sidesOf(const Ring& ring) const
{
    std::vector<Side> sides;
    for (std::size_t i = 0; i < ring.size(); ++i)
    {
        Side side;
        // What is too short goes with the next side.
        side.start = sides.empty() ? ring[i] : sides.back().start + sides.back().along * sides.back().length;
        const osg::Vec2d way = ring[(i + 1) % ring.size()] - side.start;
        side.length = way.length();
        if (side.length < LEAST_SIDE) continue;
        side.along = way / side.length;
        side.outward.set(side.along.y(), -side.along.x());
        const int pieces = std::clamp(static_cast<int>(std::ceil(side.length / _fineness.step)), 1, 1000);
        const double inward = pieces > 1 ? std::min(INWARD * side.length, MOST_INWARD) : 0.5 * side.length;
        for (int k = 0; k <= pieces; ++k)
        {
            const double along = std::clamp(side.length * k / pieces, inward, side.length - inward);
            // Both ends of a short side are alike.
            side.shares.push_back(pieces == 1 && k == 1
                                      ? side.shares.front()
                                      : shareAt(side.start + side.along * along + side.outward * BEFORE));
        }
        sides.push_back(std::move(side));
    }
    return sides;
}

ContactShade::Corner ContactShade::cornerOf(Side& before, Side& after)
{
    // The rings of both sides meet on the line that halves the angle.
    const double cosine = before.along * after.along, sine = cross(before.along, after.along);
    const double half = std::max(1.0 + cosine, 1e-3);
    osg::Vec2d way = (before.outward + after.outward) / half;
    double length = way.length() * _width;
    // Where the outline turns inward, they must not meet again; where it turns outward, a point would be long.
    if (sine < 0.0)
    {
        before.endRoom = after.room = half / -sine;
        const double most =
            ROOM * std::min({before.length, after.length, 2.0 * before.spacing(), 2.0 * after.spacing()});
        length = std::min(length, way.length() * most * after.room);
    }
    else
        length = std::min(length, LONGEST * _width);
    // A side may go back where it came from.
    if (way.normalize() < 1e-9) way = before.along;
    const unsigned int inner = atWall(after.start, 0.5 * (before.shares.back() + after.shares.front()));
    return {inner, atEnd(after.start + way * length)};
}

void ContactShade::addRing(const Ring& ring)
{
    std::vector<Side> sides = sidesOf(ring);
    if (sides.size() < 3) return;
    std::vector<Corner> corners;
    for (std::size_t i = 0; i < sides.size(); ++i)
        corners.push_back(cornerOf(sides[(i + sides.size() - 1) % sides.size()], sides[i]));
    for (std::size_t i = 0; i < sides.size(); ++i)
    {
        const Side& side = sides[i];
        const Corner& end = corners[(i + 1) % sides.size()];
        unsigned int inner = corners[i].inner, outer = corners[i].outer;
        const std::size_t pieces = side.shares.size() - 1;
        for (std::size_t k = 1; k <= pieces; ++k)
        {
            const double along = static_cast<double>(k) * side.spacing();
            const double away = std::min({_width, along * side.room, (side.length - along) * side.endRoom});
            const osg::Vec2d wall = side.start + side.along * along;
            const bool last = k == pieces;
            const unsigned int nextInner = last ? end.inner : atWall(wall, side.shares[k]),
                               nextOuter = last ? end.outer : atEnd(wall + side.outward * away);
            addTriangle(inner, outer, nextOuter);
            addTriangle(inner, nextOuter, nextInner);
            inner = nextInner;
            outer = nextOuter;
        }
    }
}

void ContactShade::add(const PlacedBuilding& building)
{
    if (building.rings.empty() || building.rings.front().size() < 3) return;
    Openness own;
    own.add(building);
    _own = &own;
    _base = building.reference.z();
    _width = width(building);
    for (const Ring& ring : building.rings)
        addRing(ring);
    _own = nullptr;
}

osg::ref_ptr<osg::Geometry> ContactShade::create(osg::StateSet* state) const
{
    if (_triangles.empty()) return nullptr;
    osg::ref_ptr<osg::Geometry> geometry = TownGeometry::create(_places, _colors, _triangles);
    geometry->setStateSet(state);
    return geometry;
}

} // namespace osgGeoFX
