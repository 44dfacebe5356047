// SPDX-License-Identifier: MIT
// SPDX-FileCopyrightText: 2026 the osgGeoFX authors
#include <osgGeoFX/paging/TileGuard.h>

#include <osgGeoFX/paging/FilesByOthers.h>
#include <osgGeoFX/paging/RemoteFiles.h>
#include <osgGeoFX/paging/detail/BinaryHeader.h>
#include <osgGeoFX/paging/detail/FileStamp.h>
#include <osgGeoFX/paging/detail/PagerCache.h>
#include <osgGeoFX/paging/detail/StandIn.h>

#include <osg/Group>
#include <osg/NodeVisitor>
#include <osg/Notify>
#include <osg/PagedLOD>
#include <osgDB/Callbacks>
#include <osgDB/FileNameUtils>
#include <osgDB/FileUtils>
#include <osgDB/Registry>
#include <osgDB/fstream>

#include <algorithm>
#include <chrono>
#include <cmath>
#include <cstdint>
#include <exception>
#include <filesystem>
#include <iterator>

namespace osgGeoFX
{

namespace
{

using ReadResult = osgDB::ReaderWriter::ReadResult;

using Clock = StandIn::Clock;

/// The first delay of a file that is on no server, seconds.
constexpr double firstDelay = 0.5;

ReadResult makeStandIn(const std::string& file, const osgDB::Options* options, Clock::time_point again)
{
    osg::ref_ptr<osg::Group> parent;
    if (options) options->getParentGroup().lock(parent);
    if (auto* const before = dynamic_cast<StandIn*>(parent.get()))
    {
        before->askLater(again);
        // Nothing, and no reason for the pager to say so.
        return ReadResult::FILE_LOADED;
    }
    const bool hasCoarser = parent && parent->getNumChildren() > 0;
    const osg::ref_ptr<StandIn> result =
        new StandIn(hasCoarser ? parent->getChild(parent->getNumChildren() - 1) : nullptr);
    result->askAgain(file, options, again);
    return result.get();
}

/// Whether all bytes of a file can be read.
bool canBeRead(const std::string& path)
{
    osgDB::ifstream stream(path.c_str(), std::ios::in | std::ios::binary);
    std::vector<char> bytes(1 << 16);
    while (stream.read(bytes.data(), static_cast<std::streamsize>(bytes.size())))
    {
    }
    return stream.is_open() && stream.eof() && !stream.bad();
}

/// The topmost folder of a missing file that is missing, too; empty where only the file is.
std::string missingFolderOf(const std::string& file, const osgDB::Options* options)
{
    std::string missing;
    for (std::string folder = osgDB::getFilePath(file);
         !folder.empty() && osgDB::findDataFile(folder, options).empty(); folder = osgDB::getFilePath(folder))
        missing = folder;
    return missing;
}

} // namespace

/// A file on a disk, as it was before it was read.
struct TileGuard::Attempt
{
    std::string path; ///< empty: no file is known
    FileStamp stamp;
};

/// The guard's place in the options of one PagedLOD, with the callback that was there before.
class TileGuard::Callback : public osgDB::ReadFileCallback
{
public:
    Callback(TileGuard* tileGuard, osgDB::ReadFileCallback* before) : guard(tileGuard), previous(before) {}

    ReadResult readNode(const std::string& file, const osgDB::Options* options) override
    {
        return guard->read(file, options, *this);
    }

    const osg::ref_ptr<TileGuard> guard;
    const osg::ref_ptr<osgDB::ReadFileCallback> previous;
    struct Failure
    {
        Clock::time_point again; ///< when the file is tried again
        double delay = 0.0;      ///< before that, seconds; 0: it has not failed
        std::string cause;       ///< of the warning
        Attempt broken;          ///< the last one, if it read a whole file
        int times = 0;           ///< how often this file was read whole and was broken
        /// One time may be a disk's fault that is over when we look.
        bool isRefused() const { return times >= 2; }
        /// The next delay is twice this one, between these limits.
        Clock::time_point putOff(double least, double most)
        {
            delay = std::min(std::max(2.0 * delay, least), most);
            again = Clock::now() +
                    std::chrono::duration_cast<Clock::duration>(std::chrono::duration<double>(delay));
            return again;
        }
    };
    /// Files that failed with these options. Under the guard's lock.
    std::map<std::string, Failure> failed;
};

/// Finds PagedLODs and, given a guard, puts it into those that have none.
class TileGuard::Installer : public osg::NodeVisitor
{
public:
    explicit Installer(TileGuard* guard) : osg::NodeVisitor(TRAVERSE_ALL_CHILDREN), _guard(guard)
    {
        setNodeMaskOverride(~0u);
    }

    void apply(osg::PagedLOD& lod) override
    {
        auto* options = dynamic_cast<osgDB::Options*>(lod.getDatabaseOptions());
        auto* callback = options ? dynamic_cast<Callback*>(options->getReadFileCallback()) : nullptr;
        if (callback && !found) found = callback->guard.get();
        if (!callback && _guard) lod.setDatabaseOptions(_guard->guardedOptions(options).get());
        apply(static_cast<osg::Node&>(lod));
    }

    /// Bounds are computed here, on the thread that reads: a PagedLOD that brings its own does not ask those below it,
    /// and two cull threads must not compute them at once.
    void apply(osg::Node& node) override
    {
        traverse(node);
        node.getBound();
    }

    TileGuard* found = nullptr;

private:
    TileGuard* _guard;
};

TileListener::~TileListener() = default;

TileGuard::TileGuard() : osg::Referenced(true) {}

TileGuard::~TileGuard() = default;

osg::ref_ptr<TileGuard> TileGuard::install(osg::Node* node, FilesByOthers* files)
{
    Installer search(nullptr);
    node->accept(search);
    osg::ref_ptr<TileGuard> guard = search.found ? search.found : new TileGuard;
    if (!search.found) guard->_files = files;
    Installer installer(guard.get());
    node->accept(installer);
    return guard;
}

osg::ref_ptr<osgDB::Options> TileGuard::readingOptions(const osg::Node& node)
{
    Installer search(nullptr);
    const_cast<osg::Node&>(node).accept(search);
    return search.found && search.found->_files ? search.found->_files->addTo(nullptr) : nullptr;
}

std::string TileGuard::faultOf(const std::string& path)
{
    if (path.empty()) return "it is missing";
    if (osgDB::getLowerCaseFileExtension(path) != "osgb") return {};
    osgDB::ifstream stream(path.c_str(), std::ios::in | std::ios::binary);
    return faultOfBinaryHeader(stream);
}

void TileGuard::setRetryDelay(double seconds)
{
    const std::lock_guard<std::mutex> lock(_mutex);
    _retryDelay = std::isfinite(seconds) ? std::clamp(seconds, 0.01, 3600.0) : 10.0;
}

void TileGuard::addListener(TileListener* listener)
{
    if (!listener) return;
    removeListener(listener);
    const std::lock_guard<std::mutex> lock(_mutex);
    _listeners.emplace_back(listener);
}

void TileGuard::removeListener(TileListener* listener)
{
    const std::lock_guard<std::mutex> lock(_mutex);
    const auto gone = [&](const osg::observer_ptr<TileListener>& each)
    {
        return !each.valid() || each == listener;
    };
    _listeners.erase(std::remove_if(_listeners.begin(), _listeners.end(), gone), _listeners.end());
}

void TileGuard::tell(osg::Node& tile, const std::string& file)
{
    // Not under the lock: listeners take their time.
    std::vector<osg::ref_ptr<TileListener>> listeners;
    {
        const std::lock_guard<std::mutex> lock(_mutex);
        for (const auto& each : _listeners)
        {
            osg::ref_ptr<TileListener> listener;
            if (each.lock(listener)) listeners.push_back(listener);
        }
    }
    for (const auto& listener : listeners)
    {
        std::string reason = "it throws something that is no std::exception";
        try
        {
            listener->tileRead(tile);
            continue;
        }
        catch (const std::exception& exception)
        {
            reason = exception.what();
        }
        catch (...)
        {
        }
        std::string message = "osgGeoFX: a TileListener fails on the tile \"";
        message += file;
        message += "\" (";
        message += reason;
        message +=
            "); the tile is drawn, without what the listener would have made of it. Repair the listener.";
        warnOnce(file, message);
    }
}

TileGuard::Counts TileGuard::counts() const
{
    const std::lock_guard<std::mutex> lock(_mutex);
    return _counts;
}

std::set<std::string> TileGuard::failedFiles() const
{
    const std::lock_guard<std::mutex> lock(_mutex);
    return _failed;
}

osg::ref_ptr<osgDB::Options> TileGuard::guardedOptions(osgDB::Options* original)
{
    // Without options of its own a PagedLOD's files are read with the registry's.
    if (!original) original = osgDB::Registry::instance()->getOptions();
    const std::lock_guard<std::mutex> lock(_mutex);
    const auto known = _options.find(original);
    osg::ref_ptr<osgDB::Options> guarded, alive;
    // Options that are gone may have left their address to others.
    const bool same = known != _options.end() && (!original || known->second.original.lock(alive));
    if (same && known->second.guarded.lock(guarded)) return guarded;
    if (_options.size() >= _purgeSize)
    {
        for (auto entry = _options.begin(); entry != _options.end();)
            entry = entry->second.guarded.valid() && (!entry->first || entry->second.original.valid())
                        ? std::next(entry)
                        : _options.erase(entry);
        _purgeSize = std::max<std::size_t>(64, 2 * _options.size());
    }
    guarded = original ? original->cloneOptions() : new osgDB::Options;
    // A callback that was there decides where files come from, and with it OSG's own ways.
    if (!guarded->getReadFileCallback())
    {
        const osgDB::FileCache* const cache = guarded->getFileCache();
        guarded->setFileCache(new PagerCache(cache ? cache->getFileCachePath() : std::string()));
    }
    guarded->setReadFileCallback(new Callback(this, guarded->getReadFileCallback()));
    _options[original] = {original, guarded.get()};
    return guarded;
}

ReadResult TileGuard::read(const std::string& file, const osgDB::Options* options, Callback& callback)
{
    Attempt attempt;
    {
        const std::lock_guard<std::mutex> lock(_mutex);
        const auto known = callback.failed.find(file);
        if (known != callback.failed.end())
        {
            if (Clock::now() < known->second.again) return makeStandIn(file, options, known->second.again);
            if (known->second.isRefused()) attempt = known->second.broken;
        }
    }
    if (!attempt.path.empty() && FileStamp::of(attempt.path) == attempt.stamp)
    {
        const std::lock_guard<std::mutex> lock(_mutex);
        return makeStandIn(file, options, callback.failed[file].putOff(firstDelay, _retryDelay));
    }
    const osg::ref_ptr<osgDB::ReadFileCallback> previous =
        callback.previous ? callback.previous.get() : osgDB::Registry::instance()->getReadFileCallback();
    const osg::ref_ptr<osgDB::Options> limited = _files && !previous ? _files->addTo(options) : nullptr;
    if (!previous && RemoteFiles::isRemote(file)) return readRemote(file, options, limited, callback);
    attempt.path = previous ? std::string() : osgDB::findDataFile(file, options);
    attempt.stamp = FileStamp::of(attempt.path);
    // A name without a file may mean something to the plugin of its extension.
    if (!previous && osgDB::getLowerCaseFileExtension(file) == "osgb")
    {
        const std::string fault = faultOf(attempt.path);
        if (!fault.empty()) return fail(file, fault, attempt, options, callback);
    }
    ReadResult result;
    try
    {
        if (_files)
            result =
                previous ? _files->readThrough(*previous, file, options) : _files->readNode(file, limited);
        else
            result = previous ? previous->readNode(file, options)
                              : osgDB::Registry::instance()->readNodeImplementation(file, options);
        if (result.validNode() && !result.loadedFromCache())
        {
            Installer installer(this);
            result.getNode()->accept(installer);
        }
    }
    catch (const std::exception& exception)
    {
        return fail(file, exception.what(), attempt, options, callback);
    }
    catch (...)
    {
        return fail(file, "its reader throws something that is no std::exception", attempt, options,
                    callback);
    }
    if (!result.validNode())
    {
        const std::string message = result.notFound() ? "it is missing" : result.statusMessage();
        return fail(file, message.empty() ? "it holds nothing that can be drawn" : message, attempt, options,
                    callback);
    }
    if (!result.loadedFromCache()) tell(*result.getNode(), file);
    std::error_code ignored;
    const std::uintmax_t size = attempt.path.empty() ? 0 : std::filesystem::file_size(attempt.path, ignored);
    const std::lock_guard<std::mutex> lock(_mutex);
    ++_counts.tilesRead;
    _counts.bytesRead += ignored ? 0 : size;
    const auto failure = callback.failed.find(file);
    if (failure != callback.failed.end())
    {
        _warned.erase(failure->second.cause);
        callback.failed.erase(failure);
        _failed.erase(file);
    }
    return result;
}

ReadResult TileGuard::readRemote(const std::string& file, const osgDB::Options* options,
                                 const osgDB::Options* limited, Callback& callback)
{
    const std::string outside = limited ? _files->faultOfPlace(file) : std::string();
    if (!outside.empty()) return fail(file, outside, Attempt(), options, callback);
    const RemoteFiles::Node read =
        RemoteFiles::readNode(file, limited ? limited : options, RemoteFiles::Order::CacheFirst);
    const std::string url = RemoteFiles::normalOf(file), server = osgDB::getServerAddress(file);
    if (!read.node)
    {
        // A server that does not answer is one fault, however many tiles want something of it.
        const bool isServers =
            read.fault == RemoteFiles::Fault::NoAnswer || read.fault == RemoteFiles::Fault::NoPlugin;
        warnOnce(isServers ? server : url,
                 "osgGeoFX: the tile \"" + url + "\" cannot be read (" + read.reason +
                     "); the coarser one stays in its place, and the tile is asked for again later; " +
                     RemoteFiles::remedyOf(read.fault));
        return failRemote(file, options, callback);
    }
    Installer installer(this);
    read.node->accept(installer);
    tell(*read.node, url);
    const std::lock_guard<std::mutex> lock(_mutex);
    ++_counts.tilesRead;
    _counts.bytesRead += read.bytes;
    callback.failed.erase(file);
    _failed.erase(url);
    if (!read.fromCache)
    {
        _warned.erase(url);
        _warned.erase(server);
    }
    return read.node.get();
}

ReadResult TileGuard::fail(const std::string& file, const std::string& reason, const Attempt& attempt,
                           const osgDB::Options* options, Callback& callback)
{
    // A file that could not be read may be there the next time: a disk, or a folder, may be away for a moment.
    const bool broken =
        !attempt.path.empty() && canBeRead(attempt.path) && FileStamp::of(attempt.path) == attempt.stamp;
    const bool local = attempt.path.empty() && !RemoteFiles::isRemote(file);
    const std::string folder = local ? missingFolderOf(file, options) : std::string();
    const std::string cause = folder.empty() ? file : folder;
    Clock::time_point again;
    {
        const std::lock_guard<std::mutex> lock(_mutex);
        Callback::Failure& failure = callback.failed[file];
        if (failure.delay == 0.0) ++_counts.tilesFailed;
        const bool same = broken && failure.broken.stamp == attempt.stamp;
        failure.times = broken ? (same ? failure.times + 1 : 1) : 0;
        failure.broken = attempt;
        failure.cause = cause;
        again = failure.putOff(firstDelay, _retryDelay);
        _failed.insert(file);
    }
    if (folder.empty())
        warnOnce(cause, "osgGeoFX: the tile \"" + file + "\" cannot be read (" + reason +
                            "); the coarser one stays in its place" +
                            (broken ? "" : ", and the file is tried again later") +
                            ". Restore the file or build the database again.");
    else
        warnOnce(cause,
                 "osgGeoFX: the folder \"" + folder + "\" is missing, and with it the tile \"" + file +
                     "\"; coarser tiles stay in the place of its tiles, and these are tried again later. "
                     "Restore the folder or build the database again.");
    return makeStandIn(file, options, again);
}

ReadResult TileGuard::failRemote(const std::string& file, const osgDB::Options* options, Callback& callback)
{
    constexpr double mostDelays = 32.0;
    const std::lock_guard<std::mutex> lock(_mutex);
    Callback::Failure& failure = callback.failed[file];
    if (failure.delay == 0.0) ++_counts.tilesFailed;
    failure.putOff(_retryDelay, mostDelays * _retryDelay);
    _failed.insert(file);
    return makeStandIn(file, options, failure.again);
}

void TileGuard::warnOnce(const std::string& file, const std::string& sentence)
{
    {
        const std::lock_guard<std::mutex> lock(_mutex);
        if (!_warned.insert(file).second) return;
    }
    OSG_WARN << sentence << std::endl;
}

} // namespace osgGeoFX
