// SPDX-License-Identifier: MIT
// SPDX-FileCopyrightText: 2026 the osgGeoFX authors
#include <osgGeoFX/closeup/detail/RegionMask.h>

#include <osg/Math>

#include <algorithm>
#include <array>
#include <cmath>
#include <map>

namespace osgGeoFX::region
{

namespace
{

/// A part of a border.
class Segment
{
public:
    Segment(const osg::Vec2d& from, const osg::Vec2d& to) : _from(from), _along(to - from)
    {
        const double length2 = _along.length2();
        if (length2 > 0.0) _perLength2 = 1.0 / length2;
    }

    double squaredDistance(const osg::Vec2d& place) const
    {
        const osg::Vec2d way = place - _from;
        const double share = std::clamp(way * _along * _perLength2, 0.0, 1.0);
        return (way - _along * share).length2();
    }

private:
    osg::Vec2d _from, _along;
    double _perLength2 = 0.0;
};
using Segments = std::vector<Segment>;

/// The distance to an ellipse about the origin.
double toEllipse(osg::Vec2d place, osg::Vec2d radii)
{
    place.set(std::abs(place.x()), std::abs(place.y()));
    if (radii.x() < radii.y())
    {
        std::swap(place.x(), place.y());
        std::swap(radii.x(), radii.y());
    }
    const double a = radii.x(), b = radii.y();
    if (a == b) return std::abs(place.length() - a);
    const double focal2 = (a - b) * (a + b);
    // The foot of the perpendicular is (a² x / (u + a² − b²), b² y / u). For u > 0 the rest of the ellipse's equation
    // is falling and convex in u. So Newton's method from the left never passes the root.
    double u = std::max(b * place.y(), a * place.x() - focal2);
    if (!(u > 0.0))
    {
        const double x = a * a * place.x() / focal2;
        const double y = b * std::sqrt(std::max(0.0, 1.0 - x * x / (a * a)));
        return std::hypot(place.x() - x, place.y() - y);
    }
    for (int turn = 0; turn < 100; ++turn)
    {
        const double p = a * place.x() / (u + focal2);
        const double q = b * place.y() / u;
        const double left = p * p + q * q - 1.0;
        const double gain = left / (2.0 * (p * p / (u + focal2) + q * q / u));
        if (!(gain > 1e-15 * u)) break;
        u += gain;
    }
    const osg::Vec2d foot(a * a * place.x() / (u + focal2), b * b * place.y() / u);
    return (place - foot).length();
}

/** Fills a picture with the distances to the nearest of some segments. It halves the picture again and again. Each
    half keeps only the segments that can be nearest somewhere in it. */
class NearestSegments
{
public:
    explicit NearestSegments(Picture& picture) : _picture(picture) {}

    void fill(const Segments& segments)
    {
        _kept = segments;
        fill({0, 0, _picture.side, _picture.side}, 0);
    }

private:
    /// A part of the picture, without its right and top ends.
    struct Block
    {
        int left, bottom, right, top;
    };

    /// Fills a block. Its segments are those from `first` to the end of the kept ones.
    void fill(const Block& block, std::size_t first)
    {
        const int columns = block.right - block.left;
        const int rows = block.top - block.bottom;
        const std::size_t count = _kept.size();
        if (columns * rows <= 8 || count - first <= 2)
        {
            for (int row = block.bottom; row < block.top; ++row)
                for (int column = block.left; column < block.right; ++column)
                    _picture.at(column, row) =
                        static_cast<float>(std::sqrt(least(_picture.place(column, row), first)));
            return;
        }
        const osg::Vec2d low = _picture.place(block.left, block.bottom);
        const osg::Vec2d high = _picture.place(block.right - 1, block.top - 1);
        const osg::Vec2d middle = (low + high) / 2.0;
        // A segment may be nearest somewhere in the block if it is at most twice the half diagonal farther from the
        // middle than the segment that is nearest there.
        const double most = (std::sqrt(least(middle, first)) + (high - low).length()) * (1.0 + 1e-9);
        for (std::size_t i = first; i < count; ++i)
        {
            const Segment segment = _kept[i];
            if (segment.squaredDistance(middle) <= most * most) _kept.push_back(segment);
        }
        Block one = block, other = block;
        const osg::Vec2d texel = _picture.texel();
        if (rows < 2 || (columns > 1 && columns * texel.x() > rows * texel.y()))
            one.right = other.left = block.left + columns / 2;
        else
            one.top = other.bottom = block.bottom + rows / 2;
        fill(one, count);
        fill(other, count);
        _kept.erase(_kept.begin() + static_cast<std::ptrdiff_t>(count), _kept.end());
    }

    /// The smallest squared distance.
    double least(const osg::Vec2d& place, std::size_t first) const
    {
        double found = 1e60;
        for (std::size_t i = first; i < _kept.size(); ++i)
            found = std::min(found, _kept[i].squaredDistance(place));
        return found;
    }

    Picture& _picture;
    Segments _kept; ///< the segments of a block come after those of the block that it is a half of
};

/// Where a horizontal line meets an outline, in order.
std::vector<double> crossings(const Line& corners, double y)
{
    std::vector<double> found;
    for (std::size_t i = 0; i < corners.size(); ++i)
    {
        const osg::Vec2d& from = corners[i];
        const osg::Vec2d& to = corners[(i + 1) % corners.size()];
        if ((from.y() <= y) == (to.y() <= y)) continue;
        found.push_back(from.x() + (to.x() - from.x()) * ((y - from.y()) / (to.y() - from.y())));
    }
    std::sort(found.begin(), found.end());
    return found;
}

/** The lines where a field changes its sign, by marching squares over a picture and one ring of texels around it.

    The field is known at the centers of texels. A point of the line lies on an edge between two neighbours, and the
    number of this edge is its name. */
class Marching
{
public:
    /// Calls `field(column, row)` for −1…side.
    template<typename Field>
    Marching(const Picture& picture, const Field& field) : _picture(picture), _width(picture.side + 2)
    {
        _field.reserve(static_cast<std::size_t>(_width) * _width);
        for (int row = -1; row <= picture.side; ++row)
            for (int column = -1; column <= picture.side; ++column)
                _field.push_back(field(column, row));
    }

    /// Calls `take(from, to)` for each part, with the names of its ends. The inside is on the left.
    template<typename Take>
    void parts(const Take& take) const
    {
        for (int y = 0; y + 1 < _width; ++y)
            for (int x = 0; x + 1 < _width; ++x)
                cell(y * _width + x, take);
    }

    osg::Vec2d place(int edge) const
    {
        const int node = edge / 2;
        const int other = edge % 2 ? node + _width : node + 1;
        const osg::Vec2d from = nodePlace(node);
        const double a = _field[node], b = _field[other];
        return from + (nodePlace(other) - from) * (a / (a - b));
    }

private:
    osg::Vec2d nodePlace(int node) const { return _picture.place(node % _width - 1, node / _width - 1); }

    template<typename Take>
    void cell(int node, const Take& take) const
    {
        // Corners run counter-clockwise from the lower left. Edge i leads from corner i to the next.
        const std::array<double, 4> value = {_field[node], _field[node + 1], _field[node + _width + 1],
                                             _field[node + _width]};
        const std::array<int, 4> edge = {2 * node, 2 * (node + 1) + 1, 2 * (node + _width), 2 * node + 1};
        // If two opposite corners are inside, the bilinear surface decides whether they are joined.
        const double across = value[0] * value[2], other = value[1] * value[3];
        const bool joined = value[0] > 0.0 ? across > other : other > across;
        for (std::size_t i = 0; i < 4; ++i)
        {
            if (!(value[i] > 0.0) || value[(i + 1) % 4] > 0.0) continue;
            std::size_t end = i;
            do
                end = (end + (joined ? 1 : 3)) % 4;
            while (value[end] > 0.0 || !(value[(end + 1) % 4] > 0.0));
            take(edge[i], edge[end]);
        }
    }

    const Picture& _picture;
    int _width;
    std::vector<double> _field;
};

double toRectangle(const osg::Vec2d& place, const osg::Vec2d& half, double radius)
{
    const double x = std::abs(place.x()) - half.x() + radius;
    const double y = std::abs(place.y()) - half.y() + radius;
    return radius - std::hypot(std::max(x, 0.0), std::max(y, 0.0)) - std::min(std::max(x, y), 0.0);
}

/// A picture of a function of its places.
template<typename Function>
Picture drawn(int side, const osg::Vec2d& half, const Function& function)
{
    Picture picture(side, half);
    for (int row = 0; row < side; ++row)
        for (int column = 0; column < side; ++column)
            picture.at(column, row) = static_cast<float>(function(picture.place(column, row)));
    return picture;
}

} // namespace

double Picture::toBorder(int column, int row) const
{
    return toRectangle(place(column, row), half, 0.0);
}

Picture ellipseDistances(int side, const osg::Vec2d& half)
{
    return drawn(side, half,
                 [&](const osg::Vec2d& place)
                 {
                     const bool inside = std::hypot(place.x() / half.x(), place.y() / half.y()) < 1.0;
                     return (inside ? 1.0 : -1.0) * toEllipse(place, half);
                 });
}

Picture rectangleDistances(int side, const osg::Vec2d& half, double radius)
{
    return drawn(side, half, [&](const osg::Vec2d& place) { return toRectangle(place, half, radius); });
}

Picture outlineDistances(int side, const osg::Vec2d& half, const Line& corners)
{
    // An edge that comes twice has the same on both sides and is no border.
    std::map<std::pair<osg::Vec2d, osg::Vec2d>, bool> odd;
    for (std::size_t i = 0; i < corners.size(); ++i)
    {
        const auto ends = std::minmax(corners[i], corners[(i + 1) % corners.size()]);
        bool& isOdd = odd[{ends.first, ends.second}];
        isOdd = !isOdd;
    }
    Segments edges;
    for (const auto& [ends, isOdd] : odd)
        if (isOdd)
            edges.emplace_back(osg::componentMultiply(ends.first, half),
                               osg::componentMultiply(ends.second, half));
    Picture picture(side, half);
    NearestSegments(picture).fill(edges);
    for (int row = 0; row < side; ++row)
    {
        const std::vector<double> found = crossings(corners, picture.place(0, row).y() / half.y());
        std::size_t passed = 0;
        for (int column = 0; column < side; ++column)
        {
            const double x = picture.place(column, row).x() / half.x();
            while (passed < found.size() && found[passed] <= x)
                ++passed;
            if (passed % 2 == 0) picture.at(column, row) *= -1.0f;
        }
    }
    return picture;
}

Picture greyDistances(const Picture& grey)
{
    const int last = grey.side - 1;
    const Marching marching(
        grey,
        [&](int column, int row) {
            return static_cast<double>(grey.at(std::clamp(column, 0, last), std::clamp(row, 0, last))) - 0.5;
        });
    Segments lines;
    marching.parts([&](int from, int to) { lines.emplace_back(marching.place(from), marching.place(to)); });
    Picture picture(grey.side, grey.half);
    NearestSegments(picture).fill(lines);
    for (int row = 0; row <= last; ++row)
    {
        for (int column = 0; column <= last; ++column)
        {
            float& distance = picture.at(column, row);
            if (grey.at(column, row) > 0.5f)
                distance = std::min(distance, static_cast<float>(grey.toBorder(column, row)));
            else
                distance = -std::min(distance, 2.0f);
        }
    }
    return picture;
}

Line starCorners(int points, double innerRadius)
{
    Line corners;
    for (int i = 0; i < 2 * points; ++i)
    {
        const double angle = osg::PI_2 + osg::PI * i / points;
        corners.push_back(osg::Vec2d(std::cos(angle), std::sin(angle)) * (i % 2 ? innerRadius : 1.0));
    }
    return corners;
}

bool hasArea(const Line& corners)
{
    std::vector<double> heights;
    for (const osg::Vec2d& corner : corners)
        heights.push_back(corner.y());
    std::sort(heights.begin(), heights.end());
    double area = 0.0;
    for (std::size_t i = 0; i + 1 < heights.size(); ++i)
    {
        const double height = heights[i + 1] - heights[i];
        // Edges are straight between two heights. Even if some cross, one of the two rows shows that there is an
        // area.
        for (const double share : {0.3, 0.8})
        {
            const std::vector<double> found =
                height > 0.0 ? crossings(corners, heights[i] + share * height) : std::vector<double>();
            for (std::size_t k = 0; k + 1 < found.size(); k += 2)
                area += (found[k + 1] - found[k]) * height;
        }
        if (area > 1e-9) return true;
    }
    return false;
}

Picture sharpMask(const Picture& distances)
{
    Picture mask(distances.side, distances.half);
    const int last = distances.side - 1;
    const osg::Vec2d texel = distances.texel();
    const auto slope = [](float low, float high, int steps)
    {
        return static_cast<double>(high - low) / std::max(steps, 1);
    };
    for (int y = 0; y <= last; ++y)
    {
        for (int x = 0; x <= last; ++x)
        {
            const int left = std::max(x - 1, 0), right = std::min(x + 1, last);
            const int below = std::max(y - 1, 0), above = std::min(y + 1, last);
            // The change of the distance from texel to texel. It vanishes along ridges, where the size of a texel
            // takes its place.
            const double size =
                std::max(std::hypot(slope(distances.at(left, y), distances.at(right, y), right - left),
                                    slope(distances.at(x, below), distances.at(x, above), above - below)),
                         std::min(texel.x(), texel.y()));
            const double share = 0.5 + 0.5 * static_cast<double>(distances.at(x, y)) / size;
            mask.at(x, y) = static_cast<float>(std::clamp(share, 0.0, 1.0));
        }
    }
    return mask;
}

Picture softMask(const Picture& distances, double softness)
{
    Picture mask = distances;
    for (float& value : mask.values)
        value = static_cast<float>(std::clamp(static_cast<double>(value) / softness, 0.0, 1.0));
    return mask;
}

std::vector<Line> borders(const Picture& distances)
{
    const osg::Vec2d texel = distances.texel();
    const int side = distances.side;
    const Marching marching(distances,
                            [&](int column, int row)
                            {
                                const bool beside = column < 0 || column == side;
                                // The region's border lies half a texel inside of the ring.
                                if (row < 0 || row == side) return -texel.y() / 2.0;
                                return beside ? -texel.x() / 2.0
                                              : static_cast<double>(distances.at(column, row));
                            });
    std::map<int, int> next;
    marching.parts([&](int from, int to) { next[from] = to; });
    std::vector<Line> lines;
    while (!next.empty())
    {
        Line line;
        for (auto part = next.begin(); part != next.end();)
        {
            const osg::Vec2d place = marching.place(part->first);
            const osg::Vec2d shared(std::clamp(place.x() / distances.half.x(), -1.0, 1.0),
                                    std::clamp(place.y() / distances.half.y(), -1.0, 1.0));
            // A line through the very center of a texel meets several edges there.
            constexpr double same = 1e-6;
            if (line.empty() || (shared - line.back()).length() * side > same) line.push_back(shared);
            const int end = part->second;
            next.erase(part);
            part = next.find(end);
        }
        while (line.size() > 1 && (line.back() - line.front()).length() * side <= 1e-6)
            line.pop_back();
        if (line.size() > 2) lines.push_back(std::move(line));
    }
    return lines;
}

} // namespace osgGeoFX::region
