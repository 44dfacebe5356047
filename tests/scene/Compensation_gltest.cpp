// SPDX-License-Identifier: MIT
// SPDX-FileCopyrightText: 2026 the osgGeoFX authors
//
// What is culled is out of sight, and what is not is in sight: on real terrain, for random cameras and effects, while
// tiles arrive. The picture with culling equals the picture without, bit for bit; the tiles drawn and those asked for are
// compared with an oracle that deforms every triangle.
#include <osgGeoFX/paging/TerrainInfo.h>
#include <tools/CullHarness.h>
#include <tools/GlFixture.h>
#include <tools/ImageComparison.h>
#include <tools/OahuScene.h>
#include <tools/RandomSamples.h>

#include <algorithm>
#include <set>
#include <tuple>

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

const int PARTS = fullTest() ? 4 : 2;

/// What the drawables belong to: tiles, or they are things of their own.
std::set<const osg::Object*> tilesOf(const std::set<const osg::Drawable*>& drawables)
{
    std::set<const osg::Object*> result;
    for (const osg::Drawable* drawable : drawables)
    {
        const osg::Geometry* mesh = drawable->asGeometry();
        const osg::Transform* tile = mesh ? TileInfo::tileOf(*mesh) : nullptr;
        result.insert(tile ? static_cast<const osg::Object*>(tile) : drawable);
    }
    return result;
}

/// For a database, and a part of the cameras.
class Compensation : public GlFixture, public ::testing::WithParamInterface<std::tuple<OahuCase, int>>
{
protected:
    Compensation() : GlFixture(WIDTH, HEIGHT) {}

    /// The terrain again, with no tile loaded beyond the root.
    void reload()
    {
        const std::optional<Scene> loaded = loadOahu(std::get<0>(GetParam()).database);
        ASSERT_TRUE(loaded);
        _scene = loaded->effects;
        _reference = loaded->reference;
    }

    osg::ref_ptr<EffectScene> _scene;
    osg::ref_ptr<Georeference> _reference;
};

} // namespace

TEST_P(Compensation, PicturesAreThoseWithoutCullingAndTilesThoseOfTheOracle)
{
    const OahuCase& sort = std::get<0>(GetParam());
    const SampleRange cameras(fullTest() ? sort.many : sort.few, std::get<1>(GetParam()), PARTS);
    const bool painted = sort.addEffects == addRandomPainting;
    const int count = cameras.count();
    std::vector<double> tileRatios;
    std::vector<double> requestRatios;
    std::unique_ptr<CullHarness> harness;
    int loaded = 0;
    int deformed = 0;
    std::size_t culledAway = 0;
    for (int i = cameras.first; i < cameras.end; ++i)
    {
        SCOPED_TRACE("camera " + std::to_string(i));
        Random random(static_cast<std::uint64_t>(i));
        if (i % 12 == 0 || i == cameras.first)
        {
            reload();
            if (!_scene || !_reference) return;
            if (!harness) harness = std::make_unique<CullHarness>(context(), _scene, WIDTH, HEIGHT);
            harness->setScene(_scene);
        }
        std::get<0>(GetParam()).addEffects(*_scene, random);
        const osg::Matrixd view = randomOahuView(random, *_reference);
        const osg::Matrixd projection = randomProjection(random);
        harness->setCamera(view, projection);
        // Tiles arrive while the camera stands, some of those that are asked for.
        for (int step = random.integer(1, 5); step > 0; --step)
        {
            loaded += CullHarness::load(harness->frame(true, false).requests, random, 0.7);
        }

        const Culled culled = harness->frame(true);
        const Culled everything = harness->frame(false);
        const osg::ref_ptr<const DeformationChain> chain = _scene->deformation(view, projection);
        deformed += chain->empty() ? 0 : 1;
        const Oracle oracle(everything, *chain);
        const Oracle::Mistakes mistakes = oracle.mistakesOf(culled);
        ASSERT_FALSE(mistakes.picture)
            << ::testing::PrintToString(imagesMatch(*culled.image, *everything.image, {}));
        ASSERT_EQ(mistakes.culled, 0) << "a tile in sight was culled";
        const auto needed = static_cast<double>(tilesOf(oracle.needed).size());
        const std::size_t drawn = tilesOf(culled.drawables()).size();
        culledAway += everything.leaves.size() - culled.drawables().size();
        // A painting draws its mirror's tiles, too, and those beside the picture whose strokes reach into it.
        if (!painted)
        {
            EXPECT_LE(static_cast<double>(drawn), 1.5 * needed + 4.0)
                << needed << " needed, " << _scene->getEffect(0)->className();
        }
        if (needed > 0.0) tileRatios.push_back(static_cast<double>(drawn) / needed);

        // Whoever is in sight, or has a part in sight, and deserves more detail asks for it; few others do.
        EXPECT_EQ(mistakes.unasked, 0);
        const auto asking = static_cast<double>(culled.requesting().size());
        const auto deserving = static_cast<double>(oracle.deserving.size());
        if (!painted)
        {
            EXPECT_LE(asking, 2.0 * deserving + 4.0) << deserving << " deserving";
        }
        if (deserving > 0.0) requestRatios.push_back(asking / deserving);
    }
    EXPECT_GE(loaded, count);
    EXPECT_GT(deformed, count / 2);
    EXPECT_GT(culledAway, static_cast<std::size_t>(10 * count));
    const double tileRatio = median(tileRatios);
    if (!painted)
    {
        EXPECT_LE(tileRatio, 1.10);
    }
    RecordProperty("median tiles drawn over needed", std::to_string(tileRatio));
    RecordProperty("median requests over deserving", std::to_string(median(requestRatios)));
    std::cout << "tiles drawn / needed: median " << tileRatio << ", most "
              << *std::max_element(tileRatios.begin(), tileRatios.end()) << "; requests: median "
              << median(requestRatios) << ", most "
              << *std::max_element(requestRatios.begin(), requestRatios.end()) << "; deformed " << deformed
              << " of " << count << ", " << loaded << " tiles loaded\n";
}

INSTANTIATE_TEST_SUITE_P(
    Oahu, Compensation,
    ::testing::Combine(
        ::testing::Values(OahuCase{"oahu", "oahu", addRandomEffects, 5, 500},
                          OahuCase{"oahu_projected", "oahu_projected", addRandomEffects, 3, 500},
                          OahuCase{"liberties", "oahu", addRandomLiberties, 6, 200},
                          OahuCase{"liberties_projected", "oahu_projected", addRandomLiberties, 6, 200},
                          OahuCase{"panorama", "oahu", addRandomPanorama, 4, 100},
                          OahuCase{"panorama_projected", "oahu_projected", addRandomPanorama, 4, 100},
                          OahuCase{"painting", "oahu", addRandomPainting, 2, 40},
                          OahuCase{"painting_projected", "oahu_projected", addRandomPainting, 2, 40}),
        ::testing::Range(0, PARTS)),
    [](const auto& each)
    { return std::string(std::get<0>(each.param).name) + "_" + std::to_string(std::get<1>(each.param)); });
