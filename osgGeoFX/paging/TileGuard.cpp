// SPDX-License-Identifier: MIT
// SPDX-FileCopyrightText: 2026 the osgGeoFX authors
#include <osgGeoFX/paging/TileGuard.h>

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
#include <cstdint>
#include <exception>
#include <filesystem>
#include <iterator>

namespace osgGeoFX
{

namespace
{

using ReadResult = osgDB::ReaderWriter::ReadResult;

/// Draws what the parent of a tile that cannot be read draws. The parent's own child is not added as a child: that
/// would change its list of parents in the pager's thread.
class StandIn : public osg::Group
{
public:
    explicit StandIn(osg::Node* shown) : _shown(shown) {}

    osg::BoundingSphere computeBound() const override { return _shown->getBound(); }

    // Visitors of all children (compiling, optimising, writing) reach the parent's child through the parent.
    void traverse(osg::NodeVisitor& visitor) override
    {
        if (visitor.getTraversalMode() == osg::NodeVisitor::TRAVERSE_ACTIVE_CHILDREN) _shown->accept(visitor);
    }

protected:
    ~StandIn() override = default;

private:
    const osg::ref_ptr<osg::Node> _shown;
};

osg::ref_ptr<osg::Node> makeStandIn(const osgDB::Options* options)
{
    osg::ref_ptr<osg::Group> parent;
    if (options && options->getParentGroup().lock(parent) && parent->getNumChildren() > 0)
    {
        return new StandIn(parent->getChild(parent->getNumChildren() - 1));
    }
    return new osg::Group;
}

/// A file's header, as far as OSG would trust its sizes. Everything after it is checked by zlib.
class BinaryHeader
{
public:
    explicit BinaryHeader(const std::string& file) : _stream(file.c_str(), std::ios::in | std::ios::binary) {}

    /// What is wrong with it; empty if nothing is, or if it is not for us to judge.
    std::string fault()
    {
        constexpr std::uint32_t low = 0x6C910EA1;
        constexpr std::uint32_t high = 0x1AFB4545;
        if (!_stream) return "it cannot be opened";
        const std::uint32_t first = number();
        const std::uint32_t second = number();
        if (!_stream) return "it is empty or cut off";
        if (first == swapped(low) && second == swapped(high)) return {};
        if (first != low || second != high) return "it is not an OpenSceneGraph binary file";
        const std::uint32_t type = number();
        number(); // version
        const std::uint32_t attributes = number();
        if (!_stream) return "it is cut off";
        if (type > 3 || (attributes & ~7u) != 0) return _damaged;
        if (attributes & 1u)
        {
            const std::uint32_t domains = number();
            if (domains > 1000) return _damaged;
            for (std::uint32_t i = 0; i < domains; ++i)
            {
                if (!skipString()) return _damaged;
                number();
            }
        }
        return skipString() ? std::string() : _damaged;
    }

private:
    std::uint32_t number()
    {
        std::uint32_t value = 0;
        _stream.read(reinterpret_cast<char*>(&value), sizeof value);
        return value;
    }

    bool skipString()
    {
        const std::uint32_t length = number();
        return _stream && length <= 4096 && _stream.ignore(length) &&
               _stream.gcount() == static_cast<std::streamsize>(length);
    }

    static std::uint32_t swapped(std::uint32_t value)
    {
        return (value >> 24) | ((value >> 8) & 0xff00u) | ((value << 8) & 0xff0000u) | (value << 24);
    }

    const std::string _damaged = "its header is damaged";
    osgDB::ifstream _stream;
};

} // namespace

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
    /// Files that failed with these options. Under the guard's lock.
    std::set<std::string> failed;
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

osg::ref_ptr<TileGuard> TileGuard::install(osg::Node* node)
{
    Installer search(nullptr);
    node->accept(search);
    osg::ref_ptr<TileGuard> guard = search.found ? search.found : new TileGuard;
    Installer installer(guard.get());
    node->accept(installer);
    return guard;
}

std::string TileGuard::faultOf(const std::string& path)
{
    if (path.empty()) return "it is missing";
    if (osgDB::getLowerCaseFileExtension(path) != "osgb") return {};
    return BinaryHeader(path).fault();
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
        warnOnce(file, "osgGeoFX: a TileListener fails on the tile \"" + file + "\" (" + reason +
                           "); the tile is drawn, without what the listener would have made of it. Repair "
                           "the listener.");
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
    guarded->setReadFileCallback(new Callback(this, guarded->getReadFileCallback()));
    _options[original] = {original, guarded.get()};
    return guarded;
}

ReadResult TileGuard::read(const std::string& file, const osgDB::Options* options, Callback& callback)
{
    {
        const std::lock_guard<std::mutex> lock(_mutex);
        if (callback.failed.count(file)) return makeStandIn(options).get();
    }
    const osg::ref_ptr<osgDB::ReadFileCallback> previous =
        callback.previous ? callback.previous.get() : osgDB::Registry::instance()->getReadFileCallback();
    const bool local = !previous && !osgDB::containsServerAddress(file);
    const std::string path = local ? osgDB::findDataFile(file, options) : std::string();
    // A name without a file may mean something to the plugin of its extension.
    if (local && osgDB::getLowerCaseFileExtension(file) == "osgb")
    {
        const std::string fault = faultOf(path);
        if (!fault.empty()) return fail(file, fault, options, callback);
    }
    ReadResult result;
    try
    {
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
        return fail(file, exception.what(), options, callback);
    }
    catch (...)
    {
        return fail(file, "its reader throws something that is no std::exception", options, callback);
    }
    if (!result.validNode())
    {
        const std::string message = result.notFound() ? "it is missing" : result.statusMessage();
        return fail(file, message.empty() ? "it holds nothing that can be drawn" : message, options,
                    callback);
    }
    if (!result.loadedFromCache()) tell(*result.getNode(), file);
    std::error_code ignored;
    const std::uintmax_t size = path.empty() ? 0 : std::filesystem::file_size(path, ignored);
    const std::lock_guard<std::mutex> lock(_mutex);
    ++_counts.tilesRead;
    _counts.bytesRead += ignored ? 0 : size;
    return result;
}

ReadResult TileGuard::fail(const std::string& file, const std::string& reason, const osgDB::Options* options,
                           Callback& callback)
{
    {
        const std::lock_guard<std::mutex> lock(_mutex);
        if (callback.failed.insert(file).second) ++_counts.tilesFailed;
        _failed.insert(file);
    }
    warnOnce(file,
             "osgGeoFX: the tile \"" + file + "\" cannot be read (" + reason +
                 "); the coarser one stays in its place. Restore the file or build the database again.");
    return makeStandIn(options).get();
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
