// SPDX-License-Identifier: MIT
// SPDX-FileCopyrightText: 2026 the osgGeoFX authors
#pragma once

#include <osgGeoFX/Export.h>

#include <filesystem>
#include <functional>
#include <map>
#include <string>
#include <vector>

namespace osgGeoFX
{

/** The files that a program reads, so that it replaces none of them. A program adds them all, and then claims each of its outputs, before
    it does anything else.

    Files are compared by device and inode, so links and other spellings of a path do not matter. Not thread-safe.
    @ingroup batch */
class OSGGEOFX_EXPORT InputFiles
{
public:
    /// The files from which a file takes its data. Names may be no files.
    using Sources = std::function<std::vector<std::string>(const std::string& file)>;

    /// `sources`: empty for none.
    explicit InputFiles(Sources sources = {}) : _sources(std::move(sources)) {}

    /** Adds what a name is read from: a file, a folder with all below it, FILE:LAYER, or GDAL's names with a file within
        (`NETCDF:"FILE":VARIABLE`, `/vsizip/FILE/INNER`). With a file come its sources and theirs; with a text that names other files, such
        as a scene, KML or SLD, those; and with a database's root file, its tiles. Names without a file add nothing. Nothing is looked up before an output is claimed
        that is there. */
    void add(const std::string& name) { _names.push_back(name); }

    /** Claims a file that is to be written. Throws WorkError if this would replace a file that is read, or one that was claimed before.
        `what`: what the file is, such as "The picture"; `option`: what names it, such as "-o". Both are for the sentence. */
    void claim(const std::string& what, const std::string& file, const std::string& option);

    /// Claims a folder that is to be replaced or removed, with all in it. Throws WorkError if a file that is read lies in it.
    void claimFolder(const std::string& what, const std::string& folder, const std::string& option);

private:
    struct Entry
    {
        std::string name; ///< as it was given
        bool written = false;
    };

    /// Looks up what was added. Where no output is there yet, nothing needs to be.
    void lookUp();
    void addName(const std::string& name);
    bool isNew(const std::string& file);
    void addFile(const std::string& file);
    void addDatabase(const std::filesystem::path& root);
    void addNamesIn(const std::filesystem::path& text);
    const Entry* find(const std::string& file) const;

    Sources _sources;
    std::vector<std::string> _names;             ///< those that are not looked up yet
    std::map<std::string, Entry> _files;         ///< by what identifies them
    std::map<std::string, std::string> _folders; ///< the same, and names
    std::vector<std::filesystem::path> _places;  ///< of all files that are read, complete
};

} // namespace osgGeoFX
