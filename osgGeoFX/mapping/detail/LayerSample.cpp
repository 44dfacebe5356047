// SPDX-License-Identifier: MIT
// SPDX-FileCopyrightText: 2026 the osgGeoFX authors
#include <osgGeoFX/mapping/detail/LayerSample.h>

#include <osgGeoFX/raster/LayerPixels.h>

#include <algorithm>
#include <cmath>
#include <cstring>

namespace osgGeoFX
{

namespace
{

/// Two by two texels, with the image's lowest row below.
std::optional<LayerPixels> square(const osg::Image& image, const LayerSample::How& how, int column, int row)
{
    const unsigned int bytes = image.getPixelSizeInBits() / 8;
    if (bytes == 0) return std::nullopt;
    osg::ref_ptr<osg::Image> part = new osg::Image;
    part->allocateImage(2, 2, 1, image.getPixelFormat(), image.getDataType(), 1);
    if (!part->data()) return std::nullopt;
    const bool fromAbove = image.getOrigin() == osg::Image::TOP_LEFT;
    for (int y = 0; y < 2; ++y)
    {
        const int up = std::clamp(row + y, 0, image.t() - 1);
        for (int x = 0; x < 2; ++x)
        {
            const auto s = static_cast<unsigned int>(std::clamp(column + x, 0, image.s() - 1));
            const auto t = static_cast<unsigned int>(fromAbove ? image.t() - 1 - up : up);
            std::memcpy(part->data(static_cast<unsigned int>(x), static_cast<unsigned int>(y)),
                        image.data(s, t), bytes);
        }
    }
    LayerPixels::Options options;
    options.kind = static_cast<LayerPixels::Kind>(how.kind);
    options.noData = how.noData;
    options.levels = 1;
    std::string error;
    return LayerPixels::make(*part, options, error);
}

osg::Vec4d colorOf(LayerPixels::Texel texel)
{
    const auto channel = [&](unsigned int shift)
    {
        return static_cast<double>(texel >> shift & 255u) / 255.0;
    };
    return {channel(0), channel(8), channel(16), channel(24)};
}

} // namespace

LayerSample::How LayerSample::How::of(const DataLayer& layer)
{
    How how;
    how.kind = layer.getKind();
    how.smooth = layer.getSmooth();
    if (layer.getHasNoData()) how.noData = layer.getNoData();
    return how;
}

std::optional<LayerSample> LayerSample::read(const osg::Image& image, const How& how,
                                             const osg::Vec2d& raster)
{
    if (!image.data() || image.s() < 1 || image.t() < 1 || image.isCompressed()) return std::nullopt;
    const bool smooth = how.smooth && how.kind != DataLayer::CLASS;
    const double half = smooth ? 0.5 : 0.0;
    const osg::Vec2d at(std::clamp(raster.x(), 0.0, 1.0) * image.s() - half,
                        std::clamp(raster.y(), 0.0, 1.0) * image.t() - half);
    // The upper edge belongs to the last texel.
    const int column = std::min(static_cast<int>(std::floor(at.x())), image.s() - 1);
    const int row = std::min(static_cast<int>(std::floor(at.y())), image.t() - 1);
    const std::optional<LayerPixels> texels = square(image, how, column, row);
    if (!texels) return std::nullopt;
    const osg::Vec2d share(smooth ? at.x() - column : 0.0, smooth ? at.y() - row : 0.0);
    LayerSample result;
    for (std::size_t corner = 0; corner < 4; ++corner)
    {
        const double weight =
            (corner % 2 == 0 ? 1.0 - share.x() : share.x()) * (corner / 2 == 0 ? 1.0 - share.y() : share.y());
        const LayerPixels::Texel texel = texels->levels[0][corner];
        if (weight <= 0.0) continue;
        if (how.kind == DataLayer::COLOR)
        {
            result.color += colorOf(texel) * weight;
            result.cover += weight;
            continue;
        }
        const auto value = static_cast<double>(LayerPixels::value(texel));
        if (std::isnan(value)) continue;
        result.value += value * weight;
        result.cover += weight;
    }
    if (how.kind != DataLayer::COLOR && result.cover > 0.0) result.value /= result.cover;
    return result;
}

} // namespace osgGeoFX
