// SPDX-License-Identifier: MIT
// SPDX-FileCopyrightText: 2026 the osgGeoFX authors
#pragma once

#include <cstdint>
#include <filesystem>
#include <string>

namespace osgGeoFX
{

class BuildPlan;

/// The file of a database's folder that says what it was built from.
constexpr const char* ORIGIN_FILE = "built-from.txt";

/// Where a build keeps its files while it goes on, in the database's folder.
std::filesystem::path workFolderOf(const std::filesystem::path& database);

/// Empties or adopts the output folder. Returns true if a finished database of the same build lies there. Throws
/// BuildError.
bool prepareFolder(const BuildPlan& plan);

/// Removes the work files, and the temporary files of processes that were killed. What cannot be removed does no harm.
void removeLeftovers(const BuildPlan& plan);

/// The size of all files in a folder.
std::uint64_t bytesBelow(const std::string& folder);

} // namespace osgGeoFX
