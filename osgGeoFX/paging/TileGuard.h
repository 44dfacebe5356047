// SPDX-License-Identifier: MIT
// SPDX-FileCopyrightText: 2026 the osgGeoFX authors
#pragma once

#include <osgGeoFX/Export.h>

#include <osg/Node>
#include <osg/Referenced>
#include <osg/observer_ptr>
#include <osg/ref_ptr>
#include <osgDB/Options>

#include <cstdint>
#include <map>
#include <mutex>
#include <set>
#include <string>
#include <vector>

namespace osgGeoFX
{

class FilesByOthers;

/// Is told of the tiles that a pager reads; see TileGuard::addListener().
/// @ingroup paging
class OSGGEOFX_EXPORT TileListener : public osg::Referenced
{
public:
    /// Called when a tile was read, on the thread that reads it and before any other thread sees the tile. The threads
    /// of several pagers may call it at once.
    virtual void tileRead(osg::Node& tile) = 0;

protected:
    TileListener() : osg::Referenced(true) {}
    ~TileListener() override;
};

/** Makes a missing or damaged tile of a paged scene harmless. The parent of the tile stays on screen, one warning
    names the file and the reason, and the pager does not ask for the tile again and again.

    The guard stands in the database options of the scene's PagedLODs, including those that are loaded later. It acts
    before any ReadFileCallback that is there already. Instead of a tile that cannot be read, it gives the pager a
    node that draws the same as the parent. It checks the header of an .osgb tile before OSG reads the tile. A
    checksum of zlib protects the content of a tile that was written with `Compressor=zlib`, as those of
    osggeofx_build are. The guard passes other formats to OSG as they are and only catches exceptions.

    Tiles of web servers are read through RemoteFiles, so they come from OSG's file cache where it has them. A tile that
    a server did not send is tried again when it is in sight and some time has passed (setRetryDelay()). If a server
    does not answer, there is one warning for all its tiles, and one more if that happens again later.

    A file on a disk that could not be read, because it or its folder is missing or because the disk fails, is tried again
    after 0.5 s while it is in sight. Each further failure doubles that time, up to that of setRetryDelay(). A file
    that was read twice and is damaged is left alone until it changes. If a folder is missing, there is one warning for all its
    tiles. PagedLODs with options of their own may use one file name for different tiles. Some loaders do so and find in
    the options what to read.
    Thread-safe, in all of OSG's threading models and for any number of pager threads.

    @ingroup paging */
class OSGGEOFX_EXPORT TileGuard : public osg::Referenced
{
public:
    /// Totals of the tiles that the guard has handled.
    struct Counts
    {
        std::uint64_t tilesRead = 0;
        std::uint64_t bytesRead = 0; ///< sizes of the files
        std::uint64_t tilesFailed = 0;
    };

    /// Guards all PagedLODs at and below the node. Call it before the scene is drawn, or in the update phase. Returns
    /// the guard that is already there, if any (a .geofx scene brings its own). With `files`, the files of all these
    /// PagedLODs are read as those of somebody else; if the guard is there already, it keeps the files that it has.
    static osg::ref_ptr<TileGuard> install(osg::Node* node, FilesByOthers* files = nullptr);

    /// Options to read the files of PagedLODs at and below a node in another way than by a pager: with the limits of
    /// somebody else's files, if there are any, and without stand-ins and listeners. Null if no limits hold.
    static osg::ref_ptr<osgDB::Options> readingOptions(const osg::Node& node);

    /// The reason why OSG should not read a file: it is missing or, if it is an .osgb, has a bad header. Empty if no
    /// fault is found. `path` is empty for a file that was not found.
    static std::string faultOf(const std::string& path);

    TileGuard();

    /// How long a tile of a server that failed is left alone, 0.01…3,600 seconds; at first 10. Each further failure
    /// doubles it, up to 32 times. A file on a disk is left alone for this time at most. It holds for the next failures.
    void setRetryDelay(double seconds);

    /// Tells a listener of each tile that is read from now on. If the listener throws, there is one warning for each
    /// tile's file, and the tile is drawn nonetheless. The guard does not keep the listener alive; the caller must.
    /// Null, and a listener that was added before, are ignored. Listeners are not told of tiles that OSG takes from its
    /// object cache, nor of those that failed.
    void addListener(TileListener* listener);
    /// Removes a listener. It may still be told of a tile that is being read at this moment.
    void removeListener(TileListener* listener);

    /// Totals since the guard was made.
    Counts counts() const;
    /// The names of all files that failed, without those that were read later.
    std::set<std::string> failedFiles() const;

protected:
    ~TileGuard() override;

private:
    class Callback;
    class Installer;
    struct Attempt;

    void tell(osg::Node& tile, const std::string& file);
    void warnOnce(const std::string& file, const std::string& sentence);
    osg::ref_ptr<osgDB::Options> guardedOptions(osgDB::Options* original);
    osgDB::ReaderWriter::ReadResult read(const std::string& file, const osgDB::Options* options,
                                         Callback& callback);
    osgDB::ReaderWriter::ReadResult fail(const std::string& file, const std::string& reason,
                                         const Attempt& attempt, const osgDB::Options* options,
                                         Callback& callback);

    osgDB::ReaderWriter::ReadResult readRemote(const std::string& file, const osgDB::Options* options,
                                               const osgDB::Options* limited, Callback& callback);
    osgDB::ReaderWriter::ReadResult failRemote(const std::string& file, const osgDB::Options* options,
                                               Callback& callback);

    mutable std::mutex _mutex;
    std::set<std::string> _failed, _warned; ///< file names; warned of: servers and folders, too
    double _retryDelay = 10.0;              ///< seconds
    Counts _counts;
    osg::ref_ptr<FilesByOthers> _files;
    std::vector<osg::observer_ptr<TileListener>> _listeners;
    struct Guarded
    {
        osg::observer_ptr<osgDB::Options> original, guarded;
    };
    /// From original options to guarded ones. Only the PagedLODs keep the original options. The guarded ones hold the
    /// guard, so the guard must not hold them. Entries of options that no longer exist are removed when there are
    /// `_purgeSize` entries.
    std::map<const osgDB::Options*, Guarded> _options;
    std::size_t _purgeSize = 64;
};

} // namespace osgGeoFX
