// SPDX-License-Identifier: MIT
// SPDX-FileCopyrightText: 2026 the osgGeoFX authors
// shaders/lib/bend.glsl on the GPU against the same text as C++ in double.
#include <osgGeoFX/effect/GlslFunctions.h>
#include <osgGeoFX/effect/ShaderLibrary.h>
#include <tools/GlFixture.h>
#include <tools/RandomSamples.h>

#include <osg/Geometry>
#include <osg/Program>
#include <osg/Texture2D>

#include <algorithm>
#include <cmath>
#include <cstring>
#include <sstream>
#include <vector>

namespace glsl = osgGeoFX::glsl;
using geofx::test::Random;
using glm::dvec2;

namespace
{

constexpr int columns = 256;

struct Sample
{
    glsl::geofx_Bend bend;
    dvec2 point;
};

/// What the GPU made of one sample.
struct Result
{
    dvec2 place;
    dvec2 back;
    dvec2 tangent;
    double speed;
    double turnRate;
};

double rounded(double value)
{
    return static_cast<double>(static_cast<float>(value));
}

Sample randomSample(int number)
{
    Random random(static_cast<std::uint64_t>(number));
    const double angle = random.integer(0, 3) ? random.uniform(0.0, 1.5707) : random.logarithmic(1e-9, 1e-2);
    const double size = rounded(random.logarithmic(1.0, 1e5));
    Sample sample;
    sample.bend = glsl::geofx_makeBend(random.integer(0, 2), size, rounded(random.sign() * angle));
    // Up to half of the way to the fold on the inner side.
    const double limit = std::min(0.5 / std::abs(glsl::geofx_bendCurvature(sample.bend)), 10 * size);
    const double inner = sample.bend.angle > 0 ? 1.0 : -1.0;
    sample.point = {rounded(random.uniform(-2.0, 3.0) * size),
                    rounded(inner * random.uniform(-3 * limit, limit))};
    return sample;
}

osg::ref_ptr<osg::Texture2D> makeTexture(osg::Image* image)
{
    osg::ref_ptr<osg::Texture2D> texture = new osg::Texture2D(image);
    texture->setInternalFormat(GL_RGBA32F_ARB);
    texture->setFilter(osg::Texture::MIN_FILTER, osg::Texture::NEAREST);
    texture->setFilter(osg::Texture::MAG_FILTER, osg::Texture::NEAREST);
    texture->setResizeNonPowerOfTwoHint(false);
    return texture;
}

osg::ref_ptr<osg::Image> makeFloatImage(int rows)
{
    osg::ref_ptr<osg::Image> image = new osg::Image;
    image->allocateImage(columns, rows, 1, GL_RGBA, GL_FLOAT);
    image->setInternalTextureFormat(GL_RGBA32F_ARB);
    std::memset(image->data(), 0, image->getTotalSizeInBytes());
    return image;
}

const char* const vertexShader = R"(#version 330 compatibility
void main() { gl_Position = gl_Vertex; }
)";

const char* const fragmentShader = R"(#version 330 compatibility
#include "lib/bend.glsl"
uniform sampler2D bends;  // curve, d, beta
uniform sampler2D points; // s, h
layout(location = 0) out vec4 places;
layout(location = 1) out vec4 frames;
layout(location = 2) out vec4 rates;
void main()
{
    ivec2 texel = ivec2(gl_FragCoord.xy);
    vec4 parameters = texelFetch(bends, texel, 0);
    vec2 point = texelFetch(points, texel, 0).xy;
    geofx_Bend bend = geofx_makeBend(int(parameters.x), parameters.y, parameters.z);
    vec2 place = geofx_bend(bend, point);
    geofx_BendFrame frame = geofx_bendFrame(bend, point.x);
    places = vec4(place, geofx_unbend(bend, place));
    frames = vec4(frame.foot, frame.tangent);
    rates = vec4(frame.speed, frame.turnRate, 0.0, 0.0);
}
)";

} // namespace

class Bend : public geofx::test::GlFixture
{
protected:
    Bend() : GlFixture(16, 16) {}

    /// Draws one pixel for each sample into float textures.
    std::vector<Result> runOnGpu(const std::vector<Sample>& samples)
    {
        const int rows = static_cast<int>(samples.size()) / columns;
        const osg::ref_ptr<osg::Image> bends = makeFloatImage(rows);
        const osg::ref_ptr<osg::Image> points = makeFloatImage(rows);
        for (std::size_t i = 0; i < samples.size(); ++i)
        {
            const Sample& sample = samples[i];
            float* bend = reinterpret_cast<float*>(bends->data()) + 4 * i;
            bend[0] = static_cast<float>(sample.bend.curve);
            bend[1] = static_cast<float>(sample.bend.size);
            bend[2] = static_cast<float>(sample.bend.angle);
            float* point = reinterpret_cast<float*>(points->data()) + 4 * i;
            point[0] = static_cast<float>(sample.point.x);
            point[1] = static_cast<float>(sample.point.y);
        }
        const osg::ref_ptr<osg::Camera> camera = new osg::Camera;
        camera->setRenderOrder(osg::Camera::PRE_RENDER);
        camera->setRenderTargetImplementation(osg::Camera::FRAME_BUFFER_OBJECT, osg::Camera::FRAME_BUFFER);
        camera->setViewport(0, 0, columns, rows);
        camera->setReferenceFrame(osg::Transform::ABSOLUTE_RF);
        camera->setComputeNearFarMode(osg::CullSettings::DO_NOT_COMPUTE_NEAR_FAR);
        std::vector<osg::ref_ptr<osg::Image>> images;
        for (int i = 0; i < 3; ++i)
        {
            images.push_back(makeFloatImage(rows));
            camera->attach(static_cast<osg::Camera::BufferComponent>(osg::Camera::COLOR_BUFFER0 + i),
                           images.back());
        }
        camera->addChild(makeQuad(bends, points));
        render(camera);

        std::vector<Result> results;
        const auto* places = reinterpret_cast<const float*>(images[0]->data());
        const auto* frames = reinterpret_cast<const float*>(images[1]->data());
        const auto* rates = reinterpret_cast<const float*>(images[2]->data());
        for (std::size_t i = 0; i < 4 * samples.size(); i += 4)
        {
            results.push_back({{places[i], places[i + 1]},
                               {places[i + 2], places[i + 3]},
                               {frames[i + 2], frames[i + 3]},
                               static_cast<double>(rates[i]),
                               static_cast<double>(rates[i + 1])});
        }
        return results;
    }

private:
    static osg::ref_ptr<osg::Geometry> makeQuad(osg::Image* bends, osg::Image* points)
    {
        const osg::ref_ptr<osg::Program> program = new osg::Program;
        program->addShader(new osg::Shader(osg::Shader::VERTEX, vertexShader));
        program->addShader(new osg::Shader(
            osg::Shader::FRAGMENT, osgGeoFX::ShaderLibrary().assemble(fragmentShader, "Bend_gltest")));
        osg::ref_ptr<osg::Geometry> quad = osg::createTexturedQuadGeometry({-1, -1, 0}, {2, 0, 0}, {0, 2, 0});
        quad->setCullingActive(false);
        osg::StateSet* state = quad->getOrCreateStateSet();
        state->setAttributeAndModes(program);
        state->setTextureAttribute(0, makeTexture(bends));
        state->setTextureAttribute(1, makeTexture(points));
        state->addUniform(new osg::Uniform("bends", 0));
        state->addUniform(new osg::Uniform("points", 1));
        return quad;
    }
};

TEST_F(Bend, GpuResultIsCpuResult)
{
    std::vector<Sample> samples;
    const int rows = geofx::test::sampleCount() / columns;
    for (int i = 0; i < rows * columns; ++i)
        samples.push_back(randomSample(i));
    const std::vector<Result> results = runOnGpu(samples);
    double worst = 0.0;
    for (std::size_t i = 0; i < samples.size(); ++i)
    {
        const glsl::geofx_Bend& bend = samples[i].bend;
        const dvec2& point = samples[i].point;
        SCOPED_TRACE(::testing::Message()
                     << "sample " << i << ": curve " << bend.curve << ", d " << bend.size << ", beta "
                     << bend.angle << ", s " << point.x << ", h " << point.y);
        const double scale = bend.size + std::abs(point.x) + std::abs(point.y);
        const glsl::geofx_BendFrame frame = glsl::geofx_bendFrame(bend, point.x);
        const Result& gpu = results[i];
        const double error =
            std::max(glm::length(gpu.place - glsl::geofx_bend(bend, point)), glm::length(gpu.back - point)) /
            scale;
        worst = std::max(worst, error);
        EXPECT_LT(error, 1e-5);
        EXPECT_LT(glm::length(gpu.tangent - frame.tangent), 1e-5);
        EXPECT_NEAR(gpu.speed, frame.speed, 1e-5);
        EXPECT_NEAR(gpu.turnRate * bend.size, frame.turnRate * bend.size, 1e-5);
        if (HasFailure())
        {
            return;
        }
    }
    std::ostringstream text;
    text << worst;
    RecordProperty("worst_relative_error", text.str());
}
