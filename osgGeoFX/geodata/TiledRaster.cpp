// SPDX-License-Identifier: MIT
// SPDX-FileCopyrightText: 2026 the osgGeoFX authors
#include <osgGeoFX/geodata/TiledRaster.h>

#include <osgGeoFX/geodata/BuildError.h>
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
          const std::optional<RasterBands>& bands)
        : _cache(GdalCacheLimit::small()), _file(std::move(file)), _frame(frame), _crs(crsOf(frame, _file)),
          _wanted(wanted), _wantedBands(bands), _bands(bands.value_or(RasterBands()))
    {
        std::unique_ptr<FrameRaster> raster = open(itself);
        raster->checkOverviews();
        _bands = raster->bands;
        _kind = raster->kind;
        if (const std::optional<double> texel = texelAroundGlobe())
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
        return source;
    }

    osg::ref_ptr<osg::Image> read(const osg::Vec2d& from, const osg::Vec2d& to, int columns, int rows,
                                  std::string& error) override
    {
        const FilesByOthers::Scope scope(_folder);
        try
        {
            std::unique_ptr<FrameRaster> raster = take(itself);
            const int overview = raster->overviewFor((to - from).x() / columns / texel());
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
        const std::array<LocalOrigin, 6> origins = CubeFace::origins();
        const bool isSixth = std::any_of(origins.begin(), origins.end(),
                                         [this](const LocalOrigin& origin) {
                                             return origin.longitude == _frame.origin.longitude &&
                                                    origin.latitude == _frame.origin.latitude;
                                         });
        if (!_frame.globe || !isSixth) return std::nullopt;
        std::string error;
        const std::optional<GroundReach> reach = OverlayRaster::reachOf(_file, error);
        if (!reach) throw BuildError(error);
        return reach->radius > CubeFace::leastRadius ? std::optional(reach->texel) : std::nullopt;
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
    bool _isFace = false; ///< of a raster around the globe
    std::mutex _mutex;
    std::map<int, std::vector<std::unique_ptr<FrameRaster>>> _idle; ///< by overview
};

} // namespace

osg::ref_ptr<RasterTiles> TiledRaster::open(const std::string& file, const MappingFrame& frame,
                                            std::optional<DataLayer::Kind> kind, std::string& error,
                                            const std::optional<RasterBands>& bands)
{
    initialiseGdal();
    try
    {
        return new Tiles(file, frame, kind, bands);
    }
    catch (const BuildError& failure)
    {
        error = failure.what();
        return nullptr;
    }
}

} // namespace osgGeoFX
