// SPDX-License-Identifier: MIT
// SPDX-FileCopyrightText: 2026 the osgGeoFX authors
//
// How much room culling leaves: for what is drawn beyond a drawable's own picture, for what bulges between the points that
// a bound is made of, and for what is stretched. Places and sizes are worked out here, point by point.
#include <tools/CullHarness.h>
#include <tools/GlFixture.h>

#include <osg/CullingSet>
#include <osg/Geometry>
#include <osg/LOD>
#include <osg/MatrixTransform>
#include <osgGeoFX/deformation/BirdsEyeView.h>
#include <osgGeoFX/deformation/PedestrianView.h>
#include <osgGeoFX/deformation/VerticalExaggeration.h>
#include <osgGeoFX/effect/DrawableCompanion.h>
#include <osgGeoFX/effect/PassEffect.h>
#include <osgGeoFX/scene/DeformedView.h>
#include <osgGeoFX/scene/EffectScene.h>

#include <algorithm>
#include <cmath>
#include <map>
#include <vector>

using namespace osgGeoFX;
using namespace geofx::test;

namespace
{

constexpr int WIDTH = 240, HEIGHT = 180;

class CullMargins : public GlFixture
{
protected:
    CullMargins() : GlFixture(WIDTH, HEIGHT) {}

    const osg::Matrixd _projection =
        osg::Matrixd::perspective(60.0, static_cast<double>(WIDTH) / HEIGHT, 1.0, 1e5);
};

osg::ref_ptr<osg::Geometry> makeSquare(const osg::Vec3d& middle, double half)
{
    osg::ref_ptr<osg::Geometry> geometry = new osg::Geometry;
    osg::ref_ptr<osg::Vec3Array> vertices = new osg::Vec3Array;
    for (const auto& [x, y] : {std::pair(-1, -1), std::pair(1, -1), std::pair(1, 1), std::pair(-1, 1)})
        vertices->push_back(middle + osg::Vec3d(x * half, y * half, 0.0));
    geometry->setVertexArray(vertices);
    geometry->addPrimitiveSet(new osg::DrawArrays(GL_TRIANGLE_FAN, 0, 4));
    return geometry;
}

/// Draws a geometry with each drawable, which is told to reach some pixels beyond it.
class Companions : public PassEffect, public DrawableCompanion
{
public:
    Companions() = default;
    explicit Companions(double reach) : _reach(reach) {}
    Companions(const Companions& other, const osg::CopyOp& copy)
        : PassEffect(other, copy), _reach(other._reach)
    {
    }
    META_Object(osgGeoFX, Companions);

    const Properties& properties() const override
    {
        static const Properties all = {enabledProperty()};
        return all;
    }
    void cull(const ScenePass&) override {}
    DrawableCompanion* companion(const ScenePass&) override { return this; }
    osg::Drawable* companion(osg::Drawable& drawable, const osg::Matrixd&) override
    {
        osg::ref_ptr<osg::Geometry>& made = _made[&drawable];
        if (!made) made = makeSquare(osg::Vec3d(), 1.0);
        return made;
    }
    osg::StateSet* state() override { return _state; }
    double reach() const override { return _reach; }

    const osg::Drawable* of(const osg::Drawable* drawable) const
    {
        const auto found = _made.find(drawable);
        return found == _made.end() ? nullptr : found->second.get();
    }

protected:
    ~Companions() override = default;

private:
    double _reach = 0.0;
    osg::ref_ptr<osg::StateSet> _state = new osg::StateSet;
    std::map<const osg::Drawable*, osg::ref_ptr<osg::Geometry>> _made;
};

/// Below nodes of different kinds, which are all culled.
osg::ref_ptr<osg::Node> wrapped(osg::Geometry* geometry, int kind)
{
    osg::ref_ptr<osg::Group> group;
    if (kind == 1) group = new osg::Group;
    if (kind == 2) group = new osg::MatrixTransform;
    if (kind == 3)
    {
        group = new osg::MatrixTransform;
        group->addChild(new osg::Group);
        group->getChild(0)->asGroup()->addChild(geometry);
        return group;
    }
    if (kind == 4)
    {
        osg::ref_ptr<osg::LOD> lod = new osg::LOD;
        lod->addChild(geometry, 0.0f, 1e9f);
        return lod;
    }
    if (!group) return geometry;
    group->addChild(geometry);
    return group;
}

/// A grid over a rectangle in space, whose points all move.
osg::ref_ptr<osg::Geometry> makeGrid(const osg::Vec3d& corner, const osg::Vec3d& along,
                                     const osg::Vec3d& across)
{
    constexpr int cells = 48;
    osg::ref_ptr<osg::Geometry> geometry = new osg::Geometry;
    osg::ref_ptr<osg::Vec3Array> vertices = new osg::Vec3Array;
    osg::ref_ptr<osg::DrawElementsUShort> triangles = new osg::DrawElementsUShort(GL_TRIANGLES);
    for (int row = 0; row <= cells; ++row)
    {
        for (int column = 0; column <= cells; ++column)
        {
            vertices->push_back(corner + along * (static_cast<double>(row) / cells) +
                                across * (static_cast<double>(column) / cells));
            if (row == cells || column == cells) continue;
            const int at = row * (cells + 1) + column;
            for (const int index : {at, at + 1, at + cells + 1, at + 1, at + cells + 2, at + cells + 1})
                triangles->push_back(static_cast<unsigned short>(index));
        }
    }
    geometry->setVertexArray(vertices);
    geometry->addPrimitiveSet(triangles);
    return geometry;
}

/// A bend of any kind before a camera, and a grid that reaches across its zone.
struct BentGrid
{
    BentGrid(Random& random, const osg::Matrixd& projection)
    {
        scene->setTerrainFrame(EffectScene::PROJECTED);
        osg::ref_ptr<PerspectiveBend> bend;
        const double eyeHeight = random.logarithmic(50.0, 3000.0);
        if (random.integer(0, 1))
        {
            const osg::ref_ptr<PedestrianView> pedestrian = new PedestrianView;
            pedestrian->setFocusDistance(eyeHeight * random.uniform(0.0, 2.0));
            pedestrian->setZoneWidth(eyeHeight * random.uniform(0.5, 4.0));
            pedestrian->setBendAngle(random.uniform(0.6, 1.57));
            bend = pedestrian;
        }
        else
        {
            const osg::ref_ptr<BirdsEyeView> bird = new BirdsEyeView;
            bird->setFocusLine(random.uniform(0.0, 0.3));
            bird->setHorizonLine(random.uniform(0.5, 0.9));
            bend = bird;
        }
        bend->setCurve(static_cast<PerspectiveBend::Curve>(random.integer(0, 2)));
        const double size = eyeHeight * random.uniform(1.0, 6.0);
        bend->setTallest(0.05 * size);
        scene->addEffect(bend);
        view = osg::Matrixd::lookAt(osg::Vec3d(0.0, 0.0, eyeHeight),
                                    osg::Vec3d(0.0, eyeHeight * random.uniform(0.5, 3.0), 0.0),
                                    osg::Vec3d(0.0, 0.0, 1.0));
        chain = scene->deformation(view, projection);
        const double turn = random.uniform(-0.5, 0.5);
        const osg::Vec3d along(std::sin(turn), std::cos(turn), random.uniform(-0.04, 0.04));
        const osg::Vec3d across(std::cos(turn), -std::sin(turn), 0.0);
        const osg::Vec3d corner(-0.3 * size, eyeHeight * random.uniform(0.0, 1.0), 0.0);
        grid = makeGrid(corner, along * size, across * (0.6 * size));
        scene->addChild(grid);
    }

    const osg::ref_ptr<EffectScene> scene = new EffectScene;
    osg::ref_ptr<osg::Geometry> grid;
    osg::Matrixd view;
    osg::ref_ptr<const DeformationChain> chain;
};

/// The points just within a bent grid that reach farthest in the picture to its four sides; before the eye.
std::vector<osg::Vec2d> tipsOf(const BentGrid& bent, const osg::Matrixd& projection)
{
    const auto& vertices = dynamic_cast<const osg::Vec3Array&>(*bent.grid->getVertexArray());
    std::vector<osg::Vec2d> places;
    for (const osg::Vec3& vertex : vertices)
    {
        const osg::Vec3d eye = bent.chain->deform(osg::Vec3d(vertex) * bent.view);
        const osg::Vec3d inPicture = eye * projection;
        const bool before = eye.z() < -0.1;
        places.emplace_back(before ? inPicture.x() : HUGE_VAL, before ? inPicture.y() : HUGE_VAL);
    }
    const osg::DrawElements& corners = *bent.grid->getPrimitiveSet(0)->getDrawElements();
    std::vector<osg::Vec2d> tips;
    for (const osg::Vec2d& direction :
         {osg::Vec2d(0, 1), osg::Vec2d(0, -1), osg::Vec2d(1, 0), osg::Vec2d(-1, 0)})
    {
        double most = -HUGE_VAL;
        osg::Vec2d target;
        for (unsigned int corner = 0; corner + 2 < corners.getNumIndices(); corner += 3)
        {
            const osg::Vec2d& a = places[corners.index(corner)];
            const osg::Vec2d& b = places[corners.index(corner + 1)];
            const osg::Vec2d& c = places[corners.index(corner + 2)];
            if (!std::isfinite(a.x() + b.x() + c.x())) continue;
            for (const osg::Vec2d& tip : {a, b, c})
            {
                const osg::Vec2d at = tip * 0.98 + (a + b + c) * (0.02 / 3.0);
                if (at * direction <= most) continue;
                most = at * direction;
                target = at;
            }
        }
        if (most > -HUGE_VAL) tips.push_back(target);
    }
    return tips;
}

TEST_F(CullMargins, NearAndFarReachTheEndsOfWhatLiesBetween)
{
    // Two small squares tell near and far for sure; a long one has its middle between them, and its ends beyond.
    const osg::ref_ptr<osg::Group> ground = new osg::Group;
    ground->addChild(makeSquare(osg::Vec3d(0.0, 800.0, 0.0), 1.0));
    ground->addChild(makeSquare(osg::Vec3d(0.0, 1200.0, 0.0), 1.0));
    ground->addChild(makeSquare(osg::Vec3d(0.0, 1000.0, 0.0), 300.0));
    const osg::ref_ptr<EffectScene> scene = new EffectScene;
    const osg::ref_ptr<VerticalExaggeration> exaggeration = new VerticalExaggeration;
    exaggeration->setFactor(1.5);
    scene->addEffect(exaggeration);
    scene->addChild(ground);
    CullHarness harness(context(), scene, WIDTH, HEIGHT);
    harness.camera().setComputeNearFarMode(osg::CullSettings::COMPUTE_NEAR_FAR_USING_BOUNDING_VOLUMES);
    const osg::Vec3d eye(0.0, 0.0, 20.0);
    harness.setCamera(osg::Matrixd::lookAt(eye, eye + osg::Vec3d(0.0, 1.0, 0.0), osg::Vec3d(0.0, 0.0, 1.0)),
                      osg::Matrixd::perspective(100.0, static_cast<double>(WIDTH) / HEIGHT, 1.0, 1e5));
    const Culled culled = harness.frame(true);
    ASSERT_EQ(culled.leaves.size(), 3u);
    double left = 0.0, right = 0.0, bottom = 0.0, top = 0.0, near = 0.0, far = 0.0;
    ASSERT_TRUE(culled.projection.getFrustum(left, right, bottom, top, near, far));
    EXPECT_LE(near, 700.0);
    EXPECT_GE(far, 1300.0);
    EXPECT_LE(far, 2000.0); // they are computed at all
}

} // namespace

TEST_F(CullMargins, ACompanionIsDrawnAsFarBesideThePictureAsItReaches)
{
    const int count = fullTest() ? 3000 : 300;
    int reaching = 0;
    int beyond = 0;
    for (int i = 0; i < count; ++i)
    {
        SCOPED_TRACE("sample " + std::to_string(i));
        Random random(static_cast<std::uint64_t>(i));
        const double reach = random.uniform(10.0, 60.0);
        const osg::ref_ptr<EffectScene> scene = new EffectScene;
        scene->setTerrainFrame(EffectScene::PROJECTED);
        // Next to no deformation, but one that culling has to think of.
        const osg::ref_ptr<VerticalExaggeration> slight = new VerticalExaggeration;
        slight->setFactor(1.0 + 1e-7);
        scene->addEffect(slight);
        const osg::ref_ptr<Companions> companions = new Companions(reach);
        scene->addEffect(companions);
        // A speck beside one side of the picture, in pixels from the border.
        const double off = random.uniform(0.0, 2.0) * reach;
        const bool horizontal = random.integer(0, 1) == 1;
        const double side = random.sign();
        const double x = horizontal ? side * (1.0 + 2.0 * off / WIDTH) : random.uniform(-0.9, 0.9);
        const double y = horizontal ? random.uniform(-0.9, 0.9) : side * (1.0 + 2.0 * off / HEIGHT);
        const double depth = random.logarithmic(20.0, 5000.0);
        const osg::Matrixd view = osg::Matrixd::lookAt(
            osg::Vec3d(0.0, 0.0, 500.0), osg::Vec3d(0.0, 800.0, 0.0), osg::Vec3d(0.0, 0.0, 1.0));
        const osg::Vec3d eye(x * depth / _projection(0, 0), y * depth / _projection(1, 1), -depth);
        const double pixel = 2.0 * depth / (_projection(1, 1) * HEIGHT);
        const osg::ref_ptr<osg::Geometry> speck = makeSquare(eye * osg::Matrixd::inverse(view), 0.05 * pixel);
        scene->addChild(wrapped(speck, random.integer(0, 4)));
        CullHarness harness(context(), scene, WIDTH, HEIGHT);
        // The speck itself is too small to matter to anyone.
        harness.camera().setCullingMode(osg::CullSettings::VIEW_FRUSTUM_CULLING);
        harness.setCamera(view, _projection);
        const std::set<const osg::Drawable*> drawn = harness.frame(true, false).drawables();
        const bool found = companions->of(speck) && drawn.count(companions->of(speck));
        if (off < reach - 0.5)
        {
            EXPECT_TRUE(found) << off << " pixels beside the picture, reaching " << reach;
            ++reaching;
        }
        if (off > reach + 2.0)
        {
            EXPECT_FALSE(found) << off << " pixels beside the picture, reaching " << reach;
            ++beyond;
        }
    }
    EXPECT_GT(reaching, count / 4);
    EXPECT_GT(beyond, count / 4);
}

TEST_F(CullMargins, NearAndFarContainWhatBulgesBetweenSections)
{
    const int count = fullTest() ? 3000 : 300;
    int checked = 0;
    double slackest = 0.0;
    for (int i = 0; i < count; ++i)
    {
        SCOPED_TRACE("sample " + std::to_string(i));
        Random random(static_cast<std::uint64_t>(i));
        const BentGrid bent(random, _projection);
        if (bent.chain->empty()) continue;
        CullHarness harness(context(), bent.scene, WIDTH, HEIGHT);
        harness.camera().setComputeNearFarMode(osg::CullSettings::COMPUTE_NEAR_FAR_USING_BOUNDING_VOLUMES);
        harness.camera().setNearFarRatio(1e-6);
        harness.setCamera(bent.view, _projection);
        const Culled culled = harness.frame(true, false);
        double nearest = HUGE_VAL;
        double farthest = 0.0;
        for (const osg::Vec3& vertex : dynamic_cast<const osg::Vec3Array&>(*bent.grid->getVertexArray()))
        {
            const osg::Vec3d eye = bent.chain->deform(osg::Vec3d(vertex) * bent.view);
            const osg::Vec4d clip = osg::Vec4d(eye, 1.0) * _projection;
            if (eye.z() >= 0.0 || std::abs(clip.x()) > clip.w() || std::abs(clip.y()) > clip.w()) continue;
            nearest = std::min(nearest, -eye.z());
            farthest = std::max(farthest, -eye.z());
        }
        if (!(farthest > 0.0)) continue;
        ASSERT_EQ(culled.leaves.size(), 1u);
        osg::Matrixd back;
        back.invert(culled.projection);
        const double near = -(osg::Vec3d(0.0, 0.0, -1.0) * back).z();
        const double far = -(osg::Vec3d(0.0, 0.0, 1.0) * back).z();
        ++checked;
        // OSG puts the planes 2 % away from what the traversal found.
        EXPECT_LE(near, nearest * 0.9801);
        EXPECT_GE(far, farthest * 1.0199);
        slackest = std::max(slackest, far / farthest);
    }
    RecordProperty("largest_far_over_farthest", std::to_string(slackest));
    EXPECT_GT(checked, count / 2);
}

TEST_F(CullMargins, PickingHitsWhatBulgesBetweenSections)
{
    const int count = fullTest() ? 3000 : 400;
    int hits = 0;
    for (int i = 0; i < count; ++i)
    {
        SCOPED_TRACE("sample " + std::to_string(i));
        Random random(static_cast<std::uint64_t>(i) + 20000);
        const BentGrid bent(random, _projection);
        if (bent.chain->empty()) continue;
        const DeformedView picture(*bent.scene, bent.view, _projection, WIDTH, HEIGHT);
        for (const osg::Vec2d& tip : tipsOf(bent, _projection))
        {
            ++hits;
            EXPECT_TRUE(picture.pick((tip.x() + 1.0) * WIDTH / 2.0, (tip.y() + 1.0) * HEIGHT / 2.0))
                << tip.x() << ' ' << tip.y();
        }
    }
    EXPECT_GT(hits, 2 * count);
}

TEST_F(CullMargins, WhatBulgesBeforeTheFarPlaneIsDrawn)
{
    const int count = fullTest() ? 3000 : 300;
    int checked = 0;
    for (int i = 0; i < count; ++i)
    {
        SCOPED_TRACE("sample " + std::to_string(i));
        Random random(static_cast<std::uint64_t>(i));
        const BentGrid bent(random, _projection);
        if (bent.chain->empty()) continue;
        double nearest = HUGE_VAL;
        for (const osg::Vec3& vertex : dynamic_cast<const osg::Vec3Array&>(*bent.grid->getVertexArray()))
        {
            const osg::Vec3d eye = bent.chain->deform(osg::Vec3d(vertex) * bent.view);
            const osg::Vec4d clip = osg::Vec4d(eye, 1.0) * _projection;
            if (eye.z() >= 0.0 || std::abs(clip.x()) > clip.w() || std::abs(clip.y()) > clip.w()) continue;
            nearest = std::min(nearest, -eye.z());
        }
        if (!std::isfinite(nearest)) continue;
        // Near and far do not change the bend. All but what is nearest lies behind the picture.
        const osg::Matrixd shallow = osg::Matrixd::perspective(60.0, static_cast<double>(WIDTH) / HEIGHT,
                                                               0.5 * nearest, nearest * (1.0 + 1e-4));
        CullHarness harness(context(), bent.scene, WIDTH, HEIGHT);
        harness.camera().setCullingMode(osg::CullSettings::VIEW_FRUSTUM_CULLING |
                                        osg::CullSettings::FAR_PLANE_CULLING);
        harness.setCamera(bent.view, shallow);
        EXPECT_EQ(harness.frame(true, false).leaves.size(), 1u) << nearest;
        ++checked;
    }
    EXPECT_GT(checked, count / 2);
}

TEST_F(CullMargins, LevelsBySizeGoByTheSizeOfWhatIsStretched)
{
    const int count = fullTest() ? 2000 : 200;
    int larger = 0;
    const osg::ref_ptr<osg::Viewport> port = new osg::Viewport(0, 0, WIDTH, HEIGHT);
    const osg::Vec4d pixelSize = osg::CullingSet::computePixelSizeVector(*port, _projection, osg::Matrix());
    for (int i = 0; i < count; ++i)
    {
        SCOPED_TRACE("sample " + std::to_string(i));
        Random random(static_cast<std::uint64_t>(i));
        const osg::ref_ptr<EffectScene> scene = new EffectScene;
        scene->setTerrainFrame(EffectScene::PROJECTED);
        const osg::ref_ptr<VerticalExaggeration> high = new VerticalExaggeration;
        const double factor = random.uniform(2.0, 6.0);
        high->setFactor(factor);
        scene->addEffect(high);
        const osg::Matrixd view =
            osg::Matrixd::lookAt(osg::Vec3d(0.0, 0.0, random.uniform(200.0, 1500.0)),
                                 osg::Vec3d(0.0, 2000.0, 0.0), osg::Vec3d(0.0, 0.0, 1.0));
        const osg::Vec3d place(random.uniform(-300.0, 300.0), random.uniform(1500.0, 5000.0),
                               random.uniform(-50.0, 50.0));
        const double radius = 4.0;
        const osg::Vec3d eye = osg::Vec3d(place.x(), place.y(), factor * place.z()) * view;
        // What is stretched upwards is as high as a larger ball, whose size OSG tells.
        const double pixels = radius * factor / std::abs(osg::Vec4d(eye, 1.0) * pixelSize);
        const double limit = pixels * random.logarithmic(0.3, 3.0);
        if (std::abs(limit / pixels - 1.0) < 0.05) continue;
        osg::ref_ptr<osg::LOD> lod = new osg::LOD;
        lod->setRangeMode(osg::LOD::PIXEL_SIZE_ON_SCREEN);
        lod->setCenterMode(osg::LOD::USER_DEFINED_CENTER);
        lod->setCenter(place);
        lod->setRadius(static_cast<float>(radius));
        const osg::ref_ptr<osg::Geometry> coarse = makeSquare(place, 1.0);
        lod->addChild(coarse, 0.0f, static_cast<float>(limit));
        lod->addChild(makeSquare(place, 1.0), static_cast<float>(limit), 1e9f);
        scene->addChild(lod);
        CullHarness harness(context(), scene, WIDTH, HEIGHT);
        harness.setCamera(view, _projection);
        const Culled culled = harness.frame(false, false);
        ASSERT_EQ(culled.leaves.size(), 1u);
        EXPECT_EQ(culled.leaves[0].drawable == coarse, pixels < limit) << pixels << " of " << limit;
        larger += pixels > limit && pixels < limit * factor ? 1 : 0;
    }
    EXPECT_GT(larger, count / 10);
}
