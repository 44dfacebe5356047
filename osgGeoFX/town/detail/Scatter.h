// SPDX-License-Identifier: MIT
// SPDX-FileCopyrightText: 2026 the osgGeoFX authors
#pragma once

#include <cstdint>

namespace osgGeoFX
{

/// A number that looks random, 0 to 1, of the bits of what it belongs to.
inline double scatter(std::uint32_t bits)
{
    bits ^= bits >> 16;
    bits *= 0x7feb352du;
    bits ^= bits >> 15;
    bits *= 0x846ca68bu;
    bits ^= bits >> 16;
    return static_cast<double>(bits) / 4294967295.0;
}

} // namespace osgGeoFX
