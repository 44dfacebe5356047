// SPDX-License-Identifier: MIT
// SPDX-FileCopyrightText: 2026 the osgGeoFX authors
//
// Things that a render bin of the host lays out in the picture, as osgEarth does with labels and icons: each stands where the
// deformed ground is, in its own shape and color, and the globe hides what is behind it.
#include <osgGeoFX/deformation/BirdsEyeView.h>
#include <osgGeoFX/deformation/PedestrianView.h>
#include <osgGeoFX/deformation/VerticalExaggeration.h>
#include <osgGeoFX/panorama/PanoramaMap.h>
#include <osgGeoFX/scene/EffectScene.h>
#include <tools/CullHarness.h>
#include <tools/GlFixture.h>
#include <tools/RandomSamples.h>

#include <osg/CoordinateSystemNode>
#include <osg/Geometry>
#include <osg/Math>
#include <osg/MatrixTransform>
#include <osgUtil/RenderBin>
#include <osgUtil/RenderLeaf>

#include <cmath>
#include <cstdlib>
#include <map>
#include <mutex>
#include <string>
#include <vector>

using namespace osgGeoFX;
using namespace geofx::test;

namespace
{

constexpr int WIDTH = 320, HEIGHT = 240;
constexpr const char* BIN = "geofx_test_LayoutBin";
/// Half of a label's width and height, pixels.
constexpr float HALF = 3.0f;

/// Where the labels of the last frame stand, pixels.
std::map<const osg::Drawable*, osg::Vec2d> anchors;

/// Makes a layout of labels as osgEarth does: by the origin of each leaf's own frame.
struct Layout : osgUtil::RenderBin::SortCallback
{
    void sortImplementation(osgUtil::RenderBin* bin) override
    {
        bin->copyLeavesFromStateGraphListToRenderLeafList();
        for (osgUtil::RenderLeaf* leaf : bin->getRenderLeafList())
        {
            const osg::Vec4d clip =
                osg::Vec4d(0.0, 0.0, 0.0, 1.0) * osg::Matrixd(*leaf->_modelview) * *leaf->_projection;
            const osg::Vec2d pixel(0.5 * WIDTH * (clip.x() / clip.w() + 1.0),
                                   0.5 * HEIGHT * (clip.y() / clip.w() + 1.0));
            anchors[leaf->getDrawable()] = pixel;
            leaf->_modelview = new osg::RefMatrix(osg::Matrixd::translate(pixel.x(), pixel.y(), 0.0));
            leaf->_projection = new osg::RefMatrix(osg::Matrixd::ortho(0.0, WIDTH, 0.0, HEIGHT, -1.0, 1.0));
        }
    }
};

class LayoutBin : public osgUtil::RenderBin
{
public:
    LayoutBin()
    {
        setName(BIN);
        setSortCallback(new Layout);
    }
    LayoutBin(const LayoutBin& other, const osg::CopyOp& copy) : osgUtil::RenderBin(other, copy) {}
    osg::Object* clone(const osg::CopyOp& copy) const override { return new LayoutBin(*this, copy); }
};

osg::ref_ptr<osg::Geometry> square(const osg::Vec4& color)
{
    osg::ref_ptr<osg::Geometry> geometry = new osg::Geometry;
    osg::ref_ptr<osg::Vec3Array> vertices = new osg::Vec3Array;
    for (const auto& [x, y] : {std::pair(-HALF, -HALF), {HALF, -HALF}, {HALF, HALF}, {-HALF, HALF}})
        vertices->push_back({x, y, 0.0f});
    osg::ref_ptr<osg::Vec4Array> colors = new osg::Vec4Array(osg::Array::BIND_OVERALL);
    colors->push_back(color);
    geometry->setVertexArray(vertices);
    geometry->setColorArray(colors);
    geometry->addPrimitiveSet(new osg::DrawArrays(GL_TRIANGLE_FAN, 0, 4));
    return geometry;
}

class LaidOutThings : public GlFixture
{
protected:
    LaidOutThings() : GlFixture(WIDTH, HEIGHT) {}
    void SetUp() override
    {
        GlFixture::SetUp();
        if (IsSkipped() || HasFatalFailure()) return;
        osgUtil::RenderBin::addRenderBinPrototype(BIN, _prototype);
        osg::StateSet* state = _labels->getOrCreateStateSet();
        state->setRenderBinDetails(10, BIN, osg::StateSet::OVERRIDE_PROTECTED_RENDERBIN_DETAILS);
        state->setNestRenderBins(false);
        state->setMode(GL_DEPTH_TEST, osg::StateAttribute::OFF);
        state->setMode(GL_LIGHTING, osg::StateAttribute::OFF);
        _scene->setLayoutBins({BIN});
    }
    void TearDown() override
    {
        osgUtil::RenderBin::removeRenderBinPrototype(_prototype);
        GlFixture::TearDown();
    }

    struct Label
    {
        osg::Vec3d place; ///< in the scene's frame
        osg::ref_ptr<osg::Geometry> drawable;
    };
    void add(const osg::Vec3d& place, const osg::Vec4& color = {1.0f, 0.0f, 0.0f, 1.0f})
    {
        osg::ref_ptr<osg::MatrixTransform> transform =
            new osg::MatrixTransform(osg::Matrixd::translate(place));
        osg::ref_ptr<osg::Geometry> drawable = square(color);
        transform->addChild(drawable);
        // As small as it is in metres, OSG would leave it out.
        transform->setCullingActive(false);
        _labels->addChild(transform);
        _all.push_back({place, drawable});
    }
    /// A square of the plane, so that there is ground to move.
    static osg::ref_ptr<osg::Geometry> ground(float size)
    {
        osg::ref_ptr<osg::Geometry> geometry = square({0.2f, 0.4f, 0.2f, 1.0f});
        for (osg::Vec3& vertex : static_cast<osg::Vec3Array&>(*geometry->getVertexArray()))
            vertex *= size / HALF;
        return geometry;
    }
    osg::ref_ptr<const DeformationChain> chain(const osg::Matrixd& view, const osg::Matrixd& projection)
    {
        return _scene->deformation(view, projection);
    }

    /// Puts the labels onto a globe. False where its heights are refused.
    bool makeGlobe()
    {
        osg::ref_ptr<osg::CoordinateSystemNode> earth = new osg::CoordinateSystemNode;
        earth->setEllipsoidModel(_ellipsoid);
        earth->addChild(_labels);
        _scene->addChild(earth);
        EffectScene::GroundDescription heights;
        heights.minHeight = -1000.0;
        heights.maxHeight = 9000.0;
        return _scene->setGround(heights);
    }
    osg::Vec3d placeAt(double latitude, double longitude, double height) const
    {
        osg::Vec3d place;
        _ellipsoid->convertLatLongHeightToXYZ(latitude, longitude, height, place.x(), place.y(), place.z());
        return place;
    }

    const osg::ref_ptr<osg::EllipsoidModel> _ellipsoid = new osg::EllipsoidModel;
    osg::ref_ptr<EffectScene> _scene = new EffectScene;
    osg::ref_ptr<osg::Group> _labels = new osg::Group;
    std::vector<Label> _all;

private:
    osg::ref_ptr<LayoutBin> _prototype = new LayoutBin;
};

/// Where a place, in eye space, is in the picture, pixels; w ≤ 0 behind the eye.
osg::Vec3d pixelOf(const osg::Vec3d& place, const osg::Matrixd& projection)
{
    const osg::Vec4d clip = osg::Vec4d(place, 1.0) * projection;
    return {0.5 * WIDTH * (clip.x() / clip.w() + 1.0), 0.5 * HEIGHT * (clip.y() / clip.w() + 1.0), clip.w()};
}

bool isWithin(const osg::Vec3d& pixel, double margin)
{
    return pixel.z() > 0.0 && pixel.x() > margin && pixel.x() < WIDTH - margin && pixel.y() > margin &&
           pixel.y() < HEIGHT - margin;
}

std::vector<osg::ref_ptr<Effect>> effects()
{
    osg::ref_ptr<VerticalExaggeration> exaggeration = new VerticalExaggeration;
    exaggeration->setFactor(2.0);
    return {exaggeration, new BirdsEyeView, new PedestrianView, new PanoramaMap};
}

} // namespace

TEST_F(LaidOutThings, StandWhereTheGroundGoes)
{
    _scene->addChild(ground(20000.0f));
    _scene->addChild(_labels);
    EffectScene::GroundDescription heights;
    heights.minHeight = 0.0;
    heights.maxHeight = 3000.0;
    ASSERT_TRUE(_scene->setGround(heights));
    Random random(5);
    for (int i = 0; i < (fullTest() ? 600 : 80); ++i)
        add({random.uniform(-15000.0, 15000.0), random.uniform(-15000.0, 15000.0),
             random.uniform(0.0, 3000.0)});
    CullHarness harness(context(), _scene, WIDTH, HEIGHT);
    for (const osg::ref_ptr<Effect>& effect : effects())
    {
        SCOPED_TRACE(effect->className());
        _scene->addEffect(effect);
        const bool isPedestrian = dynamic_cast<const PedestrianView*>(effect.get()) != nullptr;
        int shown = 0, moved = 0;
        for (int camera = 0; camera < (fullTest() ? 20 : 4); ++camera)
        {
            const osg::Vec3d eye(random.uniform(-4000.0, 4000.0), random.uniform(-12000.0, -6000.0),
                                 isPedestrian ? random.uniform(100.0, 800.0)
                                              : random.uniform(3500.0, 6000.0));
            const osg::Matrixd view = osg::Matrixd::lookAt(
                eye, osg::Vec3d(random.uniform(-3000.0, 3000.0), random.uniform(-2000.0, 6000.0), 0.0),
                osg::Vec3d(0.0, 0.0, 1.0));
            const osg::Matrixd projection =
                osg::Matrixd::perspective(45.0, static_cast<double>(WIDTH) / HEIGHT, 10.0, 1e6);
            harness.setCamera(view, projection);
            anchors.clear();
            const Culled culled = harness.frame(true);
            const osg::ref_ptr<const DeformationChain> deformation = chain(view, projection);
            for (const Label& label : _all)
            {
                const osg::Vec3d place = label.place * view;
                const osg::Vec3d pixel = pixelOf(deformation->deform(place), projection);
                const auto found = anchors.find(label.drawable);
                if (!isWithin(pixel, -2.0 * static_cast<double>(HALF)))
                {
                    const bool shows = found != anchors.end() && pixel.z() > 0.0;
                    EXPECT_FALSE(shows && isWithin({found->second, 1.0}, 0.0));
                    continue;
                }
                // All that is beyond a panorama map is one point of its horizon.
                if (!isWithin(pixel, 5.0) || deformation->isBeyond(place)) continue;
                ASSERT_NE(found, anchors.end()) << "no label at " << pixel.x() << ", " << pixel.y();
                EXPECT_NEAR(found->second.x(), pixel.x(), 0.05);
                EXPECT_NEAR(found->second.y(), pixel.y(), 0.05);
                const unsigned char* color = culled.image->data(static_cast<unsigned int>(pixel.x()),
                                                                static_cast<unsigned int>(pixel.y()));
                EXPECT_TRUE(color[0] == 255 && color[1] == 0 && color[2] == 0);
                ++shown;
                if ((pixel - pixelOf(place, projection)).length() > 3.0) ++moved;
            }
        }
        // A pedestrian sees little of so wide a country.
        EXPECT_GT(shown, isPedestrian ? 1 : 20);
        EXPECT_GT(moved, isPedestrian ? 1 : 10);
        _scene->removeEffect(effect);
    }
}

// The kit moves nothing but the place: no pixel of a label is more, less, or of another color.
TEST_F(LaidOutThings, KeepTheirShapeAndColor)
{
    _scene->addChild(_labels);
    add({0.0, 0.0, 0.0});
    CullHarness harness(context(), _scene, WIDTH, HEIGHT);
    const osg::Matrixd view =
        osg::Matrixd::lookAt(osg::Vec3d(0.0, -8000.0, 6000.0), osg::Vec3d(), osg::Vec3d(0.0, 0.0, 1.0));
    const osg::Matrixd projection =
        osg::Matrixd::perspective(45.0, static_cast<double>(WIDTH) / HEIGHT, 10.0, 1e6);
    const auto reds = [&]
    {
        harness.setCamera(view, projection);
        const Culled culled = harness.frame(true);
        int count = 0;
        for (int y = 0; y < HEIGHT; ++y)
            for (int x = 0; x < WIDTH; ++x)
            {
                const unsigned char* color =
                    culled.image->data(static_cast<unsigned int>(x), static_cast<unsigned int>(y));
                count += color[0] == 255 && color[1] == 0 && color[2] == 0 ? 1 : 0;
            }
        return count;
    };
    const int plain = reds();
    EXPECT_GE(plain, 30);
    int shown = 0;
    for (const osg::ref_ptr<Effect>& effect : effects())
    {
        SCOPED_TRACE(effect->className());
        _scene->addEffect(effect);
        const osg::Vec3d place = chain(view, projection)->deform(osg::Vec3d() * view);
        const bool shows = isWithin(pixelOf(place, projection), 5.0);
        shown += shows ? 1 : 0;
        // A label between pixels has a row more or less.
        EXPECT_NEAR(reds(), shows ? plain : 0, 14);
        _scene->removeEffect(effect);
    }
    EXPECT_GE(shown, 3);
}

// They are drawn without a depth test, so nothing else hides what is on the far side of the Earth.
TEST_F(LaidOutThings, BehindTheGlobeAreNotDrawn)
{
    ASSERT_TRUE(makeGlobe());
    Random random(6);
    for (int i = 0; i < (fullTest() ? 1500 : 300); ++i)
        add(placeAt(std::asin(random.uniform(-1.0, 1.0)), random.uniform(-osg::PI, osg::PI),
                    random.uniform(0.0, 9000.0)));
    CullHarness harness(context(), _scene, WIDTH, HEIGHT);
    const double equator = _ellipsoid->getRadiusEquator(), polar = _ellipsoid->getRadiusPolar();
    for (const double factor : {1.0005, 2.0, 30.0, 0.1})
    {
        SCOPED_TRACE(factor);
        osg::ref_ptr<VerticalExaggeration> exaggeration = new VerticalExaggeration;
        exaggeration->setFactor(factor);
        _scene->addEffect(exaggeration);
        int shown = 0, hidden = 0;
        for (int camera = 0; camera < 4; ++camera)
        {
            const osg::Vec3d eye =
                placeAt(random.uniform(-1.5, 1.5), random.uniform(-3.0, 3.0), random.logarithmic(1e6, 2e7));
            const osg::Matrixd view = osg::Matrixd::lookAt(eye, osg::Vec3d(), osg::Vec3d(0.0, 0.3, 1.0));
            const osg::Matrixd projection =
                osg::Matrixd::perspective(90.0, static_cast<double>(WIDTH) / HEIGHT, 1000.0, 1e8);
            harness.setCamera(view, projection);
            anchors.clear();
            harness.frame(true, false);
            const osg::ref_ptr<const DeformationChain> deformation = chain(view, projection);
            const osg::Matrixd toWorld = osg::Matrixd::inverse(view);
            for (const Label& label : _all)
            {
                const osg::Vec3d place = deformation->deform(label.place * view);
                if (!isWithin(pixelOf(place, projection), 5.0)) continue;
                // Whether the way from the eye runs through the ellipsoid before it comes to the place.
                const osg::Vec3d from(eye.x() / equator, eye.y() / equator, eye.z() / polar);
                osg::Vec3d to = place * toWorld;
                to = osg::Vec3d(to.x() / equator, to.y() / equator, to.z() / polar) - from;
                const double half = from * to, rest = half * half - to.length2() * (from.length2() - 1.0);
                const double first = (-half - std::sqrt(std::max(rest, 0.0))) / to.length2();
                const bool behind = rest > 0.0 && first > 0.0 && first < 1.0 - 1e-9;
                EXPECT_EQ(anchors.count(label.drawable), behind ? 0u : 1u);
                (behind ? hidden : shown) += 1;
            }
        }
        EXPECT_GT(shown, 50);
        EXPECT_GT(hidden, 50);
        _scene->removeEffect(exaggeration);
    }
}

// A bend lifts ground into sight. Behind it are places whose line of sight comes out of the bent globe.
TEST_F(LaidOutThings, BehindABentGlobeAreNotDrawn)
{
    ASSERT_TRUE(makeGlobe());
    const double radius = _ellipsoid->getRadiusEquator();
    Random random(7);
    // Ahead of the eye, up to far beyond the horizon.
    for (int i = 0; i < 600; ++i)
        add(placeAt(random.logarithmic(5e3, 8e6) / radius, random.uniform(-0.15, 0.15), 100.0));
    CullHarness harness(context(), _scene, WIDTH, HEIGHT);
    const osg::Vec3d up(1.0, 0.0, 0.0), north(0.0, 0.0, 1.0);
    osg::ref_ptr<VerticalExaggeration> exaggeration = new VerticalExaggeration;
    exaggeration->setFactor(3.0);
    for (const bool alsoHigh : {false, true})
    {
        if (alsoHigh) _scene->addEffect(exaggeration);
        const osg::ref_ptr<BirdsEyeView> bend = new BirdsEyeView;
        _scene->addEffect(bend);
        int shown = 0, hidden = 0;
        for (int camera = 0; camera < 10; ++camera)
        {
            const osg::Vec3d eye = placeAt(0.0, 0.0, random.logarithmic(2000.0, 50000.0));
            const osg::Matrixd view =
                osg::Matrixd::lookAt(eye, eye + north - up * random.uniform(0.5, 1.2), up);
            const osg::Matrixd projection =
                osg::Matrixd::perspective(50.0, static_cast<double>(WIDTH) / HEIGHT, 100.0, 1e8);
            harness.setCamera(view, projection);
            anchors.clear();
            harness.frame(true, false);
            const osg::ref_ptr<const DeformationChain> deformation = chain(view, projection);
            const osg::Matrixd toWorld = osg::Matrixd::inverse(view);
            const auto heightOf = [&](const osg::Vec3d& place)
            {
                const osg::Vec3d world = deformation->undeform(place) * toWorld;
                double latitude = 0.0, longitude = 0.0, height = 0.0;
                _ellipsoid->convertXYZToLatLongHeight(world.x(), world.y(), world.z(), latitude, longitude,
                                                      height);
                return height;
            };
            for (const Label& label : _all)
            {
                const osg::Vec3d place = deformation->deform(label.place * view);
                if (!isWithin(pixelOf(place, projection), 5.0)) continue;
                // How deep below the bent ground the line of sight comes from.
                double deepest = 0.0;
                for (int step = 1; step < 200; ++step)
                    deepest = std::min(deepest, heightOf(place * (1.0 - step / 200.0)));
                if (deepest < 0.0 && deepest > -50.0) continue;
                const bool behind = deepest < 0.0;
                EXPECT_EQ(anchors.count(label.drawable), behind ? 0u : 1u)
                    << "deepest " << deepest << " m, " << place.length() << " m away";
                (behind ? hidden : shown) += 1;
            }
        }
        EXPECT_GT(shown, 30);
        EXPECT_GT(hidden, 50);
        while (_scene->getNumEffects() > 0)
            _scene->removeEffect(_scene->getEffect(0));
    }
}
