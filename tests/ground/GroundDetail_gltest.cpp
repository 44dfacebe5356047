// SPDX-License-Identifier: MIT
// SPDX-FileCopyrightText: 2026 the osgGeoFX authors
//
// Pictures of GroundDetail against what the CPU makes of the same functions and the same noise, at the place that picking finds.
#include <osgGeoFX/deformation/BirdsEyeView.h>
#include <osgGeoFX/effect/GlslFunctions.h>
#include <osgGeoFX/effect/LocalOrigin.h>
#include <osgGeoFX/effect/RigidParts.h>
#include <osgGeoFX/ground/GroundDetail.h>
#include <osgGeoFX/ground/detail/DetailNoise.h>
#include <osgGeoFX/mapping/ProjectiveMappings.h>
#include <osgGeoFX/scene/DeformedView.h>
#include <tools/GlFixture.h>
#include <tools/PlainView.h>
#include <tools/RandomSamples.h>
#include <tools/SmoothTexture.h>

#include <osg/Geometry>
#include <osg/LightModel>
#include <osg/LightSource>
#include <osg/Material>
#include <osg/MatrixTransform>
#include <osg/TexMat>
#include <osg/Texture2D>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstring>

using namespace geofx::test;
using namespace osgGeoFX;

namespace
{

constexpr int WIDTH = 240, HEIGHT = 160;
constexpr double HALF = 1000.0; ///< metres, of the ground
constexpr int TEXELS = 32;      ///< across it

/// Woods, grass, a town and the sea, as a land cover of coarse cells has them.
struct Class
{
    std::array<int, 3> color;
    glsl::geofx_Cover cover;
};
const std::array<Class, 4> classes = {
    Class{{112, 138, 82}, {0.9, 0.0, 0.0, 0.0}}, Class{{162, 174, 112}, {0.05, 0.0, 0.0, 0.0}},
    Class{{210, 200, 182}, {0.2, 0.6, 0.0, 0.0}}, Class{{38, 82, 122}, {0.0, 0.0, 0.0, 0.0}}};

/// To the east the sea, before it the three classes in patches.
int classAt(int x, int y)
{
    if (x > 24) return 3;
    return (x / 5 + 2 * (y / 7)) % 3;
}

osg::ref_ptr<osg::Image> newImage()
{
    osg::ref_ptr<osg::Image> image = new osg::Image;
    image->allocateImage(TEXELS, TEXELS, 1, GL_RGBA, GL_UNSIGNED_BYTE);
    return image;
}

unsigned char coded(double share)
{
    return static_cast<unsigned char>(std::lround(255.0 * std::clamp(share, 0.0, 1.0)));
}

glm::dvec4 texelOf(const osg::Image& image, int x, int y)
{
    const unsigned char* bytes = image.data(static_cast<unsigned int>(std::clamp(x, 0, TEXELS - 1)),
                                            static_cast<unsigned int>(std::clamp(y, 0, TEXELS - 1)));
    return glm::dvec4(bytes[0], bytes[1], bytes[2], bytes[3]) / 255.0;
}

glm::dvec4 bilinear(const osg::Image& image, const glm::dvec2& at)
{
    const int x = static_cast<int>(std::floor(at.x)), y = static_cast<int>(std::floor(at.y));
    const double u = at.x - x, v = at.y - y;
    return (1 - v) * ((1 - u) * texelOf(image, x, y) + u * texelOf(image, x + 1, y)) +
           v * ((1 - u) * texelOf(image, x, y + 1) + u * texelOf(image, x + 1, y + 1));
}

/// What the noise has at a place in its periods, as a texture that repeats has it.
glm::dvec4 noiseAt(const osg::Image& image, const osg::Vec3d& place)
{
    constexpr int side = DetailNoise::side;
    glm::dvec4 sum(0.0);
    int low[3];
    double share[3];
    for (int axis = 0; axis < 3; ++axis)
    {
        const double at = place[axis] * side - 0.5;
        low[axis] = static_cast<int>(std::floor(at));
        share[axis] = at - low[axis];
    }
    for (int corner = 0; corner < 8; ++corner)
    {
        double weight = 1.0;
        unsigned int at[3];
        for (int axis = 0; axis < 3; ++axis)
        {
            const int up = corner >> axis & 1;
            weight *= up ? share[axis] : 1.0 - share[axis];
            at[axis] = static_cast<unsigned int>(((low[axis] + up) % side + side) % side);
        }
        const unsigned char* bytes = image.data(at[0], at[1], at[2]);
        sum += weight * (glm::dvec4(bytes[0], bytes[1], bytes[2], bytes[3]) - 128.0) / 127.0;
    }
    return sum;
}

/// A place on the ground.
struct Place
{
    osg::Vec3d world;
    glm::dvec2 local; ///< metres in the ground's own frame
};

class GroundDetailTest : public GlFixture
{
protected:
    GroundDetailTest() : GlFixture(WIDTH, HEIGHT) {}

    void SetUp() override
    {
        GlFixture::SetUp();
        if (IsSkipped() || HasFatalFailure()) return;
        usePlainView(viewer());
        paint();
        build(osg::Matrixd());
        look({-300.0, -900.0, 260.0}, {0.0, -300.0, 0.0});
    }

    void paint()
    {
        for (int i = 0; i < TEXELS * TEXELS; ++i)
        {
            const int x = i % TEXELS, y = i / TEXELS;
            const Class& here = classes[static_cast<std::size_t>(classAt(x, y))];
            unsigned char* color = _colors->data() + 4 * i;
            unsigned char* cover = _cover->data() + 4 * i;
            for (int channel = 0; channel < 3; ++channel)
                color[channel] = static_cast<unsigned char>(here.color[static_cast<std::size_t>(channel)]);
            color[3] = 255;
            cover[0] = coded(here.cover.trees);
            cover[1] = coded(here.cover.town);
            cover[2] = coded(here.cover.bare);
            // The shore is where the class changes.
            cover[3] = coded(glsl::geofx_shoreCode((x - 24.5) * 2.0 * HALF / TEXELS));
        }
    }

    /// The ground, flat in a frame in the world.
    void build(const osg::Matrixd& frame)
    {
        constexpr int cells = 64;
        osg::ref_ptr<osg::Geometry> ground = new osg::Geometry;
        osg::ref_ptr<osg::Vec3Array> places = new osg::Vec3Array;
        osg::ref_ptr<osg::Vec2Array> coordinates = new osg::Vec2Array;
        osg::ref_ptr<osg::DrawElementsUInt> corners = new osg::DrawElementsUInt(GL_TRIANGLES);
        for (unsigned int i = 0; i < (cells + 1) * (cells + 1); ++i)
        {
            const osg::Vec2 at(static_cast<float>(i % (cells + 1)) / cells,
                               static_cast<float>(i / (cells + 1)) / cells);
            coordinates->push_back(at);
            places->push_back(
                osg::Vec3((at * 2.0f - osg::Vec2(1.0f, 1.0f)) * static_cast<float>(HALF), 0.0f));
            if (i % (cells + 1) == cells || i / (cells + 1) == cells) continue;
            for (const unsigned int corner : {i, i + 1, i + cells + 2, i, i + cells + 2, i + cells + 1})
                corners->push_back(corner);
        }
        osg::ref_ptr<osg::Vec3Array> normal = new osg::Vec3Array(1);
        normal->front().set(0.0f, 0.0f, 1.0f);
        ground->setVertexArray(places);
        ground->setTexCoordArray(0, coordinates);
        ground->setNormalArray(normal, osg::Array::BIND_OVERALL);
        osg::ref_ptr<osg::Vec4Array> white = new osg::Vec4Array(1);
        white->front().set(1.0f, 1.0f, 1.0f, 1.0f);
        ground->setColorArray(white, osg::Array::BIND_OVERALL);
        ground->addPrimitiveSet(corners);
        ground->setUseDisplayList(false);
        ground->setUseVertexBufferObjects(false);
        osg::StateSet& state = *ground->getOrCreateStateSet();
        state.setTextureAttributeAndModes(0, smoothTexture(_colors));
        state.setTextureAttribute(7, smoothTexture(_cover));
        _frame = frame;
        _ground = new osg::MatrixTransform(frame);
        _ground->addChild(ground);
        _scene = new EffectScene;
        _scene->addEffect(_detail);
        _scene->addChild(_ground);
        _root = new osg::Group;
        _root->addChild(_scene);
        _root->getOrCreateStateSet()->setMode(GL_LIGHTING, osg::StateAttribute::OFF);
        if (frame.isIdentity()) _scene->setTerrainFrame(EffectScene::PROJECTED);
    }

    /// From a place of the ground's frame to another.
    void look(const osg::Vec3d& eye, const osg::Vec3d& at, double angle = 40.0)
    {
        osg::Camera& camera = *viewer().getCamera();
        const osg::Vec3d up = osg::Matrixd::transform3x3(osg::Vec3d(0.0, 0.0, 1.0), _frame);
        camera.setViewMatrixAsLookAt(eye * _frame, at * _frame, up);
        camera.setProjectionMatrixAsPerspective(angle, static_cast<double>(WIDTH) / HEIGHT, 1.0, 20000.0);
    }
    osg::ref_ptr<osg::Image> draw() { return render(_root); }

    static osg::Vec3d colorAt(const osg::Image& image, int x, int y)
    {
        const unsigned char* bytes = image.data(static_cast<unsigned int>(x), static_cast<unsigned int>(y));
        return osg::Vec3d(bytes[0], bytes[1], bytes[2]) / 255.0;
    }
    static int differing(const osg::Image& a, const osg::Image& b)
    {
        int count = 0;
        for (unsigned int y = 0; y < HEIGHT; ++y)
            for (unsigned int x = 0; x < WIDTH; ++x)
                count += std::memcmp(a.data(x, y), b.data(x, y), 3) != 0 ? 1 : 0;
        return count;
    }
    static double meanDifference(const osg::Image& a, const osg::Image& b)
    {
        double sum = 0.0;
        for (int y = 0; y < HEIGHT; ++y)
            for (int x = 0; x < WIDTH; ++x)
                sum += (colorAt(a, x, y) - colorAt(b, x, y)).length();
        return sum / (WIDTH * HEIGHT);
    }

    glm::dvec3 evaluate(const Place& place, const Place& right, const Place& above, const osg::Vec3d& towards,
                        double brightness) const;
    void expectWhatTheCpuMakes(const osg::Image& image, const osg::Vec3d& towards, double brightness = 1.0);

    osg::ref_ptr<GroundDetail> _detail = new GroundDetail;
    osg::ref_ptr<osg::Image> _colors = newImage(), _cover = newImage();
    const osg::ref_ptr<osg::Image> _noise = DetailNoise::makeImage();
    osg::Matrixd _frame;
    osg::ref_ptr<osg::MatrixTransform> _ground;
    osg::ref_ptr<EffectScene> _scene;
    osg::ref_ptr<osg::Group> _root;
};

/// `towards`: the light in the ground's frame. `brightness`: of the ground's light.
glm::dvec3 GroundDetailTest::evaluate(const Place& place, const Place& right, const Place& above,
                                      const osg::Vec3d& towards, double brightness) const
{
    using namespace osgGeoFX::glsl;
    const double texel = 2.0 * HALF / TEXELS;
    const double metres =
        std::max((right.world - place.world).length(), (above.world - place.world).length());
    const glm::dvec2 x = right.local - place.local, y = above.local - place.local;
    const double longer = std::max(glm::length(x), glm::length(y));
    const double shorter = std::abs(x.x * y.y - x.y * y.x) / longer;
    const double nearness = _detail->getStrength() * geofx_detailNearness(texel / shorter);
    const double pixels = texel / longer;

    const glm::dvec2 at = (place.local + glm::dvec2(HALF)) / texel - 0.5;
    glm::dvec4 known = bilinear(*_cover, at);
    double shore = 0.0;
    for (const glm::dvec2 way :
         {glm::dvec2(0.75, 0.75), glm::dvec2(-0.75, 0.75), glm::dvec2(0.75, -0.75), glm::dvec2(-0.75, -0.75)})
        shore += 0.25 * bilinear(*_cover, at + way).w;
    known.w = glm::mix(known.w, shore, _detail->getEdges());
    const osg::Vec3d level = osg::Vec3d(towards.x(), towards.y(), 0.0) / std::max(towards.z(), 0.35);
    const osg::Vec3d lightInWorld = osg::Matrixd::transform3x3(level, _frame);
    geofx_DetailWaves waves = geofx_detailCalm();
    glm::dvec2 stray(0.0);
    int index = 0;
    for (double wavelength = _detail->getLargest(); wavelength > _detail->getSmallest();
         wavelength /= GEOFX_DETAIL_STEP)
    {
        const double fade = geofx_detailFade(wavelength, metres);
        const osg::Matrixd octave = DetailNoise::octave(index++, wavelength);
        if (fade <= 0.0) break;
        const double share = fade * geofx_detailMissing(wavelength, texel);
        const glm::dvec4 wave = noiseAt(*_noise, place.world * octave);
        osg::Vec3d light = osg::Matrixd::transform3x3(lightInWorld, octave);
        light *= GEOFX_DETAIL_WAVES * wavelength;
        waves = geofx_detailWith(waves, share * geofx_detailBands(wavelength), wave.w,
                                 -(wave.x * light.x() + wave.y * light.y() + wave.z * light.z()));
        stray += share * std::min(wavelength / texel, 1.5) * glm::dvec2(wave.x, wave.y);
    }
    stray *= 0.3 * (1.0 - 0.85 * geofx_share(2.0 * known.y));
    const glm::dvec2 room = glm::min(at, glm::dvec2(TEXELS - 1.0) - at);
    const glm::dvec2 strayed = at + stray * geofx_share(std::min(room.x, room.y));
    const int column = static_cast<int>(std::floor(strayed.x)), row = static_cast<int>(std::floor(strayed.y));
    const double u = strayed.x - column, v = strayed.y - row;
    Rgba weights((1 - u) * (1 - v), u * (1 - v), (1 - u) * v, u * v);
    std::array<glm::dvec4, 4> colors, covers;
    for (int corner = 0; corner < 4; ++corner)
    {
        const auto i = static_cast<std::size_t>(corner);
        colors[i] = texelOf(*_colors, column + corner % 2, row + corner / 2);
        covers[i] = texelOf(*_cover, column + corner % 2, row + corner / 2);
    }
    weights = glm::mix(
        weights,
        geofx_crispWeights(weights, Rgb(colors[0]), Rgb(colors[1]), Rgb(colors[2]), Rgb(colors[3]), pixels),
        _detail->getEdges());
    // The sea's texels for the sea, and the land's for the land.
    const auto wetOf = [](const glm::dvec4& cover)
    {
        return cover.w >= 128.0 / 255.0;
    };
    Rgba ashore(0.0);
    for (int corner = 0; corner < 4; ++corner)
        ashore[corner] =
            wetOf(covers[static_cast<std::size_t>(corner)]) == wetOf(known) ? weights[corner] : 0.0;
    const double all = ashore.x + ashore.y + ashore.z + ashore.w;
    if (all > 1e-3) weights = glm::mix(weights, ashore / all, _detail->getEdges());
    glm::dvec4 color(0.0), cover(0.0);
    for (int corner = 0; corner < 4; ++corner)
    {
        color += weights[corner] * colors[static_cast<std::size_t>(corner)];
        cover += weights[corner] * covers[static_cast<std::size_t>(corner)];
    }
    if (all <= 1e-3)
    {
        // Nearby texels of the place's own side.
        glm::dvec4 nearColor(0.0), nearCover(0.0);
        double sum = 0.0;
        for (int down = -1; down <= 2; ++down)
            for (int along = -1; along <= 2; ++along)
            {
                const glm::ivec2 cell(column + along, row + down);
                const glm::dvec4 texelsCover = texelOf(*_cover, cell.x, cell.y);
                if (glm::clamp(cell, 0, TEXELS - 1) != cell || wetOf(texelsCover) != wetOf(known)) continue;
                const glm::dvec2 way = glm::dvec2(cell) - strayed;
                const double weight = std::exp2(-4.0 * glm::dot(way, way));
                nearColor += weight * texelOf(*_colors, cell.x, cell.y);
                nearCover += weight * texelsCover;
                sum += weight;
            }
        if (sum > 0.0)
        {
            color = glm::mix(color, nearColor / sum, _detail->getEdges());
            cover = glm::mix(cover, nearCover / sum, _detail->getEdges());
        }
    }
    cover.w = known.w;
    const geofx_Cover here = geofx_coverOf(cover);
    const Rgb own = brightness * Rgb(color);
    const double wet = geofx_share(here.shore / metres + 0.5);
    Rgb land = own * geofx_detailFactor(geofx_detailClasses(here, Rgb(color), 0.0), here, waves,
                                        _detail->getRelief());
    const Rgb water = geofx_detailWater(own, here.shore, 1.0, waves, _detail->getRelief(), brightness);
    const Rgb plain = brightness * Rgb(bilinear(*_colors, at));
    return glm::clamp(glm::mix(plain, glm::mix(land, water, wet), nearness), 0.0, 1.0);
}

void GroundDetailTest::expectWhatTheCpuMakes(const osg::Image& image, const osg::Vec3d& towards,
                                             double brightness)
{
    const DeformedView view(*_scene, *viewer().getCamera());
    const osg::Matrixd toLocal = osg::Matrixd::inverse(_frame);
    const auto placeAt = [&](int x, int y) -> std::optional<Place>
    {
        const auto found = view.pick(x + 0.5, y + 0.5);
        if (!found) return std::nullopt;
        const osg::Vec3d local = found->world * toLocal;
        return Place{found->world, {local.x(), local.y()}};
    };
    Random random(11);
    int compared = 0, off = 0;
    double worst = 0.0, fromPlain = 0.0;
    const osg::ref_ptr<osg::Image> drawn = new osg::Image(image);
    for (int i = 0; i < 600; ++i)
    {
        // The lower left pixel of a block of four, whose differences the GPU takes.
        const int x = 2 * random.integer(0, WIDTH / 2 - 1), y = 2 * random.integer(0, HEIGHT / 2 - 1);
        const auto place = placeAt(x, y), right = placeAt(x + 1, y), above = placeAt(x, y + 1);
        if (!place || !right || !above) continue;
        if (std::abs(place->local.x) > HALF - 70.0 || std::abs(place->local.y) > HALF - 70.0) continue;
        const glm::dvec3 expected = evaluate(*place, *right, *above, towards, brightness);
        const osg::Vec3d actual = colorAt(image, x, y);
        double difference = 0.0;
        for (int channel = 0; channel < 3; ++channel)
            difference = std::max(difference, std::abs(expected[channel] - actual[channel]));
        ++compared;
        // Eight bits of the noise and of filters; sharp borders within a pixel.
        off += difference > 5.0 / 255.0 ? 1 : 0;
        worst = std::max(worst, difference);
        const glm::dvec2 at = (place->local + glm::dvec2(HALF)) * (TEXELS / (2.0 * HALF)) - 0.5;
        fromPlain += glm::length(brightness * glm::dvec3(bilinear(*_colors, at)) - expected);
    }
    EXPECT_GT(compared, 250);
    EXPECT_LE(off, compared / 40) << "worst " << worst;
    EXPECT_GT(fromPlain / compared, 0.03) << "there is hardly any detail";
}

constexpr double pi = 3.14159265358979;
const osg::Vec3d usualLight(-0.5, 0.5, 0.7071);

} // namespace

TEST_F(GroundDetailTest, ThePictureIsWhatTheCpuMakes)
{
    draw();
    expectWhatTheCpuMakes(*draw(), usualLight);
    // From farther away, where some octaves fade.
    look({-900.0, -1500.0, 500.0}, {0.0, 100.0, 0.0}, 25.0);
    draw();
    expectWhatTheCpuMakes(*draw(), usualLight);
}

// The same on a globe, where coordinates have seven digits before the point.
TEST_F(GroundDetailTest, OnAGlobeToo)
{
    const osg::ref_ptr<osg::EllipsoidModel> earth = new osg::EllipsoidModel;
    build(LocalOrigin::onGlobe(-157.8 / 180.0 * pi, 21.3 / 180.0 * pi).toWorld(earth));
    _scene->setTerrainFrame(EffectScene::GEOCENTRIC);
    look({-300.0, -900.0, 260.0}, {0.0, -300.0, 0.0});
    draw();
    expectWhatTheCpuMakes(*draw(), usualLight);
}

TEST_F(GroundDetailTest, BendsWithTheGround)
{
    const osg::ref_ptr<BirdsEyeView> bend = new BirdsEyeView;
    bend->setFocusLine(0.3);
    bend->setHorizonLine(0.95);
    _scene->addEffect(bend);
    draw();
    const osg::ref_ptr<osg::Image> bent = draw();
    expectWhatTheCpuMakes(*bent, usualLight);
    bend->setEnabled(false);
    EXPECT_GT(differing(*bent, *draw()), WIDTH * HEIGHT / 10) << "nothing was bent";
}

TEST_F(GroundDetailTest, LightFallsFromWhereTheSunIs)
{
    osg::ref_ptr<osg::LightSource> sun = new osg::LightSource;
    osg::Vec3d towards(0.7, -0.2, 0.4);
    towards.normalize();
    sun->getLight()->setPosition(osg::Vec4f(osg::Vec4d(towards, 0.0)));
    sun->getLight()->setAmbient({0.3f, 0.3f, 0.3f, 1.0f});
    sun->getLight()->setDiffuse({0.5f, 0.5f, 0.5f, 1.0f});
    _root->addChild(sun);
    osg::StateSet& state = *_root->getOrCreateStateSet();
    state.setMode(GL_LIGHTING, osg::StateAttribute::ON);
    state.setMode(GL_LIGHT0, osg::StateAttribute::ON);
    osg::ref_ptr<osg::Material> material = new osg::Material;
    material->setAmbient(osg::Material::FRONT_AND_BACK, {1.0f, 1.0f, 1.0f, 1.0f});
    material->setDiffuse(osg::Material::FRONT_AND_BACK, {1.0f, 1.0f, 1.0f, 1.0f});
    state.setAttribute(material);
    osg::ref_ptr<osg::LightModel> model = new osg::LightModel;
    model->setAmbientIntensity({0.0f, 0.0f, 0.0f, 1.0f});
    state.setAttribute(model);
    draw();
    expectWhatTheCpuMakes(*draw(), towards, 0.3 + 0.5 * towards.z());
}

TEST_F(GroundDetailTest, FarGroundStaysAsItIs)
{
    // A texel is 62 m: 2 pixels of 31 m.
    look({0.0, -1.0, 8000.0}, {0.0, 0.0, 0.0}, 40.0);
    draw();
    const osg::ref_ptr<osg::Image> far = draw();
    _detail->setEnabled(false);
    draw();
    EXPECT_EQ(differing(*far, *draw()), 0);
    _detail->setEnabled(true);
    look({0.0, -1.0, 2500.0}, {0.0, 0.0, 0.0}, 40.0);
    draw();
    const osg::ref_ptr<osg::Image> near = draw();
    _detail->setStrength(0.0);
    draw();
    EXPECT_GT(differing(*near, *draw()), WIDTH * HEIGHT / 10);
}

// A camera that comes nearer, a step at a time: no step changes the picture much more than the others do, so nothing pops, and waves come
// slowly.
TEST_F(GroundDetailTest, ComesSlowlyAsTheCameraComesNear)
{
    std::vector<double> steps;
    osg::ref_ptr<osg::Image> last;
    for (int i = 0; i < 60; ++i)
    {
        const double distance = 5000.0 * std::pow(0.94, i);
        look({-0.4 * distance, -0.8 * distance, 0.45 * distance}, {0.0, 0.0, 0.0});
        const osg::ref_ptr<osg::Image> next = draw();
        if (i > 1) steps.push_back(meanDifference(*next, *last));
        last = new osg::Image(*next, osg::CopyOp::DEEP_COPY_ALL);
    }
    std::vector<double> sorted = steps;
    std::sort(sorted.begin(), sorted.end());
    EXPECT_LT(sorted.back(), 2.0 * sorted[sorted.size() / 2]);
}

// A mean over a block of pixels stays while the camera moves by parts of a pixel: no wave is too short for its pixel.
TEST_F(GroundDetailTest, DoesNotShimmer)
{
    const auto change = [&]
    {
        double worst = 0.0;
        osg::ref_ptr<osg::Image> last;
        for (int i = 0; i < 8; ++i)
        {
            // About a quarter of a pixel, on ground that is seen nearly from its edge.
            look({-700.0 + 0.12 * i, -950.0, 120.0}, {0.12 * i, 0.0, 0.0}, 30.0);
            const osg::ref_ptr<osg::Image> next = draw();
            if (i > 1)
            {
                double sum = 0.0;
                int count = 0;
                for (int y = HEIGHT / 2; y < HEIGHT * 3 / 4; ++y)
                {
                    for (int x = 10; x < WIDTH - 10; ++x, ++count)
                        sum += std::pow((colorAt(*next, x, y) - colorAt(*last, x, y)).length(), 2.0);
                }
                worst = std::max(worst, std::sqrt(sum / count));
            }
            last = new osg::Image(*next, osg::CopyOp::DEEP_COPY_ALL);
        }
        return worst;
    };
    const double changes = change();
    EXPECT_LT(changes, 0.02);
}

TEST_F(GroundDetailTest, ComesBeforeMappingsWhereverItStands)
{
    const osg::ref_ptr<ProjectiveMapping> mapping = new ProjectiveMapping;
    mapping->setRectangle({-100.0, -300.0}, 150.0, 100.0);
    mapping->getTransfer()->setSource(ColorTransfer::CONSTANT);
    mapping->getTransfer()->setConstant({0.9, 0.2, 0.1, 0.5});
    const osg::ref_ptr<ProjectiveMappings> mappings = new ProjectiveMappings;
    mappings->addMapping(mapping);
    _scene->addEffect(mappings);
    draw();
    const osg::ref_ptr<osg::Image> after = draw();
    _scene->removeEffect(_scene->getEffect(0));
    draw();
    const osg::ref_ptr<osg::Image> without = draw();
    _scene->addEffect(_detail);
    draw();
    const osg::ref_ptr<osg::Image> before = draw();
    EXPECT_EQ(differing(*after, *before), 0);
    EXPECT_GT(differing(*without, *before), WIDTH * HEIGHT / 4);
}

// A style that greys the context greys its detail, too, in either order.
TEST_F(GroundDetailTest, ComesBeforeStylesWhereverItStands)
{
    const osg::ref_ptr<BirdsEyeView> bend = new BirdsEyeView;
    bend->setFocusLine(0.0);
    bend->setHorizonLine(0.95);
    bend->setContextSaturation(0.0);
    _scene->insertEffect(0, bend);
    draw();
    const osg::ref_ptr<osg::Image> before = draw();
    _scene->removeEffect(bend);
    _scene->addEffect(bend);
    draw();
    EXPECT_EQ(differing(*before, *draw()), 0);
}

TEST_F(GroundDetailTest, LeavesOutWhatIsNoGround)
{
    _detail->setEnabled(false);
    draw();
    const osg::ref_ptr<osg::Image> plain = draw();
    _detail->setEnabled(true);
    _ground->getOrCreateStateSet()->setDefine("GEOFX_DETAIL", osg::StateAttribute::OFF);
    draw();
    EXPECT_EQ(differing(*plain, *draw()), 0);
    _ground->getOrCreateStateSet()->removeDefine("GEOFX_DETAIL");
    draw();
    EXPECT_GT(differing(*plain, *draw()), WIDTH * HEIGHT / 4);
}

// Without a texture that says what lies there, slope, height and color decide.
TEST_F(GroundDetailTest, OfTerrainsThatTellNothing)
{
    for (int i = 0; i < TEXELS * TEXELS; ++i)
    {
        unsigned char* cover = _cover->data() + 4 * i;
        cover[0] = cover[1] = cover[2] = 0;
        cover[3] = 255;
    }
    _cover->dirty();
    _detail->setEnabled(false);
    look({-300.0, -900.0, 260.0}, {0.0, -300.0, 0.0});
    draw();
    const osg::ref_ptr<osg::Image> plain = draw();
    _detail->setEnabled(true);
    draw();
    const osg::ref_ptr<osg::Image> detailed = draw();
    EXPECT_GT(differing(*plain, *detailed), WIDTH * HEIGHT / 4);
}

// The smooth shore runs across cells of the other side, and wind carries the sample over it.
TEST_F(GroundDetailTest, EachSideOfARaggedShoreHasColorsOfItsOwn)
{
    Random random(5);
    std::array<bool, TEXELS * TEXELS> sea{};
    for (int y = 0; y < TEXELS; ++y)
        for (int x = 0, shore = random.integer(12, 19); x < TEXELS; ++x)
            sea[static_cast<std::size_t>(y * TEXELS + x)] = x > shore;
    const double texel = 2.0 * HALF / TEXELS;
    for (int i = 0; i < TEXELS * TEXELS; ++i)
    {
        const bool wet = sea[static_cast<std::size_t>(i)];
        double nearest = 1e6; // texels from the border of the nearest one of the other side
        for (int k = 0; k < TEXELS * TEXELS; ++k)
            if (sea[static_cast<std::size_t>(k)] != wet)
                nearest =
                    std::min(nearest, std::hypot(std::max(std::abs(k % TEXELS - i % TEXELS) - 0.5, 0.0),
                                                 std::max(std::abs(k / TEXELS - i / TEXELS) - 0.5, 0.0)));
        unsigned char* color = _colors->data() + 4 * i;
        unsigned char* cover = _cover->data() + 4 * i;
        color[0] = wet ? 30 : 200, color[1] = wet ? 70 : 150, color[2] = wet ? 120 : 80;
        cover[0] = cover[1] = cover[2] = 0;
        cover[3] = coded(glsl::geofx_shoreCode((wet ? 1.0 : -1.0) * texel * nearest));
    }
    _colors->dirty();
    _cover->dirty();
    look({-120.0, -700.0, 420.0}, {-60.0, 0.0, 0.0});
    draw();
    const osg::ref_ptr<osg::Image> image = draw();
    const DeformedView view(*_scene, *viewer().getCamera());
    int land = 0, water = 0, blueLand = 0, brownWater = 0;
    for (int y = 0; y < HEIGHT; y += 2)
        for (int x = 0; x < WIDTH; x += 2)
        {
            const auto place = view.pick(x + 0.5, y + 0.5);
            if (!place) continue;
            const glm::dvec2 at =
                (glm::dvec2(place->world.x(), place->world.y()) + glm::dvec2(HALF)) / texel - 0.5;
            double code = 0.0;
            for (const glm::dvec2 way : {glm::dvec2(0.75, 0.75), glm::dvec2(-0.75, 0.75),
                                         glm::dvec2(0.75, -0.75), glm::dvec2(-0.75, -0.75)})
                code += 0.25 * bilinear(*_cover, at + way).w;
            const double shore = glsl::geofx_shoreDistance(code);
            const osg::Vec3d color = colorAt(*image, x, y);
            // Not where a pixel has both; beyond the foam.
            if (shore < -30.0 && shore > -90.0) ++land, blueLand += color.z() > color.x();
            if (shore > 30.0 && shore < 90.0) ++water, brownWater += color.x() > color.z();
        }
    EXPECT_GT(land, 300);
    EXPECT_GT(water, 300);
    EXPECT_EQ(blueLand, 0);
    EXPECT_EQ(brownWater, 0);
}

// A texture that begins again, and coordinates that a texture matrix makes, show the same detail.
TEST_F(GroundDetailTest, FollowsTheTexturesCoordinates)
{
    draw();
    const osg::ref_ptr<osg::Image> plain = draw();
    osg::Geometry& ground = *_ground->getChild(0)->asGeometry();
    auto& coordinates = static_cast<osg::Vec2Array&>(*ground.getTexCoordArray(0));
    osg::StateSet& state = *ground.getStateSet();
    for (osg::Vec2& at : coordinates)
        at *= 0.25f;
    state.setTextureAttributeAndModes(0, new osg::TexMat(osg::Matrixd::scale(4.0, 4.0, 1.0)));
    // What lies there goes by the same coordinates.
    EXPECT_EQ(differing(*plain, *draw()), 0);
    state.removeTextureAttribute(0, osg::StateAttribute::TEXMAT);
    auto& colors = static_cast<osg::Texture2D&>(*state.getTextureAttribute(0, osg::StateAttribute::TEXTURE));
    auto& cover = static_cast<osg::Texture2D&>(*state.getTextureAttribute(7, osg::StateAttribute::TEXTURE));
    for (osg::Texture2D* texture : {&colors, &cover})
    {
        texture->setWrap(osg::Texture::WRAP_S, osg::Texture::REPEAT);
        texture->setWrap(osg::Texture::WRAP_T, osg::Texture::REPEAT);
    }
    for (osg::Vec2& at : coordinates)
        at = at * 4.0f + osg::Vec2(3.0f, 3.0f);
    // But for the texels of the border, and what floats of 3 to 4 round.
    EXPECT_LT(meanDifference(*plain, *draw()), 0.004);
}

// Only light 0, if it is on, tells where light comes from. One at the eye shines along the view.
TEST_F(GroundDetailTest, OtherLightsTellNothing)
{
    osg::StateSet& state = *_root->getOrCreateStateSet();
    osg::ref_ptr<osg::Material> material = new osg::Material;
    material->setEmission(osg::Material::FRONT_AND_BACK, {1.0f, 1.0f, 1.0f, 1.0f});
    state.setAttribute(material);
    draw();
    const osg::ref_ptr<osg::Image> unlit = draw();
    state.setMode(GL_LIGHTING, osg::StateAttribute::ON);
    state.setMode(GL_LIGHT0, osg::StateAttribute::OFF);
    state.setMode(GL_LIGHT1, osg::StateAttribute::ON);
    // Number 0 stands elsewhere, but is out.
    for (const int number : {0, 1})
    {
        osg::ref_ptr<osg::LightSource> source = new osg::LightSource;
        source->setLight(new osg::Light(static_cast<unsigned int>(number)));
        source->getLight()->setPosition({1.0f, 1.0f, 0.2f, 0.0f});
        _root->addChild(source);
    }
    draw();
    EXPECT_EQ(differing(*unlit, *draw()), 0);
    state.setMode(GL_LIGHT0, osg::StateAttribute::ON);
    const osg::ref_ptr<osg::LightSource> lamp = new osg::LightSource;
    lamp->setReferenceFrame(osg::LightSource::ABSOLUTE_RF);
    lamp->getLight()->setPosition({0.0f, 0.0f, 0.0f, 1.0f});
    _root->addChild(lamp);
    draw();
    const osg::ref_ptr<osg::Image> lit = draw();
    for (int y = 0; y < HEIGHT / 2; y += 3)
        for (int x = 0; x < WIDTH; x += 3)
            ASSERT_GT(colorAt(*lit, x, y).length(), 0.02) << x << " " << y;
}
