// SPDX-License-Identifier: MIT
// SPDX-FileCopyrightText: 2026 the osgGeoFX authors
//
// What a program may do to the kit without knowing better: it is drawn right all the same, or one sentence says what to do.
#include <osgGeoFX/deformation/BlendedView.h>
#include <osgGeoFX/deformation/PedestrianView.h>
#include <osgGeoFX/deformation/VerticalExaggeration.h>
#include <osgGeoFX/effect/RigidParts.h>
#include <osgGeoFX/panorama/PanoramaMap.h>
#include <osgGeoFX/scene/CameraEffects.h>
#include <osgGeoFX/scene/EffectCullCallback.h>
#include <osgGeoFX/scene/EffectScene.h>
#include <tools/CullHarness.h>
#include <tools/GlFixture.h>
#include <tools/HeightMesh.h>
#include <tools/ImageComparison.h>
#include <tools/PixelsApart.h>

#include <osg/CoordinateSystemNode>
#include <osg/MatrixTransform>
#include <osg/PagedLOD>
#include <osg/Texture2D>

#include <cmath>
#include <functional>
#include <string>
#include <vector>

using namespace osgGeoFX;
using namespace geofx::test;

namespace
{

constexpr int WIDTH = 160, HEIGHT = 120;

/// Hills of 6 × 6 km around the origin of a plane, in many colors.
osg::ref_ptr<osg::Geometry> makeGround()
{
    const osg::ref_ptr<osg::Geometry> ground =
        makeMesh(60,
                 [](double east, double north)
                 {
                     const double x = 6000.0 * (east - 0.5), y = 6000.0 * (north - 0.5);
                     return osg::Vec3d(x, y, 60.0 * std::sin(x / 300.0) * std::cos(y / 400.0));
                 });
    const osg::ref_ptr<osg::Vec4Array> colors = new osg::Vec4Array(osg::Array::BIND_PER_VERTEX);
    for (const osg::Vec3& vertex : static_cast<const osg::Vec3Array&>(*ground->getVertexArray()))
        colors->push_back({0.5f + 0.5f * std::sin(vertex.x() / 250.0f),
                           0.5f + 0.5f * std::sin(vertex.y() / 250.0f), 0.5f + vertex.z() / 150.0f, 1.0f});
    ground->setColorArray(colors);
    ground->getOrCreateStateSet()->setMode(GL_LIGHTING, osg::StateAttribute::OFF);
    return ground;
}

class Misuse : public GlFixture
{
protected:
    Misuse() : GlFixture(WIDTH, HEIGHT) {}
    void SetUp() override
    {
        GlFixture::SetUp();
        if (IsSkipped() || HasFatalFailure()) return;
        osg::EllipsoidModel().computeLocalToWorldTransformFromLatLongHeight(
            osg::DegreesToRadians(-33.0), osg::DegreesToRadians(151.0), 0.0, place);
    }

    /// Hills on a globe in the south, where a plane's heights z are below the ground.
    osg::ref_ptr<osg::Node> makeGlobeHills() const
    {
        const osg::ref_ptr<osg::MatrixTransform> tile = new osg::MatrixTransform(place);
        tile->addChild(makeGround());
        return tile;
    }
    static osg::ref_ptr<osg::CoordinateSystemNode> makeSystem()
    {
        const osg::ref_ptr<osg::CoordinateSystemNode> system = new osg::CoordinateSystemNode;
        system->setEllipsoidModel(new osg::EllipsoidModel);
        return system;
    }
    osg::ref_ptr<osg::Image> draw(osg::Node* root, int frames = 1)
    {
        CullHarness harness(context(), root, WIDTH, HEIGHT);
        harness.camera().setClearColor({0.0f, 0.0f, 0.0f, 1.0f});
        Culled last;
        for (int frame = 0; frame < frames; ++frame)
        {
            harness.setCamera(view(), osg::Matrixd::perspective(50.0, 4.0 / 3.0, 10.0, 20000.0));
            last = harness.frame(true);
        }
        return last.image;
    }
    /// Of a plane, with one effect or none.
    osg::ref_ptr<osg::Image> drawFlat(Effect* effect, osg::Node* ground, const osg::Matrixd& projection,
                                      bool computesNearFar = false)
    {
        const osg::ref_ptr<EffectScene> scene = new EffectScene;
        if (effect) scene->addEffect(effect);
        scene->addChild(ground);
        CullHarness harness(context(), scene, WIDTH, HEIGHT);
        harness.camera().setClearColor({0.0f, 0.0f, 0.0f, 1.0f});
        harness.camera().setComputeNearFarMode(
            computesNearFar ? osg::CullSettings::COMPUTE_NEAR_FAR_USING_BOUNDING_VOLUMES
                            : osg::CullSettings::DO_NOT_COMPUTE_NEAR_FAR);
        harness.setCamera(osg::Matrixd::lookAt(osg::Vec3d(0.0, -1800.0, 1500.0), osg::Vec3d(0.0, -200.0, 0.0),
                                               osg::Vec3d(0.0, 0.0, 1.0)),
                          projection);
        return harness.frame(true).image;
    }
    osg::ref_ptr<osg::Image> drawPlane(osg::Node* root, int frames)
    {
        CullHarness harness(context(), root, WIDTH, HEIGHT);
        Culled last;
        for (int frame = 0; frame < frames; ++frame)
        {
            harness.setCamera(planeView(), osg::Matrixd::perspective(50.0, 4.0 / 3.0, 10.0, 20000.0));
            last = harness.frame(true);
        }
        return last.image;
    }
    static osg::Matrixd planeView()
    {
        return osg::Matrixd::lookAt(osg::Vec3d(0.0, -1800.0, 1500.0), osg::Vec3d(0.0, -200.0, 0.0),
                                    osg::Vec3d(0.0, 0.0, 1.0));
    }
    osg::Matrixd view() const
    {
        const osg::Vec3d eye = osg::Vec3d(0.0, -1800.0, 1500.0) * place;
        const osg::Vec3d center = osg::Vec3d(0.0, -200.0, 0.0) * place;
        return osg::Matrixd::lookAt(eye, center,
                                    osg::Matrixd::transform3x3(osg::Vec3d(0.0, 0.0, 1.0), place));
    }

    osg::Matrixd place;
};

TEST_F(Misuse, AGlobeIsBentWhereverItsCoordinateSystemIs)
{
    const osg::ref_ptr<osg::Node> hills = makeGlobeHills();
    struct Way
    {
        const char* name;
        std::function<osg::ref_ptr<osg::Node>(EffectScene&)> build; ///< what is drawn
    };
    const auto below = [&](EffectScene& scene, const std::vector<osg::ref_ptr<osg::Group>>& groups)
    {
        osg::ref_ptr<osg::Group> last = &scene;
        for (const osg::ref_ptr<osg::Group>& group : groups)
        {
            auto* levels = dynamic_cast<osg::LOD*>(last.get());
            if (levels)
                levels->addChild(group, 0.0f, 1e10f);
            else
                last->addChild(group);
            last = group;
        }
        last->addChild(hills);
        return osg::ref_ptr<osg::Node>(&scene);
    };
    std::vector<osg::ref_ptr<osg::Group>> many;
    for (int i = 0; i < 14; ++i)
        many.push_back(new osg::Group);
    many.push_back(makeSystem());
    const Way ways[] = {
        {"directly",
         [&](EffectScene& scene)
         {
             return below(scene, {makeSystem()});
         }},
        {"below levels of detail",
         [&](EffectScene& scene)
         {
             return below(scene, {new osg::LOD, makeSystem()});
         }},
        {"below a paged LOD",
         [&](EffectScene& scene)
         {
             return below(scene, {new osg::PagedLOD, makeSystem()});
         }},
        {"many levels down",
         [&](EffectScene& scene)
         {
             return below(scene, many);
         }},
        {"above the scene",
         [&](EffectScene& scene)
         {
             scene.addChild(hills);
             const osg::ref_ptr<osg::Group> system = makeSystem();
             system->addChild(&scene);
             return osg::ref_ptr<osg::Node>(system);
         }},
        {"nowhere",
         [&](EffectScene& scene)
         {
             return below(scene, {new osg::Group});
         }},
    };
    osg::ref_ptr<osg::Image> right;
    for (const Way& way : ways)
    {
        const osg::ref_ptr<EffectScene> scene = new EffectScene;
        scene->addEffect(new BirdsEyeView);
        const osg::ref_ptr<osg::Image> image = draw(way.build(*scene));
        if (!right)
        {
            right = image;
        }
        else if (std::string(way.name) == "nowhere")
        {
            EXPECT_GT(pixelsApart(*image, *right), WIDTH * HEIGHT / 10)
                << "a plane's bend should look otherwise";
        }
        else
        {
            EXPECT_TRUE(imagesMatch(*image, *right, {}, way.name)) << way.name;
        }
    }
}

/// The search of one frame takes a look at some dozens of nodes.
TEST_F(Misuse, AGlobeThatComesToALargeSceneIsBentInTheNextFrame)
{
    const osg::ref_ptr<osg::Group> system = makeSystem();
    system->addChild(makeGlobeHills());
    const osg::ref_ptr<osg::Group> crowd = new osg::Group;
    for (int i = 0; i < 20000; ++i)
        crowd->addChild(new osg::Group);
    const osg::ref_ptr<EffectScene> scene = new EffectScene, small = new EffectScene;
    scene->addEffect(new BirdsEyeView);
    scene->addChild(crowd);
    EXPECT_FALSE(scene->ground().ellipsoid);
    const osg::ref_ptr<osg::PagedLOD> paged = new osg::PagedLOD;
    scene->addChild(paged);
    paged->addChild(system, 0.0f, 1e10f);
    const osg::ref_ptr<osg::Image> image = draw(scene, 2);
    EXPECT_TRUE(scene->ground().ellipsoid);
    small->addEffect(new BirdsEyeView);
    small->addChild(system);
    EXPECT_TRUE(imagesMatch(*image, *draw(small)));
}

/// The far plane of the kit's pictures is what lies farthest; a program may have none.
TEST_F(Misuse, WithoutAFarPlaneEffectsAreThoseWithOne)
{
    const osg::ref_ptr<osg::Geometry> ground = makeGround();
    const double nearest = 10.0;
    osg::Matrixd endless = osg::Matrixd::perspective(50.0, 4.0 / 3.0, nearest, 1e7), beyond = endless;
    endless(2, 2) = -1.0;
    endless(3, 2) = -2.0 * nearest;
    beyond(2, 2) = -1.0 + 2.4e-7;
    beyond(3, 2) = (2.4e-7 - 2.0) * nearest;
    const osg::ref_ptr<osg::Image> plain =
        drawFlat(nullptr, ground, osg::Matrixd::perspective(50.0, 4.0 / 3.0, nearest, 1e7));
    const osg::ref_ptr<PedestrianView> pedestrian = new PedestrianView;
    pedestrian->setFocusDistance(1000.0);
    pedestrian->setBendAngle(0.5);
    for (const osg::ref_ptr<Effect>& effect : std::vector<osg::ref_ptr<Effect>>{
             new BirdsEyeView, pedestrian, new BlendedView, new PanoramaMap, new VerticalExaggeration})
    {
        for (const bool computes : {false, true})
        {
            SCOPED_TRACE(std::string(effect->className()) + (computes ? ", near and far computed" : ""));
            const osg::ref_ptr<osg::Image> right =
                drawFlat(effect, ground, osg::Matrixd::perspective(50.0, 4.0 / 3.0, nearest, 1e7), computes);
            if (effect->asDeformation()->isProjection())
            {
                EXPECT_GT(pixelsApart(*right, *plain), WIDTH * HEIGHT / 20) << "it is to do something";
            }
            for (const osg::Matrixd& each : {endless, beyond})
                EXPECT_LT(pixelsApart(*drawFlat(effect, ground, each, computes), *right), 10);
        }
    }
}

/// Something that a program may do: what is drawn, with and without the mistake, and what is told of it.
struct Mistake
{
    const char* told;
    std::function<osg::ref_ptr<osg::Node>(bool wrong)> root;
};

osg::ref_ptr<EffectScene> sceneOf(const osg::ref_ptr<Effect>& effect, const osg::ref_ptr<osg::Node>& child)
{
    osg::ref_ptr<EffectScene> scene = new EffectScene;
    if (effect) scene->addEffect(effect);
    if (child) scene->addChild(child);
    return scene;
}

osg::ref_ptr<osg::Group> above(osg::Group* group, const osg::ref_ptr<osg::Node>& child)
{
    const osg::ref_ptr<osg::Group> result = group;
    if (auto* levels = dynamic_cast<osg::LOD*>(group))
        levels->addChild(child, 0.0f, 1e10f);
    else
        result->addChild(child);
    return result;
}

osg::ref_ptr<osg::Group> terrainWith(EffectScene* scene)
{
    const osg::ref_ptr<osg::Group> terrain = new osg::Group;
    terrain->addChild(makeGround());
    terrain->setCullingActive(false);
    terrain->setCullCallback(new EffectCullCallback(scene));
    return terrain;
}

TEST_F(Misuse, EachIsToldInOneSentenceOnce)
{
    const auto bend = []
    {
        osg::ref_ptr<BirdsEyeView> effect = new BirdsEyeView;
        effect->setTallest(0.0);
        return effect;
    };
    const std::vector<Mistake> mistakes = {
        {"a transform above the scene, or the camera's view matrix, scales",
         [&](bool wrong) -> osg::ref_ptr<osg::Node>
         {
             const osg::Matrixd scale = osg::Matrixd::scale(0.5, 0.5, 0.5);
             if (wrong) return above(new osg::MatrixTransform(scale), sceneOf(bend(), makeGround()));
             return above(new osg::MatrixTransform(osg::Matrixd::rotate(0.1, osg::Z_AXIS)),
                          sceneOf(bend(), above(new osg::MatrixTransform(scale), makeGround())));
         }},
        {"the scene stands below the node LOD \"levels\"",
         [&](bool wrong) -> osg::ref_ptr<osg::Node>
         {
             osg::LOD* const levels = new osg::LOD;
             levels->setName("levels");
             if (wrong) return above(levels, sceneOf(bend(), makeGround()));
             return sceneOf(bend(), above(levels, makeGround()));
         }},
        {"the terrain has geocentric coordinates",
         [&](bool wrong) -> osg::ref_ptr<osg::Node>
         {
             const osg::ref_ptr<EffectScene> scene = sceneOf(bend(), makeGlobeHills());
             if (!wrong) scene->setTerrainFrame(EffectScene::GEOCENTRIC);
             return scene;
         }},
        {"a scene with effects stands below another one",
         [&](bool wrong) -> osg::ref_ptr<osg::Node>
         {
             // One without effects is a group.
             return sceneOf(bend(), sceneOf(wrong ? bend() : nullptr, makeGround()));
         }},
        {"one EffectScene draws two terrains",
         [&](bool wrong) -> osg::ref_ptr<osg::Node>
         {
             const osg::ref_ptr<EffectScene> scene = sceneOf(bend(), nullptr),
                                             other = sceneOf(bend(), nullptr);
             const osg::ref_ptr<osg::Group> both = new osg::Group;
             both->addChild(terrainWith(scene));
             both->addChild(terrainWith(wrong ? scene : other));
             return both;
         }},
        {"the callback's scene has children",
         [&](bool wrong) -> osg::ref_ptr<osg::Node>
         {
             return terrainWith(sceneOf(bend(), wrong ? new osg::Group : nullptr));
         }},
        {"nothing that is drawn has a texture on unit 1",
         [&](bool wrong) -> osg::ref_ptr<osg::Node>
         {
             const osg::ref_ptr<BirdsEyeView> effect = bend();
             effect->setMapUnit(1);
             const osg::ref_ptr<osg::Group> all = new osg::Group;
             all->addChild(makeGround());
             all->addChild(makeGround());
             const osg::ref_ptr<osg::Image> map = new osg::Image;
             map->allocateImage(1, 1, 1, GL_RGBA, GL_UNSIGNED_BYTE);
             const osg::ref_ptr<osg::Texture2D> texture = new osg::Texture2D(map);
             // What a database's tiles have there for shaders is no map.
             if (wrong) texture->setName("geofx classes");
             // Some may be without.
             all->getChild(1)->getOrCreateStateSet()->setTextureAttributeAndModes(1, texture);
             return sceneOf(effect, all);
         }},
        {"GEOFX_RIGID is in force",
         [&](bool wrong) -> osg::ref_ptr<osg::Node>
         {
             const osg::ref_ptr<osg::Geometry> ground = makeGround();
             ground->getOrCreateStateSet()->setDefine(RigidParts::define);
             const auto& vertices = static_cast<const osg::Vec3Array&>(*ground->getVertexArray());
             if (!wrong) RigidParts::finish(*ground, {vertices.begin(), vertices.end()});
             return sceneOf(bend(), ground);
         }},
    };
    for (const Mistake& mistake : mistakes)
    {
        SCOPED_TRACE(mistake.told);
        const bool globe = std::string(mistake.told).find("geocentric") != std::string::npos;
        for (const bool wrong : {true, false})
        {
            const osg::ref_ptr<osg::Node> root = mistake.root(wrong);
            const std::vector<std::string> said = watch().messagesOf(
                [&]
                {
                    // Again and again, and again for another camera.
                    for (int camera = 0; camera < 2; ++camera)
                    {
                        // Tiles that are still to come might mend it.
                        if (globe)
                            draw(root, 32);
                        else
                            drawPlane(root, 32);
                    }
                });
            if (!wrong)
            {
                EXPECT_EQ(said, std::vector<std::string>());
                continue;
            }
            ASSERT_EQ(said.size(), 1u) << ::testing::PrintToString(said);
            EXPECT_NE(said[0].find(mistake.told), std::string::npos) << said[0];
            EXPECT_EQ(said[0].find("osgGeoFX: "), std::string("OSG: ").size()) << said[0];
        }
    }
}

TEST_F(Misuse, ACamerasOwnWordsForAnEffectOfNoSceneAreTold)
{
    const osg::ref_ptr<BirdsEyeView> bend = new BirdsEyeView, copy = new BirdsEyeView;
    const osg::ref_ptr<EffectScene> scene = sceneOf(bend, makeGround());
    for (const bool wrong : {true, false})
    {
        CullHarness harness(context(), scene, WIDTH, HEIGHT);
        CameraEffects::of(harness.camera()).setEnabled(wrong ? *copy : *bend, false);
        const std::vector<std::string> said = watch().messagesOf(
            [&]
            {
                for (int frame = 0; frame < 3; ++frame)
                {
                    harness.setCamera(planeView(), osg::Matrixd::perspective(50.0, 4.0 / 3.0, 10.0, 20000.0));
                    harness.frame(true);
                }
            });
        ASSERT_EQ(said.size(), wrong ? 1u : 0u) << ::testing::PrintToString(said);
        if (wrong)
        {
            EXPECT_NE(said[0].find("CameraEffects are for a BirdsEyeView that is in no scene"),
                      std::string::npos)
                << said[0];
        }
    }
    // Nor has a scene one that it has given up, or that a scene had which is gone.
    const auto told = [&](osg::Node& root)
    {
        CullHarness harness(context(), &root, WIDTH, HEIGHT);
        CameraEffects::of(harness.camera()).setEnabled(*bend, false);
        return watch().messagesOf(
            [&]
            {
                harness.setCamera(planeView(), osg::Matrixd::perspective(50.0, 4.0 / 3.0, 10.0, 20000.0));
                harness.frame(true);
            });
    };
    const osg::ref_ptr<EffectScene> other = sceneOf(copy, makeGround());
    osg::ref_ptr<EffectScene> second = new EffectScene(*scene);
    scene->removeEffect(bend);
    EXPECT_EQ(told(*other).size(), 0u) << "the copy of the scene has it";
    second = nullptr;
    EXPECT_EQ(told(*other).size(), 1u);
}

// The shore of the Dead Sea lies 400 m below the ellipsoid.
TEST_F(Misuse, ABirdsEyeViewBendsOnBelowZero)
{
    const auto drawLow = [&](bool stated, Effect* effect)
    {
        const osg::ref_ptr<osg::MatrixTransform> low =
            new osg::MatrixTransform(osg::Matrixd::translate(0.0, 0.0, -2000.0));
        low->addChild(makeGround());
        const osg::ref_ptr<EffectScene> scene = sceneOf(effect, low);
        EffectScene::GroundDescription ground;
        ground.minHeight = -2060.0;
        ground.maxHeight = -1940.0;
        if (stated) scene->setGround(ground);
        CullHarness harness(context(), scene, WIDTH, HEIGHT);
        harness.camera().setClearColor({0.0f, 0.0f, 0.0f, 1.0f});
        osg::ref_ptr<osg::Image> image;
        for (int frame = 0; frame < 3; ++frame)
        {
            // 500 m below zero, and as high above the ground as elsewhere.
            harness.setCamera(osg::Matrixd::translate(0.0, 0.0, 2000.0) * planeView(),
                              osg::Matrixd::perspective(50.0, 4.0 / 3.0, 10.0, 20000.0));
            image = harness.frame(true).image;
        }
        return image;
    };
    const osg::ref_ptr<BirdsEyeView> bend = new BirdsEyeView;
    bend->setTallest(0.0);
    const osg::ref_ptr<osg::Image> plain = drawLow(true, nullptr);
    EXPECT_GT(pixelsApart(*drawLow(true, bend), *plain), WIDTH * HEIGHT / 20);
    osg::ref_ptr<osg::Image> unknown;
    const std::vector<std::string> said = watch().messagesOf([&] { unknown = drawLow(false, bend); });
    EXPECT_LT(pixelsApart(*unknown, *plain), 10);
    ASSERT_EQ(said.size(), 1u);
    EXPECT_NE(said[0].find("a BirdsEyeView bends nothing while the eye is below its reference plane"),
              std::string::npos)
        << said[0];
}

} // namespace
