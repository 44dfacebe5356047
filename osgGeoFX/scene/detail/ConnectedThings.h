// SPDX-License-Identifier: MIT
// SPDX-FileCopyrightText: 2026 the osgGeoFX authors
#pragma once

#include <osg/Vec3d>

#include <cstddef>
#include <cstdint>
#include <unordered_map>
#include <vector>

namespace osgGeoFX
{

/// Finds which corners of triangles belong to one thing: those that triangles join, and those that lie in one place.
class ConnectedThings
{
public:
    static constexpr double tolerance = 0.01; ///< metres: corners that are closer are one

    /// A number for a place. Places that are close have the same one.
    unsigned int corner(const osg::Vec3d& place);
    void join(unsigned int a, unsigned int b);
    /// The thing that a corner belongs to, called by one of its corners.
    unsigned int thing(unsigned int corner);

    const std::vector<osg::Vec3d>& places() const { return _places; }

private:
    struct Cell
    {
        std::int64_t x, y, z;
        bool operator==(const Cell& other) const { return x == other.x && y == other.y && z == other.z; }
    };
    struct Hash
    {
        std::size_t operator()(const Cell& cell) const;
    };

    std::unordered_multimap<Cell, unsigned int, Hash> _cells;
    std::vector<osg::Vec3d> _places;
    std::vector<unsigned int> _parents;
};

} // namespace osgGeoFX
