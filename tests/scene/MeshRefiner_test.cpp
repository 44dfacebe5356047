// SPDX-License-Identifier: MIT
// SPDX-FileCopyrightText: 2026 the osgGeoFX authors
//
// Splitting of other engines' meshes: no crack, all arrays, and what is left alone.
#include <osgGeoFX/deformation/PedestrianView.h>
#include <osgGeoFX/deformation/VerticalExaggeration.h>
#include <osgGeoFX/scene/EffectScene.h>
#include <osgGeoFX/scene/MeshRefiner.h>
#include <osgGeoFX/scene/RigidReference.h>
#include <tools/NotifyWatch.h>
#include <tools/RandomSamples.h>

#include <gtest/gtest.h>
#include <osg/AutoTransform>
#include <osg/Billboard>
#include <osg/Geode>
#include <osg/KdTree>
#include <osg/MatrixTransform>
#include <osg/Program>
#include <osg/TriangleIndexFunctor>

#include <algorithm>
#include <array>
#include <cmath>
#include <map>

using namespace geofx::test;
using osg::Vec3d;
using osgGeoFX::MeshRefiner;

namespace
{

struct IndexCollector
{
    std::vector<unsigned int> corners;
    void operator()(unsigned int a, unsigned int b, unsigned int c)
    {
        corners.insert(corners.end(), {a, b, c});
    }
};

std::vector<unsigned int> cornersOf(const osg::Geometry& geometry)
{
    osg::TriangleIndexFunctor<IndexCollector> collector;
    geometry.accept(collector);
    return collector.corners;
}

const osg::Vec3Array& verticesOf(const osg::Geometry& geometry)
{
    return static_cast<const osg::Vec3Array&>(*geometry.getVertexArray());
}

/// A square of one or two triangles, drawn as `mode` says.
osg::ref_ptr<osg::Geometry> makeQuad(GLenum mode = GL_QUADS, float size = 1000.0f)
{
    osg::ref_ptr<osg::Geometry> geometry = new osg::Geometry;
    const osg::ref_ptr<osg::Vec3Array> vertices = new osg::Vec3Array;
    vertices->push_back({0.0f, 0.0f, 0.0f});
    vertices->push_back({size, 0.0f, 10.0f});
    vertices->push_back({size, size, 0.0f});
    vertices->push_back({0.0f, size, 0.0f});
    geometry->setVertexArray(vertices);
    geometry->addPrimitiveSet(new osg::DrawArrays(mode, 0, 4));
    return geometry;
}

double longestOf(const osg::Geometry& geometry, const osg::Matrixd& matrix = {})
{
    const std::vector<unsigned int> corners = cornersOf(geometry);
    double longest = 0.0;
    for (std::size_t i = 0; i < corners.size(); ++i)
    {
        const std::size_t next = i % 3 == 2 ? i - 2 : i + 1;
        const Vec3d a = Vec3d(verticesOf(geometry)[corners[i]]) * matrix;
        longest = std::max(longest, (a - Vec3d(verticesOf(geometry)[corners[next]]) * matrix).length());
    }
    return longest;
}

double areaOf(const osg::Geometry& geometry)
{
    const std::vector<unsigned int> corners = cornersOf(geometry);
    double area = 0.0;
    for (std::size_t i = 0; i < corners.size(); i += 3)
    {
        const Vec3d a = verticesOf(geometry)[corners[i]], b = verticesOf(geometry)[corners[i + 1]];
        area += ((b - a) ^ (Vec3d(verticesOf(geometry)[corners[i + 2]]) - a)).z() / 2.0;
    }
    return area;
}

/// A ground of jittered posts, whose triangles are dealt out to geometries with frames of their own.
struct Patchwork
{
    osg::ref_ptr<osg::Group> root = new osg::Group;
    std::vector<std::pair<osg::ref_ptr<osg::Geometry>, osg::Matrixd>> parts;
    static constexpr int posts = 9;
    static constexpr double size = 40000.0;

    explicit Patchwork(Random& random)
    {
        std::vector<Vec3d> places;
        for (int i = 0; i < posts * posts; ++i)
        {
            const double x = i % posts, y = i / posts;
            const bool inner = x > 0 && y > 0 && x < posts - 1 && y < posts - 1;
            const double jitter = inner ? 0.45 : 0.0;
            places.emplace_back((x + random.uniform(-jitter, jitter)) * size / (posts - 1),
                                (y + random.uniform(-jitter, jitter)) * size / (posts - 1),
                                random.uniform(0.0, 1500.0));
        }
        std::array<std::vector<unsigned int>, 5> dealt;
        for (unsigned int y = 0; y + 1 < posts; ++y)
        {
            for (unsigned int x = 0; x + 1 < posts; ++x)
            {
                const unsigned int a = y * posts + x, b = a + 1, c = a + posts + 1, d = a + posts;
                for (const auto& corners : {std::array{a, b, c}, std::array{a, c, d}})
                {
                    auto& to = dealt[static_cast<std::size_t>(random.integer(0, 4))];
                    to.insert(to.end(), corners.begin(), corners.end());
                }
            }
        }
        for (const auto& corners : dealt)
            add(places, corners, random);
    }

    void add(const std::vector<Vec3d>& places, const std::vector<unsigned int>& corners, Random& random)
    {
        const osg::Matrixd frame =
            osg::Matrixd::rotate(random.uniform(-3.0, 3.0), Vec3d(0.3, 0.2, 1.0)) *
            osg::Matrixd::translate(random.uniform(0.0, size), random.uniform(0.0, size), 0.0);
        const osg::Matrixd inverse = osg::Matrixd::inverse(frame);
        const osg::ref_ptr<osg::Geometry> geometry = new osg::Geometry;
        const osg::ref_ptr<osg::Vec3Array> vertices = new osg::Vec3Array;
        for (const Vec3d& place : places)
            vertices->push_back(osg::Vec3(place * inverse));
        geometry->setVertexArray(vertices);
        // In two primitive sets, which share vertices.
        const std::size_t half = corners.size() / 6 * 3;
        geometry->addPrimitiveSet(new osg::DrawElementsUInt(
            GL_TRIANGLES, corners.begin(), corners.begin() + static_cast<std::ptrdiff_t>(half)));
        geometry->addPrimitiveSet(new osg::DrawElementsUInt(
            GL_TRIANGLES, corners.begin() + static_cast<std::ptrdiff_t>(half), corners.end()));
        const osg::ref_ptr<osg::MatrixTransform> node = new osg::MatrixTransform(frame);
        node->addChild(geometry);
        root->addChild(node);
        parts.emplace_back(geometry, frame);
    }

    /// How many edges inside of the ground do not have a triangle on either side. Places that are 0.1 m apart at most, for the
    /// floats of their frames, are one.
    int openEdges() const
    {
        std::map<std::array<long, 3>, std::vector<std::pair<Vec3d, int>>> cells;
        int places = 0;
        const auto numberOf = [&](const Vec3d& at)
        {
            const std::array<long, 3> cell = {std::lround(at.x()), std::lround(at.y()), std::lround(at.z())};
            for (int i = 0; i < 27; ++i)
            {
                const auto found =
                    cells.find({cell[0] + i % 3 - 1, cell[1] + i / 3 % 3 - 1, cell[2] + i / 9 - 1});
                if (found == cells.end()) continue;
                for (const auto& [place, number] : found->second)
                    if ((place - at).length() < 0.1) return number;
            }
            cells[cell].emplace_back(at, places);
            return places++;
        };
        std::map<std::pair<int, int>, int> uses;
        for (const auto& [geometry, frame] : parts)
        {
            const std::vector<unsigned int> corners = cornersOf(*geometry);
            std::vector<Vec3d> at;
            std::vector<int> numbers;
            for (const unsigned int corner : corners)
            {
                at.push_back(Vec3d(verticesOf(*geometry)[corner]) * frame);
                numbers.push_back(numberOf(at.back()));
            }
            for (std::size_t i = 0; i < corners.size(); ++i)
            {
                const std::size_t next = i % 3 == 2 ? i - 2 : i + 1;
                if (!onBorder(at[i], at[next])) ++uses[std::minmax(numbers[i], numbers[next])];
            }
        }
        return static_cast<int>(
            std::count_if(uses.begin(), uses.end(), [](const auto& each) { return each.second != 2; }));
    }
    static bool onBorder(const Vec3d& a, const Vec3d& b)
    {
        for (int axis = 0; axis < 2; ++axis)
        {
            for (const double side : {0.0, size})
                if (std::abs(a[axis] - side) < 0.5 && std::abs(b[axis] - side) < 0.5) return true;
        }
        return false;
    }
};

} // namespace

TEST(MeshRefiner, LeavesNoEdgeTooLongAndKeepsTheShape)
{
    for (const GLenum mode : {GL_QUADS, GL_POLYGON, GL_TRIANGLE_FAN})
    {
        const osg::ref_ptr<osg::Geometry> quad = makeQuad(mode);
        const osg::ref_ptr<MeshRefiner> refiner = new MeshRefiner(90.0);
        refiner->refine(*quad);
        EXPECT_LE(longestOf(*quad), 90.1);
        EXPECT_GT(longestOf(*quad), 44.0);
        EXPECT_NEAR(areaOf(*quad), 1e6, 1.0) << "and none is turned over";
        EXPECT_EQ(refiner->refinedGeometries(), 1u);
        EXPECT_EQ(refiner->refinedTriangles(), cornersOf(*quad).size() / 3);
        // 500 do for such edges; splitting in halves takes up to four times as many, and little more.
        EXPECT_LT(refiner->refinedTriangles(), 2500u);
        const unsigned int before = quad->getVertexArray()->getNumElements();
        refiner->refine(*quad);
        EXPECT_EQ(quad->getVertexArray()->getNumElements(), before) << "nothing is left to split";
    }
}

TEST(MeshRefiner, OpensNoCrackBetweenGeometriesAndSets)
{
    for (int sample = 0; sample < (fullTest() ? 200 : 20); ++sample)
    {
        SCOPED_TRACE("sample " + std::to_string(sample));
        Random random(static_cast<std::uint64_t>(sample));
        Patchwork patchwork(random);
        ASSERT_EQ(patchwork.openEdges(), 0) << "before";
        const osg::ref_ptr<MeshRefiner> refiner = new MeshRefiner(random.logarithmic(400.0, 6000.0));
        // The pager brings one tile after the other.
        for (unsigned int i = 0; i < patchwork.root->getNumChildren(); ++i)
            static_cast<osgGeoFX::TileListener&>(*refiner).tileRead(*patchwork.root->getChild(i));
        EXPECT_GT(refiner->refinedGeometries(), 0u);
        EXPECT_EQ(patchwork.openEdges(), 0);
        for (const auto& [geometry, frame] : patchwork.parts)
            EXPECT_LE(longestOf(*geometry, frame), refiner->getLongestEdge() * 1.001);
    }
}

TEST(MeshRefiner, KeepsBordersClosedWhereTheLimitIsMet)
{
    NotifyWatch watch;
    constexpr double longestWished = 250.0;
    // A limit that some of the geometries meet and others do not.
    std::vector<std::size_t> counts;
    {
        Random random(5);
        Patchwork patchwork(random);
        const osg::ref_ptr<MeshRefiner> refiner = new MeshRefiner(longestWished);
        refiner->refine(*patchwork.root);
        for (const auto& part : patchwork.parts)
            counts.push_back(cornersOf(*part.first).size() / 3);
    }
    const auto [least, most] = std::minmax_element(counts.begin(), counts.end());
    const std::size_t limit = (*least + *most) / 2;
    ASSERT_LT(*least + 1000, *most);
    Random random(5);
    Patchwork patchwork(random);
    const osg::ref_ptr<MeshRefiner> refiner = new MeshRefiner(longestWished);
    ASSERT_TRUE(refiner->setMostTriangles(static_cast<unsigned int>(limit)));
    const auto said = watch.messagesOf([&] { refiner->refine(*patchwork.root); });
    ASSERT_EQ(said.size(), 1u) << "once, for five geometries";
    EXPECT_NE(said[0].find(std::to_string(limit) + " triangles"), std::string::npos) << said[0];
    EXPECT_NE(said[0].find("setMostTriangles"), std::string::npos) << said[0];
    EXPECT_EQ(patchwork.openEdges(), 0);
    double longest = 0.0;
    for (const auto& [geometry, frame] : patchwork.parts)
    {
        EXPECT_LE(cornersOf(*geometry).size() / 3, limit);
        longest = std::max(longest, longestOf(*geometry, frame));
    }
    EXPECT_GT(longest, 300.0) << "the limit is met";
    EXPECT_LT(longest, 4000.0);
}

TEST(MeshRefiner, GivesNewVerticesTheMeanInEveryArray)
{
    const osg::ref_ptr<osg::Geometry> quad = makeQuad();
    const osg::Vec3Array& places = verticesOf(*quad);
    const osg::ref_ptr<osg::Vec3Array> normals = new osg::Vec3Array;
    const osg::ref_ptr<osg::Vec4ubArray> colors = new osg::Vec4ubArray;
    const osg::ref_ptr<osg::Vec2Array> texels = new osg::Vec2Array;
    const osg::ref_ptr<osg::Vec3bArray> bytes = new osg::Vec3bArray;
    const osg::ref_ptr<osg::DoubleArray> numbers = new osg::DoubleArray;
    const osg::ref_ptr<osg::UIntArray> names = new osg::UIntArray;
    names->setPreserveDataType(true);
    for (std::size_t i = 0; i < 4; ++i)
    {
        const osg::Vec3& p = places[i];
        osg::Vec3 normal(p.x() / 1000.0f - 0.5f, p.y() / 1000.0f - 0.5f, 1.0f);
        normal.normalize();
        normals->push_back(normal);
        colors->push_back(osg::Vec4ub(static_cast<unsigned char>(p.x() / 5.0f),
                                      static_cast<unsigned char>(p.y() / 5.0f), 0, 255));
        texels->push_back({p.x() / 500.0f, 3.0f - p.y() / 500.0f});
        bytes->push_back(osg::Vec3b(static_cast<signed char>(p.x() / 10.0f - 50.0f), 0, 0));
        numbers->push_back(static_cast<double>(p.x() - 2.0f * p.y()));
        names->push_back(i % 2 ? 7u : 1000u);
    }
    quad->setNormalArray(normals, osg::Array::BIND_PER_VERTEX);
    quad->setColorArray(colors, osg::Array::BIND_PER_VERTEX);
    quad->setTexCoordArray(2, texels, osg::Array::BIND_PER_VERTEX);
    quad->setVertexAttribArray(5, bytes, osg::Array::BIND_PER_VERTEX);
    quad->setVertexAttribArray(6, numbers, osg::Array::BIND_PER_VERTEX);
    quad->setVertexAttribArray(7, names, osg::Array::BIND_PER_VERTEX);
    const osg::ref_ptr<MeshRefiner> refiner = new MeshRefiner(200.0);
    refiner->refine(*quad);
    const osg::Vec3Array& now = verticesOf(*quad);
    ASSERT_GT(now.size(), 40u);
    EXPECT_EQ(normals->size(), 4u) << "others may have the former array, too";
    EXPECT_EQ(texels->size(), 4u);
    for (std::size_t i = 0; i < now.size(); ++i)
    {
        const osg::Vec3& p = now[i];
        const auto& normal = (*static_cast<const osg::Vec3Array*>(quad->getNormalArray()))[i];
        EXPECT_NEAR(normal.length(), 1.0f, 1e-5f);
        EXPECT_GT(normal.z(), 0.7f);
        const auto& color = (*static_cast<const osg::Vec4ubArray*>(quad->getColorArray()))[i];
        EXPECT_NEAR(color.r(), p.x() / 5.0f, 3.0f) << "rounded at each level";
        EXPECT_NEAR(color.g(), p.y() / 5.0f, 3.0f);
        const auto& texel = (*static_cast<const osg::Vec2Array*>(quad->getTexCoordArray(2)))[i];
        EXPECT_NEAR(texel.x(), p.x() / 500.0f, 1e-5f);
        EXPECT_NEAR(texel.y(), 3.0f - p.y() / 500.0f, 1e-5f);
        const auto& byte = (*static_cast<const osg::Vec3bArray*>(quad->getVertexAttribArray(5)))[i];
        EXPECT_NEAR(byte.x(), p.x() / 10.0f - 50.0f, 3.0f);
        const double number = (*static_cast<const osg::DoubleArray*>(quad->getVertexAttribArray(6)))[i];
        EXPECT_NEAR(number, static_cast<double>(p.x() - 2.0f * p.y()), 1e-3);
        const unsigned int name = (*static_cast<const osg::UIntArray*>(quad->getVertexAttribArray(7)))[i];
        EXPECT_TRUE(name == 7u || name == 1000u) << name << " names nothing";
    }
}

TEST(MeshRefiner, KeepsBindingsSetsPointsAndLines)
{
    const osg::ref_ptr<osg::Geometry> quad = makeQuad();
    quad->getPrimitiveSet(0)->setName("sea");
    quad->addPrimitiveSet(new osg::DrawArrays(GL_LINES, 0, 2));
    const unsigned short strip[] = {0, 1, 3, 2};
    quad->addPrimitiveSet(new osg::DrawElementsUShort(GL_TRIANGLE_STRIP, 4, strip));
    const osg::ref_ptr<osg::Vec4Array> colors = new osg::Vec4Array(3);
    quad->setColorArray(colors, osg::Array::BIND_PER_PRIMITIVE_SET);
    const osg::ref_ptr<osg::Vec3Array> normal = new osg::Vec3Array(1);
    quad->setNormalArray(normal, osg::Array::BIND_OVERALL);
    const osg::PrimitiveSet* lines = quad->getPrimitiveSet(1);
    quad->setShape(new osg::KdTree);
    const osg::ref_ptr<MeshRefiner> refiner = new MeshRefiner(200.0);
    refiner->refine(*quad);
    ASSERT_EQ(quad->getNumPrimitiveSets(), 3u);
    EXPECT_EQ(quad->getPrimitiveSet(0)->getName(), "sea");
    EXPECT_EQ(quad->getPrimitiveSet(1), lines);
    EXPECT_GT(quad->getPrimitiveSet(0)->getNumIndices(), 100u);
    EXPECT_EQ(quad->getPrimitiveSet(0)->getMode(), static_cast<GLenum>(GL_TRIANGLES));
    EXPECT_GT(quad->getPrimitiveSet(2)->getNumIndices(), 100u);
    EXPECT_NEAR(areaOf(*quad), 2e6, 2.0);
    EXPECT_EQ(quad->getColorArray(), colors);
    EXPECT_EQ(quad->getNormalArray(), normal);
    EXPECT_EQ(quad->getShape(), nullptr) << "it is of the former triangles";
    // Each geometry has buffers of its own.
    EXPECT_EQ(quad->getVertexArray()->getVertexBufferObject()->getNumBufferData(), 1u);
}

TEST(MeshRefiner, LeavesAloneWhatIsNotBent)
{
    const auto untouched = [](const std::string& what, osg::Node& node, const osg::Geometry& quad)
    {
        const osg::ref_ptr<MeshRefiner> refiner = new MeshRefiner(100.0);
        refiner->refine(node);
        EXPECT_EQ(quad.getVertexArray()->getNumElements(), 4u) << what;
        EXPECT_EQ(refiner->refinedGeometries(), 0u) << what;
    };
    const auto below = [&](const std::string& what, const osg::ref_ptr<osg::Group>& group)
    {
        const osg::ref_ptr<osg::Geometry> quad = makeQuad();
        group->addChild(quad);
        untouched(what, *group, *quad);
    };
    below("rigid", new osgGeoFX::RigidReference);
    below("billboard", new osg::Billboard);
    below("camera", new osg::Camera);
    below("projection", new osg::Projection);
    below("follows the eye", new osg::AutoTransform);
    const osg::ref_ptr<osg::MatrixTransform> tile = new osg::MatrixTransform, hud = new osg::MatrixTransform;
    tile->setName("tile 3/1/2");
    below("a tile of the kit's", tile);
    hud->setReferenceFrame(osg::Transform::ABSOLUTE_RF);
    below("absolute", hud);
    const osg::ref_ptr<osg::Group> off = new osg::Group, stranger = new osg::Group;
    off->getOrCreateStateSet()->setDefine("GEOFX_DEFORMATION", osg::StateAttribute::OFF);
    below("deformation off", off);
    const osg::ref_ptr<osg::Program> program = new osg::Program;
    program->addShader(new osg::Shader(osg::Shader::VERTEX, "void main() { gl_Position = ftransform(); }"));
    stranger->getOrCreateStateSet()->setAttribute(program);
    below("a stranger", stranger);

    const osg::ref_ptr<osg::Geometry> short1 = makeQuad(GL_QUADS, 50.0f), instanced = makeQuad(),
                                      dynamic = makeQuad(), divided = makeQuad();
    untouched("short", *short1, *short1);
    instanced->getPrimitiveSet(0)->setNumInstances(3);
    untouched("instances", *instanced, *instanced);
    dynamic->setDataVariance(osg::Object::DYNAMIC);
    untouched("dynamic", *dynamic, *dynamic);
    const osg::ref_ptr<osg::Vec4Array> wide = new osg::Vec4Array;
    for (const osg::Vec3& each : verticesOf(*divided))
        wide->push_back(osg::Vec4(each * 2.0f, 2.0f));
    divided->setVertexArray(wide);
    untouched("divided", *divided, *divided);
    // One that calls the functions is bent.
    const osg::ref_ptr<osg::Group> friendly = new osg::Group;
    const osg::ref_ptr<osg::Program> good = new osg::Program;
    good->addShader(new osg::Shader(osg::Shader::VERTEX,
                                    "vec4 geofx_vertex(vec4 p);\nvoid main() { gl_Position = "
                                    "gl_ProjectionMatrix * geofx_vertex(gl_ModelViewMatrix * gl_Vertex); }"));
    friendly->getOrCreateStateSet()->setAttribute(good);
    friendly->addChild(makeQuad());
    const osg::ref_ptr<MeshRefiner> refiner = new MeshRefiner(100.0);
    refiner->refine(*friendly);
    EXPECT_EQ(refiner->refinedGeometries(), 1u);
}

TEST(MeshRefiner, MeasuresInMetresOnceForEachGeometry)
{
    const osg::ref_ptr<osg::Geometry> quad = makeQuad(GL_QUADS, 1.0f);
    const osg::ref_ptr<osg::MatrixTransform> large = new osg::MatrixTransform(
                                                 osg::Matrixd::scale(1000.0, 1000.0, 1.0)),
                                             small = new osg::MatrixTransform;
    small->addChild(quad);
    large->addChild(quad);
    const osg::ref_ptr<osg::Group> root = new osg::Group;
    root->addChild(small);
    root->addChild(large);
    const osg::ref_ptr<MeshRefiner> refiner = new MeshRefiner(100.0);
    refiner->refine(*root);
    EXPECT_EQ(refiner->refinedGeometries(), 1u);
    EXPECT_LE(longestOf(*quad, large->getMatrix()), 100.1);
}

TEST(MeshRefiner, NumbersThatCannotBeAreRefusedInASentence)
{
    NotifyWatch watch;
    const osg::ref_ptr<osg::Geometry> quad = makeQuad();
    for (const double wrong : {0.0, -5.0, std::nan("")})
    {
        osg::ref_ptr<MeshRefiner> refiner;
        EXPECT_EQ(watch.messagesOf([&] { refiner = new MeshRefiner(wrong); }).size(), 1u);
        refiner->refine(*quad);
        EXPECT_EQ(quad->getVertexArray()->getNumElements(), 4u);
    }
    const osg::ref_ptr<MeshRefiner> refiner = new MeshRefiner(10.0);
    for (const unsigned int wrong : {0u, 999u, 10000001u})
        EXPECT_EQ(watch.messagesOf([&] { EXPECT_FALSE(refiner->setMostTriangles(wrong)); }).size(), 1u);
    EXPECT_EQ(refiner->getMostTriangles(), 200000u);
}

TEST(MeshRefiner, AsksTheDeformationsThatAreOn)
{
    const osg::ref_ptr<osgGeoFX::EffectScene> scene = new osgGeoFX::EffectScene;
    osgGeoFX::CameraRange cameras;
    cameras.projection.makePerspective(40.0, 1.5, 1.0, 1e5);
    cameras.distance = 2000.0;
    EXPECT_EQ(MeshRefiner::longestEdge(*scene, cameras, 0.001), HUGE_VAL);
    const osg::ref_ptr<osgGeoFX::VerticalExaggeration> exaggeration = new osgGeoFX::VerticalExaggeration;
    ASSERT_TRUE(exaggeration->setFactor(4.0));
    scene->addEffect(exaggeration);
    EXPECT_EQ(MeshRefiner::longestEdge(*scene, cameras, 0.001), HUGE_VAL) << "a plane stays one";
    const osg::ref_ptr<osgGeoFX::PedestrianView> view = new osgGeoFX::PedestrianView;
    scene->addEffect(view);
    const double both = MeshRefiner::longestEdge(*scene, cameras, 0.001);
    ASSERT_TRUE(exaggeration->setEnabled(false));
    const double one = MeshRefiner::longestEdge(*scene, cameras, 0.001);
    EXPECT_GT(one, 10.0);
    EXPECT_NEAR(both, one / 4.0, 1e-6 * one) << "the edges that are bent are four times as long";
    // A curve's error goes with the square of the edge, that of a kink with the edge.
    const double strict = MeshRefiner::longestEdge(*scene, cameras, 0.0005);
    EXPECT_LT(strict, one / std::sqrt(2.0) + 1e-6);
    EXPECT_GT(strict, one / 2.0);
    ASSERT_TRUE(view->setEnabled(false));
    EXPECT_EQ(MeshRefiner::longestEdge(*scene, cameras, 0.001), HUGE_VAL);
}
