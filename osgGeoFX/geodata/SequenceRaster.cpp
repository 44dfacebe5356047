// SPDX-License-Identifier: MIT
// SPDX-FileCopyrightText: 2026 the osgGeoFX authors
#include <osgGeoFX/geodata/SequenceRaster.h>

#include <osgGeoFX/geodata/BuildError.h>
#include <osgGeoFX/geodata/detail/TimeSteps.h>
#include <osgGeoFX/paging/FilesByOthers.h>

#include <osg/CoordinateSystemNode>
#include <osg/Math>

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <memory>
#include <mutex>
#include <utility>

namespace osgGeoFX
{

namespace
{

/// So many steps are looked at for the range of values.
constexpr std::size_t looks = 8;

class Steps final : public SequenceSteps
{
public:
    Steps(std::unique_ptr<TimeSteps> steps, const MappingFrame& frame, const std::string& file,
          const SequenceRaster::Options& options)
        : _steps(std::move(steps)),
          _crs(crsOf(frame, file)), _source{file + (options.variable.empty() ? "" : ":" + options.variable),
                                            frame.globe,
                                            frame.wkt,
                                            frame.origin,
                                            options.maxSide,
                                            std::nullopt,
                                            std::nullopt}
    {
        const std::unique_ptr<FrameRaster> first = _steps->step(0);
        _kind = first->kind;
        extent = first->extent(_crs);
        const osg::Vec2d size = extent.high - extent.low;
        const double texel = std::max(extent.texel, std::max(size.x(), size.y()) / options.maxSide);
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
            return read(*_steps->step(step));
        }
        catch (const BuildError& failure)
        {
            error = failure.what();
            return nullptr;
        }
    }

    const TimeSteps& timeSteps() const { return *_steps; }
    const FrameCrs& crs() const { return _crs; }

    FrameRaster::Extent extent;

protected:
    ~Steps() override = default;

private:
    osg::ref_ptr<osg::Image> read(const FrameRaster& raster) const
    {
        if (raster.kind != _kind) raster.fail("it has other data than the first step; make all steps alike");
        return raster.image(_crs, extent.low, extent.high, _columns, _rows);
    }

    const std::optional<std::string> _folder = FilesByOthers::Scope::folder();
    std::unique_ptr<TimeSteps> _steps;
    const FrameCrs _crs;
    const LayerSource _source;
    DataLayer::Kind _kind = DataLayer::VALUE;
    int _columns = 1, _rows = 1;
    std::mutex _mutex; ///< of the datasets
};

/// On a globe, a frame is a plane that touches it: what lies beyond is on its other side, or squeezed.
constexpr double farthest = 60.0; // degrees of arc

void checkReach(const FrameRaster::Extent& extent, const FrameCrs& crs, const std::string& file)
{
    const osg::Vec2d low = extent.low * crs.metresPerUnit - crs.origin;
    const osg::Vec2d high = extent.high * crs.metresPerUnit - crs.origin;
    const double reach =
        std::max({std::abs(low.x()), std::abs(low.y()), std::abs(high.x()), std::abs(high.y())});
    if (reach > osg::WGS_84_RADIUS_EQUATOR * std::sin(osg::DegreesToRadians(farthest)))
        throw BuildError(
            file +
            ": it reaches farther around the globe than a layer in time can, 60 degrees from its middle; cut "
            "a part out with gdal_translate -projwin, or gdalmdimtranslate -subset.");
}

void findRange(Steps& steps, SequenceRaster& result)
{
    if (steps.kind() == DataLayer::COLOR) return;
    bool any = false;
    const std::size_t count = steps.times().size();
    for (std::size_t i = 0; i < std::min(looks, count); ++i)
    {
        std::string error;
        const osg::ref_ptr<osg::Image> image =
            steps.read(i * (count - 1) / std::max<std::size_t>(1, std::min(looks, count) - 1), error);
        if (!image) throw BuildError(error);
        const auto* values = reinterpret_cast<const float*>(image->data());
        const auto texels = static_cast<std::ptrdiff_t>(image->s()) * image->t();
        for (std::ptrdiff_t k = 0; k < texels; ++k)
        {
            const auto value = static_cast<double>(values[k]);
            if (!std::isfinite(value)) continue;
            result.lowest = any ? std::min(result.lowest, value) : value;
            result.highest = any ? std::max(result.highest, value) : value;
            any = true;
        }
    }
}

} // namespace

std::optional<SequenceRaster> SequenceRaster::open(const std::string& file, MappingFrame& frame, bool moves,
                                                   const Options& options, std::string& error)
{
    initialiseGdal();
    try
    {
        std::unique_ptr<TimeSteps> source = TimeSteps::open(file, options.variable);
        MappingFrame moved = frame;
        if (moves) source->step(0)->moveToMiddle(moved);
        const osg::ref_ptr<Steps> steps = new Steps(std::move(source), moved, file, options);
        if (moved.globe) checkReach(steps->extent, steps->crs(), file);
        SequenceRaster result;
        result.variable = steps->timeSteps().variable;
        result.unit = steps->timeSteps().unit;
        const FrameCrs& crs = steps->crs();
        result.low = steps->extent.low * crs.metresPerUnit - crs.origin;
        result.high = steps->extent.high * crs.metresPerUnit - crs.origin;
        findRange(*steps, result);
        result.steps = steps;
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
    std::error_code fault;
    const std::size_t colon = text.rfind(':');
    // That of an address, "/vsicurl/https://…", is none.
    const std::size_t slash = text.rfind('/');
    const bool none = colon == std::string::npos || (slash != std::string::npos && colon < slash);
    if (none || std::filesystem::exists(text, fault)) return {text, ""};
    return {text.substr(0, colon), text.substr(colon + 1)};
}

} // namespace osgGeoFX
