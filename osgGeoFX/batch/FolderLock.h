// SPDX-License-Identifier: MIT
// SPDX-FileCopyrightText: 2026 the osgGeoFX authors
#pragma once

#include <osgGeoFX/Export.h>

#include <string>

namespace osgGeoFX
{

/** Keeps others who lock it out of a folder while it lives: threads and processes of this machine. The system lets go of it when a process
    ends, however it ends, and nothing is written into the folder.

    Where the file system has no such locks, as some of networks, one warning for each folder says so, and nobody is kept out. Any thread may
    make one.
    @ingroup batch */
class OSGGEOFX_EXPORT FolderLock
{
public:
    enum Kind
    {
        ALONE,   ///< keeps everybody out
        TOGETHER ///< keeps those out who must be alone
    };

    /// Throws WorkError if the folder is locked by somebody else in a way that excludes this one. A folder that is not there is not locked. `option`: what names
    /// another folder, such as "-o", for the sentence.
    FolderLock(const std::string& folder, Kind kind, const std::string& option);
    ~FolderLock();
    FolderLock(const FolderLock&) = delete;
    FolderLock& operator=(const FolderLock&) = delete;

private:
    int _descriptor;
};

} // namespace osgGeoFX
