// SPDX-License-Identifier: MIT
// SPDX-FileCopyrightText: 2026 the osgGeoFX authors
//
// Where the GPU lifts vertices to, against CloseUpItem in double: with any close-up, below bends and exaggeration, on globes
// and on projected terrain.
#include <osgGeoFX/closeup/CloseUps.h>
#include <osgGeoFX/closeup/detail/CloseUpItem.h>
#include <osgGeoFX/deformation/BirdsEyeView.h>
#include <osgGeoFX/deformation/VerticalExaggeration.h>
#include <osgGeoFX/scene/detail/EffectProgram.h>
#include <tools/CloseUpSamples.h>
#include <tools/GlFixture.h>
#include <tools/RandomViews.h>

#include <osg/BufferIndexBinding>
#include <osg/Geometry>
#include <osg/Program>
#include <osg/Texture2DArray>

#include <algorithm>
#include <cmath>
#include <cstring>
#include <sstream>

using namespace osgGeoFX;
using namespace geofx::test;

namespace
{

constexpr int columns = 64;
constexpr int itemsOfBlock = 64;
constexpr int maskSide = 64;
constexpr unsigned int binding = 7;

/// One close-up as one camera has it, and points over its region.
struct Sample
{
    osg::ref_ptr<CloseUp> closeUp;
    osg::ref_ptr<DeformationChain> chain = new DeformationChain;
    std::vector<osg::ref_ptr<const DeformationSnapshot>> frames; ///< for each effect before the close-ups
    std::unique_ptr<CloseUpItem> item;
    std::vector<osg::Vec3d> points;
    std::string text;
};

using Effects = std::vector<osg::ref_ptr<Effect>>;

/// Two deformations of which each sample takes none, one or both, and the close-ups.
struct SampleEffects
{
    osg::ref_ptr<VerticalExaggeration> high = new VerticalExaggeration;
    osg::ref_ptr<BirdsEyeView> bend = new BirdsEyeView;
    Effects all = {high.get(), bend.get(), new CloseUps};
};

CameraPose randomCamera(Random& random)
{
    CameraPose pose;
    pose.globe = random.integer(0, 1) == 1;
    pose.x = pose.globe ? random.uniform(-3.0, 3.0) : random.uniform(-1e6, 1e6);
    pose.y = pose.globe ? random.uniform(-1.2, 1.2) : random.uniform(-1e6, 1e6);
    pose.height = random.logarithmic(200.0, 3e4);
    pose.heading = random.uniform(-3.0, 3.0);
    pose.pitch = -random.uniform(0.2, 1.5);
    pose.lens = static_cast<CameraPose::Lens>(random.integer(0, 2));
    pose.pictureSize = pose.height;
    return pose;
}

Sample randomSample(int number, SampleEffects& effects)
{
    Random random(static_cast<std::uint64_t>(number));
    const CameraPose pose = randomCamera(random);
    Sample sample;
    effects.high->setFactor(random.uniform(0.5, 3.0));
    effects.bend->setHorizonLine(random.uniform(0.6, 0.95));
    effects.bend->setFocusLine(random.uniform(0.0, 0.5));
    ViewGeometry view = pose.view();
    for (Deformation* each :
         {static_cast<Deformation*>(effects.high), static_cast<Deformation*>(effects.bend)})
    {
        sample.frames.push_back(random.integer(0, 1) ? each->snapshot(view) : nullptr);
        if (sample.frames.back()) sample.chain->add(sample.frames.back());
    }
    CloseUpPlan plan;
    plan.globe = pose.globe;
    const double distance = pose.height * random.uniform(0.2, 2.0);
    const osg::Vec2d ahead(distance * std::sin(pose.heading), distance * std::cos(pose.heading));
    plan.center.set(pose.x, pose.y);
    constexpr double radius = 6.37e6;
    plan.center += pose.globe ? osg::Vec2d(ahead.x() / radius / std::cos(pose.y), ahead.y() / radius) : ahead;
    plan.reach = 0.0;
    plan.size = pose.height * random.logarithmic(0.2, 1.0);
    plan.rise = 0.3 * pose.height;
    sample.closeUp = randomCloseUp(random, plan);
    sample.closeUp->getRegion()->setMaskSide(maskSide);
    sample.item =
        std::make_unique<CloseUpItem>(*sample.closeUp, pose.view(), pose.modelView(), *sample.chain, 0.0);
    const RegionOfInterest& region = *sample.closeUp->getRegion();
    for (int i = 0; i < columns; ++i)
    {
        const osg::Vec3d place(0.55 * region.getWidth() * random.uniform(-1.0, 1.0),
                               0.55 * region.getDepth() * random.uniform(-1.0, 1.0),
                               0.05 * plan.size * random.uniform(-1.0, 1.0));
        sample.points.emplace_back(osg::Vec3f(place * sample.item->regionToEye()));
    }
    std::ostringstream text;
    text << "sample " << number << ": " << pose << "; " << describe(*sample.closeUp);
    sample.text = text.str();
    return sample;
}

/// By how much the mask can change for each unit of a place in the region.
double maskSlope(const RegionOfInterest& region)
{
    const double smaller = std::min(region.getWidth(), region.getDepth());
    const double larger = std::max(region.getWidth(), region.getDepth());
    const bool soft = region.getSoftness() > 0.0 && region.getShape() != RegionOfInterest::IMAGE;
    // No steeper than from one texel to the next, which a sharp border is.
    return std::min(0.5 * maskSide, soft ? 1.5 * larger / smaller / region.getSoftness() : 0.5 * maskSide);
}

/** What a vertex may be off by: 1e-5 of the scene's size, which is how far away things are. Between a region and its close-up it is on
    a ramp as steep as the mask is; there, the place in the region, a float as exact as the eye position that it is made of, is
    amplified by the mask's slope and the way from the ground to the close-up. */
double allowedError(const Sample& sample, const osg::Vec3d& point, const osg::Vec3d& bent, bool onRamp)
{
    const osg::Vec3d lifted = sample.item->lifted(point);
    const RegionOfInterest& region = *sample.closeUp->getRegion();
    const double scene = point.length() + lifted.length() + bent.length();
    double allowed = 1e-5 * scene;
    if (!onRamp) return allowed;
    const double half = 0.5 * std::min(region.getWidth(), region.getDepth());
    constexpr double rounding = 3e-7; // five roundings of floats
    const double from = point.length() + sample.item->regionToEye().getTrans().length();
    return allowed + rounding * from / half * maskSlope(region) * (lifted - bent).length();
}

osg::ref_ptr<osg::Image> makeFloatImage(int rows)
{
    osg::ref_ptr<osg::Image> image = new osg::Image;
    image->allocateImage(columns, rows, 1, GL_RGBA, GL_FLOAT);
    image->setInternalTextureFormat(GL_RGBA32F_ARB);
    std::memset(image->data(), 0, image->getTotalSizeInBytes());
    return image;
}

const char* const vertexMain = R"(#version 330 compatibility
vec4 geofx_vertex(vec4 eyePosition);
flat out vec4 place;
void main()
{
    place = geofx_vertex(gl_Vertex);
    gl_Position = vec4(gl_MultiTexCoord0.xy, 0.0, 1.0);
}
)";

const char* const fragmentMain = R"(#version 330 compatibility
flat in vec4 place;
layout(location = 0) out vec4 places;
void main()
{
    places = vec4(place.xyz / place.w, 1.0);
}
)";

osg::ref_ptr<osg::Texture2DArray> makeMasks(const std::vector<Sample>& samples)
{
    osg::ref_ptr<osg::Texture2DArray> masks = new osg::Texture2DArray;
    masks->setTextureSize(maskSide, maskSide, static_cast<int>(samples.size()));
    masks->setInternalFormat(GL_RG32F);
    masks->setSourceFormat(GL_RG);
    masks->setSourceType(GL_FLOAT);
    masks->setFilter(osg::Texture::MIN_FILTER, osg::Texture::NEAREST);
    masks->setFilter(osg::Texture::MAG_FILTER, osg::Texture::NEAREST);
    for (std::size_t i = 0; i < samples.size(); ++i)
    {
        const osg::ref_ptr<osg::Image> image = new osg::Image(*samples[i].closeUp->getRegion()->mask());
        image->setInternalTextureFormat(GL_RG32F);
        masks->setImage(static_cast<unsigned int>(i), image);
    }
    return masks;
}

osg::ref_ptr<osg::UniformBufferBinding> makeBlock(const std::vector<Sample>& samples)
{
    osg::ref_ptr<osg::Vec4Array> values = new osg::Vec4Array(itemsOfBlock * CloseUpItem::rows);
    for (std::size_t i = 0; i < samples.size(); ++i)
    {
        CloseUpItem::Places places;
        places.mask = static_cast<int>(i);
        places.maskSide = maskSide;
        const CloseUpItem::Values item = samples[i].item->values(places, {}, 0, 1, 1);
        std::copy(item.begin(), item.end(),
                  values->begin() + static_cast<std::ptrdiff_t>(i) * CloseUpItem::rows);
    }
    values->setBufferObject(new osg::UniformBufferObject);
    return new osg::UniformBufferBinding(binding, values, 0,
                                         static_cast<GLsizeiptr>(values->getTotalDataSize()));
}

class LiftedVertices : public GlFixture
{
protected:
    LiftedVertices() : GlFixture(16, 16) {}

    /// Of all samples, all points as close-up and then all points as anchor.
    std::vector<osg::Vec3d> run(const std::vector<Sample>& samples, const Effects& effects)
    {
        const int height = 2 * static_cast<int>(samples.size());
        const osg::ref_ptr<osg::Camera> camera = new osg::Camera;
        camera->setRenderOrder(osg::Camera::PRE_RENDER);
        camera->setRenderTargetImplementation(osg::Camera::FRAME_BUFFER_OBJECT, osg::Camera::FRAME_BUFFER);
        camera->setViewport(0, 0, columns, height);
        camera->setReferenceFrame(osg::Transform::ABSOLUTE_RF);
        camera->setComputeNearFarMode(osg::CullSettings::DO_NOT_COMPUTE_NEAR_FAR);
        camera->setCullingMode(osg::CullSettings::NO_CULLING);
        const osg::ref_ptr<osg::Image> image = makeFloatImage(height);
        camera->attach(osg::Camera::COLOR_BUFFER0, image);
        osg::StateSet* state = camera->getOrCreateStateSet();
        state->setAttributeAndModes(programOf(effects));
        state->setAttribute(makeBlock(samples));
        state->setTextureAttribute(11, makeMasks(samples));
        state->addUniform(new osg::Uniform((EffectProgram::prefix(2) + "masks").c_str(), 11));
        // As CloseUps sets it where vertices are moved by their masks.
        state->setDefine(EffectProgram::prefix(2) + "MASKED");
        for (int row = 0; row < height; ++row)
            camera->addChild(drawingOf(samples[static_cast<std::size_t>(row / 2)], row, height));
        render(camera);
        std::vector<osg::Vec3d> places;
        const auto* texels = reinterpret_cast<const osg::Vec4f*>(image->data());
        for (int i = 0; i < height * columns; ++i)
        {
            EXPECT_EQ(texels[i].w(), 1.0f) << "nothing was drawn";
            places.emplace_back(osg::Vec3f(texels[i].x(), texels[i].y(), texels[i].z()));
        }
        return places;
    }

private:
    static osg::ref_ptr<osg::Geometry> drawingOf(const Sample& sample, int row, int height)
    {
        osg::ref_ptr<osg::Geometry> drawing = new osg::Geometry;
        const osg::ref_ptr<osg::Vec2Array> pixels = new osg::Vec2Array;
        for (int i = 0; i < columns; ++i)
            pixels->push_back({(2.0f * static_cast<float>(i) + 1.0f) / columns - 1.0f,
                               (2.0f * static_cast<float>(row) + 1.0f) / static_cast<float>(height) - 1.0f});
        drawing->setVertexArray(new osg::Vec3Array(sample.points.begin(), sample.points.end()));
        drawing->setTexCoordArray(0, pixels, osg::Array::BIND_PER_VERTEX);
        drawing->addPrimitiveSet(new osg::DrawArrays(GL_POINTS, 0, columns));
        drawing->setUseDisplayList(false);
        drawing->setUseVertexBufferObjects(true);
        osg::StateSet* state = drawing->getOrCreateStateSet();
        state->addUniform(new osg::Uniform((EffectProgram::prefix(2) + "layer").c_str(), row));
        state->setDefine("GEOFX_DEFORMATION");
        for (std::size_t i = 0; i < sample.frames.size(); ++i)
        {
            if (!sample.frames[i]) continue;
            state->setDefine(EffectProgram::define(i));
            for (const auto& [name, value] : sample.frames[i]->uniforms())
                state->addUniform(
                    new osg::Uniform((EffectProgram::prefix(i) + name).c_str(), osg::Vec4f(value)));
        }
        return drawing;
    }

    osg::Program* programOf(const Effects& effects)
    {
        if (_program) return _program;
        PassShaders pass;
        pass.vertex = {"stages/closeup.items.glsl", "stages/closeup.vert.glsl"};
        _program = new osg::Program;
        _program->addShader(new osg::Shader(osg::Shader::VERTEX, vertexMain));
        _program->addShader(new osg::Shader(
            osg::Shader::VERTEX,
            EffectProgram::passFunctions(effects, pass, EffectProgram::prefix(2), osg::Shader::VERTEX)));
        _program->addShader(new osg::Shader(osg::Shader::FRAGMENT, fragmentMain));
        _program->addBindUniformBlock(EffectProgram::prefix(2) + "Items", binding);
        return _program;
    }

    osg::ref_ptr<osg::Program> _program;
};

} // namespace

TEST_F(LiftedVertices, AreThoseOfTheCpu)
{
    const int batches = fullTest() ? 20 : 2;
    SampleEffects effects;
    double worst = 0.0;
    double worstOnRamp = 0.0;
    int onRamps = 0;
    int kinds[3] = {0, 0, 0};
    int bent = 0;
    for (int batch = 0; batch < batches; ++batch)
    {
        std::vector<Sample> samples;
        for (int i = 0; i < itemsOfBlock; ++i)
            samples.push_back(randomSample(batch * itemsOfBlock + i, effects));
        const std::vector<osg::Vec3d> gpu = run(samples, effects.all);
        std::size_t next = 0;
        for (const Sample& sample : samples)
        {
            SCOPED_TRACE(sample.text);
            ++kinds[sample.closeUp->getOrientation()];
            bent += sample.chain->empty() ? 0 : 1;
            for (const bool anchor : {false, true})
            {
                const bool whole = !anchor && sample.closeUp->getEdge() == CloseUp::FRAGMENTS;
                for (const osg::Vec3d& point : sample.points)
                {
                    const osg::Vec3d ground = sample.chain->deform(point);
                    const osg::Vec3d place = point * sample.item->toRegion();
                    // Beyond the region there is no mask, whatever it is at the region's own border: a jump.
                    const double beside = std::max(std::abs(place.x()), std::abs(place.y())) - 1.0;
                    if (!whole && std::abs(beside) < 1e-4)
                    {
                        ++next;
                        continue;
                    }
                    const double mask = sample.closeUp->getRegion()->maskAt({place.x(), place.y()}).x();
                    const osg::Vec3d expected =
                        whole ? sample.item->lifted(point) : sample.item->raised(point, ground, mask);
                    const double error = (gpu[next++] - expected).length();
                    const bool onRamp = !whole && mask > 0.0 && mask < 1.0;
                    // A vertex beside a border may be on the other side of its ramp's end.
                    const double allowed = allowedError(sample, point, ground, !whole);
                    ASSERT_LE(error, allowed) << "mask " << mask << ", anchor " << anchor;
                    const double scene =
                        point.length() + sample.item->lifted(point).length() + ground.length();
                    double& most = onRamp ? worstOnRamp : worst;
                    most = std::max(most, error / scene);
                    onRamps += onRamp ? 1 : 0;
                }
            }
        }
    }
    EXPECT_GT(onRamps, 100 * batches);
    for (const int kind : kinds)
        EXPECT_GT(kind, 5 * batches);
    EXPECT_GT(bent, 20 * batches);
    std::cout << "error over the scene's size: " << worst << " at most; " << worstOnRamp << " on ramps\n";
}

TEST_F(LiftedVertices, OfSoftMasksKeepToTheTightBoundEverywhere)
{
    // Regions that are not small from where the camera is, with wide borders: here floats are exact enough for 1e-5 on the ramp, too.
    SampleEffects effects;
    std::vector<Sample> samples;
    for (int i = 0; static_cast<int>(samples.size()) < itemsOfBlock; ++i)
    {
        Sample sample = randomSample(100000 + i, effects);
        RegionOfInterest& region = *sample.closeUp->getRegion();
        const double distance = sample.item->regionToEye().getTrans().length();
        if (region.getShape() == RegionOfInterest::IMAGE ||
            std::min(region.getWidth(), region.getDepth()) < 0.4 * distance)
            continue;
        region.setSoftness(1.0);
        samples.push_back(std::move(sample));
    }
    const std::vector<osg::Vec3d> gpu = run(samples, effects.all);
    std::size_t next = 0;
    double worst = 0.0;
    for (const Sample& sample : samples)
    {
        SCOPED_TRACE(sample.text);
        next += columns;
        for (const osg::Vec3d& point : sample.points)
        {
            const osg::Vec3d ground = sample.chain->deform(point);
            const osg::Vec3d place = point * sample.item->toRegion();
            const double mask = sample.closeUp->getRegion()->maskAt({place.x(), place.y()}).x();
            const double scene = point.length() + sample.item->lifted(point).length() + ground.length();
            const double error = (gpu[next++] - sample.item->raised(point, ground, mask)).length() / scene;
            worst = std::max(worst, error);
            ASSERT_LE(error, 1e-5) << "mask " << mask;
        }
    }
    std::cout << "error over the scene's size: " << worst << " at most\n";
}
