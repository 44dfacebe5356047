// SPDX-License-Identifier: MIT
// SPDX-FileCopyrightText: 2026 the osgGeoFX authors
#pragma once

#include <osgGeoFX/batch/WorkStage.h>

namespace osgGeoFX
{

class BuildPlan;
struct TilePassResult;

using BuildStage = WorkStage;
using BuildStages = WorkStages;

/// Sampled heights, filled voids, and what upper tiers gather of them.
void addHeightStages(BuildPlan& plan, BuildStages& stages);
/// Finds and fills voids. They have nothing to do if no height is missing.
void addVoidStages(BuildPlan& plan, BuildStages& stages);
/// The rasters of shores.
void addGroundStages(BuildPlan& plan, BuildStages& stages);
/// The tiles' files. `result` gets the number of tiles that were taken over.
void addTileStages(BuildPlan& plan, BuildStages& stages, TilePassResult& result);
/// All stages of a build, in their order. The last one writes terrain.osgb.
BuildStages createStages(BuildPlan& plan, TilePassResult& result);

} // namespace osgGeoFX
