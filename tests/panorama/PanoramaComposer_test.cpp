// SPDX-License-Identifier: MIT
// SPDX-FileCopyrightText: 2026 the osgGeoFX authors
//
// The automatic view of a panorama map: what it promises of terrains of different kinds, and against other views.
#include <osgGeoFX/panorama/PanoramaComposer.h>
#include <osgGeoFX/panorama/PanoramaMap.h>
#include <osgGeoFX/scene/DeformedView.h>
#include <tools/InventedTerrain.h>
#include <tools/RandomSamples.h>

#include <gtest/gtest.h>
#include <osg/Math>

#include <algorithm>
#include <cmath>
#include <limits>

using osgGeoFX::PanoramaComposer;
using osgGeoFX::PanoramaComposition;
using osgGeoFX::PanoramaJudgement;
using osgGeoFX::PanoramaWishes;
using osgGeoFX::TerrainRelief;

namespace
{

/// A terrain of 40 km on a plane.
TerrainRelief reliefOf(const std::string& name, int cells = 200)
{
    TerrainRelief relief;
    relief.west = 300000.0;
    relief.east = 340000.0;
    relief.south = 5000000.0;
    relief.north = 5040000.0;
    relief.columns = relief.rows = cells;
    for (int row = 0; row < cells; ++row)
    {
        for (int column = 0; column < cells; ++column)
        {
            const double height =
                geofx::test::inventedHeight(name, (column + 0.5) / cells, (row + 0.5) / cells);
            // As ThinnedRaster has the sea.
            relief.heights.push_back(static_cast<float>(std::max(height, 0.0)));
            relief.water.push_back(height <= 0.0 ? 1 : 0);
        }
    }
    return relief;
}

class PanoramaComposers : public testing::TestWithParam<const char*>
{
};

} // namespace

TEST_P(PanoramaComposers, NothingIsCutOffAndNoEdgeIsSeen)
{
    const TerrainRelief relief = reliefOf(GetParam());
    const PanoramaComposer composer(relief);
    const PanoramaComposition view = composer.compose();
    const PanoramaJudgement seen = composer.judge(view);
    EXPECT_LT(seen.blank, 0.001);
    EXPECT_EQ(seen.cut, 0.0);
    EXPECT_GE(seen.sky, 0.12);
    EXPECT_LE(seen.sky, 0.30);
    EXPECT_LE(seen.top, view.horizonLine + 0.5 * (1.0 - view.horizonLine)) << "the sky's lower half";
    EXPECT_LT(seen.hidden, 0.5);
    // All that is said of it can be read.
    for (const std::string& line : composer.explain(view))
        EXPECT_GT(line.size(), 20u);
}

TEST_P(PanoramaComposers, TheChosenViewIsAmongTheBest)
{
    const TerrainRelief relief = reliefOf(GetParam());
    const PanoramaComposer composer(relief);
    const PanoramaComposition chosen = composer.compose();
    const double worth = composer.judge(chosen).worth;
    int better = 0;
    for (std::uint64_t i = 0; i < 50; ++i)
    {
        geofx::test::Random random(i);
        // Such views as a person might try: the exaggeration fits them.
        PanoramaWishes wishes;
        wishes.heading = random.uniform(-osg::PI, osg::PI);
        wishes.viewRadius = random.uniform(0.12, 0.45) * 40000.0;
        wishes.horizonDistance = random.uniform(1.8, 4.0);
        wishes.horizonLine = random.uniform(0.65, 0.85);
        wishes.place =
            osg::Vec2d(random.uniform(relief.west, relief.east), random.uniform(relief.south, relief.north));
        const PanoramaComposition other = PanoramaComposer(relief, wishes).compose();
        better += composer.judge(other).worth > worth ? 1 : 0;
    }
    EXPECT_LE(better, 4);
}

INSTANTIATE_TEST_SUITE_P(Terrains, PanoramaComposers,
                         testing::Values("alps", "islands", "volcano", "hills", "feet"),
                         [](const auto& each) { return std::string(each.param); });

TEST(PanoramaComposer, LooksFromThePlainToTheMountains)
{
    // "feet" has its mountains in the north, and rivers that flow south.
    const PanoramaComposition north = PanoramaComposer(reliefOf("feet")).compose();
    EXPECT_LT(std::abs(std::remainder(north.heading, 2.0 * osg::PI)), osg::DegreesToRadians(75.0));
    // The same terrain turned round.
    TerrainRelief turned = reliefOf("feet");
    std::reverse(turned.heights.begin(), turned.heights.end());
    std::reverse(turned.water.begin(), turned.water.end());
    const PanoramaComposition south = PanoramaComposer(turned).compose();
    EXPECT_LT(std::abs(std::remainder(south.heading - osg::PI, 2.0 * osg::PI)), osg::DegreesToRadians(75.0));
}

TEST(PanoramaComposer, KeepsToTheWishes)
{
    const TerrainRelief relief = reliefOf("alps");
    PanoramaWishes wishes;
    wishes.aspect = 1.0;
    wishes.heading = 1.25;
    wishes.viewRadius = 7000.0;
    wishes.horizonLine = 0.71;
    wishes.horizonDistance = 3.1;
    wishes.exaggeration = 1.7;
    wishes.place = osg::Vec2d(311000.0, 5012000.0);
    const PanoramaComposition view = PanoramaComposer(relief, wishes).compose();
    EXPECT_NEAR(view.heading, 1.25, 1e-12);
    EXPECT_EQ(view.viewRadius, 7000.0);
    EXPECT_EQ(view.horizonLine, 0.71);
    EXPECT_EQ(view.horizonDistance, 3.1);
    EXPECT_EQ(view.exaggeration, 1.7);
    EXPECT_EQ(view.place, osg::Vec2d(311000.0, 5012000.0));

    // A focus lies before the base, in the picture's middle.
    PanoramaWishes focused;
    focused.focus = osg::Vec2d(320000.0, 5021000.0);
    const PanoramaComposition toFocus = PanoramaComposer(relief, focused).compose();
    const osg::Vec2d away = *focused.focus - toFocus.place;
    const osg::Vec2d ahead(std::sin(toFocus.heading), std::cos(toFocus.heading));
    EXPECT_NEAR(away.x() * ahead.y() - away.y() * ahead.x(), 0.0, 1.0) << "neither left nor right";
    EXPECT_GT(away * ahead, 0.0);
    EXPECT_LT(away * ahead, toFocus.horizonDistance * toFocus.viewRadius);
}

namespace
{

/// The composer's own curve is that of the map that it composes: the highest tip is where the map draws it.
void expectThePictureThatTheMapDraws(double horizonExaggeration, const std::vector<osg::Vec2d>& curvePoints)
{
    TerrainRelief relief = reliefOf("hills", 100);
    std::fill(relief.heights.begin(), relief.heights.end(), 100.0f);
    const int column = 60, row = 70;
    relief.heights[relief.index(column, row)] = 1500.0f;
    PanoramaWishes wishes;
    wishes.heading = 0.4;
    wishes.viewRadius = 14000.0;
    wishes.place = osg::Vec2d(316000.0, 5008000.0);
    wishes.horizonExaggeration = horizonExaggeration;
    wishes.curvePoints = curvePoints;
    const PanoramaComposer composer(relief, wishes);
    const PanoramaComposition view = composer.compose();

    const osg::ref_ptr<osgGeoFX::EffectScene> scene = new osgGeoFX::EffectScene;
    const osg::ref_ptr<osgGeoFX::PanoramaMap> map = new osgGeoFX::PanoramaMap;
    view.applyTo(*map);
    EXPECT_EQ(map->getHorizonExaggeration(), horizonExaggeration);
    EXPECT_EQ(map->getCurvePoints(), curvePoints);
    scene->addEffect(map);
    const osgGeoFX::DeformedView picture(*scene, view.viewMatrix(relief),
                                         osg::Matrixd::perspective(30.0, 16.0 / 9.0, 1.0, 1e6), 1600.0,
                                         900.0);
    const osg::Vec2d place = relief.place(column, row);
    osg::Vec2d tip, base;
    ASSERT_TRUE(picture.project(osg::Vec3d(place, 1500.0), tip));
    EXPECT_NEAR(tip.y() / 900.0, composer.judge(view).top, 0.004);
    // The place of the composition is at the middle of the base.
    ASSERT_TRUE(picture.project(osg::Vec3d(view.place, view.baseHeight), base));
    EXPECT_NEAR(base.x(), 800.0, 0.5);
    EXPECT_NEAR(base.y(), 0.0, 0.5);
}

} // namespace

TEST(PanoramaComposer, JudgesThePictureThatTheMapDraws)
{
    expectThePictureThatTheMapDraws(-1.0, {});
}

TEST(PanoramaComposer, JudgesThePictureOfACurveOfOnesOwn)
{
    expectThePictureThatTheMapDraws(0.8, {{0.3, 0.2}, {0.6, 0.75}});
}

TEST(PanoramaComposer, FindsAViewOfAnything)
{
    for (const double height : {0.0, 12.0, -430.0})
    {
        TerrainRelief relief;
        relief.east = relief.north = 20000.0;
        relief.columns = relief.rows = 4;
        relief.heights.assign(16, static_cast<float>(height));
        relief.water.assign(16, height <= 0.0 ? 1 : 0);
        const PanoramaComposition view = PanoramaComposer(relief).compose();
        EXPECT_GT(view.viewRadius, 0.0);
        EXPECT_GT(view.exaggeration, 0.0);
        EXPECT_TRUE(std::isfinite(view.heading + view.place.x() + view.place.y() + view.baseHeight));
        const osg::ref_ptr<osgGeoFX::PanoramaMap> map = new osgGeoFX::PanoramaMap;
        view.applyTo(*map);
        EXPECT_EQ(map->getHorizonDistance(), view.horizonDistance);
        EXPECT_EQ(map->getCurveDistance(), view.curveDistance);
        EXPECT_EQ(map->getBaseHeight(), view.baseHeight);
    }
    // Half of it is a hole.
    TerrainRelief holed = reliefOf("feet");
    for (int row = 0; row < holed.rows; ++row)
        for (int column = 0; column < holed.columns / 2; ++column)
            holed.heights[holed.index(column, row)] = std::numeric_limits<float>::quiet_NaN();
    const PanoramaComposer composer(holed);
    EXPECT_LT(composer.judge(composer.compose()).blank, 0.001);
}

TEST(TerrainRelief, CoarserOnesKeepTheSummits)
{
    TerrainRelief relief = reliefOf("volcano", 90);
    const TerrainRelief rough = relief.coarser(4);
    EXPECT_EQ(rough.columns, 23);
    EXPECT_EQ(*std::max_element(relief.heights.begin(), relief.heights.end()),
              *std::max_element(rough.heights.begin(), rough.heights.end()));
    EXPECT_NEAR(rough.place(0, 0).x() - rough.west, 2.0 * (relief.place(0, 0).x() - relief.west) * 2.0, 1e-6);
}
