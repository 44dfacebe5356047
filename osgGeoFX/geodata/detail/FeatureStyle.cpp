// SPDX-License-Identifier: MIT
// SPDX-FileCopyrightText: 2026 the osgGeoFX authors
#include <osgGeoFX/geodata/detail/FeatureStyle.h>

#include <osgGeoFX/geodata/BuildError.h>

#include <cpl_string.h>

#include <algorithm>
#include <array>
#include <cctype>
#include <charconv>
#include <cmath>
#include <cstring>
#include <functional>

namespace osgGeoFX
{

namespace
{

std::string textOf(const osg::Vec4& color)
{
    std::string text;
    for (int i = 0; i < 4; ++i)
        text += std::to_string(color[i]) + ",";
    return text;
}

std::string textOf(const std::optional<StrokePaint>& stroke)
{
    if (!stroke) return "-";
    std::string text = textOf(stroke->color) + std::to_string(stroke->width) + "," +
                       std::to_string(stroke->join) + std::to_string(stroke->cap);
    for (const double dash : stroke->dashes)
        text += "," + std::to_string(dash);
    return text + ";" + std::to_string(stroke->dashOffset);
}

std::optional<std::string> fieldOf(const OGRFeature& feature, const std::string& name)
{
    const int index = feature.GetDefnRef()->GetFieldIndex(name.c_str());
    if (index < 0 || !feature.IsFieldSetAndNotNull(index)) return std::nullopt;
    return const_cast<OGRFeature&>(feature).GetFieldAsString(index);
}

std::string lowered(std::string text)
{
    std::transform(text.begin(), text.end(), text.begin(),
                   [](unsigned char c) { return static_cast<char>(std::tolower(c)); });
    return text;
}

/// -1, 0 or 1.
int compare(std::string a, std::string b, bool matchCase)
{
    const std::optional<double> x = numberOf(a), y = numberOf(b);
    if (x && y) return *x < *y ? -1 : *x > *y ? 1 : 0;
    if (!matchCase)
    {
        a = lowered(a);
        b = lowered(b);
    }
    const int order = a.compare(b);
    return order < 0 ? -1 : order > 0 ? 1 : 0;
}

/// A pattern of any number of `any` takes time by the product of both lengths at most.
bool isLike(const std::string& text, const std::string& pattern, const StyleFilter& how)
{
    struct Token
    {
        char c;
        bool any, one;
    };
    std::vector<Token> tokens;
    for (std::size_t i = 0; i < pattern.size(); ++i)
    {
        if (pattern[i] == how.escape && i + 1 < pattern.size())
            tokens.push_back({pattern[++i], false, false});
        else
            tokens.push_back({pattern[i], pattern[i] == how.any, pattern[i] == how.one});
    }
    std::vector<bool> reached(text.size() + 1, false);
    reached[0] = true;
    for (const Token& token : tokens)
    {
        std::vector<bool> next(text.size() + 1, false);
        bool before = false;
        for (std::size_t i = 0; i <= text.size(); ++i)
        {
            if (token.any)
            {
                before = before || reached[i];
                next[i] = before;
            }
            else if (i > 0)
                next[i] = reached[i - 1] && (token.one || text[i - 1] == token.c);
        }
        reached = std::move(next);
    }
    return reached[text.size()];
}

using Fields = std::function<void(const StyleExpression&)>;

void eachField(const StyleExpression& expression, const Fields& take)
{
    if (expression.kind == StyleExpression::FIELD) take(expression);
    for (const StyleExpression& part : expression.parts)
        eachField(part, take);
}

void eachField(const std::optional<StyleExpression>& expression, const Fields& take)
{
    if (expression) eachField(*expression, take);
}

void eachField(const StyleFilter& filter, const Fields& take)
{
    for (const StyleExpression& operand : filter.operands)
        eachField(operand, take);
    for (const StyleFilter& part : filter.filters)
        eachField(part, take);
}

void eachField(const std::optional<FillStyle>& fill, const Fields& take)
{
    if (!fill) return;
    eachField(fill->color, take);
    eachField(fill->opacity, take);
}

void eachField(const std::optional<StrokeStyle>& stroke, const Fields& take)
{
    if (!stroke) return;
    for (const auto& each : {stroke->color, stroke->width, stroke->opacity, stroke->dashOffset})
        eachField(each, take);
}

void eachField(const StyleRule& rule, const Fields& take)
{
    if (rule.filter) eachField(*rule.filter, take);
    for (const Symbolizer& each : rule.symbolizers)
    {
        eachField(each.fill, take);
        eachField(each.stroke, take);
        eachField(each.graphic.fill, take);
        eachField(each.graphic.stroke, take);
        for (const auto& expression : {each.graphic.size, each.graphic.rotation, each.graphic.opacity})
            eachField(expression, take);
    }
}

/// Values of a symbolizer for a feature.
class Values
{
public:
    Values(const std::string& file, const OGRFeature& feature) : _file(file), _feature(feature) {}

    double number(const std::optional<StyleExpression>& expression, double usual, double least, double most,
                  const char* what) const
    {
        if (!expression) return usual;
        const std::optional<std::string> text = expression->value(_feature);
        if (!text) return usual;
        const std::optional<double> value = numberOf(*text);
        if (!value || *value < least || *value > most)
            fail(*expression, std::string(what) + " is \"" + text->substr(0, 40) +
                                  "\"; write a number from " + shortly(least) + " to " + shortly(most) + ".");
        return *value;
    }

    osg::Vec4 color(const std::optional<StyleExpression>& expression,
                    const std::optional<StyleExpression>& opacity, const char* usual) const
    {
        std::string text = usual;
        if (expression) text = expression->value(_feature).value_or(usual);
        std::optional<osg::Vec4> color = colorOfHex(text);
        if (!color) fail(*expression, "the color is \"" + text.substr(0, 40) + "\"; write #rrggbb.");
        color->a() = static_cast<float>(number(opacity, 1.0, 0.0, 1.0, "the opacity"));
        return *color;
    }

    std::optional<osg::Vec4> fill(const std::optional<FillStyle>& style) const
    {
        if (!style) return std::nullopt;
        return color(style->color, style->opacity, "#808080");
    }

    std::optional<StrokePaint> stroke(const std::optional<StrokeStyle>& style, double unit) const
    {
        if (!style) return std::nullopt;
        StrokePaint paint;
        paint.color = color(style->color, style->opacity, "#000000");
        paint.width = number(style->width, 1.0, 0.0, 1e6, "the stroke's width") * unit;
        paint.join = style->join;
        paint.cap = style->cap;
        for (const double dash : style->dashes)
            paint.dashes.push_back(dash * unit);
        paint.dashOffset = number(style->dashOffset, 0.0, -1e6, 1e6, "the dashes' offset") * unit;
        return paint;
    }

private:
    static std::string shortly(double value) { return CPLSPrintf("%g", value); }
    [[noreturn]] void fail(const StyleExpression& at, const std::string& sentence) const
    {
        throw BuildError(_file + ":" + std::to_string(at.line) + ": " + sentence);
    }

    const std::string& _file;
    const OGRFeature& _feature;
};

} // namespace

std::optional<osg::Vec4> colorOfHex(const std::string& text)
{
    const bool isHex =
        (text.size() == 7 || text.size() == 4) && text[0] == '#' &&
        std::all_of(text.begin() + 1, text.end(), [](unsigned char c) { return std::isxdigit(c) != 0; });
    if (!isHex) return std::nullopt;
    osg::Vec4 color(0.0f, 0.0f, 0.0f, 1.0f);
    const std::size_t digits = text.size() == 7 ? 2 : 1;
    for (std::size_t i = 0; i < 3; ++i)
    {
        const int value = std::stoi(text.substr(1 + digits * i, digits), nullptr, 16);
        color[static_cast<int>(i)] = static_cast<float>(digits == 2 ? value : 17 * value) / 255.0f;
    }
    return color;
}

std::optional<double> numberOf(const std::string& text)
{
    const char* begin = text.data();
    const char* end = text.data() + text.size();
    while (begin != end && std::isspace(static_cast<unsigned char>(*begin)))
        ++begin;
    while (begin != end && std::isspace(static_cast<unsigned char>(end[-1])))
        --end;
    if (begin != end && *begin == '+') ++begin;
    double value = 0.0;
    const auto [stop, failure] = std::from_chars(begin, end, value);
    if (failure != std::errc() || stop != end || !std::isfinite(value)) return std::nullopt;
    return value;
}

std::string ShapePaint::key() const
{
    return (fill ? textOf(*fill) : "-") + textOf(stroke) + (pattern ? pattern->key() : "-") +
           (metres ? "m" : "p") + std::to_string(leastScale) + "," + std::to_string(mostScale);
}

std::string SymbolPaint::key() const
{
    return picture + "|" + mark + "|" + (fill ? textOf(*fill) : "-") + textOf(stroke) + "|" +
           std::to_string(size) + "," + std::to_string(rotation) + "," + std::to_string(opacity) + "," +
           std::to_string(anchor.x()) + "," + std::to_string(anchor.y()) + "," + std::to_string(offset.x()) +
           "," + std::to_string(offset.y()) + "," + std::to_string(gap.x()) + "," + std::to_string(gap.y()) +
           (metres ? "m" : "p");
}

std::optional<std::string> StyleExpression::value(const OGRFeature& feature) const
{
    if (kind == TEXT) return text;
    if (kind == FIELD) return fieldOf(feature, text);
    std::string joined;
    std::array<double, 2> numbers{};
    for (std::size_t i = 0; i < parts.size(); ++i)
    {
        const std::optional<std::string> part = parts[i].value(feature);
        if (kind == JOINED)
        {
            // A field that is null is null as a whole, and between other texts it is none.
            if (!part && parts.size() == 1) return std::nullopt;
            joined += part.value_or("");
            continue;
        }
        const std::optional<double> number = part ? numberOf(*part) : std::nullopt;
        if (!number || i >= numbers.size()) return std::nullopt;
        numbers[i] = *number;
    }
    if (kind == JOINED) return joined;
    const double a = numbers[0], b = numbers[1];
    const double result = kind == ADD ? a + b : kind == SUBTRACT ? a - b : kind == MULTIPLY ? a * b : a / b;
    if (!std::isfinite(result)) return std::nullopt;
    return std::string(CPLSPrintf("%.17g", result));
}

bool StyleFilter::matches(const OGRFeature& feature) const
{
    const auto holds = [&](const StyleFilter& filter)
    {
        return filter.matches(feature);
    };
    if (kind == AND) return std::all_of(filters.begin(), filters.end(), holds);
    if (kind == OR) return std::any_of(filters.begin(), filters.end(), holds);
    if (kind == NOT) return !filters[0].matches(feature);
    const std::optional<std::string> a = operands[0].value(feature);
    if (kind == IS_NULL) return !a;
    const std::optional<std::string> b = operands[1].value(feature);
    if (!a || !b) return false;
    if (kind == LIKE) return matchCase ? isLike(*a, *b, *this) : isLike(lowered(*a), lowered(*b), *this);
    const int order = compare(*a, *b, matchCase);
    switch (kind)
    {
    case EQUAL:
        return order == 0;
    case NOT_EQUAL:
        return order != 0;
    case LESS:
        return order < 0;
    case LESS_EQUAL:
        return order <= 0;
    case GREATER:
        return order > 0;
    case GREATER_EQUAL:
        return order >= 0;
    default:
        break;
    }
    const std::optional<std::string> c = operands[2].value(feature); // BETWEEN
    return c && order >= 0 && compare(*a, *c, matchCase) <= 0;
}

const LayerStyle* FeatureStyle::of(const std::string& layer) const
{
    for (const LayerStyle& each : layers)
        if (EQUAL(each.layer.c_str(), layer.c_str())) return &each;
    // QGIS and GeoServer name the layer as their user did, so a single one is for any.
    return layers.size() == 1 ? &layers[0] : nullptr;
}

void FeatureStyle::checkFields(const LayerStyle& style, const OGRFeatureDefn& features,
                               const std::string& vectors) const
{
    const auto check = [&](const StyleExpression& field)
    {
        if (features.GetFieldIndex(field.text.c_str()) >= 0) return;
        std::string names;
        for (int i = 0; i < features.GetFieldCount() && i < 12; ++i)
            names += (i > 0 ? ", " : "") + std::string(features.GetFieldDefn(i)->GetNameRef());
        throw BuildError(file + ":" + std::to_string(field.line) + ": the style names the field \"" +
                         field.text + "\", which the layer " + features.GetName() + " of " + vectors +
                         " does not have; it has " + (names.empty() ? "none" : names) +
                         ". Name one of these, or another layer.");
    };
    for (const std::vector<StyleRule>& rules : style.passes)
        for (const StyleRule& rule : rules)
            eachField(rule, check);
}

std::vector<const StyleRule*> FeatureStyle::rulesFor(const std::vector<StyleRule>& rules,
                                                     const OGRFeature& feature)
{
    std::vector<const StyleRule*> result;
    for (const StyleRule& rule : rules)
        if (!rule.isElse && (!rule.filter || rule.filter->matches(feature))) result.push_back(&rule);
    if (!result.empty()) return result;
    for (const StyleRule& rule : rules)
        if (rule.isElse) result.push_back(&rule);
    return result;
}

ShapePaint FeatureStyle::shapeOf(const Symbolizer& symbolizer, const StyleRule& rule,
                                 const OGRFeature& feature) const
{
    const Values values(file, feature);
    const double unit = symbolizer.metresPerUnit > 0.0 ? symbolizer.metresPerUnit : 1.0;
    ShapePaint paint;
    paint.metres = symbolizer.metresPerUnit > 0.0;
    paint.fill = values.fill(symbolizer.fill);
    if (symbolizer.hasPattern) paint.pattern = symbolOf(symbolizer, feature);
    paint.stroke = values.stroke(symbolizer.stroke, unit);
    if (paint.stroke && paint.stroke->width == 0.0) paint.stroke.reset();
    paint.leastScale = rule.leastScale;
    paint.mostScale = rule.mostScale;
    return paint;
}

SymbolPaint FeatureStyle::symbolOf(const Symbolizer& symbolizer, const OGRFeature& feature) const
{
    const Values values(file, feature);
    const double unit = symbolizer.metresPerUnit > 0.0 ? symbolizer.metresPerUnit : 1.0;
    const GraphicStyle& graphic = symbolizer.graphic;
    SymbolPaint paint;
    paint.metres = symbolizer.metresPerUnit > 0.0;
    paint.picture = graphic.picture;
    paint.mark = graphic.mark;
    paint.fill = values.fill(graphic.fill);
    paint.stroke = values.stroke(graphic.stroke, unit);
    const double usual = graphic.picture.empty() ? 6.0 : 0.0;
    paint.size = values.number(graphic.size, usual, 0.0, 1e6, "the symbol's size") * unit;
    // Images are made for each rotation, so there must not be too many of them.
    paint.rotation = 3.0 * std::round(values.number(graphic.rotation, 0.0, -1e4, 1e4, "the rotation") / 3.0);
    paint.rotation = std::fmod(std::fmod(paint.rotation, 360.0) + 360.0, 360.0);
    paint.opacity = values.number(graphic.opacity, 1.0, 0.0, 1.0, "the opacity");
    paint.anchor = graphic.anchor;
    paint.offset = graphic.offset * unit;
    paint.gap = graphic.gap * unit;
    return paint;
}

} // namespace osgGeoFX
