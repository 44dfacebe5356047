// SPDX-License-Identifier: MIT
// SPDX-FileCopyrightText: 2026 the osgGeoFX authors
//
// The painting of a panorama map on grounds whose classes are known: the palette's colors in light and shade, air that keeps the
// value, and a picture of whatever terrain there is.
#include <tools/GlFixture.h>
#include <tools/RandomSamples.h>
#include <tools/SmoothTexture.h>

#include <osg/Geometry>
#include <osg/Texture2D>
#include <osgGeoFX/effect/GlslFunctions.h>
#include <osgGeoFX/panorama/PanoramaMap.h>
#include <osgGeoFX/panorama/PanoramaPalette.h>
#include <osgGeoFX/scene/EffectScene.h>

#include <algorithm>
#include <cmath>
#include <functional>
#include <optional>

using namespace osgGeoFX;
using namespace geofx::test;

namespace
{

constexpr int WIDTH = 240, HEIGHT = 180;
/// Half the width of the ground shown, metres.
constexpr double RADIUS = 5000.0;

/// A terrain as one tile: heights, metres, and what lies there, by metres east and north of the picture's base.
struct Land
{
    std::function<double(double x, double y)> height = [](double, double)
    {
        return 0.0;
    };
    /// Nothing where tiles do not tell.
    std::function<glsl::geofx_Cover(double x, double y)> cover = nullptr;
    /// Where there is no ground.
    std::function<bool(double x, double y)> hole = [](double, double)
    {
        return false;
    };
};

constexpr double WEST = -1.5 * RADIUS, SOUTH = -0.5 * RADIUS, SIZE = 6.0 * RADIUS;
constexpr unsigned int CELLS = 192;

glsl::geofx_Cover coverOf(double trees, double town, double bare, double shore)
{
    return {trees, town, bare, shore};
}

osg::ref_ptr<osg::Texture2D> makeCover(const Land& land)
{
    constexpr int texels = 256;
    osg::ref_ptr<osg::Image> image = new osg::Image;
    image->allocateImage(texels, texels, 1, GL_RGBA, GL_UNSIGNED_BYTE);
    image->setInternalTextureFormat(GL_RGBA8);
    for (int row = 0; row < texels; ++row)
    {
        for (int column = 0; column < texels; ++column)
        {
            const glm::dvec4 texel = glsl::geofx_coverTexel(
                land.cover(WEST + SIZE * (column + 0.5) / texels, SOUTH + SIZE * (row + 0.5) / texels));
            unsigned char* bytes =
                image->data(static_cast<unsigned int>(column), static_cast<unsigned int>(row));
            for (int i = 0; i < 4; ++i)
                bytes[i] = static_cast<unsigned char>(std::lround(texel[i] * 255.0));
        }
    }
    return smoothTexture(image);
}

osg::ref_ptr<osg::Geometry> makeLand(const Land& land)
{
    const double step = SIZE / CELLS;
    osg::ref_ptr<osg::Vec3Array> places = new osg::Vec3Array;
    osg::ref_ptr<osg::Vec3Array> normals = new osg::Vec3Array;
    osg::ref_ptr<osg::Vec2Array> texels = new osg::Vec2Array;
    osg::ref_ptr<osg::DrawElementsUInt> triangles = new osg::DrawElementsUInt(GL_TRIANGLES);
    for (unsigned int row = 0; row <= CELLS; ++row)
    {
        for (unsigned int column = 0; column <= CELLS; ++column)
        {
            const double x = WEST + column * step;
            const double y = SOUTH + row * step;
            places->push_back(osg::Vec3(osg::Vec3d(x, y, land.height(x, y))));
            osg::Vec3d normal(land.height(x - 0.5 * step, y) - land.height(x + 0.5 * step, y),
                              land.height(x, y - 0.5 * step) - land.height(x, y + 0.5 * step), step);
            normal.normalize();
            normals->push_back(osg::Vec3(normal));
            texels->push_back(osg::Vec2(osg::Vec2d(column, row) / CELLS));
            if (row == 0 || column == 0 || land.hole(x - 0.5 * step, y - 0.5 * step)) continue;
            const unsigned int here = row * (CELLS + 1) + column;
            const unsigned int below = here - CELLS - 1;
            for (const unsigned int index : {below - 1, below, here, below - 1, here, here - 1})
                triangles->push_back(index);
        }
    }
    osg::ref_ptr<osg::Geometry> geometry = new osg::Geometry;
    geometry->setVertexArray(places);
    geometry->setNormalArray(normals, osg::Array::BIND_PER_VERTEX);
    geometry->setTexCoordArray(0, texels, osg::Array::BIND_PER_VERTEX);
    geometry->addPrimitiveSet(triangles);
    geometry->setUseDisplayList(false);
    // A buffer object would be used again for the next land, of which Mesa complains.
    geometry->setUseVertexBufferObjects(false);
    if (land.cover) geometry->getOrCreateStateSet()->setTextureAttribute(7, makeCover(land));
    return geometry;
}

struct Pixel
{
    double red = 0.0, green = 0.0, blue = 0.0;

    double value() const { return std::max({red, green, blue}); }
    double hue() const { return glsl::geofx_toHsv({red, green, blue}).x; }
    double off(const Pixel& other) const
    {
        return std::max(
            {std::abs(red - other.red), std::abs(green - other.green), std::abs(blue - other.blue)});
    }
};

Pixel pixelOf(const osg::Image& image, int column, int row)
{
    const unsigned char* bytes =
        image.data(static_cast<unsigned int>(column), static_cast<unsigned int>(row));
    return {bytes[0] / 255.0, bytes[1] / 255.0, bytes[2] / 255.0};
}

/// Shortest way around the circle of hues, 0…0.5.
double hueDistance(double a, double b)
{
    return std::abs(std::remainder(a - b, 1.0));
}

class PanoramaPainting : public GlFixture
{
protected:
    PanoramaPainting() : GlFixture(WIDTH, HEIGHT) {}

    osg::ref_ptr<PanoramaMap> makeMap()
    {
        osg::ref_ptr<PanoramaMap> map = new PanoramaMap;
        map->setViewRadius(RADIUS);
        return map;
    }

    void show(const Land& land, PanoramaMap* map)
    {
        _scene = new EffectScene;
        _scene->setTerrainFrame(EffectScene::PROJECTED);
        _scene->addEffect(map);
        _scene->addChild(makeLand(land));
        osg::Camera& camera = *viewer().getCamera();
        camera.setViewMatrixAsLookAt(osg::Vec3d(0.0, 0.0, 8000.0), osg::Vec3d(0.0, 8000.0, 0.0),
                                     osg::Vec3d(0.0, 0.0, 1.0));
        camera.setProjectionMatrixAsPerspective(40.0, static_cast<double>(WIDTH) / HEIGHT, 10.0, 1e5);
    }

    osg::ref_ptr<osg::Image> draw() { return render(_scene); }

private:
    osg::ref_ptr<EffectScene> _scene;
};

double hills(double x, double y)
{
    return 400.0 + 350.0 * std::sin(x / 900.0) * std::cos(y / 1300.0) +
           80.0 * std::sin((x - 2.0 * y) / 500.0);
}

/// All classes side by side, with a lake.
Land mixedLand()
{
    Land land;
    land.height = [](double x, double y)
    {
        return std::max(0.0, hills(x, y) - 100.0);
    };
    land.cover = [](double x, double y)
    {
        const double lake = 600.0 - std::hypot(x - 1500.0, y - 5000.0);
        return coverOf(0.5 + 0.5 * std::sin(x / 700.0), 0.5 + 0.5 * std::sin(y / 1700.0),
                       0.5 + 0.5 * std::sin((x + y) / 2300.0), lake);
    };
    return land;
}

} // namespace

TEST_F(PanoramaPainting, AirKeepsTheValueAndLiftsTheDark)
{
    const osg::ref_ptr<PanoramaMap> map = makeMap();
    show(mixedLand(), map);
    // Each color keeps its value, or is lifted to it from the dark; a mixture of two of them, at a stroke's edge or in what water shows of the land, need not. And ripples
    // move with the clock.
    map->setStrokes(false);
    map->setReflection(0.0);
    map->setRipples(0.0);
    map->setAtmosphere(0.0);
    const osg::ref_ptr<osg::Image> clear = draw();
    map->setAtmosphere(1.0);
    const osg::ref_ptr<osg::Image> hazy = draw();
    double worst = 0.0;
    int changed = 0;
    const glsl::Rgb air = glsl::geofx_airColor();
    const double brightest = glsl::GEOFX_AIR_LIGHT * std::max({air.x, air.y, air.z});
    // The sky has air of its own; what stands above the horizon does not count here.
    const int rows = static_cast<int>(HEIGHT * (map->getHorizonLine() - map->getHorizonBend())) - 2;
    for (int row = 0; row < rows; ++row)
    {
        for (int column = 0; column < WIDTH; ++column)
        {
            const Pixel a = pixelOf(*clear, column, row);
            const Pixel b = pixelOf(*hazy, column, row);
            // How much of the air there is depends on the place.
            const double lifted = a.value() + glsl::GEOFX_AIR_LIFT * std::max(brightest - a.value(), 0.0);
            worst = std::max({worst, a.value() - b.value(), b.value() - lifted});
            changed += a.off(b) > 0.04 ? 1 : 0;
        }
    }
    EXPECT_LT(worst, 2.0 / 255.0);
    EXPECT_GT(changed, rows * WIDTH / 20);
    std::cout << "V changes by " << worst * 255.0 << "/255 at most; " << changed << " of " << rows * WIDTH
              << " pixels have another color\n";
}

namespace
{

/// A class of the palette and a ground that is of it alone.
struct ClassCase
{
    const char* name;
    int row;
    double slope;
    glsl::geofx_Cover cover;
    double snowLine;
};

class PaintedClass : public PanoramaPainting, public ::testing::WithParamInterface<ClassCase>
{
};

} // namespace

TEST_P(PaintedClass, LitAndShadedColorsAreThePalettes)
{
    const ClassCase& given = GetParam();
    Land land;
    // Roofs of 16 cells, whose sides face west and east.
    const double width = 16.0 * SIZE / CELLS;
    land.height = [&](double x, double)
    {
        return 10.0 + given.slope * std::abs(std::remainder(x - WEST, width));
    };
    land.cover = [&](double, double)
    {
        return given.cover;
    };
    const osg::ref_ptr<PanoramaMap> map = makeMap();
    map->setStrokes(false);
    map->setSky(false);
    map->setAtmosphere(0.0);
    map->setBrush(0.0);
    map->setBottomShade(0.0);
    map->setSnowLine(given.snowLine);
    map->setSnowWidth(1.0);
    map->setLightAzimuth(-osg::PI_2);
    map->setLightElevation(osg::DegreesToRadians(12.0));
    map->setExaggeration(0.1);
    // All sides lie as steep in the light.
    map->setRelief(std::clamp(1.2 / given.slope, 0.1, 20.0));
    show(land, map);
    const osg::ref_ptr<osg::Image> image = draw();

    const osg::ref_ptr<osg::Image> palette = makePalette();
    const auto nearest = [&](const Pixel& pixel, double& off)
    {
        int found = 0;
        off = 1.0;
        for (int column = 0; column < palette->s(); ++column)
        {
            const double distance = pixelOf(*palette, column, given.row).off(pixel);
            if (distance >= off) continue;
            off = distance;
            found = column;
        }
        return found;
    };
    int onRow = 0;
    int pixels = 0;
    std::vector<Pixel> lit;
    std::vector<Pixel> shaded;
    for (int row = 2; row < HEIGHT / 2; ++row)
    {
        for (int column = 0; column < WIDTH; ++column)
        {
            const Pixel pixel = pixelOf(*image, column, row);
            double off = 0.0;
            const int light = nearest(pixel, off);
            ++pixels;
            if (off > 3.0 / 255.0) continue;
            ++onRow;
            // Sides of slope 1.2, the sun 12 degrees high: light 0.89 and -0.63; of fields, 0.7: 0.73 and -0.39.
            if (light > 210) lit.push_back(pixel);
            if (light < 90) shaded.push_back(pixel);
        }
    }
    // Along the ridges the ground is less steep, and of other classes.
    EXPECT_GT(onRow, pixels * 3 / 4) << "of " << pixels << " pixels have a color of the palette's row";
    ASSERT_GT(lit.size(), static_cast<std::size_t>(pixels / 5));
    ASSERT_GT(shaded.size(), static_cast<std::size_t>(pixels / 5));
    const auto byValue = [](const Pixel& a, const Pixel& b)
    {
        return a.hue() < b.hue();
    };
    std::nth_element(lit.begin(), lit.begin() + static_cast<std::ptrdiff_t>(lit.size() / 2), lit.end(),
                     byValue);
    std::nth_element(shaded.begin(), shaded.begin() + static_cast<std::ptrdiff_t>(shaded.size() / 2),
                     shaded.end(), byValue);
    const Pixel& light = lit[lit.size() / 2];
    const Pixel& shade = shaded[shaded.size() / 2];
    double off = 0.0;
    const double asked = hueDistance(pixelOf(*palette, nearest(light, off), given.row).hue(),
                                     pixelOf(*palette, nearest(shade, off), given.row).hue());
    const double found = hueDistance(light.hue(), shade.hue());
    std::cout << given.name << ": hues " << light.hue() << " and " << shade.hue() << '\n';
    EXPECT_NEAR(found, asked, 0.02);
    EXPECT_GT(found, 0.05) << "light and shade are of one hue";
}

INSTANTIATE_TEST_SUITE_P(Classes, PaintedClass,
                         ::testing::Values(ClassCase{"field", 0, 0.035, coverOf(0, 0, 0, -400), 9000.0},
                                           ClassCase{"hill", 1, 0.3, coverOf(0, 0, 0, -400), 9000.0},
                                           ClassCase{"cliff", 2, 2.0, coverOf(0, 0, 0, -400), 9000.0},
                                           ClassCase{"snow", 3, 0.3, coverOf(0, 0, 0, -400), 0.0},
                                           ClassCase{"forest", 4, 0.3, coverOf(1, 0, 0, -400), 9000.0},
                                           ClassCase{"town", 6, 0.3, coverOf(0, 1, 0, -400), 9000.0},
                                           ClassCase{"bare", 7, 0.3, coverOf(0, 0, 0.5, -400), 9000.0}),
                         [](const auto& each) { return std::string(each.param.name); });

namespace
{

/// Woods in stripes from the base on. Their borders are straight lines between cells of the cover.
class ForestEdges : public PanoramaPainting
{
protected:
    static constexpr double STRIPE = 16.0 * SIZE / 256.0; ///< metres
    static constexpr int ROWS = HEIGHT / 2;

    osg::ref_ptr<PanoramaMap> showStripes()
    {
        Land land;
        land.height = [](double, double)
        {
            return 50.0;
        };
        land.cover = [](double x, double)
        {
            return coverOf(static_cast<int>((x - WEST) / STRIPE) % 2 ? 1.0 : 0.0, 0, 0, -5000);
        };
        const osg::ref_ptr<PanoramaMap> map = makeMap();
        map->setSky(false);
        map->setStrokes(false);
        map->setAtmosphere(0.0);
        map->setBrush(0.0);
        map->setBottomShade(0.0);
        show(land, map);
        return map;
    }

    /// Which pixels of the lower half are forest floor rather than field.
    static std::vector<bool> floorOf(const osg::Image& image)
    {
        std::vector<Pixel> pixels;
        for (int row = 0; row < ROWS; ++row)
            for (int column = 0; column < WIDTH; ++column)
                pixels.push_back(pixelOf(image, column, row));
        const auto [dark, bright] =
            std::minmax_element(pixels.begin(), pixels.end(),
                                [](const Pixel& a, const Pixel& b) { return a.value() < b.value(); });
        const double between = 0.5 * (dark->value() + bright->value());
        std::vector<bool> floor;
        for (const Pixel& pixel : pixels)
            floor.push_back(pixel.value() < between);
        return floor;
    }
};

/// The pixels of forest around each border, row by row.
std::vector<std::vector<int>> bordersOf(const std::vector<bool>& floor, int width, int rows, double stripe,
                                        double west)
{
    std::vector<std::vector<int>> borders;
    const double perPixel = 2.0 * RADIUS / width;
    for (int k = 1; west + k * stripe < RADIUS; ++k)
    {
        const double middle = (west + k * stripe + RADIUS) / perPixel, half = 0.5 * stripe / perPixel;
        if (middle < half || middle + half > width) continue;
        std::vector<int> border;
        for (int row = 2; row < rows; ++row)
        {
            int count = 0;
            for (int column = static_cast<int>(middle - half); column < static_cast<int>(middle + half);
                 ++column)
                count += floor[static_cast<std::size_t>(row * width + column)] ? 1 : 0;
            border.push_back(count);
        }
        borders.push_back(border);
    }
    return borders;
}

} // namespace

TEST_F(ForestEdges, AreBrokenAsByABrushAndCoverTheSame)
{
    const osg::ref_ptr<PanoramaMap> map = showStripes();
    const double pixelsOfStripe = STRIPE / (2.0 * RADIUS / WIDTH);
    const auto measure = [&](double size)
    {
        map->setStrokeSize(size);
        const std::vector<std::vector<int>> borders = bordersOf(floorOf(*draw()), WIDTH, ROWS, STRIPE, WEST);
        EXPECT_GE(borders.size(), 3u);
        int longest = 0;
        double sum = 0.0, count = 0.0;
        for (const std::vector<int>& border : borders)
        {
            int run = 0, former = -1;
            for (const int each : border)
            {
                run = each == former ? run + 1 : 1;
                former = each;
                longest = std::max(longest, run);
                sum += each;
                count += 1.0;
            }
        }
        const double share = sum / count / pixelsOfStripe;
        std::cout << "strokes of " << size << " pixels: straight for " << longest << " pixels, forest "
                  << share << '\n';
        EXPECT_NEAR(share, 0.5, 0.01);
        return longest;
    };
    EXPECT_GT(measure(1.0), ROWS / 3) << "the cells' borders are straight, so the measure tells";
    EXPECT_LE(measure(8.0), 12);
}

TEST_F(ForestEdges, TreesStandOnThePaintedFloor)
{
    const osg::ref_ptr<PanoramaMap> map = showStripes();
    map->setStrokeSize(12.0);
    map->setStrokeSpacing(10.0);
    const osg::ref_ptr<osg::Image> bare = draw();
    const std::vector<bool> floor = floorOf(*bare);
    map->setStrokes(true);
    const osg::ref_ptr<osg::Image> wooded = draw();
    const auto isTree = [&](int column, int row)
    {
        return pixelOf(*bare, column, row).off(pixelOf(*wooded, column, row)) > 0.05;
    };
    // The lowest pixels of trees are on the floor, or a pixel or two beside it.
    int feet = 0, lost = 0;
    for (int row = 4; row < ROWS; ++row)
    {
        for (int column = 2; column < WIDTH - 2; ++column)
        {
            if (!isTree(column, row) || isTree(column, row - 1)) continue;
            ++feet;
            bool onFloor = false;
            for (int y = row - 3; y <= row; ++y)
                for (int x = column - 2; x <= column + 2; ++x)
                    onFloor = onFloor || floor[static_cast<std::size_t>(y * WIDTH + x)];
            lost += onFloor ? 0 : 1;
        }
    }
    std::cout << feet << " feet of trees, " << lost << " beside the floor\n";
    EXPECT_GT(feet, 400);
    EXPECT_LE(lost, 0.035 * feet) << "trees go another way than the ground";
}

namespace
{

struct LandCase
{
    const char* name;
    Land land;
};

std::vector<LandCase> landCases()
{
    const auto dry = [](double, double)
    {
        return coverOf(0.4, 0, 0, -400);
    };
    const auto wet = [](double, double)
    {
        return coverOf(0, 0, 0, 3000);
    };
    std::vector<LandCase> cases;
    cases.push_back({"flat", {}});
    cases.back().land.height = [](double, double)
    {
        return 100.0;
    };
    cases.back().land.cover = dry;
    cases.push_back({"sea", {}});
    cases.back().land.cover = wet;
    cases.push_back({"seabed", {}});
    cases.back().land.height = [](double x, double y)
    {
        return hills(x, y) - 4000.0;
    };
    cases.back().land.cover = wet;
    cases.push_back({"holes", mixedLand()});
    cases.back().land.hole = [](double x, double y)
    {
        return std::sin(x / 400.0) * std::cos(y / 600.0) > 0.6;
    };
    cases.push_back({"cliff", {}});
    cases.back().land.height = [](double, double y)
    {
        return y < 6000.0 ? 20.0 : 1500.0;
    };
    cases.back().land.cover = dry;
    cases.push_back({"uncovered", {}});
    cases.back().land.height = [](double x, double y)
    {
        return hills(x, y) - 300.0;
    };
    cases.push_back({"everest", {}});
    cases.back().land.height = [](double x, double y)
    {
        return 8800.0 * std::exp(-std::hypot(x, y - 6000.0) / 2000.0);
    };
    cases.push_back({"nothing", {}});
    cases.back().land.hole = [](double, double)
    {
        return true;
    };
    return cases;
}

} // namespace

TEST_F(PanoramaPainting, AnyTerrainIsASensiblePicture)
{
    for (const LandCase& given : landCases())
    {
        for (const double season : {0.5, 0.0})
        {
            SCOPED_TRACE(::testing::Message() << given.name << ", season " << season);
            const osg::ref_ptr<PanoramaMap> map = makeMap();
            map->setSeason(season);
            show(given.land, map);
            // The reflection of the first frame is of its own frame, too.
            const osg::ref_ptr<osg::Image> image = draw();
            int dark = 0;
            int glaring = 0;
            double sum = 0.0;
            double squares = 0.0;
            double steps = 0.0;
            for (int row = 0; row < HEIGHT; ++row)
            {
                for (int column = 0; column < WIDTH; ++column)
                {
                    const Pixel pixel = pixelOf(*image, column, row);
                    dark += pixel.value() < 0.08 ? 1 : 0;
                    // No ground, water or sky is as pure a color as a shader that went wrong.
                    glaring += pixel.value() - std::min({pixel.red, pixel.green, pixel.blue}) > 0.92 ? 1 : 0;
                    sum += pixel.value();
                    squares += pixel.value() * pixel.value();
                    if (column) steps += pixel.off(pixelOf(*image, column - 1, row));
                }
            }
            const double count = WIDTH * HEIGHT;
            const double mean = sum / count;
            std::cout << given.name << ": value " << mean << ", deviation "
                      << std::sqrt(std::max(0.0, squares / count - mean * mean)) << ", from pixel to pixel "
                      << steps / count << ", " << dark << " dark\n";
            EXPECT_EQ(dark, 0);
            EXPECT_EQ(glaring, 0);
            EXPECT_GT(mean, 0.3);
            EXPECT_LT(mean, 0.97);
            // A painting, neither one color nor noise.
            EXPECT_GT(squares / count - mean * mean, 1e-4);
            EXPECT_LT(steps / count, 0.12);
        }
    }
}
