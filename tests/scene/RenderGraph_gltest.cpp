// SPDX-License-Identifier: MIT
// SPDX-FileCopyrightText: 2026 the osgGeoFX authors
//
// What nodes put into the render graph by themselves, and nodes whose state alone matters: deformed, lifted into close-ups, left
// out, clipped and cleared as everything else.
#include <tools/BentGround.h>
#include <tools/CloseUpStage.h>
#include <tools/CullHarness.h>
#include <tools/ImageComparison.h>

#include <osg/Billboard>
#include <osg/ClearNode>
#include <osg/ClipNode>
#include <osg/ComputeBoundsVisitor>
#include <osg/Depth>
#include <osg/Geode>
#include <osg/LightSource>
#include <osg/MatrixTransform>
#include <osg/Projection>
#include <osg/TexGenNode>
#include <osgGeoFX/closeup/CloseUpPicking.h>
#include <osgGeoFX/deformation/PedestrianView.h>
#include <osgGeoFX/scene/DeformedView.h>
#include <osgSim/LightPointNode>
#include <osgText/Text>

#include <cmath>
#include <cstring>

using namespace osgGeoFX;
using namespace geofx::test;

namespace
{

/// Pixels of a color: how many, and where. A smooth point is nowhere quite opaque with NVIDIA's driver.
struct Patch
{
    int count = 0;
    int left = 10000, right = -1, low = 10000, high = -1;
    osg::Vec2d center;

    Patch(const osg::Image& image, const osg::Vec3ub& color)
    {
        for (int y = 0; y < image.t(); ++y)
        {
            for (int x = 0; x < image.s(); ++x)
            {
                const unsigned char* pixel =
                    image.data(static_cast<unsigned int>(x), static_cast<unsigned int>(y));
                if (std::abs(pixel[0] - color.r()) + std::abs(pixel[1] - color.g()) +
                        std::abs(pixel[2] - color.b()) >
                    90)
                    continue;
                ++count;
                left = std::min(left, x);
                right = std::max(right, x);
                low = std::min(low, y);
                high = std::max(high, y);
                center += osg::Vec2d(x + 0.5, y + 0.5);
            }
        }
        if (count > 0) center /= count;
    }
};

const osg::Vec3ub magenta(255, 0, 255);

osg::ref_ptr<osg::Geometry> makeSign(double size)
{
    const osg::Vec3 across(osg::Vec3d(size, 0.0, 0.0)), up(osg::Vec3d(0.0, 0.0, size));
    osg::ref_ptr<osg::Geometry> sign = osg::createTexturedQuadGeometry(across * -0.5f, across, up);
    static_cast<osg::Vec4Array&>(*sign->getColorArray())[0].set(1.0f, 0.0f, 1.0f, 1.0f);
    sign->getOrCreateStateSet()->setMode(GL_LIGHTING, osg::StateAttribute::OFF);
    return sign;
}

osg::ref_ptr<osg::Billboard> makeBillboard(osg::Billboard::Mode mode, const osg::Vec3d& place, double size)
{
    osg::ref_ptr<osg::Billboard> billboard = new osg::Billboard;
    billboard->setMode(mode);
    billboard->addDrawable(makeSign(size), osg::Vec3(place));
    return billboard;
}

osg::ref_ptr<osgSim::LightPointNode> makeLights(const std::vector<osg::Vec3d>& places, float size)
{
    osg::ref_ptr<osgSim::LightPointNode> lights = new osgSim::LightPointNode;
    lights->setMinPixelSize(size);
    lights->setMaxPixelSize(size + 1.0f);
    for (const osg::Vec3d& place : places)
    {
        osgSim::LightPoint light(true, osg::Vec3(place), osg::Vec4(1, 0, 1, 1), 1.0f);
        light._blendingMode = osgSim::LightPoint::BLENDED;
        lights->addLightPoint(light);
    }
    return lights;
}

class RenderGraph : public BentGround
{
protected:
    /// Where a place is seen, pixels.
    osg::Vec2d pixelOf(EffectScene& scene, const osg::Vec3d& place)
    {
        osg::Vec2d pixel;
        EXPECT_TRUE(DeformedView(scene, *viewer().getCamera()).project(place, pixel));
        return pixel;
    }
    static osg::ref_ptr<EffectScene> makeWalk(const osg::ref_ptr<osg::Node>& child)
    {
        const osg::ref_ptr<PedestrianView> walk = new PedestrianView;
        walk->setFocusDistance(80);
        walk->setZoneWidth(60);
        osg::ref_ptr<EffectScene> scene = new EffectScene;
        scene->addEffect(walk);
        scene->addChild(child);
        return scene;
    }
};

class LiftedGraph : public CloseUpStage
{
protected:
    void SetUp() override
    {
        CloseUpStage::SetUp();
        if (IsSkipped() || HasFatalFailure()) return;
        _closeUp = makeCloseUp({0.0, 0.0});
        _closeUps->addCloseUp(_closeUp);
    }
    osg::Vec2d liftedPixel(const osg::Vec3d& place)
    {
        const auto pixel = projectCloseUp(*_scene, *_closeUp, *viewer().getCamera(), place, 0.0);
        EXPECT_TRUE(pixel);
        return pixel.value_or(osg::Vec2d());
    }
    /// With the pipeline's change told or not.
    osg::ref_ptr<osg::Image> drawQuietly()
    {
        osg::ref_ptr<osg::Image> image;
        watch().messagesOf(
            [&]
            {
                draw();
                image = draw();
            });
        return image;
    }
    osg::ref_ptr<CloseUp> _closeUp;
};

} // namespace

// ------------------------------------------------------------------------------------------------ billboards and lights

TEST_F(RenderGraph, BillboardsAreBent)
{
    for (const osg::Billboard::Mode mode :
         {osg::Billboard::POINT_ROT_EYE, osg::Billboard::POINT_ROT_WORLD, osg::Billboard::AXIAL_ROT})
    {
        SCOPED_TRACE(mode);
        const osg::Vec3d place(20, 90, 2);
        const osg::ref_ptr<osg::Billboard> billboard = makeBillboard(mode, place, 24.0);
        const osg::ref_ptr<EffectScene> scene = makeScene({billboard});
        const osg::Vec2d foot = pixelOf(*scene, place);
        const Patch patch(*render(scene), magenta);
        ASSERT_GT(patch.count, 20);
        // Its foot's middle is its place, and it faces the eye from where it stands.
        EXPECT_NEAR(patch.low, foot.y(), 1.5);
        EXPECT_NEAR(patch.center.x(), foot.x(), 1.5);
        const double width = patch.right - patch.left + 1;
        const double height = patch.high - patch.low + 1;
        if (mode == osg::Billboard::POINT_ROT_EYE)
        {
            EXPECT_NEAR(width / height, 1.0, 0.2);
        }
        // Elsewhere than without the bend.
        const Patch plain(*render(makePlain({billboard})), magenta);
        EXPECT_GT((plain.center - patch.center).length(), 4.0);
        // It is picked where it is seen.
        const auto hit = DeformedView(*scene, *viewer().getCamera()).pick(patch.center.x(), patch.center.y());
        ASSERT_TRUE(hit);
        EXPECT_EQ(hit->drawable, billboard->getDrawable(0));
    }
}

TEST_F(RenderGraph, BillboardsAreCulledByWhereTheyAreSeen)
{
    // Undeformed it is above the picture, deformed in it; and the other way round.
    const osg::Vec3d high(0, 130, 40), low(0, 130, 0);
    const auto billboard = [](const osg::Vec3d& place)
    {
        return makeBillboard(osg::Billboard::POINT_ROT_EYE, place, 20.0);
    };
    EXPECT_EQ(covered(*render(makePlain({billboard(high)}))), 0);
    EXPECT_GT(covered(*render(makeScene({billboard(high)}))), 20);
    EXPECT_GT(covered(*render(makePlain({billboard(low)}))), 20);
    EXPECT_EQ(covered(*render(makeWalk(billboard(low)))), 0);
    // Near and far hold them.
    viewer().getCamera()->setComputeNearFarMode(osg::CullSettings::COMPUTE_NEAR_FAR_USING_BOUNDING_VOLUMES);
    EXPECT_GT(covered(*render(makeScene({billboard(high)}))), 20);
}

TEST_F(RenderGraph, LightPointsAreBent)
{
    const std::vector<osg::Vec3d> places = {{20, 90, 2}, {-40, 110, 5}, {30, 60, 3}};
    for (const bool lit : {false, true})
    {
        SCOPED_TRACE(lit);
        for (const osg::Vec3d& place : places)
        {
            const osg::ref_ptr<EffectScene> scene = makeScene({makeLights({place}, 5.0f)});
            if (lit) scene->getOrCreateStateSet()->setMode(GL_LIGHTING, osg::StateAttribute::ON);
            const osg::Vec2d expected = pixelOf(*scene, place);
            const Patch patch(*render(scene), magenta);
            EXPECT_GT(patch.count, 5);
            EXPECT_LT((patch.center - expected).length(), 1.0) << patch.center.x() << ' ' << patch.center.y();
        }
    }
    // All together, of two nodes that share their state, beside other geometry, frame after frame.
    const osg::ref_ptr<EffectScene> scene =
        makeScene({makeGround(), makeLights({places[0]}, 5.0f), makeLights({places[1], places[2]}, 5.0f)});
    for (int frame = 0; frame < 3; ++frame)
    {
        const osg::ref_ptr<osg::Image> image = render(scene);
        for (const osg::Vec3d& place : places)
        {
            const osg::Vec2d at = pixelOf(*scene, place);
            const unsigned char* pixel =
                image->data(static_cast<unsigned int>(at.x()), static_cast<unsigned int>(at.y()));
            EXPECT_GT(pixel[0], 200);
            EXPECT_LT(pixel[1], 60);
            EXPECT_GT(pixel[2], 200);
        }
    }
    // Near and far hold them where there is nothing else.
    viewer().getCamera()->setComputeNearFarMode(osg::CullSettings::COMPUTE_NEAR_FAR_USING_BOUNDING_VOLUMES);
    EXPECT_GT(Patch(*render(makeScene({makeLights(places, 5.0f)})), magenta).count, 15);
}

TEST_F(LiftedGraph, BillboardsAreLifted)
{
    const osg::Vec3d place(30.0, -40.0, groundHeight(30.0, -40.0));
    _scene->addChild(makeBillboard(osg::Billboard::POINT_ROT_EYE, place, 120.0));
    const osg::Vec2d foot = liftedPixel(place);
    osg::ref_ptr<osg::Image> former;
    for (const CloseUps::Pipeline pipeline : {CloseUps::MULTI_PASS, CloseUps::SINGLE_PASS})
    {
        SCOPED_TRACE(pipeline);
        _closeUps->setPipeline(pipeline);
        const osg::ref_ptr<osg::Image> image = drawQuietly();
        ASSERT_EQ(_closeUps->statistics().closeUps, 1);
        const unsigned char* pixel =
            image->data(static_cast<unsigned int>(foot.x()), static_cast<unsigned int>(foot.y()) + 3);
        EXPECT_GT(pixel[0], 200);
        EXPECT_LT(pixel[1], 60);
        if (former)
        {
            EXPECT_LT(differing(*image, *former), 0.002);
        }
        former = image;
        // The one on the ground is still there, once.
        const Patch both(*image, magenta);
        EXPECT_LT(both.low, foot.y() - 10);
    }
}

TEST_F(LiftedGraph, LightPointsAreLifted)
{
    const osg::Vec3d place(30.0, -40.0, groundHeight(30.0, -40.0) + 12.0);
    const auto pixelAt = [](const osg::Image& image, const osg::Vec2d& at)
    {
        const unsigned char* pixel =
            image.data(static_cast<unsigned int>(at.x()), static_cast<unsigned int>(at.y()));
        return osg::Vec3i(pixel[0], pixel[1], pixel[2]);
    };
    for (const CloseUps::Pipeline pipeline : {CloseUps::MULTI_PASS, CloseUps::AUTOMATIC})
    {
        SCOPED_TRACE(pipeline);
        _closeUps->setPipeline(pipeline);
        EXPECT_GT(pixelAt(*drawQuietly(), liftedPixel(place)).y(), 100) << "the ground alone";
        const osg::ref_ptr<osgSim::LightPointNode> lights = makeLights({place}, 7.0f);
        _scene->addChild(lights);
        const osg::Vec3i lifted = pixelAt(*drawQuietly(), liftedPixel(place));
        EXPECT_GT(lifted.x(), 180);
        EXPECT_LT(lifted.y(), 100);
        EXPECT_GT(lifted.z(), 180);
        _scene->removeChild(lights);
    }
}

// -------------------------------------------------------------------------------------- nodes whose state alone matters

TEST_F(RenderGraph, NodesThatOsgDoesNotCullAreLeftOutToo)
{
    const osg::Vec3d low(0, 130, 0), high(0, 130, 40);
    const osg::ref_ptr<osg::Image> plain = render(makePlain({makeBox(8, low)}));
    EXPECT_GT(covered(*plain), 0);
    const std::vector<osg::ref_ptr<osg::Group>> nodes = {new osg::LightSource, new osg::ClipNode,
                                                         new osg::TexGenNode, new osg::ClearNode};
    for (const osg::ref_ptr<osg::Group>& node : nodes)
    {
        SCOPED_TRACE(node->className());
        if (auto* clear = dynamic_cast<osg::ClearNode*>(node.get()))
            clear->setClearColor(viewer().getCamera()->getClearColor());
        const osg::ref_ptr<osg::Group> parent = makePlain({makePlain({makeBox(8, low)})});
        node->addChild(parent);
        // Folded out of the picture, but for what is left out.
        EXPECT_EQ(covered(*render(makeWalk(node))), 0);
        node->getOrCreateStateSet()->setDefine("GEOFX_DEFORMATION", osg::StateAttribute::OFF);
        EXPECT_TRUE(same(*render(makeWalk(node)), *plain));
        EXPECT_TRUE(same(*render(makeWalk(makePlain({makePlain({node})}))), *plain));
        node->removeChildren(0, 1);
        node->addChild(makeBox(20, high));
        EXPECT_EQ(covered(*render(makeScene({node}))), 0);
        node->getOrCreateStateSet()->setDefine("GEOFX_DEFORMATION", osg::StateAttribute::ON);
        EXPECT_GT(covered(*render(makeScene({node}))), 0);
    }
}

// What is left out needs no more than to say so, wherever it stands.
TEST_F(RenderGraph, LeftOutBelowGroupsThatAreBentOutOfSight)
{
    const osg::Vec3d low(0, 130, 0);
    const osg::ref_ptr<osg::Image> plain = render(makePlain({makeBox(8, low)}));
    const osg::ref_ptr<osg::Group> box = makeBox(8, low);
    const osg::ref_ptr<EffectScene> scene = makeWalk(makePlain({makePlain({box})}));
    EXPECT_EQ(covered(*render(scene)), 0);
    box->getChild(0)->getOrCreateStateSet()->setDefine("GEOFX_DEFORMATION", osg::StateAttribute::OFF);
    // What was looked at before is looked at again after some frames.
    osg::ref_ptr<osg::Image> image;
    for (int frame = 0; frame < 32; ++frame)
        image = render(scene);
    EXPECT_TRUE(same(*image, *plain));
}

namespace
{

/// A sky behind all else, in the place of clearing: what a ClearNode that clears nothing is for.
osg::ref_ptr<osg::Projection> makeSky(const osg::Vec4& color)
{
    const osg::ref_ptr<osg::Geometry> square =
        osg::createTexturedQuadGeometry({-1.0f, -1.0f, 0.0f}, {2.0f, 0.0f, 0.0f}, {0.0f, 2.0f, 0.0f});
    const osg::ref_ptr<osg::Vec4Array> colors = new osg::Vec4Array(1);
    colors->front() = color;
    square->setColorArray(colors, osg::Array::BIND_OVERALL);
    square->setCullingActive(false);
    osg::StateSet* state = square->getOrCreateStateSet();
    state->setAttributeAndModes(new osg::Depth(osg::Depth::ALWAYS, 1.0, 1.0));
    state->setMode(GL_LIGHTING, osg::StateAttribute::OFF);
    state->setRenderBinDetails(-100, "RenderBin");
    const osg::ref_ptr<osg::MatrixTransform> transform = new osg::MatrixTransform;
    transform->setReferenceFrame(osg::Transform::ABSOLUTE_RF);
    transform->setCullingActive(false);
    transform->addChild(square);
    const osg::ref_ptr<osg::Projection> sky = new osg::Projection(osg::Matrix());
    sky->setCullingActive(false);
    sky->addChild(transform);
    return sky;
}

} // namespace

TEST_F(LiftedGraph, ClearNodesClearThePictureAlone)
{
    osg::ref_ptr<osg::ClearNode> clear = new osg::ClearNode;
    clear->setClearColor({0.1f, 0.2f, 0.3f, 1.0f});
    // Else what a layer is cleared with lies behind the ground.
    _closeUps->setDepthTest(false);
    for (const CloseUps::Pipeline pipeline : {CloseUps::SINGLE_PASS, CloseUps::MULTI_PASS})
    {
        SCOPED_TRACE(pipeline);
        _closeUps->setPipeline(pipeline);
        const osg::ref_ptr<osg::Image> expected = draw();
        _scene->addChild(clear);
        EXPECT_TRUE(same(*draw(), *expected));
        _scene->removeChild(clear);
        EXPECT_EQ(_closeUps->statistics().closeUps, 1);
    }
}

// Without clearing, layers would keep what earlier frames have drawn.
TEST_F(LiftedGraph, LayersAreClearedWhereThePictureIsNot)
{
    _root->addChild(makeSky({0.6f, 0.7f, 0.9f, 1.0f}));
    osg::ref_ptr<osg::ClearNode> clear = new osg::ClearNode;
    clear->setRequiresClear(false);
    const osg::Vec3d here = _closeUp->getOffset();
    for (const CloseUps::Pipeline pipeline : {CloseUps::SINGLE_PASS, CloseUps::MULTI_PASS})
    {
        SCOPED_TRACE(pipeline);
        _closeUps->setPipeline(pipeline);
        const osg::ref_ptr<osg::Image> expected = draw();
        _scene->addChild(clear);
        // Elsewhere for a while.
        _closeUp->setOffset(here + osg::Vec3d(60.0, 40.0, 30.0));
        EXPECT_GT(differing(*draw(), *expected), 0.005);
        _closeUp->setOffset(here);
        const osg::ref_ptr<osg::Image> image = draw();
        EXPECT_TRUE(same(*image, *expected)) << differing(*image, *expected);
        _scene->removeChild(clear);
        EXPECT_EQ(_closeUps->statistics().closeUps, 1);
    }
}

// A plane between the eye and all that it sees: what has no place in the world must not be cut by it.
TEST_F(LiftedGraph, PlanesAboveTheSceneCutTheGroundAlone)
{
    const auto clipped = [&](const osg::Vec4d& plane)
    {
        osg::ref_ptr<osg::ClipNode> clip = new osg::ClipNode;
        clip->addClipPlane(new osg::ClipPlane(0, plane));
        clip->addChild(_root);
        clip->setStateSetModes(*clip->getOrCreateStateSet(), osg::StateAttribute::ON);
        render(clip);
        return render(clip);
    };
    _closeUp->getAnchor()->setLineWidth(2.0);
    for (const CloseUps::Pipeline pipeline : {CloseUps::SINGLE_PASS, CloseUps::MULTI_PASS})
    {
        SCOPED_TRACE(pipeline);
        _closeUps->setPipeline(pipeline);
        draw();
        const osg::ref_ptr<osg::Image> expected = draw();
        // The eye is at y = -1800, the ground begins at -1000.
        EXPECT_LT(differing(*clipped({0.0, 1.0, 0.0, 1400.0}), *expected), 0.002);
        // Half of the region is cut off, and of the close-up, too.
        const osg::ref_ptr<osg::Image> half = clipped({1.0, 0.0, 0.0, 0.0});
        const osg::Vec2d kept = liftedPixel({120.0, 0.0, groundHeight(120.0, 0.0)});
        const osg::Vec2d cut = liftedPixel({-120.0, 0.0, groundHeight(-120.0, 0.0)});
        const auto sameAt = [&](const osg::Vec2d& at)
        {
            const auto x = static_cast<unsigned int>(at.x()), y = static_cast<unsigned int>(at.y());
            return std::memcmp(half->data(x, y), expected->data(x, y), 3) == 0;
        };
        EXPECT_TRUE(sameAt(kept));
        EXPECT_FALSE(sameAt(cut));
    }
}

// ------------------------------------------------------------------------------------------------- what is small, or new

TEST_F(RenderGraph, DrawablesAreNotTooSmallByThemselves)
{
    const auto point = []
    {
        osg::ref_ptr<osg::Vec3Array> vertices = new osg::Vec3Array(1);
        vertices->front().set(10.0f, -80.0f, 4.0f);
        osg::ref_ptr<osg::Vec4Array> colors = new osg::Vec4Array(1);
        colors->front().set(1.0f, 0.0f, 1.0f, 1.0f);
        osg::ref_ptr<osg::Geometry> geometry = new osg::Geometry;
        geometry->setVertexArray(vertices);
        geometry->setColorArray(colors, osg::Array::BIND_OVERALL);
        geometry->addPrimitiveSet(new osg::DrawArrays(GL_POINTS, 0, 1));
        return geometry;
    }();
    const osg::ref_ptr<osgText::Text> text = new osgText::Text;
    text->setText("i");
    text->setCharacterSize(0.1f);
    text->setPosition({-10.0f, -80.0f, 4.0f});
    const osg::ref_ptr<osg::Geode> geode = new osg::Geode;
    geode->addDrawable(makeGround());
    geode->addDrawable(point);
    geode->addDrawable(text);
    const osg::ref_ptr<osg::Geometry> other(
        static_cast<osg::Geometry*>(point->clone(osg::CopyOp::SHALLOW_COPY)));
    const osg::ref_ptr<osg::MatrixTransform> transform = new osg::MatrixTransform;
    transform->addChild(makeBox(30));
    transform->addChild(other);
    // Alone below a node it is as small as the node.
    const osg::ref_ptr<osg::Geometry> alone(
        static_cast<osg::Geometry*>(point->clone(osg::CopyOp::SHALLOW_COPY)));
    const osg::ref_ptr<osg::MatrixTransform> lonely = new osg::MatrixTransform;
    lonely->addChild(alone);
    const std::vector<osg::ref_ptr<osg::Node>> things = {geode, transform, lonely};
    const auto drawn = [&](const osg::ref_ptr<osg::Group>& scene)
    {
        CullHarness harness(context(), scene, WIDTH, HEIGHT);
        harness.setCamera(viewer().getCamera()->getViewMatrix(), viewer().getCamera()->getProjectionMatrix());
        std::set<const osg::Drawable*> result;
        watch().messagesOf([&] { result = harness.frame(true, false).drawables(); });
        return result;
    };
    const std::set<const osg::Drawable*> expected = drawn(makePlain(things));
    EXPECT_EQ(expected.size(), 5u);
    EXPECT_EQ(drawn(makeScene(things)), expected);
}

TEST_F(RenderGraph, NewArraysAreSeen)
{
    // The ground's triangles in a corner that the camera does not see, and then in its picture.
    const auto vertices = [](const osg::Vec3& by)
    {
        osg::ref_ptr<osg::Vec3Array> moved = new osg::Vec3Array;
        for (int i = 0; i <= 40 * 41; ++i)
            moved->push_back(
                osg::Vec3(0.5f * static_cast<float>(i % 41), 0.5f * static_cast<float>(i / 41), 0.0f) + by);
        return moved;
    };
    osg::ref_ptr<osg::DrawElementsUInt> triangles = new osg::DrawElementsUInt(GL_TRIANGLES);
    for (GLuint i = 0; i + 42 < 40 * 41; ++i)
    {
        for (const GLuint index : {i, i + 1, i + 41, i + 1, i + 42, i + 41})
            triangles->push_back(index);
    }
    const osg::ref_ptr<osg::Geometry> mesh = new osg::Geometry;
    mesh->setUseDisplayList(false);
    mesh->addPrimitiveSet(triangles);
    // Far points keep the box as it is, with its middle beside the picture, so that the smaller boxes decide.
    const auto far = [](const osg::ref_ptr<osg::Vec3Array>& array)
    {
        array->push_back({-400.0f, -90.0f, 0.0f});
        array->push_back({-400.0f, -91.0f, 0.0f});
        array->push_back({100.0f, -91.0f, 0.0f});
        array->push_back({100.0f, -91.0f, 0.5f});
        return array;
    };
    for (const GLuint index : {1641u, 1642u, 1642u, 1643u, 1644u, 1644u})
        triangles->push_back(index);
    mesh->setVertexArray(far(vertices({-300.0f, -100.0f, 0.0f})));
    const osg::ref_ptr<EffectScene> scene = makeScene({makeGround(), mesh});
    CullHarness harness(context(), scene, WIDTH, HEIGHT);
    harness.setCamera(viewer().getCamera()->getViewMatrix(), viewer().getCamera()->getProjectionMatrix());
    EXPECT_EQ(harness.frame(true, false).drawables().count(mesh), 0u);
    const unsigned int modified = mesh->getVertexArray()->getModifiedCount();
    mesh->setVertexArray(far(vertices({-10.0f, -80.0f, 0.0f})));
    ASSERT_EQ(mesh->getVertexArray()->getModifiedCount(), modified);
    EXPECT_EQ(harness.frame(true, false).drawables().count(mesh), 1u);
}

TEST_F(LiftedGraph, NewArraysAreSeen)
{
    _closeUp->getAnchor()->setLineWidth(2.0);
    const osg::ref_ptr<osg::Geometry> kept = _scene->getChild(0)->asGeometry();
    osg::Geometry& hills = *kept;
    // New arrays get a buffer of their own: Mesa frowns on more that is written into one.
    const auto apart = [](osg::Array& array)
    {
        array.setVertexBufferObject(new osg::VertexBufferObject);
    };
    for (const CloseUps::Pipeline pipeline : {CloseUps::SINGLE_PASS, CloseUps::MULTI_PASS})
    {
        SCOPED_TRACE(pipeline);
        _closeUps->setPipeline(pipeline);
        draw();
        const osg::ref_ptr<osg::Image> before = draw();
        // Another color.
        const osg::ref_ptr<osg::Array> white = hills.getColorArray();
        osg::ref_ptr<osg::Vec4Array> red = new osg::Vec4Array(1);
        red->front().set(1.0f, 0.1f, 0.1f, 1.0f);
        apart(*red);
        hills.setColorArray(red, osg::Array::BIND_OVERALL);
        draw();
        const osg::ref_ptr<osg::Image> colored = draw();
        // Other heights.
        const osg::ref_ptr<osg::Array> former = hills.getVertexArray();
        const osg::ref_ptr<osg::Vec3Array> steeper =
            new osg::Vec3Array(static_cast<const osg::Vec3Array&>(*former));
        for (osg::Vec3& vertex : *steeper)
            vertex.z() *= 2.0f;
        apart(*steeper);
        while (steeper->getModifiedCount() < former->getModifiedCount())
            steeper->dirty();
        hills.setVertexArray(steeper);
        draw();
        const osg::ref_ptr<osg::Image> moved = draw();

        // As a scene that never knew others shows them.
        const osg::ref_ptr<CloseUps> fresh = new CloseUps;
        fresh->addCloseUp(_closeUp);
        fresh->setPipeline(pipeline);
        const osg::ref_ptr<osg::Geometry> copy = new osg::Geometry(hills, osg::CopyOp::SHALLOW_COPY);
        _scene->removeEffect(_closeUps);
        _scene->addEffect(fresh);
        _scene->setChild(0, copy);
        draw();
        EXPECT_TRUE(same(*draw(), *moved));
        copy->setVertexArray(former);
        draw();
        EXPECT_TRUE(same(*draw(), *colored));
        EXPECT_GT(differing(*before, *colored), 0.1);
        EXPECT_GT(differing(*moved, *colored), 0.1);
        _scene->removeEffect(fresh);
        _scene->addEffect(_closeUps);
        _scene->setChild(0, &hills);
        hills.setVertexArray(former);
        hills.setColorArray(white, osg::Array::BIND_OVERALL);
    }
}

// ---------------------------------------------------------------------------------- geometry that vertices do not tell of

namespace
{

/// Forty by forty cells of half a metre, drawn elsewhere by their shader: at the end of a row of five, or all by an offset.
osg::ref_ptr<osg::Geometry> makeDisplaced(EffectScene& scene, bool instances)
{
    osg::ref_ptr<osg::Vec3Array> vertices = new osg::Vec3Array;
    for (int i = 0; i <= 40 * 41; ++i)
        vertices->push_back(
            {0.5f * static_cast<float>(i % 41) - 200.0f, 0.5f * static_cast<float>(i / 41) - 90.0f, 0});
    osg::ref_ptr<osg::DrawElementsUInt> triangles = new osg::DrawElementsUInt(GL_TRIANGLES);
    for (GLuint i = 0; i + 42 < 40 * 41; ++i)
    {
        for (const GLuint index : {i, i + 1, i + 41, i + 1, i + 42, i + 41})
            triangles->push_back(index);
    }
    if (instances) triangles->setNumInstances(5);
    osg::ref_ptr<osg::Geometry> mesh = new osg::Geometry;
    mesh->setUseDisplayList(false);
    mesh->setUseVertexBufferObjects(true);
    mesh->setVertexArray(vertices);
    mesh->addPrimitiveSet(triangles);
    mesh->setInitialBound(osg::BoundingBox(-200, -90, -5, 60, -70, 5));
    osg::ref_ptr<osg::Program> program = new osg::Program;
    program->addShader(new osg::Shader(
        osg::Shader::VERTEX, std::string("#version 330 compatibility\nvec4 geofx_vertex(vec4 eye);\n"
                                         "void main() {\n    vec4 at = gl_Vertex;\n    at.x += ") +
                                 (instances ? "50.0 * float(gl_InstanceID)" : "200.0") +
                                 ";\n    gl_Position = gl_ProjectionMatrix * "
                                 "geofx_vertex(gl_ModelViewMatrix * at);\n}\n"));
    program->addShader(
        new osg::Shader(osg::Shader::FRAGMENT,
                        "#version 330 compatibility\nvoid main() { gl_FragColor = vec4(1, 0, 1, 1); }\n"));
    scene.addFunctions(*program);
    mesh->getOrCreateStateSet()->setAttribute(program);
    return mesh;
}

} // namespace

TEST_F(RenderGraph, InstancesAndDisplacedGeometryAreCulledByTheirBound)
{
    for (const bool instances : {true, false})
    {
        SCOPED_TRACE(instances ? "instances" : "displaced");
        const osg::ref_ptr<EffectScene> scene = makeScene({});
        const osg::ref_ptr<osg::Geometry> mesh = makeDisplaced(*scene, instances);
        scene->addChild(mesh);
        const Patch patch(*render(scene), magenta);
        EXPECT_GT(patch.count, 100);
        // Where the vertices say, nothing would be in the picture.
        mesh->getStateSet()->removeAttribute(osg::StateAttribute::PROGRAM);
        mesh->setInitialBound(osg::BoundingBox());
        mesh->getPrimitiveSet(0)->setNumInstances(0);
        EXPECT_EQ(covered(*render(scene)), 0);
    }
}
