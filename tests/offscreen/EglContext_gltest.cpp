// SPDX-License-Identifier: MIT
// SPDX-FileCopyrightText: 2026 the osgGeoFX authors
// The off-screen context under osgViewer: what is drawn, sharing, threads, messages, and what it says when it cannot.
#include <osgGeoFX/offscreen/EglGraphicsContext.h>
#include <osgGeoFX/offscreen/ImageCapture.h>

#include <osg/ColorMask>
#include <osg/Depth>
#include <osg/Geometry>
#include <osg/ShapeDrawable>
#include <osgViewer/CompositeViewer>
#include <osgViewer/Viewer>

#include <gtest/gtest.h>
#include <tools/GlFixture.h>

#include <cstdlib>
#include <cstring>
#include <thread>

using osgGeoFX::EglGraphicsContext;
using osgGeoFX::ImageCapture;

namespace
{

/// The fixture's own context is not used; it skips the test where there is none, and watches for warnings.
class EglContext : public geofx::test::GlFixture
{
};

osg::ref_ptr<osg::GraphicsContext::Traits> traitsOf(int width, int height, unsigned int samples = 0)
{
    osg::ref_ptr<osg::GraphicsContext::Traits> traits = new osg::GraphicsContext::Traits;
    traits->width = width;
    traits->height = height;
    traits->alpha = 8;
    traits->samples = samples;
    return traits;
}

osg::ref_ptr<EglGraphicsContext> makeContext(int width, int height, unsigned int samples = 0)
{
    osg::ref_ptr<EglGraphicsContext> context = new EglGraphicsContext(traitsOf(width, height, samples));
    EXPECT_TRUE(context->valid()) << context->error();
    return context;
}

/// A triangle over the lower left half of the picture, unlit, drawn in normalised device coordinates.
osg::ref_ptr<osg::Node> makeTriangle(const osg::Vec4& color)
{
    osg::ref_ptr<osg::Geometry> geometry = new osg::Geometry;
    osg::ref_ptr<osg::Vec3Array> vertices = new osg::Vec3Array;
    vertices->push_back(osg::Vec3(-1.0f, -1.0f, 0.0f));
    vertices->push_back(osg::Vec3(1.0f, -1.0f, 0.0f));
    vertices->push_back(osg::Vec3(-1.0f, 1.0f, 0.0f));
    osg::ref_ptr<osg::Vec4Array> colors = new osg::Vec4Array(osg::Array::BIND_OVERALL);
    colors->push_back(color);
    geometry->setVertexArray(vertices);
    geometry->setColorArray(colors);
    geometry->addPrimitiveSet(new osg::DrawArrays(GL_TRIANGLES, 0, 3));
    geometry->getOrCreateStateSet()->setMode(GL_LIGHTING, osg::StateAttribute::OFF);
    return geometry;
}

/// A lit scene of many spheres with different states, enough work for a draw thread to fall behind.
osg::ref_ptr<osg::Node> makeSpheres()
{
    osg::ref_ptr<osg::Group> group = new osg::Group;
    for (int i = 0; i < 60; ++i)
    {
        const int column = i % 10;
        const int row = i / 10;
        const osg::Vec3 center(static_cast<float>(column) - 4.0f, 0.0f, static_cast<float>(row) - 2.0f);
        osg::ref_ptr<osg::ShapeDrawable> sphere = new osg::ShapeDrawable(new osg::Sphere(center, 0.45f));
        sphere->setColor(osg::Vec4(0.1f + 0.015f * static_cast<float>(i), 0.8f, 0.5f, 1.0f));
        group->addChild(sphere);
    }
    return group;
}

void setUpCamera(osg::Camera* camera, osg::GraphicsContext* context)
{
    const osg::GraphicsContext::Traits* traits = context->getTraits();
    camera->setGraphicsContext(context);
    camera->setViewport(0, 0, traits->width, traits->height);
    camera->setClearColor(osg::Vec4(0.2f, 0.4f, 0.6f, 1.0f));
    camera->setProjectionMatrixAsPerspective(
        40.0, static_cast<double>(traits->width) / static_cast<double>(traits->height), 1.0, 100.0);
    camera->setViewMatrixAsLookAt(osg::Vec3d(3.0, -12.0, 4.0), osg::Vec3d(), osg::Z_AXIS);
}

void setUpFlatCamera(osg::Camera* camera, osg::GraphicsContext* context)
{
    setUpCamera(camera, context);
    camera->setComputeNearFarMode(osg::Camera::DO_NOT_COMPUTE_NEAR_FAR);
    camera->setProjectionMatrix(osg::Matrixd::identity());
    camera->setViewMatrix(osg::Matrixd::identity());
}

osg::ref_ptr<osg::Image> drawFrame(osgViewer::Viewer& viewer, ImageCapture* capture)
{
    capture->request();
    viewer.frame(0.0);
    return capture->take();
}

bool sameBytes(const osg::Image* a, const osg::Image* b)
{
    return a && b && a->getTotalSizeInBytes() == b->getTotalSizeInBytes() &&
           std::memcmp(a->data(), b->data(), a->getTotalSizeInBytes()) == 0;
}

/// 8 bit channels of a pixel, counted from the lower left corner.
osg::Vec4i pixel(const osg::Image* image, int x, int y)
{
    const unsigned char* p = image->data(x, y);
    return osg::Vec4i(p[0], p[1], p[2], image->getPixelFormat() == GL_RGBA ? p[3] : 255);
}

} // namespace

TEST_F(EglContext, DrawsClearColorAndTriangle)
{
    osg::ref_ptr<EglGraphicsContext> context = makeContext(64, 48);
    osgViewer::Viewer viewer;
    viewer.setThreadingModel(osgViewer::Viewer::SingleThreaded);
    setUpFlatCamera(viewer.getCamera(), context);
    viewer.setSceneData(makeTriangle(osg::Vec4(1.0f, 0.0f, 0.0f, 1.0f)));
    osg::ref_ptr<ImageCapture> capture = ImageCapture::attach(viewer.getCamera(), ImageCapture::Format::Rgba);
    viewer.realize();
    ASSERT_TRUE(viewer.isRealized());

    osg::ref_ptr<osg::Image> image = drawFrame(viewer, capture);
    ASSERT_TRUE(image.valid());
    EXPECT_EQ(image->s(), 64);
    EXPECT_EQ(image->t(), 48);
    EXPECT_EQ(pixel(image, 5, 5), osg::Vec4i(255, 0, 0, 255));
    EXPECT_EQ(pixel(image, 60, 44), osg::Vec4i(51, 102, 153, 255));
}

TEST_F(EglContext, IsTheNewestCompatibilityProfile)
{
    osg::ref_ptr<EglGraphicsContext> context = makeContext(16, 16);
    ASSERT_TRUE(context->realize());
    ASSERT_TRUE(context->makeCurrent());
    EXPECT_GE(osg::getGLVersionNumber(), 3.3f);
    GLint profile = 0;
    glGetIntegerv(GL_CONTEXT_PROFILE_MASK, &profile);
    EXPECT_EQ(profile, GL_CONTEXT_COMPATIBILITY_PROFILE_BIT);
    // A function that OSG found by itself, with the X flavoured loader of Debian's OSG.
    GLuint buffer = 0;
    context->getState()->get<osg::GLExtensions>()->glGenBuffers(1, &buffer);
    EXPECT_NE(buffer, 0u);
    EXPECT_EQ(glGetError(), static_cast<GLenum>(GL_NO_ERROR));
    context->releaseContext();
}

TEST_F(EglContext, MultisamplingSmoothsEdges)
{
    auto shades = [](unsigned int samples)
    {
        osg::ref_ptr<EglGraphicsContext> context = makeContext(64, 48, samples);
        EXPECT_EQ(context->getTraits()->samples > 0, samples > 0);
        osgViewer::Viewer viewer;
        viewer.setThreadingModel(osgViewer::Viewer::SingleThreaded);
        setUpFlatCamera(viewer.getCamera(), context);
        viewer.setSceneData(makeTriangle(osg::Vec4(1.0f, 0.0f, 0.0f, 1.0f)));
        osg::ref_ptr<ImageCapture> capture = ImageCapture::attach(viewer.getCamera());
        osg::ref_ptr<osg::Image> image = drawFrame(viewer, capture);
        int count = 0;
        for (int y = 0; y < 48; ++y)
        {
            for (int x = 0; x < 64; ++x)
            {
                const int red = pixel(image, x, y)[0];
                count += red != 255 && red != 51;
            }
        }
        return count;
    };
    EXPECT_EQ(shades(0), 0);
    EXPECT_GT(shades(4), 20);
}

TEST_F(EglContext, CapturesDepth)
{
    osg::ref_ptr<EglGraphicsContext> context = makeContext(64, 48);
    osgViewer::Viewer viewer;
    viewer.setThreadingModel(osgViewer::Viewer::SingleThreaded);
    setUpFlatCamera(viewer.getCamera(), context);
    viewer.setSceneData(makeTriangle(osg::Vec4(1.0f, 0.0f, 0.0f, 1.0f)));
    osg::ref_ptr<ImageCapture> capture =
        ImageCapture::attach(viewer.getCamera(), ImageCapture::Format::DepthFloat);
    osg::ref_ptr<osg::Image> image = drawFrame(viewer, capture);
    ASSERT_TRUE(image.valid());
    ASSERT_EQ(image->getDataType(), static_cast<GLenum>(GL_FLOAT));
    EXPECT_NEAR(*reinterpret_cast<const float*>(image->data(5, 5)), 0.5f, 1e-5f);
    EXPECT_EQ(*reinterpret_cast<const float*>(image->data(60, 44)), 1.0f);
}

TEST_F(EglContext, CaptureKeepsOtherCallbacks)
{
    struct Counter : public osg::Camera::DrawCallback
    {
        using osg::Camera::DrawCallback::operator();
        void operator()(osg::RenderInfo&) const override { ++count; }
        mutable int count = 0;
    };
    osg::ref_ptr<EglGraphicsContext> context = makeContext(64, 48);
    osgViewer::Viewer viewer;
    viewer.setThreadingModel(osgViewer::Viewer::SingleThreaded);
    setUpFlatCamera(viewer.getCamera(), context);
    viewer.setSceneData(makeTriangle(osg::Vec4(1.0f, 0.0f, 0.0f, 1.0f)));
    osg::ref_ptr<Counter> before = new Counter;
    osg::ref_ptr<Counter> after = new Counter;
    viewer.getCamera()->setFinalDrawCallback(before);
    osg::ref_ptr<ImageCapture> capture = ImageCapture::attach(viewer.getCamera());
    viewer.getCamera()->addFinalDrawCallback(after);

    EXPECT_TRUE(drawFrame(viewer, capture).valid());
    viewer.frame(0.0);
    EXPECT_FALSE(capture->take(0.0).valid()) << "a frame that nobody requested was captured";
    capture->detach(viewer.getCamera());
    capture->request();
    viewer.frame(0.0);
    EXPECT_FALSE(capture->take(0.0).valid());
    EXPECT_EQ(before->count, 3);
    EXPECT_EQ(after->count, 3);
}

TEST_F(EglContext, ThreadingModelsGiveTheSameImage)
{
    const osgViewer::ViewerBase::ThreadingModel models[] = {
        osgViewer::Viewer::SingleThreaded, osgViewer::Viewer::CullDrawThreadPerContext,
        osgViewer::Viewer::DrawThreadPerContext, osgViewer::Viewer::CullThreadPerCameraDrawThreadPerContext};
    osg::ref_ptr<osg::Image> reference;
    for (auto model : models)
    {
        osg::ref_ptr<EglGraphicsContext> context = makeContext(320, 200);
        osgViewer::Viewer viewer;
        viewer.setThreadingModel(model);
        setUpCamera(viewer.getCamera(), context);
        viewer.setSceneData(makeSpheres());
        osg::ref_ptr<ImageCapture> capture = ImageCapture::attach(viewer.getCamera());
        for (int i = 0; i < 3; ++i)
        {
            osg::ref_ptr<osg::Image> image = drawFrame(viewer, capture);
            ASSERT_TRUE(image.valid());
            if (!reference) reference = image;
            EXPECT_TRUE(sameBytes(image, reference)) << "threading model " << model << ", frame " << i;
        }
    }
    EXPECT_NE(pixel(reference, 160, 100), pixel(reference, 0, 0)) << "nothing was drawn";
}

TEST_F(EglContext, TwoContextsAtOnceWithAndWithoutSharing)
{
    for (bool share : {false, true})
    {
        osg::ref_ptr<EglGraphicsContext> first = makeContext(200, 150);
        osg::ref_ptr<osg::GraphicsContext::Traits> traits = traitsOf(200, 150);
        if (share) traits->sharedContext = first.get();
        osg::ref_ptr<EglGraphicsContext> second;
        // OSG 3.6.5 always says "incrementContextIDUsageCount(0) to 2" when contexts share their objects.
        watch().messagesOf([&] { second = new EglGraphicsContext(traits); });
        ASSERT_TRUE(second->valid()) << second->error();
        EXPECT_EQ(first->getState()->getContextID() == second->getState()->getContextID(), share);

        osgViewer::CompositeViewer viewer;
        // OSG does not order the first uploads of two draw threads that share their objects.
        viewer.setThreadingModel(share ? osgViewer::Viewer::SingleThreaded
                                       : osgViewer::Viewer::DrawThreadPerContext);
        osg::ref_ptr<osg::Node> scene = makeSpheres();
        std::vector<osg::ref_ptr<ImageCapture>> captures;
        for (EglGraphicsContext* context : {first.get(), second.get()})
        {
            osg::ref_ptr<osgViewer::View> view = new osgViewer::View;
            setUpCamera(view->getCamera(), context);
            view->setSceneData(scene);
            captures.push_back(ImageCapture::attach(view->getCamera()));
            viewer.addView(view);
        }
        for (int i = 0; i < 5; ++i)
        {
            for (auto& capture : captures)
                capture->request();
            viewer.frame(0.0);
            osg::ref_ptr<osg::Image> a = captures[0]->take();
            osg::ref_ptr<osg::Image> b = captures[1]->take();
            EXPECT_TRUE(sameBytes(a, b)) << (share ? "shared" : "not shared") << ", frame " << i;
        }
    }
}

TEST_F(EglContext, ManyContextsComeAndGo)
{
    for (int i = 0; i < 20; ++i)
    {
        osg::ref_ptr<EglGraphicsContext> context = makeContext(32 + i, 32);
        osgViewer::Viewer viewer;
        viewer.setThreadingModel(i % 2 ? osgViewer::Viewer::SingleThreaded
                                       : osgViewer::Viewer::DrawThreadPerContext);
        setUpCamera(viewer.getCamera(), context);
        viewer.setSceneData(makeSpheres());
        osg::ref_ptr<ImageCapture> capture = ImageCapture::attach(viewer.getCamera());
        EXPECT_TRUE(drawFrame(viewer, capture).valid());
    }
}

namespace
{

/// What the driver says of a wrong call in a context of these traits.
std::vector<EglGraphicsContext::DebugMessage> messagesOfAnError(osg::GraphicsContext::Traits* traits)
{
    std::vector<EglGraphicsContext::DebugMessage> messages;
    EglGraphicsContext::Options options;
    options.debugCallback = [&](const EglGraphicsContext::DebugMessage& message)
    {
        messages.push_back(message);
    };
    osg::ref_ptr<EglGraphicsContext> context = new EglGraphicsContext(traits, options);
    if (!context->valid() || !context->realize() || !context->makeCurrent())
    {
        ADD_FAILURE() << context->error();
        return {};
    }
    messages.clear();
    glEnable(0xdead);
    glGetError();
    context->releaseContext();
    return messages;
}

} // namespace

TEST_F(EglContext, ReportsDebugMessages)
{
    const std::vector<EglGraphicsContext::DebugMessage> messages = messagesOfAnError(traitsOf(16, 16));
    ASSERT_FALSE(messages.empty());
    EXPECT_EQ(messages.front().type, 0x824Cu /* GL_DEBUG_TYPE_ERROR */);
    EXPECT_NE(messages.front().text.find("GL_INVALID_ENUM"), std::string::npos) << messages.front().text;
}

// NVIDIA's driver gives the version that was asked for, Mesa the newest that it has, unless the environment of a process says
// otherwise.
TEST_F(EglContext, ReportsDebugMessagesOfOlderVersionsToo)
{
    GTEST_FLAG_SET(death_test_style, "threadsafe"); // a process of its own
    const osg::ref_ptr<osg::GraphicsContext::Traits> traits = traitsOf(16, 16);
    traits->glContextVersion = "3.3";
    traits->glContextProfileMask = 1;
    setenv("MESA_GL_VERSION_OVERRIDE", "3.3", 1);
    EXPECT_EXIT(std::exit(messagesOfAnError(traits).empty() ? 1 : 0), ::testing::ExitedWithCode(0), "");
    unsetenv("MESA_GL_VERSION_OVERRIDE");
}

TEST_F(EglContext, SaysWhyThereIsNone)
{
    osg::ref_ptr<EglGraphicsContext> empty = new EglGraphicsContext(traitsOf(0, 10));
    EXPECT_FALSE(empty->valid());
    EXPECT_FALSE(empty->error().empty());

    EglGraphicsContext::Options options;
    options.platform = EglGraphicsContext::Platform::Device;
    options.device = 63;
    osg::ref_ptr<EglGraphicsContext> none = new EglGraphicsContext(traitsOf(10, 10), options);
    EXPECT_FALSE(none->valid());
    EXPECT_NE(none->error().find("does not exist"), std::string::npos) << none->error();

    osg::ref_ptr<osg::GraphicsContext::Traits> traits = traitsOf(10, 10);
    traits->glContextVersion = "9.9";
    osg::ref_ptr<EglGraphicsContext> future = new EglGraphicsContext(traits);
    EXPECT_FALSE(future->valid());
    EXPECT_NE(future->error().find("no OpenGL context"), std::string::npos) << future->error();
}

TEST_F(EglContext, ChoosesPlatformsByName)
{
    EglGraphicsContext::Options options;
    options.platform = EglGraphicsContext::Platform::Surfaceless;
    osg::ref_ptr<EglGraphicsContext> surfaceless = new EglGraphicsContext(traitsOf(10, 10), options);
    if (surfaceless->valid())
    {
        EXPECT_EQ(surfaceless->platformName(), "surfaceless");
    }
    options.platform = EglGraphicsContext::Platform::Device;
    osg::ref_ptr<EglGraphicsContext> device = new EglGraphicsContext(traitsOf(10, 10), options);
    if (device->valid())
    {
        EXPECT_EQ(device->platformName().rfind("device ", 0), 0u);
    }
    EXPECT_TRUE(surfaceless->valid() || device->valid()) << surfaceless->error() << " " << device->error();
}
