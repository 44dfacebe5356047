// SPDX-License-Identifier: MIT
// SPDX-FileCopyrightText: 2026 the osgGeoFX authors
#pragma once

#include "SceneFile.h"
#include "SceneValidator.h"

#include <osgGeoFX/effect/PropertyHolder.h>

#include <array>
#include <string>
#include <vector>

namespace osgGeoFX
{

/// What all parts of a scene's reader need: elements that the schema has found to be right, as values.
class SceneXml
{
public:
    /// `file` is for messages; relative paths start at `folder`.
    SceneXml(std::string file, std::string folder, std::vector<std::string>& errors);

    /// The first child of a name, and the next sibling of a name from a node on; null where there is none.
    static xmlNode* child(xmlNode* parent, const char* name);
    static xmlNode* next(xmlNode* node, const char* name);

    /// In every locale; the schema has found them to be numbers.
    static double real(xmlNode* node, const char* name);
    static int integer(xmlNode* node, const char* name);

    /// "#rrggbb" or "#rrggbbaa" as red, green, blue and alpha, 0…1.
    static std::array<double, 4> color(xmlNode* node, const char* name);

    ScenePlace place(xmlNode* node) const;
    std::string joined(const std::string& path) const;
    ScenePath path(xmlNode* node, const char* attribute) const;
    std::vector<ScenePath> paths(xmlNode* parent, const char* name) const;

    /// Of west, south, east and north, which are all there; nothing, with an error, where they span nothing.
    std::optional<SceneBox> box(xmlNode* node) const;

    /// Sets the properties of an object and its parts from an element and those in it, but for the attributes named.
    /// What the schema cannot say is found here: properties that do not fit each other.
    void set(PropertyHolder& object, xmlNode* node, const std::vector<std::string>& but = {}) const;

    /// One more error, unless there are enough of them.
    void fail(xmlNode* node, const std::string& sentence) const;

private:
    std::string _file, _folder;
    std::vector<std::string>& _errors;
};

} // namespace osgGeoFX
