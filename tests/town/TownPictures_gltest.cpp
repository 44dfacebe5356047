// SPDX-License-Identifier: MIT
// SPDX-FileCopyrightText: 2026 the osgGeoFX authors
//
// Pictures of towns in databases: culling leaves nothing out that shows, with all kinds of effects and while files arrive; what
// is drawn grows with what is in sight and not with the town; and plain OpenSceneGraph draws the town.
#include <osgGeoFX/paging/Georeference.h>
#include <osgGeoFX/terrain/DatabaseBuilder.h>
#include <osgGeoFX/town/TownBuilder.h>
#include <osgGeoFX/viewer/ViewPoint.h>
#include <tools/CullHarness.h>
#include <tools/GlFixture.h>
#include <tools/ImageComparison.h>
#include <tools/OahuScene.h>
#include <tools/TempDir.h>
#include <tools/TestRasters.h>
#include <town/TownFiles.h>

#include <algorithm>
#include <set>
#include <tuple>

using namespace osgGeoFX;
using namespace geofx::test;

namespace
{

constexpr int WIDTH = 240, HEIGHT = 180;
constexpr double WEST = -157.95, NORTH = 21.38, PIXEL = 0.0005;
constexpr int COLUMNS = 360, ROWS = 280;

class TownPictures : public GlFixture
{
protected:
    TownPictures() : GlFixture(WIDTH, HEIGHT) {}

    /// A database with a town of so many buildings on `share` of its sides, made once for all tests.
    static std::string database(int buildings, double share)
    {
        static const TempDir folder;
        const std::string name = std::to_string(buildings) + "-" + std::to_string(share);
        const std::filesystem::path ground = folder / "ground", path = folder / name;
        if (!std::filesystem::exists(ground))
        {
            BuildOptions options;
            options.dems = {writeRelief(folder / "dem.tif", COLUMNS, ROWS, WEST, NORTH, PIXEL)};
            options.tileSize = 32;
            options.output = ground.string();
            buildDatabase(options);
        }
        if (std::filesystem::exists(path)) return path.string();
        std::filesystem::copy(ground, path, std::filesystem::copy_options::recursive);
        Random random(5);
        std::vector<Feature> features;
        for (int i = 0; i < buildings; ++i)
        {
            const double x = WEST + PIXEL * COLUMNS * (0.5 + 0.49 * share * random.uniform(-1.0, 1.0)),
                         y = NORTH - PIXEL * ROWS * (0.5 + 0.49 * share * random.uniform(-1.0, 1.0));
            features.push_back(
                {rectangle(x, y, random.uniform(1e-4, 4e-4), random.uniform(1e-4, 3e-4)),
                 {std::to_string(random.logarithmic(5.0, 150.0)), random.integer(0, 1) ? "gabled" : "flat"}});
        }
        TownOptions options;
        options.database = path.string();
        options.buildings = writeFeatures(folder / (name + ".gpkg"), {"height:real", "roof"}, features);
        buildTown(options);
        return path.string();
    }

    void load(const std::string& path)
    {
        _scene = new EffectScene;
        const osg::ref_ptr<osg::Node> root = osgDB::readRefNodeFile(path + "/terrain.osgb");
        ASSERT_TRUE(root);
        _scene->addChild(root);
        std::string error;
        _reference = Georeference::create(root, error);
        ASSERT_TRUE(_reference) << error;
    }

    osg::Matrixd randomView(Random& random) const
    {
        return view(WEST + PIXEL * COLUMNS * random.uniform(0.1, 0.9),
                    NORTH - PIXEL * ROWS * random.uniform(0.1, 0.9),
                    1000.0 + random.logarithmic(20.0, 8000.0), random.uniform(0.0, 6.28),
                    osg::DegreesToRadians(random.uniform(-70.0, 5.0)));
    }

    osg::Matrixd view(double longitude, double latitude, double height, double heading, double pitch) const
    {
        ViewPoint point;
        point.longitude = osg::DegreesToRadians(longitude);
        point.latitude = osg::DegreesToRadians(latitude);
        point.height = height;
        point.heading = heading;
        point.pitch = pitch;
        osg::Matrixd matrix;
        EXPECT_TRUE(point.viewMatrix(*_reference, matrix));
        return matrix;
    }

    /// Whether a leaf is one of the town's.
    static bool isTown(const Culled::Leaf& leaf) { return RigidParts::of(*leaf.drawable) != nullptr; }

    /// Loads what is asked for, until nothing more is.
    static int settle(CullHarness& harness)
    {
        Random random(1);
        int loaded = 0;
        for (int step = 0; step < 30; ++step)
        {
            const int more = CullHarness::load(harness.frame(true, false).requests, random, 1.0);
            loaded += more;
            if (more == 0) break;
        }
        return loaded;
    }

    osg::ref_ptr<EffectScene> _scene;
    osg::ref_ptr<Georeference> _reference;
};

} // namespace

TEST_F(TownPictures, WithCullingAreThoseWithout)
{
    const std::string path = database(600, 1.0);
    const int count = fullTest() ? 800 : 18;
    std::unique_ptr<CullHarness> harness;
    int town = 0, deformed = 0, left = 0;
    for (int i = 0; i < count; ++i)
    {
        SCOPED_TRACE("camera " + std::to_string(i));
        Random random(static_cast<std::uint64_t>(i));
        if (i % 20 == 0)
        {
            load(path);
            if (!harness) harness = std::make_unique<CullHarness>(context(), _scene, WIDTH, HEIGHT);
            harness->setScene(_scene);
        }
        (i % 6 == 4   ? addRandomPanorama
         : i % 6 == 5 ? addRandomLiberties
                      : addRandomEffects)(*_scene, random);
        const osg::Matrixd camera = randomView(random), projection = randomProjection(random);
        harness->setCamera(camera, projection);
        for (int step = random.integer(1, 6); step > 0; --step)
            CullHarness::load(harness->frame(true, false).requests, random, 0.8);
        // A lone house may be smaller than two pixels, which may be left out.
        harness->camera().setCullingMode(harness->camera().getCullingMode() &
                                         ~osg::CullSettings::SMALL_FEATURE_CULLING);
        const Culled culled = harness->frame(true), everything = harness->frame(false);
        deformed += _scene->deformation(camera, projection)->empty() ? 0 : 1;
        ASSERT_TRUE(imagesMatch(*culled.image, *everything.image, {})) << "something in sight was culled";
        const auto drawn = std::count_if(culled.leaves.begin(), culled.leaves.end(), isTown);
        const auto all = std::count_if(everything.leaves.begin(), everything.leaves.end(), isTown);
        town += drawn > 0 ? 1 : 0;
        left += drawn < all ? 1 : 0;
    }
    EXPECT_GT(town, count / 3);
    EXPECT_GT(left, count / 3);
    EXPECT_GT(deformed, count / 2);
}

// Four times the town around what is in sight: as much is drawn.
TEST_F(TownPictures, WhatIsInSightCounts)
{
    std::vector<std::size_t> drawables, triangles;
    for (const auto& [buildings, share] : {std::pair{500, 0.3}, std::pair{2000, 0.6}})
    {
        load(database(buildings, share));
        CullHarness harness(context(), _scene, WIDTH, HEIGHT);
        // Near, in the middle of the town, downward: all in sight is within the smaller town.
        harness.setCamera(view(WEST + 0.5 * PIXEL * COLUMNS, NORTH - 0.5 * PIXEL * ROWS, 1900.0, 0.0, -1.2),
                          osg::Matrixd::perspective(40.0, 4.0 / 3.0, 10.0, 50000.0));
        settle(harness);
        std::size_t count = 0, corners = 0;
        for (const Culled::Leaf& leaf : harness.frame(true, false).leaves)
        {
            if (!isTown(leaf)) continue;
            ++count;
            corners += leaf.drawable->asGeometry()->getPrimitiveSet(0)->getNumIndices();
        }
        drawables.push_back(count);
        triangles.push_back(corners / 3);
    }
    ASSERT_GT(drawables[0], 2u);
    EXPECT_LE(drawables[1], drawables[0] + drawables[0] / 3 + 2);
    EXPECT_LE(static_cast<double>(triangles[1]), 1.6 * static_cast<double>(triangles[0]));
}

// Without effects, the kit and OpenSceneGraph's own traversal draw the same.
TEST_F(TownPictures, ArePlainOpenSceneGraphs)
{
    const std::string path = database(600, 1.0);
    load(path);
    const osg::ref_ptr<osg::Node> plain = osgDB::readRefNodeFile(path + "/terrain.osgb");
    const osg::Matrixd camera =
        view(WEST + 0.5 * PIXEL * COLUMNS, NORTH - 0.55 * PIXEL * ROWS, 1300.0, 0.3, -0.35);
    const osg::Matrixd projection = osg::Matrixd::perspective(40.0, 4.0 / 3.0, 10.0, 50000.0);
    std::vector<osg::ref_ptr<osg::Image>> images;
    for (osg::Node* scene : {static_cast<osg::Node*>(_scene.get()), plain.get()})
    {
        CullHarness harness(context(), scene, WIDTH, HEIGHT);
        harness.setCamera(camera, projection);
        EXPECT_GT(settle(harness), 5);
        const Culled culled = harness.frame(true);
        EXPECT_GT(std::count_if(culled.leaves.begin(), culled.leaves.end(), isTown), 3);
        images.push_back(culled.image);
    }
    EXPECT_TRUE(imagesMatch(*images[0], *images[1], {}));
    // Windows and roofs: many colors.
    std::set<std::tuple<int, int, int>> colors;
    for (int y = 0; y < HEIGHT; ++y)
        for (int x = 0; x < WIDTH; ++x)
        {
            const unsigned char* pixel = images[0]->data(static_cast<unsigned>(x), static_cast<unsigned>(y));
            colors.emplace(pixel[0] / 8, pixel[1] / 8, pixel[2] / 8);
        }
    EXPECT_GT(colors.size(), 60u);
}
