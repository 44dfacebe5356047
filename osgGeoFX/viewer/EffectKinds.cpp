// SPDX-License-Identifier: MIT
// SPDX-FileCopyrightText: 2026 the osgGeoFX authors
#include <osgGeoFX/viewer/EffectKinds.h>

#include <osgGeoFX/closeup/CloseUps.h>
#include <osgGeoFX/deformation/BirdsEyeView.h>
#include <osgGeoFX/deformation/BlendedView.h>
#include <osgGeoFX/deformation/PedestrianView.h>
#include <osgGeoFX/deformation/RegionalLiberty.h>
#include <osgGeoFX/deformation/VerticalExaggeration.h>
#include <osgGeoFX/ground/GroundDetail.h>
#include <osgGeoFX/light/SunShadows.h>
#include <osgGeoFX/mapping/LayerClock.h>
#include <osgGeoFX/mapping/ProjectiveMappings.h>
#include <osgGeoFX/mapping/RouteMapping.h>
#include <osgGeoFX/panorama/PanoramaMap.h>

#include <cctype>
#include <sstream>

namespace osgGeoFX
{

namespace
{

template<typename Base, typename Class>
osg::ref_ptr<Base> make()
{
    return new Class;
}

template<typename Base>
struct Kind
{
    const char* name;
    osg::ref_ptr<Base> (*create)();
    const char* description;
};

/// The one list of effects: scene files, options and tests go by it. A name is the class's with a small first letter.
constexpr Kind<Effect> effects[] = {
    {"birdsEyeView", make<Effect, BirdsEyeView>,
     "A map below and the skyline above it: behind a line of the image the ground bends down until the "
     "horizon lies "
     "where it is wanted."},
    {"pedestrianView", make<Effect, PedestrianView>,
     "The surroundings as they are, and the ground ahead folded up like a map."},
    {"blendedView", make<Effect, BlendedView>,
     "The bird's-eye view from high up, the pedestrian's view near the ground, and one bend between them on "
     "the way. "
     "Of the two views only what is their own counts: lines, distances, angles, reference planes and "
     "tallest."},
    {"verticalExaggeration", make<Effect, VerticalExaggeration>,
     "Heights drawn larger or smaller than they are."},
    {"regionalLiberty", make<Effect, RegionalLiberty>,
     "A liberty that painters of maps take with a region: a summit enlarged, a valley widened, a mountain "
     "turned; the "
     "ground around it stays as it is."},
    {"groundDetail", make<Effect, GroundDetail>,
     "The ground from nearby: grass, crowns of trees, rock, sand, gardens and waves below the resolution of "
     "its "
     "colors, and sharp borders between them."},
    {"sunShadows", make<Effect, SunShadows>,
     "The shadows of the sun on terrain and buildings, those of the undeformed world on bent ground, too."},
    {"projectiveMappings", make<Effect, ProjectiveMappings>,
     "Rasters thrown onto the terrain and what stands on it, thousands at once. They lie in a frame whose "
     "origin is "
     "on the terrain; where nothing says its origin, it lies in the terrain's center."},
    {"closeUps", make<Effect, CloseUps>,
     "Regions of the terrain, lifted out, scaled and restyled above it, and tied to their place by anchors."},
    {"panoramaMap", make<Effect, PanoramaMap>,
     "A panorama map in the manner of painted ones: the terrain from above at the base, up to a horizon; "
     "ground, water "
     "and sky in the colors of a painting. The camera tells place, heading and width."},
};

/// What mappings and close-ups are made of.
constexpr Kind<PropertyHolder> parts[] = {
    {"projectiveMapping", make<PropertyHolder, ProjectiveMapping>, "A raster on the terrain."},
    {"routeMapping", make<PropertyHolder, RouteMapping>,
     "A route on the terrain, with marks at its way points."},
    {"dataLayer", make<PropertyHolder, DataLayer>, "The raster that a mapping shows."},
    {"layerClock", make<PropertyHolder, LayerClock>, "The time of layers that change with it."},
    {"colorTransfer", make<PropertyHolder, ColorTransfer>,
     "How rasters become colors, and how these meet the scene's."},
    {"closeUp", make<PropertyHolder, CloseUp>, "A region of the ground, lifted out."},
    {"regionOfInterest", make<PropertyHolder, RegionOfInterest>,
     "What is lifted out: a place, a size and a shape. Corners make it a polygon, and an image makes it a "
     "mask."},
    {"anchor", make<PropertyHolder, Anchor>,
     "The fence between a region and its close-up. It is transparent by a table over the height."},
    {"surfaceData", make<PropertyHolder, SurfaceData>,
     "Several rasters of one part of the ground, by their names."},
};

std::string joined(const std::vector<std::string>& words)
{
    std::string text;
    for (const std::string& word : words)
        text += (text.empty() ? "" : ", ") + word;
    return text;
}

} // namespace

std::vector<std::string> effectKinds()
{
    std::vector<std::string> names;
    for (const Kind<Effect>& kind : effects)
        names.emplace_back(kind.name);
    return names;
}

osg::ref_ptr<Effect> createEffect(const std::string& name)
{
    for (const Kind<Effect>& kind : effects)
    {
        if (name == kind.name) return kind.create();
    }
    return nullptr;
}

std::vector<std::string> propertyHolderKinds()
{
    std::vector<std::string> names = effectKinds();
    for (const Kind<PropertyHolder>& kind : parts)
        names.emplace_back(kind.name);
    return names;
}

osg::ref_ptr<PropertyHolder> createPropertyHolder(const std::string& name)
{
    for (const Kind<PropertyHolder>& kind : parts)
    {
        if (name == kind.name) return kind.create();
    }
    return createEffect(name);
}

std::string describeKind(const std::string& name)
{
    for (const Kind<Effect>& kind : effects)
    {
        if (name == kind.name) return kind.description;
    }
    for (const Kind<PropertyHolder>& kind : parts)
    {
        if (name == kind.name) return kind.description;
    }
    return {};
}

std::string effectsHelp()
{
    std::string text;
    for (const Kind<Effect>& kind : effects)
    {
        text += std::string(text.empty() ? "" : "\n") + kind.name + ": " + kind.description + "\n";
        const osg::ref_ptr<Effect> effect = kind.create();
        for (const Property& property : effect->properties())
            text += "  " + property.name + "=" + property.text(property.defaultValue) + "  " +
                    property.documentation() + "\n";
        for (const PropertyHolder::Part& part : effect->parts())
            text += std::string("  ") + part.name + ".…  the properties of " + kindOf(*part.object) + "\n";
    }
    return text;
}

std::string kindOf(const osg::Object& object)
{
    std::string name = object.className();
    if (!name.empty()) name[0] = static_cast<char>(std::tolower(static_cast<unsigned char>(name[0])));
    return name;
}

std::string whyItDrawsNothing(const Effect& effect)
{
    const auto* closeUps = dynamic_cast<const CloseUps*>(&effect);
    if (closeUps && closeUps->getNumCloseUps() == 0)
        return "closeUps draws nothing, because it has no close-up; write it with a <closeUp> for each "
               "region into "
               "a .geofx scene, or call CloseUps::addCloseUp() in a program.";
    const auto* mappings = dynamic_cast<const ProjectiveMappings*>(&effect);
    if (mappings && mappings->getNumMappings() + mappings->getNumRoutes() == 0)
        return "projectiveMappings draws nothing, because it has no mapping; write it with a <raster> or "
               "<mapping> for "
               "each into a .geofx scene, or call ProjectiveMappings::addMapping() in a program.";
    return {};
}

osg::ref_ptr<Effect> parseEffect(const std::string& text, std::string& error)
{
    std::istringstream words(text);
    std::string word;
    words >> word;
    osg::ref_ptr<Effect> effect = createEffect(word);
    if (!effect)
    {
        error = "There is no effect \"" + word + "\"; there are " + joined(effectKinds()) + ".";
        return nullptr;
    }
    Effect::Texts texts;
    while (words >> word)
    {
        const std::size_t equals = word.find('=');
        if (equals == std::string::npos)
        {
            error = "\"" + word + "\" sets nothing; write property=value.";
            return nullptr;
        }
        texts.emplace_back(word.substr(0, equals), word.substr(equals + 1));
    }
    if (!effect->setPropertyTexts(texts, error)) return nullptr;
    error = whyItDrawsNothing(*effect);
    return error.empty() ? effect : nullptr;
}

} // namespace osgGeoFX
