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

/// What the masks of regions of interest are made with (RegionOfInterest.h). All of it is thread-safe.
namespace osgGeoFX::region
{

using Line = std::vector<osg::Vec2d>;

/** A picture of side² numbers over a region, row 0 at y = −1.

    Lengths are in halves of the region's smaller side, so that distances are true where width and depth differ:
    places reach from −half to +half, the smaller part of which is 1. */
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
    /// Width and height of a texel.
    osg::Vec2d texel() const { return half * (2.0 / side); }
    /// The center of a texel, of those beside the picture too.
    osg::Vec2d place(int column, int row) const
    {
        return {(2.0 * column + 1.0 - side) / side * half.x(), (2.0 * row + 1.0 - side) / side * half.y()};
    }
    /// How far the center of a texel is from the region's border.
    double toBorder(int column, int row) const;
};

/// Signed distances to a shape's border, positive inside, exact.
Picture ellipseDistances(int side, const osg::Vec2d& half);
Picture rectangleDistances(int side, const osg::Vec2d& half, double radius);
/// Corners in −1…1. What two edges share that run between the same corners is no border, so that outlines may have holes.
Picture outlineDistances(int side, const osg::Vec2d& half, const Line& corners);
/// To the line where bilinearly interpolated greys are one half, and to the region's border from inside. −2 where all is
/// outside.
Picture greyDistances(const Picture& grey);

/// A star's corners, −1…1.
Line starCorners(int points, double innerRadius);
/// Whether the odd-even rule leaves anything inside.
bool hasArea(const Line& corners);

/// An image's luminance times alpha, averaged by area or interpolated. Nothing, with a sentence in `error`, where the image
/// cannot be read.
std::optional<Picture> greys(const osg::Image& image, int side, const osg::Vec2d& half, std::string& error);
/// A sentence where greys() could not read the image.
std::string refusal(const osg::Image& image);

/// 1 inside and 0 outside, with a ramp of one texel on both sides of the border.
Picture sharpMask(const Picture& distances);
/// Grows from 0 at the border to 1 at `softness` inside.
Picture softMask(const Picture& distances, double softness);
/// Blurred as far as `softness`, and grows from 0 at the region's border.
Picture blurred(const Picture& grey, double softness);

/// Closed lines where distances are 0, in −1…1, the inside on the left. Outside of the picture is outside.
std::vector<Line> borders(const Picture& distances);

} // namespace osgGeoFX::region
