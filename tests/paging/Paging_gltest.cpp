// SPDX-License-Identifier: MIT
// SPDX-FileCopyrightText: 2026 the osgGeoFX authors
// Paging: all tiles arrive, the same call gives the same bytes, and a bad tile leaves its parent on screen.
#include <osgGeoFX/offscreen/SceneRenderer.h>
#include <osgGeoFX/paging/PagerMonitor.h>
#include <osgGeoFX/viewer/Scene.h>
#include <tools/GlFixture.h>
#include <tools/ImageComparison.h>
#include <tools/PagedScene.h>
#include <tools/TempDir.h>

#include <osg/PagedLOD>
#include <osgDB/Callbacks>
#include <osgDB/ReadFile>
#include <osgDB/Registry>

#include <fstream>
#include <iterator>

using geofx::test::GlFixture;
using geofx::test::imagesMatch;
using geofx::test::PagedScene;
using geofx::test::TempDir;
using osgGeoFX::Scene;
using osgGeoFX::SceneRenderer;

namespace fs = std::filesystem;

namespace
{

constexpr int size = 128;
const osg::Vec3i red(255, 0, 0);
const osg::Vec3i green(0, 255, 0);
const osg::Vec3i blue(0, 0, 255);

/// Down from 8 km: the square of 4 km fills most of the picture, north is up.
osg::Matrixd fromAbove(double height = 8000.0)
{
    return osg::Matrixd::lookAt(osg::Vec3d(0.0, 0.0, height), osg::Vec3d(), osg::Vec3d(0.0, 1.0, 0.0));
}

SceneRenderer::Options rendererOptions()
{
    SceneRenderer::Options options;
    options.width = size;
    options.height = size;
    options.countTriangles = true;
    options.timeout = 60.0;
    return options;
}

osg::Vec3i pixel(const osg::Image& image, int x, int y)
{
    const unsigned char* p = image.data(x, y);
    return osg::Vec3i(p[0], p[1], p[2]);
}

/// Colors at the middles of the quadrants: south-west, south-east, north-west, north-east.
std::vector<osg::Vec3i> quadrants(const osg::Image& image)
{
    return {pixel(image, 48, 48), pixel(image, 80, 48), pixel(image, 48, 80), pixel(image, 80, 80)};
}

std::string contentOf(const fs::path& file)
{
    std::ifstream stream(file, std::ios::binary);
    return {std::istreambuf_iterator<char>(stream), std::istreambuf_iterator<char>()};
}

void replace(const fs::path& file, const std::string& content)
{
    std::ofstream(file, std::ios::binary) << content;
}

class Paging : public GlFixture
{
protected:
    Scene load(const fs::path& file)
    {
        std::string error;
        std::optional<Scene> scene = Scene::load(file.string(), error);
        EXPECT_TRUE(scene) << error;
        return scene.value_or(Scene());
    }

    osg::ref_ptr<osg::Image> renderOnce(const Scene& scene, osgGeoFX::FrameStatistics& statistics,
                                        const SceneRenderer::Options& options = rendererOptions())
    {
        std::string error;
        const auto renderer = SceneRenderer::create(scene, options, error);
        EXPECT_TRUE(renderer) << error;
        osg::ref_ptr<osg::Image> image =
            renderer ? renderer->render(fromAbove(), 0.0, statistics, error) : nullptr;
        EXPECT_TRUE(image.valid()) << error;
        return image;
    }

    TempDir _folder;
};

struct Damage
{
    const char* name;
    std::function<void(const fs::path&)> inflict;
};

std::ostream& operator<<(std::ostream& stream, const Damage& damage)
{
    return stream << damage.name;
}

class DamagedTile : public Paging, public ::testing::WithParamInterface<Damage>
{
};

} // namespace

TEST_F(Paging, AllTilesArriveAndAreCounted)
{
    const Scene scene = load(PagedScene::write(_folder.path(), PagedScene::Kind::Flat));
    osgGeoFX::FrameStatistics statistics;
    const osg::ref_ptr<osg::Image> image = renderOnce(scene, statistics);
    ASSERT_TRUE(image.valid());
    EXPECT_EQ(quadrants(*image), std::vector<osg::Vec3i>(4, blue));
    std::uint64_t bytes = 0;
    for (const auto& file : fs::directory_iterator(_folder / "tiles"))
        bytes += file.file_size();
    EXPECT_EQ(statistics.tilesLoaded, 5u);
    EXPECT_EQ(statistics.bytesRead, bytes);
    EXPECT_EQ(statistics.tilesDrawn, 16u);
    EXPECT_EQ(statistics.drawables, 16u);
    EXPECT_EQ(statistics.triangles, 32u);
    EXPECT_GT(statistics.totalMilliseconds, 0.0);
}

TEST_F(Paging, DoesNotWaitWhenToldSo)
{
    const Scene scene = load(PagedScene::write(_folder.path(), PagedScene::Kind::Flat));
    SceneRenderer::Options options = rendererOptions();
    options.waitForTiles = false;
    osgGeoFX::FrameStatistics statistics;
    const osg::ref_ptr<osg::Image> image = renderOnce(scene, statistics, options);
    ASSERT_TRUE(image.valid());
    EXPECT_EQ(quadrants(*image), std::vector<osg::Vec3i>(4, red));
}

TEST_F(Paging, SaysWhenTilesDoNotArriveInTime)
{
    const Scene scene = load(PagedScene::write(_folder.path(), PagedScene::Kind::Flat));
    SceneRenderer::Options options = rendererOptions();
    options.timeout = 1e-6;
    std::string error;
    const auto renderer = SceneRenderer::create(scene, options, error);
    ASSERT_TRUE(renderer) << error;
    osgGeoFX::FrameStatistics statistics;
    EXPECT_FALSE(renderer->render(fromAbove(), 0.0, statistics, error).valid());
    EXPECT_NE(error.find("did not arrive"), std::string::npos) << error;
}

TEST_F(Paging, SameCallGivesSameBytesWithAndWithoutCulling)
{
    const fs::path file = PagedScene::write(_folder.path(), PagedScene::Kind::Flat);
    osgGeoFX::FrameStatistics statistics;
    const osg::ref_ptr<osg::Image> first = renderOnce(load(file), statistics);
    ASSERT_TRUE(first.valid());
    for (const bool cull : {true, false})
    {
        SceneRenderer::Options options = rendererOptions();
        options.cull = cull;
        const osg::ref_ptr<osg::Image> again = renderOnce(load(file), statistics, options);
        ASSERT_TRUE(again.valid());
        EXPECT_TRUE(imagesMatch(*again, *first, {}, cull ? "culled" : "not culled"));
    }
}

TEST_F(Paging, NoCullDrawsWhatIsOutsideTheFrustum)
{
    const fs::path file = PagedScene::write(_folder.path(), PagedScene::Kind::Flat);
    const osg::Matrixd away = osg::Matrixd::lookAt(
        osg::Vec3d(15000.0, 0.0, 1000.0), osg::Vec3d(15000.0, 1000.0, 1000.0), osg::Vec3d(0.0, 0.0, 1.0));
    for (const bool cull : {true, false})
    {
        SceneRenderer::Options options = rendererOptions();
        options.cull = cull;
        std::string error;
        const auto renderer = SceneRenderer::create(load(file), options, error);
        ASSERT_TRUE(renderer) << error;
        osgGeoFX::FrameStatistics statistics;
        ASSERT_TRUE(renderer->render(away, 0.0, statistics, error).valid()) << error;
        EXPECT_EQ(statistics.tilesLoaded, cull ? 0u : 5u);
        // The four tiles wholly behind the eye are left out by OSG in any case: they have no place in near and far.
        EXPECT_EQ(statistics.tilesDrawn, cull ? 0u : 12u);
    }
}

TEST_F(Paging, LodScaleFollowsTheScreen)
{
    const Scene scene = load(PagedScene::write(_folder.path(), PagedScene::Kind::Geocentric));
    ASSERT_TRUE(scene.terrain);
    const osg::Matrixd placement = PagedScene::placement(PagedScene::Kind::Geocentric);
    const auto levelFrom = [&](double height, int pixels)
    {
        SceneRenderer::Options options = rendererOptions();
        options.width = pixels;
        options.height = pixels;
        std::string error;
        const auto renderer = SceneRenderer::create(scene, options, error);
        osgGeoFX::FrameStatistics statistics;
        renderer->render(osg::Matrixd::inverse(placement) * fromAbove(height), 0.0, statistics, error);
        return statistics.tilesDrawn == 16 ? 2 : statistics.tilesDrawn == 4 ? 1 : 0;
    };
    EXPECT_EQ(levelFrom(19000.0, 64), 2);
    EXPECT_EQ(levelFrom(21000.0, 64), 1) << "a small picture must not be coarser than the database's ranges";
    // 2200 pixels over 30 degrees are 4105 per radian, twice the 2077 that the database was made for.
    EXPECT_EQ(levelFrom(38000.0, 2200), 2);
    EXPECT_EQ(levelFrom(42000.0, 2200), 1);
}

TEST_P(DamagedTile, LeavesItsParentOnScreenWithOneWarning)
{
    const fs::path file = PagedScene::write(_folder.path(), PagedScene::Kind::Flat);
    GetParam().inflict(_folder / "tiles" / "1_1_0.osgb");
    const Scene scene = load(file);
    osg::ref_ptr<osg::Image> image;
    const std::vector<std::string> warnings = watch().messagesOf(
        [&]
        {
            std::string error;
            const auto renderer = SceneRenderer::create(scene, rendererOptions(), error);
            ASSERT_TRUE(renderer) << error;
            osgGeoFX::FrameStatistics statistics;
            for (int i = 0; i < 3; ++i)
            {
                image = renderer->render(fromAbove(8000.0 + i), i, statistics, error);
                ASSERT_TRUE(image.valid()) << error;
            }
            EXPECT_EQ(statistics.tilesDrawn, 13u);
        });
    ASSERT_TRUE(image.valid());
    const std::vector<osg::Vec3i> expected = {blue, green, blue, blue};
    EXPECT_EQ(quadrants(*image), expected);
    ASSERT_EQ(warnings.size(), 1u) << ::testing::PrintToString(warnings);
    EXPECT_NE(warnings[0].find("1_1_0.osgb"), std::string::npos) << warnings[0];
    EXPECT_EQ(scene.guard->counts().tilesFailed, 1u);
    EXPECT_EQ(scene.guard->counts().tilesRead, 4u);
}

INSTANTIATE_TEST_SUITE_P(All, DamagedTile,
                         ::testing::Values(Damage{"Missing",
                                                  [](const fs::path& file)
                                                  {
                                                      fs::remove(file);
                                                  }},
                                           Damage{"Empty",
                                                  [](const fs::path& file)
                                                  {
                                                      replace(file, "");
                                                  }},
                                           Damage{"HalfHeader",
                                                  [](const fs::path& file)
                                                  {
                                                      replace(file, contentOf(file).substr(0, 14));
                                                  }},
                                           Damage{"Truncated",
                                                  [](const fs::path& file)
                                                  {
                                                      const std::string content = contentOf(file);
                                                      replace(file, content.substr(0, content.size() - 10));
                                                  }},
                                           Damage{"Garbage",
                                                  [](const fs::path& file)
                                                  {
                                                      replace(file, std::string(5000, '\x5a'));
                                                  }},
                                           Damage{"HugeCountsInHeader",
                                                  [](const fs::path& file)
                                                  {
                                                      std::string content = contentOf(file);
                                                      for (std::size_t i = 16; i < 28; ++i)
                                                          content[i] = '\x7f';
                                                      replace(file, content);
                                                  }},
                                           Damage{"FlippedBit",
                                                  [](const fs::path& file)
                                                  {
                                                      std::string content = contentOf(file);
                                                      content[content.size() / 2] =
                                                          static_cast<char>(content[content.size() / 2] ^ 4);
                                                      replace(file, content);
                                                  }},
                                           Damage{"NotANode",
                                                  [](const fs::path& file)
                                                  {
                                                      replace(file, std::string("#Ascii Image"));
                                                  }}),
                         [](const ::testing::TestParamInfo<Damage>& damage)
                         { return std::string(damage.param.name); });

/// The pager asks as long as the stand-in is in sight.
TEST_F(Paging, TilesOfADiskThatIsAwayForAMomentComeWhenItIsBack)
{
    const Scene scene = load(PagedScene::write(_folder.path(), PagedScene::Kind::Flat));
    const fs::path tiles = _folder / "tiles", away = _folder / "away";
    fs::rename(tiles, away);
    using Clock = std::chrono::steady_clock;
    const Clock::time_point start = Clock::now();
    std::string error;
    std::unique_ptr<SceneRenderer> renderer;
    osg::ref_ptr<osg::Image> image;
    int frame = 0;
    const auto draw = [&]
    {
        osgGeoFX::FrameStatistics statistics;
        image = renderer->render(fromAbove(), frame, statistics, error);
        ++frame;
        ASSERT_TRUE(image.valid()) << error;
    };
    const std::vector<std::string> warnings = watch().messagesOf(
        [&]
        {
            renderer = SceneRenderer::create(scene, rendererOptions(), error);
            ASSERT_TRUE(renderer) << error;
            while (Clock::now() < start + std::chrono::milliseconds(800))
                draw();
        });
    EXPECT_EQ(warnings.size(), 1u) << ::testing::PrintToString(warnings);
    EXPECT_EQ(quadrants(*image), std::vector<osg::Vec3i>(4, red));
    fs::rename(away, tiles);
    const std::vector<osg::Vec3i> finest(4, blue);
    while (quadrants(*image) != finest && Clock::now() < start + std::chrono::seconds(10))
        draw();
    EXPECT_EQ(quadrants(*image), finest);
}

TEST_F(Paging, BadTileIsHarmlessInEveryThreadingModel)
{
    const fs::path file = PagedScene::write(_folder.path(), PagedScene::Kind::Flat);
    replace(_folder / "tiles" / "1_0_1.osgb", "garbage");
    using Viewer = osgViewer::Viewer;
    for (auto model : {Viewer::SingleThreaded, Viewer::CullDrawThreadPerContext, Viewer::DrawThreadPerContext,
                       Viewer::CullThreadPerCameraDrawThreadPerContext})
    {
        const Scene scene = load(file);
        osg::ref_ptr<osg::GraphicsContext::Traits> traits = new osg::GraphicsContext::Traits;
        traits->width = size;
        traits->height = size;
        osg::ref_ptr<osgGeoFX::EglGraphicsContext> context = new osgGeoFX::EglGraphicsContext(traits);
        Viewer viewer;
        viewer.setThreadingModel(model);
        viewer.getCamera()->setGraphicsContext(context);
        viewer.getCamera()->setViewport(0, 0, size, size);
        viewer.getCamera()->setProjectionMatrixAsPerspective(30.0, 1.0, 1.0, 1e5);
        viewer.getCamera()->setViewMatrix(fromAbove());
        viewer.setSceneData(scene.node);
        const auto capture = osgGeoFX::ImageCapture::attach(viewer.getCamera());
        osgGeoFX::PagerMonitor monitor(viewer.getDatabasePager(), scene.guard.get(), 5);
        const std::vector<std::string> warnings = watch().messagesOf(
            [&]
            {
                int frames = 0;
                do
                {
                    viewer.frame();
                    monitor.waitForReads(1.0);
                } while (!monitor.frameFinished() && ++frames < 1000);
                EXPECT_GT(frames, 0) << "the first frame cannot have had all tiles";
                EXPECT_LT(frames, 1000) << "the pager asks for the bad tile again and again";
            });
        capture->request();
        viewer.frame();
        const osg::ref_ptr<osg::Image> image = capture->take();
        ASSERT_TRUE(image.valid());
        const std::vector<osg::Vec3i> expected = {blue, blue, green, blue};
        EXPECT_EQ(quadrants(*image), expected) << "threading model " << model;
        EXPECT_EQ(warnings.size(), 1u) << ::testing::PrintToString(warnings);
        EXPECT_EQ(monitor.takeProgress().tilesLoaded, 4u);
        EXPECT_EQ(monitor.takeProgress().tilesLoaded, 0u);
    }
}

TEST_F(Paging, GuardKeepsAnotherReadCallback)
{
    struct Counter : public osgDB::ReadFileCallback
    {
        osgDB::ReaderWriter::ReadResult readNode(const std::string& file,
                                                 const osgDB::Options* options) override
        {
            ++count;
            return osgDB::ReadFileCallback::readNode(file, options);
        }
        std::atomic<int> count{0};
    };
    const fs::path file = PagedScene::write(_folder.path(), PagedScene::Kind::Flat);
    osg::ref_ptr<osg::Node> node = osgDB::readRefNodeFile(file.string());
    ASSERT_TRUE(node.valid());
    osg::ref_ptr<Counter> counter = new Counter;
    osg::ref_ptr<osgDB::Options> options = new osgDB::Options;
    options->setReadFileCallback(counter);
    auto* lod = dynamic_cast<osg::PagedLOD*>(node->asGroup()->getChild(0));
    ASSERT_NE(lod, nullptr);
    lod->setDatabaseOptions(options);

    std::string error;
    const std::optional<Scene> scene = Scene::adopt(node, error);
    ASSERT_TRUE(scene) << error;
    EXPECT_EQ(osgGeoFX::TileGuard::install(node), scene->guard) << "a second guard";
    osgGeoFX::FrameStatistics statistics;
    ASSERT_TRUE(renderOnce(*scene, statistics).valid());
    EXPECT_EQ(counter->count, 1) << "the file of the PagedLOD that has the callback";
    EXPECT_EQ(scene->guard->counts().tilesRead, 5u);
}

TEST_F(Paging, AFailedTileThatIsAskedForAgainIsAnsweredSilently)
{
    const Scene scene = load(PagedScene::write(_folder.path(), PagedScene::Kind::Flat));
    auto* lod = dynamic_cast<osg::PagedLOD*>(scene.effects->getChild(0)->asGroup()->getChild(0));
    ASSERT_NE(lod, nullptr);
    auto* options = dynamic_cast<osgDB::Options*>(lod->getDatabaseOptions());
    ASSERT_NE(options, nullptr);
    const auto read = [&](const std::string& file)
    {
        return watch().messagesOf(
            [&] { EXPECT_TRUE(osgDB::Registry::instance()->readNode(file, options, false).validNode()); });
    };
    EXPECT_EQ(read("gone.osgb").size(), 1u);
    EXPECT_EQ(read("gone.osgb").size(), 0u);
    EXPECT_EQ(read("gone too.osgb").size(), 1u);
    EXPECT_EQ(scene.guard->failedFiles(), (std::set<std::string>{"gone.osgb", "gone too.osgb"}));
}
