// SPDX-License-Identifier: MIT
// SPDX-FileCopyrightText: 2026 the osgGeoFX authors
//
// The automatic view of a panorama map: what it promises of terrains of different kinds, and against other views.
#include <osgGeoFX/panorama/PanoramaComposer.h>
#include <osgGeoFX/panorama/PanoramaMap.h>
#include <osgGeoFX/scene/DeformedView.h>
#include <osgGeoFX/viewer/Liberties.h>
#include <tools/InventedTerrain.h>
#include <tools/RandomSamples.h>

#include <gtest/gtest.h>
#include <osg/Math>

#include <algorithm>
#include <cmath>
#include <limits>
#include <map>
#include <string>

using osgGeoFX::PanoramaComposer;
using osgGeoFX::PanoramaComposition;
using osgGeoFX::PanoramaJudgement;
using osgGeoFX::PanoramaLiberty;
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
protected:
    /// The view that the composer chooses of the terrain, once for all tests.
    static const PanoramaComposition& chosen(const PanoramaComposer& composer)
    {
        static std::map<std::string, PanoramaComposition> known;
        const auto [view, isNew] = known.try_emplace(GetParam());
        if (isNew) view->second = composer.compose();
        return view->second;
    }
};

} // namespace

TEST_P(PanoramaComposers, NothingIsCutOffAndNoEdgeIsSeen)
{
    const TerrainRelief relief = reliefOf(GetParam());
    const PanoramaComposer composer(relief);
    const PanoramaComposition& view = chosen(composer);
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
    const PanoramaComposition& best = chosen(composer);
    const double worth = composer.judge(best).worth;
    int better = 0;
    const std::uint64_t views = geofx::test::fullTest() ? 50 : 24;
    for (std::uint64_t i = 0; i < views; ++i)
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
    EXPECT_LE(better, static_cast<int>(views / 12));
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

namespace
{

/// Land at 100 m with one mountain, long in a direction (clockwise from north), and a composition that looks north at it.
TerrainRelief mountainRelief(double direction, double height, double longer = 3.0)
{
    TerrainRelief relief = reliefOf("hills", 200);
    for (int row = 0; row < relief.rows; ++row)
    {
        for (int column = 0; column < relief.columns; ++column)
        {
            const osg::Vec2d away = relief.place(column, row) - osg::Vec2d(320000.0, 5020000.0);
            const double along = away.x() * std::sin(direction) + away.y() * std::cos(direction);
            const double across = away.x() * std::cos(direction) - away.y() * std::sin(direction);
            const double r = std::hypot(along / longer, across) / 1000.0;
            const std::size_t cell = relief.index(column, row);
            relief.water[cell] = 0;
            relief.heights[cell] =
                static_cast<float>(100.0 + height * std::exp(-r * r) + 3.0 * std::sin(column * 0.7));
        }
    }
    return relief;
}

PanoramaComposition northwards()
{
    PanoramaWishes wishes;
    wishes.heading = 0.0;
    wishes.viewRadius = 12000.0;
    wishes.horizonLine = 0.75;
    wishes.horizonDistance = 2.0;
    wishes.exaggeration = 2.0;
    wishes.place = osg::Vec2d(320000.0, 5008000.0);
    PanoramaComposition view = PanoramaComposer(mountainRelief(0.0, 900.0), wishes).compose();
    return view;
}

/// How far a direction of the ground at a place turns, clockwise.
double turned(const PanoramaLiberty& liberty, const osg::Vec2d& place, double direction)
{
    const osg::ref_ptr<osgGeoFX::EffectScene> scene = new osgGeoFX::EffectScene;
    scene->addEffect(osgGeoFX::makeLiberty(liberty, false));
    const osgGeoFX::DeformedView view(
        *scene,
        osg::Matrixd::lookAt(osg::Vec3d(place, 1e4), osg::Vec3d(place, 0.0), osg::Vec3d(0.0, 1.0, 0.0)),
        osg::Matrixd::perspective(30.0, 1.0, 1.0, 1e6), 100.0, 100.0);
    const osg::Vec3d end(place + osg::Vec2d(std::sin(direction), std::cos(direction)) * 10.0, 500.0);
    const osg::Vec3d way = view.deform(end) - view.deform(osg::Vec3d(place, 500.0));
    return std::remainder(std::atan2(way.x(), way.y()) - direction, 2.0 * osg::PI);
}

} // namespace

TEST_P(PanoramaComposers, LibertiesCutNothingOffAndHideNothing)
{
    const TerrainRelief relief = reliefOf(GetParam());
    const PanoramaComposer composer(relief);
    const PanoramaComposition& view = chosen(composer);
    const PanoramaJudgement before = composer.judge(view);
    EXPECT_TRUE(composer.liberties(view, 0.0).empty());
    for (const double strength : {PanoramaComposer::usualLiberties, 1.0})
    {
        const std::vector<PanoramaLiberty> all = composer.liberties(view, strength);
        const PanoramaJudgement seen = composer.judge(view, all);
        EXPECT_EQ(seen.cut, 0.0);
        EXPECT_LE(seen.top, view.horizonLine + 0.5 * (1.0 - view.horizonLine)) << "the sky's lower half";
        EXPECT_LT(seen.blank, 0.001);
        EXPECT_GE(seen.sky, 0.12);
        EXPECT_LE(seen.sky, 0.30);
        EXPECT_LE(seen.hidden, before.hidden + 0.03);
        EXPECT_LE(all.size(), 5u);
        for (const PanoramaLiberty& liberty : all)
        {
            EXPECT_LE(liberty.enlarge, 1.0 + 0.5 * strength + 1e-9);
            EXPECT_LE(liberty.widen, 1.0 + 0.6 * strength + 0.01);
            EXPECT_LE(std::abs(liberty.turn), osg::DegreesToRadians(20.0 * strength) + 1e-9);
            EXPECT_TRUE(liberty.enlarge > 1.0 || liberty.widen > 1.0 || liberty.turn != 0.0);
            EXPECT_EQ(liberty.why.substr(0, 4), "The ");
            EXPECT_EQ(liberty.why.back(), '.');
        }
        // The same again.
        const std::vector<PanoramaLiberty> again = PanoramaComposer(relief).liberties(view, strength);
        ASSERT_EQ(again.size(), all.size());
        for (std::size_t i = 0; i < all.size(); ++i)
            EXPECT_EQ(again[i].why, all[i].why);
    }
}

TEST(PanoramaComposer, EnlargesWhatLooksSmallAboveItsFoot)
{
    const PanoramaComposition view = northwards();
    const auto enlarged = [&](double height)
    {
        double factor = 1.0;
        for (const PanoramaLiberty& each :
             PanoramaComposer(mountainRelief(0.5 * osg::PI, height)).liberties(view, 1.0))
        {
            if (each.enlarge == 1.0) continue;
            factor = each.enlarge;
            EXPECT_LT((each.place - osg::Vec2d(320000.0, 5020000.0)).length(), 500.0);
            EXPECT_NEAR(each.baseHeight, 100.0, 30.0) << "the land around it";
            EXPECT_GT(each.across, 2500.0);
            EXPECT_LT(each.across, 7000.0);
        }
        return factor;
    };
    EXPECT_GT(enlarged(250.0), 1.3);
    EXPECT_EQ(enlarged(1700.0), 1.0) << "it is tall already, and has room above";
}

TEST(PanoramaComposer, TurnsABroadSideToTheViewer)
{
    const PanoramaComposition view = northwards();
    const osg::Vec2d place(320000.0, 5020000.0);
    for (const double direction : {0.3, 0.8, -0.3, -0.8, 1.5})
    {
        SCOPED_TRACE(direction);
        double turn = 0.0;
        for (const PanoramaLiberty& each :
             PanoramaComposer(mountainRelief(direction, 900.0)).liberties(view, 1.0))
            if (each.turn != 0.0) turn = turned(each, place, direction);
        if (direction == 1.5)
        {
            EXPECT_EQ(turn, 0.0) << "it lies across the picture";
            continue;
        }
        // Its length comes nearer to the picture's width: away from north.
        EXPECT_GT(turn * direction, 0.0);
        EXPECT_LE(std::abs(turn), osg::DegreesToRadians(20.5));
        EXPECT_GT(std::abs(turn), osg::DegreesToRadians(8.0));
    }
}

TEST(PanoramaComposer, WidensTheValleyThatLeadsIntoThePicture)
{
    const double direction = 0.25;
    TerrainRelief relief = reliefOf("hills", 200);
    for (int row = 0; row < relief.rows; ++row)
    {
        for (int column = 0; column < relief.columns; ++column)
        {
            const osg::Vec2d away = relief.place(column, row) - osg::Vec2d(320000.0, 5018000.0);
            const double across = away.x() * std::cos(direction) - away.y() * std::sin(direction);
            const double from = std::abs(across) / 500.0;
            const std::size_t cell = relief.index(column, row);
            relief.water[cell] = 0;
            relief.heights[cell] = static_cast<float>(100.0 + 500.0 * (1.0 - std::exp(-from * from)));
        }
    }
    const PanoramaComposition view = northwards();
    int valleys = 0;
    for (const PanoramaLiberty& each : PanoramaComposer(relief).liberties(view, 1.0))
    {
        if (each.widen == 1.0) continue;
        ++valleys;
        EXPECT_NEAR(std::remainder(each.heading - direction, osg::PI), 0.0, 0.12);
        const osg::Vec2d away = each.place - osg::Vec2d(320000.0, 5018000.0);
        EXPECT_NEAR(away.x() * std::cos(direction) - away.y() * std::sin(direction), 0.0, 600.0);
        EXPECT_GT(each.widen, 1.3);
        // It widens across the valley.
        EXPECT_LT(std::abs(turned(each, each.place, direction)), 0.05);
    }
    EXPECT_EQ(valleys, 1);
}

/// The composer's own liberties are those of the effect: a tip stands where map and liberty draw it.
TEST(PanoramaComposer, JudgesLibertiesAsTheEffectTakesThem)
{
    TerrainRelief relief = reliefOf("hills", 100);
    std::fill(relief.heights.begin(), relief.heights.end(), 100.0f);
    std::fill(relief.water.begin(), relief.water.end(), 0);
    const int column = 60, row = 70;
    for (int y = -1; y <= 1; ++y)
        for (int x = -1; x <= 1; ++x)
            relief.heights[relief.index(column + x, row + y)] = 1200.0f;
    PanoramaWishes wishes;
    wishes.heading = 0.4;
    wishes.viewRadius = 14000.0;
    wishes.place = osg::Vec2d(316000.0, 5008000.0);
    wishes.exaggeration = 1.5;
    const PanoramaComposer composer(relief, wishes);
    const PanoramaComposition view = composer.compose();
    PanoramaLiberty liberty;
    liberty.place = relief.place(column - 2, row + 3);
    liberty.across = 5000.0;
    liberty.along = 7000.0;
    liberty.heading = 0.7;
    liberty.enlarge = 1.6;
    liberty.baseHeight = 150.0;
    liberty.widen = 1.3;
    liberty.turn = 0.3;
    const osg::ref_ptr<osgGeoFX::EffectScene> scene = new osgGeoFX::EffectScene;
    const osg::ref_ptr<osgGeoFX::PanoramaMap> map = new osgGeoFX::PanoramaMap;
    view.applyTo(*map);
    scene->addEffect(map);
    const osg::ref_ptr<osgGeoFX::RegionalLiberty> effect = osgGeoFX::makeLiberty(liberty, false);
    osgGeoFX::addLiberty(*scene, *effect);
    ASSERT_EQ(scene->getEffect(0), effect);
    const PanoramaLiberty back = osgGeoFX::libertyOf(*effect, false);
    EXPECT_EQ(back.place, liberty.place);
    EXPECT_NEAR(back.enlarge, liberty.enlarge, 1e-12);
    EXPECT_NEAR(back.turn, liberty.turn, 1e-12);
    const osgGeoFX::DeformedView picture(*scene, view.viewMatrix(relief),
                                         osg::Matrixd::perspective(30.0, 16.0 / 9.0, 1.0, 1e6), 1600.0,
                                         900.0);
    double top = 0.0;
    for (int y = -1; y <= 1; ++y)
    {
        for (int x = -1; x <= 1; ++x)
        {
            osg::Vec2d tip;
            ASSERT_TRUE(picture.project(osg::Vec3d(relief.place(column + x, row + y), 1200.0), tip));
            top = std::max(top, tip.y() / 900.0);
        }
    }
    EXPECT_GT(top, composer.judge(view).top + 0.02);
    // Cells of 400 m move, and are sampled again.
    EXPECT_NEAR(composer.judge(view, {liberty}).top, top, 0.02);
}

/// The same of a cylindrical map, all of whose directions count.
TEST(PanoramaComposer, JudgesTheStripThatTheMapDraws)
{
    TerrainRelief relief = reliefOf("hills", 100);
    std::fill(relief.heights.begin(), relief.heights.end(), 100.0f);
    const int column = 60, row = 70;
    relief.heights[relief.index(column, row)] = 1500.0f;
    PanoramaWishes wishes;
    wishes.aspect = 5.0;
    wishes.heading = 0.4;
    wishes.horizontalAngle = 2.0 * osg::PI;
    wishes.place = osg::Vec2d(319000.0, 5019000.0);
    const PanoramaComposer composer(relief, wishes);
    const PanoramaComposition view = composer.compose();
    EXPECT_EQ(view.horizontalAngle, 2.0 * osg::PI);
    EXPECT_EQ(view.horizonBend, 0.0);
    EXPECT_LT(composer.judge(view).blank, 0.001);

    const osg::ref_ptr<osgGeoFX::EffectScene> scene = new osgGeoFX::EffectScene;
    const osg::ref_ptr<osgGeoFX::PanoramaMap> map = new osgGeoFX::PanoramaMap;
    view.applyTo(*map);
    scene->addEffect(map);
    const osgGeoFX::DeformedView picture(*scene, view.viewMatrix(relief),
                                         osg::Matrixd::perspective(30.0, 5.0, 1.0, 1e6), 2000.0, 400.0);
    const osg::Vec2d place = relief.place(column, row);
    osg::Vec2d tip;
    ASSERT_TRUE(picture.project(osg::Vec3d(place, 1500.0), tip));
    EXPECT_NEAR(tip.y() / 400.0, composer.judge(view).top, 0.01);
    const osg::Vec2d away = place - view.place;
    const double azimuth = std::remainder(std::atan2(away.x(), away.y()) - view.heading, 2.0 * osg::PI);
    EXPECT_NEAR(tip.x(), 2000.0 * (0.5 + azimuth / (2.0 * osg::PI)), 0.5);
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
