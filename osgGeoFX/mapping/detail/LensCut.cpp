// SPDX-License-Identifier: MIT
// SPDX-FileCopyrightText: 2026 the osgGeoFX authors
#include <osgGeoFX/mapping/detail/LensCut.h>

#include <glm/glm.hpp>

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>

namespace osgGeoFX
{

namespace
{

/// One level of a layer, for interpolation between its texels.
class Level
{
public:
    Level(const LayerPixels& pixels, unsigned int number)
        : _texels(pixels.levels[number]), _side(pixels.side >> number),
          _width(std::max((pixels.width - 1) >> number, 0)),
          _height(std::max((pixels.height - 1) >> number, 0)),
          _scaleX(static_cast<double>(pixels.width) / (1 << number)),
          _scaleY(static_cast<double>(pixels.height) / (1 << number))
    {
    }

    LayerPixels::Texel nearest(double u, double v) const
    {
        return at(static_cast<int>(std::floor(u * _scaleX)), static_cast<int>(std::floor(v * _scaleY)));
    }

    /// The four texels around a place, and their weights.
    struct Four
    {
        std::array<LayerPixels::Texel, 4> texels;
        std::array<double, 4> weights;
    };
    Four around(double u, double v) const
    {
        const double x = u * _scaleX - 0.5;
        const double y = v * _scaleY - 0.5;
        const int column = static_cast<int>(std::floor(x));
        const int row = static_cast<int>(std::floor(y));
        const double s = x - column;
        const double t = y - row;
        return {{at(column, row), at(column + 1, row), at(column, row + 1), at(column + 1, row + 1)},
                {(1 - s) * (1 - t), s * (1 - t), (1 - s) * t, s * t}};
    }

private:
    LayerPixels::Texel at(int column, int row) const
    {
        const int x = std::clamp(column, 0, _width);
        const int y = std::clamp(row, 0, _height);
        return _texels[static_cast<std::size_t>(y) * static_cast<std::size_t>(_side) +
                       static_cast<std::size_t>(x)];
    }

    const std::vector<LayerPixels::Texel>& _texels;
    int _side, _width, _height; ///< the last two: of the texels that have data
    double _scaleX, _scaleY;
};

/// Averages colors weighted by their alphas, so that transparent texels do not bleed.
void mixColors(const Level::Four& four, double alpha, unsigned char* rgba)
{
    std::array<double, 4> sum = {};
    for (std::size_t i = 0; i < 4; ++i)
    {
        const double share = four.weights[i] * (four.texels[i] >> 24u);
        for (unsigned int channel = 0; channel < 3; ++channel)
            sum[channel] += share * ((four.texels[i] >> (8u * channel)) & 255u);
        sum[3] += share;
    }
    for (std::size_t channel = 0; channel < 3; ++channel)
        rgba[channel] = static_cast<unsigned char>(sum[3] > 0.0 ? std::lround(sum[channel] / sum[3]) : 0);
    rgba[3] = static_cast<unsigned char>(std::lround(sum[3] * alpha));
}

float mixValues(const Level::Four& four)
{
    double sum = 0.0;
    double weights = 0.0;
    for (std::size_t i = 0; i < 4; ++i)
    {
        const auto value = static_cast<double>(LayerPixels::value(four.texels[i]));
        if (std::isnan(value)) continue;
        sum += four.weights[i] * value;
        weights += four.weights[i];
    }
    // Mostly no data means no data.
    return weights < 0.5 ? std::numeric_limits<float>::quiet_NaN() : static_cast<float>(sum / weights);
}

} // namespace

osg::ref_ptr<osg::Image> cutOutLens(const ProjectiveMapping& lens, const ProjectiveMapping& content,
                                    const LayerPixels& pixels, int side, const osg::Image& mask)
{
    const bool colors = content.getLayer()->getKind() == DataLayer::COLOR;
    const bool classes = content.getLayer()->getKind() == DataLayer::CLASS;
    osg::ref_ptr<osg::Image> image = new osg::Image;
    image->allocateImage(side, side, 1, colors ? GL_RGBA : GL_LUMINANCE,
                         colors ? GL_UNSIGNED_BYTE : GL_FLOAT);
    const glm::dmat3 lensToContent = content.placeToRaster() * glm::inverse(lens.placeToRaster());
    const auto raster = [&](double u, double v)
    {
        const glm::dvec3 found = lensToContent * glm::dvec3(u, v, 1.0);
        return glm::dvec2(found) / found.z;
    };
    // The level whose texels are about as large as those of the cut, in the middle.
    const double step = 1.0 / side;
    const glm::dvec2 size(pixels.width, pixels.height);
    const glm::dvec2 middle = raster(0.5, 0.5);
    const double width = std::max(glm::length((raster(0.5 + step, 0.5) - middle) * size),
                                  glm::length((raster(0.5, 0.5 + step) - middle) * size));
    const int last = static_cast<int>(pixels.levels.size()) - 1;
    const Level level(pixels, static_cast<unsigned int>(std::clamp(
                                  static_cast<int>(std::lround(std::log2(std::max(width, 1.0)))), 0, last)));
    for (int row = 0; row < side; ++row)
    {
        for (int column = 0; column < side; ++column)
        {
            const double u = (column + 0.5) * step;
            const double v = (row + 0.5) * step;
            const glm::dvec2 at = raster(u, v);
            const bool there = at.x >= 0.0 && at.x <= 1.0 && at.y >= 0.0 && at.y <= 1.0;
            if (colors)
            {
                const unsigned char* outline = mask.data(static_cast<unsigned int>(u * mask.s()),
                                                         static_cast<unsigned int>(v * mask.t()));
                mixColors(level.around(at.x, at.y), there ? outline[3] / 255.0 : 0.0,
                          image->data(column, row));
                continue;
            }
            float value = std::numeric_limits<float>::quiet_NaN();
            if (there)
                value = classes ? LayerPixels::value(level.nearest(at.x, at.y))
                                : mixValues(level.around(at.x, at.y));
            *reinterpret_cast<float*>(image->data(column, row)) = value;
        }
    }
    return image;
}

} // namespace osgGeoFX
