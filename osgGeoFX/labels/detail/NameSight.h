// SPDX-License-Identifier: MIT
// SPDX-FileCopyrightText: 2026 the osgGeoFX authors
#pragma once

#include <osgGeoFX/scene/DepthReader.h>

#include <osg/Vec3d>

#include <algorithm>
#include <memory>
#include <vector>

namespace osgGeoFX
{

/// Whether a name's places, where they are drawn in world coordinates, are to be seen in the pictures of a view's cameras. A curve is
/// seen if a third of it is: trees and ridges stand before parts of it, and its name lies over them.
inline bool isSeen(const std::vector<osg::Vec3d>& drawn,
                   const std::vector<std::shared_ptr<const DepthPicture>>& pictures)
{
    const double tolerance = drawn.size() > 1 ? 0.02 : 0.004;
    const auto seen =
        std::count_if(drawn.begin(), drawn.end(),
                      [&](const osg::Vec3d& place)
                      {
                          return std::any_of(pictures.begin(), pictures.end(),
                                             [&](const auto& picture)
                                             { return picture->shows(place * picture->view, 1, tolerance); });
                      });
    return 3 * static_cast<std::size_t>(seen) >= drawn.size();
}

} // namespace osgGeoFX
