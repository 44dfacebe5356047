// SPDX-License-Identifier: MIT
// SPDX-FileCopyrightText: 2026 the osgGeoFX authors
#pragma once

#include "SceneXml.h"

#include <map>

namespace osgGeoFX
{

// What elements of effects share: names by which they refer to each other, and color tables.

bool isGivenAny(xmlNode* node, const std::vector<const char*>& names);
osg::Vec4 colorOf(xmlNode* node, const char* name);

/// What has a name in an effect.
template<typename Class>
using Named = std::map<std::string, osg::ref_ptr<Class>>;

/// Gives an object its element's name, and adds it; an error where the name is there.
template<typename Class>
void addNamed(const SceneXml& xml, xmlNode* node, Named<Class>& all, Class& object)
{
    const std::string name = attributeOf(node, "name");
    object.setName(name);
    if (!all.emplace(name, &object).second)
        xml.fail(node, "the name \"" + name + "\" stands twice; give one of them another name.");
}

/// An error about an attribute that names no such element; the names that there are stand in it.
void failToFind(const SceneXml& xml, xmlNode* node, const char* attribute, const std::string& element,
                const std::vector<std::string>& names);

/// What an attribute names; null, with an error, where there is no such thing, and null where it names nothing.
template<typename Class>
Class* findNamed(const SceneXml& xml, xmlNode* node, const char* attribute, const Named<Class>& all,
                 const char* element)
{
    const std::string name = attributeOf(node, attribute);
    if (name.empty()) return nullptr;
    const auto found = all.find(name);
    if (found != all.end()) return found->second.get();
    std::vector<std::string> names;
    for (const auto& [each, object] : all)
        names.push_back(each);
    failToFind(xml, node, attribute, "<" + std::string(element) + "> of this effect", names);
    return nullptr;
}

/// Reads a <colorTable>; where its colors are in a file, they are left to be read from there.
void readTable(const SceneXml& xml, xmlNode* node, Named<ColorTable>& all, std::vector<SceneTable>& files);

} // namespace osgGeoFX
