// SPDX-License-Identifier: MIT
// SPDX-FileCopyrightText: 2026 the osgGeoFX authors
#include "MappingsReader.h"

#include "SceneNames.h"

#include <algorithm>

namespace osgGeoFX
{

namespace
{

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
                readTable(_xml, node, _tables, _result.tables);
            else if (kind == "transfer")
                readTransfer(node);
            else if (kind == "sequence")
                readSequence(node);
            else if (kind == "overlays")
                readOverlays(node);
            else if (kind == "route")
                readRoute(node);
            else
                readMapping(node, kind == "raster");
        }
    }

private:
    void readLayer(xmlNode* node)
    {
        const osg::ref_ptr<DataLayer> layer = new DataLayer;
        _xml.set(*layer, node, {"name", "file", "noData"});
        if (isGiven(node, "noData")) layer->setNoData(SceneXml::real(node, "noData"));
        addNamed(_xml, node, _layers, *layer);
        _result.layers.push_back({layer, _xml.path(node, "file")});
    }

    void readTransfer(xmlNode* node)
    {
        const osg::ref_ptr<ColorTransfer> transfer = new ColorTransfer;
        _xml.set(*transfer, node, {"name"});
        addNamed(_xml, node, _transfers, *transfer);
    }

    void readSequence(xmlNode* node)
    {
        SceneSequence sequence;
        sequence.place = _xml.place(node);
        sequence.file = _xml.path(node, "file");
        sequence.maxSide = SceneXml::integer(node, "maxSide");
        sequence.blending = attributeOf(node, "blending") != "false" && attributeOf(node, "blending") != "0";
        if (isGiven(node, "speed")) sequence.speed = SceneXml::real(node, "speed");
        sequence.mapping = new ProjectiveMapping;
        sequence.mapping->setOpacity(SceneXml::real(node, "opacity"));
        sequence.mapping->setOrder(SceneXml::integer(node, "order"));
        sequence.mapping->setName(attributeOf(node, "name"));
        sequence.mapping->setTable(findNamed(_xml, node, "table", _tables, "colorTable"));
        sequence.hasTransfer = isGiven(node, "transfer");
        if (ColorTransfer* transfer = findNamed(_xml, node, "transfer", _transfers, "transfer"))
            sequence.mapping->setTransfer(transfer);
        _result.sequences.push_back(sequence);
    }

    void readOverlays(xmlNode* node)
    {
        SceneOverlay overlay{_xml.place(node),
                             _xml.path(node, "file"),
                             attributeOf(node, "layer"),
                             std::nullopt,
                             SceneXml::integer(node, "maxSide"),
                             SceneXml::real(node, "opacity"),
                             SceneXml::integer(node, "order")};
        if (isGiven(node, "style")) overlay.style = _xml.path(node, "style");
        overlay.bands = bandsOf(node);
        _result.overlays.push_back(overlay);
    }

    void readRoute(xmlNode* node)
    {
        SceneRoute route;
        route.place = _xml.place(node);
        if (isGiven(node, "file")) route.file = _xml.path(node, "file");
        route.layer = attributeOf(node, "layer");
        route.path.name = attributeOf(node, "name");
        route.path.wayPoints = true;
        if (isGiven(node, "color"))
        {
            const std::array<double, 4> color = SceneXml::color(node, "color");
            route.color = osg::Vec4(osg::Vec4d(color[0], color[1], color[2], color[3]));
        }
        if (isGiven(node, "width")) route.look.width = SceneXml::real(node, "width");
        route.look.order = SceneXml::integer(node, "order");
        route.look.style.context =
            attributeOf(node, "context") == "true" || attributeOf(node, "context") == "1";
        readLook(node, route);
        route.inAir = attributeOf(node, "inAir") == "true" || attributeOf(node, "inAir") == "1";
        for (xmlNode* point = SceneXml::child(node, "wayPoint"); point;
             point = SceneXml::next(point->next, "wayPoint"))
            route.path.places.emplace_back(SceneXml::real(point, "longitude"),
                                           SceneXml::real(point, "latitude"), 0.0);
        if (route.file.has_value() == !route.path.places.empty())
            return _xml.fail(node, "a route has either a file or <wayPoint> elements; give it one of them.");
        _result.routes.push_back(route);
    }

    /// The properties of a RouteMapping that are given, in metres as they are; the width enlarges the others.
    void readLook(xmlNode* node, SceneRoute& route) const
    {
        const osg::ref_ptr<RouteMapping> sample = new RouteMapping;
        _xml.set(*sample, node, {"name", "file", "layer", "width", "color", "inAir", "context", "order"});
        for (const Property& property : sample->properties())
        {
            const bool own =
                property.name == "color" || property.name == "context" || property.name == "order";
            if (!own && isGiven(node, property.name.c_str()))
                route.look.properties[property.name] = property.get(*sample);
        }
    }

    void readMapping(xmlNode* node, bool isRaster)
    {
        SceneMapping result;
        result.place = _xml.place(node);
        result.mapping = new ProjectiveMapping;
        ProjectiveMapping& mapping = *result.mapping;
        _xml.set(mapping, node,
                 {"layer", "mask", "table", "transfer", "file", "variable", "kind", "maxSide", "stretch",
                  "west", "south", "east", "north", "longitude", "latitude"});
        mapping.setLayer(findNamed(_xml, node, "layer", _layers, "layer"));
        mapping.setMask(findNamed(_xml, node, "mask", _layers, "layer"));
        mapping.setTable(findNamed(_xml, node, "table", _tables, "colorTable"));
        if (ColorTransfer* transfer = findNamed(_xml, node, "transfer", _transfers, "transfer"))
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
        raster.bands = bandsOf(node);
        return raster;
    }

    std::optional<RasterBands> bandsOf(xmlNode* node) const
    {
        if (!isGiven(node, "stretch")) return std::nullopt;
        RasterBands bands;
        if (!bands.setRange(attributeOf(node, "stretch")))
            _xml.fail(node, "the stretch is \"" + attributeOf(node, "stretch").substr(0, 40) +
                                "\"; write two different numbers with a comma between them.");
        return bands;
    }

    void readPlacing(xmlNode* node, SceneMapping& result) const
    {
        const std::vector<const char*> edges = {"west", "south", "east", "north"};
        const std::vector<const char*> angles = {"longitude", "latitude"};
        const std::vector<const char*> center = {"centerX", "centerY"};
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
            if (!hasAll(edges) || has(angles) || has(center) || has(frame))
                return _xml.fail(node,
                                 "west, south, east and north belong together and say all of the place; "
                                 "remove centerX, uX and the like, or the edges.");
            result.box = _xml.box(node);
        }
        else if (has(angles))
        {
            if (!hasAll(angles) || has(center))
                return _xml.fail(node, "longitude and latitude belong together and stand in the place of "
                                       "centerX and centerY; remove one of the pairs.");
            result.point =
                SceneMapping::Point{SceneXml::real(node, "longitude"), SceneXml::real(node, "latitude")};
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
    result.place = xml.place(element);
    result.effect = &effect;
    result.hasOrigin = isGivenAny(element, {"originX", "originY", "longitude", "latitude"});
    Reader(xml, result).read(element);
    return result;
}

} // namespace osgGeoFX
