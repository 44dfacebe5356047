// SPDX-License-Identifier: MIT
// SPDX-FileCopyrightText: 2026 the osgGeoFX authors
//
// The mesh of a picture, drawn without any effect, against the picture: the same outlines and distances; files read back.
#include <osgGeoFX/deformation/BirdsEyeView.h>
#include <osgGeoFX/offscreen/SceneRenderer.h>
#include <osgGeoFX/panorama/PanoramaMap.h>
#include <osgGeoFX/print/PictureMesh.h>
#include <osgGeoFX/print/PlacePicture.h>
#include <tools/GlFixture.h>
#include <tools/OahuScene.h>
#include <tools/PanoramaHills.h>
#include <tools/SampledCases.h>
#include <tools/TempDir.h>

#include <osg/Material>
#include <osg/Math>
#include <osg/ValueObject>
#include <osgDB/ReadFile>

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <fstream>

using namespace osgGeoFX;
using namespace geofx::test;

namespace fs = std::filesystem;

namespace
{

constexpr int WIDTH = 240, HEIGHT = 160;

class PictureMeshTest : public GlFixture
{
protected:
    explicit PictureMeshTest(bool globe = true) : _globe(globe) {}

    void SetUp() override
    {
        GlFixture::SetUp();
        if (IsSkipped() || HasFatalFailure()) return;
        osg::Vec3d up(0.0, 0.0, 1.0), east(1.0, 0.0, 0.0);
        if (_globe)
        {
            up = _hills.middle();
            up.normalize();
            east = osg::Vec3d(0.0, 0.0, 1.0) ^ up;
            east.normalize();
        }
        _view = osg::Matrixd::lookAt(_hills.middle() + up * 6000.0 - (up ^ east) * 16000.0,
                                     _hills.middle() + up * 3000.0, up);
    }

    Scene scene(Effect* effect) const
    {
        std::string error;
        const osg::ref_ptr<osg::Node> terrain = _hills.terrain();
        terrain->getOrCreateStateSet()->setAttributeAndModes(new osg::Material);
        std::optional<Scene> result = Scene::adopt(terrain, error);
        EXPECT_TRUE(result) << error;
        if (effect) result->effects->addEffect(effect);
        return *result;
    }
    static osg::ref_ptr<PanoramaMap> map()
    {
        osg::ref_ptr<PanoramaMap> result = new PanoramaMap;
        result->setViewRadius(9000.0);
        result->setStrokes(false);
        return result;
    }

    /// The distances of a picture's pixels, rows downwards; negative where there is sky.
    struct Drawn
    {
        osg::ref_ptr<osg::Camera> camera;
        std::vector<double> distances;
    };
    Drawn draw(const Scene& scene, const osg::Matrixd& view) const
    {
        Scene whole = scene;
        const osg::ref_ptr<DepthReader> reader = whole.readDepths();
        SceneRenderer::Options drawing;
        drawing.width = WIDTH;
        drawing.height = HEIGHT;
        drawing.fieldOfView = 40.0;
        std::string error;
        const auto renderer = SceneRenderer::create(whole, drawing, error);
        EXPECT_TRUE(renderer) << error;
        FrameStatistics unused;
        EXPECT_TRUE(renderer->render(view, 0.0, unused, error)) << error;
        Drawn drawn;
        drawn.camera = new osg::Camera(renderer->camera());
        const PlacePicture places(*whole.effects, renderer->camera(), reader->pictures());
        for (int y = 0; y < HEIGHT; ++y)
            for (int x = 0; x < WIDTH; ++x)
                drawn.distances.push_back(places.distanceAt(x, y).value_or(-1.0));
        return drawn;
    }
    Drawn drawMesh(osg::Node* mesh, const osg::Matrixd& view) const
    {
        std::string error;
        const std::optional<Scene> plain = Scene::adopt(mesh, error);
        EXPECT_TRUE(plain) << error;
        return draw(*plain, view);
    }

    /// Compares within a pixel: each distance lies among those of the other picture's nine pixels.
    static void expectTheSame(const Drawn& a, const Drawn& b, int most)
    {
        int ground = 0, sky = 0, off = 0;
        for (int y = 1; y + 1 < HEIGHT; ++y)
        {
            for (int x = 1; x + 1 < WIDTH; ++x)
            {
                const auto at = [&](const Drawn& drawn, int dx, int dy)
                {
                    return drawn.distances[static_cast<std::size_t>((y + dy) * WIDTH + x + dx)];
                };
                const double here = at(a, 0, 0);
                (here < 0.0 ? sky : ground) += 1;
                double low = HUGE_VAL, high = -HUGE_VAL;
                bool sees = false;
                for (int dy = -1; dy <= 1; ++dy)
                {
                    for (int dx = -1; dx <= 1; ++dx)
                    {
                        const double there = at(b, dx, dy);
                        sees = sees || there < 0.0;
                        if (there < 0.0) continue;
                        low = std::min(low, there);
                        high = std::max(high, there);
                    }
                }
                const double room = 1e-3 * here;
                off += here < 0.0 ? !sees : !(here >= low - room && here <= high + room);
            }
        }
        EXPECT_GT(ground, WIDTH * HEIGHT / 4);
        EXPECT_GT(sky, WIDTH * HEIGHT / 40);
        EXPECT_LE(off, most);
    }
    std::string file(const std::string& name) const { return (fs::path(_folder.path()) / name).string(); }

    TempDir _folder;
    const bool _globe;
    const PanoramaHills _hills{_globe ? std::optional<double>(0.65) : std::nullopt};
    osg::Matrixd _view;
};

class MeshOfGround : public PictureMeshTest, public ::testing::WithParamInterface<bool>
{
protected:
    MeshOfGround() : PictureMeshTest(GetParam()) {}
};

} // namespace

TEST_P(MeshOfGround, HasTheOutlinesOfThePicture)
{
    const osg::ref_ptr<BirdsEyeView> bird = new BirdsEyeView;
    bird->setFocusLine(0.3);
    bird->setHorizonLine(0.8);
    for (const osg::ref_ptr<Effect>& effect : std::vector<osg::ref_ptr<Effect>>{nullptr, bird, map()})
    {
        SCOPED_TRACE(effect ? effect->className() : "plain");
        const Scene drawn = scene(effect);
        const Drawn picture = draw(drawn, _view);
        const PictureMesh mesh(*drawn.effects, *picture.camera, drawn.reference);
        EXPECT_GT(mesh.triangles(), 1000u);
        const Drawn again = drawMesh(mesh.node(), mesh.view());
        expectTheSame(picture, again, WIDTH * HEIGHT / 2000);
        expectTheSame(again, picture, WIDTH * HEIGHT / 2000);
        // Floats near the origin: the coordinates are small.
        EXPECT_LT(mesh.node()->getBound().center().length() + mesh.node()->getBound().radius(), 300000.0f);
    }
}

TEST_F(PictureMeshTest, IsReadBackFromFiles)
{
    const Scene drawn = scene(map());
    const Drawn picture = draw(drawn, _view);
    const PictureMesh mesh(*drawn.effects, *picture.camera, drawn.reference);
    for (const char* const name : {"ground.osgb", "ground.obj"})
    {
        SCOPED_TRACE(name);
        std::string error;
        ASSERT_TRUE(mesh.write(file(name), error)) << error;
        const osg::ref_ptr<osg::Node> read = osgDB::readRefNodeFile(file(name));
        ASSERT_TRUE(read);
        // OSG turns the y axis of an .obj upwards to z, as modelling programs do.
        const Drawn again = drawMesh(read, mesh.view());
        expectTheSame(picture, again, WIDTH * HEIGHT / 1000);
    }
    osg::Matrixd frame;
    const osg::ref_ptr<osg::Node> node = osgDB::readRefNodeFile(file("ground.osgb"));
    ASSERT_TRUE(node && node->getUserValue("geofx.frame", frame));
    EXPECT_EQ(frame, mesh.frame());
    std::ifstream stream(file("ground.obj"));
    const std::string text{std::istreambuf_iterator<char>(stream), std::istreambuf_iterator<char>()};
    for (const char* const told : {"# frame", "# view", "# projection", "mtllib ground.mtl", "usemtl "})
        EXPECT_NE(text.find(told), std::string::npos) << told;
}

TEST_F(PictureMeshTest, FaultsAreSentences)
{
    const Scene drawn = scene(nullptr);
    const Drawn picture = draw(drawn, _view);
    const PictureMesh mesh(*drawn.effects, *picture.camera, drawn.reference);
    fs::create_directory(file("folder.obj"));
    for (const std::string& wrong :
         {file("ground.xyz"), file("ground"), file("none/ground.obj"), file("folder.obj")})
    {
        std::string error;
        EXPECT_FALSE(mesh.write(wrong, error));
        EXPECT_EQ(error.rfind("\"" + wrong + "\"", 0), 0u) << error;
        EXPECT_EQ(error.back(), '.');
    }
    // The camera looks up.
    picture.camera->setViewMatrix(_view * osg::Matrixd::rotate(osg::PI, osg::X_AXIS));
    std::string error;
    EXPECT_FALSE(PictureMesh(*drawn.effects, *picture.camera, drawn.reference).write(file("sky.obj"), error));
    EXPECT_NE(error.find("no ground"), std::string::npos) << error;
}

// Tiles of a database at the levels of detail that the picture has; each has its texture.
TEST_F(PictureMeshTest, HasTheTilesOfADatabase)
{
    std::optional<Scene> oahu = loadOahu("oahu");
    ASSERT_TRUE(oahu && oahu->reference);
    osg::Matrixd frame;
    ASSERT_TRUE(oahu->reference->localToWorld(osg::DegreesToRadians(-157.9), osg::DegreesToRadians(21.25),
                                              6000.0, frame));
    const osg::Matrixd view =
        osg::Matrixd::inverse(osg::Matrixd::rotate(osg::DegreesToRadians(75.0), osg::X_AXIS) * frame);
    while (oahu->effects->getNumEffects() > 0)
        oahu->effects->removeEffect(oahu->effects->getEffect(0));
    const osg::ref_ptr<PanoramaMap> panorama = map();
    panorama->setDetail(0.3);
    oahu->effects->addEffect(panorama);
    const Drawn picture = draw(*oahu, view);
    const PictureMesh mesh(*oahu->effects, *picture.camera, oahu->reference);
    std::string error;
    ASSERT_TRUE(mesh.write(file("oahu.osgb"), error)) << error;
    const osg::ref_ptr<osg::Node> read = osgDB::readRefNodeFile(file("oahu.osgb"));
    ASSERT_TRUE(read);
    const Drawn again = drawMesh(read, mesh.view());
    expectTheSame(picture, again, WIDTH * HEIGHT / 500);
    ASSERT_TRUE(mesh.write(file("oahu.obj"), error)) << error;
    int textures = 0;
    for (const auto& entry : fs::directory_iterator(file("oahu.textures")))
        textures += entry.path().extension() == ".png" ? 1 : 0;
    EXPECT_GT(textures, 3);
}

INSTANTIATE_TEST_SUITE_P(Ground, MeshOfGround, ::testing::ValuesIn(sampledCases<bool>({false, true}, 2)),
                         [](const auto& each) { return each.param ? "Globe" : "Plane"; });
