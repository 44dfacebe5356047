// SPDX-License-Identifier: MIT
// SPDX-FileCopyrightText: 2026 the osgGeoFX authors
#pragma once

#include <osg/Array>
#include <osg/Group>
#include <osg/Vec2d>
#include <osg/Vec4>
#include <osgText/Font>
#include <osgText/Text>

#include <string>
#include <vector>

namespace osgGeoFX
{

using OverlayPoints = std::vector<osg::Vec2d>;

/// A rectangle of the viewport, pixels, y up.
struct PixelBox
{
    double left = 0.0, bottom = 0.0, width = 0.0, height = 0.0;

    double right() const { return left + width; }
    double top() const { return bottom + height; }
    osg::Vec2d middle() const { return {left + 0.5 * width, bottom + 0.5 * height}; }
    bool has(const osg::Vec2d& place) const
    {
        return place.x() >= left && place.y() >= bottom && place.x() < right() && place.y() < top();
    }
};

/** Collects what an overlay draws: flat shapes with smooth edges, and texts over them. Places are pixels. Colors with alpha. */
class OverlayShapes
{
public:
    explicit OverlayShapes(osgText::Font* font) : _font(font) {}

    void box(const osg::Vec2d& low, const osg::Vec2d& high, const osg::Vec4& color);
    /// The same, at whole pixels.
    void box(const PixelBox& box, const osg::Vec4& color);
    /// A convex polygon, whichever way round.
    void polygon(const OverlayPoints& corners, const osg::Vec4& color);
    void line(const OverlayPoints& points, double width, const osg::Vec4& color);
    void disc(const osg::Vec2d& center, double radius, const osg::Vec4& color);
    void ring(const osg::Vec2d& center, double radius, double width, const osg::Vec4& color);
    /// UTF-8. `place`: the middle of the text's base line, or its left or right end.
    void text(const std::string& words, const osg::Vec2d& place, double size, const osg::Vec4& color,
              osgText::Text::AlignmentType alignment = osgText::Text::CENTER_BASE_LINE);

    /// How wide a text of this size is.
    double widthOf(const std::string& words, double size) const;

    /// All of it: the shapes in their order, and the texts over them.
    osg::ref_ptr<osg::Group> group() const;

private:
    osg::ref_ptr<osgText::Text> makeText(const std::string& words, double size) const;
    void triangle(const osg::Vec2d& a, const osg::Vec2d& b, const osg::Vec2d& c, const osg::Vec4& colorA,
                  const osg::Vec4& colorB, const osg::Vec4& colorC);

    osg::ref_ptr<osgText::Font> _font;
    osg::ref_ptr<osg::Vec3Array> _corners = new osg::Vec3Array;
    osg::ref_ptr<osg::Vec4Array> _colors = new osg::Vec4Array;
    std::vector<osg::ref_ptr<osgText::Text>> _texts;
};

/// What of a convex polygon lies on the side of a line where `normal` * place <= limit.
OverlayPoints clippedPolygon(const OverlayPoints& corners, const osg::Vec2d& normal, double limit);
/// The part of a segment that lies in a box; empty if there is none.
OverlayPoints clippedSegment(const osg::Vec2d& from, const osg::Vec2d& to, const osg::Vec2d& low,
                             const osg::Vec2d& high);

/// The size of overlays' texts in a viewport of this height, pixels.
double overlayTextSize(double height);

/// The colors of overlays.
namespace overlay
{
const osg::Vec4 background(0.06f, 0.07f, 0.09f, 0.78f);
const osg::Vec4 bright(0.95f, 0.95f, 0.95f, 1.0f);
const osg::Vec4 dim(0.66f, 0.68f, 0.71f, 1.0f);
const osg::Vec4 warm(0.98f, 0.72f, 0.28f, 1.0f); ///< the transition zone
const osg::Vec4 cold(0.45f, 0.74f, 1.00f, 1.0f); ///< the context
} // namespace overlay

} // namespace osgGeoFX
