// SPDX-License-Identifier: MIT
// SPDX-FileCopyrightText: 2026 the osgGeoFX authors
#include <osgGeoFX/paging/ReadingFile.h>

#include <mutex>
#include <utility>

namespace osgGeoFX
{

namespace
{

struct Files
{
    std::mutex mutex;
    std::list<std::string> names; ///< in the order in which their reading began
};

/// Threads may read while the process ends.
Files& files()
{
    static Files& all = *new Files;
    return all;
}

std::list<std::string>::iterator entryOf(std::string file)
{
    const std::lock_guard<std::mutex> lock(files().mutex);
    return files().names.insert(files().names.end(), std::move(file));
}

} // namespace

ReadingFile::ReadingFile(std::string file) : _entry(entryOf(std::move(file))) {}

ReadingFile::~ReadingFile()
{
    const std::lock_guard<std::mutex> lock(files().mutex);
    files().names.erase(_entry);
}

std::string ReadingFile::longest()
{
    const std::lock_guard<std::mutex> lock(files().mutex);
    return files().names.empty() ? std::string() : files().names.front();
}

} // namespace osgGeoFX
