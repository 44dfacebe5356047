// SPDX-License-Identifier: MIT
// SPDX-FileCopyrightText: 2026 the osgGeoFX authors
#pragma once

#include <osgGeoFX/mapping/MarkImages.h>

namespace figure3
{

/// How far a place of the square −1…1 lies within a sign's figure; negative outside.
using Glyph = double (*)(double x, double y);

double planeGlyph(double x, double y);
double peakGlyph(double x, double y);
double anchorGlyph(double x, double y);
double sunGlyph(double x, double y);
double crossGlyph(double x, double y);
double flagGlyph(double x, double y);

/// A round sign: the figure in white on a color.
osg::ref_ptr<osg::Image> makeSign(Glyph glyph, const osg::Vec4& color);
/// A pin; its tip is the image's middle.
osg::ref_ptr<osg::Image> makePin(const osg::Vec4& color);

} // namespace figure3
