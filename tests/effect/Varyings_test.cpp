// SPDX-License-Identifier: MIT
// SPDX-FileCopyrightText: 2026 the osgGeoFX authors
//
// Whether effects declare exactly the varyings that their shader files have.
#include <apps/examples/Contours.h>
#include <apps/examples/Lean.h>
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

/// "flat vec3 place" of each line `flat out vec3 SLOT_place;`. `way` is "out" or "in".
Names namesIn(const std::string& file, const char* way)
{
    if (file.empty()) return {};
    const std::string text = osgGeoFX::ShaderLibrary().source(file);
    const std::regex declaration("(?:^|\\n)\\s*((?:\\w+\\s+)*)" + std::string(way) +
                                 "\\s+(\\w+)\\s+SLOT_(\\w+)\\s*;");
    Names names;
    for (std::sregex_iterator each(text.begin(), text.end(), declaration), end; each != end; ++each)
        names.insert((*each)[1].str() + (*each)[2].str() + " " + (*each)[3].str());
    return names;
}

template<typename Side>
void expectDeclared(const Side& side, std::size_t& count)
{
    SCOPED_TRACE(side.vertexFile());
    Names declared;
    for (const Varying& each : side.varyings())
        declared.insert((each.flat ? "flat " : "") + each.type + " " + each.name);
    EXPECT_EQ(declared.size(), side.varyings().size()) << "two have one name";
    EXPECT_EQ(declared, namesIn(side.vertexFile(), "out"));
    EXPECT_EQ(declared, namesIn(side.fragmentFile(), "in"));
    count += declared.size();
}

TEST(Varyings, AreThoseOfTheShaderFiles)
{
    std::vector<osg::ref_ptr<Effect>> effects = {new Contours, new Lean};
    for (const std::string& kind : osgGeoFX::effectKinds())
        effects.push_back(osgGeoFX::createEffect(kind));
    std::size_t count = 0;
    for (const osg::ref_ptr<Effect>& effect : effects)
    {
        SCOPED_TRACE(effect->className());
        if (const osgGeoFX::Deformation* side = effect->asDeformation()) expectDeclared(*side, count);
        const Effect& constant = *effect;
        if (const osgGeoFX::SurfaceEffect* side = constant.asSurfaceEffect()) expectDeclared(*side, count);
    }
    // Two of mappings, three of panorama maps and one of contour lines.
    EXPECT_GE(count, 6u);
}

} // namespace
