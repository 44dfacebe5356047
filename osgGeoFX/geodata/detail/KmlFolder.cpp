// SPDX-License-Identifier: MIT
// SPDX-FileCopyrightText: 2026 the osgGeoFX authors
#include <osgGeoFX/geodata/detail/KmlFolder.h>

#include <osgGeoFX/geodata/BuildError.h>
#include <osgGeoFX/geodata/detail/GdalSupport.h>

#include <cpl_string.h>
#include <cpl_vsi.h>

#include <algorithm>
#include <cctype>
#include <filesystem>

namespace osgGeoFX
{

namespace
{

namespace fs = std::filesystem;

std::string extensionOf(const std::string& file)
{
    std::string extension = fs::path(file).extension().string();
    for (char& c : extension)
        c = static_cast<char>(std::tolower(static_cast<unsigned char>(c)));
    return extension;
}

bool isAddress(const std::string& path)
{
    return path.find("://") != std::string::npos;
}

/// What GDAL calls the inside of an archive. In braces, for the archive's name need not end with ".zip".
std::string insideOf(const std::string& archive)
{
    return "/vsizip/{" + archive + "}";
}

/// A file's text in an address, without %20 and the like.
std::string unescaped(const std::string& href)
{
    char* const text = CPLUnescapeString(href.c_str(), nullptr, CPLES_URL);
    std::string result = text ? text : "";
    CPLFree(text);
    return result;
}

bool startsWith(const std::string& text, const std::string& start)
{
    return text.compare(0, start.size(), start) == 0;
}

std::string lower(std::string text)
{
    std::transform(text.begin(), text.end(), text.begin(),
                   [](unsigned char c) { return static_cast<char>(std::tolower(c)); });
    return text;
}

/// A path of which nothing is there as it is written: as a file or folder is called there, in letters of another case or with back slashes; unchanged
/// if there is none.
std::string asItIsCalled(const std::string& path)
{
    VSIStatBufL status;
    const fs::path whole(path);
    if (VSIStatL(path.c_str(), &status) == 0 || !whole.has_parent_path() || whole.parent_path() == whole)
        return path;
    const std::string archive = "/vsizip/{";
    // Archives of Windows may have entries with back slashes, which are no folders.
    const bool isInArchive = startsWith(path, archive);
    const std::string root = isInArchive ? path.substr(0, path.find('}') + 1) : std::string();
    const std::string folder = isInArchive ? root : asItIsCalled(whole.parent_path().string());
    const std::string name =
        lower(isInArchive ? path.substr(std::min(path.size(), root.size() + 1)) : whole.filename().string());
    const CPLStringList names(isInArchive ? VSIReadDirRecursive(folder.c_str()) : VSIReadDir(folder.c_str()));
    for (int i = 0; i < names.size(); ++i)
    {
        std::string each = lower(names[i]);
        std::replace(each.begin(), each.end(), '\\', '/');
        if (each == name) return folder + "/" + names[i];
    }
    return path;
}

} // namespace

std::string documentOfKmz(const std::string& file)
{
    if (!faultOfArchive(file).empty()) return {};
    const GdalErrorScope errors;
    const CPLStringList names(VSIReadDirRecursive(insideOf(file).c_str()));
    std::string best;
    const auto rank = [](const std::string& name)
    {
        return 2 * std::count(name.begin(), name.end(), '/') +
               (fs::path(name).filename() == "doc.kml" ? 0 : 1);
    };
    for (int i = 0; i < names.size(); ++i)
        if (extensionOf(names[i]) == ".kml" && (best.empty() || rank(names[i]) < rank(best))) best = names[i];
    return best.empty() ? std::string() : insideOf(file) + "/" + best;
}

KmlFolder::KmlFolder(const std::string& file, bool allowOutside) : _allowOutside(allowOutside)
{
    std::error_code fault;
    const std::string real = fs::weakly_canonical(file, fault).string();
    if (!fs::is_regular_file(real, fault))
        throw BuildError(file + ": the file does not exist; correct its name.");
    if (extensionOf(file) == ".kmz")
    {
        const std::string packed = faultOfArchive(real);
        if (!packed.empty()) throw BuildError(file + ": " + packed + ".");
        _root = insideOf(real);
        _document = documentOfKmz(real);
        if (_document.empty())
            throw BuildError(file +
                             ": it is no KMZ file, or it holds no KML; check it with unzip -l, or save it "
                             "again.");
        return;
    }
    _root = fs::path(real).parent_path().string();
    _document = real;
}

bool KmlFolder::isWithin(const std::string& path) const
{
    const bool isInArchive = startsWith(_root, "/vsizip/");
    if (isInArchive) return startsWith(path, _root + "/");
    if (startsWith(path, "/vsizip/{"))
    {
        // A linked archive.
        const std::size_t end = path.find('}');
        return end != std::string::npos && isWithin(path.substr(9, end - 9));
    }
    if (startsWith(path, "/vsi")) return false;
    std::error_code fault;
    const fs::path real = fs::weakly_canonical(path, fault);
    const fs::path root(_root);
    return !fault && std::mismatch(root.begin(), root.end(), real.begin(), real.end()).first == root.end();
}

std::optional<std::string> KmlFolder::resolve(const std::string& document, const std::string& href) const
{
    if (isAddress(href) && !startsWith(href, "file://"))
    {
        if (!_allowOutside) return std::nullopt;
        return "/vsicurl/" + href;
    }
    std::string name = unescaped(startsWith(href, "file://") ? href.substr(7) : href);
    std::replace(name.begin(), name.end(), '\\', '/');
    if (name.empty() || name.find('\0') != std::string::npos) return std::nullopt;
    if (startsWith(name, "/vsi")) return _allowOutside ? std::optional(name) : std::nullopt;
    // Within an archive ".." is followed by the letters alone, so that no archive leads out of itself.
    std::string path = (fs::path(document).parent_path() / name).lexically_normal().string();
    if (_allowOutside || isWithin(path)) path = asItIsCalled(path);
    if (!_allowOutside && !isWithin(path)) return std::nullopt;
    // A linked archive stands for the text in it, and may lie within the folder as any file may.
    if (extensionOf(path) == ".kmz" && !startsWith(path, "/vsi")) path = documentOfKmz(path);
    return path;
}

std::string KmlFolder::onDisk(const std::string& path)
{
    const std::string archive = "/vsizip/{";
    if (startsWith(path, archive)) return path.substr(archive.size(), path.find('}') - archive.size());
    return startsWith(path, "/vsi") ? std::string() : path;
}

std::string KmlFolder::plain(const std::string& path)
{
    std::string text = path;
    for (const char* const start : {"/vsizip/{", "/vsicurl/"})
        if (startsWith(text, start)) text.erase(0, std::string(start).size());
    text.erase(std::remove(text.begin(), text.end(), '}'), text.end());
    return text;
}

} // namespace osgGeoFX
