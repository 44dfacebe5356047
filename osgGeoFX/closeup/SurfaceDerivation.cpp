// SPDX-License-Identifier: MIT
// SPDX-FileCopyrightText: 2026 the osgGeoFX authors
#include <osgGeoFX/closeup/SurfaceDerivation.h>

#include <osg/Math>

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>

namespace osgGeoFX
{

namespace
{

constexpr float hole = std::numeric_limits<float>::quiet_NaN();

/// Less than this is level: the noise of floats on a high lake.
constexpr double levelGradient = 1e-5;

/** The highest line of sight from a point of a profile to those some steps before it.

    The points before it within the radius lie in its own block, as long as the radius, and at the end of the block
    before. Each part has the upper hull of its points, on which the line of sight touches: in its own block it grows with
    the walk; of the block before it is built at once and taken back point by point, as the points fall out of
    the radius. So each point costs the same, whatever the radius. */
class Horizon
{
public:
    /// For profiles of `length` points at most, `step` metres apart, and a radius of `reach` points, 1 at least.
    Horizon(int length, double step, int reach)
        : _step(step), _reach(reach), _undo(static_cast<std::size_t>(reach))
    {
        _own.points.resize(static_cast<std::size_t>(std::min(length, reach)));
        _former.points.resize(_own.points.size());
    }

    /// Calls result(i, tangent of the horizon's angle, not below 0) for each point with a height.
    template<typename Result>
    void walk(const std::vector<float>& profile, int length, const Result& result)
    {
        _former.size = 0;
        for (int begin = 0; begin < length; begin += _reach)
        {
            if (begin > 0) buildFormer(profile, begin);
            _own.size = 0;
            for (int i = begin; i < std::min(length, begin + _reach); ++i)
            {
                if (begin > 0 && i > begin) _former.takeBack(_undo[static_cast<std::size_t>(i - begin - 1)]);
                const float height = profile[static_cast<std::size_t>(i)];
                if (std::isnan(height)) continue;
                const Point point{static_cast<double>(i), static_cast<double>(height)};
                _own.push(point);
                // Pushed, so that what it stands on now is where its line of sight touches.
                double rise = _own.size > 1 ? slope(_own.points[_own.size - 2], point) : 0.0;
                if (_former.size > 0) rise = std::max(rise, _former.steepestFrom(point));
                result(i, std::max(0.0, rise) / _step);
            }
        }
    }

private:
    struct Point
    {
        double place, height;
    };
    /// What is taken back to undo a push.
    struct Undo
    {
        std::size_t size = 0, at = 0;
        Point point{};
    };

    /// Up from b to a, for each point between them.
    static double slope(const Point& a, const Point& b)
    {
        return (a.height - b.height) / std::abs(a.place - b.place);
    }

    struct Hull
    {
        std::vector<Point> points;
        std::size_t size = 0;

        Undo push(const Point& point)
        {
            std::size_t at = size;
            while (at >= 2 && slope(points[at - 2], point) >= slope(points[at - 1], point))
                --at;
            const Undo undo{size, at, points[at]};
            points[at] = point;
            size = at + 1;
            return undo;
        }
        void takeBack(const Undo& undo)
        {
            if (undo.size == kept) return;
            points[undo.at] = undo.point;
            size = undo.size;
        }
        /// From a point beyond the hull's first one: the slopes to its points grow and then fall.
        double steepestFrom(const Point& point) const
        {
            std::size_t low = 0, high = size - 1;
            while (low < high)
            {
                const std::size_t middle = (low + high) / 2;
                if (slope(points[middle + 1], point) > slope(points[middle], point))
                    low = middle + 1;
                else
                    high = middle;
            }
            return slope(points[low], point);
        }
    };

    static constexpr std::size_t kept = std::numeric_limits<std::size_t>::max();

    /// From the block's last point to its first, so that the first is the first to be taken back.
    void buildFormer(const std::vector<float>& profile, int end)
    {
        _former.size = 0;
        for (int k = _reach - 1; k >= 0; --k)
        {
            const int i = end - _reach + k;
            const float height = profile[static_cast<std::size_t>(i)];
            Undo& undo = _undo[static_cast<std::size_t>(k)];
            undo.size = kept;
            if (!std::isnan(height))
                undo = _former.push({static_cast<double>(i), static_cast<double>(height)});
        }
    }

    double _step;
    int _reach;
    Hull _own, _former;
    std::vector<Undo> _undo;
};

/// A direction and its opposite: `minor` texels along y for each along x, −1…1.
struct Direction
{
    double minor;
    double step; ///< metres along it for each texel along x
};

/** Walks all parallel lines of a direction and its opposite through a grid, and adds up what the horizons hide.

    A line is half a texel aside of a texel's center at most. So both lines beside it are asked, from the ground on the line
    and not on the texel, and mixed: on a smooth slope that is right, where the nearest line alone makes stripes. */
class Sweep
{
public:
    Sweep(const std::vector<float>& heights, int width, int height)
        : _heights(heights), _width(width), _height(height), _hidden(heights.size()),
          _directions(heights.size()), _sum(heights.size()), _weight(heights.size()),
          _profile(static_cast<std::size_t>(width)), _row(static_cast<std::size_t>(width)),
          _share(static_cast<std::size_t>(width))
    {
    }

    void add(const Direction& direction, double radius)
    {
        const double reach = std::min(radius / direction.step + 1e-9, static_cast<double>(_width));
        if (reach < 1.0)
        {
            for (float& directions : _directions)
                directions += 2.0f;
            return;
        }
        Horizon horizon(_width, direction.step, static_cast<int>(reach));
        for (int x = 0; x < _width; ++x)
        {
            const double y = direction.minor * x;
            const double row = std::floor(y + 1e-6);
            _row[static_cast<std::size_t>(x)] = static_cast<int>(row);
            _share[static_cast<std::size_t>(x)] = y - row < 1e-6 ? 0.0f : static_cast<float>(y - row);
        }
        for (const bool forth : {true, false})
        {
            std::fill(_sum.begin(), _sum.end(), 0.0f);
            std::fill(_weight.begin(), _weight.end(), 0.0f);
            // All lines through the grid, by the rows where they meet its first column, or would.
            const int rise = _row.back();
            for (int first = std::min(0, -rise); first < _height + std::max(0, -rise); ++first)
                walk(horizon, first, forth);
            for (std::size_t i = 0; i < _sum.size(); ++i)
            {
                if (_weight[i] <= 0.0f) continue;
                _hidden[i] += _sum[i] / _weight[i];
                _directions[i] += 1.0f;
            }
        }
    }

    float hidden(std::size_t i) const { return _hidden[i]; }
    float directions(std::size_t i) const { return _directions[i]; }

private:
    void walk(Horizon& horizon, int first, bool forth)
    {
        // The part of the line that is in the grid.
        int begin = 0, end = _width;
        const auto inside = [&](int x)
        {
            const int y = first + _row[static_cast<std::size_t>(x)];
            return y >= 0 && y < _height;
        };
        while (begin < end && !inside(begin))
            ++begin;
        while (end > begin && !inside(end - 1))
            --end;
        const int length = end - begin;
        for (int i = 0; i < length; ++i)
            _profile[static_cast<std::size_t>(forth ? i : length - 1 - i)] = heightAt(first, begin + i);
        horizon.walk(_profile, length,
                     [&](int i, double tangent)
                     {
                         const auto x = static_cast<std::size_t>(forth ? begin + i : end - 1 - i);
                         const auto hidden =
                             static_cast<float>(tangent * tangent / (1.0 + tangent * tangent));
                         const std::size_t texel =
                             static_cast<std::size_t>(first + _row[x]) * static_cast<std::size_t>(_width) + x;
                         _sum[texel] += (1.0f - _share[x]) * hidden;
                         _weight[texel] += 1.0f - _share[x];
                         if (_share[x] == 0.0f) return;
                         _sum[texel + static_cast<std::size_t>(_width)] += _share[x] * hidden;
                         _weight[texel + static_cast<std::size_t>(_width)] += _share[x];
                     });
    }

    /// Of the ground on a line; none where one of the two texels beside it has none.
    float heightAt(int first, int x) const
    {
        const auto column = static_cast<std::size_t>(x);
        const int y = first + _row[column];
        const std::size_t texel = static_cast<std::size_t>(y) * static_cast<std::size_t>(_width) + column;
        const float share = _share[column];
        if (share == 0.0f) return _heights[texel];
        if (y + 1 >= _height) return hole;
        return (1.0f - share) * _heights[texel] + share * _heights[texel + static_cast<std::size_t>(_width)];
    }

    const std::vector<float>& _heights;
    int _width, _height;
    std::vector<float> _hidden, _directions; ///< of all directions
    std::vector<float> _sum, _weight;        ///< of one
    std::vector<float> _profile;
    std::vector<int> _row; ///< of a line through (0, 0), and how far it is above that
    std::vector<float> _share;
};

std::vector<float> transposed(const std::vector<float>& grid, std::size_t width, std::size_t height)
{
    std::vector<float> result(grid.size());
    for (std::size_t y = 0; y < height; ++y)
        for (std::size_t x = 0; x < width; ++x)
            result[x * height + y] = grid[y * width + x];
    return result;
}

} // namespace

SurfaceDerivation::SurfaceDerivation(const osg::Image& heights, const osg::Vec2d& spacing)
    : _width(heights.s()), _height(heights.t()), _spacing(spacing)
{
    const auto* texels = reinterpret_cast<const float*>(heights.data());
    const std::size_t count = static_cast<std::size_t>(_width) * static_cast<std::size_t>(_height);
    _heights.reserve(count);
    for (std::size_t i = 0; i < count; ++i)
        _heights.push_back(texels[4 * i + 3] > 0.0f && std::isfinite(texels[4 * i]) ? texels[4 * i] : hole);
}

osg::ref_ptr<osg::Image> SurfaceDerivation::emptyLayer(int width, int height)
{
    osg::ref_ptr<osg::Image> image = new osg::Image;
    image->allocateImage(width, height, 1, GL_RGBA, GL_FLOAT);
    image->setInternalTextureFormat(GL_RGBA32F_ARB);
    std::fill_n(image->data(), image->getTotalSizeInBytes(), static_cast<unsigned char>(0));
    return image;
}

bool SurfaceDerivation::has(int x, int y) const
{
    return x >= 0 && y >= 0 && x < _width && y < _height && !std::isnan(at(x, y));
}

osg::Vec2d SurfaceDerivation::gradient(int x, int y) const
{
    // The mean of three rows, or columns, the middle one twice; in each the difference of its ends, or of the one that
    // there is to its middle. So planes have their slope everywhere.
    osg::Vec2d result;
    for (const bool along : {true, false})
    {
        double sum = 0.0, weights = 0.0;
        for (int side = -1; side <= 1; ++side)
        {
            const auto present = [&](int i)
            {
                return along ? has(x + i, y + side) : has(x + side, y + i);
            };
            const auto height = [&](int i)
            {
                return static_cast<double>(along ? at(x + i, y + side) : at(x + side, y + i));
            };
            const int low = present(-1) ? -1 : 0;
            const int high = present(1) ? 1 : 0;
            if (low == high || !present(low) || !present(high)) continue;
            const double weight = side == 0 ? 2.0 : 1.0;
            sum += weight * (height(high) - height(low)) / (high - low);
            weights += weight;
        }
        if (weights > 0.0) result[along ? 0 : 1] = sum / weights / _spacing[along ? 0 : 1];
    }
    return result;
}

template<typename Texel>
osg::ref_ptr<osg::Image> SurfaceDerivation::layerOf(const Texel& texel) const
{
    osg::ref_ptr<osg::Image> image = emptyLayer(_width, _height);
    auto* out = reinterpret_cast<float*>(image->data());
    for (int y = 0; y < _height; ++y)
        for (int x = 0; x < _width; ++x, out += 4)
            if (has(x, y)) texel(x, y, out);
    return image;
}

osg::ref_ptr<osg::Image> SurfaceDerivation::normals() const
{
    return layerOf(
        [this](int x, int y, float* out)
        {
            const osg::Vec2d up = gradient(x, y);
            const double length = std::sqrt(up.length2() + 1.0);
            out[0] = static_cast<float>(-up.x() / length);
            out[1] = static_cast<float>(-up.y() / length);
            out[2] = static_cast<float>(1.0 / length);
            out[3] = 1.0f;
        });
}

osg::ref_ptr<osg::Image> SurfaceDerivation::slopes() const
{
    return layerOf(
        [this](int x, int y, float* out)
        {
            out[0] = static_cast<float>(std::atan(gradient(x, y).length()));
            out[3] = 1.0f;
        });
}

osg::ref_ptr<osg::Image> SurfaceDerivation::aspects() const
{
    return layerOf(
        [this](int x, int y, float* out)
        {
            const osg::Vec2d up = gradient(x, y);
            const double length = up.length();
            if (length < levelGradient) return;
            const double angle = std::atan2(-up.x(), -up.y());
            out[0] = static_cast<float>(angle < 0.0 ? angle + 2.0 * osg::PI : angle);
            out[1] = static_cast<float>(-up.x() / length);
            out[2] = static_cast<float>(-up.y() / length);
            out[3] = 1.0f;
        });
}

osg::ref_ptr<osg::Image> SurfaceDerivation::occlusion(double radius) const
{
    const auto width = static_cast<std::size_t>(_width);
    const auto height = static_cast<std::size_t>(_height);
    const std::vector<float> turned = transposed(_heights, width, height);
    Sweep alongX(_heights, _width, _height);
    Sweep alongY(turned, _height, _width);
    constexpr int pairs = 8;
    for (int i = 0; i < pairs; ++i)
    {
        // In texels for each metre; the axes exactly.
        const double angle = osg::PI * i / pairs;
        const double x = i == pairs / 2 ? 0.0 : std::cos(angle) / _spacing.x();
        const double y = i == 0 ? 0.0 : std::sin(angle) / _spacing.y();
        if (std::abs(x) >= std::abs(y))
            alongX.add({y / x, 1.0 / std::abs(x)}, radius);
        else
            alongY.add({x / y, 1.0 / std::abs(y)}, radius);
    }
    return layerOf(
        [&](int x, int y, float* out)
        {
            const std::size_t i = static_cast<std::size_t>(y) * width + static_cast<std::size_t>(x);
            const std::size_t j = static_cast<std::size_t>(x) * height + static_cast<std::size_t>(y);
            // The axes are among the directions, so there are some.
            out[0] =
                1.0f - (alongX.hidden(i) + alongY.hidden(j)) / (alongX.directions(i) + alongY.directions(j));
            out[3] = 1.0f;
        });
}

} // namespace osgGeoFX
