// SPDX-License-Identifier: MIT
// SPDX-FileCopyrightText: 2026 the osgGeoFX authors
#pragma once

#include <osg/Image>

namespace geofx::test
{

/// How many pixels of two pictures of one size have clearly other colors: farther apart than `distance` in their cube of 0…1.
inline int pixelsApart(const osg::Image& a, const osg::Image& b, float distance = 0.03f)
{
    int count = 0;
    for (int y = 0; y < a.t(); ++y)
        for (int x = 0; x < a.s(); ++x)
        {
            const auto column = static_cast<unsigned int>(x), row = static_cast<unsigned int>(y);
            count += (a.getColor(column, row) - b.getColor(column, row)).length() > distance ? 1 : 0;
        }
    return count;
}

} // namespace geofx::test
