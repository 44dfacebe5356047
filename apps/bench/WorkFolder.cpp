// SPDX-License-Identifier: MIT
// SPDX-FileCopyrightText: 2026 the osgGeoFX authors
#include "WorkFolder.h"

#include "BenchError.h"

#include <cstdlib>
#include <cstring>
#include <string>

namespace geofx::bench
{

WorkFolder::WorkFolder(const std::filesystem::path& parent)
{
    std::string pattern = (parent / "osggeofx_bench-XXXXXX").string();
    if (!mkdtemp(pattern.data()))
    {
        throw BenchError(parent.string() + ": no temporary folder can be made here (" + std::strerror(errno) +
                         "); name a folder that can be written with --work DIR.");
    }
    _path = pattern;
}

WorkFolder::~WorkFolder()
{
    std::error_code ignored;
    std::filesystem::remove_all(_path, ignored);
}

void requireSpace(const std::filesystem::path& folder, std::uint64_t bytes)
{
    constexpr std::uint64_t megabyte = 1000000;
    const std::uint64_t available = std::filesystem::space(folder).available;
    if (available < bytes)
    {
        throw BenchError(folder.parent_path().string() + ": " + std::to_string(bytes / megabyte) +
                         " MB are needed for a while and " + std::to_string(available / megabyte) +
                         " MB are free; make room, name another folder with --work DIR, or take --quick.");
    }
}

std::uint64_t bytesBelow(const std::filesystem::path& folder)
{
    std::uint64_t bytes = 0;
    for (const auto& entry : std::filesystem::recursive_directory_iterator(folder))
    {
        if (entry.is_regular_file()) bytes += entry.file_size();
    }
    return bytes;
}

} // namespace geofx::bench
