// SPDX-License-Identifier: MIT
// SPDX-FileCopyrightText: 2026 the osgGeoFX authors
//
// Picking of close-ups against what the GPU drew: close-ups in a grey of their own each, which says whose a pixel is, and the
// place of the ground projected again.
#include <tools/CloseUpStage.h>
#include <tools/CullHarness.h>
#include <tools/PagedScene.h>
#include <tools/TempDir.h>

#include <osg/LOD>
#include <osg/MatrixTransform>
#include <osgGeoFX/closeup/CloseUpPicking.h>
#include <osgGeoFX/deformation/VerticalExaggeration.h>
#include <osgGeoFX/scene/DeformedView.h>
#include <osgGeoFX/scene/RigidReference.h>
#include <osgGeoFX/viewer/Scene.h>

#include <cmath>

using namespace osgGeoFX;
using namespace geofx::test;

namespace
{

constexpr int overview = -1, mixed = -2;

/// Contrast 0 leaves middle grey, to which brightness is added.
int greyOf(int number)
{
    return 40 + 20 * number;
}

void paint(CloseUp& closeUp, int number)
{
    closeUp.setSurface("");
    closeUp.setLighting(CloseUp::AS_SCENE);
    closeUp.setSaturation(1.0);
    closeUp.setContrast(0.0);
    closeUp.setBrightness(greyOf(number) / 255.0 - 0.5);
    closeUp.setOpacity(1.0);
    closeUp.setActivity(CloseUp::ACTIVE);
    closeUp.getAnchor()->setKind(Anchor::NONE);
    closeUp.getAnchor()->setLineWidth(0.0);
    closeUp.getRegion()->setSoftness(0.0);
}

int ownerAt(const osg::Image& image, int x, int y)
{
    const unsigned char* pixel = image.data(static_cast<unsigned int>(x), static_cast<unsigned int>(y));
    if (std::abs(pixel[0] - pixel[1]) > 1 || std::abs(pixel[0] - pixel[2]) > 1) return overview;
    const int number = (pixel[0] - greyOf(0) + 10) / 20;
    return std::abs(pixel[0] - greyOf(number)) <= 1 ? number : overview;
}

/// Whose a pixel and its neighbours are; mixed where they are several ones', or at the picture's border.
int innerOwner(const osg::Image& image, int x, int y)
{
    if (x < 1 || y < 1 || x + 1 >= image.s() || y + 1 >= image.t()) return mixed;
    const int owner = ownerAt(image, x, y);
    for (int dy = -1; dy <= 1; ++dy)
    {
        for (int dx = -1; dx <= 1; ++dx)
        {
            if (ownerAt(image, x + dx, y + dy) != owner) return mixed;
        }
    }
    return owner;
}

struct Tally
{
    int closeUps = 0, regions = 0, others = 0, wrong = 0;
    int cut = 0;        ///< of close-ups, by borders of triangles
    double worst = 0.0; ///< pixels
};

/// Picks at pixels of a picture; `whole` is off where borders are those of triangles, which may lie further inside.
void check(EffectScene& scene, CloseUps& closeUps, const osg::Camera& camera, const osg::Image& image,
           Random& random, int pixels, Tally& tally, bool whole = true)
{
    const DeformedView view(scene, camera);
    const osg::Vec3d nearest =
        osg::Vec3d(0.0, 0.0, -1.0) * osg::Matrixd::inverse(camera.getProjectionMatrix());
    for (int i = 0; i < pixels; ++i)
    {
        const int x = random.integer(0, image.s() - 1);
        const int y = random.integer(0, image.t() - 1);
        const int owner = innerOwner(image, x, y);
        const osg::Vec2d pixel(x + 0.5, y + 0.5);
        const std::optional<CloseUpHit> hit = pickCloseUp(scene, closeUps, camera, pixel.x(), pixel.y());
        SCOPED_TRACE("pixel " + std::to_string(x) + ' ' + std::to_string(y));
        if (!hit)
        {
            if (owner >= 0) ++tally.wrong;
            ++tally.others;
            continue;
        }
        // What the near plane cuts away is beside the matter.
        if ((hit->drawn * view.modelView()).z() > nearest.z()) continue;
        const osg::Vec3d drawn = hit->drawn * view.modelView() * camera.getProjectionMatrix();
        osg::Vec2d again((drawn.x() + 1.0) / 2.0 * image.s(), (drawn.y() + 1.0) / 2.0 * image.t());
        EXPECT_LT((again - pixel).length(), 0.01);
        if (hit->onRegion)
        {
            ++tally.regions;
            if (owner >= 0) ++tally.wrong;
        }
        else
        {
            const std::optional<osg::Vec2d> found = projectCloseUp(scene, *hit->closeUp, camera, hit->world);
            ASSERT_TRUE(found);
            again = *found;
            ++tally.closeUps;
            const bool right =
                owner == mixed ||
                (owner >= 0 && closeUps.getCloseUp(static_cast<unsigned>(owner)) == hit->closeUp);
            if (!right && owner == overview && !whole)
            {
                ++tally.cut;
                continue;
            }
            if (!right) ++tally.wrong;
        }
        const double off = (again - pixel).length();
        tally.worst = std::max(tally.worst, off);
        EXPECT_LT(off, 0.5);
        const osg::Matrixd toRegion = hit->closeUp->getRegion()->worldToRegion(scene.ground().ellipsoid);
        const osg::Vec3d place = hit->world * toRegion;
        EXPECT_NEAR(place.x(), hit->place.x(), 1e-5);
        EXPECT_NEAR(place.y(), hit->place.y(), 1e-5);
        EXPECT_GT(hit->closeUp->getRegion()->maskAt(hit->place).y(), 0.0);
    }
}

void tell(const Tally& tally)
{
    std::cout << tally.closeUps << " on close-ups, " << tally.regions << " on regions, " << tally.others
              << " beside, " << tally.wrong << " wrong, " << tally.cut << " cut, worst " << tally.worst
              << " pixels\n";
}

/// A square; `width` metres to the east of `west`.
osg::ref_ptr<osg::Geometry> square(double west, double width, double height)
{
    osg::ref_ptr<osg::Geometry> result = osg::createTexturedQuadGeometry(
        osg::Vec3d(west, -1000.0, height), osg::Vec3d(width, 0.0, 0.0), osg::Vec3d(0.0, 2000.0, 0.0));
    osg::ref_ptr<osg::Vec4Array> colors = new osg::Vec4Array(1);
    (*colors)[0].set(0.9f, 0.5f, 0.2f, 1.0f);
    result->setColorArray(colors, osg::Array::BIND_OVERALL);
    return result;
}

class CloseUpPicking : public CloseUpStage
{
protected:
    void SetUp() override
    {
        CloseUpStage::SetUp();
        if (IsSkipped() || HasFatalFailure()) return;
        _high->setEnabled(false);
        _bend->setEnabled(false);
        _scene->addEffect(_high);
        _scene->addEffect(_bend);
        _root->getOrCreateStateSet()->setMode(GL_LIGHTING, osg::StateAttribute::OFF);
    }

    void randomSetUp(Random& random, const CloseUpPlan& plan, CloseUp::Edge edge)
    {
        _closeUps->removeCloseUps();
        for (int number = random.integer(1, 6) - 1; number >= 0; --number)
            _closeUps->addCloseUp(randomCloseUp(random, plan));
        for (unsigned int i = 0; i < _closeUps->getNumCloseUps(); ++i)
        {
            paint(*_closeUps->getCloseUp(i), static_cast<int>(i));
            _closeUps->getCloseUp(i)->setEdge(edge);
        }
        _closeUps->setDepthTest(random.integer(0, 2) > 0);
        _closeUps->setTessellation(random.integer(0, 1) ? 16 : 1);
        _closeUps->setPipeline(random.integer(0, 1) ? CloseUps::SINGLE_PASS : CloseUps::MULTI_PASS);
        _high->setEnabled(random.integer(0, 3) == 0);
        _high->setFactor(random.uniform(0.5, 2.0));
        _bend->setEnabled(random.integer(0, 1) == 0);
        _bend->setHorizonLine(random.uniform(0.7, 0.95));
        _bend->setFocusLine(random.uniform(0.1, 0.5));
        lookAnyhow(random);
    }

    Tally anySetUps(const CloseUpPlan& plan, const osg::Matrixd& placement, int first,
                    CloseUp::Edge edge = CloseUp::FRAGMENTS)
    {
        Tally tally;
        const int count = fullTest() ? 200 : 24;
        for (int i = 0; i < count; ++i)
        {
            SCOPED_TRACE("set-up " + std::to_string(i));
            Random random(static_cast<std::uint64_t>(first + i));
            randomSetUp(random, plan, edge);
            osg::Camera& camera = *viewer().getCamera();
            camera.setViewMatrix(osg::Matrixd::inverse(placement) * camera.getViewMatrix());
            const osg::ref_ptr<osg::Image> image = draw();
            check(*_scene, *_closeUps, camera, *image, random, 60, tally, edge == CloseUp::FRAGMENTS);
        }
        tell(tally);
        return tally;
    }

    osg::ref_ptr<VerticalExaggeration> _high = new VerticalExaggeration;
    osg::ref_ptr<BirdsEyeView> _bend = new BirdsEyeView;
};

void expectGood(const Tally& tally)
{
    const int all = tally.closeUps + tally.regions + tally.others;
    // Here and there, a crest hides what it hides by less than a pixel.
    EXPECT_LE(tally.wrong, 1 + all / 2000);
    EXPECT_LE(tally.cut, tally.closeUps / 50);
    EXPECT_GT(tally.closeUps, all / 8);
    EXPECT_GT(tally.regions, all / 100);
}

} // namespace

TEST_F(CloseUpPicking, AnySetUp)
{
    osg::ref_ptr<RigidReference> rigid = new RigidReference;
    rigid->setUseBoundCenter(true);
    rigid->addChild(makeHouses());
    _scene->addChild(rigid);
    expectGood(anySetUps(CloseUpPlan(), osg::Matrixd(), 0));
}

TEST_F(CloseUpPicking, EdgesOfTriangles)
{
    expectGood(anySetUps(CloseUpPlan(), osg::Matrixd(), 1000, CloseUp::PRIMITIVES));
}

TEST_F(CloseUpPicking, OnAGlobe)
{
    const osg::Matrixd placement = PagedScene::placement(PagedScene::Kind::Geocentric);
    CloseUpPlan plan;
    plan.globe = true;
    plan.center.set(osg::DegreesToRadians(-157.8), osg::DegreesToRadians(21.4));
    _scene->setTerrainFrame(EffectScene::GEOCENTRIC);
    osg::ref_ptr<osg::MatrixTransform> ground = new osg::MatrixTransform(placement);
    ground->addChild(_scene->getChild(0));
    _scene->removeChildren(0, 1);
    _scene->addChild(ground);
    expectGood(anySetUps(plan, placement, 2000));
}

TEST_F(CloseUpPicking, FlatMapsTellTheirGround)
{
    const osg::ref_ptr<CloseUp> closeUp = makeCloseUp({100.0, -50.0}, 500.0, 500.0);
    closeUp->setScale(2.0, 2.0, 0.0);
    paint(*closeUp, 0);
    _closeUps->addCloseUp(closeUp);
    for (const CloseUp::Orientation orientation : {CloseUp::SCENE, CloseUp::FIXED, CloseUp::BILLBOARD})
    {
        closeUp->setOrientation(orientation);
        closeUp->setTilt(orientation == CloseUp::SCENE ? 0.3 : 0.0);
        Random random(7);
        Tally tally;
        const osg::Camera& camera = *viewer().getCamera();
        const osg::ref_ptr<osg::Image> image = draw();
        check(*_scene, *_closeUps, camera, *image, random, 200, tally);
        EXPECT_EQ(tally.wrong, 0);
        EXPECT_GT(tally.closeUps, 10);
        // Not at any height, but at the ground's.
        for (int i = 0; i < 200; ++i)
        {
            const auto hit = pickCloseUp(*_scene, *_closeUps, camera, random.uniform(0.0, _width),
                                         random.uniform(0.0, _height));
            if (hit)
            {
                EXPECT_NEAR(hit->world.z(), groundHeight(hit->world.x(), hit->world.y()), 6.0);
            }
        }
    }
}

TEST_F(CloseUpPicking, LevelsOfDetailAreThoseThatAreDrawn)
{
    // Near by, there is the western half only.
    osg::ref_ptr<osg::LOD> levels = new osg::LOD;
    levels->addChild(square(-1000.0, 2000.0, 0.0), 1500.0f, 1e9f);
    levels->addChild(square(-1000.0, 1000.0, 0.0), 0.0f, 1500.0f);
    _scene->removeChildren(0, _scene->getNumChildren());
    _scene->addChild(levels);
    const osg::ref_ptr<CloseUp> closeUp = makeCloseUp({0.0, 0.0}, 700.0, 400.0);
    closeUp->setScale(1.2, 1.2, 1.2);
    paint(*closeUp, 0);
    _closeUps->addCloseUp(closeUp);
    Tally tally;
    int least = 1000, most = 0;
    for (int i = 0; i < 12; ++i)
    {
        Random random(static_cast<std::uint64_t>(i));
        _closeUps->setPipeline(i % 2 ? CloseUps::SINGLE_PASS : CloseUps::MULTI_PASS);
        const double distance = 1200.0 + 80.0 * i;
        look({100.0, -0.8 * distance, 0.7 * distance}, {0.0, 0.0, 200.0}, 40.0);
        const int before = tally.closeUps;
        const osg::ref_ptr<osg::Image> image = draw();
        check(*_scene, *_closeUps, *viewer().getCamera(), *image, random, 100, tally);
        least = std::min(least, tally.closeUps - before);
        most = std::max(most, tally.closeUps - before);
    }
    tell(tally);
    EXPECT_EQ(tally.wrong, 0);
    EXPECT_GT(most, least + 10) << "both levels";
}

TEST_F(CloseUpPicking, PagedScenes)
{
    for (const PagedScene::Kind kind : {PagedScene::Kind::Flat, PagedScene::Kind::Geocentric})
    {
        const TempDir folder;
        std::string error;
        const std::optional<Scene> scene =
            Scene::load(PagedScene::write(folder.path(), kind).string(), error);
        ASSERT_TRUE(scene) << error;
        const osg::ref_ptr<CloseUps> closeUps = new CloseUps;
        scene->effects->addEffect(closeUps);
        CloseUpPlan plan;
        plan.globe = kind == PagedScene::Kind::Geocentric;
        if (plan.globe) plan.center.set(osg::DegreesToRadians(-157.8), osg::DegreesToRadians(21.4));
        CullHarness harness(context(), scene->effects, _width, _height);
        Tally tally;
        for (int i = 0; i < 10; ++i)
        {
            Random random(static_cast<std::uint64_t>(i));
            closeUps->removeCloseUps();
            for (int number = 0; number < 4; ++number)
            {
                const osg::ref_ptr<CloseUp> closeUp = randomCloseUp(random, plan);
                paint(*closeUp, number);
                closeUp->setEdge(CloseUp::FRAGMENTS);
                closeUp->getRegion()->setBaseHeight(plan.globe ? 100.0 : 0.0);
                closeUps->addCloseUp(closeUp);
            }
            lookAnyhow(random);
            const osg::Camera& camera = *viewer().getCamera();
            const osg::Matrixd view =
                osg::Matrixd::inverse(PagedScene::placement(kind)) * camera.getViewMatrix();
            harness.setCamera(view, camera.getProjectionMatrix());
            for (int step = 0; step < 4; ++step)
                CullHarness::load(harness.frame(true, false).requests, random, 0.7);
            const Culled culled = harness.frame(true);
            check(*scene->effects, *closeUps, harness.camera(), *culled.image, random, 60, tally);
        }
        tell(tally);
        expectGood(tally);
    }
}

TEST_F(CloseUpPicking, WhatIsNotDrawnIsNotPicked)
{
    const osg::ref_ptr<CloseUp> closeUp = makeCloseUp({0.0, 0.0}, 400.0, 400.0);
    _closeUps->addCloseUp(closeUp);
    const osg::Camera& camera = *viewer().getCamera();
    const auto onCloseUp = projectCloseUp(*_scene, *closeUp, camera, {0.0, 0.0, groundHeight(0.0, 0.0)});
    ASSERT_TRUE(onCloseUp);
    osg::Vec2d onRegion;
    ASSERT_TRUE(DeformedView(*_scene, camera).project({0.0, -100.0, groundHeight(0.0, -100.0)}, onRegion));
    const auto at = [&](const osg::Vec2d& pixel)
    {
        const auto hit = pickCloseUp(*_scene, *_closeUps, camera, pixel.x(), pixel.y());
        return !hit ? ' ' : hit->onRegion ? 'r' : 'c';
    };
    EXPECT_EQ(at(*onCloseUp), 'c');
    EXPECT_EQ(at(onRegion), 'r');
    for (const CloseUp::Activity activity : {CloseUp::NO_ANCHOR, CloseUp::DESATURATED, CloseUp::REGION_ONLY})
    {
        closeUp->setActivity(activity);
        EXPECT_EQ(at(*onCloseUp), activity == CloseUp::REGION_ONLY ? ' ' : 'c');
        EXPECT_EQ(at(onRegion), 'r');
    }
    closeUp->setActivity(CloseUp::ACTIVE);
    const auto none = [&]
    {
        return at(*onCloseUp) == ' ' && at(onRegion) == ' ';
    };
    closeUp->setEnabled(false);
    EXPECT_TRUE(none());
    closeUp->setEnabled(true);
    _closeUps->setEnabled(false);
    EXPECT_TRUE(none());
    _closeUps->setEnabled(true);
    _closeUps->setOpacity(0.0);
    EXPECT_TRUE(none());
    _closeUps->setOpacity(1.0);
    // A hill before it, or one that would be.
    closeUp->setOffset({0.0, 0.0, -300.0});
    const auto under = projectCloseUp(*_scene, *closeUp, camera, {0.0, 0.0, groundHeight(0.0, 0.0)});
    ASSERT_TRUE(under);
    EXPECT_NE(at(*under), 'c');
    _closeUps->setDepthTest(false);
    EXPECT_EQ(at(*under), 'c');
    // Behind the eye.
    closeUp->setOffset({3000.0, -10000.0, 5000.0});
    EXPECT_FALSE(projectCloseUp(*_scene, *closeUp, camera, {0.0, 0.0, 0.0}));
    EXPECT_FALSE(dragCloseUp(*_scene, *closeUp, camera, {3000.0, -10000.0, 5000.0}, 5.0, 5.0));
}

TEST_F(CloseUpPicking, WhatIsDraggedFollowsThePointer)
{
    int dragged = 0;
    for (int i = 0; i < 40; ++i)
    {
        SCOPED_TRACE("set-up " + std::to_string(i));
        Random random(static_cast<std::uint64_t>(3000 + i));
        randomSetUp(random, CloseUpPlan(), CloseUp::FRAGMENTS);
        const osg::Camera& camera = *viewer().getCamera();
        for (int tries = 0; tries < 20; ++tries)
        {
            const auto hit = pickCloseUp(*_scene, *_closeUps, camera, random.uniform(0.0, _width),
                                         random.uniform(0.0, _height));
            if (!hit || hit->onRegion) continue;
            const osg::Vec2d to(random.uniform(0.0, _width), random.uniform(0.0, _height));
            const auto shift = dragCloseUp(*_scene, *hit->closeUp, camera, hit->drawn, to.x(), to.y());
            ASSERT_TRUE(shift);
            hit->closeUp->setOffset(hit->closeUp->getOffset() + *shift);
            const auto now = projectCloseUp(*_scene, *hit->closeUp, camera, hit->world);
            ASSERT_TRUE(now);
            EXPECT_LT((*now - to).length(), 0.01);
            ++dragged;
            break;
        }
    }
    EXPECT_GT(dragged, 15);
}
