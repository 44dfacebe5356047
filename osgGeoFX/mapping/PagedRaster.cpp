// SPDX-License-Identifier: MIT
// SPDX-FileCopyrightText: 2026 the osgGeoFX authors
#include <osgGeoFX/mapping/PagedRaster.h>

#include <osgGeoFX/mapping/detail/PageCut.h>
#include <osgGeoFX/mapping/detail/TileStore.h>

#include <algorithm>
#include <chrono>
#include <cmath>
#include <cstring>
#include <map>
#include <optional>
#include <set>
#include <utility>

namespace osgGeoFX
{

namespace
{

/// MiB of a tile in main memory: its image. One that is shown has its levels there and on the GPU, too.
constexpr double sizeInMemory = 0.25;
constexpr double sizeShown = sizeInMemory + 2.0 * sizeInMemory * 4.0 / 3.0;
/// The shares of the memory: of tiles in sight, and of other tiles; the rest is for parts of coarse ones.
constexpr double shareInSight = 0.55;
constexpr double shareOfOthers = 0.25;
/// Texels a side of what is shown out of sight.
constexpr int sideOutOfSight = 32;
/// What a camera needed is kept for so many updates after it was seen last.
constexpr std::uint64_t patience = 120;
/// A view that needs too many tiles is coarser by such factors.
constexpr double coarserBy = 1.41421356; // in each step
constexpr int mostCoarser = 24;
/// Between what is in memory and what is needed, every third level is read.
constexpr int levelStep = 3;
/// Texels may be so much larger than a picture needs them, for pages have fixed sizes, and the next finer ones are four times as many. Not those
/// of a raster that draws itself.
constexpr double mostTexel = 1.2;
/// Texels along the longer side of the coarse picture.
constexpr int coarseSide = 256;

/// What a PageCut asks, for one raster.
class TileSight final : public PageSight
{
public:
    /// `scale`: how much larger texels may be than the picture needs them.
    TileSight(PageSight& sight, const PlaneBox& extent, double texel, double scale)
        : _sight(sight), _extent(extent), _texel(texel), _scale(scale)
    {
    }
    bool empty(const PlaneBox& box) override { return !box.overlaps(_extent); }
    bool shows(const SeenGround& ground) override { return _sight.shows(ground); }
    // Nothing is finer than the raster itself.
    double texel(const SeenGround& ground) override
    {
        return std::max(_sight.texel(ground) * _scale, _texel);
    }

private:
    PageSight& _sight;
    const PlaneBox& _extent;
    const double _texel;
    const double _scale;
};

/// A part of a tile that is a tile of a finer level, with so many texels a side at most.
osg::ref_ptr<DataLayer> partOf(const DataLayer& layer, const MappingPage& page, const MappingPage& part,
                               int most)
{
    const int levels = page.level - part.level;
    const std::int64_t count = std::int64_t{1} << std::min(levels, 62);
    const int all = std::max(1, static_cast<int>(TileStore::side / count));
    const int side = std::min(all, most), step = all / side;
    const auto corner = [&](std::int64_t index, std::int64_t first)
    {
        const double share = static_cast<double>(index - first * count) / static_cast<double>(count);
        return std::clamp(static_cast<int>(share * TileStore::side), 0, TileStore::side - all);
    };
    const int column = corner(part.x, page.x), row = corner(part.y, page.y);
    const osg::Image& from = *layer.getImage();
    osg::ref_ptr<osg::Image> image = new osg::Image;
    image->allocateImage(side, side, 1, from.getPixelFormat(), from.getDataType());
    // Colors and values have four bytes.
    for (int y = 0; y < side; ++y)
    {
        for (int x = 0; x < side; ++x)
            std::memcpy(image->data(static_cast<unsigned int>(x), static_cast<unsigned int>(y)),
                        from.data(static_cast<unsigned int>(column + x * step + step / 2),
                                  static_cast<unsigned int>(row + y * step + step / 2)),
                        4);
    }
    osg::ref_ptr<DataLayer> result = new DataLayer(image);
    result->setKind(layer.getKind());
    return result;
}

} // namespace

class PagedRaster::Work
{
    using Clock = std::chrono::steady_clock;

public:
    Work(RasterTiles* tiles, const Options& options, osg::Image* coarse, ProjectiveMapping* mapping)
        : _tiles(tiles), _extent{tiles->low(), tiles->high()}, _texel(tiles->texel()), _options(options),
          _mapping(mapping ? mapping : new ProjectiveMapping),
          _most(static_cast<std::size_t>(std::max(8.0, shareInSight * options.megabytes / sizeShown))),
          _store(tiles, options.threads,
                 _most + static_cast<std::size_t>(shareOfOthers * options.megabytes / sizeInMemory))
    {
        if (!mapping) _mapping->setName(coarse->getFileName());
        const osg::ref_ptr<DataLayer> layer = _mapping->getLayer() ? _mapping->getLayer() : new DataLayer;
        layer->setImage(coarse);
        layer->setKind(tiles->kind());
        _mapping->setLayer(layer);
        if (!mapping && tiles->kind() == DataLayer::VALUE) setRange(*coarse);
        const osg::Vec2d half = (_extent.high - _extent.low) / 2.0;
        _mapping->setRectangle(_extent.low + half, half.x(), half.y());
        const int level = static_cast<int>(std::ceil(std::log2(2.0 * std::max(half.x(), half.y()))));
        _rootLevel = std::clamp(level, MappingPage::finest, MappingPage::coarsest);
    }

    /// Reads the coarsest tiles.
    bool start(std::string& error)
    {
        bool all = true;
        eachRoot([&](const MappingPage& page) { all = all && _store.readNow(page, error); });
        return all;
    }

    void see(const void* camera, const std::vector<SeenGround>& seen, PageSight& sight)
    {
        using Cut = std::optional<std::vector<MappingPage>>;
        PageCut maker;
        const auto cutAt = [&](int step) -> Cut
        {
            TileSight own(sight, _extent, _texel,
                          std::pow(coarserBy, step) * (_tiles->hasLengthsInPixels() ? 1.0 : mostTexel));
            return maker.make(seen, own, _most);
        };
        int step = 0;
        {
            const std::lock_guard<std::mutex> lock(_mutex);
            step = _demands[camera].coarser;
        }
        // The finest one that there is memory for; as a rule it is as fine as in the last frame.
        Cut cut = cutAt(step);
        while (!cut && step < mostCoarser)
            cut = cutAt(++step);
        while (cut && step > 0)
        {
            Cut finer = cutAt(step - 1);
            if (!finer) break;
            cut = std::move(finer);
            --step;
        }
        const std::lock_guard<std::mutex> lock(_mutex);
        Demand& demand = _demands[camera];
        demand.time = _time;
        demand.coarser = step;
        // Roots are coarse enough, and there.
        std::set<MappingPage> pages;
        for (const MappingPage& page : cut.value_or(std::vector<MappingPage>()))
        {
            if (page.level < _rootLevel) pages.insert(page);
        }
        // The next frame shows them, or asks for them.
        if (pages != demand.pages) _statistics.settled = false;
        demand.pages = std::move(pages);
    }

    bool update(Parts& parts)
    {
        const std::lock_guard<std::mutex> lock(_mutex);
        ++_time;
        const bool look = _revision != _mapping->revision();
        collect();
        _store.setCoarseness(std::pow(coarserBy, _coarser));
        _store.want(missing());
        const auto now = Clock::now();
        const std::chrono::duration<double, std::milli> frame = now - _updated;
        _updated = now;
        _budget =
            std::clamp(static_cast<int>(0.1 * std::min(frame.count(), 1e3)), _options.tilesPerFrame, 64);
        _pending = false;
        Leaves leaves;
        eachRoot([&](const MappingPage& page) { visit(page, page, _store.find(page), leaves); });
        bool same = !look && leaves.size() == _leaves.size();
        for (auto& [page, leaf] : leaves)
        {
            const auto former = _leaves.find(page);
            const bool stays =
                !look && former != _leaves.end() && former->second.part && former->second.layer == leaf.layer;
            leaf.part = stays ? former->second.part : partFor(page, leaf.layer);
            same = same && stays;
        }
        _revision = _mapping->revision();
        _leaves = std::move(leaves);
        settle(same);
        if (same) return false;
        parts.clear();
        for (const auto& [page, leaf] : _leaves)
            parts.push_back(leaf.part);
        return true;
    }

    /// Nothing is shown any more.
    void reset()
    {
        const std::lock_guard<std::mutex> lock(_mutex);
        _leaves.clear();
    }

    Statistics statistics() const
    {
        const TileStore::Count count = _store.count();
        const std::lock_guard<std::mutex> lock(_mutex);
        Statistics all = _statistics;
        all.inMemory = count.inMemory;
        all.failed = count.failed;
        all.read = count.read;
        all.megabytes = sizeInMemory * count.inMemory + _shownMegabytes;
        return all;
    }

    Tile tileAt(const osg::Vec2d& place)
    {
        const PlaneBox at{place, place};
        if (!at.overlaps(_extent)) return {};
        for (int level = MappingPage::finest; level <= _rootLevel; ++level)
        {
            const double side = MappingPage::sideOf(level);
            // The last of finer ones than the raster's pixels.
            if (level < _rootLevel && 2.0 * side <= TileStore::side * _texel) continue;
            const auto cell = [&](double metres)
            {
                return static_cast<std::int64_t>(std::floor(metres / side));
            };
            const MappingPage page{level, cell(place.x()), cell(place.y())};
            const osg::ref_ptr<DataLayer> layer = _store.find(page);
            if (layer) return {layer, page.square().low, page.square().high};
        }
        return {};
    }

    /// With some room for parts of tiles.
    int pagesOf(int side) const
    {
        const double tiles = std::pow(std::max(side, TileStore::side) / TileStore::side, 2.0);
        return static_cast<int>(std::ceil(1.25 * static_cast<double>(_most) / tiles));
    }

    ProjectiveMapping* mapping() const { return _mapping; }
    const Options& options() const { return _options; }
    const RasterTiles& tiles() const { return *_tiles; }
    const PlaneBox& extent() const { return _extent; }

private:
    /// Values are greys from the lowest to the highest, unless a program says otherwise.
    void setRange(const osg::Image& values)
    {
        double low = 9e7, high = -9e7;
        for (int y = 0; y < values.t(); ++y)
        {
            const auto* row = reinterpret_cast<const float*>(values.data(0, static_cast<unsigned int>(y)));
            for (int x = 0; x < values.s(); ++x)
            {
                const auto value = static_cast<double>(row[x]);
                if (!(std::abs(value) <= 9e7)) continue;
                low = std::min(low, value);
                high = std::max(high, value);
            }
        }
        if (low < high) _mapping->getTransfer()->setValueRange(low, high);
    }

    /// What is shown on a square.
    struct Leaf
    {
        MappingPage source; ///< the tile that it is, or is a part of
        osg::ref_ptr<DataLayer> layer;
        osg::ref_ptr<ProjectiveMapping> part;
        int most = 0; ///< texels a side that a part of a tile may have
    };
    using Leaves = std::map<MappingPage, Leaf>;
    struct Demand
    {
        std::set<MappingPage> pages;
        std::uint64_t time = 0;
        int coarser = 0; ///< by so many steps than it wants
    };

    template<class Action>
    void eachRoot(const Action& action) const
    {
        const double side = MappingPage::sideOf(_rootLevel);
        const auto cell = [&](double metres)
        {
            return static_cast<std::int64_t>(std::floor(metres / side));
        };
        for (std::int64_t y = cell(_extent.low.y()); y <= cell(_extent.high.y()); ++y)
        {
            for (std::int64_t x = cell(_extent.low.x()); x <= cell(_extent.high.x()); ++x)
                action(MappingPage{_rootLevel, x, y});
        }
    }

    /// What all cameras want, and what lies above that.
    void collect()
    {
        _wanted.clear();
        _above.clear();
        int coarser = mostCoarser + 1, most = 0;
        for (auto demand = _demands.begin(); demand != _demands.end();)
        {
            if (demand->second.time + patience < _time)
            {
                demand = _demands.erase(demand);
                continue;
            }
            _wanted.insert(demand->second.pages.begin(), demand->second.pages.end());
            coarser = std::min(coarser, demand->second.coarser);
            most = std::max(most, demand->second.coarser);
            ++demand;
        }
        for (const MappingPage& page : _wanted)
        {
            for (int level = page.level + 1; level <= _rootLevel; ++level)
            {
                if (!_above.insert(page.above(level - page.level)).second) break;
            }
        }
        _statistics.coarser = most > 0;
        // While nobody looks, tiles stay as they are. Of several cameras the finest one counts: in the others lines are wider.
        if (!_demands.empty()) _coarser = coarser;
    }

    /// What is wanted, with some coarser tiles, the coarsest first.
    std::vector<MappingPage> missing() const
    {
        std::set<MappingPage> all = _wanted;
        for (const MappingPage& page : _above)
        {
            if ((_rootLevel - page.level) % levelStep == 0) all.insert(page);
        }
        return {all.begin(), all.end()};
    }

    /// `source`, `layer`: the finest tile at or above the page that is in memory.
    void visit(const MappingPage& page, const MappingPage& source, const osg::ref_ptr<DataLayer>& layer,
               Leaves& leaves)
    {
        if (!page.square().overlaps(_extent)) return;
        if (_above.count(page) == 0)
        {
            leaves[page] = leafOf(page, source, layer);
            return;
        }
        for (int i = 0; i < 4; ++i)
        {
            const MappingPage child = page.child(i);
            const osg::ref_ptr<DataLayer> own = ownLayer(child);
            visit(child, own ? child : source, own ? own : layer, leaves);
        }
    }

    /// A tile's own layer, if it may be shown now.
    osg::ref_ptr<DataLayer> ownLayer(const MappingPage& page)
    {
        const osg::ref_ptr<DataLayer> own = _store.find(page);
        // What is above of what is shown costs nothing.
        if (!own || _above.count(page) > 0) return own;
        const auto former = _leaves.find(page);
        if (former != _leaves.end() && former->second.layer == own) return own;
        if (_budget == 0)
        {
            _pending = _pending || _wanted.count(page) > 0;
            return nullptr;
        }
        --_budget;
        return own;
    }

    Leaf leafOf(const MappingPage& page, const MappingPage& source, const osg::ref_ptr<DataLayer>& layer)
    {
        if (page == source) return {source, layer, nullptr, 0};
        const int most = _wanted.count(page) > 0 ? TileStore::side : sideOutOfSight;
        const auto former = _leaves.find(page);
        if (former != _leaves.end() && former->second.source == source && former->second.most == most)
            return former->second;
        return {source, partOf(*layer, source, page, most), nullptr, most};
    }

    osg::ref_ptr<ProjectiveMapping> partFor(const MappingPage& page,
                                            const osg::ref_ptr<DataLayer>& layer) const
    {
        // Nothing that could be changed while a camera draws with it: all but the table is its own.
        osg::ref_ptr<ProjectiveMapping> part = new ProjectiveMapping;
        for (const Property& property : part->properties())
            property.put(*part, property.get(*_mapping));
        part->setTable(_mapping->getTable());
        part->setTransfer(new ColorTransfer(*_mapping->getTransfer()));
        const PlaneBox square = page.square();
        const osg::Vec2d half = (square.high - square.low) / 2.0;
        part->setRectangle(square.low + half, half.x(), half.y());
        // Tiles must meet without a seam.
        part->setSoftEdges(false);
        layer->setSmooth(_mapping->getLayer() ? _mapping->getLayer()->getSmooth() : true);
        part->setLayer(layer);
        return part;
    }

    /// `same`: whether all is shown as it was. Otherwise another camera may have drawn this frame before it was.
    void settle(bool same)
    {
        _statistics.shown = static_cast<int>(_leaves.size());
        _shownMegabytes = 0.0;
        for (const auto& [page, leaf] : _leaves)
        {
            const double share = std::pow(1.0 * leaf.layer->getImage()->s() / TileStore::side, 2.0);
            // Parts have an image of their own.
            _shownMegabytes += share * (leaf.source == page ? sizeShown - sizeInMemory : sizeShown);
        }
        _statistics.wanted = static_cast<int>(_wanted.size());
        _statistics.waiting = 0;
        _statistics.fault.clear();
        // Coarser ones, too: they show where a finer one cannot be read.
        for (const MappingPage& page : missing())
        {
            if (!_store.isDone(page)) ++_statistics.waiting;
            if (_statistics.fault.empty()) _statistics.fault = _store.faultOf(page);
        }
        _statistics.settled = same && _statistics.waiting == 0 && !_pending;
    }

    const osg::ref_ptr<RasterTiles> _tiles;
    const PlaneBox _extent;
    const double _texel;
    const Options _options;
    const osg::ref_ptr<ProjectiveMapping> _mapping;
    const std::size_t _most;
    int _rootLevel = 0;
    TileStore _store;

    mutable std::mutex _mutex;
    std::map<const void*, Demand> _demands; ///< of cameras
    std::uint64_t _time = 0;
    std::set<MappingPage> _wanted, _above;
    Leaves _leaves;
    unsigned int _revision = 0;
    int _budget = 0;
    Clock::time_point _updated;
    bool _pending = false;
    double _shownMegabytes = 0.0;
    int _coarser = 0; ///< the steps for which tiles are read
    Statistics _statistics;
};

osg::ref_ptr<PagedRaster> PagedRaster::create(RasterTiles* tiles, const Options& options, std::string& error,
                                              ProjectiveMapping* mapping)
{
    const auto refuse = [&](const std::string& name, int value, int least, int most)
    {
        if (value >= least && value <= most) return false;
        error = "PagedRaster: " + name + " must be " + std::to_string(least) + " to " + std::to_string(most) +
                ", not " + std::to_string(value) + ".";
        return true;
    };
    if (refuse("megabytes", options.megabytes, 32, 65536) || refuse("threads", options.threads, 1, 16) ||
        refuse("tilesPerFrame", options.tilesPerFrame, 1, 64))
        return nullptr;
    const osg::Vec2d size = tiles ? tiles->high() - tiles->low() : osg::Vec2d();
    if (!(size.x() > 0.0 && size.y() > 0.0 && tiles->texel() > 0.0))
    {
        error = "PagedRaster: the raster covers no area; give it one.";
        return nullptr;
    }
    const double texel = std::max(std::max(size.x(), size.y()) / coarseSide, tiles->texel());
    const auto texels = [&](double metres)
    {
        return std::clamp(static_cast<int>(std::lround(metres / texel)), 1, coarseSide);
    };
    const int columns = texels(size.x()), rows = texels(size.y());
    const osg::ref_ptr<osg::Image> coarse = tiles->read(tiles->low(), tiles->high(), columns, rows, error);
    if (!coarse) return nullptr;
    error = TileStore::faultOf(*coarse, columns, rows, tiles->kind());
    if (!error.empty()) return nullptr;
    osg::ref_ptr<PagedRaster> raster = new PagedRaster(tiles, options, coarse, mapping);
    if (!raster->_work->start(error)) return nullptr;
    return raster;
}

PagedRaster::PagedRaster(RasterTiles* tiles, const Options& options, osg::Image* coarse,
                         ProjectiveMapping* mapping)
    : _work(std::make_unique<Work>(tiles, options, coarse, mapping))
{
}

PagedRaster::~PagedRaster() = default;

ProjectiveMapping* PagedRaster::getMapping()
{
    return _work->mapping();
}

const ProjectiveMapping* PagedRaster::getMapping() const
{
    return _work->mapping();
}

const PagedRaster::Options& PagedRaster::getOptions() const
{
    return _work->options();
}

const RasterTiles& PagedRaster::tiles() const
{
    return _work->tiles();
}

PagedRaster::Statistics PagedRaster::statistics() const
{
    return _work->statistics();
}

PagedRaster::Tile PagedRaster::tileAt(const osg::Vec2d& place) const
{
    return _work->tileAt(place);
}

osg::Vec2d PagedRaster::low() const
{
    return _work->extent().low;
}

osg::Vec2d PagedRaster::high() const
{
    return _work->extent().high;
}

int PagedRaster::pagesOf(int side) const
{
    return _work->pagesOf(side);
}

void PagedRaster::see(const void* camera, const std::vector<SeenGround>& seen, PageSight& sight)
{
    _work->see(camera, seen, sight);
}

void PagedRaster::reset()
{
    _work->reset();
}

bool PagedRaster::update(Parts& parts)
{
    return _work->update(parts);
}

RasterTiles::RasterTiles() = default;
RasterTiles::~RasterTiles() = default;

osg::ref_ptr<osg::Image> RasterTiles::readCoarser(const osg::Vec2d& from, const osg::Vec2d& to, int columns,
                                                  int rows, double, std::string& error)
{
    return read(from, to, columns, rows, error);
}

} // namespace osgGeoFX
