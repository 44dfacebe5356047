// SPDX-License-Identifier: MIT
// SPDX-FileCopyrightText: 2026 the osgGeoFX authors
//
// The places of a picture's pixels against picking, and back to their pixels: plain, bent and as a panorama map, on a plane and on
// the globe, in several parts, in tiles, with samples, and with depths of other kinds.
#include <osgGeoFX/closeup/CloseUpPicking.h>
#include <osgGeoFX/closeup/CloseUps.h>
#include <osgGeoFX/deformation/BirdsEyeView.h>
#include <osgGeoFX/offscreen/SceneRenderer.h>
#include <osgGeoFX/panorama/PanoramaMap.h>
#include <osgGeoFX/print/PlacePicture.h>
#include <osgGeoFX/scene/DeformedView.h>
#include <tools/GlFixture.h>
#include <tools/OahuScene.h>
#include <tools/PanoramaHills.h>
#include <tools/RandomSamples.h>
#include <tools/SampledCases.h>

#include <osg/Material>
#include <osg/Math>

#include <cmath>

using namespace osgGeoFX;
using namespace geofx::test;

namespace
{

constexpr int WIDTH = 320, HEIGHT = 200;

/// Of a plane whose metres are called ten-thousandths of a degree.
class PlaneReference : public Georeference
{
public:
    osg::Object* cloneType() const override { return new PlaneReference; }
    osg::Object* clone(const osg::CopyOp&) const override { return new PlaneReference; }
    const char* libraryName() const override { return "test"; }
    const char* className() const override { return "PlaneReference"; }
    bool isGeocentric() const override { return false; }
    bool toWorld(double longitude, double latitude, double height, osg::Vec3d& world) const override
    {
        world.set(osg::RadiansToDegrees(longitude) * 1e4, osg::RadiansToDegrees(latitude) * 1e4, height);
        return true;
    }
    bool toGeodetic(const osg::Vec3d& world, double& longitude, double& latitude,
                    double& height) const override
    {
        longitude = osg::DegreesToRadians(world.x() * 1e-4);
        latitude = osg::DegreesToRadians(world.y() * 1e-4);
        height = world.z();
        return true;
    }
    bool localToWorld(double, double, double, osg::Matrixd&) const override { return false; }
};

class PlacePictureTest : public GlFixture
{
protected:
    explicit PlacePictureTest(bool globe = true) : _globe(globe) {}

    void SetUp() override
    {
        GlFixture::SetUp();
        if (IsSkipped() || HasFatalFailure()) return;
        _east.set(1.0, 0.0, 0.0);
        _up.set(0.0, 0.0, 1.0);
        if (_globe)
        {
            _up = _hills.middle();
            _up.normalize();
            _east = osg::Vec3d(0.0, 0.0, 1.0) ^ _up;
            _east.normalize();
        }
        const osg::Vec3d north = _up ^ _east;
        _view = osg::Matrixd::lookAt(_hills.middle() + _up * 9000.0 - north * 16000.0, _hills.middle(), _up);
        std::string error;
        const osg::ref_ptr<osg::Node> terrain = _hills.terrain();
        terrain->getOrCreateStateSet()->setAttributeAndModes(new osg::Material);
        if (_globe)
            _reference = Georeference::create(terrain, error);
        else
            _reference = new PlaneReference;
        ASSERT_TRUE(_reference) << error;
        _scene = Scene::adopt(terrain, error);
        ASSERT_TRUE(_scene) << error;
        _drawing.width = WIDTH;
        _drawing.height = HEIGHT;
        _drawing.fieldOfView = 40.0;
    }
    static osg::ref_ptr<PanoramaMap> map()
    {
        osg::ref_ptr<PanoramaMap> result = new PanoramaMap;
        result->setViewRadius(9000.0);
        result->setRipples(0.0);
        return result;
    }

    /// Draws the scene with an effect.
    void draw(Effect* effect, bool strokes)
    {
        while (_scene->effects->getNumEffects() > 0)
            _scene->effects->removeEffect(_scene->effects->getEffect(0));
        if (effect) _scene->effects->addEffect(effect);
        Scene whole = *_scene;
        _reader = whole.readDepths();
        std::string error;
        _renderer = SceneRenderer::create(whole, _drawing, error);
        ASSERT_TRUE(_renderer) << error;
        std::optional<WithoutStrokes> without;
        if (!strokes) without.emplace(*_scene->effects);
        FrameStatistics unused;
        ASSERT_TRUE(_renderer->render(_view, 0.0, unused, error)) << error;
    }
    PlacePicture places() const
    {
        return {*_scene->effects, _renderer->camera(), _reader->pictures(), *_reference};
    }

    struct Found
    {
        int ground = 0, sky = 0, near = 0, asked = 0;
    };
    /// Compares pixels with picking. `room`: pixels by which a place may be off that of the pick.
    Found compare(const PlacePicture& places, int samples, double room) const
    {
        EXPECT_EQ(places.width(), _renderer->camera().getViewport()->width());
        EXPECT_EQ(places.height(), _renderer->camera().getViewport()->height());
        const DeformedView view(*_scene->effects, _renderer->camera());
        Found found;
        Random random(7);
        for (int i = 0; i < samples; ++i)
        {
            const int x = random.integer(0, places.width() - 1), y = random.integer(0, places.height() - 1);
            SCOPED_TRACE(std::to_string(x) + "," + std::to_string(y));
            const auto place = places.at(x, y);
            const osg::Vec2d pixel(x + 0.5, places.height() - y - 0.5);
            const auto hit = view.pick(pixel.x(), pixel.y());
            ++found.asked;
            if (!place)
            {
                found.sky += hit ? 0 : 1;
                continue;
            }
            // Projected again, it is its pixel.
            osg::Vec2d back;
            EXPECT_TRUE(view.project(osg::DegreesToRadians(place->longitude),
                                     osg::DegreesToRadians(place->latitude), place->height, *_reference,
                                     back));
            EXPECT_LT((back - pixel).length(), 0.5);
            EXPECT_NEAR(places.distanceAt(x, y).value(), place->distance, 1e-9);
            if (!hit) continue;
            ++found.ground;
            // The same place as the pick's: as it would be seen from above, in pixels of this picture.
            osg::Vec3d world;
            EXPECT_TRUE(_reference->toWorld(osg::DegreesToRadians(place->longitude),
                                            osg::DegreesToRadians(place->latitude), place->height, world));
            const double perPixel = hit->deformed.length() * 2.0 *
                                    std::tan(osg::DegreesToRadians(0.5 * _drawing.fieldOfView)) /
                                    places.height();
            const bool same = (world - hit->world).length() < room * perPixel;
            found.near += same ? 1 : 0;
        }
        return found;
    }

    const bool _globe;
    const PanoramaHills _hills{_globe ? std::optional<double>(0.65) : std::nullopt};
    osg::Vec3d _east, _up;
    osg::Matrixd _view;
    osg::ref_ptr<Georeference> _reference;
    std::optional<Scene> _scene;
    osg::ref_ptr<DepthReader> _reader;
    SceneRenderer::Options _drawing;
    std::unique_ptr<SceneRenderer> _renderer;
};

class PlacesOnGround : public PlacePictureTest, public ::testing::WithParamInterface<bool>
{
protected:
    PlacesOnGround() : PlacePictureTest(GetParam()) {}
};

} // namespace

TEST_P(PlacesOnGround, AgreeWithPicking)
{
    const osg::ref_ptr<BirdsEyeView> bird = new BirdsEyeView;
    bird->setFocusLine(0.3);
    bird->setHorizonLine(0.85);
    const std::vector<osg::ref_ptr<Effect>> effects = {nullptr, bird, map()};
    for (const osg::ref_ptr<Effect>& effect : effects)
    {
        SCOPED_TRACE(effect ? effect->className() : "plain");
        draw(effect, false);
        const Found found = compare(places(), 150, 0.5);
        EXPECT_GT(found.ground, 60);
        EXPECT_GE(found.near, found.ground - 1);
        EXPECT_GE(found.ground + found.sky, found.asked - 2);
        EXPECT_TRUE(!effect || found.sky > 3) << "beyond the horizon";
        EXPECT_FALSE(places().at(-1, 5) || places().at(5, HEIGHT) || places().distanceAt(WIDTH, 5));
    }
}

// On a close-up it is the ground that the close-up shows, in the region and elsewhere that of the pick.
TEST_P(PlacesOnGround, OfCloseUpsIsTheGroundThatTheyShow)
{
    for (const double scaleHeight : {1.5, 0.0})
    {
        const osg::ref_ptr<CloseUp> closeUp = new CloseUp;
        if (_globe)
            closeUp->getRegion()->setGeodeticCenter(0.4, 0.65);
        else
            closeUp->getRegion()->setCenter(osg::Vec2d());
        closeUp->getRegion()->setSize(5000.0, 5000.0);
        closeUp->setOffset(osg::Vec3d(0.0, 0.0, 2500.0));
        closeUp->setScale(1.5, 1.5, scaleHeight);
        const osg::ref_ptr<CloseUps> closeUps = new CloseUps;
        closeUps->addCloseUp(closeUp);
        draw(closeUps, true);
        const PlacePicture places = this->places();
        int lifted = 0, ground = 0, wrong = 0;
        for (int y = 4; y < HEIGHT; y += 6)
            for (int x = 4; x < WIDTH; x += 6)
            {
                const osg::Vec2d pixel(x + 0.5, HEIGHT - y - 0.5);
                const auto place = places.at(x, y);
                const auto hitAt = [&](double right, double up)
                {
                    return pickCloseUp(*_scene->effects, *closeUps, _renderer->camera(), pixel.x() + right,
                                       pixel.y() + up);
                };
                const auto hit = hitAt(0.0, 0.0);
                const DeformedView view(*_scene->effects, _renderer->camera());
                const auto below = view.pick(pixel.x(), pixel.y());
                const bool onCloseUp = hit && !hit->onRegion;
                if (!place || (!onCloseUp && !below)) continue;
                osg::Vec3d world;
                ASSERT_TRUE(_reference->toWorld(osg::DegreesToRadians(place->longitude),
                                                osg::DegreesToRadians(place->latitude), place->height,
                                                world));
                const osg::Vec3d expected = onCloseUp ? hit->world : below->world;
                ++(onCloseUp ? lifted : ground);
                if ((world - expected).length() <= 150.0) continue;
                // At the close-up's border a pixel may show either.
                const auto isOther = [&](double right, double up)
                {
                    const auto beside = hitAt(right, up);
                    return (beside && !beside->onRegion) != onCloseUp;
                };
                wrong +=
                    !(isOther(2.0, 0.0) || isOther(-2.0, 0.0) || isOther(0.0, 2.0) || isOther(0.0, -2.0));
            }
        EXPECT_GT(lifted, 60) << scaleHeight;
        EXPECT_GT(ground, 300) << scaleHeight;
        EXPECT_LE(wrong, lifted / 40) << scaleHeight;
    }
}

// A tile has the places of its pixels of the picture, and no others.
TEST_F(PlacePictureTest, OfATile)
{
    _drawing.width = 70;
    _drawing.height = 60;
    _drawing.pictureWidth = WIDTH;
    _drawing.pictureHeight = HEIGHT;
    draw(map(), false);
    std::string error;
    FrameStatistics unused;
    _renderer->setTile(100, 30);
    const WithoutStrokes without(*_scene->effects);
    ASSERT_TRUE(_renderer->render(_view, 0.0, unused, error)) << error;
    const PlacePicture tile = places();
    EXPECT_EQ(tile.width(), WIDTH);
    int there = 0;
    for (int y = 0; y < HEIGHT; ++y)
        for (int x = 0; x < WIDTH; ++x)
            there += tile.at(x, y) ? 1 : 0;
    EXPECT_EQ(there, 70 * 60);
    EXPECT_TRUE(tile.at(100, HEIGHT - 31) && tile.at(169, HEIGHT - 90));
    const Found found = compare(tile, 600, 0.5);
    EXPECT_GT(found.near, 20);
    EXPECT_EQ(found.near, found.ground);
}

// A pick looks through trees, and so do the places of a frame without them.
TEST_F(PlacePictureTest, LooksThroughStrokesWhereThereAreNone)
{
    const osg::ref_ptr<PanoramaMap> woods = map();
    woods->setStrokeSize(12.0);
    draw(woods, true);
    const Found among = compare(places(), 200, 0.5);
    {
        const WithoutStrokes without(*_scene->effects);
        EXPECT_TRUE(without.changes());
        EXPECT_FALSE(woods->getStrokes());
    }
    EXPECT_TRUE(woods->getStrokes()) << "they are on again";
    draw(woods, false);
    const Found through = compare(places(), 200, 0.5);
    EXPECT_GE(through.near, through.ground - 1);
    EXPECT_LT(among.near, among.ground - 10) << "trees stand before the ground";
}

// With samples a depth is that of one of them: half a pixel beside.
TEST_F(PlacePictureTest, OfSamples)
{
    _drawing.samples = 4;
    draw(map(), false);
    const Found found = compare(places(), 150, 4.0);
    EXPECT_GT(found.ground, 60);
    EXPECT_GE(found.near, found.ground - 6);
}

// Depths as other engines write them: the same places.
TEST_F(PlacePictureTest, OfDepthsOfOtherKinds)
{
    draw(map(), false);
    const PlacePicture usual = places();
    const DepthPicture drawn = *_reader->pictures().front();
    const osg::Matrixd& p = drawn.projection;
    const auto expectTheSame = [&](const DepthPicture& other)
    {
        const PlacePicture same(*_scene->effects, _renderer->camera(),
                                {std::make_shared<DepthPicture>(other)}, *_reference);
        int ground = 0;
        for (int y = 0; y < HEIGHT; y += 7)
        {
            for (int x = 0; x < WIDTH; x += 7)
            {
                const auto a = usual.distanceAt(x, y), b = same.distanceAt(x, y);
                ASSERT_EQ(a.has_value(), b.has_value());
                if (!a) continue;
                ++ground;
                EXPECT_NEAR(*a, *b, 1e-4 * *a);
            }
        }
        EXPECT_GT(ground, 300);
    };
    DepthPicture logarithmic = drawn;
    logarithmic.convention.kind = DepthConvention::LOGARITHMIC;
    logarithmic.convention.farDistance = 1e6;
    DepthPicture reversed = drawn;
    reversed.zeroToOne = true;
    constexpr double near = 10.0, far = 1e6;
    reversed.projection(2, 2) = near / (far - near);
    reversed.projection(3, 2) = near * far / (far - near);
    for (std::size_t i = 0; i < drawn.depths.size(); ++i)
    {
        const double depth = static_cast<double>(drawn.depths[i]);
        const bool sky = depth >= 1.0;
        const double away = p(3, 2) / (2.0 * depth - 1.0 + p(2, 2)); // of a symmetric perspective
        const double w = std::abs(away);
        logarithmic.depths[i] = sky ? 1.0f : static_cast<float>(std::log2(1.0 + w) / std::log2(1e6 + 1.0));
        reversed.depths[i] = sky ? 0.0f : static_cast<float>(near * (far - w) / (w * (far - near)));
    }
    {
        SCOPED_TRACE("logarithmic");
        expectTheSame(logarithmic);
    }
    SCOPED_TRACE("reversed");
    expectTheSame(reversed);
    // Depths that could not be read tell no place.
    DepthPicture none = drawn;
    none.depths.clear();
    const PlacePicture nowhere(*_scene->effects, _renderer->camera(), {std::make_shared<DepthPicture>(none)},
                               *_reference);
    EXPECT_FALSE(nowhere.at(WIDTH / 2, HEIGHT - 10));
}

// A strip all around has a camera for each column, and each of them another deformation. Its tiles lie in one column only, unlike the hills.
TEST_F(PlacePictureTest, OfAPictureInParts)
{
    _scene = loadOahu("oahu");
    ASSERT_TRUE(_scene && _scene->reference) << (_scene ? _scene->referenceError : "");
    _reference = _scene->reference;
    osg::Matrixd frame;
    ASSERT_TRUE(
        _reference->localToWorld(osg::DegreesToRadians(-158.0), osg::DegreesToRadians(21.47), 9000.0, frame));
    _view = osg::Matrixd::inverse(osg::Matrixd::rotate(osg::DegreesToRadians(60.0), osg::X_AXIS) * frame);
    const osg::ref_ptr<PanoramaMap> strip = map();
    strip->setHorizontalAngle(2.0 * osg::PI);
    strip->setHorizonBend(0.0);
    strip->setDetail(0.1);
    _drawing.width = 480;
    _drawing.height = 120;
    _drawing.fieldOfView = 30.0;
    draw(strip, false);
    ASSERT_EQ(_reader->pictures().size(), 2u);
    const Found found = compare(places(), fullTest() ? 200 : 12, 0.5);
    EXPECT_GT(found.ground, 4);
    EXPECT_GE(found.near, found.ground - found.ground / 50);
    EXPECT_GE(found.ground + found.sky, found.asked - found.asked / 10);
}

INSTANTIATE_TEST_SUITE_P(Ground, PlacesOnGround, ::testing::ValuesIn(sampledCases<bool>({false, true}, 2, 1)),
                         [](const auto& each) { return each.param ? "Globe" : "Plane"; });
