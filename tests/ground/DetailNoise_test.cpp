// SPDX-License-Identifier: MIT
// SPDX-FileCopyrightText: 2026 the osgGeoFX authors
//
// The noise of GroundDetail.
#include <osgGeoFX/effect/GlslFunctions.h>
#include <osgGeoFX/ground/detail/DetailNoise.h>

#include <gtest/gtest.h>

#include <cmath>

using osgGeoFX::DetailNoise;

namespace
{

constexpr int side = DetailNoise::side;

double valueOf(const osg::Image& image, int x, int y, int z, int channel)
{
    const auto wrapped = [](int i)
    {
        return static_cast<unsigned int>((i % side + side) % side);
    };
    return (image.data(wrapped(x), wrapped(y), wrapped(z))[channel] - 128.0) / 127.0;
}

class DetailNoiseTest : public ::testing::Test
{
protected:
    static double height(int x, int y, int z) { return valueOf(*_image, x, y, z, 3); }
    static const osg::ref_ptr<osg::Image> _image;
};

const osg::ref_ptr<osg::Image> DetailNoiseTest::_image = DetailNoise::makeImage();

} // namespace

TEST_F(DetailNoiseTest, HasTheMeansThatTheShadersCountOn)
{
    double sum = 0.0, absolute = 0.0, square = 0.0;
    int cut = 0;
    for (int i = 0; i < side * side * side; ++i)
    {
        const double value = height(i % side, i / side % side, i / side / side);
        sum += value;
        absolute += std::abs(value);
        square += value * value;
        cut += std::abs(value) > 0.999 ? 1 : 0;
    }
    const double count = side * side * side;
    EXPECT_NEAR(sum / count, 0.0, 0.01);
    EXPECT_NEAR(absolute / count, osgGeoFX::glsl::GEOFX_DETAIL_MEAN, 0.01);
    EXPECT_NEAR(std::sqrt(square / count), 0.33, 0.01);
    EXPECT_LT(cut / count, 0.01);
}

// No seam at the period's ends, and the same waves in all directions.
TEST_F(DetailNoiseTest, IsPeriodicAndHasNoDirection)
{
    double inside[3] = {}, seam[3] = {};
    for (int i = 0; i < side * side; ++i)
    {
        const int a = i % side, b = i / side;
        for (int axis = 0; axis < 3; ++axis)
        {
            const auto step = [&](int at)
            {
                const int low[3] = {at, a, b};
                const int high[3] = {at + 1, a, b};
                const auto pick = [&](const int* of, int which)
                {
                    return of[(which - axis + 3) % 3];
                };
                return std::abs(height(pick(high, 0), pick(high, 1), pick(high, 2)) -
                                height(pick(low, 0), pick(low, 1), pick(low, 2)));
            };
            inside[axis] += step(31);
            seam[axis] += step(side - 1);
        }
    }
    for (int axis = 0; axis < 3; ++axis)
    {
        EXPECT_NEAR(seam[axis] / inside[axis], 1.0, 0.15) << axis;
        EXPECT_NEAR(inside[axis] / inside[0], 1.0, 0.25) << axis;
    }
}

// As many waves across a period as the shaders think, so that fading octaves are what they say.
TEST_F(DetailNoiseTest, HasEightWavesInAPeriod)
{
    int turns = 0;
    for (int i = 0; i < side * side; ++i)
    {
        for (int x = 0; x < side; ++x)
            turns +=
                (height(x, i % side, i / side) < 0.0) != (height(x + 1, i % side, i / side) < 0.0) ? 1 : 0;
    }
    // A line through waves in all directions meets fewer of them: 1/√3 of the turns.
    const double waves = 0.5 * turns / (side * side) * std::sqrt(3.0);
    EXPECT_NEAR(waves, osgGeoFX::glsl::GEOFX_DETAIL_WAVES, 1.0);
}

TEST_F(DetailNoiseTest, HasTheGradientOfItsHeights)
{
    double product = 0.0, gradient = 0.0, difference = 0.0;
    for (int i = 0; i < side * side * side; i += 7)
    {
        const int x = i % side, y = i / side % side, z = i / side / side;
        const double steps[3] = {height(x + 1, y, z) - height(x - 1, y, z),
                                 height(x, y + 1, z) - height(x, y - 1, z),
                                 height(x, y, z + 1) - height(x, y, z - 1)};
        for (int axis = 0; axis < 3; ++axis)
        {
            const double value = valueOf(*_image, x, y, z, axis);
            product += value * steps[axis];
            gradient += value * value;
            difference += steps[axis] * steps[axis];
        }
    }
    EXPECT_GT(product / std::sqrt(gradient * difference), 0.97);
    // Each component of a slope has the deviation of a height.
    EXPECT_NEAR(std::sqrt(gradient / (side * side * side / 7.0 * 3.0)), 0.33, 0.02);
}

TEST(DetailOctaves, AreTurnsOfTheWorldByTheirWaves)
{
    for (int i = 0; i < osgGeoFX::glsl::GEOFX_DETAIL_MOST; ++i)
    {
        const double wavelength = 300.0 / std::pow(2.3, i);
        const osg::Matrixd octave = DetailNoise::octave(i, wavelength);
        EXPECT_EQ(octave.getTrans(), osg::Vec3d());
        for (const osg::Vec3d& axis : {osg::Vec3d(1, 0, 0), osg::Vec3d(0, 1, 0), osg::Vec3d(0, 0, 1)})
            EXPECT_NEAR((axis * octave).length() * wavelength * osgGeoFX::glsl::GEOFX_DETAIL_WAVES, 1.0,
                        1e-9);
        // No two have an axis in common.
        for (int j = 0; j < i; ++j)
        {
            const osg::Matrixd other = DetailNoise::octave(j, wavelength);
            for (const osg::Vec3d& axis : {osg::Vec3d(1, 0, 0), osg::Vec3d(0, 1, 0), osg::Vec3d(0, 0, 1)})
            {
                osg::Vec3d a = axis * octave, b = axis * other;
                a.normalize();
                b.normalize();
                EXPECT_LT(std::abs(a * b), 0.9995) << i << " " << j;
            }
        }
    }
}
