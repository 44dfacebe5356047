// SPDX-License-Identifier: MIT
// SPDX-FileCopyrightText: 2026 the osgGeoFX authors
//
// Triangles are read of vertices of any type, with primitive restart and with indices beyond the array; and picking, which
// reads them, finds the same ground whatever the type.
#include <tools/VertexTypes.h>

#include <gtest/gtest.h>
#include <osg/Camera>
#include <osg/Geode>
#include <osg/PrimitiveRestartIndex>
#include <osg/View>
#include <osgGeoFX/effect/detail/DrawableTriangles.h>
#include <osgGeoFX/scene/DeformedIntersector.h>

#include <array>
#include <cmath>

using namespace osgGeoFX;
using namespace geofx::test;

namespace
{

using Triangle = std::array<unsigned int, 3>;

/// The first so many vertices of a zigzag: (0, 0), (0, 1), (1, 0), (1, 1), (2, 0) …
osg::ref_ptr<osg::Geometry> makeZigzag(unsigned int count)
{
    osg::ref_ptr<osg::Vec3Array> vertices = new osg::Vec3Array;
    for (unsigned int i = 0; i < count; ++i)
    {
        const auto column = static_cast<float>(i / 2);
        vertices->push_back({column, static_cast<float>(i % 2), column * column});
    }
    osg::ref_ptr<osg::Geometry> geometry = new osg::Geometry;
    geometry->setVertexArray(vertices);
    return geometry;
}

std::vector<Triangle> trianglesOf(const osg::Drawable& drawable)
{
    const DrawableTriangles read(drawable);
    EXPECT_EQ(read.corners().size() % 3, 0u);
    std::vector<Triangle> triangles;
    for (std::size_t i = 0; i + 2 < read.corners().size(); i += 3)
        triangles.push_back({read.corners()[i], read.corners()[i + 1], read.corners()[i + 2]});
    for (const unsigned int corner : read.corners())
        EXPECT_LT(corner, read.positions().size());
    return triangles;
}

template<typename Indices>
std::vector<Triangle> trianglesOf(GLenum mode, const std::vector<unsigned int>& indices, osg::StateSet* state,
                                  unsigned int vertices = 8)
{
    const osg::ref_ptr<osg::Geometry> geometry = makeZigzag(vertices);
    const osg::ref_ptr<Indices> primitives = new Indices(mode);
    for (const unsigned int index : indices)
        primitives->push_back(static_cast<typename Indices::value_type>(index));
    geometry->addPrimitiveSet(primitives);
    geometry->setStateSet(state);
    return trianglesOf(*geometry);
}

std::vector<Triangle> asElements(GLenum mode, const std::vector<unsigned int>& indices,
                                 osg::StateSet* state = nullptr)
{
    return trianglesOf<osg::DrawElementsUShort>(mode, indices, state);
}

osg::ref_ptr<osg::StateSet> restartAt(unsigned int index)
{
    osg::ref_ptr<osg::StateSet> state = new osg::StateSet;
    state->setAttribute(new osg::PrimitiveRestartIndex(index));
    state->setMode(0x8F9D, osg::StateAttribute::ON);
    return state;
}

osg::ref_ptr<osg::DrawElementsUShort> strip(std::initializer_list<GLushort> indices)
{
    osg::ref_ptr<osg::DrawElementsUShort> primitives = new osg::DrawElementsUShort(GL_TRIANGLE_STRIP);
    primitives->insert(primitives->end(), indices.begin(), indices.end());
    return primitives;
}

/// Picks along the z axis from above, at a place.
std::vector<osg::Vec3d> pick(osg::Node& node, double x, double y)
{
    const osg::ref_ptr<DeformedLineIntersector> line =
        new DeformedLineIntersector({x, y, 1000.0}, {0.0, 0.0, -1.0});
    const osg::ref_ptr<DeformationChain> chain = new DeformationChain;
    const osg::ref_ptr<DeformedIntersectionVisitor> visitor =
        new DeformedIntersectionVisitor(line, *chain, osg::Matrixd(), 1.0);
    node.accept(*visitor);
    std::vector<osg::Vec3d> hits;
    for (const auto& each : line->intersections())
        hits.push_back(each.world);
    return hits;
}

struct GivenBox : public osg::Drawable::ComputeBoundingBoxCallback
{
    osg::BoundingBox computeBound(const osg::Drawable&) const override
    {
        return {0.0f, 0.0f, 0.0f, 10.0f, 1.0f, 100.0f};
    }
};

} // namespace

TEST(DrawableTriangles, AreThoseOfOpenGl)
{
    const std::vector<unsigned int> six = {0, 1, 2, 3, 4, 5};
    using All = std::vector<Triangle>;
    EXPECT_EQ(asElements(GL_TRIANGLES, six), (All{{0, 1, 2}, {3, 4, 5}}));
    EXPECT_EQ(asElements(GL_TRIANGLE_STRIP, six), (All{{0, 1, 2}, {1, 3, 2}, {2, 3, 4}, {3, 5, 4}}));
    EXPECT_EQ(asElements(GL_TRIANGLE_FAN, six), (All{{0, 1, 2}, {0, 2, 3}, {0, 3, 4}, {0, 4, 5}}));
    EXPECT_EQ(asElements(GL_POLYGON, six), asElements(GL_TRIANGLE_FAN, six));
    EXPECT_EQ(asElements(GL_QUADS, six), (All{{0, 1, 2}, {0, 2, 3}}));
    EXPECT_EQ(asElements(GL_QUAD_STRIP, six), (All{{0, 1, 2}, {1, 3, 2}, {2, 3, 4}, {3, 5, 4}}));
    EXPECT_EQ(asElements(GL_LINES, six), All{});
    // What is incomplete is not drawn.
    EXPECT_EQ(asElements(GL_TRIANGLES, {0, 1, 2, 3, 4}), (All{{0, 1, 2}}));
    EXPECT_EQ(asElements(GL_TRIANGLE_STRIP, {0, 1}), All{});
}

TEST(DrawableTriangles, KnowRestart)
{
    using All = std::vector<Triangle>;
    const All twoStrips = {{0, 1, 2}, {1, 3, 2}, {4, 5, 6}, {5, 7, 6}};
    const std::vector<unsigned int> cut = {0, 1, 2, 3, 0xFFFF, 4, 5, 6, 7};
    EXPECT_EQ(asElements(GL_TRIANGLE_STRIP, cut, restartAt(0xFFFF)), twoStrips);
    // Also where nothing that we see has said so: there is no such vertex.
    EXPECT_EQ(asElements(GL_TRIANGLE_STRIP, cut), twoStrips);
    // An index of the array may be the one.
    EXPECT_EQ(asElements(GL_TRIANGLE_STRIP, {0, 1, 2, 3, 7, 4, 5, 6}, restartAt(7)),
              (All{{0, 1, 2}, {1, 3, 2}, {4, 5, 6}}));
    EXPECT_EQ(asElements(GL_TRIANGLES, {0, 1, 2, 3, 7, 4, 5, 6}, restartAt(7)), (All{{0, 1, 2}, {4, 5, 6}}));
    EXPECT_EQ(asElements(GL_TRIANGLE_FAN, {0, 1, 2, 7, 3, 4, 5}, restartAt(7)), (All{{0, 1, 2}, {3, 4, 5}}));

    osg::ref_ptr<osg::StateSet> largest = new osg::StateSet;
    largest->setMode(0x8D69, osg::StateAttribute::ON);
    EXPECT_EQ(
        trianglesOf<osg::DrawElementsUByte>(GL_TRIANGLE_STRIP, {0, 1, 2, 3, 255, 4, 5, 6, 7}, largest, 256),
        twoStrips);
    EXPECT_EQ(trianglesOf<osg::DrawElementsUByte>(GL_TRIANGLE_STRIP, {253, 254, 255}, nullptr, 256),
              (All{{253, 254, 255}}));

    // The state of a node above has its say.
    const osg::ref_ptr<osg::Geometry> geometry = makeZigzag(8);
    geometry->addPrimitiveSet(strip({0, 1, 7, 2}));
    const osg::ref_ptr<osg::Geode> geode = new osg::Geode;
    geode->addDrawable(geometry);
    EXPECT_EQ(trianglesOf(*geometry).size(), 2u);
    geode->setStateSet(restartAt(7));
    EXPECT_EQ(trianglesOf(*geometry).size(), 0u);
    geode->setStateSet(nullptr);
    const osg::ref_ptr<osg::Camera> camera = new osg::Camera;
    camera->setStateSet(restartAt(7));
    camera->addChild(geode);
    EXPECT_EQ(trianglesOf(*geometry).size(), 0u);
    // But not that of a view's camera, which its own thread may change at the time.
    const osg::ref_ptr<osg::View> view = new osg::View;
    view->setCamera(camera);
    EXPECT_EQ(trianglesOf(*geometry).size(), 2u);
}

TEST(DrawableTriangles, LeaveOutWhatIsBeyondTheArray)
{
    using All = std::vector<Triangle>;
    EXPECT_EQ(asElements(GL_TRIANGLES, {0, 1, 2, 3, 60000, 4, 5, 6, 7}), (All{{0, 1, 2}, {5, 6, 7}}));
    EXPECT_EQ(trianglesOf<osg::DrawElementsUInt>(GL_TRIANGLES, {0, 1, 0xFFFFFFF0u, 2, 3, 4}, nullptr),
              (All{{2, 3, 4}}));
    const osg::ref_ptr<osg::Geometry> geometry = makeZigzag(5);
    geometry->addPrimitiveSet(new osg::DrawArrays(GL_TRIANGLES, 0, 3000));
    EXPECT_EQ(trianglesOf(*geometry), (All{{0, 1, 2}}));
    geometry->setPrimitiveSet(0, new osg::DrawArrays(GL_TRIANGLES, 90, 3));
    EXPECT_EQ(trianglesOf(*geometry), All{});
    geometry->setPrimitiveSet(0, new osg::DrawArrays(GL_TRIANGLES, -2, 3));
    EXPECT_EQ(trianglesOf(*geometry), All{});
    geometry->setVertexArray(nullptr);
    EXPECT_EQ(trianglesOf(*geometry), All{});
}

TEST(DrawableTriangles, TellWhetherTheyAreAll)
{
    const osg::ref_ptr<osg::Geometry> geometry = makeZigzag(6);
    geometry->addPrimitiveSet(new osg::DrawArrays(GL_TRIANGLES, 0, 6));
    EXPECT_TRUE(DrawableTriangles(*geometry).tellAll());
    geometry->addPrimitiveSet(new osg::DrawArrays(GL_LINES, 0, 6));
    EXPECT_FALSE(DrawableTriangles(*geometry).tellAll());
    geometry->setPrimitiveSet(1, new osg::DrawArrays(GL_TRIANGLES, 0, 3, 7));
    const DrawableTriangles instanced(*geometry);
    EXPECT_FALSE(instanced.tellAll());
    ASSERT_EQ(instanced.parts().size(), 2u);
    EXPECT_EQ(instanced.parts()[0].end, 6u);
    EXPECT_EQ(instanced.parts()[1].end, 9u);
    EXPECT_EQ(instanced.parts()[1].instances, 7);
    geometry->removePrimitiveSet(1);
    geometry->setInitialBound(osg::BoundingBox(0, 0, 0, 100, 100, 100));
    EXPECT_FALSE(DrawableTriangles(*geometry).tellAll());
    geometry->setInitialBound(osg::BoundingBox());
    EXPECT_TRUE(DrawableTriangles(*geometry).tellAll());
    // A point at infinity has no position.
    const osg::ref_ptr<osg::Vec4Array> far = new osg::Vec4Array(6);
    geometry->setVertexArray(far);
    EXPECT_FALSE(DrawableTriangles(*geometry).tellAll());
}

class PickedTypes : public ::testing::TestWithParam<VertexType>
{
};

TEST_P(PickedTypes, LieWhereTheyAreDrawn)
{
    const osg::ref_ptr<osg::Geometry> geometry = makeZigzag(8);
    geometry->addPrimitiveSet(new osg::DrawArrays(GL_TRIANGLE_STRIP, 0, 8));
    geometry->setVertexArray(
        convertVertices(static_cast<const osg::Vec3Array&>(*geometry->getVertexArray()), GetParam()));
    geometry->setComputeBoundingBoxCallback(new GivenBox);
    for (const double x : {0.25, 1.5, 2.75})
    {
        const std::vector<osg::Vec3d> hits = pick(*geometry, x, 0.4);
        ASSERT_EQ(hits.size(), 1u);
        const double column = std::floor(x);
        const double height = column * column + (2.0 * column + 1.0) * (x - column);
        EXPECT_NEAR(hits[0].z(), hasHeight(GetParam()) ? height : 0.0, 1e-5);
    }
}

INSTANTIATE_TEST_SUITE_P(Types, PickedTypes,
                         ::testing::Values(VertexType::Vec2, VertexType::Vec3, VertexType::Vec4,
                                           VertexType::ScaledVec4, VertexType::Vec2d, VertexType::Vec3d,
                                           VertexType::Vec4d, VertexType::Vec3s, VertexType::Vec4s,
                                           VertexType::Vec3i),
                         [](const auto& tested) { return nameOf(tested.param); });

TEST(PickedTriangles, EndAtTheArray)
{
    const osg::ref_ptr<osg::Geometry> geometry = makeZigzag(8);
    geometry->addPrimitiveSet(strip({0, 1, 2, 3, 0xFFFF, 4, 5, 6, 7}));
    geometry->setComputeBoundingBoxCallback(new GivenBox);
    EXPECT_EQ(pick(*geometry, 0.5, 0.4).size(), 1u);
    EXPECT_EQ(pick(*geometry, 1.5, 0.4).size(), 0u);
    EXPECT_EQ(pick(*geometry, 2.5, 0.4).size(), 1u);
}

TEST(GeometryStamp, TellsOfNewArraysWithEqualCounts)
{
    const osg::ref_ptr<osg::Geometry> geometry = makeZigzag(8);
    geometry->addPrimitiveSet(new osg::DrawArrays(GL_TRIANGLE_STRIP, 0, 8));
    const auto shape = [&]
    {
        return GeometryStamp(*geometry);
    };
    const auto all = [&]
    {
        return GeometryStamp(*geometry, GeometryStamp::ALL_ARRAYS);
    };
    GeometryStamp first = shape();
    GeometryStamp second = all();
    EXPECT_TRUE(first.matches(*geometry));
    EXPECT_TRUE(second.matches(*geometry));
    EXPECT_FALSE(GeometryStamp().matches(*geometry));
    geometry->setColorArray(new osg::Vec4Array(8), osg::Array::BIND_PER_VERTEX);
    EXPECT_TRUE(first.matches(*geometry));
    EXPECT_FALSE(second.matches(*geometry));
    second = all();
    geometry->setTexCoordArray(1, new osg::Vec2Array(8));
    EXPECT_FALSE(second.matches(*geometry));
    // The new one may come to lie where the old one was.
    for (int i = 0; i < 20; ++i)
    {
        first = shape();
        geometry->setVertexArray(nullptr);
        geometry->setVertexArray(new osg::Vec3Array(8));
        EXPECT_FALSE(first.matches(*geometry));
    }
    first = shape();
    geometry->getVertexArray()->dirty();
    EXPECT_FALSE(first.matches(*geometry));
    first = shape();
    geometry->setPrimitiveSet(0, new osg::DrawArrays(GL_TRIANGLE_STRIP, 0, 8));
    EXPECT_FALSE(first.matches(*geometry));
    first = shape();
    static_cast<osg::DrawArrays*>(geometry->getPrimitiveSet(0))->setCount(6);
    EXPECT_FALSE(first.matches(*geometry));
}
