// SPDX-License-Identifier: MIT
// SPDX-FileCopyrightText: 2026 the osgGeoFX authors
#pragma once

#include <osgGeoFX/mapping/ProjectiveMapping.h>

namespace osgGeoFX
{

/// How a mapping can be drawn beforehand.
enum class PageKind
{
    Page, ///< into pages: what it does depends on the place alone, and mixes a color with the scene's
    Base, ///< it changes the scene's own color alike everywhere; below all others, where it covers all that is seen
    Exact ///< not at all
};

PageKind pageKindOf(const ProjectiveMapping& mapping);

/// A mapping of the kind Base.
struct PageBase
{
    ColorTransfer::Matrix matrix{};
    double strength = 0.0;
    PlaneFootprint outline;
};

} // namespace osgGeoFX
