// SPDX-License-Identifier: MIT
// SPDX-FileCopyrightText: 2026 the osgGeoFX authors
#include <osgGeoFX/geodata/detail/OgrStyle.h>

#include <osg/Vec4d>

#include <cpl_string.h>
#include <ogr_featurestyle.h>

#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <cstring>
#include <memory>

namespace osgGeoFX
{

namespace
{

/// Of a screen, as the standard of SLD has it: 0.28 mm.
constexpr double pixelsPerMillimetre = 1.0 / 0.28;

std::optional<osg::Vec4> colorOf(OGRStyleTool& tool, const char* text)
{
    int red = 0, green = 0, blue = 0, alpha = 255;
    if (!text || !tool.GetRGBFromString(text, red, green, blue, alpha)) return std::nullopt;
    return osg::Vec4(osg::Vec4d(red, green, blue, alpha) / 255.0);
}

/// What lengths of a tool are; others than pixels and metres are told in millimetres of paper.
struct Unit
{
    explicit Unit(OGRStyleTool& tool) : metres(tool.GetUnit() == OGRSTUGround)
    {
        if (metres || tool.GetUnit() == OGRSTUPixel) return;
        tool.SetUnit(OGRSTUMM);
        pixels = pixelsPerMillimetre;
    }
    const bool metres;
    double pixels = 1.0; ///< of one
};

void addPen(OGRStylePen& pen, OgrStyle& style)
{
    GBool isNone = FALSE;
    const Unit unit(pen);
    StrokePaint stroke;
    const std::optional<osg::Vec4> color = colorOf(pen, pen.Color(isNone));
    if (color && !isNone) stroke.color = *color;
    const double width = pen.Width(isNone);
    stroke.width = isNone ? 1.0 : width * unit.pixels;
    if (!(stroke.width > 0.0 && stroke.width < 1e6)) stroke.width = 1.0;
    const char* const cap = pen.Cap(isNone);
    if (!isNone && cap)
        stroke.cap = EQUAL(cap, "r")   ? StrokePaint::ROUND_CAP
                     : EQUAL(cap, "p") ? StrokePaint::SQUARE
                                       : StrokePaint::BUTT;
    const char* const join = pen.Join(isNone);
    if (!isNone && join)
        stroke.join = EQUAL(join, "r")   ? StrokePaint::ROUND
                      : EQUAL(join, "b") ? StrokePaint::BEVEL
                                         : StrokePaint::MITRE;
    ShapePaint paint;
    paint.stroke = stroke;
    paint.metres = unit.metres;
    style.shapes.push_back(paint);
}

void addBrush(OGRStyleBrush& brush, OgrStyle& style)
{
    GBool isNone = FALSE;
    const char* const text = brush.ForeColor(isNone);
    const std::optional<osg::Vec4> color = isNone ? std::nullopt : colorOf(brush, text);
    if (!color) return;
    ShapePaint paint;
    paint.fill = color;
    style.shapes.push_back(paint);
}

void addSymbol(OGRStyleSymbol& symbol, OgrStyle& style)
{
    GBool isNone = FALSE;
    const Unit unit(symbol);
    SymbolPaint paint;
    paint.metres = unit.metres;
    // OGR's own symbols, of which every second one is filled.
    static const char* const marks[] = {"cross",  "x",        "circle",   "circle", "square",
                                        "square", "triangle", "triangle", "star",   "star"};
    const char* const id = symbol.Id(isNone);
    const char* const number = isNone || !id ? nullptr : std::strstr(id, "ogr-sym-");
    const int index = number ? std::atoi(number + 8) : 3;
    paint.mark = index >= 0 && index < 10 ? marks[index] : "circle";
    const std::optional<osg::Vec4> color = colorOf(symbol, symbol.Color(isNone));
    const osg::Vec4 plain = color.value_or(osg::Vec4(0.0f, 0.0f, 0.0f, 1.0f));
    const bool isFilled = index >= 2 && index % 2 == 1;
    if (isFilled || index < 2 || index > 9)
        paint.fill = plain;
    else
        paint.stroke = StrokePaint{plain, 1.5, StrokePaint::MITRE, StrokePaint::BUTT, {}, 0.0};
    const double size = symbol.Size(isNone);
    paint.size = isNone ? 0.0 : size * unit.pixels;
    if (!(paint.size > 0.0 && paint.size < 1e6))
    {
        paint.size = 10.0;
        paint.metres = false;
    }
    if (paint.stroke && paint.metres) paint.stroke->width = paint.size / 8.0;
    const double angle = symbol.Angle(isNone);
    // Counter-clockwise.
    if (!isNone && std::isfinite(angle))
        paint.rotation = std::fmod(std::fmod(-3.0 * std::round(angle / 3.0), 360.0) + 360.0, 360.0);
    style.symbols.push_back(paint);
}

} // namespace

OgrStyle OgrStyle::of(OGRFeature& feature, OGRStyleTable* table)
{
    OgrStyle style;
    OGRStyleMgr manager(table);
    if (!manager.InitFromFeature(&feature)) return style;
    // Areas lie below their borders, whichever is told first.
    for (int i = 0; i < manager.GetPartCount(); ++i)
    {
        const std::unique_ptr<OGRStyleTool> tool(manager.GetPart(i));
        if (tool && tool->GetType() == OGRSTCBrush) addBrush(static_cast<OGRStyleBrush&>(*tool), style);
    }
    for (int i = 0; i < manager.GetPartCount(); ++i)
    {
        const std::unique_ptr<OGRStyleTool> tool(manager.GetPart(i));
        if (!tool) continue;
        if (tool->GetType() == OGRSTCPen) addPen(static_cast<OGRStylePen&>(*tool), style);
        if (tool->GetType() == OGRSTCSymbol) addSymbol(static_cast<OGRStyleSymbol&>(*tool), style);
    }
    return style;
}

} // namespace osgGeoFX
