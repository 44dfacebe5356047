// SPDX-License-Identifier: MIT
// SPDX-FileCopyrightText: 2026 the osgGeoFX authors
#pragma once

#include "SceneFile.h"

#include <libxml/tree.h>

#include <cstddef>
#include <memory>
#include <string>
#include <vector>

namespace osgGeoFX
{

/// No more sentences than this are said of one scene.
constexpr std::size_t mostErrors = 20;

struct XmlDocumentFree
{
    void operator()(xmlDoc* document) const { xmlFreeDoc(document); }
};
using XmlDocument = std::unique_ptr<xmlDoc, XmlDocumentFree>;

/// The value of an attribute without spaces around it; empty where there is none.
std::string attributeOf(xmlNode* element, const char* name);

/// Whether the person has written an attribute; the schema's defaults are not.
bool isGiven(xmlNode* element, const char* name);

/** A scene's XML, checked against the schema and with the schema's defaults filled in. Null, with sentences
   in `errors` that name `file`, where it is no scene of this version. Nothing but `text` is read: no DTD, no
   entity and no schema that the text names. The scene is the outermost element of the document. */
XmlDocument readSceneXml(const std::string& text, const std::string& file, std::vector<std::string>& errors);

/** Makes the checked XML of a scene that an engine has read from its own file. Names get the schema's spelling. Lines are those of the first
   <geofx> in `text`, as far as its elements are those of the scene; `text` may be malformed or empty. */
XmlDocument makeSceneXml(const SceneElement& scene, const std::string& text, const std::string& file,
                         std::vector<std::string>& errors);

} // namespace osgGeoFX
