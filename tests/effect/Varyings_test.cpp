// SPDX-License-Identifier: MIT
// SPDX-FileCopyrightText: 2026 the osgGeoFX authors
//
// Whether effects declare exactly the varyings that their shader files have.
#include <apps/examples/Contours.h>
#include <apps/examples/Lean.h>
#include <osgGeoFX/deformation/BirdsEyeView.h>
#include <osgGeoFX/effect/Deformation.h>
#include <osgGeoFX/effect/ShaderLibrary.h>
#include <osgGeoFX/effect/SurfaceEffect.h>
#include <osgGeoFX/viewer/EffectKinds.h>

#include <gtest/gtest.h>

#include <regex>
#include <set>
#include <string>
#include <vector>

namespace
{

using osgGeoFX::Effect;
using osgGeoFX::Varying;
using Names = std::set<std::string>;

/// "flat vec3 place" of each line `flat out vec3 SLOT_place;`. `way` is "out" or "in". What stands below `#ifdef SLOT_X` counts if the
/// effect's `constants` define it.
Names namesIn(const std::string& file, const char* way, const std::string& constants)
{
    if (file.empty()) return {};
    std::string text = osgGeoFX::ShaderLibrary().source(file);
    const std::regex condition("#ifdef (SLOT_\\w+)\n[^#]*#endif");
    std::smatch found;
    for (std::size_t from = 0;
         std::regex_search(text.cbegin() + static_cast<std::ptrdiff_t>(from), text.cend(), found, condition);)
    {
        const auto at = static_cast<std::size_t>(found.position()) + from;
        const bool defined = constants.find("#define " + found[1].str() + "\n") != std::string::npos;
        if (defined)
            from = at + 1;
        else
            text.erase(at, static_cast<std::size_t>(found.length()));
    }
    const std::regex declaration("(?:^|\\n)\\s*((?:\\w+\\s+)*)" + std::string(way) +
                                 "\\s+(\\w+)\\s+SLOT_(\\w+)\\s*;");
    Names names;
    for (std::sregex_iterator each(text.begin(), text.end(), declaration), end; each != end; ++each)
        names.insert((*each)[1].str() + (*each)[2].str() + " " + (*each)[3].str());
    return names;
}

template<typename Side>
void expectDeclared(const Side& side, std::size_t& count, const std::string& constants = {})
{
    SCOPED_TRACE(side.vertexFile());
    Names declared;
    for (const Varying& each : side.varyings())
        declared.insert((each.flat ? "flat " : "") + each.type + " " + each.name);
    EXPECT_EQ(declared.size(), side.varyings().size()) << "two have one name";
    EXPECT_EQ(declared, namesIn(side.vertexFile(), "out", constants));
    EXPECT_EQ(declared, namesIn(side.fragmentFile(), "in", constants));
    count += declared.size();
}

TEST(Varyings, AreThoseOfTheShaderFiles)
{
    std::vector<osg::ref_ptr<Effect>> effects = {new Contours, new Lean};
    for (const std::string& kind : osgGeoFX::effectKinds())
        effects.push_back(osgGeoFX::createEffect(kind));
    const osg::ref_ptr<osgGeoFX::BirdsEyeView> mapped = new osgGeoFX::BirdsEyeView;
    mapped->setCoverMap(true);
    effects.push_back(mapped);
    std::size_t count = 0;
    for (const osg::ref_ptr<Effect>& effect : effects)
    {
        SCOPED_TRACE(effect->className());
        if (const osgGeoFX::Deformation* side = effect->asDeformation())
            expectDeclared(*side, count, side->constants());
        const Effect& constant = *effect;
        if (const osgGeoFX::SurfaceEffect* side = constant.asSurfaceEffect()) expectDeclared(*side, count);
    }
    // Two of mappings, three of panorama maps and one of contour lines.
    EXPECT_GE(count, 6u);
}

} // namespace
