// SPDX-License-Identifier: MIT
// SPDX-FileCopyrightText: 2026 the osgGeoFX authors
#include <osgGeoFX/geodata/detail/SldStyle.h>

#include <osgGeoFX/geodata/BuildError.h>
#include <osgGeoFX/geodata/detail/KmlFolder.h>
#include <osgGeoFX/geodata/detail/MarkShapes.h>
#include <osgGeoFX/geodata/detail/SldDocument.h>

#include <libxml/tree.h>

#include <algorithm>
#include <cctype>
#include <cstring>
#include <filesystem>
#include <iterator>
#include <memory>
#include <set>
#include <sstream>

namespace osgGeoFX
{

namespace
{

const char* nameOf(const xmlNode* node)
{
    return reinterpret_cast<const char*>(node->name);
}

bool isNamed(const xmlNode* node, const char* name)
{
    return node->type == XML_ELEMENT_NODE && std::strcmp(nameOf(node), name) == 0;
}

xmlNode* childOf(const xmlNode* node, const char* name)
{
    for (xmlNode* child = node ? node->children : nullptr; child; child = child->next)
        if (isNamed(child, name)) return child;
    return nullptr;
}

std::vector<xmlNode*> elementsOf(const xmlNode* node)
{
    std::vector<xmlNode*> result;
    for (xmlNode* child = node->children; child; child = child->next)
        if (child->type == XML_ELEMENT_NODE) result.push_back(child);
    return result;
}

std::string trimmed(const std::string& text)
{
    const std::size_t first = text.find_first_not_of(" \t\r\n");
    if (first == std::string::npos) return {};
    return text.substr(first, text.find_last_not_of(" \t\r\n") - first + 1);
}

std::string textOf(xmlNode* node)
{
    if (!node) return {};
    xmlChar* const text = xmlNodeGetContent(node);
    const std::string result = text ? reinterpret_cast<const char*>(text) : "";
    xmlFree(text);
    return trimmed(result);
}

std::string attributeOf(xmlNode* node, const char* name)
{
    xmlChar* const text = xmlGetProp(node, reinterpret_cast<const xmlChar*>(name));
    std::string result = text ? reinterpret_cast<const char*>(text) : "";
    xmlFree(text);
    return result;
}

class Reader
{
public:
    Reader(const std::string& file, bool allowOutside)
        : _document(readSldDocument(file, "the style")), _allowOutside(allowOutside)
    {
        _style.file = file;
    }

    FeatureStyle read()
    {
        std::vector<xmlNode*> layers;
        collect(xmlDocGetRootElement(_document.get()), "NamedLayer", layers);
        collect(xmlDocGetRootElement(_document.get()), "UserLayer", layers);
        for (xmlNode* const each : layers)
        {
            LayerStyle layer;
            layer.layer = textOf(childOf(each, "Name"));
            std::vector<xmlNode*> passes;
            collect(each, "FeatureTypeStyle", passes);
            for (xmlNode* const pass : passes)
                layer.passes.push_back(rulesOf(pass));
            _style.layers.push_back(std::move(layer));
        }
        if (layers.empty())
        {
            // SE has the rules alone.
            std::vector<xmlNode*> passes;
            collect(xmlDocGetRootElement(_document.get()), "FeatureTypeStyle", passes);
            if (!passes.empty()) _style.layers.emplace_back();
            for (xmlNode* const pass : passes)
                _style.layers[0].passes.push_back(rulesOf(pass));
        }
        if (_symbolizers == 0)
            throw BuildError(
                _style.file +
                ": it has no PolygonSymbolizer, LineSymbolizer or PointSymbolizer; export the style "
                "of a layer with areas, lines or points as SLD.");
        _style.notices.assign(_notices.begin(), _notices.end());
        return std::move(_style);
    }

private:
    static void collect(xmlNode* node, const char* name, std::vector<xmlNode*>& found)
    {
        for (; node; node = node->next)
        {
            if (node->type != XML_ELEMENT_NODE) continue;
            if (isNamed(node, name))
                found.push_back(node);
            else if (!isNamed(node, "Rule"))
                collect(node->children, name, found);
        }
    }

    [[noreturn]] void fail(const xmlNode* node, const std::string& sentence) const
    {
        throw BuildError(_style.file + ":" + std::to_string(xmlGetLineNo(node)) + ": " + sentence);
    }

    void leaveOut(const xmlNode* node)
    {
        _notices.insert(_style.file + ": <" + nameOf(node) + "> is left out, which mappings do not draw.");
    }

    double number(xmlNode* node, double least, double most) const
    {
        const std::optional<double> value = numberOf(textOf(node));
        if (!value || *value < least || *value > most)
            fail(node,
                 "the number is \"" + textOf(node).substr(0, 40) + "\"; write one that has a sense here.");
        return *value;
    }

    std::vector<StyleRule> rulesOf(xmlNode* pass)
    {
        std::vector<StyleRule> rules;
        for (xmlNode* const node : elementsOf(pass))
        {
            if (!isNamed(node, "Rule")) continue;
            StyleRule rule;
            for (xmlNode* const child : elementsOf(node))
            {
                if (isNamed(child, "Filter"))
                    rule.filter = filterOf(child);
                else if (isNamed(child, "ElseFilter"))
                    rule.isElse = true;
                else if (isNamed(child, "MinScaleDenominator"))
                    rule.leastScale = number(child, 0.0, 1e15);
                else if (isNamed(child, "MaxScaleDenominator"))
                    rule.mostScale = number(child, 0.0, 1e15);
                else
                    addSymbolizer(child, rule);
            }
            rules.push_back(std::move(rule));
        }
        return rules;
    }

    void addSymbolizer(xmlNode* node, StyleRule& rule)
    {
        const std::string name = nameOf(node);
        if (name.size() < 10 || name.substr(name.size() - 10) != "Symbolizer") return;
        Symbolizer symbolizer;
        const std::string unit = attributeOf(node, "uom");
        const auto ends = [&](const std::string& word)
        {
            return unit.size() >= word.size() &&
                   unit.compare(unit.size() - word.size(), word.size(), word) == 0;
        };
        if (ends("metre") || ends("meter"))
            symbolizer.metresPerUnit = 1.0;
        else if (ends("foot"))
            symbolizer.metresPerUnit = 0.3048;
        else if (!unit.empty() && !ends("pixel"))
            fail(node, "the unit is \"" + unit.substr(0, 80) + "\"; write metre, foot or pixel.");
        if (name == "PolygonSymbolizer" || name == "LineSymbolizer")
        {
            symbolizer.kind = name == "LineSymbolizer" ? Symbolizer::LINE : Symbolizer::AREA;
            if (xmlNode* const fill = childOf(node, "Fill")) readFill(fill, node, symbolizer);
            if (xmlNode* const stroke = childOf(node, "Stroke")) symbolizer.stroke = strokeOf(stroke);
            if (name == "LineSymbolizer" && !symbolizer.stroke) symbolizer.stroke = StrokeStyle();
            if (xmlNode* const offset = childOf(node, "PerpendicularOffset")) leaveOut(offset);
        }
        else if (name == "PointSymbolizer")
        {
            symbolizer.kind = Symbolizer::POINT;
            if (rule.leastScale > 0.0 || rule.mostScale < 1e15)
                _notices.insert(_style.file + ": symbols of points show at all scales.");
            if (!readGraphic(childOf(node, "Graphic"), symbolizer.graphic)) return;
        }
        else
            return leaveOut(node);
        ++_symbolizers;
        rule.symbolizers.push_back(std::move(symbolizer));
    }

    /// Calls `take(name, node)` for the parameters, CssParameter in 1.0 and SvgParameter in 1.1.
    template<class Take>
    void eachParameter(xmlNode* node, const Take& take)
    {
        for (xmlNode* const child : elementsOf(node))
        {
            if (isNamed(child, "CssParameter") || isNamed(child, "SvgParameter"))
                take(attributeOf(child, "name"), child);
            else if (isNamed(child, "GraphicStroke"))
                leaveOut(child);
        }
    }

    /// Of an area: a color, or a mark that is repeated.
    void readFill(xmlNode* node, xmlNode* area, Symbolizer& symbolizer)
    {
        xmlNode* const graphic = childOf(childOf(node, "GraphicFill"), "Graphic");
        if (!graphic)
        {
            symbolizer.fill = fillOf(node);
            return;
        }
        if (childOf(graphic, "ExternalGraphic"))
            _notices.insert(
                _style.file +
                ": a picture that fills areas is left out, which mappings do not draw; the next mark "
                "is, or nothing. Fill them with a color or a mark.");
        if (!childOf(graphic, "Mark")) return;
        GraphicStyle& style = symbolizer.graphic;
        readGraphic(graphic, style, false);
        if (style.dense > 0.0)
        {
            symbolizer.fill = style.fill;
            symbolizer.fill->opacity = product(style.fill->opacity, style.dense);
            return;
        }
        style.gap = gapOf(area);
        symbolizer.hasPattern = true;
    }

    /// GeoServer's margins around each mark, which QGIS writes, too.
    osg::Vec2d gapOf(xmlNode* area) const
    {
        for (xmlNode* const option : elementsOf(area))
        {
            if (!isNamed(option, "VendorOption") || attributeOf(option, "name") != "graphic-margin") continue;
            std::istringstream words(textOf(option));
            std::vector<double> margins;
            for (std::string word; words >> word;)
            {
                const std::optional<double> margin = numberOf(word);
                if (!margin || *margin < 0.0 || *margin > 1e4)
                    fail(option, "the margins are \"" + textOf(option).substr(0, 40) +
                                     "\"; write one, two or four numbers.");
                margins.push_back(*margin);
            }
            if (margins.size() == 1) return osg::Vec2d(2.0 * margins[0], 2.0 * margins[0]);
            if (margins.size() == 2) return osg::Vec2d(2.0 * margins[1], 2.0 * margins[0]);
            if (margins.size() == 4) return osg::Vec2d(margins[1] + margins[3], margins[0] + margins[2]);
        }
        return {};
    }

    static StyleExpression product(const std::optional<StyleExpression>& value, double factor)
    {
        StyleExpression text, result;
        text.text = std::to_string(factor);
        if (!value) return text;
        result.kind = StyleExpression::MULTIPLY;
        result.line = value->line;
        result.parts = {*value, text};
        return result;
    }

    FillStyle fillOf(xmlNode* node)
    {
        FillStyle fill;
        eachParameter(node,
                      [&](const std::string& name, xmlNode* value)
                      {
                          if (name == "fill") fill.color = expressionOf(value);
                          if (name == "fill-opacity") fill.opacity = expressionOf(value);
                      });
        return fill;
    }

    StrokeStyle strokeOf(xmlNode* node)
    {
        StrokeStyle stroke;
        eachParameter(node,
                      [&](const std::string& name, xmlNode* value)
                      {
                          if (name == "stroke") stroke.color = expressionOf(value);
                          if (name == "stroke-width") stroke.width = expressionOf(value);
                          if (name == "stroke-opacity") stroke.opacity = expressionOf(value);
                          if (name == "stroke-dashoffset") stroke.dashOffset = expressionOf(value);
                          const std::string text = textOf(value);
                          if (name == "stroke-linejoin")
                              stroke.join = text == "round"   ? StrokePaint::ROUND
                                            : text == "bevel" ? StrokePaint::BEVEL
                                                              : StrokePaint::MITRE;
                          if (name == "stroke-linecap")
                              stroke.cap = text == "round"    ? StrokePaint::ROUND_CAP
                                           : text == "square" ? StrokePaint::SQUARE
                                                              : StrokePaint::BUTT;
                          if (name == "stroke-dasharray") stroke.dashes = dashesOf(value, text);
                      });
        return stroke;
    }

    std::vector<double> dashesOf(xmlNode* node, std::string text) const
    {
        std::replace(text.begin(), text.end(), ',', ' ');
        std::istringstream words(text);
        std::vector<double> dashes;
        double sum = 0.0;
        for (std::string word; words >> word;)
        {
            const std::optional<double> length = numberOf(word);
            if (!length || *length < 0.0 || *length > 1e6 || dashes.size() > 32)
                fail(node, "the dashes are \"" + text.substr(0, 40) + "\"; write lengths, such as 4 2.");
            dashes.push_back(*length);
            sum += *length;
        }
        return sum > 0.0 ? dashes : std::vector<double>();
    }

    /// The first mark or picture that can be drawn; false if there is none.
    bool readGraphic(xmlNode* node, GraphicStyle& graphic, bool withPictures = true)
    {
        bool found = false;
        if (!node) return false;
        for (xmlNode* const child : elementsOf(node))
        {
            if (isNamed(child, "ExternalGraphic") && !found)
                found = withPictures && readPicture(child, graphic);
            else if (isNamed(child, "Mark") && !found)
                found = readMark(child, graphic);
            else if (isNamed(child, "Opacity"))
                graphic.opacity = expressionOf(child);
            else if (isNamed(child, "Size"))
                graphic.size = expressionOf(child);
            else if (isNamed(child, "Rotation"))
                graphic.rotation = expressionOf(child);
            else if (isNamed(child, "AnchorPoint"))
                graphic.anchor = {
                    number(childOf(child, "AnchorPointX") ? childOf(child, "AnchorPointX") : child, -100.0,
                           100.0),
                    number(childOf(child, "AnchorPointY") ? childOf(child, "AnchorPointY") : child, -100.0,
                           100.0)};
            else if (isNamed(child, "Displacement") && childOf(child, "DisplacementX") &&
                     childOf(child, "DisplacementY"))
                graphic.offset = {number(childOf(child, "DisplacementX"), -1e4, 1e4),
                                  number(childOf(child, "DisplacementY"), -1e4, 1e4)};
        }
        if (!found) found = readMark(nullptr, graphic);
        return found;
    }

    bool readMark(xmlNode* node, GraphicStyle& graphic)
    {
        xmlNode* const name = childOf(node, "WellKnownName");
        const std::string mark = name ? textOf(name) : "square";
        const std::optional<std::string> known = MarkShapes::named(mark);
        graphic.dense = denseOf(mark);
        if (!known && graphic.dense == 0.0)
            _notices.insert(_style.file + ": the mark \"" + mark.substr(0, 40) + "\" is drawn as a square.");
        graphic.mark = known.value_or("square");
        if (xmlNode* const fill = childOf(node, "Fill")) graphic.fill = fillOf(fill);
        if (xmlNode* const stroke = childOf(node, "Stroke")) graphic.stroke = strokeOf(stroke);
        // The standard's own look of a mark that says nothing.
        if (!graphic.fill && !graphic.stroke)
        {
            graphic.fill = FillStyle();
            graphic.stroke = StrokeStyle();
        }
        // QGIS gives lines a fill alone.
        if (MarkShapes::isLine(graphic.mark) && graphic.fill)
        {
            if (!graphic.stroke)
            {
                graphic.stroke = StrokeStyle();
                graphic.stroke->color = graphic.fill->color;
                graphic.stroke->opacity = graphic.fill->opacity;
            }
            graphic.fill.reset();
        }
        if (graphic.dense > 0.0 && !graphic.fill) graphic.fill = FillStyle();
        return true;
    }

    /// The share that QGIS's brushes of dots cover; 0 for other marks.
    static double denseOf(const std::string& mark)
    {
        static const std::string brush = "brush://dense";
        constexpr double shares[] = {0.94, 0.88, 0.63, 0.5, 0.37, 0.12, 0.06};
        if (mark.size() != brush.size() + 1 || mark.compare(0, brush.size(), brush) != 0) return 0.0;
        const int number = mark.back() - '1';
        return number >= 0 && number < static_cast<int>(std::size(shares)) ? shares[number] : 0.0;
    }

    bool readPicture(xmlNode* node, GraphicStyle& graphic)
    {
        xmlNode* const resource = childOf(node, "OnlineResource");
        const std::string href = resource ? attributeOf(resource, "href") : "";
        if (href.empty()) return false;
        // QGIS writes pictures that are in its styles, and colors behind the names of others.
        if (href.rfind("base64:", 0) == 0 || href.rfind("data:", 0) == 0)
        {
            _notices.insert(
                _style.file +
                ": a picture within the style is not drawn; the next mark is, or a square. Save it as "
                "PNG beside the style.");
            return false;
        }
        std::string extension = std::filesystem::path(href.substr(0, href.find('?'))).extension().string();
        std::transform(extension.begin(), extension.end(), extension.begin(),
                       [](unsigned char c) { return static_cast<char>(std::tolower(c)); });
        if (extension == ".svg")
        {
            _notices.insert(_style.file + ": the picture \"" + href.substr(0, 80) +
                            "\" is SVG, which is not drawn; the next mark is, or a square. Save it as PNG.");
            return false;
        }
        const KmlFolder folder(_style.file, _allowOutside);
        const std::optional<std::string> path = folder.resolve(_style.file, href);
        if (!path || path->empty())
            fail(resource, "the picture \"" + href.substr(0, 80) +
                               "\" leads out of the style's folder; put it beside the style or below; or, if "
                               "you trust the file, start the program with --allow-outside.");
        graphic.picture = *path;
        return true;
    }

    StyleExpression expressionOf(xmlNode* node) const
    {
        StyleExpression result;
        result.line = static_cast<int>(xmlGetLineNo(node));
        result.kind = StyleExpression::JOINED;
        for (xmlNode* child = node->children; child; child = child->next)
        {
            if (child->type == XML_ELEMENT_NODE)
                result.parts.push_back(operandOf(child));
            else if (child->type == XML_TEXT_NODE || child->type == XML_CDATA_SECTION_NODE)
            {
                const std::string text = textOf(child);
                if (!text.empty()) result.parts.push_back({StyleExpression::TEXT, text, result.line, {}});
            }
        }
        return result;
    }

    StyleExpression operandOf(xmlNode* node) const
    {
        StyleExpression result;
        result.line = static_cast<int>(xmlGetLineNo(node));
        result.text = textOf(node);
        if (isNamed(node, "Literal")) return result;
        if (isNamed(node, "PropertyName") || isNamed(node, "ValueReference"))
        {
            result.kind = StyleExpression::FIELD;
            return result;
        }
        static const std::pair<const char*, StyleExpression::Kind> operators[] = {
            {"Add", StyleExpression::ADD},
            {"Sub", StyleExpression::SUBTRACT},
            {"Mul", StyleExpression::MULTIPLY},
            {"Div", StyleExpression::DIVIDE}};
        for (const auto& [name, kind] : operators)
        {
            if (!isNamed(node, name)) continue;
            result.kind = kind;
            for (xmlNode* const part : elementsOf(node))
                result.parts.push_back(operandOf(part));
            if (result.parts.size() != 2) fail(node, "it has two operands; write two.");
            return result;
        }
        fail(node, std::string("<") + nameOf(node) +
                       "> cannot be computed here; write Literal, PropertyName, Add, Sub, Mul or Div.");
    }

    StyleFilter filterOf(xmlNode* node) const
    {
        StyleFilter all;
        all.kind = StyleFilter::AND;
        for (xmlNode* const child : elementsOf(node))
            all.filters.push_back(conditionOf(child));
        if (all.filters.empty()) fail(node, "the filter is empty; give it a comparison.");
        return all;
    }

    StyleFilter conditionOf(xmlNode* node) const
    {
        static const std::pair<const char*, StyleFilter::Kind> kinds[] = {
            {"And", StyleFilter::AND},
            {"Or", StyleFilter::OR},
            {"Not", StyleFilter::NOT},
            {"PropertyIsEqualTo", StyleFilter::EQUAL},
            {"PropertyIsNotEqualTo", StyleFilter::NOT_EQUAL},
            {"PropertyIsLessThan", StyleFilter::LESS},
            {"PropertyIsLessThanOrEqualTo", StyleFilter::LESS_EQUAL},
            {"PropertyIsGreaterThan", StyleFilter::GREATER},
            {"PropertyIsGreaterThanOrEqualTo", StyleFilter::GREATER_EQUAL},
            {"PropertyIsBetween", StyleFilter::BETWEEN},
            {"PropertyIsNull", StyleFilter::IS_NULL},
            {"PropertyIsLike", StyleFilter::LIKE}};
        const auto* const found = std::find_if(std::begin(kinds), std::end(kinds),
                                               [&](const auto& each) { return isNamed(node, each.first); });
        if (found == std::end(kinds))
            fail(node, std::string("<") + nameOf(node) +
                           "> is no comparison that is known here; write PropertyIsEqualTo and the like, "
                           "And, Or or Not.");
        StyleFilter filter;
        filter.kind = found->second;
        const bool joins = filter.kind <= StyleFilter::NOT;
        for (xmlNode* const child : elementsOf(node))
        {
            if (joins)
                filter.filters.push_back(conditionOf(child));
            else if (isNamed(child, "LowerBoundary") || isNamed(child, "UpperBoundary"))
                filter.operands.push_back(expressionOf(child));
            else
                filter.operands.push_back(operandOf(child));
        }
        const std::size_t wanted = filter.kind == StyleFilter::BETWEEN   ? 3
                                   : filter.kind == StyleFilter::IS_NULL ? 1
                                                                         : 2;
        const std::size_t parts = filter.filters.size();
        if (joins ? parts == 0 || (filter.kind == StyleFilter::NOT && parts > 1)
                  : filter.operands.size() != wanted)
            fail(node, std::string("<") + nameOf(node) + "> has another number of operands; correct it.");
        filter.matchCase = attributeOf(node, "matchCase") != "false";
        if (filter.kind == StyleFilter::LIKE) readPattern(node, filter);
        return filter;
    }

    static void readPattern(xmlNode* node, StyleFilter& filter)
    {
        const auto take = [&](const char* name, char& c)
        {
            const std::string text = attributeOf(node, name);
            if (text.size() == 1) c = text[0];
        };
        take("wildCard", filter.any);
        take("singleChar", filter.one);
        take("escape", filter.escape);
        take("escapeChar", filter.escape);
    }

    const SldDocument _document;
    const bool _allowOutside;
    FeatureStyle _style;
    std::set<std::string> _notices;
    int _symbolizers = 0;
};

} // namespace

FeatureStyle readSldStyle(const std::string& file, bool allowOutside)
{
    return Reader(file, allowOutside).read();
}

} // namespace osgGeoFX
