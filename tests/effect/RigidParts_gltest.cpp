// SPDX-License-Identifier: MIT
// SPDX-FileCopyrightText: 2026 the osgGeoFX authors
//
// Many things in one geometry that each keep their shape: as if each had a node, and culled and picked where they are drawn.
#include <osgGeoFX/deformation/PedestrianView.h>
#include <osgGeoFX/deformation/RegionalLiberty.h>
#include <osgGeoFX/deformation/VerticalExaggeration.h>
#include <osgGeoFX/effect/RigidParts.h>
#include <osgGeoFX/scene/DeformedIntersector.h>
#include <osgGeoFX/scene/DeformedView.h>
#include <osgGeoFX/scene/RigidReference.h>
#include <tools/BentGround.h>
#include <tools/ImageComparison.h>
#include <tools/PixelsApart.h>
#include <tools/RandomSamples.h>

using namespace osgGeoFX;
using namespace geofx::test;

namespace
{

struct Box
{
    osg::Vec3d place; ///< of its foot, which is its reference
    float size;
    osg::Vec3d away = osg::Vec3d(); ///< of its reference from the foot
};

class RigidPartsTest : public BentGround
{
protected:
    /// All boxes in one geometry.
    static osg::ref_ptr<osg::Geometry> makeParts(const std::vector<Box>& boxes)
    {
        osg::ref_ptr<osg::Geometry> all = new osg::Geometry;
        osg::ref_ptr<osg::Vec3Array> vertices = new osg::Vec3Array,
                                     normals = new osg::Vec3Array(osg::Array::BIND_PER_VERTEX);
        osg::ref_ptr<osg::Vec4Array> colors = new osg::Vec4Array(osg::Array::BIND_PER_VERTEX);
        osg::ref_ptr<osg::DrawElementsUInt> triangles = new osg::DrawElementsUInt(GL_TRIANGLES);
        std::vector<osg::Vec3> references;
        for (const Box& each : boxes)
        {
            const osg::ref_ptr<osg::Geometry> box = makeBox(each.size);
            const auto first = static_cast<unsigned int>(vertices->size());
            const osg::PrimitiveSet& set = *box->getPrimitiveSet(0);
            for (unsigned int i = 0; i < set.getNumIndices(); ++i)
                triangles->push_back(first + set.index(i));
            const auto& places = static_cast<const osg::Vec3Array&>(*box->getVertexArray());
            for (std::size_t i = 0; i < places.size(); ++i)
            {
                vertices->push_back(places[i] + osg::Vec3(each.place));
                normals->push_back(static_cast<const osg::Vec3Array&>(*box->getNormalArray())[i]);
                colors->push_back(static_cast<const osg::Vec4Array&>(*box->getColorArray())[i]);
                references.push_back(osg::Vec3(each.place + each.away));
            }
        }
        all->setVertexArray(vertices);
        all->setNormalArray(normals);
        all->setColorArray(colors);
        all->addPrimitiveSet(triangles);
        all->setUseDisplayList(false);
        all->setUseVertexBufferObjects(false);
        all->getOrCreateStateSet()->setDefine(RigidParts::define);
        RigidParts::finish(*all, references);
        return all;
    }

    /// Each box below a node of its own.
    static osg::ref_ptr<osg::Node> makeNodes(const std::vector<Box>& boxes)
    {
        osg::ref_ptr<osg::Group> group = new osg::Group;
        for (const Box& each : boxes)
        {
            osg::ref_ptr<RigidReference> rigid = new RigidReference;
            rigid->addChild(makeBox(each.size, each.place));
            rigid->setReference(each.place + each.away);
            group->addChild(rigid);
        }
        return group;
    }

    static std::vector<Box> randomBoxes(Random& random, int count)
    {
        std::vector<Box> boxes;
        for (int i = 0; i < count; ++i)
            boxes.push_back({{random.uniform(-90, 90), random.uniform(-100, 120), random.uniform(0, 6)},
                             static_cast<float>(random.uniform(2, 11))});
        return boxes;
    }

    static osg::ref_ptr<EffectScene> sceneOf(int kind, const osg::ref_ptr<osg::Node>& child)
    {
        osg::ref_ptr<EffectScene> scene = new EffectScene;
        if (kind == 0) scene->addEffect(makeBend());
        if (kind == 1)
        {
            osg::ref_ptr<PedestrianView> walk = new PedestrianView;
            walk->setFocusDistance(80);
            walk->setZoneWidth(60);
            scene->addEffect(walk);
        }
        if (kind >= 2)
        {
            osg::ref_ptr<VerticalExaggeration> lift = new VerticalExaggeration;
            lift->setFactor(3.0);
            scene->addEffect(lift);
        }
        if (kind == 3) scene->addEffect(makeBend());
        if (child) scene->addChild(child);
        return scene;
    }
};

} // namespace

TEST_F(RigidPartsTest, AreDrawnAsIfEachHadANode)
{
    for (int kind = 0; kind < 4; ++kind)
    {
        SCOPED_TRACE(kind);
        Random random(static_cast<std::uint64_t>(kind));
        const std::vector<Box> boxes = randomBoxes(random, 40);
        const osg::ref_ptr<osg::Image> expected = render(sceneOf(kind, makeNodes(boxes)));
        const osg::ref_ptr<osg::Image> actual = render(sceneOf(kind, makeParts(boxes)));
        EXPECT_GT(covered(*expected), 800);
        // Floats instead of matrices of doubles: edges may fall to the other pixel.
        EXPECT_LE(pixelsApart(*actual, *expected), covered(*expected) / 50);
        // Without the references they lean.
        osg::ref_ptr<osg::Geometry> soft = makeParts(boxes);
        soft->setStateSet(nullptr);
        soft->setVertexAttribArray(RigidParts::attribute, nullptr);
        EXPECT_GT(pixelsApart(*render(sceneOf(kind, soft)), *expected),
                  5 * pixelsApart(*actual, *expected) + 10);
    }
}

TEST_F(RigidPartsTest, StayToTheLastBitWhereNothingMoves)
{
    Random random(7);
    std::vector<Box> boxes = randomBoxes(random, 30);
    const osg::ref_ptr<osg::Geometry> parts = makeParts(boxes);
    const osg::ref_ptr<osg::Image> plain = render(makePlain({parts}));
    EXPECT_GT(covered(*plain), 500);
    // In the focus of a bend that begins behind all of them.
    const osg::ref_ptr<EffectScene> scene = sceneOf(1, parts);
    dynamic_cast<PedestrianView&>(*scene->getEffect(0)).setFocusDistance(5000);
    EXPECT_TRUE(same(*render(scene), *plain));
    // Left out.
    const osg::ref_ptr<EffectScene> bent = sceneOf(0, parts);
    EXPECT_FALSE(same(*render(bent), *plain));
    parts->getStateSet()->setDefine("GEOFX_DEFORMATION", osg::StateAttribute::OFF);
    EXPECT_TRUE(same(*render(bent), *plain));
}

// Edges keep their lengths, anywhere on the curve, and the CPU's places are the GPU's.
TEST_F(RigidPartsTest, KeepTheirShapeOnTheCpu)
{
    const osg::Matrixd& view = viewer().getCamera()->getViewMatrix();
    const osg::Matrixd& projection = viewer().getCamera()->getProjectionMatrix();
    for (int kind = 0; kind < 4; ++kind)
    {
        const osg::ref_ptr<EffectScene> scene = sceneOf(kind, makeBox(1));
        const osg::ref_ptr<const DeformationChain> chain = scene->deformation(view, projection);
        double worst = 0.0, soft = 0.0;
        for (int i = 0; i < 2000; ++i)
        {
            Random random(static_cast<std::uint64_t>(i));
            const osg::Vec3d foot(random.uniform(-90, 90), random.uniform(-120, 140), random.uniform(0, 6));
            const osg::Vec3d a(random.uniform(-8, 8), random.uniform(-8, 8), random.uniform(0, 20));
            const osg::Vec3d b(random.uniform(-8, 8), random.uniform(-8, 8), random.uniform(0, 20));
            const osg::Vec3d reference = foot * view, from = (foot + a) * view, to = (foot + b) * view;
            const double length = (a - b).length();
            const auto placed = [&](const osg::Vec3d& position)
            {
                return RigidParts::place(*chain, position, reference);
            };
            worst = std::max(worst, std::abs((placed(from) - placed(to)).length() / length - 1.0));
            soft =
                std::max(soft, std::abs((chain->deform(from) - chain->deform(to)).length() / length - 1.0));
            // As a node would do it.
            const osg::Vec3d node = from * chain->placement(reference);
            EXPECT_LT((placed(from) - node).length(), 1e-9 * (1.0 + node.length()));
        }
        EXPECT_LT(worst, 1e-9) << kind;
        EXPECT_GT(soft, 0.05) << kind;
    }
}

TEST_F(RigidPartsTest, AreNotCulledWrongly)
{
    osg::Camera& camera = *viewer().getCamera();
    // What is smaller than two pixels may be left out.
    const osg::CullSettings::CullingMode culling =
        camera.getCullingMode() & ~osg::CullSettings::SMALL_FEATURE_CULLING;
    const osg::Matrixd home = camera.getViewMatrix();
    const int count = fullTest() ? 3000 : 400;
    int some = 0, border = 0, left = 0;
    std::vector<osg::ref_ptr<EffectScene>> scenes;
    for (int kind = 0; kind < 4; ++kind)
        scenes.push_back(sceneOf(kind, nullptr));
    for (int i = 0; i < count; ++i)
    {
        Random random(static_cast<std::uint64_t>(i));
        // Half of them in a bend that squeezes the ground most.
        const int kind = i % 2 ? 1 : i / 2 % 4;
        EffectScene* scene = scenes[static_cast<std::size_t>(kind)];
        if (kind == 1)
        {
            auto& walk = dynamic_cast<PedestrianView&>(*scene->getEffect(0));
            walk.setZoneWidth(random.uniform(20, 60));
            walk.setBendAngle(random.uniform(0.8, 1.5));
        }
        scene->removeChildren(0, scene->getNumChildren());
        // A few boxes, so that the geometry's own box is no larger than they need.
        const osg::Vec3d middle(random.uniform(-90, 90), random.uniform(-120, 140), random.uniform(0, 20));
        std::vector<Box> boxes;
        for (int box = random.integer(1, 3); box > 0; --box)
            boxes.push_back({middle + osg::Vec3d(random.uniform(-4, 4), random.uniform(-4, 4), 0.0),
                             static_cast<float>(random.uniform(2, 14)),
                             i % 3 ? osg::Vec3d()
                                   : osg::Vec3d(random.uniform(-30, 30), random.uniform(10, 120),
                                                random.uniform(0, 20))});
        scene->addChild(makePlain({makeParts(boxes)}));
        camera.setViewMatrix(home * osg::Matrix::rotate(random.uniform(-0.5, 0.5), osg::Vec3d(0, 1, 0)) *
                             osg::Matrix::rotate(random.uniform(-0.5, 0.3), osg::Vec3d(1, 0, 0)));
        camera.setCullingMode(culling);
        const osg::ref_ptr<osg::Image> actual = render(scene);
        camera.setCullingMode(osg::CullSettings::NO_CULLING);
        const osg::ref_ptr<osg::Image> expected = render(scene);
        ASSERT_TRUE(same(*actual, *expected)) << "sample " << i;
        const int seen = covered(*expected);
        some += seen > 0 ? 1 : 0;
        border += seen > 0 && seen < 40 ? 1 : 0;
        left += seen == 0 ? 1 : 0;
    }
    EXPECT_GT(some, count / 4);
    EXPECT_GT(border, count / 60);
    EXPECT_GT(left, count / 10);
    camera.setViewMatrix(home);
    camera.setCullingMode(culling);
}

TEST_F(RigidPartsTest, ArePickedWhereTheyAreDrawn)
{
    const osg::Matrixd& view = viewer().getCamera()->getViewMatrix();
    const osg::Matrixd& projection = viewer().getCamera()->getProjectionMatrix();
    Random random(3);
    std::vector<Box> boxes = randomBoxes(random, 40);
    // References beside the boxes, so that it shows where each box goes by another one's.
    for (Box& box : boxes)
        box.away.set(random.uniform(-15, 15), random.uniform(-25, 25), 0.0);
    const osg::ref_ptr<osg::Geometry> parts = makeParts(boxes);
    const osg::ref_ptr<EffectScene> scene = sceneOf(1, parts);
    dynamic_cast<PedestrianView&>(*scene->getEffect(0)).setBendAngle(1.2);
    const osg::ref_ptr<osg::Image> picture = render(scene);
    const osg::ref_ptr<const DeformationChain> chain = scene->deformation(view, projection);
    const osg::ref_ptr<osg::Image> empty = render(new osg::Group);
    int hits = 0, wrong = 0, known = 0;
    const osg::Matrixd inverse = osg::Matrixd::inverse(projection);
    for (int y = 1; y < HEIGHT; y += 3)
        for (int x = 1; x < WIDTH; x += 3)
        {
            const osg::Vec3d through =
                osg::Vec3d(2.0 * (x + 0.5) / WIDTH - 1.0, 2.0 * (y + 0.5) / HEIGHT - 1.0, 0.0) * inverse;
            const osg::ref_ptr<DeformedLineIntersector> ray =
                new DeformedLineIntersector(osg::Vec3d(), through);
            const osg::ref_ptr<DeformedIntersectionVisitor> visitor =
                new DeformedIntersectionVisitor(ray, *chain, view, 1.0);
            scene->accept(*visitor);
            const bool drawn = picture->getColor(static_cast<unsigned>(x), static_cast<unsigned>(y)) !=
                               empty->getColor(static_cast<unsigned>(x), static_cast<unsigned>(y));
            const bool picked = !ray->intersections().empty();
            hits += picked ? 1 : 0;
            wrong += picked != drawn ? 1 : 0;
            if (!picked) continue;
            // The place is told as it stands, undeformed: on one of the boxes.
            const osg::Vec3d& world = ray->intersections().front().world;
            for (const Box& box : boxes)
            {
                const osg::Vec3d from = world - box.place;
                const double half = static_cast<double>(box.size) / 2.0 + 1e-3,
                             top = 2.0 * static_cast<double>(box.size) + 1e-3;
                if (std::abs(from.x()) < half && std::abs(from.y()) < half && from.z() > -1e-3 &&
                    from.z() < top)
                {
                    ++known;
                    break;
                }
            }
        }
    EXPECT_GT(hits, 60);
    // Pixels of edges.
    EXPECT_LE(wrong, hits / 20);
    EXPECT_EQ(known, hits);
}

// Without the define, the attribute is the application's.
TEST_F(RigidPartsTest, AnotherAttributeOfThisNumberCountsForNothing)
{
    const osg::Camera& camera = *viewer().getCamera();
    const osg::ref_ptr<osg::Geometry> without = makeGround(), with = makeGround();
    Random random(11);
    const osg::ref_ptr<osg::Vec4Array> tangents = new osg::Vec4Array(osg::Array::BIND_PER_VERTEX);
    for (unsigned int i = 0; i < with->getVertexArray()->getNumElements(); ++i)
        tangents->push_back({static_cast<float>(random.uniform(-1, 1)),
                             static_cast<float>(random.uniform(-1, 1)), 0.0f, 1.0f});
    with->setVertexAttribArray(RigidParts::attribute, tangents);
    const osg::ref_ptr<EffectScene> expected = sceneOf(0, without), actual = sceneOf(0, with);
    const osg::ref_ptr<osg::Image> picture = render(actual);
    EXPECT_TRUE(same(*picture, *render(expected)));
    const auto compare = [&](const char* what)
    {
        SCOPED_TRACE(what);
        int hits = 0;
        for (int y = 2; y < HEIGHT; y += 9)
            for (int x = 2; x < WIDTH; x += 9)
            {
                const auto right = DeformedView(*expected, camera).pick(x, y);
                const auto found = DeformedView(*actual, camera).pick(x, y);
                ASSERT_EQ(found.has_value(), right.has_value()) << x << ", " << y;
                if (!found) continue;
                ++hits;
                EXPECT_LT((found->world - right->world).length(), 1e-9) << x << ", " << y;
                EXPECT_FALSE(RigidParts::inForce(found->path));
            }
        EXPECT_GT(hits, 50);
    };
    compare("no define");
    actual->getOrCreateStateSet()->setDefine(RigidParts::define);
    with->getOrCreateStateSet()->setDefine(RigidParts::define, osg::StateAttribute::OFF);
    EXPECT_TRUE(same(*render(actual), *picture));
    compare("off below a scene with it");
}

// Wherever the define is: at the scene, too.
TEST_F(RigidPartsTest, ArePickedWhereTheSceneHasTheDefine)
{
    const osg::Camera& camera = *viewer().getCamera();
    Random random(5);
    std::vector<Box> boxes = randomBoxes(random, 40);
    for (Box& box : boxes)
        box.away.set(random.uniform(-15, 15), random.uniform(-25, 25), 0.0);
    const osg::ref_ptr<osg::Geometry> parts = makeParts(boxes), other = makeParts(boxes);
    const osg::ref_ptr<EffectScene> expected = sceneOf(0, parts), actual = sceneOf(0, other);
    other->setStateSet(nullptr);
    actual->getOrCreateStateSet()->setDefine(RigidParts::define);
    EXPECT_TRUE(same(*render(actual), *render(expected)));
    int hits = 0;
    for (int y = 1; y < HEIGHT; y += 4)
        for (int x = 1; x < WIDTH; x += 4)
        {
            const auto right = DeformedView(*expected, camera).pick(x, y);
            const auto found = DeformedView(*actual, camera).pick(x, y);
            ASSERT_EQ(found.has_value(), right.has_value()) << x << ", " << y;
            if (!found) continue;
            ++hits;
            EXPECT_LT((found->world - right->world).length(), 1e-9) << x << ", " << y;
            EXPECT_TRUE(RigidParts::inForce(found->path));
        }
    EXPECT_GT(hits, 30);
}
