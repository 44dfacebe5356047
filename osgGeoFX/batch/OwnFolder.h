// SPDX-License-Identifier: MIT
// SPDX-FileCopyrightText: 2026 the osgGeoFX authors
#pragma once

#include <osgGeoFX/Export.h>

#include <string>

namespace osgGeoFX
{

/** Folders that a program makes, uses and removes as it likes. A file in each of them says so (`MARK`). Any number of processes may take
    one at once. Any thread may call all of it.
    @ingroup batch */
struct OSGGEOFX_EXPORT OwnFolder
{
    static constexpr const char* MARK = "osggeofx-work.txt";

    /// Throws WorkError if there is a folder, or a file, that is not the program's own and not empty. `option`: what names another folder,
    /// such as "--work", for the sentence.
    static void check(const std::string& folder, const std::string& option);

    /// Makes the folder and puts the file into it, or takes one that is there. Throws WorkError as check() does, and if it cannot be made.
    static void take(const std::string& folder, const std::string& option);

    /// Removes the folder with all in it, if it has the file; else nothing. The file goes last, so that what is left after a kill is still
    /// the program's own.
    static void remove(const std::string& folder);
};

} // namespace osgGeoFX
