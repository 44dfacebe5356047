// SPDX-License-Identifier: MIT
// SPDX-FileCopyrightText: 2026 the osgGeoFX authors
#include <osgGeoFX/viewer/EffectKinds.h>

#include <osgGeoFX/closeup/CloseUps.h>
#include <osgGeoFX/deformation/BirdsEyeView.h>
#include <osgGeoFX/deformation/BlendedView.h>
#include <osgGeoFX/deformation/PedestrianView.h>
#include <osgGeoFX/deformation/VerticalExaggeration.h>
#include <osgGeoFX/mapping/ProjectiveMappings.h>
#include <osgGeoFX/panorama/PanoramaMap.h>

#include <cctype>
#include <sstream>

namespace osgGeoFX
{

namespace
{

template<typename Class>
osg::ref_ptr<Effect> make()
{
    return new Class;
}

struct Kind
{
    const char* name;
    osg::ref_ptr<Effect> (*create)();
};

/// The one list of effects: scene files, options and tests go by it. A name is the class's with a small first letter.
constexpr Kind kinds[] = {
    {"birdsEyeView", make<BirdsEyeView>},
    {"pedestrianView", make<PedestrianView>},
    {"blendedView", make<BlendedView>},
    {"verticalExaggeration", make<VerticalExaggeration>},
    {"projectiveMappings", make<ProjectiveMappings>},
    {"closeUps", make<CloseUps>},
    {"panoramaMap", make<PanoramaMap>},
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
    for (const Kind& kind : kinds)
        names.emplace_back(kind.name);
    return names;
}

osg::ref_ptr<Effect> createEffect(const std::string& name)
{
    for (const Kind& kind : kinds)
    {
        if (name == kind.name) return kind.create();
    }
    return nullptr;
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
    if (mappings && mappings->getNumMappings() == 0)
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
