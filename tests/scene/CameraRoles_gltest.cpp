// SPDX-License-Identifier: MIT
// SPDX-FileCopyrightText: 2026 the osgGeoFX authors
//
// Cameras that draw another one's view, from elsewhere or in part: the picture is that of ground which the CPU has moved as the
// other camera has it.
#include <osgGeoFX/deformation/PedestrianView.h>
#include <osgGeoFX/deformation/VerticalExaggeration.h>
#include <osgGeoFX/scene/CameraEffects.h>
#include <osgGeoFX/scene/RigidReference.h>
#include <tools/BentGround.h>
#include <tools/ImageComparison.h>

#include <osg/Math>
#include <osgShadow/ShadowMap>
#include <osgShadow/ShadowedScene>

#include <cmath>
#include <functional>
#include <vector>

using namespace osgGeoFX;
using namespace geofx::test;

namespace
{

using Effects = std::vector<osg::ref_ptr<Effect>>;

/// In the role that a test says.
class Role : public CameraRoleCallback
{
public:
    explicit Role(const CameraRole& role) : _role(role) {}
    CameraRole role(const osg::Camera&, osgUtil::CullVisitor&, const CameraRole&) const override
    {
        return _role;
    }

private:
    const CameraRole _role;
};

class CameraRoles : public BentGround
{
protected:
    static Effects bend() { return {makeBend()}; }
    static Effects pedestrian()
    {
        const osg::ref_ptr<PedestrianView> view = new PedestrianView;
        view->setFocusDistance(110.0);
        view->setZoneWidth(60.0);
        return {view};
    }
    static Effects bentAndHigher()
    {
        const osg::ref_ptr<VerticalExaggeration> higher = new VerticalExaggeration;
        higher->setFactor(4.0);
        return {higher, makeBend()};
    }

    osg::Camera& camera() { return *viewer().getCamera(); }
    static osg::ref_ptr<EffectScene> sceneWith(const Effects& effects)
    {
        const osg::ref_ptr<EffectScene> scene = new EffectScene;
        for (const osg::ref_ptr<Effect>& each : effects)
            scene->addEffect(each);
        scene->addChild(makeGround());
        return scene;
    }
    /// The same ground without effects, moved as a scene moves it for a camera with these matrices.
    static osg::ref_ptr<osg::Geometry> moved(const EffectScene& scene, const osg::Matrixd& view,
                                             const osg::Matrixd& projection)
    {
        const osg::ref_ptr<const DeformationChain> chain = scene.deformation(view, projection);
        EXPECT_FALSE(chain->empty());
        const osg::Matrixd toWorld = osg::Matrixd::inverse(view);
        const osg::ref_ptr<osg::Geometry> ground = makeGround();
        for (osg::Vec3& vertex : dynamic_cast<osg::Vec3Array&>(*ground->getVertexArray()))
            vertex = chain->deform(osg::Vec3d(vertex) * view) * toWorld;
        return ground;
    }
    static osg::ref_ptr<osg::Group> plain(osg::Node* node)
    {
        const osg::ref_ptr<osg::Group> group = new osg::Group;
        group->addChild(node);
        return group;
    }
    /// Vertices that the CPU has moved round otherwise than those that the GPU moves: along edges pixels differ.
    static ::testing::AssertionResult alike(const osg::Image& actual, const osg::Image& expected,
                                            const std::string& name = "")
    {
        return imagesMatch(actual, expected, {0.03f, 0.01, 1.0f}, name);
    }
    /// How many pixels differ by more than rounding.
    static double differing(const osg::Image& a, const osg::Image& b)
    {
        int count = 0;
        const unsigned int size = a.getTotalSizeInBytes();
        for (unsigned int i = 0; i < size; ++i)
            count += std::abs(a.data()[i] - b.data()[i]) > 8;
        return static_cast<double>(count) / size;
    }
};

} // namespace

TEST_F(CameraRoles, LikeAnotherCameraFromElsewhere)
{
    const osg::Matrixd view = camera().getViewMatrix();
    const osg::Matrixd projection = camera().getProjectionMatrix();
    // From beside and above; turned; and as a parallel picture from above, as of a shadow map.
    struct Look
    {
        osg::Vec3d eye, at;
        bool parallel;
    };
    const Look looks[] = {{{60.0, -130.0, 90.0}, {0.0, 0.0, 0.0}, false},
                          {{0.0, -150.0, 70.0}, {90.0, 30.0, 0.0}, false},
                          {{-100.0, 100.0, 200.0}, {0.0, 0.0, 0.0}, true}};
    for (const auto& effects : {&bend, &pedestrian, &bentAndHigher})
    {
        const osg::ref_ptr<EffectScene> scene = sceneWith(effects());
        const osg::ref_ptr<osg::Group> straight = plain(makeGround());
        const osg::ref_ptr<osg::Group> expected = plain(moved(*scene, view, projection));
        scene->setRoleCallback(new Role(CameraRole::like(view, projection)));
        for (const Look& look : looks)
        {
            camera().setViewMatrixAsLookAt(look.eye, look.at, {0.0, 0.0, 1.0});
            if (look.parallel)
                camera().setProjectionMatrixAsOrtho(-160.0, 160.0, -120.0, 120.0, 1.0, 1000.0);
            else
                camera().setProjectionMatrix(projection);
            const osg::ref_ptr<osg::Image> image = render(scene);
            EXPECT_TRUE(alike(*image, *render(expected)));
            // Each of these tells the view's deformation from none.
            EXPECT_GT(differing(*image, *render(straight)), 0.02);
            scene->setCompensation(false);
            EXPECT_TRUE(same(*image, *render(scene)));
            scene->setCompensation(true);
        }
    }
}

// Things of their own, which are culled one by one, by the frustum of the camera that draws.
TEST_F(CameraRoles, LikeAnotherCameraNothingIsMissingFromElsewhere)
{
    const osg::Matrixd view = camera().getViewMatrix();
    const osg::Matrixd projection = camera().getProjectionMatrix();
    const osg::ref_ptr<EffectScene> scene = sceneWith(bentAndHigher());
    for (int i = 0; i < 400; ++i)
    {
        const osg::Vec3 at(15.0f * static_cast<float>(i % 20 - 10), 15.0f * static_cast<float>(i / 20 - 10),
                           3.0f);
        osg::ref_ptr<osg::Vec3Array> corners = new osg::Vec3Array;
        for (const osg::Vec3& corner :
             {osg::Vec3(-3.0f, 0.0f, 0.0f), osg::Vec3(3.0f, 0.0f, 0.0f), osg::Vec3(0.0f, 0.0f, 8.0f)})
            corners->push_back(at + corner);
        osg::ref_ptr<osg::Geometry> post = new osg::Geometry;
        post->setUseVertexBufferObjects(true);
        post->setVertexArray(corners);
        osg::ref_ptr<osg::Vec4Array> color = new osg::Vec4Array(1);
        color->front().set(static_cast<float>(i % 7) / 7.0f, static_cast<float>(i % 5) / 5.0f, 1.0f, 1.0f);
        post->setColorArray(color, osg::Array::BIND_OVERALL);
        post->addPrimitiveSet(new osg::DrawArrays(GL_TRIANGLES, 0, 3));
        scene->addChild(post);
    }
    scene->setRoleCallback(new Role(CameraRole::like(view, projection)));
    camera().setComputeNearFarMode(osg::CullSettings::DO_NOT_COMPUTE_NEAR_FAR);
    const osg::CullSettings::CullingMode mode = camera().getCullingMode();
    for (const osg::Vec3d& eye :
         {osg::Vec3d(60.0, -130.0, 90.0), osg::Vec3d(150.0, 20.0, 60.0), osg::Vec3d(-100.0, 100.0, 120.0)})
    {
        camera().setViewMatrixAsLookAt(eye, {0.0, 0.0, 0.0}, {0.0, 0.0, 1.0});
        const osg::ref_ptr<osg::Image> culled = render(scene);
        camera().setCullingMode(osg::CullSettings::NO_CULLING);
        const osg::ref_ptr<osg::Image> whole = render(scene);
        camera().setCullingMode(mode);
        EXPECT_TRUE(same(*culled, *whole));
    }
}

TEST_F(CameraRoles, TheDefaultNearAndFarPlanesHoldWhatIsSeenFromElsewhere)
{
    const osg::ref_ptr<EffectScene> scene = sceneWith(bentAndHigher());
    scene->setRoleCallback(
        new Role(CameraRole::like(camera().getViewMatrix(), camera().getProjectionMatrix())));
    const osg::Matrixd projection = camera().getProjectionMatrix();
    for (const osg::Vec3d& eye : {osg::Vec3d(120.0, 10.0, 60.0), osg::Vec3d(-80.0, 180.0, 40.0)})
    {
        // OSG leaves what it has found in the camera.
        camera().setProjectionMatrix(projection);
        camera().setViewMatrixAsLookAt(eye, {0.0, 0.0, 0.0}, {0.0, 0.0, 1.0});
        camera().setComputeNearFarMode(osg::CullSettings::DO_NOT_COMPUTE_NEAR_FAR);
        const osg::ref_ptr<osg::Image> expected = render(scene);
        camera().setComputeNearFarMode(osg::CullSettings::COMPUTE_NEAR_FAR_USING_BOUNDING_VOLUMES);
        camera().setNearFarRatio(0.0005);
        EXPECT_LT(differing(*render(scene), *expected), 0.001);
        double left, right, bottom, top, near, far;
        camera().getProjectionMatrixAsFrustum(left, right, bottom, top, near, far);
        EXPECT_LT(far, 1200.0);
    }
}

TEST_F(CameraRoles, SlavesShowOneWallOfScreens)
{
    // The middle one as the wide camera has it, the others turned aside, each with a third of the picture.
    const osg::ref_ptr<EffectScene> scene = sceneWith(bend());
    const osg::Matrixd view = camera().getViewMatrix();
    const osg::Matrixd projection = camera().getProjectionMatrix();
    const osg::ref_ptr<osg::Group> expected = plain(moved(*scene, view, projection));
    osgViewer::Viewer wall;
    wall.setThreadingModel(osgViewer::ViewerBase::SingleThreaded);
    wall.setLightingMode(osg::View::NO_LIGHT);
    wall.getCamera()->setViewMatrix(view);
    wall.getCamera()->setProjectionMatrix(projection);
    std::vector<osg::ref_ptr<ImageCapture>> captures;
    std::vector<osg::Matrixd> turns;
    for (int i = 0; i < 3; ++i)
    {
        const osg::ref_ptr<osg::Camera> slave = new osg::Camera;
        slave->setGraphicsContext(&context());
        slave->setViewport(53 * i, 0, 53, HEIGHT);
        slave->setClearColor(camera().getClearColor());
        slave->setComputeNearFarMode(osg::CullSettings::DO_NOT_COMPUTE_NEAR_FAR);
        captures.push_back(ImageCapture::attach(slave, ImageCapture::Format::Rgba));
        turns.push_back(osg::Matrixd::rotate(osg::DegreesToRadians(15.0 * (i - 1)), 0.0, 1.0, 0.0));
        wall.addSlave(slave, osg::Matrixd::scale(2.0, 1.0, 1.0), turns.back());
    }
    for (int i = 0; i < 3; ++i)
    {
        wall.setSceneData(scene);
        captures[static_cast<std::size_t>(i)]->request();
        wall.frame();
        const osg::ref_ptr<osg::Image> image = captures[static_cast<std::size_t>(i)]->take();
        wall.setSceneData(expected);
        captures[static_cast<std::size_t>(i)]->request();
        wall.frame();
        EXPECT_TRUE(
            alike(*image, *captures[static_cast<std::size_t>(i)]->take(), "channel " + std::to_string(i)));
    }
}

TEST_F(CameraRoles, BothEyesSeeTheSameGround)
{
    const osg::ref_ptr<EffectScene> scene = sceneWith(bend());
    const osg::ref_ptr<osg::Group> expected =
        plain(moved(*scene, camera().getViewMatrix(), camera().getProjectionMatrix()));
    const osg::ref_ptr<osg::Image> mono = render(scene);
    for (const auto eye : {osg::DisplaySettings::LEFT_EYE, osg::DisplaySettings::RIGHT_EYE})
    {
        const osg::ref_ptr<osg::DisplaySettings> settings = new osg::DisplaySettings;
        settings->setStereo(true);
        settings->setStereoMode(eye);
        settings->setEyeSeparation(0.4f);
        camera().setDisplaySettings(settings);
        const osg::ref_ptr<osg::Image> image = render(scene);
        EXPECT_TRUE(alike(*image, *render(expected)));
        EXPECT_GT(differing(*image, *mono), 0.02);
    }
    camera().setDisplaySettings(nullptr);
}

TEST_F(CameraRoles, ObjectsAndLevelsOfDetailAreThoseOfTheView)
{
    // A house that is moved as a whole, and ground that has fewer levels from afar.
    const osg::Matrixd view = camera().getViewMatrix();
    const osg::Matrixd projection = camera().getProjectionMatrix();
    const auto make = [&](bool near, bool far)
    {
        const osg::ref_ptr<EffectScene> scene = makeScene({});
        const osg::ref_ptr<osg::LOD> levels = new osg::LOD;
        const osg::Vec3d place(10.0, 60.0, 2.0);
        const double distance = (place - osg::Vec3d(0.0, -150.0, 70.0)).length();
        levels->setCenterMode(osg::LOD::USER_DEFINED_CENTER);
        levels->setCenter(place);
        levels->setRadius(30.0f);
        // By the bend it is nearer or farther than that by far less than by where the other camera stands.
        levels->addChild(near ? makeBox(20.0f, place) : new osg::Group, 0.0f,
                         static_cast<float>(1.2 * distance));
        levels->addChild(far ? makeBox(8.0f, place) : new osg::Group, static_cast<float>(1.2 * distance),
                         1e6f);
        scene->addChild(levels);
        const osg::ref_ptr<RigidReference> house = new RigidReference;
        house->addChild(makeBox(12.0f, {-30.0, 40.0, 0.0}));
        scene->addChild(house);
        scene->setRoleCallback(new Role(CameraRole::like(view, projection)));
        return scene;
    };
    camera().setViewMatrixAsLookAt({300.0, 300.0, 200.0}, {0.0, 40.0, 0.0}, {0.0, 0.0, 1.0});
    const osg::ref_ptr<osg::Image> image = render(make(true, true));
    EXPECT_TRUE(same(*image, *render(make(true, false))));
    EXPECT_FALSE(same(*image, *render(make(false, true))));
}

TEST_F(CameraRoles, ShadowMapsMayShowTheDeformedWorld)
{
    // The light's camera in the role LIKE draws what the CPU has moved.
    const osg::Matrixd view = camera().getViewMatrix();
    const osg::Matrixd projection = camera().getProjectionMatrix();
    const auto nested = [&](osg::Node* scene)
    {
        const osg::ref_ptr<osg::Camera> light = new osg::Camera;
        light->setReferenceFrame(osg::Transform::ABSOLUTE_RF);
        light->setViewMatrixAsLookAt({-100.0, 60.0, 150.0}, {0.0, 0.0, 0.0}, {0.0, 0.0, 1.0});
        light->setProjectionMatrixAsOrtho(-160.0, 160.0, -120.0, 120.0, 1.0, 1000.0);
        light->setComputeNearFarMode(osg::CullSettings::DO_NOT_COMPUTE_NEAR_FAR);
        light->addChild(scene);
        return light;
    };
    const osg::ref_ptr<EffectScene> scene = sceneWith(bentAndHigher());
    const osg::ref_ptr<osg::Group> expected = plain(moved(*scene, view, projection));
    const osg::ref_ptr<osg::Group> straight = plain(makeGround());
    // By default it is undeformed.
    EXPECT_TRUE(same(*render(nested(scene)), *render(nested(straight))));
    scene->setRoleCallback(new Role(CameraRole::like(camera())));
    const osg::ref_ptr<osg::Image> image = render(nested(scene));
    EXPECT_TRUE(alike(*image, *render(nested(expected))));
    EXPECT_GT(differing(*image, *render(nested(straight))), 0.02);
}

// Values that are compiled into shaders, too: curves, styles, lines.
TEST_F(CameraRoles, AReplacementMayHaveAnyValues)
{
    const osg::ref_ptr<BirdsEyeView> bend = makeBend();
    const osg::ref_ptr<EffectScene> scene = sceneWith({bend});
    const osg::ref_ptr<osg::Image> bent = render(scene);
    const osg::ref_ptr<BirdsEyeView> other = makeBend();
    ASSERT_TRUE(CameraEffects::of(camera()).setReplacement(*bend, other));
    EXPECT_TRUE(same(*render(scene), *bent));
    const std::function<void()> changes[] = {[&] { other->setContextSaturation(0.0); },
                                             [&] { other->setCurve(PerspectiveBend::CIRCULAR_ARC); },
                                             [&] { other->setZoneLines(true); },
                                             [&]
                                             {
                                                 other->setContextSaturation(1.0);
                                             }};
    for (const std::function<void()>& change : changes)
    {
        // The object goes with the camera's user data, below.
        CameraEffects& own = CameraEffects::of(camera());
        // While it is a replacement, and before it becomes one.
        change();
        const osg::ref_ptr<osg::Image> changed = render(scene);
        own.setReplacement(*bend, nullptr);
        EXPECT_TRUE(same(*render(scene), *bent));
        const osg::ref_ptr<BirdsEyeView> copy = osg::clone(other.get(), osg::CopyOp::SHALLOW_COPY);
        EXPECT_TRUE(own.setReplacement(*bend, copy));
        const osg::ref_ptr<osg::Image> replaced = render(scene);
        EXPECT_TRUE(own.setReplacement(*bend, other));
        camera().setUserDataContainer(nullptr);
        const osg::ref_ptr<osg::Image> expected = render(sceneWith({copy}));
        EXPECT_TRUE(same(*changed, *expected));
        EXPECT_TRUE(same(*replaced, *expected));
        EXPECT_GT(differing(*changed, *bent), 0.001);
        EXPECT_TRUE(CameraEffects::of(camera()).setReplacement(*bend, other));
    }
    // The other camera keeps the scene's own.
    camera().setUserDataContainer(nullptr);
    EXPECT_TRUE(same(*render(scene), *bent));
}

TEST_F(CameraRoles, ARefusedReplacementIsToldOnce)
{
    const osg::ref_ptr<BirdsEyeView> bend = makeBend();
    CameraEffects& own = CameraEffects::of(camera());
    const std::vector<std::string> refused = watch().messagesOf(
        [&]
        {
            for (int i = 0; i < 5; ++i)
                EXPECT_FALSE(own.setReplacement(*bend, new VerticalExaggeration));
        });
    EXPECT_EQ(refused.size(), 1u);
}

TEST_F(CameraRoles, EffectsMayDifferFromCameraToCamera)
{
    const osg::ref_ptr<BirdsEyeView> bend = makeBend();
    const osg::ref_ptr<BirdsEyeView> flatter = makeBend();
    flatter->setContextTilt(0.3);
    const osg::ref_ptr<EffectScene> scene = sceneWith({bend});
    const osg::ref_ptr<osg::Image> bent = render(scene);
    const osg::ref_ptr<osg::Image> straight = render(plain(makeGround()));
    const osg::ref_ptr<osg::Image> flat = render(sceneWith({flatter}));
    EXPECT_GT(differing(*bent, *straight), 0.02);
    EXPECT_GT(differing(*bent, *flat), 0.02);

    CameraEffects& own = CameraEffects::of(camera());
    EXPECT_EQ(&CameraEffects::of(camera()), &own);
    own.setEnabled(*bend, false);
    EXPECT_TRUE(same(*render(scene), *straight));
    own.setEnabled(*bend, true);
    EXPECT_TRUE(same(*render(scene), *bent));
    EXPECT_TRUE(own.setReplacement(*bend, flatter));
    EXPECT_TRUE(same(*render(scene), *flat));
    // It follows the replacement's own switch, and the refused one leaves it.
    flatter->setEnabled(false);
    EXPECT_TRUE(same(*render(scene), *straight));
    flatter->setEnabled(true);
    const std::vector<std::string> refused =
        watch().messagesOf([&] { EXPECT_FALSE(own.setReplacement(*bend, new VerticalExaggeration)); });
    ASSERT_EQ(refused.size(), 1u);
    EXPECT_NE(refused[0].find("a VerticalExaggeration cannot be drawn in the place of a BirdsEyeView"),
              std::string::npos);
    EXPECT_TRUE(same(*render(scene), *flat));
    EXPECT_TRUE(own.setReplacement(*bend, nullptr));
    own.setRole(CameraRole::undeformed());
    EXPECT_TRUE(same(*render(scene), *straight));
    own.clearRole();
    EXPECT_TRUE(same(*render(scene), *bent));
    // The scene's callback comes after the camera's own word.
    own.setRole(CameraRole::undeformed());
    scene->setRoleCallback(new Role(CameraRole::view()));
    EXPECT_TRUE(same(*render(scene), *bent));
}
