// SPDX-License-Identifier: MIT
// SPDX-FileCopyrightText: 2026 the osgGeoFX authors
//
// What is culled is out of sight, and what is not is in sight: on real terrain, for random cameras and effects, while
// tiles arrive. The picture with culling equals the picture without, bit for bit; the tiles drawn and those asked for are
// compared with an oracle that deforms every triangle.
#include <tools/CullHarness.h>
#include <tools/GlFixture.h>
#include <tools/ImageComparison.h>
#include <tools/OahuScene.h>
#include <tools/RandomSamples.h>

#include <algorithm>
#include <cstring>

using namespace osgGeoFX;
using namespace geofx::test;

namespace
{

constexpr int WIDTH = 240, HEIGHT = 180;

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
        const std::optional<Scene> loaded = loadOahu(GetParam());
        ASSERT_TRUE(loaded);
        scene = loaded->effects;
        reference = loaded->reference;
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
    std::size_t culledAway = 0;
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
        const osg::Matrixd view = randomOahuView(random, *reference);
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
        culledAway += everything.leaves.size() - drawn.size();
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
    EXPECT_GT(culledAway, static_cast<std::size_t>(10 * count));
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
