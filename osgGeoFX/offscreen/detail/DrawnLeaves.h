// SPDX-License-Identifier: MIT
// SPDX-FileCopyrightText: 2026 the osgGeoFX authors
#pragma once

#include <osgUtil/RenderStage>

#include <cstdint>

namespace osgGeoFX
{

/// Counts of what a culled render stage, with the stages before and after it, is about to draw.
struct DrawnLeaves
{
    std::uint64_t triangles = 0;
    std::uint64_t drawables = 0;
    std::uint64_t tiles = 0; ///< distinct tiles of a terrain database

    static DrawnLeaves count(const osgUtil::RenderStage& stage);
};

} // namespace osgGeoFX
