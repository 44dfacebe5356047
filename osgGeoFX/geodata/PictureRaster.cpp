// SPDX-License-Identifier: MIT
// SPDX-FileCopyrightText: 2026 the osgGeoFX authors
#include <osgGeoFX/geodata/PictureRaster.h>

#include <osgGeoFX/geodata/detail/FrameRaster.h>

#include <osgGeoFX/geodata/BuildError.h>

namespace osgGeoFX
{

namespace
{

std::optional<PictureRaster> opened(const std::string& file, const PictureRaster::Options& options,
                                    bool pixels, std::string& error)
{
    initialiseGdal();
    try
    {
        if (options.maxSide < 1)
            throw BuildError(file + ": a picture cannot have " + std::to_string(options.maxSide) +
                             " texels on a side; give 1 or more.");
        const FrameRaster raster(file, options.kind, false);
        PictureRaster result;
        result.width = static_cast<int>(raster.size().x());
        result.height = static_cast<int>(raster.size().y());
        result.kind = raster.kind;
        if (pixels) result.image = raster.picture(options.maxSide);
        return result;
    }
    catch (const BuildError& failure)
    {
        error = failure.what();
        return std::nullopt;
    }
}

} // namespace

std::optional<PictureRaster> PictureRaster::read(const std::string& file, const Options& options,
                                                 std::string& error)
{
    return opened(file, options, true, error);
}

std::optional<PictureRaster> PictureRaster::look(const std::string& file, const Options& options,
                                                 std::string& error)
{
    return opened(file, options, false, error);
}

} // namespace osgGeoFX
