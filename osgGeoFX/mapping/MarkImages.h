// SPDX-License-Identifier: MIT
// SPDX-FileCopyrightText: 2026 the osgGeoFX authors
#pragma once

#include <osgGeoFX/Export.h>

#include <osg/Image>
#include <osg/Vec4>

#include <functional>

namespace osgGeoFX
{

/// Round marks fill this share of half their image's side. The rest is an empty border, which keeps their edges
/// smooth.
constexpr double markReach = 0.97;

/// A function that gives the color at x and y, −1…1 within a mark's reach. `texel` is the size of a texel in this
/// unit. Colors are sRGB-coded, 0…1, with straight alpha.
using MarkColor = std::function<osg::Vec4(double x, double y, double texel)>;
/// A square RGBA image of `color`, with `side` texels along each side.
OSGGEOFX_EXPORT osg::ref_ptr<osg::Image> makeMark(int side, const MarkColor& color);

/// The share of a texel that lies within an outline, 0…1. `inwards` is the distance of the texel's center from the
/// outline, positive inside, in the mark's unit.
inline double markCover(double inwards, double texel)
{
    const double cover = inwards / texel + 0.5;
    return cover < 0.0 ? 0.0 : cover > 1.0 ? 1.0 : cover;
}

/// A disc. Outside of the radius `inner` (0…1) it has the color `rim`.
OSGGEOFX_EXPORT osg::ref_ptr<osg::Image> makeDisc(int side, const osg::Vec4& color, const osg::Vec4& rim,
                                                  double inner);

} // namespace osgGeoFX
