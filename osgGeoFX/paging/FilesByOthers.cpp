// SPDX-License-Identifier: MIT
// SPDX-FileCopyrightText: 2026 the osgGeoFX authors
#include <osgGeoFX/paging/FilesByOthers.h>

#include <osgGeoFX/paging/RemoteFiles.h>
#include <osgGeoFX/paging/detail/DatabaseContent.h>
#include <osgGeoFX/paging/detail/PictureStart.h>

#include <osg/ImageStream>
#include <osgDB/FileNameUtils>
#include <osgDB/FileUtils>
#include <osgDB/Registry>
#include <osgDB/fstream>

#include <algorithm>
#include <exception>
#include <filesystem>
#include <iterator>
#include <sstream>
#include <utility>

namespace osgGeoFX
{

namespace
{

namespace fs = std::filesystem;
using ReadResult = osgDB::ReaderWriter::ReadResult;

/// Bytes of a file, and of what it becomes.
constexpr std::size_t mostBytes = std::size_t{256} << 20;

const char* const consent =
    "; if you trust the scene, start the program with --allow-outside, or give OSG the option string "
    "\"allowOutside\"";

/// Whether this thread reads a file of somebody else's.
thread_local int filesOpen = 0;

/// Where this thread reads data of somebody else's.
thread_local std::optional<std::string> dataFolder;

/// While one exists, it does.
class Within
{
public:
    explicit Within(int change = 1) : _change(change) { filesOpen += _change; }
    ~Within() { filesOpen -= _change; }
    Within(const Within&) = delete;
    Within& operator=(const Within&) = delete;

private:
    const int _change;
};

std::string contentOf(const std::string& path, std::string& reason)
{
    osgDB::ifstream stream(path.c_str(), std::ios::in | std::ios::binary | std::ios::ate);
    const std::streamoff size = stream ? static_cast<std::streamoff>(stream.tellg()) : -1;
    if (size < 0) reason = "it cannot be opened";
    if (size > static_cast<std::streamoff>(mostBytes)) reason = "it is larger than 256 MiB";
    if (!reason.empty()) return {};
    std::string content(static_cast<std::size_t>(size), '\0');
    stream.seekg(0);
    stream.read(content.data(), size);
    content.resize(static_cast<std::size_t>(std::max<std::streamsize>(0, stream.gcount())));
    return content;
}

/// Reads with a plugin; exceptions become sentences.
template<typename Read>
ReadResult attempt(const Read& read)
{
    try
    {
        return read();
    }
    catch (const std::exception& exception)
    {
        return ReadResult(std::string(exception.what()));
    }
    catch (...)
    {
        return ReadResult(std::string("its reader throws something that is no std::exception"));
    }
}

osg::ref_ptr<osg::Image> pictureOf(const std::string& content, std::string& reason)
{
    const std::optional<PictureStart> header = pictureStartOf(content);
    if (!header)
    {
        reason = "it is not PNG, JPEG, GIF, BMP or DDS";
        return nullptr;
    }
    if (header->bytes > static_cast<double>(mostBytes))
    {
        reason = "its pixels take more than 256 MiB";
        return nullptr;
    }
    // Our own gate is not meant.
    const Within paused(-filesOpen);
    osgDB::ReaderWriter* const reader =
        osgDB::Registry::instance()->getReaderWriterForExtension(header->reader);
    if (!reader)
    {
        reason = "OSG has no plugin for \"" + std::string(header->reader) + "\"";
        return nullptr;
    }
    std::istringstream stream(content);
    ReadResult result = attempt([&] { return reader->readImage(stream); });
    osg::ref_ptr<osg::Image> image = result.getImage();
    // A film has no pixels before it plays.
    if (image && (image->valid() || dynamic_cast<osg::ImageStream*>(image.get()))) return image;
    reason = result.message().empty() ? "it is damaged or cut off" : result.message();
    return nullptr;
}

ReadResult refusal(const std::string& reason)
{
    return ReadResult(reason + consent);
}

bool isAddress(const std::string& path)
{
    return path.find("://") != std::string::npos;
}

/// Whether an address lies below another one, after ".." in it.
bool isBelow(const std::string& address, const std::string& folder)
{
    const std::size_t start = address.find('/', address.find("://") + 3);
    const std::string root = folder + (folder.back() == '/' ? "" : "/");
    // A server decides what escaped characters mean; ".." may be among them.
    if (start == std::string::npos || address.find('%') != std::string::npos) return false;
    const std::string normal =
        address.substr(0, start) + fs::path(address.substr(start)).lexically_normal().string();
    return normal.compare(0, root.size(), root) == 0;
}

bool isScene(const std::string& content, const std::string& name)
{
    return osgDB::getLowerCaseFileExtension(name) == "geofx" && content.find('<') < 16;
}

} // namespace

/// Answers in the place of all readers while a file of others is read, and hides else.
class GateReader : public osgDB::ReaderWriter
{
public:
    const char* className() const override { return "osgGeoFX pictures within files by others"; }
    bool acceptsExtension(const std::string&) const override { return filesOpen > 0; }
    ReadResult readImage(std::istream& stream, const Options*) const override
    {
        const std::string content((std::istreambuf_iterator<char>(stream)), std::istreambuf_iterator<char>());
        std::string reason;
        const osg::ref_ptr<osg::Image> image = pictureOf(content, reason);
        return image ? ReadResult(image.get()) : refusal("a picture within it is left out: " + reason);
    }
    ReadResult readObject(const std::string&, const Options*) const override
    {
        return refusal("a database by others names a raster by itself, which is left out");
    }
};

FilesByOthers::Gate::Gate() : _reader(new GateReader)
{
    // First, as a plugin that is loaded already would answer otherwise. OSG loads plugins under the lock of this list.
    auto& readers = osgDB::Registry::instance()->getReaderWriterList();
    readers.insert(readers.begin(), _reader);
}

FilesByOthers::Gate::~Gate()
{
    if (osgDB::Registry::instance()) osgDB::Registry::instance()->removeReaderWriter(_reader.get());
}

FilesByOthers::Scope::Scope(std::optional<std::string> folder) : _former(std::move(dataFolder))
{
    dataFolder = std::move(folder);
}

FilesByOthers::Scope::~Scope()
{
    dataFolder = std::move(_former);
}

const std::optional<std::string>& FilesByOthers::Scope::folder()
{
    return dataFolder;
}

FilesByOthers::FilesByOthers(std::string folder) : _folder(std::move(folder)) {}

FilesByOthers::~FilesByOthers() = default;

FilesByOthers* FilesByOthers::of(const osgDB::Options* options)
{
    return options ? dynamic_cast<FilesByOthers*>(options->getReadFileCallback()) : nullptr;
}

osg::ref_ptr<osgDB::Options> FilesByOthers::addTo(const osgDB::Options* options)
{
    osg::ref_ptr<osgDB::Options> result = options ? options->cloneOptions() : new osgDB::Options;
    // OSG's clones lack it.
    if (options && options->getAuthenticationMap())
        result->setAuthenticationMap(const_cast<osgDB::AuthenticationMap*>(options->getAuthenticationMap()));
    result->setReadFileCallback(this);
    return result;
}

bool FilesByOthers::isWithin(const std::string& path, const std::string& folder)
{
    if (isAddress(folder)) return isAddress(path) && isBelow(path, folder);
    if (path.rfind("/vsi", 0) == 0 || isAddress(path)) return false;
    std::error_code code;
    const fs::path root = fs::weakly_canonical(folder.empty() ? "." : folder, code);
    if (code) return false;
    const fs::path real = fs::weakly_canonical(path, code);
    if (code) return false;
    return std::mismatch(root.begin(), root.end(), real.begin(), real.end()).first == root.end();
}

std::string FilesByOthers::faultOfPlace(const std::string& path) const
{
    return isWithin(path, _folder) ? std::string()
                                   : std::string("it lies outside the scene's folder") + consent;
}

osg::ref_ptr<osg::Image> FilesByOthers::readPicture(const std::string& path, std::string& reason)
{
    const std::string content = contentOf(path, reason);
    const osg::ref_ptr<osg::Image> image = reason.empty() ? pictureOf(content, reason) : nullptr;
    if (image) image->setFileName(path);
    return image;
}

osg::ref_ptr<osg::Image> FilesByOthers::sharedPicture(const std::string& path, std::string& reason)
{
    const std::string real = osgDB::getRealPath(path);
    osg::ref_ptr<osg::Image> image;
    {
        const std::lock_guard<std::mutex> lock(_mutex);
        const auto known = _pictures.find(real);
        if (known != _pictures.end() && known->second.lock(image)) return image;
    }
    image = readPicture(path, reason);
    const std::lock_guard<std::mutex> lock(_mutex);
    // Those of tiles that went are forgotten.
    constexpr std::size_t many = 1000;
    for (auto each = _pictures.begin(); _pictures.size() > many && each != _pictures.end();)
        each = each->second.valid() ? std::next(each) : _pictures.erase(each);
    if (image) _pictures[real] = image;
    return image;
}

ReadResult FilesByOthers::readNode(const std::string& file, const osgDB::Options* options)
{
    if (RemoteFiles::isRemote(file))
    {
        std::string fault = faultOfPlace(file);
        if (!fault.empty()) return ReadResult(std::move(fault));
        if (osgDB::getLowerCaseFileExtension(file) == "geofx")
        {
            // It fetches scenes by itself.
            osgDB::ReaderWriter* const scenes =
                osgDB::Registry::instance()->getReaderWriterForExtension("geofx");
            return scenes ? scenes->readNode(file, addTo(options)) : ReadResult(ReadResult::FILE_NOT_HANDLED);
        }
        const RemoteFiles::Node read =
            RemoteFiles::readNode(file, addTo(options), RemoteFiles::Order::CacheFirst);
        return read.node ? ReadResult(read.node.get()) : ReadResult(read.reason);
    }
    const std::string path = osgDB::findDataFile(file, options);
    if (path.empty()) return ReadResult(std::string("it is missing"));
    std::string reason = faultOfPlace(path);
    std::string content = reason.empty() ? contentOf(path, reason) : std::string();
    return reason.empty() ? readBytes(std::move(content), path, options) : ReadResult(std::move(reason));
}

ReadResult FilesByOthers::readBytes(std::string content, const std::string& name,
                                    const osgDB::Options* options)
{
    const bool isGeofx = isScene(content, name);
    const std::string fault = isGeofx ? std::string() : faultOfDatabase(content, mostBytes);
    if (!fault.empty()) return refusal(fault + " (a database is .osgb, .osgt or .geofx)");
    const char* const extension = isGeofx ? "geofx" : "osgb";
    osgDB::ReaderWriter* const reader = osgDB::Registry::instance()->getReaderWriterForExtension(extension);
    if (!reader) return ReadResult("OSG has no plugin for \"" + std::string(extension) + "\"");
    const osg::ref_ptr<osgDB::Options> here = addTo(options);
    here->getDatabasePathList().push_front(osgDB::getFilePath(name));
    here->setPluginStringData("STREAM_FILENAME", osgDB::getSimpleFileName(name));
    here->setPluginStringData("filename", name);
    here->setPluginStringData("fileType", "");
    std::istringstream stream(std::move(content));
    if (isGeofx)
        return attempt(
            [&] {
                return RemoteFiles::isRemote(name) ? reader->readNode(stream, here)
                                                   : reader->readNode(name, here);
            });
    const Within reading;
    ReadResult result = attempt([&] { return reader->readNode(stream, here); });
    if (!result.validNode() && result.message().empty())
        return ReadResult(std::string("it is damaged or cut off"));
    return result;
}

ReadResult FilesByOthers::readThrough(osgDB::ReadFileCallback& callback, const std::string& file,
                                      const osgDB::Options* options)
{
    const std::string path = RemoteFiles::isRemote(file) ? std::string() : osgDB::findDataFile(file, options);
    std::string reason = path.empty() ? std::string() : faultOfPlace(path);
    if (!path.empty() && reason.empty())
    {
        std::string content = contentOf(path, reason);
        if (reason.empty() && !isScene(content, path)) reason = faultOfDatabase(content, mostBytes);
    }
    if (!reason.empty()) return ReadResult(std::move(reason));
    const Within reading;
    return callback.readNode(file, options);
}

ReadResult FilesByOthers::readImage(const std::string& file, const osgDB::Options* options)
{
    std::string reason;
    osg::ref_ptr<osg::Image> image;
    if (RemoteFiles::isRemote(file))
    {
        reason = faultOfPlace(file);
        const RemoteFiles::Content content =
            reason.empty() ? RemoteFiles::readContent(file, addTo(options)) : RemoteFiles::Content();
        if (reason.empty()) reason = content.reason;
        if (reason.empty()) image = pictureOf(content.bytes, reason);
        if (image) image->setFileName(file);
    }
    else
    {
        const std::string path = osgDB::findDataFile(file, options);
        if (path.empty()) return ReadResult::FILE_NOT_FOUND;
        reason = faultOfPlace(path);
        if (reason.empty()) image = sharedPicture(path, reason);
    }
    if (image) return ReadResult(image.get());
    return ReadResult(std::move(reason));
}

ReadResult FilesByOthers::openArchive(const std::string&, osgDB::ReaderWriter::ArchiveStatus, unsigned int,
                                      const osgDB::Options*)
{
    return refusal("archives are not read");
}

ReadResult FilesByOthers::readObject(const std::string&, const osgDB::Options*)
{
    return refusal("only databases and pictures are read");
}

ReadResult FilesByOthers::readHeightField(const std::string&, const osgDB::Options*)
{
    return refusal("only databases and pictures are read");
}

ReadResult FilesByOthers::readShader(const std::string&, const osgDB::Options*)
{
    return refusal("only databases and pictures are read");
}

ReadResult FilesByOthers::readScript(const std::string&, const osgDB::Options*)
{
    return refusal("only databases and pictures are read");
}

} // namespace osgGeoFX
