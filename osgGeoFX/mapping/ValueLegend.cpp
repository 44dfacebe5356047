// SPDX-License-Identifier: MIT
// SPDX-FileCopyrightText: 2026 the osgGeoFX authors
#include <osgGeoFX/mapping/ValueLegend.h>

#include <osg/Geometry>
#include <osg/MatrixTransform>
#include <osg/Notify>
#include <osg/Texture2D>
#include <osg/ValueObject>
#include <osgText/Text>

#include <algorithm>
#include <cmath>
#include <cstdio>

namespace osgGeoFX
{

namespace
{

struct Box
{
    double left, bottom, width, height;
};

/// Builds a legend from its lowest line upwards.
class LegendBuilder
{
public:
    explicit LegendBuilder(const LegendStyle& style) : _style(style), _legend(new osg::Group)
    {
        osg::StateSet* state = _legend->getOrCreateStateSet();
        state->setMode(GL_LIGHTING, osg::StateAttribute::OFF);
        state->setMode(GL_DEPTH_TEST, osg::StateAttribute::OFF);
        state->setMode(GL_BLEND, osg::StateAttribute::ON);
        state->setRenderBinDetails(0, "TraversalOrderBin");
    }

    double textHeight() const { return _style.textSize * 1.35; }
    double margin() const { return _style.textSize * 0.8; }

    void background(double height)
    {
        _legend->addChild(quad({0.0, 0.0, _style.width, height}, _style.background));
        _legend->setUserValue("width", _style.width);
        _legend->setUserValue("height", height);
    }

    void colored(const Box& box, const osg::Vec4& color) { _legend->addChild(quad(box, color)); }

    /// A picture over a checkered ground, with a thin frame.
    void picture(const Box& box, osg::Image* image)
    {
        colored({box.left - 1.0, box.bottom - 1.0, box.width + 2.0, box.height + 2.0}, frame());
        colored(box, {1.0f, 1.0f, 1.0f, 1.0f});
        const double side = box.height / 2.0;
        for (int i = 0; i * side < box.width; ++i)
        {
            const double left = box.left + i * side;
            colored(
                {left, box.bottom + (i % 2 ? side : 0.0), std::min(side, box.left + box.width - left), side},
                {0.8f, 0.8f, 0.8f, 1.0f});
        }
        osg::ref_ptr<osg::Geometry> geometry = quad(box, {1.0f, 1.0f, 1.0f, 1.0f});
        osg::ref_ptr<osg::Texture2D> texture = new osg::Texture2D(image);
        texture->setResizeNonPowerOfTwoHint(false);
        texture->setFilter(osg::Texture::MIN_FILTER, osg::Texture::LINEAR);
        texture->setFilter(osg::Texture::MAG_FILTER, osg::Texture::LINEAR);
        texture->setWrap(osg::Texture::WRAP_S, osg::Texture::CLAMP_TO_EDGE);
        texture->setWrap(osg::Texture::WRAP_T, osg::Texture::CLAMP_TO_EDGE);
        geometry->getOrCreateStateSet()->setTextureAttributeAndModes(0, texture);
        _legend->addChild(geometry);
    }

    /// `x` is where the text's left end is, its middle or its right end; `y` its base line.
    void text(const std::string& words, double x, double y, osgText::Text::AlignmentType alignment)
    {
        osg::ref_ptr<osgText::Text> text = new osgText::Text;
        if (_style.font) text->setFont(_style.font);
        text->setCharacterSize(static_cast<float>(_style.textSize));
        const auto resolution = static_cast<unsigned int>(std::clamp(_style.textSize * 2.0, 16.0, 128.0));
        text->setFontResolution(resolution, resolution);
        text->setColor(_style.textColor);
        text->setAlignment(alignment);
        text->setPosition(osg::Vec3(static_cast<float>(x), static_cast<float>(y), 0.0f));
        text->setText(words, osgText::String::ENCODING_UTF8);
        _legend->addChild(text);
    }

    osg::Vec4 frame() const
    {
        return {_style.textColor.x(), _style.textColor.y(), _style.textColor.z(), 0.7f};
    }
    osg::ref_ptr<osg::Group> take() { return _legend; }

private:
    static osg::ref_ptr<osg::Geometry> quad(const Box& box, const osg::Vec4& color)
    {
        const auto number = [](double value)
        {
            return static_cast<float>(value);
        };
        osg::ref_ptr<osg::Geometry> geometry = osg::createTexturedQuadGeometry(
            {number(box.left), number(box.bottom), 0.0f}, {number(box.width), 0.0f, 0.0f},
            {0.0f, number(box.height), 0.0f});
        osg::ref_ptr<osg::Vec4Array> colors = new osg::Vec4Array;
        colors->push_back(color);
        geometry->setColorArray(colors, osg::Array::BIND_OVERALL);
        return geometry;
    }

    const LegendStyle& _style;
    osg::ref_ptr<osg::Group> _legend;
};

std::string nameOf(double value, double step, const LegendStyle& style)
{
    const auto found = style.names.find(value);
    return found != style.names.end() ? found->second : tickText(value, step);
}

void makeFields(LegendBuilder& builder, const std::vector<ColorTable::Stop>& stops, const LegendStyle& style)
{
    const double line = std::max(style.barHeight, style.textSize) * 1.5;
    double step = 0.0;
    for (std::size_t i = 1; i < stops.size(); ++i)
    {
        const double apart = stops[i].value - stops[i - 1].value;
        step = step > 0.0 ? std::min(step, apart) : apart;
    }
    const double width = style.barHeight * 1.8;
    for (std::size_t i = 0; i < stops.size(); ++i)
    {
        // The first on top.
        const double bottom = builder.margin() + line * static_cast<double>(stops.size() - 1 - i);
        const Box box = {builder.margin(), bottom, width, style.barHeight};
        builder.colored({box.left - 1.0, box.bottom - 1.0, box.width + 2.0, box.height + 2.0},
                        builder.frame());
        builder.colored(box, {1.0f, 1.0f, 1.0f, 1.0f});
        builder.colored(box, stops[i].color);
        builder.text(nameOf(stops[i].value, step, style), box.left + width + builder.margin() * 0.8,
                     bottom + style.barHeight * 0.5 - style.textSize * 0.36, osgText::Text::LEFT_BASE_LINE);
    }
}

void makeBar(LegendBuilder& builder, const ColorTable& colors, double low, double high,
             const LegendStyle& style)
{
    const double tick = style.textSize * 0.35;
    const Box bar = {builder.margin() * 1.6, builder.margin() * 0.6 + builder.textHeight() + tick,
                     style.width - 3.2 * builder.margin(), style.barHeight};
    const osg::ref_ptr<osg::Image> picture =
        colors.legend(low, high, std::max(static_cast<int>(bar.width), 2), 1);
    if (picture) builder.picture(bar, picture);
    const std::vector<double> ticks = roundTicks(low, high, style.mostTicks);
    const double step = ticks.size() > 1 ? ticks[1] - ticks[0] : high - low;
    for (const double value : ticks)
    {
        const double x = bar.left + bar.width * (value - low) / (high - low);
        builder.colored({std::round(x) - 0.5, bar.bottom - tick, 1.0, tick}, builder.frame());
        builder.text(nameOf(value, step, style), x, bar.bottom - tick - style.textSize,
                     osgText::Text::CENTER_BASE_LINE);
    }
}

} // namespace

std::vector<double> roundTicks(double low, double high, int most)
{
    if (!(low < high) || !std::isfinite(high - low) || most < 1) return {};
    const double power = std::pow(10.0, std::floor(std::log10((high - low) / most)));
    for (const double factor : {1.0, 2.0, 5.0, 10.0, 20.0, 50.0})
    {
        const double step = factor * power;
        // A little beyond the ends, for those that only rounding puts there.
        const double first = std::ceil(low / step - 1e-9);
        const double last = std::floor(high / step + 1e-9);
        if (last - first >= most) continue;
        std::vector<double> ticks;
        for (double number = first; number <= last; ++number)
            ticks.push_back(number * step + 0.0);
        return ticks;
    }
    return {};
}

std::string tickText(double value, double step)
{
    const double magnitude = std::max(std::abs(value), std::abs(step));
    char text[64];
    if (magnitude >= 1e7 || (magnitude > 0.0 && magnitude < 1e-4))
    {
        std::snprintf(text, sizeof text, "%.3g", value);
        return text;
    }
    int digits = 0;
    double scaled = std::abs(step);
    while (digits < 6 && std::abs(scaled - std::round(scaled)) > 1e-6 * std::max(scaled, 1e-3))
    {
        scaled *= 10.0;
        ++digits;
    }
    std::snprintf(text, sizeof text, "%.*f", digits, value == 0.0 ? 0.0 : value);
    // A true minus is as wide as a digit.
    return text[0] == '-' ? std::string("\u2212") + (text + 1) : std::string(text);
}

osg::ref_ptr<osg::Group> makeLegend(const ColorTable& colors, double low, double high,
                                    const LegendStyle& style)
{
    const auto within = [](double value)
    {
        return value >= 1.0 && value <= 10000.0;
    };
    if (!(low < high) || !within(style.width) || !within(style.barHeight) || !within(style.textSize))
    {
        OSG_WARN << "osgGeoFX: A legend from " << low << " to " << high << " with the size " << style.width
                 << " x " << style.barHeight << " cannot be made." << std::endl;
        return nullptr;
    }
    LegendBuilder builder(style);
    const bool fields = colors.getMode() == ColorTable::EXACT;
    std::vector<ColorTable::Stop> stops;
    for (const ColorTable::Stop& stop : colors.getStops())
    {
        if (stop.value >= low && stop.value <= high) stops.push_back(stop);
    }
    const double line = std::max(style.barHeight, style.textSize) * 1.5;
    const double content = fields ? builder.margin() + line * static_cast<double>(stops.size())
                                  : builder.margin() * 0.6 + builder.textHeight() + style.textSize * 0.35 +
                                        style.barHeight + builder.margin() * 0.8;
    const bool titled = !style.title.empty() || !style.unit.empty();
    builder.background(content + (titled ? builder.textHeight() + builder.margin() * 0.4 : 0.0));
    if (fields)
        makeFields(builder, stops, style);
    else
        makeBar(builder, colors, low, high, style);
    if (titled)
    {
        const std::string between = !style.title.empty() && !style.unit.empty() ? ", " : "";
        builder.text(style.title + between + style.unit, fields ? builder.margin() : builder.margin() * 1.6,
                     content + style.textSize * 0.1, osgText::Text::LEFT_BASE_LINE);
    }
    return builder.take();
}

} // namespace osgGeoFX
