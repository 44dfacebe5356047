// SPDX-License-Identifier: MIT
// SPDX-FileCopyrightText: 2026 the osgGeoFX authors
//
// Hosts whose cull visitor does more than OSG's, as SimGear's does: it draws nodes of theirs with a state of its own, collects
// lights, and draws a kind of drawable in its own way. All of that goes on below a scene with effects.
#include <osgGeoFX/closeup/CloseUps.h>
#include <osgGeoFX/deformation/VerticalExaggeration.h>
#include <osgGeoFX/panorama/MaterialCover.h>
#include <osgGeoFX/panorama/PanoramaMap.h>
#include <tools/BentGround.h>
#include <tools/ImageComparison.h>

#include <osg/Geode>
#include <osg/Material>
#include <osgUtil/CullVisitor>

#include <atomic>
#include <vector>

using namespace osgGeoFX;
using namespace geofx::test;

namespace
{

/// Ground of a host: its look is not a state set of the node.
class HostGeode : public osg::Geode
{
public:
    explicit HostGeode(osg::StateSet* state) : look(state) {}
    const osg::ref_ptr<osg::StateSet> look;
};

/// A light of a host: no geometry.
class HostLight : public osg::Node
{
public:
    osg::BoundingSphere computeBound() const override { return {osg::Vec3(), 30.0f}; }
};

/// A group that a host wants to hear of.
class HostGroup : public osg::Group
{
};

/// What the visitors of a test have seen; they are OSG's to make and to delete.
struct Seen
{
    std::atomic<int> lights{0}, groups{0}, drawables{0};
    osg::Vec3d light; ///< in eye space
};
Seen* seen = nullptr;

/// A drawable that a host draws with a state of its own.
class HostDrawable : public osg::Geometry
{
public:
    HostDrawable(const osg::Geometry& other, osg::StateSet* state)
        : osg::Geometry(other, osg::CopyOp::SHALLOW_COPY), look(state)
    {
    }
    const osg::ref_ptr<osg::StateSet> look;
};

class HostCullVisitor : public osgUtil::CullVisitor
{
public:
    osgUtil::CullVisitor* clone() const override { return new HostCullVisitor; }
    using osgUtil::CullVisitor::apply;
    void apply(osg::Node& node) override
    {
        osgUtil::CullVisitor::apply(node);
        if (!dynamic_cast<HostLight*>(&node)) return;
        ++seen->lights;
        seen->light = osg::Vec3d() * *getModelViewMatrix();
    }
    void apply(osg::Group& node) override
    {
        if (dynamic_cast<HostGroup*>(&node)) ++seen->groups;
        osgUtil::CullVisitor::apply(node);
    }
    void apply(osg::Geode& node) override
    {
        const auto* own = dynamic_cast<HostGeode*>(&node);
        if (own) pushStateSet(own->look);
        osgUtil::CullVisitor::apply(node);
        if (own) popStateSet();
    }
    void apply(osg::Drawable& drawable) override
    {
        const auto* own = dynamic_cast<HostDrawable*>(&drawable);
        if (own) ++seen->drawables;
        if (own) pushStateSet(own->look);
        osgUtil::CullVisitor::apply(drawable);
        if (own) popStateSet();
    }
};

class HostCullVisitors : public BentGround
{
protected:
    HostCullVisitors()
    {
        _former = osgUtil::CullVisitor::prototype();
        osgUtil::CullVisitor::prototype() = new HostCullVisitor;
        seen = &_seen;
    }
    ~HostCullVisitors() override { osgUtil::CullVisitor::prototype() = _former; }

    /// A wash of one color, which replaces that of the vertices.
    static osg::ref_ptr<osg::StateSet> look(const osg::Vec4& color)
    {
        const osg::ref_ptr<osg::StateSet> state = new osg::StateSet;
        const osg::ref_ptr<osg::Material> material = new osg::Material;
        material->setColorMode(osg::Material::OFF);
        material->setEmission(osg::Material::FRONT_AND_BACK, color);
        material->setAmbient(osg::Material::FRONT_AND_BACK, osg::Vec4(0, 0, 0, 1));
        material->setDiffuse(osg::Material::FRONT_AND_BACK, osg::Vec4(0, 0, 0, 1));
        state->setAttributeAndModes(material);
        state->setMode(GL_LIGHTING, osg::StateAttribute::ON);
        return state;
    }
    /// Ground, a box that is moved, and a box of the host's own kind; `told`: as a host has it, else with state sets that
    /// any visitor knows.
    static std::vector<osg::ref_ptr<osg::Node>> make(bool told)
    {
        const osg::ref_ptr<osg::StateSet> red = look({0.8f, 0.2f, 0.1f, 1.0f});
        const osg::ref_ptr<osg::StateSet> blue = look({0.1f, 0.3f, 0.9f, 1.0f});
        const osg::ref_ptr<osg::Geode> ground = told ? new HostGeode(red) : new osg::Geode;
        if (!told) ground->setStateSet(red);
        ground->addDrawable(makeGround());
        const osg::ref_ptr<osg::Geometry> made = makeBox(14.0f);
        const osg::ref_ptr<osg::Geometry> box = told ? new HostDrawable(*made, blue) : made;
        if (!told) box->setStateSet(blue);
        const osg::ref_ptr<osg::MatrixTransform> place =
            new osg::MatrixTransform(osg::Matrixd::translate(30, 20, 0));
        place->addChild(box);
        const osg::ref_ptr<osg::Group> group = told ? new HostGroup : new osg::Group;
        group->addChild(ground);
        group->addChild(place);
        if (told)
        {
            const osg::ref_ptr<osg::MatrixTransform> lamp =
                new osg::MatrixTransform(osg::Matrixd::translate(10, 20, 30));
            lamp->addChild(new HostLight);
            group->addChild(lamp);
        }
        return {group, makeBox(18.0f, {-40.0, 60.0, 0.0})};
    }

    Seen _seen;

private:
    osg::ref_ptr<osgUtil::CullVisitor> _former;
};

} // namespace

TEST_F(HostCullVisitors, DrawTheirOwnNodesWithTheirOwnStates)
{
    const osg::ref_ptr<osg::Image> plain = render(makePlain(make(true)));
    EXPECT_TRUE(same(*plain, *render(makePlain(make(false)))));
    const osg::ref_ptr<EffectScene> scene = makeScene(make(true));
    const osg::ref_ptr<osg::Image> image = render(scene);
    EXPECT_TRUE(same(*image, *render(makeScene(make(false)))));
    EXPECT_GT(differing(*image, *plain), 500);
    scene->setCompensation(false);
    EXPECT_TRUE(same(*render(scene), *image));
    scene->setCompensation(true);
    // With an effect that does nothing it is the host's own picture.
    const osg::ref_ptr<EffectScene> still = makeScene(make(true));
    still->getEffect(0)->setEnabled(false);
    const osg::ref_ptr<VerticalExaggeration> one = new VerticalExaggeration;
    one->setFactor(1.0);
    still->addEffect(one);
    EXPECT_TRUE(same(*render(still), *plain));
}

TEST_F(HostCullVisitors, CollectWhatTheyCollect)
{
    const osg::ref_ptr<EffectScene> scene = makeScene(make(true));
    // Passes draw the scene again; the host hears of it once.
    const osg::ref_ptr<CloseUps> closeUps = new CloseUps;
    const osg::ref_ptr<CloseUp> closeUp = new CloseUp;
    closeUp->getRegion()->setSize(60.0, 60.0);
    closeUp->setOffset({0.0, 0.0, 40.0});
    closeUps->addCloseUp(closeUp);
    scene->addEffect(closeUps);
    const osg::ref_ptr<osg::Image> image = render(scene);
    EXPECT_EQ(_seen.lights, 1);
    EXPECT_EQ(_seen.groups, 1);
    EXPECT_LT((_seen.light - osg::Vec3d(10, 20, 30) * viewer().getCamera()->getViewMatrix()).length(), 1e-6);
    // The close-up has the host's ground.
    const osg::ref_ptr<EffectScene> expected = makeScene(make(false));
    expected->addEffect(closeUps);
    EXPECT_TRUE(same(*image, *render(expected)));
    closeUps->setEnabled(false);
    EXPECT_GT(differing(*image, *render(scene)), 500);
}

TEST_F(HostCullVisitors, WithoutNormalsNothingIsLeftOver)
{
    // A painted thing without normals, after one out of sight with any; drawn by the host and by the kit.
    for (const bool told : {false, true})
    {
        SCOPED_TRACE(told);
        const auto picture = [&](const osg::Vec3& normal)
        {
            const osg::ref_ptr<osg::Geometry> before = new osg::Geometry(*makeBox(1.0f));
            const osg::ref_ptr<osg::Vec3Array> normals = new osg::Vec3Array(osg::Array::BIND_OVERALL, 1);
            normals->front() = normal;
            before->setNormalArray(normals);
            before->setCullingActive(false);
            const osg::ref_ptr<osg::MatrixTransform> away =
                new osg::MatrixTransform(osg::Matrixd::translate(0.0, -2000.0, 0.0));
            away->addChild(before);
            away->setCullingActive(false);
            const osg::ref_ptr<osg::Geometry> made = makeGround();
            made->setNormalArray(nullptr);
            const osg::ref_ptr<osg::Geometry> after =
                told ? new HostDrawable(*made, look({0.8f, 0.2f, 0.1f, 1.0f})) : made;
            const osg::ref_ptr<EffectScene> scene = new EffectScene;
            const osg::ref_ptr<PanoramaMap> map = new PanoramaMap;
            map->setWater(false); // it moves
            scene->addEffect(map);
            scene->addChild(away);
            scene->addChild(after);
            scene->getOrCreateStateSet()->setRenderBinDetails(0, "TraversalOrderBin");
            return render(scene);
        };
        const osg::ref_ptr<osg::Image> image = picture({0, 0, 1});
        EXPECT_GT(covered(*image), 500);
        EXPECT_TRUE(same(*image, *picture({0.9f, -0.3f, 0.3f})));
    }
}

TEST_F(HostCullVisitors, WhatEffectsDrawWithAThingTheyDrawWithTheHosts)
{
    // Trees of a panorama map on the host's ground.
    osg::Camera& camera = *viewer().getCamera();
    const auto picture = [&](bool told, bool strokes)
    {
        const osg::ref_ptr<MaterialCover> cover = new MaterialCover;
        cover->setCover("Forest", {1.0, 0.0, 0.0, false});
        const osg::ref_ptr<osg::StateSet> red = look({0.8f, 0.2f, 0.1f, 1.0f});
        const osg::ref_ptr<osg::Group> ground = new osg::Group;
        for (const double x : {-160.0, 160.0})
        {
            const osg::ref_ptr<osg::Geode> half = told ? new HostGeode(red) : new osg::Geode;
            if (!told) half->setStateSet(red);
            half->addDrawable(makeGround());
            half->setName("Forest");
            const osg::ref_ptr<osg::MatrixTransform> place =
                new osg::MatrixTransform(osg::Matrixd::translate(x, 0.0, 0.0));
            place->addChild(half);
            ground->addChild(place);
        }
        cover->apply(*ground);
        const osg::ref_ptr<PanoramaMap> map = new PanoramaMap;
        map->setViewRadius(80.0);
        map->setStrokeStep(2.0);
        map->setStrokes(strokes);
        map->setWater(false);
        const osg::ref_ptr<EffectScene> scene = new EffectScene;
        scene->addEffect(map);
        scene->addChild(ground);
        return render(scene);
    };
    const osg::ref_ptr<osg::Image> image = picture(true, true);
    EXPECT_TRUE(same(*image, *picture(false, true)));
    EXPECT_GT(differing(*image, *picture(true, false)), 500);
    camera.setCullingMode(osg::CullSettings::NO_CULLING);
    EXPECT_TRUE(same(*image, *picture(true, true)));
}

TEST_F(HostCullVisitors, NearAndFarHoldWhatTheyDraw)
{
    const osg::ref_ptr<EffectScene> scene = makeScene(make(true));
    osg::Camera& camera = *viewer().getCamera();
    const osg::ref_ptr<osg::Image> expected = render(scene);
    camera.setComputeNearFarMode(osg::CullSettings::COMPUTE_NEAR_FAR_USING_BOUNDING_VOLUMES);
    const osg::ref_ptr<osg::Image> image = render(scene);
    EXPECT_TRUE(imagesMatch(*image, *expected, {0.02f, 0.01, 1.0f}));
    double left, right, bottom, top, near, far;
    camera.getProjectionMatrixAsFrustum(left, right, bottom, top, near, far);
    EXPECT_LT(far, 1500.0);
}

TEST_F(HostCullVisitors, WhatTheyDrawIsCulledWhereItGoes)
{
    // Boxes of the host's below the picture, which the deformation lifts into it, and above the picture.
    osg::Camera& camera = *viewer().getCamera();
    camera.setViewMatrixAsLookAt({0, -150, 70}, {0, -40, 60}, {0, 0, 1});
    const osg::ref_ptr<EffectScene> scene = new EffectScene;
    const osg::ref_ptr<VerticalExaggeration> high = new VerticalExaggeration;
    high->setFactor(8.0);
    scene->addEffect(high);
    const osg::ref_ptr<osg::StateSet> red = look({0.8f, 0.2f, 0.1f, 1.0f});
    for (const double height : {2.0, 8.0, 60.0})
    {
        const osg::ref_ptr<osg::MatrixTransform> place =
            new osg::MatrixTransform(osg::Matrixd::translate(0, 30, height));
        place->addChild(new HostDrawable(*makeBox(6.0f), red));
        scene->addChild(place);
    }
    const osg::ref_ptr<osg::Image> culled = render(scene);
    EXPECT_GT(covered(*culled), 10);
    camera.setCullingMode(osg::CullSettings::NO_CULLING);
    EXPECT_TRUE(same(*render(scene), *culled));
    camera.setCullingMode(osg::CullSettings::DEFAULT_CULLING);
    high->setFactor(1.0);
    EXPECT_FALSE(same(*render(scene), *culled));
}
