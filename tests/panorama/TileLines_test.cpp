// SPDX-License-Identifier: MIT
// SPDX-FileCopyrightText: 2026 the osgGeoFX authors
//
// Roads, rivers and towns as strokes of tiles: on the ground, along the line, the same in all tiles and levels.
#include <osgGeoFX/panorama/detail/StrokeMaker.h>
#include <tools/StrokeTiles.h>

#include <gtest/gtest.h>

#include <cmath>
#include <map>
#include <vector>

using namespace osgGeoFX;
using namespace geofx::test;

namespace
{

struct Stroke
{
    osg::Vec3d place; ///< in the world
    osg::Vec3d along;
    osg::Vec4s traits;
};

osg::ref_ptr<StrokeLines> linesOf(std::vector<StrokeLines::Line> lines,
                                  StrokeLines::Units units = StrokeLines::METRES)
{
    osg::ref_ptr<StrokeLines> result = new StrokeLines;
    EXPECT_TRUE(result->set(units, std::move(lines)));
    return result;
}

/// A winding road from the south-west to the north-east over 12 km, and a river beside it.
osg::ref_ptr<StrokeLines> windingLines()
{
    std::vector<osg::Vec2d> road, river;
    for (int i = 0; i <= 240; ++i)
    {
        const double x = 50.0 * i + 17.0;
        road.emplace_back(x, 0.8 * x + 1000.0 + 300.0 * std::sin(x / 700.0));
        river.emplace_back(x, 0.8 * x + 1400.0 + 300.0 * std::sin(x / 700.0));
    }
    return linesOf({{StrokeLines::ROAD, road}, {StrokeLines::RIVER, river}});
}

class TileLines : public ::testing::Test
{
protected:
    StrokeTiles _tiles;
    StrokeParameters _parameters;

    TileLines()
    {
        _tiles.height = [](double x, double y)
        {
            return 100.0 + 0.1 * x + 60.0 * std::sin(y / 900.0);
        };
        _tiles.cover = cover(0.0, -1000.0);
    }

    static std::function<glsl::geofx_Cover(double, double)> cover(double trees, double shore)
    {
        return [=](double, double)
        {
            glsl::geofx_Cover each = {};
            each.trees = trees;
            each.shore = shore;
            return each;
        };
    }

    std::vector<Stroke> strokes(double west, double south, double size, int* finest = nullptr) const
    {
        const osg::ref_ptr<osg::MatrixTransform> tile = _tiles.tile(west, south, west + size, south + size);
        const osg::ref_ptr<TileStrokes> made = TileStrokes::make(
            StrokeTiles::geometryOf(*tile), tile->getMatrix(), _parameters, _tiles.ellipsoid);
        if (finest) *finest = made->finest();
        std::vector<Stroke> result;
        const osg::Geometry* points = made->points();
        if (!points) return result;
        const auto& vertices = static_cast<const osg::Vec3Array&>(*points->getVertexArray());
        const auto& traits = static_cast<const osg::Vec4sArray&>(*points->getTexCoordArray(0));
        const auto* along = static_cast<const osg::Vec3sArray*>(points->getTexCoordArray(1));
        for (std::size_t i = 0; i < vertices.size(); ++i)
        {
            Stroke stroke{osg::Vec3d(vertices[i]) * tile->getMatrix(), {}, traits[i]};
            if (along)
                stroke.along =
                    osg::Matrixd::transform3x3(osg::Vec3d((*along)[i].x(), (*along)[i].y(), (*along)[i].z()),
                                               tile->getMatrix()) /
                    32767.0;
            result.push_back(stroke);
        }
        return result;
    }

    static std::vector<Stroke> ofKind(const std::vector<Stroke>& all, TileStrokes::Kind kind)
    {
        std::vector<Stroke> some;
        for (const Stroke& stroke : all)
            if (stroke.traits.z() == kind) some.push_back(stroke);
        return some;
    }
};

/// What tells a stroke of one line from the others.
std::pair<short, short> identity(const Stroke& stroke)
{
    return {stroke.traits.x(), stroke.traits.y()};
}

TEST_F(TileLines, LieOnTheGroundAlongTheLine)
{
    _parameters.lines = linesOf({{StrokeLines::ROAD, {{10.0, 20.0}, {2400.0, 2300.0}}}});
    const std::vector<Stroke> road = ofKind(strokes(0.0, 0.0, 2500.0), TileStrokes::Road);
    const double length = std::hypot(2390.0, 2280.0);
    EXPECT_NEAR(static_cast<double>(road.size()), length / 12.5 + 1.5, 1.0);
    osg::Vec3d way(2390.0, 2280.0, 0.0);
    way.normalize();
    for (const Stroke& stroke : road)
    {
        const osg::Vec3d from = stroke.place - osg::Vec3d(10.0, 20.0, 0.0);
        EXPECT_LT(std::abs(from.x() * way.y() - from.y() * way.x()), 0.2);
        // The mesh is flat between its posts.
        EXPECT_LT(std::abs(stroke.place.z() - _tiles.height(stroke.place.x(), stroke.place.y())), 1.0);
        EXPECT_NEAR(stroke.along.length(), 1.0, 1e-3);
        const osg::Vec3d ahead = stroke.place + stroke.along * 10.0;
        EXPECT_LT(std::abs(ahead.z() - _tiles.height(ahead.x(), ahead.y())), 2.5);
        EXPECT_GT(stroke.along * way, 0.98);
        EXPECT_EQ(stroke.traits.w(), -2);
    }
}

TEST_F(TileLines, AreTheSameInAllTilesAndHaveNoGaps)
{
    _parameters.lines = windingLines();
    for (const auto kind : {TileStrokes::Road, TileStrokes::River})
    {
        for (const double size : {12800.0, 3200.0, 1600.0})
        {
            std::vector<double> xs;
            int finest = 0;
            for (double west = 0.0; west < 12800.0; west += size)
                for (double south = 0.0; south < 12800.0; south += size)
                    for (const Stroke& stroke : ofKind(strokes(west, south, size, &finest), kind))
                        xs.push_back(stroke.place.x());
            std::sort(xs.begin(), xs.end());
            const double spacing = 12.5 * std::exp2(finest / 2);
            EXPECT_EQ(finest, size > 10000.0 ? 4 : 0);
            ASSERT_GT(xs.size(), 10000.0 / spacing);
            EXPECT_LT(xs.front(), 18.0);
            // None is there twice, and none is missing.
            for (std::size_t i = 1; i < xs.size(); ++i)
            {
                ASSERT_GT(xs[i] - xs[i - 1], i + 1 < xs.size() ? 0.4 * spacing : -1.0) << size;
                ASSERT_LT(xs[i] - xs[i - 1], 1.05 * spacing) << size;
            }
        }
    }
}

TEST_F(TileLines, ACoarserTileHasTheSameStrokesButFewer)
{
    for (const bool globe : {false, true})
    {
        SCOPED_TRACE(globe);
        const double unit = globe ? 1.0 / 6378137.0 : 1.0, degrees = globe ? 180.0 / osg::PI : 1.0;
        _tiles.ellipsoid = globe ? new osg::EllipsoidModel : nullptr;
        _tiles.height = [](double, double)
        {
            return 100.0;
        };
        const double west = globe ? 3.1414 : 0.0, south = globe ? 0.2 : 0.0;
        std::vector<osg::Vec2d> points;
        for (int i = 0; i <= 56; ++i)
            points.emplace_back((west + 50.0 * i * unit) * degrees,
                                (south + (50.0 * i + 200.0 * std::sin(i / 9.0)) * unit) * degrees);
        _parameters.lines =
            linesOf({{StrokeLines::ROAD, points}}, globe ? StrokeLines::DEGREES : StrokeLines::METRES);
        int finest = 0, coarsest = 0;
        const std::vector<Stroke> fine = strokes(west, south, 3000.0 * unit, &finest);
        const std::vector<Stroke> coarse = strokes(west, south, 12000.0 * unit, &coarsest);
        std::map<std::pair<short, short>, osg::Vec3d> kept;
        for (const Stroke& stroke : coarse)
            kept[identity(stroke)] = stroke.place;
        EXPECT_EQ(finest, 0);
        EXPECT_EQ(coarsest, 4);
        std::size_t due = 0;
        for (const Stroke& stroke : fine)
        {
            const auto found = kept.find(identity(stroke));
            if (stroke.traits.y() < coarsest - 2)
            {
                EXPECT_EQ(found, kept.end());
                continue;
            }
            ++due;
            ASSERT_NE(found, kept.end());
            EXPECT_LT((found->second - stroke.place).length(), globe ? 0.3 : 0.1);
        }
        EXPECT_GT(due, 40u);
        EXPECT_EQ(due, coarse.size());
    }
}

TEST_F(TileLines, RiversEndAtWaterAndRoadsCrossIt)
{
    _parameters.lines = windingLines();
    _tiles.cover = cover(0.0, 50.0);
    const std::vector<Stroke> wet = strokes(0.0, 0.0, 3000.0);
    EXPECT_GT(ofKind(wet, TileStrokes::Road).size(), 100u);
    EXPECT_TRUE(ofKind(wet, TileStrokes::River).empty());
}

TEST_F(TileLines, TownsHaveHouses)
{
    _tiles.cover = cover(1.0, -1000.0);
    _parameters.lines =
        linesOf({{StrokeLines::TOWN, {{500.0, 500.0}, {1500.0, 500.0}, {1500.0, 1500.0}, {500.0, 1500.0}}}});
    std::size_t houses = 0, trees = 0;
    for (const Stroke& stroke : strokes(0.0, 0.0, 2500.0))
    {
        const bool within =
            std::max(std::abs(stroke.place.x() - 1000.0), std::abs(stroke.place.y() - 1000.0)) < 500.1;
        if (stroke.traits.z() == TileStrokes::House)
            EXPECT_TRUE(within);
        else
            trees += within ? 1 : 0;
        houses += stroke.traits.z() == TileStrokes::House ? 1 : 0;
    }
    EXPECT_NEAR(static_cast<double>(houses), 1600.0 * 0.7, 120.0);
    EXPECT_NEAR(static_cast<double>(trees), 1600.0 * 0.3, 120.0);
}

TEST_F(TileLines, OtherLinesOrUnitsChangeNothingElse)
{
    _tiles.cover = cover(0.5, -1000.0);
    const std::vector<Stroke> plain = strokes(0.0, 0.0, 2500.0);
    _parameters.lines = linesOf({{StrokeLines::ROAD, {{0.1, 0.1}, {20.0, 20.0}}}}, StrokeLines::DEGREES);
    EXPECT_EQ(strokes(0.0, 0.0, 2500.0).size(), plain.size());
    _parameters.lines = windingLines();
    const std::vector<Stroke> both = strokes(0.0, 0.0, 2500.0);
    EXPECT_EQ(ofKind(both, TileStrokes::Tree).size(), plain.size());
    for (std::size_t i = 0; i < plain.size(); ++i)
        ASSERT_EQ(both[i].place, plain[i].place);

    StrokeParameters other = _parameters;
    EXPECT_EQ(other, _parameters);
    other.lines = windingLines();
    EXPECT_NE(other, _parameters);
}

TEST_F(TileLines, NewLinesGiveNewStrokes)
{
    const osg::ref_ptr<osg::MatrixTransform> tile = _tiles.tile(0.0, 0.0, 2500.0, 2500.0);
    osg::Geometry& mesh = StrokeTiles::geometryOf(*tile);
    const osg::ref_ptr<StrokeMaker> maker = new StrokeMaker(nullptr);
    EXPECT_EQ(maker->strokes(mesh, tile->getMatrix()), nullptr);
    _parameters.lines = windingLines();
    maker->setParameters(_parameters);
    const osg::ref_ptr<osg::Geometry> strokes = maker->strokes(mesh, tile->getMatrix());
    ASSERT_NE(strokes, nullptr);
    EXPECT_EQ(maker->strokes(mesh, tile->getMatrix()), strokes);
}

} // namespace
