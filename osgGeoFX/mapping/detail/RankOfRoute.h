// SPDX-License-Identifier: MIT
// SPDX-FileCopyrightText: 2026 the osgGeoFX authors
#pragma once

#include <cstddef>
#include <cstdint>

namespace osgGeoFX
{

/// The place of a route's mapping among those of its order: above all that are no route's, and those of a later route above. It
/// does not depend on what has been changed since, so a route that comes from a file lies where it lay.
struct RankOfRoute
{
    static constexpr unsigned int routeBits = 24, roleBits = 3, indexBits = 20;
    static constexpr std::uint64_t first = std::uint64_t{1} << (routeBits + roleBits + indexBits);

    static std::uint64_t of(std::uint64_t route, unsigned int role, std::size_t index)
    {
        return first | route << (roleBits + indexBits) | std::uint64_t{role} << indexBits | index;
    }
    static std::uint64_t routeOf(std::uint64_t rank)
    {
        return (rank & (first - 1)) >> (roleBits + indexBits);
    }
};

} // namespace osgGeoFX
