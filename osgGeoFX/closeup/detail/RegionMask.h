// SPDX-License-Identifier: MIT
// SPDX-FileCopyrightText: 2026 the osgGeoFX authors
#pragma once

#include <osg/Image>
#include <osg/Vec2d>

#include <cstddef>
#include <optional>
#include <string>
#include <utility>
#include <vector>

/// The making of masks for regions of interest (RegionOfInterest.h). Everything here is thread-safe.
namespace osgGeoFX::region
{

using Line = std::vector<osg::Vec2d>;

/** A picture of side² numbers over a region. Row 0 is at y = −1.

    Lengths are in halves of the region's smaller side, so that distances are true even if width and depth differ.
    Places reach from −half to +half; the smaller coordinate of `half` is 1. */
struct Picture
{
    Picture(int texels, const osg::Vec2d& halfSizes)
        : side(texels), half(halfSizes), values(static_cast<std::size_t>(texels) * texels)
    {
    }

    int side;
    osg::Vec2d half;
    std::vector<float> values;

    float& at(int column, int row) { return values[static_cast<std::size_t>(row) * side + column]; }
    float at(int column, int row) const { return values[static_cast<std::size_t>(row) * side + column]; }
    /// The width and height of a texel.
    osg::Vec2d texel() const { return half * (2.0 / side); }
    /// The center of a texel, also of one outside the picture.
    osg::Vec2d place(int column, int row) const
    {
        return {(2.0 * column + 1.0 - side) / side * half.x(), (2.0 * row + 1.0 - side) / side * half.y()};
    }
    /// The distance from the center of a texel to the region's border.
    double toBorder(int column, int row) const;
};

/// Signed distances to a shape's border, positive inside, exact.
Picture ellipseDistances(int side, const osg::Vec2d& half);
Picture rectangleDistances(int side, const osg::Vec2d& half, double radius);
/// The corners are in −1…1. A pair of edges between the same corners is no border, so an outline may have holes.
Picture outlineDistances(int side, const osg::Vec2d& half, const Line& corners);
/// Distances to the line where bilinearly interpolated greys are one half, and, from inside, to the region's border.
/// −2 if all is outside.
Picture greyDistances(const Picture& grey);

/// The corners of a star, −1…1.
Line starCorners(int points, double innerRadius);
/// Whether the odd-even rule leaves anything inside.
bool hasArea(const Line& corners);

/// An image's luminance times alpha, averaged by area or interpolated. Nothing, with a sentence in `error`, if the
/// image cannot be read.
std::optional<Picture> greys(const osg::Image& image, int side, const osg::Vec2d& half, std::string& error);
/// The sentence for an image that greys() cannot read; empty if it can.
std::string refusal(const osg::Image& image);

/// 1 inside and 0 outside, with a ramp of one texel on both sides of the border.
Picture sharpMask(const Picture& distances);
/// Grows from 0 at the border to 1 at `softness` inside of it.
Picture softMask(const Picture& distances, double softness);
/// Blurred by `softness`; grows from 0 at the region's border.
Picture blurred(const Picture& grey, double softness);

/// The closed lines where the distances are 0, in −1…1, with the inside on the left. Everything beyond the picture is
/// outside.
std::vector<Line> borders(const Picture& distances);

} // namespace osgGeoFX::region
