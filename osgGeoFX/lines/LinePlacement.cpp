// SPDX-License-Identifier: MIT
// SPDX-FileCopyrightText: 2026 the osgGeoFX authors
#include <osgGeoFX/lines/LinePlacement.h>

#include <osgGeoFX/labels/FinestGround.h>

#include <osg/Vec2d>

#include <algorithm>
#include <cmath>
#include <iterator>
#include <limits>
#include <utility>

namespace osgGeoFX
{

namespace
{

/// Where a line lies on the extent, and how high its ground is.
struct Place
{
    osg::Vec2d at;
    double height = 0.0;
};

/// Leaves out places that are where the straight way between others is, to a tolerance in metres.
class Thinner
{
public:
    Thinner(const std::vector<osg::Vec3d>& places, double tolerance)
        : _places(places), _tolerance(tolerance), _kept(places.size(), false)
    {
    }

    std::vector<osg::Vec3d> thin()
    {
        if (_places.size() < 3) return _places;
        _kept.front() = _kept.back() = true;
        split(0, _places.size() - 1);
        std::vector<osg::Vec3d> result;
        for (std::size_t i = 0; i < _places.size(); ++i)
            if (_kept[i]) result.push_back(_places[i]);
        return result;
    }

private:
    /// Douglas and Peucker's algorithm, without recursion: a coast has 10⁵ places.
    void split(std::size_t first, std::size_t last)
    {
        std::vector<std::pair<std::size_t, std::size_t>> open = {{first, last}};
        while (!open.empty())
        {
            const auto [from, to] = open.back();
            open.pop_back();
            double most = _tolerance;
            std::size_t farthest = 0;
            for (std::size_t i = from + 1; i < to; ++i)
            {
                const double away = distance(_places[i], _places[from], _places[to]);
                if (away <= most) continue;
                most = away;
                farthest = i;
            }
            if (farthest == 0) continue;
            _kept[farthest] = true;
            open.emplace_back(from, farthest);
            open.emplace_back(farthest, to);
        }
    }

    static double distance(const osg::Vec3d& place, const osg::Vec3d& from, const osg::Vec3d& to)
    {
        const osg::Vec3d way = to - from;
        const double length2 = way.length2();
        const double share = length2 > 0.0 ? std::clamp((place - from) * way / length2, 0.0, 1.0) : 0.0;
        return (place - (from + way * share)).length();
    }

    const std::vector<osg::Vec3d>& _places;
    const double _tolerance;
    std::vector<bool> _kept;
};

/// One line on the ground.
class Walk
{
public:
    Walk(const FinestGround& ground, const TerrainRelief& relief, double step, std::size_t finest)
        : _ground(ground), _relief(relief), _step(step), _finest(finest)
    {
    }

    /// The places along a line, in parts that lie on the terrain.
    std::vector<std::vector<Place>> along(const MapLine& line, bool straight)
    {
        std::vector<std::vector<Place>> parts(1);
        const osg::Vec2d* former = nullptr;
        osg::Vec2d last;
        for (const osg::Vec3d& each : line.places)
        {
            const osg::Vec2d next = turned(osg::Vec2d(each.x(), each.y()), former);
            const int steps = former && !straight ? stepsBetween(last, next) : 1;
            for (int i = 1; i <= steps; ++i)
            {
                const osg::Vec2d at = former ? last + (next - last) * (static_cast<double>(i) / steps) : next;
                add(at, parts);
            }
            last = next;
            former = &last;
        }
        return parts;
    }

private:
    static constexpr int mostSteps = 100000;

    /// The longitude that is nearest to the place before, or to the extent's middle.
    osg::Vec2d turned(osg::Vec2d place, const osg::Vec2d* former) const
    {
        if (!_relief.geocentric) return place;
        const double middle = former ? former->x() : 0.5 * (_relief.west + _relief.east);
        place.x() = middle + std::remainder(place.x() - middle, 360.0);
        return place;
    }

    int stepsBetween(const osg::Vec2d& from, const osg::Vec2d& to) const
    {
        const osg::Vec2d metre = _relief.metre(0.5 * (from.y() + to.y()));
        const double length = std::hypot((to.x() - from.x()) / metre.x(), (to.y() - from.y()) / metre.y());
        return static_cast<int>(std::clamp(std::ceil(length / _step), 1.0, double(mostSteps)));
    }

    void add(const osg::Vec2d& at, std::vector<std::vector<Place>>& parts)
    {
        double height = _ground.coarse(at.x(), at.y());
        if (std::isnan(height))
        {
            if (!parts.back().empty()) parts.emplace_back();
            return;
        }
        if (_finest > 0)
        {
            --_finest;
            const double fine = _ground.finest(at.x(), at.y());
            if (!std::isnan(fine)) height = fine;
        }
        parts.back().push_back({at, height});
    }

    const FinestGround& _ground;
    const TerrainRelief& _relief;
    const double _step;
    std::size_t _finest;
};

} // namespace

LinePlacement::Result LinePlacement::place(std::vector<MapLine>& lines,
                                           const std::map<std::string, LineStyle>& styles,
                                           const osg::Node& terrain, const osg::EllipsoidModel* ellipsoid,
                                           const TerrainRelief& relief) const
{
    Result result;
    const FinestGround ground(terrain, ellipsoid, relief);
    const double cell = std::max(relief.size().x() / relief.columns, relief.size().y() / relief.rows);
    Walk walk(ground, relief, step > 0.0 ? step : std::max(cell, 10.0), finest);
    std::vector<MapLine> placed;
    for (const MapLine& line : lines)
    {
        const LineStyle& style = lineStyleOf(styles, line.style);
        if (!style.shown) continue;
        bool any = false;
        for (const std::vector<Place>& part : walk.along(line, style.straight))
        {
            if (part.size() < 2) continue;
            MapLine on{line.style, line.name, {}};
            for (const Place& each : part)
                on.places.push_back(
                    ground.world(each.at.x(), each.at.y(), each.height + (style.straight ? wire : 0.0)));
            on.places = Thinner(on.places, tolerance).thin();
            result.places += on.places.size();
            placed.push_back(std::move(on));
            any = true;
        }
        if (!any) ++result.outside;
    }
    lines = std::move(placed);
    return result;
}

} // namespace osgGeoFX
