// SPDX-License-Identifier: MIT
// SPDX-FileCopyrightText: 2026 the osgGeoFX authors
//
// What a program may do to the kit without knowing better: it is drawn right all the same, or one sentence says what to do.
#include <osgGeoFX/deformation/BlendedView.h>
#include <osgGeoFX/deformation/PedestrianView.h>
#include <osgGeoFX/deformation/VerticalExaggeration.h>
#include <osgGeoFX/panorama/PanoramaMap.h>
#include <osgGeoFX/scene/EffectScene.h>
#include <tools/CullHarness.h>
#include <tools/GlFixture.h>
#include <tools/HeightMesh.h>
#include <tools/ImageComparison.h>
#include <tools/PixelsApart.h>

#include <osg/CoordinateSystemNode>
#include <osg/MatrixTransform>
#include <osg/PagedLOD>

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

} // namespace
