// SPDX-License-Identifier: MIT
// SPDX-FileCopyrightText: 2026 the osgGeoFX authors
#pragma once

#include <osgGeoFX/Export.h>

#include <osg/Image>
#include <osg/Vec4>

#include <functional>

namespace osgGeoFX
{

/// The share of their image's half side that round marks reach to; the rest is an empty border, for smooth edges.
constexpr double markReach = 0.97;

/// A square RGBA image of a function of x and y, −1…1 within a mark's reach; `texel` is what a texel spans. Colours are
/// sRGB-coded, 0…1, with straight alpha.
using MarkColor = std::function<osg::Vec4(double x, double y, double texel)>;
OSGGEOFX_EXPORT osg::ref_ptr<osg::Image> makeMark(int side, const MarkColor& color);

/// How much of a texel is within an outline: `inwards` is the distance of its middle, in the mark's unit.
inline double markCover(double inwards, double texel)
{
    const double cover = inwards / texel + 0.5;
    return cover < 0.0 ? 0.0 : cover > 1.0 ? 1.0 : cover;
}

/// A disc, its rim outside of `inner` (0…1) in another colour.
OSGGEOFX_EXPORT osg::ref_ptr<osg::Image> makeDisc(int side, const osg::Vec4& color, const osg::Vec4& rim,
                                                  double inner);

} // namespace osgGeoFX
