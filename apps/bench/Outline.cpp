// SPDX-License-Identifier: MIT
// SPDX-FileCopyrightText: 2026 the osgGeoFX authors
#include "Outline.h"

#include <algorithm>

namespace geofx::bench
{

namespace
{

bool covered(const osg::Image& image, int x, int y)
{
    return *image.data(static_cast<unsigned int>(x), static_cast<unsigned int>(y)) > 127;
}

/// Distance from a pixel to the nearest one of the other kind; the picture's size where there is none.
int distanceToOtherKind(const osg::Image& image, int x, int y)
{
    const bool here = covered(image, x, y);
    const int farthest = std::max(image.s(), image.t());
    for (int radius = 1; radius < farthest; ++radius)
    {
        for (int j = std::max(0, y - radius); j <= std::min(image.t() - 1, y + radius); ++j)
        {
            // Inside the square only its border is new.
            const int step = j == y - radius || j == y + radius ? 1 : 2 * radius;
            for (int i = x - radius; i <= x + radius; i += step)
            {
                if (i >= 0 && i < image.s() && covered(image, i, j) != here) return radius;
            }
        }
    }
    return farthest;
}

} // namespace

OutlineDifference compareOutlines(const osg::Image& a, const osg::Image& b)
{
    OutlineDifference difference;
    for (int y = 0; y < a.t(); ++y)
    {
        for (int x = 0; x < a.s(); ++x)
        {
            if (covered(a, x, y) == covered(b, x, y)) continue;
            ++difference.pixels;
            // It cannot grow any more where one of the pictures shows nothing.
            if (difference.distance >= std::max(a.s(), a.t())) continue;
            difference.distance =
                std::max({difference.distance, distanceToOtherKind(a, x, y), distanceToOtherKind(b, x, y)});
        }
    }
    return difference;
}

osg::ref_ptr<osg::Image> drawOutlines(const osg::Image& a, const osg::Image& b)
{
    osg::ref_ptr<osg::Image> result = new osg::Image;
    result->allocateImage(a.s(), a.t(), 1, GL_RGB, GL_UNSIGNED_BYTE, 1);
    for (int y = 0; y < a.t(); ++y)
    {
        for (int x = 0; x < a.s(); ++x)
        {
            const bool inA = covered(a, x, y), inB = covered(b, x, y);
            unsigned char* const pixel =
                result->data(static_cast<unsigned int>(x), static_cast<unsigned int>(y));
            pixel[0] = inA ? (inB ? 96 : 255) : 0;
            pixel[1] = inB ? (inA ? 96 : 255) : 0;
            pixel[2] = inA && inB ? 96 : 0;
        }
    }
    return result;
}

} // namespace geofx::bench
