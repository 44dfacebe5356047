// SPDX-License-Identifier: MIT
// SPDX-FileCopyrightText: 2026 the osgGeoFX authors
#include <osgGeoFX/closeup/detail/RegionMask.h>

#include <osgGeoFX/raster/LayerPixels.h>

#include <algorithm>
#include <cmath>
#include <numeric>

namespace osgGeoFX::region
{

namespace
{

/// Replaces each number of a row or column by the mean over ±radius texels. The end numbers go on beyond the ends.
void smooth(std::vector<double>& line, double radius)
{
    const auto count = static_cast<int>(line.size());
    std::vector<double> sum(line.size() + 1, 0.0);
    std::partial_sum(line.begin(), line.end(), sum.begin() + 1);
    const double first = line.front(), last = line.back();
    const auto upTo = [&](double x)
    {
        if (x <= 0.0) return x * first;
        if (x >= count) return sum.back() + (x - count) * last;
        const auto whole = static_cast<std::size_t>(x);
        return sum[whole] + (x - static_cast<double>(whole)) * (sum[whole + 1] - sum[whole]);
    };
    for (int i = 0; i < count; ++i)
        line[i] = (upTo(i + 0.5 + radius) - upTo(i + 0.5 - radius)) / (2.0 * radius);
}

/// The texels of a source that one texel of a picture shows, with their weights: a tent as wide as the coarser of
/// both.
std::vector<std::pair<int, double>> weights(int texel, int side, int source)
{
    const double scale = static_cast<double>(source) / side;
    const double center = (texel + 0.5) * scale - 0.5;
    const double reach = std::max(1.0, scale);
    std::vector<std::pair<int, double>> found;
    double sum = 0.0;
    for (int i = static_cast<int>(std::ceil(center - reach)); i <= center + reach; ++i)
    {
        const double weight = reach - std::abs(i - center);
        if (weight > 0.0) found.emplace_back(std::clamp(i, 0, source - 1), weight);
        sum += std::max(weight, 0.0);
    }
    for (auto& [index, weight] : found)
        weight /= sum;
    return found;
}

std::optional<LayerPixels> pixelsOf(const osg::Image& image, int maxSide, std::string& error)
{
    LayerPixels::Options options;
    options.sRGB = false; // greys are shares here, and no light
    options.maxSide = maxSide;
    options.levels = 1;
    return LayerPixels::make(image, options, error);
}

} // namespace

std::string refusal(const osg::Image& image)
{
    std::string error;
    pixelsOf(image, 1, error);
    return error;
}

std::optional<Picture> greys(const osg::Image& image, int side, const osg::Vec2d& half, std::string& error)
{
    const std::optional<LayerPixels> pixels = pixelsOf(image, 2048, error);
    if (!pixels) return std::nullopt;
    // An image with one red channel is taken as grey.
    const bool isRed = image.getPixelFormat() == GL_RED;
    const auto greyOf = [&](LayerPixels::Texel texel)
    {
        const auto part = [&](int channel)
        {
            return (texel >> (8 * channel) & 255u) / 255.0;
        };
        const double luminance = 0.2126 * part(0) + 0.7152 * part(1) + 0.0722 * part(2);
        return (isRed ? part(0) : luminance) * part(3);
    };
    // Each source row is resampled first, and then added to the rows of the picture that it shows in.
    std::vector<std::vector<std::pair<int, double>>> across, along(pixels->height);
    for (int i = 0; i < side; ++i)
    {
        across.push_back(weights(i, side, pixels->width));
        for (const auto& [row, weight] : weights(i, side, pixels->height))
            along[row].emplace_back(i, weight);
    }
    std::vector<double> sums(static_cast<std::size_t>(side) * side, 0.0), source(pixels->width);
    for (int y = 0; y < pixels->height; ++y)
    {
        const auto from = pixels->levels[0].begin() + static_cast<std::ptrdiff_t>(y) * pixels->side;
        std::transform(from, from + pixels->width, source.begin(), greyOf);
        for (int x = 0; x < side; ++x)
        {
            double grey = 0.0;
            for (const auto& [column, weight] : across[x])
                grey += weight * source[column];
            for (const auto& [row, weight] : along[y])
                sums[static_cast<std::size_t>(row) * side + x] += weight * grey;
        }
    }
    Picture picture(side, half);
    std::transform(sums.begin(), sums.end(), picture.values.begin(),
                   [](double sum) { return static_cast<float>(std::clamp(sum, 0.0, 1.0)); });
    return picture;
}

Picture blurred(const Picture& grey, double softness)
{
    Picture mask = grey;
    const int side = grey.side;
    const osg::Vec2d texel = grey.texel();
    std::vector<double> line(side);
    for (const bool rows : {true, false})
    {
        for (int i = 0; i < side; ++i)
        {
            const auto value = [&](int k) -> float&
            {
                return rows ? mask.at(k, i) : mask.at(i, k);
            };
            for (int k = 0; k < side; ++k)
                line[k] = static_cast<double>(value(k));
            // Two means of half the width make a tent.
            for (int turn = 0; turn < 2; ++turn)
                smooth(line, softness / 2.0 / (rows ? texel.x() : texel.y()));
            for (int k = 0; k < side; ++k)
                value(k) = static_cast<float>(line[k]);
        }
    }
    for (int row = 0; row < side; ++row)
        for (int column = 0; column < side; ++column)
            mask.at(column, row) *=
                static_cast<float>(std::clamp(grey.toBorder(column, row) / softness, 0.0, 1.0));
    return mask;
}

} // namespace osgGeoFX::region
