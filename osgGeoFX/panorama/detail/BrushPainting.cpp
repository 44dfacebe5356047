// SPDX-License-Identifier: MIT
// SPDX-FileCopyrightText: 2026 the osgGeoFX authors
#include <osgGeoFX/panorama/detail/PaintedImages.h>

#include <osgGeoFX/panorama/detail/PaintNoise.h>

#include <algorithm>
#include <vector>

namespace osgGeoFX
{

namespace
{

/// Numbers on a square that repeats.
class Field
{
public:
    explicit Field(int side) : _side(side), _values(static_cast<std::size_t>(side) * side) {}

    double& at(int x, int y) { return _values[index(x, y)]; }
    double at(int x, int y) const { return _values[index(x, y)]; }

    /// Each value among its neighbours, 1-2-1 in x and in y.
    void soften()
    {
        for (const bool alongX : {true, false})
        {
            const Field old = *this;
            for (int y = 0; y < _side; ++y)
            {
                for (int x = 0; x < _side; ++x)
                {
                    const double around =
                        alongX ? old.at(x - 1, y) + old.at(x + 1, y) : old.at(x, y - 1) + old.at(x, y + 1);
                    at(x, y) = 0.5 * old.at(x, y) + 0.25 * around;
                }
            }
        }
    }

    /// To mean 0 and a standard deviation of 1.
    void normalise()
    {
        double sum = 0.0;
        double squares = 0.0;
        for (const double value : _values)
        {
            sum += value;
            squares += value * value;
        }
        const double count = static_cast<double>(_values.size());
        const double mean = sum / count;
        const double scale = 1.0 / std::sqrt(std::max(squares / count - mean * mean, 1e-12));
        for (double& value : _values)
            value = (value - mean) * scale;
    }

private:
    std::size_t index(int x, int y) const
    {
        const auto wrap = [this](int i)
        {
            return static_cast<std::size_t>(((i % _side) + _side) % _side);
        };
        return wrap(y) * static_cast<std::size_t>(_side) + wrap(x);
    }

    int _side;
    std::vector<double> _values;
};

/// Strokes over and beside each other: their relief, and a tone for each.
void paintStrokes(int side, Field& relief, Field& tone)
{
    paint::Sequence random(7);
    const double texel = side / 512.0;
    constexpr int strokes = 5200;
    for (int i = 0; i < strokes; ++i)
    {
        const double u = random.uniform();
        const double v = random.uniform();
        paint::Stroke stroke;
        stroke.x = u * side;
        stroke.y = v * side;
        stroke.length = random.uniform(13.0, 27.0) * texel;
        stroke.width = random.uniform(4.0, 8.0) * texel;
        stroke.angle = 0.9 * paint::cloudy(3 * u, 3 * v, 3, 3, 2, 11) + random.uniform(-0.25, 0.25);
        stroke.seed = static_cast<std::uint32_t>(i);
        const double color = random.uniform(-1.0, 1.0);
        const double ridge = random.uniform(0.3, 1.0);
        paint::stamp(stroke,
                     [&](int x, int y, double cover, double across)
                     {
                         // Paint is pushed to the brush's sides.
                         const double height = ridge * (0.8 + 0.2 * across * across) + 0.5 * color;
                         double& relieved = relief.at(x, y);
                         relieved += (height - relieved) * 0.7 * cover;
                         double& toned = tone.at(x, y);
                         toned += (color - toned) * 0.7 * cover;
                     });
    }
}

/// How high ripples stand: long crests that lie across each other a little.
double ripple(double u, double v)
{
    const double bendX = 0.35 * paint::cloudy(4 * u, 4 * v, 4, 4, 2, 51);
    const double bendY = 0.8 * paint::cloudy(3 * u, 6 * v, 3, 6, 2, 52);
    const double waves = 0.6 * paint::noise(6 * u + bendX, 22 * v + bendY, 6, 22, 53) +
                         0.4 * paint::noise(11 * u + bendX, 45 * v + bendY, 11, 45, 54);
    return 0.5 + 0.5 * waves;
}

unsigned char byte(double value)
{
    return static_cast<unsigned char>(std::lround(255.0 * std::clamp(value, 0.0, 1.0)));
}

} // namespace

osg::ref_ptr<osg::Image> paintBrush(int side)
{
    side = std::clamp(side, 64, 2048);
    Field relief(side);
    Field tone(side);
    paintStrokes(side, relief, tone);
    // The edges of strokes are seen, but no outlines.
    for (int i = 0; i < side; i += 128)
        relief.soften();
    relief.normalise();
    tone.normalise();
    Field height(side);
    for (int y = 0; y < side; ++y)
    {
        for (int x = 0; x < side; ++x)
        {
            const double u = (x + 0.5) / side;
            const double v = (y + 0.5) / side;
            height.at(x, y) = 0.2 * relief.at(x, y) + paint::cloudy(8 * u, 14 * v, 8, 14, 3, 21);
            tone.at(x, y) = 0.35 * tone.at(x, y) + 1.9 * paint::cloudy(6 * u, 9 * v, 6, 9, 4, 31);
        }
    }
    tone.normalise();
    Field slopeX(side);
    Field slopeY(side);
    for (int y = 0; y < side; ++y)
    {
        for (int x = 0; x < side; ++x)
        {
            slopeX.at(x, y) = height.at(x + 1, y) - height.at(x - 1, y);
            slopeY.at(x, y) = height.at(x, y + 1) - height.at(x, y - 1);
        }
    }
    slopeX.normalise();
    slopeY.normalise();

    osg::ref_ptr<osg::Image> image = new osg::Image;
    image->allocateImage(side, side, 1, GL_RGBA, GL_UNSIGNED_BYTE);
    for (int y = 0; y < side; ++y)
    {
        for (int x = 0; x < side; ++x)
        {
            unsigned char* texel = image->data(x, y);
            texel[0] = byte(0.5 + 0.16 * slopeX.at(x, y));
            texel[1] = byte(0.5 + 0.16 * slopeY.at(x, y));
            texel[2] = byte(0.5 + 0.2 * tone.at(x, y));
            texel[3] = byte(ripple((x + 0.5) / side, (y + 0.5) / side));
        }
    }
    return image;
}

} // namespace osgGeoFX
