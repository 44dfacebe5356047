// SPDX-License-Identifier: MIT
// SPDX-FileCopyrightText: 2026 the osgGeoFX authors
#include "SceneXml.h"

#include <algorithm>
#include <charconv>
#include <cstring>
#include <filesystem>
#include <utility>

namespace osgGeoFX
{

namespace
{

namespace fs = std::filesystem;

/// Not strtod: it obeys the program's locale.
template<typename T>
T number(const std::string& text)
{
    const char* begin = text.c_str();
    const char* end = begin + text.size();
    if (*begin == '+') ++begin;
    T value{};
    std::from_chars(begin, end, value);
    return value;
}

} // namespace

SceneXml::SceneXml(std::string file, std::string folder, std::vector<std::string>& errors)
    : _file(std::move(file)), _folder(std::move(folder)), _errors(errors)
{
}

xmlNode* SceneXml::next(xmlNode* node, const char* name)
{
    while (node && (node->type != XML_ELEMENT_NODE ||
                    std::strcmp(reinterpret_cast<const char*>(node->name), name) != 0))
        node = node->next;
    return node;
}

xmlNode* SceneXml::child(xmlNode* parent, const char* name)
{
    return next(parent->children, name);
}

double SceneXml::real(xmlNode* node, const char* name)
{
    return number<double>(attributeOf(node, name));
}

int SceneXml::integer(xmlNode* node, const char* name)
{
    return number<int>(attributeOf(node, name));
}

std::array<double, 4> SceneXml::color(xmlNode* node, const char* name)
{
    std::string digits = attributeOf(node, name).substr(1);
    if (digits.size() == 6) digits += "ff";
    unsigned int value = 0;
    std::from_chars(digits.data(), digits.data() + digits.size(), value, 16);
    return {(value >> 24) / 255.0, (value >> 16 & 255) / 255.0, (value >> 8 & 255) / 255.0,
            (value & 255) / 255.0};
}

ScenePlace SceneXml::place(xmlNode* node) const
{
    return {_file, static_cast<int>(xmlGetLineNo(node)), reinterpret_cast<const char*>(node->name)};
}

std::string SceneXml::joined(const std::string& path) const
{
    // The path of an address is made normal without the address, whose slashes are two.
    const std::size_t scheme = _folder.find("://");
    if (scheme == std::string::npos) return (fs::path(_folder) / path).lexically_normal().string();
    const std::size_t start = std::min(_folder.find('/', scheme + 3), _folder.size());
    const fs::path folder = start < _folder.size() ? fs::path(_folder.substr(start)) : fs::path("/");
    return _folder.substr(0, start) + (folder / path).lexically_normal().string();
}

ScenePath SceneXml::path(xmlNode* node, const char* attribute) const
{
    const std::string text = attributeOf(node, attribute);
    const bool isAddress = text.find("://") != std::string::npos;
    return {isAddress ? text : joined(text), place(node), attribute,
            std::string(attribute) == "file" ? attributeOf(node, "variable") : ""};
}

std::vector<ScenePath> SceneXml::paths(xmlNode* parent, const char* name) const
{
    std::vector<ScenePath> result;
    for (xmlNode* node = child(parent, name); node; node = next(node->next, name))
        result.push_back(path(node, "file"));
    return result;
}

std::optional<SceneBox> SceneXml::box(xmlNode* node) const
{
    const SceneBox result{real(node, "west"), real(node, "south"), real(node, "east"), real(node, "north")};
    if (result.south < result.north && result.west != result.east) return result;
    fail(node, result.south < result.north ? "west and east must differ." : "south must be less than north.");
    return std::nullopt;
}

void SceneXml::set(PropertyHolder& object, xmlNode* node, const std::vector<std::string>& but) const
{
    PropertyHolder::Texts texts;
    for (const xmlAttr* attribute = node->properties; attribute; attribute = attribute->next)
    {
        const std::string name = reinterpret_cast<const char*>(attribute->name);
        if (attribute->ns || std::find(but.begin(), but.end(), name) != but.end()) continue;
        const std::string value = attributeOf(node, name.c_str());
        texts.emplace_back(name, value.substr(value.rfind('+', 0) == 0 ? 1 : 0));
    }
    std::string error;
    if (!object.setPropertyTexts(texts, error)) fail(node, error);
    for (const PropertyHolder::Part& part : object.parts())
    {
        if (xmlNode* below = child(node, part.name)) set(*part.object, below, but);
    }
}

void SceneXml::fail(xmlNode* node, const std::string& sentence) const
{
    if (_errors.size() < mostErrors) _errors.push_back(place(node).message(sentence));
}

} // namespace osgGeoFX
