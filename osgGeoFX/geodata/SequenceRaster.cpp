// SPDX-License-Identifier: MIT
// SPDX-FileCopyrightText: 2026 the osgGeoFX authors
#include <osgGeoFX/geodata/SequenceRaster.h>

#include <osgGeoFX/geodata/BuildError.h>
#include <osgGeoFX/geodata/detail/CubeFace.h>
#include <osgGeoFX/geodata/detail/RasterFile.h>
#include <osgGeoFX/geodata/detail/RasterReach.h>
#include <osgGeoFX/geodata/detail/TimeSteps.h>
#include <osgGeoFX/paging/FilesByOthers.h>

#include <osg/CoordinateSystemNode>
#include <osg/Math>

#include <algorithm>
#include <array>
#include <cmath>
#include <memory>
#include <mutex>
#include <utility>

namespace osgGeoFX
{

namespace
{

/// So many steps are looked at for the range of values.
constexpr std::size_t looks = 8;
/// Texels a side that are looked at.
constexpr int lookSide = 256;

class Steps final : public SequenceSteps
{
public:
    /// `face`: of rasters around the globe, the frame being that of a part.
    Steps(std::unique_ptr<TimeSteps> steps, const MappingFrame& frame, const std::string& file,
          const SequenceRaster::Options& options, const std::optional<MappingRaster::Window>& face)
        : _steps(std::move(steps)),
          _crs(crsOf(frame, file)), _source{file + (options.variable.empty() ? "" : ":" + options.variable),
                                            frame.globe,
                                            frame.wkt,
                                            frame.origin,
                                            options.maxSide,
                                            std::nullopt,
                                            std::nullopt,
                                            options.bands},
          _isFace(face), _isPolar(std::abs(frame.origin.latitude) > 1.0)
    {
        const std::unique_ptr<FrameRaster> first = _steps->step(0);
        _kind = first->kind;
        if (face)
            _extent = {face->low, face->high, face->texel};
        else
            _extent = first->extent(_crs);
        const osg::Vec2d size = _extent.high - _extent.low;
        const double texel = std::max(_extent.texel, std::max(size.x(), size.y()) / options.maxSide);
        const auto texels = [&](double length)
        {
            return std::clamp(static_cast<int>(std::lround(length / texel)), 1, options.maxSide);
        };
        _columns = texels(size.x());
        _rows = texels(size.y());
    }

    const std::vector<double>& times() const override { return _steps->times; }
    bool dated() const override { return _steps->dated; }
    DataLayer::Kind kind() const override { return _kind; }
    std::optional<LayerSource> source() const override { return _source; }
    osg::ref_ptr<osg::Image> read(std::size_t step, std::string& error) override
    {
        const FilesByOthers::Scope scope(_folder);
        const std::lock_guard<std::mutex> lock(_mutex);
        try
        {
            return read(*_steps->step(step), _columns, _rows);
        }
        catch (const BuildError& failure)
        {
            error = failure.what();
            return nullptr;
        }
    }

    /// A step, in fewer texels where it is a part of a raster around the globe. Throws BuildError.
    osg::ref_ptr<osg::Image> look(std::size_t step)
    {
        const int most = _isFace ? lookSide : std::max(_columns, _rows);
        return read(*_steps->step(step), std::min(_columns, most), std::min(_rows, most));
    }

    const TimeSteps& timeSteps() const { return *_steps; }
    osg::Vec2d low() const { return _extent.low * _crs.metresPerUnit - _crs.origin; }
    osg::Vec2d high() const { return _extent.high * _crs.metresPerUnit - _crs.origin; }

protected:
    ~Steps() override = default;

private:
    osg::ref_ptr<osg::Image> read(const FrameRaster& raster, int columns, int rows) const
    {
        if (raster.kind != _kind) raster.fail("it has other data than the first step; make all steps alike");
        const osg::ref_ptr<osg::Image> image = raster.image(_crs, _extent.low, _extent.high, columns, rows);
        if (_isFace) CubeFace::cut(*image, {_extent.low, _extent.high}, _isPolar);
        return image;
    }

    const std::optional<std::string> _folder = FilesByOthers::Scope::folder();
    std::unique_ptr<TimeSteps> _steps;
    const FrameCrs _crs;
    const LayerSource _source;
    const bool _isFace, _isPolar;
    FrameRaster::Extent _extent;
    DataLayer::Kind _kind = DataLayer::VALUE;
    int _columns = 1, _rows = 1;
    std::mutex _mutex; ///< of the datasets
};

constexpr const char* cutRemedy =
    "cut a part out with gdal_translate -projwin, or gdalmdimtranslate -subset.";

/// On a globe, a frame is a plane that touches it: what lies beyond is on its other side, or squeezed.
void checkReach(const Steps& steps, const std::string& file)
{
    const osg::Vec2d low = steps.low(), high = steps.high();
    const double reach =
        std::max({std::abs(low.x()), std::abs(low.y()), std::abs(high.x()), std::abs(high.y())});
    if (reach > osg::WGS_84_RADIUS_EQUATOR * std::sin(CubeFace::leastRadius))
        throw BuildError(
            file +
            ": it reaches farther than 60 degrees of arc from the frame's origin; give the frame an origin "
            "near its middle, or " +
            cutRemedy);
}

/// Takes the values of a part into the range. False where it has none.
bool takeRange(Steps& steps, SequenceRaster& result, bool& any)
{
    bool hasOwn = false;
    const std::size_t count = steps.times().size();
    const bool isColor = steps.kind() == DataLayer::COLOR;
    for (std::size_t i = 0; i < std::min(isColor ? 1 : looks, count); ++i)
    {
        const osg::ref_ptr<osg::Image> image =
            steps.look(i * (count - 1) / std::max<std::size_t>(1, std::min(looks, count) - 1));
        const auto texels = static_cast<std::ptrdiff_t>(image->s()) * image->t();
        for (std::ptrdiff_t k = 0; isColor && k < texels; ++k)
            hasOwn = hasOwn || image->data()[4 * k + 3] != 0;
        if (isColor) continue;
        const auto* values = reinterpret_cast<const float*>(image->data());
        for (std::ptrdiff_t k = 0; k < texels; ++k)
        {
            const auto value = static_cast<double>(values[k]);
            if (!std::isfinite(value)) continue;
            result.lowest = any ? std::min(result.lowest, value) : value;
            result.highest = any ? std::max(result.highest, value) : value;
            any = hasOwn = true;
        }
    }
    return hasOwn;
}

/// The origins of the parts of rasters that reach around the globe, else that of the frame.
std::vector<LocalOrigin> originsOf(const MappingFrame& frame, bool moves, bool isAround,
                                   const std::string& file)
{
    if (!isAround) return {frame.origin};
    const std::array<LocalOrigin, 6> all = CubeFace::origins();
    if (moves) return {all.begin(), all.end()};
    if (!CubeFace::isOrigin(frame.origin))
        throw BuildError(file +
                         ": it reaches around the globe, and a frame whose origin is given has no room for "
                         "it; show it with "
                         "--sequence, or " +
                         cutRemedy);
    return {frame.origin};
}

} // namespace

std::optional<SequenceRaster> SequenceRaster::open(const std::string& file, MappingFrame& frame, bool moves,
                                                   const Options& options, std::string& error)
{
    initialiseGdal();
    try
    {
        const RasterBands bands = options.bands.value_or(RasterBands());
        std::unique_ptr<TimeSteps> source = TimeSteps::open(file, options.variable, bands);
        MappingFrame moved = frame;
        std::optional<MappingRaster::Window> face;
        if (frame.globe)
        {
            const GroundReach reach = reachOf(*source->step(0));
            if (reach.radius > CubeFace::leastRadius)
            {
                // Faces lie over each other by two texels, which a coarse raster would show.
                constexpr int leastSide = 1024;
                face = CubeFace::window(reach.texel);
                face->texel = std::min(reach.texel, (face->high.x() - face->low.x()) / leastSide);
            }
        }
        if (moves && !face) source->step(0)->moveToMiddle(moved);
        SequenceRaster result;
        result.variable = source->variable;
        result.unit = source->unit;
        bool any = false;
        const std::vector<LocalOrigin> origins = originsOf(moved, moves, face.has_value(), file);
        for (std::size_t i = 0; i < origins.size(); ++i)
        {
            const LocalOrigin& origin = origins[i];
            if (!source) source = TimeSteps::open(file, options.variable, bands);
            MappingFrame own = moved;
            own.origin = origin;
            const osg::ref_ptr<Steps> steps = new Steps(std::move(source), own, file, options, face);
            if (own.globe && !face) checkReach(*steps, file);
            const bool isEmpty = !takeRange(*steps, result, any), isLast = i + 1 == origins.size();
            if (isEmpty && (result.steps || !isLast)) continue;
            if (result.steps)
            {
                result.others.push_back({origin, steps, steps->low(), steps->high()});
                continue;
            }
            result.steps = steps;
            result.low = steps->low();
            result.high = steps->high();
            moved.origin = origin;
        }
        frame = moved;
        return result;
    }
    catch (const BuildError& failure)
    {
        error = failure.what();
        return std::nullopt;
    }
}

std::pair<std::string, std::string> SequenceRaster::parse(const std::string& text)
{
    return RasterFile::parse(text);
}

} // namespace osgGeoFX
