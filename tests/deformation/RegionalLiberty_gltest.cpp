// SPDX-License-Identifier: MIT
// SPDX-FileCopyrightText: 2026 the osgGeoFX authors
//
// Liberties with regions, as the GPU draws them: the picture is that of ground that the CPU has deformed, light and all;
// what lies outside is drawn as it was, to the bit; picking and rigid things follow.
#include <osgGeoFX/deformation/PedestrianView.h>
#include <osgGeoFX/deformation/RegionalLiberty.h>
#include <osgGeoFX/panorama/PanoramaMap.h>
#include <osgGeoFX/scene/DeformedView.h>
#include <osgGeoFX/scene/RigidReference.h>
#include <tools/CloseUpStage.h>
#include <tools/ImageComparison.h>
#include <tools/RandomSamples.h>

#include <osg/Math>
#include <osg/MatrixTransform>

#include <algorithm>
#include <cmath>

using namespace osgGeoFX;
using namespace geofx::test;

namespace
{

using Picture = osg::ref_ptr<osg::Image>;

constexpr int WIDTH = 320, HEIGHT = 240;

class LibertyPictures : public CloseUpStage
{
protected:
    LibertyPictures() : CloseUpStage(WIDTH, HEIGHT) {}

    void SetUp() override
    {
        CloseUpStage::SetUp();
        if (IsSkipped() || HasFatalFailure()) return;
        _ground = static_cast<osg::Geometry*>(_scene->getChild(0));
        look({300.0, -1400.0, 700.0}, {0.0, 0.0, 100.0});
    }

    static osg::ref_ptr<RegionalLiberty> makeLiberty(const osg::Vec2d& center, double across, double along)
    {
        osg::ref_ptr<RegionalLiberty> liberty = new RegionalLiberty;
        liberty->setCenter(center);
        liberty->setRadii(across, along);
        liberty->setHeading(0.5);
        liberty->setEnlarge(3.0);
        liberty->setBaseHeight(-60.0);
        liberty->setWiden(1.4);
        liberty->setTurn(0.6);
        return liberty;
    }
    /// Two that overlap.
    static Effects makeSet()
    {
        const osg::ref_ptr<RegionalLiberty> second = makeLiberty({250.0, 200.0}, 350.0, 350.0);
        second->setLengthen(0.7);
        second->setEnlarge(0.5);
        return {makeLiberty({-150.0, -100.0}, 600.0, 450.0), second};
    }

    const osg::Matrixd& view() { return viewer().getCamera()->getViewMatrix(); }

    osg::ref_ptr<const DeformationChain> chainOf(const Effects& effects)
    {
        return sceneOf(effects, _ground)->deformation(view(), viewer().getCamera()->getProjectionMatrix());
    }

    /// The ground with places and normals as the effects leave them.
    osg::ref_ptr<osg::Geometry> deformed(const Effects& effects, bool normals = true)
    {
        const osg::ref_ptr<const DeformationChain> chain = chainOf(effects);
        const osg::Matrixd back = osg::Matrixd::inverse(view());
        osg::ref_ptr<osg::Geometry> result =
            new osg::Geometry(*_ground, osg::CopyOp::DEEP_COPY_ARRAYS | osg::CopyOp::DEEP_COPY_PRIMITIVES);
        result->setUseVertexBufferObjects(false);
        auto& vertices = static_cast<osg::Vec3Array&>(*result->getVertexArray());
        auto& all = static_cast<osg::Vec3Array&>(*result->getNormalArray());
        for (std::size_t i = 0; i < vertices.size(); ++i)
        {
            const osg::Vec3d eye = osg::Vec3d(vertices[i]) * view();
            const osg::Vec3d normal = osg::Matrixd::transform3x3(osg::Vec3d(all[i]), view());
            vertices[i] = chain->deform(eye) * back;
            if (normals) all[i] = osg::Matrixd::transform3x3(chain->deformNormal(eye, normal), back);
        }
        return result;
    }

    osg::ref_ptr<osg::Geometry> _ground;
};

} // namespace

TEST_F(LibertyPictures, AreThoseOfGroundThatTheCpuHasDeformed)
{
    const Effects set = makeSet();
    const Picture plain = picture({}, _ground);
    const Picture expected = picture({}, deformed(set));
    EXPECT_GT(differing(*plain, *expected, 8), 0.1) << "the liberties are seen";
    // The light goes by the deformed surface.
    EXPECT_GT(differing(*picture({}, deformed(set, false)), *expected, 8), 0.02);
    const Picture actual = picture(set, _ground);
    EXPECT_LE(differing(*actual, *expected, 4), 0.004)
        << imagesMatch(*actual, *expected, {}, "set").message();
}

TEST_F(LibertyPictures, ComeBeforeAProjection)
{
    osg::ref_ptr<BirdsEyeView> birdsEye = new BirdsEyeView;
    birdsEye->setFocusLine(0.1);
    birdsEye->setHorizonLine(0.6);
    osg::ref_ptr<PedestrianView> pedestrian = new PedestrianView;
    pedestrian->setFocusDistance(300.0);
    pedestrian->setZoneWidth(800.0);
    pedestrian->setBendAngle(1.2);
    osg::ref_ptr<PanoramaMap> map = new PanoramaMap;
    for (const char* const part : {"paint", "strokes", "water", "sky"})
    {
        std::string error;
        ASSERT_TRUE(map->setProperty(part, 0.0, error)) << error;
    }
    map->setViewRadius(700.0);
    // Bends have a light of their own, which this test is not about.
    _root->getOrCreateStateSet()->setMode(GL_LIGHTING, osg::StateAttribute::OFF);
    for (const osg::ref_ptr<Effect>& projection :
         {osg::ref_ptr<Effect>(birdsEye), osg::ref_ptr<Effect>(pedestrian), osg::ref_ptr<Effect>(map)})
    {
        SCOPED_TRACE(projection->className());
        Effects all = makeSet();
        all.push_back(projection);
        const Picture expected = picture({}, deformed(all));
        EXPECT_GT(differing(*picture({projection}, _ground), *expected, 8), 0.05);
        const Picture actual = picture(all, _ground);
        EXPECT_LE(differing(*actual, *expected, 4), 0.006)
            << imagesMatch(*actual, *expected, {}, projection->className()).message();
    }
}

TEST_F(LibertyPictures, LeaveOtherGroundAsItIsToTheBit)
{
    look({0.0, -1.0, 3000.0}, {0.0, 0.0, 0.0}, 30.0);
    const osg::ref_ptr<RegionalLiberty> liberty = makeLiberty({300.0, 0.0}, 250.0, 250.0);
    const osg::ref_ptr<RegionalLiberty> elsewhere = makeLiberty({5000.0, 0.0}, 250.0, 250.0);
    const Picture before = picture({elsewhere}, _ground);
    const Picture after = picture({liberty}, _ground);
    const DeformedView ground(*_scene, *viewer().getCamera());
    int inside = 0, outside = 0;
    for (int y = 0; y < HEIGHT; ++y)
    {
        for (int x = 0; x < WIDTH; ++x)
        {
            const bool same = std::equal(before->data(x, y), before->data(x, y) + 3, after->data(x, y));
            osg::Vec2d center;
            ASSERT_TRUE(ground.project(osg::Vec3d(300.0, 0.0, 0.0), center));
            // 250 m, and a margin for what rises before the ground behind it.
            const double pixels = HEIGHT / (2.0 * 3000.0 * std::tan(osg::DegreesToRadians(15.0)));
            const bool away = (osg::Vec2d(x + 0.5, y + 0.5) - center).length() > 250.0 * 1.25 * pixels + 3.0;
            outside += away ? 1 : 0;
            inside += same ? 0 : 1;
            ASSERT_TRUE(same || !away) << x << ", " << y;
        }
    }
    EXPECT_GT(inside, 300);
    EXPECT_GT(outside, WIDTH * HEIGHT / 2);
}

TEST_F(LibertyPictures, ArePickedWhereTheyAreSeen)
{
    osg::ref_ptr<PanoramaMap> map = new PanoramaMap;
    map->setViewRadius(700.0);
    for (const bool mapped : {false, true})
    {
        Effects all = makeSet();
        if (mapped) all.push_back(map);
        const osg::ref_ptr<EffectScene> scene = sceneOf(all, _ground);
        const osg::ref_ptr<EffectScene> plain = sceneOf({}, _ground);
        const DeformedView seen(*scene, *viewer().getCamera()), straight(*plain, *viewer().getCamera());
        Random random(3);
        int picked = 0, moved = 0;
        for (int i = 0; i < 200; ++i)
        {
            const osg::Vec2d pixel(random.uniform(0.0, WIDTH), random.uniform(0.0, HEIGHT));
            const auto hit = seen.pick(pixel.x(), pixel.y());
            if (!hit) continue;
            ++picked;
            osg::Vec2d back;
            ASSERT_TRUE(seen.project(hit->world, back));
            // Triangles are straight in the picture, and the ground between their corners is not.
            EXPECT_LT((back - pixel).length(), 4.0);
            osg::Vec2d before;
            if (straight.project(hit->world, before) && (before - pixel).length() > 5.0) ++moved;
        }
        EXPECT_GT(picked, 50);
        EXPECT_GT(moved, 20);
    }
}

TEST_F(LibertyPictures, CarryWhatKeepsItsShape)
{
    const Effects set = makeSet();
    const osg::Vec3d place(-150.0, -100.0, groundHeight(-150.0, -100.0));
    const auto makeTent = [&]
    {
        const osg::ref_ptr<osg::Vec3Array> corners = new osg::Vec3Array;
        const osg::ref_ptr<osg::Vec3Array> normals = new osg::Vec3Array;
        const osg::Vec3 tip(0.0f, 0.0f, 220.0f);
        const osg::Vec3 foot[] = {
            {-90.0f, -90.0f, 0.0f}, {90.0f, -90.0f, 0.0f}, {90.0f, 90.0f, 0.0f}, {-90.0f, 90.0f, 0.0f}};
        for (int i = 0; i < 4; ++i)
        {
            osg::Vec3 normal = (foot[(i + 1) % 4] - foot[i]) ^ (tip - foot[i]);
            normal.normalize();
            for (const osg::Vec3& corner : {foot[i], foot[(i + 1) % 4], tip})
            {
                corners->push_back(corner);
                normals->push_back(normal);
            }
        }
        const osg::ref_ptr<osg::Geometry> tent = new osg::Geometry;
        tent->setUseDisplayList(false);
        tent->setUseVertexBufferObjects(true);
        tent->setVertexArray(corners);
        tent->setNormalArray(normals, osg::Array::BIND_PER_VERTEX);
        const osg::ref_ptr<osg::Vec4Array> red = new osg::Vec4Array;
        red->push_back(osg::Vec4(1.0f, 0.1f, 0.1f, 1.0f));
        tent->setColorArray(red, osg::Array::BIND_OVERALL);
        tent->addPrimitiveSet(new osg::DrawArrays(GL_TRIANGLES, 0, 12));
        return tent;
    };
    const auto at = [&](const osg::Matrixd& matrix, osg::Node* child)
    {
        const osg::ref_ptr<osg::MatrixTransform> transform = new osg::MatrixTransform(matrix);
        transform->addChild(child);
        return transform;
    };
    const osg::ref_ptr<osg::Group> content = new osg::Group;
    content->addChild(_ground);
    const osg::ref_ptr<RigidReference> rigid = new RigidReference;
    rigid->addChild(makeTent());
    content->addChild(at(osg::Matrixd::translate(place), rigid));

    const osg::ref_ptr<const DeformationChain> chain = chainOf(set);
    const osg::Matrixd moved = view() * chain->placement(place * view()) * osg::Matrixd::inverse(view());
    EXPECT_GT((place * moved - place).length(), 25.0);
    const osg::ref_ptr<osg::Group> expected = new osg::Group;
    expected->addChild(deformed(set));
    expected->addChild(at(osg::Matrixd::translate(place) * moved, makeTent()));
    const Picture wanted = picture({}, expected);
    const Picture actual = picture(set, content);
    EXPECT_LE(differing(*actual, *wanted, 4), 0.006) << imagesMatch(*actual, *wanted, {}, "rigid").message();
    EXPECT_GT(differing(*picture(set, _ground), *wanted, 4), 0.008) << "the tent is seen";
}
