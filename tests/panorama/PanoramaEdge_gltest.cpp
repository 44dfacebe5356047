// SPDX-License-Identifier: MIT
// SPDX-FileCopyrightText: 2026 the osgGeoFX authors
//
// Where a terrain ends: a panorama map claims a sea only where the data's own border is sea; land runs out into haze and paper, and no
// cliff shows.
#include <osgGeoFX/paging/TerrainInfo.h>
#include <tools/GlFixture.h>
#include <tools/StrokeTiles.h>

#include <osg/ValueObject>
#include <osgGeoFX/panorama/PanoramaMap.h>
#include <osgGeoFX/panorama/detail/EdgeMap.h>
#include <osgGeoFX/scene/EffectScene.h>

#include <algorithm>
#include <cmath>
#include <functional>

using namespace osgGeoFX;
using namespace geofx::test;

namespace
{

constexpr int WIDTH = 240, HEIGHT = 180;
/// Half the width of the ground shown, metres; the terrain's border, east and north of the middle of the picture's base.
constexpr double RADIUS = 10000.0;
constexpr double WEST = -15000.0, EAST = 15000.0, SOUTH = 3000.0, NORTH = 33000.0;

struct Land
{
    std::function<double(double x, double y)> height = [](double, double)
    {
        return 0.0;
    };
    /// Metres to the shore, negative on land.
    std::function<double(double x, double y)> shore = [](double, double)
    {
        return -5000.0;
    };
};

double hills(double x, double y)
{
    return 900.0 + 400.0 * std::sin(x / 1900.0) * std::cos(y / 2300.0);
}

/// As a database of osggeofx_build begins: a root that tells of itself above the coarsest tile.
osg::ref_ptr<osg::Group> terrainOf(const Land& land, bool ours)
{
    StrokeTiles tiles;
    tiles.cells = 128;
    tiles.skirt = 0.0;
    tiles.height = land.height;
    tiles.cover = [&](double x, double y)
    {
        glsl::geofx_Cover cover{};
        cover.shore = land.shore(x, y);
        return cover;
    };
    const osg::ref_ptr<osg::MatrixTransform> tile = tiles.tile(WEST, SOUTH, EAST, NORTH);
    auto* cover =
        StrokeTiles::geometryOf(*tile).getStateSet()->getTextureAttribute(7, osg::StateAttribute::TEXTURE);
    static_cast<osg::Texture2D*>(cover)->setResizeNonPowerOfTwoHint(false);
    StrokeTiles::geometryOf(*tile).setUseDisplayList(false);
    StrokeTiles::geometryOf(*tile).setUseVertexBufferObjects(false);
    tile->setName("tile 0/0/0");
    tile->setUserValue("geofx.boxMin", osg::Vec3d(-15000.0, -15000.0, 0.0));
    tile->setUserValue("geofx.boxMax", osg::Vec3d(15000.0, 15000.0, 2000.0));
    const osg::ref_ptr<osg::CoordinateSystemNode> root = new osg::CoordinateSystemNode;
    root->addChild(tile);
    if (!ours) return root;
    root->setName("osgGeoFX terrain");
    root->setUserValue("geofx.format", osgGeoFX::TerrainInfo::newestFormat);
    root->setUserValue("geofx.kind", std::string("projected"));
    root->setUserValue("geofx.west", WEST);
    root->setUserValue("geofx.south", SOUTH);
    root->setUserValue("geofx.east", EAST);
    root->setUserValue("geofx.north", NORTH);
    root->setUserValue("geofx.minHeight", 0.0);
    root->setUserValue("geofx.maxHeight", 1500.0);
    root->setUserValue("geofx.pixelsPerRadian", 1000.0);
    root->setUserValue("geofx.pixelError", 1.0);
    root->setUserValue("geofx.levels", 1);
    root->setUserValue("geofx.vertical", std::string("none"));
    return root;
}

struct Pixel
{
    double red = 0.0, green = 0.0, blue = 0.0;
    double off(const Pixel& other) const
    {
        return std::max(
            {std::abs(red - other.red), std::abs(green - other.green), std::abs(blue - other.blue)});
    }
    /// No haze, paper or land of these tests is that blue.
    bool sea() const { return blue > red + 0.15 && blue > 0.25; }
    bool pale() const { return std::min({red, green, blue}) > 0.72; }
};

Pixel pixelOf(const osg::Image& image, int column, int row)
{
    const unsigned char* bytes =
        image.data(static_cast<unsigned int>(column), static_cast<unsigned int>(row));
    return {bytes[0] / 255.0, bytes[1] / 255.0, bytes[2] / 255.0};
}

/// Below the horizon, bent down at the sides.
const int GROUND_ROWS = static_cast<int>(HEIGHT * 0.75) - 1;

class PanoramaEdgePicture : public GlFixture
{
protected:
    PanoramaEdgePicture() : GlFixture(WIDTH, HEIGHT)
    {
        map->setViewRadius(RADIUS);
        map->setAtmosphere(0.0);
        map->setStrokes(false);
        map->setRipples(0.0);
        map->setReflection(0.0);
    }

    osg::ref_ptr<osg::Image> draw(const Land& land, bool ours = true)
    {
        const osg::ref_ptr<EffectScene> scene = new EffectScene;
        scene->setTerrainFrame(EffectScene::PROJECTED);
        scene->addEffect(map);
        scene->addChild(terrainOf(land, ours));
        osg::Camera& camera = *viewer().getCamera();
        camera.setViewMatrixAsLookAt(osg::Vec3d(0.0, 0.0, 20000.0), osg::Vec3d(0.0, 20000.0, 0.0),
                                     osg::Vec3d(0.0, 0.0, 1.0));
        camera.setProjectionMatrixAsPerspective(40.0, static_cast<double>(WIDTH) / HEIGHT, 10.0, 1e5);
        return render(scene);
    }

    static int countSea(const osg::Image& image, int left = 0, int right = WIDTH)
    {
        int count = 0;
        for (int row = 0; row < GROUND_ROWS; ++row)
            for (int column = left; column < right; ++column)
                count += pixelOf(image, column, row).sea() ? 1 : 0;
        return count;
    }

    static int countDifferent(const osg::Image& a, const osg::Image& b, double least)
    {
        int count = 0;
        for (int row = 0; row < HEIGHT; ++row)
            for (int column = 0; column < WIDTH; ++column)
                count += pixelOf(a, column, row).off(pixelOf(b, column, row)) > least ? 1 : 0;
        return count;
    }

    const osg::ref_ptr<PanoramaMap> map = new PanoramaMap;
};

} // namespace

TEST_F(PanoramaEdgePicture, LandlockedLandEndsInNoSea)
{
    Land land;
    land.height = hills;
    const osg::ref_ptr<osg::Image> image = draw(land);
    EXPECT_EQ(countSea(*image), 0);
    for (int column = 0; column < WIDTH; ++column)
        EXPECT_TRUE(pixelOf(*image, column, 1).pale()) << "no paper at the base, column " << column;
    // In the middle there is land.
    int land_ = 0;
    for (int row = 0; row < GROUND_ROWS; ++row)
        land_ += pixelOf(*image, WIDTH / 2, row).pale() ? 0 : 1;
    EXPECT_GT(land_, GROUND_ROWS / 4);
    map->setEdge(PanoramaMap::SEA);
    EXPECT_GT(countSea(*draw(land)), 1000) << "the test would not see a sea";
}

TEST_F(PanoramaEdgePicture, AnIslandLiesInItsSea)
{
    Land land;
    land.shore = [](double x, double y)
    {
        return std::hypot(x, y - 15000.0) - 7000.0;
    };
    land.height = [&](double x, double y)
    {
        return std::max(0.0, -0.1 * land.shore(x, y));
    };
    const osg::ref_ptr<osg::Image> image = draw(land);
    map->setEdge(PanoramaMap::SEA);
    EXPECT_EQ(countDifferent(*image, *draw(land), 0.0), 0);
    // The sea ends, too, where that is wanted.
    map->setEdge(PanoramaMap::HAZE);
    const osg::ref_ptr<osg::Image> hazy = draw(land);
    for (int column = 0; column < WIDTH; ++column)
        EXPECT_TRUE(pixelOf(*hazy, column, 1).pale()) << column;
}

TEST_F(PanoramaEdgePicture, ACoastThatTheBorderCutsHasSeaOnItsOwnSideAlone)
{
    // Sea in the west.
    Land land;
    land.shore = [](double x, double)
    {
        return -x;
    };
    land.height = [](double x, double)
    {
        return std::clamp(0.3 * x, 0.0, 900.0);
    };
    const osg::ref_ptr<osg::Image> image = draw(land);
    int sea = 0, pale = 0;
    for (int column = 0; column < WIDTH / 4; ++column)
        sea += pixelOf(*image, column, 2).sea() ? 1 : 0;
    for (int column = 3 * WIDTH / 4; column < WIDTH; ++column)
        pale += pixelOf(*image, column, 2).pale() ? 1 : 0;
    EXPECT_GT(sea, WIDTH / 4 - 4) << "at the base, in the west";
    EXPECT_GT(pale, WIDTH / 4 - 4) << "at the base, in the east";
    EXPECT_EQ(countSea(*image, WIDTH / 2 + 10), 0);
}

TEST_F(PanoramaEdgePicture, ALakeThatTheBorderCutsIsNoSea)
{
    Land land;
    land.height = [](double x, double y)
    {
        return std::hypot(x, y - SOUTH) < 5000.0 ? 700.0 : 700.0 + 0.2 * (std::hypot(x, y - SOUTH) - 5000.0);
    };
    land.shore = [](double x, double y)
    {
        return 5000.0 - std::hypot(x, y - SOUTH);
    };
    const osg::ref_ptr<osg::Image> image = draw(land);
    for (int column = 0; column < WIDTH; ++column)
        EXPECT_TRUE(pixelOf(*image, column, 1).pale()) << column;
}

TEST_F(PanoramaEdgePicture, WhatTheBorderCutsDoesNotShow)
{
    Land land;
    land.height = hills;
    const osg::ref_ptr<osg::Image> image = draw(land);
    // Walls and ditches right at the border, where a painted cliff would show them, against the land behind them, the sky and the paper.
    Land walled = land;
    walled.height = [](double x, double y)
    {
        const double inside = std::min({x - WEST, EAST - x, y - SOUTH, NORTH - y});
        return hills(x, y) + (inside < 200.0 ? 600.0 * std::sin(x / 300.0) : 0.0);
    };
    // What the wall hides and shows of the land behind it in the south has gone, too.
    const osg::ref_ptr<osg::Image> other = draw(walled);
    EXPECT_LT(countDifferent(*image, *other, 12.0 / 255.0), WIDTH * HEIGHT / 250);
    map->setEdge(PanoramaMap::SEA);
    const osg::ref_ptr<osg::Image> cut = draw(land);
    EXPECT_GT(countDifferent(*cut, *draw(walled), 12.0 / 255.0), WIDTH * HEIGHT / 100)
        << "the test would not see a wall";
}

TEST_F(PanoramaEdgePicture, ARidgeAtTheBaseRunsOutAsTheValleyBehindIt)
{
    Land land;
    land.height = [](double x, double y)
    {
        const double away = (y - SOUTH - 1500.0 - 300.0 * std::sin(x / 1500.0)) / 400.0;
        return 300.0 + 500.0 * std::exp(-away * away);
    };
    const osg::ref_ptr<osg::Image> image = draw(land);
    map->setEdge(PanoramaMap::SEA);
    const osg::ref_ptr<osg::Image> whole = draw(land);
    // Blue tells best: the land has hardly any, paper nearly all.
    const double paper = pixelOf(*image, WIDTH / 2, 1).blue;
    double steepest = 0.0, most = 0.0;
    int shown = 0;
    for (int column = WIDTH / 4; column < 3 * WIDTH / 4; ++column)
    {
        double below = std::nan("");
        for (int row = 0; row < HEIGHT / 2; ++row)
        {
            const Pixel painted = pixelOf(*whole, column, row), faded = pixelOf(*image, column, row);
            const bool land_ = !painted.sea() && paper - painted.blue > 0.3;
            const double gone = land_ ? (faded.blue - painted.blue) / (paper - painted.blue) : std::nan("");
            if (land_) most = std::max(most, gone), ++shown;
            if (gone < below) steepest = std::max(steepest, below - gone);
            below = gone;
        }
    }
    EXPECT_GT(shown, WIDTH * HEIGHT / 16);
    EXPECT_GT(most, 0.8) << "nothing runs out";
    EXPECT_LT(steepest, 0.3) << "a ridge stands white before a valley";
}

TEST_F(PanoramaEdgePicture, BeyondABaysBorderTheSeaIsThatBeforeIt)
{
    // A bay, whose shore is nearer to the border than the land takes to run out.
    Land land;
    land.shore = [](double, double y)
    {
        return SOUTH + 1500.0 - y;
    };
    land.height = [&](double x, double y)
    {
        return std::clamp(-0.3 * land.shore(x, y), 0.0, 900.0);
    };
    map->setEdge(PanoramaMap::SEA);
    const osg::ref_ptr<osg::Image> sea = draw(land);
    map->setEdge(PanoramaMap::AUTOMATIC);
    const osg::ref_ptr<osg::Image> image = draw(land);
    int different = 0;
    for (int row = 0; row < HEIGHT / 8; ++row)
        for (int column = WIDTH / 3; column < 2 * WIDTH / 3; ++column)
            different += pixelOf(*image, column, row).off(pixelOf(*sea, column, row)) > 2.0 / 255.0 ? 1 : 0;
    EXPECT_EQ(different, 0) << "paper over the sea";
    EXPECT_GT(countSea(*image, WIDTH / 3, 2 * WIDTH / 3), WIDTH / 3 * HEIGHT / 10);
}

TEST_F(PanoramaEdgePicture, OfDatabasesOfOthersNoSeaIsClaimed)
{
    Land land;
    land.height = hills;
    EXPECT_EQ(countSea(*draw(land, false)), 0);
    map->setEdge(PanoramaMap::SEA);
    EXPECT_GT(countSea(*draw(land, false)), 1000);
}

TEST_F(PanoramaEdgePicture, WithoutASkyNothingIsDrawnBeyondAndTheLandStays)
{
    Land land;
    land.height = hills;
    map->setSky(false);
    const osg::ref_ptr<osg::Image> image = draw(land);
    map->setEdge(PanoramaMap::SEA);
    EXPECT_EQ(countDifferent(*image, *draw(land), 0.0), 0);
}
