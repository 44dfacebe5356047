// SPDX-License-Identifier: MIT
// SPDX-FileCopyrightText: 2026 the osgGeoFX authors
#include "SceneFile.h"

#include "SceneValidator.h"

#include <osgGeoFX/scene/EffectKinds.h>

#include <charconv>
#include <cstring>
#include <filesystem>

namespace osgGeoFX
{

namespace
{

namespace fs = std::filesystem;

/// Of a text that the schema has found to be a number. Not strtod: it obeys the program's locale.
template<typename T>
T number(const std::string& text, int base = 10)
{
    const char* begin = text.c_str();
    const char* end = begin + text.size();
    if (*begin == '+') ++begin;
    T value{};
    if constexpr (std::is_integral_v<T>)
        std::from_chars(begin, end, value, base);
    else
        std::from_chars(begin, end, value);
    return value;
}

class Reader
{
public:
    Reader(const std::string& file, const std::string& folder, std::vector<std::string>& errors)
        : _file(file), _folder(folder), _errors(errors)
    {
    }

    SceneFile scene(xmlNode* root) const
    {
        SceneFile result;
        xmlNode* terrain = child(root, "terrain");
        if (xmlNode* database = child(terrain, "database")) result.database = path(database, "file");
        if (xmlNode* rasterNode = child(terrain, "rasters")) result.rasters = rasters(rasterNode);
        if (xmlNode* view = child(root, "homeView")) result.homeView = homeView(view);
        if (xmlNode* sunNode = child(root, "sun"))
            result.sun = SceneSun{place(sunNode), real(sunNode, "azimuth"), real(sunNode, "elevation"),
                                  colour(sunNode, "colour"), colour(sunNode, "ambient")};
        if (xmlNode* background = child(root, "background")) result.background = colour(background, "colour");
        if (xmlNode* effectsNode = child(root, "effects")) result.effects = effects(effectsNode);
        return result;
    }

private:
    static xmlNode* next(xmlNode* node, const char* name)
    {
        while (node && (node->type != XML_ELEMENT_NODE ||
                        std::strcmp(reinterpret_cast<const char*>(node->name), name) != 0))
            node = node->next;
        return node;
    }
    static xmlNode* child(xmlNode* parent, const char* name) { return next(parent->children, name); }

    static double real(xmlNode* node, const char* name) { return number<double>(attributeOf(node, name)); }
    static int integer(xmlNode* node, const char* name) { return number<int>(attributeOf(node, name)); }

    static SceneColour colour(xmlNode* node, const char* name)
    {
        const auto value = number<unsigned int>(attributeOf(node, name).substr(1), 16);
        return {(value >> 16) / 255.0, (value >> 8 & 255) / 255.0, (value & 255) / 255.0};
    }

    ScenePlace place(xmlNode* node) const
    {
        return {_file, static_cast<int>(xmlGetLineNo(node)), reinterpret_cast<const char*>(node->name)};
    }

    std::string joined(const std::string& path) const
    {
        return (fs::path(_folder) / path).lexically_normal().string();
    }

    ScenePath path(xmlNode* node, const char* attribute) const
    {
        const std::string text = attributeOf(node, attribute);
        const bool isAddress = text.find("://") != std::string::npos;
        return {isAddress ? text : joined(text), place(node), attribute};
    }

    std::vector<ScenePath> paths(xmlNode* parent, const char* name) const
    {
        std::vector<ScenePath> result;
        for (xmlNode* node = child(parent, name); node; node = next(node->next, name))
            result.push_back(path(node, "file"));
        return result;
    }

    SceneRasters rasters(xmlNode* node) const
    {
        SceneRasters result;
        result.place = place(node);
        result.dems = paths(node, "dem");
        result.imagery = paths(node, "imagery");
        if (xmlNode* landCover = child(node, "landCover"))
            result.landCover = SceneRasters::LandCover{path(landCover, "file"), path(landCover, "table")};
        const std::string cache = attributeOf(node, "cache"), srs = attributeOf(node, "srs");
        if (!cache.empty()) result.cache = joined(cache);
        if (srs != "geocentric") result.epsg = number<int>(srs.substr(std::strlen("EPSG:")));
        result.vertical = attributeOf(node, "vertical");
        result.tileSize = integer(node, "tileSize");
        result.textureSize = integer(node, "textureSize");
        result.pixelError = real(node, "pixelError");
        result.texelError = real(node, "texelError");
        result.memoryMiB = integer(node, "memory");
        return result;
    }

    static SceneView homeView(xmlNode* node)
    {
        SceneView view{real(node, "longitude"),
                       real(node, "latitude"),
                       real(node, "altitude"),
                       real(node, "heading"),
                       real(node, "pitch"),
                       real(node, "roll"),
                       std::nullopt};
        if (!attributeOf(node, "verticalFieldOfView").empty())
            view.verticalFieldOfView = real(node, "verticalFieldOfView");
        return view;
    }

    std::vector<osg::ref_ptr<Effect>> effects(xmlNode* parent) const
    {
        std::vector<osg::ref_ptr<Effect>> result;
        for (xmlNode* node = parent->children; node; node = node->next)
        {
            if (node->type != XML_ELEMENT_NODE) continue;
            result.push_back(createEffect(reinterpret_cast<const char*>(node->name)));
            set(*result.back(), node);
        }
        return result;
    }

    /// What the schema cannot say is found here: properties that do not fit each other.
    void set(PropertyHolder& object, xmlNode* node) const
    {
        PropertyHolder::Texts texts;
        for (const xmlAttr* attribute = node->properties; attribute; attribute = attribute->next)
        {
            if (attribute->ns) continue;
            const std::string name = reinterpret_cast<const char*>(attribute->name);
            const std::string value = attributeOf(node, name.c_str());
            texts.emplace_back(name, value.substr(value.rfind('+', 0) == 0 ? 1 : 0));
        }
        std::string error;
        const bool fits = object.setPropertyTexts(texts, error);
        if (!fits && _errors.size() < mostErrors) _errors.push_back(place(node).message(error));
        for (const PropertyHolder::Part& part : object.parts())
        {
            if (xmlNode* below = child(node, part.name)) set(*part.object, below);
        }
    }

    std::string _file, _folder;
    std::vector<std::string>& _errors;
};

/// What keeps a path from being read; empty if nothing does, or if it is not a file (GDAL's /vsi…, an
/// address).
std::string faultOf(const std::string& path)
{
    if (path.rfind("/vsi", 0) == 0 || path.find("://") != std::string::npos) return {};
    std::error_code code;
    const fs::file_status status = fs::status(path, code);
    if (status.type() == fs::file_type::not_found) return "does not exist";
    if (code) return "cannot be read (" + code.message() + ")";
    if (fs::is_directory(status)) return "is a folder";
    return {};
}

} // namespace

std::string ScenePlace::message(const std::string& text) const
{
    return file + ":" + std::to_string(line) + ": <" + element + ">: " + text;
}

SceneResult parseScene(const std::string& text, const std::string& file, const std::string& folder)
{
    SceneResult result;
    const XmlDocument document = readSceneXml(text, file, result.errors);
    if (document)
        result.scene = Reader(file, folder, result.errors).scene(xmlDocGetRootElement(document.get()));
    if (!result.errors.empty()) result.scene.reset();
    return result;
}

std::vector<std::string> missingFiles(const SceneFile& scene)
{
    std::vector<ScenePath> paths;
    if (scene.database) paths.push_back(*scene.database);
    if (scene.rasters)
    {
        paths = scene.rasters->dems;
        paths.insert(paths.end(), scene.rasters->imagery.begin(), scene.rasters->imagery.end());
        if (scene.rasters->landCover)
            paths.insert(paths.end(), {scene.rasters->landCover->file, scene.rasters->landCover->table});
    }
    std::vector<std::string> errors;
    for (const ScenePath& path : paths)
    {
        const std::string fault = faultOf(path.path);
        if (!fault.empty())
            errors.push_back(path.place.message(
                "the file \"" + path.path + "\" " + fault + "; correct the attribute \"" + path.attribute +
                "\" (a relative path starts in the folder of the scene file)."));
    }
    return errors;
}

} // namespace osgGeoFX
