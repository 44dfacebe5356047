// SPDX-License-Identifier: MIT
// SPDX-FileCopyrightText: 2026 the osgGeoFX authors
//
// Which side is which in a panorama map: a roof's lit one, the sky's headings, land and water; and that the brush keeps its size while one
// zooms. Each expectation follows from what anyone sees in a sketch of the scene.
#include <tools/GlFixture.h>
#include <tools/SampledCases.h>
#include <tools/StrokeTiles.h>

#include <osgGeoFX/panorama/PanoramaMap.h>
#include <osgGeoFX/scene/EffectScene.h>

#include <algorithm>
#include <cmath>
#include <functional>

using namespace osgGeoFX;
using namespace geofx::test;

namespace
{

constexpr int WIDTH = 240, HEIGHT = 180;
constexpr double RADIUS = 5000.0;
/// Where the camera stands, on the globe: radians.
constexpr double LONGITUDE = 0.4, LATITUDE = 0.7, EARTH = 6378137.0;

class PanoramaSides : public GlFixture, public ::testing::WithParamInterface<bool>
{
protected:
    PanoramaSides() : GlFixture(WIDTH, HEIGHT)
    {
        map->setViewRadius(RADIUS);
        map->setStrokes(false);
        map->setAtmosphere(0.0);
        map->setBrush(0.0);
        map->setBottomShade(0.0);
        map->setEdge(PanoramaMap::SEA);
    }

    /// Ground by metres to the right of the middle of the picture's base and away from it, seen at a heading, degrees clockwise from the
    /// north, on a plane or a globe.
    osg::ref_ptr<osg::Image> draw(double headingDegrees, const std::function<double(double, double)>& height,
                                  const std::function<double(double, double)>& shore)
    {
        const double heading = osg::DegreesToRadians(headingDegrees);
        const bool globe = GetParam();
        StrokeTiles tiles;
        tiles.cells = 200;
        tiles.skirt = 0.0;
        if (globe) tiles.ellipsoid = new osg::EllipsoidModel;
        const double perX = globe ? EARTH * std::cos(LATITUDE) : 1.0, perY = globe ? EARTH : 1.0;
        const double x0 = globe ? LONGITUDE : 0.0, y0 = globe ? LATITUDE : 0.0;
        const auto seen = [=](const std::function<double(double, double)>& function)
        {
            return [=](double x, double y)
            {
                const double east = (x - x0) * perX, north = (y - y0) * perY;
                return function(east * std::cos(heading) - north * std::sin(heading),
                                east * std::sin(heading) + north * std::cos(heading));
            };
        };
        tiles.height = seen(height);
        const auto distance = seen(shore);
        tiles.cover = [=](double x, double y)
        {
            glsl::geofx_Cover cover{};
            cover.shore = distance(x, y);
            return cover;
        };
        const double half = 20000.0;
        const osg::ref_ptr<osg::MatrixTransform> tile =
            tiles.tile(x0 - half / perX, y0 - half / perY, x0 + half / perX, y0 + half / perY);
        auto* cover = StrokeTiles::geometryOf(*tile).getStateSet()->getTextureAttribute(
            7, osg::StateAttribute::TEXTURE);
        static_cast<osg::Texture2D*>(cover)->setResizeNonPowerOfTwoHint(false);
        StrokeTiles::geometryOf(*tile).setUseDisplayList(false);
        StrokeTiles::geometryOf(*tile).setUseVertexBufferObjects(false);
        const osg::ref_ptr<osg::CoordinateSystemNode> root = new osg::CoordinateSystemNode;
        if (globe) root->setEllipsoidModel(tiles.ellipsoid);
        root->addChild(tile);
        const osg::ref_ptr<EffectScene> scene = new EffectScene;
        scene->addEffect(map);
        scene->addChild(root);
        osg::Matrixd local = osg::Matrixd::translate(x0, y0, 0.0);
        if (globe)
            osg::EllipsoidModel().computeLocalToWorldTransformFromLatLongHeight(LATITUDE, LONGITUDE, 0.0,
                                                                                local);
        const osg::Vec3d ahead(std::sin(heading), std::cos(heading), -1.0);
        const osg::Vec3d eye = osg::Vec3d(0.0, 0.0, 8000.0) * local;
        const osg::Vec3d center = (osg::Vec3d(0.0, 0.0, 8000.0) + ahead * 8000.0) * local;
        const osg::Vec3d up = osg::Matrixd::transform3x3(osg::Vec3d(0.0, 0.0, 1.0), local);
        osg::Camera& camera = *viewer().getCamera();
        camera.setViewMatrixAsLookAt(eye, center, up);
        camera.setProjectionMatrixAsPerspective(40.0, static_cast<double>(WIDTH) / HEIGHT, 10.0, 1e5);
        return render(scene);
    }

    static double valueAt(const osg::Image& image, int column, int row)
    {
        const unsigned char* bytes =
            image.data(static_cast<unsigned int>(column), static_cast<unsigned int>(row));
        return (bytes[0] + bytes[1] + bytes[2]) / 765.0;
    }

    const osg::ref_ptr<PanoramaMap> map = new PanoramaMap;
};

const auto level = [](double, double)
{
    return 10.0;
};
const auto dry = [](double, double)
{
    return -400.0;
};

} // namespace

TEST_P(PanoramaSides, TheLightOfARoofComesFromTheLeftWhateverTheHeading)
{
    map->setExaggeration(0.2);
    // A roof whose ridge runs away from the viewer: its left side looks to the left.
    const auto roof = [](double x, double)
    {
        return 2000.0 - 0.3 * std::abs(x);
    };
    // And one whose ridge runs across: its near side looks down in the picture.
    const auto across = [](double, double s)
    {
        return 2000.0 - 0.3 * std::abs(s - 1500.0);
    };
    for (const double heading : {0.0, 70.0, 180.0, -110.0})
    {
        SCOPED_TRACE(heading);
        map->setLightAzimuth(osg::DegreesToRadians(-60.0));
        osg::ref_ptr<osg::Image> image = draw(heading, roof, dry);
        EXPECT_GT(valueAt(*image, WIDTH / 4, HEIGHT / 5), valueAt(*image, 3 * WIDTH / 4, HEIGHT / 5) + 0.05);
        map->setLightAzimuth(osg::DegreesToRadians(60.0));
        image = draw(heading, roof, dry);
        EXPECT_LT(valueAt(*image, WIDTH / 4, HEIGHT / 5), valueAt(*image, 3 * WIDTH / 4, HEIGHT / 5) - 0.05);
        // From behind the ridge the far side is lit; from the viewer's side the near one.
        const int near = HEIGHT / 16, far = HEIGHT * 3 / 10;
        map->setLightAzimuth(0.0);
        image = draw(heading, across, dry);
        EXPECT_GT(valueAt(*image, WIDTH / 2, far), valueAt(*image, WIDTH / 2, near) + 0.05);
        map->setLightAzimuth(osg::PI);
        image = draw(heading, across, dry);
        EXPECT_LT(valueAt(*image, WIDTH / 2, far), valueAt(*image, WIDTH / 2, near) - 0.05);
        if (HasFailure()) return;
    }
}

TEST_P(PanoramaSides, ALandmarkOfTheSkyStandsAtItsHeading)
{
    // A turn of 360 degrees, its left border in the north: a tower in the east, some degrees wide.
    const osg::ref_ptr<osg::Image> sky = new osg::Image;
    sky->allocateImage(512, 64, 1, GL_RGBA, GL_UNSIGNED_BYTE);
    for (unsigned int row = 0; row < 64; ++row)
        for (unsigned int column = 0; column < 512; ++column)
            sky->setColor(column >= 124 && column < 132 ? osg::Vec4(1, 0, 0, 1)
                                                        : osg::Vec4(0.5f, 0.6f, 0.9f, 1),
                          column, row);
    map->setSkyImage(sky);
    // Half of the turn lies across the picture: it is seen up to 90 degrees to the left and to the right.
    for (const double heading : {90.0, 40.0, 150.0, 15.0, -30.0, -90.0, 220.0})
    {
        SCOPED_TRACE(heading);
        const osg::ref_ptr<osg::Image> image = draw(heading, level, dry);
        double sum = 0.0, weights = 0.0;
        for (int column = 0; column < WIDTH; ++column)
        {
            const unsigned char* bytes = image->data(static_cast<unsigned int>(column), HEIGHT * 9 / 10);
            if (bytes[0] < 180 || bytes[1] > 80) continue;
            sum += column + 0.5;
            weights += 1.0;
        }
        const double off = std::remainder(90.0 - heading, 360.0);
        if (std::abs(off) > 95.0)
        {
            EXPECT_EQ(weights, 0.0) << "it is behind the viewer";
            continue;
        }
        ASSERT_GT(weights, 0.0);
        EXPECT_NEAR(sum / weights, WIDTH * (0.5 + off / 180.0), 2.5);
    }
}

TEST_P(PanoramaSides, WaterIsWhereTheCoverSaysSo)
{
    map->setReflection(0.0);
    map->setRipples(0.0);
    // A lake in the picture's left half.
    const osg::ref_ptr<osg::Image> image = draw(25.0, level, [](double x, double) { return -x; });
    for (const int row : {HEIGHT / 10, HEIGHT / 4, HEIGHT / 2})
    {
        const unsigned char* left = image->data(WIDTH / 8, static_cast<unsigned int>(row));
        const unsigned char* right = image->data(7 * WIDTH / 8, static_cast<unsigned int>(row));
        EXPECT_GT(left[2], left[0] + 40) << row;
        EXPECT_LT(right[2], right[1]) << row;
        // Pale at the shore, deep far off.
        const unsigned char* shore = image->data(WIDTH / 2 - 3, static_cast<unsigned int>(row));
        EXPECT_GT(shore[0], left[0] + 40) << row;
    }
}

TEST_P(PanoramaSides, TheBrushKeepsItsSizeWhileOneZooms)
{
    map->setBrush(1.0);
    map->setSky(false);
    // How fast the strokes' light changes across the picture, in its value.
    const auto roughness = [&](double radius)
    {
        map->setViewRadius(radius);
        const osg::ref_ptr<osg::Image> image = draw(0.0, level, dry);
        double steps = 0.0, spread = 0.0, mean = 0.0;
        int count = 0;
        for (int row = 2; row < HEIGHT / 3; ++row)
            for (int column = 1; column < WIDTH; ++column, ++count)
                mean += valueAt(*image, column, row);
        mean /= count;
        for (int row = 2; row < HEIGHT / 3; ++row)
            for (int column = 1; column < WIDTH; ++column)
            {
                steps += std::pow(valueAt(*image, column, row) - valueAt(*image, column - 1, row), 2);
                spread += std::pow(valueAt(*image, column, row) - mean, 2);
            }
        return std::sqrt(steps / spread);
    };
    double least = HUGE_VAL, most = 0.0;
    for (double radius = 1500.0; radius < 6100.0; radius *= std::exp2(0.25))
    {
        const double found = roughness(radius);
        std::cout << radius << " m: " << found << '\n';
        least = std::min(least, found);
        most = std::max(most, found);
    }
    EXPECT_LT(most, 1.6 * least);
    // It does not pop from one size to the next: 1.6 times a power of two.
    map->setViewRadius(1.6 * 2048.0 * 0.9995);
    const osg::ref_ptr<osg::Image> before = draw(0.0, level, dry);
    map->setViewRadius(1.6 * 2048.0 * 1.0005);
    const osg::ref_ptr<osg::Image> after = draw(0.0, level, dry);
    double worst = 0.0;
    for (int row = 2; row < HEIGHT / 4; ++row)
        for (int column = WIDTH / 4; column < WIDTH * 3 / 4; ++column)
            worst = std::max(worst, std::abs(valueAt(*before, column, row) - valueAt(*after, column, row)));
    EXPECT_LT(worst, 0.04);
}

INSTANTIATE_TEST_SUITE_P(Terrains, PanoramaSides, ::testing::ValuesIn(sampledCases<bool>({false, true}, 2)),
                         [](const auto& given) { return given.param ? "Globe" : "Plane"; });
