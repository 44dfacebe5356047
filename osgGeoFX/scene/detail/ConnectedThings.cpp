// SPDX-License-Identifier: MIT
// SPDX-FileCopyrightText: 2026 the osgGeoFX authors
#include <osgGeoFX/scene/detail/ConnectedThings.h>

#include <cmath>

namespace osgGeoFX
{

std::size_t ConnectedThings::Hash::operator()(const Cell& cell) const
{
    const auto mix = [](std::uint64_t value)
    {
        value = (value ^ (value >> 31)) * 0x7fb5d329728ea185ull;
        return (value ^ (value >> 27)) * 0x81dadef4bc2dd44dull;
    };
    return static_cast<std::size_t>(
        mix(static_cast<std::uint64_t>(cell.x) +
            mix(static_cast<std::uint64_t>(cell.y) + mix(static_cast<std::uint64_t>(cell.z)))));
}

unsigned int ConnectedThings::corner(const osg::Vec3d& place)
{
    // Cells are wide enough that what is close lies in at most two along each axis.
    constexpr double side = 4.0 * tolerance;
    const auto cellOf = [](double coordinate)
    {
        return static_cast<std::int64_t>(std::floor(coordinate / side));
    };
    for (std::int64_t x = cellOf(place.x() - tolerance); x <= cellOf(place.x() + tolerance); ++x)
        for (std::int64_t y = cellOf(place.y() - tolerance); y <= cellOf(place.y() + tolerance); ++y)
            for (std::int64_t z = cellOf(place.z() - tolerance); z <= cellOf(place.z() + tolerance); ++z)
            {
                const auto [first, end] = _cells.equal_range({x, y, z});
                for (auto each = first; each != end; ++each)
                    if ((_places[each->second] - place).length2() < tolerance * tolerance)
                        return each->second;
            }
    const auto number = static_cast<unsigned int>(_places.size());
    _places.push_back(place);
    _parents.push_back(number);
    _cells.emplace(Cell{cellOf(place.x()), cellOf(place.y()), cellOf(place.z())}, number);
    return number;
}

void ConnectedThings::join(unsigned int a, unsigned int b)
{
    a = thing(a);
    b = thing(b);
    // The older one keeps its name, so the order of triangles does not matter.
    if (a < b) _parents[b] = a;
    if (b < a) _parents[a] = b;
}

unsigned int ConnectedThings::thing(unsigned int corner)
{
    while (_parents[corner] != corner)
    {
        _parents[corner] = _parents[_parents[corner]];
        corner = _parents[corner];
    }
    return corner;
}

} // namespace osgGeoFX
