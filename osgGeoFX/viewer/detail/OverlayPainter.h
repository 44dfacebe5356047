// SPDX-License-Identifier: MIT
// SPDX-FileCopyrightText: 2026 the osgGeoFX authors
#pragma once

#include <osg/Geometry>
#include <osg/Group>
#include <osg/Vec2d>
#include <osgText/Text>

#include <string>

namespace osgGeoFX
{

/// A rectangle of the viewport, pixels, y up.
struct PixelBox
{
    double left = 0.0, bottom = 0.0, width = 0.0, height = 0.0;

    double right() const { return left + width; }
    double top() const { return bottom + height; }
    bool has(const osg::Vec2d& place) const
    {
        return place.x() >= left && place.y() >= bottom && place.x() < right() && place.y() < top();
    }
};

/// Collects shapes and texts in the order in which they are drawn, and gives them out as one group for an overlay.
class OverlayPainter
{
public:
    /// `font`: null is OSG's own.
    OverlayPainter(double textSize, osgText::Font* font);

    void box(const PixelBox& box, const osg::Vec4& color);
    void line(const osg::Vec2d& from, const osg::Vec2d& to, double width, const osg::Vec4& color);
    void disc(const osg::Vec2d& middle, double radius, const osg::Vec4& color);
    /// `x` is where the text has its left end, middle or right end; `baseLine` its base line. UTF-8.
    void text(const std::string& words, double x, double baseLine, osgText::Text::AlignmentType alignment,
              const osg::Vec4& color);
    /// How wide a text is.
    double widthOf(const std::string& words) const;

    /// Shapes first, and texts over them.
    osg::ref_ptr<osg::Group> take();

private:
    osg::ref_ptr<osgText::Text> make(const std::string& words) const;
    void triangle(const osg::Vec2d& a, const osg::Vec2d& b, const osg::Vec2d& c, const osg::Vec4& color);

    double _size;
    osg::ref_ptr<osgText::Font> _font;
    osg::ref_ptr<osg::Group> _group = new osg::Group;
    osg::ref_ptr<osg::Geometry> _shapes = new osg::Geometry;
    osg::ref_ptr<osg::Vec3Array> _corners = new osg::Vec3Array;
    osg::ref_ptr<osg::Vec4Array> _colors = new osg::Vec4Array;
};

} // namespace osgGeoFX
