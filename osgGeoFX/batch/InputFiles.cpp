// SPDX-License-Identifier: MIT
// SPDX-FileCopyrightText: 2026 the osgGeoFX authors
#include <osgGeoFX/batch/InputFiles.h>

#include <osgGeoFX/batch/WorkError.h>

#include <sys/stat.h>

#include <algorithm>
#include <cctype>
#include <fstream>
#include <iterator>
#include <set>
#include <system_error>

namespace osgGeoFX
{

namespace
{

namespace fs = std::filesystem;

/// Texts beyond this are data, and names in them no names of files.
constexpr std::uintmax_t LARGEST_TEXT = 16u << 20u;
constexpr std::size_t LONGEST_NAME = 1024;

std::string inode(const struct stat& status)
{
    return std::to_string(status.st_dev) + ":" + std::to_string(status.st_ino);
}

/// The same for two names of one file: device and inode; for a file that is not there, those of its folder, and its name.
std::string keyOf(const fs::path& file)
{
    struct stat status = {};
    if (stat(file.c_str(), &status) == 0) return inode(status);
    std::error_code code;
    const fs::path whole = fs::weakly_canonical(file, code);
    if (stat(whole.parent_path().c_str(), &status) == 0)
        return inode(status) + "/" + whole.filename().string();
    return whole.string();
}

bool isFile(const fs::path& path)
{
    std::error_code code;
    return fs::is_regular_file(path, code);
}

/// Whether a file has other names, and one of them is below a folder.
bool hasLinkTo(const fs::path& folder, const fs::path& file)
{
    struct stat status = {}, other = {};
    if (stat(file.c_str(), &status) != 0 || status.st_nlink < 2) return false;
    std::error_code code;
    for (fs::recursive_directory_iterator entry(folder, code), end; !code && entry != end;
         entry.increment(code))
        if (stat(entry->path().c_str(), &other) == 0 && inode(other) == inode(status)) return true;
    return false;
}

/// The file that one of GDAL's names of its own file systems begins with; empty if there is none.
std::string virtualFile(const std::string& name)
{
    if (name.rfind("/vsi", 0) != 0) return {};
    const std::size_t slash = name.find('/', 1);
    if (slash == std::string::npos) return {};
    for (fs::path path = name.substr(slash + 1); !path.empty() && path != path.parent_path();
         path = path.parent_path())
        if (isFile(path)) return path.string();
    return {};
}

/// The files in names such as FILE:LAYER and NETCDF:"FILE":VARIABLE.
std::vector<std::string> filesIn(std::string name)
{
    name.erase(std::remove(name.begin(), name.end(), '"'), name.end());
    std::vector<std::size_t> colons;
    for (std::size_t i = 0; i < name.size(); ++i)
        if (name[i] == ':') colons.push_back(i);
    std::vector<std::size_t> begins{0}, ends = colons;
    for (const std::size_t colon : colons)
        begins.push_back(colon + 1);
    ends.push_back(name.size());
    std::vector<std::string> found;
    for (const std::size_t begin : begins)
        for (const std::size_t end : ends)
        {
            if (end <= begin) continue;
            const std::string part = name.substr(begin, end - begin), inside = virtualFile(part);
            if (isFile(part)) found.push_back(part);
            if (!inside.empty()) found.push_back(inside);
        }
    return found;
}

/// A name as XML and addresses have it.
std::string decoded(const std::string& text)
{
    std::string result;
    for (std::size_t i = 0; i < text.size(); ++i)
    {
        const auto isHex = [&](std::size_t at)
        {
            return at < text.size() && std::isxdigit(static_cast<unsigned char>(text[at]));
        };
        if (text[i] == '%' && isHex(i + 1) && isHex(i + 2))
        {
            result += static_cast<char>(std::stoi(text.substr(i + 1, 2), nullptr, 16));
            i += 2;
        }
        else if (text.compare(i, 5, "&amp;") == 0)
        {
            result += '&';
            i += 4;
        }
        else
            result += text[i];
    }
    return result;
}

/// What stands between quotes and tags.
std::set<std::string> wordsOf(const std::string& text)
{
    std::set<std::string> words;
    for (std::size_t begin = 0; begin < text.size();)
    {
        std::size_t end = text.find_first_of("\"'<>\n", begin);
        if (end == std::string::npos) end = text.size();
        const std::size_t first = text.find_first_not_of(" \t\r", begin),
                          last = text.find_last_not_of(" \t\r", end - 1);
        if (first < end && end > begin && last - first < LONGEST_NAME)
            words.insert(text.substr(first, last - first + 1));
        begin = end + 1;
    }
    return words;
}

bool isBelow(const fs::path& path, const fs::path& folder)
{
    std::error_code code;
    const fs::path inner = fs::weakly_canonical(path, code), outer = fs::weakly_canonical(folder, code);
    return std::mismatch(outer.begin(), outer.end(), inner.begin(), inner.end()).first == outer.end();
}

[[noreturn]] void refuse(const std::string& what, const std::string& output, const std::string& does,
                         const std::string& option)
{
    throw WorkError(what + " " + output + " would " + does + "; choose another " + option + ".");
}

} // namespace

bool InputFiles::isNew(const std::string& file)
{
    std::error_code code;
    if (!_files.emplace(keyOf(file), Entry{file}).second) return false;
    _places.push_back(fs::weakly_canonical(file, code));
    return true;
}

void InputFiles::lookUp()
{
    std::vector<std::string> names;
    names.swap(_names);
    for (const std::string& name : names)
        addName(name);
}

void InputFiles::addName(const std::string& name)
{
    std::error_code code;
    if (fs::is_directory(name, code))
    {
        _folders.emplace(keyOf(name), name);
        _places.push_back(fs::weakly_canonical(name, code));
    }
    else if (isFile(name))
        addFile(name);
    else
        for (const std::string& file : filesIn(name))
            addFile(file);
}

void InputFiles::addFile(const std::string& file)
{
    if (!isNew(file)) return;
    static const std::set<std::string> texts = {".geofx", ".kml",   ".sld", ".osgt", ".osgx",
                                                ".osg",   ".earth", ".xml", ".vrt"};
    const fs::path path(file);
    if (path.filename() == "terrain.osgb") addDatabase(path);
    if (texts.count(path.extension().string()) > 0) addNamesIn(path);
    if (_sources)
        for (const std::string& source : _sources(file))
            addName(source);
}

void InputFiles::addDatabase(const fs::path& root)
{
    for (const char* part : {"tiles", "buildings", "kept", "built-from.txt"})
        if (fs::exists(root.parent_path() / part)) addName((root.parent_path() / part).string());
}

void InputFiles::addNamesIn(const fs::path& text)
{
    std::error_code code;
    if (fs::file_size(text, code) > LARGEST_TEXT || code) return;
    std::ifstream stream(text, std::ios::binary);
    const std::string content{std::istreambuf_iterator<char>(stream), std::istreambuf_iterator<char>()};
    for (const std::string& word : wordsOf(content))
    {
        const fs::path named = text.parent_path() / decoded(word);
        if (isFile(named) ||
            (word.find('/') != std::string::npos && fs::is_directory(named, code) && !isBelow(text, named)))
            addName(named.string());
    }
}

const InputFiles::Entry* InputFiles::find(const std::string& file) const
{
    const auto known = _files.find(keyOf(file));
    return known == _files.end() ? nullptr : &known->second;
}

void InputFiles::claim(const std::string& what, const std::string& file, const std::string& option)
{
    std::error_code code;
    if (fs::exists(file, code)) lookUp();
    if (const Entry* const entry = find(file))
        refuse(what, file,
               "replace the file " + entry->name + ", which is " + (entry->written ? "written, too" : "read"),
               option);
    for (const auto& [key, folder] : _folders)
        if (hasLinkTo(folder, file))
            refuse(what, file, "replace a file of the folder " + folder + ", which is read", option);
    const fs::path whole = fs::weakly_canonical(file, code);
    for (fs::path folder = whole.parent_path(); fs::exists(whole, code) && !folder.empty();
         folder = folder.parent_path())
    {
        const auto known = _folders.find(keyOf(folder));
        if (known != _folders.end())
            refuse(what, file, "replace a file of the folder " + known->second + ", which is read", option);
        if (folder == folder.parent_path()) break;
    }
    _files.emplace(keyOf(file), Entry{file, true});
}

void InputFiles::claimFolder(const std::string& what, const std::string& folder, const std::string& option)
{
    std::error_code code;
    if (fs::exists(folder, code)) lookUp();
    for (const fs::path& inner : _places)
        if (isBelow(inner, folder))
            refuse(what, folder, "be replaced with " + inner.string() + " in it, which is read", option);
}

} // namespace osgGeoFX
