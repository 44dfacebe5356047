// SPDX-License-Identifier: MIT
// SPDX-FileCopyrightText: 2026 the osgGeoFX authors
#include <osgGeoFX/geodata/TiledRaster.h>

#include <osgGeoFX/geodata/BuildError.h>
#include <osgGeoFX/geodata/FileSources.h>
#include <osgGeoFX/geodata/OverlayRaster.h>
#include <osgGeoFX/geodata/detail/CubeFace.h>
#include <osgGeoFX/geodata/detail/FrameRaster.h>
#include <osgGeoFX/paging/FilesByOthers.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <map>
#include <memory>
#include <mutex>
#include <utility>
#include <vector>

namespace osgGeoFX
{

namespace
{

class Tiles final : public RasterTiles
{
public:
    Tiles(std::string file, const MappingFrame& frame, std::optional<DataLayer::Kind> wanted,
          const std::optional<RasterBands>& bands, double reach)
        : _cache(GdalCacheLimit::small()), _file(std::move(file)), _frame(frame), _crs(crsOf(frame, _file)),
          _wanted(wanted), _wantedBands(bands), _bands(bands.value_or(RasterBands())), _reach(reach),
          _service(turnOf(_file))
    {
        std::unique_ptr<FrameRaster> raster = open(itself);
        raster->checkOverviews();
        _bands = raster->bands;
        _kind = raster->kind;
        if (_reach > 0.0)
        {
            const osg::Vec2d corner(_reach, _reach);
            constexpr int side = 256;
            const double pixels =
                raster->below(_crs, _crs.fromFrame(-corner), _crs.fromFrame(corner), side, side).pixels;
            // Without any pixel there, as at the poles of a Mercator map, nothing is read.
            const double texels = side * (pixels > 0.0 ? std::sqrt(pixels) : 1.0);
            _extent = {_crs.fromFrame(-corner), _crs.fromFrame(corner),
                       2.0 * _reach / _crs.metresPerUnit / texels};
        }
        else if (const std::optional<double> texel = texelAroundGlobe())
        {
            const MappingRaster::Window window = CubeFace::window(*texel);
            _isFace = true;
            _extent = {window.low, window.high, *texel};
        }
        else
            _extent = raster->extent(_crs);
        _idle[itself].push_back(std::move(raster));
    }

    osg::Vec2d low() const override { return _extent.low * _crs.metresPerUnit - _crs.origin; }
    osg::Vec2d high() const override { return _extent.high * _crs.metresPerUnit - _crs.origin; }
    double texel() const override { return _extent.texel * _crs.metresPerUnit; }
    DataLayer::Kind kind() const override { return _kind; }
    std::optional<LayerSource> source() const override
    {
        LayerSource source = sourceOf(_file, _frame);
        if (_wanted) source.kind = *_wanted;
        source.bands = _wantedBands;
        source.reach = _reach;
        return source;
    }

    osg::ref_ptr<osg::Image> read(const osg::Vec2d& from, const osg::Vec2d& to, int columns, int rows,
                                  std::string& error) override
    {
        const FilesByOthers::Scope scope(_folder);
        try
        {
            // Neighbors share a service's tiles, which are fetched once.
            std::unique_lock<std::mutex> turn;
            if (_service) turn = std::unique_lock<std::mutex>(*_service);
            std::unique_ptr<FrameRaster> raster = take(itself);
            const int overview = raster->overviewFor(pixelsOfTexel(*raster, from, to, columns, rows));
            if (overview != itself)
            {
                give(itself, std::move(raster));
                raster = take(overview);
            }
            const osg::ref_ptr<osg::Image> image =
                raster->image(_crs, _crs.fromFrame(from), _crs.fromFrame(to), columns, rows);
            if (_isFace) CubeFace::cut(*image, {from, to}, std::abs(_frame.origin.latitude) > 1.0);
            give(overview, std::move(raster));
            return image;
        }
        catch (const BuildError& failure)
        {
            error = failure.what();
            return nullptr;
        }
    }

protected:
    ~Tiles() override = default;

private:
    static constexpr int itself = -1;

    /// The size of a pixel, metres, if the raster reaches around the globe and the frame is that of a sixth of it.
    std::optional<double> texelAroundGlobe() const
    {
        if (!_frame.globe || !CubeFace::isOrigin(_frame.origin)) return std::nullopt;
        std::string error;
        const std::optional<GroundReach> reach = OverlayRaster::reachOf(_file, error);
        if (!reach) throw BuildError(error);
        return reach->radius > CubeFace::leastRadius ? std::optional(reach->texel) : std::nullopt;
    }

    /// How many pixels of the file, along one side, a texel of a rectangle has.
    double pixelsOfTexel(const FrameRaster& raster, const osg::Vec2d& from, const osg::Vec2d& to, int columns,
                         int rows) const
    {
        const double pixels = (to - from).x() / columns / texel();
        if (!_isFace && !(_reach > 0.0)) return pixels;
        // They differ from place to place. The levels of services of the world are a fifth coarser than pages.
        constexpr double slack = 1.2;
        const double below =
            raster.below(_crs, _crs.fromFrame(from), _crs.fromFrame(to), columns, rows).pixels;
        return slack * (below > 0.0 ? std::sqrt(below) : pixels);
    }

    /// Held by one read of a service's description at a time; null for other files.
    static std::shared_ptr<std::mutex> turnOf(const std::string& file)
    {
        if (FileSources::of(file).service.empty()) return nullptr;
        static std::mutex mutex;
        static std::map<std::string, std::weak_ptr<std::mutex>> turns;
        const std::lock_guard<std::mutex> lock(mutex);
        std::weak_ptr<std::mutex>& known = turns[file];
        std::shared_ptr<std::mutex> turn = known.lock();
        if (!turn) known = turn = std::make_shared<std::mutex>();
        return turn;
    }

    /// GDAL's datasets are for one thread each.
    std::unique_ptr<FrameRaster> take(int overview)
    {
        {
            const std::lock_guard<std::mutex> lock(_mutex);
            std::vector<std::unique_ptr<FrameRaster>>& idle = _idle[overview];
            if (!idle.empty())
            {
                std::unique_ptr<FrameRaster> raster = std::move(idle.back());
                idle.pop_back();
                return raster;
            }
        }
        return open(overview);
    }

    std::unique_ptr<FrameRaster> open(int overview) const
    {
        return std::make_unique<FrameRaster>(_file, _wanted, true, FrameRaster::ANY_FORMAT, overview, _bands);
    }

    void give(int overview, std::unique_ptr<FrameRaster> raster)
    {
        const std::lock_guard<std::mutex> lock(_mutex);
        _idle[overview].push_back(std::move(raster));
    }

    const std::optional<std::string> _folder = FilesByOthers::Scope::folder();
    const std::shared_ptr<GdalCacheLimit> _cache;
    const std::string _file;
    const MappingFrame _frame;
    const FrameCrs _crs;
    const std::optional<DataLayer::Kind> _wanted;
    const std::optional<RasterBands> _wantedBands;
    RasterBands _bands; ///< with all that the file and its numbers have decided
    DataLayer::Kind _kind = DataLayer::COLOR;
    FrameRaster::Extent _extent;
    const double _reach;  ///< 0: all of it
    bool _isFace = false; ///< of a raster around the globe
    const std::shared_ptr<std::mutex> _service;
    std::mutex _mutex;
    std::map<int, std::vector<std::unique_ptr<FrameRaster>>> _idle; ///< by overview
};

} // namespace

osg::ref_ptr<RasterTiles> TiledRaster::open(const std::string& file, const MappingFrame& frame,
                                            std::optional<DataLayer::Kind> kind, std::string& error,
                                            const std::optional<RasterBands>& bands, double reach)
{
    initialiseGdal();
    try
    {
        return new Tiles(file, frame, kind, bands, reach);
    }
    catch (const BuildError& failure)
    {
        error = failure.what();
        return nullptr;
    }
}

} // namespace osgGeoFX
