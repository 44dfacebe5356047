// SPDX-License-Identifier: MIT
// SPDX-FileCopyrightText: 2026 the osgGeoFX authors
#pragma once

#include <cstdint>

namespace osgGeoFX
{

/// Bits that look random, of the bits of what they belong to.
inline std::uint32_t scatteredBits(std::uint32_t bits)
{
    bits ^= bits >> 16;
    bits *= 0x7feb352du;
    bits ^= bits >> 15;
    bits *= 0x846ca68bu;
    return bits ^ (bits >> 16);
}

/// The same as a number from 0 to 1.
inline double scatter(std::uint32_t bits)
{
    return static_cast<double>(scatteredBits(bits)) / 4294967295.0;
}

} // namespace osgGeoFX
