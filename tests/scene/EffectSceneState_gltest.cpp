// SPDX-License-Identifier: MIT
// SPDX-FileCopyrightText: 2026 the osgGeoFX authors
// An EffectScene amid what else a scene graph has: cameras, head-up displays, OSG's other groups, OpenGL's objects.
#include <tools/BentGround.h>
#include <tools/ImageComparison.h>

#include <osg/Billboard>
#include <osg/Geode>
#include <osg/LOD>
#include <osg/LightSource>
#include <osg/OcclusionQueryNode>
#include <osg/Program>
#include <osg/Projection>
#include <osg/Sequence>
#include <osg/Switch>
#include <osg/Texture2D>

using namespace osgGeoFX;
using namespace geofx::test;

class EffectSceneState : public BentGround
{
protected:
    using Build = std::function<void(osg::Group&)>;

    /// The same thing below a plain group and below an EffectScene, whose own state is the application's.
    osg::ref_ptr<osg::Image> renderPlain(const Build& build)
    {
        const osg::ref_ptr<osg::Group> group = new osg::Group;
        build(*group);
        return render(group);
    }
    osg::ref_ptr<osg::Image> renderBent(const Build& build)
    {
        const osg::ref_ptr<EffectScene> scene = makeScene({});
        build(*scene);
        return render(scene);
    }

    /// A camera with its own view of a ground, drawn into a part of the picture.
    static osg::ref_ptr<osg::Camera> makeCamera(osg::Camera::RenderOrder order)
    {
        osg::ref_ptr<osg::Camera> camera = new osg::Camera;
        camera->setRenderOrder(order);
        camera->setReferenceFrame(osg::Transform::ABSOLUTE_RF);
        camera->setViewport(10, 20, 70, 60);
        camera->setClearMask(GL_DEPTH_BUFFER_BIT);
        camera->setComputeNearFarMode(osg::CullSettings::DO_NOT_COMPUTE_NEAR_FAR);
        camera->setViewMatrixAsLookAt({0, -150, 70}, {0, -40, 0}, {0, 0, 1});
        camera->setProjectionMatrixAsPerspective(40, 4.0 / 3.0, 5, 2000);
        camera->addChild(makeGround());
        return camera;
    }

    /// Renders what it sees into a texture, and shows it on a quad.
    static void addRenderToTexture(osg::Group& group, const osg::ref_ptr<osg::Node>& seen)
    {
        osg::ref_ptr<osg::Texture2D> texture = new osg::Texture2D;
        texture->setTextureSize(64, 64);
        texture->setInternalFormat(GL_RGBA);
        texture->setFilter(osg::Texture::MIN_FILTER, osg::Texture::NEAREST);
        osg::ref_ptr<osg::Camera> camera = makeCamera(osg::Camera::PRE_RENDER);
        camera->removeChildren(0, camera->getNumChildren());
        camera->addChild(seen);
        camera->setViewport(0, 0, 64, 64);
        camera->setClearMask(GL_COLOR_BUFFER_BIT | GL_DEPTH_BUFFER_BIT);
        camera->setClearColor({0.3f, 0.2f, 0.1f, 1});
        camera->setRenderTargetImplementation(osg::Camera::FRAME_BUFFER_OBJECT);
        camera->attach(osg::Camera::COLOR_BUFFER, texture);
        group.addChild(camera);
        osg::ref_ptr<osg::Camera> screen = makeCamera(osg::Camera::POST_RENDER);
        screen->removeChildren(0, screen->getNumChildren());
        screen->setViewport(0, 0, WIDTH, HEIGHT);
        screen->setViewMatrix(osg::Matrix());
        screen->setProjectionMatrixAsOrtho2D(0, 1, 0, 1);
        osg::ref_ptr<osg::Geometry> quad =
            osg::createTexturedQuadGeometry({0.4f, 0.3f, 0}, {0.5f, 0, 0}, {0, 0.6f, 0});
        quad->getOrCreateStateSet()->setTextureAttributeAndModes(0, texture);
        screen->addChild(quad);
        group.addChild(screen);
    }

    /// The application's state, which cameras below it inherit.
    static void dress(osg::Group& group)
    {
        osg::ref_ptr<osg::LightSource> source = new osg::LightSource;
        source->getLight()->setPosition({-0.5f, -0.3f, 0.6f, 0});
        group.addChild(source);
        group.getOrCreateStateSet()->setMode(GL_LIGHTING, osg::StateAttribute::ON);
        group.getStateSet()->setMode(GL_LIGHT0, osg::StateAttribute::ON);
        group.getStateSet()->setMode(GL_CULL_FACE, osg::StateAttribute::ON);
    }
};

// ---------------------------------------------------------------------------------------------------------------------

TEST_F(EffectSceneState, CamerasBelowAreDrawnAsEver)
{
    for (const osg::Camera::RenderOrder order :
         {osg::Camera::PRE_RENDER, osg::Camera::NESTED_RENDER, osg::Camera::POST_RENDER})
    {
        for (const bool deep : {false, true})
        {
            const Build build = [=](osg::Group& group)
            {
                dress(group);
                osg::Group* parent = &group;
                if (deep)
                {
                    // Groups with state between the scene and the camera.
                    parent = new osg::Group;
                    group.addChild(parent);
                    parent->getOrCreateStateSet()->setMode(GL_LIGHTING, osg::StateAttribute::OFF);
                    parent->addChild(new osg::Group);
                    parent = parent->getChild(0)->asGroup();
                    parent->getOrCreateStateSet()->setDefine("GEOFX_DEFORMATION", osg::StateAttribute::OFF);
                }
                osg::ref_ptr<osg::Camera> camera = makeCamera(order);
                // What is drawn first must not be cleared away.
                if (order == osg::Camera::PRE_RENDER) camera->setClearMask(0);
                parent->addChild(camera);
            };
            if (order == osg::Camera::PRE_RENDER)
            {
                viewer().getCamera()->setClearMask(GL_DEPTH_BUFFER_BIT);
                withContext(
                    [](osg::State&)
                    {
                        glClearColor(0, 0, 0, 1);
                        glClear(GL_COLOR_BUFFER_BIT | GL_DEPTH_BUFFER_BIT);
                    });
            }
            const std::string name = "order " + std::to_string(order) + (deep ? " deep" : "");
            const osg::ref_ptr<osg::Image> expected = renderPlain(build);
            EXPECT_GT(covered(*expected), 500) << name;
            EXPECT_TRUE(same(*renderBent(build), *expected, name));
            viewer().getCamera()->setClearMask(GL_COLOR_BUFFER_BIT | GL_DEPTH_BUFFER_BIT);
        }
    }
}

TEST_F(EffectSceneState, ProjectionsBelowAreDrawnAsEver)
{
    const Build build = [](osg::Group& group)
    {
        osg::ref_ptr<osg::Projection> projection =
            new osg::Projection(osg::Matrix::ortho2D(-160, 160, -160, 160));
        osg::ref_ptr<osg::MatrixTransform> view = new osg::MatrixTransform;
        view->setReferenceFrame(osg::Transform::ABSOLUTE_RF);
        view->addChild(makeGround());
        projection->addChild(view);
        group.addChild(projection);
        dress(group);
    };
    const osg::ref_ptr<osg::Image> expected = renderPlain(build);
    EXPECT_GT(covered(*expected), WIDTH * HEIGHT / 2);
    EXPECT_TRUE(same(*renderBent(build), *expected));
}

TEST_F(EffectSceneState, RenderToTextureBelowIsDrawnAsEver)
{
    const Build build = [](osg::Group& group)
    {
        addRenderToTexture(group, makeGround());
    };
    const osg::ref_ptr<osg::Image> expected = renderPlain(build);
    EXPECT_GT(covered(*expected), WIDTH * HEIGHT / 4);
    EXPECT_TRUE(same(*renderBent(build), *expected));
    // Beside it the scene is deformed as ever.
    const osg::ref_ptr<EffectScene> scene = makeScene({makeBox(20, {0, 130, 40})});
    const int alone = covered(*render(scene));
    EXPECT_GT(alone, 0);
    const osg::ref_ptr<osg::Camera> hidden = makeCamera(osg::Camera::NESTED_RENDER);
    hidden->setNodeMask(0);
    scene->addChild(hidden);
    EXPECT_EQ(covered(*render(scene)), alone);
}

// Nothing of ours reaches them: shaders that call the scene's functions are not deformed there.
TEST_F(EffectSceneState, FunctionsDoNothingInCamerasBelow)
{
    const auto build = [](EffectScene& scene)
    {
        osg::ref_ptr<osg::Program> program = new osg::Program;
        program->addShader(new osg::Shader(
            osg::Shader::VERTEX,
            "#version 330 compatibility\n"
            "vec4 geofx_vertex(vec4 eyePosition);\n"
            "void main()\n{\n"
            "    gl_Position = gl_ProjectionMatrix * geofx_vertex(gl_ModelViewMatrix * gl_Vertex);\n"
            "    gl_FrontColor = gl_Color;\n}\n"));
        program->addShader(new osg::Shader(osg::Shader::FRAGMENT,
                                           "#version 330 compatibility\n"
                                           "void main() { gl_FragColor = gl_Color; }\n"));
        scene.addFunctions(*program);
        osg::ref_ptr<osg::Camera> camera = makeCamera(osg::Camera::POST_RENDER);
        camera->getOrCreateStateSet()->setAttribute(program);
        osg::ref_ptr<osg::Group> group = new osg::Group;
        group->getOrCreateStateSet()->setMode(GL_CULL_FACE, osg::StateAttribute::ON);
        group->addChild(camera);
        scene.addChild(group);
    };
    const osg::ref_ptr<EffectScene> scene = makeScene({});
    build(*scene);
    const osg::ref_ptr<osg::Image> actual = render(scene);
    EXPECT_GT(covered(*actual), 500);
    scene->getEffect(0)->setEnabled(false);
    EXPECT_TRUE(same(*actual, *render(scene)));
}

TEST_F(EffectSceneState, CamerasAboveAreDeformedWhereAskedFor)
{
    const osg::ref_ptr<osg::Group> plainRoot = new osg::Group;
    addRenderToTexture(*plainRoot, makeGround());
    const osg::ref_ptr<osg::Image> plain = render(plainRoot);
    const osg::ref_ptr<EffectScene> scene = makeScene({makeGround()});
    const osg::ref_ptr<osg::Group> root = new osg::Group;
    addRenderToTexture(*root, scene);
    EXPECT_TRUE(same(*render(root), *plain, "not asked for"));
    scene->setNestedCameras(true);
    EXPECT_GT(differing(*render(root), *plain), 200);
    scene->setNestedCameras(false);
    EXPECT_TRUE(same(*render(root), *plain, "no longer"));
}

// One scene drawn by the viewer's camera and, at the same time, into a texture.
TEST_F(EffectSceneState, OneSceneInTwoCameras)
{
    const osg::ref_ptr<EffectScene> scene = makeScene({makeGround()});
    scene->setNestedCameras(true);
    const osg::ref_ptr<osg::Group> root = makePlain({scene});
    addRenderToTexture(*root, scene);
    const osg::ref_ptr<osg::Image> together = render(root);
    // The same two, as scenes of their own.
    const osg::ref_ptr<EffectScene> first = makeScene({makeGround()});
    const osg::ref_ptr<EffectScene> second = makeScene({makeGround()});
    second->setNestedCameras(true);
    const osg::ref_ptr<osg::Group> apart = makePlain({first});
    addRenderToTexture(*apart, second);
    EXPECT_TRUE(same(*together, *render(apart)));
}

// ---------------------------------------------------------------------------------------------------------------------

TEST_F(EffectSceneState, NothingBelow)
{
    const osg::ref_ptr<EffectScene> scene = makeScene({});
    EXPECT_EQ(covered(*render(scene)), 0);
    scene->addChild(new osg::Group);
    scene->addChild(new osg::Geode);
    scene->addChild(new osg::Geometry);
    osg::ref_ptr<osg::MatrixTransform> empty = new osg::MatrixTransform;
    empty->addChild(new osg::LOD);
    empty->addChild(new osg::LightSource);
    scene->addChild(empty);
    EXPECT_EQ(covered(*render(scene)), 0);
    viewer().getCamera()->setComputeNearFarMode(osg::CullSettings::COMPUTE_NEAR_FAR_USING_BOUNDING_VOLUMES);
    EXPECT_EQ(covered(*render(scene)), 0);
    scene->addChild(makeGround());
    EXPECT_GT(covered(*render(scene)), WIDTH * HEIGHT / 3);
}

// Groups that decide what is drawn decide the same below an EffectScene; what they choose is deformed.
TEST_F(EffectSceneState, OtherGroups)
{
    const auto thing = [](const osg::Vec3d& place)
    {
        return makeBox(20, place);
    };
    const std::vector<std::pair<std::string, std::function<osg::ref_ptr<osg::Node>(const osg::Vec3d&)>>>
        groups = {{"Switch",
                   [&](const osg::Vec3d& place)
                   {
                       osg::ref_ptr<osg::Switch> group = new osg::Switch;
                       group->addChild(thing(place + osg::Vec3d(40, 0, 0)), false);
                       group->addChild(thing(place), true);
                       return group;
                   }},
                  {"Sequence",
                   [&](const osg::Vec3d& place)
                   {
                       osg::ref_ptr<osg::Sequence> group = new osg::Sequence;
                       group->addChild(thing(place), 10);
                       group->addChild(thing(place + osg::Vec3d(40, 0, 0)), 10);
                       group->setInterval(osg::Sequence::LOOP, 0, 1);
                       group->setDuration(1, -1);
                       group->setMode(osg::Sequence::START);
                       group->setMode(osg::Sequence::PAUSE);
                       group->setValue(0);
                       return group;
                   }},
                  {"LOD by distance",
                   [&](const osg::Vec3d& place)
                   {
                       osg::ref_ptr<osg::LOD> group = new osg::LOD;
                       group->addChild(thing(place + osg::Vec3d(40, 0, 0)), 500, 1e6f);
                       group->addChild(thing(place), 0, 500);
                       return group;
                   }},
                  {"LOD by pixels",
                   [&](const osg::Vec3d& place)
                   {
                       osg::ref_ptr<osg::LOD> group = new osg::LOD;
                       group->setRangeMode(osg::LOD::PIXEL_SIZE_ON_SCREEN);
                       group->addChild(thing(place + osg::Vec3d(40, 0, 0)), 0, 3);
                       group->addChild(thing(place), 3, 1e6f);
                       return group;
                   }},
                  {"OcclusionQueryNode", [&](const osg::Vec3d& place)
                   {
                       osg::ref_ptr<osg::OcclusionQueryNode> group = new osg::OcclusionQueryNode;
                       group->setQueriesEnabled(false);
                       group->addChild(thing(place));
                       return group;
                   }}};
    for (const osg::Vec3d& place : {osg::Vec3d(0, -90, 0), osg::Vec3d(0, 130, 0)})
    {
        const osg::ref_ptr<osg::Image> expected = render(makeScene({thing(place)}));
        EXPECT_GT(covered(*expected), 30);
        for (const auto& [name, make] : groups)
        {
            const osg::ref_ptr<EffectScene> scene = makeScene({make(place)});
            render(scene);
            EXPECT_TRUE(same(*render(scene), *expected, name));
        }
    }
}

TEST_F(EffectSceneState, PixelSizesAreThoseOfThePicture)
{
    // In the focus the same level as without effects, whatever the limit.
    int fine = 0;
    for (float limit = 4; limit < 700; limit *= 1.5f)
    {
        const auto make = [&]
        {
            osg::ref_ptr<osg::LOD> group = new osg::LOD;
            group->setRangeMode(osg::LOD::PIXEL_SIZE_ON_SCREEN);
            group->addChild(makeBox(8, {-10, -95, 0}), 0, limit);
            group->addChild(makeBox(6, {10, -95, 0}), limit, 1e6f);
            return group;
        };
        const osg::ref_ptr<osg::Image> expected = render(makePlain({make()}));
        EXPECT_TRUE(same(*render(makeScene({make()})), *expected, std::to_string(limit)));
        fine += differing(*expected, *render(makePlain({makeBox(6, {10, -95, 0})}))) == 0 ? 1 : 0;
    }
    EXPECT_GT(fine, 2);
    EXPECT_LT(fine, 11);
}

TEST_F(EffectSceneState, BillboardsAreDrawn)
{
    for (const osg::Billboard::Mode mode :
         {osg::Billboard::POINT_ROT_EYE, osg::Billboard::POINT_ROT_WORLD, osg::Billboard::AXIAL_ROT})
    {
        const auto make = [&](const osg::Vec3d& place)
        {
            osg::ref_ptr<osg::Billboard> billboard = new osg::Billboard;
            billboard->setMode(mode);
            billboard->addDrawable(osg::createTexturedQuadGeometry({-8, 0, 0}, {16, 0, 0}, {0, 0, 16}),
                                   place);
            return billboard;
        };
        const osg::Vec3d near(5, -90, 0);
        const osg::ref_ptr<osg::Image> expected = render(makePlain({make(near)}));
        EXPECT_GT(covered(*expected), 50);
        EXPECT_TRUE(same(*render(makeScene({make(near)})), *expected, std::to_string(mode)));
        EXPECT_GT(covered(*render(makeScene({make({0, 130, 0})}))), 20);
    }
}

TEST_F(EffectSceneState, LampsBelowLight)
{
    const auto lit = [](const osg::ref_ptr<EffectScene>& scene, osg::Group& group)
    {
        osg::ref_ptr<osg::LightSource> source = new osg::LightSource;
        source->getLight()->setPosition({0, -120, 30, 1});
        group.addChild(source);
        scene->getOrCreateStateSet()->setMode(GL_LIGHTING, osg::StateAttribute::ON);
        scene->getStateSet()->setMode(GL_LIGHT0, osg::StateAttribute::ON);
        return scene;
    };
    const osg::ref_ptr<EffectScene> below = makeScene({makeGround()});
    const osg::ref_ptr<osg::Image> actual = render(lit(below, *below));
    const osg::ref_ptr<EffectScene> beside = makeScene({makeGround()});
    const osg::ref_ptr<osg::Group> root = makePlain({beside});
    lit(beside, *root);
    EXPECT_TRUE(same(*actual, *render(root)));
    EXPECT_GT(differing(*actual, *render(makeScene({makeGround()}))), WIDTH * HEIGHT / 3);
}

// ---------------------------------------------------------------------------------------------------------------------

TEST_F(EffectSceneState, ReleasedAndDrawnAgain)
{
    const osg::ref_ptr<EffectScene> scene = makeScene({makeGround()});
    const osg::ref_ptr<osg::Image> expected = render(scene);
    for (int i = 0; i < 2; ++i)
    {
        withContext([&](osg::State& state) { scene->releaseGLObjects(&state); });
        EXPECT_TRUE(same(*render(scene), *expected, "of one context"));
    }
    scene->releaseGLObjects(nullptr);
    EXPECT_TRUE(same(*render(scene), *expected, "of all"));
    scene->resizeGLObjectBuffers(8);
    EXPECT_TRUE(same(*render(scene), *expected, "resized"));
    // A copy that is drawn, and gone.
    osg::ref_ptr<EffectScene> copy = osg::clone(scene.get(), osg::CopyOp::SHALLOW_COPY);
    EXPECT_TRUE(same(*render(copy), *expected, "copied"));
    copy->releaseGLObjects(nullptr);
    copy = nullptr;
    EXPECT_TRUE(same(*render(scene), *expected, "after the copy"));
}

TEST_F(EffectSceneState, TwoContextsOneAfterTheOther)
{
    const osg::ref_ptr<EffectScene> scene = makeScene({makeGround()});
    const osg::ref_ptr<osg::Image> expected = render(scene);
    TearDown();
    SetUp();
    EXPECT_TRUE(same(*render(scene), *expected, "the first one closed"));
    scene->releaseGLObjects(nullptr);
    TearDown();
    SetUp();
    EXPECT_TRUE(same(*render(scene), *expected, "released before"));
}
