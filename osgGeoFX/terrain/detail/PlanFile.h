// SPDX-License-Identifier: MIT
// SPDX-FileCopyrightText: 2026 the osgGeoFX authors
#pragma once

#include <osgGeoFX/terrain/DatabaseBuilder.h>
#include <osgGeoFX/terrain/detail/BuildStage.h>

#include <cstdint>
#include <string>
#include <utility>
#include <vector>

namespace osgGeoFX
{

/// What plan.json says.
struct PlanFile
{
    /// The version that this code writes and reads.
    static constexpr int VERSION = 1;
    /// Where the plan of a database lies.
    static std::string file(const std::string& folder);

    BuildOptions options; ///< `output` is the folder that the plan was read from
    std::string fingerprint;

    /// Throws BuildError if there is no plan, or one that this version cannot read.
    static PlanFile read(const std::string& folder);
    /// Writes a plan into its folder.
    static void write(const BuildPlan& plan, const BuildStages& stages);

    /// Throws BuildError, with what has changed, if the plan does not hold for the sources of now.
    void compare(const BuildPlan& now) const;
};

} // namespace osgGeoFX
