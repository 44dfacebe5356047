// SPDX-License-Identifier: MIT
// SPDX-FileCopyrightText: 2026 the osgGeoFX authors
#include "SceneNode.h"

#include "CloseUpsLoader.h"
#include "MapLoader.h"
#include "MappingsLoader.h"
#include "PanoramasLoader.h"

#include <osgGeoFX/light/SunLight.h>
#include <osgGeoFX/paging/Georeference.h>
#include <osgGeoFX/paging/TerrainInfo.h>
#include <osgGeoFX/scene/EffectScene.h>
#include <osgGeoFX/viewer/EarthSky.h>

#include <osg/Fog>
#include <osg/LightModel>
#include <osg/LightSource>
#include <osg/Math>
#include <osg/ValueObject>

#include <charconv>
#include <cmath>

namespace osgGeoFX
{

namespace
{

/// The shortest texts that give the same numbers again, in every locale.
template<typename Numbers>
std::string joined(const Numbers& numbers)
{
    std::string text;
    for (const double value : numbers)
    {
        char buffer[32];
        const auto end = std::to_chars(std::begin(buffer), std::end(buffer), value).ptr;
        text += (text.empty() ? "" : ",") + std::string(buffer, end);
    }
    return text;
}

/// Longitude and latitude (radians) of the place from which a scene's sun is seen. False, with the reason in
/// `error`.
bool sunPlace(const SceneFile& scene, const osg::Node& terrain, const Georeference& reference,
              double& longitude, double& latitude, std::string& error)
{
    if (scene.homeView)
    {
        longitude = osg::DegreesToRadians(scene.homeView->longitude);
        latitude = osg::DegreesToRadians(scene.homeView->latitude);
        return true;
    }
    const std::optional<TerrainInfo> info = TerrainInfo::read(&terrain, error);
    if (!error.empty()) return false;
    osg::Vec3d center = terrain.getBound().center();
    if (info)
    {
        center.set((info->west + info->east) / 2.0, (info->south + info->north) / 2.0, 0.0);
        if (info->geocentric)
        {
            longitude = osg::DegreesToRadians(center.x());
            latitude = osg::DegreesToRadians(center.y());
            return true;
        }
    }
    double height = 0.0;
    if (reference.toGeodetic(center, longitude, latitude, height)) return true;
    error = "The terrain's center has no longitude and latitude; give the scene a <homeView>.";
    return false;
}

osg::Vec4 opaque(const SceneColor& color)
{
    return osg::Vec4(osg::Vec3d(color[0], color[1], color[2]), 1.0);
}

/// A light that stays where the scene says.
osg::ref_ptr<osg::LightSource> fixedSun(const SceneSun& sun, const osg::Matrixd& frame)
{
    const double azimuth = osg::DegreesToRadians(sun.azimuth),
                 elevation = osg::DegreesToRadians(sun.elevation);
    const osg::Vec3d local(std::sin(azimuth) * std::cos(elevation), std::cos(azimuth) * std::cos(elevation),
                           std::sin(elevation));
    osg::ref_ptr<osg::Light> light = new osg::Light(0);
    light->setPosition(osg::Vec4d(osg::Matrixd::transform3x3(local, frame), 0.0));
    light->setDiffuse(opaque(sun.color));
    light->setSpecular(opaque(sun.color));
    light->setAmbient(opaque(sun.ambient));
    osg::ref_ptr<osg::LightSource> source = new osg::LightSource;
    source->setLight(light);
    return source;
}

/// False, with the reason in `error`, if it is unknown from where the sun is seen.
bool addSun(const SceneFile& scene, const osg::Node& terrain, osg::Group& group, std::string& error)
{
    const SceneSun& sun = *scene.sun;
    const osg::ref_ptr<Georeference> reference = Georeference::create(&terrain, error);
    double longitude = 0.0, latitude = 0.0;
    if (!reference || !sunPlace(scene, terrain, *reference, longitude, latitude, error)) return false;
    osg::Matrixd frame;
    if (!reference->localToWorld(longitude, latitude, 0.0, frame))
    {
        error = "The home view lies outside the terrain's projection; correct its longitude and latitude.";
        return false;
    }
    osg::ref_ptr<osg::LightSource> source;
    if (sun.time)
    {
        const osg::ref_ptr<SunLight> light = new SunLight;
        light->setPlace(longitude, latitude, frame);
        light->setTime(*sun.time);
        light->setColor(opaque(sun.color));
        light->setAmbient(opaque(sun.ambient));
        source = light;
    }
    else
    {
        source = fixedSun(sun, frame);
    }
    // A viewer puts its headlight, number 0, into the list of lights before the scene's: ours comes later and
    // wins.
    source->setName("sun");
    group.addChild(source);

    osg::StateSet* state = group.getOrCreateStateSet();
    state->setMode(GL_LIGHTING, osg::StateAttribute::ON);
    state->setAssociatedModes(source->getLight(), osg::StateAttribute::ON);
    // OSG adds an ambient light of its own, 0.1; the scene's says all.
    osg::ref_ptr<osg::LightModel> model = new osg::LightModel;
    model->setAmbientIntensity(osg::Vec4(0.0f, 0.0f, 0.0f, 1.0f));
    state->setAttributeAndModes(model);
    return true;
}

/// Fog of OpenGL, which any program draws.
void addHaze(const SceneBackground& background, osg::Group& group)
{
    const osg::ref_ptr<osg::Fog> haze = new osg::Fog;
    haze->setMode(osg::Fog::EXP);
    haze->setDensity(static_cast<float>(hazeDensity(*background.visibility)));
    haze->setColor(opaque(background.color));
    group.getOrCreateStateSet()->setAttributeAndModes(haze);
}

/// A group of a sky and the node. Null, with a sentence in `error`, if there is no round Earth.
osg::ref_ptr<osg::Group> withSky(const SceneBackground& background, osg::Node& terrain, EffectScene& effects,
                                 osg::Group& node, std::string& error)
{
    const osg::ref_ptr<Georeference> reference = Georeference::create(&terrain, error);
    if (!reference || !reference->isGeocentric())
    {
        error = background.place.message("the terrain is no round Earth to put a sky around; expected: no "
                                         "sky, or a terrain that is geocentric.");
        return nullptr;
    }
    const SceneColor& air = background.color;
    osg::ref_ptr<osg::Group> both = new osg::Group;
    const osg::Vec3d color(air[0], air[1], air[2]);
    both->addChild(makeEarthSky(osg::EllipsoidModel(), osg::Vec3(color),
                                background.visibility.value_or(DEFAULT_VISIBILITY), &effects));
    both->addChild(&node);
    return both;
}

} // namespace

bool addEffects(const SceneFile& scene, EffectScene& node, const osg::Node& terrain, std::string& error)
{
    node.setGround(scene.ground);
    for (const osg::ref_ptr<Effect>& effect : scene.effects)
        node.addEffect(effect);
    if (!scene.presets.empty()) EffectPreset::write(node, scene.presets);
    try
    {
        SceneTerrain ground(node, terrain, scene.anywhere);
        loadMappings(scene, ground, node);
        loadCloseUps(scene, ground);
        loadPanoramas(scene, ground);
        return true;
    }
    catch (const SceneFailure& failure)
    {
        error = failure.sentence;
        return false;
    }
}

namespace
{

void tellPrograms(const SceneFile& scene, osg::Group& group)
{
    group.setName("osgGeoFX scene");
    if (scene.homeView)
    {
        const SceneView& view = *scene.homeView;
        group.setUserValue("geofx.homeView",
                           joined(std::array<double, 6>{view.longitude, view.latitude, view.height,
                                                        view.heading, view.pitch, view.roll}));
        if (view.verticalFieldOfView) group.setUserValue("geofx.homeFov", *view.verticalFieldOfView);
    }
    if (scene.background) group.setUserValue("geofx.background", joined(scene.background->color));
    if (scene.sun) group.setUserValue("geofx.hasLight", true);
    if (scene.background && scene.background->visibility)
        group.setUserValue("geofx.visibility", *scene.background->visibility);
    if (scene.background && scene.background->sky) group.setUserValue("geofx.hasSky", true);
}

/// A group of the scene and its names, or the scene if it has none. Null, with a sentence in `error`, where something is missing.
osg::ref_ptr<osg::Group> withMap(const SceneMap& map, EffectScene& scene, std::string& error)
{
    try
    {
        const osg::ref_ptr<osg::Node> names = loadMap(map, scene);
        if (!names) return &scene;
        osg::ref_ptr<osg::Group> both = new osg::Group;
        both->addChild(&scene);
        both->addChild(names);
        return both;
    }
    catch (const SceneFailure& failure)
    {
        error = failure.sentence;
        return nullptr;
    }
}

} // namespace

osg::ref_ptr<osg::Group> createSceneNode(const SceneFile& scene, osg::Node* terrain, std::string& error)
{
    osg::ref_ptr<osg::Group> group;
    osg::ref_ptr<EffectScene> effects;
    const bool sky = scene.background && scene.background->sky;
    // Names and a sky stand beside an EffectScene, so that effects which a program adds leave them alone.
    if (scene.effects.empty() && !scene.map && !sky)
    {
        group = new osg::Group;
    }
    else
    {
        effects = new EffectScene;
        group = effects;
    }
    group->addChild(terrain);
    if (effects && !addEffects(scene, *effects, *terrain, error)) return nullptr;
    if (scene.sun && !addSun(scene, *terrain, *group, error))
    {
        error = scene.sun->place.message(error);
        return nullptr;
    }
    if (scene.background && scene.background->visibility) addHaze(*scene.background, *group);
    if (scene.map) group = withMap(*scene.map, *effects, error);
    if (group && sky) group = withSky(*scene.background, *terrain, *effects, *group, error);
    if (group) tellPrograms(scene, *group);
    return group;
}

} // namespace osgGeoFX
