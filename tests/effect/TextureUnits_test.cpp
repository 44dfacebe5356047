// SPDX-License-Identifier: MIT
// SPDX-FileCopyrightText: 2026 the osgGeoFX authors
// Which texture units a scene gives to its effects; MappingLife_gltest and GlObjects_gltest have pictures of it.
#include <osgGeoFX/closeup/CloseUps.h>
#include <osgGeoFX/deformation/BirdsEyeView.h>
#include <osgGeoFX/effect/TextureUnits.h>
#include <osgGeoFX/mapping/ProjectiveMappings.h>
#include <osgGeoFX/panorama/PanoramaMap.h>
#include <osgGeoFX/scene/EffectScene.h>
#include <tools/NotifyWatch.h>
#include <tools/RandomSamples.h>

#include <gtest/gtest.h>

#include <algorithm>
#include <set>

using namespace osgGeoFX;
using geofx::test::Random;
using geofx::test::sampleCount;

namespace
{

using Effects = TextureUnits::Effects;
using Units = TextureUnits::Units;

std::vector<TextureUnitWish> wishesOf(const Effect& effect)
{
    const auto* user = dynamic_cast<const TextureUser*>(&effect);
    return user ? user->textureUnits() : std::vector<TextureUnitWish>();
}

/// Each effect with its passes alone may be drawn at one time, and all that is everywhere with it.
void expectNoUnitTwice(const Effects& effects, const TextureUnits& given)
{
    for (std::size_t drawn = 0; drawn < effects.size(); ++drawn)
    {
        std::multiset<int> taken;
        std::set<int> ofTerrain;
        for (std::size_t i = 0; i < effects.size(); ++i)
        {
            const std::vector<TextureUnitWish> wishes = wishesOf(*effects[i]);
            ASSERT_EQ(given.ofEffects[i].size(), wishes.size());
            for (std::size_t j = 0; j < wishes.size(); ++j)
            {
                const int unit = given.ofEffects[i][j];
                if (wishes[j].ofTerrain)
                    ofTerrain.insert(unit);
                else if ((wishes[j].everywhere || i == drawn) && given.complete[i])
                    taken.insert(unit);
            }
        }
        for (const int unit : taken)
        {
            EXPECT_EQ(taken.count(unit), 1u) << unit;
            EXPECT_EQ(ofTerrain.count(unit), 0u) << unit;
            EXPECT_GE(unit, 4);
            EXPECT_LE(unit, 31);
        }
    }
}

} // namespace

TEST(TextureUnits, OneOfEachHasThoseThatItPrefers)
{
    const Effects effects = {new BirdsEyeView, new ProjectiveMappings, new PanoramaMap, new CloseUps};
    const TextureUnits given = TextureUnits::of(effects);
    EXPECT_EQ(given.ofEffects, (std::vector<Units>{{}, {8, 9, 10}, {4, 5, 6, 14, 15, 7}, {11, 12, 13}}));
    EXPECT_TRUE(given.sentences.empty());
}

TEST(TextureUnits, WhatWasSetComesFirst)
{
    const osg::ref_ptr<ProjectiveMappings> first = new ProjectiveMappings;
    const osg::ref_ptr<ProjectiveMappings> second = new ProjectiveMappings;
    const osg::ref_ptr<CloseUps> closeUps = new CloseUps;
    const Effects effects = {closeUps, first, second};
    EXPECT_EQ(TextureUnits::of(effects).ofEffects, (std::vector<Units>{{11, 12, 13}, {8, 9, 10}, {4, 5, 6}}));
    second->setUnits(9, 12, -1);
    const TextureUnits given = TextureUnits::of(effects);
    EXPECT_EQ(given.ofEffects, (std::vector<Units>{{11, 4, 13}, {8, 5, 10}, {9, 12, 6}}));
    EXPECT_TRUE(given.sentences.empty());
}

TEST(TextureUnits, OfTheTerrainAreNoOnesElse)
{
    const osg::ref_ptr<ProjectiveMappings> mappings = new ProjectiveMappings;
    mappings->setUnits(7, 14, 15);
    EXPECT_EQ(TextureUnits::of({mappings}).ofEffects[0], (Units{7, 14, 15})) << "without a panorama map";
    const Effects effects = {mappings, new PanoramaMap};
    const TextureUnits given = TextureUnits::of(effects);
    EXPECT_EQ(given.ofEffects, (std::vector<Units>{{8, 14, 15}, {4, 5, 6, 9, 10, 7}}));
    ASSERT_EQ(given.sentences.size(), 1u);
    EXPECT_EQ(given.sentences[0],
              "ProjectiveMappings (effect 1 of the scene) cannot have texture unit 7 as its dataUnit, for "
              "PanoramaMap (effect 2 of the scene) has it; the scene gives it another one. Set one that is "
              "free, or -1 for the scene's choice.");
}

TEST(TextureUnits, ThoseBelowTheLowestBelongToTheApplication)
{
    const osg::ref_ptr<PanoramaMap> map = new PanoramaMap;
    const Effects effects = {new ProjectiveMappings, map};
    EXPECT_EQ(TextureUnits::of(effects, 16).ofEffects,
              (std::vector<Units>{{16, 17, 18}, {19, 20, 21, 22, 23, 7}}));
    EXPECT_EQ(TextureUnits::of(effects, 6).ofEffects,
              (std::vector<Units>{{8, 9, 10}, {6, 11, 12, 14, 15, 7}}));
    const Effects many(4, new CloseUps);
    const TextureUnits few = TextureUnits::of(many, 30);
    EXPECT_FALSE(few.complete[0]);
    ASSERT_FALSE(few.sentences.empty());
    EXPECT_NE(few.sentences[0].find("all texture units from 30 to 31"), std::string::npos);
}

TEST(TextureUnits, AScenesLowestIsOneThatItMayChoose)
{
    const osg::ref_ptr<EffectScene> scene = new EffectScene;
    EXPECT_EQ(scene->getFirstTextureUnit(), 4);
    EXPECT_TRUE(scene->setFirstTextureUnit(31));
    for (const int unit : {3, 32, -1})
    {
        geofx::test::NotifyWatch watch;
        const auto messages = watch.messagesOf([&] { EXPECT_FALSE(scene->setFirstTextureUnit(unit)); });
        ASSERT_EQ(messages.size(), 1u);
        EXPECT_NE(messages[0].find("cannot be the first texture unit"), std::string::npos);
    }
    EXPECT_EQ(scene->getFirstTextureUnit(), 31);
    const osg::ref_ptr<EffectScene> copy = new EffectScene(*scene);
    EXPECT_EQ(copy->getFirstTextureUnit(), 31);
}

TEST(TextureUnits, AnEngineGivesThemOneByOne)
{
    const Effects effects = {new ProjectiveMappings, new CloseUps};
    // Preferred ones first; close-ups draw in passes, and may not have what mappings have everywhere.
    EXPECT_EQ(TextureUnits::of(effects, Units{5, 9, 12, 17, 20, 23}).ofEffects,
              (std::vector<Units>{{5, 9, 12}, {17, 20, 23}}));
    const TextureUnits few = TextureUnits::of(effects, Units{5, 7, 9, 12});
    EXPECT_TRUE(few.complete[0]);
    EXPECT_FALSE(few.complete[1]);
    ASSERT_FALSE(few.sentences.empty());
    EXPECT_NE(few.sentences[0].find("all texture units from 5 to 12 that the scene may choose"),
              std::string::npos)
        << few.sentences[0];

    const osg::ref_ptr<EffectScene> scene = new EffectScene;
    EXPECT_TRUE(scene->getTextureUnits().empty());
    EXPECT_TRUE(scene->setTextureUnits({12, 5, 31}));
    for (const std::vector<int>& wrong : {std::vector<int>{3}, {32}, {8, 8}})
    {
        geofx::test::NotifyWatch watch;
        const auto messages = watch.messagesOf([&] { EXPECT_FALSE(scene->setTextureUnits(wrong)); });
        ASSERT_EQ(messages.size(), 1u);
        EXPECT_NE(messages[0].find("each named once"), std::string::npos);
    }
    EXPECT_EQ(scene->getTextureUnits(), (std::vector<int>{5, 12, 31}));
    const osg::ref_ptr<EffectScene> copy = new EffectScene(*scene);
    EXPECT_EQ(copy->getTextureUnits(), scene->getTextureUnits());
}

TEST(TextureUnits, EachUniformBlockHasABindingOfItsOwn)
{
    const osg::ref_ptr<CloseUps> first = new CloseUps;
    const osg::ref_ptr<CloseUps> second = new CloseUps;
    const Effects effects = {new BirdsEyeView, first, second};
    EXPECT_EQ(TextureUnits::of(effects).ofBlocks, (std::vector<Units>{{}, {7}, {8}}));
    EXPECT_EQ(TextureUnits::of(effects, 4, 20).ofBlocks, (std::vector<Units>{{}, {20}, {21}}));
    EXPECT_EQ(TextureUnits::of(effects, 4, 0).ofBlocks, (std::vector<Units>{{}, {7}, {0}}));
    // What a property names stays, also below the first that the scene may choose.
    second->setBlockBinding(7);
    EXPECT_EQ(TextureUnits::of(effects).ofBlocks, (std::vector<Units>{{}, {8}, {7}}));
    EXPECT_EQ(TextureUnits::of(effects, 4, 20).ofBlocks, (std::vector<Units>{{}, {20}, {7}}));
    EXPECT_TRUE(TextureUnits::of(effects).sentences.empty());
    first->setBlockBinding(7);
    const TextureUnits both = TextureUnits::of(effects);
    EXPECT_EQ(both.ofBlocks, (std::vector<Units>{{}, {7}, {8}}));
    ASSERT_EQ(both.sentences.size(), 1u);
    EXPECT_EQ(
        both.sentences[0],
        "CloseUps (effect 3 of the scene) cannot have uniform block binding 7 as its blockBinding, for "
        "CloseUps "
        "(effect 2 of the scene) has it; the scene gives it another one. Set one that is free, or -1 for the "
        "scene's choice.");
    second->setBlockBinding(-1);
    const TextureUnits few = TextureUnits::of(Effects{new CloseUps, new CloseUps}, 4, 35);
    EXPECT_EQ(few.complete, (std::vector<bool>{true, false}));
    ASSERT_EQ(few.sentences.size(), 1u);
    EXPECT_NE(few.sentences[0].find("all uniform block bindings from 35 to 35"), std::string::npos);
}

TEST(TextureUnits, AScenesFirstBindingIsOneThatEveryGpuHas)
{
    const osg::ref_ptr<EffectScene> scene = new EffectScene;
    EXPECT_EQ(scene->getFirstBlockBinding(), 7);
    EXPECT_TRUE(scene->setFirstBlockBinding(0));
    for (const int binding : {-1, 36})
    {
        geofx::test::NotifyWatch watch;
        const auto messages = watch.messagesOf([&] { EXPECT_FALSE(scene->setFirstBlockBinding(binding)); });
        ASSERT_EQ(messages.size(), 1u);
        EXPECT_NE(messages[0].find("cannot be the first uniform block binding"), std::string::npos);
    }
    EXPECT_EQ(scene->getFirstBlockBinding(), 0);
    const osg::ref_ptr<EffectScene> copy = new EffectScene(*scene);
    EXPECT_EQ(copy->getFirstBlockBinding(), 0);
}

TEST(TextureUnits, CloseUpsAreDrawnOneAfterTheOther)
{
    const Effects effects = {new CloseUps, new CloseUps};
    EXPECT_EQ(TextureUnits::of(effects).ofEffects, (std::vector<Units>{{11, 12, 13}, {11, 12, 13}}));
}

TEST(TextureUnits, WhoGetsNoneIsToldAndIsNotDrawn)
{
    Effects effects;
    for (int i = 0; i < 10; ++i)
        effects.push_back(new ProjectiveMappings);
    effects[0]->setEnabled(false);
    const TextureUnits given = TextureUnits::of(effects);
    expectNoUnitTwice(effects, given);
    EXPECT_FALSE(given.complete[0]) << "what is switched off comes last";
    EXPECT_EQ(std::count(given.complete.begin(), given.complete.end(), false), 1);
    EXPECT_TRUE(given.sentences.empty()) << "and is not drawn anyway";
    effects[0]->setEnabled(true);
    const TextureUnits all = TextureUnits::of(effects);
    EXPECT_FALSE(all.complete[9]);
    ASSERT_EQ(all.sentences.size(), 1u);
    EXPECT_EQ(all.sentences[0],
              "ProjectiveMappings (effect 10 of the scene) is not drawn: the other effects "
              "have all texture units from 4 to 31 that the scene may choose. Remove effects, or "
              "put the mappings of several sets into one.");
}

TEST(TextureUnits, WhatEffectsCanDoWithoutComesLast)
{
    Effects effects;
    for (int i = 0; i < 9; ++i)
    {
        const osg::ref_ptr<ProjectiveMappings> mappings = new ProjectiveMappings;
        mappings->setCaching(ProjectiveMappings::AUTOMATIC);
        effects.push_back(mappings);
        const TextureUnits given = TextureUnits::of(effects);
        EXPECT_EQ(std::count(given.complete.begin(), given.complete.end(), false), 0) << i;
        EXPECT_TRUE(given.sentences.empty()) << i;
        std::set<int> taken;
        for (std::size_t k = 0; k < effects.size(); ++k)
        {
            const Units& units = given.ofEffects[k];
            ASSERT_EQ(units.size(), 5u);
            for (std::size_t j = 0; j < 5; ++j)
            {
                EXPECT_TRUE(units[j] >= 4 || j >= 3) << i;
                EXPECT_TRUE(units[j] < 0 || taken.insert(units[j]).second) << i;
            }
        }
        // Of 27 units, those that are left go to pages.
        EXPECT_EQ(taken.size(), std::min(std::size_t{27}, 5 * effects.size())) << i;
    }
}

TEST(TextureUnits, AnyEffectsWithAnyUnits)
{
    for (int i = 0; i < sampleCount() / 10; ++i)
    {
        SCOPED_TRACE(i);
        Random random(static_cast<std::uint64_t>(i));
        Effects effects;
        std::string error;
        for (int count = random.integer(1, 4); count > 0; --count)
        {
            const int kind = random.integer(0, 3);
            const auto unit = [&]
            {
                return random.integer(0, 2) == 0 ? random.integer(4, 31) : -1;
            };
            osg::ref_ptr<Effect> effect;
            if (kind == 0)
                effect = new CloseUps;
            else if (kind == 1)
                effect = new PanoramaMap;
            else
                effect = new ProjectiveMappings;
            for (const TextureUnitWish& wish : wishesOf(*effect))
            {
                if (!wish.ofTerrain || random.integer(0, 4) == 0)
                    effect->setProperty(wish.property, unit(), error);
            }
            effect->setEnabled(random.integer(0, 3) > 0);
            effects.push_back(effect);
        }
        const TextureUnits given = TextureUnits::of(effects);
        expectNoUnitTwice(effects, given);
        std::size_t refused = 0;
        for (std::size_t e = 0; e < effects.size(); ++e)
        {
            EXPECT_TRUE(given.complete[e]) << "there are enough";
            const std::vector<TextureUnitWish> wishes = wishesOf(*effects[e]);
            for (std::size_t w = 0; w < wishes.size() && effects[e]->getEnabled(); ++w)
                refused += wishes[w].unit >= 0 && wishes[w].unit != given.ofEffects[e][w] ? 1 : 0;
        }
        EXPECT_EQ(given.sentences.size(), refused);
    }
}

TEST(TextureUnits, ThoseOfTheGeometryAreRefused)
{
    geofx::test::NotifyWatch watch;
    const osg::ref_ptr<ProjectiveMappings> mappings = new ProjectiveMappings;
    const osg::ref_ptr<PanoramaMap> panorama = new PanoramaMap;
    const std::vector<std::string> said = watch.messagesOf(
        [&]
        {
            EXPECT_FALSE(mappings->setUnits(3, -1, -1));
            EXPECT_FALSE(mappings->setUnits(8, -1, 8));
            EXPECT_FALSE(panorama->setFirstUnit(2));
            EXPECT_FALSE(panorama->setFirstUnit(6));
        });
    ASSERT_EQ(said.size(), 4u);
    EXPECT_NE(said[0].find("dataUnit must be from 4 to 31"), std::string::npos) << said[0];
    EXPECT_NE(said[1].find("dataUnit and tableUnit must differ."), std::string::npos) << said[1];
    EXPECT_TRUE(mappings->setUnits(-1, -1, -1));
    EXPECT_TRUE(mappings->setUnits(10, 8, 9));
}
