// SPDX-License-Identifier: MIT
// SPDX-FileCopyrightText: 2026 the osgGeoFX authors
//
// City models of others: what hangs together keeps its shape in a bend, as if each thing had a node, and all else bends as it did.
#include <osgGeoFX/deformation/PedestrianView.h>
#include <osgGeoFX/effect/RigidParts.h>
#include <osgGeoFX/scene/RigidModel.h>
#include <osgGeoFX/scene/RigidReference.h>
#include <tools/BentGround.h>
#include <tools/PixelsApart.h>
#include <tools/RandomSamples.h>
#include <tools/TempDir.h>

#include <osg/PagedLOD>
#include <osgDB/ReadFile>
#include <osgDB/WriteFile>

#include <cmath>
#include <vector>

using namespace osgGeoFX;
using namespace geofx::test;

namespace
{

struct House
{
    osg::Vec3d place; ///< of its foot
    float size;
};

/// Faces have vertices of their own, as in models that programs export.
void append(osg::Geometry& all, const osg::Geometry& part, const osg::Vec3& shift, unsigned int first,
            unsigned int end)
{
    auto& vertices = static_cast<osg::Vec3Array&>(*all.getVertexArray());
    auto& normals = static_cast<osg::Vec3Array&>(*all.getNormalArray());
    auto& colors = static_cast<osg::Vec4Array&>(*all.getColorArray());
    auto& triangles = static_cast<osg::DrawElementsUInt&>(*all.getPrimitiveSet(0));
    const osg::PrimitiveSet& set = *part.getPrimitiveSet(0);
    for (unsigned int i = first; i < end; ++i)
    {
        const unsigned int from = set.index(i);
        triangles.push_back(static_cast<unsigned int>(vertices.size()));
        vertices.push_back(static_cast<const osg::Vec3Array&>(*part.getVertexArray())[from] + shift);
        normals.push_back(static_cast<const osg::Vec3Array&>(*part.getNormalArray())[from]);
        colors.push_back(static_cast<const osg::Vec4Array&>(*part.getColorArray())[from]);
    }
}

osg::ref_ptr<osg::Geometry> makeEmpty()
{
    osg::ref_ptr<osg::Geometry> geometry = new osg::Geometry;
    geometry->setVertexArray(new osg::Vec3Array);
    geometry->setNormalArray(new osg::Vec3Array(osg::Array::BIND_PER_VERTEX));
    geometry->setColorArray(new osg::Vec4Array(osg::Array::BIND_PER_VERTEX));
    geometry->addPrimitiveSet(new osg::DrawElementsUInt(GL_TRIANGLES));
    geometry->setUseDisplayList(false);
    return geometry;
}

class RigidModelTest : public BentGround
{
protected:
    static std::vector<House> randomHouses(int count)
    {
        // On a grid, so that no two touch.
        Random random(5);
        std::vector<House> houses;
        for (int i = 0; i < count; ++i)
            houses.push_back({{-90.0 + 24.0 * (i % 8), -80.0 + 24.0 * (i / 8), random.uniform(0, 6)},
                              static_cast<float>(random.uniform(3, 11))});
        return houses;
    }
    /// All in one geometry.
    static osg::ref_ptr<osg::Geometry> makeModel(const std::vector<House>& houses)
    {
        osg::ref_ptr<osg::Geometry> all = makeEmpty();
        for (const House& each : houses)
            append(*all, *makeBox(each.size), osg::Vec3(each.place), 0, 36);
        return all;
    }
    /// Walls and roofs are different geometries, moved by different transforms.
    static osg::ref_ptr<osg::Group> makeScattered(const std::vector<House>& houses)
    {
        osg::ref_ptr<osg::Group> group = new osg::Group;
        for (int part = 0; part < 2; ++part)
        {
            const osg::Vec3 shift(31.0f * static_cast<float>(part), -17.0f, 4.0f);
            osg::ref_ptr<osg::Geometry> geometry = makeEmpty();
            for (const House& each : houses)
                append(*geometry, *makeBox(each.size), osg::Vec3(each.place) - shift, part ? 24 : 0,
                       part ? 36 : 24);
            osg::ref_ptr<osg::MatrixTransform> transform =
                new osg::MatrixTransform(osg::Matrix::translate(shift));
            transform->addChild(geometry);
            group->addChild(transform);
        }
        return group;
    }
    static osg::ref_ptr<osg::Group> makeNodes(const std::vector<House>& houses)
    {
        osg::ref_ptr<osg::Group> group = new osg::Group;
        for (const House& each : houses)
        {
            osg::ref_ptr<RigidReference> rigid = new RigidReference;
            rigid->addChild(makeBox(each.size, each.place));
            rigid->setReference(each.place);
            group->addChild(rigid);
        }
        return group;
    }
};

osg::Vec4 referenceOf(const osg::Geometry& geometry, std::size_t vertex)
{
    const osg::Vec4Array* const all = RigidParts::of(geometry);
    return all ? (*all)[vertex] : osg::Vec4();
}

} // namespace

TEST_F(RigidModelTest, HousesAreDrawnAsIfEachHadANode)
{
    const std::vector<House> houses = randomHouses(56);
    const osg::ref_ptr<osg::Image> expected = render(makeScene({makeNodes(houses)}));
    ASSERT_GT(covered(*expected), 800);
    const osg::ref_ptr<osg::Node> models[] = {makeModel(houses), makeScattered(houses)};
    for (const osg::ref_ptr<osg::Node>& model : models)
    {
        const int soft = pixelsApart(*render(makeScene({model})), *expected);
        const osg::ref_ptr<RigidModel> rigid = new RigidModel;
        rigid->prepare(*model);
        EXPECT_EQ(rigid->things(), houses.size());
        const int left = pixelsApart(*render(makeScene({model})), *expected);
        // Floats instead of matrices of doubles: edges may fall to the other pixel.
        EXPECT_LE(left, covered(*expected) / 50);
        EXPECT_GT(soft, 5 * left + 10);
        // Once more changes nothing.
        const std::size_t geometries = rigid->geometries();
        rigid->prepare(*model);
        EXPECT_EQ(rigid->geometries(), geometries);
    }
}

TEST_F(RigidModelTest, GroundInTheModelBends)
{
    const std::vector<House> houses = randomHouses(16);
    const osg::ref_ptr<osg::Geometry> ground = makeGround();
    const osg::ref_ptr<osg::Image> bent = render(makeScene({ground}));
    const osg::ref_ptr<RigidModel> rigid = new RigidModel;
    rigid->setLargest(100.0);
    // In one geometry with houses, far below which it lies: its own pixels stay as they were.
    const osg::ref_ptr<osg::Group> model = new osg::Group;
    model->addChild(ground);
    model->addChild(makeModel(houses));
    rigid->prepare(*model);
    EXPECT_EQ(rigid->things(), houses.size());
    EXPECT_EQ(rigid->geometries(), 1u);
    EXPECT_FALSE(RigidParts::of(*ground));
    EXPECT_TRUE(same(*render(makeScene({ground})), *bent));
    // If it may be as large, it is a thing.
    rigid->setLargest(1000.0);
    rigid->prepare(*model);
    EXPECT_TRUE(RigidParts::of(*ground));
    EXPECT_FALSE(same(*render(makeScene({ground})), *bent));
    watch().ignore("RigidModel: the largest building must be more than 0 m");
    EXPECT_FALSE(rigid->setLargest(0.0));
    EXPECT_FALSE(rigid->setLargest(std::nan("")));
    EXPECT_EQ(rigid->getLargest(), 1000.0);
}

TEST_F(RigidModelTest, LargeAndSmallThingsShareAGeometry)
{
    osg::ref_ptr<osg::Geometry> all = makeModel({{{0, 0, 0}, 4}});
    append(*all, *makeBox(120), {0, 200, 0}, 0, 36);
    const osg::ref_ptr<RigidModel> rigid = new RigidModel;
    rigid->setLargest(50.0);
    rigid->prepare(*all);
    EXPECT_EQ(rigid->things(), 1u);
    const auto& vertices = static_cast<const osg::Vec3Array&>(*all->getVertexArray());
    ASSERT_TRUE(RigidParts::of(*all));
    for (std::size_t i = 0; i < 36; ++i)
        EXPECT_LT((osg::Vec3d(referenceOf(*all, i).x(), referenceOf(*all, i).y(), referenceOf(*all, i).z()))
                      .length(),
                  1e-5);
    for (std::size_t i = 36; i < 72; ++i)
    {
        const osg::Vec4 reference = referenceOf(*all, i);
        EXPECT_EQ(osg::Vec3(reference.x(), reference.y(), reference.z()), vertices[i]);
    }
    EXPECT_LT(RigidParts::radius(*all), 10.0);
}

TEST_F(RigidModelTest, StatesOfOthersStayAsTheyAre)
{
    const osg::ref_ptr<osg::StateSet> shared = new osg::StateSet;
    const osg::ref_ptr<osg::Geometry> a = makeModel(randomHouses(4)), b = makeModel({{{50, 60, 0}, 5}}),
                                      line = makeEmpty();
    line->setPrimitiveSet(0, new osg::DrawArrays(GL_LINES, 0, 2));
    auto& ends = static_cast<osg::Vec3Array&>(*line->getVertexArray());
    ends.push_back({0, 0, 0});
    ends.push_back({0, 0, 9});
    for (osg::Geometry* each : {a.get(), b.get(), line.get()})
        each->setStateSet(shared);
    const osg::ref_ptr<osg::Group> model = makePlain({a, b, line});
    const osg::ref_ptr<RigidModel> rigid = new RigidModel;
    rigid->prepare(*model);
    EXPECT_EQ(rigid->geometries(), 2u);
    EXPECT_EQ(line->getStateSet(), shared);
    EXPECT_TRUE(shared->getDefineList().empty());
    EXPECT_NE(a->getStateSet(), shared);
    EXPECT_EQ(a->getStateSet(), b->getStateSet());
    EXPECT_FALSE(RigidParts::of(*line));
}

TEST_F(RigidModelTest, LeavesAloneWhatIsNotItsOwn)
{
    const std::vector<House> one = {{{10, 10, 0}, 5}};
    const osg::ref_ptr<osg::MatrixTransform> scaled = new osg::MatrixTransform(osg::Matrix::scale(2, 2, 2));
    scaled->addChild(makeModel(one));
    const osg::ref_ptr<osg::Geometry> off = makeModel(one), dynamic = makeModel(one);
    off->getOrCreateStateSet()->setDefine("GEOFX_DEFORMATION", osg::StateAttribute::OFF);
    dynamic->setDataVariance(osg::Object::DYNAMIC);
    const osg::ref_ptr<osg::Group> model = makePlain({scaled, off, dynamic, makeNodes(one)});
    const osg::ref_ptr<RigidModel> rigid = new RigidModel;
    rigid->prepare(*model);
    EXPECT_EQ(rigid->things(), 0u);
    EXPECT_EQ(rigid->geometries(), 0u);
}

// The bottom is where the globe's down is.
TEST_F(RigidModelTest, StandsOnAGlobe)
{
    const osg::ref_ptr<osg::EllipsoidModel> ellipsoid = new osg::EllipsoidModel;
    Random random(1);
    for (int i = 0; i < 20; ++i)
    {
        osg::Matrixd frame;
        ellipsoid->computeLocalToWorldTransformFromLatLongHeight(random.uniform(-1.5, 1.5),
                                                                 random.uniform(-3.0, 3.0), 100.0, frame);
        // A model in a frame of its own, turned within it.
        const osg::Matrixd turned = osg::Matrix::rotate(random.uniform(0.0, 3.0), osg::Vec3d(1, 1, 0)) *
                                    osg::Matrix::translate(random.uniform(-500, 500), 20, 0) * frame;
        const osg::ref_ptr<osg::MatrixTransform> place = new osg::MatrixTransform(turned);
        const osg::ref_ptr<osg::Geometry> house = makeModel({{{3, 4, 5}, 8}});
        place->addChild(house);
        const osg::ref_ptr<RigidModel> rigid = new RigidModel(ellipsoid);
        rigid->prepare(*place);
        ASSERT_EQ(rigid->things(), 1u);
        const osg::Vec4 local = referenceOf(*house, 0);
        const osg::Vec3d reference = osg::Vec3d(local.x(), local.y(), local.z()) * turned;
        const osg::Vec3d up = ellipsoid->computeLocalUpVector(reference.x(), reference.y(), reference.z());
        double lowest = HUGE_VAL;
        for (const osg::Vec3& vertex : static_cast<const osg::Vec3Array&>(*house->getVertexArray()))
            lowest = std::min(lowest, (osg::Vec3d(vertex) * turned - reference) * up);
        EXPECT_NEAR(lowest, 0.0, 0.01);
    }
}

TEST_F(RigidModelTest, TilesThatAPagerReadsAreRigid)
{
    const TempDir folder;
    const std::string tile = (folder.path() / "tile.osgb").string();
    ASSERT_TRUE(osgDB::writeNodeFile(*makeModel(randomHouses(9)), tile));
    const osg::ref_ptr<osg::PagedLOD> paged = new osg::PagedLOD;
    paged->setFileName(0, tile);
    paged->setRange(0, 0.0f, 1e6f);
    const osg::ref_ptr<osg::Group> model = makePlain({paged});
    const osg::ref_ptr<RigidModel> rigid = new RigidModel;
    TileGuard::install(model)->addListener(rigid);
    const osg::ref_ptr<osg::Node> read =
        osgDB::readRefNodeFile(tile, static_cast<const osgDB::Options*>(paged->getDatabaseOptions()));
    ASSERT_TRUE(read);
    EXPECT_EQ(rigid->things(), 9u);
}

// Corners that touch make one thing, others do not.
TEST_F(RigidModelTest, HousesThatTouchAreOneThing)
{
    for (const double gap : {0.0, 0.005, 0.03})
    {
        const osg::ref_ptr<osg::Geometry> pair = makeModel({{{0, 0, 0}, 6}, {{6.0 + gap, 0, 0}, 6}});
        const osg::ref_ptr<RigidModel> rigid = new RigidModel;
        rigid->prepare(*pair);
        EXPECT_EQ(rigid->things(), gap < 0.01 ? 1u : 2u) << gap;
    }
}
