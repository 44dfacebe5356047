// SPDX-License-Identifier: MIT
// SPDX-FileCopyrightText: 2026 the osgGeoFX authors
#include <osgGeoFX/paging/detail/FileStamp.h>

#include <sys/stat.h>

namespace osgGeoFX
{

FileStamp FileStamp::of(const std::string& path)
{
    FileStamp stamp;
    struct stat entry;
    if (path.empty() || stat(path.c_str(), &entry) != 0) return stamp;
    // A copy that keeps the time of its original has another time of entry.
    stamp._values = {static_cast<std::int64_t>(entry.st_dev),
                     static_cast<std::int64_t>(entry.st_ino),
                     static_cast<std::int64_t>(entry.st_size),
                     entry.st_mtim.tv_sec,
                     entry.st_mtim.tv_nsec,
                     entry.st_ctim.tv_sec,
                     entry.st_ctim.tv_nsec};
    return stamp;
}

} // namespace osgGeoFX
