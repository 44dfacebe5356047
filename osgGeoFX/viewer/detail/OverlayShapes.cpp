// SPDX-License-Identifier: MIT
// SPDX-FileCopyrightText: 2026 the osgGeoFX authors
#include <osgGeoFX/viewer/detail/OverlayShapes.h>

#include <osg/Geometry>
#include <osg/Math>

#include <algorithm>
#include <cmath>

namespace osgGeoFX
{

namespace
{

/// Of an edge that fades, pixels.
constexpr double soft = 1.0;

osg::Vec4 clear(const osg::Vec4& color)
{
    return {color.r(), color.g(), color.b(), 0.0f};
}

double cross(const osg::Vec2d& a, const osg::Vec2d& b)
{
    return a.x() * b.y() - a.y() * b.x();
}

osg::Vec2d onCircle(double angle)
{
    return {std::cos(angle), std::sin(angle)};
}

int cornersOf(double radius)
{
    return std::clamp(static_cast<int>(2.5 * radius), 12, 96);
}

} // namespace

void OverlayShapes::triangle(const osg::Vec2d& a, const osg::Vec2d& b, const osg::Vec2d& c,
                             const osg::Vec4& colorA, const osg::Vec4& colorB, const osg::Vec4& colorC)
{
    for (const osg::Vec2d& corner : {a, b, c})
        _corners->push_back(osg::Vec3(osg::Vec3d(corner.x(), corner.y(), 0.0)));
    for (const osg::Vec4& color : {colorA, colorB, colorC})
        _colors->push_back(color);
}

void OverlayShapes::box(const osg::Vec2d& low, const osg::Vec2d& high, const osg::Vec4& color)
{
    const osg::Vec2d right(high.x(), low.y()), left(low.x(), high.y());
    triangle(low, right, high, color, color, color);
    triangle(low, high, left, color, color, color);
}

void OverlayShapes::box(const PixelBox& box, const osg::Vec4& color)
{
    this->box({std::round(box.left), std::round(box.bottom)},
              {std::round(box.right()), std::round(box.top())}, color);
}

void OverlayShapes::polygon(const OverlayPoints& corners, const osg::Vec4& color)
{
    const std::size_t count = corners.size();
    if (count < 3) return;
    double area = 0.0;
    for (std::size_t i = 0; i < count; ++i)
        area += cross(corners[i], corners[(i + 1) % count]);
    for (std::size_t i = 2; i < count; ++i)
        triangle(corners[0], corners[i - 1], corners[i], color, color, color);
    // The edge fades outwards; at a corner its two sides meet.
    OverlayPoints edge;
    for (std::size_t i = 0; i < count; ++i)
    {
        osg::Vec2d before = corners[i] - corners[(i + count - 1) % count];
        osg::Vec2d after = corners[(i + 1) % count] - corners[i];
        const bool begins = before.normalize() <= 0.0, ends = after.normalize() <= 0.0;
        if (begins) before = after;
        if (ends) after = before;
        osg::Vec2d out(before.y() + after.y(), -before.x() - after.x());
        if (area < 0.0) out = -out;
        const double length = out.normalize();
        edge.push_back(corners[i] + out * (soft * 2.0 / std::max(length, 0.7)));
    }
    for (std::size_t i = 0; i < count; ++i)
    {
        const std::size_t next = (i + 1) % count;
        triangle(corners[i], corners[next], edge[next], color, color, clear(color));
        triangle(corners[i], edge[next], edge[i], color, clear(color), clear(color));
    }
}

void OverlayShapes::line(const OverlayPoints& points, double width, const osg::Vec4& color)
{
    const std::size_t count = points.size();
    if (count < 2) return;
    // Both sides of each point, and where they fade.
    OverlayPoints across;
    const bool closed = points.front() == points.back();
    for (std::size_t i = 0; i < count; ++i)
    {
        osg::Vec2d before = points[i] - points[i > 0 ? i - 1 : closed ? count - 2 : 0];
        osg::Vec2d after = points[i + 1 < count ? i + 1 : closed ? 1 : i] - points[i];
        const bool begins = before.normalize() <= 0.0, ends = after.normalize() <= 0.0;
        if (begins) before = after;
        if (ends) after = before;
        osg::Vec2d along = before + after;
        if (along.normalize() <= 0.0) along = before;
        // A mitre, where it is not too long.
        const double stretch = 1.0 / std::max(0.5, std::sqrt(std::max(0.0, 0.5 + 0.5 * (before * after))));
        across.push_back(osg::Vec2d(-along.y(), along.x()) * stretch);
    }
    const double half = std::max(0.5 * width - 0.5 * soft, 0.0);
    for (std::size_t i = 1; i < count; ++i)
    {
        for (const double side : {-1.0, 1.0})
        {
            const osg::Vec2d from = points[i - 1] + across[i - 1] * (side * half);
            const osg::Vec2d to = points[i] + across[i] * (side * half);
            const osg::Vec2d fromOut = points[i - 1] + across[i - 1] * (side * (half + soft));
            const osg::Vec2d toOut = points[i] + across[i] * (side * (half + soft));
            triangle(points[i - 1], points[i], to, color, color, color);
            triangle(points[i - 1], to, from, color, color, color);
            triangle(from, to, toOut, color, color, clear(color));
            triangle(from, toOut, fromOut, color, clear(color), clear(color));
        }
    }
}

void OverlayShapes::disc(const osg::Vec2d& center, double radius, const osg::Vec4& color)
{
    OverlayPoints corners;
    const int count = cornersOf(radius);
    for (int i = 0; i < count; ++i)
        corners.push_back(center + onCircle(2.0 * osg::PI * i / count) * radius);
    polygon(corners, color);
}

void OverlayShapes::ring(const osg::Vec2d& center, double radius, double width, const osg::Vec4& color)
{
    OverlayPoints points;
    const int count = cornersOf(radius);
    for (int i = 0; i <= count; ++i)
        points.push_back(center + onCircle(2.0 * osg::PI * i / count) * radius);
    line(points, width, color);
}

osg::ref_ptr<osgText::Text> OverlayShapes::makeText(const std::string& words, double size) const
{
    osg::ref_ptr<osgText::Text> text = new osgText::Text;
    if (_font) text->setFont(_font);
    text->setCharacterSize(static_cast<float>(size));
    const auto resolution = static_cast<unsigned int>(std::clamp(size * 1.5, 16.0, 96.0));
    text->setFontResolution(resolution, resolution);
    text->setText(osgText::String(words, osgText::String::ENCODING_UTF8));
    return text;
}

double OverlayShapes::widthOf(const std::string& words, double size) const
{
    const osg::BoundingBox bounds = makeText(words, size)->getBoundingBox();
    return bounds.valid() ? static_cast<double>(bounds.xMax()) : 0.0;
}

void OverlayShapes::text(const std::string& words, const osg::Vec2d& place, double size,
                         const osg::Vec4& color, osgText::Text::AlignmentType alignment)
{
    const osg::ref_ptr<osgText::Text> text = makeText(words, size);
    text->setAlignment(alignment);
    text->setColor(color);
    text->setPosition(osg::Vec3(osg::Vec3d(std::round(place.x()), std::round(place.y()), 0.0)));
    _texts.push_back(text);
}

osg::ref_ptr<osg::Group> OverlayShapes::group() const
{
    const osg::ref_ptr<osg::Geometry> shapes = new osg::Geometry;
    shapes->setVertexArray(_corners);
    shapes->setColorArray(_colors, osg::Array::BIND_PER_VERTEX);
    shapes->addPrimitiveSet(new osg::DrawArrays(GL_TRIANGLES, 0, static_cast<int>(_corners->size())));
    shapes->getOrCreateStateSet()->setMode(GL_BLEND, osg::StateAttribute::ON);
    const osg::ref_ptr<osg::Group> group = new osg::Group;
    group->getOrCreateStateSet()->setRenderBinDetails(0, "TraversalOrderBin");
    group->addChild(shapes);
    for (const auto& text : _texts)
        group->addChild(text);
    return group;
}

OverlayPoints clippedPolygon(const OverlayPoints& corners, const osg::Vec2d& normal, double limit)
{
    OverlayPoints result;
    for (std::size_t i = 0; i < corners.size(); ++i)
    {
        const osg::Vec2d& from = corners[i];
        const osg::Vec2d& to = corners[(i + 1) % corners.size()];
        const double before = from * normal - limit, after = to * normal - limit;
        if (before <= 0.0) result.push_back(from);
        if ((before < 0.0 && after > 0.0) || (before > 0.0 && after < 0.0))
            result.push_back(from + (to - from) * (before / (before - after)));
    }
    return result;
}

OverlayPoints clippedSegment(const osg::Vec2d& from, const osg::Vec2d& to, const osg::Vec2d& low,
                             const osg::Vec2d& high)
{
    double begin = 0.0, end = 1.0;
    const osg::Vec2d way = to - from;
    for (int axis = 0; axis < 2; ++axis)
    {
        if (way[axis] == 0.0)
        {
            if (from[axis] < low[axis] || from[axis] > high[axis]) return {};
            continue;
        }
        const double a = (low[axis] - from[axis]) / way[axis], b = (high[axis] - from[axis]) / way[axis];
        begin = std::max(begin, std::min(a, b));
        end = std::min(end, std::max(a, b));
    }
    if (!(begin < end)) return {};
    return {from + way * begin, from + way * end};
}

double overlayTextSize(double height)
{
    return std::clamp(std::round(height / 50.0), 11.0, 22.0);
}

} // namespace osgGeoFX
