// SPDX-License-Identifier: MIT
// SPDX-FileCopyrightText: 2026 the osgGeoFX authors
#pragma once

#include <tools/RandomSamples.h>

#include <cstddef>
#include <vector>

namespace geofx::test
{

/// All cases of a test in ./tests/run --full, else each `step`-th one from `first`, since each takes seconds.
template<typename Case>
std::vector<Case> sampledCases(const std::vector<Case>& all, std::size_t step, std::size_t first = 0)
{
    if (fullTest()) return all;
    std::vector<Case> result;
    for (std::size_t i = first; i < all.size(); i += step)
        result.push_back(all[i]);
    return result;
}

} // namespace geofx::test
