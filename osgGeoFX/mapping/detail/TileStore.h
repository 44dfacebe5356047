// SPDX-License-Identifier: MIT
// SPDX-FileCopyrightText: 2026 the osgGeoFX authors
#pragma once

#include <osgGeoFX/mapping/DataLayer.h>
#include <osgGeoFX/mapping/RasterTiles.h>
#include <osgGeoFX/mapping/detail/MappingPage.h>

#include <chrono>
#include <condition_variable>
#include <cstddef>
#include <cstdint>
#include <map>
#include <mutex>
#include <set>
#include <string>
#include <thread>
#include <vector>

namespace osgGeoFX
{

/** The tiles of a raster that are in memory. Threads of its own read those that are wanted, in their order; those that were wanted
    longest ago make room. A tile that cannot be read is read again after a second while it is wanted, and then after times that double, up to a
    minute. A tile is the square of a MappingPage. Thread-safe. */
class TileStore
{
public:
    /// Texels a side of a tile.
    static constexpr int side = 256;

    /// `most`: tiles in memory, unless more are wanted.
    TileStore(RasterTiles* tiles, int threads, std::size_t most);
    /// Waits for the reads that are under way.
    ~TileStore();
    TileStore(const TileStore&) = delete;
    TileStore& operator=(const TileStore&) = delete;

    /// Why an image is no such rectangle of a raster; empty if it is.
    static std::string faultOf(const osg::Image& image, int columns, int rows, DataLayer::Kind kind);

    /// Reads a tile now, and keeps it for good. Null, with a sentence in `error`, if it cannot.
    osg::ref_ptr<DataLayer> readNow(const MappingPage& page, std::string& error);
    /// From now on tiles are read for this (RasterTiles::readCoarser()). Of a raster that has lengths in pixels, those in memory are read again
    /// where they are wanted, after all that are missing, and stay until then.
    void setCoarseness(double coarseness);
    /// From now on these are read, the first ones first, and those that were wanted before are not.
    void want(const std::vector<MappingPage>& pages);
    /// A tile that is in memory; null for others. What is asked for stays longer.
    osg::ref_ptr<DataLayer> find(const MappingPage& page);

    struct Count
    {
        int inMemory = 0;
        int failed = 0; ///< those that could not be read when they were last tried
        std::size_t read = 0;
    };
    Count count() const;
    /// Why a tile could not be read when it was last tried; empty if it could.
    std::string faultOf(const MappingPage& page) const;
    /// Whether a tile is in memory as it should be, or could not be read when it was last tried.
    bool isDone(const MappingPage& page) const;

private:
    using Clock = std::chrono::steady_clock;
    struct Tile
    {
        osg::ref_ptr<DataLayer> layer; ///< null while it is read for the first time, and if it has failed
        double coarseness = 1.0;       ///< for which it was read
        bool reading = false;
        std::uint64_t used = 0;
        bool kept = false;
        int failures = 0;        ///< in a row
        Clock::time_point again; ///< when it is tried again, if it has failed
        std::string fault;       ///< of the last try
    };
    osg::ref_ptr<DataLayer> read(const MappingPage& page, double coarseness, std::string& error) const;
    bool isStale(const Tile& tile) const { return tile.coarseness != _coarseness && _remakes; }
    /// Whether a tile that was read, or could not be, is to be read again now.
    bool isDue(const Tile& tile) const
    {
        return tile.failures > 0 ? Clock::now() >= tile.again : tile.layer && isStale(tile);
    }
    void fail(Tile& tile, const std::string& error);
    void work();
    void evict();

    const osg::ref_ptr<RasterTiles> _tiles;
    const bool _remakes; ///< tiles when the coarseness changes
    const std::size_t _most;
    mutable std::mutex _mutex;
    std::condition_variable _news;
    bool _over = false;
    std::vector<MappingPage> _queue; ///< the next one last
    std::set<MappingPage> _wanted;
    std::map<MappingPage, Tile> _all;
    std::uint64_t _time = 0;
    double _coarseness = 1.0;
    std::size_t _read = 0;
    bool _hasWarned = false;
    std::vector<std::thread> _threads;
};

} // namespace osgGeoFX
