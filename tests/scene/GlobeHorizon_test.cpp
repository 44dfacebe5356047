// SPDX-License-Identifier: MIT
// SPDX-FileCopyrightText: 2026 the osgGeoFX authors
//
// What the horizon of a deformed globe hides, and the plane at which engines clip what they draw without a depth test.
#include <osgGeoFX/deformation/BirdsEyeView.h>
#include <osgGeoFX/deformation/PedestrianView.h>
#include <osgGeoFX/deformation/VerticalExaggeration.h>
#include <osgGeoFX/panorama/PanoramaMap.h>
#include <osgGeoFX/scene/EffectScene.h>
#include <osgGeoFX/scene/detail/GlobeHorizon.h>
#include <tools/RandomSamples.h>

#include <gtest/gtest.h>
#include <osg/CoordinateSystemNode>
#include <osg/Math>

#include <algorithm>
#include <cmath>

using namespace osgGeoFX;
using namespace geofx::test;

namespace
{

class GlobeHorizonTest : public testing::Test
{
protected:
    GlobeHorizonTest()
    {
        _ground.ellipsoid = _ellipsoid;
        _ground.minHeight = 0.0;
        _ground.maxHeight = 9000.0;
        _ground.heightsKnown = true;
        const osg::ref_ptr<osg::CoordinateSystemNode> earth = new osg::CoordinateSystemNode;
        earth->setEllipsoidModel(_ellipsoid);
        _scene->addChild(earth);
        EffectScene::GroundDescription heights;
        heights.minHeight = 0.0;
        heights.maxHeight = 9000.0;
        EXPECT_TRUE(_scene->setGround(heights));
    }
    void exaggerate(double factor)
    {
        while (_scene->getNumEffects() > 0)
            _scene->removeEffect(_scene->getEffect(0));
        const osg::ref_ptr<VerticalExaggeration> exaggeration = new VerticalExaggeration;
        exaggeration->setFactor(factor);
        _scene->addEffect(exaggeration);
    }
    osg::Vec3d placeAt(double latitude, double longitude, double height) const
    {
        osg::Vec3d place;
        _ellipsoid->convertLatLongHeightToXYZ(latitude, longitude, height, place.x(), place.y(), place.z());
        return place;
    }
    /// From the equator, to the north.
    static osg::Matrixd lookFrom(const osg::Vec3d& eye, double down)
    {
        const osg::Vec3d up(1.0, 0.0, 0.0), north(0.0, 0.0, 1.0);
        return osg::Matrixd::lookAt(eye, eye + north - up * down, up);
    }

    const osg::ref_ptr<osg::EllipsoidModel> _ellipsoid = new osg::EllipsoidModel;
    const osg::ref_ptr<EffectScene> _scene = new EffectScene;
    Ground _ground;
    const osg::Matrixd _projection = osg::Matrixd::perspective(50.0, 1.3, 100.0, 1e8);
};

} // namespace

// It is where osgEarth has its own.
TEST_F(GlobeHorizonTest, PlaneIsThatOfThePlainGlobeWhereNothingMoves)
{
    const osg::ref_ptr<VerticalExaggeration> weak = new VerticalExaggeration;
    weak->setFactor(1.0000001);
    _scene->addEffect(weak);
    for (const double height : {100.0, 5000.0, 1e6, 3e7})
    {
        SCOPED_TRACE(height);
        const osg::Matrixd view = lookFrom(placeAt(0.0, 0.0, height), 0.5);
        const osg::ref_ptr<const DeformationChain> chain = _scene->deformation(view, _projection);
        const GlobeHorizon horizon(*chain, ViewGeometry(view, _projection, _ground), {});
        const std::optional<osg::Vec4d> plane = horizon.plane();
        ASSERT_TRUE(plane);
        const double radius = _ellipsoid->getRadiusEquator();
        const double angle = std::acos(radius / (radius + height));
        for (const double share : {0.99, 1.01})
        {
            const osg::Vec4d place(placeAt(0.0, share * angle, 0.0) * view, 1.0);
            EXPECT_EQ(*plane * place > 0.0, share < 1.0) << share;
        }
    }
}

// A bend that rolls the ground up turns the far side of the Earth around its zone, too, into the picture. The Earth is before it.
TEST_F(GlobeHorizonTest, PedestriansSeeNothingThroughTheEarth)
{
    Random random(19);
    int hidden = 0, deep = 0;
    for (int i = 0; i < 300; ++i)
    {
        while (_scene->getNumEffects() > 0)
            _scene->removeEffect(_scene->getEffect(0));
        const osg::ref_ptr<PedestrianView> pedestrian = new PedestrianView;
        const PerspectiveBend::Curve curves[] = {PerspectiveBend::BEZIER, PerspectiveBend::ARC_LENGTH,
                                                 PerspectiveBend::CIRCULAR_ARC};
        pedestrian->setCurve(curves[i % 3]);
        _scene->addEffect(pedestrian);
        const osg::Vec3d eye = placeAt(0.0, 0.0, random.logarithmic(60.0, 3e5));
        const osg::Matrixd view = lookFrom(eye, random.uniform(0.1, 0.8));
        const osg::ref_ptr<const DeformationChain> chain = _scene->deformation(view, _projection);
        if (chain->empty()) continue;
        const osg::Vec3d center = osg::Vec3d() * view;
        const double polar = _ellipsoid->getRadiusPolar();
        for (int j = 0; j < 40; ++j)
        {
            // To the east and the west of the zone, nearby and down to the other side.
            const double turn = j % 4 == 0 ? random.uniform(-0.4, 0.4) : random.uniform(0.5, 1.5) * osg::PI;
            const osg::Vec3d place =
                placeAt(random.uniform(-0.02, 0.02), turn, random.uniform(0.0, 9000.0)) * view;
            const bool isHidden = chain->hides({place, random.logarithmic(1.0, 1e4)}, {});
            hidden += isHidden ? 1 : 0;
            deep += std::cos(turn) < -0.3 ? 1 : 0;
            if (!isHidden) continue;
            // Some part of the line of sight is within the undeformed Earth, below all ground.
            const osg::Vec3d seen = chain->deform(place);
            double least = HUGE_VAL;
            for (int k = 1; k < 200; ++k)
                least = std::min(least, (chain->undeform(seen * (k / 200.0)) - center).length());
            EXPECT_LT(least, 0.985 * polar) << eye.length() - 6378137.0 << ' ' << turn;
        }
    }
    EXPECT_GT(hidden, deep / 2);
    EXPECT_GT(deep, 2000);
}

TEST_F(GlobeHorizonTest, PlaneHasAllThatIsSeenOnItsPositiveSide)
{
    Random random(11);
    int planes = 0, seen = 0, cut = 0;
    for (int i = 0; i < 40; ++i)
    {
        while (_scene->getNumEffects() > 0)
            _scene->removeEffect(_scene->getEffect(0));
        osg::ref_ptr<VerticalExaggeration> exaggeration = new VerticalExaggeration;
        exaggeration->setFactor(random.logarithmic(0.2, 8.0));
        exaggeration->setBaseHeight(random.uniform(-2000.0, 2000.0));
        if (i % 2 == 0) _scene->addEffect(exaggeration);
        if (i % 4 != 0) _scene->addEffect(new BirdsEyeView);
        const osg::Vec3d eye = placeAt(0.0, 0.0, random.logarithmic(5000.0, 1e6));
        const osg::Matrixd view = lookFrom(eye, random.uniform(0.3, 1.2));
        const osg::Matrixd toWorld = osg::Matrixd::inverse(view);
        const osg::ref_ptr<const DeformationChain> chain = _scene->deformation(view, _projection);
        if (chain->empty()) continue;
        const GlobeHorizon horizon(*chain, ViewGeometry(view, _projection, _ground), {});
        const std::optional<osg::Vec4d> plane = horizon.plane();
        // A bend may end beyond the horizon.
        if (!plane) continue;
        ++planes;
        for (int j = 0; j < 100; ++j)
        {
            const osg::Vec3d ground =
                placeAt(random.uniform(-1.5, 1.5), random.uniform(-osg::PI, osg::PI), 0.0) * view;
            const osg::Vec3d place = chain->deform(ground);
            double deepest = 0.0;
            for (int step = 1; step < 200 && deepest > -100.0; ++step)
            {
                const osg::Vec3d world = chain->undeform(place * (1.0 - step / 200.0)) * toWorld;
                double latitude = 0.0, longitude = 0.0, height = 0.0;
                _ellipsoid->convertXYZToLatLongHeight(world.x(), world.y(), world.z(), latitude, longitude,
                                                      height);
                deepest = std::min(deepest, height);
            }
            const bool isPositive = *plane * osg::Vec4d(ground, 1.0) > 0.0;
            if (!isPositive) ++cut;
            if (deepest < -1.0) continue;
            ++seen;
            EXPECT_TRUE(isPositive) << "camera " << i << ", " << place.length() << " m away";
        }
    }
    EXPECT_GT(planes, 20);
    EXPECT_GT(seen, 20);
    EXPECT_GT(cut, 1000);
}

TEST_F(GlobeHorizonTest, PlaneIsNotThereInPanoramaMaps)
{
    _scene->addEffect(new PanoramaMap);
    const osg::Matrixd view = lookFrom(placeAt(0.0, 0.0, 8000.0), 0.4);
    const osg::ref_ptr<const DeformationChain> chain = _scene->deformation(view, _projection);
    ASSERT_FALSE(chain->empty());
    EXPECT_FALSE(GlobeHorizon(*chain, ViewGeometry(view, _projection, _ground), {}).plane());
}

// The highest peaks come into sight long before the ground at their feet, and the sooner the higher an effect makes them.
TEST_F(GlobeHorizonTest, HidesNoPeakThatIsSeen)
{
    Random random(12);
    int seen = 0, hidden = 0;
    for (int i = 0; i < 30; ++i)
    {
        exaggerate(random.logarithmic(2.0, 30.0));
        const osg::Matrixd view = lookFrom(placeAt(0.0, 0.0, random.logarithmic(1e4, 1e6)), 0.4);
        const osg::ref_ptr<const DeformationChain> chain = _scene->deformation(view, _projection);
        const GlobeHorizon horizon(*chain, ViewGeometry(view, _projection, _ground), {});
        const osg::Vec3d center = osg::Vec3d() * view;
        for (int j = 0; j < 200; ++j)
        {
            const osg::Vec3d peak = placeAt(0.0, random.uniform(0.0, 1.5), 9000.0) * view;
            const osg::Vec3d place = chain->deform(peak);
            // How near to the Earth's center the line of sight comes.
            const double along = std::clamp((place * center) / place.length2(), 0.0, 1.0);
            const bool isSeen = (place * along - center).length() > _ellipsoid->getRadiusEquator();
            const bool isHidden = horizon.hides(Ball{peak, 1000.0});
            EXPECT_FALSE(isSeen && isHidden) << "camera " << i << ", " << place.length() << " m away";
            seen += isSeen ? 1 : 0;
            hidden += isHidden ? 1 : 0;
        }
    }
    EXPECT_GT(seen, 500);
    EXPECT_GT(hidden, 500);
}

// Most labels stand on the sea or a little below: there the line of sight from the far side comes out of the globe at the label.
TEST_F(GlobeHorizonTest, HidesPlacesOnTheFarSideAtAnyHeight)
{
    Random random(14);
    int seen = 0, hidden = 0;
    for (int i = 0; i < 30; ++i)
    {
        exaggerate(random.logarithmic(0.2, 10.0));
        const osg::Matrixd view = lookFrom(placeAt(0.0, 0.0, random.logarithmic(1e4, 3e7)), 0.4);
        const osg::ref_ptr<const DeformationChain> chain = _scene->deformation(view, _projection);
        const GlobeHorizon horizon(*chain, ViewGeometry(view, _projection, _ground), {});
        const double eye = (osg::Vec3d() * view).length();
        const double atHorizon = std::acos(_ellipsoid->getRadiusEquator() / eye);
        for (const double height : {-50.0, -0.001, 0.0, 0.001, 50.0})
        {
            for (int j = 0; j < 40; ++j)
            {
                const double longitude = random.uniform(-osg::PI, osg::PI);
                const double beyond = std::abs(longitude) - atHorizon;
                // Such heights are seen from a little farther away.
                constexpr double little = 0.03;
                if (std::abs(beyond) < little) continue;
                const bool isHidden = horizon.hidesPlace(placeAt(0.0, longitude, height) * view);
                EXPECT_EQ(isHidden, beyond > 0.0)
                    << "camera " << i << ", " << height << " m, " << beyond << " beyond the horizon";
                ++(isHidden ? hidden : seen);
            }
        }
    }
    EXPECT_GT(seen, 500);
    EXPECT_GT(hidden, 500);
}
