// SPDX-License-Identifier: MIT
// SPDX-FileCopyrightText: 2026 the osgGeoFX authors
#include "Marks.h"

#include <osg/Math>

#include <algorithm>
#include <cmath>

using namespace osgGeoFX;

namespace figure3
{

namespace
{

/// Within a stroke with round ends.
double stroke(double x, double y, double x1, double y1, double x2, double y2, double half)
{
    const double dx = x2 - x1;
    const double dy = y2 - y1;
    const double t = std::clamp(((x - x1) * dx + (y - y1) * dy) / (dx * dx + dy * dy), 0.0, 1.0);
    return half - std::hypot(x - x1 - t * dx, y - y1 - t * dy);
}

osg::Vec4 mixed(const osg::Vec4& a, const osg::Vec4& b, double share)
{
    return a * static_cast<float>(1.0 - share) + b * static_cast<float>(share);
}

const osg::Vec4 white(1.0f, 1.0f, 1.0f, 1.0f);

} // namespace

double planeGlyph(double x, double y)
{
    const double side = std::abs(x);
    return std::max({stroke(x, y, 0.0, -0.55, 0.0, 0.55, 0.12), stroke(side, y, 0.0, 0.12, 0.58, -0.14, 0.10),
                     stroke(side, y, 0.0, -0.46, 0.24, -0.56, 0.07)});
}

double peakGlyph(double x, double y)
{
    const auto triangle = [&](double middle, double top, double slope)
    {
        return std::min(y + 0.42, (top - y - slope * std::abs(x - middle)) / std::hypot(1.0, slope));
    };
    return std::max(triangle(-0.10, 0.55, 1.75), triangle(0.36, 0.14, 1.75));
}

double anchorGlyph(double x, double y)
{
    const double side = std::abs(x);
    const double ring = 0.075 - std::abs(std::hypot(x, y - 0.47) - 0.12);
    const double bow = y < -0.10 ? 0.085 - std::abs(std::hypot(x, y + 0.08) - 0.44) : -1.0;
    return std::max({ring, bow, stroke(x, y, 0.0, -0.5, 0.0, 0.36, 0.085),
                     stroke(side, y, 0.0, 0.16, 0.24, 0.16, 0.07),
                     stroke(side, y, 0.44, -0.10, 0.33, -0.20, 0.09)});
}

double sunGlyph(double x, double y)
{
    const double away = std::hypot(x, y);
    const double eighth = osg::PI / 4.0;
    const double angle = std::atan2(y, x);
    const double turned = angle - eighth * std::round(angle / eighth);
    return std::max(0.28 - away,
                    stroke(away * std::cos(turned), away * std::sin(turned), 0.42, 0.0, 0.58, 0.0, 0.065));
}

double crossGlyph(double x, double y)
{
    const double a = std::abs(x);
    const double b = std::abs(y);
    return std::max(std::min(0.17 - a, 0.52 - b), std::min(0.17 - b, 0.52 - a));
}

double flagGlyph(double x, double y)
{
    const double cloth =
        std::min({x + 0.18, 0.60 - y, y - 0.02, (0.52 - x) * 0.9 - std::abs(y - 0.31) * 0.9});
    return std::max({cloth, stroke(x, y, -0.18, -0.5, -0.18, 0.55, 0.075),
                     stroke(x, y, -0.36, -0.52, 0.10, -0.52, 0.07)});
}

osg::ref_ptr<osg::Image> makeSign(Glyph glyph, const osg::Vec4& color)
{
    return makeMark(256,
                    [&](double x, double y, double texel)
                    {
                        const double away = std::hypot(x, y);
                        osg::Vec4 result = mixed(white, color, markCover(0.88 - away, texel));
                        result = mixed(result, white, markCover(glyph(x / 0.92, y / 0.92), texel));
                        result.a() = static_cast<float>(markCover(1.0 - away, texel));
                        return result;
                    });
}

osg::ref_ptr<osg::Image> makePin(const osg::Vec4& color)
{
    return makeMark(256,
                    [&](double x, double y, double texel)
                    {
                        // A disc, and the two tangents that meet at its tip.
                        const double radius = 0.36;
                        const double middle = 0.60;
                        const double half = std::asin(radius / middle);
                        const double away = std::hypot(x, y - middle);
                        const double flank = y * std::sin(half) - std::abs(x) * std::cos(half);
                        const double tangent = middle * std::cos(half) * std::cos(half);
                        const double within = std::max(radius - away, y < tangent ? flank : -1.0);
                        osg::Vec4 result = mixed(white, color, markCover(within - 0.06, texel));
                        result = mixed(result, white, markCover(0.13 - away, texel));
                        result.a() = static_cast<float>(markCover(within, texel));
                        return result;
                    });
}

} // namespace figure3
