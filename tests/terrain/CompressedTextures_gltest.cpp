// SPDX-License-Identifier: MIT
// SPDX-FileCopyrightText: 2026 the osgGeoFX authors
// A database with compressed textures looks as one without does: to plain OpenSceneGraph and under effects.
#include <osgGeoFX/deformation/BirdsEyeView.h>
#include <osgGeoFX/offscreen/SceneRenderer.h>
#include <osgGeoFX/panorama/PanoramaMap.h>
#include <osgGeoFX/scene/EffectScene.h>
#include <osgGeoFX/terrain/DatabaseBuilder.h>
#include <osgGeoFX/viewer/Scene.h>
#include <tools/GlFixture.h>
#include <tools/ImageComparison.h>
#include <tools/TempDir.h>
#include <tools/TestRasters.h>

#include <osg/LightSource>
#include <osgDB/ReadFile>
#include <osgDB/WriteFile>

#include <algorithm>
#include <cmath>

using namespace osgGeoFX;
using namespace geofx::test;

namespace
{

/// From the south, over the middle.
const osg::Vec3d eye(602250.0, 2394000.0, 2600.0), look(602250.0, 2397900.0, 100.0), up(0.0, 0.0, 1.0);

struct Difference
{
    double mean = 0.0, most = 0.0; ///< of 255; `most` of all but a thousandth of the channels
};

Difference differenceOf(const osg::Image& a, const osg::Image& b)
{
    std::vector<int> values;
    double sum = 0.0;
    for (unsigned int i = 0; i < a.getTotalSizeInBytes(); ++i)
    {
        values.push_back(std::abs(a.data()[i] - b.data()[i]));
        sum += values.back();
    }
    const std::size_t rank = values.size() - values.size() / 1000 - 1;
    std::nth_element(values.begin(), values.begin() + static_cast<std::ptrdiff_t>(rank), values.end());
    return {sum / static_cast<double>(values.size()), static_cast<double>(values[rank])};
}

class CompressedTextures : public GlFixture
{
protected:
    CompressedTextures() : GlFixture(200, 150) {}

    void SetUp() override
    {
        GlFixture::SetUp();
        if (IsSkipped() || HasFatalFailure()) return;
        BuildOptions options;
        options.dems = {TestRaster(150, 150)
                            .placed(600000.0, 2400000.0, 30.0, 30.0)
                            .crs("EPSG:32604")
                            .fill([](int column, int row, int) { return 0.4 * relief(column, row); })
                            .write(_folder / "dem.tif")};
        options.imagery = {TestRaster(300, 300, 3, GDT_Byte)
                               .placed(600000.0, 2400000.0, 15.0, 15.0)
                               .crs("EPSG:32604")
                               .fill(
                                   [](int column, int row, int band)
                                   {
                                       return 140 +
                                              std::lround(80.0 * std::sin(0.015 * column + 0.4 * band) *
                                                          std::cos(0.012 * row)) +
                                              (column * 7919 + row * 104729) % 7;
                                   })
                               .write(_folder / "image.tif")};
        options.epsg = 32604;
        options.tileSize = 32;
        for (const bool compress : {false, true})
        {
            options.compressTextures = compress;
            options.output = (_folder / (compress ? "small" : "plain")).string();
            buildDatabase(options);
        }
    }

    /// The terrain from the south, all tiles that the view deserves.
    osg::ref_ptr<osg::Image> draw(const char* database, Effect* effect)
    {
        const std::string file = (_folder / database / "terrain.osgb").string();
        std::string error;
        std::optional<Scene> loaded = Scene::load(file, error);
        EXPECT_TRUE(loaded) << error;
        if (!loaded) return nullptr;
        if (effect) loaded->effects->addEffect(effect);
        SceneRenderer::Options options;
        options.width = 480;
        options.height = 360;
        options.fieldOfView = 40.0;
        options.countTriangles = true;
        const auto renderer = SceneRenderer::create(*loaded, options, error);
        EXPECT_TRUE(renderer) << error;
        if (!renderer) return nullptr;
        FrameStatistics statistics;
        const osg::Matrixd view = osg::Matrixd::lookAt(eye, look, up);
        osg::ref_ptr<osg::Image> image = renderer->render(view, 0.0, statistics, error);
        EXPECT_TRUE(image.valid()) << error;
        EXPECT_GT(statistics.tilesLoaded, 1u);
        return image;
    }

    void expectAlike(const std::function<osg::ref_ptr<Effect>()>& effect, const std::string& name)
    {
        const osg::ref_ptr<Effect> first = effect(), second = effect();
        const osg::ref_ptr<osg::Image> plain = draw("plain", first);
        const osg::ref_ptr<osg::Image> small = draw("small", second);
        ASSERT_TRUE(plain && small);
        osgDB::writeImageFile(*plain, (testOutputFolder() / (name + " plain.png")).string());
        osgDB::writeImageFile(*small, (testOutputFolder() / (name + ".png")).string());
        const Difference difference = differenceOf(*small, *plain);
        EXPECT_LE(difference.mean, 1.5) << name;
        EXPECT_LE(difference.most, 24.0) << name;
        // Blocks were decoded, and colors of many kinds are in sight.
        EXPECT_GT(difference.mean, 0.05) << name;
        RecordProperty(name, std::to_string(difference.mean) + " " + std::to_string(difference.most));
    }

    const TempDir _folder;
};

TEST_F(CompressedTextures, LookAlike)
{
    expectAlike([] { return osg::ref_ptr<Effect>(); }, "without effects");
}

TEST_F(CompressedTextures, LookAlikeWhenBent)
{
    expectAlike(
        []
        {
            osg::ref_ptr<BirdsEyeView> bend = new BirdsEyeView;
            bend->setFocusLine(0.35);
            bend->setHorizonLine(0.9);
            return osg::ref_ptr<Effect>(bend);
        },
        "bent");
}

TEST_F(CompressedTextures, LookAlikeAsAPanorama)
{
    expectAlike([] { return osg::ref_ptr<Effect>(new PanoramaMap); }, "panorama");
}

/// By the database's own program, with a lamp. A message of OpenGL or OSG, as of an image that cannot be uploaded, fails the test.
TEST_F(CompressedTextures, PlainOpenSceneGraph)
{
    viewer().getCamera()->setViewMatrixAsLookAt(eye, look, up);
    viewer().getCamera()->setProjectionMatrixAsPerspective(40.0, 4.0 / 3.0, 100.0, 20000.0);
    viewer().setLightingMode(osg::View::SKY_LIGHT);
    osg::ref_ptr<osg::Image> pictures[2];
    for (const bool compress : {false, true})
    {
        const osg::ref_ptr<osg::Node> root =
            osgDB::readRefNodeFile((_folder / (compress ? "small" : "plain") / "terrain.osgb").string());
        ASSERT_TRUE(root.valid());
        pictures[compress] = render(root);
        ASSERT_TRUE(pictures[compress].valid());
    }
    const Difference difference = differenceOf(*pictures[1], *pictures[0]);
    EXPECT_LE(difference.mean, 1.5);
    EXPECT_LE(difference.most, 24.0);
    EXPECT_GT(difference.mean, 0.05);
}

} // namespace
