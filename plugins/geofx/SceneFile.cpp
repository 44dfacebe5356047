// SPDX-License-Identifier: MIT
// SPDX-FileCopyrightText: 2026 the osgGeoFX authors
#include "SceneFile.h"

#include "CloseUpsReader.h"
#include "MappingsReader.h"
#include "SceneXml.h"

#include <osgGeoFX/deformation/PerspectiveBend.h>
#include <osgGeoFX/viewer/EffectKinds.h>

#include <cstring>
#include <filesystem>

namespace osgGeoFX
{

namespace
{

namespace fs = std::filesystem;

/// A table of land cover that is named, not filed: GDAL would not read a file without an extension.
bool isLegend(const std::string& table)
{
    return table.find_first_of("./") == std::string::npos;
}

class Reader
{
public:
    explicit Reader(const SceneXml& xml) : _xml(xml) {}

    SceneFile scene(xmlNode* root) const
    {
        SceneFile result;
        xmlNode* terrain = child(root, "terrain");
        result.place = _xml.place(terrain);
        if (xmlNode* database = child(terrain, "database"))
        {
            result.database = _xml.path(database, "file");
            result.ground = ground(database);
        }
        if (xmlNode* engine = child(terrain, "engine"))
        {
            const bool open = attributeOf(engine, "culling") == "open";
            result.engine = SceneEngine{open ? EffectScene::OPEN : EffectScene::PROXY};
            result.ground = ground(engine);
        }
        if (xmlNode* rasterNode = child(terrain, "rasters")) result.rasters = rasters(rasterNode);
        if (xmlNode* view = child(root, "homeView"))
        {
            result.homeView = homeView(view);
            result.homeViewPlace = _xml.place(view);
        }
        if (xmlNode* sunNode = child(root, "sun")) result.sun = sun(sunNode);
        if (xmlNode* behind = child(root, "background")) result.background = background(behind);
        if (xmlNode* effectsNode = child(root, "effects")) effects(effectsNode, result);
        if (xmlNode* presetsNode = child(root, "presets")) presets(presetsNode, result);
        if (xmlNode* map = child(root, "map")) result.map = mapOf(map);
        return result;
    }

private:
    static xmlNode* child(xmlNode* parent, const char* name) { return SceneXml::child(parent, name); }
    static double real(xmlNode* node, const char* name) { return SceneXml::real(node, name); }
    static int integer(xmlNode* node, const char* name) { return SceneXml::integer(node, name); }

    static SceneColor color(xmlNode* node, const char* name)
    {
        const std::array<double, 4> rgba = SceneXml::color(node, name);
        return {rgba[0], rgba[1], rgba[2]};
    }

    EffectScene::GroundDescription ground(xmlNode* node) const
    {
        EffectScene::GroundDescription result;
        const std::string frame = attributeOf(node, "frame");
        if (frame == "geocentric") result.frame = EffectScene::GEOCENTRIC;
        if (frame == "projected") result.frame = EffectScene::PROJECTED;
        if (!attributeOf(node, "minHeight").empty()) result.minHeight = real(node, "minHeight");
        if (!attributeOf(node, "maxHeight").empty()) result.maxHeight = real(node, "maxHeight");
        if (!attributeOf(node, "tileCells").empty()) result.tileCells = integer(node, "tileCells");
        const std::string fault = result.fault();
        if (!fault.empty()) _xml.fail(node, fault);
        return result;
    }

    SceneRasters rasters(xmlNode* node) const
    {
        SceneRasters result;
        result.place = _xml.place(node);
        result.dems = _xml.paths(node, "dem");
        result.imagery = _xml.paths(node, "imagery");
        if (xmlNode* landCover = child(node, "landCover"))
        {
            result.landCover =
                SceneRasters::LandCover{_xml.path(landCover, "file"), _xml.path(landCover, "table")};
            const std::string table = attributeOf(landCover, "table");
            if (isLegend(table)) result.landCover->table.path = table;
        }
        if (xmlNode* treeCover = child(node, "treeCover")) result.treeCover = _xml.path(treeCover, "file");
        const std::string cache = attributeOf(node, "cache"), srs = attributeOf(node, "srs");
        if (!cache.empty()) result.cache = _xml.joined(cache);
        if (srs != "geocentric") result.epsg = std::stoi(srs.substr(std::strlen("EPSG:")));
        result.vertical = attributeOf(node, "vertical");
        result.voids = attributeOf(node, "voids");
        result.voidReach = integer(node, "voidReach");
        result.voidSmoothing = integer(node, "voidSmoothing");
        result.tileSize = integer(node, "tileSize");
        result.textureSize = integer(node, "textureSize");
        result.pixelError = real(node, "pixelError");
        result.texelError = real(node, "texelError");
        result.memoryMiB = integer(node, "memory");
        return result;
    }

    static SceneView homeView(xmlNode* node)
    {
        SceneView view{
            real(node, "longitude"), real(node, "latitude"), real(node, "height"), real(node, "heading"),
            real(node, "pitch"),     real(node, "roll"),     std::nullopt};
        if (!attributeOf(node, "verticalFieldOfView").empty())
            view.verticalFieldOfView = real(node, "verticalFieldOfView");
        return view;
    }

    void effects(xmlNode* parent, SceneFile& scene) const
    {
        for (xmlNode* node = parent->children; node; node = node->next)
        {
            if (node->type != XML_ELEMENT_NODE) continue;
            const osg::ref_ptr<Effect> effect = createEffect(reinterpret_cast<const char*>(node->name));
            _xml.set(*effect, node, {"palette", "skyImage"});
            scene.effects.push_back(effect);
            if (auto* mappings = dynamic_cast<ProjectiveMappings*>(effect.get()))
                scene.mappings.push_back(readMappings(_xml, node, *mappings));
            if (auto* closeUps = dynamic_cast<CloseUps*>(effect.get()))
                scene.closeUps.push_back(readCloseUps(_xml, node, *closeUps));
            if (auto* map = dynamic_cast<PanoramaMap*>(effect.get()))
                scene.panoramas.push_back(
                    {map, pathIfAny(node, "palette"), pathIfAny(node, "skyImage"), strokeLines(node)});
        }
    }

    void presets(xmlNode* parent, SceneFile& scene) const
    {
        for (xmlNode* node = child(parent, "preset"); node; node = SceneXml::next(node->next, "preset"))
        {
            EffectPreset preset{attributeOf(node, "name"), {}};
            for (const EffectPreset& other : scene.presets)
                if (other.name == preset.name)
                    _xml.fail(node, "the name \"" + preset.name +
                                        "\" stands twice; give one of them another name.");
            for (xmlNode* each = child(node, "set"); each; each = SceneXml::next(each->next, "set"))
            {
                const std::string property = attributeOf(each, "property"),
                                  value = attributeOf(each, "value");
                const std::string fault = EffectPreset::fault(scene.effects, property, value);
                if (!fault.empty()) _xml.fail(each, fault);
                preset.settings.emplace_back(property, value);
            }
            scene.presets.push_back(preset);
        }
    }

    SceneSun sun(xmlNode* node) const
    {
        SceneSun result;
        result.place = _xml.place(node);
        result.color = color(node, "color");
        result.ambient = color(node, "ambient");
        const bool azimuth = !attributeOf(node, "azimuth").empty();
        const bool elevation = !attributeOf(node, "elevation").empty();
        const std::string time = attributeOf(node, "time");
        if (azimuth != elevation || azimuth == !time.empty())
        {
            _xml.fail(node, "the sun's place is unclear; expected: azimuth and elevation, or time alone.");
        }
        else if (azimuth)
        {
            result.azimuth = real(node, "azimuth");
            result.elevation = real(node, "elevation");
        }
        else
        {
            result.time = readClockTime(time);
            if (!result.time)
                _xml.fail(node,
                          "time is \"" + time +
                              "\"; expected: a time of the years 1 to 9999 with a zone of up to 14 hours.");
        }
        return result;
    }

    SceneBackground background(xmlNode* node) const
    {
        SceneBackground result;
        result.place = _xml.place(node);
        result.color = color(node, "color");
        if (!attributeOf(node, "visibility").empty()) result.visibility = real(node, "visibility");
        result.sky = attributeOf(node, "sky") == "true";
        return result;
    }

    SceneMap mapOf(xmlNode* node) const
    {
        return {_xml.place(node),          pathIfAny(node, "style"),  pathIfAny(node, "fontFile"),
                attributeOf(node, "font"), vectors(node, "mapNames"), vectors(node, "mapLines")};
    }

    std::vector<SceneMap::Vectors> vectors(xmlNode* parent, const char* name) const
    {
        std::vector<SceneMap::Vectors> result;
        for (xmlNode* node = child(parent, name); node; node = SceneXml::next(node->next, name))
            result.push_back({_xml.path(node, "file"), attributeOf(node, "layer")});
        return result;
    }

    std::optional<ScenePath> pathIfAny(xmlNode* node, const char* attribute) const
    {
        if (attributeOf(node, attribute).empty()) return std::nullopt;
        return _xml.path(node, attribute);
    }

    std::vector<ScenePanorama::Lines> strokeLines(xmlNode* parent) const
    {
        std::vector<ScenePanorama::Lines> result;
        for (xmlNode* node = child(parent, "lines"); node; node = SceneXml::next(node->next, "lines"))
        {
            const std::string kind = attributeOf(node, "kind");
            result.push_back({_xml.path(node, "file"), attributeOf(node, "layer"),
                              kind == "river"  ? StrokeLines::RIVER
                              : kind == "town" ? StrokeLines::TOWN
                                               : StrokeLines::ROAD});
        }
        return result;
    }

    const SceneXml& _xml;
};

/// What keeps a path from being read; empty if nothing does, or if it is not a file (GDAL's /vsi…, an
/// address).
std::string faultOf(const std::string& path, bool mayBeFolder)
{
    if (path.rfind("/vsi", 0) == 0 || path.find("://") != std::string::npos) return {};
    std::error_code code;
    const fs::file_status status = fs::status(path, code);
    if (status.type() == fs::file_type::not_found) return "does not exist";
    if (code) return "cannot be read (" + code.message() + ")";
    if (fs::is_directory(status) && !mayBeFolder) return "is a folder";
    return {};
}

} // namespace

std::string ScenePlace::message(const std::string& text) const
{
    return file + (line > 0 ? ":" + std::to_string(line) : "") + (file.empty() ? "<" : ": <") + element +
           ">: " + text;
}

namespace
{

SceneResult parse(const XmlDocument& document, const std::string& file, const std::string& folder,
                  SceneResult result)
{
    if (document)
        result.scene =
            Reader(SceneXml(file, folder, result.errors)).scene(xmlDocGetRootElement(document.get()));
    if (!result.errors.empty()) result.scene.reset();
    return result;
}

} // namespace

SceneResult parseScene(const std::string& text, const std::string& file, const std::string& folder)
{
    SceneResult result;
    const XmlDocument document = readSceneXml(text, file, result.errors);
    result = parse(document, file, folder, std::move(result));
    if (result.scene && result.scene->engine)
    {
        result.errors.push_back(
            result.scene->place.message("<engine> stands for the terrain of an osgEarth map, and this file "
                                        "is no .earth file; expected: <database> "
                                        "or <rasters>."));
        result.scene.reset();
    }
    return result;
}

SceneResult parseEngineScene(const SceneElement& part, const std::string& text, const std::string& file,
                             const std::string& folder)
{
    SceneResult result;
    const XmlDocument document = makeSceneXml(part, text, file, result.errors);
    result = parse(document, file, folder, std::move(result));
    if (!result.scene) return result;
    const SceneFile& scene = *result.scene;
    if (!scene.engine)
        result.errors.push_back(
            scene.place.message("the map has a terrain of its own; expected: <engine/>."));
    if (scene.homeView)
        result.errors.push_back(scene.homeViewPlace.message(
            "the map has viewpoints of its own; expected: a <viewpoints> in the <map> instead."));
    if (scene.sun)
        result.errors.push_back(scene.sun->place.message(
            "the map has a sky of its own; expected: a <sky> in the <map> instead."));
    for (const osg::ref_ptr<Effect>& effect : scene.effects)
    {
        const auto* bend = dynamic_cast<const PerspectiveBend*>(effect.get());
        if (bend && bend->getCoverMap())
            result.errors.push_back(scene.place.message(
                "the map's tiles do not say what lies on the ground; expected: bends without coverMap."));
    }
    if (scene.background && !scene.background->sky)
        result.errors.push_back(scene.background->place.message(
            "a background without a sky is the program's; expected: sky=\"true\", or no <background> in an "
            ".earth file."));
    if (scene.map)
        result.errors.push_back(scene.map->place.message("names and lines are put on terrains that the scene "
                                                         "itself names; expected: layers of the osgEarth map "
                                                         "with annotations or features instead."));
    if (!result.errors.empty()) result.scene.reset();
    return result;
}

std::vector<ScenePath> filesOf(const SceneFile& scene)
{
    std::vector<ScenePath> paths;
    if (scene.database) paths.push_back(*scene.database);
    if (scene.rasters)
    {
        paths = scene.rasters->dems;
        paths.insert(paths.end(), scene.rasters->imagery.begin(), scene.rasters->imagery.end());
        if (scene.rasters->landCover) paths.push_back(scene.rasters->landCover->file);
        if (scene.rasters->landCover && !isLegend(scene.rasters->landCover->table.path))
            paths.push_back(scene.rasters->landCover->table);
        if (scene.rasters->treeCover) paths.push_back(*scene.rasters->treeCover);
    }
    for (const SceneMappings& mappings : scene.mappings)
    {
        for (const auto& [layer, file] : mappings.layers)
            paths.push_back(file);
        for (const SceneTable& table : mappings.tables)
            paths.push_back(table.file);
        for (const SceneMapping& mapping : mappings.mappings)
        {
            if (mapping.raster) paths.push_back(mapping.raster->file);
        }
        for (const SceneSequence& sequence : mappings.sequences)
            paths.push_back(sequence.file);
        for (const SceneOverlay& overlay : mappings.overlays)
        {
            paths.push_back(overlay.file);
            if (overlay.style) paths.push_back(*overlay.style);
        }
        for (const SceneRoute& route : mappings.routes)
        {
            if (route.file) paths.push_back(*route.file);
        }
    }
    for (const SceneCloseUps& closeUps : scene.closeUps)
    {
        for (const SceneTable& table : closeUps.tables)
            paths.push_back(table.file);
        for (const SceneSurface& surface :
             closeUps.surfaceData ? closeUps.surfaceData->surfaces : std::vector<SceneSurface>())
        {
            if (surface.source != SceneSurface::DERIVED) paths.push_back(surface.file);
        }
        for (const SceneCloseUp& closeUp : closeUps.closeUps)
        {
            if (closeUp.image) paths.push_back(*closeUp.image);
        }
    }
    for (const ScenePanorama& panorama : scene.panoramas)
    {
        if (panorama.palette) paths.push_back(*panorama.palette);
        if (panorama.skyImage) paths.push_back(*panorama.skyImage);
        for (const ScenePanorama::Lines& lines : panorama.lines)
            paths.push_back(lines.file);
    }
    if (scene.map)
    {
        for (const std::optional<ScenePath>& path : {scene.map->style, scene.map->fontFile})
            if (path) paths.push_back(*path);
        for (const auto* const files : {&scene.map->names, &scene.map->lines})
            for (const SceneMap::Vectors& vectors : *files)
                paths.push_back(vectors.file);
    }
    return paths;
}

std::vector<std::string> missingFiles(const SceneFile& scene)
{
    std::vector<std::string> errors;
    for (const ScenePath& path : filesOf(scene))
    {
        // Rasters in time may be the files of a folder.
        const std::string fault = faultOf(path.path, path.place.element == "sequence");
        if (!fault.empty())
            errors.push_back(path.place.message(
                "the file \"" + path.path + "\" " + fault + "; correct the attribute \"" + path.attribute +
                "\" (a relative path starts in the folder of the scene file)."));
    }
    return errors;
}

} // namespace osgGeoFX
