// SPDX-License-Identifier: MIT
// SPDX-FileCopyrightText: 2026 the osgGeoFX authors
//
// What is culled is out of sight, and what is not is in sight: on real terrain, for random cameras and effects, while
// tiles arrive. The picture with culling equals the picture without, bit for bit; the tiles drawn and those asked for are
// compared with an oracle that deforms every triangle.
#include <tools/CullHarness.h>
#include <tools/GlFixture.h>
#include <tools/ImageComparison.h>
#include <tools/RandomSamples.h>

#include <osgGeoFX/deformation/BirdsEyeView.h>
#include <osgGeoFX/deformation/BlendedView.h>
#include <osgGeoFX/deformation/PedestrianView.h>
#include <osgGeoFX/deformation/VerticalExaggeration.h>
#include <osgGeoFX/paging/Scene.h>
#include <osgGeoFX/paging/ViewPoint.h>
#include <osgGeoFX/scene/EffectScene.h>

#include <algorithm>
#include <cstring>

using namespace osgGeoFX;
using namespace geofx::test;

namespace
{

constexpr int WIDTH = 240, HEIGHT = 180;

osg::Matrixd randomProjection(Random& random)
{
    const double aspect = random.uniform(0.5, 2.0);
    const int kind = random.integer(0, 9);
    if (kind == 0)
    {
        const double half = random.logarithmic(500.0, 30000.0);
        return osg::Matrixd::ortho(-half * aspect, half * aspect, -half, half, 1.0, 2e5);
    }
    const double near = 5.0;
    const double half = near * std::tan(osg::DegreesToRadians(random.uniform(10.0, 100.0)) / 2.0);
    const double shiftX = kind == 1 ? random.uniform(-1.0, 1.0) * half : 0.0;
    const double shiftY = kind == 1 ? random.uniform(-1.0, 1.0) * half : 0.0;
    return osg::Matrixd::frustum(shiftX - half * aspect, shiftX + half * aspect, shiftY - half, shiftY + half,
                                 near, 3e5);
}

/// A camera over Oahu.
osg::Matrixd randomView(Random& random, const Georeference& reference)
{
    ViewPoint point;
    point.longitude = osg::DegreesToRadians(random.uniform(-158.3, -157.6));
    point.latitude = osg::DegreesToRadians(random.uniform(21.2, 21.75));
    point.altitude = random.logarithmic(100.0, 30000.0);
    point.heading = random.uniform(0.0, 2.0 * osg::PI);
    point.pitch = osg::DegreesToRadians(random.integer(0, 9) == 0 ? -90.0 : random.uniform(-80.0, 5.0));
    point.roll = random.integer(0, 4) == 0 ? random.uniform(-1.0, 1.0) : 0.0;
    osg::Matrixd view;
    EXPECT_TRUE(point.viewMatrix(reference, view));
    return view;
}

void randomizeBend(PerspectiveBend& bend, Random& random)
{
    bend.setCurve(static_cast<PerspectiveBend::Curve>(random.integer(0, 2)));
    bend.setPlaneElevation(random.integer(0, 2) == 0 ? random.uniform(-100.0, 800.0) : 0.0);
    bend.setTransitionDetail(random.uniform(1.0, 4.0));
    bend.setContextDetail(random.uniform(0.5, 1.5));
}

osg::ref_ptr<BirdsEyeView> randomBirdsEye(Random& random)
{
    osg::ref_ptr<BirdsEyeView> view = new BirdsEyeView;
    randomizeBend(*view, random);
    view->setHorizonLine(random.uniform(0.5, 0.98));
    view->setFocusLine(random.uniform(0.0, 0.95) * view->getHorizonLine());
    view->setContextTilt(random.integer(0, 1) ? random.uniform(0.0, 0.9) : 0.0);
    return view;
}

osg::ref_ptr<PedestrianView> randomPedestrian(Random& random)
{
    osg::ref_ptr<PedestrianView> view = new PedestrianView;
    randomizeBend(*view, random);
    view->setBendAngle(random.uniform(0.0, osg::PI_2));
    view->setFocusDistance(random.logarithmic(100.0, 8000.0));
    view->setZoneWidth(random.logarithmic(100.0, 8000.0));
    return view;
}

void addRandomEffects(EffectScene& scene, Random& random)
{
    while (scene.getNumEffects())
        scene.removeEffect(scene.getEffect(0));
    const int kind = random.integer(0, 5);
    if (kind == 4 || kind == 5)
    {
        osg::ref_ptr<VerticalExaggeration> exaggeration = new VerticalExaggeration;
        exaggeration->setFactor(random.logarithmic(0.2, 6.0));
        scene.addEffect(exaggeration);
    }
    if (kind == 0 || kind == 5) scene.addEffect(randomBirdsEye(random));
    if (kind == 1) scene.addEffect(randomBirdsEye(random));
    if (kind == 2) scene.addEffect(randomPedestrian(random));
    if (kind == 3)
    {
        osg::ref_ptr<BlendedView> blend = new BlendedView;
        blend->setHighHeight(random.uniform(1000.0, 20000.0));
        blend->setBirdsEyeView(randomBirdsEye(random));
        blend->setPedestrianView(randomPedestrian(random));
        scene.addEffect(blend);
    }
}

double median(std::vector<double> values)
{
    if (values.empty()) return 0.0;
    std::sort(values.begin(), values.end());
    return values[values.size() / 2];
}

class Compensation : public GlFixture, public ::testing::WithParamInterface<const char*>
{
protected:
    Compensation() : GlFixture(WIDTH, HEIGHT) {}

    /// The terrain again, with no tile loaded beyond the root.
    void reload()
    {
        std::string error;
        const std::string file = std::string(GEOFX_BUILD_DIR "/test-data/") + GetParam() + "/terrain.osgb";
        const std::optional<Scene> loaded = Scene::load(file, error);
        ASSERT_TRUE(loaded) << error << " The fixture oahu_database builds it.";
        scene = loaded->effects;
        reference = loaded->reference;
        ASSERT_TRUE(reference) << loaded->referenceError;
    }

    osg::ref_ptr<EffectScene> scene;
    osg::ref_ptr<Georeference> reference;
};

bool sameBytes(const osg::Image& a, const osg::Image& b)
{
    return a.getTotalSizeInBytes() == b.getTotalSizeInBytes() &&
           std::memcmp(a.data(), b.data(), a.getTotalSizeInBytes()) == 0;
}

} // namespace

TEST_P(Compensation, PicturesAreThoseWithoutCullingAndTilesThoseOfTheOracle)
{
    const int count = fullTest() ? 500 : 24;
    std::vector<double> tileRatios;
    std::vector<double> requestRatios;
    std::unique_ptr<CullHarness> harness;
    int loaded = 0;
    int deformed = 0;
    for (int i = 0; i < count; ++i)
    {
        SCOPED_TRACE("camera " + std::to_string(i));
        Random random(static_cast<std::uint64_t>(i));
        if (i % 12 == 0)
        {
            reload();
            if (!scene || !reference) return;
            if (!harness) harness = std::make_unique<CullHarness>(context(), scene, WIDTH, HEIGHT);
            harness->setScene(scene);
        }
        addRandomEffects(*scene, random);
        const osg::Matrixd view = randomView(random, *reference);
        const osg::Matrixd projection = randomProjection(random);
        harness->setCamera(view, projection);
        // Tiles arrive while the camera stands, some of those that are asked for.
        for (int step = random.integer(1, 5); step > 0; --step)
        {
            loaded += CullHarness::load(harness->frame(true, false).requests, random, 0.7);
        }

        const Culled culled = harness->frame(true);
        const Culled everything = harness->frame(false);
        const osg::ref_ptr<const DeformationChain> chain = scene->deformation(view, projection);
        deformed += chain->empty() ? 0 : 1;
        ASSERT_TRUE(sameBytes(*culled.image, *everything.image))
            << ::testing::PrintToString(imagesMatch(*culled.image, *everything.image, {}));
        const std::set<const osg::Drawable*> needed = CullHarness::needed(everything, *chain);
        const std::set<const osg::Drawable*> drawn = culled.drawables();
        for (const osg::Drawable* drawable : needed)
        {
            ASSERT_TRUE(drawn.count(drawable)) << "a tile in sight was culled";
        }
        EXPECT_LE(static_cast<double>(drawn.size()), 1.5 * static_cast<double>(needed.size()) + 4.0)
            << needed.size() << " needed, " << scene->getEffect(0)->className();
        if (!needed.empty())
        {
            tileRatios.push_back(static_cast<double>(drawn.size()) / static_cast<double>(needed.size()));
        }

        // Whoever is in sight, or has a part in sight, and deserves more detail asks for it; few others do.
        const std::set<const osg::PagedLOD*> asked = culled.requesting();
        const std::set<const osg::PagedLOD*> inSight = CullHarness::groupsAbove(everything, needed);
        std::set<const osg::PagedLOD*> deserving;
        for (const osg::PagedLOD* group : everything.requesting())
        {
            if (inSight.count(group)) deserving.insert(group);
        }
        for (const osg::PagedLOD* group : deserving)
            EXPECT_TRUE(asked.count(group)) << group->getFileName(1);
        EXPECT_LE(static_cast<double>(asked.size()), 2.0 * static_cast<double>(deserving.size()) + 4.0)
            << deserving.size() << " deserving";
        if (!deserving.empty())
        {
            requestRatios.push_back(static_cast<double>(asked.size()) /
                                    static_cast<double>(deserving.size()));
        }
    }
    EXPECT_GT(loaded, count);
    EXPECT_GT(deformed, count / 2);
    const double tileRatio = median(tileRatios);
    EXPECT_LE(tileRatio, 1.10);
    RecordProperty("median tiles drawn over needed", std::to_string(tileRatio));
    RecordProperty("median requests over deserving", std::to_string(median(requestRatios)));
    std::cout << "tiles drawn / needed: median " << tileRatio << ", most "
              << *std::max_element(tileRatios.begin(), tileRatios.end()) << "; requests: median "
              << median(requestRatios) << ", most "
              << *std::max_element(requestRatios.begin(), requestRatios.end()) << "; deformed " << deformed
              << " of " << count << ", " << loaded << " tiles loaded\n";
}

INSTANTIATE_TEST_SUITE_P(Oahu, Compensation, ::testing::Values("oahu", "oahu_projected"));
