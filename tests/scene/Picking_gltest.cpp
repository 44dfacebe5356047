// SPDX-License-Identifier: MIT
// SPDX-FileCopyrightText: 2026 the osgGeoFX authors
//
// Picking through the deformation: pixel → ground → pixel, against what the GPU drew at the pixel, and that the ground is the
// terrain's. Where the GPU drew sky there is nothing to be picked, and what is picked is something that was drawn.
#include <tools/CullHarness.h>
#include <tools/GlFixture.h>
#include <tools/OahuScene.h>

#include <osg/Geometry>
#include <osgGeoFX/deformation/BirdsEyeView.h>
#include <osgGeoFX/paging/TerrainInfo.h>
#include <osgGeoFX/scene/DeformedView.h>
#include <osgUtil/LineSegmentIntersector>

#include <algorithm>
#include <cmath>
#include <set>
#include <utility>

using namespace osgGeoFX;
using namespace geofx::test;

namespace
{

constexpr int WIDTH = 240, HEIGHT = 180;

class Picking : public GlFixture, public ::testing::WithParamInterface<OahuCase>
{
protected:
    Picking() : GlFixture(WIDTH, HEIGHT) {}
};

/// Eye depth from a depth buffer's value, metres.
double depthOf(float value, const osg::Matrixd& projection)
{
    osg::Matrixd inverse;
    inverse.invert(projection);
    return -(osg::Vec3d(0.0, 0.0, 2.0 * static_cast<double>(value) - 1.0) * inverse).z();
}

float valueAt(const osg::Image& depths, int x, int y)
{
    return *reinterpret_cast<const float*>(
        depths.data(static_cast<unsigned int>(x), static_cast<unsigned int>(y)));
}

/// Whether a pixel and all around it show sky.
bool skyAround(const osg::Image& depths, int x, int y)
{
    for (int row = std::max(y - 1, 0); row <= std::min(y + 1, HEIGHT - 1); ++row)
    {
        for (int column = std::max(x - 1, 0); column <= std::min(x + 1, WIDTH - 1); ++column)
            if (valueAt(depths, column, row) < 1.0f) return false;
    }
    return true;
}

/// How many pixels divided triangles may be off; 0 where none are divided.
double pixelsOff(const EffectScene& scene)
{
    for (unsigned int i = 0; i < scene.getNumEffects(); ++i)
    {
        const auto* bend = dynamic_cast<const PerspectiveBend*>(scene.getEffect(i));
        if (bend && bend->tessellates()) return bend->getTessellationPixels();
    }
    return 0.0;
}

/// By how much depths change within half a pixel of a point of the picture, metres; endless beside the sky.
double footprintAt(const DeformedView& picture, double x, double y, double depth)
{
    double most = 0.0;
    for (const auto& [right, up] :
         {std::pair(0.5, 0.0), std::pair(-0.5, 0.0), std::pair(0.0, 0.5), std::pair(0.0, -0.5)})
    {
        const auto hit = picture.pick(x + right, y + up);
        if (!hit) return HUGE_VAL;
        most = std::max(most, std::abs(-hit->deformed.z() - depth));
    }
    return most;
}

} // namespace

TEST_P(Picking, PixelToGroundToPixel)
{
    const std::optional<Scene> oahu = loadOahu(GetParam().database);
    if (!oahu) return;
    CullHarness harness(context(), oahu->effects, WIDTH, HEIGHT);
    const int cameras = fullTest() ? GetParam().many : GetParam().few;
    const int pixels = 20;
    int checked = 0;
    int inZone = 0;
    int sky = 0;
    int footprints = 0;
    int gathered = 0;
    double worst = 0.0;
    for (int camera = 0; camera < cameras; ++camera)
    {
        SCOPED_TRACE("camera " + std::to_string(camera));
        Random random(static_cast<std::uint64_t>(camera) + 1000);
        GetParam().addEffects(*oahu->effects, random);
        const osg::Matrixd view = randomOahuView(random, *oahu->reference);
        // Near and far as close as may be, for the depth buffer's sake.
        const double half = 50.0 * std::tan(random.uniform(0.2, 0.7));
        const osg::Matrixd projection =
            osg::Matrixd::frustum(-half * WIDTH / HEIGHT, half * WIDTH / HEIGHT, -half, half, 50.0, 2e5);
        harness.setCamera(view, projection);
        for (int step = 0; step < 4; ++step)
            CullHarness::load(harness.frame(true, false).requests, random, 1.0);
        harness.frame(true);
        osg::ref_ptr<osg::Image> depths = new osg::Image;
        depths->readPixels(0, 0, WIDTH, HEIGHT, GL_DEPTH_COMPONENT, GL_FLOAT);

        const DeformedView picture(*oahu->effects, view, projection, WIDTH, HEIGHT);
        for (int i = 0; i < pixels; ++i)
        {
            const int x = random.integer(0, WIDTH - 1);
            const int y = random.integer(0, HEIGHT - 1);
            const float depth = valueAt(*depths, x, y);
            const auto hit = picture.pick(x + 0.5, y + 0.5);
            // What lies before the near plane can be picked, and is not drawn.
            if (hit && -hit->deformed.z() < 50.0) continue;
            if (depth >= 1.0f)
            {
                // At the skyline the pixel's middle may just miss what its neighbours show.
                if (!skyAround(*depths, x, y)) continue;
                ++sky;
                EXPECT_FALSE(hit) << "the sky at pixel " << x << ' ' << y << " is ground "
                                  << (hit ? -hit->deformed.z() : 0.0) << " m away";
                continue;
            }
            double longitude = 0.0;
            double latitude = 0.0;
            double height = 0.0;
            ASSERT_TRUE(hit) << "pixel " << x << ' ' << y;
            ASSERT_TRUE(picture.unproject(x + 0.5, y + 0.5, *oahu->reference, longitude, latitude, height));
            osg::Vec2d pixel;
            ASSERT_TRUE(picture.project(longitude, latitude, height, *oahu->reference, pixel));
            // The place lies in what was hit.
            const osg::BoundingSphere& bound = hit->drawable->getBound();
            const osg::Vec3d middle = osg::Vec3d(bound.center()) * osg::computeLocalToWorld(hit->path);
            EXPECT_LE((hit->world - middle).length(), 1.01 * static_cast<double>(bound.radius()))
                << "pixel " << x << ' ' << y;
            const double off = (pixel - osg::Vec2d(x + 0.5, y + 0.5)).length();
            // Where a panorama gathers its ground behind the horizon, a flat triangle lies where no ground is drawn.
            const osg::Vec3d back = picture.chain().deform(hit->world * picture.modelView());
            if (GetParam().addEffects != addRandomEffects &&
                (back - hit->deformed).length() > 1e-3 * -hit->deformed.z())
            {
                ++gathered;
                continue;
            }
            worst = std::max(worst, off);
            EXPECT_LT(off, 0.5) << "pixel " << x << ' ' << y;
            ++checked;
            // A panorama map has no such zone, and its ground lies edge-on at the horizon.
            if (GetParam().addEffects != addRandomEffects) continue;
            // What the GPU drew there: 24 bits of depth, and a pixel's width of ground seen at a slant.
            const double drawn = depthOf(depth, projection);
            const double precision = drawn * drawn / 50.0 * 3e-7;
            const double pixelSize = -hit->deformed.z() * 2.0 * half / 50.0 / HEIGHT;
            EXPECT_NEAR(-hit->deformed.z(), drawn, 10.0 * pixelSize + precision + 1e-4 * drawn)
                << "pixel " << x << ' ' << y;
            // Half a pixel's ground at that slant, and the rounding of positions in floats.
            const double footprint = footprintAt(picture, x + 0.5, y + 0.5, -hit->deformed.z());
            // What the GPU divides may be that many pixels off the curve, in any direction.
            EXPECT_NEAR(-hit->deformed.z(), drawn,
                        footprint + precision + 1e-5 * drawn + pixelsOff(*oahu->effects) * pixelSize)
                << "pixel " << x << ' ' << y;
            if (std::isfinite(footprint)) ++footprints;
            const double style = picture.chain().style(hit->world * picture.modelView());
            inZone += style > 0.0 && style < 1.0 ? 1 : 0;
        }
    }
    std::cout << checked << " pixels, " << inZone << " in the transition zone, " << sky << " of sky, "
              << footprints << " compared with their footprint, worst " << worst << " pixels\n";
    EXPECT_GT(checked, cameras * pixels / 4);
    EXPECT_GT(sky, 0);
    EXPECT_LE(gathered, checked / 20);
    if (GetParam().addEffects == addRandomEffects)
    {
        EXPECT_GT(inZone, checked / 20);
        EXPECT_GT(footprints, checked / 2);
    }
}

class BentSea : public GlFixture, public ::testing::WithParamInterface<const char*>
{
protected:
    BentSea() : GlFixture(WIDTH, HEIGHT) {}
};

/// The triangles of a sea are kilometres long. Close above it 15 parts of each are not enough for a bend's zone, which is some 100 m
/// long there, so finer ones must be drawn.
TEST_P(BentSea, LiesOnTheCurveThoughItsTrianglesAreLong)
{
    const std::optional<Scene> oahu = loadOahu(GetParam());
    if (!oahu) return;
    ViewPoint point;
    point.longitude = osg::DegreesToRadians(-157.64);
    point.latitude = osg::DegreesToRadians(21.232);
    point.height = 130.0;
    point.heading = osg::DegreesToRadians(-46.0);
    point.pitch = osg::DegreesToRadians(-72.0);
    osg::Matrixd view;
    ASSERT_TRUE(point.viewMatrix(*oahu->reference, view));
    const double half = 12.5;
    const osg::Matrixd projection =
        osg::Matrixd::frustum(-half * WIDTH / HEIGHT, half * WIDTH / HEIGHT, -half, half, 50.0, 2e5);
    const osg::ref_ptr<BirdsEyeView> bend = new BirdsEyeView;
    bend->setFocusLine(0.65);
    bend->setHorizonLine(0.84);
    bend->setTransitionDetail(1.5);
    bend->setTessellation(true);
    oahu->effects->addEffect(bend);
    CullHarness harness(context(), oahu->effects, WIDTH, HEIGHT);
    harness.setCamera(view, projection);
    // The first frame of a context draws nothing divided, and finer tiles come one after the other.
    harness.frame(true);
    Random random(1);
    for (int step = 0; step < 20; ++step)
        CullHarness::load(harness.frame(true, false).requests, random, 1.0);
    harness.frame(true);
    ASSERT_TRUE(bend->tessellates());
    osg::ref_ptr<osg::Image> depths = new osg::Image;
    depths->readPixels(0, 0, WIDTH, HEIGHT, GL_DEPTH_COMPONENT, GL_FLOAT);

    const DeformedView picture(*oahu->effects, view, projection, WIDTH, HEIGHT);
    int checked = 0, inZone = 0;
    for (int y = 4; y < HEIGHT; y += 12)
    {
        for (int x = 4; x < WIDTH; x += 12)
        {
            const auto hit = picture.pick(x + 0.5, y + 0.5);
            double longitude = 0.0, latitude = 0.0, height = 0.0;
            if (!hit || -hit->deformed.z() > 2000.0 ||
                !picture.unproject(x + 0.5, y + 0.5, *oahu->reference, longitude, latitude, height))
                continue;
            const double pixelSize = -hit->deformed.z() * 2.0 * half / 50.0 / HEIGHT;
            EXPECT_NEAR(height, 0.0, pixelSize) << "pixel " << x << ' ' << y;
            const double drawn = depthOf(valueAt(*depths, x, y), projection);
            EXPECT_NEAR(-hit->deformed.z(), drawn,
                        footprintAt(picture, x + 0.5, y + 0.5, -hit->deformed.z()) + pixelSize)
                << "pixel " << x << ' ' << y;
            const double style = picture.chain().style(hit->world * picture.modelView());
            inZone += style > 0.0 && style < 1.0 ? 1 : 0;
            ++checked;
        }
    }
    EXPECT_GT(checked, 50);
    EXPECT_GT(inZone, 20);
}

INSTANTIATE_TEST_SUITE_P(Oahu, BentSea, ::testing::Values("oahu", "oahu_projected"),
                         [](const auto& each) { return std::string(each.param); });

TEST_P(Picking, WhatIsPickedIsDrawnWhateverTheLodScale)
{
    const std::optional<Scene> oahu = loadOahu(GetParam().database);
    if (!oahu) return;
    CullHarness harness(context(), oahu->effects, WIDTH, HEIGHT);
    const int cameras = fullTest() ? GetParam().many : GetParam().few;
    int hits = 0;
    std::set<int> levels;
    for (int camera = 0; camera < cameras; ++camera)
    {
        SCOPED_TRACE("camera " + std::to_string(camera));
        Random random(static_cast<std::uint64_t>(camera) + 2000);
        GetParam().addEffects(*oahu->effects, random);
        const osg::Matrixd view = randomOahuView(random, *oahu->reference);
        const osg::Matrixd projection = osg::Matrixd::perspective(
            random.uniform(25.0, 60.0), static_cast<double>(WIDTH) / HEIGHT, 50.0, 2e5);
        const double lodScale = camera % 2 ? random.uniform(0.3, 0.7) : random.uniform(2.0, 6.0);
        harness.camera().setLODScale(static_cast<float>(lodScale));
        harness.setCamera(view, projection);
        // All that this camera and a finer one want is in memory, so that the scale alone decides.
        for (const double scale : {lodScale / 4.0, lodScale})
        {
            harness.camera().setLODScale(static_cast<float>(scale));
            for (int step = 0; step < 5; ++step)
                CullHarness::load(harness.frame(true, false).requests, random, 1.0);
        }
        const std::set<const osg::Drawable*> drawn = harness.frame(true, false).drawables();
        const DeformedView picture(*oahu->effects, view, projection, WIDTH, HEIGHT, lodScale);
        for (int i = 0; i < 60; ++i)
        {
            const auto hit = picture.pick(random.uniform(0.0, WIDTH), random.uniform(0.0, HEIGHT));
            if (!hit) continue;
            ++hits;
            EXPECT_TRUE(drawn.count(hit->drawable))
                << "what is picked at LOD scale " << lodScale << " is not drawn";
            const osg::Geometry* mesh = hit->drawable->asGeometry();
            const osg::Node* tile = mesh ? TileInfo::tileOf(*mesh) : nullptr;
            const std::optional<TileInfo> info = tile ? TileInfo::read(*tile) : std::nullopt;
            if (info) levels.insert(info->level);
        }
    }
    EXPECT_GT(hits, 5 * cameras);
    EXPECT_GT(levels.size(), 2u);
}

TEST_P(Picking, WithoutEffectsItIsOsgsOwnIntersector)
{
    const std::optional<Scene> oahu = loadOahu(GetParam().database);
    if (!oahu) return;
    Random random(5);
    osg::ref_ptr<BirdsEyeView> off = new BirdsEyeView;
    off->setEnabled(false);
    oahu->effects->addEffect(off);
    int hits = 0;
    for (int i = 0; i < (fullTest() ? 100 : 30); ++i)
    {
        const osg::Matrixd view = randomOahuView(random, *oahu->reference);
        const osg::Matrixd projection = osg::Matrixd::perspective(40.0, 1.0, 1.0, 2e5);
        const DeformedView picture(*oahu->effects, view, projection, 100, 100);
        const osg::Vec2d pixel(random.uniform(0.0, 100.0), random.uniform(0.0, 100.0));
        const auto hit = picture.pick(pixel.x(), pixel.y());

        osg::Matrixd toWorld;
        toWorld.invert(view * projection);
        const osg::Vec3d start = osg::Vec3d(pixel.x() / 50.0 - 1.0, pixel.y() / 50.0 - 1.0, -1.0) * toWorld;
        const osg::Vec3d end = osg::Vec3d(pixel.x() / 50.0 - 1.0, pixel.y() / 50.0 - 1.0, 1.0) * toWorld;
        const osg::ref_ptr<osgUtil::LineSegmentIntersector> segment =
            new osgUtil::LineSegmentIntersector(start, end);
        // Only what is in memory: the root's tile.
        osgUtil::IntersectionVisitor visitor(segment);
        oahu->effects->accept(visitor);
        ASSERT_EQ(hit.has_value(), segment->containsIntersections()) << i;
        // OSG's visitor takes the finest meshes in memory, the kit's those that are drawn.
        if (!hit || hit->drawable != segment->getFirstIntersection().drawable.get()) continue;
        ++hits;
        EXPECT_LT((hit->world - segment->getFirstIntersection().getWorldIntersectPoint()).length(),
                  1e-6 * (start - hit->world).length() + 0.01);
    }
    EXPECT_GT(hits, 3);
}

INSTANTIATE_TEST_SUITE_P(
    Oahu, Picking,
    ::testing::Values(OahuCase{"oahu", "oahu", addRandomEffects, 3, 50},
                      OahuCase{"oahu_projected", "oahu_projected", addRandomEffects, 2, 50},
                      OahuCase{"panorama", "oahu", addRandomPanorama, 2, 12},
                      OahuCase{"panorama_projected", "oahu_projected", addRandomPanorama, 3, 12}),
    [](const auto& each) { return std::string(each.param.name); });
