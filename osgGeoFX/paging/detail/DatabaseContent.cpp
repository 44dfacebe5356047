// SPDX-License-Identifier: MIT
// SPDX-FileCopyrightText: 2026 the osgGeoFX authors
#include <osgGeoFX/paging/detail/BinaryHeader.h>
#include <osgGeoFX/paging/detail/DatabaseContent.h>

#include <osgDB/FileNameUtils>
#include <osgDB/FileUtils>
#include <osgDB/Registry>

#include <dlfcn.h>

#include <algorithm>
#include <array>
#include <cctype>
#include <cstdint>
#include <cstring>
#include <map>
#include <optional>
#include <sstream>
#include <streambuf>
#include <string_view>

namespace osgGeoFX
{

namespace
{

/// Libraries whose objects read no files by themselves, or only through the options that they are read with.
const char* const libraries[] = {"osg",       "osgAnimation", "osgFX",   "osgParticle",
                                 "osgShadow", "osgSim",       "osgUtil", "osgGeoFX"};

/// Objects of these libraries that do more: scripts, and pictures that are read later without options.
const char* const refused[] = {"osg::Script", "osg::ImageSequence"};

std::uint32_t numberAt(const std::string& content, std::size_t i)
{
    std::uint32_t value = 0;
    if (i + sizeof value <= content.size()) std::memcpy(&value, content.data() + i, sizeof value);
    return value;
}

/// Gives the bytes behind a header, and none any more as soon as they have become too many.
class Source : public std::streambuf
{
public:
    Source(std::string& packed, std::size_t start, const std::string& unpacked, std::size_t most)
        : _packed(packed), _next(start), _unpacked(unpacked), _most(most)
    {
    }

private:
    int_type underflow() override
    {
        if (_unpacked.size() > _most || _next >= _packed.size()) return traits_type::eof();
        const std::size_t count = std::min<std::size_t>(16384, _packed.size() - _next);
        setg(&_packed[_next], &_packed[_next], &_packed[_next] + count);
        _next += count;
        return traits_type::to_int_type(*gptr());
    }

    std::string& _packed;
    std::size_t _next;
    const std::string& _unpacked;
    const std::size_t _most;
};

std::string unpack(std::string& content, std::size_t most)
{
    constexpr std::uint32_t schema = 2;
    std::istringstream stream(content);
    std::string fault = faultOfBinaryHeader(stream);
    if (!fault.empty()) return fault;
    // The magic number as it stands in files of little-endian machines, which we are.
    if (numberAt(content, 0) != 0x6C910EA1) return "its bytes have another order";
    if (numberAt(content, 16) & schema) return "it changes how OSG reads other files";
    // A name with its length is the header's last part.
    const auto end = static_cast<std::size_t>(stream.tellg());
    const std::size_t none = end - 5, zlib = end - 8;
    if (numberAt(content, none) == 1 && content[none + 4] == '0') return {};
    if (numberAt(content, zlib) != 4 || content.compare(zlib + 4, 4, "zlib") != 0)
        return "it is compressed by another method than zlib";
    osgDB::BaseCompressor* const method =
        osgDB::Registry::instance()->getObjectWrapperManager()->findCompressor("zlib");
    if (!method) return "OSG has no zlib to unpack it";
    // The last bytes tell how many there are. Where they lie, unpacking ends by itself.
    const std::string tooLarge = "it is larger than 256 MiB when it is unpacked";
    if (numberAt(content, content.size() - 4) > most) return tooLarge;
    std::string unpacked = content.substr(0, zlib);
    const std::uint32_t one = 1;
    unpacked.append(reinterpret_cast<const char*>(&one), sizeof one);
    unpacked += '0';
    Source source(content, end, unpacked, most);
    std::istream bytes(&source);
    const bool done = method->decompress(bytes, unpacked);
    if (unpacked.size() > most) return tooLarge;
    if (!done) return "it is damaged or cut off";
    content.swap(unpacked);
    return {};
}

/// The folder of OSG's own libraries, if it is known.
std::string folderOfOsg()
{
    Dl_info info = {};
    return dladdr(reinterpret_cast<void*>(&osgDB::fileExists), &info) != 0 && info.dli_fname
               ? osgDB::getFilePath(info.dli_fname)
               : std::string();
}

/** OSG loads a library by the name of a class: of "a::B" it tries liba.so and plugins named after a. It looks for them in the
    current folder, too, which may be the sender's. Such names are found wherever they stand, as OSG finds no others: behind
    their lengths in binary files, between spaces in text. */
class ClassNames
{
public:
    /// Empty if all names may be there.
    std::string faultOf(const std::string& content, bool isBinary)
    {
        std::size_t colons = content.find("::");
        for (std::size_t start = 0; colons != std::string::npos && start < content.size();)
        {
            std::size_t end = start;
            if (isBinary)
            {
                const std::uint32_t length = start < 4 ? 0 : numberAt(content, start - 4);
                end = length > content.size() - start ? start : start + length;
            }
            else
            {
                end = std::min(content.find_first_of(" \t\r\n\v\f", start), content.size());
            }
            if (colons < start) colons = content.find("::", start);
            if (colons != std::string::npos && colons + 2 <= end)
            {
                const std::string fault = faultOfName(content, start, end);
                if (!fault.empty()) return fault;
            }
            start = isBinary ? start + 1 : end + 1;
        }
        return {};
    }

private:
    std::string faultOfName(const std::string& content, std::size_t start, std::size_t end)
    {
        // Paths are not longer.
        const std::size_t stop = std::min(end, start + 4096);
        const std::string_view name(content.data() + start, stop - start);
        // A zero ends a path, and not a name. No class has one in its name, but a library may be loaded by it.
        const std::size_t zero = name.find('\0');
        const std::size_t last = name.substr(0, zero).rfind("::");
        const bool isName = zero == std::string_view::npos && stop == end && last != std::string_view::npos;
        if (!isName)
        {
            for (const std::size_t length : {zero, last})
                if (length != 0 && length != std::string_view::npos &&
                    isInCurrentFolder(name.substr(0, length)))
                    return lying(name.substr(0, length));
            return {};
        }
        const std::string_view library = name.substr(0, last);
        const std::string shown(name.substr(0, 60));
        if (std::find(std::begin(libraries), std::end(libraries), library) != std::end(libraries))
        {
            if (std::any_of(std::begin(refused), std::end(refused),
                            [&](const std::string_view each) { return name.substr(0, each.size()) == each; }))
                return "it holds a " + shown + ", which is not allowed there";
        }
        else if (std::all_of(library.begin(), library.end(),
                             [](unsigned char letter) { return std::isalnum(letter) || letter == '_'; }) &&
                 isInstalled(std::string(library)))
        {
            return "it holds a " + shown + ", and objects of its library are not allowed there";
        }
        return isInCurrentFolder(library) ? lying(library) : std::string();
    }

    static std::string lying(std::string_view library)
    {
        return "a library for its objects of \"" + std::string(library.substr(0, 60)) +
               "\" lies in the current folder";
    }

    static std::array<std::string, 3> filesOf(const std::string& library)
    {
        osgDB::Registry& registry = *osgDB::Registry::instance();
        return {registry.createLibraryNameForNodeKit(library),
                registry.createLibraryNameForExtension(library),
                registry.createLibraryNameForExtension("serializers_" + library)};
    }

    bool isInstalled(const std::string& library)
    {
        const auto [known, isNew] = _installed.emplace(library, false);
        if (isNew)
        {
            static const std::string folder = folderOfOsg();
            for (const std::string& file : filesOf(library))
                known->second = known->second || !osgDB::findLibraryFile(file).empty() ||
                                osgDB::fileExists(osgDB::concatPaths(folder, file));
        }
        return known->second;
    }

    bool isInCurrentFolder(std::string_view library)
    {
        if (!_currentFolder.has_value())
        {
            _currentFolder = false;
            for (const std::string& entry : osgDB::getDirectoryContents("."))
                _currentFolder =
                    *_currentFolder || entry.rfind("lib", 0) == 0 || entry.rfind("osgPlugins", 0) == 0;
        }
        if (!*_currentFolder) return false;
        // No file has a longer name, and no path of them.
        if (library.size() > 4000) return false;
        for (const std::string& file : filesOf(std::string(library)))
            if (osgDB::fileExists(file)) return true;
        return false;
    }

    std::map<std::string, bool> _installed;
    std::optional<bool> _currentFolder; ///< whether any library or plugin may lie there
};

} // namespace

std::string faultOfDatabase(std::string& content, std::size_t most)
{
    const bool isText = content.compare(0, 6, "#Ascii") == 0;
    if (!isText)
    {
        const std::string fault = unpack(content, most);
        if (!fault.empty()) return fault;
    }
    return ClassNames().faultOf(content, !isText);
}

} // namespace osgGeoFX
