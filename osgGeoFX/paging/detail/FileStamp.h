// SPDX-License-Identifier: MIT
// SPDX-FileCopyrightText: 2026 the osgGeoFX authors
#pragma once

#include <array>
#include <cstdint>
#include <string>

namespace osgGeoFX
{

/// Tells whether a file has changed, or another one has its name.
class FileStamp
{
public:
    /// The stamp of a path where there is no file is that of no file.
    static FileStamp of(const std::string& path);

    bool operator==(const FileStamp& other) const { return _values == other._values; }

private:
    std::array<std::int64_t, 7> _values{}; ///< device, number, size, times of its content and of its entry
};

} // namespace osgGeoFX
