// SPDX-License-Identifier: MIT
// SPDX-FileCopyrightText: 2026 the osgGeoFX authors
//
// Brush strokes of tiles: kinds by what covers the ground, the same ones after every reload, and who keeps them.
#include <osgGeoFX/effect/PassEffect.h>
#include <osgGeoFX/panorama/PanoramaMap.h>
#include <osgGeoFX/panorama/detail/CoverSampler.h>
#include <osgGeoFX/panorama/detail/StrokeLattice.h>
#include <osgGeoFX/panorama/detail/StrokeMaker.h>
#include <tools/NotifyWatch.h>
#include <tools/StrokeTiles.h>
#include <tools/TempDir.h>

#include <gtest/gtest.h>
#include <osg/UserDataContainer>
#include <osgDB/ReadFile>
#include <osgDB/WriteFile>

#include <cmath>
#include <map>
#include <set>
#include <thread>
#include <vector>

using namespace osgGeoFX;
using namespace geofx::test;

namespace
{

/// What lies everywhere on a tile.
std::function<glsl::geofx_Cover(double, double)> everywhere(double trees, double town, double shore = -1000.0)
{
    return [=](double, double)
    {
        glsl::geofx_Cover cover = {};
        cover.trees = trees;
        cover.town = town;
        cover.shore = shore;
        return cover;
    };
}

struct Made
{
    osg::ref_ptr<osg::MatrixTransform> tile;
    osg::ref_ptr<TileStrokes> strokes;

    std::size_t count() const
    {
        return strokes->points() ? strokes->points()->getVertexArray()->getNumElements() : 0;
    }
    osg::Vec3d vertex(std::size_t i) const
    {
        return osg::Vec3d((*static_cast<const osg::Vec3Array*>(strokes->points()->getVertexArray()))[i]);
    }
    osg::Vec4s traits(std::size_t i) const
    {
        return (*static_cast<const osg::Vec4sArray*>(strokes->points()->getTexCoordArray(0)))[i];
    }
    osg::Vec3d shorts(const osg::Array* array, std::size_t i) const
    {
        const osg::Vec3s& each = (*static_cast<const osg::Vec3sArray*>(array))[i];
        return osg::Vec3d(each.x(), each.y(), each.z()) / 32767.0;
    }
    std::size_t countOf(TileStrokes::Kind kind) const
    {
        std::size_t sum = 0;
        for (std::size_t i = 0; i < count(); ++i)
            sum += traits(i).z() == kind ? 1 : 0;
        return sum;
    }
};

/// A tile of 2.5 km, which has 100 × 100 lattice points.
Made make(const StrokeTiles& tiles, const StrokeParameters& parameters = {}, double west = 0.0)
{
    Made made;
    made.tile = tiles.tile(west, 0.0, west + 2500.0, 2500.0);
    made.strokes =
        TileStrokes::make(StrokeTiles::geometryOf(*made.tile), made.tile->getMatrix(), parameters, nullptr);
    return made;
}

/// What tells a stroke from all others.
using Identity = std::tuple<short, short, short, short>;

std::map<Identity, osg::Vec3d> strokesOf(const Made& made)
{
    std::map<Identity, osg::Vec3d> strokes;
    for (std::size_t i = 0; i < made.count(); ++i)
    {
        const osg::Vec4s traits = made.traits(i);
        strokes[{traits.x(), traits.y(), traits.z(), traits.w()}] = made.vertex(i) * made.tile->getMatrix();
    }
    return strokes;
}

TEST(TileStrokes, TreesAreAsDenseAsTheCoverSays)
{
    for (const double share : {0.0, 0.25, 0.6, 1.0})
    {
        StrokeTiles tiles;
        tiles.cover = everywhere(share, 0.0);
        const Made made = make(tiles);
        EXPECT_NEAR(static_cast<double>(made.count()), 10000.0 * share,
                    4.0 * std::sqrt(10000.0 * share * (1.0 - share)) + 250.0)
            << share;
        EXPECT_EQ(made.countOf(TileStrokes::Tree), made.count());
    }
}

TEST(TileStrokes, MoreTreesAddTreesAndMoveNone)
{
    StrokeTiles tiles;
    tiles.cover = everywhere(0.3, 0.0);
    const auto few = strokesOf(make(tiles));
    tiles.cover = everywhere(0.7, 0.0);
    const auto many = strokesOf(make(tiles));
    EXPECT_GT(many.size(), 2 * few.size());
    for (const auto& [identity, place] : few)
    {
        const auto found = many.find(identity);
        ASSERT_NE(found, many.end());
        ASSERT_LT((found->second - place).length(), 1e-6);
    }
}

TEST(TileStrokes, TownsHaveHousesAndNoPlaceHasTwoStrokes)
{
    StrokeTiles tiles;
    tiles.cover = everywhere(0.2, 0.5);
    const Made made = make(tiles);
    EXPECT_NEAR(static_cast<double>(made.countOf(TileStrokes::House)), 5000.0, 300.0);
    EXPECT_NEAR(static_cast<double>(made.countOf(TileStrokes::Tree)), 2000.0, 300.0);
    tiles.cover = everywhere(0.9, 0.9);
    EXPECT_LT(make(tiles).count(), 10300u);
}

TEST(TileStrokes, WaterHasNone)
{
    StrokeTiles tiles;
    tiles.cover = everywhere(1.0, 0.0, 20.0);
    EXPECT_EQ(make(tiles).strokes->points(), nullptr);
    // A lake in the middle.
    const auto lake = [](double x, double y)
    {
        return 600.0 - std::hypot(x - 1250.0, y - 1250.0);
    };
    tiles.cover = [&](double x, double y)
    {
        return everywhere(1.0, 0.0, lake(x, y))(x, y);
    };
    const Made made = make(tiles);
    EXPECT_NEAR(static_cast<double>(made.count()), 10000.0 - osg::PI * 576.0, 200.0);
    for (std::size_t i = 0; i < made.count(); ++i)
    {
        const osg::Vec3d place = made.vertex(i) * made.tile->getMatrix();
        // A texel of the shore is 4 m, and what is between texels is not quite straight.
        ASSERT_LT(lake(place.x(), place.y()), 6.0);
    }
}

TEST(TileStrokes, SteepGroundIsCliffWithItsFallLine)
{
    StrokeTiles tiles;
    tiles.cover = everywhere(1.0, 0.0);
    tiles.height = [](double x, double)
    {
        return 2.0 * x;
    };
    const Made made = make(tiles);
    EXPECT_GT(made.count(), 9000u);
    EXPECT_EQ(made.countOf(TileStrokes::Cliff), made.count());
    const osg::Vec3d downhill = osg::Vec3d(-1.0, 0.0, -2.0) / std::sqrt(5.0);
    const osg::Vec3d normal = osg::Vec3d(-2.0, 0.0, 1.0) / std::sqrt(5.0);
    for (std::size_t i = 0; i < made.count(); i += 50)
    {
        EXPECT_LT((made.shorts(made.strokes->points()->getTexCoordArray(1), i) - downhill).length(), 1e-3);
        EXPECT_LT((made.shorts(made.strokes->points()->getNormalArray(), i) - normal).length(), 1e-3);
    }
    StrokeParameters parameters;
    parameters.cliffSlope = 3.0;
    const Made gentle = make(tiles, parameters);
    EXPECT_EQ(gentle.countOf(TileStrokes::Cliff), 0u);
    EXPECT_EQ(gentle.strokes->points()->getTexCoordArray(1), nullptr);
}

TEST(TileStrokes, OpenSlopesHaveStrokesAlongTheirFallLines)
{
    StrokeTiles tiles;
    tiles.cover = everywhere(0.0, 0.0);
    // Half as steep as a cliff: what a far tile has left of one.
    const double slope = 0.5 * StrokeParameters().cliffSlope;
    tiles.height = [&](double x, double)
    {
        return slope * x;
    };
    const Made open = make(tiles);
    EXPECT_GT(open.countOf(TileStrokes::Cliff), 3000u);
    EXPECT_EQ(open.countOf(TileStrokes::Cliff), open.count());
    const osg::Vec3d downhill = osg::Vec3d(-1.0, 0.0, -slope) / std::hypot(1.0, slope);
    for (std::size_t i = 0; i < open.count(); i += 50)
        EXPECT_LT((open.shorts(open.strokes->points()->getTexCoordArray(1), i) - downhill).length(), 1e-3);
    // Woods hide them, and even ground has none.
    tiles.cover = everywhere(1.0, 0.0);
    EXPECT_EQ(make(tiles).countOf(TileStrokes::Cliff), 0u);
    tiles.cover = everywhere(0.0, 0.0);
    tiles.height = [](double x, double)
    {
        return 0.1 * x;
    };
    EXPECT_EQ(make(tiles).count(), 0u);
}

TEST(TileStrokes, TellTheShoreAndTheMiddleOfTheTown)
{
    StrokeTiles tiles;
    // Town from west to east, and the sea in the south.
    tiles.cover = [](double x, double y)
    {
        return everywhere(0.0, std::clamp(x / 2500.0, 0.0, 1.0), -y - 20.0)(x, y);
    };
    const Made made = make(tiles);
    ASSERT_GT(made.count(), 3000u);
    const auto& told = static_cast<const osg::Vec2sArray&>(*made.strokes->points()->getTexCoordArray(2));
    for (std::size_t i = 0; i < made.count(); ++i)
    {
        const osg::Vec3d place = made.vertex(i) * made.tile->getMatrix();
        ASSERT_EQ(made.traits(i).z(), TileStrokes::House);
        // A byte codes the distance.
        ASSERT_NEAR(told[i].y(), place.y() + 20.0, 4.0 + 0.06 * place.y());
        ASSERT_NEAR(told[i].x() / 32767.0, glsl::geofx_townMiddle(place.x() / 2500.0, 0.0, -place.y() - 20.0),
                    0.03);
    }
}

TEST(TileStrokes, WithoutACoverItIsGuessed)
{
    StrokeTiles tiles;
    tiles.height = [](double x, double)
    {
        return 0.4 * x - 400.0;
    };
    const Made made = make(tiles);
    EXPECT_GT(made.count(), 4000u);
    for (std::size_t i = 0; i < made.count(); ++i)
        ASSERT_GT((made.vertex(i) * made.tile->getMatrix()).z(), 0.0);
    // A texture that says nothing is the same as none.
    tiles.cover = [](double, double)
    {
        glsl::geofx_Cover cover = {};
        cover.shore = 1e9;
        return cover;
    };
    StrokeTiles unknown = tiles;
    const osg::ref_ptr<osg::MatrixTransform> tile = unknown.tile(0.0, 0.0, 2500.0, 2500.0);
    osg::Geometry& mesh = StrokeTiles::geometryOf(*tile);
    auto* texture = static_cast<osg::Texture2D*>(
        mesh.getStateSet()->getTextureAttribute(7, osg::StateAttribute::TEXTURE));
    for (unsigned int i = 0; i < texture->getImage()->getTotalSizeInBytes(); ++i)
        texture->getImage()->data()[i] = i % 4 == 3 ? 255 : 0;
    const osg::ref_ptr<TileStrokes> strokes = TileStrokes::make(mesh, tile->getMatrix(), {}, nullptr);
    ASSERT_NE(strokes->points(), nullptr);
    EXPECT_EQ(strokes->points()->getVertexArray()->getNumElements(), made.count());
    // Above the tree line there are no trees.
    StrokeParameters low;
    low.treeLine = 10.0;
    EXPECT_LT(make(tiles, low).countOf(TileStrokes::Tree), 200u);
}

TEST(TileStrokes, TheCoverIsTakenFromStatesAbove)
{
    StrokeTiles tiles;
    tiles.cover = everywhere(1.0, 0.0);
    const osg::ref_ptr<osg::MatrixTransform> tile = tiles.tile(0.0, 0.0, 2500.0, 2500.0);
    osg::Geometry& mesh = StrokeTiles::geometryOf(*tile);
    const osg::ref_ptr<osg::StateSet> state = mesh.getStateSet();
    mesh.setStateSet(new osg::StateSet);
    tile->setStateSet(state);
    const CoverSampler sampler(mesh);
    ASSERT_TRUE(sampler.valid());
    EXPECT_NEAR(sampler.at(0.5, 0.5).x, 1.0, 1e-9);
    EXPECT_FALSE(CoverSampler(mesh, 6).valid());
    tile->setStateSet(nullptr);
    EXPECT_FALSE(CoverSampler(mesh).valid());
    EXPECT_EQ(CoverSampler(mesh).at(0.5, 0.5), glsl::Rgba(0.0, 0.0, 0.0, 1.0));
}

TEST(TileStrokes, TheCoverIsFilteredAsAGpuDoes)
{
    osg::ref_ptr<osg::Image> image = new osg::Image;
    image->allocateImage(2, 2, 1, GL_RGBA, GL_UNSIGNED_BYTE);
    image->setColor(osg::Vec4(0.0f, 0.0f, 0.0f, 0.0f), 0, 0);
    image->setColor(osg::Vec4(1.0f, 0.0f, 0.0f, 0.0f), 1, 0);
    image->setColor(osg::Vec4(0.0f, 1.0f, 0.0f, 0.0f), 0, 1);
    image->setColor(osg::Vec4(1.0f, 1.0f, 0.0f, 0.0f), 1, 1);
    osg::ref_ptr<osg::Geometry> mesh = new osg::Geometry;
    mesh->getOrCreateStateSet()->setTextureAttribute(7, new osg::Texture2D(image));
    const CoverSampler sampler(*mesh);
    EXPECT_NEAR(sampler.at(0.25, 0.25).x, 0.0, 1e-12);
    EXPECT_NEAR(sampler.at(0.4, 0.25).x, 0.3, 1e-12);
    EXPECT_NEAR(sampler.at(0.4, 0.65).y, 0.8, 1e-12);
    EXPECT_NEAR(sampler.at(-3.0, 7.0).x, 0.0, 1e-12);
    EXPECT_NEAR(sampler.at(-3.0, 7.0).y, 1.0, 1e-12);
    EXPECT_EQ(sampler.at(std::nan(""), 0.5), glsl::Rgba(0.0, 0.0, 0.0, 1.0));
}

TEST(TileStrokes, AreTheSameAfterAReload)
{
    StrokeTiles tiles;
    tiles.cover = everywhere(0.5, 0.2);
    tiles.height = [](double x, double y)
    {
        return 40.0 * std::sin(x / 100.0) * std::cos(y / 80.0);
    };
    const Made first = make(tiles), second = make(tiles);
    ASSERT_EQ(first.count(), second.count());
    for (std::size_t i = 0; i < first.count(); ++i)
    {
        ASSERT_EQ(first.vertex(i), second.vertex(i));
        ASSERT_EQ(first.traits(i), second.traits(i));
    }
}

TEST(TileStrokes, ACoarserTileHasTheSameStrokesButFewer)
{
    for (const bool globe : {false, true})
    {
        StrokeTiles tiles;
        tiles.cover = everywhere(0.5, 0.2);
        if (globe) tiles.ellipsoid = new osg::EllipsoidModel;
        const double unit = globe ? 1.0 / 6378137.0 : 1.0;
        const auto strokes = [&](double size)
        {
            Made made;
            made.tile = tiles.tile(0.1, 0.2, 0.1 + size * unit, 0.2 + size * unit);
            made.strokes = TileStrokes::make(StrokeTiles::geometryOf(*made.tile), made.tile->getMatrix(), {},
                                             tiles.ellipsoid);
            return std::make_pair(strokesOf(made), made.strokes->finest());
        };
        const auto [fine, finest] = strokes(3000.0);
        const auto [coarse, coarsest] = strokes(12000.0);
        EXPECT_EQ(finest, 0);
        EXPECT_EQ(coarsest, 4);
        std::size_t shared = 0, due = 0;
        for (const auto& [identity, place] : fine)
        {
            const auto found = coarse.find(identity);
            if (std::get<1>(identity) < coarsest)
            {
                ASSERT_EQ(found, coarse.end());
                continue;
            }
            ++due;
            if (found == coarse.end()) continue;
            ++shared;
            // The coarser mesh lies below the globe's, by as much as it is coarser.
            ASSERT_LT((found->second - place).length(), globe ? 0.2 : 0.02);
        }
        EXPECT_GT(due, 400u);
        EXPECT_EQ(shared, due);
    }
}

TEST(TileStrokes, HaveABoxAndLittleWeight)
{
    StrokeTiles tiles;
    tiles.cover = everywhere(1.0, 0.0);
    const Made made = make(tiles);
    const osg::Geometry& points = *made.strokes->points();
    const osg::BoundingBox box = points.getBoundingBox();
    EXPECT_NEAR(box.xMax() - box.xMin(), 2500.0, 60.0);
    EXPECT_TRUE(points.getUseVertexBufferObjects());
    EXPECT_EQ(points.getPrimitiveSet(0)->getMode(), static_cast<GLenum>(GL_POINTS));
    EXPECT_EQ(points.getVertexArray()->getElementSize() + points.getNormalArray()->getElementSize() +
                  points.getTexCoordArray(0)->getElementSize(),
              26u);
}

TEST(StrokeMaker, FurnishesWhatIsBelowANode)
{
    StrokeTiles tiles;
    tiles.cover = everywhere(1.0, 0.0);
    const osg::ref_ptr<osg::Group> group = new osg::Group;
    const osg::ref_ptr<osg::MatrixTransform> a = tiles.tile(0.0, 0.0, 2500.0, 2500.0);
    const osg::ref_ptr<osg::MatrixTransform> b = tiles.tile(2500.0, 0.0, 5000.0, 2500.0);
    group->addChild(a);
    group->addChild(b);
    const osg::ref_ptr<StrokeMaker> maker = new StrokeMaker(nullptr);
    maker->furnish(*group);
    for (const auto& tile : {a, b})
    {
        osg::Geometry& mesh = StrokeTiles::geometryOf(*tile);
        ASSERT_EQ(mesh.getUserDataContainer()->getNumUserObjects(), 1u);
        const auto* kept = dynamic_cast<const TileStrokes*>(mesh.getUserDataContainer()->getUserObject(0));
        ASSERT_NE(kept, nullptr);
        EXPECT_EQ(maker->strokes(mesh, tile->getMatrix()), kept->points());
        const osg::ref_ptr<TileStrokes> alone = TileStrokes::make(mesh, tile->getMatrix(), {}, nullptr);
        EXPECT_EQ(alone->points()->getVertexArray()->getNumElements(),
                  kept->points()->getVertexArray()->getNumElements());
    }
    // Where the tile's parent moves it, it has the strokes of that place.
    const osg::ref_ptr<osg::MatrixTransform> c = tiles.tile(0.0, 0.0, 2500.0, 2500.0);
    maker->furnish(*c, osg::Matrixd::translate(2500.0, 0.0, 0.0));
    const osg::Matrixd moved = c->getMatrix() * osg::Matrixd::translate(2500.0, 0.0, 0.0);
    EXPECT_EQ(StrokeTiles::geometryOf(*c).getUserDataContainer()->getNumUserObjects(), 1u);
    EXPECT_EQ(
        maker->strokes(StrokeTiles::geometryOf(*c), moved)->getVertexArray()->getNumElements(),
        maker->strokes(StrokeTiles::geometryOf(*b), b->getMatrix())->getVertexArray()->getNumElements());
    EXPECT_EQ(StrokeTiles::geometryOf(*c).getUserDataContainer()->getNumUserObjects(), 1u);
}

TEST(StrokeMaker, NewParametersGiveNewStrokes)
{
    StrokeTiles tiles;
    tiles.cover = everywhere(1.0, 0.0);
    const osg::ref_ptr<osg::MatrixTransform> tile = tiles.tile(0.0, 0.0, 2500.0, 2500.0);
    osg::Geometry& mesh = StrokeTiles::geometryOf(*tile);
    const osg::ref_ptr<StrokeMaker> maker = new StrokeMaker(nullptr);
    const osg::ref_ptr<osg::Geometry> first = maker->strokes(mesh, tile->getMatrix());
    EXPECT_EQ(maker->strokes(mesh, tile->getMatrix()), first);
    StrokeParameters parameters;
    for (int i = 1; i < 5; ++i)
    {
        parameters.spacing = 25.0 * (i + 1);
        maker->setParameters(parameters);
        EXPECT_EQ(maker->getParameters(), parameters);
        const osg::ref_ptr<osg::Geometry> next = maker->strokes(mesh, tile->getMatrix());
        EXPECT_LT(next->getVertexArray()->getNumElements(), first->getVertexArray()->getNumElements());
        EXPECT_LE(mesh.getUserDataContainer()->getNumUserObjects(), 2u);
    }
    // Two scenes with different wishes share a terrain without taking each other's.
    const osg::ref_ptr<StrokeMaker> other = new StrokeMaker(nullptr);
    const osg::ref_ptr<osg::Geometry> theirs = other->strokes(mesh, tile->getMatrix());
    const osg::ref_ptr<osg::Geometry> ours = maker->strokes(mesh, tile->getMatrix());
    EXPECT_NE(theirs, ours);
    EXPECT_EQ(other->strokes(mesh, tile->getMatrix()), theirs);
    EXPECT_EQ(maker->strokes(mesh, tile->getMatrix()), ours);
}

TEST(StrokeMaker, AnyNumberOfScenesWithWishesOfTheirOwnShareATerrain)
{
    StrokeTiles tiles;
    tiles.cover = everywhere(1.0, 0.0);
    const osg::ref_ptr<osg::MatrixTransform> tile = tiles.tile(0.0, 0.0, 2500.0, 2500.0);
    osg::Geometry& mesh = StrokeTiles::geometryOf(*tile);
    std::vector<osg::ref_ptr<StrokeMaker>> makers;
    std::vector<osg::Geometry*> first;
    for (int i = 0; i < 5; ++i)
    {
        StrokeParameters parameters;
        parameters.spacing = 25.0 * (i + 1);
        makers.push_back(new StrokeMaker(nullptr));
        makers.back()->setParameters(parameters);
        first.push_back(makers.back()->strokes(mesh, tile->getMatrix()).get());
    }
    // Frame by frame nobody's are made anew.
    for (int frame = 0; frame < 3; ++frame)
        for (std::size_t i = 0; i < makers.size(); ++i)
            EXPECT_EQ(makers[i]->strokes(mesh, tile->getMatrix()), first[i]) << i;
    EXPECT_EQ(mesh.getUserDataContainer()->getNumUserObjects(), 5u);
    // What nobody wants any more goes when others come.
    makers.resize(2);
    StrokeParameters parameters;
    parameters.spacing = 500.0;
    makers[0]->setParameters(parameters);
    makers[0]->strokes(mesh, tile->getMatrix());
    EXPECT_EQ(mesh.getUserDataContainer()->getNumUserObjects(), 2u);
    EXPECT_EQ(makers[1]->strokes(mesh, tile->getMatrix()), first[1]);
}

TEST(StrokeMaker, TilesBelowATransformHaveTheStrokesOfTheirPlace)
{
    StrokeTiles tiles;
    tiles.cover = [](double x, double)
    {
        glsl::geofx_Cover cover{};
        cover.trees = x < 2500.0 ? 1.0 : 0.4;
        cover.shore = -400.0;
        return cover;
    };
    // A pager's tile knows nothing of the transform above it.
    const osg::Matrixd above = osg::Matrixd::translate(137.0, -2045.0, 12.0);
    const osg::ref_ptr<StrokeMaker> maker = new StrokeMaker(nullptr);
    for (int i = 0; i < 3; ++i)
    {
        const osg::ref_ptr<osg::MatrixTransform> tile = tiles.tile(2500.0 * i, 0.0, 2500.0 * (i + 1), 2500.0);
        osg::Geometry& mesh = StrokeTiles::geometryOf(*tile);
        maker->tileRead(*tile);
        const osg::ref_ptr<osg::Geometry> read =
            static_cast<const TileStrokes&>(*mesh.getUserDataContainer()->getUserObject(0)).points();
        const osg::Matrixd toWorld = tile->getMatrix() * above;
        const osg::ref_ptr<osg::Geometry> drawn = maker->strokes(mesh, toWorld);
        // The first one shows that there is a transform; the pager's thread makes the others right.
        EXPECT_EQ(drawn == read, i > 0) << i;
        EXPECT_EQ(mesh.getUserDataContainer()->getNumUserObjects(), 1u) << i;
        const osg::ref_ptr<TileStrokes> expected = TileStrokes::make(mesh, toWorld, {}, nullptr);
        const auto& a = static_cast<const osg::Vec3Array&>(*drawn->getVertexArray());
        const auto& b = static_cast<const osg::Vec3Array&>(*expected->points()->getVertexArray());
        ASSERT_EQ(a.size(), b.size());
        for (std::size_t k = 0; k < a.size(); ++k)
            ASSERT_LT((a[k] - b[k]).length(), 0.05f) << k;
        const osg::ref_ptr<TileStrokes> unmoved = TileStrokes::make(mesh, tile->getMatrix(), {}, nullptr);
        EXPECT_NE(unmoved->points()->getVertexArray()->getNumElements(), 0u);
        const auto& c = static_cast<const osg::Vec3Array&>(*unmoved->points()->getVertexArray());
        const bool differs = a.size() != c.size() || (a[0] - c[0]).length() > 1.0f;
        EXPECT_TRUE(differs) << "the transform makes no difference, so that the test would see nothing";
    }
}

TEST(StrokeMaker, ParametersDifferWhereAnyOfThemDoes)
{
    const StrokeParameters same;
    std::vector<StrokeParameters> others(8);
    others[0].spacing += 1.0;
    others[1].referenceLatitude += 0.1;
    others[2].jitter += 0.1;
    others[3].cliffSlope += 0.1;
    others[4].treeLine += 1.0;
    others[5].seed += 1;
    others[6].strokesAlongTile += 1.0;
    others[7].coverUnit += 1;
    for (const StrokeParameters& other : others)
        EXPECT_NE(other, same);
    EXPECT_EQ(StrokeParameters(), same);
    StrokeTiles tiles;
    tiles.cover = everywhere(1.0, 0.0);
    const Made made = make(tiles);
    const osg::ref_ptr<osg::EllipsoidModel> globe = new osg::EllipsoidModel;
    EXPECT_TRUE(made.strokes->madeWith({}, nullptr));
    EXPECT_FALSE(made.strokes->madeWith({}, globe));
    EXPECT_FALSE(made.strokes->madeWith(others[0], nullptr));
}

// One map over several scenes, each with an ellipsoid of its own: what counts is its size, not which object it is.
TEST(StrokeMaker, EachGroundHasOneWhateverObjectsItIsToldBy)
{
    const osg::ref_ptr<PanoramaMap> map = new PanoramaMap;
    const auto makerOf = [&](const Ground& ground)
    {
        const osg::ref_ptr<TileListener> listener = map->asPassEffect()->tileListener(ground);
        return osg::ref_ptr<StrokeMaker>(dynamic_cast<StrokeMaker*>(listener.get()));
    };
    const auto groundWith = [](osg::EllipsoidModel* ellipsoid, double latitude)
    {
        Ground ground;
        ground.ellipsoid = ellipsoid;
        ground.latitude = latitude;
        return ground;
    };
    constexpr double here = 0.4;
    StrokeTiles tiles;
    tiles.ellipsoid = new osg::EllipsoidModel;
    tiles.cover = everywhere(1.0, 0.0);
    const osg::ref_ptr<osg::MatrixTransform> tile = tiles.tile(here, here, here + 0.0003, here + 0.0003);
    osg::Geometry& mesh = StrokeTiles::geometryOf(*tile);
    const auto strokesOf = [&](const Ground& ground)
    {
        return makerOf(ground)->strokes(mesh, tile->getMatrix());
    };
    // A pager may have it, which does not keep it alive, before the terrain is there.
    const osg::observer_ptr<StrokeMaker> first = makerOf(groundWith(tiles.ellipsoid, 0.0));
    const Ground one = groundWith(tiles.ellipsoid, here);
    const osg::ref_ptr<osg::Geometry> strokes = strokesOf(one);
    ASSERT_TRUE(strokes);
    EXPECT_EQ(makerOf(one), first.get());
    const Ground equal = groundWith(new osg::EllipsoidModel, here);
    const Ground wider = groundWith(new osg::EllipsoidModel(6.4e6), here);
    const Ground northern = groundWith(new osg::EllipsoidModel, 1.0);
    const Ground flat = groundWith(nullptr, here);
    for (int turn = 0; turn < 3; ++turn)
    {
        EXPECT_EQ(strokesOf(equal), strokes);
        EXPECT_EQ(makerOf(equal), first.get());
        EXPECT_EQ(strokesOf(one), strokes);
        for (const Ground& other : {wider, northern})
        {
            EXPECT_NE(makerOf(other), first.get());
            EXPECT_NE(strokesOf(other), strokes);
        }
        EXPECT_NE(makerOf(flat), first.get());
        EXPECT_NE(makerOf(flat), makerOf(wider));
    }
    // All of them follow the map.
    map->setCliffSlope(1.5 * map->getCliffSlope());
    EXPECT_EQ(makerOf(one), first.get());
    EXPECT_NE(strokesOf(one), strokes);
    EXPECT_EQ(makerOf(wider)->getParameters().cliffSlope, makerOf(one)->getParameters().cliffSlope);
}

TEST(StrokeMaker, ThreadsThatAskAtOnceGetTheSame)
{
    StrokeTiles tiles;
    tiles.cover = everywhere(1.0, 0.0);
    const osg::ref_ptr<StrokeMaker> maker = new StrokeMaker(nullptr);
    for (int turn = 0; turn < 10; ++turn)
    {
        const osg::ref_ptr<osg::MatrixTransform> tile = tiles.tile(0.0, 0.0, 1000.0, 1000.0);
        osg::Geometry& mesh = StrokeTiles::geometryOf(*tile);
        std::vector<osg::ref_ptr<osg::Geometry>> got(4);
        std::vector<std::thread> threads;
        for (osg::ref_ptr<osg::Geometry>& each : got)
            threads.emplace_back([&] { each = maker->strokes(mesh, tile->getMatrix()); });
        for (std::thread& thread : threads)
            thread.join();
        for (const auto& each : got)
            EXPECT_EQ(each, got.front());
        EXPECT_EQ(mesh.getUserDataContainer()->getNumUserObjects(), 1u);
    }
}

TEST(StrokeMaker, FilesAndCopiesAreAsIfThereWereNone)
{
    const NotifyWatch watch;
    const TempDir folder;
    StrokeTiles tiles;
    tiles.cover = everywhere(1.0, 0.0);
    const osg::ref_ptr<osg::MatrixTransform> tile = tiles.tile(0.0, 0.0, 1000.0, 1000.0);
    const osg::ref_ptr<StrokeMaker> maker = new StrokeMaker(nullptr);
    maker->furnish(*tile);
    const auto hasStrokes = [](osg::MatrixTransform& node)
    {
        const osg::UserDataContainer* data = StrokeTiles::geometryOf(node).getUserDataContainer();
        for (unsigned int i = 0; data && i < data->getNumUserObjects(); ++i)
            if (dynamic_cast<const TileStrokes*>(data->getUserObject(i))) return true;
        return false;
    };
    EXPECT_TRUE(hasStrokes(*tile));
    const osg::ref_ptr<osg::Object> copy = tile->clone(osg::CopyOp::DEEP_COPY_ALL);
    EXPECT_FALSE(hasStrokes(static_cast<osg::MatrixTransform&>(*copy)));
    for (const char* name : {"tile.osgb", "tile.osgt"})
    {
        const std::string file = (folder / name).string();
        ASSERT_TRUE(osgDB::writeNodeFile(*tile, file));
        const osg::ref_ptr<osg::Node> read = osgDB::readRefNodeFile(file);
        ASSERT_TRUE(read.valid());
        auto& node = static_cast<osg::MatrixTransform&>(*read);
        EXPECT_FALSE(hasStrokes(node));
        EXPECT_TRUE(maker->strokes(StrokeTiles::geometryOf(node), node.getMatrix()).valid());
    }
}

/// A coarse mesh' vertices do not tell of the slopes between them; the tile's texture of normals does.
TEST(TileStrokes, NormalsAreThoseOfTheTexture)
{
    StrokeTiles tiles;
    tiles.cover = everywhere(1.0, 0.0);
    const osg::ref_ptr<osg::MatrixTransform> tile = tiles.tile(0.0, 0.0, 2500.0, 2500.0);
    osg::Geometry& geometry = StrokeTiles::geometryOf(*tile);
    osg::ref_ptr<osg::Image> image = new osg::Image;
    image->allocateImage(65, 65, 1, GL_RG, GL_UNSIGNED_BYTE, 1);
    for (unsigned int row = 0; row < 65; ++row)
        for (unsigned int column = 0; column < 65; ++column)
        {
            // Steep to the east in the eastern half.
            image->data(column, row)[0] = column < 32 ? 128 : 128 - 102;
            image->data(column, row)[1] = 128;
        }
    osg::ref_ptr<osg::Texture2D> texture = new osg::Texture2D(image);
    geometry.getOrCreateStateSet()->setTextureAttribute(2, texture);
    const auto normals = [&](const char* name)
    {
        texture->setName(name);
        const auto strokes = TileStrokes::make(geometry, tile->getMatrix(), {}, nullptr);
        std::vector<std::pair<osg::Vec3d, osg::Vec3d>> result;
        const auto& places = static_cast<const osg::Vec3Array&>(*strokes->points()->getVertexArray());
        const auto& shorts = static_cast<const osg::Vec3sArray&>(*strokes->points()->getNormalArray());
        for (std::size_t i = 0; i < places.size(); ++i)
            result.emplace_back(places[i], osg::Vec3d(shorts[i].x(), shorts[i].y(), shorts[i].z()) / 32767.0);
        return result;
    };
    int steep = 0, level = 0;
    for (const auto& [place, normal] : normals("geofx normals"))
    {
        if (std::abs(place.x()) < 40.0) continue;
        const osg::Vec3d expected =
            place.x() < 0.0 ? osg::Vec3d(0, 0, 1) : osg::Vec3d(-102, 0, 75.66) / 127.0;
        EXPECT_LT((normal - expected).length(), 0.01) << place.x();
        ++(place.x() < 0.0 ? level : steep);
    }
    EXPECT_GT(steep, 1000);
    EXPECT_GT(level, 1000);
    // Another texture there is not one of normals.
    for (const auto& [place, normal] : normals("another"))
        EXPECT_LT((normal - osg::Vec3d(0, 0, 1)).length(), 0.01) << place.x();
}

TEST(StrokeMaker, StrokesGoWithTheirTile)
{
    StrokeTiles tiles;
    tiles.cover = everywhere(1.0, 0.0);
    osg::ref_ptr<osg::MatrixTransform> tile = tiles.tile(0.0, 0.0, 1000.0, 1000.0);
    const osg::ref_ptr<StrokeMaker> maker = new StrokeMaker(nullptr);
    const osg::observer_ptr<osg::Geometry> strokes =
        maker->strokes(StrokeTiles::geometryOf(*tile), tile->getMatrix()).get();
    EXPECT_TRUE(strokes.valid());
    tile = nullptr;
    EXPECT_FALSE(strokes.valid());
}

TEST(StrokeMaker, StrokesGoWithTheLastThatWantsThem)
{
    StrokeTiles tiles;
    tiles.cover = everywhere(1.0, 0.0);
    std::vector<osg::ref_ptr<osg::MatrixTransform>> row;
    for (int i = 0; i < 3; ++i)
        row.push_back(tiles.tile(1000.0 * i, 0.0, 1000.0 * i + 1000.0, 1000.0));
    std::vector<osg::ref_ptr<StrokeMaker>> makers = {new StrokeMaker(nullptr), new StrokeMaker(nullptr)};
    StrokeParameters parameters;
    parameters.spacing = 77.0;
    osg::ref_ptr<StrokeMaker> other = new StrokeMaker(nullptr);
    other->setParameters(parameters);
    const auto all = [&]
    {
        std::set<const osg::Geometry*> strokes;
        for (const auto& tile : row)
        {
            const osg::UserDataContainer* data = StrokeTiles::geometryOf(*tile).getUserDataContainer();
            for (unsigned int i = 0; data && i < data->getNumUserObjects(); ++i)
                if (const auto* each = dynamic_cast<const TileStrokes*>(data->getUserObject(i)))
                    strokes.insert(each->points());
        }
        return strokes.size();
    };
    for (const auto& tile : row)
    {
        for (const auto& maker : makers)
            maker->strokes(StrokeTiles::geometryOf(*tile), tile->getMatrix());
        other->strokes(StrokeTiles::geometryOf(*tile), tile->getMatrix());
    }
    EXPECT_EQ(all(), 6u) << "makers of one wish share theirs";
    makers.pop_back();
    EXPECT_EQ(all(), 6u);
    makers.pop_back();
    EXPECT_EQ(all(), 3u) << "the tiles keep what nobody wants";
    row.pop_back();
    other = nullptr;
    EXPECT_EQ(all(), 0u);
}

} // namespace
