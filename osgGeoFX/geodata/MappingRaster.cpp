// SPDX-License-Identifier: MIT
// SPDX-FileCopyrightText: 2026 the osgGeoFX authors
#include <osgGeoFX/geodata/MappingRaster.h>

#include <osgGeoFX/geodata/detail/FrameRaster.h>

#include <osgGeoFX/geodata/BuildError.h>

#include <osg/Math>

#include <algorithm>
#include <cmath>
#include <vector>

namespace osgGeoFX
{

namespace
{

MappingRaster readRaster(const std::string& file, const MappingFrame& frame,
                         const MappingRaster::Options& options)
{
    const FrameCrs crs = crsOf(frame, file);
    const FrameRaster whole(file, options.kind, true, FrameRaster::ANY_FORMAT, -1, options.bands);
    FrameRaster::Extent extent;
    if (const std::optional<MappingRaster::Window>& window = options.window)
        extent = {crs.fromFrame(window->low), crs.fromFrame(window->high), window->texel / crs.metresPerUnit};
    else
        extent = whole.extent(crs);
    const osg::Vec2d size = extent.high - extent.low;
    const double texel = std::max(extent.texel, std::max(size.x(), size.y()) / options.maxSide);
    const auto texels = [&](double length)
    {
        return std::max(1, std::min(options.maxSide, static_cast<int>(std::lround(length / texel))));
    };
    // With fewer texels than all of it has, an overview is enough.
    const int overview = whole.overviewFor(texel / extent.texel);
    std::optional<FrameRaster> coarse;
    if (overview >= 0)
        coarse.emplace(file, options.kind, true, FrameRaster::ANY_FORMAT, overview, whole.bands);
    const FrameRaster& raster = coarse ? *coarse : whole;

    MappingRaster result;
    result.low = extent.low * crs.metresPerUnit - crs.origin;
    result.high = extent.high * crs.metresPerUnit - crs.origin;
    double lowest = 1.0, highest = 0.0; // none yet
    const osg::ref_ptr<osg::Image> image =
        raster.image(crs, extent.low, extent.high, texels(size.x()), texels(size.y()), &lowest, &highest);
    if (lowest <= highest)
    {
        result.lowest = lowest;
        result.highest = highest;
    }
    result.layer = new DataLayer(image);
    result.layer->setKind(raster.kind);
    raster.giveWords(*result.layer);
    return result;
}

} // namespace

std::optional<MappingRaster> MappingRaster::read(const std::string& file, const MappingFrame& frame,
                                                 const Options& options, std::string& error)
{
    initialiseGdal();
    try
    {
        return readRaster(file, frame, options);
    }
    catch (const BuildError& failure)
    {
        error = failure.what();
        return std::nullopt;
    }
}

bool MappingRaster::moveToMiddle(const std::string& file, MappingFrame& frame, std::string& error)
{
    initialiseGdal();
    try
    {
        FrameRaster(file, DataLayer::VALUE).moveToMiddle(frame);
        return true;
    }
    catch (const BuildError& failure)
    {
        error = failure.what();
        return false;
    }
}

} // namespace osgGeoFX
