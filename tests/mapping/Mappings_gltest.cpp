// SPDX-License-Identifier: MIT
// SPDX-FileCopyrightText: 2026 the osgGeoFX authors
// Random sets of mappings on the GPU, pixel by pixel against the same functions on the CPU; and the grid against the
// list of all.
#include <osgGeoFX/mapping/ProjectiveMappings.h>
#include <osgGeoFX/scene/EffectScene.h>
#include <tools/GlFixture.h>
#include <tools/MappingEvaluator.h>
#include <tools/RandomSamples.h>

#include <osg/Geometry>
#include <osg/Program>

#include <algorithm>
#include <cmath>
#include <cstring>

using namespace geofx::test;
using namespace osgGeoFX;

namespace
{

constexpr int WIDTH = 96;
constexpr int HEIGHT = 72;
constexpr int TARGETS = 8;
constexpr double SIDE = 1000.0;

const char* const vertexShader = R"(#version 330 compatibility
vec4 geofx_vertex(vec4 eyePosition);
void main()
{
    gl_Position = gl_ProjectionMatrix * geofx_vertex(gl_ModelViewMatrix * gl_Vertex);
    gl_FrontColor = gl_Color;
}
)";

// The color, and all that it is computed from.
const char* const fragmentShader = R"(#version 330 compatibility
vec4 geofx_fragment(vec4 color, vec4 map);
in vec3 geofx_0_place;
in vec3 geofx_0_position;
layout(location = 0) out vec4 results[8];
void main()
{
    results[1] = gl_Color;
    results[2] = vec4(geofx_0_place, 1.0);
    results[3] = vec4(dFdx(geofx_0_place), 1.0);
    results[4] = vec4(dFdy(geofx_0_place), 1.0);
    results[5] = vec4(geofx_0_position, 1.0);
    results[6] = vec4(dFdx(geofx_0_position), 1.0);
    results[7] = vec4(dFdy(geofx_0_position), 1.0);
    results[0] = geofx_fragment(gl_Color, vec4(0.0));
}
)";

double heightAt(double x, double y)
{
    return 60.0 * std::sin(x / 130.0) * std::cos(y / 170.0) + 25.0 * std::sin((x + y) / 60.0);
}

osg::ref_ptr<osg::Geometry> makeGround()
{
    constexpr int cells = 80;
    osg::ref_ptr<osg::Vec3Array> vertices = new osg::Vec3Array;
    osg::ref_ptr<osg::Vec4Array> colors = new osg::Vec4Array;
    for (int j = 0; j <= cells; ++j)
    {
        for (int i = 0; i <= cells; ++i)
        {
            const double x = SIDE * (2.0 * i / cells - 1.0);
            const double y = SIDE * (2.0 * j / cells - 1.0);
            vertices->push_back(osg::Vec3(osg::Vec3d(x, y, heightAt(x, y))));
            colors->push_back(
                osg::Vec4(osg::Vec4d(0.5 + 0.5 * std::sin(x / 90.0), 0.5 + 0.5 * std::cos(y / 70.0),
                                     0.5 + 0.5 * std::sin((x - y) / 110.0), 0.75)));
        }
    }
    osg::ref_ptr<osg::DrawElementsUInt> triangles = new osg::DrawElementsUInt(GL_TRIANGLES);
    for (unsigned int j = 0; j < cells; ++j)
    {
        for (unsigned int i = 0; i < cells; ++i)
        {
            const unsigned int a = j * (cells + 1) + i;
            for (const unsigned int index : {a, a + 1, a + cells + 2, a, a + cells + 2, a + cells + 1})
                triangles->push_back(index);
        }
    }
    osg::ref_ptr<osg::Geometry> ground = new osg::Geometry;
    ground->setUseVertexBufferObjects(true);
    ground->setVertexArray(vertices);
    ground->setColorArray(colors, osg::Array::BIND_PER_VERTEX);
    ground->addPrimitiveSet(triangles);
    ground->getOrCreateStateSet()->setMode(GL_BLEND, osg::StateAttribute::OFF);
    return ground;
}

/// A smooth picture with transparency, of any size.
osg::ref_ptr<osg::Image> randomPicture(Random& random)
{
    const int width = random.integer(1, 70);
    const int height = random.integer(1, 70);
    osg::ref_ptr<osg::Image> image = new osg::Image;
    image->allocateImage(width, height, 1, GL_RGBA, GL_UNSIGNED_BYTE);
    double waves[4][3];
    for (auto& wave : waves)
    {
        for (double& number : wave)
            number = random.uniform(0.0, 7.0);
    }
    for (int y = 0; y < height; ++y)
    {
        for (int x = 0; x < width; ++x)
        {
            for (int c = 0; c < 4; ++c)
            {
                const double* wave = waves[c];
                const double value = std::sin(wave[0] * x / width + wave[1] * y / height + wave[2]);
                // What is fully transparent has no color to speak of.
                const double shade = c < 3 ? 0.5 + 0.5 * value : 0.6 + 0.4 * value;
                image->data(x, y)[c] = static_cast<unsigned char>(255.0 * shade);
            }
        }
    }
    return image;
}

osg::ref_ptr<osg::Image> randomValues(Random& random, bool classes)
{
    const int width = random.integer(2, 50);
    const int height = random.integer(2, 50);
    osg::ref_ptr<osg::Image> image = new osg::Image;
    image->allocateImage(width, height, 1, GL_LUMINANCE, GL_FLOAT);
    const double frequency = random.uniform(1.0, 6.0);
    for (int y = 0; y < height; ++y)
    {
        for (int x = 0; x < width; ++x)
        {
            double value = 50.0 + 50.0 * std::sin(frequency * x / width) * std::cos(frequency * y / height);
            if (classes) value = std::floor(value / 20.0);
            const bool none = random.uniform(0.0, 1.0) < 0.1;
            *reinterpret_cast<float*>(image->data(x, y)) = none ? NAN : static_cast<float>(value);
        }
    }
    return image;
}

osg::ref_ptr<DataLayer> randomLayer(Random& random)
{
    osg::ref_ptr<DataLayer> layer = new DataLayer;
    layer->setKind(static_cast<DataLayer::Kind>(random.integer(0, 2)));
    layer->setSmooth(random.integer(0, 3) > 0);
    layer->setImage(layer->getKind() == DataLayer::COLOR
                        ? randomPicture(random)
                        : randomValues(random, layer->getKind() == DataLayer::CLASS));
    return layer;
}

osg::ref_ptr<ColorTransfer> randomTransfer(Random& random, const DataLayer& layer)
{
    osg::ref_ptr<ColorTransfer> transfer = new ColorTransfer;
    transfer->setSource(static_cast<ColorTransfer::Source>(random.integer(0, 3)));
    transfer->setAlpha(static_cast<ColorTransfer::Alpha>(random.integer(0, 3)));
    transfer->setEquation(static_cast<ColorTransfer::Equation>(random.integer(0, 7)));
    if (random.integer(0, 1) == 1) transfer->setEquation(ColorTransfer::ADD);
    if (random.integer(0, 1) == 1)
        transfer->setBlendFunction(static_cast<ColorTransfer::Factor>(random.integer(0, 14)),
                                   static_cast<ColorTransfer::Factor>(random.integer(0, 14)));
    if (layer.getKind() != DataLayer::COLOR)
        transfer->setValueRange(0.0, layer.getKind() == DataLayer::CLASS ? 5.0 : 100.0);
    const double top = layer.getKind() == DataLayer::COLOR ? 1.0 : 100.0;
    // Neither ramp nor table is steep: a picture's bytes are filtered with the precision of bytes.
    transfer->setRamp(random.uniform(0.0, 0.1) * top, random.uniform(0.9, 1.0) * top);
    if (random.integer(0, 3) == 0) transfer->setRamp(top, 0.0);
    transfer->setConstant({random.uniform(0.0, 1.0), random.uniform(0.0, 1.0), random.uniform(0.0, 1.0),
                           random.uniform(0.0, 1.0)});
    if (random.integer(0, 2) == 0)
    {
        transfer->setBrightness(random.uniform(0.5, 1.5));
        transfer->setContrast(random.uniform(0.5, 1.5));
        transfer->setSaturation(random.uniform(0.0, 1.5));
        transfer->setHue(random.uniform(-3.0, 3.0));
    }
    return transfer;
}

double difference(const glm::dvec4& a, const glm::dvec4& b)
{
    return std::max({std::abs(a.r - b.r), std::abs(a.g - b.g), std::abs(a.b - b.b)});
}

/// A fragment as far off as floats may be.
MappingEvaluator::Fragment nudged(MappingEvaluator::Fragment fragment, int way)
{
    const glm::dvec3 shift((way & 1) ? 1e-3 : -1e-3, (way & 2) ? 1e-3 : -1e-3, (way & 1) ? 1e-3 : -1e-3);
    const double scale = (way & 4) ? 1.0 + 1e-3 : 1.0 - 1e-3;
    fragment.place += shift;
    fragment.position += shift;
    for (glm::dvec3* step : {&fragment.across, &fragment.up, &fragment.positionAcross, &fragment.positionUp})
        *step *= scale;
    return fragment;
}

osg::Vec2d randomPlace(Random& random, double reach)
{
    return {random.uniform(-reach, reach), random.uniform(-reach, reach)};
}

osg::ref_ptr<ProjectiveMapping> randomMapping(Random& random)
{
    osg::ref_ptr<ProjectiveMapping> mapping = new ProjectiveMapping;
    mapping->setOrder(random.integer(-3, 3));
    mapping->setOpacity(random.uniform(0.3, 1.0));
    const double size = random.logarithmic(20.0, 900.0);
    mapping->setRectangle(randomPlace(random, 800.0), size * random.uniform(0.5, 1.0),
                          size * random.uniform(0.5, 1.0), random.uniform(-3.0, 3.0));
    const int form = random.integer(0, 5);
    if (form == 0)
    {
        mapping->setTransform({random.uniform(0.5, 2.0), random.uniform(-0.3, 0.3), 0.0,
                               random.uniform(-0.3, 0.3), random.uniform(0.5, 2.0), 0.0,
                               random.uniform(-0.5, 0.5), random.uniform(-0.5, 0.5), 1.0});
    }
    if (form == 1)
    {
        const osg::Vec2d o = randomPlace(random, 600.0);
        const osg::Vec2d corners[4] = {o + osg::Vec2d(-size, -size * random.uniform(0.5, 1.0)),
                                       o + osg::Vec2d(size * random.uniform(0.5, 1.0), -size),
                                       o + osg::Vec2d(size, size * random.uniform(0.5, 1.0)),
                                       o + osg::Vec2d(-size * random.uniform(0.5, 1.0), size)};
        EXPECT_TRUE(mapping->setQuad(corners));
    }
    if (form == 2)
    {
        mapping->setSizeInPixels(random.uniform(10.0, 40.0));
        mapping->setTurned(random.integer(0, 1) == 1);
    }
    if (form == 3)
    {
        ProjectiveMapping::Camera camera;
        const osg::Vec2d o = randomPlace(random, 700.0);
        camera.eye.set(o.x(), o.y(), random.uniform(150.0, 500.0));
        camera.heading = random.uniform(-3.0, 3.0);
        camera.pitch = random.uniform(-1.4, -0.4);
        camera.roll = random.uniform(-0.5, 0.5);
        camera.k1 = random.uniform(-0.1, 0.1);
        camera.k2 = random.uniform(-0.02, 0.02);
        camera.p1 = random.uniform(-0.01, 0.01);
        camera.p2 = random.uniform(-0.01, 0.01);
        camera.range = random.uniform(500.0, 2000.0);
        EXPECT_TRUE(mapping->setCamera(camera));
    }
    if (random.integer(0, 4) == 0) mapping->setHeights(-20.0, random.uniform(0.0, 60.0));
    if (random.integer(0, 4) == 0)
        mapping->setDistances(random.uniform(0.0, 300.0), random.uniform(800.0, 1500.0), 0.5);
    if (random.integer(0, 4) == 0) mapping->setPixels(random.uniform(2.0, 10.0), random.uniform(12.0, 60.0));
    if (random.integer(0, 4) == 0) mapping->setSlopes(random.uniform(0.1, 0.4), random.uniform(0.5, 1.2));
    mapping->setSoftEdges(random.integer(0, 1) == 1);
    mapping->setLayer(randomLayer(random));
    mapping->setMask(randomLayer(random));
    mapping->setTransfer(randomTransfer(random, *mapping->getLayer()));
    const bool classes = mapping->getLayer()->getKind() == DataLayer::CLASS;
    const double top = mapping->getLayer()->getKind() == DataLayer::VALUE ? 100.0 : classes ? 5.0 : 1.0;
    osg::ref_ptr<ColorTable> table =
        ColorTable::named(random.integer(0, 1) == 0 ? "viridis" : "terrain", 0.0, top);
    if (classes) table->setMode(ColorTable::NEAREST);
    mapping->setTable(table);
    return mapping;
}

} // namespace

class Mappings : public GlFixture
{
protected:
    Mappings() : GlFixture(16, 16) {}

    void SetUp() override
    {
        GlFixture::SetUp();
        if (IsSkipped()) return;
        _scene->setNestedCameras(true);
        _scene->addEffect(_mappings);
        osg::ref_ptr<osg::Program> program = new osg::Program;
        program->addShader(new osg::Shader(osg::Shader::VERTEX, vertexShader));
        program->addShader(new osg::Shader(osg::Shader::FRAGMENT, fragmentShader));
        _scene->addFunctions(*program);
        _ground->getOrCreateStateSet()->setAttribute(program);
        _scene->addChild(_ground);
        _camera->setRenderOrder(osg::Camera::PRE_RENDER);
        _camera->setRenderTargetImplementation(osg::Camera::FRAME_BUFFER_OBJECT, osg::Camera::FRAME_BUFFER);
        _camera->setViewport(0, 0, WIDTH, HEIGHT);
        _camera->setReferenceFrame(osg::Transform::ABSOLUTE_RF);
        _camera->setComputeNearFarMode(osg::CullSettings::DO_NOT_COMPUTE_NEAR_FAR);
        _camera->setClearColor(osg::Vec4());
        for (int i = 0; i < TARGETS; ++i)
        {
            osg::ref_ptr<osg::Image> image = new osg::Image;
            image->allocateImage(WIDTH, HEIGHT, 1, GL_RGBA, GL_FLOAT);
            image->setInternalTextureFormat(GL_RGBA32F_ARB);
            _images.push_back(image);
            _camera->attach(static_cast<osg::Camera::BufferComponent>(osg::Camera::COLOR_BUFFER0 + i), image);
        }
        _camera->addChild(_scene);
    }

    void look(const osg::Vec3d& eye, const osg::Vec3d& at)
    {
        _eye = eye;
        _camera->setViewMatrixAsLookAt(eye, at, osg::Vec3d(0.0, 0.0, 1.0));
        _camera->setProjectionMatrixAsPerspective(45.0, static_cast<double>(WIDTH) / HEIGHT, 1.0, 10000.0);
    }
    void randomView(Random& random)
    {
        const osg::Vec2d at = randomPlace(random, 400.0);
        const osg::Vec2d away = randomPlace(random, 700.0);
        look(osg::Vec3d(at.x() + away.x(), at.y() + away.y(), random.uniform(250.0, 900.0)),
             osg::Vec3d(at.x(), at.y(), 0.0));
    }

    void draw() { render(_camera); }
    /// llvmpipe filters pictures of bytes with weights and results of eight bits; the evaluator can do the same.
    bool filtersInBytes()
    {
        std::string renderer;
        withContext([&](osg::State&) { renderer = reinterpret_cast<const char*>(glGetString(GL_RENDERER)); });
        return renderer.find("llvmpipe") != std::string::npos;
    }

    glm::dvec4 pixel(int target, int x, int y) const
    {
        const auto* data =
            reinterpret_cast<const float*>(_images[static_cast<std::size_t>(target)]->data(x, y));
        return {data[0], data[1], data[2], data[3]};
    }
    /// The ground's pixels: their fragments.
    bool fragment(int x, int y, MappingEvaluator::Fragment& result) const
    {
        if (pixel(2, x, y).w == 0.0) return false;
        result.place = pixel(2, x, y);
        result.across = pixel(3, x, y);
        result.up = pixel(4, x, y);
        result.position = pixel(5, x, y);
        result.positionAcross = pixel(6, x, y);
        result.positionUp = pixel(7, x, y);
        result.eye = {_eye.x(), _eye.y(), _eye.z()};
        return true;
    }
    static double pixelSpan() { return 2.0 * std::tan(osg::DegreesToRadians(22.5)) / HEIGHT; }

    /// Compares the picture with the CPU's; the share of pixels that mappings have changed.
    double expectAsOnTheCpu(const std::string& what, bool filtersInBytes, double allowed = 2.0 / 255.0) const
    {
        const MappingEvaluator evaluator(*_mappings, pixelSpan(), filtersInBytes);
        int ground = 0;
        int changed = 0;
        int off = 0;
        double worst = 0.0;
        glm::ivec2 where(0);
        for (int y = 0; y < HEIGHT; ++y)
        {
            for (int x = 0; x < WIDTH; ++x)
            {
                MappingEvaluator::Fragment found;
                if (!fragment(x, y, found)) continue;
                ++ground;
                const glm::dvec4 scene = pixel(1, x, y);
                const glm::dvec4 expected = evaluator.color(found, scene);
                const glm::dvec4 drawn = pixel(0, x, y);
                if (glm::distance(expected, scene) > 0.02) ++changed;
                double error = difference(expected, drawn);
                // At a jump of the functions, floats may find themselves on the other side.
                for (int way = 0; way < 8 && error > allowed; ++way)
                    error = std::min(error, difference(evaluator.color(nudged(found, way), scene), drawn));
                if (error > allowed) ++off;
                if (error <= worst) continue;
                worst = error;
                where = {x, y};
            }
        }
        EXPECT_GT(ground, WIDTH * HEIGHT / 4) << what;
        EXPECT_LE(worst, allowed) << what << " at " << where.x << ", " << where.y << "; " << off
                                  << " pixels are off";
        return static_cast<double>(changed) / ground;
    }

    osg::ref_ptr<ProjectiveMappings> _mappings = new ProjectiveMappings;
    osg::ref_ptr<EffectScene> _scene = new EffectScene;
    osg::ref_ptr<osg::Geometry> _ground = makeGround();
    osg::ref_ptr<osg::Camera> _camera = new osg::Camera;
    std::vector<osg::ref_ptr<osg::Image>> _images;
    osg::Vec3d _eye;
};

constexpr int PARTS = 8;

class MappingScenes : public Mappings, public ::testing::WithParamInterface<int>
{
};

TEST_P(MappingScenes, AreWhatTheCpuComputes)
{
    _mappings->setPageSide(256);
    const bool inBytes = filtersInBytes();
    double changed = 0.0;
    const SampleRange scenes(fullTest() ? 200 : 16, GetParam(), PARTS);
    for (int scene = scenes.first; scene < scenes.end; ++scene)
    {
        Random random(static_cast<std::uint64_t>(scene));
        _mappings->removeMappings();
        const int count = random.integer(1, scene % 4 == 0 ? 64 : 12);
        for (int i = 0; i < count; ++i)
            _mappings->addMapping(randomMapping(random));
        randomView(random);
        _mappings->setWholeList(false);
        draw();
        changed += expectAsOnTheCpu("scene " + std::to_string(scene), inBytes);
        const osg::ref_ptr<osg::Image> grid = osg::clone(_images[0].get(), osg::CopyOp::DEEP_COPY_ALL);
        _mappings->setWholeList(true);
        draw();
        EXPECT_EQ(std::memcmp(grid->data(), _images[0]->data(), grid->getTotalSizeInBytes()), 0)
            << "the grid and the list of all differ in scene " << scene;
        if (HasFailure()) break;
    }
    EXPECT_GT(changed / scenes.count(), 0.05) << "enough of the ground should be covered to tell";
}

INSTANTIATE_TEST_SUITE_P(Mappings, MappingScenes, ::testing::Range(0, PARTS));

// Whatever the platform's filter makes of weights, with sharp pictures of any size on the screen.
TEST_F(Mappings, OnePictureIsAsExactArithmeticHasIt)
{
    _mappings->setPageSide(256);
    Random random(5);
    osg::ref_ptr<osg::Image> image = new osg::Image;
    image->allocateImage(32, 32, 1, GL_RGBA, GL_UNSIGNED_BYTE);
    std::generate_n(image->data(), image->getTotalSizeInBytes(),
                    [&] { return static_cast<unsigned char>(random.integer(0, 255)); });
    osg::ref_ptr<ProjectiveMapping> mapping = new ProjectiveMapping;
    mapping->setLayer(new DataLayer(image));
    _mappings->addMapping(mapping);
    look(osg::Vec3d(30.0, -400.0, 600.0), osg::Vec3d());
    for (const double size : {900.0, 500.0, 250.0, 100.0, 40.0})
    {
        mapping->setRectangle(osg::Vec2d(), size, size, 0.3);
        draw();
        EXPECT_GT(expectAsOnTheCpu("half a side of " + std::to_string(size), false), 0.0);
    }
}
