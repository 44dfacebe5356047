// SPDX-License-Identifier: MIT
// SPDX-FileCopyrightText: 2026 the osgGeoFX authors
#include <osgGeoFX/paging/RemoteFiles.h>

#include <osgGeoFX/paging/FilesByOthers.h>
#include <osgGeoFX/paging/detail/BinaryHeader.h>
#include <osgGeoFX/paging/detail/FileStore.h>
#include <osgGeoFX/paging/detail/ServerRests.h>

#include <osg/DisplaySettings>
#include <osg/Notify>
#include <osg/ValueObject>
#include <osgDB/FileCache>
#include <osgDB/FileNameUtils>
#include <osgDB/Registry>

#include <algorithm>
#include <cstdlib>
#include <exception>
#include <filesystem>
#include <mutex>
#include <set>
#include <sstream>

namespace osgGeoFX
{

namespace
{

namespace fs = std::filesystem;
using ReadResult = osgDB::ReaderWriter::ReadResult;
using Content = RemoteFiles::Content;
using Fault = RemoteFiles::Fault;

/// osgdb_curl hands what it has fetched to the reader of the extension. This one takes it as it is.
class ByteReader : public osgDB::ReaderWriter
{
public:
    ByteReader() { supportsExtension("geofxbytes", "a file's bytes, for osgGeoFX alone"); }
    const char* className() const override { return "osgGeoFX byte reader"; }
    ReadResult readObject(std::istream& stream, const Options*) const override
    {
        std::ostringstream bytes;
        bytes << stream.rdbuf();
        return new osg::StringValueObject("bytes", bytes.str());
    }
};

/// An address without what follows the path.
std::string pathOf(const std::string& url)
{
    return RemoteFiles::normalOf(url.substr(0, url.find_first_of("?#")));
}

void addTimeout(std::string& words, const std::string& name, const char* usual)
{
    if (words.find(name + "=") != std::string::npos) return;
    const char* const set = std::getenv(name.c_str());
    words += " " + name + "=" + (set && std::atol(set) > 0 ? set : usual);
}

osg::ref_ptr<osgDB::Options> fetchOptions(const osgDB::Options* options)
{
    osg::ref_ptr<osgDB::Options> result = options ? options->cloneOptions() : new osgDB::Options;
    // OSG's clones lack it.
    if (options && options->getAuthenticationMap())
        result->setAuthenticationMap(const_cast<osgDB::AuthenticationMap*>(options->getAuthenticationMap()));
    std::string words = options ? options->getOptionString() : std::string();
    addTimeout(words, "OSG_CURL_CONNECTTIMEOUT", "10");
    addTimeout(words, "OSG_CURL_TIMEOUT", "30");
    result->setOptionString(words);
    return result;
}

std::string reasonOf(const ReadResult& result, Content& content)
{
    const std::string& message = result.message();
    const std::string prefix = "error code = ";
    if (message.compare(0, prefix.size(), prefix) == 0)
    {
        content.fault = Fault::Refused;
        return "the server answers " + message.substr(prefix.size());
    }
    content.fault = Fault::NoAnswer;
    return "the server does not answer in time, or breaks off";
}

bool isServerFault(const Content& content)
{
    return content.fault == Fault::NoAnswer ||
           (content.fault == Fault::Refused && content.reason.find(" answers 5") != std::string::npos);
}

/// Asks the server. OSG's registry would ask it twice for what fails, so the plugin is asked directly.
Content fetch(const std::string& url, const osgDB::Options* options)
{
    Content content;
    const std::string server = osgDB::getServerAddress(url);
    if (ServerRests::isAtRest(server))
    {
        content.fault = Fault::NoAnswer;
        content.reason = "the server has not answered several times";
        return content;
    }
    // Not when the library is loaded: OSG's registry reads the environment when it is first used, and programs may set that.
    static const osgDB::RegisterReaderWriterProxy<ByteReader> byteReader;
    const osgDB::ReaderWriter* const plugin =
        osgDB::Registry::instance()->getReaderWriterForProtocolAndExtension(osgDB::getServerProtocol(url),
                                                                            "geofxbytes");
    if (!plugin)
    {
        content.fault = Fault::NoPlugin;
        content.reason = "OSG's plugin osgdb_curl was not found";
        return content;
    }
    // What follows "#" is not sent. It names the reader.
    ReadResult result;
    try
    {
        result = plugin->readObject(url.substr(0, url.find('#')) + "#.geofxbytes", fetchOptions(options));
    }
    catch (const std::exception&)
    {
        // Too long for the memory; the same as no answer.
    }
    if (const auto* bytes = dynamic_cast<const osg::StringValueObject*>(result.getObject()))
        content.bytes = bytes->getValue();
    else
        content.reason = reasonOf(result, content);
    ServerRests::tell(server, content.fault != Fault::NoAnswer);
    return content;
}

std::string faultOfBytes(const std::string& bytes, const std::string& extension)
{
    if (bytes.compare(0, 2, "\x1f\x8b") == 0 && extension != "gz" && extension != "osgz")
        return "the server sends it compressed by gzip, for which it was not asked";
    if (extension != "osgb") return {};
    std::istringstream stream(bytes);
    return faultOfBinaryHeader(stream);
}

/// Makes a node of a file's bytes.
RemoteFiles::Node parse(const std::string& url, const std::string& bytes, const osgDB::Options* options)
{
    RemoteFiles::Node result;
    result.bytes = bytes.size();
    const std::string path = pathOf(url), extension = osgDB::getLowerCaseFileExtension(path);
    result.reason = faultOfBytes(bytes, extension);
    FilesByOthers* const others = FilesByOthers::of(options);
    if (others && result.reason.empty())
    {
        ReadResult read = others->readBytes(bytes, path, options);
        result.node = read.getNode();
        if (!result.node) result.reason = read.message();
    }
    osgDB::ReaderWriter* const reader =
        result.reason.empty() && !others ? osgDB::Registry::instance()->getReaderWriterForExtension(extension)
                                         : nullptr;
    if (!reader && !others && result.reason.empty())
        result.reason = "OSG has no plugin for \"" + extension + "\"";
    if (reader)
    {
        const osg::ref_ptr<osgDB::Options> here = options ? options->cloneOptions() : new osgDB::Options;
        here->getDatabasePathList().push_front(osgDB::getFilePath(path));
        here->setPluginStringData("STREAM_FILENAME", osgDB::getSimpleFileName(path));
        here->setPluginStringData("filename", path);
        std::istringstream stream(bytes);
        try
        {
            ReadResult read = reader->readNode(stream, here);
            result.node = read.getNode();
            if (!result.node) result.reason = read.message();
        }
        catch (const std::exception& exception)
        {
            result.reason = exception.what();
        }
        catch (...)
        {
            result.reason = "its reader throws something that is no std::exception";
        }
        if (!result.node && result.reason.empty()) result.reason = "it is damaged or cut off";
    }
    if (!result.node) result.fault = Fault::Damaged;
    return result;
}

void warnOnce(const std::string& key, const std::string& sentence)
{
    static std::mutex mutex;
    static std::set<std::string> warned;
    {
        const std::lock_guard<std::mutex> lock(mutex);
        if (!warned.insert(key).second) return;
    }
    OSG_WARN << sentence << std::endl;
}

void store(const std::string& file, const std::string& bytes)
{
    const std::string fault = FileStore::write(file, bytes);
    if (!fault.empty())
        warnOnce("cache",
                 "osgGeoFX: the file cache cannot keep \"" + file + "\" (" + fault +
                     "); files are fetched each time. Make the folder of OSG_FILE_CACHE writable, and "
                     "free some space.");
}

void warnOfCache(const std::string& url, const std::string& reason)
{
    warnOnce(url, "osgGeoFX: \"" + url + "\" cannot be fetched (" + reason +
                      "); its copy in the file cache is used. Check the network and the server.");
}

} // namespace

std::string RemoteFiles::normalOf(const std::string& url)
{
    const std::size_t scheme = url.find("://");
    const std::size_t start = scheme == std::string::npos ? scheme : url.find('/', scheme + 3);
    if (start == std::string::npos) return url;
    const std::size_t end = std::min(url.find_first_of("?#", start), url.size());
    return url.substr(0, start) + fs::path(url.substr(start, end - start)).lexically_normal().string() +
           url.substr(end);
}

bool RemoteFiles::isRemote(const std::string& name)
{
    return osgDB::containsServerAddress(name);
}

RemoteFiles::Node RemoteFiles::readNode(const std::string& url, const osgDB::Options* options, Order order)
{
    const std::string file = cacheFileOf(url, options);
    if (order == Order::CacheFirst && FileStore::has(file))
    {
        Node kept = parse(url, FileStore::read(file), options);
        kept.fromCache = true;
        if (kept.node) return kept;
        OSG_INFO << "osgGeoFX: " << file << " in the file cache is damaged and is fetched again."
                 << std::endl;
        FileStore::remove(file);
    }
    const Content content = fetch(url, options);
    if (content.fault == Fault::None)
    {
        Node fetched = parse(url, content.bytes, options);
        if (!fetched.node || file.empty()) return fetched;
        if (order == Order::ServerFirst && FileStore::has(file))
        {
            if (FileStore::read(file) == content.bytes) return fetched;
            FileStore::removeTiles(fs::path(file).parent_path());
        }
        store(file, content.bytes);
        return fetched;
    }
    if (order == Order::ServerFirst && isServerFault(content) && FileStore::has(file))
    {
        Node kept = parse(url, FileStore::read(file), options);
        kept.fromCache = true;
        if (kept.node)
        {
            warnOfCache(url, content.reason);
            return kept;
        }
    }
    Node failed;
    failed.fault = content.fault;
    failed.reason = content.reason;
    return failed;
}

RemoteFiles::Content RemoteFiles::readContent(const std::string& url, const osgDB::Options* options)
{
    const std::string file = cacheFileOf(url, options);
    Content content = fetch(url, options);
    if (content.fault == Fault::None && !file.empty()) store(file, content.bytes);
    if (isServerFault(content) && FileStore::has(file))
    {
        warnOfCache(url, content.reason);
        content = Content();
        content.bytes = FileStore::read(file);
    }
    return content;
}

std::string RemoteFiles::cacheFileOf(const std::string& url, const osgDB::Options* options)
{
    const osgDB::FileCache* cache = options ? options->getFileCache() : nullptr;
    if (!cache || cache->getFileCachePath().empty()) cache = osgDB::Registry::instance()->getFileCache();
    if (!cache || cache->getFileCachePath().empty() || !isRemote(url)) return {};
    // Names and passwords are no part of a place.
    std::string server = osgDB::getServerAddress(url);
    server.erase(0, server.find('@') + 1);
    if (server.empty() || server == "." || server == "..") return {};
    const std::string name = osgDB::getServerFileName(url.substr(0, url.find('#')));
    const fs::path path = fs::path("/" + name).lexically_normal();
    if (!path.has_filename()) return {};
    return cache->getFileCachePath() + "/" + server + path.string();
}

std::string RemoteFiles::remedyOf(Fault fault)
{
    switch (fault)
    {
    case Fault::NoAnswer:
        return "check the network and the server, or give it longer with OSG_CURL_TIMEOUT.";
    case Fault::Refused:
        return "put the file onto the server, or correct the address.";
    case Fault::Damaged:
        return "put the whole file onto the server as it is, without another compression.";
    case Fault::NoPlugin:
        return "install it (on Debian: libopenscenegraph161), or put its folder on OSG_LIBRARY_PATH.";
    default:
        return {};
    }
}

void RemoteFiles::setUpThreads(osgDB::DatabasePager& pager, unsigned int local)
{
    constexpr unsigned int usual = 8;
    const char* const set = std::getenv("OSG_NUM_HTTP_DATABASE_THREADS");
    const int hint = static_cast<int>(osg::DisplaySettings::instance()->getNumOfHttpDatabaseThreadsHint());
    const unsigned int remote = set ? static_cast<unsigned int>(std::clamp(hint, 1, 64)) : usual;
    pager.setUpThreads(std::max(1u, local) + remote, remote);
}

} // namespace osgGeoFX
