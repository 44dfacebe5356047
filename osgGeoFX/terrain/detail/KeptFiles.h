// SPDX-License-Identifier: MIT
// SPDX-FileCopyrightText: 2026 the osgGeoFX authors
#pragma once

#include <osgGeoFX/terrain/detail/BuildPlan.h>
#include <osgGeoFX/terrain/detail/UnitRecord.h>

#include <filesystem>
#include <optional>
#include <string>

namespace osgGeoFX
{

/** What a former build has left for updates, in the folder `kept` of its database: work files of units that are small
    beside their tiles, and records of what they were made from. A unit that has not changed takes its former work files
    over, as second names of the same files. Thread-safe. */
class KeptFiles
{
public:
    explicit KeptFiles(const BuildPlan& plan) : _plan(plan) {}

    /// Why a plan's folder has nothing that an update could use, as a clause. Empty if it has.
    static std::string obstacle(const BuildPlan& plan);

    /// Whether the kept facts of a unit were made from what the key stands for.
    bool haveFacts(const char* pass, const Unit& unit, const Digest& key) const;
    std::optional<UnitRecord> record(const Unit& unit) const;
    /// Whether the former database has a group's file, as large as it was written.
    bool hasTiles(const UnitRecord::Group& group, const TileKey& parent) const;

    /// Makes a kept file a work file, too. Returns false if there is none. `name` is below both folders.
    bool take(const std::string& name) const;

private:
    const BuildPlan& _plan;
};

} // namespace osgGeoFX
