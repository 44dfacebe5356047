// SPDX-License-Identifier: MIT
// SPDX-FileCopyrightText: 2026 the osgGeoFX authors
//
// A panorama map is true: where the sea ends, how high summits stand and what ground is shown, measured in pixels of what was
// drawn. Distances on the globe are GeographicLib's geodesics, not the projection's own.
#include <tools/GlFixture.h>
#include <tools/RandomViews.h>

#include <GeographicLib/Geocentric.hpp>
#include <GeographicLib/Geodesic.hpp>
#include <osg/Geometry>
#include <osg/MatrixTransform>
#include <osgGeoFX/panorama/PanoramaMap.h>
#include <osgGeoFX/scene/EffectScene.h>

#include <algorithm>
#include <cmath>
#include <functional>

using namespace osgGeoFX;
using namespace geofx::test;

namespace
{

constexpr int WIDTH = 400, HEIGHT = 720;

/// A place of the map, metres: to the right of the eye's foot, ahead of it, and the height.
struct MapPlace
{
    double x = 0.0;
    double s = 0.0;
    double height = 0.0;
};

/// A camera with a panorama map before it, and what the map should be like.
struct Shot
{
    CameraPose pose;
    osg::ref_ptr<PanoramaMap> map = new PanoramaMap;

    /// Half the width of what the camera would show straight below it; of a picture without perspective, half its width.
    double radius() const
    {
        const double scale = pose.projection()(0, 0);
        return (pose.lens == CameraPose::ORTHOGRAPHIC ? 1.0 : pose.height) / scale;
    }
    double horizon() const { return map->getHorizonDistance() * radius(); }

    osg::Matrixd localToWorld() const
    {
        osg::Matrixd matrix;
        if (pose.globe)
            osg::EllipsoidModel().computeLocalToWorldTransformFromLatLongHeight(pose.y, pose.x, 0.0, matrix);
        else
            matrix.makeTranslate(pose.x, pose.y, 0.0);
        return matrix;
    }

    /// Into the local frame: x east, y north, z up from the eye's foot.
    osg::Vec3d local(const MapPlace& place) const
    {
        osg::Matrixd toLocal = osg::Matrixd::inverse(localToWorld());
        osg::Vec3d right = osg::Matrixd::transform3x3(osg::Vec3d(1.0, 0.0, 0.0),
                                                      osg::Matrixd::inverse(pose.modelView()) * toLocal);
        right.z() = 0.0;
        right.normalize();
        const osg::Vec3d forward = osg::Vec3d(0.0, 0.0, 1.0) ^ right;
        const osg::Vec3d flat = right * place.x + forward * place.s;
        if (!pose.globe) return flat + osg::Vec3d(0.0, 0.0, place.height);
        double latitude = 0.0;
        double longitude = 0.0;
        GeographicLib::Geodesic::WGS84().Direct(osg::RadiansToDegrees(pose.y), osg::RadiansToDegrees(pose.x),
                                                osg::RadiansToDegrees(std::atan2(flat.x(), flat.y())),
                                                flat.length(), latitude, longitude);
        osg::Vec3d world;
        GeographicLib::Geocentric::WGS84().Forward(latitude, longitude, place.height, world.x(), world.y(),
                                                   world.z());
        return world * toLocal;
    }
};

Shot randomShot(Random& random)
{
    Shot shot;
    do
    {
        shot.pose = randomCommonPose(random);
        shot.pose.height = random.logarithmic(300.0, 2e4);
        shot.pose.pitch = random.uniform(-osg::PI_2, 0.3);
        shot.pose.roll = random.integer(0, 1) ? random.uniform(-1.2, 1.2) : 0.0;
        shot.pose.lowestGround = shot.pose.highestGround = 0.0;
        PanoramaMap& map = *shot.map;
        map.setPaint(false);
        map.setWater(false);
        map.setSky(false);
        map.setStrokes(false);
        map.setCurveDistance(0.0);
        map.setHorizonDistance(random.uniform(1.0, 8.0));
        map.setCurveDistance(random.uniform(0.0, 0.9) * map.getHorizonDistance());
        map.setHorizonLine(random.uniform(0.4, 0.95));
        map.setHorizonBend(random.uniform(0.0, 0.2));
        map.setExaggeration(random.uniform(0.5, 4.0));
    } while (shot.radius() < 100.0 || shot.radius() > 5e4);
    return shot;
}

using Surface = std::function<MapPlace(double u, double v)>;

/// Triangles over a surface with u and v from 0 to 1, in one color.
osg::ref_ptr<osg::Geometry> makeSurface(const Shot& shot, const osg::Vec4& color, unsigned int columns,
                                        unsigned int rows, const Surface& surface)
{
    osg::ref_ptr<osg::Geometry> geometry = new osg::Geometry;
    osg::ref_ptr<osg::Vec3Array> vertices = new osg::Vec3Array;
    osg::ref_ptr<osg::DrawElementsUInt> triangles = new osg::DrawElementsUInt(GL_TRIANGLES);
    for (unsigned int row = 0; row <= rows; ++row)
    {
        for (unsigned int column = 0; column <= columns; ++column)
        {
            vertices->push_back(
                shot.local(surface(static_cast<double>(column) / columns, static_cast<double>(row) / rows)));
            if (row == 0 || column == 0) continue;
            const unsigned int here = row * (columns + 1) + column;
            const unsigned int below = here - columns - 1;
            for (const unsigned int index : {below - 1, below, here, below - 1, here, here - 1})
                triangles->push_back(index);
        }
    }
    geometry->setVertexArray(vertices);
    osg::ref_ptr<osg::Vec4Array> colors = new osg::Vec4Array(osg::Array::BIND_OVERALL);
    colors->push_back(color);
    geometry->setColorArray(colors);
    geometry->addPrimitiveSet(triangles);
    // Each camera's own; a buffer object would be used again, of which Mesa complains.
    geometry->setUseDisplayList(false);
    geometry->setUseVertexBufferObjects(false);
    osg::StateSet* state = geometry->getOrCreateStateSet();
    state->setMode(GL_LIGHTING, osg::StateAttribute::OFF);
    state->setMode(GL_DEPTH_TEST, osg::StateAttribute::OFF);
    return geometry;
}

/// All of the ground that the picture can show, and more.
osg::ref_ptr<osg::Geometry> makeSea(const Shot& shot)
{
    return makeSurface(
        shot, {1, 1, 1, 1}, 80, 400,
        [&](double u, double v) {
            return MapPlace{(2.6 * u - 1.3) * shot.radius(), (1.6 * v - 0.1) * shot.horizon(), 0.0};
        });
}

double channel(const osg::Image& image, int column, int row, int which)
{
    return image.data(static_cast<unsigned int>(column), static_cast<unsigned int>(row))[which] / 255.0;
}

class PanoramaTruth : public GlFixture
{
protected:
    PanoramaTruth() : GlFixture(WIDTH, HEIGHT) {}

    osg::ref_ptr<osg::Image> draw(const Shot& shot, const std::vector<osg::ref_ptr<osg::Geometry>>& things)
    {
        osg::ref_ptr<EffectScene> scene = new EffectScene;
        scene->setTerrainFrame(shot.pose.globe ? EffectScene::GEOCENTRIC : EffectScene::PROJECTED);
        scene->addEffect(shot.map);
        osg::ref_ptr<osg::MatrixTransform> foot = new osg::MatrixTransform(shot.localToWorld());
        for (const auto& thing : things)
            foot->addChild(thing);
        scene->addChild(foot);
        osg::Camera& camera = *viewer().getCamera();
        camera.setComputeNearFarMode(osg::CullSettings::DO_NOT_COMPUTE_NEAR_FAR);
        camera.setClearColor({0.0f, 0.0f, 0.0f, 1.0f});
        camera.setViewport(0, 0, WIDTH, HEIGHT);
        camera.setProjectionMatrix(shot.pose.projection());
        camera.setViewMatrix(shot.pose.modelView());
        return render(scene);
    }

    static int topRow(const osg::Image& image, int column, int which)
    {
        for (int row = HEIGHT - 1; row >= 0; --row)
        {
            if (channel(image, column, row, which) > 0.5) return row;
        }
        return -1;
    }
};

} // namespace

TEST_F(PanoramaTruth, ASeaEndsAtTheHorizonLineAndFollowsEquationOne)
{
    double worst = 0.0;
    double worstMiddle = 0.0;
    int columns = 0;
    for (int i = 0; i < (fullTest() ? 500 : 50); ++i)
    {
        Random random(static_cast<std::uint64_t>(i));
        const Shot shot = randomShot(random);
        SCOPED_TRACE(::testing::Message() << i << ": " << describe(*shot.map) << "; " << shot.pose);
        const osg::ref_ptr<osg::Image> image = draw(shot, {makeSea(shot)});
        for (int column = 0; column < WIDTH; column += 7)
        {
            const double x = (column + 0.5) / WIDTH * 2.0 - 1.0;
            const double expected = HEIGHT * (shot.map->getHorizonLine() -
                                              shot.map->getHorizonBend() * (1.0 - std::cos(x * osg::PI_2)));
            // The border of what is drawn lies between the middles of two rows.
            const double off = std::abs(topRow(*image, column, 0) + 1.0 - expected);
            worst = std::max(worst, off);
            if (std::abs(x) < 0.02) worstMiddle = std::max(worstMiddle, off);
            EXPECT_LE(off, 1.0) << "column " << column;
            ++columns;
        }
        if (HasFailure()) return;
    }
    std::cout << columns << " columns, worst " << worst << " pixels, in the middle " << worstMiddle << '\n';
}

TEST_F(PanoramaTruth, ASeaOfFewTrianglesFarBeyondThePictureFollowsEquationOneAtBothSides)
{
    double worst = 0.0;
    for (int i = 0; i < (fullTest() ? 200 : 20); ++i)
    {
        Random random(static_cast<std::uint64_t>(i) + 3000);
        Shot shot = randomShot(random);
        shot.map->setHorizonBend(random.uniform(0.05, 0.2));
        const double wide = random.logarithmic(1.5, 8.0);
        // Beyond the horizon, all of it is gathered in one point.
        const double far = random.logarithmic(1.5, 12.0);
        SCOPED_TRACE(::testing::Message() << i << ": " << wide << " radii, " << far << " horizons, "
                                          << describe(*shot.map) << "; " << shot.pose);
        const auto sea = makeSurface(shot, {1, 1, 1, 1}, 24, 24,
                                     [&](double u, double v) {
                                         return MapPlace{(2.0 * u - 1.0) * wide * shot.radius(),
                                                         (far * v - 0.1) * shot.horizon(), 0.0};
                                     });
        const osg::ref_ptr<osg::Image> image = draw(shot, {sea, makeSea(shot)});
        for (int column = 0; column < WIDTH; column += 7)
        {
            const double x = (column + 0.5) / WIDTH * 2.0 - 1.0;
            const double expected = HEIGHT * (shot.map->getHorizonLine() -
                                              shot.map->getHorizonBend() * (1.0 - std::cos(x * osg::PI_2)));
            const double off = std::abs(topRow(*image, column, 0) + 1.0 - expected);
            worst = std::max(worst, off);
            EXPECT_LE(off, 1.0) << "column " << column;
        }
        if (HasFailure()) return;
    }
    std::cout << "worst " << worst << " pixels\n";
}

TEST_F(PanoramaTruth, SummitsStandInTheRatioOfTheirHeightsWhateverTheirDistance)
{
    double worst = 0.0;
    for (int i = 0; i < (fullTest() ? 400 : 40); ++i)
    {
        Random random(static_cast<std::uint64_t>(i) + 1000);
        Shot shot = randomShot(random);
        shot.map->setHorizonLine(random.uniform(0.3, 0.4));
        const double scale = shot.pose.projection()(1, 1) / shot.pose.projection()(0, 0);
        // One summit is 200 pixels high, the other k times as high.
        const double high = 400.0 / HEIGHT * shot.radius() / (scale * shot.map->getExaggeration());
        const double k = random.logarithmic(0.75, 1.33);
        SCOPED_TRACE(::testing::Message()
                     << i << ": k " << k << ", " << describe(*shot.map) << "; " << shot.pose);
        const double wide = 0.03 * shot.radius();
        // So that all of the mark at its foot is in the picture, lowered by Eq. 1.
        const double lowered = shot.map->getHorizonBend() * (1.0 - std::cos(0.5 * osg::PI_2)) + 0.01;
        const double along = 2.0 * shot.map->getHorizonLine() /
                             (shot.horizon() + shot.map->getCurveDistance() * shot.radius());
        const double nearS = std::max(random.uniform(0.05, 0.3) * shot.horizon(), lowered / along + wide);
        const double farS = random.uniform(0.5, 0.95) * shot.horizon();
        double shown[2] = {};
        for (int cone = 0; cone < 2; ++cone)
        {
            // In the middle of a column of pixels.
            const MapPlace summit{((cone == 0 ? -0.5 : 0.5) + 1.0 / WIDTH) * shot.radius(),
                                  cone == 0 ? nearS : farS, cone == 0 ? high : k * high};
            const auto mountain =
                makeSurface(shot, {1, 1, 1, 1}, 32, 32,
                            [&](double u, double v)
                            {
                                const double angle = 2.0 * osg::PI * u;
                                const double away = wide * (1.0 - v);
                                return MapPlace{summit.x + away * std::cos(angle),
                                                summit.s + away * std::sin(angle), summit.height * v};
                            });
            // A mark in the middle of the mountain's foot, some pixels large.
            const auto mark = makeSurface(shot, {1, 1, 1, 1}, 1, 32,
                                          [&](double u, double v) {
                                              return MapPlace{summit.x + wide * (2.0 * u - 1.0),
                                                              summit.s + wide * (2.0 * v - 1.0), 0.0};
                                          });
            const auto rowsOf = [&](const osg::ref_ptr<osg::Geometry>& thing, int& low)
            {
                const osg::ref_ptr<osg::Image> image = draw(shot, {thing});
                int top = -1;
                low = HEIGHT;
                for (int row = 0; row < HEIGHT; ++row)
                {
                    for (int column = 0; column < WIDTH; ++column)
                    {
                        if (channel(*image, column, row, 0) < 0.5) continue;
                        top = row;
                        low = std::min(low, row);
                    }
                }
                return top;
            };
            int low = 0;
            const int top = rowsOf(mountain, low);
            const int markTop = rowsOf(mark, low);
            ASSERT_GE(markTop, 0);
            shown[cone] = top + 1.0 - (markTop + low + 1.0) / 2.0;
        }
        const double off = shown[1] / shown[0] / k - 1.0;
        worst = std::max(worst, std::abs(off));
        EXPECT_NEAR(shown[0], 200.0, 3.0);
        EXPECT_LT(std::abs(off), 0.02) << shown[0] << " and " << shown[1] << " pixels";
        if (HasFailure()) return;
    }
    std::cout << "ratios off by " << 100.0 * worst << " % at most\n";
}

TEST_F(PanoramaTruth, TheGroundShownIsARectangle)
{
    double worst = 0.0;
    for (int i = 0; i < (fullTest() ? 300 : 30); ++i)
    {
        Random random(static_cast<std::uint64_t>(i) + 2000);
        const Shot shot = randomShot(random);
        shot.map->setHorizonBend(0.0);
        SCOPED_TRACE(::testing::Message() << i << ": " << describe(*shot.map) << "; " << shot.pose);
        // A rim of a twentieth inside the rectangle: left red, right green; blue where the ground begins and ends.
        const double r = shot.radius();
        const double end = shot.horizon();
        const auto strip = [&](const osg::Vec4& color, double x0, double x1, double s0, double s1)
        {
            return makeSurface(shot, color, 40, 400,
                               [=](double u, double v) {
                                   return MapPlace{(x0 + u * (x1 - x0)) * r, (s0 + v * (s1 - s0)) * end, 0.0};
                               });
        };
        const osg::ref_ptr<osg::Image> image = draw(
            shot, {strip({1, 0, 0, 1}, -1.0, -0.95, 0.0, 1.0), strip({0, 1, 0, 1}, 0.95, 1.0, 0.0, 1.0)});
        const int top = static_cast<int>(shot.map->getHorizonLine() * HEIGHT);
        for (int row = 0; row < top - 1; ++row)
        {
            int red = 0;
            int green = 0;
            for (int column = 0; column < WIDTH; ++column)
            {
                red += channel(*image, column, row, 0) > 0.5 ? 1 : 0;
                green += channel(*image, column, row, 1) > 0.5 ? 1 : 0;
            }
            const double wide = 0.025 * WIDTH;
            worst = std::max({worst, std::abs(red - wide), std::abs(green - wide)});
            EXPECT_NEAR(red, wide, 1.0) << "row " << row;
            EXPECT_NEAR(green, wide, 1.0) << "row " << row;
            EXPECT_GT(channel(*image, 0, row, 0), 0.5);
            EXPECT_GT(channel(*image, WIDTH - 1, row, 1), 0.5);
        }
        // Marks in its four corners lie in those of the picture, the far ones below the horizon.
        const double size = 0.04;
        const osg::ref_ptr<osg::Image> corners =
            draw(shot, {strip({1, 0, 0, 1}, -1.0, size - 1.0, 0.0, size * shot.radius() / end),
                        strip({0, 1, 0, 1}, 1.0 - size, 1.0, 0.0, size * shot.radius() / end),
                        strip({0, 0, 1, 1}, -1.0, size - 1.0, 0.7, 1.0),
                        strip({1, 1, 0, 1}, 1.0 - size, 1.0, 0.7, 1.0)});
        EXPECT_GT(channel(*corners, 0, 0, 0), 0.5);
        EXPECT_GT(channel(*corners, WIDTH - 1, 0, 1), 0.5);
        for (const int column : {0, WIDTH - 1})
        {
            const int far = topRow(*corners, column, column == 0 ? 2 : 0);
            EXPECT_NEAR(far + 1.0, shot.map->getHorizonLine() * HEIGHT, 1.0);
        }
        if (HasFailure()) return;
    }
    std::cout << "borders off by " << worst << " pixels at most\n";
}
