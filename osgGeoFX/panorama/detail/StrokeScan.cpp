// SPDX-License-Identifier: MIT
// SPDX-FileCopyrightText: 2026 the osgGeoFX authors
#include <osgGeoFX/panorama/detail/StrokeScan.h>

#include <osgGeoFX/effect/detail/DrawableTriangles.h>

#include <algorithm>
#include <cfloat>
#include <cmath>
#include <numeric>

namespace osgGeoFX
{

namespace
{

/// Skirts of the kit's tiles lean by 1 in 10.
constexpr double steepest = 0.15; ///< cosine of the steepest slope that is ground
/// A step of the lattice is divided into so many parts for the test of points in triangles. Points lie in the middle
/// of a part.
constexpr double cuts = 256.0;
/// Larger tiles, in steps, have no strokes: their integers would overflow.
constexpr double mostSteps = 2097152.0;

std::int64_t crossed(const std::array<std::int64_t, 2>& a, const std::array<std::int64_t, 2>& b,
                     const std::array<std::int64_t, 2>& p)
{
    return (b[0] - a[0]) * (p[1] - a[1]) - (b[1] - a[1]) * (p[0] - a[0]);
}

/// Whether a triangle owns an edge. Two triangles that share an edge run along it in opposite directions, and exactly
/// one owns it.
bool owns(const std::array<std::int64_t, 2>& a, const std::array<std::int64_t, 2>& b)
{
    return b[1] > a[1] || (b[1] == a[1] && b[0] < a[0]);
}

} // namespace

/// Counter-clockwise, with columns on one turn of the globe.
struct StrokeScan::Triangle
{
    std::array<unsigned int, 3> corners;
    std::array<osg::Vec2d, 3> at;

    /// A vector of the lattice as one in the mesh's frame.
    osg::Vec3d onGround(const osg::Vec3Array& vertices, const osg::Vec2d& way) const
    {
        const osg::Vec2d ab = at[1] - at[0], ac = at[2] - at[0];
        const double area = ab.x() * ac.y() - ab.y() * ac.x();
        const double s = (way.x() * ac.y() - way.y() * ac.x()) / area;
        const double t = (ab.x() * way.y() - ab.y() * way.x()) / area;
        const osg::Vec3d a(vertices[corners[0]]);
        return (osg::Vec3d(vertices[corners[1]]) - a) * s + (osg::Vec3d(vertices[corners[2]]) - a) * t;
    }
};

/// The triangle at a place; none for a place beside the mesh.
struct StrokeScan::Footing
{
    const Triangle* triangle = nullptr;
    std::array<double, 3> weights{};
};

StrokeScan::StrokeScan(const StrokeLattice& lattice, const osg::Geometry& mesh, const osg::Matrixd& toWorld,
                       double strokesAlongTile, const StrokeLines* lines, double spacing)
    : _lattice(lattice), _vertices(dynamic_cast<const osg::Vec3Array*>(mesh.getVertexArray())),
      _toWorld(toWorld)
{
    const DrawableTriangles read(mesh);
    if (read.positions().empty()) return;
    if (!_vertices) _vertices = new osg::Vec3Array(read.positions().begin(), read.positions().end());
    _corners = read.corners();
    _coordinates.reserve(_vertices->size());
    for (const osg::Vec3& vertex : *_vertices)
        _coordinates.push_back(_lattice.coordinates(osg::Vec3d(vertex) * _toWorld));
    const std::vector<Triangle> triangles = usable();
    if (triangles.empty()) return;
    chooseLevel(triangles, std::clamp(strokesAlongTile, 1.0, 1024.0));
    const osg::Vec2d size = _high - _low;
    if (std::max(size.x(), size.y()) >= mostSteps) return;
    settle(triangles);
    if (lines && (lines->getUnits() == StrokeLines::DEGREES) == _lattice.onGlobe())
        settleLines(triangles, *lines, std::max(spacing, 1e-3));
}

osg::Vec3d StrokeScan::up(unsigned int vertex) const
{
    osg::Vec3d up =
        osg::Matrixd::transform3x3(_toWorld, _lattice.up(osg::Vec3d((*_vertices)[vertex]) * _toWorld));
    up.normalize();
    return up;
}

std::vector<StrokeScan::Triangle> StrokeScan::usable() const
{
    std::vector<Triangle> triangles;
    for (std::size_t i = 0; i < _corners.size(); i += 3)
        addIfUsable(&_corners[i], triangles);
    return triangles;
}

void StrokeScan::addIfUsable(const unsigned int* corners, std::vector<Triangle>& triangles) const
{
    const unsigned int a = corners[0], b = corners[1], c = corners[2];
    Triangle triangle{{a, b, c}, {}};
    double reference = triangles.empty() ? _coordinates[a].x() : triangles.front().at[0].x();
    for (std::size_t i = 0; i < 3; ++i)
    {
        const osg::Vec3d& each = _coordinates[triangle.corners[i]];
        if (!std::isfinite(each.x() + each.y() + each.z())) return;
        triangle.at[i].set(_lattice.columnNear(each.x(), reference), each.y());
        reference = triangle.at[0].x();
    }
    const osg::Vec2d ab = triangle.at[1] - triangle.at[0], ac = triangle.at[2] - triangle.at[0];
    // Around a pole columns run together.
    const auto around = static_cast<double>(_lattice.columns());
    if (around > 0.0 &&
        std::max({std::abs(ab.x()), std::abs(ac.x()), std::abs(ac.x() - ab.x())}) > around / 8.0)
        return;
    if (!(ab.x() * ac.y() - ab.y() * ac.x() > 0.0)) return;
    const osg::Vec3Array& vertices = *_vertices;
    const osg::Vec3d normal = osg::Vec3d(vertices[b] - vertices[a]) ^ osg::Vec3d(vertices[c] - vertices[a]);
    if (!(normal * up(a) > steepest * normal.length())) return;
    triangles.push_back(triangle);
}

void StrokeScan::chooseLevel(const std::vector<Triangle>& triangles, double strokesAlongTile)
{
    _low.set(DBL_MAX, DBL_MAX);
    _high.set(-DBL_MAX, -DBL_MAX);
    for (const Triangle& triangle : triangles)
    {
        for (const osg::Vec2d& at : triangle.at)
        {
            _low.set(std::min(_low.x(), at.x()), std::min(_low.y(), at.y()));
            _high.set(std::max(_high.x(), at.x()), std::max(_high.y(), at.y()));
        }
    }
    // A little slack keeps tiles of one size on one level in spite of rounding.
    const double size = std::max(_high.x() - _low.x(), _high.y() - _low.y());
    const auto fits = [&]
    {
        return size <= 1.01 * strokesAlongTile * StrokeLattice::spacingOf(_finest);
    };
    while (_finest < StrokeLattice::highest && !fits())
        ++_finest;
}

/// Lists all points whose strokes may stand within the triangles' box.
void StrokeScan::sow(std::vector<StrokeSpot>& spots) const
{
    for (int level = _finest; level <= StrokeLattice::highest; ++level)
    {
        const std::int64_t step = std::int64_t{1} << (level / 2);
        const double reach = _lattice.reach(level);
        const auto first = [&](double low)
        {
            return static_cast<std::int64_t>(std::floor((low - reach) / static_cast<double>(step))) * step;
        };
        for (std::int64_t row = first(_low.y()); static_cast<double>(row) <= _high.y() + reach; row += step)
        {
            for (std::int64_t column = first(_low.x()); static_cast<double>(column) <= _high.x() + reach;
                 column += step)
            {
                if (StrokeLattice::halfLevel(column, row) == level)
                    spots.push_back({column, row, level, {}, {}});
            }
        }
    }
}

std::vector<StrokeScan::Footing> StrokeScan::footings(const std::vector<Triangle>& triangles,
                                                      const std::vector<osg::Vec2d>& places) const
{
    // The points, sorted into the cells of a grid over the box.
    const double cell = StrokeLattice::spacingOf(_finest);
    const auto cellOf = [&](double at, double low)
    {
        return static_cast<int>(std::floor((at - low) / cell));
    };
    const int across = cellOf(_high.x(), _low.x()) + 1, along = cellOf(_high.y(), _low.y()) + 1;
    const auto cells = static_cast<std::size_t>(across) * static_cast<std::size_t>(along);
    std::vector<std::size_t> cellOfPoint(places.size(), cells); // those outside come last
    std::vector<std::uint32_t> firsts(cells + 2, 0);
    for (std::size_t i = 0; i < places.size(); ++i)
    {
        const int x = cellOf(places[i].x(), _low.x()), y = cellOf(places[i].y(), _low.y());
        if (x >= -1 && y >= -1 && x <= across && y <= along)
        {
            // Rounding may move a place on the border into the box.
            const int column = std::clamp(x, 0, across - 1), row = std::clamp(y, 0, along - 1);
            cellOfPoint[i] = static_cast<std::size_t>(row * across + column);
        }
        ++firsts[cellOfPoint[i] + 1];
    }
    std::partial_sum(firsts.begin(), firsts.end(), firsts.begin());
    std::vector<std::uint32_t> sorted(places.size()), next = firsts;
    for (std::size_t i = 0; i < places.size(); ++i)
        sorted[next[cellOfPoint[i]]++] = static_cast<std::uint32_t>(i);

    const osg::Vec2d origin(std::floor(_low.x()), std::floor(_low.y()));
    using Point = std::array<std::int64_t, 2>;
    // Vertices have even numbers and points odd ones, so no point lies on an edge that runs straight along the
    // lattice.
    const auto rounded = [&](const osg::Vec2d& at)
    {
        return Point{2 * std::llround((at.x() - origin.x()) * cuts),
                     2 * std::llround((at.y() - origin.y()) * cuts)};
    };
    const auto middle = [&](const osg::Vec2d& at)
    {
        return Point{2 * static_cast<std::int64_t>(std::floor((at.x() - origin.x()) * cuts)) + 1,
                     2 * static_cast<std::int64_t>(std::floor((at.y() - origin.y()) * cuts)) + 1};
    };
    std::vector<Footing> footings(places.size());
    for (const Triangle& triangle : triangles)
    {
        const Point a = rounded(triangle.at[0]), b = rounded(triangle.at[1]), c = rounded(triangle.at[2]);
        const std::int64_t area = crossed(a, b, c);
        if (area <= 0) continue;
        const auto range = [&](unsigned int axis, double low, int count)
        {
            const auto [least, most] =
                std::minmax({triangle.at[0][axis], triangle.at[1][axis], triangle.at[2][axis]});
            return std::make_pair(std::clamp(cellOf(least - 1.0 / cuts, low), 0, count - 1),
                                  std::clamp(cellOf(most + 1.0 / cuts, low), 0, count - 1));
        };
        const auto [left, right] = range(0, _low.x(), across);
        const auto [bottom, top] = range(1, _low.y(), along);
        for (int row = bottom; row <= top; ++row)
        {
            for (int column = left; column <= right; ++column)
            {
                const auto here = static_cast<std::size_t>(row * across + column);
                for (std::uint32_t k = firsts[here]; k < firsts[here + 1]; ++k)
                {
                    const std::uint32_t i = sorted[k];
                    if (footings[i].triangle) continue;
                    const Point p = middle(places[i]);
                    const std::int64_t u = crossed(b, c, p), v = crossed(c, a, p), w = crossed(a, b, p);
                    if (u < 0 || v < 0 || w < 0) continue;
                    if ((u == 0 && !owns(b, c)) || (v == 0 && !owns(c, a)) || (w == 0 && !owns(a, b)))
                        continue;
                    const auto whole = static_cast<double>(area);
                    footings[i] = {&triangle,
                                   {static_cast<double>(u) / whole, static_cast<double>(v) / whole,
                                    static_cast<double>(w) / whole}};
                }
            }
        }
    }
    return footings;
}

void StrokeScan::settle(const std::vector<Triangle>& triangles)
{
    std::vector<StrokeSpot> sown;
    sow(sown);
    std::vector<osg::Vec2d> places;
    places.reserve(sown.size());
    for (const StrokeSpot& spot : sown)
        places.push_back(_lattice.place(spot.column, spot.row));
    const std::vector<Footing> found = footings(triangles, places);
    for (std::size_t i = 0; i < sown.size(); ++i)
    {
        if (!found[i].triangle) continue;
        sown[i].corners = found[i].triangle->corners;
        sown[i].weights = found[i].weights;
        _spots.push_back(sown[i]);
    }
}

void StrokeScan::settleLines(const std::vector<Triangle>& triangles, const StrokeLines& lines, double spacing)
{
    // The lines of a globe may be a turn away from the tile.
    const auto around = static_cast<double>(_lattice.columns());
    for (const double turn :
         around > 0.0 ? std::vector<double>{-around, 0.0, around} : std::vector<double>{0.0})
    {
        const osg::Vec2d shift(turn, 0.0), room(1.0, 1.0);
        const std::vector<StrokeLines::Mark> marks =
            lines.marks(_lattice.toMap(_low + shift - room), _lattice.toMap(_high + shift + room),
                        0.5 * spacing, _finest / 2);
        std::vector<osg::Vec2d> places;
        places.reserve(marks.size());
        for (const StrokeLines::Mark& mark : marks)
            places.push_back(_lattice.fromMap(mark.place) - shift);
        const std::vector<Footing> found = footings(triangles, places);
        for (std::size_t i = 0; i < marks.size(); ++i)
        {
            const Triangle* triangle = found[i].triangle;
            if (!triangle) continue;
            StrokeLineSpot spot;
            spot.column = marks[i].index;
            spot.row = marks[i].line;
            spot.halfLevel = std::min(2 * marks[i].level - 2, StrokeLattice::highest);
            spot.corners = triangle->corners;
            spot.weights = found[i].weights;
            spot.kind = lines.getLines()[marks[i].line].kind;
            spot.along = triangle->onGround(*_vertices, _lattice.fromMap(marks[i].along));
            _lineSpots.push_back(spot);
        }
    }
}

} // namespace osgGeoFX
