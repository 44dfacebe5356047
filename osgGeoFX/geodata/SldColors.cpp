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
#include <utility>

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

    osg::ref_ptr<ColorTable> read()
    {
        const SldDocument document = readSldDocument(_file, "the color map");
        xmlNode* const map = findElement(xmlDocGetRootElement(document.get()), "ColorMap");
        if (!map)
            throw BuildError(_file + ": it has no ColorMap; export the style of a raster layer as SLD.");
        const std::string type = attribute(map, "type").value_or("ramp");
        for (xmlNode* entry = map->children; entry; entry = entry->next)
            if (entry->type == XML_ELEMENT_NODE &&
                std::strcmp(reinterpret_cast<const char*>(entry->name), "ColorMapEntry") == 0)
                take(entry);
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

private:
    [[noreturn]] void fail(xmlNode* node, const std::string& sentence) const
    {
        throw BuildError(_file + ":" + std::to_string(xmlGetLineNo(node)) + ": " + sentence);
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
        _stops.push_back({*value, osg::Vec4(rgb[0], rgb[1], rgb[2], static_cast<float>(*alpha))});
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
    ColorTable::Stops _stops;
};

} // namespace

osg::ref_ptr<ColorTable> SldColors::read(const std::string& file, std::string& error)
{
    try
    {
        return Reader(file).read();
    }
    catch (const BuildError& failure)
    {
        error = failure.what();
        return nullptr;
    }
}

bool SldColors::isSld(const std::string& file)
{
    std::string extension = std::filesystem::path(file).extension().string();
    std::transform(extension.begin(), extension.end(), extension.begin(),
                   [](unsigned char c) { return static_cast<char>(std::tolower(c)); });
    return extension == ".sld" || extension == ".xml";
}

} // namespace osgGeoFX
