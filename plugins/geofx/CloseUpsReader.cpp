// SPDX-License-Identifier: MIT
// SPDX-FileCopyrightText: 2026 the osgGeoFX authors
#include "CloseUpsReader.h"

#include "SceneNames.h"

#include <algorithm>
#include <charconv>
#include <iterator>
#include <sstream>

namespace osgGeoFX
{

namespace
{

// In the order of SurfaceData::Kind.
const std::vector<std::string> kinds = {"color",  "height",    "normal", "slope",
                                        "aspect", "occlusion", "class",  "value"};
/// The pictures that a DEM makes, called like their kinds.
constexpr SurfaceData::Kind kindsOfDem[] = {SurfaceData::HEIGHT, SurfaceData::NORMAL, SurfaceData::SLOPE,
                                            SurfaceData::ASPECT, SurfaceData::OCCLUSION};

class Reader
{
public:
    Reader(const SceneXml& xml, SceneCloseUps& result) : _xml(xml), _result(result) {}

    void read(xmlNode* element)
    {
        for (xmlNode* node = element->children; node; node = node->next)
        {
            if (node->type != XML_ELEMENT_NODE) continue;
            const std::string kind = reinterpret_cast<const char*>(node->name);
            if (kind == "colorTable")
                readTable(_xml, node, _tables, _result.tables);
            else if (kind == "surfaceData")
                readData(node);
            else
                readCloseUp(node);
        }
    }

private:
    void readData(xmlNode* node)
    {
        SceneSurfaceData data;
        data.place = _xml.place(node);
        data.maxSide = SceneXml::integer(node, "maxSide");
        data.radius = SceneXml::real(node, "radius");
        const std::vector<const char*> edges = {"west", "south", "east", "north"};
        const auto given =
            std::count_if(edges.begin(), edges.end(), [&](const char* edge) { return isGiven(node, edge); });
        if (given == 4)
            data.box = _xml.box(node);
        else if (given > 0 || !SceneXml::child(node, "dem"))
            _xml.fail(
                node,
                "nothing says what it covers; expected: all of west, south, east and north, or a <dem>.");
        for (xmlNode* child = node->children; child; child = child->next)
        {
            if (child->type == XML_ELEMENT_NODE) data.surfaces.push_back(surfaceOf(child));
        }
        _result.surfaceData = data;
    }

    SceneSurface surfaceOf(xmlNode* node)
    {
        SceneSurface surface;
        surface.place = _xml.place(node);
        const std::string element = surface.place.element;
        if (element == "dem")
        {
            surface.file = _xml.path(node, "file");
            for (const SurfaceData::Kind kind : kindsOfDem)
                _surfaces.push_back(kinds[static_cast<std::size_t>(kind)]);
            _hasHeights = true;
            return surface;
        }
        surface.name = attributeOf(node, "name");
        if (std::count(_surfaces.begin(), _surfaces.end(), surface.name) > 0)
            _xml.fail(node, "the name \"" + surface.name + "\" stands twice; give one of them another name.");
        _surfaces.push_back(surface.name);
        if (element != "derived") surface.file = _xml.path(node, "file");
        if (element == "vectors")
        {
            surface.source = SceneSurface::VECTORS;
            surface.width = SceneXml::real(node, "width");
            surface.color = colorOf(node, "color");
            return surface;
        }
        const auto kind = std::find(kinds.begin(), kinds.end(), attributeOf(node, "kind"));
        surface.kind = static_cast<SurfaceData::Kind>(kind - kinds.begin());
        surface.source = element == "derived" ? SceneSurface::DERIVED : SceneSurface::RASTER;
        if (surface.source == SceneSurface::DERIVED && !_hasHeights)
            _xml.fail(
                node,
                "there are no heights before it; expected: a <dem> or a <surface kind=\"height\"> first.");
        _hasHeights = _hasHeights || surface.kind == SurfaceData::HEIGHT;
        return surface;
    }

    void readCloseUp(xmlNode* node)
    {
        SceneCloseUp result;
        result.place = _xml.place(node);
        result.closeUp = new CloseUp;
        CloseUp& closeUp = *result.closeUp;
        // The last two are those of region and anchor.
        _xml.set(closeUp, node, {"surface", "table", "image"});
        closeUp.setTable(findNamed(_xml, node, "table", _tables, "colorTable"));
        closeUp.setSurface(attributeOf(node, "surface"));
        const std::string& surface = closeUp.getSurface();
        if (!surface.empty() && std::count(_surfaces.begin(), _surfaces.end(), surface) == 0)
            failToFind(_xml, node, "surface", "picture of this effect's <surfaceData>", _surfaces);
        if (xmlNode* region = SceneXml::child(node, "region")) readRegion(region, result);
        if (xmlNode* anchor = SceneXml::child(node, "anchor")) readAnchor(anchor, *closeUp.getAnchor());
        _result.effect->addCloseUp(&closeUp);
        _result.closeUps.push_back(result);
    }

    void readRegion(xmlNode* node, SceneCloseUp& result) const
    {
        result.place = _xml.place(node);
        const std::vector<const char*> angles = {"longitude", "latitude"};
        const bool hasAngles = isGivenAny(node, angles);
        const bool hasMetres = isGivenAny(node, {"centerX", "centerY"});
        const bool hasBoth = isGiven(node, angles[0]) && isGiven(node, angles[1]);
        if (hasAngles && (hasMetres || !hasBoth))
            _xml.fail(node, "longitude and latitude belong together and stand in the place of "
                            "centerX and centerY; remove one of the pairs.");
        result.center = hasAngles   ? SceneCloseUp::DEGREES
                        : hasMetres ? SceneCloseUp::METRES
                                    : SceneCloseUp::NOTHING;
        RegionOfInterest& region = *result.closeUp->getRegion();
        std::vector<osg::Vec2d> corners;
        for (xmlNode* corner = SceneXml::child(node, "corner"); corner;
             corner = SceneXml::next(corner->next, "corner"))
            corners.emplace_back(SceneXml::real(corner, "x"), SceneXml::real(corner, "y"));
        if (!corners.empty()) readOutline(node, corners, region);
        if (!isGiven(node, "image")) return;
        result.image = _xml.path(node, "image");
        if (takesShape(node, "image", RegionOfInterest::IMAGE, region)) return;
        _xml.fail(node, "an image is of no use with this shape; remove it, or write shape=\"image\".");
    }

    void readOutline(xmlNode* node, const std::vector<osg::Vec2d>& corners, RegionOfInterest& region) const
    {
        if (!takesShape(node, "polygon", RegionOfInterest::POLYGON, region))
            _xml.fail(node,
                      "corners are of no use with this shape; remove them, or write shape=\"polygon\".");
        else if (!region.setOutline(corners))
            _xml.fail(node, "its corners span no area; expected: three or more, not on one line.");
    }

    /// Where the element says no shape, it is this one. False where it says another one.
    static bool takesShape(xmlNode* node, const char* name, RegionOfInterest::Shape shape,
                           RegionOfInterest& region)
    {
        if (isGiven(node, "shape")) return attributeOf(node, "shape") == name;
        return region.setShape(shape);
    }

    void readAnchor(xmlNode* node, Anchor& anchor) const
    {
        if (!isGiven(node, "table")) return;
        std::istringstream words(attributeOf(node, "table"));
        std::vector<float> opacities;
        for (std::string word; words >> word;)
        {
            const std::size_t first = word.rfind('+', 0) == 0 ? 1 : 0;
            // In every locale; the schema has found it to be a number.
            std::from_chars(word.data() + first, word.data() + word.size(), opacities.emplace_back());
        }
        if (isGiven(node, "style") && attributeOf(node, "style") != "table")
            return _xml.fail(node,
                             "a table is of no use with this style; remove it, or write style=\"table\".");
        anchor.setTable(opacities);
    }

    const SceneXml& _xml;
    SceneCloseUps& _result;
    Named<ColorTable> _tables;
    std::vector<std::string> _surfaces;
    bool _hasHeights = false;
};

} // namespace

SceneCloseUps readCloseUps(const SceneXml& xml, xmlNode* element, CloseUps& effect)
{
    SceneCloseUps result;
    result.place = xml.place(element);
    result.effect = &effect;
    Reader(xml, result).read(element);
    return result;
}

} // namespace osgGeoFX
