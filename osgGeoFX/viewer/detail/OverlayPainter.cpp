// SPDX-License-Identifier: MIT
// SPDX-FileCopyrightText: 2026 the osgGeoFX authors
#include <osgGeoFX/viewer/detail/OverlayPainter.h>

#include <algorithm>
#include <cmath>

namespace osgGeoFX
{

OverlayPainter::OverlayPainter(double textSize, osgText::Font* font) : _size(textSize), _font(font)
{
    _shapes->setVertexArray(_corners);
    _shapes->setColorArray(_colors, osg::Array::BIND_PER_VERTEX);
    _shapes->getOrCreateStateSet()->setMode(GL_BLEND, osg::StateAttribute::ON);
    _group->getOrCreateStateSet()->setRenderBinDetails(0, "TraversalOrderBin");
    _group->addChild(_shapes);
}

void OverlayPainter::triangle(const osg::Vec2d& a, const osg::Vec2d& b, const osg::Vec2d& c,
                              const osg::Vec4& color)
{
    for (const osg::Vec2d& corner : {a, b, c})
    {
        _corners->push_back(osg::Vec3(osg::Vec3d(corner.x(), corner.y(), 0.0)));
        _colors->push_back(color);
    }
}

void OverlayPainter::box(const PixelBox& box, const osg::Vec4& color)
{
    const osg::Vec2d low(std::round(box.left), std::round(box.bottom));
    const osg::Vec2d high(std::round(box.right()), std::round(box.top()));
    triangle(low, {high.x(), low.y()}, high, color);
    triangle(low, high, {low.x(), high.y()}, color);
}

void OverlayPainter::line(const osg::Vec2d& from, const osg::Vec2d& to, double width, const osg::Vec4& color)
{
    osg::Vec2d aside(from.y() - to.y(), to.x() - from.x());
    if (!(aside.normalize() > 0.0)) return;
    aside *= 0.5 * width;
    triangle(from - aside, to - aside, to + aside, color);
    triangle(from - aside, to + aside, from + aside, color);
}

void OverlayPainter::disc(const osg::Vec2d& middle, double radius, const osg::Vec4& color)
{
    constexpr int sides = 20;
    const auto rim = [&](int side)
    {
        const double angle = 2.0 * osg::PI * side / sides;
        return middle + osg::Vec2d(std::cos(angle), std::sin(angle)) * radius;
    };
    for (int side = 0; side < sides; ++side)
        triangle(middle, rim(side), rim(side + 1), color);
}

osg::ref_ptr<osgText::Text> OverlayPainter::make(const std::string& words) const
{
    osg::ref_ptr<osgText::Text> text = new osgText::Text;
    if (_font) text->setFont(_font);
    text->setCharacterSize(static_cast<float>(_size));
    const auto resolution = static_cast<unsigned int>(std::clamp(_size * 1.5, 16.0, 96.0));
    text->setFontResolution(resolution, resolution);
    text->setText(osgText::String(words, osgText::String::ENCODING_UTF8));
    return text;
}

double OverlayPainter::widthOf(const std::string& words) const
{
    const osg::BoundingBox bounds = make(words)->getBoundingBox();
    return bounds.valid() ? static_cast<double>(bounds.xMax()) : 0.0;
}

void OverlayPainter::text(const std::string& words, double x, double baseLine,
                          osgText::Text::AlignmentType alignment, const osg::Vec4& color)
{
    const osg::ref_ptr<osgText::Text> text = make(words);
    text->setAlignment(alignment);
    text->setColor(color);
    text->setPosition(osg::Vec3(osg::Vec3d(std::round(x), std::round(baseLine), 0.0)));
    _group->addChild(text);
}

osg::ref_ptr<osg::Group> OverlayPainter::take()
{
    _shapes->addPrimitiveSet(new osg::DrawArrays(GL_TRIANGLES, 0, static_cast<int>(_corners->size())));
    return _group;
}

} // namespace osgGeoFX
