// SPDX-License-Identifier: MIT
// SPDX-FileCopyrightText: 2026 the osgGeoFX authors
//
// Vertex arrays of any type are culled, drawn and lifted as osg::Vec3Array is; and so is what restarts primitives.
#include <tools/CloseUpStage.h>
#include <tools/CullHarness.h>
#include <tools/GlFixture.h>
#include <tools/ImageComparison.h>
#include <tools/VertexTypes.h>

#include <osg/PrimitiveRestartIndex>
#include <osgGeoFX/deformation/BirdsEyeView.h>
#include <osgGeoFX/scene/EffectScene.h>

#include <cmath>
#include <cstring>

using namespace osgGeoFX;
using namespace geofx::test;

namespace
{

constexpr int WIDTH = 160, HEIGHT = 120;
constexpr int cells = 64;

/// 64 × 64 cells of 100 m around the origin, with whole metres of height.
osg::ref_ptr<osg::Vec3Array> makeVertices(bool level)
{
    osg::ref_ptr<osg::Vec3Array> vertices = new osg::Vec3Array;
    for (int j = 0; j <= cells; ++j)
    {
        for (int i = 0; i <= cells; ++i)
        {
            const double height = level ? 0.0 : std::floor(200.0 * std::sin(i / 5.0) * std::cos(j / 7.0));
            vertices->push_back(osg::Vec3(osg::Vec3d(100.0 * i - 3200.0, 100.0 * j - 3200.0, height)));
        }
    }
    return vertices;
}

osg::ref_ptr<osg::DrawElementsUShort> makeTriangles()
{
    osg::ref_ptr<osg::DrawElementsUShort> triangles = new osg::DrawElementsUShort(GL_TRIANGLES);
    for (int j = 0; j < cells; ++j)
    {
        for (int i = 0; i < cells; ++i)
        {
            const int a = j * (cells + 1) + i;
            const int b = a + cells + 1;
            for (const int index : {a, a + 1, b, a + 1, b + 1, b})
                triangles->push_back(static_cast<GLushort>(index));
        }
    }
    return triangles;
}

/// The same triangles as strips, which a restart ends.
osg::ref_ptr<osg::DrawElementsUShort> makeStrips()
{
    osg::ref_ptr<osg::DrawElementsUShort> strips = new osg::DrawElementsUShort(GL_TRIANGLE_STRIP);
    for (int j = 0; j < cells; ++j)
    {
        for (int i = 0; i <= cells; ++i)
        {
            const int a = j * (cells + 1) + i;
            strips->push_back(static_cast<GLushort>(a));
            strips->push_back(static_cast<GLushort>(a + cells + 1));
        }
        strips->push_back(0xFFFF);
    }
    return strips;
}

osg::ref_ptr<osg::Geometry> makeGrid(osg::Array* vertices)
{
    osg::ref_ptr<osg::Vec4Array> colors = new osg::Vec4Array;
    for (int i = 0; i < (cells + 1) * (cells + 1); ++i)
    {
        const auto share = static_cast<float>(i % 97) / 96.0f;
        colors->push_back({share, 1.0f - share, 0.3f + 0.5f * share, 1.0f});
    }
    osg::ref_ptr<osg::Geometry> grid = new osg::Geometry;
    grid->setUseDisplayList(false);
    grid->setUseVertexBufferObjects(true);
    grid->setVertexArray(vertices);
    grid->setColorArray(colors, osg::Array::BIND_PER_VERTEX);
    grid->addPrimitiveSet(makeTriangles());
    grid->getOrCreateStateSet()->setMode(GL_LIGHTING, osg::StateAttribute::OFF);
    return grid;
}

struct GridBox : public osg::Drawable::ComputeBoundingBoxCallback
{
    osg::BoundingBox computeBound(const osg::Drawable&) const override
    {
        return {-3200.0f, -3200.0f, -210.0f, 3200.0f, 3200.0f, 210.0f};
    }
};

osg::ref_ptr<osg::StateSet> restartingState()
{
    osg::ref_ptr<osg::StateSet> state = new osg::StateSet;
    state->setMode(GL_LIGHTING, osg::StateAttribute::OFF);
    state->setAttribute(new osg::PrimitiveRestartIndex(0xFFFF));
    state->setMode(0x8F9D, osg::StateAttribute::ON); // GL_PRIMITIVE_RESTART
    return state;
}

class VertexTypes : public GlFixture, public ::testing::WithParamInterface<VertexType>
{
protected:
    VertexTypes() : GlFixture(WIDTH, HEIGHT) {}

    static osg::ref_ptr<EffectScene> makeScene(osg::Geometry* grid)
    {
        osg::ref_ptr<BirdsEyeView> bend = new BirdsEyeView;
        bend->setHorizonLine(0.8);
        bend->setFocusLine(0.3);
        bend->setContextTilt(0.7);
        osg::ref_ptr<EffectScene> scene = new EffectScene;
        scene->addEffect(bend);
        scene->addChild(grid);
        return scene;
    }

    /// Compares the pictures of two scenes while the camera turns through 360°.
    void turn(osg::Geometry* grid, osg::Geometry* reference, int allowed)
    {
        CullHarness tested(context(), makeScene(grid), WIDTH, HEIGHT);
        CullHarness expected(context(), makeScene(reference), WIDTH, HEIGHT);
        int shown = 0;
        int missing = 0;
        for (int degrees = 0; degrees < 360; degrees += 12)
        {
            SCOPED_TRACE(std::to_string(degrees) + " degrees");
            const double angle = osg::DegreesToRadians(static_cast<double>(degrees));
            const osg::Vec3d eye(-2500.0, 2300.0, 900.0);
            const osg::Matrixd view = osg::Matrixd::lookAt(
                eye, eye + osg::Vec3d(std::sin(angle), std::cos(angle), -0.35), osg::Vec3d(0.0, 0.0, 1.0));
            const osg::Matrixd projection = osg::Matrixd::perspective(40.0, 4.0 / 3.0, 10.0, 20000.0);
            tested.setCamera(view, projection);
            expected.setCamera(view, projection);
            const Culled culled = tested.frame(true);
            const Culled whole = expected.frame(false);
            int differing = 0;
            for (int i = 0; i < WIDTH * HEIGHT; ++i)
                differing +=
                    std::memcmp(culled.image->data() + 3 * i, whole.image->data() + 3 * i, 3) ? 1 : 0;
            EXPECT_LE(differing, allowed);
            (culled.leaves.empty() ? missing : shown) += 1;
        }
        // Culling has something to do.
        EXPECT_GT(shown, 5);
        EXPECT_GT(missing, 0);
    }
};

class LiftedTypes : public CloseUpStage, public ::testing::WithParamInterface<VertexType>
{
protected:
    /// The stage with one close-up whose wall and line go around it, of other ground.
    osg::ref_ptr<osg::Image> drawOf(osg::Geometry* ground, CloseUps::Pipeline pipeline)
    {
        _scene->setChild(0, ground);
        _closeUps->setPipeline(pipeline);
        draw();
        return draw();
    }
    void SetUp() override
    {
        CloseUpStage::SetUp();
        if (IsSkipped() || HasFatalFailure()) return;
        const osg::ref_ptr<CloseUp> closeUp = makeCloseUp({-100.0, 50.0});
        closeUp->getAnchor()->setLineWidth(3.0);
        _closeUps->addCloseUp(closeUp);
    }
    static osg::ref_ptr<osg::Geometry> makeGround(VertexType type, bool level)
    {
        osg::ref_ptr<osg::Geometry> ground = makeHills();
        auto& vertices = static_cast<osg::Vec3Array&>(*ground->getVertexArray());
        for (osg::Vec3& vertex : vertices)
            vertex.set(std::trunc(vertex.x()), std::trunc(vertex.y()), level ? 0.0f : std::trunc(vertex.z()));
        ground->setVertexArray(convertVertices(vertices, type));
        if (isInteger(type)) ground->setComputeBoundingBoxCallback(new GridBox);
        return ground;
    }
};

} // namespace

TEST_P(VertexTypes, AreBentAndCulledAlike)
{
    const bool level = !hasHeight(GetParam());
    const osg::ref_ptr<osg::Vec3Array> vertices = makeVertices(level);
    const osg::ref_ptr<osg::Geometry> grid = makeGrid(convertVertices(*vertices, GetParam()));
    const osg::ref_ptr<osg::Geometry> reference = makeGrid(vertices);
    // OSG finds no bounds of integers.
    if (isInteger(GetParam())) grid->setComputeBoundingBoxCallback(new GridBox);
    // With another last coordinate the focus takes the way of the rest, which rounds otherwise.
    turn(grid, reference, GetParam() == VertexType::ScaledVec4 ? WIDTH * HEIGHT / 50 : 0);
}

TEST_P(LiftedTypes, ShowTheSameCloseUps)
{
    const osg::ref_ptr<osg::Geometry> ground = makeGround(GetParam(), !hasHeight(GetParam()));
    const osg::ref_ptr<osg::Geometry> reference = makeGround(VertexType::Vec3, !hasHeight(GetParam()));
    for (const CloseUps::Pipeline pipeline : {CloseUps::SINGLE_PASS, CloseUps::MULTI_PASS})
    {
        const osg::ref_ptr<osg::Image> expected = drawOf(reference, pipeline);
        ASSERT_EQ(_closeUps->statistics().closeUps, 1);
        EXPECT_TRUE(imagesMatch(*drawOf(ground, pipeline), *expected, {0.01f, 0.002, 1.0f}));
        EXPECT_EQ(_closeUps->statistics().closeUps, 1);
        EXPECT_EQ(_closeUps->statistics().pipeline, pipeline);
    }
}

INSTANTIATE_TEST_SUITE_P(Types, VertexTypes,
                         ::testing::Values(VertexType::Vec2, VertexType::Vec3, VertexType::Vec4,
                                           VertexType::ScaledVec4, VertexType::Vec2d, VertexType::Vec3d,
                                           VertexType::Vec4d, VertexType::Vec3s),
                         [](const auto& tested) { return nameOf(tested.param); });
INSTANTIATE_TEST_SUITE_P(Types, LiftedTypes,
                         ::testing::Values(VertexType::Vec2, VertexType::Vec4, VertexType::Vec3d,
                                           VertexType::Vec4d, VertexType::Vec3s),
                         [](const auto& tested) { return nameOf(tested.param); });

using Restarts = VertexTypes;

TEST_F(Restarts, AreBentAndCulledAsTriangles)
{
    const osg::ref_ptr<osg::Vec3Array> vertices = makeVertices(false);
    const osg::ref_ptr<osg::Geometry> strips = makeGrid(vertices);
    strips->setPrimitiveSet(0, makeStrips());
    strips->setStateSet(restartingState());
    strips->setComputeBoundingBoxCallback(new GridBox);
    // The same triangles from other corners on, which may round otherwise.
    turn(strips, makeGrid(vertices), WIDTH * HEIGHT / 200);
}

using LiftedRestarts = LiftedTypes;

TEST_F(LiftedRestarts, ShowTheSameCloseUps)
{
    const osg::ref_ptr<osg::Geometry> ground = makeGround(VertexType::Vec3, false);
    const auto strips = [&]
    {
        osg::ref_ptr<osg::Geometry> made = makeGround(VertexType::Vec3, false);
        osg::ref_ptr<osg::DrawElementsUShort> indices = new osg::DrawElementsUShort(GL_TRIANGLE_STRIP);
        for (int j = 0; j < 40; ++j)
        {
            // From the last column on, so that the diagonals are the triangles'.
            for (int i = 40; i >= 0; --i)
            {
                indices->push_back(static_cast<GLushort>(j * 41 + i));
                indices->push_back(static_cast<GLushort>((j + 1) * 41 + i));
            }
            indices->push_back(0xFFFF);
        }
        made->setPrimitiveSet(0, indices);
        made->setComputeBoundingBoxCallback(new GridBox);
        made->setStateSet(restartingState());
        return made;
    }();
    ground->getOrCreateStateSet()->setMode(GL_LIGHTING, osg::StateAttribute::OFF);
    for (const CloseUps::Pipeline pipeline : {CloseUps::SINGLE_PASS, CloseUps::MULTI_PASS})
    {
        const osg::ref_ptr<osg::Image> expected = drawOf(ground, pipeline);
        EXPECT_TRUE(imagesMatch(*drawOf(strips, pipeline), *expected, {0.03f, 0.01, 1.0f}));
        EXPECT_EQ(_closeUps->statistics().closeUps, 1);
    }
}
