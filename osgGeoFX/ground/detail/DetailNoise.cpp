// SPDX-License-Identifier: MIT
// SPDX-FileCopyrightText: 2026 the osgGeoFX authors
#include <osgGeoFX/ground/detail/DetailNoise.h>

#include <osgGeoFX/effect/GlslFunctions.h>

#include <osg/Quat>

#include <algorithm>
#include <array>
#include <cmath>
#include <complex>
#include <cstdint>
#include <vector>

namespace osgGeoFX
{

namespace
{

/// Plane waves that make the noise. Some hundred look like random ground; fewer show their directions.
constexpr int planeWaves = 96;
/// The shortest and the longest ones, in waves across a period.
constexpr double longest = 4.5, shortest = 11.0;
/// Of heights and slopes, before they are cut at 1.
constexpr double deviation = 0.33;

/// The same numbers on all machines, which the standard library's distributions are not.
class Numbers
{
public:
    double next() ///< 0…1
    {
        _state = _state * 6364136223846793005u + 1442695040888963407u;
        return static_cast<double>(_state >> 11u) / 9007199254740992.0;
    }

private:
    std::uint64_t _state = 0x6f7367476f464658u;
};

struct PlaneWave
{
    std::array<int, 3> waves; ///< across a period
    std::complex<double> phase;
};

std::vector<PlaneWave> makeWaves()
{
    Numbers numbers;
    std::vector<PlaneWave> all;
    while (all.size() < planeWaves)
    {
        PlaneWave wave = {};
        for (int& each : wave.waves)
            each = static_cast<int>(std::lround(shortest * (2.0 * numbers.next() - 1.0)));
        const double size = std::hypot(wave.waves[0], wave.waves[1], wave.waves[2]);
        // As many short ones as long ones: there are more short directions.
        const double share = longest / std::max(size, 1.0);
        const bool taken = numbers.next() < share * share;
        const double angle = 2.0 * osg::PI * numbers.next();
        if (size < longest || size > shortest || !taken) continue;
        wave.phase = std::polar(1.0, angle);
        all.push_back(wave);
    }
    return all;
}

unsigned char coded(double value)
{
    return static_cast<unsigned char>(std::lround(128.0 + 127.0 * std::clamp(value, -1.0, 1.0)));
}

} // namespace

osg::ref_ptr<osg::Image> DetailNoise::makeImage()
{
    const std::vector<PlaneWave> waves = makeWaves();
    std::array<std::complex<double>, side> turns;
    for (int i = 0; i < side; ++i)
        turns[static_cast<std::size_t>(i)] = std::polar(1.0, 2.0 * osg::PI * i / side);
    const auto turn = [&](int count)
    {
        return turns[static_cast<std::size_t>(((count % side) + side) % side)];
    };
    const double amplitude = deviation * std::sqrt(2.0 / planeWaves);
    double slopes = 0.0;
    for (const PlaneWave& wave : waves)
        slopes +=
            (wave.waves[0] * wave.waves[0] + wave.waves[1] * wave.waves[1] + wave.waves[2] * wave.waves[2]) /
            3.0;
    const double perWave = 1.0 / std::sqrt(slopes / planeWaves);

    osg::ref_ptr<osg::Image> image = new osg::Image;
    image->allocateImage(side, side, side, GL_RGBA, GL_UNSIGNED_BYTE);
    unsigned char* texel = image->data();
    std::vector<std::complex<double>> row(waves.size());
    for (int z = 0; z < side; ++z)
    {
        for (int y = 0; y < side; ++y)
        {
            for (std::size_t i = 0; i < waves.size(); ++i)
                row[i] = waves[i].phase * turn(waves[i].waves[1] * y + waves[i].waves[2] * z);
            for (int x = 0; x < side; ++x)
            {
                double height = 0.0;
                osg::Vec3d slope;
                for (std::size_t i = 0; i < waves.size(); ++i)
                {
                    const std::complex<double> value = row[i] * turn(waves[i].waves[0] * x);
                    height += value.real();
                    slope -=
                        osg::Vec3d(waves[i].waves[0], waves[i].waves[1], waves[i].waves[2]) * value.imag();
                }
                for (int axis = 0; axis < 3; ++axis)
                    *texel++ = coded(amplitude * perWave * slope[axis]);
                *texel++ = coded(amplitude * height);
            }
        }
    }
    return image;
}

osg::Matrixd DetailNoise::octave(int index, double wavelength)
{
    // Turned by the golden angle about an axis of its own, so that no two octaves repeat together.
    const double golden = osg::PI * (3.0 - std::sqrt(5.0));
    const osg::Vec3d axis(std::sin(1.7 * index + 0.6), std::cos(2.3 * index), 0.8);
    const osg::Quat turn(golden * (index + 1), axis);
    const double period = glsl::GEOFX_DETAIL_WAVES * wavelength;
    return osg::Matrixd::rotate(turn) * osg::Matrixd::scale(1.0 / period, 1.0 / period, 1.0 / period);
}

osg::ref_ptr<osg::Texture3D> DetailNoise::texture()
{
    const std::lock_guard<std::mutex> lock(_mutex);
    if (!_texture)
    {
        // All effects of a process have the same one.
        static const osg::ref_ptr<osg::Image> image = makeImage();
        _texture = new osg::Texture3D(image);
        // Waves are gone before they need mipmaps.
        _texture->setFilter(osg::Texture::MIN_FILTER, osg::Texture::LINEAR);
        _texture->setFilter(osg::Texture::MAG_FILTER, osg::Texture::LINEAR);
        for (const osg::Texture::WrapParameter wrap :
             {osg::Texture::WRAP_S, osg::Texture::WRAP_T, osg::Texture::WRAP_R})
            _texture->setWrap(wrap, osg::Texture::REPEAT);
        _texture->setResizeNonPowerOfTwoHint(false);
    }
    return _texture;
}

osg::ref_ptr<osg::Texture2D> DetailNoise::noCover()
{
    const std::lock_guard<std::mutex> lock(_mutex);
    if (!_noCover)
    {
        osg::ref_ptr<osg::Image> image = new osg::Image;
        image->allocateImage(1, 1, 1, GL_RGBA, GL_UNSIGNED_BYTE);
        image->setColor(osg::Vec4(0.0f, 0.0f, 0.0f, 1.0f), 0, 0);
        _noCover = new osg::Texture2D(image);
        _noCover->setFilter(osg::Texture::MIN_FILTER, osg::Texture::NEAREST);
        _noCover->setFilter(osg::Texture::MAG_FILTER, osg::Texture::NEAREST);
    }
    return _noCover;
}

void DetailNoise::resizeGLObjectBuffers(unsigned int size)
{
    const std::lock_guard<std::mutex> lock(_mutex);
    if (_texture) _texture->resizeGLObjectBuffers(size);
    if (_noCover) _noCover->resizeGLObjectBuffers(size);
}

void DetailNoise::releaseGLObjects(osg::State* state) const
{
    const std::lock_guard<std::mutex> lock(_mutex);
    if (_texture) _texture->releaseGLObjects(state);
    if (_noCover) _noCover->releaseGLObjects(state);
}

} // namespace osgGeoFX
