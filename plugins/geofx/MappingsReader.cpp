// SPDX-License-Identifier: MIT
// SPDX-FileCopyrightText: 2026 the osgGeoFX authors
#include "MappingsReader.h"

#include <algorithm>
#include <map>

namespace osgGeoFX
{

namespace
{

/// What has a name in an effect.
template<typename Class>
using Named = std::map<std::string, osg::ref_ptr<Class>>;

bool isGivenAny(xmlNode* node, const std::vector<const char*>& names)
{
    return std::any_of(names.begin(), names.end(), [&](const char* name) { return isGiven(node, name); });
}

osg::Vec4 colourOf(xmlNode* node, const char* name)
{
    const std::array<double, 4> rgba = SceneXml::colour(node, name);
    return osg::Vec4(osg::Vec4d(rgba[0], rgba[1], rgba[2], rgba[3]));
}

class Reader
{
public:
    Reader(const SceneXml& xml, SceneMappings& result) : _xml(xml), _result(result) {}

    void read(xmlNode* element)
    {
        for (xmlNode* node = element->children; node; node = node->next)
        {
            if (node->type != XML_ELEMENT_NODE) continue;
            const std::string kind = reinterpret_cast<const char*>(node->name);
            if (kind == "layer")
                readLayer(node);
            else if (kind == "colorTable")
                readTable(node);
            else if (kind == "transfer")
                readTransfer(node);
            else
                readMapping(node, kind == "raster");
        }
    }

private:
    template<typename Class>
    void add(xmlNode* node, Named<Class>& all, Class* object)
    {
        const std::string name = attributeOf(node, "name");
        object->setName(name);
        if (!all.emplace(name, object).second)
            _xml.fail(node, "the name \"" + name + "\" stands twice; give one of them another name.");
    }

    /// What an attribute names; null, with an error, where there is no such thing, and null where it names nothing.
    template<typename Class>
    Class* named(xmlNode* node, const char* attribute, const Named<Class>& all, const char* element) const
    {
        const std::string name = attributeOf(node, attribute);
        if (name.empty()) return nullptr;
        const auto found = all.find(name);
        if (found != all.end()) return found->second.get();
        std::string names;
        for (const auto& [each, object] : all)
            names += (names.empty() ? "" : ", ") + each;
        _xml.fail(node, std::string(attribute) + "=\"" + name + "\" names no <" + element +
                            "> of this effect; expected: " +
                            (names.empty() ? "nothing, there is none" : names) + ".");
        return nullptr;
    }

    void readLayer(xmlNode* node)
    {
        const osg::ref_ptr<DataLayer> layer = new DataLayer;
        _xml.set(*layer, node, {"name", "file", "noData"});
        if (isGiven(node, "noData")) layer->setNoData(SceneXml::real(node, "noData"));
        add(node, _layers, layer.get());
        _result.layers.push_back({layer, _xml.path(node, "file")});
    }

    void readTable(xmlNode* node)
    {
        osg::ref_ptr<ColorTable> table = new ColorTable;
        std::optional<std::pair<double, double>> range;
        if (isGivenAny(node, {"low", "high"})) range.emplace(0.0, 1.0);
        if (isGiven(node, "low")) range->first = SceneXml::real(node, "low");
        if (isGiven(node, "high")) range->second = SceneXml::real(node, "high");
        xmlNode* stop = SceneXml::child(node, "stop");
        const int sources = isGiven(node, "ready") + isGiven(node, "file") + (stop != nullptr);
        if (sources != 1)
            _xml.fail(node, std::string(sources == 0 ? "nothing says what the colours are"
                                                     : "too much says what the colours are") +
                                "; expected: one of ready, file and <stop> elements.");
        else if (range && stop)
            _xml.fail(node, "low and high are of no use with <stop> elements; remove them.");
        else if (range && !(range->first < range->second))
            _xml.fail(node, "low must be less than high.");
        else if (isGiven(node, "ready"))
        {
            const auto [low, high] = range.value_or(std::pair(0.0, 1.0));
            table = ColorTable::named(attributeOf(node, "ready"), low, high);
        }
        ColorTable::Stops stops;
        for (; stop; stop = SceneXml::next(stop->next, "stop"))
            stops.push_back({SceneXml::real(stop, "value"), colourOf(stop, "colour")});
        if (!stops.empty()) table->setStops(stops);
        const std::vector<std::string> modes = {"linear", "nearest", "exact", "steps"};
        const auto mode = std::find(modes.begin(), modes.end(), attributeOf(node, "mode"));
        table->setMode(static_cast<ColorTable::Mode>(mode - modes.begin()));
        table->setNoDataColor(colourOf(node, "noDataColour"));
        add(node, _tables, table.get());
        if (isGiven(node, "file")) _result.tables.push_back({table, _xml.path(node, "file"), range});
    }

    void readTransfer(xmlNode* node)
    {
        const osg::ref_ptr<ColorTransfer> transfer = new ColorTransfer;
        _xml.set(*transfer, node, {"name"});
        add(node, _transfers, transfer.get());
    }

    void readMapping(xmlNode* node, bool isRaster)
    {
        SceneMapping result;
        result.place = _xml.place(node);
        result.mapping = new ProjectiveMapping;
        ProjectiveMapping& mapping = *result.mapping;
        _xml.set(mapping, node,
                 {"layer", "mask", "table", "transfer", "file", "kind", "maxSide", "west", "south", "east",
                  "north", "longitudeDegrees", "latitudeDegrees"});
        mapping.setLayer(named(node, "layer", _layers, "layer"));
        mapping.setMask(named(node, "mask", _layers, "layer"));
        mapping.setTable(named(node, "table", _tables, "colorTable"));
        if (ColorTransfer* transfer = named(node, "transfer", _transfers, "transfer"))
            mapping.setTransfer(transfer);
        result.hasTransfer = isGiven(node, "transfer");
        if (isRaster)
            result.raster = rasterOf(node);
        else
            readPlacing(node, result);
        _result.effect->addMapping(&mapping);
        _result.mappings.push_back(result);
    }

    SceneMapping::Raster rasterOf(xmlNode* node) const
    {
        SceneMapping::Raster raster{_xml.path(node, "file"), std::nullopt,
                                    SceneXml::integer(node, "maxSide")};
        const std::string kind = attributeOf(node, "kind");
        if (kind == "color") raster.kind = DataLayer::COLOR;
        if (kind == "value") raster.kind = DataLayer::VALUE;
        if (kind == "class") raster.kind = DataLayer::CLASS;
        return raster;
    }

    void readPlacing(xmlNode* node, SceneMapping& result) const
    {
        const std::vector<const char*> edges = {"west", "south", "east", "north"};
        const std::vector<const char*> angles = {"longitudeDegrees", "latitudeDegrees"};
        const std::vector<const char*> centre = {"centreX", "centreY"};
        const std::vector<const char*> frame = {"uX",  "uY",  "vX",  "vY",  "m00", "m01", "m02",
                                                "m10", "m11", "m12", "m20", "m21", "m22"};
        const auto has = [&](const std::vector<const char*>& names)
        {
            return isGivenAny(node, names);
        };
        const auto hasAll = [&](const std::vector<const char*>& names)
        {
            return std::all_of(names.begin(), names.end(),
                               [&](const char* name) { return isGiven(node, name); });
        };
        if (has(edges))
        {
            if (!hasAll(edges) || has(angles) || has(centre) || has(frame))
                return _xml.fail(node,
                                 "west, south, east and north belong together and say all of the place; "
                                 "remove centreX, uX and the like, or the edges.");
            const SceneMapping::Box box{SceneXml::real(node, "west"), SceneXml::real(node, "south"),
                                        SceneXml::real(node, "east"), SceneXml::real(node, "north")};
            if (!(box.south < box.north)) return _xml.fail(node, "south must be less than north.");
            if (box.west == box.east) return _xml.fail(node, "west and east must differ.");
            result.box = box;
        }
        else if (has(angles))
        {
            if (!hasAll(angles) || has(centre))
                return _xml.fail(
                    node, "longitudeDegrees and latitudeDegrees belong together and stand in the place of "
                          "centreX and centreY; remove one of the pairs.");
            result.point = SceneMapping::Point{SceneXml::real(node, "longitudeDegrees"),
                                               SceneXml::real(node, "latitudeDegrees")};
        }
    }

    const SceneXml& _xml;
    SceneMappings& _result;
    Named<DataLayer> _layers;
    Named<ColorTable> _tables;
    Named<ColorTransfer> _transfers;
};

} // namespace

SceneMappings readMappings(const SceneXml& xml, xmlNode* element, ProjectiveMappings& effect)
{
    SceneMappings result;
    result.effect = &effect;
    result.hasOrigin = isGivenAny(element, {"originX", "originY", "longitudeDegrees", "latitudeDegrees"});
    Reader(xml, result).read(element);
    return result;
}

} // namespace osgGeoFX
