// SPDX-License-Identifier: MIT
// SPDX-FileCopyrightText: 2026 the osgGeoFX authors
#include "SceneNames.h"

#include <algorithm>

namespace osgGeoFX
{

bool isGivenAny(xmlNode* node, const std::vector<const char*>& names)
{
    return std::any_of(names.begin(), names.end(), [&](const char* name) { return isGiven(node, name); });
}

osg::Vec4 colorOf(xmlNode* node, const char* name)
{
    const std::array<double, 4> rgba = SceneXml::color(node, name);
    return osg::Vec4(osg::Vec4d(rgba[0], rgba[1], rgba[2], rgba[3]));
}

void failToFind(const SceneXml& xml, xmlNode* node, const char* attribute, const std::string& element,
                const std::vector<std::string>& names)
{
    std::string all;
    for (const std::string& name : names)
        all += (all.empty() ? "" : ", ") + name;
    xml.fail(node, std::string(attribute) + "=\"" + attributeOf(node, attribute) + "\" names no " + element +
                       "; expected: " + (all.empty() ? "nothing, there is none" : all) + ".");
}

void readTable(const SceneXml& xml, xmlNode* node, Named<ColorTable>& all, std::vector<SceneTable>& files)
{
    osg::ref_ptr<ColorTable> table = new ColorTable;
    std::optional<std::pair<double, double>> range;
    if (isGivenAny(node, {"low", "high"})) range.emplace(0.0, 1.0);
    if (isGiven(node, "low")) range->first = SceneXml::real(node, "low");
    if (isGiven(node, "high")) range->second = SceneXml::real(node, "high");
    xmlNode* stop = SceneXml::child(node, "stop");
    const int sources = isGiven(node, "ready") + isGiven(node, "file") + (stop != nullptr);
    if (sources != 1)
        xml.fail(node, std::string(sources == 0 ? "nothing says what the colors are"
                                                : "too much says what the colors are") +
                           "; expected: one of ready, file and <stop> elements.");
    else if (range && stop)
        xml.fail(node, "low and high are of no use with <stop> elements; remove them.");
    else if (range && !(range->first < range->second))
        xml.fail(node, "low must be less than high.");
    else if (isGiven(node, "ready"))
    {
        const auto [low, high] = range.value_or(std::pair(0.0, 1.0));
        table = ColorTable::named(attributeOf(node, "ready"), low, high);
    }
    ColorTable::Stops stops;
    for (; stop; stop = SceneXml::next(stop->next, "stop"))
        stops.push_back({SceneXml::real(stop, "value"), colorOf(stop, "color")});
    if (!stops.empty()) table->setStops(stops);
    const std::vector<std::string> modes = {"linear", "nearest", "exact", "steps"};
    const auto mode = std::find(modes.begin(), modes.end(), attributeOf(node, "mode"));
    table->setMode(static_cast<ColorTable::Mode>(mode - modes.begin()));
    table->setNoDataColor(colorOf(node, "noDataColor"));
    addNamed(xml, node, all, *table);
    if (isGiven(node, "file")) files.push_back({table, xml.path(node, "file"), range});
}

} // namespace osgGeoFX
