// SPDX-License-Identifier: MIT
// SPDX-FileCopyrightText: 2026 the osgGeoFX authors
#pragma once

#include <cstdint>
#include <filesystem>

namespace geofx::bench
{

/// A folder of its own for a suite's files, which are gone when the object is.
class WorkFolder
{
public:
    /// Throws BenchError where none can be made.
    explicit WorkFolder(const std::filesystem::path& parent);
    ~WorkFolder();
    WorkFolder(const WorkFolder&) = delete;
    WorkFolder& operator=(const WorkFolder&) = delete;

    const std::filesystem::path& path() const { return _path; }

private:
    std::filesystem::path _path;
};

/// Throws BenchError where a folder's disk has less room than that.
void requireSpace(const std::filesystem::path& folder, std::uint64_t bytes);

/// Sizes of all files at and below a folder.
std::uint64_t bytesBelow(const std::filesystem::path& folder);

} // namespace geofx::bench
