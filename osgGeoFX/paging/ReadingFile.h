// SPDX-License-Identifier: MIT
// SPDX-FileCopyrightText: 2026 the osgGeoFX authors
#pragma once

#include <osgGeoFX/Export.h>

#include <list>
#include <string>

namespace osgGeoFX
{

/** While an object lives, a raster or a file of vector data counts as being read. GDAL's readers cannot be stopped, and some files keep
    them busy for hours; so a program that must end a wait ends itself, and tells which file it was. Thread-safe.
    @ingroup paging */
class OSGGEOFX_EXPORT ReadingFile
{
public:
    explicit ReadingFile(std::string file);
    ~ReadingFile();
    ReadingFile(const ReadingFile&) = delete;
    ReadingFile& operator=(const ReadingFile&) = delete;

    /// The file, of all threads', that has been read for longest; empty if none is being read.
    static std::string longest();

private:
    const std::list<std::string>::iterator _entry;
};

} // namespace osgGeoFX
