// SPDX-License-Identifier: MIT
// SPDX-FileCopyrightText: 2026 the osgGeoFX authors
#pragma once

#include <osgGeoFX/terrain/detail/BuildPlan.h>

namespace osgGeoFX
{

/** Which rasters a unit samples. A digest has the identities of all that reach into its rectangle, with a margin for the
    kernels of sampling, and of others that what is sampled depends on. If it is the same as before, so are the samples.
    If not, they may still be. */

/// The elevation, and the voids that are filled there once the plan knows them. It also has what the facts of a unit's
/// leaves depend on: whether they lie beside denser ones.
Digest heightsKey(const BuildPlan& plan, const Unit& unit);
/// Colors, classes and what lies on the ground, without shores. If heights give the colors, they have the range of heights,
/// but not the elevation itself.
Digest surfaceSources(const BuildPlan& plan, const Unit& unit);

} // namespace osgGeoFX
