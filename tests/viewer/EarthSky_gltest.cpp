// SPDX-License-Identifier: MIT
// SPDX-FileCopyrightText: 2026 the osgGeoFX authors
// The sky around the Earth, against air that the test adds up along the ray.
#include <osgGeoFX/deformation/BirdsEyeView.h>
#include <osgGeoFX/deformation/PedestrianView.h>
#include <osgGeoFX/scene/EffectScene.h>
#include <osgGeoFX/viewer/EarthSky.h>
#include <tools/GlFixture.h>

#include <osg/Geometry>
#include <osg/Math>
#include <osg/ShapeDrawable>

#include <algorithm>
#include <cmath>
#include <limits>

namespace
{

const osg::Vec3 air(0.72f, 0.80f, 0.88f);
const osg::Vec3d scatter = osg::Vec3d(5.8e-6, 13.5e-6, 33.1e-6) * 2.5;
constexpr double AIR_HEIGHT = 8.0e3, HAZE_HEIGHT = 1.2e3;

/// What a ray meets of air or haze, in metres of what is at the sea, from an eye on a ball of the Earth's size. Where
/// it ends on the ball, `hits` is set.
double metAlong(const osg::Vec3d& eye, const osg::Vec3d& ray, double radius, double scale, bool& hits)
{
    const double middle = -(eye * ray), offset2 = eye.length2() - middle * middle;
    hits = offset2 < radius * radius && middle > 0.0;
    const double end = hits ? middle - std::sqrt(radius * radius - offset2) : std::max(middle, 0.0) + 3e6;
    const double start = std::max(0.0, middle - 3e6);
    double sum = 0.0;
    constexpr int STEPS = 20000;
    const double step = (end - start) / STEPS;
    for (int i = 0; i < STEPS; ++i)
        sum += step * std::exp(-((eye + ray * (start + (i + 0.5) * step)).length() - radius) / scale);
    return sum;
}

class EarthSky : public geofx::test::GlFixture
{
protected:
    static constexpr double RADIUS = 6378137.0;

    void SetUp() override
    {
        GlFixture::SetUp();
        if (IsSkipped() || HasFatalFailure()) return;
        _sky = osgGeoFX::makeEarthSky(osg::EllipsoidModel(RADIUS, RADIUS), air);
        viewer().getCamera()->setClearColor(osg::Vec4(1.0f, 0.0f, 1.0f, 1.0f));
    }

    /// The eye over the equator. Pitch is counted from the level, upwards; degrees.
    osg::ref_ptr<osg::Image> look(osg::Node* scene, double height, double pitch, double fieldOfView)
    {
        const double angle = osg::DegreesToRadians(pitch);
        _eye.set(RADIUS + height, 0.0, 0.0);
        _view = osg::Matrixd::lookAt(_eye, _eye + osg::Vec3d(std::sin(angle), 0.0, std::cos(angle)) * RADIUS,
                                     osg::Vec3d(std::cos(angle), 0.0, -std::sin(angle)));
        viewer().getCamera()->setViewMatrix(_view);
        viewer().getCamera()->setProjectionMatrixAsPerspective(fieldOfView, 1.0, 1.0, 1e6);
        _tangent = std::tan(osg::DegreesToRadians(0.5 * fieldOfView));
        return render(scene);
    }

    osg::Vec3d ray(double column, double row) const
    {
        osg::Vec3d direction(((column + 0.5) / 128.0 - 1.0) * _tangent,
                             ((row + 0.5) / 128.0 - 1.0) * _tangent, -1.0);
        direction = osg::Matrixd::transform3x3(direction, osg::Matrixd::inverse(_view));
        direction.normalize();
        return direction;
    }

    double airAlong(const osg::Vec3d& ray, bool& hits) const
    {
        return metAlong(_eye, ray, RADIUS, AIR_HEIGHT, hits);
    }

    /// Compares the sky's pictures with air that is added up; `haze`: what haze at the sea scatters, to a metre.
    void expectAirAlongRays(osg::Node& sky, double haze);

    osg::ref_ptr<osg::Node> _sky;
    osg::Vec3d _eye;
    osg::Matrixd _view;
    double _tangent = 1.0;
};

} // namespace

void EarthSky::expectAirAlongRays(osg::Node& sky, double haze)
{
    struct View
    {
        double height, pitch, fieldOfView;
    };
    int rim = 0, space = 0, ground = 0;
    for (const View& v : {View{2.0, 10.0, 60.0}, View{2000.0, 0.0, 30.0}, View{20e3, -4.5, 20.0},
                          View{200e3, -14.0, 6.0}, View{2e6, -40.4, 3.0}, View{20e6, -76.0, 2.0}})
    {
        SCOPED_TRACE(v.height);
        const osg::ref_ptr<osg::Image> image = look(&sky, v.height, v.pitch, v.fieldOfView);
        for (int row = 1; row < 256; row += 3)
        {
            // Not where the horizon runs through the pixel.
            bool below = false, above = false;
            airAlong(ray(128, row - 1), below);
            airAlong(ray(128, row + 1), above);
            if (below != above) continue;
            bool hits = false;
            const double metres = airAlong(ray(128, row), hits);
            const double hazy = haze * metAlong(_eye, ray(128, row), RADIUS, HAZE_HEIGHT, hits);
            const osg::Vec4 seen = image->getColor(128, row);
            for (unsigned int channel = 0; channel < 3; ++channel)
            {
                const double sea[] = {0.10, 0.19, 0.33};
                const double veil = 1.0 - std::exp(-metres * scatter[channel] - hazy);
                const double expected =
                    (hits ? sea[channel] : 0.0) * (1.0 - veil) + static_cast<double>(air[channel]) * veil;
                // A byte's rounding, and what a parabola for the round Earth costs.
                ASSERT_NEAR(static_cast<double>(seen[channel]), expected, 0.03)
                    << "row " << row << ", channel " << channel << ", " << metres << " m of air";
            }
            ground += hits;
            space += !hits && metres < 1.0;
            rim += !hits && metres > 1e4 && metres < 3e5;
        }
    }
    // The views meet all three kinds.
    EXPECT_GT(rim, 20);
    EXPECT_GT(space, 20);
    EXPECT_GT(ground, 50);
}

TEST_F(EarthSky, AirThinsOutAlongTheRay)
{
    const osg::EllipsoidModel ball(RADIUS, RADIUS);
    expectAirAlongRays(*osgGeoFX::makeEarthSky(ball, air, std::numeric_limits<double>::infinity()), 0.0);
}

TEST_F(EarthSky, HazeThinsOutFasterThanAir)
{
    const osg::EllipsoidModel ball(RADIUS, RADIUS);
    for (const double visibility : {300e3, 30e3})
        expectAirAlongRays(*osgGeoFX::makeEarthSky(ball, air, visibility), -std::log(0.02) / visibility);
}

// A bird's-eye view looks down at the ground and has its horizon in the picture. Its sky is that of a camera which is turned against the ground as the
// bend turns the far ground.
TEST_F(EarthSky, ComesDownWithTheHorizonOfABend)
{
    const osg::EllipsoidModel ball(RADIUS, RADIUS);
    const osg::ref_ptr<osg::CoordinateSystemNode> ground = new osg::CoordinateSystemNode;
    ground->setEllipsoidModel(new osg::EllipsoidModel(ball));
    const osg::ref_ptr<osgGeoFX::EffectScene> scene = new osgGeoFX::EffectScene;
    scene->addChild(ground);
    const osg::ref_ptr<osgGeoFX::BirdsEyeView> bird = new osgGeoFX::BirdsEyeView;
    bird->setHorizonLine(0.84);
    scene->addEffect(bird);
    const osg::ref_ptr<osg::Group> both = new osg::Group;
    both->addChild(osgGeoFX::makeEarthSky(ball, air, osgGeoFX::DEFAULT_VISIBILITY, scene));
    both->addChild(scene);

    constexpr double height = 4000.0, pitch = -42.0, fieldOfView = 40.0;
    const osg::ref_ptr<osg::Image> bent = look(both, height, pitch, fieldOfView);
    const osg::Matrixd plainView = _view, projection = viewer().getCamera()->getProjectionMatrix();
    const double down = osg::DegreesToRadians(-pitch);
    osg::Matrixd moved = scene->deformation(plainView, projection)
                             ->placement(osg::Vec3d(0.0, std::sin(down), -std::cos(down)) * 1e6);
    moved.setTrans(osg::Vec3d());
    viewer().getCamera()->setViewMatrix(plainView * moved);
    const osg::ref_ptr<osg::Image> expected = render(_sky);
    const osg::ref_ptr<osg::Image> straight = look(_sky, height, pitch, fieldOfView);
    for (unsigned int row = 0; row < 256; ++row)
        for (unsigned int channel = 0; channel < 3; ++channel)
            ASSERT_NEAR(bent->getColor(128, row)[channel], expected->getColor(128, row)[channel], 1.1 / 255.0)
                << "row " << row;
    // At the line of the horizon there is bright air, and a dark sea without the bend.
    EXPECT_GT(bent->getColor(128, 217).r(), 0.6f);
    EXPECT_LT(straight->getColor(128, 217).r(), 0.4f);

    // A pedestrian's ground rises into the sky, and the sky stays.
    scene->removeEffect(bird);
    scene->addEffect(new osgGeoFX::PedestrianView);
    const osg::ref_ptr<osg::Image> folded = look(both, 300.0, -3.0, fieldOfView);
    const osg::ref_ptr<osg::Image> above = look(_sky, 300.0, -3.0, fieldOfView);
    for (unsigned int row = 0; row < 256; ++row)
        ASSERT_EQ(folded->getColor(128, row), above->getColor(128, row)) << "row " << row;
}

TEST_F(EarthSky, NearAndFarAreThoseOfTheSceneAndNothingIsHidden)
{
    osg::ref_ptr<osg::Geode> ball = new osg::Geode;
    ball->addDrawable(
        new osg::ShapeDrawable(new osg::Sphere(osg::Vec3(6478137.0f, 0.0f, 20000.0f), 2000.0f)));
    look(ball, 100e3, 0.0, 30.0);
    double left, right, bottom, top, near, far, skyNear, skyFar;
    viewer().getCamera()->getProjectionMatrixAsFrustum(left, right, bottom, top, near, far);
    osg::ref_ptr<osg::Group> both = new osg::Group;
    both->addChild(ball); // drawn first, if bins did not say otherwise
    both->addChild(_sky);
    const osg::ref_ptr<osg::Image> alone = look(ball, 100e3, 0.0, 30.0),
                                   withSky = look(both, 100e3, 0.0, 30.0);
    viewer().getCamera()->getProjectionMatrixAsFrustum(left, right, bottom, top, skyNear, skyFar);
    EXPECT_EQ(near, skyNear);
    EXPECT_EQ(far, skyFar);
    int ballPixels = 0;
    for (unsigned int row = 0; row < 256; ++row)
        for (unsigned int column = 0; column < 256; ++column)
        {
            const osg::Vec4 before = alone->getColor(column, row);
            if (before == osg::Vec4(1.0f, 0.0f, 1.0f, 1.0f)) continue;
            ++ballPixels;
            ASSERT_EQ(before, withSky->getColor(column, row)) << column << " " << row;
        }
    EXPECT_GT(ballPixels, 1000);
}
