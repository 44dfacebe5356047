// SPDX-License-Identifier: MIT
// SPDX-FileCopyrightText: 2026 the osgGeoFX authors
#pragma once

#include <osg/Image>

#include <cstdint>

namespace geofx::bench
{

/// How the outlines of what two pictures show differ.
struct OutlineDifference
{
    std::uint64_t pixels = 0; ///< covered in one picture alone
    int distance = 0;         ///< the farthest of them from its picture's, or the other's, outline, pixels
};

/** Compares the outlines in two pictures of a size, white on black.

    A pixel that only one picture covers is off by the distance, the larger of x and y, to the nearest pixel
   of the other kind, in that one of the two pictures where it is farther. */
OutlineDifference compareOutlines(const osg::Image& a, const osg::Image& b);

/// For people: grey where both pictures are covered, red where only the first is, green where only the second is.
osg::ref_ptr<osg::Image> drawOutlines(const osg::Image& a, const osg::Image& b);

} // namespace geofx::bench
