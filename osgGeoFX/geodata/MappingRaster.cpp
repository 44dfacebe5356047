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

void readValues(const FrameRaster& raster, GDALDataset& warped, osg::Image& image, MappingRaster& result)
{
    const int height = warped.GetRasterYSize();
    image.allocateImage(warped.GetRasterXSize(), height, 1, GL_RED, GL_FLOAT);
    image.setInternalTextureFormat(GL_R32F);
    std::vector<double> line;
    bool any = false;
    for (int row = 0; row < height; ++row)
    {
        raster.readValues(warped, row, line);
        auto* out = reinterpret_cast<float*>(image.data(0, static_cast<unsigned int>(height - 1 - row)));
        for (const double value : line)
        {
            *out++ = static_cast<float>(value);
            if (std::isnan(value)) continue;
            result.lowest = any ? std::min(result.lowest, value) : value;
            result.highest = any ? std::max(result.highest, value) : value;
            any = true;
        }
    }
}

MappingRaster readRaster(const std::string& file, const MappingFrame& frame,
                         const MappingRaster::Options& options)
{
    const FrameCrs crs = crsOf(frame, file);
    const FrameRaster whole(file, options.kind);
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
    const int overview = options.window ? -1 : whole.overviewFor(texel / extent.texel);
    std::optional<FrameRaster> coarse;
    if (overview >= 0) coarse.emplace(file, options.kind, true, FrameRaster::ANY_FORMAT, overview);
    const FrameRaster& raster = coarse ? *coarse : whole;
    const DatasetPtr warped = raster.warped(crs, extent.low, extent.high, texels(size.x()), texels(size.y()));

    MappingRaster result;
    result.low = extent.low * crs.metresPerUnit - crs.origin;
    result.high = extent.high * crs.metresPerUnit - crs.origin;
    const osg::ref_ptr<osg::Image> image = new osg::Image;
    if (raster.kind == DataLayer::COLOR)
    {
        image->allocateImage(warped->GetRasterXSize(), warped->GetRasterYSize(), 1, GL_RGBA,
                             GL_UNSIGNED_BYTE);
        raster.readColors(*warped, image->data());
    }
    else
        readValues(raster, *warped, *image, result);
    image->setFileName(file);
    result.layer = new DataLayer(image);
    result.layer->setKind(raster.kind);
    return result;
}

void move(const std::string& file, MappingFrame& frame)
{
    const FrameRaster raster(file, std::nullopt);
    FrameCrs crs;
    if (frame.globe)
        crs.definition = "EPSG:4326";
    else
        crs = crsOf(frame, file);
    const osg::Vec2d middle = raster.middle(crs);
    if (frame.globe)
        frame.origin =
            LocalOrigin::onGlobe(osg::DegreesToRadians(middle.x()), osg::DegreesToRadians(middle.y()));
    else
        frame.origin = LocalOrigin::onPlane(middle * crs.metresPerUnit);
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
        move(file, frame);
        return true;
    }
    catch (const BuildError& failure)
    {
        error = failure.what();
        return false;
    }
}

} // namespace osgGeoFX
