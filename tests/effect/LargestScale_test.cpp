// SPDX-License-Identifier: MIT
// SPDX-FileCopyrightText: 2026 the osgGeoFX authors
//
// By how much a matrix lengthens vectors at most, against vectors that it lengthens.
#include <tools/RandomSamples.h>

#include <gtest/gtest.h>
#include <osgGeoFX/effect/DeformationChain.h>

#include <algorithm>

using namespace osgGeoFX;
using namespace geofx::test;

namespace
{

osg::Matrixd randomTurn(Random& random)
{
    osg::Vec3d axis(random.uniform(-1.0, 1.0), random.uniform(-1.0, 1.0), random.uniform(-1.0, 1.0));
    axis.normalize();
    return osg::Matrixd::rotate(random.uniform(-3.0, 3.0), axis);
}

/// What the matrix makes of the vector that it lengthens most, found by going there again and again.
double lengthened(const osg::Matrixd& matrix, Random& random)
{
    double most = 0.0;
    for (int start = 0; start < 4; ++start)
    {
        osg::Vec3d vector(random.uniform(-1.0, 1.0), random.uniform(-1.0, 1.0), random.uniform(-1.0, 1.0));
        for (int step = 0; step < 2000; ++step)
        {
            vector.normalize();
            const osg::Vec3d image = osg::Matrixd::transform3x3(vector, matrix);
            most = std::max(most, image.length());
            vector = osg::Matrixd::transform3x3(matrix, image);
        }
    }
    return most;
}

} // namespace

TEST(LargestScale, OfAScaleAboveATurn)
{
    // A node that scales x by ten, above one that turns by 45°.
    const osg::Matrixd matrix =
        osg::Matrixd::rotate(osg::PI_4, osg::Vec3d(0, 0, 1)) * osg::Matrixd::scale(10, 1, 1);
    EXPECT_NEAR(largestScale(matrix), 10.0, 1e-4);
    EXPECT_GE(largestScale(matrix), 10.0);
    EXPECT_NEAR(largestScale(osg::Matrixd::scale(2, 3, 4)), 4.0, 1e-4);
    EXPECT_NEAR(largestScale(osg::Matrixd()), 1.0, 1e-5);
    EXPECT_NEAR(largestScale(osg::Matrixd::translate(5, 6, 7)), 1.0, 1e-5);
    EXPECT_EQ(largestScale(osg::Matrixd::scale(0, 0, 0)), 0.0);
}

TEST(LargestScale, HoldsAndIsTight)
{
    Random random(1);
    for (int i = 0; i < 300; ++i)
    {
        SCOPED_TRACE(i);
        osg::Matrixd matrix;
        for (int part = random.integer(1, 3); part > 0; --part)
        {
            matrix.postMult(randomTurn(random));
            matrix.postMult(
                osg::Matrixd::scale(random.logarithmic(0.01, 100.0), random.logarithmic(0.01, 100.0),
                                    random.integer(0, 3) ? random.logarithmic(0.01, 100.0) : 0.0));
        }
        if (random.integer(0, 1)) matrix.postMult(randomTurn(random));
        const double most = lengthened(matrix, random);
        EXPECT_GE(largestScale(matrix), most * (1.0 - 1e-12));
        EXPECT_LE(largestScale(matrix), most * (1.0 + 3e-5));
    }
}
