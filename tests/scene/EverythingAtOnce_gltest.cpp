// SPDX-License-Identifier: MIT
// SPDX-FileCopyrightText: 2026 the osgGeoFX authors
//
// All effects in one scene, above real terrain with houses and labels: the picture with culling equals the one without, bit
// for bit, for random cameras, while tiles arrive.
#include <osgGeoFX/closeup/CloseUps.h>
#include <osgGeoFX/mapping/ProjectiveMappings.h>
#include <osgGeoFX/scene/RigidReference.h>
#include <tools/CloseUpSamples.h>
#include <tools/CullHarness.h>
#include <tools/GlFixture.h>
#include <tools/ImageComparison.h>
#include <tools/OahuScene.h>
#include <tools/RandomSamples.h>

#include <osg/Billboard>
#include <osg/Math>
#include <osg/MatrixTransform>
#include <osg/ShapeDrawable>

#include <cstring>
#include <tuple>

using namespace osgGeoFX;
using namespace geofx::test;

namespace
{

constexpr int WIDTH = 240, HEIGHT = 180;
constexpr int PARTS = 4;
constexpr double EAST = -157.98, NORTH = 21.47; // degrees, the island's middle
constexpr double REACH = 22000.0;               // metres, to its coasts

bool sameBits(const osg::Image& a, const osg::Image& b)
{
    return a.getTotalSizeInBytes() == b.getTotalSizeInBytes() &&
           std::memcmp(a.data(), b.data(), a.getTotalSizeInBytes()) == 0;
}

osg::ref_ptr<ProjectiveMappings> randomMappings(Random& random, const CloseUpPlan& plan)
{
    osg::ref_ptr<ProjectiveMappings> mappings = new ProjectiveMappings;
    if (plan.globe)
        mappings->setGeodeticOrigin(plan.center.x(), plan.center.y());
    else
        mappings->setOrigin(plan.center);
    osg::ref_ptr<osg::Image> image = new osg::Image;
    image->allocateImage(16, 16, 1, GL_RGBA, GL_UNSIGNED_BYTE);
    for (unsigned int i = 0; i < image->getTotalSizeInBytes(); ++i)
        image->data()[i] = static_cast<unsigned char>(random.integer(0, 255));
    const osg::ref_ptr<DataLayer> layer = new DataLayer(image);
    for (int i = 0; i < 40; ++i)
    {
        osg::ref_ptr<ProjectiveMapping> mapping = new ProjectiveMapping;
        mapping->setRectangle({random.uniform(-REACH, REACH), random.uniform(-REACH, REACH)},
                              random.logarithmic(300.0, 6000.0), random.logarithmic(300.0, 6000.0),
                              random.uniform(-3.0, 3.0));
        mapping->setSoftEdges(random.integer(0, 1) == 1);
        if (random.integer(0, 1))
            mapping->setLayer(layer);
        else
        {
            mapping->getTransfer()->setSource(ColorTransfer::CONSTANT);
            mapping->getTransfer()->setConstant({random.uniform(0.0, 1.0), random.uniform(0.0, 1.0),
                                                 random.uniform(0.0, 1.0), random.uniform(0.3, 1.0)});
        }
        mappings->addMapping(mapping);
    }
    return mappings;
}

/// Houses, each moved as one piece, and signs that face the camera.
osg::ref_ptr<osg::Group> makeThings(const Georeference& reference)
{
    Random random(7);
    osg::ref_ptr<osg::Group> things = new osg::Group;
    osg::ref_ptr<osg::ShapeDrawable> house =
        new osg::ShapeDrawable(new osg::Box({}, 300.0f, 200.0f, 1600.0f));
    house->setColor({0.8f, 0.5f, 0.4f, 1.0f});
    osg::ref_ptr<osg::ShapeDrawable> sign = new osg::ShapeDrawable(new osg::Box({}, 600.0f, 5.0f, 200.0f));
    sign->setColor({0.9f, 0.9f, 0.2f, 1.0f});
    for (int i = 0; i < 60; ++i)
    {
        osg::Matrixd frame;
        EXPECT_TRUE(reference.localToWorld(osg::DegreesToRadians(EAST + random.uniform(-0.2, 0.2)),
                                           osg::DegreesToRadians(NORTH + random.uniform(-0.2, 0.2)), 0.0,
                                           frame));
        osg::ref_ptr<osg::MatrixTransform> place = new osg::MatrixTransform(frame);
        if (i % 3)
            place->addChild(house);
        else
        {
            osg::ref_ptr<osg::Billboard> billboard = new osg::Billboard;
            billboard->setMode(osg::Billboard::POINT_ROT_EYE);
            billboard->addDrawable(sign, {0.0f, 0.0f, 1500.0f});
            place->addChild(billboard);
        }
        osg::ref_ptr<RigidReference> rigid = new RigidReference;
        rigid->setReference(frame.getTrans());
        rigid->addChild(place);
        things->addChild(rigid);
    }
    // Nothing but their colors.
    things->getOrCreateStateSet()->setMode(GL_LIGHTING, osg::StateAttribute::OFF);
    things->getOrCreateStateSet()->setDefine("GEOFX_PAINTED", osg::StateAttribute::OFF);
    return things;
}

/// For a database of Oahu, and a part of the cameras.
class EverythingAtOnce : public GlFixture, public ::testing::WithParamInterface<std::tuple<std::string, int>>
{
protected:
    EverythingAtOnce() : GlFixture(WIDTH, HEIGHT) {}

    /// The terrain again, with no tile loaded beyond the root.
    void reload()
    {
        const std::optional<Scene> loaded = loadOahu(std::get<0>(GetParam()));
        ASSERT_TRUE(loaded);
        _scene = loaded->effects;
        _reference = loaded->reference;
        _scene->addChild(makeThings(*_reference));
    }

    /// An exaggeration, a bend or a panorama map with all its parts, mappings before or after it, and close-ups.
    void addEffects(Random& random)
    {
        osg::Matrixd middle;
        ASSERT_TRUE(
            _reference->localToWorld(osg::DegreesToRadians(EAST), osg::DegreesToRadians(NORTH), 0.0, middle));
        CloseUpPlan plan;
        plan.globe = std::get<0>(GetParam()) == "oahu";
        plan.center.set(middle.getTrans().x(), middle.getTrans().y());
        if (plan.globe) plan.center.set(osg::DegreesToRadians(EAST), osg::DegreesToRadians(NORTH));
        plan.reach = REACH;
        plan.size = random.logarithmic(1500.0, 8000.0);
        plan.rise = 0.5 * plan.size;

        // Takes away what was there before.
        do
            addRandomEffects(*_scene, random);
        while (_scene->getEffect(_scene->getNumEffects() - 1)->className() ==
               std::string("VerticalExaggeration"));
        std::vector<osg::ref_ptr<Effect>> views;
        for (unsigned int i = 0; i < _scene->getNumEffects(); ++i)
            views.push_back(_scene->getEffect(i));
        if (random.integer(0, 1))
        {
            osg::ref_ptr<Effect> exaggeration = views.size() > 1 ? views[0] : nullptr;
            addRandomPainting(*_scene, random);
            views = {_scene->getEffect(0)};
            if (exaggeration) views.insert(views.begin(), exaggeration);
        }
        while (_scene->getNumEffects())
            _scene->removeEffect(_scene->getEffect(0));
        const osg::ref_ptr<ProjectiveMappings> mappings = randomMappings(random, plan);
        _closeUps = new CloseUps;
        for (int i = 0; i < 5; ++i)
        {
            const osg::ref_ptr<CloseUp> closeUp = randomCloseUp(random, plan);
            closeUp->setSurface("");
            _closeUps->addCloseUp(closeUp);
        }
        // Strokes need several passes, and a sentence says so.
        const bool strokes = views.back()->className() == std::string("PanoramaMap");
        _closeUps->setPipeline(random.integer(0, 1) ? CloseUps::AUTOMATIC
                               : strokes            ? CloseUps::MULTI_PASS
                                                    : CloseUps::SINGLE_PASS);
        if (random.integer(0, 1)) _scene->addEffect(mappings);
        for (const osg::ref_ptr<Effect>& each : views)
            _scene->addEffect(each);
        if (_scene->getEffect(0) != mappings) _scene->addEffect(mappings);
        _scene->addEffect(_closeUps);
    }

    osg::ref_ptr<EffectScene> _scene;
    osg::ref_ptr<Georeference> _reference;
    osg::ref_ptr<CloseUps> _closeUps;
};

/// On a plane the effects are those of the globe again, so that a sample has a quarter of them there.
std::vector<std::tuple<std::string, int>> cases()
{
    std::vector<std::tuple<std::string, int>> result;
    // The programs of one part take most of its time.
    for (int part = 0; part < (fullTest() ? PARTS : 1); ++part)
        result.emplace_back("oahu", part);
    for (int part = 0; part < (fullTest() ? PARTS : 0); ++part)
        result.emplace_back("oahu_projected", part);
    return result;
}

} // namespace

TEST_P(EverythingAtOnce, IsThePictureWithoutCulling)
{
    // OSG gives buffers of scenes that are gone to new tiles.
    watch().ignore("to update a GL_STATIC_DRAW buffer");
    const SampleRange cameras(fullTest() ? 300 : 8, std::get<1>(GetParam()), PARTS);
    std::unique_ptr<CullHarness> harness;
    int loaded = 0;
    int lifted = 0;
    std::size_t spared = 0;
    for (int i = cameras.first; i < cameras.end; ++i)
    {
        SCOPED_TRACE("camera " + std::to_string(i));
        Random random(static_cast<std::uint64_t>(i));
        // Each frame without culling draws all tiles that have come so far.
        const bool again = (fullTest() && i % 12 == 0) || i == cameras.first;
        if (again)
        {
            reload();
            if (HasFatalFailure()) return;
            if (!harness) harness = std::make_unique<CullHarness>(context(), _scene, WIDTH, HEIGHT);
            harness->setScene(_scene);
            // OSG leaves out what is smaller than two pixels, on purpose: a sign at the horizon is one of them.
            harness->camera().setSmallFeatureCullingPixelSize(0.0f);
        }
        // Most of the time goes into the programs of new effects, so that the cameras of a sample have the same.
        if (fullTest() || again) addEffects(random);
        if (HasFatalFailure()) return;
        // A part of the tiles, for the time that so many cameras take: the pictures without culling draw all that is loaded.
        harness->camera().setLODScale(i % 32 == 0 && fullTest() ? 2.5f : i % 4 == 0 ? 5.0f : 10.0f);
        harness->setCamera(randomOahuView(random, *_reference), randomProjection(random));
        for (int step = random.integer(1, 3); step > 0; --step)
            loaded +=
                CullHarness::load(harness->frame(true, false).requests, random, fullTest() ? 0.5 : 0.25);
        const Culled culled = harness->frame(true);
        lifted += _closeUps->statistics().closeUps > 0 ? 1 : 0;
        const Culled whole = harness->frame(false);
        spared += whole.leaves.size() - culled.leaves.size();
        EXPECT_TRUE(sameBits(*culled.image, *whole.image))
            << imagesMatch(*culled.image, *whole.image, {}, std::to_string(i)).message();
    }
    EXPECT_GT(loaded, cameras.count());
    EXPECT_GT(lifted, cameras.count() / 4);
    EXPECT_GT(spared, static_cast<std::size_t>(10 * cameras.count()));
    std::cout << lifted << " of " << cameras.count() << " cameras see close-ups; " << loaded
              << " tiles loaded, " << spared << " drawables culled\n";
}

INSTANTIATE_TEST_SUITE_P(Oahu, EverythingAtOnce, ::testing::ValuesIn(cases()),
                         [](const auto& each)
                         { return std::get<0>(each.param) + "_" + std::to_string(std::get<1>(each.param)); });
