// SPDX-License-Identifier: MIT
// SPDX-FileCopyrightText: 2026 the osgGeoFX authors
#include "MapSaver.h"

#include "panorama/Recipe.h"
#include "panorama/RecipeLiberties.h"

#include <osgGeoFX/batch/WholeFile.h>
#include <osgGeoFX/panorama/PanoramaPose.h>
#include <osgGeoFX/viewer/EffectKinds.h>

#include <libxml/parser.h>
#include <libxml/tree.h>
#include <osg/Math>

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <filesystem>
#include <iostream>
#include <map>
#include <memory>
#include <set>
#include <system_error>

namespace geofx::viewer
{

namespace
{

namespace fs = std::filesystem;
using geofx::panorama::Failure;
using geofx::panorama::Recipe;
using osgGeoFX::Effect;
using osgGeoFX::PanoramaMap;
using osgGeoFX::Property;

struct DocumentCloser
{
    void operator()(xmlDoc* document) const { xmlFreeDoc(document); }
};
using Document = std::unique_ptr<xmlDoc, DocumentCloser>;

const xmlChar* xml(const std::string& text)
{
    return reinterpret_cast<const xmlChar*>(text.c_str());
}

void set(xmlNode* node, const char* name, const std::string& value)
{
    xmlSetProp(node, xml(name), xml(value));
}

/// Short, and exact to a millimetre on the ground; in any locale.
std::string number(double value)
{
    return Property::number("number", "", -1e300, 1e300).text(value);
}

xmlNode* childOf(xmlNode* parent, const std::string& name)
{
    for (xmlNode* node = parent->children; node; node = node->next)
        if (node->type == XML_ELEMENT_NODE && xmlStrEqual(node->name, xml(name))) return node;
    return xmlNewChild(parent, nullptr, xml(name), nullptr);
}

/// The element of the effect at an index; null if the file has fewer, since a program has added it.
xmlNode* effectNode(xmlNode* effects, unsigned int index)
{
    for (xmlNode* node = effects->children; node; node = node->next)
        if (node->type == XML_ELEMENT_NODE && index-- == 0) return node;
    return nullptr;
}

void setProperties(xmlNode* node, const osgGeoFX::PropertyHolder& effect)
{
    for (const Property& property : effect.properties())
    {
        const double value = property.get(effect);
        // What a file says already is said again, lest an old value stays.
        if (value != property.defaultValue || xmlHasProp(node, xml(property.name)))
            set(node, property.name.c_str(), property.text(value));
    }
}

/// The document of a scene file, or a new one that names a terrain.
Document documentOf(const std::string& file, const fs::path& folder)
{
    if (fs::path(file).extension() == ".geofx")
    {
        Document document(
            xmlReadFile(file.c_str(), nullptr,
                        XML_PARSE_NONET | XML_PARSE_NOBLANKS | XML_PARSE_NOERROR | XML_PARSE_NOWARNING));
        if (!document || !xmlDocGetRootElement(document.get()))
            throw Failure(file + ": cannot be read any more; no scene is saved.");
        return document;
    }
    Document document(xmlNewDoc(xml("1.0")));
    xmlNode* const root = xmlNewNode(nullptr, xml("geofx"));
    xmlDocSetRootElement(document.get(), root);
    set(root, "version", "1");
    xmlNode* const terrain = xmlNewChild(root, nullptr, xml("terrain"), nullptr);
    set(xmlNewChild(terrain, nullptr, xml("database"), nullptr), "file",
        fs::path(file).lexically_relative(folder).string());
    return document;
}

std::string freeName(const fs::path& folder, const std::string& stem)
{
    for (int i = 1;; ++i)
    {
        const std::string name = (folder / (stem + "-map" + (i > 1 ? "-" + std::to_string(i) : ""))).string();
        std::error_code ignored;
        if (!fs::exists(name + ".geofx", ignored) && !fs::exists(name + ".json", ignored)) return name;
    }
}

} // namespace

MapSaver::MapSaver(const osgGeoFX::Scene& scene, std::string file) : _scene(scene), _file(std::move(file))
{
    for (unsigned int i = 0; i < _scene.effects->getNumEffects(); ++i)
        _known.emplace_back(_scene.effects->getEffect(i));
}

void MapSaver::getUsage(osg::ApplicationUsage& usage) const
{
    usage.addKeyboardMouseBinding("F12", "Save the panorama map as a scene file and as a recipe");
}

std::optional<MapSaver::Pose> MapSaver::poseOf(PanoramaMap& map, const osg::Camera& camera) const
{
    osgGeoFX::PanoramaPose seen(*_scene.effects, map);
    seen.follow();
    seen.setProjection(camera.getProjectionMatrix());
    seen.setMatrix(camera.getInverseViewMatrix());
    Pose pose{};
    pose.heading = seen.heading();
    pose.radius = seen.radius();
    double aspect = 1.0, nearest = 1.0, farthest = 1.0, degrees = 0.0;
    if (camera.getProjectionMatrixAsPerspective(degrees, aspect, nearest, farthest))
        pose.fieldOfView = osg::DegreesToRadians(degrees);
    const osg::Vec3d eye = seen.matrix().getTrans();
    const bool known =
        _scene.reference && _scene.reference->toGeodetic(eye, pose.longitude, pose.latitude, pose.height);
    if (_scene.effects->ground().ellipsoid)
    {
        if (!known) return std::nullopt;
        pose.place.set(osg::RadiansToDegrees(pose.longitude), osg::RadiansToDegrees(pose.latitude));
    }
    else
        pose.place.set(eye.x(), eye.y());
    if (!known) pose.height = HUGE_VAL;
    // Up in the grid is not north everywhere.
    osg::Matrixd frame;
    pose.northHeading = pose.heading;
    if (known && !_scene.effects->ground().ellipsoid &&
        _scene.reference->localToWorld(pose.longitude, pose.latitude, pose.height, frame))
    {
        const osg::Vec3d north = osg::Matrixd::transform3x3(osg::Y_AXIS, frame);
        pose.northHeading -= std::atan2(north.x(), north.y());
    }
    return pose;
}

void MapSaver::writeRecipe(const PanoramaMap& map, const Pose& pose, const osg::Camera& camera,
                           const std::string& file) const
{
    Recipe recipe;
    recipe.terrain = _file;
    recipe.geocentric = _scene.effects->ground().ellipsoid.valid();
    if (const osg::Viewport* const viewport = camera.getViewport())
    {
        recipe.width = static_cast<int>(viewport->width());
        recipe.height = static_cast<int>(viewport->height());
    }
    if (map.getPalette()) recipe.palette = map.getPalette()->getFileName();
    recipe.view.place = pose.place;
    recipe.view.heading = pose.heading;
    recipe.view.viewRadius = pose.radius;
    recipe.view.horizonLine = map.getHorizonLine();
    recipe.view.curveDistance = map.getCurveDistance();
    recipe.view.horizontalAngle = map.getHorizontalAngle();
    recipe.view.horizonDistance = map.getHorizonDistance();
    recipe.view.horizonBend = map.getHorizonBend();
    recipe.view.exaggeration = map.getExaggeration();
    recipe.view.baseHeight = map.getBaseHeight();
    recipe.view.edgeWidth = map.getEdgeWidth();
    // The recipe's base is stated, so that it does not depend on which tiles are there.
    const auto& ground = _scene.effects->ground();
    if (map.getBaseFromTerrain() && ground.heightsKnown)
        recipe.view.baseHeight = std::max(recipe.view.baseHeight, ground.minHeight);
    static const std::set<std::string> ofView = {
        "enabled",      "viewRadius", "horizonLine", "curveDistance",   "horizonDistance", "horizonBend",
        "exaggeration", "baseHeight", "edgeWidth",   "baseFromTerrain", "horizontalAngle"};
    for (const Property& property : map.properties())
    {
        const double value = property.get(map);
        if (value != property.defaultValue && ofView.count(property.name) == 0)
            recipe.map[property.name] = property.text(value);
    }
    // An edge that is not chosen is the terrain's own.
    for (const Property& property : map.properties())
        if (property.name == "edge") recipe.map["edge"] = property.text(property.get(map));
    for (unsigned int i = 0; i < _scene.effects->getNumEffects() && _scene.effects->getEffect(i) != &map; ++i)
    {
        const auto* const liberty =
            dynamic_cast<const osgGeoFX::RegionalLiberty*>(_scene.effects->getEffect(i));
        if (liberty && liberty->isActive()) recipe.liberties.push_back(geofx::panorama::textsOf(*liberty));
    }
    recipe.write(file);
}

void MapSaver::writeScene(const PanoramaMap& map, const Pose& pose, const std::string& file) const
{
    if (fs::path(_file).extension() == ".earth")
        throw Failure("No scene file is saved, since scene files name no .earth files.");
    if (!std::isfinite(pose.height))
        throw Failure("No scene file is saved, since its home view needs longitude and latitude, and the "
                      "terrain does not tell them.");
    const fs::path folder = fs::path(file).parent_path();
    const Document document = documentOf(_file, folder);
    xmlNode* const root = xmlDocGetRootElement(document.get());
    xmlNode* const home = childOf(root, "homeView");
    const std::pair<const char*, double> values[] = {{"longitude", osg::RadiansToDegrees(pose.longitude)},
                                                     {"latitude", osg::RadiansToDegrees(pose.latitude)},
                                                     {"height", pose.height},
                                                     {"heading", osg::RadiansToDegrees(pose.northHeading)},
                                                     {"pitch", -35.0}};
    for (const auto& [name, value] : values)
        set(home, name, number(value));
    if (pose.fieldOfView > 0.0)
        set(home, "verticalFieldOfView", number(osg::RadiansToDegrees(pose.fieldOfView)));
    xmlUnsetProp(home, xml("roll"));
    xmlNode* const effects = childOf(root, "effects");
    // Liberties may come before effects of the file, which keep their elements. Those of effects that are gone go, too.
    std::map<const Effect*, xmlNode*> nodes;
    xmlNode* next = effectNode(effects, 0);
    for (const osg::ref_ptr<Effect>& known : _known)
    {
        if (!next || !xmlStrEqual(next->name, xml(osgGeoFX::kindOf(*known)))) continue;
        nodes[known] = next;
        next = xmlNextElementSibling(next);
    }
    for (const auto& [effect, node] : nodes)
        xmlUnlinkNode(node);
    for (unsigned int i = 0; i < _scene.effects->getNumEffects(); ++i)
    {
        const Effect& effect = *_scene.effects->getEffect(i);
        const auto known = nodes.find(&effect);
        xmlNode* node = known != nodes.end() ? xmlAddChild(effects, known->second) : nullptr;
        if (node)
            nodes.erase(known);
        else
        {
            // A program's own effects have children that a file of another scene cannot name.
            if (&effect != &map && !effect.getEnabled()) continue;
            node = xmlNewChild(effects, nullptr, xml(osgGeoFX::kindOf(effect)), nullptr);
        }
        setProperties(node, effect);
    }
    for (const auto& [effect, node] : nodes)
        xmlFreeNode(node);
    xmlChar* text = nullptr;
    int size = 0;
    xmlDocDumpFormatMemoryEnc(document.get(), &text, &size, "UTF-8", 1);
    const bool written = text && osgGeoFX::writeWholeFile(file, reinterpret_cast<const char*>(text),
                                                          static_cast<std::size_t>(size)) == 0;
    xmlFree(text);
    if (!written)
        throw Failure(file + ": cannot be written; check the folder, its permissions and the disk's space.");
}

std::string MapSaver::save(osgViewer::View& view) const
{
    PanoramaMap* map = nullptr;
    for (unsigned int i = 0; i < _scene.effects->getNumEffects() && !map; ++i)
    {
        auto* const each = dynamic_cast<PanoramaMap*>(_scene.effects->getEffect(i));
        if (each && each->getEnabled()) map = each;
    }
    if (!map) return "No panorama map is shown, so none is saved; F11 makes one.";
    const std::optional<Pose> pose = poseOf(*map, *view.getCamera());
    if (!pose) return "The place of the view is not known on the terrain, so no panorama map is saved.";
    const fs::path source(_file);
    const fs::path folder = source.parent_path().empty() ? fs::path(".") : source.parent_path();
    const std::string name = freeName(folder, source.stem().string());
    std::string said;
    const auto attempt = [&](const std::string& file, const auto& write)
    {
        try
        {
            write(file);
            said += (said.empty() ? "Saved " : " Saved ") + file + ".";
        }
        catch (const Failure& failure)
        {
            said += (said.empty() ? "" : " ") + std::string(failure.what());
        }
    };
    attempt(name + ".geofx", [&](const std::string& file) { writeScene(*map, *pose, file); });
    attempt(name + ".json",
            [&](const std::string& file) { writeRecipe(*map, *pose, *view.getCamera(), file); });
    return said;
}

bool MapSaver::handle(const osgGA::GUIEventAdapter& event, osgGA::GUIActionAdapter& action)
{
    auto* const view = dynamic_cast<osgViewer::View*>(&action);
    if (event.getEventType() != osgGA::GUIEventAdapter::KEYDOWN ||
        event.getKey() != osgGA::GUIEventAdapter::KEY_F12 || !view)
        return false;
    std::cout << save(*view) << std::endl;
    return true;
}

} // namespace geofx::viewer
