// SPDX-License-Identifier: MIT
// SPDX-FileCopyrightText: 2026 the osgGeoFX authors
#include <osgGeoFX/geodata/detail/VirtualNames.h>

#include <cpl_minixml.h>
#include <cpl_string.h>

#include <algorithm>
#include <filesystem>
#include <iterator>
#include <memory>

namespace osgGeoFX
{

namespace
{

namespace fs = std::filesystem;

struct XmlDestroyer
{
    void operator()(CPLXMLNode* node) const { CPLDestroyXMLNode(node); }
};
using Xml = std::unique_ptr<CPLXMLNode, XmlDestroyer>;

std::string textOf(const CPLXMLNode& node)
{
    for (const CPLXMLNode* child = node.psChild; child; child = child->psNext)
        if (child->eType == CXT_Text) return child->pszValue;
    return {};
}

std::string attributeOf(const CPLXMLNode& node, const char* name)
{
    for (const CPLXMLNode* child = node.psChild; child; child = child->psNext)
        if (child->eType == CXT_Attribute && EQUAL(child->pszValue, name)) return textOf(*child);
    return {};
}

bool namesFile(const CPLXMLNode& node)
{
    constexpr const char* elements[] = {"SourceFilename", "SourceDataset", "SrcDataSource", "IndexDataset",
                                        "FileName",       "OverviewFile",  "Filename"};
    if (std::any_of(std::begin(elements), std::end(elements),
                    [&](const char* element) { return EQUAL(node.pszValue, element); }))
        return true;
    // Rasters of places, such as X_DATASET and Y_DATASET.
    const std::string key = EQUAL(node.pszValue, "MDI") ? attributeOf(node, "key") : std::string();
    return key.size() > 7 && EQUAL(key.c_str() + key.size() - 7, "DATASET");
}

void collect(const CPLXMLNode* node, const std::string& file, std::vector<std::string>& names)
{
    for (; node; node = node->psNext)
    {
        if (node->eType != CXT_Element) continue;
        const std::string name = namesFile(*node) ? textOf(*node) : std::string();
        if (!name.empty())
            names.push_back(VirtualNames::complete(name, attributeOf(*node, "relativeToVRT") == "1", file));
        collect(node->psChild, file, names);
    }
}

} // namespace

std::vector<std::string> VirtualNames::in(const std::string& xml, const std::string& file)
{
    std::vector<std::string> names;
    collect(Xml(CPLParseXMLString(xml.c_str())).get(), file, names);
    return names;
}

std::string VirtualNames::complete(const std::string& name, bool beside, const std::string& file)
{
    const bool isPath = !name.empty() && name[0] != '<' && name.rfind("/vsi", 0) != 0 &&
                        name.find("://") == std::string::npos;
    if (!isPath) return name;
    std::error_code code;
    const fs::path folder = beside ? fs::path(file).parent_path() : fs::current_path(code);
    return (folder / name).lexically_normal().string();
}

} // namespace osgGeoFX
