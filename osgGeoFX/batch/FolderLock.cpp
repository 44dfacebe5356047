// SPDX-License-Identifier: MIT
// SPDX-FileCopyrightText: 2026 the osgGeoFX authors
#include <osgGeoFX/batch/FolderLock.h>

#include <osgGeoFX/batch/WorkError.h>

#include <osg/Notify>

#include <sys/file.h>
#include <unistd.h>

#include <cerrno>
#include <cstring>
#include <fcntl.h>
#include <mutex>
#include <set>

namespace osgGeoFX
{

namespace
{

void warnOnce(const std::string& folder, int error)
{
    static std::mutex mutex;
    static std::set<std::string> warned;
    const std::lock_guard<std::mutex> lock(mutex);
    if (!warned.insert(folder).second) return;
    OSG_WARN << "osgGeoFX: " << folder << ": its file system has no locks (" << std::strerror(error)
             << "); see to it that no second program works in this folder." << std::endl;
}

} // namespace

FolderLock::FolderLock(const std::string& folder, Kind kind, const std::string& option)
    : _descriptor(open(folder.c_str(), O_RDONLY | O_DIRECTORY | O_CLOEXEC))
{
    // Whoever needs the folder says what is wrong with it.
    if (_descriptor < 0) return;
    int result = 0;
    do
        result = flock(_descriptor, (kind == ALONE ? LOCK_EX : LOCK_SH) | LOCK_NB);
    while (result != 0 && errno == EINTR);
    if (result == 0) return;
    const int error = errno;
    close(_descriptor);
    _descriptor = -1;
    if (error == EWOULDBLOCK)
        throw WorkError(folder +
                        ": another process is at work in this folder; wait until it has ended, or "
                        "choose another " +
                        option + ".");
    warnOnce(folder, error);
}

FolderLock::~FolderLock()
{
    if (_descriptor >= 0) close(_descriptor);
}

} // namespace osgGeoFX
