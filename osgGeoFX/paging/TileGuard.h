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

/// Is told of the tiles that a pager brings; TileGuard::addListener().
class OSGGEOFX_EXPORT TileListener : public osg::Referenced
{
public:
    /// A tile was read. Called on the thread that reads, before any other sees the tile; several pagers' threads may call
    /// it at once.
    virtual void tileRead(osg::Node& tile) = 0;

protected:
    TileListener() : osg::Referenced(true) {}
    ~TileListener() override;
};

/** Makes a missing or damaged tile of a paged scene harmless: its parent stays on screen, one warning names the
    file and the reason, and the pager does not ask for it again and again.

    It stands in the database options of the scene's PagedLODs (those loaded later included), in front of any
    ReadFileCallback that is there. In place of a tile that cannot be read it hands the pager a node that draws
    what the parent draws. Before OSG reads an .osgb tile its header is checked; the content of one written
    with `Compressor=zlib`, as ours are, is protected by its own checksum. Other formats are passed to OSG as
    they are, and only what throws is caught.

    Once failed, a file is not tried again with the same options, in the lifetime of these. PagedLODs with options of their
    own may use one file name for tiles that differ, as loaders do that find in the options what to read. Thread-safe, in
    all of OSG's threading models and for any number of pager threads. */
class OSGGEOFX_EXPORT TileGuard : public osg::Referenced
{
public:
    struct Counts
    {
        std::uint64_t tilesRead = 0;
        std::uint64_t bytesRead = 0; ///< sizes of the files
        std::uint64_t tilesFailed = 0;
    };

    /// Guards all PagedLODs at and below the node; call it before the scene is drawn, or in the update phase.
    /// Returns the guard that is already there, if any (a .geofx scene brings its own).
    static osg::ref_ptr<TileGuard> install(osg::Node* node);

    /// Why OSG should not be handed a file: it is missing or, if an .osgb, has a bad header. Empty if nothing is found.
    /// `path` is empty for a file that was not found.
    static std::string faultOf(const std::string& path);

    TileGuard();

    /// Tells a listener of each tile that is read from now on. What it throws is a warning, once for each tile's file, and the tile
    /// is drawn nonetheless. It is held weakly: who adds it keeps it. Null and one that is there
    /// already are ignored. Tiles that OSG takes from its cache of objects, and those that failed, are not told of.
    void addListener(TileListener* listener);
    /// It may still be told of a tile that is just being read.
    void removeListener(TileListener* listener);

    /// Totals since the guard was made.
    Counts counts() const;
    std::set<std::string> failedFiles() const;

protected:
    ~TileGuard() override;

private:
    class Callback;
    class Installer;

    void tell(osg::Node& tile, const std::string& file);
    void warnOnce(const std::string& file, const std::string& sentence);
    osg::ref_ptr<osgDB::Options> guardedOptions(osgDB::Options* original);
    osgDB::ReaderWriter::ReadResult read(const std::string& file, const osgDB::Options* options,
                                         Callback& callback);
    osgDB::ReaderWriter::ReadResult fail(const std::string& file, const std::string& reason,
                                         const osgDB::Options* options, Callback& callback);

    mutable std::mutex _mutex;
    std::set<std::string> _failed, _warned; ///< file names
    Counts _counts;
    std::vector<osg::observer_ptr<TileListener>> _listeners;
    struct Guarded
    {
        osg::observer_ptr<osgDB::Options> original, guarded;
    };
    /// From original options, which only their PagedLODs keep, to guarded ones, which hold the guard, so it must not hold
    /// them. An entry of options that are gone is removed when there are `_purgeSize`.
    std::map<const osgDB::Options*, Guarded> _options;
    std::size_t _purgeSize = 64;
};

} // namespace osgGeoFX
