// SPDX-License-Identifier: MIT
// SPDX-FileCopyrightText: 2026 the osgGeoFX authors
#include "panorama/RecipeLiberties.h"

#include <osgGeoFX/viewer/Liberties.h>
#include <osgGeoFX/viewer/ViewPoint.h>

namespace geofx::panorama
{

using osgGeoFX::PanoramaLiberty;
using osgGeoFX::RegionalLiberty;

namespace
{

/// 0 for none.
double strengthOf(const std::string& text)
{
    if (text.empty()) return 0.0;
    const auto numbers = osgGeoFX::parseNumbers(text);
    if (!numbers || numbers->size() != 1 || !(numbers->front() >= 0.0 && numbers->front() <= 1.0))
        throw Failure("--liberties=" + text + ": write a strength from 0 to 1, such as --liberties=0.5.");
    return numbers->front();
}

osg::ref_ptr<RegionalLiberty> parsed(const std::string& text, bool geocentric)
{
    std::string error;
    osg::ref_ptr<RegionalLiberty> liberty = osgGeoFX::parseLiberty(text, geocentric, error);
    if (!liberty) throw Failure("--liberty: " + error);
    return liberty;
}

} // namespace

std::map<std::string, std::string> textsOf(const RegionalLiberty& liberty)
{
    std::map<std::string, std::string> texts;
    for (const osgGeoFX::Property& property : liberty.properties())
    {
        const double value = property.get(liberty);
        if (value != property.defaultValue) texts[property.name] = property.text(value);
    }
    return texts;
}

void checkLiberties(const std::string& strength, const std::vector<std::string>& own)
{
    strengthOf(strength);
    // Any numbers are a place on a plane.
    for (const std::string& text : own)
        parsed(text, false);
}

void takeOwnLiberties(const std::vector<std::string>& own, Recipe& recipe)
{
    for (const std::string& text : own)
    {
        recipe.liberties.push_back(textsOf(*parsed(text, recipe.geocentric)));
        recipe.reasons.push_back("A liberty of your own: " + text + ".");
    }
}

void takeLiberties(const std::string& strength, const std::vector<std::string>& own,
                   const osgGeoFX::PanoramaComposer& composer, Recipe& recipe)
{
    std::vector<PanoramaLiberty> all;
    const double wanted = strengthOf(strength);
    if (wanted > 0.0) all = composer.liberties(recipe.view, wanted);
    for (const PanoramaLiberty& liberty : all)
    {
        recipe.liberties.push_back(textsOf(*osgGeoFX::makeLiberty(liberty, recipe.geocentric)));
        recipe.reasons.push_back(liberty.why);
    }
    if (wanted > 0.0 && all.empty())
        recipe.reasons.emplace_back("Liberties: none, since nothing in the picture asks for one.");
    if (own.empty()) return;
    takeOwnLiberties(own, recipe);
    const double before = composer.judge(recipe.view).cut;
    for (const std::string& text : own)
        all.push_back(osgGeoFX::libertyOf(*parsed(text, recipe.geocentric), recipe.geocentric));
    if (composer.judge(recipe.view, all).cut > before)
        recipe.reasons.emplace_back("With your liberties summits go beyond the picture's upper edge; enlarge "
                                    "less, or lower the exaggeration.");
}

void addLiberties(const Recipe& recipe, osgGeoFX::EffectScene& scene)
{
    for (const auto& texts : recipe.liberties)
    {
        const osg::ref_ptr<RegionalLiberty> liberty = new RegionalLiberty;
        std::string error;
        if (!liberty->setPropertyTexts({texts.begin(), texts.end()}, error))
            throw Failure("The recipe's liberties: " + error);
        scene.addEffect(liberty);
    }
}

} // namespace geofx::panorama
