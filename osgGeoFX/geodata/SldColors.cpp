// SPDX-License-Identifier: MIT
// SPDX-FileCopyrightText: 2026 the osgGeoFX authors
#include <osgGeoFX/geodata/SldColors.h>

#include <osgGeoFX/geodata/BuildError.h>
#include <osgGeoFX/geodata/detail/SldDocument.h>

#include <libxml/tree.h>

#include <algorithm>
#include <array>
#include <cctype>
#include <charconv>
#include <cmath>
#include <cstring>
#include <filesystem>
#include <limits>
#include <optional>
#include <set>
#include <utility>
#include <vector>

namespace osgGeoFX
{

namespace
{

/// The first element of a name, in the text's order.
xmlNode* findElement(xmlNode* node, const char* name)
{
    for (; node; node = node->next)
    {
        if (node->type != XML_ELEMENT_NODE) continue;
        if (std::strcmp(reinterpret_cast<const char*>(node->name), name) == 0) return node;
        if (xmlNode* const below = findElement(node->children, name)) return below;
    }
    return nullptr;
}

std::string nameOf(const xmlNode* node)
{
    return reinterpret_cast<const char*>(node->name);
}

std::vector<xmlNode*> elementsOf(const xmlNode* node)
{
    std::vector<xmlNode*> result;
    for (xmlNode* child = node->children; child; child = child->next)
        if (child->type == XML_ELEMENT_NODE) result.push_back(child);
    return result;
}

std::string textOf(xmlNode* node)
{
    xmlChar* const content = xmlNodeGetContent(node);
    const std::string text = content ? reinterpret_cast<const char*>(content) : "";
    xmlFree(content);
    const std::size_t first = text.find_first_not_of(" \t\r\n");
    return first == std::string::npos ? "" : text.substr(first, text.find_last_not_of(" \t\r\n") - first + 1);
}

std::optional<std::string> attribute(xmlNode* node, const char* name)
{
    xmlChar* const text = xmlGetNoNsProp(node, reinterpret_cast<const xmlChar*>(name));
    if (!text) return std::nullopt;
    std::string value = reinterpret_cast<const char*>(text);
    xmlFree(text);
    return value;
}

std::optional<double> number(const std::string& text)
{
    const char* begin = text.data();
    const char* const end = text.data() + text.size();
    if (begin != end && *begin == '+') ++begin;
    double value = 0.0;
    const auto [stop, failure] = std::from_chars(begin, end, value);
    if (failure != std::errc() || stop != end || !std::isfinite(value)) return std::nullopt;
    return value;
}

class Reader
{
public:
    explicit Reader(const std::string& file) : _file(file) {}

    SldColors read()
    {
        const SldDocument document = readSldDocument(_file, "the color map");
        xmlNode* const root = xmlDocGetRootElement(document.get());
        xmlNode* const map = findElement(root, "ColorMap");
        xmlNode* const symbolizer = findElement(root, "RasterSymbolizer");
        if (symbolizer) readSymbolizer(symbolizer);
        if (!map && !_result.hasBands)
            throw BuildError(_file + ": it has no ColorMap; export the style of a raster layer as SLD.");
        if (map)
        {
            _result.table = tableOf(map);
            _result.opacity = 1.0;
        }
        _result.notices.assign(_notices.begin(), _notices.end());
        return std::move(_result);
    }

private:
    [[noreturn]] void fail(xmlNode* node, const std::string& sentence) const
    {
        throw BuildError(_file + ":" + std::to_string(xmlGetLineNo(node)) + ": " + sentence);
    }

    osg::ref_ptr<ColorTable> tableOf(xmlNode* map)
    {
        const std::string type = attribute(map, "type").value_or("ramp");
        for (xmlNode* const entry : elementsOf(map))
            if (nameOf(entry) == "ColorMapEntry") take(entry);
        if (_stops.empty()) fail(map, "the ColorMap has no ColorMapEntry; give it one or more.");
        // QGIS's last interval. Only intervals have a color below their quantity.
        const bool isOpen = std::isinf(_stops.back().value);
        const osg::Vec4 last = _stops.back().color;
        while (std::isinf(_stops.back().value) && _stops.size() > 1)
            _stops.pop_back();
        if (std::isinf(_stops.back().value)) _stops.back().value = 0.0;
        osg::ref_ptr<ColorTable> table = new ColorTable;
        if (type == "intervals")
        {
            table->setMode(ColorTable::STEPS);
            table->setStops(intervals(isOpen ? last : osg::Vec4()));
        }
        else if (type == "values")
        {
            table->setMode(ColorTable::EXACT);
            table->setStops(_stops);
        }
        else if (type == "ramp")
            table->setStops(_stops);
        else
            fail(map,
                 "the ColorMap's type is \"" + type.substr(0, 40) + "\"; write ramp, intervals or values.");
        return table;
    }

    void readSymbolizer(xmlNode* symbolizer)
    {
        for (xmlNode* const child : elementsOf(symbolizer))
        {
            const std::string name = nameOf(child);
            if (name == "Opacity")
            {
                const std::string text = textOf(child);
                const std::optional<double> opacity = number(text);
                if (!opacity || *opacity < 0.0 || *opacity > 1.0)
                    fail(child, "the opacity is \"" + text.substr(0, 40) + "\"; write a number from 0 to 1.");
                _result.opacity = *opacity;
            }
            else if (name == "ChannelSelection")
                readChannels(child);
            else if (name == "ContrastEnhancement")
                readEnhancement(child, _result.bands.channels);
            else if (name == "ShadedRelief" || name == "ImageOutline" || name == "OverlapBehavior")
                leaveOut(name);
            else if (name == "VendorOption") // QGIS's saturation, brightness and contrast
                leaveOut(attribute(child, "name").value_or(name).substr(0, 40));
        }
    }

    void readChannels(xmlNode* selection)
    {
        std::array<RasterBands::Channel, 3>& channels = _result.bands.channels;
        for (xmlNode* const child : elementsOf(selection))
        {
            const std::string name = nameOf(child);
            RasterBands::Channel channel;
            std::array<RasterBands::Channel, 3> read;
            for (xmlNode* const part : elementsOf(child))
            {
                if (nameOf(part) == "SourceChannelName")
                    channel.band = bandOf(part);
                else if (nameOf(part) == "ContrastEnhancement")
                    readEnhancement(part, read);
            }
            channel.range = read[0].range;
            if (name == "GrayChannel")
                channels = {channel, channel, channel};
            else if (name == "RedChannel")
                channels[0] = channel;
            else if (name == "GreenChannel")
                channels[1] = channel;
            else if (name == "BlueChannel")
                channels[2] = channel;
            else
                continue;
            _result.hasBands = true;
        }
    }

    int bandOf(xmlNode* node) const
    {
        const std::string text = textOf(node);
        const std::optional<double> band = number(text);
        if (!band || *band < 1.0 || *band > 65535.0 || *band != std::floor(*band))
            fail(node,
                 "the channel is \"" + text.substr(0, 40) + "\"; write the number of a band, from 1 on.");
        return static_cast<int>(*band);
    }

    /// Sets the range of the channels where it is told.
    void readEnhancement(xmlNode* node, std::array<RasterBands::Channel, 3>& channels)
    {
        for (xmlNode* const child : elementsOf(node))
        {
            const std::string name = nameOf(child);
            if (name == "GammaValue" && number(textOf(child)) == 1.0) continue;
            // Without numbers it is what is done anyway.
            if (name == "Normalize")
                readRange(child, channels);
            else
                leaveOut(name);
        }
    }

    void readRange(xmlNode* node, std::array<RasterBands::Channel, 3>& channels)
    {
        std::optional<double> low, high;
        for (xmlNode* const option : elementsOf(node))
        {
            const std::string name = attribute(option, "name").value_or(""), text = textOf(option);
            if (name == "algorithm" && text != "StretchToMinimumMaximum")
                leaveOut(text.substr(0, 40));
            else if (name == "minValue" || name == "maxValue")
            {
                const std::optional<double> value = number(text);
                if (!value)
                    fail(option, "the " + name + " is \"" + text.substr(0, 40) + "\"; write a number.");
                (name == "minValue" ? low : high) = value;
            }
        }
        if (!low || !high || *low == *high) return;
        for (RasterBands::Channel& channel : channels)
            channel.range = {*low, *high};
        _result.hasBands = true;
    }

    void leaveOut(const std::string& name)
    {
        _notices.insert(_file + ": " + name + " of its RasterSymbolizer is left out.");
    }

    void take(xmlNode* entry)
    {
        const std::string quantity = attribute(entry, "quantity").value_or("");
        const std::string color = attribute(entry, "color").value_or("");
        const std::string opacity = attribute(entry, "opacity").value_or("1");
        const std::optional<double> alpha = number(opacity);
        const std::optional<double> value = quantity == "inf" || quantity == "+inf"
                                                ? std::numeric_limits<double>::infinity()
                                                : number(quantity);
        if (!value)
            fail(entry, "the entry's quantity is \"" + quantity.substr(0, 40) + "\"; write a number.");
        if (!alpha || *alpha < 0.0 || *alpha > 1.0)
            fail(entry,
                 "the entry's opacity is \"" + opacity.substr(0, 40) + "\"; write a number from 0 to 1.");
        if (!_stops.empty() && *value < _stops.back().value)
            fail(entry, "the entry's quantity is less than that of the entry before; put them in order.");
        std::array<float, 3> rgb{};
        const bool isHex = color.size() == 7 && color[0] == '#' &&
                           std::all_of(color.begin() + 1, color.end(),
                                       [](unsigned char c) { return std::isxdigit(c) != 0; });
        if (!isHex) fail(entry, "the entry's color is \"" + color.substr(0, 40) + "\"; write #rrggbb.");
        for (std::size_t i = 0; i < 3; ++i)
            rgb[i] = static_cast<float>(std::stoi(color.substr(1 + 2 * i, 2), nullptr, 16)) / 255.0f;
        _stops.push_back(
            {*value, osg::Vec4(rgb[0], rgb[1], rgb[2], static_cast<float>(*alpha * _result.opacity))});
    }

    /// Colors that hold below their quantities become ones that hold from the quantity before on.
    /// `last`: from the last quantity on.
    ColorTable::Stops intervals(const osg::Vec4& last) const
    {
        const double span = _stops.back().value - _stops.front().value;
        ColorTable::Stops result = {
            {_stops.front().value - (span > 0.0 ? span / static_cast<double>(_stops.size()) : 1.0),
             _stops.front().color}};
        for (std::size_t i = 0; i < _stops.size(); ++i)
            result.push_back({_stops[i].value, i + 1 < _stops.size() ? _stops[i + 1].color : last});
        return result;
    }

    const std::string& _file;
    SldColors _result;
    std::set<std::string> _notices;
    ColorTable::Stops _stops;
};

} // namespace

std::optional<SldColors> SldColors::readAll(const std::string& file, std::string& error)
{
    try
    {
        return Reader(file).read();
    }
    catch (const BuildError& failure)
    {
        error = failure.what();
        return std::nullopt;
    }
}

osg::ref_ptr<ColorTable> SldColors::read(const std::string& file, std::string& error)
{
    const std::optional<SldColors> all = readAll(file, error);
    if (!all) return nullptr;
    if (!all->table) error = file + ": it has no ColorMap; export the style of a layer with one band as SLD.";
    return all->table;
}

bool SldColors::isSld(const std::string& file)
{
    std::string extension = std::filesystem::path(file).extension().string();
    std::transform(extension.begin(), extension.end(), extension.begin(),
                   [](unsigned char c) { return static_cast<char>(std::tolower(c)); });
    return extension == ".sld" || extension == ".xml";
}

} // namespace osgGeoFX
