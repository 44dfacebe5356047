// SPDX-License-Identifier: MIT
// SPDX-FileCopyrightText: 2026 the osgGeoFX authors
#pragma once

#include <optional>
#include <string>

namespace osgGeoFX
{

/// Where a KML file's pictures and links may lie: the folder of the file that was opened first, or its KMZ.
class KmlFolder
{
public:
    /// Throws BuildError where `file` is a KMZ without a KML file.
    KmlFolder(const std::string& file, bool allowOutside);

    /// The KML text to begin with, as GDAL opens it.
    const std::string& document() const { return _document; }
    /// What a document's `href` means, as GDAL opens it; nothing if it leads out of the folder. Letters of another case and back slashes count where
    /// no file is called exactly so.
    std::optional<std::string> resolve(const std::string& document, const std::string& href) const;
    /// For sentences: a path as a person knows it.
    static std::string plain(const std::string& path);
    /// The file or archive on disk that holds what GDAL calls so; empty if there is none.
    static std::string onDisk(const std::string& path);

private:
    bool isWithin(const std::string& path) const;

    std::string _root;
    std::string _document;
    bool _allowOutside;
};

/// The KML text in a KMZ file, as GDAL opens it: of those in the outermost folder that has one `doc.kml`, else the first. Empty if there is none.
std::string documentOfKmz(const std::string& file);

} // namespace osgGeoFX
