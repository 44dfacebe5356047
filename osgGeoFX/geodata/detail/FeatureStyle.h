// SPDX-License-Identifier: MIT
// SPDX-FileCopyrightText: 2026 the osgGeoFX authors
#pragma once

// Private to osgGeoFXData: consumers of the library do not need GDAL's headers.

#include <ogr_feature.h>
#include <osg/Vec2d>
#include <osg/Vec4>

#include <limits>
#include <optional>
#include <string>
#include <vector>

namespace osgGeoFX
{

/// How a line is drawn, for one feature. Lengths are pixels, or metres on the ground.
struct StrokePaint
{
    enum Join
    {
        MITRE,
        ROUND,
        BEVEL
    };
    enum Cap
    {
        BUTT,
        ROUND_CAP,
        SQUARE
    };
    osg::Vec4 color = {0.0f, 0.0f, 0.0f, 1.0f};
    double width = 1.0;
    Join join = MITRE;
    Cap cap = BUTT;
    std::vector<double> dashes;
    double dashOffset = 0.0;
};

/// How a point is drawn.
struct SymbolPaint
{
    std::string picture;         ///< a file, as GDAL opens it; empty: a mark
    std::string mark = "square"; ///< of MarkShapes
    std::optional<osg::Vec4> fill;
    std::optional<StrokePaint> stroke;
    double size = 0.0;     ///< its height; 0: the picture's own
    double rotation = 0.0; ///< clockwise, degrees
    double opacity = 1.0;
    osg::Vec2d anchor = {0.5, 0.5}; ///< what of the symbol lies at the place, 0…1 from its lower left corner
    osg::Vec2d offset;              ///< to the right and up
    osg::Vec2d gap;                 ///< between the marks of a pattern
    bool metres = false;

    std::string key() const;
};

/// How an area or a line is drawn.
struct ShapePaint
{
    std::optional<osg::Vec4> fill;
    std::optional<SymbolPaint> pattern; ///< of an area: marks side by side, as lines where they are such
    std::optional<StrokePaint> stroke;
    bool metres = false; ///< lengths are metres
    /// Of scales 1:N, in which it shows; from `leastScale`, below `mostScale`.
    double leastScale = 0.0, mostScale = std::numeric_limits<double>::infinity();

    bool fills() const { return fill || pattern; }
    void keepStroke()
    {
        fill.reset();
        pattern.reset();
    }
    /// The same text for what looks the same.
    std::string key() const;
};

/// A text that a style computes for each feature.
struct StyleExpression
{
    enum Kind
    {
        TEXT,
        FIELD,
        ADD,
        SUBTRACT,
        MULTIPLY,
        DIVIDE,
        JOINED ///< the parts' texts one after the other
    };
    Kind kind = TEXT;
    std::string text; ///< or the field's name
    int line = 0;
    std::vector<StyleExpression> parts;

    /// Nothing where a field is null, or where what is computed with is no number.
    std::optional<std::string> value(const OGRFeature& feature) const;
};

/// What a rule asks of a feature.
struct StyleFilter
{
    enum Kind
    {
        AND,
        OR,
        NOT,
        EQUAL,
        NOT_EQUAL,
        LESS,
        LESS_EQUAL,
        GREATER,
        GREATER_EQUAL,
        BETWEEN,
        IS_NULL,
        LIKE
    };
    Kind kind = AND;
    std::vector<StyleFilter> filters;
    std::vector<StyleExpression> operands;
    bool matchCase = true;
    char any = '*', one = '?', escape = '\\'; ///< of LIKE

    /// Comparisons are of numbers where both are such, else of texts; with null, none holds.
    bool matches(const OGRFeature& feature) const;
};

/// What a symbolizer says of a line, before a feature is known.
struct StrokeStyle
{
    std::optional<StyleExpression> color, width, opacity, dashOffset;
    StrokePaint::Join join = StrokePaint::MITRE;
    StrokePaint::Cap cap = StrokePaint::BUTT;
    std::vector<double> dashes;
};

struct FillStyle
{
    std::optional<StyleExpression> color, opacity;
};

struct GraphicStyle
{
    std::string picture, mark = "square";
    std::optional<FillStyle> fill;
    std::optional<StrokeStyle> stroke;
    std::optional<StyleExpression> size, rotation, opacity;
    osg::Vec2d anchor = {0.5, 0.5}, offset, gap;
    double dense = 0.0; ///< of QGIS's brushes of dots: the share that they cover; else 0
};

struct Symbolizer
{
    enum Kind
    {
        AREA,
        LINE,
        POINT
    };
    Kind kind = AREA;
    std::optional<FillStyle> fill;
    std::optional<StrokeStyle> stroke;
    GraphicStyle graphic;
    bool hasPattern = false;    ///< of an area, which the graphic fills
    double metresPerUnit = 0.0; ///< of lengths; 0: they are pixels
};

struct StyleRule
{
    std::optional<StyleFilter> filter;
    bool isElse = false;
    double leastScale = 0.0, mostScale = std::numeric_limits<double>::infinity();
    std::vector<Symbolizer> symbolizers;
};

/// All features are drawn by the first list of rules, then by the next one over it.
struct LayerStyle
{
    std::string layer; ///< its name; may be empty
    std::vector<std::vector<StyleRule>> passes;
};

/// A style file.
struct FeatureStyle
{
    std::string file;
    std::vector<LayerStyle> layers;
    std::vector<std::string> notices; ///< on what is left out

    /// That of a layer: the one of its name, or the only one. Null if there is none.
    const LayerStyle* of(const std::string& layer) const;
    /// Throws BuildError where the style names a field that the features do not have.
    void checkFields(const LayerStyle& style, const OGRFeatureDefn& features, const std::string& file) const;
    /// The rules of a pass that hold for a feature.
    static std::vector<const StyleRule*> rulesFor(const std::vector<StyleRule>& rules,
                                                  const OGRFeature& feature);

    /// What a symbolizer is for a feature; throws BuildError where a value is none.
    ShapePaint shapeOf(const Symbolizer& symbolizer, const StyleRule& rule, const OGRFeature& feature) const;
    SymbolPaint symbolOf(const Symbolizer& symbolizer, const OGRFeature& feature) const;
};

/// #rgb or #rrggbb; nothing for other texts.
std::optional<osg::Vec4> colorOfHex(const std::string& text);

/// A finite number that is all of a text, whatever the language of the program.
std::optional<double> numberOf(const std::string& text);

} // namespace osgGeoFX
