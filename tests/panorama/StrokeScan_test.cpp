// SPDX-License-Identifier: MIT
// SPDX-FileCopyrightText: 2026 the osgGeoFX authors
//
// Which points of the strokes' lattice a tile has: each exactly once over all tiles of a level, and the same ones at every level.
#include <osgGeoFX/panorama/detail/StrokeScan.h>
#include <tools/RandomSamples.h>
#include <tools/StrokeTiles.h>

#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <map>
#include <set>
#include <string>

using namespace osgGeoFX;
using namespace geofx::test;

namespace
{

using Point = std::pair<std::int64_t, std::int64_t>;

struct Area
{
    std::string name;
    bool globe;
    double west, south, east, north; ///< degrees or metres
};

std::ostream& operator<<(std::ostream& out, const Area& area)
{
    return out << area.name;
}

Point canonical(const StrokeLattice& lattice, const StrokeSpot& spot)
{
    const std::int64_t around = lattice.columns();
    return {around > 0 ? (spot.column % around + around) % around : spot.column, spot.row};
}

class StrokeScanOver : public ::testing::TestWithParam<Area>
{
protected:
    StrokeScanOver()
    {
        _unit = GetParam().globe ? osg::PI / 180.0 : 1.0;
        _tiles.ellipsoid = GetParam().globe ? new osg::EllipsoidModel : nullptr;
        _tiles.height = [this](double x, double y)
        {
            return 500.0 + 300.0 * std::sin(900.0 * x / _unit) * std::cos(700.0 * y / _unit);
        };
        if (!GetParam().globe)
            _tiles.height = [](double x, double y)
            {
                return 500.0 + 60.0 * std::sin(x / 300.0) * std::cos(y / 400.0);
            };
        _parameters.referenceLatitude = 0.4;
        _parameters.strokesAlongTile = 60.0;
    }

    StrokeLattice lattice() const { return StrokeLattice(_parameters, _tiles.ellipsoid); }

    /// How often the tiles of a level have each point; `finest` is that of the coarsest of them.
    std::map<Point, int> points(int level, int& finest)
    {
        const Area& area = GetParam();
        const StrokeLattice ours = lattice();
        std::map<Point, int> found;
        const int count = 1 << level;
        finest = 0;
        for (int y = 0; y < count; ++y)
        {
            for (int x = 0; x < count; ++x)
            {
                const auto at = [&](double low, double high, int k)
                {
                    return _unit * (low + (high - low) * k / count);
                };
                const osg::ref_ptr<osg::MatrixTransform> tile =
                    _tiles.tile(at(area.west, area.east, x), at(area.south, area.north, y),
                                at(area.west, area.east, x + 1), at(area.south, area.north, y + 1));
                const StrokeScan scan(ours, StrokeTiles::geometryOf(*tile), tile->getMatrix(),
                                      _parameters.strokesAlongTile);
                finest = std::max(finest, scan.finest());
                for (const StrokeSpot& spot : scan.spots())
                {
                    EXPECT_GE(spot.halfLevel, scan.finest());
                    EXPECT_EQ(spot.halfLevel, StrokeLattice::halfLevel(spot.column, spot.row));
                    ++found[canonical(ours, spot)];
                }
            }
        }
        return found;
    }

    /// What should be there: points of a level and above whose strokes stand within the area, less those on its very border.
    std::set<Point> wanted(int half, double margin) const
    {
        const Area& area = GetParam();
        const StrokeLattice ours = lattice();
        const auto corner = [&](double x, double y)
        {
            return ours.coordinates(_tiles.world(_unit * x, _unit * y, 0.0));
        };
        const osg::Vec3d low = corner(area.west, area.south);
        osg::Vec3d high = corner(area.east, area.north);
        high.x() = ours.columnNear(high.x(), low.x());
        if (high.x() < low.x()) high.x() += static_cast<double>(ours.columns());
        std::set<Point> points;
        const auto look = [&](std::int64_t reach, std::int64_t step)
        {
            const auto first = [&](double start)
            {
                return (static_cast<std::int64_t>(std::floor(start)) - reach) / step * step;
            };
            for (std::int64_t row = first(low.y()); static_cast<double>(row - reach) < high.y(); row += step)
            {
                for (std::int64_t column = first(low.x()); static_cast<double>(column - reach) < high.x();
                     column += step)
                {
                    if (StrokeLattice::halfLevel(column, row) < half) continue;
                    const osg::Vec2d place = ours.place(column, row);
                    const osg::Vec2d inwards(std::min(place.x() - low.x(), high.x() - place.x()),
                                             std::min(place.y() - low.y(), high.y() - place.y()));
                    if (std::min(inwards.x(), inwards.y()) <= margin) continue;
                    StrokeSpot spot;
                    spot.column = column;
                    spot.row = row;
                    points.insert(canonical(ours, spot));
                }
            }
        };
        look(60, 1);
        look(20000, 64); // the few that may stand farther off
        return points;
    }

    double _unit = 1.0;
    StrokeTiles _tiles;
    StrokeParameters _parameters;
};

TEST_P(StrokeScanOver, EachPointIsInOneTileOfALevelAndInAllLevels)
{
    std::set<Point> former;
    for (int level = 0; level < 4; ++level)
    {
        int finest = 0;
        const std::map<Point, int> found = points(level, finest);
        for (const auto& [point, times] : found)
            ASSERT_EQ(times, 1) << point.first << " " << point.second << " at level " << level;
        // Nothing is missing.
        const std::set<Point> due = wanted(finest, 0.01);
        EXPECT_GT(due.size(), 800u);
        std::size_t missing = 0;
        for (const Point& point : due)
            missing += found.count(point) ? 0 : 1;
        EXPECT_EQ(missing, 0u) << "of " << due.size() << " at level " << level;
        EXPECT_LT(found.size(), due.size() + 40);
        // What the coarser level had, this one has.
        for (const Point& point : former)
            ASSERT_TRUE(found.count(point)) << point.first << " " << point.second << " at level " << level;
        former.clear();
        for (const Point& point : due)
            former.insert(point);
    }
}

TEST_P(StrokeScanOver, CoarserTilesHaveCoarserLevels)
{
    int former = 0;
    for (int level = 3; level >= 0; --level)
    {
        int finest = 0;
        const std::size_t count = points(level, finest).size() >> (2 * level);
        EXPECT_LE(static_cast<double>(count), 1.1 * 61.0 * 61.0);
        EXPECT_GE(static_cast<double>(count),
                  0.3 * 60.0 * 60.0 * std::min(1.0, std::exp2(0.5 * finest) - 0.2));
        EXPECT_GE(finest, former);
        former = finest;
    }
    EXPECT_GE(former, 4);
}

TEST_P(StrokeScanOver, SkirtsHaveNoStrokes)
{
    const Area& area = GetParam();
    const StrokeLattice ours = lattice();
    const auto scan = [&](double skirt)
    {
        _tiles.skirt = skirt;
        const osg::ref_ptr<osg::MatrixTransform> tile =
            _tiles.tile(_unit * area.west, _unit * area.south, _unit * area.east, _unit * area.north);
        std::vector<Point> found;
        const StrokeScan made(ours, StrokeTiles::geometryOf(*tile), tile->getMatrix(),
                              _parameters.strokesAlongTile);
        for (const StrokeSpot& spot : made.spots())
            found.push_back(canonical(ours, spot));
        return found;
    };
    EXPECT_EQ(scan(0.0), scan(3000.0));
}

INSTANTIATE_TEST_SUITE_P(Areas, StrokeScanOver,
                         ::testing::Values(Area{"projected", false, -4000.0, 2000.0, 4000.0, 10000.0},
                                           Area{"offLattice", false, 600013.7, 2350011.3, 608011.1,
                                                2358017.9},
                                           Area{"globe", true, -158.0, 21.3, -157.92, 21.38},
                                           Area{"dateLine", true, 179.96, -17.0, 180.04, -16.92},
                                           Area{"south", true, 20.0, -60.0, 20.16, -59.92}),
                         ::testing::PrintToStringParamName());

TEST(StrokeScan, SpotsLieOnTheMesh)
{
    StrokeTiles tiles;
    tiles.height = [](double x, double y)
    {
        return 0.2 * x - 0.1 * y;
    };
    const osg::ref_ptr<osg::MatrixTransform> tile = tiles.tile(0.0, 0.0, 1000.0, 1000.0);
    const osg::Geometry& mesh = StrokeTiles::geometryOf(*tile);
    const StrokeLattice lattice({}, nullptr);
    const StrokeScan scan(lattice, mesh, tile->getMatrix(), 128.0);
    ASSERT_GT(scan.spots().size(), 1000u);
    const auto& vertices = static_cast<const osg::Vec3Array&>(*mesh.getVertexArray());
    for (const StrokeSpot& spot : scan.spots())
    {
        osg::Vec3d at;
        double height = 0.0;
        for (std::size_t i = 0; i < 3; ++i)
        {
            at += osg::Vec3d(vertices[spot.corners[i]]) * spot.weights[i];
            height += scan.height(spot.corners[i]) * spot.weights[i];
        }
        at = at * tile->getMatrix();
        const osg::Vec2d place = lattice.place(spot.column, spot.row) * 25.0;
        ASSERT_NEAR(at.x(), place.x(), 0.1);
        ASSERT_NEAR(at.y(), place.y(), 0.1);
        ASSERT_NEAR(at.z(), 0.2 * at.x() - 0.1 * at.y(), 1e-3);
        ASSERT_NEAR(height, at.z(), 1e-3);
    }
}

TEST(StrokeScan, HolesAndHeightsThatAreNoNumbersHaveNone)
{
    StrokeTiles tiles;
    tiles.skirt = 0.0;
    const StrokeLattice lattice({}, nullptr);
    const auto inHole = [&](const osg::MatrixTransform& tile, const osg::Geometry& mesh)
    {
        std::pair<int, int> counts;
        const StrokeScan scan(lattice, mesh, tile.getMatrix(), 128.0);
        for (const StrokeSpot& spot : scan.spots())
        {
            const osg::Vec2d place = lattice.place(spot.column, spot.row) * 25.0;
            const bool inside =
                place.x() > 440.0 && place.x() < 560.0 && place.y() > 440.0 && place.y() < 560.0;
            ++(inside ? counts.first : counts.second);
        }
        return counts;
    };
    const osg::ref_ptr<osg::MatrixTransform> whole = tiles.tile(0.0, 0.0, 1000.0, 1000.0);
    const auto [there, around] = inHole(*whole, StrokeTiles::geometryOf(*whole));
    EXPECT_GT(there, 10);

    const osg::ref_ptr<osg::MatrixTransform> holed = tiles.tile(0.0, 0.0, 1000.0, 1000.0);
    osg::Geometry& mesh = StrokeTiles::geometryOf(*holed);
    auto& vertices = static_cast<osg::Vec3Array&>(*mesh.getVertexArray());
    for (osg::Vec3& vertex : vertices)
        if (std::abs(vertex.x()) < 70.0f && std::abs(vertex.y()) < 70.0f) // around the middle
            vertex.z() = std::numeric_limits<float>::quiet_NaN();
    const auto [missing, rest] = inHole(*holed, mesh);
    EXPECT_EQ(missing, 0);
    EXPECT_GT(rest, around / 2);

    const osg::ref_ptr<osg::MatrixTransform> cut = tiles.tile(0.0, 0.0, 1000.0, 1000.0);
    osg::Geometry& cutMesh = StrokeTiles::geometryOf(*cut);
    auto& triangles = static_cast<osg::DrawElementsUInt&>(*cutMesh.getPrimitiveSet(0));
    triangles.resize(triangles.size() / 2);
    const StrokeScan half(lattice, cutMesh, cut->getMatrix(), 128.0);
    for (const StrokeSpot& spot : half.spots())
        ASSERT_LT(lattice.place(spot.column, spot.row).y() * 25.0, 500.1);
    EXPECT_NEAR(static_cast<double>(half.spots().size()), 0.5 * (there + around), 0.06 * (there + around));
}

TEST(StrokeScan, StrangeMeshesDoNoHarm)
{
    const StrokeLattice plane({}, nullptr);
    osg::ref_ptr<osg::Geometry> mesh = new osg::Geometry;
    EXPECT_TRUE(StrokeScan(plane, *mesh, {}, 128.0).spots().empty());
    osg::ref_ptr<osg::Vec3Array> vertices = new osg::Vec3Array;
    for (const auto& each :
         {osg::Vec3(0, 0, 0), osg::Vec3(500, 0, 0), osg::Vec3(500, 500, 0), osg::Vec3(0, 500, 0)})
        vertices->push_back(each);
    mesh->setVertexArray(vertices);
    EXPECT_TRUE(StrokeScan(plane, *mesh, {}, 128.0).spots().empty());
    osg::ref_ptr<osg::DrawElementsUShort> triangles = new osg::DrawElementsUShort(GL_TRIANGLES);
    for (const int index : {0, 1, 99, 0, 0, 0, 0, 2, 1}) // beyond the array, without area, from below
        triangles->push_back(static_cast<GLushort>(index));
    mesh->addPrimitiveSet(triangles);
    EXPECT_TRUE(StrokeScan(plane, *mesh, {}, 128.0).spots().empty());
    mesh->setPrimitiveSet(0, new osg::DrawArrays(GL_TRIANGLE_FAN, 0, 4));
    EXPECT_NEAR(static_cast<double>(StrokeScan(plane, *mesh, {}, 128.0).spots().size()), 400.0, 60.0);
    // As large as a planet, in metres and in steps of a millimetre.
    EXPECT_LT(StrokeScan(plane, *mesh, osg::Matrixd::scale(1e5, 1e5, 1.0), 128.0).spots().size(), 20000u);
    StrokeParameters fine;
    fine.spacing = 0.001;
    EXPECT_LT(StrokeScan(StrokeLattice(fine, nullptr), *mesh, osg::Matrixd::scale(1e5, 1e5, 1.0), 128.0)
                  .spots()
                  .size(),
              20000u);
    for (osg::Vec3& vertex : *vertices)
        vertex.y() = std::numeric_limits<float>::infinity();
    EXPECT_TRUE(StrokeScan(plane, *mesh, {}, 128.0).spots().empty());
}

TEST(StrokeScan, PolesAndWholeGlobes)
{
    StrokeTiles tiles;
    tiles.ellipsoid = new osg::EllipsoidModel;
    const StrokeLattice lattice({}, tiles.ellipsoid);
    const double degree = osg::PI / 180.0;
    const auto scan = [&](double west, double south, double east, double north)
    {
        const osg::ref_ptr<osg::MatrixTransform> tile =
            tiles.tile(west * degree, south * degree, east * degree, north * degree);
        const StrokeScan made(lattice, StrokeTiles::geometryOf(*tile), tile->getMatrix(), 128.0);
        std::map<Point, int> found;
        for (const StrokeSpot& spot : made.spots())
            ++found[canonical(lattice, spot)];
        for (const auto& [point, times] : found)
            EXPECT_EQ(times, 1) << point.first << " " << point.second;
        EXPECT_LT(found.size(), 20000u);
        return found.size();
    };
    EXPECT_GT(scan(10.0, 88.0, 12.0, 90.0), 1000u);
    EXPECT_GT(scan(-180.0, -90.0, 180.0, -80.0), 100u);
    tiles.cells = 64;
    EXPECT_GT(scan(-180.0, -90.0, 180.0, 90.0), 4000u);
}

TEST(StrokeScan, PointsOnEdgesBelongToOneTriangle)
{
    // Rows without jitter, on the borders of tiles and on the diagonals of their cells.
    StrokeParameters parameters;
    parameters.jitter = 0.0;
    const StrokeLattice lattice(parameters, nullptr);
    StrokeTiles tiles;
    std::set<Point> found;
    for (const double west : {-1600.0, 0.0, 1600.0})
    {
        const osg::ref_ptr<osg::MatrixTransform> tile = tiles.tile(west, 0.0, west + 1600.0, 1600.0);
        const StrokeScan scan(lattice, StrokeTiles::geometryOf(*tile), tile->getMatrix(), 128.0);
        EXPECT_EQ(scan.spots().size(), 64u * 64u);
        for (const StrokeSpot& spot : scan.spots())
            EXPECT_TRUE(found.insert({spot.column, spot.row}).second);
    }
}

TEST(StrokeScan, TrianglesAroundAPoleHaveNone)
{
    const osg::ref_ptr<osg::EllipsoidModel> ellipsoid = new osg::EllipsoidModel;
    const StrokeLattice lattice({}, ellipsoid);
    osg::ref_ptr<osg::Geometry> mesh = new osg::Geometry;
    osg::ref_ptr<osg::Vec3Array> vertices = new osg::Vec3Array;
    const double pole = ellipsoid->getRadiusPolar();
    for (const auto& [angle, away] : {std::pair(0.5, 1e6), std::pair(2.6, 3e5), std::pair(4.7, 5e4)})
        vertices->push_back(osg::Vec3d(away * std::cos(angle), away * std::sin(angle), pole));
    mesh->setVertexArray(vertices);
    mesh->addPrimitiveSet(new osg::DrawArrays(GL_TRIANGLES, 0, 3));
    EXPECT_TRUE(StrokeScan(lattice, *mesh, {}, 128.0).spots().empty());
}

} // namespace
