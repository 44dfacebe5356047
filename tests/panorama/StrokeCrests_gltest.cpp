// SPDX-License-Identifier: MIT
// SPDX-FileCopyrightText: 2026 the osgGeoFX authors
//
// Strokes on the crests of steep ridges, before the sky: none floats above the ground.
#include <osgGeoFX/offscreen/SceneRenderer.h>
#include <osgGeoFX/panorama/PanoramaMap.h>
#include <tools/GlFixture.h>
#include <tools/StrokeTiles.h>

#include <osg/CoordinateSystemNode>
#include <osg/Material>

#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <optional>
#include <vector>

using namespace osgGeoFX;
using namespace geofx::test;

namespace
{

constexpr int WIDTH = 640, HEIGHT = 360;

/// Teeth of rock along a ridge, as steep as forest grows.
double heightAt(double x, double y)
{
    const double crest = 2500.0 + 400.0 * std::sin(x / 900.0);
    const double tooth = 90.0 + 60.0 * std::sin(x / 110.0) * std::sin(x / 310.0);
    return 60.0 + 1.4 * std::max(tooth - 0.55 * std::abs(y - crest), 0.0);
}

class StrokeCrests : public GlFixture
{
protected:
    osg::ref_ptr<osg::Image> picture(bool strokes, bool sky) const
    {
        StrokeTiles tiles;
        tiles.height = heightAt;
        tiles.cells = 252;
        tiles.cover = [](double, double)
        {
            glsl::geofx_Cover cover = {};
            cover.trees = 0.5;
            cover.shore = -1000.0;
            return cover;
        };
        const osg::ref_ptr<osg::CoordinateSystemNode> terrain = new osg::CoordinateSystemNode;
        terrain->addChild(tiles.tile(-8000.0, -8000.0, 8000.0, 8000.0));
        // Without one OSG takes the color of whatever was drawn last.
        terrain->getOrCreateStateSet()->setAttributeAndModes(new osg::Material);
        std::string error;
        std::optional<Scene> scene = Scene::adopt(terrain, error);
        EXPECT_TRUE(scene) << error;
        const osg::ref_ptr<PanoramaMap> map = new PanoramaMap;
        map->setViewRadius(4000.0);
        map->setExaggeration(4.0);
        map->setStrokes(strokes);
        map->setSky(sky);
        map->setStrokeSize(8.0);
        map->setStrokeSpacing(6.0);
        scene->effects->addEffect(map);
        SceneRenderer::Options options;
        options.width = WIDTH;
        options.height = HEIGHT;
        const auto renderer = SceneRenderer::create(*scene, options, error);
        EXPECT_TRUE(renderer) << error;
        FrameStatistics unused;
        const osg::Matrixd view =
            osg::Matrixd::lookAt(osg::Vec3d(0.0, -6000.0, 4000.0), osg::Vec3d(), osg::Vec3d(0.0, 0.0, 1.0));
        osg::ref_ptr<osg::Image> image = renderer->render(view, 0.0, unused, error);
        EXPECT_TRUE(image) << error;
        return image;
    }
};

std::size_t at(int x, int y)
{
    return static_cast<std::size_t>(y) * WIDTH + static_cast<std::size_t>(x);
}

} // namespace

TEST_F(StrokeCrests, NoStrokeFloatsInTheSky)
{
    const osg::ref_ptr<osg::Image> bare = picture(false, true), skyless = picture(false, false),
                                   painted = picture(true, true);
    ASSERT_TRUE(bare && skyless && painted);
    const auto difference = [](const osg::Image& a, const osg::Image& b, int x, int y)
    {
        int most = 0;
        for (int i = 0; i < 3; ++i)
            most = std::max(most,
                            std::abs(a.data(static_cast<unsigned int>(x), static_cast<unsigned int>(y))[i] -
                                     b.data(static_cast<unsigned int>(x), static_cast<unsigned int>(y))[i]));
        return most;
    };
    std::vector<bool> ground(WIDTH * HEIGHT), stroke(WIDTH * HEIGHT);
    int ofGround = 0, ofStrokes = 0;
    for (int y = 0; y < HEIGHT; ++y)
        for (int x = 0; x < WIDTH; ++x)
        {
            ground[at(x, y)] = difference(*bare, *skyless, x, y) == 0;
            stroke[at(x, y)] = !ground[at(x, y)] && difference(*bare, *painted, x, y) > 25;
            ofGround += ground[at(x, y)] ? 1 : 0;
            ofStrokes += stroke[at(x, y)] ? 1 : 0;
        }
    ASSERT_GT(ofGround, WIDTH * HEIGHT / 3);
    ASSERT_LT(ofGround, 9 * WIDTH * HEIGHT / 10);
    ASSERT_GT(ofStrokes, 200) << "trees stand on the crest";

    // What is joined to the ground, over gaps of a pixel, pixel by pixel.
    std::vector<std::pair<int, int>> waiting;
    for (int y = 0; y < HEIGHT; ++y)
        for (int x = 0; x < WIDTH; ++x)
            if (ground[at(x, y)]) waiting.emplace_back(x, y);
    while (!waiting.empty())
    {
        const auto [x, y] = waiting.back();
        waiting.pop_back();
        for (int j = std::max(y - 2, 0); j <= std::min(y + 2, HEIGHT - 1); ++j)
            for (int i = std::max(x - 2, 0); i <= std::min(x + 2, WIDTH - 1); ++i)
                if (stroke[at(i, j)])
                {
                    stroke[at(i, j)] = false;
                    waiting.emplace_back(i, j);
                }
    }
    const auto floating = std::count(stroke.begin(), stroke.end(), true);
    EXPECT_EQ(floating, 0) << "of " << ofStrokes << " pixels of strokes before the sky";
}
