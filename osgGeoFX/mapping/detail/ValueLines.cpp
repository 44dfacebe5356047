// SPDX-License-Identifier: MIT
// SPDX-FileCopyrightText: 2026 the osgGeoFX authors
#include <osgGeoFX/mapping/detail/ValueLines.h>

#include <algorithm>
#include <cmath>
#include <limits>

namespace osgGeoFX
{

namespace
{

/// The values of a layer, interpolated between texels. NaN if one of these has no data.
class Values
{
public:
    explicit Values(const LayerPixels& pixels) : _pixels(pixels) {}

    double at(double x, double y) const
    {
        const double column = std::floor(x);
        const double row = std::floor(y);
        const double s = x - column;
        const double t = y - row;
        const int i = static_cast<int>(column);
        const int j = static_cast<int>(row);
        return (texel(i, j) * (1 - s) + texel(i + 1, j) * s) * (1 - t) +
               (texel(i, j + 1) * (1 - s) + texel(i + 1, j + 1) * s) * t;
    }

private:
    double texel(int column, int row) const
    {
        const int x = std::clamp(column, 0, _pixels.width - 1);
        const int y = std::clamp(row, 0, _pixels.height - 1);
        return static_cast<double>(
            LayerPixels::value(_pixels.levels[0][static_cast<std::size_t>(y) * _pixels.side + x]));
    }

    const LayerPixels& _pixels;
};

} // namespace

osg::ref_ptr<osg::Image> distancesToLines(const LayerPixels& pixels, const osg::Vec2d& size, double step,
                                          double low, double high, double reach)
{
    const int finer = std::clamp(1024 / std::max(pixels.width, pixels.height), 1, 8);
    osg::ref_ptr<osg::Image> image = new osg::Image;
    image->allocateImage(pixels.width * finer, pixels.height * finer, 1, GL_LUMINANCE, GL_FLOAT);
    const Values values(pixels);
    const double texelWidth = size.x() / pixels.width;
    const double texelHeight = size.y() / pixels.height;
    for (int row = 0; row < image->t(); ++row)
    {
        for (int column = 0; column < image->s(); ++column)
        {
            const double x = (column + 0.5) / finer - 0.5;
            const double y = (row + 0.5) / finer - 0.5;
            const double value = values.at(x, y);
            double distance = std::numeric_limits<double>::quiet_NaN();
            if (!std::isnan(value))
            {
                // Measured over a texel to each side, so that the slope does not jump at texels.
                const double slope =
                    std::hypot((values.at(x + 0.5, y) - values.at(x - 0.5, y)) / texelWidth,
                               (values.at(x, y + 0.5) - values.at(x, y - 0.5)) / texelHeight);
                const double line = std::round(value / step) * step;
                const bool there = line > low && line < high && slope > 0.0;
                distance = there ? std::min(std::abs(value - line) / slope, reach) : reach;
            }
            *reinterpret_cast<float*>(image->data(column, row)) = static_cast<float>(distance);
        }
    }
    return image;
}

} // namespace osgGeoFX
