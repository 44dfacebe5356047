// SPDX-License-Identifier: MIT
// SPDX-FileCopyrightText: 2026 the osgGeoFX authors
#include <osgGeoFX/mapping/detail/TileStore.h>

#include <osg/Notify>

#include <algorithm>
#include <iterator>
#include <string>

namespace osgGeoFX
{

TileStore::TileStore(RasterTiles* tiles, int threads, std::size_t most) : _tiles(tiles), _most(most)
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

osg::ref_ptr<DataLayer> TileStore::read(const MappingPage& page, std::string& error) const
{
    const PlaneBox square = page.square();
    const osg::ref_ptr<osg::Image> image = _tiles->read(square.low, square.high, side, side, error);
    if (!image) return nullptr;
    error = faultOf(*image, side, side, _tiles->kind());
    if (!error.empty()) return nullptr;
    osg::ref_ptr<DataLayer> layer = new DataLayer(image);
    layer->setKind(_tiles->kind());
    return layer;
}

osg::ref_ptr<DataLayer> TileStore::readNow(const MappingPage& page, std::string& error)
{
    const osg::ref_ptr<DataLayer> layer = read(page, error);
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
        for (auto page = pages.rbegin(); page != pages.rend(); ++page)
        {
            const auto found = _all.find(*page);
            if (found == _all.end())
                _queue.push_back(*page);
            else
                found->second.used = _time;
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

bool TileStore::hasFailed(const MappingPage& page) const
{
    const std::lock_guard<std::mutex> lock(_mutex);
    const auto found = _all.find(page);
    return found != _all.end() && found->second.failed;
}

TileStore::Count TileStore::count() const
{
    const std::lock_guard<std::mutex> lock(_mutex);
    Count count;
    count.inMemory = static_cast<int>(
        std::count_if(_all.begin(), _all.end(), [](const auto& each) { return each.second.layer.valid(); }));
    count.failed = _failed;
    count.read = _read;
    return count;
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
        if (!isNew) continue; // another thread reads it
        entry->second.used = _time;
        lock.unlock();
        std::string error;
        const osg::ref_ptr<DataLayer> layer = read(page, error);
        lock.lock();
        Tile& tile = _all[page];
        tile.layer = layer;
        if (layer)
            ++_read;
        else
        {
            tile.failed = true;
            if (_failed++ == 0) OSG_WARN << "osgGeoFX: PagedRaster: " << error << std::endl;
        }
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
