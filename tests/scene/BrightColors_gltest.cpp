// SPDX-License-Identifier: MIT
// SPDX-FileCopyrightText: 2026 the osgGeoFX authors
//
// Frame buffers of floating-point numbers: what the kit draws into textures on the way there keeps colors above 1, and the
// precision of colors and depths.
#include <osgGeoFX/deformation/VerticalExaggeration.h>
#include <osgGeoFX/panorama/PanoramaManipulator.h>
#include <tools/CloseUpStage.h>
#include <tools/DepthKinds.h>
#include <tools/FrameBufferTarget.h>
#include <tools/PanoramaHills.h>

#include <osg/Fog>
#include <osg/TexEnv>
#include <osg/Texture2D>

#include <cmath>

using namespace osgGeoFX;
using namespace geofx::test;

namespace
{

class BrightColors : public CloseUpStage, public ::testing::WithParamInterface<GLenum>
{
protected:
    /// Two that cross, with soft edges, in the colors of the ground alone.
    void addCloseUps()
    {
        for (const double x : {-120.0, 120.0})
        {
            const osg::ref_ptr<CloseUp> closeUp = makeCloseUp({x, 0.0}, 450.0, 300.0 + x);
            closeUp->getAnchor()->setKind(Anchor::NONE);
            closeUp->getAnchor()->setLineWidth(0.0);
            closeUp->getRegion()->setSoftness(0.5);
            _closeUps->addCloseUp(closeUp);
        }
    }
    /// Ground so many times as bright, by an application's program, or by a texture.
    void setBrightness(float brightness, bool byProgram)
    {
        _scene->removeChildren(0, _scene->getNumChildren());
        const osg::ref_ptr<osg::Geometry> hills = makeHills();
        osg::StateSet& state = *hills->getOrCreateStateSet();
        if (byProgram)
        {
            state.setAttribute(program());
            state.addUniform(new osg::Uniform("brightness", brightness));
        }
        else
        {
            state.setTextureAttributeAndModes(0, texture(brightness));
            state.setMode(GL_LIGHTING, osg::StateAttribute::OFF);
        }
        _scene->addChild(hills);
        viewer().getCamera()->setClearColor(osg::Vec4(0.1f, 0.2f, 0.3f, 1.0f) * brightness);
    }

private:
    static osg::ref_ptr<osg::Program> program()
    {
        HostProgram host("#version 330 compatibility\n",
                         "place = gl_Vertex.xyz;\n"
                         "    gl_Position = gl_ProjectionMatrix * DEFORM(gl_ModelViewMatrix * gl_Vertex);",
                         "out vec3 place;\n");
        host.fragments = {
            "#version 330 compatibility\nDEFINES\nin vec3 place;\nuniform float brightness;\nvoid main()\n{\n"
            "    vec3 color = 0.5 + 0.5 * sin(place / vec3(90.0, 70.0, 20.0));\n"
            "    gl_FragColor = TINT(vec4(brightness * color, 1.0));\n}\n"};
        osg::ref_ptr<osg::Program> program = host.make(false);
        EffectScene::adapt(*program);
        return program;
    }
    static osg::ref_ptr<osg::Texture2D> texture(float brightness)
    {
        const osg::ref_ptr<osg::Image> image = new osg::Image;
        image->allocateImage(16, 16, 1, GL_RGB, GL_FLOAT);
        image->setInternalTextureFormat(GL_RGB32F_ARB);
        for (int i = 0; i < 3 * 16 * 16; ++i)
            reinterpret_cast<float*>(image->data())[i] =
                brightness * static_cast<float>((i * 7) % 32) / 32.0f;
        osg::ref_ptr<osg::Texture2D> texture = new osg::Texture2D(image);
        texture->setFilter(osg::Texture::MIN_FILTER, osg::Texture::NEAREST);
        texture->setFilter(osg::Texture::MAG_FILTER, osg::Texture::NEAREST);
        texture->setWrap(osg::Texture::WRAP_S, osg::Texture::REPEAT);
        texture->setWrap(osg::Texture::WRAP_T, osg::Texture::REPEAT);
        return texture;
    }
};

/// The largest difference of two pictures, the second one times a factor; and the largest color of the first.
std::pair<double, double> farthestApart(const osg::Image& a, const osg::Image& b, double factor)
{
    double most = 0.0, brightest = 0.0;
    for (int i = 0; i < a.s() * a.t(); ++i)
    {
        for (int channel = 0; channel < 3; ++channel)
        {
            const double one = reinterpret_cast<const float*>(a.data())[4 * i + channel];
            const double other = reinterpret_cast<const float*>(b.data())[4 * i + channel];
            most = std::max(most, std::abs(one - factor * other));
            brightest = std::max(brightest, one);
        }
    }
    return {most, brightest};
}

} // namespace

// Close-ups change no color here: the picture of bright ground is that of dim ground, times a power of two.
TEST_P(BrightColors, CloseUpsKeepThem)
{
    addCloseUps();
    const FrameBufferTarget target(*viewer().getCamera(), GetParam(), GL_DEPTH_COMPONENT24);
    for (const auto& [pipeline, byProgram] :
         {std::pair(CloseUps::SINGLE_PASS, false), std::pair(CloseUps::MULTI_PASS, false),
          std::pair(CloseUps::MULTI_PASS, true)})
    {
        SCOPED_TRACE(::testing::Message() << pipeline << ' ' << byProgram);
        _closeUps->setPipeline(pipeline);
        const bool own = byProgram;
        const auto drawn = [&](float brightness)
        {
            setBrightness(brightness, own);
            draw();
            draw();
            return osg::ref_ptr<osg::Image>(osg::clone(target.image.get(), osg::CopyOp::DEEP_COPY_ALL));
        };
        const osg::ref_ptr<osg::Image> bright = drawn(16.0f), dim = drawn(0.5f);
        _closeUps->setEnabled(false);
        EXPECT_GT(farthestApart(*bright, *drawn(16.0f), 1.0).first, 4.0) << "there are close-ups";
        _closeUps->setEnabled(true);
        const auto [apart, brightest] = farthestApart(*bright, *dim, 32.0);
        EXPECT_GT(brightest, 10.0);
        // Half floats have eleven bits; soft edges are mixed with what is behind them.
        EXPECT_LT(apart, (GetParam() == GL_RGBA16F_ARB ? 4e-3 : 1e-5) * brightest);
    }
}

INSTANTIATE_TEST_SUITE_P(Formats, BrightColors, ::testing::Values(GL_RGBA16F_ARB, GL_RGBA32F_ARB),
                         [](const auto& format)
                         { return std::string(format.param == GL_RGBA16F_ARB ? "half" : "single"); });

// Geometry without a shader, as plain OpenSceneGraph draws it. OpenGL bounds what texture environments add, even here.
TEST_P(BrightColors, GeometryWithoutAShaderIsAsWithoutTheKit)
{
    const FrameBufferTarget target(*viewer().getCamera(), GetParam(), GL_DEPTH_COMPONENT24);
    _scene->removeEffect(_closeUps);
    const osg::ref_ptr<VerticalExaggeration> lift = new VerticalExaggeration;
    lift->setFactor(1.0 + 1e-9); // the kit's program draws, and nothing moves
    _scene->addEffect(lift);
    const auto drawn = [&](int kind, bool effects)
    {
        setBrightness(4.0f, false);
        const osg::ref_ptr<osg::Geometry> hills = _scene->getChild(0)->asGeometry();
        osg::StateSet& state = *hills->getOrCreateStateSet();
        if (kind == 0) state.setTextureAttribute(0, new osg::TexEnv(osg::TexEnv::ADD));
        if (kind == 1)
        {
            const osg::ref_ptr<osg::Fog> fog = new osg::Fog;
            fog->setMode(osg::Fog::LINEAR);
            fog->setStart(1500.0f);
            fog->setEnd(4000.0f);
            fog->setColor({0.5f, 0.5f, 0.5f, 1.0f});
            state.setAttributeAndModes(fog);
        }
        if (kind == 2)
        {
            const osg::ref_ptr<osg::Vec4Array> more = new osg::Vec4Array(1);
            more->front().set(0.3f, 0.2f, 0.1f, 1.0f);
            hills->setSecondaryColorArray(more, osg::Array::BIND_OVERALL);
            state.setMode(GL_COLOR_SUM, osg::StateAttribute::ON);
        }
        const osg::ref_ptr<osg::Group> plain = new osg::Group;
        plain->addChild(hills);
        _root->replaceChild(_root->getChild(_root->getNumChildren() - 1),
                            effects ? static_cast<osg::Group*>(_scene.get()) : plain.get());
        draw();
        draw();
        return osg::ref_ptr<osg::Image>(osg::clone(target.image.get(), osg::CopyOp::DEEP_COPY_ALL));
    };
    for (int kind = 0; kind < 3; ++kind)
    {
        SCOPED_TRACE(kind);
        const auto [apart, brightest] = farthestApart(*drawn(kind, true), *drawn(kind, false), 1.0);
        EXPECT_GT(brightest, kind == 0 ? 0.9 : 2.0);
        EXPECT_LT(apart, 0.02);
    }
}

namespace
{

class BrightPanorama : public GlFixture
{
protected:
    BrightPanorama() : GlFixture(240, 150) {}
};

} // namespace

// A sky of the application's, brighter than white: so is its reflection.
TEST_F(BrightPanorama, WaterReflectsThem)
{
    const PanoramaHills hills{0.8};
    const osg::ref_ptr<EffectScene> scene = new EffectScene;
    const osg::ref_ptr<PanoramaMap> map = new PanoramaMap;
    map->setRipples(0.0);
    map->setReflection(1.0);
    map->setAtmosphere(0.0);
    map->setStrokes(false);
    scene->addEffect(map);
    scene->addChild(hills.terrain());
    viewer().setLightingMode(osg::View::NO_LIGHT);
    osg::Camera& camera = *viewer().getCamera();
    camera.setComputeNearFarMode(osg::CullSettings::DO_NOT_COMPUTE_NEAR_FAR);
    camera.setProjectionMatrixAsPerspective(30.0, 240.0 / 150.0, 1000.0, 1e6);
    const osg::ref_ptr<PanoramaManipulator> hand = new PanoramaManipulator(*scene, *map);
    hand->setCameraProjection(camera.getProjectionMatrix());
    hand->setWidth(40000.0);
    EXPECT_TRUE(hand->setCenter(hills.middle()));
    hand->updateCamera(camera);
    const FrameBufferTarget target(camera, GL_RGBA16F_ARB, GL_DEPTH_COMPONENT24);
    const auto drawn = [&](float brightness)
    {
        const osg::ref_ptr<osg::Image> sky = new osg::Image;
        sky->allocateImage(8, 8, 1, GL_RGB, GL_FLOAT);
        sky->setInternalTextureFormat(GL_RGB16F_ARB);
        for (int i = 0; i < 8 * 8; ++i)
        {
            const osg::Vec3f color(0.4f, 0.6f, 1.0f);
            for (int channel = 0; channel < 3; ++channel)
                reinterpret_cast<float*>(sky->data())[3 * i + channel] = brightness * color[channel];
        }
        map->setSkyImage(sky);
        render(scene);
        render(scene);
        return osg::ref_ptr<osg::Image>(osg::clone(target.image.get(), osg::CopyOp::DEEP_COPY_ALL));
    };
    const osg::ref_ptr<osg::Image> dim = drawn(1.0f), bright = drawn(4.0f);
    double more[2] = {};
    int count[2] = {};
    for (int y = 0; y < dim->t(); ++y)
    {
        for (int x = 0; x < dim->s(); ++x)
        {
            const double difference =
                static_cast<double>(bright->getColor(x, y).b() - dim->getColor(x, y).b());
            if (std::abs(difference) < 0.02) continue;
            const int where = y > dim->t() / 2 ? 0 : 1;
            more[where] += difference;
            ++count[where];
        }
    }
    EXPECT_GT(count[0], 5000) << "sky";
    EXPECT_NEAR(more[0] / count[0], 3.0, 0.01);
    EXPECT_GT(count[1], 1000) << "water";
    EXPECT_GT(more[1] / count[1], 1.0) << "its own color has a share";
}
