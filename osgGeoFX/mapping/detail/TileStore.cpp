// SPDX-License-Identifier: MIT
// SPDX-FileCopyrightText: 2026 the osgGeoFX authors
#include <osgGeoFX/mapping/detail/TileStore.h>

#include <osg/Notify>

#include <algorithm>
#include <cmath>
#include <iterator>
#include <string>
#include <utility>

namespace osgGeoFX
{

TileStore::TileStore(RasterTiles* tiles, int threads, std::size_t most)
    : _tiles(tiles), _remakes(tiles->hasLengthsInPixels()), _most(most)
{
    for (int i = 0; i < threads; ++i)
        _threads.emplace_back([this] { work(); });
}

TileStore::~TileStore()
{
    {
        const std::lock_guard<std::mutex> lock(_mutex);
        _over = true;
    }
    _news.notify_all();
    for (std::thread& each : _threads)
        each.join();
}

std::string TileStore::faultOf(const osg::Image& image, int columns, int rows, DataLayer::Kind kind)
{
    const bool color = kind == DataLayer::COLOR;
    const bool right = image.s() == columns && image.t() == rows && image.data() &&
                       image.getDataType() == (color ? GL_UNSIGNED_BYTE : GL_FLOAT) &&
                       (color ? image.getPixelFormat() == GL_RGBA
                              : osg::Image::computeNumComponents(image.getPixelFormat()) == 1);
    if (right) return {};
    return "A tile of the raster \"" + image.getFileName() + "\" is not " + std::to_string(columns) + " x " +
           std::to_string(rows) + (color ? " pixels of GL_RGBA bytes" : " values, a float each") +
           "; RasterTiles::read() must make it so.";
}

osg::ref_ptr<DataLayer> TileStore::read(const MappingPage& page, double coarseness, std::string& error) const
{
    const PlaneBox square = page.square();
    const osg::ref_ptr<osg::Image> image =
        _tiles->readCoarser(square.low, square.high, side, side, coarseness, error);
    if (!image) return nullptr;
    error = faultOf(*image, side, side, _tiles->kind());
    if (!error.empty()) return nullptr;
    osg::ref_ptr<DataLayer> layer = new DataLayer(image);
    layer->setKind(_tiles->kind());
    return layer;
}

osg::ref_ptr<DataLayer> TileStore::readNow(const MappingPage& page, std::string& error)
{
    const osg::ref_ptr<DataLayer> layer = read(page, 1.0, error);
    if (!layer) return nullptr;
    const std::lock_guard<std::mutex> lock(_mutex);
    Tile& tile = _all[page];
    tile.layer = layer;
    tile.kept = true;
    ++_read;
    return layer;
}

void TileStore::want(const std::vector<MappingPage>& pages)
{
    {
        const std::lock_guard<std::mutex> lock(_mutex);
        ++_time;
        _queue.clear();
        _wanted = std::set<MappingPage>(pages.begin(), pages.end());
        for (const bool again : {true, false})
        {
            for (auto page = pages.rbegin(); page != pages.rend(); ++page)
            {
                const auto found = _all.find(*page);
                if (found != _all.end()) found->second.used = _time;
                if (again ? found != _all.end() && isDue(found->second) : found == _all.end())
                    _queue.push_back(*page);
            }
        }
    }
    _news.notify_all();
}

osg::ref_ptr<DataLayer> TileStore::find(const MappingPage& page)
{
    const std::lock_guard<std::mutex> lock(_mutex);
    const auto found = _all.find(page);
    if (found == _all.end()) return nullptr;
    found->second.used = _time;
    return found->second.layer;
}

void TileStore::setCoarseness(double coarseness)
{
    const std::lock_guard<std::mutex> lock(_mutex);
    _coarseness = coarseness;
}

bool TileStore::isDone(const MappingPage& page) const
{
    const std::lock_guard<std::mutex> lock(_mutex);
    const auto found = _all.find(page);
    if (found == _all.end()) return false;
    return found->second.failures > 0 || (found->second.layer && !isStale(found->second));
}

TileStore::Count TileStore::count() const
{
    const std::lock_guard<std::mutex> lock(_mutex);
    Count count;
    count.inMemory = static_cast<int>(
        std::count_if(_all.begin(), _all.end(), [](const auto& each) { return each.second.layer.valid(); }));
    count.failed = static_cast<int>(
        std::count_if(_all.begin(), _all.end(), [](const auto& each) { return each.second.failures > 0; }));
    count.read = _read;
    return count;
}

std::string TileStore::faultOf(const MappingPage& page) const
{
    const std::lock_guard<std::mutex> lock(_mutex);
    const auto found = _all.find(page);
    return found == _all.end() ? std::string() : found->second.fault;
}

void TileStore::fail(Tile& tile, const std::string& error)
{
    constexpr double first = 1.0, longest = 60.0; // seconds
    const double delay = std::min(longest, first * std::pow(2.0, std::min(tile.failures++, 10)));
    tile.again =
        Clock::now() + std::chrono::duration_cast<Clock::duration>(std::chrono::duration<double>(delay));
    tile.fault = error;
    if (std::exchange(_hasWarned, true)) return;
    OSG_WARN << "osgGeoFX: PagedRaster: " << error << std::endl;
}

void TileStore::work()
{
    std::unique_lock<std::mutex> lock(_mutex);
    for (;;)
    {
        _news.wait(lock, [this] { return _over || !_queue.empty(); });
        if (_over) return;
        const MappingPage page = _queue.back();
        _queue.pop_back();
        const auto [entry, isNew] = _all.try_emplace(page);
        if (entry->second.reading || (!isNew && !isDue(entry->second))) continue; // another thread reads it
        entry->second.used = _time;
        entry->second.reading = true;
        const double coarseness = _coarseness;
        lock.unlock();
        std::string error;
        const osg::ref_ptr<DataLayer> layer = read(page, coarseness, error);
        lock.lock();
        Tile& tile = _all[page];
        tile.coarseness = coarseness;
        tile.reading = false;
        if (layer)
        {
            tile.layer = layer;
            tile.failures = 0;
            tile.fault.clear();
            ++_read;
        }
        else
            fail(tile, error);
        evict();
    }
}

/// Lets go of the tiles that were used longest ago.
void TileStore::evict()
{
    std::vector<std::pair<std::uint64_t, MappingPage>> free;
    std::size_t count = 0;
    for (const auto& [page, tile] : _all)
    {
        if (tile.layer) ++count;
        if (tile.layer && !tile.kept && _wanted.count(page) == 0) free.emplace_back(tile.used, page);
    }
    if (count <= _most) return;
    const auto end = free.begin() + static_cast<std::ptrdiff_t>(std::min(free.size(), count - _most));
    std::nth_element(free.begin(), end, free.end());
    std::for_each(free.begin(), end, [this](const auto& each) { _all.erase(each.second); });
}

} // namespace osgGeoFX
