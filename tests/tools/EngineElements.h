// SPDX-License-Identifier: MIT
// SPDX-FileCopyrightText: 2026 the osgGeoFX authors
#pragma once

#include <geofx/SceneFile.h>

#include <libxml/parser.h>
#include <libxml/tree.h>

#include <algorithm>
#include <cctype>
#include <string>

namespace geofx::test
{

namespace detail
{

inline std::string lowerCase(const xmlChar* text)
{
    std::string result = text ? reinterpret_cast<const char*>(text) : "";
    std::transform(result.begin(), result.end(), result.begin(),
                   [](unsigned char c) { return std::tolower(c); });
    return result;
}

/// As osgEarth's Config: names in lower case, attributes and then elements, both as children.
inline osgGeoFX::SceneElement elementOf(xmlNode* node)
{
    osgGeoFX::SceneElement result{lowerCase(node->name), {}, {}};
    for (xmlAttr* attribute = node->properties; attribute; attribute = attribute->next)
    {
        xmlChar* value = xmlNodeListGetString(node->doc, attribute->children, 1);
        const std::string prefix =
            attribute->ns && attribute->ns->prefix ? lowerCase(attribute->ns->prefix) + ":" : std::string();
        result.children.push_back(
            {prefix + lowerCase(attribute->name), value ? reinterpret_cast<const char*>(value) : "", {}});
        xmlFree(value);
    }
    std::sort(result.children.begin(), result.children.end(),
              [](const auto& a, const auto& b) { return a.name < b.name; });
    for (xmlNode* child = node->children; child; child = child->next)
    {
        if (child->type == XML_ELEMENT_NODE) result.children.push_back(elementOf(child));
        if (child->type == XML_TEXT_NODE) result.value += reinterpret_cast<const char*>(child->content);
    }
    result.value.erase(0, result.value.find_first_not_of(" \t\r\n"));
    result.value.erase(result.value.find_last_not_of(" \t\r\n") + 1);
    return result;
}

inline xmlNode* sceneIn(xmlNode* node)
{
    for (; node; node = node->next)
    {
        if (node->type == XML_ELEMENT_NODE && lowerCase(node->name) == "geofx") return node;
        xmlNode* below = node->type == XML_ELEMENT_NODE ? sceneIn(node->children) : nullptr;
        if (below) return below;
    }
    return nullptr;
}

} // namespace detail

/// The first <geofx> of a map, as osgEarth's lenient reader hands it over; without a name for none.
inline osgGeoFX::SceneElement engineElement(const std::string& map)
{
    xmlDoc* document = xmlReadMemory(map.data(), static_cast<int>(map.size()), nullptr, nullptr,
                                     XML_PARSE_RECOVER | XML_PARSE_NOERROR | XML_PARSE_NOWARNING);
    xmlNode* node = detail::sceneIn(document ? document->children : nullptr);
    osgGeoFX::SceneElement result = node ? detail::elementOf(node) : osgGeoFX::SceneElement();
    xmlFreeDoc(document);
    return result;
}

/// What an extension of osgEarth makes of a map.
inline osgGeoFX::SceneResult parseMap(const std::string& map, const std::string& file = "x.earth",
                                      const std::string& folder = "/maps")
{
    return osgGeoFX::parseEngineScene(engineElement(map), map, file, folder);
}

} // namespace geofx::test
