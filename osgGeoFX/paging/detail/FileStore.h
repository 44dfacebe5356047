// SPDX-License-Identifier: MIT
// SPDX-FileCopyrightText: 2026 the osgGeoFX authors
#pragma once

#include <filesystem>
#include <string>

namespace osgGeoFX
{

/// The files of a cache on the disk. Several threads and programs may use one.
class FileStore
{
public:
    static bool has(const std::string& file);
    /// Empty if it cannot be read.
    static std::string read(const std::string& file);
    /// Writes a file under another name and renames it, so that nobody reads a half of it. What went wrong; empty as a rule.
    static std::string write(const std::string& file, const std::string& bytes);
    static void remove(const std::string& file);
    /// Removes the .osgb files in a folder and below.
    static void removeTiles(const std::filesystem::path& folder);
};

} // namespace osgGeoFX
